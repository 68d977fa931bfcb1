//! Verifiers: is a value valid within so many bits? Pure; each knows a strict tier and the specification's, and never
//! another picture.

pub mod cube;
pub mod environment;
pub mod flat;

use std::cmp::Ordering;

use super::bench::{Encoding, GlCompare, GlStencilOp};

/// Grade of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Grade {
    /// Within the strict tier.
    Good,
    /// Only within what the specification allows.
    Allowed,
    Wrong,
}

/// By a distance and the bounds of the two tiers.
pub fn within(distance: f64, strict: f64, allowed: f64) -> Grade {
    match distance.abs() {
        distance if distance <= strict => Grade::Good,
        distance if distance <= allowed => Grade::Allowed,
        _ => Grade::Wrong,
    }
}

/// Many values' grades, and the worst distance among them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GradeTally {
    pub good: usize,
    pub allowed: usize,
    pub wrong: usize,
    pub worst: f64,
    /// The first that is wrong: how many came before it, and its distance.
    pub first_wrong: Option<(usize, f64)>,
}

impl GradeTally {
    pub fn add(&mut self, grade: Grade, distance: f64) {
        if grade == Grade::Wrong && self.first_wrong.is_none() {
            self.first_wrong = Some((self.count(), distance));
        }
        match grade {
            Grade::Good => self.good += 1,
            Grade::Allowed => self.allowed += 1,
            Grade::Wrong => self.wrong += 1,
        }
        let distance = distance.abs();
        if distance > self.worst || distance.is_nan() {
            self.worst = distance;
        }
    }

    pub fn count(&self) -> usize {
        self.good + self.allowed + self.wrong
    }
}

/// Distance within which reference and texel may count as equal (2^-16: a reference of 16 bits).
pub const NEAR_TIE: f64 = 1.0 / 65536.0;

/// Tests whether the eight functions' results, in [`GlCompare::ALL`]'s order, are those of one order of `reference`
/// against `stored`, and of one that is possible: the true one, or any within `error`.
pub fn comparisons(results: [f32; 8], reference: f64, stored: f64, error: f64) -> Grade {
    let explains = |order: Ordering| {
        GlCompare::ALL
            .into_iter()
            .zip(results)
            .all(|(compare, result)| result == f32::from(u8::from(compare.holds(order))))
    };
    let truth = reference.total_cmp(&stored);
    if explains(truth) {
        return Grade::Good;
    }
    let near_tie = error > 0.0 && (reference - stored).abs() <= error;
    if near_tie && [Ordering::Less, Ordering::Equal, Ordering::Greater].into_iter().any(explains) {
        Grade::Allowed
    } else {
        Grade::Wrong
    }
}

/// Bits of a filtered comparison's result, and of its sub-texel position: strictly, and at least.
const RESULT_BITS: i32 = 5;
const POSITION_BITS: [i32; 2] = [7, 4];

/// A comparison filtered over 2x2 texels: `passes` at (0,0), (1,0), (0,1), (1,1), weights `alpha` along x, `beta`
/// along y. Strictly the bilinear result. "Proportional to the number of comparison passes" [GL 4.6, 8.23.1] also
/// allows the nearest texel alone, the mean of four, and what lies between these; not a depth that was filtered first.
pub fn filtered(value: f64, passes: [bool; 4], weights: [f64; 2]) -> Grade {
    filtered_of(value, passes.map(|pass| f64::from(u8::from(pass))), weights)
}

/// The same of comparisons that may be a mean themselves: the fourth texel of three at a cube's corner.
pub fn filtered_of(value: f64, texels: [f64; 4], weights: [f64; 2]) -> Grade {
    let [strict, least] = POSITION_BITS.map(|bits| f64::from(-bits).exp2());
    let good = range(positions(weights, strict).map(|[alpha, beta]| bilinear(texels, alpha, beta)));
    let nearest = positions(weights, least).map(|[alpha, beta]| bilinear(texels, alpha.round(), beta.round()));
    let near = positions(weights, least).map(|[alpha, beta]| bilinear(texels, alpha, beta));
    let [low, high] = [range(nearest), range(near)].into_iter().fold([texels.iter().sum::<f64>() / 4.0; 2], join);
    // Values written as 8 bits are read as floats: 2^-9 more.
    let error = f64::from(-RESULT_BITS).exp2() + 1.0 / 512.0;
    let inside = |[low, high]: [f64; 2]| (low - error..=high + error).contains(&value);
    match () {
        // If all agree, weights do not matter.
        () if texels.iter().all(|texel| *texel == texels[0]) => within(value - texels[0], 1.0 / 512.0, 1.0 / 512.0),
        () if inside(good) => Grade::Good,
        () if inside([low, high]) => Grade::Allowed,
        () => Grade::Wrong,
    }
}

/// The corners of where a position may be: a bilinear result is least and greatest there.
fn positions(weights: [f64; 2], slack: f64) -> [[f64; 2]; 4] {
    let [alphas, betas] = weights.map(|weight| [-slack, slack].map(|change| (weight + change).clamp(0.0, 1.0)));
    [[alphas[0], betas[0]], [alphas[1], betas[0]], [alphas[0], betas[1]], [alphas[1], betas[1]]]
}

fn range(values: [f64; 4]) -> [f64; 2] {
    values.into_iter().map(|value| [value; 2]).fold([f64::INFINITY, f64::NEG_INFINITY], join)
}

