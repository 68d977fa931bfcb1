//! The frames.

use crate::plan::ViewRequest;
use crate::scene::{Embedded, Scene};
use crate::techniques;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    Maps,
}

impl Group {
    pub const ALL: [Self; 1] = [Self::Maps];

    pub fn name(self) -> &'static str {
        "shadow maps"
    }
}

pub struct FrameToDraw {
    pub said: String,
    pub text: String,
    pub views: Vec<ViewRequest>,
}

impl FrameToDraw {
    pub fn scene(&self) -> Result<Scene, String> {
        let embedded = Embedded { path: "frame.toml", text: "", pictures: &[], meshes: &[] };
        let _ = embedded;
        techniques::load_str(&self.text, std::path::Path::new(""), &[]).map(|loaded| loaded.scene).map_err(|error| error.to_string())
    }
}

pub fn of_group(_: Group) -> Vec<FrameToDraw> {
    let text = std::fs::read_to_string("/tmp/frames-scratch/scene.toml").unwrap_or_default();
    vec![FrameToDraw { said: "x".into(), text, views: Vec::new() }]
}
