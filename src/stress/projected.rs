//! Random scenes whose spotlights have images, beams and laws of distance, and photographs on objects, and the judgement of their colours: each pixel
//! against its colour in f64, without shadows, which the other rows judge.

use fastrand::Rng;

use super::case::{Case, files_named_in};
use super::photos::with_photos;
use super::random;
use super::results::{CaseRow, Verdict};
use super::rows::RowSettings;
use crate::device::Pixels;
use crate::frame::{self, Renderer};
use crate::plan::Request;
use crate::report::measure::colors::color_options;
use crate::scene::Scene;
use crate::techniques;
use crate::truth;

/// Codes of 1/255 that a pixel may be off beyond what the error of its sample explains: its own rounding, and half a code
/// each for the texels of a map, between them, and between those of a law of distance.
const ALLOWED_CODES: f64 = 2.0;

/// Scene number `index` of `seed`: the random scene of these numbers, with more keys for its spotlights.
pub fn case(seed: u64, index: u64) -> Case {
    let plain = random::case(seed, index);
    let mut rng = Rng::with_seed(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ index ^ 0x6c69_6768_7400);
    let mut toml = String::new();
    let mut planes = [1.0, 10.0];
    for line in plain.toml.lines() {
        toml.push_str(line);
        toml.push('\n');
        for (plane, key) in planes.iter_mut().zip(["near = ", "far = "]) {
            let value = line.strip_prefix(key).and_then(|value| value.parse().ok());
            *plane = value.unwrap_or(*plane);
        }
        if line.starts_with("shape = ") {
            add_keys(&mut rng, planes, line.contains("frustum"), &mut toml);
        }
    }
    let toml = with_photos(seed, index, &toml);
    let (name, why) = (format!("projected-{seed}-{index}"), String::from("a random scene in projected light"));
    Case { name, why, files: files_named_in(&toml), toml, ..plain }
}

fn add_keys(rng: &mut Rng, [near, far]: [f64; 2], is_frustum: bool, toml: &mut String) {
    let mut chance = |share: f64| rng.f64() < share;
    let (has_aspect, has_image, has_beam, has_falloff, divides) =
        (is_frustum && chance(0.5), chance(0.6), chance(0.6), chance(0.6), chance(0.3));
    if has_aspect {
        toml.push_str(&format!("aspect = {:?}\n", [0.2, 0.5, 1.5, 4.0][rng.usize(0..4)]));
    }
    if has_image {
        let filter = ["nearest", "linear", "trilinear"][rng.usize(0..3)];
        toml.push_str(&format!("image = \"floor.png\"\nfilter = \"{filter}\"\n"));
    }
    if has_beam {
        let profile = match rng.usize(0..3) {
            0 => format!("exponent = {:?}", [0.5, 2.0, 10.0, 60.0][rng.usize(0..4)]),
            1 => format!("profile = [1.0, {:.2}, {:.2}, 0.0]", rng.f64(), rng.f64()),
            _ => String::from("shield = \"barn-doors.png\""),
        };
        let lens = if rng.f64() < 0.3 { format!(", lens = {:.2}", rng.f64() - 0.5) } else { String::new() };
        toml.push_str(&format!("beam = {{ {profile}{lens} }}\n"));
    }
    if has_falloff {
        let full = (near * far).sqrt() * (0.3 + 3.0 * rng.f64());
        toml.push_str(&match rng.usize(0..3) {
            0 => format!("falloff = {{ by = \"z\", law = \"inverse\", d0 = {full:e} }}\n"),
            1 => format!("falloff = {{ by = \"z\", law = \"inverse-square\", d0 = {full:e} }}\n"),
            _ => format!(
                "falloff = {{ by = \"z\", table = [[{:e}, 1.0], [{:e}, 0.5], [{:e}, 0.1]] }}\n",
                0.1 * far,
                0.3 * far,
                0.9 * far
            ),
        });
    }
    if divides {
        toml.push_str("interpolate = \"segal\"\n");
    }
}

/// The picture of `scene` without shadows, as a row of technique `none`.
pub fn color_row(scene: &Scene, renderer: &mut Renderer) -> CaseRow {
    let settings = RowSettings { technique: String::from("none"), keys: String::new(), pictured: true };
    let row = CaseRow::new(0, &settings);
    let mut scene = scene.clone();
    scene.lights.iter_mut().for_each(|light| light.shadow = techniques::unshadowed());
    let colors = match truth::color(&scene, &vec![None; scene.lights.len()], &color_options(&scene)) {
        Ok(colors) => colors,
        Err(error) => return CaseRow { verdict: Verdict::Refused, why: error.to_string(), ..row },
    };
    let (picture, warnings) = match draw(&scene, renderer) {
        Ok(drawn) => drawn,
        Err(error) => return CaseRow { verdict: Verdict::Refused, why: error.to_string(), ..row },
    };
    let known = colors.pixels.iter().zip(picture.as_chunks::<4>().0).filter(|(pixel, _)| pixel.is_known);
    let (mut compared, mut beyond) = (0, 0);
    for (pixel, codes) in known {
        compared += 1;
        beyond += usize::from(pixel.excess_codes([0, 1, 2].map(|k| f64::from(codes[k]))) > ALLOWED_CODES);
    }
    let verdict = match (beyond == 0, warnings.is_empty()) {
        (true, true) => Verdict::Right,
        (true, false) => Verdict::FalseAlarm,
        (false, false) => Verdict::Warned,
        (false, true) => Verdict::SilentlyWrong,
    };
    CaseRow { verdict, compared, wrong: beyond, beyond, why: warnings.join("; "), ..row }
}

fn draw(scene: &Scene, renderer: &mut Renderer) -> Result<(Vec<u8>, Vec<String>), frame::Error> {
    let plan = renderer.plan(scene, &Request::default())?;
    renderer.draw(&plan)?;
    let data = match renderer.read(&plan)?.picture {
        Pixels::Rgba8 { data, .. } => data,
        _ => Vec::new(),
    };
    Ok((data, plan.warnings))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_loads_and_most_have_projected_light() {
        let folder = tempfile::tempdir().unwrap();
        let mut projected = 0;
        for index in 0..60 {
            let case = case(3, index);
            let loaded = case.load(folder.path()).unwrap_or_else(|error| panic!("{error}\n{}", case.toml));
            projected += usize::from(crate::report::measure::colors::has_projected_light(&loaded.scene));
        }
        assert!(projected > 20, "{projected} of 60");
    }
}
