//! The keys of `[light.shadow]` that midpoint maps read beside those of shadow maps.

use crate::scene::{Reader, SettingsError};
use crate::techniques::Axis;
use crate::techniques::change::{Change, of_shade};
use crate::techniques::shadow_map::settings::{self as map, Settings as Map};

/// Mean of two layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Average {
    /// The mean of both window depths, as in [HSM, "Advantages and Limitations"]. It lies nearer to the light than the
    /// middle point.
    Window,
    /// The window depth of the point midway between the layers.
    EyeLinear,
}

/// Value of a texel with only one layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Single {
    /// That layer: it shades itself like a map without polygon offset.
    First,
    /// The far plane: it shades nothing. Right, because everything that can be seen behind a caster is a layer, too.
    Far,
    /// That layer under the polygon offset of an ordinary map.
    FirstOffset,
}

/// Test of the second pass for lying behind the nearest layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peel {
    /// Comparison in the shader, with the depth that it fetches for the average anyway: one lookup for each fragment.
    Fetch,
    /// Comparison by the texture unit, as in [HSM, "Advantages and Limitations"]: one more lookup. The texels are the same.
    Compare,
}

pub struct Settings {
    pub map: Map,
    pub average: Average,
    pub peel: Peel,
    /// `None`: [`Single::Far`].
    pub single: Option<Single>,
}

pub const AXES: &[Axis] = &[
    Axis { key: "size", values: &["512", "1024", "2048"], quick: &["1024"] },
    Axis { key: "average", values: &["\"window\"", "\"eye-linear\""], quick: &["\"window\""] },
];

pub const CHANGES: &[Change] = &of_shade([
    "average = \"eye-linear\"",
    "peel = \"compare\"",
    "filter = \"nearest\"",
    "kernel = \"3x3\"",
    "compare = \"gequal\"",
    "format = \"depth32f\"",
]);

/// Reads the keys, each with its default.
///
/// # Errors
///
/// A value of the wrong type or out of its range, with its place.
pub fn read(keys: &mut Reader<'_>) -> Result<Settings, SettingsError> {
    let averages = [("window", Average::Window), ("eye-linear", Average::EyeLinear)];
    let singles = [("first", Single::First), ("far", Single::Far), ("first+offset", Single::FirstOffset)];
    Ok(Settings {
        map: map::read(keys)?,
        average: keys.choice("average", &averages)?.unwrap_or(Average::Window),
        peel: keys.choice("peel", &[("fetch", Peel::Fetch), ("compare", Peel::Compare)])?.unwrap_or(Peel::Fetch),
        single: keys.choice("single", &singles)?,
    })
}
