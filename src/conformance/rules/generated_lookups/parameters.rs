//! Parameters of textures and sampler objects: changes of one at a time, and what makes a result defined.

use super::lookups::{Class, LookUpKind, Source};
use super::model::{Shape, Texture};
use crate::conformance::bench::{GlCompare, GlMipmap, GlWrap, Sampling};
use crate::conformance::random::Random;

/// Changes numbers that a driver need not compile for.
pub fn nudge(random: &mut Random, sampling: &mut Sampling) {
    if random.chance(0.5) {
        sampling.border[random.below(4)] = random.between(-0.5, 1.5);
    }
    if sampling.lod[0] > -900.0 && random.chance(0.5) {
        sampling.lod[0] = end(random, 0.125, 3.0);
    }
    if sampling.lod[1] < 900.0 && random.chance(0.5) {
        sampling.lod[1] = end(random, 0.125, 6.0);
    }
    sampling.lod[1] = sampling.lod[1].max(sampling.lod[0]);
    if sampling.bias != 0.0 && random.chance(0.5) {
        sampling.bias = (random.between(0.1, 2.5) * 8.0).round() / 8.0;
    }
}

/// An end of the range of levels, in odd sixteenths: halfway between two levels either may be the nearest.
fn end(random: &mut Random, low: f32, high: f32) -> f32 {
    (random.between(low, high) * 8.0).floor() / 8.0 + 0.0625
}

/// Changes one parameter.
pub fn mutate(random: &mut Random, sampling: &mut Sampling) {
    const WRAPS: [GlWrap; 4] = [GlWrap::Repeat, GlWrap::MirroredRepeat, GlWrap::ClampToEdge, GlWrap::ClampToBorder];
    match random.below(10) {
        0 => sampling.linear = !sampling.linear,
        1 => sampling.magnified = Some(random.chance(0.5)),
        2 => sampling.mipmap = random.pick(&[GlMipmap::Off, GlMipmap::Nearest, GlMipmap::Linear]),
        3 | 4 => sampling.wrap[random.below(3)] = random.pick(&WRAPS),
        5 => {
            let part = random.below(4);
            match random.below(4) {
                0 | 1 => sampling.border[part] = random.between(-0.5, 1.5),
                2 => sampling.border = [(); 4].map(|()| random.unit()),
                // As scenes set it: what is outside passes, or fails.
                _ => sampling.border = [random.pick(&[0.0, 1.0]); 4],
            }
        }
        6 => sampling.compare = Some(random.pick(&GlCompare::ALL)),
        7 => sampling.lod[0] = if random.chance(0.5) { -1000.0 } else { end(random, -2.0, 3.0) },
        8 => sampling.lod[1] = if random.chance(0.5) { 1000.0 } else { end(random, 0.0, 6.0) },
        _ => sampling.bias = if random.chance(0.4) { 0.0 } else { (random.between(-2.5, 2.5) * 8.0).round() / 8.0 },
    }
    sampling.lod[1] = sampling.lod[1].max(sampling.lod[0]);
}

/// Makes parameters such that the result is defined.
pub fn fit(
    random: &mut Random,
    (sampling, own): (&mut Sampling, &mut Sampling),
    texture: &Texture,
    kind: LookUpKind,
    (seamless, again): (bool, bool),
) {
    let integer = texture.format.is_integer();
    if kind.shape == Shape::Rectangle {
        for wrap in &mut sampling.wrap {
            if matches!(wrap, GlWrap::Repeat | GlWrap::MirroredRepeat) {
                *wrap = random.pick(&[GlWrap::ClampToEdge, GlWrap::ClampToBorder]);
            }
        }
        sampling.mipmap = GlMipmap::Off;
        // Mesa's llvmpipe takes a derivative for one of normalised coordinates, and minifies too early: left out.
        sampling.magnified = Some(sampling.linear);
    }
    if integer {
        sampling.linear = false;
        sampling.magnified = Some(false);
        // Mesa's llvmpipe takes the levels of integers by NEAREST as it does by NEAREST_MIPMAP_NEAREST: this is left out.
        if sampling.mipmap != GlMipmap::Nearest && kind.shape != Shape::Rectangle {
            sampling.mipmap = GlMipmap::Nearest;
        }
        for wrap in &mut sampling.wrap {
            if *wrap == GlWrap::ClampToBorder {
                *wrap = GlWrap::ClampToEdge;
            }
        }
    }
    // Mesa's llvmpipe takes all wrap modes of a cube map for CLAMP_TO_EDGE, also without seamless filters: left out.
    if kind.shape == Shape::Cube && !seamless {
        sampling.wrap = [GlWrap::ClampToEdge; 3];
    }
    sampling.compare = match kind.class {
        Class::Shadow if again => sampling.compare.or(Some(GlCompare::LessEqual)),
        Class::Shadow => Some(random.pick(&GlCompare::ALL)),
        _ if texture.format.is_depth() => None,
        _ => sampling.compare,
    };
    // Without derivatives there is one filter of one level.
    if kind.source == Source::Fetched && kind.is_implicit() {
        sampling.magnified = Some(sampling.linear);
        if integer {
            own.levels = own.levels.map(|[base, _]| [base, base]);
        } else {
            sampling.mipmap = GlMipmap::Off;
        }
    }
}
