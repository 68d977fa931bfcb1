//! Any scene in a window: `glumbra view`. [`Explorer`] is its state: the scene as its files have it and as keys and mouse have
//! changed it, what is shown of it, and what is saved.

mod apply;
mod headless;
mod keys;
mod moves;
mod save;
mod script;
mod shadow;
mod sheets;
mod shown;
mod sources;

use std::path::PathBuf;

pub use headless::{Run, run_steps, turn};
pub use keys::{ExploreCommand, explore_help};
pub use script::{Step, parse_steps};
pub use sources::Sources;

use super::show::Facts;
use crate::judge::truth_pictures::TruthMemory;
use crate::scene::{self, Camera, Scene};
use shown::Looks;

/// State of a window over any scene.
#[derive(Debug)]
pub struct Explorer {
    sources: Sources,
    /// The scene as its files have it, through the chosen camera.
    base: Scene,
    scene: Scene,
    /// The last state that could be drawn, to go back to.
    good: (Scene, Looks),
    good_light: usize,
    /// True after going back, until something is drawn.
    has_gone_back: bool,
    looks: Looks,
    /// Names of the scene's cameras; empty if they have none.
    cameras: Vec<String>,
    /// The chosen one of them.
    camera: usize,
    /// The chosen light.
    light: usize,
    /// True if the mouse holds the light and not the camera.
    holds_light: bool,
    /// True if a drag looks around and w, a, s, d move.
    flies: bool,
    size: [u32; 2],
    facts: Facts,
    /// Outcome of the last command, if that is not to be seen.
    said: Option<String>,
    /// Error of a change that could not be drawn.
    error: Option<String>,
    /// Error in the scene's files, until they are read without.
    file_error: Option<String>,
    folder: PathBuf,
    /// The rays traced last.
    truth: TruthMemory,
    /// Changes of the scene by other than keys and mouse: of its files, and of going back.
    changes: u64,
}

impl Explorer {
    /// The state for a scene that was loaded from `sources`. `folder`: where pictures and scenes are saved.
    ///
    /// # Errors
    ///
    /// A scene file that cannot be read again.
    pub fn new(sources: Sources, scene: Scene, folder: PathBuf) -> Result<Self, scene::Error> {
        let cameras = sources.cameras()?;
        let camera = sources.first_camera(&cameras);
        Ok(Self {
            sources,
            base: scene.clone(),
            good: (scene.clone(), Looks::default()),
            good_light: 0,
            has_gone_back: false,
            size: scene.image.size,
            scene,
            looks: Looks::default(),
            cameras,
            camera,
            light: 0,
            holds_light: false,
            flies: false,
            facts: Facts::default(),
            said: None,
            error: None,
            file_error: None,
            folder,
            truth: TruthMemory::default(),
            changes: 0,
        })
    }

    /// The scene as changed so far.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The camera through which the scene is seen.
    pub fn camera(&self) -> &Camera {
        &self.scene.camera
    }

    /// Number of times that rays were traced for a picture of the truth.
    pub fn traces(&self) -> u64 {
        self.truth.traces()
    }

    /// The error that is shown, if there is one.
    pub fn error(&self) -> Option<&str> {
        self.error.as_deref().or(self.file_error.as_deref())
    }
}
