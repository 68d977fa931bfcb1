//! Makes a case's checks, in the order of its file. The first that fails is the test's message; the pictures of a
//! failure lie under `target/case-failures/`.

use std::path::{Path, PathBuf};

use glam::DVec3;
use glumbra::views::View;

use super::compare::{self, Tolerance};
use super::draw::{self, Drawn, Wanted};
use super::file::{After, Case, Class, Cone, Count, Edge, Of, Pick, Same, Sum};
use super::picture::Picture;
use super::{formula, golden};

/// How many texels and pixels a pick keeps from an edge that it is beside: GL_LINEAR's reach and rounding.
const TEXELS: f64 = 2.2;
const PIXELS: f64 = 1.5;

/// Makes every check of `case`.
///
/// # Errors
///
/// The first check that fails, with what it measured and where the pictures are; a case without checks.
pub fn run(case: &Case) -> Result<(), String> {
    all_checks(case).map_err(|error| format!("{}\n  {error}", case.checks.asks))
}

fn all_checks(case: &Case) -> Result<(), String> {
    let checks = &case.checks;
    if checks.is_empty() {
        return Err(String::from("the case has no checks"));
    }
    if let Some(text) = &checks.fails_with {
        return fails_with(case, text);
    }
    words(case)?;
    for pick in &checks.pick {
        pick_one(case, pick)?;
    }
    checks.edge.iter().try_for_each(|each| edge(case, each))?;
    checks.cone.iter().try_for_each(|each| cone(case, each))?;
    checks.count.iter().try_for_each(|each| count(case, each))?;
    checks.same.iter().try_for_each(|each| same(case, each))?;
    checks.after.iter().try_for_each(|each| after(case, each))?;
    checks.sum.iter().try_for_each(|each| sum(case, each))?;
    if let Some(wanted) = &checks.golden {
        let actual = draw(case, &[], Wanted::Picture)?.picture;
        let how = golden::check(&actual, &case.folder, wanted, golden::blessing())
            .map_err(|(error, expected)| failure(case, error, &actual, expected.as_ref()))?;
        println!("{}: {how}", case.name);
    }
    Ok(())
}

fn all(case: &Case, set: &[String]) -> Vec<String> {
    case.checks.set.iter().chain(set).cloned().collect()
}

fn draw(case: &Case, set: &[String], wanted: Wanted) -> Result<Drawn, String> {
    draw::draw(&case.scene(), &all(case, set), 1, wanted)
}

fn fails_with(case: &Case, text: &str) -> Result<(), String> {
    match draw(case, &[], Wanted::Picture) {
        Ok(_) => Err(format!("the scene draws; it should fail with \"{text}\"")),
        Err(error) if error.contains(text) => Ok(()),
        Err(error) => Err(format!("the error is \"{error}\", without \"{text}\"")),
    }
}

/// Warnings and what was left out.
fn words(case: &Case) -> Result<(), String> {
    let wanted = [&case.checks.warns, &case.checks.leaves_out];
    if wanted.iter().all(|text| text.is_none()) {
        return Ok(());
    }
    let drawn = draw(case, &[], Wanted::Picture)?;
    for (wanted, said) in wanted.into_iter().zip([&drawn.warnings, &drawn.left_out]) {
        if let Some(text) = wanted
            && !said.iter().any(|line| line.contains(text))
        {
            return Err(format!("nothing says \"{text}\": {said:?}"));
        }
    }
    Ok(())
}

fn pick_one(case: &Case, pick: &Pick) -> Result<(), String> {
    let asked = [pick.class.is_some(), pick.shade.is_some(), pick.color.is_some(), pick.formula.is_some()];
    if !asked.contains(&true) {
        return Err(format!("a pick expects nothing ({})", pick.why));
    }
    if pick.class.is_some() || pick.shade.is_some() {
        let drawn = draw(case, &pick.set, Wanted::View(View::Shade, pick.light))?;
        let pixel = pick_pixel(&drawn, pick)?;
        let found = drawn.picture.pixel(pixel);
        let right = pick.class.is_none_or(|class| class_of(found) == Some(class))
            && pick
                .shade
                .is_none_or(|shade| found[1] > 0.0 && (f64::from(found[0]) - shade).abs() <= pick.within / 255.0);
        if !right {
            let wanted = pick.class.map_or_else(|| format!("{:?}", pick.shade), |class| format!("{class:?}"));
            let message = format!("pixel {pixel:?} is {}, not {wanted}: {}", in_words(found), pick.why);
            return Err(failure(case, message, &drawn.picture, None));
        }
    }
    if pick.color.is_some() || pick.formula.is_some() {
        pick_color(case, pick)?;
    }
    Ok(())
}

