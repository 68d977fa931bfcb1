//! 4×4 matrices in double-double arithmetic (about 31 digits).
//!
//! There are several equal forms of the light's texture transform [HSM, Appendix A], some of which invert a projection. In
//! f64 that inverse loses as many digits as the frustum is stiff (near/far), and equal forms round to different f32 planes.
//! Here every form rounds to the same f32. Two-sum and two-product after [Dekker 1971].

use std::ops::Mul;

use glam::{DMat4, DVec4, Mat4};

/// An unevaluated sum `hi + lo` with `|lo| <= ulp(hi) / 2`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Dd {
    hi: f64,
    lo: f64,
}

impl Dd {
    const ONE: Self = Self { hi: 1.0, lo: 0.0 };

    fn two_sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        let b_part = hi - a;
        Self { hi, lo: (a - (hi - b_part)) + (b - b_part) }
    }

    fn add(self, other: Self) -> Self {
        let sum = Self::two_sum(self.hi, other.hi);
        let tail = Self::two_sum(self.lo, other.lo);
        let first = Self::two_sum(sum.hi, sum.lo + tail.hi);
        Self::two_sum(first.hi, first.lo + tail.lo)
    }

    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }

    fn mul(self, other: Self) -> Self {
        let hi = self.hi * other.hi;
        let error = self.hi.mul_add(other.hi, -hi);
        Self::two_sum(hi, error + (self.hi * other.lo + self.lo * other.hi))
    }

    fn div(self, other: Self) -> Self {
        let first = self.hi / other.hi;
        let rest = self.add(other.mul(Self { hi: first, lo: 0.0 }).neg());
        let second = rest.hi / other.hi;
        let rest = rest.add(other.mul(Self { hi: second, lo: 0.0 }).neg());
        Self::two_sum(first, second).add(Self { hi: rest.hi / other.hi, lo: 0.0 })
    }
}

/// A 4×4 matrix, rows first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DdMat4([[Dd; 4]; 4]);

impl From<DMat4> for DdMat4 {
    fn from(m: DMat4) -> Self {
        let columns = m.to_cols_array_2d();
        Self(std::array::from_fn(|row| std::array::from_fn(|column| Dd { hi: columns[column][row], lo: 0.0 })))
    }
}

impl Mul for DdMat4 {
    type Output = Self;

    fn mul(self, right: Self) -> Self {
        Self(std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                (0..4).fold(Dd::default(), |sum, k| sum.add(self.0[row][k].mul(right.0[k][column])))
            })
        }))
    }
}

impl DdMat4 {
    pub const IDENTITY: Self = {
        let zero = Dd { hi: 0.0, lo: 0.0 };
        let mut m = [[zero; 4]; 4];
        m[0][0] = Dd::ONE;
        m[1][1] = Dd::ONE;
        m[2][2] = Dd::ONE;
        m[3][3] = Dd::ONE;
        Self(m)
    };

    /// The inverse by Gauss-Jordan elimination with row pivoting; `None` where a pivot is zero or not finite.
    pub fn inverse(&self) -> Option<Self> {
        let mut left = self.0;
        let mut right = Self::IDENTITY.0;
        for column in 0..4 {
            let pivot = (column..4).max_by(|&a, &b| left[a][column].hi.abs().total_cmp(&left[b][column].hi.abs()))?;
            left.swap(column, pivot);
            right.swap(column, pivot);
            let scale = left[column][column];
            if scale.hi == 0.0 || !scale.hi.is_finite() {
                return None;
            }
            for k in 0..4 {
                left[column][k] = left[column][k].div(scale);
                right[column][k] = right[column][k].div(scale);
            }
            for row in (0..4).filter(|&row| row != column) {
                let factor = left[row][column].neg();
                for k in 0..4 {
                    left[row][k] = left[row][k].add(factor.mul(left[column][k]));
                    right[row][k] = right[row][k].add(factor.mul(right[column][k]));
                }
            }
        }
        Some(Self(right))
    }

    /// Rounded to f64. What cancellation left of an exact zero (below 2⁻⁹⁰ of its row's largest entry) is zero.
    pub fn to_f64(self) -> DMat4 {
        let rows = self.0.map(|row| {
            let largest = row.iter().fold(0.0_f64, |m, entry| m.max(entry.hi.abs()));
            DVec4::from_array(row.map(|e| if e.hi.abs() < largest * 2.0_f64.powi(-90) { 0.0 } else { e.hi }))
        });
        DMat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
    }

    /// Rounded to f32, for GL.
    pub fn to_f32(self) -> Mat4 {
        self.to_f64().as_mat4()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::spaces::{perspective, view_from_world};
    use glam::DVec3;

    #[test]
    fn inverse_of_a_stiff_frustum_is_exact_beyond_f64() {
        let light = perspective(0.01_f64.to_radians(), 1.0, 1e-4, 1e7)
            * view_from_world(DVec3::new(1e4, -3.0, 7.0), DVec3::new(0.1, 0.2, 0.3), DVec3::Y);
        let light = DdMat4::from(light);
        let inverse = light.inverse().unwrap();
        let product = light * inverse;
        for row in 0..4 {
            for column in 0..4 {
                let expected = if row == column { Dd::ONE } else { Dd::default() };
                let error = product.0[row][column].add(expected.neg()).hi.abs();
                assert!(error < 1e-15, "{row},{column}: {error:e}");
            }
        }
    }

    #[test]
    fn singular_matrices_have_no_inverse() {
        assert!(DdMat4::from(DMat4::from_cols(DVec4::X, DVec4::X, DVec4::Z, DVec4::W)).inverse().is_none());
        assert!(DdMat4::from(DMat4::from_cols(DVec4::X, DVec4::NAN, DVec4::Z, DVec4::W)).inverse().is_none());
    }

    #[test]
    fn thirds_sum_to_one() {
        let third = Dd::ONE.div(Dd { hi: 3.0, lo: 0.0 });
        let sum = third.add(third).add(third).add(Dd::ONE.neg());
        assert!(sum.hi.abs() < 1e-31);
    }
}
