//! Relations of pictures: set-ups that show the same, renderers that have drawn before, pictures that add up.

use super::bench::CaseBench;
use super::draw::Wanted;
use super::file::{After, Of, Same, Sum};
use super::outcome::Failure;
use crate::pictures::Raster;
use crate::pictures::compare::{self, Tolerance};
use crate::views::View;

fn wanted_of(of: Of, light: usize) -> Wanted {
    match of {
        Of::Picture => Wanted::Picture,
        Of::Shade => Wanted::View(View::Shade, light),
        Of::Depth => Wanted::View(View::Depth, 0),
        Of::LightDepth => Wanted::View(View::LightDepth, light),
        Of::LightDistance => Wanted::View(View::LightDistance, light),
    }
}

/// Holds set-ups against the one that they must look like.
///
/// # Errors
///
/// A difference beyond the tolerance.
pub(super) fn same(on: &CaseBench, same: &Same, set: &[String]) -> Result<(), Failure> {
    let tolerance = match (same.max, same.share) {
        (Some(max), Some(share)) => Tolerance { max, mean: f64::INFINITY, share, ..Tolerance::EXACT },
        _ => Tolerance::EXACT,
    };
    for of in &same.of {
        let wanted = wanted_of(*of, same.light);
        let expected = on.draw_frames(None, &[set, &same.with], same.frames, wanted)?;
        for other in &same.sets {
            let actual = on.draw_frames(same.scene.as_deref(), &[set, other], same.frames, wanted)?;
            match compare::compare(&actual.picture, &expected.picture, &tolerance) {
                Ok(found) if found.count > 0 => on.note(format!("{of:?} {other:?}: {found}")),
                Ok(_) => {}
                Err(error) => {
                    let message = format!("{of:?} with {other:?} against {:?}: {error} ({})", same.with, same.why);
                    return Err(on.failure(message, &actual.picture, Some(&expected.picture)));
                }
            }
        }
    }
    Ok(())
}

/// Holds pictures of a used renderer against those of a new one.
///
/// # Errors
///
/// A difference beyond the tolerance.
pub(super) fn after(on: &CaseBench, after: &After) -> Result<(), Failure> {
    for of in &after.of {
        let wanted = wanted_of(*of, 0);
        let expected = &on.draw(&[], wanted)?.picture;
        for first in &after.firsts {
            let actual = on.draw_after(first, wanted)?.picture;
            compare::compare(&actual, expected, &Tolerance::EXACT).map_err(|error| {
                let message = format!("{of:?} after {first:?}: {error} ({})", after.why);
                on.failure(message, &actual, Some(expected))
            })?;
        }
    }
    Ok(())
}

/// Holds the picture against the sum of others.
///
/// # Errors
///
/// A difference beyond the tolerance.
pub(super) fn sum(on: &CaseBench, sum: &Sum) -> Result<(), Failure> {
    let actual = &on.draw(&[], Wanted::FloatPicture)?.picture;
    let mut expected = Raster { data: vec![0.0; actual.data.len()], ..actual.clone() };
    let signed = sum.plus.iter().map(|set| (1.0, set)).chain(sum.minus.iter().map(|set| (-1.0, set)));
    for (sign, set) in signed {
        let term = &on.draw(&[set], Wanted::FloatPicture)?.picture;
        if term.data.len() != actual.data.len() {
            return Err("a term of the sum has another size".into());
        }
        expected.data.iter_mut().zip(&term.data).for_each(|(total, value)| *total += sign * value);
    }
    let tolerance = Tolerance { max: sum.max, mean: f64::INFINITY, share: 1.0, ..Tolerance::EXACT };
    compare::compare(actual, &expected, &tolerance)
        .map(drop)
        .map_err(|error| on.failure(format!("the sum: {error} ({})", sum.why), actual, Some(&expected)))
}
