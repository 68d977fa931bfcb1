//! Shades against exact visibility, by [`crate::judge`].

use super::bench::CaseBench;
use super::classes::class_of;
use super::draw::{DrawnScene, Wanted};
use super::file::{Class, MayBeWrong, TruthCheck};
use super::outcome::Failure;
use crate::frame::ShadeImage;
use crate::judge::colors::why_unshaded;
use crate::judge::difference::{difference_picture, truth_picture};
use crate::judge::{Bound, Judge, Judgement};
use crate::pictures::Raster;
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
    if let Some(why) = why_unshaded(&drawn.scene, truth.light) {
        return Err(format!("light {} has no shade that could be held against truth: {why}", truth.light).into());
    }
    let bound = bound_of(truth, &drawn);
    let mut judge = Judge::new(&drawn.scene, truth.light).map_err(|error| error.to_string())?;
    let mut shade = shade_image(&drawn.picture);
    if on.case.checks.render.is_some() && shade.covered.iter().all(|is_covered| *is_covered) {
        judge.cover_surfaces(&mut shade);
    }
    let found = judge.shade(&shade, &bound).map_err(|error| error.to_string())?;
    let edge = judge.edge_distances(&shade).map_err(|error| error.to_string())?[1].map(|edge| edge.mean_pixels);
    let words = in_words(truth, &found, edge);
    match broken_limits(truth, &found, edge) {
        None => {
            on.note(format!("truth: {words}"));
            Ok(())
        }
        Some(limits) => {
            let message = format!("{words}; {limits} ({})", truth.why);
            let known = judge.truth(&bound);
            let expected = of_rgb(&truth_picture(known));
            let difference = difference_picture(known, &shade).ok().map(|picture| of_rgb(&picture));
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

/// A shade view for the judge.
fn shade_image(shade: &Raster) -> ShadeImage {
    let [width, height] = shade.size;
    let covered = shade.pixels().map(|pixel| class_of(pixel) != Some(Class::Outside)).collect();
    let values = shade.pixels().map(|pixel| pixel.first().copied().unwrap_or_default().clamp(0.0, 1.0));
    ShadeImage { width, height, shade: values.collect(), covered }
}

/// A picture of 8 bits a channel.
fn of_rgb(picture: &image::RgbImage) -> Raster {
    let data = picture.as_raw().iter().map(|value| f32::from(*value) / 255.0).collect();
    Raster { size: [picture.width(), picture.height()], channels: 3, data }
}

fn percent(found: &Judgement, count: usize) -> f64 {
    100.0 * found.share(count)
}

fn in_words(truth: &TruthCheck, found: &Judgement, edge: Option<f64>) -> String {
    let Judgement { compared, false_shadow, leak, outside_band, .. } = *found;
    let share = |count: usize| format!("{count} ({:.3} %)", percent(found, count));
    let edge = edge.map_or_else(String::new, |edge| format!("; shadow edges lie {edge:.3} pixels aside in the mean"));
    format!(
        "light {}: of {compared} pixels {} have a false shadow, {} a leak, and {} are wrong outside the bound{edge}",
        truth.light,
        share(false_shadow),
        share(leak),
        share(outside_band)
    )
}

/// The limits that are broken, in words; none where all hold.
fn broken_limits(truth: &TruthCheck, found: &Judgement, edge: Option<f64>) -> Option<String> {
    if found.compared == 0 {
        return Some(String::from("nothing could be compared"));
    }
    let limits = [
        ("false_shadow", found.false_shadow, truth.false_shadow),
        ("leak", found.leak, truth.leak),
        ("outside_band", found.outside_band, truth.outside_band),
    ];
    let broken = limits.into_iter().filter(|(_, count, limit)| percent(found, *count) > *limit);
    let mut words: Vec<String> = broken.map(|(key, _, limit)| format!("{key} may be {limit} %")).collect();
    match (truth.edge, edge) {
        (Some(limit), Some(edge)) if edge > limit => words.push(format!("edge may be {limit} pixels")),
        (Some(_), None) => words.push(String::from("there is no shadow edge whose distance `edge` could limit")),
        _ => {}
    }
    (!words.is_empty()).then(|| words.join(", "))
}
