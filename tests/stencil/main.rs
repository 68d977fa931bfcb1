//! Shadow volumes counted by GL, compared with the ray tracer's counts: exact at every pixel outside its band.

mod closure;
mod count;
#[allow(dead_code)]
#[path = "../volumes/homogeneous.rs"]
mod homogeneous;
mod lights;
mod meshes;
mod positions;
#[path = "../oracle/scenes.rs"]
#[allow(dead_code)]
mod scenes;
#[path = "../volumes/shapes.rs"]
#[allow(dead_code)]
mod shapes;
