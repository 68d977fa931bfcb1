//! Coordinates of every kind: within a texture, at the middles and edges of texels, far outside; near a cube's edges; planes.

use super::lookups::{Class, LookUp, LookUpKind, OFFSET};
use super::model::{Shape, Texture};
use crate::conformance::bench::Sampling;
use crate::conformance::random::Random;

/// Numbers beside the coordinates: a level, a bias, gradients.
pub fn by(random: &mut Random, texture: &Texture, sampling: &Sampling, kind: LookUpKind) -> [f32; 4] {
    let levels = texture.levels.len() as f32;
    match kind.function {
        LookUp::Size => {
            let [base, most] = sampling.levels.unwrap_or([0, 1000]).map(|level| level as usize);
            [random.below(most.min(texture.levels.len() - 1) - base + 1) as f32; 4]
        }
        LookUp::Grad => {
            let size = texture.levels[0].size[0].max(texture.levels[0].size[1]) as f32;
            let texels = random.between(-2.0, levels + 1.0).exp2();
            let unit = if kind.shape == Shape::Rectangle { 1.0 } else { size };
            let mut slope = || random.between(-1.0, 1.0) * texels / unit;
            [slope(), slope(), slope(), slope()]
        }
        _ if random.chance(0.3) => [random.between(-1.0, levels + 1.0).round(); 4],
        _ => [random.between(-2.0, levels + 1.0); 4],
    }
}

/// A reference near to some texel's depth, or anywhere.
fn reference(random: &mut Random, texture: &Texture) -> f32 {
    if !texture.format.is_depth() {
        return random.unit();
    }
    let texels = &texture.levels[0].texels;
    let depth = texels[random.below(texels.len())][0];
    let step = random.pick(&[-20.0_f64, -18.0, -17.0, -15.0, -13.0, -11.0, -9.0, -6.0]).exp2() * 1.5;
    match random.below(12) {
        0 => random.between(-3.0, 4.0),
        1 => random.unit() * 100.0,
        2 => random.pick(&[0.0, 1.0, 0.5, -0.0]),
        3..=5 => random.unit(),
        6 => depth as f32,
        7..=9 => (depth + step) as f32,
        _ => (depth - step) as f32,
    }
}

/// A coordinate along one axis of so many texels, in parts of the axis.
fn coordinate(random: &mut Random, texels: usize) -> f32 {
    let size = texels as f32;
    let texel = random.below(texels) as f32;
    match random.below(16) {
        0..=5 => random.unit(),
        6..=7 => random.between(-0.6, 1.6),
        8..=9 => (texel + 0.5) / size,
        10 => (texel + random.pick(&[0.03125, 0.96875])) / size,
        11 => random.pick(&[0.0, 1.0, -0.0]) + random.pick(&[-0.25, 0.25, 0.5, -0.5, 1.5]) / size,
        12 => random.between(-8.0, 8.0),
        13 => (random.between(-100.0, 100.0).floor() * size + texel + 0.5) / size,
        14 => random.between(-2000.0, 2000.0).floor() + (texel + 0.25) / size,
        _ => random.between(-1e4, 1e4),
    }
}

/// A direction: any, near an edge or a corner of the cube, along an axis; of any length.
fn direction(random: &mut Random) -> [f32; 3] {
    let mut at = [(); 3].map(|()| random.between(-1.0, 1.0));
    match random.below(6) {
        0 => {
            let [first, second] = [random.below(3), random.below(3)];
            at[first] = at[second] * random.pick(&[1.0, -1.0, 1.0 - 1.0 / 64.0, 1.0 / 64.0 - 1.0]);
        }
        1 => at = at.map(|part| if part < 0.0 { -1.0 - part / 64.0 } else { 1.0 - part / 64.0 }),
        2 => {
            at = [0.0; 3];
            at[random.below(3)] = random.pick(&[1.0, -1.0]);
        }
        _ => {}
    }
    let length = if random.chance(0.6) { 1.0 } else { random.between(-16.0, 16.0).exp2() };
    let most = at.into_iter().map(f32::abs).fold(0.0, f32::max);
    if most < 1e-3 { [length, 0.0, 0.0] } else { at.map(|part| part * length) }
}

