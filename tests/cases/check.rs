//! Makes a case's checks, in the order of its file. The first that fails is the test's message; the pictures of a
//! failure lie under `target/case-failures/`.

use glam::DVec3;
use glumbra::views::View;

use super::bench::Bench;
use super::compare::{self, Tolerance};
use super::draw::{self, Drawn, Wanted};
use super::file::{After, Case, Class, Cone, Count, Edge, Of, Pick, Same, Sets, Sum};
use super::formula;
use super::golden;
use super::picture::Picture;
use super::refused;

/// Texels and pixels between a pick and an edge that it is beside: GL_LINEAR's reach and rounding.
const TEXELS: f64 = 2.2;
const PIXELS: f64 = 1.5;

/// Makes every check of `case`.
///
/// # Errors
///
/// The first check that fails, with what it measured and where the pictures are; a case without checks.
pub fn run(case: &Case) -> Result<(), String> {
    let checked = refused::check(case).and_then(|()| {
        case.variants().iter().try_for_each(|case| {
            all_checks(&Bench::new(case)).map_err(|error| match &case.variant {
                Some(set) => format!("for_each {set:?}: {error}"),
                None => error,
            })
        })
    });
    checked.map_err(|error| format!("{}\n  {error}", case.checks.asks))
}

fn all_checks(on: &Bench) -> Result<(), String> {
    let checks = &on.case.checks;
    if let Some(text) = &checks.fails_with {
        return fails_with(on, text);
    }
    words(on)?;
    checks.pick.iter().try_for_each(|each| repeat(each.for_each.as_ref(), |set| pick(on, each, set)))?;
    checks.edge.iter().try_for_each(|each| repeat(each.for_each.as_ref(), |set| edge(on, each, set)))?;
    checks.cone.iter().try_for_each(|each| repeat(each.for_each.as_ref(), |set| cone(on, each, set)))?;
    checks.count.iter().try_for_each(|each| repeat(each.for_each.as_ref(), |set| count(on, each, set)))?;
    checks.same.iter().try_for_each(|each| repeat(each.for_each.as_ref(), |set| same(on, each, set)))?;
    checks.after.iter().try_for_each(|each| after(on, each))?;
    checks.sum.iter().try_for_each(|each| sum(on, each))?;
    if let Some(wanted) = &checks.golden {
        let actual = &on.draw(&[], Wanted::Picture)?.picture;
        let how = golden::check(actual, &on.case.folder, wanted, golden::blessing())
            .map_err(|(error, expected)| on.failure(error, actual, expected.as_ref()))?;
        println!("{}: {how}", on.case.name);
    }
    Ok(())
}

/// Makes a check with each set of its `for_each`, or once where it has none.
fn repeat(for_each: Option<&Sets>, check: impl Fn(&[String]) -> Result<(), String>) -> Result<(), String> {
    let Some(sets) = for_each else { return check(&[]) };
    sets.iter().try_for_each(|set| check(set).map_err(|error| format!("for_each {set:?}: {error}")))
}

fn fails_with(on: &Bench, text: &str) -> Result<(), String> {
    match on.draw(&[], Wanted::Picture) {
        Ok(_) => Err(format!("the scene draws; it should fail with \"{text}\"")),
        Err(error) if error.contains(text) => Ok(()),
        Err(error) => Err(format!("the error is \"{error}\", without \"{text}\"")),
    }
}

/// Warnings and what was left out.
fn words(on: &Bench) -> Result<(), String> {
    let wanted = [&on.case.checks.warns, &on.case.checks.leaves_out];
    if wanted.iter().all(|text| text.is_none()) {
        return Ok(());
    }
    let drawn = on.draw(&[], Wanted::Picture)?;
    for (wanted, said) in wanted.into_iter().zip([&drawn.warnings, &drawn.left_out]) {
        if let Some(text) = wanted
            && !said.iter().any(|line| line.contains(text))
        {
            return Err(format!("nothing says \"{text}\": {said:?}"));
        }
    }
    Ok(())
}

fn pick(on: &Bench, pick: &Pick, set: &[String]) -> Result<(), String> {
    let sets = [set, &pick.set];
    if pick.class.is_some() || pick.shade.is_some() {
        let drawn = on.draw(&sets, Wanted::View(View::Shade, pick.light))?;
        let pixel = pick_pixel(&drawn, pick)?;
        let found = drawn.picture.pixel(pixel);
        let right = pick.class.is_none_or(|class| class_of(found) == Some(class))
            && pick
                .shade
                .is_none_or(|shade| found[1] > 0.0 && (f64::from(found[0]) - shade).abs() <= pick.within / 255.0);
        if !right {
            let wanted = pick.class.map_or_else(|| format!("{:?}", pick.shade), |class| format!("{class:?}"));
            let message = format!("pixel {pixel:?} is {}, not {wanted}: {}", in_words(found), pick.why);
            return Err(on.failure(message, &drawn.picture, None));
        }
    }
    if pick.color.is_some() || pick.formula.is_some() {
        pick_color(on, pick, &sets)?;
    }
    Ok(())
}

