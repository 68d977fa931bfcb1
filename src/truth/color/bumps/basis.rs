//! Directions of s and t on a triangle, in f64, by dual bases: not by the formulas of the renderer's own tangents.

use glam::{DVec2, DVec3};

use crate::geometry::tangents::BasisFit;

/// Unit vectors along s, along t, and outwards.
pub(super) type Axes = [DVec3; 3];

/// Sine of the angle between two edges, on the surface or on its skin, below which there is no direction.
const LEAST_SINE: f64 = 1e-9;

/// Radii of the built-in torus.
const TORUS_MAJOR: f64 = 1.0;
const TORUS_MINOR: f64 = 0.4;

/// Axes at the corners of a triangle, and whether they are known: without a direction on the skin any will do.
pub(super) fn corner_axes(
    places: [DVec3; 3],
    skin: [DVec2; 3],
    normals: [DVec3; 3],
    fit: BasisFit,
) -> ([Axes; 3], bool) {
    let facet = (places[1] - places[0]).cross(places[2] - places[0]).normalize_or(normals[0]);
    let outward = normals.map(|normal| if fit == BasisFit::PerPolygon { facet } else { normal });
    let any = outward.map(|normal| {
        let aside = normal.any_orthonormal_vector();
        [aside, normal.cross(aside), normal]
    });
    let Some([along_s, along_t]) = derivatives(places, skin) else { return (any, false) };
    let sense = along_s.cross(along_t).dot(facet).signum();
    let mut axes = any;
    for (axes, normal) in axes.iter_mut().zip(outward) {
        // Into the plane of the normal.
        let flat = |way: DVec3| (way - normal * way.dot(normal) / normal.length_squared()).normalize_or_zero();
        let [tangent, bitangent] = match fit {
            BasisFit::PerPolygon => [along_s, along_t],
            BasisFit::Skewed => [flat(along_s), flat(along_t)],
            BasisFit::Orthogonal => {
                let tangent = flat(along_s);
                [tangent, sense * normal.cross(tangent)]
            }
        };
        let is_upright = along_s.cross(normal).length().min(along_t.cross(normal).length()) < 1e-6;
        if is_upright {
            return (any, false);
        }
        *axes = [tangent, bitangent, normal];
    }
    (axes, true)
}

/// Unit vectors along which s and t grow. The gradients of s and t are sums over the dual of the two edges, and the
/// derivatives by s and t are the dual of these gradients.
fn derivatives(places: [DVec3; 3], skin: [DVec2; 3]) -> Option<[DVec3; 2]> {
    let size = (places[1] - places[0]).length().max((places[2] - places[0]).length());
    let edges = [1, 2].map(|corner| (places[corner] - places[0]) / size);
    let reach = [1, 2].map(|corner| skin[corner] - skin[0]);
    let turn = reach[0].normalize_or_zero().perp_dot(reach[1].normalize_or_zero());
    if turn.abs() < LEAST_SINE {
        return None;
    }
    let across = dual(edges)?;
    let scale = reach[0].length().max(reach[1].length());
    let gradient = |of: fn(DVec2) -> f64| across[0] * (of(reach[0]) / scale) + across[1] * (of(reach[1]) / scale);
    let ways = dual([gradient(|reach| reach.x), gradient(|reach| reach.y)])?;
    Some(ways.map(DVec3::normalize_or_zero))
}

/// The two vectors of the plane of `pair` whose products with them are 1 and 0, and 0 and 1.
fn dual([a, b]: [DVec3; 2]) -> Option<[DVec3; 2]> {
    let normal = a.cross(b);
    let area = normal.length_squared();
    if normal.length() < LEAST_SINE * a.length() * b.length() || area == 0.0 {
        return None;
    }
    Some([b.cross(normal) / area, normal.cross(a) / area])
}

/// Axes of the built-in torus at a point of it, with the vertex's normal: s around the y axis, t around the tube.
pub(super) fn torus_axes(place: DVec3, normal: DVec3) -> Axes {
    let out = DVec3::new(place.x, 0.0, place.z);
    let radius = out.length();
    let out = out / radius;
    let [cosine, sine] = [(radius - TORUS_MAJOR) / TORUS_MINOR, place.y / TORUS_MINOR];
    [DVec3::Y.cross(out), DVec3::Y * cosine - out * sine, normal]
}