/// Coordinates of one look-up.
pub fn place(random: &mut Random, texture: &Texture, sampling: &Sampling, kind: LookUpKind) -> [f32; 4] {
    let [base, most] = sampling.levels.unwrap_or([0, 1000]);
    let last = (most as usize).min(texture.levels.len() - 1);
    let level = base as usize + random.below(last - base as usize + 1);
    let size = texture.levels[level].size;
    if matches!(kind.function, LookUp::Fetch | LookUp::FetchOffset | LookUp::Size) {
        let axes = kind.shape.axes();
        let moved = |axis: usize| {
            if kind.function == LookUp::FetchOffset && axis < axes { OFFSET[axis] as f32 } else { 0.0 }
        };
        // With an offset that leads back into the texture.
        let at = [0, 1, 2].map(|axis| random.below(size[axis]) as f32 - moved(axis));
        return [at[0], at[1], at[2], (level - base as usize) as f32];
    }
    let layer = |random: &mut Random, layers: usize| match random.below(6) {
        0 => random.between(-4.0, layers as f32 + 4.0).round() + 0.25,
        _ => random.below(layers) as f32 + random.between(-0.4, 0.4),
    };
    let reference = reference(random, texture);
    let unit = |at: f32, axis: usize| if kind.shape == Shape::Rectangle { at * size[axis] as f32 } else { at };
    let mut at = match kind.shape {
        Shape::Cube => direction(random),
        Shape::Array => [coordinate(random, size[0]), coordinate(random, size[1]), layer(random, size[2])],
        _ => [0, 1, 2].map(|axis| unit(coordinate(random, size[axis]), axis)),
    };
    if !kind.is_projective() {
        return [at[0], at[1], at[2], reference];
    }
    let q = match random.below(8) {
        0 => random.between(-8.0, 8.0).exp2(),
        1 => -random.between(-8.0, 8.0).exp2(),
        2 => random.between(-20.0, 12.0).exp2(),
        3 => random.between(0.5, 5000.0),
        _ => random.between(0.25, 4.0) * random.pick(&[1.0, 1.0, -1.0]),
    };
    if kind.class == Class::Shadow {
        at[2] = reference;
    }
    [at[0] * q, at[1] * q, at[2] * q, q]
}

/// Coordinates at the middle of a cell, and their derivatives.
pub fn plane(
    random: &mut Random,
    texture: &Texture,
    sampling: &Sampling,
    kind: LookUpKind,
) -> ([f64; 4], [[f64; 4]; 2]) {
    let base = sampling.levels.map_or(0, |[base, _]| base) as usize;
    let size = texture.levels[base.min(texture.levels.len() - 1)].size;
    let levels = texture.levels.len() as f32;
    // Texels a pixel: magnified, minified, or longer one way than the other.
    let texels = f64::from(random.between(-2.5, levels + 0.5).exp2());
    let mut middle = place(random, texture, sampling, kind).map(f64::from);
    let mut slopes = [[0.0; 4]; 2];
    let narrow = if random.chance(0.3) { f64::from(random.between(0.05, 0.5)) } else { 1.0 };
    let turn = if random.chance(0.4) { 0.0 } else { f64::from(random.between(0.0, 6.3)) };
    let (sin, cos) = turn.sin_cos();
    let directions = [[cos, sin, 0.3 * sin], [-sin * narrow, cos * narrow, 0.3 * cos]];
    let divisor = if kind.is_projective() { middle[3] } else { 1.0 };
    if kind.shape == Shape::Cube {
        // Within the plane of a face: s and t are linear. A look-up stays on the face where the slope is small.
        let face = random.below(6);
        let (major, sign) = (face / 2, if face.is_multiple_of(2) { 1.0 } else { -1.0 });
        let texels = texels.min(size[0] as f64 / 48.0);
        let length = f64::from(random.between(-3.0, 3.0).exp2());
        let reach = 2.0 * texels / size[0] as f64;
        let spare = (0.98 - reach * 21.0).max(0.0);
        let mut axis_of = 0;
        for axis in 0..3 {
            if axis == major {
                middle[axis] = sign * length;
                continue;
            }
            middle[axis] = f64::from(random.between(-1.0, 1.0)) * spare * length;
            for (slope, direction) in slopes.iter_mut().zip(directions) {
                slope[axis] = direction[axis_of] * reach * length;
            }
            axis_of += 1;
        }
        return (middle, slopes);
    }
    for axis in 0..kind.shape.axes() {
        let unit = if kind.shape == Shape::Rectangle { 1.0 } else { size[axis] as f64 };
        for (slope, direction) in slopes.iter_mut().zip(directions) {
            slope[axis] = direction[axis] * texels / unit * divisor;
        }
        // Not too far away for a float that is followed across the surface.
        middle[axis] = (middle[axis] / divisor % 64.0) * divisor;
    }
    (middle, slopes)
}