fn pick_color(on: &Bench, pick: &Pick, sets: &[&[String]]) -> Result<(), String> {
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

fn pick_pixel(drawn: &Drawn, pick: &Pick) -> Result<[u32; 2], String> {
    match (pick.pixel, pick.at) {
        (Some(pixel), _) => Ok(pixel),
        (None, Some(at)) => formula::pixel(&drawn.scene, DVec3::from_array(at)),
        (None, None) => Err(format!("a pick has neither `at` nor `pixel` ({})", pick.why)),
    }
}

fn class_of(shade: &[f32]) -> Option<Class> {
    match *shade {
        [_, 0.0] => Some(Class::Outside),
        [0.0, 1.0] => Some(Class::Shadowed),
        [1.0, 1.0] => Some(Class::Lit),
        [value, 1.0] if value > 0.0 && value < 1.0 => Some(Class::Partial),
        _ => None,
    }
}

fn in_words(shade: &[f32]) -> String {
    class_of(shade).map_or_else(|| format!("{shade:?}"), |class| format!("{class:?} {shade:?}"))
}

/// Holds the shade at points of a floor against classes.
fn points(on: &Bench, drawn: &Drawn, wanted: &[(DVec3, Class)], why: &str) -> Result<(), String> {
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

fn edge(on: &Bench, edge: &Edge, set: &[String]) -> Result<(), String> {
    let drawn = on.draw(&[set, &edge.set], Wanted::View(View::Shade, 0))?;
    let light = drawn.scene.lights.first().ok_or("the scene has no light")?;
    let outward = DVec3::from_array(edge.outward).normalize();
    let caster = match (edge.caster, &edge.sphere) {
        (Some(caster), None) => DVec3::from_array(caster),
        (None, Some(sphere)) => formula::tangent_point(light, sphere, outward),
        _ => return Err(format!("an edge needs a caster or a sphere ({})", edge.why)),
    };
    let at = formula::shadow_on_floor(light, caster, edge.floor);
    let texels = TEXELS * formula::texel_length(formula::frustum(light)?, formula::map_size(light), at);
    let margin = texels + PIXELS * formula::pixel_length(&drawn.scene, at, outward)?;
    let wanted = [(at - margin * outward, Class::Shadowed), (at + margin * outward, Class::Lit)];
    points(on, &drawn, &wanted, &edge.why)
}

fn cone(on: &Bench, cone: &Cone, set: &[String]) -> Result<(), String> {
    let drawn = on.draw(&[set, &cone.set], Wanted::View(View::Shade, 0))?;
    let light = drawn.scene.lights.first().ok_or("the scene has no light")?;
    let start = formula::shadow_on_floor(light, formula::frustum(light)?.target, cone.floor);
    let towards = DVec3::from_array(cone.towards).normalize();
    let end = formula::reach_end(light, start, towards)?;
    let margin = PIXELS * formula::pixel_length(&drawn.scene, start + end * towards, towards)?;
    let wanted = [(start + (end - margin) * towards, Class::Lit), (start + (end + margin) * towards, Class::Outside)];
    points(on, &drawn, &wanted, &cone.why)
}

fn count(on: &Bench, count: &Count, set: &[String]) -> Result<(), String> {
    let drawn = on.draw(&[set, &count.set], Wanted::View(View::Shade, count.light))?;
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
    let Count { class, least, most, why, .. } = count;
    let message = format!("{of_class} of {among} pixels are {class:?}, {share:.5}, not in [{least}, {most}]: {why}");
    Err(on.failure(message, &drawn.picture, None))
}

fn wanted_of(of: Of, light: usize) -> Wanted {
    match of {
        Of::Picture => Wanted::Picture,
        Of::Shade => Wanted::View(View::Shade, light),
        Of::Depth => Wanted::View(View::Depth, 0),
        Of::LightDepth => Wanted::View(View::LightDepth, light),
        Of::LightDistance => Wanted::View(View::LightDistance, light),
    }
}

fn same(on: &Bench, same: &Same, set: &[String]) -> Result<(), String> {
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
                Ok(found) if found.count > 0 => println!("{}: {of:?} {other:?}: {found}", on.case.name),
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

fn after(on: &Bench, after: &After) -> Result<(), String> {
    for of in &after.of {
        let wanted = wanted_of(*of, 0);
        let expected = &on.draw(&[], wanted)?.picture;
        for first in &after.firsts {
            let actual = draw::draw_after(&on.case.scene(), &on.all(&[first]), &on.all(&[]), wanted)?.picture;
            compare::compare(&actual, expected, &Tolerance::EXACT).map_err(|error| {
                let message = format!("{of:?} after {first:?}: {error} ({})", after.why);
                on.failure(message, &actual, Some(expected))
            })?;
        }
    }
    Ok(())
}

fn sum(on: &Bench, sum: &Sum) -> Result<(), String> {
    let actual = &on.draw(&[], Wanted::FloatPicture)?.picture;
    let mut expected = Picture { data: vec![0.0; actual.data.len()], ..actual.clone() };
    let signed = sum.plus.iter().map(|set| (1.0, set)).chain(sum.minus.iter().map(|set| (-1.0, set)));
    for (sign, set) in signed {
        let term = &on.draw(&[set], Wanted::FloatPicture)?.picture;
        if term.data.len() != actual.data.len() {
            return Err(String::from("a term of the sum has another size"));
        }
        expected.data.iter_mut().zip(&term.data).for_each(|(total, value)| *total += sign * value);
    }
    let tolerance = Tolerance { max: sum.max, mean: f64::INFINITY, share: 1.0, ..Tolerance::EXACT };
    compare::compare(actual, &expected, &tolerance)
        .map(drop)
        .map_err(|error| on.failure(format!("the sum: {error} ({})", sum.why), actual, Some(&expected)))
}
