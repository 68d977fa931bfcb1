//! Rays against triangles, in f64: techniques sample with them to find out where their pictures are wrong.

use glam::{BVec3, DVec3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode, TraversalAction};
use rayon::prelude::*;

/// Triangles in one space, in a hierarchy of boxes. Of many triangles each box holds several that lie close together: a
/// hierarchy of all takes longer to build than it saves.
pub struct Triangles {
    corners: Vec<[DVec3; 3]>,
    /// The triangles, group after group.
    order: Vec<u32>,
    /// Number of triangles of a group; the last may have fewer.
    group: usize,
    /// One box a group.
    boxes: Boxes,
}

/// Boxes in one space, in hierarchies.
pub struct Boxes {
    /// The greatest coordinate of any corner.
    reach: f64,
    parts: Vec<Part>,
}

/// Some of the boxes in a hierarchy.
struct Part {
    bvh: Bvh,
    /// The boxes' indices, in the order of the hierarchy's leaves.
    indices: Vec<u32>,
}

/// Number of boxes above which a hierarchy is built in parts, on all cores.
const MOST_IN_PART: usize = 1 << 14;

/// A mesh of twice as many triangles has groups of two, and so on.
const TRIANGLES_PER_GROUPED: usize = 1 << 15;

/// Greatest number of triangles of a group.
const MOST_IN_GROUP: usize = 16;

/// Times that boxes are halved for that, at most: each ray looks into each part.
const MOST_HALVED: u32 = 3;

impl Boxes {
    /// Builds the tree from each box's least and greatest corner.
    pub fn new(boxes: impl Iterator<Item = [DVec3; 2]>) -> Self {
        let mut reach: f64 = 0.0;
        let boxes: Vec<Aabb> = boxes
            .map(|[min, max]| {
                reach = reach.max(min.abs().max(max.abs()).max_element());
                Aabb::new(Vector::from_array(min.to_array()), Vector::from_array(max.to_array()))
            })
            .collect();
        let indices = (0..boxes.len() as u32).collect();
        Self { parts: parts(&boxes, indices, MOST_HALVED), reach }
    }

    /// Calls `found` with each box that the ray may meet, in no particular order; returns the number of nodes that were
    /// visited.
    pub fn met(&self, ray: &Ray, mut found: impl FnMut(u32)) -> usize {
        let slab = Slab::new(ray, self.reach);
        let mut looked_at = 0;
        for Part { bvh, indices } in &self.parts {
            bvh.traverse(|node| {
                looked_at += 1;
                if !slab.meets(node) {
                    return TraversalAction::Prune;
                }
                if let Some(leaf) = node.leaf_data() {
                    found(indices[leaf as usize]);
                }
                TraversalAction::Continue
            });
        }
        looked_at
    }
}

/// Hierarchies of the boxes `indices`, which are halved along their longest axis up to `halved` times.
fn parts(boxes: &[Aabb], mut indices: Vec<u32>, halved: u32) -> Vec<Part> {
    if indices.len() <= MOST_IN_PART || halved == 0 {
        let leaves: Vec<Aabb> = indices.iter().map(|index| boxes[*index as usize]).collect();
        return vec![Part { bvh: Bvh::from_leaves(BvhBuildStrategy::Binned, &leaves), indices }];
    }
    let middle = |index: &u32| {
        let own = &boxes[*index as usize];
        DVec3::from_array(own.mins.to_array()) + DVec3::from_array(own.maxs.to_array())
    };
    let (least, most) = indices
        .iter()
        .map(middle)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(least, most), at| (least.min(at), most.max(at)));
    let axis = (most - least).max_position();
    let half = indices.len() / 2;
    indices.select_nth_unstable_by(half, |a, b| middle(a)[axis].total_cmp(&middle(b)[axis]));
    let other = indices.split_off(half);
    let (mut all, others) = rayon::join(|| parts(boxes, indices, halved - 1), || parts(boxes, other, halved - 1));
    all.extend(others);
    all
}

/// The points `origin + t * way` with `start <= t <= end`.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: DVec3,
    pub way: DVec3,
    pub start: f64,
    pub end: f64,
}

impl Triangles {
    pub fn new(corners: Vec<[DVec3; 3]>) -> Self {
        let group = (corners.len() / TRIANGLES_PER_GROUPED).clamp(1, MOST_IN_GROUP);
        let order = if group == 1 { (0..corners.len() as u32).collect() } else { along_a_curve(&corners) };
        let bounds = order.chunks(group).map(|group| {
            let all = group.iter().flat_map(|triangle| corners[*triangle as usize]);
            all.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[min, max], corner| [min.min(corner), max.max(corner)])
        });
        Self { boxes: Boxes::new(bounds), order, group, corners }
    }

    /// The corners of a triangle, by its index in the input of [`Triangles::new`].
    pub fn corners(&self, triangle: u32) -> &[DVec3; 3] {
        &self.corners[triangle as usize]
    }

    /// Calls `found` with each triangle that the ray crosses, and its t, in no particular order. An edge that two
    /// triangles share is crossed in one of them.
    pub fn crossings(&self, ray: &Ray, mut found: impl FnMut(u32, f64)) {
        let axes = axes(ray.way);
        self.boxes.met(ray, |group| {
            let start = group as usize * self.group;
            for &triangle in &self.order[start..(start + self.group).min(self.order.len())] {
                if let Some(t) = crossing(ray, axes, &self.corners[triangle as usize])
                    && (ray.start..=ray.end).contains(&t)
                {
                    found(triangle, t);
                }
            }
        });
    }
}

