//! Shades against exact visibility, by [`crate::judge`].

use super::bench::CaseBench;
use super::classes::class_of;
use super::draw::{DrawnScene, Wanted};
use super::file::{Class, MayBeWrong, TruthCheck};
use super::outcome::Failure;
use super::raster::Raster;
use crate::frame::ShadeImage;
use crate::judge::difference::{difference_picture, truth_picture};
use crate::judge::{Bound, Judge, Judgement};
use crate::truth::{Answer, Truth};
use crate::views::View;

/// Band beside a shadow's edge in which a command may be wrong where the file does not say, in pixels: a filter of two texels
/// of a pixel's size, and rounding.
const BAND: f64 = 3.0;

/// Holds the shade of a light against exact visibility.
///
/// # Errors
///
/// More wrong pixels than the limits allow; a light that is not there; nothing to compare.
pub(super) fn truth(on: &CaseBench, truth: &TruthCheck, set: &[String]) -> Result<(), Failure> {
    let drawn = on.draw(&[set, &truth.set], Wanted::View(View::Shade, truth.light))?;
    let lights = drawn.scene.lights.len();
    if truth.light >= lights {
        return Err(format!("light {} is not in the scene: it has {lights}, numbered from 0", truth.light).into());
    }
    let bound = bound_of(truth, &drawn);
    let mut judge = Judge::new(&drawn.scene, truth.light).map_err(|error| error.to_string())?;
    let shade = shade_image(&drawn.picture, judge.truth(&bound), on.case.checks.render.is_some());
    let found = judge.shade(&shade, &bound).map_err(|error| error.to_string())?;
    let words = in_words(truth, &found);
    match broken_limits(truth, &found) {
        None => {
            on.note(format!("truth: {words}"));
            Ok(())
        }
        Some(limits) => {
            let message = format!("{words}; {limits} ({})", truth.why);
            let known = judge.truth(&bound);
            let expected = Raster::of_rgb(&truth_picture(known));
            let difference = difference_picture(known, &shade).ok().map(|picture| Raster::of_rgb(&picture));
            Err(on.failure_with(message, &drawn.picture, Some(&expected), difference.as_ref()))
        }
    }
}

/// Where pixels may be wrong.
fn bound_of(truth: &TruthCheck, drawn: &DrawnScene) -> Bound {
    match (truth.band, truth.bound, &drawn.plan) {
        (Some(pixels), _, _) => Bound::Band { pixels },
        (None, Some(MayBeWrong::Exact), _) => Bound::Exact,
        (None, _, Some(plan)) => Bound::of_plan(&drawn.scene, plan, truth.light),
        (None, _, None) => Bound::Band { pixels: BAND },
    }
}

/// A shade view for the judge. A command's opaque picture is taken to show a surface wherever the truth does.
fn shade_image(shade: &Raster, truth: &Truth, is_commands: bool) -> ShadeImage {
    let outside = |pixel: &[f32]| class_of(pixel) == Some(Class::Outside);
    let covered = match is_commands && !shade.pixels().any(outside) {
        true => truth.pixels.iter().map(|pixel| pixel.answer != Answer::Background).collect(),
        false => shade.pixels().map(|pixel| !outside(pixel)).collect(),
    };
    let [width, height] = shade.size;
    let values = shade.pixels().map(|pixel| pixel.first().copied().unwrap_or_default().clamp(0.0, 1.0));
    ShadeImage { width, height, shade: values.collect(), covered }
}

fn percent(found: &Judgement, count: usize) -> f64 {
    100.0 * found.share(count)
}

fn in_words(truth: &TruthCheck, found: &Judgement) -> String {
    let Judgement { compared, false_shadow, leak, outside_band, .. } = *found;
    let share = |count: usize| format!("{count} ({:.3} %)", percent(found, count));
    format!(
        "light {}: of {compared} pixels {} have a false shadow, {} a leak, and {} are wrong outside the bound",
        truth.light,
        share(false_shadow),
        share(leak),
        share(outside_band)
    )
}

/// The limits that are broken, in words; none where all hold.
fn broken_limits(truth: &TruthCheck, found: &Judgement) -> Option<String> {
    if found.compared == 0 {
        return Some(String::from("nothing could be compared"));
    }
    let limits = [
        ("false_shadow", found.false_shadow, truth.false_shadow),
        ("leak", found.leak, truth.leak),
        ("outside_band", found.outside_band, truth.outside_band),
    ];
    let broken = limits.into_iter().filter(|(_, count, limit)| percent(found, *count) > *limit);
    let words: Vec<String> = broken.map(|(key, _, limit)| format!("{key} may be {limit} %")).collect();
    (!words.is_empty()).then(|| words.join(", "))
}
