//! Display modes of a window, and the thing that its mouse moves.

use crate::plan::{Request, Subject};
use crate::scene::Scene;
use crate::techniques;

/// Display modes of the sample program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// From the camera, without shadows.
    Camera,
    /// From the camera, with shadows.
    #[default]
    Shadowed,
    /// From the first light, in the largest square of a power of two.
    Light,
}

impl Mode {
    /// All modes in the order of the space key, with their names on the command line.
    pub const ALL: [(&str, Self); 3] = [("camera", Self::Camera), ("shadowed", Self::Shadowed), ("light", Self::Light)];

    fn place(self) -> usize {
        Self::ALL.iter().position(|(_, mode)| *mode == self).unwrap_or(0)
    }

    /// Description of the mode.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Camera => "without shadows",
            Self::Shadowed => "with shadows",
            Self::Light => "from the light",
        }
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        Self::ALL[self.place()].0
    }

    #[must_use]
    pub fn next(self) -> Self {
        Self::ALL[(self.place() + 1) % Self::ALL.len()].1
    }

    /// `scene` at `size` pixels, and the request for its picture, so that a frame shows it in this mode.
    pub fn frame(self, scene: &Scene, size: [u32; 2]) -> (Scene, Request) {
        let mut scene = scene.clone();
        scene.image.size = size;
        let mut request = Request::default();
        match self {
            Self::Camera => scene.lights.iter_mut().for_each(|light| light.shadow = techniques::unshadowed()),
            Self::Shadowed => {}
            Self::Light => request.subject = Subject::Light(0),
        }
        (scene, request)
    }
}

/// Thing that the mouse turns and moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Handle {
    #[default]
    Camera,
    /// The first light, about what it points at.
    Light,
    /// The first object that is lit, about its own middle.
    Object,
}