/// The triangles along a curve through their box that mostly stays near where it was: a Z-order curve.
fn along_a_curve(corners: &[[DVec3; 3]]) -> Vec<u32> {
    let middle = |[a, b, c]: &[DVec3; 3]| *a + *b + *c;
    let wider = |[min, max]: [DVec3; 2], at: DVec3| [min.min(at), max.max(at)];
    let [min, max] = corners.iter().map(middle).fold([DVec3::INFINITY, DVec3::NEG_INFINITY], wider);
    let cells = f64::from(1 << CURVE_BITS) / (max - min).max_element();
    let key = |at: DVec3| {
        // A cast takes what is no number to 0.
        let [x, y, z] = ((at - min) * cells).to_array().map(|at| spread_bits((at as u32).min((1 << CURVE_BITS) - 1)));
        x | y << 1 | z << 2
    };
    let mut keyed: Vec<(u32, u32)> = corners.iter().map(|corners| key(middle(corners))).zip(0..).collect();
    keyed.par_sort_unstable();
    keyed.into_iter().map(|(_, triangle)| triangle).collect()
}

/// Bits of each coordinate of a place on the curve: three of them are a key.
const CURVE_BITS: u32 = 10;

/// The ten bits of a number, two zeros between each and the next.
fn spread_bits(number: u32) -> u32 {
    let spread = (number | number << 16) & 0x0300_00ff;
    let spread = (spread | spread << 8) & 0x0300_f00f;
    let spread = (spread | spread << 4) & 0x030c_30c3;
    (spread | spread << 2) & 0x0924_9249
}

/// The slab test, against boxes grown by its own rounding.
struct Slab {
    ray: Ray,
    inverse: DVec3,
    /// Axes that the ray runs down.
    backwards: BVec3,
    pad: f64,
}

impl Slab {
    /// Prepares the ray for boxes within `reach` of the origin. Its own end may be at infinity, where no box is.
    fn new(ray: &Ray, reach: f64) -> Self {
        let size = ray.origin.abs().max_element().max(reach);
        let inverse = ray.way.recip();
        Self { ray: *ray, inverse, backwards: inverse.cmplt(DVec3::ZERO), pad: 16.0 * f64::EPSILON * size }
    }

    fn meets(&self, node: &BvhNode) -> bool {
        let min = (DVec3::from_array(node.mins().to_array()) - self.pad - self.ray.origin) * self.inverse;
        let max = (DVec3::from_array(node.maxs().to_array()) + self.pad - self.ray.origin) * self.inverse;
        let (near, far) = (DVec3::select(self.backwards, max, min), DVec3::select(self.backwards, min, max));
        // These comparisons leave out a NaN, which is 0 times infinity: a ray in the face of a box.
        let later = |enter: f64, near: f64| if near > enter { near } else { enter };
        let sooner = |leave: f64, far: f64| if far < leave { far } else { leave };
        let enter = later(later(later(self.ray.start, near.x), near.y), near.z);
        let leave = sooner(sooner(sooner(self.ray.end, far.x), far.y), far.z);
        enter <= leave * (1.0 + 1e-12)
    }
}

/// Crossing of the ray's line with a triangle. Corners are sheared so that the ray is the third axis [Woop 2013]. An edge's
/// sign comes from its own two corners. An edge that the line meets counts as slightly beside the line, the same way for
/// both its triangles.
fn crossing(ray: &Ray, [x, y, z]: [usize; 3], corners: &[DVec3; 3]) -> Option<f64> {
    let [a, b, c] = corners.map(|corner| {
        let local = corner - ray.origin;
        let along = local[z] / ray.way[z];
        [local[x] - ray.way[x] * along, local[y] - ray.way[y] * along, along]
    });
    let edge = |p: [f64; 3], q: [f64; 3]| {
        let value = p[0] * q[1] - p[1] * q[0];
        let tie = if q[1] == p[1] { p[0] - q[0] } else { q[1] - p[1] };
        (value, if value == 0.0 { tie } else { value })
    };
    let sides = [edge(b, c), edge(c, a)];
    let agree = |side: f64, other: f64| (side > 0.0 && other > 0.0) || (side < 0.0 && other < 0.0);
    if !agree(sides[0].1, sides[1].1) {
        return None; // most triangles end here
    }
    let last = edge(a, b);
    let area = sides[0].0 + sides[1].0 + last.0;
    (agree(sides[0].1, last.1) && area != 0.0).then(|| (sides[0].0 * a[2] + sides[1].0 * b[2] + last.0 * c[2]) / area)
}

