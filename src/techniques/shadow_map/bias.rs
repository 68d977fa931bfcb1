//! Distances between a map and the compared points, so that no surface shades itself.

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::settings::{Bias, Mipmaps, Offset, Settings};
use crate::lights::projector::{Projector, Rays};
use crate::pass::{DepthFormat, Filter, PolygonOffset};

/// Reach of a lookup from its place along each axis, in texels: the kernel's taps and each tap's filter, which is the half
/// texel to its centre, or with GL_LINEAR the whole one to its farthest texel's.
pub fn reach_texels(settings: &Settings) -> f64 {
    kernel_reach(settings) + filter_reach(settings)
}

/// Distance of a kernel's outermost tap.
pub fn kernel_reach(settings: &Settings) -> f64 {
    0.5 * f64::from(settings.kernel - 1)
}

/// Reach of one tap.
pub fn filter_reach(settings: &Settings) -> f64 {
    if settings.filter == Filter::Nearest { 0.5 } else { 1.0 }
}

/// The offset as written, or by default the one with the least leak that leaves no acne on a dense model (the test acne),
/// and not one dark tap on any plane (the case shadow-map/plane-biases).
///
/// Three things put a surface behind its own texels. Each has its own term, so that the default holds at any resolution,
/// filter, format and size of a scene:
/// - its slope, over the reach of the lookup: by the polygon offset's factor. GL's slope is the steeper of both axes' [GL
///   4.6, 14.6.5]; down a diagonal a plane falls away by it along each axis, so that a factor of twice the reach in texels
///   leaves no tap of any plane dark, however steep;
/// - a texel may hold the depth of a neighbouring facet that is less steep, whose offset is too small for the steeper one.
///   `texels` is for that. A wider reach has a larger factor, and needs less of it;
/// - rounding: by units, of which one is at least the format's least step.
///
/// What remains are silhouettes, and walls that the light grazes: a surface within some five degrees of its edge rises by
/// more, from one texel to the next, than any offset of the flatter facet beside it; in a map it is a few texels wide. In a
/// city of boxes under a sun, 0.09 % of the pixels are dark for that reason, two thirds of them where the cosine of the
/// light's angle is below 0.04, and `texels` six times as large leaves as many. The other biases, which know the receiver's
/// own slope, leave none.
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
        // These biases handle the receiver's own slope, but not that of the neighbouring facet: one that rises more steeply
        // lies before the receiver's plane by its rise up to its texel's centre, half a texel from its edge. So half of the
        // slope must come from the caster's offset. A facet narrower than a texel rises less, and `texels` covers the rest.
        Bias::ReceiverPlane | Bias::NormalOffset | Bias::Adaptive => (0.5, 0.5),
    };
    // A texel of the coarser level is as wide as two; that of any level, where all may be used, too: see the report.
    let width = if settings.mipmaps == Mipmaps::None { 1.0 } else { 2.0 };
    // A simplified caster lies up to a sixth of a texel before the surface that is lit; half as much again is safe.
    let moved = if settings.simplified { 0.25 } else { 0.0 };
    Offset { polygon: PolygonOffset { factor: factor as f32, units }, texels: width * texels + moved }
}

/// Number of levels that are drawn. Depths cannot be averaged: every level that is used is drawn [LEC, "Mipmapping for
/// Depth Textures"].
pub fn levels(settings: &Settings) -> u32 {
    match settings.mipmaps {
        Mipmaps::None => 1,
        Mipmaps::EightTaps => settings.size.ilog2().min(1) + 1,
        Mipmaps::All => settings.size.ilog2() + 1,
    }
}

/// The width of a texel, along its longer side, at a distance of 1 along the light's axis; for parallel light, anywhere.
pub fn texel_at_one(projector: &Projector, settings: &Settings) -> f64 {
    texel_sides_at_one(projector, settings).max_element()
}

/// The same as [`texel_at_one`] along both sides.
pub fn texel_sides_at_one(projector: &Projector, settings: &Settings) -> DVec2 {
    let clip = &projector.clip_from_light;
    2.0 * projector.crop.half() / (DVec2::new(clip.x_axis.x, clip.y_axis.y) * f64::from(settings.size))
}

/// Matrix in light clip space that moves every point towards the light, along its ray, by `texels` widths of a texel there:
/// by the same share of its distance everywhere. A perspective projection has `z = A w - B`; for a distance that shrinks to
/// `1 / (1 + g)` it is `z = A w - (1 + g) B`, less the common factor. For parallel light, z is the distance.
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

/// Growth of `1 / distance` if a point is moved towards the light by `share` of its distance.
pub fn growth(share: f64) -> f64 {
    let share = share.min(0.5);
    share / (1.0 - share)
}
