//! Boxes by their ends in z: bounds of all that reach behind a depth, without looking at each of them again.

use glam::DVec3;

use crate::math::Aabb;

/// Boxes in the order of their least z.
pub struct Behind {
    /// Least z of each box.
    ends: Vec<f64>,
    /// Bounds of the first 0, 1, 2 and so on.
    firsts: Vec<Bounds>,
}

/// Bounds of some boxes, and what they would be without any one of them.
#[derive(Clone, Copy)]
struct Bounds {
    all: Aabb,
    /// Box that each bound is of, by axis.
    least: [usize; 3],
    greatest: [usize; 3],
    /// Bounds by the other boxes.
    next: Aabb,
}

/// Number of no box.
const NONE: usize = usize::MAX;

impl Behind {
    pub fn new(boxes: &[Aabb]) -> Self {
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        order.sort_by(|a, b| boxes[*a].min.z.total_cmp(&boxes[*b].min.z));
        let none = Bounds { all: Aabb::EMPTY, least: [NONE; 3], greatest: [NONE; 3], next: Aabb::EMPTY };
        let mut firsts = vec![none];
        let mut last = none;
        for index in &order {
            last = last.with(*index, &boxes[*index]);
            firsts.push(last);
        }
        Self { ends: order.iter().map(|index| boxes[*index].min.z).collect(), firsts }
    }

    /// Bounds of the boxes of which some lies at `z` or below, but for box `except`.
    pub fn of(&self, z: f64, except: Option<usize>) -> Aabb {
        let Bounds { all, least, greatest, next } = self.firsts[self.ends.partition_point(|end| *end <= z)];
        let pick = |all: DVec3, of: [usize; 3], next: DVec3| {
            DVec3::from_array([0, 1, 2].map(|axis| if except == Some(of[axis]) { next[axis] } else { all[axis] }))
        };
        Aabb { min: pick(all.min, least, next.min), max: pick(all.max, greatest, next.max) }
    }
}

impl Bounds {
    fn with(mut self, index: usize, own: &Aabb) -> Self {
        for axis in 0..3 {
            if own.min[axis] < self.all.min[axis] {
                (self.next.min[axis], self.all.min[axis]) = (self.all.min[axis], own.min[axis]);
                self.least[axis] = index;
            } else {
                self.next.min[axis] = self.next.min[axis].min(own.min[axis]);
            }
            if own.max[axis] > self.all.max[axis] {
                (self.next.max[axis], self.all.max[axis]) = (self.all.max[axis], own.max[axis]);
                self.greatest[axis] = index;
            } else {
                self.next.max[axis] = self.next.max[axis].max(own.max[axis]);
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_those_of_a_look_at_each_box() {
        let mut random = fastrand::Rng::with_seed(3);
        for count in [0_usize, 1, 2, 40] {
            // Few different numbers, so that many are equal.
            let mut place = || DVec3::from_array([(); 3].map(|()| f64::from(random.i32(-4..4))));
            let boxes: Vec<Aabb> = (0..count).map(|_| Aabb::from_points([place(), place()])).collect();
            let behind = Behind::new(&boxes);
            for (z, except) in (-5..5).flat_map(|z| (0..=count).map(move |k| (f64::from(z), k.checked_sub(1)))) {
                let kept = boxes.iter().enumerate().filter(|(k, own)| Some(*k) != except && own.min.z <= z);
                let expected = kept.fold(Aabb::EMPTY, |all, (_, own)| all.union(*own));
                assert_eq!(behind.of(z, except), expected, "{count} boxes, behind {z}, without {except:?}");
            }
        }
    }
}
