//! Exact signs of sums and of determinants of floating-point numbers [Shewchuk 1997].

use glam::DVec3;
use robust::{Coord3D, orient3d};

/// Side of the plane of `corners` (f32 values, exactly converted) on which `point` lies: 1 if they run counter-clockwise
/// seen from it, -1 if clockwise, 0 exactly on the plane. Never wrong, barring underflow of products below 10⁻³⁰⁰.
pub fn side_of_point(corners: &[DVec3; 3], point: DVec3) -> i8 {
    let [a, b, c, p] = [corners[0], corners[1], corners[2], point].map(|v| Coord3D { x: v.x, y: v.y, z: v.z });
    // Positive where the corners run clockwise seen from p.
    sign(-orient3d(a, b, c, p))
}

/// The same for a point infinitely far away in `direction`: the exact sign of the dot product of `direction` and the
/// normal by the corners' order. The corners are f32 values.
pub fn side_of_direction(corners: &[DVec3; 3], direction: DVec3) -> i8 {
    // normal = a x b + b x c + c x a, whose products of two f32 are exact in f64.
    let mut sum = Expansion::default();
    for k in 0..3 {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        for i in 0..3 {
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            sum.add_product(p[j] * q[l], direction[i]);
            sum.add_product(-(p[l] * q[j]), direction[i]);
        }
    }
    sum.sign()
}

/// Tests whether the three corners lie on one line, exactly. The corners are f32 values.
pub fn are_collinear(corners: &[DVec3; 3]) -> bool {
    [DVec3::X, DVec3::Y, DVec3::Z].into_iter().all(|axis| side_of_direction(corners, axis) == 0)
}

fn sign(value: f64) -> i8 {
    i8::from(value > 0.0) - i8::from(value < 0.0)
}

/// A sum of doubles that do not overlap, smallest first: exact.
#[derive(Default)]
struct Expansion {
    parts: Vec<f64>,
}

impl Expansion {
    fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        self.add(a.mul_add(b, -product));
        self.add(product);
    }

    /// Shewchuk's grow-expansion.
    fn add(&mut self, value: f64) {
        let mut carry = value;
        for part in &mut self.parts {
            let sum = carry + *part;
            let rounded = sum - carry;
            *part = (carry - (sum - rounded)) + (*part - rounded);
            carry = sum;
        }
        self.parts.push(carry);
    }

    /// The largest part outweighs all smaller ones.
    fn sign(&self) -> i8 {
        self.parts.iter().rev().find(|part| **part != 0.0).map_or(0, |part| sign(*part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn f32s(corners: [[f32; 3]; 3]) -> [DVec3; 3] {
        corners.map(|corner| DVec3::from_array(corner.map(f64::from)))
    }

    #[test]
    fn sides_are_told_apart_by_one_ulp_and_reversed_with_the_order() {
        let corners = f32s([[0.1, 0.7, 0.3], [1.1, 0.2, -0.4], [0.3, 1.9, 0.8]]);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let above = a + normal;
        assert_eq!(side_of_point(&corners, above), 1);
        assert_eq!(side_of_point(&[b, a, c], above), -1);
        assert_eq!(side_of_direction(&corners, normal), 1);
        assert_eq!(side_of_direction(&corners, b - a), 0);
        for axis in 0..3 {
            let mut near = a;
            near[axis] = f64::from_bits(near[axis].to_bits() + 1);
            let expected = sign(normal[axis]);
            assert_eq!(side_of_point(&corners, near), expected, "{axis}");
        }
    }

    #[test]
    fn a_direction_in_the_plane_is_neither_side_however_far_the_corners() {
        let corners = f32s([[1e7, 3.0, 1e-7], [-0.3, 1e6, 7.0], [0.1, -5e5, 1e7]]);
        let [a, b, c] = corners;
        // Exact in f64: differences of these corners need at most 53 bits.
        for (direction, expected) in [(b - a, 0), (c - b, 0)] {
            let exact = (direction + a == b || direction + b == c) && !are_collinear(&corners);
            if exact {
                assert_eq!(side_of_direction(&corners, direction), expected);
            }
        }
        assert!(are_collinear(&f32s([[0.0; 3], [1.0, 2.0, 3.0], [-2.0, -4.0, -6.0]])));
        assert!(!are_collinear(&f32s([[0.0; 3], [1.0, 2.0, 3.0], [-2.0, -4.0, -5.999_999_5]])));
    }
}
