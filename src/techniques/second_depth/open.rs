//! What a map of far sides cannot show: casters that have none. Says so by name and with the share that is lost, where
//! something lies behind to be shadowed.

use glam::DVec3;

use crate::techniques::projector::Rays;
use crate::techniques::shadow_map::casters::middle_of_crossing;
use crate::techniques::{FrustumView, Item, Notes};

/// A share below this is left to the gaps of meshes that are closed to the eye: that much of one object's shadow.
const LEAST_SHARE: f64 = 0.05;

/// What rounding may move, as a share of the way from the light.
const SLACK: f64 = 1e-6;

/// So many rays are asked of one caster, whatever the number of its triangles.
const MOST_RAYS: usize = 32;

/// Warns of each of `casters` whose shadow is lost, of which `is_closed` says whether it has far sides all over; and of
/// closed ones that the light stands in, whose inner sides are far sides that are lit.
pub fn warn(view: &FrustumView<'_>, casters: &[&Item], is_closed: &mut dyn FnMut(&Item) -> bool, notes: &mut Notes) {
    let mut said: Vec<&str> = Vec::new();
    for item in casters {
        if said.contains(&item.label.as_str()) {
            continue;
        }
        let problem = match is_closed(item) {
            true => {
                inside(view, item).then(|| String::from("the light stands in it, and its inner side shades itself"))
            }
            false if item.needs_alpha_test() && item.mesh.is_closed() => {
                Some(String::from("behind holes of its far side, what its near side shadows is lit"))
            }
            false => {
                Some(lost_share(view, item)).filter(|share| *share > LEAST_SHARE && shadows(view, item)).map(|share| {
                    format!("{:.0} % of what the light sees of it has no far side, and casts no shadow", 100.0 * share)
                })
            }
        };
        if let Some(problem) = problem {
            said.push(&item.label);
            notes.warnings.push(format!("{} in the map of far sides of light {}: {problem}", item.label, view.index));
        }
    }
}

/// From the light to a point, of any length.
fn way(rays: &Rays, point: DVec3) -> DVec3 {
    match rays {
        Rays::From { position, .. } => point - *position,
        Rays::Along(direction) => *direction,
    }
}

/// Solid angles of the item's near sides less those of its far sides, over those of the near sides (for parallel light,
/// areas across it). Along each ray through a closed surface both are met equally often.
fn lost_share(view: &FrustumView<'_>, item: &Item) -> f64 {
    let (near, far) = sides(view, item);
    if near > far { (near - far) / near } else { 0.0 }
}

/// What the light sees of both sides of the item's triangles.
fn sides(view: &FrustumView<'_>, item: &Item) -> (f64, f64) {
    let rays = &view.projector.rays;
    let turned = if item.world_from_model.determinant() < 0.0 { -1.0 } else { 1.0 };
    let (mut near, mut far) = (0.0, 0.0);
    for [a, b, c] in triangles(item) {
        // Positive where the front looks away from the light.
        let seen = turned
            * match rays {
                Rays::From { .. } => solid_angle([a, b, c].map(|corner| way(rays, corner))),
                Rays::Along(direction) => 0.5 * (b - a).cross(c - a).dot(*direction),
            };
        if seen > 0.0 { far += seen } else { near -= seen }
    }
    (near, far)
}

/// The corners of its triangles, in world space.
fn triangles(item: &Item) -> impl ExactSizeIterator<Item = [DVec3; 3]> {
    let indices = item.mesh.indices.get(item.indices.start as usize..item.indices.end as usize).unwrap_or_default();
    let place = |index: u32| {
        let position = item.mesh.positions.get(index as usize).copied().unwrap_or_default();
        item.world_from_model.transform_point3(DVec3::from_array(position.map(f64::from)))
    };
    indices.chunks_exact(3).map(move |triangle| [0, 1, 2].map(|corner| place(triangle[corner])))
}

/// Of a triangle as seen from the origin, in steradians; positive where it winds clockwise [Van Oosterom and Strackee].
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    let volume = a.dot(b.cross(c));
    2.0 * volume.atan2(x * y * z + a.dot(b) * z + a.dot(c) * y + b.dot(c) * x)
}

/// Whether the light stands inside a closed item: all that it sees of it are far sides.
fn inside(view: &FrustumView<'_>, item: &Item) -> bool {
    let Rays::From { position, .. } = view.projector.rays else { return false };
    let bounds = item.bounds.transformed(&item.world_from_model);
    let holds = |point: DVec3| point.cmpge(bounds.min).all() && point.cmple(bounds.max).all();
    // What the camera sees from outside are the near sides.
    if !(holds(position) && holds(view.scene.camera.eye)) {
        return false;
    }
    let (near, far) = sides(view, item);
    far - near > 2.0 * std::f64::consts::PI
}

/// Whether something else lies behind the item, in its shadow: along rays through some of its triangles, and to the middle
/// of each other item.
fn shadows(view: &FrustumView<'_>, item: &Item) -> bool {
    let rays = &view.projector.rays;
    let nearest = if matches!(rays, Rays::From { .. }) { -1.0 } else { f64::NEG_INFINITY };
    let corners = triangles(item);
    let step = corners.len() / MOST_RAYS + 1;
    let through: Vec<DVec3> = corners.step_by(step).map(|[a, b, c]| (a + b + c) / 3.0).collect();
    view.items.iter().filter(|other| !std::ptr::eq(*other, item)).any(|other| {
        let middle = other.world_from_model.transform_point3(0.5 * (other.bounds.min + other.bounds.max));
        let is_behind =
            |point: &DVec3| middle_of_crossing(other, *point, way(rays, *point)).is_some_and(|at| at > SLACK);
        let is_before = |at: f64| nearest < at && at < -SLACK;
        through.iter().any(is_behind) || middle_of_crossing(item, middle, way(rays, middle)).is_some_and(is_before)
    })
}
