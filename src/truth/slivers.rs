//! Sides of shadow volumes that the eye sees edge-on. GL rounds the places of vertices to a part of a pixel and leaves
//! their depths: where a side is hardly wider than that, a sample that it covers may get the depth of any place of its
//! plane as near, also of one where the side itself does not lie. The plane is then nearly parallel to the view ray, and
//! such places lie far before or behind the side.

use glam::DVec3;

use super::Tracer;
use super::primary::SeenPoint;
use super::shells::CountRule;

/// In pixels: sides farther than this from the eye's own place, at the depth of what is seen, are not edge-on. A sample
/// moved by 2^-7 of a pixel meets them within 3 % of the way from the eye.
const MOST_APART: f64 = 0.25;

/// The sides that are edge-on to the eye.
pub(super) struct Slivers {
    sides: Vec<Sliver>,
}

/// A side: the part of a plane that lies within three others.
struct Sliver {
    plane: Plane,
    within: [Plane; 3],
    /// By how much the count changes across it.
    weight: u32,
}

struct Plane {
    /// Unit normal.
    normal: DVec3,
    point: DVec3,
}

impl Plane {
    fn height(&self, of: DVec3) -> f64 {
        self.normal.dot(of - self.point)
    }

    /// The same plane, seen from its other side where `inside` lies below.
    fn facing(normal: DVec3, point: DVec3, inside: DVec3) -> Self {
        let normal = normal.normalize_or_zero();
        Self { normal: if normal.dot(inside) < 0.0 { -normal } else { normal }, point }
    }
}

impl Slivers {
    /// Finds them among all triangles that count by `rules`, of each object.
    pub fn new(tracer: &Tracer<'_>, rules: &[Vec<CountRule>]) -> Self {
        let eye = &tracer.eye;
        let (center, radius) = tracer.world.ball();
        let most = MOST_APART * eye.right.length().max(eye.up.length()) * (center.distance(eye.position) + radius);
        let mut sides = Vec::new();
        for (object, rules) in (0..).zip(rules) {
            for (index, rule) in (0..).zip(rules).filter(|(_, rule)| **rule != CountRule::Never) {
                let triangle = tracer.world.triangle(object, index);
                for k in 0..3 {
                    let [from, to, third] = [0, 1, 2].map(|i| triangle.corners[(k + i) % 3]);
                    let away = |corner| -tracer.lamp.towards(corner);
                    let normal = (to - from).cross(away(from)).normalize_or_zero();
                    let is_sliver = normal != DVec3::ZERO && normal.dot(eye.position - from).abs() <= most;
                    let side = |corner: DVec3| normal.dot(corner - from);
                    let is_fold = || triangle.across(k).is_none_or(|across| side(third) * side(across) >= 0.0);
                    if is_sliver && is_fold() {
                        let within = [
                            Plane::facing(normal.cross(to - from), from, away(from)),
                            Plane::facing(normal.cross(away(from)), from, to - from),
                            Plane::facing(normal.cross(away(to)), to, from - to),
                        ];
                        let weight = if *rule == CountRule::All { 2 } else { 1 };
                        sides.push(Sliver { plane: Plane { normal, point: from }, within, weight });
                    }
                }
            }
        }
        Self { sides }
    }

    /// By how much the count of a visible point may be off, for the sides that cover its pixel's centre and are drawn
    /// there before it or behind it, whichever.
    pub fn doubtful(&self, tracer: &Tracer<'_>, seen: &SeenPoint<'_>) -> u32 {
        let eye = &tracer.eye;
        let depth = eye.depth_of(seen.position - eye.position);
        // The visible surface and the side are rounded each for itself.
        let aside = 2.0 * tracer.subpixel * depth * (eye.right.length() + eye.up.length()) * 0.5;
        let near = |sliver: &&Sliver| sliver.plane.height(seen.position).abs() <= aside;
        let covering = self.sides.iter().filter(near).filter(|side| side.covers(eye.position, seen.position, aside));
        covering.map(|side| side.weight).sum()
    }
}

impl Sliver {
    /// Tests whether the side, moved by `aside` at the depth of `seen`, covers the ray from the eye through it, at any depth.
    fn covers(&self, eye: DVec3, seen: DVec3, aside: f64) -> bool {
        let (mut start, mut end) = (0.0_f64, f64::INFINITY);
        for plane in &self.within {
            let (at_eye, at_seen) = (plane.height(eye), plane.height(seen));
            let crossed = at_eye / (at_eye - at_seen);
            match at_seen.total_cmp(&at_eye) {
                std::cmp::Ordering::Greater => start = start.max(crossed),
                std::cmp::Ordering::Less => end = end.min(crossed),
                std::cmp::Ordering::Equal if at_eye < 0.0 => return false,
                std::cmp::Ordering::Equal => {}
            }
        }
        if start > end || end <= 0.0 {
            return false;
        }
        // Seen from the eye, the ray's distance from the plane is a + b / t of a pixel's, and so between its ends'.
        let (at_eye, at_seen) = (self.plane.height(eye), self.plane.height(seen));
        let apart = [start, end].map(|t| if t > 0.0 { at_seen - at_eye + at_eye / t } else { at_eye * f64::INFINITY });
        apart[0] * apart[1] <= 0.0 || apart.iter().any(|apart| apart.abs() <= aside)
    }
}
