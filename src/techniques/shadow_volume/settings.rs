//! The keys of `[light.shadow]` that shadow volumes read.

use crate::lights::light::{LedgeDepths, Lighting};
use crate::math::ledge::GUARD_CODES;
use crate::scene::{Reader, SettingsError};
use crate::techniques::Axis;
use crate::techniques::change::{Change, of_picture, of_shade};

/// Method by which volumes are counted [GDC, "Review: Stenciled Shadow Volumes"].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The cheapest way that is right, for each caster.
    Auto,
    /// One bit, inverted [GDC, "Stencil Inverting of Shadow Volume"]. Right only if volumes do not intersect and the eye is
    /// outside of them.
    Parity,
    /// Counting before visible surfaces in two draws [GDC, "For Shadow Volumes With Intersecting Polygons"]. Right only if
    /// the eye's near rectangle is outside of all volumes.
    ZPass,
    /// The same in one draw with two-sided stencil operations.
    ZPassTwoSided,
    /// The same with caps on the near plane, on a ledge [GDC, "Near Clip Plane Capping Cases", "Building a "Ledge" at the
    /// Front of the Depth Buffer"].
    ZPassCapped,
    /// Counting behind visible surfaces, with volumes and far plane at infinity [GDC, "Alternative to Near Plane Capping:
    /// Carmack's Reverse"; Everitt and Kilgard 2002].
    ZFail,
    /// The same under the scene's own projection, with depth clamp.
    ZFailClamped,
    /// Counting behind visible surfaces with volumes of finite length; wrong where a shadow reaches farther [GDC, "More
    /// Implications of Carmack's Reverse"].
    ZFailTruncated,
}

pub const METHODS: [(&str, Method); 8] = [
    ("auto", Method::Auto),
    ("parity", Method::Parity),
    ("z-pass", Method::ZPass),
    ("z-pass-two-sided", Method::ZPassTwoSided),
    ("z-pass-capped", Method::ZPassCapped),
    ("z-fail", Method::ZFail),
    ("z-fail-clamped", Method::ZFailClamped),
    ("z-fail-truncated", Method::ZFailTruncated),
];

/// Settings of volumes: how they are made and counted.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    pub method: Method,
    /// True if counts wrap modulo 256; `false`: they stop at 0 and 255.
    pub wrap: bool,
    /// Length of truncated volumes, in world units; `None`: that of the scene's bounds.
    pub distance: Option<f64>,
    /// Depths of the ledge for volumes with caps on the near plane.
    pub ledge: LedgeDepths,
    /// Passes in which the light joins the picture.
    pub lighting: Lighting,
}

pub const AXES: &[Axis] = &[Axis {
    key: "method",
    values: &[
        "\"auto\"",
        "\"parity\"",
        "\"z-pass\"",
        "\"z-pass-two-sided\"",
        "\"z-pass-capped\"",
        "\"z-fail\"",
        "\"z-fail-clamped\"",
        "\"z-fail-truncated\"",
    ],
    quick: &["\"auto\"", "\"z-fail\""],
}];

pub const SHADE_CHANGES: &[Change] = &of_shade([
    "method = \"parity\"",
    "method = \"z-pass\"",
    "method = \"z-pass-two-sided\"",
    "method = \"z-pass-capped\"",
    "method = \"z-pass-capped\", ledge = [0.05, 0.1, 1.0]",
    "method = \"z-fail\"",
    "method = \"z-fail-clamped\"",
    "method = \"z-fail-truncated\"",
    "count = \"saturate\"",
]);

pub const PICTURE_CHANGES: &[Change] = &of_picture(["passes = \"lit-unlit\""]);

/// Reads the settings; data/scenes/README.md has the defaults.
pub fn read(keys: &mut Reader<'_>) -> Result<Settings, SettingsError> {
    Ok(Settings {
        method: keys.choice("method", &METHODS)?.unwrap_or(Method::Auto),
        wrap: keys.choice("count", &[("wrap", true), ("saturate", false)])?.unwrap_or(true),
        distance: keys.number("distance", f64::MIN_POSITIVE..=crate::scene::LARGEST)?,
        ledge: read_ledge(keys)?,
        lighting: keys
            .choice("passes", &[("added", Lighting::Added), ("lit-unlit", Lighting::LitAndUnlit)])?
            .unwrap_or(Lighting::Added),
    })
}

/// `ledge = [volumes, scene, far]` in window depths.
fn read_ledge(keys: &mut Reader<'_>) -> Result<LedgeDepths, SettingsError> {
    let Some(depths) = keys.numbers::<3>("ledge", 0.0..=1.0)? else { return Ok(LedgeDepths::Fewest) };
    let [volumes, scene, far] = depths;
    // For 24 bits. Less than half of the depths would cost the scene more than a bit.
    let least = f64::from(GUARD_CODES + 1) / 16_777_215.0;
    if scene - volumes < least || far - scene < 0.5 {
        let message = format!(
            "must be [volumes, scene, far]: the depths where volumes and scene begin, at least {least:.1e} apart, and \
             where both end, at least 0.5 farther; not [{volumes}, {scene}, {far}]"
        );
        return Err(keys.error("ledge", message));
    }
    Ok(LedgeDepths::Given(depths))
}
