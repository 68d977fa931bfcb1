//! Random scenes with images, beams and laws of distance: the picture against colours in f64, pixel by pixel.

use glam::DVec3;
use glumbra::scene::Scene;
use glumbra::truth::{self, ColorPixel};
use image::{Rgb, RgbImage};

use super::{draw, load, renderer};
use crate::support::random::Random;

/// Width of bounds, in codes, up to which a pixel is compared with the value and not with the bounds.
pub const SMOOTH: f64 = 8.0;

/// Codes that a picture may be off: half of one for its own rounding, as much for a map's texels, as much between them, and
/// a filter's weights of 8 bits.
pub const ALLOWED: f64 = 2.0;

/// Noise of one texel or of many, or a smooth ramp.
pub fn picture(random: &mut Random) -> RgbImage {
    let size = [(); 2].map(|()| random.pick(&[1, 2, 5, 16, 33, 64]));
    let is_smooth = random.share() < 0.5;
    let phase = [(); 3].map(|()| random.within(0.0, 6.0));
    RgbImage::from_fn(size[0], size[1], |x, y| {
        let (x, y) = (f64::from(x) / f64::from(size[0]), f64::from(y) / f64::from(size[1]));
        Rgb([0, 1, 2].map(|k| {
            let wave = 0.5 + 0.5 * (phase[k] + 2.0 * x + 3.0 * y).sin();
            (255.0 * if is_smooth { wave } else { random.share() }) as u8
        }))
    })
}

fn beam(random: &mut Random) -> String {
    let mut keys = Vec::new();
    match random.below(3) {
        0 => keys.push(format!("exponent = {:?}", random.pick(&[1.0, 4.0, 12.5, 40.0]))),
        1 => {
            let count = 2 + random.below(6);
            let profile: Vec<f64> = (0..count).map(|_| random.share()).collect();
            keys.push(format!("profile = {profile:?}"));
        }
        _ => {}
    }
    if random.share() < 0.4 {
        keys.push(String::from("shield = \"shield.png\""));
    }
    if random.share() < 0.3 {
        keys.push(format!("lens = {:?}", random.within(-0.4, 0.4)));
    }
    format!("beam = {{ {} }}\n", keys.join(", "))
}

fn falloff(random: &mut Random) -> String {
    match random.below(4) {
        0 => String::from("falloff = \"inverse\"\n"),
        1 => format!("falloff = {{ law = \"inverse-square\", d0 = {:?} }}\n", random.within(0.5, 4.0)),
        2 => format!("falloff = {{ by = \"z\", law = \"inverse\", d0 = {:?} }}\n", random.within(0.5, 4.0)),
        _ => {
            let mut at = random.within(0.2, 2.0);
            let pairs: Vec<[f64; 2]> = (0..1 + random.below(5))
                .map(|_| {
                    at += random.within(0.2, 2.0);
                    [at, random.share()]
                })
                .collect();
            format!("falloff = {{ by = \"z\", table = {pairs:?} }}\n")
        }
    }
}

/// A spotlight with further keys; a projector of slides has no ambient light of its own.
pub fn light(random: &mut Random, technique: &str, more: &str) -> String {
    let (position, target) = (DVec3::new(0.0, 3.2, 0.0) + 1.8 * random.vector(), 0.4 * random.vector());
    let color: [f64; 3] = [(); 3].map(|()| random.within(0.2, 0.9));
    let mut text = format!(
        "[[light]]\nkind = \"spot\"\nposition = {:?}\ntarget = {:?}\nup = {:?}\ncone = {:?}\ncolor = {color:?}\n",
        position.to_array(),
        target.to_array(),
        random.vector().to_array(),
        random.within(20.0, 110.0)
    );
    if random.share() < 0.6 {
        text += &format!("shape = \"frustum\"\naspect = {:?}\n", random.pick(&[1.0, 0.5, 2.0, 3.0]));
    }
    match random.below(3) {
        0 => text += "near = 0.4\nfar = 12.0\n",
        1 => text += "near = 0.001\nfar = 12.0\n",
        _ => {}
    }
    if random.share() < 0.7 {
        let filter = random.pick(&["nearest", "linear", "linear", "trilinear"]);
        text += &format!("image = \"slide.png\"\nfilter = \"{filter}\"\n");
    }
    if random.share() < 0.6 {
        text += &beam(random);
    }
    if random.share() < 0.6 {
        text += &falloff(random);
    }
    if random.share() < 0.3 {
        text += "attenuation = [0.6, 0.1, 0.05]\n";
    }
    if random.share() < 0.3 {
        text += "interpolate = \"segal\"\n";
    }
    if random.share() < 0.3 && !more.contains("\"slide\"") {
        text += "ambient = [0.05, 0.08, 0.02]\n";
    }
    text += more;
    text += &format!("[light.shadow]\n{technique}\n");
    text
}

