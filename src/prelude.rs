//! Names that a test of pixels needs: `use glumbra::prelude::*`.

pub use crate::context::{self, ContextRequest};
pub use crate::device::Pixels;
pub use crate::frame::{Frame, Renderer};
pub use crate::output::{self, Output};
pub use crate::plan::{Request, View, ViewRequest};
pub use crate::scene::{Camera, LightBuilder, Loaded, ObjectBuilder, Scene, SceneBuilder};
pub use crate::truth::{self, Answer, Truth};
pub use crate::{glam, load, load_str};
