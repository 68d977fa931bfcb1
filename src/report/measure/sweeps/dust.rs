//! Slices of dusty air: how fast their bands vanish [LEC, "Combining Shadows with Atmospherics"].

use glam::DVec3;

use super::super::reference::{Error, MANY, in_floats, many_in_words, with_light, with_samples};
use super::{Experiment, SweepRequest, counted};
use crate::frame::Renderer;
use crate::judge::colors::{DrawnColors, draw_colors};
use crate::report::store::swept::LightSweep;
use crate::scene::Scene;
use crate::truth::{self, ColorTruth};

const COUNTS: [u32; 4] = [8, 32, 128, 512];

pub(super) fn experiment(request: &SweepRequest<'_>, renderer: &mut Renderer) -> Result<Option<Experiment>, Error> {
    let scene = request.scene;
    let has_dust = |scene: &Scene| {
        scene.lights.get(request.light).and_then(|light| light.dust).is_some_and(|dust| dust.density > 0.0)
    };
    if !has_dust(scene) {
        return Ok(None);
    }
    let many = MANY;
    let in_floats = in_floats(scene);
    let reference = draw_colors(&with_samples(scene, many), in_floats, renderer)?.to_truth(|_| true);
    let layers = if request.quick { 128 } else { 512 };
    let second = march(request, layers, in_floats, renderer)?;
    let sliced = |jitter: bool| {
        let with = move |count: &u32| {
            Ok(with_light(scene, request.light, |light| {
                if let Some(dust) = &mut light.dust {
                    (dust.slices, dust.jitter) = (*count, jitter);
                }
            }))
        };
        COUNTS.iter().map(with).collect::<Vec<Result<Scene, String>>>()
    };
    let sweep = LightSweep {
        name: String::from("slices of dust"),
        key: String::from("dust.slices"),
        source: String::from("LEC, \"Combining Shadows with Atmospherics\""),
        reference: format!(
            "{} by the same renderer: what remains is the error of few slices alone",
            many_in_words(scene, many)
        ),
        law: String::from(
            "Bands of K slices fall as K^-1: a shadow's edge in the air lies up to a slice off. Jitter makes noise of them.",
        ),
        second_reference: second.as_ref().map(|_| {
            format!(
                "the surfaces as drawn without dust, behind air marched in {layers} steps along each pixel's ray in f64"
            )
        }),
        series: vec![
            counted("slices", "dust.slices", &COUNTS, Some([1.0, 1.0])),
            counted("slices with jitter", "dust.jitter = true, dust.slices", &COUNTS, None),
        ],
    };
    Ok(Some(Experiment { sweep, reference, second, in_floats, scenes: vec![sliced(false), sliced(true)] }))
}

/// The picture with its air marched in f64. `None`: beams of several lights lie over each other.
fn march(
    request: &SweepRequest<'_>,
    layers: u32,
    in_floats: bool,
    renderer: &mut Renderer,
) -> Result<Option<ColorTruth>, Error> {
    let scene = request.scene;
    if scene.lights.iter().filter(|light| light.dust.is_some()).count() != 1 {
        return Ok(None);
    }
    let clear = with_light(scene, request.light, |light| light.dust = None);
    let surfaces = draw_colors(&clear, in_floats, renderer)?;
    let Some(air) = truth::dust(scene, request.light, layers)? else { return Ok(None) };
    let behind = |(codes, air): (&[f64; 3], &truth::Air)| {
        let color = (1.0 - air.opacity) * DVec3::from_array(*codes) + 255.0 * air.color;
        color.to_array()
    };
    let codes = surfaces.codes.iter().zip(&air).map(behind).collect();
    Ok(Some(DrawnColors { codes, ..surfaces }.to_truth(|_| true)))
}