fn material(random: &mut Random) -> String {
    let [diffuse, specular]: [[f64; 3]; 2] = [1.0, 0.5].map(|most| [(); 3].map(|()| random.within(0.1, most)));
    let specular =
        if random.share() < 0.5 { format!("specular = {specular:?}, shininess = 12.0, ") } else { String::new() };
    let decal = if random.share() < 0.3 { "decal = \"decal.png\", " } else { "" };
    let lit = if random.share() < 0.25 { "lit = false\n" } else { "" };
    format!("{lit}material = {{ {specular}{decal}diffuse = {diffuse:?} }}\n")
}

pub fn objects(random: &mut Random) -> String {
    let mut text = format!("[[object]]\nmesh = \"quad\"\nscale = [6.0, 1.0, 6.0]\n{}", material(random));
    for _ in 0..2 + random.below(2) {
        let mesh = random.pick(&["box", "sphere", "torus"]);
        let mut size: [f64; 3] = [(); 3].map(|()| random.within(0.3, 0.7));
        size[0] *= random.pick(&[1.0, -1.0]);
        text += &format!(
            "[[object]]\nmesh = \"{mesh}\"\nscale = {size:?}\ntranslate = {:?}\nrotate = {{ axis = {:?}, angle = {:?} }}\n{}",
            (DVec3::Y + DVec3::new(1.5, 0.4, 1.5) * random.vector()).to_array(),
            random.vector().to_array(),
            random.within(0.0, 180.0),
            material(random)
        );
    }
    text
}

fn scene(random: &mut Random) -> (Scene, String, Vec<Option<f64>>) {
    let (turn, height) = (random.within(0.0, std::f64::consts::TAU), random.pick(&[0.5, 1.5, 3.0, 5.0]));
    let eye = [5.0 * turn.cos(), height, 5.0 * turn.sin()];
    let lighting = random.pick(&["per-fragment", "per-fragment", "per-vertex"]);
    let mut text = format!(
        "[image]\nsize = [96, 72]\n[camera]\neye = {eye:?}\ntarget = [0.0, 0.4, 0.0]\nfov_y = 45.0\nnear = 0.1\nfar = 60.0\n\
         [shading]\nambient = [0.06, 0.05, 0.09]\nlighting = \"{lighting}\"\n"
    );
    let volumes = random.share() < 0.3;
    let technique = if volumes { "technique = \"shadow-volume\"" } else { "technique = \"none\"" };
    let count = 1 + random.below(2);
    for _ in 0..count {
        text += &light(random, technique, "");
    }
    text += &objects(random);
    let pictures = [picture(random), picture(random), picture(random)];
    let named = [("slide.png", &pictures[0]), ("shield.png", &pictures[1]), ("decal.png", &pictures[2])];
    (load(&text, &named).scene, text, vec![volumes.then_some(0.0); count])
}

/// Error of maps and tables beyond half a code, by their own account.
pub fn admitted(scene: &Scene) -> f64 {
    let spots = scene.lights.iter().filter_map(|light| light.spot());
    let errors = spots.map(|spot| {
        let beam = spot.beam.as_ref().map_or(0.0, |beam| beam.map_error_codes);
        let falloff = spot.falloff.as_ref().map_or(0.0, |falloff| falloff.table.error_codes);
        (beam - 0.5).max(0.0) + (falloff - 0.5).max(0.0)
    });
    errors.sum()
}

