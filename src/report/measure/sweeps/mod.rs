//! Sweeps over the keys of projected light: pictures of few and many lens points, slices of dusty air and filters of
//! images, each with its colour errors and its time.

mod dust;
mod filters;
mod lens;

pub use lens::{FILTERING, POINTS};

use image::RgbImage;

use super::costs;
use super::fit::power_law;
use super::reference::Error;
use crate::frame::Renderer;
use crate::judge::colors::{draw_colors, errors_of, known_or_drawn};
use crate::plan::Request;
use crate::report::store::swept::{LightSweep, PointErrors, PointOutcome, SweepPoint, SweepSeries};
use crate::scene::Scene;
use crate::truth::{ColorTruth, Truth};

/// Scene, and how thoroughly it is measured.
pub struct SweepRequest<'a> {
    /// The scene as written.
    pub scene: &'a Scene,
    /// Index of the measured light.
    pub light: usize,
    /// The ray tracer's answer for it.
    pub truth: &'a Truth,
    /// True for fewer values.
    pub quick: bool,
    /// Timed frames for each picture, at least 1.
    pub runs: usize,
}

/// A sweep with its pictures.
pub struct MeasuredSweep {
    /// Errors and times.
    pub sweep: LightSweep,
    /// Picture that all others are compared with.
    pub reference: RgbImage,
    /// Pictures of each series and point; `None`: it could not be drawn.
    pub points: Vec<Vec<Option<PointPictures>>>,
}

/// One picture of a sweep.
pub struct PointPictures {
    /// The picture.
    pub drawn: RgbImage,
    /// FLIP in colours; `None`: it is too large to have one.
    pub flip: Option<RgbImage>,
}

/// A sweep that is laid out and not yet measured.
struct Experiment {
    sweep: LightSweep,
    reference: ColorTruth,
    second: Option<ColorTruth>,
    in_floats: bool,
    /// Scene of each series and point, or the reason why it has none.
    scenes: Vec<Vec<Result<Scene, String>>>,
}

/// Measures every sweep that the light has keys for.
///
/// # Errors
///
/// A reference that cannot be had. Errors of single pictures are kept in their points.
pub fn measure(
    request: &SweepRequest<'_>,
    renderer: &mut Renderer,
    mut tick: impl FnMut(&str),
) -> Result<Vec<MeasuredSweep>, Error> {
    let mut measured = Vec::new();
    for lay_out in [lens::experiment, lens::without_image, dust::experiment, filters::experiment] {
        tick("a reference");
        if let Some(experiment) = lay_out(request, renderer)? {
            measured.push(carry_out(experiment, request.runs, renderer, &mut tick));
        }
    }
    Ok(measured)
}

fn carry_out(
    experiment: Experiment,
    runs: usize,
    renderer: &mut Renderer,
    tick: &mut impl FnMut(&str),
) -> MeasuredSweep {
    let Experiment { mut sweep, reference, second, in_floats, scenes } = experiment;
    let mut pictures = Vec::new();
    let mut of_reference = None;
    for (series, scenes) in sweep.series.iter_mut().zip(&scenes) {
        let mut of_series = Vec::new();
        for (point, scene) in series.points.iter_mut().zip(scenes) {
            tick(&format!("{}: {}", series.name, point.label));
            let drawn = scene
                .clone()
                .and_then(|scene| point_of(&scene, [Some(&reference), second.as_ref()], in_floats, runs, renderer));
            let (outcome, pictures) = match drawn {
                Ok((errors, pictures, shown)) => {
                    of_reference.get_or_insert(shown);
                    (PointOutcome::Measured(errors), Some(pictures))
                }
                Err(why) => (PointOutcome::Failed(why), None),
            };
            point.outcome = outcome;
            of_series.push(pictures);
        }
        pictures.push(of_series);
        series.fit = power_law(&pairs(series));
    }
    MeasuredSweep { sweep, reference: of_reference.unwrap_or_default(), points: pictures }
}

/// Counts and errors of a series.
fn pairs(series: &SweepSeries) -> Vec<[f64; 2]> {
    let pair = |point: &SweepPoint| Some([point.count?, point.measured()?.errors.rmse_codes]);
    series.points.iter().filter_map(pair).collect()
}

fn point_of(
    scene: &Scene,
    [reference, second]: [Option<&ColorTruth>; 2],
    in_floats: bool,
    runs: usize,
    renderer: &mut Renderer,
) -> Result<(PointErrors, PointPictures, RgbImage), String> {
    let drawn = draw_colors(scene, in_floats, renderer).map_err(|error| error.to_string())?;
    let none = || String::from("no pixel could be compared");
    let reference = reference.ok_or_else(none)?;
    let (errors, map) = errors_of(reference, &drawn).ok_or_else(none)?;
    let second = second.and_then(|second| errors_of(second, &drawn)).map(|(errors, _)| errors);
    let request = Request { frames: 100, sampled_warnings: false, ..Request::default() };
    let plan = renderer.plan(scene, &request).map_err(|error| error.to_string())?;
    let frame = costs::redrawn(&plan, runs, renderer).map_err(|error| error.to_string())?;
    let pictures = PointPictures { drawn: drawn.to_image(), flip: map.map(|map| map.picture()) };
    Ok((PointErrors { errors, second, frame }, pictures, known_or_drawn(reference, &drawn)))
}

/// A series whose points are not measured yet. `values`: each point's label, count and setting.
fn series(name: &str, values: Vec<(String, Option<f64>, String)>, expected: Option<[f64; 2]>) -> SweepSeries {
    let point = |(label, count, setting): (String, Option<f64>, String)| SweepPoint {
        setting,
        label,
        count,
        outcome: PointOutcome::Failed(String::from("it was not drawn")),
    };
    SweepSeries { name: name.to_owned(), points: values.into_iter().map(point).collect(), fit: None, expected }
}

/// A series over whole numbers of one key.
fn counted(name: &str, key: &str, counts: &[u32], expected: Option<[f64; 2]>) -> SweepSeries {
    let value = |count: &u32| (count.to_string(), Some(f64::from(*count)), format!("{key} = {count}"));
    series(name, counts.iter().map(value).collect(), expected)
}
