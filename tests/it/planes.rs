//! One plane in the light, anywhere in its frustum, at any slant and of any size: no tap of any lookup finds it dark.

use glam::{DQuat, DVec3};
use glumbra::context::{self, ContextRequest};
use glumbra::frame::{Renderer, draw_shade};
use glumbra::scene::Scene;
use glumbra::techniques;
use glumbra::truth::{self, Answer};

use crate::support::random::Random;
use crate::support::scene_of;

/// A square that faces the light from up to 48 % of the cone's angle off its axis, turned away from it by up to 80
/// degrees, seen from its lit side; all of it `unit` times as large.
fn plane(random: &mut Random, unit: f64) -> Scene {
    let cone = random.within(20.0, 160.0);
    let off = random.within(0.0, 0.48 * cone).to_radians();
    let around = random.within(0.0, std::f64::consts::TAU);
    let ray = DVec3::new(off.sin() * around.cos(), -off.cos(), off.sin() * around.sin());
    let distance = random.within(1.0, 5.0);
    let slant = random.within(0.0, 80.0_f64.powi(2)).sqrt().to_radians();
    let side = ray.cross(random.vector()).normalize();
    let normal = DQuat::from_axis_angle(side, slant) * -ray;
    let (axis, angle) = DQuat::from_rotation_arc(DVec3::Y, normal).to_axis_angle();
    let half = random.within(0.1, 0.5) * distance;
    let center = distance * ray;
    let eye = center + random.within(1.5, 3.0) * half * (normal + 0.7 * random.vector()).normalize();
    let text = format!(
        "[image]\nsize = [64, 48]\n[camera]\neye = {:?}\ntarget = {:?}\nfov_y = 40.0\nnear = {:?}\nfar = {:?}\n\
         [[light]]\nkind = \"spot\"\nposition = [0, 0, 0]\ntarget = {:?}\nup = [0, 0, 1]\ncone = {cone:?}\n\
         near = {:?}\nfar = {:?}\nshape = \"frustum\"\n\
         [[object]]\nmesh = \"quad\"\nscale = {:?}\ntranslate = {:?}\nrotate = {{ axis = {:?}, angle = {:?} }}\n",
        (unit * eye).to_array(),
        (unit * center).to_array(),
        0.05 * half * unit,
        100.0 * half * unit,
        (-unit * DVec3::Y).to_array(),
        0.05 * unit,
        20.0 * unit,
        [unit * half, 1.0, unit * half],
        (unit * center).to_array(),
        axis.to_array(),
        angle.to_degrees(),
    );
    scene_of(&text)
}

/// The bias follows from the map's own axes: a normal offset by the angle of the light's ray in place of its axis darkens
/// half of a plane that faces the light 60 degrees off the axis.
#[test]
fn no_bias_leaves_a_plane_dark_wherever_it_stands_and_however_large_it_is() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut renderer = Renderer::new(&context);
    let mut lookups = Vec::new();
    for bias in ["offset", "receiver-plane", "normal-offset", "adaptive"] {
        for lookup in ["kernel = 1", "kernel = \"5x5\"", "filter = \"nearest\""] {
            lookups.push(format!("technique = \"shadow-map\", bias = \"{bias}\", {lookup}"));
        }
    }
    let (mut lit, mut failures) = (0, Vec::new());
    for seed in 0..24 {
        let random = &mut Random::new(seed);
        // Every third as the light's unit is; the others from the smallest to the largest.
        let unit = if seed % 3 == 0 { 1.0 } else { 10.0_f64.powf(random.within(-15.5, 16.0)) };
        let scene = plane(random, unit);
        let truth = truth::trace(&scene, 0, &truth::Options { most_ambiguous: 1.0, ..Default::default() }).unwrap();
        for keys in &lookups {
            let keys = format!("{keys}, size = {}", if seed % 2 == 0 { 256 } else { 1024 });
            let scene = techniques::with_keys(&scene, 0, &keys).unwrap();
            let shade = draw_shade(&scene, 0, &mut renderer).unwrap();
            let is_lit =
                |pixel: &truth::Pixel| pixel.answer == Answer::Lit && pixel.hit.is_some_and(|hit| hit.faces_light());
            let pixels = truth.pixels.iter().enumerate().filter(|(_, pixel)| is_lit(pixel));
            let dark = pixels.clone().filter(|(index, _)| shade.covered[*index] && shade.shade[*index] < 1.0).count();
            if dark > 0 {
                failures.push(format!("{dark} taps of plane {seed}, {unit:.1e} times as large, under {keys}"));
            }
            lit += pixels.count();
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
    assert!(lit > 100_000, "{lit}");
}
