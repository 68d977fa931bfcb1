//! Classes of a shade's pixels.

use super::bench::CaseBench;
use super::file::Class;
use super::outcome::Failure;
use crate::pictures::Raster;

/// The class of a shade and its alpha; none where the shade is not in [0, 1].
pub(super) fn class_of(shade: &[f32]) -> Option<Class> {
    match *shade {
        [_, 0.0] => Some(Class::Outside),
        [0.0, 1.0] => Some(Class::Shadowed),
        [1.0, 1.0] => Some(Class::Lit),
        [value, 1.0] if value > 0.0 && value < 1.0 => Some(Class::Partial),
        _ => None,
    }
}

/// The class with the values.
pub(super) fn in_words(shade: &[f32]) -> String {
    class_of(shade).map_or_else(|| format!("{shade:?}"), |class| format!("{class:?} {shade:?}"))
}

/// Refuses a command's shade that does not say where the light's reach ends, for a check that must know.
///
/// # Errors
///
/// A command's picture without a transparent pixel.
pub(super) fn need_reach(on: &CaseBench, shade: &Raster) -> Result<(), Failure> {
    let is_known = |pixel: &[f32]| class_of(pixel) == Some(Class::Outside);
    match on.case.checks.render.is_none() || shade.pixels().any(is_known) {
        true => Ok(()),
        false => Err(
            "the command's shade is opaque: this check needs an alpha, 0 where no surface is and where the light's \
                      cone or frustum ends"
                .into(),
        ),
    }
}