#[test]
fn random_scenes_of_projected_light_have_the_colours_of_f64() {
    let (_context, mut renderer) = renderer();
    let options = truth::Options::default();
    let (mut smooth, mut bounded, mut worst) = (0, 0, 0.0_f64);
    let only: Option<usize> = std::env::var("GLUMBRA_ROUND").ok().and_then(|text| text.parse().ok());
    let mut failures = Vec::new();
    for round in 0..120 {
        if only.is_some_and(|only| only != round) {
            continue;
        }
        let mut random = Random::new(500 + round as u64);
        let (scene, text, shadows) = scene(&mut random);
        let truth = truth::color(&scene, &shadows, &options).unwrap();
        let allowed = ALLOWED + admitted(&scene) + truth.between_passes_codes;
        let picture = draw(&scene, &mut renderer);
        let mut wrong: Vec<(usize, [i32; 3], &ColorPixel)> = Vec::new();
        for (index, (pixel, codes)) in truth.pixels.iter().zip(picture).enumerate() {
            if !pixel.is_known {
                continue;
            }
            let found = codes.map(f64::from);
            let off = if pixel.is_smooth(SMOOTH) {
                smooth += 1;
                pixel.error_codes(found)
            } else {
                bounded += 1;
                pixel.excess_codes(found)
            };
            worst = worst.max(off - admitted(&scene) - truth.between_passes_codes);
            if off > allowed {
                wrong.push((index, codes, pixel));
            }
        }
        if let Some((index, codes, pixel)) = wrong.first() {
            failures.push(format!(
                "round {round}: {} wrong; pixel {} {}: {codes:?}, not {:?}\n{text}",
                wrong.len(),
                index % 96,
                index / 96,
                pixel.rgb.map(|channel| [channel.least, channel.value, channel.most].map(|value| 255.0 * value))
            ));
        }
    }
    assert!(failures.is_empty(), "{} rounds:\n{}", failures.len(), failures.join("\n"));
    assert!(only.is_some() || (smooth > 200_000 && bounded > 20_000), "{smooth} {bounded}");
    println!("{smooth} smooth, {bounded} bounded, worst {worst:.2} codes");
}

/// Colour errors of a report: nearly none of the right picture, and large ones of a wrong one.
#[test]
fn a_reports_colour_errors_are_small_for_the_scene_itself_and_large_for_another() {
    use glumbra::judge::colors::{compare_colors, has_projected_light, true_colors};

    let (_context, mut renderer) = renderer();
    let wave = |at: u32| (127.5 + 127.5 * (f64::from(at) / 10.0).sin()) as u8;
    let slide = RgbImage::from_fn(64, 64, |x, y| Rgb([wave(x), wave(y), wave(x + y)]));
    let text = "[image]\nsize = [96, 72]\n[camera]\neye = [3.0, 3.0, 4.0]\ntarget = [0.0, 0.2, 0.0]\n\
         [[light]]\nkind = \"spot\"\nposition = [0.5, 4.0, 1.0]\ntarget = [0.0, 0.0, 0.0]\ncone = 60.0\nimage = \"slide.png\"\n\
         beam = { exponent = 3 }\n[light.shadow]\ntechnique = \"shadow-volume\"\n\
         [[object]]\nmesh = \"quad\"\nscale = [4.0, 1.0, 4.0]\n\
         [[object]]\nmesh = \"box\"\nscale = 0.4\ntranslate = [0.0, 0.6, 0.0]\n";
    let scene = load(text, &[("slide.png", &slide)]).scene;
    let plain = load(&text.replace("image = \"slide.png\"\nbeam = { exponent = 3 }\n", ""), &[]).scene;
    assert!(has_projected_light(&scene) && !has_projected_light(&plain));
    let truth = true_colors(&scene, 0).unwrap();
    let right = compare_colors(&scene, &truth, &mut renderer).unwrap().unwrap();
    assert!(right.compared > 6000 && right.rmse_codes < 2.0, "{right:?}");
    // At the box's shadow a pixel's middle decides; none is beyond what its error explains.
    assert_eq!(right.beyond_percent, 0.0, "{right:?}");
    let wrong = compare_colors(&plain, &truth, &mut renderer).unwrap().unwrap();
    assert!(wrong.rmse_codes > 20.0 && wrong.beyond_percent > 30.0, "{wrong:?}");
}
