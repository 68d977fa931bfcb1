//! Tests of what a tube around a segment meets.

use super::*;

/// Random numbers in [-1, 1], the same each time.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }
}

fn visited(bvh: &Bvh, slab: &Slab, end: f64) -> Vec<u32> {
    let mut found = Vec::new();
    bvh.traverse(|node| {
        if !slab.meets(node, end) {
            return TraversalAction::Prune;
        }
        found.extend(node.leaf_data());
        TraversalAction::Continue
    });
    found
}

#[test]
fn no_box_in_a_tube_is_missed_and_few_others_are_met() {
    let mut random = Random(5);
    let corners: Vec<[DVec3; 2]> = (0..500)
        .map(|_| {
            let (middle, half) = (3.0 * random.vector(), 0.2 * random.vector().abs());
            [middle - half, middle + half]
        })
        .collect();
    let vector = |point: DVec3| Vector::from_array(point.to_array());
    let boxes: Vec<Aabb> = corners.iter().map(|[min, max]| Aabb::new(vector(*min), vector(*max))).collect();
    let bvh = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
    let (mut met, mut needed) = (0, 0);
    for _ in 0..200 {
        let (origin, direction) = (3.0 * random.vector(), 6.0 * random.vector());
        let (radius, end) = (2.0 * random.next().abs(), 1.0 + 0.1 * random.next().abs());
        let segment = Segment { origin, direction, start: 0.0, end };
        let found = visited(&bvh, &Slab::new(&segment, 0.0).around(Tube { radius, tapers: true }), end);
        met += found.len();
        for (index, [min, max]) in (0..).zip(&corners) {
            let is_in = (0..=400).any(|k| {
                let t = end * f64::from(k) / 400.0;
                let at = origin + t * direction;
                at.distance(at.clamp(*min, *max)) <= radius * t
            });
            needed += usize::from(is_in);
            assert!(!is_in || found.contains(&index), "box {index} is missed");
        }
    }
    // What is looked through is a box along the tube, at most twice as wide as the tube at a box's end.
    assert!(met < 5 * needed, "{met} of {needed}");
}

#[test]
fn what_is_far_and_huge_does_not_widen_a_tube_where_it_is_near() {
    let bounds = Aabb::new(Vector::from_array([2.0; 3]), Vector::from_array([3.0; 3]));
    let bvh = Bvh::from_leaves(BvhBuildStrategy::Binned, &[bounds]);
    let segment = Segment { origin: DVec3::ZERO, direction: DVec3::X * 1e10, start: 0.0, end: 1.0 };
    let slab = |tapers| Slab::new(&segment, 0.0).around(Tube { radius: 4e3, tapers });
    assert!(visited(&bvh, &slab(false), 1.0).len() == 1 && visited(&bvh, &slab(true), 1.0).is_empty());
}
