//! glTF files, which the tests write themselves: what they place, what they look like, and what is refused.

mod far;
pub mod glb;
mod looks;
mod malformed;
mod motion;
mod places;
mod tints;

use std::path::Path;

use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::plan::Request;
use glumbra::scene::Loaded;

use crate::support::load_file;
/// A scene's text before its objects.
const START: &str = r#"
[image]
size = [120, 90]
[camera]
eye = [3, 4, 7]
target = [0, 0.5, 0]
[[light]]
position = [4, 7, 3]
target = [0, 0, 0]
cone = 60
shadow = { technique = "shadow-map", size = 256 }
[[object]]
mesh = "quad"
scale = [6, 1, 6]
translate = [0, -0.5, 0]
"#;

fn load(path: &Path, overrides: &[&str]) -> Loaded {
    load_file(path, overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// The error that a file gives.
fn refusal(path: &Path) -> String {
    match glumbra::load(path, &[]) {
        Ok(_) => panic!("{} loads", path.display()),
        Err(error) => error.to_string(),
    }
}

/// Pictures of several scenes, drawn by one renderer.
fn drawn<const N: usize>(loaded: [&Loaded; N]) -> [Pixels; N] {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    loaded.map(|loaded| renderer.render(&loaded.scene, &Request::default()).unwrap().picture)
}

/// A scene of [`START`] and these objects, beside the files that they name.
fn scene(folder: &Path, name: &str, objects: &str) -> Loaded {
    let path = folder.join(name);
    std::fs::write(&path, format!("{START}{objects}")).unwrap();
    load(&path, &[])
}

/// Tests that two scenes' pictures are the same bits, and not those of an empty scene.
fn assert_same(found: &Loaded, expected: &Loaded) {
    let mut empty = expected.clone();
    empty.scene.objects.truncate(1);
    let [found, expected, empty] = drawn([found, expected, &empty]);
    assert!(expected != empty, "the object is not in the picture");
    assert!(found == expected, "the pictures differ");
}