/// The axes of a ray's shear: two across, and the one that it runs along most.
fn axes(way: DVec3) -> [usize; 3] {
    let size = way.abs();
    let z = if size.x >= size.y && size.x >= size.z { 0 } else { usize::from(size.z > size.y) + 1 };
    [(z + 1) % 3, (z + 2) % 3, z]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fan_is_crossed_once_wherever_a_ray_meets_it() {
        let rim = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
        let fan = Triangles::new((0..4).map(|k| [DVec3::ZERO, rim[k], rim[(k + 1) % 4]]).collect());
        for (x, y, expected) in [(0.0, 0.0, 1), (0.3, 0.0, 1), (0.0, -0.2, 1), (0.2, 0.3, 1), (0.7, 0.7, 0)] {
            let mut met = Vec::new();
            let ray = |end| Ray { origin: DVec3::new(x, y, 4.0), way: DVec3::NEG_Z, start: 0.0, end };
            fan.crossings(&ray(9.0), |_, t| met.push(t));
            assert_eq!(met, vec![4.0; expected], "{x} {y}");
            fan.crossings(&ray(3.9), |_, _| panic!("before its end"));
        }
    }

    #[test]
    fn boxes_in_parts_are_met_as_they_are_in_one() {
        let mut random = fastrand::Rng::with_seed(2);
        let mut place = || DVec3::from_array([(); 3].map(|()| random.f64()));
        let boxes: Vec<[DVec3; 2]> = (0..3 * MOST_IN_PART).map(|_| place()).map(|at| [at, at + 0.01]).collect();
        let all = Boxes::new(boxes.iter().copied());
        assert_eq!(all.parts.len(), 4);
        for _ in 0..4 {
            let (origin, way) = (2.0 * place() - 0.5, place() - 0.5);
            let ray = Ray { origin, way, start: -9.0, end: 9.0 };
            let mut met = Vec::new();
            let looked_at = all.met(&ray, |index| met.push(index as usize));
            met.sort_unstable();
            let alone = |index: &usize| {
                let mut is_met = false;
                Boxes::new(boxes[*index..=*index].iter().copied()).met(&ray, |_| is_met = true);
                is_met
            };
            assert_eq!(met, (0..boxes.len()).filter(alone).collect::<Vec<_>>());
            assert!(looked_at < 100 + 60 * met.len(), "{looked_at} for {}", met.len());
        }
    }

    /// Groups change which triangles a ray looks at, never which it crosses.
    #[test]
    fn triangles_in_groups_are_crossed_as_each_alone() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut place = || DVec3::from_array([(); 3].map(|()| random.f64()));
        let small = |at: DVec3, a: DVec3, b: DVec3| [at, at + 0.04 * (a - 0.5), at + 0.04 * (b - 0.5)];
        let corners: Vec<[DVec3; 3]> =
            (0..3 * TRIANGLES_PER_GROUPED).map(|_| small(place(), place(), place())).collect();
        let all = Triangles::new(corners.clone());
        assert_eq!(all.group, 3);
        let mut crossed = 0;
        for _ in 0..200 {
            let (origin, way) = (2.0 * place() - 0.5, place() - 0.5);
            let ray = Ray { origin, way, start: -9.0, end: 9.0 };
            let mut met = Vec::new();
            all.crossings(&ray, |triangle, t| met.push((triangle, t)));
            met.sort_by_key(|(triangle, _)| *triangle);
            let axes = axes(way);
            let alone = |(triangle, corners)| Some((triangle, crossing(&ray, axes, corners)?));
            let expected: Vec<(u32, f64)> = (0..).zip(&corners).filter_map(alone).collect();
            assert_eq!(met, expected);
            crossed += met.len();
            let looked_at = all.boxes.met(&ray, |_| {});
            assert!(20 * looked_at < corners.len() / all.group, "{looked_at}");
        }
        assert!(crossed > 100, "{crossed}");
    }

    #[test]
    fn a_ray_without_end_looks_at_few_triangles() {
        let place = |k: u32| DVec3::new(f64::from(k % 64), f64::from(k / 64), 0.0);
        let triangles = (0..4096).map(|k| [place(k), place(k) + 0.5 * DVec3::X, place(k) + 0.5 * DVec3::Y]).collect();
        let grid = Triangles::new(triangles);
        for end in [9.0, f64::MAX, f64::INFINITY] {
            let ray = Ray { origin: DVec3::new(5.1, 7.1, 4.0), way: DVec3::NEG_Z, start: 0.0, end };
            let looked_at = grid.boxes.met(&ray, |_| {});
            assert!(looked_at < 60, "{looked_at} for an end at {end}");
        }
    }
}
