//! Triangles that make shadow volumes: the rule of [`super::volume_count`], from the scene alone. An object's triangles
//! fall into shells, connected across edges; each is closed or not, looks outwards or not, and may hold the light.

use std::collections::HashMap;

use glam::DVec3;

use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::Triangle;

use super::beam::crossing_once;
use super::solid::Solid;
use super::world::PlacedObject;
use crate::scene::Object;

/// Way in which a triangle counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CountRule {
    /// It casts no shadow, or has no area.
    Never,
    /// Counts if the light is on the side from which its corners run counter-clockwise in model space.
    Facing,
    /// From both sides.
    All,
}

/// Below this share of its terms' magnitudes a signed volume is none.
const LEAST_VOLUME: f64 = 9.313_225_746_154_785e-10;

/// The rule for each triangle of an object. `light` in world space; `None`: infinitely far away.
pub(super) fn rules(object: &Object, solid: &Solid<'_>, placed: &PlacedObject, light: Option<DVec3>) -> Vec<CountRule> {
    let mut rules = vec![CountRule::Never; solid.welded.len()];
    if !object.casts_shadow {
        return rules;
    }
    let light = light.map(|light| placed.to_model_point(light));
    for shell in shells(object, solid) {
        let faces_suffice = shell.is_closed
            && looks_outwards(solid, &shell.triangles)
            && light.is_none_or(|light| {
                !touches(solid, &shell.triangles, light) && winding(solid, &shell.triangles, light) == 0
            });
        for triangle in shell.triangles {
            rules[triangle as usize] = if faces_suffice { CountRule::Facing } else { CountRule::All };
        }
    }
    rules
}

struct Shell {
    triangles: Vec<u32>,
    is_closed: bool,
}

/// Parts that the alpha test discards whole cast nothing.
fn casts(object: &Object, solid: &Solid<'_>, triangle: u32) -> bool {
    let mesh = &object.mesh;
    let of_part = || mesh.materials.get(mesh.parts.get(solid.part[triangle as usize] as usize)?.material?);
    let opacity = object.material.as_deref().or_else(of_part).map_or(1.0, |material| material.opacity);
    opacity >= 0.5 && !solid.is_degenerate(triangle)
}

/// A flood over edges: triangles that share both ends of one belong together.
fn shells(object: &Object, solid: &Solid<'_>) -> Vec<Shell> {
    // Each edge's users, with whether they run from its smaller end.
    let mut users: HashMap<(u32, u32), Vec<(u32, bool)>> = HashMap::new();
    let edges = |triangle: u32| {
        let w = solid.welded[triangle as usize];
        [(w[0], w[1]), (w[1], w[2]), (w[2], w[0])]
    };
    let count = solid.welded.len() as u32;
    let casting: Vec<u32> = (0..count).filter(|triangle| casts(object, solid, *triangle)).collect();
    for triangle in &casting {
        for (a, b) in edges(*triangle) {
            users.entry((a.min(b), a.max(b))).or_default().push((*triangle, a < b));
        }
    }
    let mut is_known = vec![false; count as usize];
    let mut shells = Vec::new();
    for first in casting {
        if std::mem::replace(&mut is_known[first as usize], true) {
            continue;
        }
        let mut shell = Shell { triangles: vec![first], is_closed: true };
        let mut next = 0;
        while let Some(triangle) = shell.triangles.get(next).copied() {
            next += 1;
            for (a, b) in edges(triangle) {
                let all = users.get(&(a.min(b), a.max(b))).map_or(&[][..], Vec::as_slice);
                shell.is_closed &= matches!(all, [one, other] if one.1 != other.1);
                for (other, _) in all {
                    if !std::mem::replace(&mut is_known[*other as usize], true) {
                        shell.triangles.push(*other);
                    }
                }
            }
        }
        shells.push(shell);
    }
    shells
}

fn corners(solid: &Solid<'_>, triangle: u32) -> [DVec3; 3] {
    solid.corners(triangle).map(|corner| solid.position(corner))
}

fn looks_outwards(solid: &Solid<'_>, triangles: &[u32]) -> bool {
    let Some(first) = triangles.iter().min() else { return false };
    let origin = corners(solid, *first)[0];
    let terms = triangles.iter().map(|triangle| {
        let [a, b, c] = corners(solid, *triangle).map(|corner| corner - origin);
        a.cross(b).dot(c)
    });
    let (volume, size) = terms.fold((0.0, 0.0), |(volume, size), term| (volume + term, size + term.abs()));
    volume > LEAST_VOLUME * size
}

/// Winding number of closed triangles around a point: ways out less ways in along a ray of no special direction.
fn winding(solid: &Solid<'_>, triangles: &[u32], point: DVec3) -> i32 {
    let ray = DVec3::new(0.573, 0.319, 0.811);
    let sign = |triangle: &u32| {
        let [a, b, c] = corners(solid, *triangle);
        match crossing_once(point, ray, &[a, b, c]) {
            Some(t) if t > 0.0 => {
                if (b - a).cross(c - a).dot(ray) > 0.0 {
                    1
                } else {
                    -1
                }
            }
            _ => 0,
        }
    };
    triangles.iter().map(sign).sum()
}

/// Tests whether a point lies on a triangle, within the rounding of f64.
fn touches(solid: &Solid<'_>, triangles: &[u32], point: DVec3) -> bool {
    let is_near = |triangle: &u32| {
        let local = solid.corners(*triangle).map(|corner| solid.position(corner) - point);
        let size = local.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
        let [a, b, c] = local.map(|corner| Vector::from_array(corner.to_array()));
        Triangle::new(a, b, c).distance_to_local_point(Vector::ZERO, false) <= 16.0 * f64::EPSILON * size
    };
    triangles.iter().any(is_near)
}
