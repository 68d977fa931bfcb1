//! A scene in a window, to walk around in: what `glumbra view` and the sample programs share. [`State`], [`ModelState`] and
//! [`explore::Explorer`] are plain data and know no window; [`run`] joins a [`Show`] to winit's events. Each change makes a new plan, and the device skips
//! passes that the last plan had, too: the map stays when only the camera moves.

pub mod explore;
mod keys;
mod mode;
mod model_keys;
mod model_state;
mod orbit;
mod picture;
mod sheet;
mod show;
mod state;
mod tweak;
mod window;

pub use keys::{Command, help, help_of};
pub use mode::{Handle, Mode};
pub use model_keys::{ModelCommand, ModelMode, model_help};
pub use model_state::ModelState;
pub use show::{Button, Reaction, Show};
pub use state::State;
pub use tweak::{TWEAKS, Tweak};
pub use window::{Shown, run};

use crate::judge::truth_pictures;
use crate::{context, frame, output, scene};

/// Reason why a window could not be opened or drawn in.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error(
        "no window can be opened: neither DISPLAY nor WAYLAND_DISPLAY is set. \
         Without a display, write a picture with --headless -o FILE"
    )]
    NoDisplay,
    #[error("no window can be opened: {0}. Without one, write a picture with --headless -o FILE")]
    Open(String),
    #[error("{0}")]
    Context(#[from] context::Error),
    #[error(transparent)]
    Frame(#[from] frame::Error),
    #[error(transparent)]
    Scene(#[from] scene::Error),
    #[error(transparent)]
    File(#[from] output::Error),
    #[error("{folder}: has thousands of saved pictures of this scene: move them away", folder = .folder.display())]
    Full { folder: std::path::PathBuf },
    #[error(transparent)]
    Truth(#[from] truth_pictures::Error),
}

/// The first name that stands twice among the names of keys, in whatever case.
#[cfg(test)]
fn twice<'n>(names: impl Iterator<Item = &'n &'n str>) -> Option<String> {
    let mut known = std::collections::HashSet::new();
    names.map(|name| name.to_lowercase()).find(|name| !known.insert(name.clone()))
}
