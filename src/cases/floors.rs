//! Shade on floors by central projection, and counts of classes.

use glam::DVec3;

use super::bench::CaseBench;
use super::classes::{class_of, in_words, need_reach};
use super::draw::{DrawnScene, Wanted};
use super::file::{Class, ClassCount, Cone, Edge};
use super::formula;
use super::outcome::Failure;
use crate::views::View;

/// Texels and pixels between a pick and an edge that it is beside: GL_LINEAR's reach and rounding.
const TEXELS: f64 = 2.2;
const PIXELS: f64 = 1.5;

/// Holds the shade at points of a floor against classes.
fn points(on: &CaseBench, drawn: &DrawnScene, wanted: &[(DVec3, Class)], why: &str) -> Result<(), Failure> {
    for (point, class) in wanted {
        let pixel = formula::pixel(&drawn.scene, *point)?;
        let found = drawn.picture.pixel(pixel);
        if class_of(found) != Some(*class) {
            let found = in_words(found);
            let message = format!("{point:.4} at pixel {pixel:?} is {found}, not {class:?}: {why}");
            return Err(on.failure(message, &drawn.picture, None));
        }
    }
    Ok(())
}

/// Holds both sides of a shadow's outline against central projection.
///
/// # Errors
///
/// Another shade.
pub(super) fn edge(on: &CaseBench, edge: &Edge, set: &[String]) -> Result<(), Failure> {
    let drawn = on.draw(&[set, &edge.set], Wanted::View(View::Shade, 0))?;
    let light = drawn.scene.lights.first().ok_or("the scene has no light")?;
    let outward = DVec3::from_array(edge.outward).normalize();
    let caster = match (edge.caster, &edge.sphere) {
        (Some(caster), None) => DVec3::from_array(caster),
        (None, Some(sphere)) => formula::tangent_point(light, sphere, outward),
        _ => return Err(format!("an edge needs a caster or a sphere ({})", edge.why).into()),
    };
    let at = formula::shadow_on_floor(light, caster, edge.floor);
    let texels = TEXELS * formula::texel_length(formula::frustum(light)?, formula::map_size(light), at);
    let margin = texels + PIXELS * formula::pixel_length(&drawn.scene, at, outward)?;
    let wanted = [(at - margin * outward, Class::Shadowed), (at + margin * outward, Class::Lit)];
    points(on, &drawn, &wanted, &edge.why)
}

/// Holds both sides of the reach's end against the light's cone or frustum.
///
/// # Errors
///
/// Another shade.
pub(super) fn cone(on: &CaseBench, cone: &Cone, set: &[String]) -> Result<(), Failure> {
    let drawn = on.draw(&[set, &cone.set], Wanted::View(View::Shade, 0))?;
    need_reach(on, &drawn.picture)?;
    let light = drawn.scene.lights.first().ok_or("the scene has no light")?;
    let start = formula::shadow_on_floor(light, formula::frustum(light)?.target, cone.floor);
    let towards = DVec3::from_array(cone.towards).normalize();
    let end = formula::reach_end(light, start, towards)?;
    let margin = PIXELS * formula::pixel_length(&drawn.scene, start + end * towards, towards)?;
    let wanted = [(start + (end - margin) * towards, Class::Lit), (start + (end + margin) * towards, Class::Outside)];
    points(on, &drawn, &wanted, &cone.why)
}

/// Holds the share of a class against its limits.
///
/// # Errors
///
/// Another shade.
pub(super) fn count(on: &CaseBench, count: &ClassCount, set: &[String]) -> Result<(), Failure> {
    let drawn = on.draw(&[set, &count.set], Wanted::View(View::Shade, count.light))?;
    need_reach(on, &drawn.picture)?;
    let classes = || drawn.picture.pixels().map(class_of);
    if classes().any(|class| class.is_none()) {
        return Err(on.failure(String::from("a pixel's shade is not in [0, 1]"), &drawn.picture, None));
    }
    let among = classes().filter(|class| count.class == Class::Outside || *class != Some(Class::Outside)).count();
    let of_class = classes().filter(|class| *class == Some(count.class)).count();
    let share = of_class as f64 / among as f64;
    if among > 0 && share >= count.least && share <= count.most {
        return Ok(());
    }
    let ClassCount { class, least, most, why, .. } = count;
    let message = format!("{of_class} of {among} pixels are {class:?}, {share:.5}, not in [{least}, {most}]: {why}");
    Err(on.failure(message, &drawn.picture, None))
}
