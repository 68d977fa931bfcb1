//! Pure matrices and planes, f64, no GL: spaces, frusta, texgen, bias.
//! Column vectors; a matrix is named `target_from_source`.

mod aabb;
pub mod dd;
pub mod exact;
pub mod frustum;
pub mod hull;
pub mod ledge;
pub mod spaces;
pub mod texgen;

pub use aabb::Aabb;
