//! An origin near the vertices of a mesh that lies far from its file's: f32, which meshes hold, would merge positions that f64
//! keeps apart (map coordinates), and shaders would multiply large numbers whose difference is the picture.

use glam::DVec3;

use crate::math::Aabb;

/// Ratio of the vertices' distance to their extent from which an origin is used: it saves three bits. Other meshes are kept as
/// they are.
const FAR: f64 = 8.0;

/// Origin of the positions of a mesh of these bounds; zero where another saves nothing.
pub(super) fn origin_of(bounds: &Aabb) -> DVec3 {
    let away = bounds.min.abs().max(bounds.max.abs()).max_element();
    let size = (bounds.max - bounds.min).max_element();
    if bounds.is_empty() || away < FAR * size || away == 0.0 {
        return DVec3::ZERO;
    }
    // A power of two not below the size: what is taken off is short, and the rest exact.
    let step = size.max(away * f64::EPSILON).log2().ceil().exp2();
    (bounds.center() / step).round() * step
}

/// Positions relative to an origin near them, and that origin.
#[cfg(any(feature = "gltf", feature = "ply", feature = "stl"))]
pub(super) fn relative(positions: &[[f64; 3]]) -> (Vec<[f32; 3]>, DVec3) {
    let places = || positions.iter().map(|position| DVec3::from_array(*position));
    let origin = origin_of(&Aabb::from_points(places()));
    (places().map(|place| (place - origin).as_vec3().to_array()).collect(), origin)
}
