//! Lens points: how fast accumulation comes near to a whole lens [Segal 1992, 3.1; Haeberli and Akeley 1990]; and, beside
//! it, percentage-closer filtering of the light from the lens's middle, which softens edges too [LEC, "Hardware Shadow Map
//! Filtering"].

use super::super::reference::{Error, Samples, in_floats, many_in_words, with_samples, with_spot};
use super::{Experiment, SweepRequest, counted, series};
use crate::frame::Renderer;
use crate::judge::colors::draw_colors;
use crate::report::store::swept::LightSweep;
use crate::scene::{self, Scene, with_shadow};
use crate::techniques::{self, LightShadow, vary};

const COUNTS: [u32; 5] = [1, 4, 16, 64, 256];
const KERNELS: [u32; 4] = [1, 3, 5, 7];

/// Name of the series of lens points.
pub const POINTS: &str = "lens points";
/// Name of the series of kernels.
pub const FILTERING: &str = "PCF kernels";

/// Lens points of the light as it is; with kernels beside them, if it has no image that the lens would blur too.
pub(super) fn experiment(request: &SweepRequest<'_>, renderer: &mut Renderer) -> Result<Option<Experiment>, Error> {
    let has_image = image_of(request.scene, request.light);
    through_lens(request.scene, request, ("lens points", !has_image), renderer)
}

/// The same without the image, for the shadows alone.
pub(super) fn without_image(request: &SweepRequest<'_>, renderer: &mut Renderer) -> Result<Option<Experiment>, Error> {
    let light = request.light;
    if !image_of(request.scene, light) || !filters_by_kernels(request.scene, light) {
        return Ok(None);
    }
    let even = with_spot(request.scene, light, |spot| spot.image = None);
    through_lens(&even, request, ("soft shadows without the image", true), renderer)
}

fn image_of(scene: &Scene, light: usize) -> bool {
    scene.lights.get(light).and_then(|light| light.spot()?.image.as_ref()).is_some()
}

fn through_lens(
    scene: &Scene,
    request: &SweepRequest<'_>,
    (name, with_kernels): (&str, bool),
    renderer: &mut Renderer,
) -> Result<Option<Experiment>, Error> {
    let light = request.light;
    let Some(focus) = scene.lights.get(light).and_then(|light| light.spot()?.lens()) else { return Ok(None) };
    let many = Samples { lens_points: if request.quick { 1024 } else { 4096 }, slices: 4096 };
    let counts = if request.quick { &COUNTS[..4] } else { &COUNTS[..] };
    let in_floats = in_floats(scene);
    let whole = with_samples(scene, many);
    let reference = draw_colors(&whole, in_floats, renderer)?.to_truth(|_| true);
    let through = |count: &u32| {
        let focus = scene::Focus { samples: *count, ..focus };
        Ok(with_spot(scene, light, |spot| spot.focus = Some(focus)))
    };
    let mut all = vec![counted(POINTS, "focus.samples", counts, Some([0.5, 1.0]))];
    let mut scenes: Vec<Vec<Result<Scene, String>>> = vec![counts.iter().map(through).collect()];
    if with_kernels && filters_by_kernels(scene, light) {
        let value = |side: &u32| {
            (format!("{side} × {side}"), None, format!("no focus, shadow.kernel = {side}, shadow.filter = \"linear\""))
        };
        all.push(series(FILTERING, KERNELS.iter().map(value).collect(), None));
        scenes.push(KERNELS.iter().map(|side| filtered(scene, light, *side)).collect());
    }
    let sweep = LightSweep {
        name: name.to_owned(),
        key: String::from("focus.samples"),
        source: String::from("Segal 1992, 3.1; Haeberli and Akeley 1990"),
        reference: format!(
            "{} by the same renderer: what remains is the error of few samples alone",
            many_in_words(scene, many)
        ),
        law: String::from(
            "The RMSE of n points falls as n^-1/2 where they are random and as n^-1 where each stands for an equal part of \
             the lens and edges cross few parts.",
        ),
        second_reference: None,
        series: all,
    };
    Ok(Some(Experiment { sweep, reference, second: None, in_floats, scenes }))
}

/// Tests whether the light's technique compares by kernels.
fn filters_by_kernels(scene: &Scene, light: usize) -> bool {
    let read = scene.lights.get(light).and_then(|light| LightShadow::of(&light.shadow));
    read.is_some_and(|read| read.technique.draws_shadows() && techniques::keys(read.technique).contains(&"kernel"))
}

/// The scene with all light from the middle of the lens, and a kernel of `side` comparisons a side.
fn filtered(scene: &Scene, light: usize, side: u32) -> Result<Scene, String> {
    let scene = with_spot(scene, light, |spot| spot.focus = None);
    let source = scene.lights.get(light).ok_or_else(String::new)?;
    let technique = vary::technique_of(source.shadow.written());
    let inside = format!("technique = \"{technique}\", kernel = {side}, filter = \"linear\"");
    let keys = scene::shadow_settings(&inside).map_err(|error| error.to_string())?;
    let table = vary::over(source.shadow.written(), &keys);
    let shadow = techniques::read(table, &source.kind, &scene.objects).map_err(|error| error.to_string())?;
    Ok(with_shadow(&scene, light, &shadow))
}
