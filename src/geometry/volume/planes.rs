//! Side of each triangle's plane on which a light lies: a vectorised test in f64 with an error bound over flat arrays, and
//! exact predicates for the few triangles that it leaves in doubt.

use std::ops::Range;

use glam::DVec3;

use super::LightSource;
use crate::math::exact;

/// Unit roundoff of f64.
const ROUNDOFF: f64 = 0.5 * f64::EPSILON;

/// Roundings of size [`ROUNDOFF`] in a side's value, relative to the magnitudes of its terms: 4 in a component of the
/// normal, 5 in product and sums, 1 in the light's offset, as many again in the plane's own; 32 holds them.
const ROUNDINGS: f64 = 32.0;

/// Number of triangles whose signs are checked at a time: they stay in the first-level cache.
const BLOCK: usize = 1024;

/// Each triangle's plane relative to `center`: dot((x, y, z), p - center) - offset is positive where the corners run
/// counter-clockwise seen from p. Scaled by powers of two so that the magnitudes of products in each normal's component
/// stay below 1. Triangles without area have zeros.
#[derive(Clone, Debug, Default)]
pub(super) struct Planes {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    offset: Vec<f64>,
    center: DVec3,
    /// The largest sum of a corner's coordinates' magnitudes, relative to the centre.
    reach: f64,
}

impl Planes {
    pub fn new(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Self {
        let mut planes = Self::default();
        planes.set(positions, triangles);
        planes
    }

    /// As [`Self::new`], in the same buffers.
    pub fn set(&mut self, positions: &[[f32; 3]], triangles: &[[u32; 3]]) {
        let position = |place: u32| DVec3::from_array(positions[place as usize].map(f64::from));
        self.clear();
        self.center = triangles.first().map_or(DVec3::ZERO, |triangle| position(triangle[0]));
        for array in [&mut self.x, &mut self.y, &mut self.z, &mut self.offset] {
            array.reserve_exact(triangles.len());
        }
        for triangle in triangles {
            self.push(&triangle.map(position));
        }
    }

    /// Forgets the planes: every side is then found by exact arithmetic.
    pub fn clear(&mut self) {
        [&mut self.x, &mut self.y, &mut self.z, &mut self.offset].into_iter().for_each(Vec::clear);
        self.reach = 0.0;
    }

    fn push(&mut self, corners: &[DVec3; 3]) {
        let [a, b, c] = *corners;
        let (u, v) = (b - a, c - a);
        let normal = u.cross(v);
        let magnitude = (u.abs().max_element() * v.abs().max_element()).max(f64::MIN_POSITIVE);
        let scale = power_of_two_below(0.5 / magnitude);
        let normal = normal * scale;
        // Exact arithmetic only where a normal may be nothing but rounding.
        let is_flat = normal.abs().max_element() <= ROUNDINGS * ROUNDOFF && exact::are_collinear(corners);
        let normal = if is_flat { DVec3::ZERO } else { normal };
        let local = a - self.center;
        self.x.push(normal.x);
        self.y.push(normal.y);
        self.z.push(normal.z);
        self.offset.push(normal.dot(local));
        for corner in corners {
            self.reach = self.reach.max((*corner - self.center).abs().element_sum());
        }
    }

    /// Writes the side of the triangles in `range` to the same range of `sides`: 1 where the light sees the corners run
    /// counter-clockwise, -1 clockwise, 0 if it lies in the plane or there is none. Exact. Returns how many needed exact
    /// arithmetic.
    pub fn sides(
        &self,
        corners: impl Fn(usize) -> [DVec3; 3],
        range: Range<usize>,
        source: LightSource,
        sides: &mut [i8],
    ) -> usize {
        let light = match source {
            LightSource::Point(position) => position - self.center,
            LightSource::Direction(direction) => direction,
        };
        let w = source.homogeneous().w;
        let doubt = ROUNDINGS * ROUNDOFF * (light.abs().element_sum() + w * self.reach);
        let mut exact = 0;
        let mut start = range.start;
        while start < range.end {
            let block = start..range.end.min(start + BLOCK);
            let out = &mut sides[block.clone()];
            self.estimate(block.clone(), light, w, doubt, out);
            if out.contains(&0) {
                for (side, triangle) in out.iter_mut().zip(block).filter(|(side, _)| **side == 0) {
                    exact += usize::from(!self.is_flat(triangle));
                    *side = self.exact_side(&corners(triangle), triangle, source);
                }
            }
            start += BLOCK;
        }
        exact
    }

    /// Signs of values beyond `doubt`, 0 elsewhere.
    fn estimate(&self, block: Range<usize>, light: DVec3, w: f64, doubt: f64, sides: &mut [i8]) {
        if self.x.is_empty() {
            return sides.fill(0);
        }
        let (x, y, z) = (&self.x[block.clone()], &self.y[block.clone()], &self.z[block.clone()]);
        let offset = &self.offset[block];
        for ((((side, x), y), z), offset) in sides.iter_mut().zip(x).zip(y).zip(z).zip(offset) {
            let value = x * light.x + y * light.y + z * light.z - offset * w;
            *side = i8::from(value > doubt) - i8::from(value < -doubt);
        }
    }

    fn is_flat(&self, triangle: usize) -> bool {
        [&self.x, &self.y, &self.z].iter().all(|array| array.get(triangle) == Some(&0.0))
    }

    /// The side of one triangle, whose `corners` these are. Exact.
    pub fn exact_side(&self, corners: &[DVec3; 3], triangle: usize, source: LightSource) -> i8 {
        match source {
            _ if self.is_flat(triangle) && exact::are_collinear(corners) => 0,
            LightSource::Point(position) => exact::side_of_point(corners, position),
            LightSource::Direction(direction) => exact::side_of_direction(corners, direction),
        }
    }
}

/// The greatest power of two that is at most `value`, a positive normal number.
fn power_of_two_below(value: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    f64::from_bits(value.to_bits() & EXPONENT)
}