fn pick_color(case: &Case, pick: &Pick) -> Result<(), String> {
    let drawn = draw(case, &pick.set, Wanted::Picture)?;
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
            return Err(failure(case, message, &drawn.picture, None));
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
fn points(case: &Case, drawn: &Drawn, wanted: &[(DVec3, Class)], why: &str) -> Result<(), String> {
    for (point, class) in wanted {
        let pixel = formula::pixel(&drawn.scene, *point)?;
        let found = drawn.picture.pixel(pixel);
        if class_of(found) != Some(*class) {
            let found = in_words(found);
            let message = format!("{point:.4} at pixel {pixel:?} is {found}, not {class:?}: {why}");
            return Err(failure(case, message, &drawn.picture, None));
        }
    }
    Ok(())
}

fn edge(case: &Case, edge: &Edge) -> Result<(), String> {
    let drawn = draw(case, &edge.set, Wanted::View(View::Shade, 0))?;
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
    points(case, &drawn, &wanted, &edge.why)
}

fn cone(case: &Case, cone: &Cone) -> Result<(), String> {
    let drawn = draw(case, &cone.set, Wanted::View(View::Shade, 0))?;
    let light = drawn.scene.lights.first().ok_or("the scene has no light")?;
    let start = formula::shadow_on_floor(light, formula::frustum(light)?.target, cone.floor);
    let towards = DVec3::from_array(cone.towards).normalize();
    let end = formula::reach_end(light, start, towards)?;
    let margin = PIXELS * formula::pixel_length(&drawn.scene, start + end * towards, towards)?;
    let wanted = [(start + (end - margin) * towards, Class::Lit), (start + (end + margin) * towards, Class::Outside)];
    points(case, &drawn, &wanted, &cone.why)
}

fn count(case: &Case, count: &Count) -> Result<(), String> {
    let drawn = draw(case, &count.set, Wanted::View(View::Shade, count.light))?;
    let classes = || drawn.picture.pixels().map(class_of);
    if classes().any(|class| class.is_none()) {
        return Err(failure(case, String::from("a pixel's shade is not in [0, 1]"), &drawn.picture, None));
    }
    let among = classes().filter(|class| count.class == Class::Outside || *class != Some(Class::Outside)).count();
    let of_class = classes().filter(|class| *class == Some(count.class)).count();
    let share = of_class as f64 / among as f64;
    if among > 0 && share >= count.least && share <= count.most {
        return Ok(());
    }
    let Count { class, least, most, why, .. } = count;
    let message = format!("{of_class} of {among} pixels are {class:?}, {share:.5}, not in [{least}, {most}]: {why}");
    Err(failure(case, message, &drawn.picture, None))
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

fn same(case: &Case, same: &Same) -> Result<(), String> {
    let tolerance = match (same.exact, same.max, same.share) {
        (true, None, None) => Tolerance::EXACT,
        (false, Some(max), Some(share)) => Tolerance { max, mean: f64::INFINITY, share },
        _ => return Err(format!("`same` needs exact = true, or max and share ({})", same.why)),
    };
    if same.of.is_empty() || same.sets.is_empty() {
        return Err(format!("`same` compares nothing ({})", same.why));
    }
    let other_scene = same.scene.as_ref().map_or_else(|| case.scene(), |scene| case.folder.join(scene));
    for of in &same.of {
        let wanted = wanted_of(*of, same.light);
        let expected = draw::draw(&case.scene(), &all(case, &same.with), same.frames, wanted)?.picture;
        for set in &same.sets {
            let actual = draw::draw(&other_scene, &all(case, set), same.frames, wanted)?.picture;
            match compare::compare(&actual, &expected, &tolerance) {
                Ok(found) if found.count > 0 => println!("{}: {of:?} {set:?}: {found}", case.name),
                Ok(_) => {}
                Err(error) => {
                    let message = format!("{of:?} with {set:?} against {:?}: {error} ({})", same.with, same.why);
                    return Err(failure(case, message, &actual, Some(&expected)));
                }
            }
        }
    }
    Ok(())
}

fn after(case: &Case, after: &After) -> Result<(), String> {
    if after.of.is_empty() || after.firsts.is_empty() {
        return Err(format!("`after` compares nothing ({})", after.why));
    }
    for of in &after.of {
        let wanted = wanted_of(*of, 0);
        let expected = draw(case, &[], wanted)?.picture;
        for first in &after.firsts {
            let actual = draw::draw_after(&case.scene(), &all(case, first), &case.checks.set, wanted)?.picture;
            compare::compare(&actual, &expected, &Tolerance::EXACT).map_err(|error| {
                let message = format!("{of:?} after {first:?}: {error} ({})", after.why);
                failure(case, message, &actual, Some(&expected))
            })?;
        }
    }
    Ok(())
}

fn sum(case: &Case, sum: &Sum) -> Result<(), String> {
    let actual = draw(case, &[], Wanted::FloatPicture)?.picture;
    let mut expected = Picture { data: vec![0.0; actual.data.len()], ..actual.clone() };
    let signed = sum.plus.iter().map(|set| (1.0, set)).chain(sum.minus.iter().map(|set| (-1.0, set)));
    for (sign, set) in signed {
        let term = draw(case, set, Wanted::FloatPicture)?.picture;
        if term.data.len() != actual.data.len() {
            return Err(String::from("a term of the sum has another size"));
        }
        expected.data.iter_mut().zip(&term.data).for_each(|(total, value)| *total += sign * value);
    }
    let tolerance = Tolerance { max: sum.max, mean: f64::INFINITY, share: 1.0 };
    compare::compare(&actual, &expected, &tolerance)
        .map(drop)
        .map_err(|error| failure(case, format!("the sum: {error} ({})", sum.why), &actual, Some(&expected)))
}

/// Writes the pictures of a failure and adds their place to its message.
fn failure(case: &Case, message: String, actual: &Picture, expected: Option<&Picture>) -> String {
    let folder = failures().join(&case.name);
    let mut written = Vec::new();
    let mut write = |name: &str, picture: &Picture| {
        let path = folder.join(name);
        match picture.write_png(&path) {
            Ok(()) => written.push(path.display().to_string()),
            Err(error) => written.push(error),
        }
    };
    // Without the folder, writing the first picture says so.
    let _ = std::fs::remove_dir_all(&folder);
    let _ = std::fs::create_dir_all(&folder);
    write("actual.png", actual);
    if let Some(expected) = expected {
        write("expected.png", expected);
        if let Some(difference) = actual.difference(expected) {
            write("difference.png", &difference);
        }
    }
    format!("{message}\n  see {}", written.join("\n      "))
}

fn failures() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    target.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("target")).join("case-failures")
}
