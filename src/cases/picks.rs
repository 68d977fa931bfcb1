//! Picks: pixels with a known answer, by class, shade, colour or formula.

use glam::DVec3;

use super::bench::CaseBench;
use super::classes::{class_of, in_words, need_reach};
use super::draw::{DrawnScene, Wanted};
use super::file::{Class, Pick};
use super::formula;
use super::outcome::Failure;
use crate::views::View;

/// Holds a pixel against what is known of it.
///
/// # Errors
///
/// Another value; a pixel outside the picture.
pub(super) fn pick(on: &CaseBench, pick: &Pick, set: &[String]) -> Result<(), Failure> {
    let sets = [set, &pick.set];
    if pick.class.is_some() || pick.shade.is_some() {
        let drawn = on.draw(&sets, Wanted::View(View::Shade, pick.light))?;
        let pixel = pick_pixel(&drawn, pick)?;
        if pick.class == Some(Class::Outside) {
            need_reach(on, &drawn.picture)?;
        }
        let found = drawn.picture.pixel(pixel);
        let right = pick.class.is_none_or(|class| class_of(found) == Some(class))
            && pick
                .shade
                .is_none_or(|shade| found[1] > 0.0 && (f64::from(found[0]) - shade).abs() <= pick.within / 255.0);
        if !right {
            let shade = |shade: f64| format!("a shade of {shade} within {}/255", pick.within);
            let wanted =
                pick.class.map_or_else(|| pick.shade.map_or_else(String::new, shade), |class| format!("{class:?}"));
            let message = format!("pixel {pixel:?} is {}, not {wanted}: {}", in_words(found), pick.why);
            return Err(on.failure(message, &drawn.picture, None));
        }
    }
    if pick.color.is_some() || pick.formula.is_some() {
        pick_color(on, pick, &sets)?;
    }
    Ok(())
}

fn pick_color(on: &CaseBench, pick: &Pick, sets: &[&[String]]) -> Result<(), Failure> {
    let drawn = on.draw(sets, Wanted::Picture)?;
    let pixel = pick_pixel(&drawn, pick)?;
    let mut expected: Vec<DVec3> = pick.color.iter().map(|color| DVec3::from_array(*color)).collect();
    if let Some(known) = &pick.formula {
        let at = DVec3::from_array(pick.at.ok_or("a formula needs a point of the world")?);
        let point = formula::point_under(&drawn.scene, pixel, at, DVec3::from_array(known.normal));
        expected.push(255.0 * formula::illumination(&drawn.scene, point, known)?);
    }
    let found = drawn.picture.pixel(pixel);
    let found = 255.0 * DVec3::new(f64::from(found[0]), f64::from(found[1]), f64::from(found[2]));
    for expected in expected {
        if (found - expected).abs().max_element() > pick.within + 1e-3 {
            let why = &pick.why;
            let message = format!("pixel {pixel:?} is {found:.2}, not {expected:.2} within {}: {why}", pick.within);
            return Err(on.failure(message, &drawn.picture, None));
        }
    }
    Ok(())
}

fn pick_pixel(drawn: &DrawnScene, pick: &Pick) -> Result<[u32; 2], Failure> {
    match (pick.pixel, pick.at) {
        (Some([x, y]), _) => {
            let [width, height] = drawn.picture.size;
            match x < width && y < height {
                true => Ok([x, y]),
                false => {
                    Err(format!("pixel [{x}, {y}] is not in the picture of {width}x{height} ({})", pick.why).into())
                }
            }
        }
        (None, Some(at)) => Ok(formula::pixel(&drawn.scene, DVec3::from_array(at))?),
        (None, None) => Err(format!("a pick has neither `at` nor `pixel` ({})", pick.why).into()),
    }
}
