//! Functions that are linear in the window, by which a triangle is rasterised in homogeneous coordinates in f64
//! [GL 4.6, 13.7, 14.6.1].
//!
//! Weights b of the corners at a pixel solve sum b (x, y, w) = (X, Y, 1). Each is linear in the window, and so is what clips:
//! no polygon has to be cut. sum b is 1/w of the fragment.

/// Rounding of a driver's f32 arithmetic: eight roundings.
pub const EPSILON: f64 = 1.0 / (1 << 20) as f64;
/// Width of the strip along an edge where a pixel is not judged, in pixels: vertices are snapped to 2^-8.
pub const BAND: f64 = 3.0 / 256.0;

/// A function that is linear in the window, and the sum of the sizes of its terms.
#[derive(Clone, Copy, Debug, Default)]
pub struct Linear {
    pub terms: [f64; 3],
    pub sizes: [f64; 3],
}

impl Linear {
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.terms[0] * x + self.terms[1] * y + self.terms[2]
    }

    pub fn size_at(&self, [x, y]: [f64; 2]) -> f64 {
        self.sizes[0] * x.abs() + self.sizes[1] * y.abs() + self.sizes[2]
    }

    /// A sum of three with factors.
    pub fn sum(weights: &[Self; 3], factors: [f64; 3]) -> Self {
        let mut sum = Self::default();
        for (weight, factor) in weights.iter().zip(factors) {
            for part in 0..3 {
                sum.terms[part] += weight.terms[part] * factor;
                sum.sizes[part] += weight.sizes[part] * factor.abs();
            }
        }
        sum
    }
}

/// The weights of three corners.
pub struct Weights {
    pub of: [Linear; 3],
    /// Twice the signed area, times the corners' w.
    pub area: f64,
    /// The sum of the sizes of the area's terms.
    pub area_size: f64,
}

impl Weights {
    /// Weights of corners (x w, y w, w), x and y in pixels.
    pub fn new(window: [[f64; 3]; 3]) -> Self {
        let cross = |a: [f64; 3], b: [f64; 3]| {
            let pairs = [[1, 2], [2, 0], [0, 1]];
            let terms = pairs.map(|[i, j]| a[i] * b[j] - a[j] * b[i]);
            let sizes = pairs.map(|[i, j]| (a[i] * b[j]).abs() + (a[j] * b[i]).abs());
            Linear { terms, sizes }
        };
        let edges = [0, 1, 2].map(|index: usize| cross(window[(index + 1) % 3], window[(index + 2) % 3]));
        let dot = |terms: [f64; 3], with: [f64; 3]| terms.iter().zip(with).map(|(a, b)| a * b).sum::<f64>();
        let area = dot(edges[0].terms, window[0]);
        let of = edges.map(|edge| Linear {
            terms: edge.terms.map(|term| term / area),
            sizes: edge.sizes.map(|size| size / area.abs()),
        });
        Self { of, area, area_size: dot(edges[0].sizes, window[0].map(f64::abs)) }
    }

    /// Planes that are at least 0 within the triangle, and between near and far unless depth is clamped.
    pub fn planes(&self, clip: &[[f64; 4]; 3], depth_clamp: bool) -> Vec<Linear> {
        let mut planes = self.of.to_vec();
        if !depth_clamp {
            for side in [1.0, -1.0] {
                planes.push(Linear::sum(&self.of, clip.map(|[_, _, z, w]| w + side * z)));
            }
        }
        planes
    }
}

/// Tests whether corners in clip space all lie in the view.
pub fn is_inside(clip: &[[f64; 4]; 3]) -> bool {
    clip.iter().all(|[x, y, z, w]| *w > 0.0 && [x, y, z].iter().all(|part| part.abs() <= *w))
}

/// Factor of the roundings of a triangle with these corners: those that are clipped have been interpolated.
pub fn rounding_factor(clip: &[[f64; 4]; 3]) -> f64 {
    let sizes = clip.map(|corner| corner.map(f64::abs).into_iter().fold(0.0, f64::max));
    let ratio = sizes.into_iter().fold(0.0, f64::max) / sizes.into_iter().fold(f64::MAX, f64::min);
    if is_inside(clip) { 1.0 } else { 2.0 + ratio.min(1e6) }
}

/// Answer whether a pixel has a fragment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Covered {
    Yes,
    No,
    Unsure,
}

/// Tests a place within a strip of `band` pixels along each plane, which are known to `rounding`.
pub fn covers(planes: &[Linear], at: [f64; 2], band: f64, rounding: f64) -> Covered {
    let mut covered = Covered::Yes;
    for plane in planes {
        let value = plane.at(at);
        let slack = band * plane.terms[0].hypot(plane.terms[1]) + rounding * plane.size_at(at);
        if value < -slack {
            return Covered::No;
        }
        if value <= slack || !value.is_finite() {
            covered = Covered::Unsure;
        }
    }
    covered
}

/// Tests a place within an area where there may be fragments that are not known.
pub fn covers_unknown([low, high]: [[f64; 2]; 2], at: [f64; 2]) -> Covered {
    if (0..2).all(|part| (low[part]..=high[part]).contains(&at[part])) { Covered::Unsure } else { Covered::No }
}
