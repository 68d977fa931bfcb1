//! Types that techniques, surfaces, compositions and views share: drawable parts of objects, a light as a technique sees
//! it, the light term, guards, and the visible part of the scene. Knows no technique and no GL.

pub mod alpha;
pub mod appearance;
pub mod box_raster;
pub mod bumps;
pub mod camera_visibility;
pub mod caster_culling;
mod coordinates;
mod crop;
pub mod cut;
pub mod drawable;
pub mod ending;
pub mod guard;
pub mod joined_batches;
pub mod light;
pub mod map;
mod notes;
pub mod photo;
pub mod projected;
pub mod projector;
pub mod sides;
mod viewer;
mod whole_target;

pub use camera_visibility::CameraView;
pub use coordinates::Coordinates;
pub use crop::Crop;
pub use drawable::Drawable;
pub use ending::{Ending, Factors};
pub use light::{FrustumView, LightTerm, LightView};
pub use map::{MapInfo, MapShape};
pub use notes::{Chosen, LeftOut, Notes};
pub use viewer::Viewer;
pub use whole_target::whole_target;
