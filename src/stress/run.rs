//! Runs cases on as many contexts as there are jobs.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use super::case::{Case, CaseSource};
use super::colors;
use super::judge::{Judged, RowJudge};
use super::results::{CaseResult, CaseRow, RowPictures, Verdict};
use super::rows::{RowSettings, row_of, rows};
use crate::context::{self, ContextRequest};
use crate::frame::{self, Renderer};
use crate::geometry::Material;
use crate::judge::{Bound, difference};
use crate::png_file::{self, PngTexts};
use crate::scene::{BumpShading, Light, Scene};
use crate::truth::Truth;

/// Options of a run.
#[derive(Clone, Debug)]
pub struct StressOptions {
    /// Cases drawn at once, each on a context of its own.
    pub jobs: usize,
    /// Only rows of this technique; `None`: of all.
    pub technique: Option<String>,
    /// Share of the rows, as one in so many: those with a technique's default settings and, of the others, every one of so
    /// many, beginning at another place in each case. 1: all. Rows that a case names itself are all drawn.
    pub one_in: usize,
    /// True if pictures of wrong rows are kept.
    pub pictures: bool,
    /// Contexts that the cases are drawn on.
    pub context: ContextRequest,
}

/// Draws and judges `cases`, calling `finished` with each as it is done, until all are or `stop` is set.
///
/// # Errors
///
/// A context that cannot be had; a folder for scene files that cannot be made.
pub fn run(
    cases: &[Case],
    options: &StressOptions,
    stop: &Arc<AtomicBool>,
    finished: impl FnMut(usize, CaseResult),
) -> Result<(), context::Error> {
    let work = |index: usize, renderer: &mut Renderer| draw_case(&cases[index], options, renderer);
    frame::on_contexts(&options.context, [cases.len(), options.jobs], stop, work, finished)
}

/// Draws one case by every row and judges each.
pub fn draw_case(case: &Case, options: &StressOptions, renderer: &mut Renderer) -> CaseResult {
    let start = Instant::now();
    let mut result = CaseResult {
        name: case.name.clone(),
        is_random: case.source == CaseSource::Random,
        why: case.why.clone(),
        sweep: case.sweep.clone(),
        decided: 1.0,
        seconds: 0.0,
        refused: None,
        refusal_expected: case.refused,
        rows: Vec::new(),
        pictures: Vec::new(),
    };
    let drawn = tempfile::tempdir()
        .map_err(|error| error.to_string())
        .and_then(|folder| draw_rows(case, folder.path(), options, renderer, &mut result));
    result.refused = drawn.err();
    result.seconds = start.elapsed().as_secs_f64();
    result
}

fn draw_rows(
    case: &Case,
    folder: &Path,
    options: &StressOptions,
    renderer: &mut Renderer,
    result: &mut CaseResult,
) -> Result<(), String> {
    if let Some(why) = &case.refusal {
        return Err(why.clone());
    }
    let mut loaded = case.load(folder)?;
    if case.source == CaseSource::File {
        loaded.warnings.clear();
    }
    let pictured = loaded.scene;
    // Shadows are judged without photographs, which show none, and without bumps, which have dark sides of their own.
    let mut scene = pictured.clone();
    scene.shading.bumps = BumpShading::default();
    for object in &mut scene.objects {
        object.photo = None;
        object.bases = None;
        object.material =
            object.material.take().map(|material| Arc::new(Material { bump: None, ..(*material).clone() }));
    }
    let driver = renderer.driver();
    let mut shares = Vec::new();
    for (light, source) in scene.lights.iter().enumerate().filter(|_| case.shades) {
        let mut judge = RowJudge::new(&scene, light).map_err(|error| error.to_string())?;
        shares.push(decided(judge.judge().truth(&Bound::NoMap)));
        // All settings of one light, or of one of each kind; of the others each technique's own.
        let rows = match case.rows.is_empty() {
            true => rows(&scene, &source.kind, has_all_rows_before(case, &scene, light)),
            false => case.rows.iter().map(|inside| row_of(inside)).collect(),
        };
        let one_in = if case.rows.is_empty() { options.one_in } else { 1 };
        for settings in chosen(&rows, &case.name, one_in, options.technique.as_deref()) {
            let mut judged = judge.row(settings, renderer);
            judged.row.add_warnings(&loaded.warnings);
            if options.pictures {
                keep_pictures(&mut judge, &judged, &driver, result);
            }
            result.rows.push(judged.row);
        }
    }
    if options.technique.is_none() && case.colors {
        let (rows, known) = colors::rows(&pictured, renderer);
        shares.push(known);
        for mut row in rows {
            // Without lights there is a warning, and ambient light alone is what is meant here.
            if !pictured.lights.is_empty() {
                row.add_warnings(&loaded.warnings);
            }
            result.rows.push(row);
        }
    }
    result.decided = shares.iter().sum::<f64>() / shares.len().max(1) as f64;
    Ok(())
}