fn join(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Texels at (0,0), (1,0), (0,1), (1,1).
pub fn bilinear(texels: [f64; 4], alpha: f64, beta: f64) -> f64 {
    let row = |left: f64, right: f64| left * (1.0 - alpha) + right * alpha;
    row(texels[0], texels[1]) * (1.0 - beta) + row(texels[2], texels[3]) * beta
}

/// A stored depth of a clamped `depth`: strictly the nearest code (a float: the nearest float), else one code off
/// [GL 4.6, 2.3.5.2: one of the two nearest, the nearest preferred; 2.3.4: arithmetic to 1 part in 10^5].
pub fn depth_code(stored: f64, depth: f64, encoding: Encoding) -> Grade {
    let depth = depth.clamp(0.0, 1.0);
    if depth == 0.0 || depth == 1.0 {
        return within(stored - depth, 0.0, 0.0);
    }
    let step = encoding.step(depth);
    // Small floats have finer steps than a window transform in f32 can keep.
    let least_step = if encoding.float { step.max(encoding.step(0.75)) } else { step };
    within(stored - depth, step * (0.5 + 1e-6), least_step * (1.5 + 1e-6))
}

/// The depth of a plane at a pixel: strictly to f32's rounding of values in [0, 1] and a code; else where the plane
/// is found anywhere within one sub-pixel of the centre. `slope`: of window depth, a pixel along x and along y.
pub fn plane_depth(error: f64, slope: [f64; 2], subpixel_bits: u32, encoding: Encoding) -> Grade {
    let steep = slope[0].abs() + slope[1].abs();
    let code = encoding.step(0.75);
    let strict = f64::from(-22).exp2() * (1.0 + 2.0 * steep) + code;
    let subpixel = f64::from(-(subpixel_bits as i32)).exp2();
    within(error, strict, strict + steep * subpixel)
}

/// Polygon offset's m against the slopes: between the larger slope and the length of both [GL 4.6, 14.6.5], strictly to
/// a thousandth, else to a tenth (piglit's bound for coarse slopes).
pub fn offset_slope(m: f64, slope: [f64; 2]) -> Grade {
    let [low, high] = [slope[0].abs().max(slope[1].abs()), slope[0].hypot(slope[1])];
    match () {
        () if m >= low * 0.999 && m <= high * 1.001 => Grade::Good,
        () if m >= low * 0.9 && m <= high * 1.1 => Grade::Allowed,
        () => Grade::Wrong,
    }
}

/// Polygon offset's r in steps of the format: strictly the least resolvable difference; up to twice that, as piglit's
/// polygon-offset allows.
pub fn offset_unit(steps: f64) -> Grade {
    match () {
        () if (0.99..=1.01).contains(&steps) => Grade::Good,
        () if (0.99..=2.0).contains(&steps) => Grade::Allowed,
        () => Grade::Wrong,
    }
}

/// An offset of `due` units that moved a flat surface by so many: to half a unit, or to a code, of which a unit has
/// 1 / `step`. That units add up to a code is GL-O1's question.
pub fn offset_moves(units: f64, due: f64, step: f64) -> Grade {
    let bound = (step * (1.0 + 1e-6)).clamp(0.5, 1.01);
    within(units - due, bound, bound)
}

/// The 8-bit code of a float: strictly the nearest, else one of the two nearest [GL 4.6, 2.3.5.2].
pub fn unorm8(code: u8, value: f64) -> Grade {
    within(f64::from(code) - value.clamp(0.0, 1.0) * 255.0, 0.5 + 1e-4, 1.0 + 1e-4)
}

/// Value of an 8-bit stencil buffer after `op` [GL 4.6, 17.3.3]: saturation comes before the write mask, and the reference
/// is clamped.
pub fn stencil(op: GlStencilOp, old: u8, reference: i32, write_mask: u32) -> u8 {
    let new = match op {
        GlStencilOp::Keep => old,
        GlStencilOp::Zero => 0,
        GlStencilOp::Replace => reference.clamp(0, 255) as u8,
        GlStencilOp::Increment => old.saturating_add(1),
        GlStencilOp::IncrementWrap => old.wrapping_add(1),
        GlStencilOp::Decrement => old.saturating_sub(1),
        GlStencilOp::DecrementWrap => old.wrapping_sub(1),
        GlStencilOp::Invert => !old,
    };
    let mask = (write_mask & 0xFF) as u8;
    (old & !mask) | (new & mask)
}

/// Tests whether a fragment passes the stencil test: the clamped reference on the left.
pub fn stencil_passes(compare: GlCompare, reference: i32, stored: u8, read_mask: u32) -> bool {
    let mask = (read_mask & 0xFF) as u8;
    compare.holds((reference.clamp(0, 255) as u8 & mask).cmp(&(stored & mask)))
}

/// Tests whether a triangle covers a pixel's centre; `None` within `band` pixels of an edge's line, where the raster may
/// decide either way. Corners in pixels, of either winding.
pub fn covers(corners: [[f64; 2]; 3], center: [f64; 2], band: f64) -> Option<bool> {
    let distances = [0, 1, 2].map(|index| {
        let [from, to] = [corners[index], corners[(index + 1) % 3]];
        let edge = [to[0] - from[0], to[1] - from[1]];
        let across = edge[0] * (center[1] - from[1]) - edge[1] * (center[0] - from[0]);
        across / edge[0].hypot(edge[1])
    });
    let [low, high] =
        [distances.iter().copied().fold(f64::MAX, f64::min), distances.iter().copied().fold(f64::MIN, f64::max)];
    match () {
        () if low > band || high < -band => Some(true),
        // Surely outside of one edge of each winding that the triangle may have.
        () if low < -band && high > band => Some(false),
        () => None,
    }
}

#[cfg(test)]
mod tests;
