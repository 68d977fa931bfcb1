//! How far a map and what is compared with it are held apart, so that no surface shades itself.

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::settings::{Bias, Mipmaps, Offset, Settings};
use crate::lights::projector::{Projector, Rays};
use crate::pass::{DepthFormat, Filter, PolygonOffset};

/// How far a lookup reaches from its place along each axis, in texels: the kernel's taps, and of each its filter: the
/// half texel to its centre, or with GL_LINEAR the whole one to its farthest texel's.
pub fn reach_texels(settings: &Settings) -> f64 {
    kernel_reach(settings) + filter_reach(settings)
}

/// Of a kernel's outermost tap.
pub fn kernel_reach(settings: &Settings) -> f64 {
    0.5 * f64::from(settings.kernel - 1)
}

/// Of one tap.
pub fn filter_reach(settings: &Settings) -> f64 {
    if settings.filter == Filter::Nearest { 0.5 } else { 1.0 }
}

/// The offset as written, or by default the one with the least leak of those that leave no acne on a dense model
/// (`tests/acne.rs`) and none, not even of one tap, on any plane (the case shadow-map/plane-biases).
///
/// Three things bring a surface before its own texels, and each is met in its own measure, so that the default holds at
/// any resolution, filter, format and size of a scene:
/// - its slope, over the reach of the lookup: by the polygon offset's factor. GL's slope is the steeper of both axes'
///   [GL 4.6, 14.6.5]; down a diagonal a plane falls away by it along each axis, so that twice as many slopes as texels
///   are reached leave no tap of any plane dark, however steep;
/// - a texel may hold the depth of a neighbouring facet that is less steep, whose offset is too small for the steeper
///   one. That is what `texels` is for. A wider reach has more of the slope to spare, and needs less of it;
/// - rounding: by units, of which one is at least the format's least step.
///
/// Beyond these nothing is left but silhouettes, and walls that the light grazes: a surface within some five degrees of its
/// edge rises by more, from one texel to the next, than any offset of the flatter facet beside it; in a map it is a few
/// texels wide. Of a city of boxes under a sun 0.09 % of the pixels are dark for it, two thirds of them where the cosine
/// of the light's angle is below 0.04, and six times as many `texels` leave as many. The receiver's own slope, which the
/// texture unit does not know, mends it: the other biases leave none.
pub fn offset(settings: &Settings) -> Offset {
    settings.offset.unwrap_or_else(|| default_offset(settings))
}

fn default_offset(settings: &Settings) -> Offset {
    // Triangles reach up to 16 times as far as the fragment (`cut.rs` cuts others), so that r and q are each off by some
    // 16 times 2^-24. A unit of floats between 1/2 and 1 is half of what it is of 24 bits.
    let units = match settings.format {
        DepthFormat::Depth16 => 1.0,
        DepthFormat::Depth24 | DepthFormat::Depth32 => 24.0,
        DepthFormat::Depth32F => 48.0,
    };
    let reach = reach_texels(settings);
    let (factor, texels) = match settings.bias {
        Bias::Offset => (2.0 * reach, 0.25 / (reach * reach)),
        // The receiver's own slope is met where it is compared, and what it cannot know is that of the facet beside it:
        // one that rises more steeply stands before the receiver's plane by what it rises up to its texel's centre, half
        // a texel from where it may begin. That half of its slope is the caster's to give. A facet narrower than a texel
        // shows less of it, and leaves the rest to `texels`.
        Bias::ReceiverPlane | Bias::NormalOffset | Bias::Adaptive => (0.5, 0.5),
    };
    // A texel of the coarser level is as wide as two; that of any level, where all may be met, as many: see the report.
    let width = if settings.mipmaps == Mipmaps::None { 1.0 } else { 2.0 };
    // A simplified caster lies up to a sixth of a texel before the surface that is lit; half as much again is safe.
    let moved = if settings.simplified { 0.25 } else { 0.0 };
    Offset { polygon: PolygonOffset { factor: factor as f32, units }, texels: width * texels + moved }
}

/// How many levels are drawn. Depths cannot be averaged: every one that is met is drawn [lecture, "Mipmapping for Depth
/// Textures"].
pub fn levels(settings: &Settings) -> u32 {
    match settings.mipmaps {
        Mipmaps::None => 1,
        Mipmaps::EightTaps => settings.size.ilog2().min(1) + 1,
        Mipmaps::All => settings.size.ilog2() + 1,
    }
}

/// The width of a texel, along its longer side, at a distance of 1 along the light's axis; of parallel light, anywhere.
pub fn texel_at_one(projector: &Projector, settings: &Settings) -> f64 {
    texel_sides_at_one(projector, settings).max_element()
}

/// The same along both sides.
pub fn texel_sides_at_one(projector: &Projector, settings: &Settings) -> DVec2 {
    let clip = &projector.clip_from_light;
    2.0 * projector.crop.half() / (DVec2::new(clip.x_axis.x, clip.y_axis.y) * f64::from(settings.size))
}

/// Light clip space with every point moved towards the light, along its ray, by `texels` widths of a texel where it
/// is: by the same share of its distance everywhere. A perspective projection has `z = A w - B`; of a distance that
/// shrinks to `1 / (1 + g)` it makes `z = A w - (1 + g) B`, less the common factor. Of parallel light, z is the distance.
pub fn moved_to_light(projector: &Projector, texels: f64, settings: &Settings) -> DMat4 {
    let width = texels * texel_at_one(projector, settings);
    let z_axis = projector.clip_from_light.z_axis;
    if let Rays::Along(_) = projector.rays {
        return DMat4::from_translation(DVec3::new(0.0, 0.0, width * z_axis.z));
    }
    let g = growth(width);
    let a = -z_axis.z;
    DMat4::from_cols(DVec4::X, DVec4::Y, DVec4::new(0.0, 0.0, 1.0 + g, 0.0), DVec4::new(0.0, 0.0, -g * a, 1.0))
}

/// By how much `1 / distance` grows where a point is moved towards the light by `share` of its distance.
pub fn growth(share: f64) -> f64 {
    let share = share.min(0.5);
    share / (1.0 - share)
}