/// Tests whether a light before this one has the rows of all settings.
fn has_all_rows_before(case: &Case, scene: &Scene, light: usize) -> bool {
    let kind = |light: &Light| std::mem::discriminant(&light.kind);
    let before = &scene.lights[..light];
    match case.source == CaseSource::File {
        true => before.iter().any(|other| kind(other) == kind(&scene.lights[light])),
        false => !before.is_empty(),
    }
}

/// One of `one_in` of the rows, and all with default settings; of `technique` alone, if there is one.
fn chosen<'r>(rows: &'r [RowSettings], case: &str, one_in: usize, technique: Option<&str>) -> Vec<&'r RowSettings> {
    let step = one_in.max(1);
    // Any number that differs from case to case, and is the same in every run.
    let first = case.bytes().fold(0, |sum: usize, byte| sum.wrapping_mul(31).wrapping_add(byte.into())) % step;
    let is_in = |index: usize, row: &RowSettings| {
        (row.is_default() || index % step == first) && technique.is_none_or(|name| name == row.technique)
    };
    rows.iter().enumerate().filter(|(index, row)| is_in(*index, row)).map(|(_, row)| row).collect()
}

/// Keeps the pictures of a row that will be `result`'s next, if it is the technique's worst so far.
fn keep_pictures(judge: &mut RowJudge<'_>, judged: &Judged, driver: &str, result: &mut CaseResult) {
    let row = &judged.row;
    let Some(shade) = judged.shade.as_ref().filter(|_| row.verdict != Verdict::Right) else { return };
    let known = result.pictures.iter().position(|pictures| {
        let other = &result.rows[pictures.row];
        other.settings.technique == row.settings.technique && other.light == row.light
    });
    let is_worse = |other: &CaseRow| (row.verdict as u8, row.wrong) > (other.verdict as u8, other.wrong);
    if known.is_some_and(|known| !is_worse(&result.rows[result.pictures[known].row])) {
        return;
    }
    let truth = judge.judge().truth(&judged.bound);
    let drawn = difference::shade_picture(shade);
    let Ok(differs) = difference::difference_picture(truth, shade) else { return };
    let texts = |title: &str| {
        PngTexts::titled(title)
            .with(PngTexts::SCENE, format!("stress case {}", result.name))
            .with("Settings", row.settings.to_inline())
            .with("Light", row.light.to_string())
            .with(PngTexts::DRIVER, driver)
    };
    let truth = difference::truth_picture(truth);
    let pngs =
        [(drawn, "shade"), (truth, "exact visibility"), (differs, "differences of a shade from exact visibility")];
    let pngs = pngs.map(|(picture, title)| png_file::of_rgb(&picture, &texts(title)));
    if let [Ok(drawn), Ok(truth), Ok(difference)] = pngs {
        let size = [shade.width, shade.height];
        let pictures = RowPictures { row: result.rows.len(), size, drawn, truth, difference };
        match known {
            Some(known) => result.pictures[known] = pictures,
            None => result.pictures.push(pictures),
        }
    }
}

fn decided(truth: &Truth) -> f64 {
    1.0 - truth.ambiguous_share()
}
