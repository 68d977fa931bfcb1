//! The pictures of a report: the scene, the truth, and the errors of the rows that matter.

use super::light_pictures;
use super::results::{Row, SceneReport};
use crate::device::Pixels;
use crate::frame::{self, Renderer, draw_shade};
use crate::judge::colors::{draw_colors, errors_of, known_or_drawn};
use crate::judge::difference::{difference_picture, truth_picture};
use crate::judge::metrics;
use crate::plan::Request;
use crate::png_file::{self, PngTexts};
use crate::report::measure::picks::{Goals, Pick, Picks};
use crate::report::measure::run::{Sweep, in_clear_air};
use crate::report::measure::sweeps::MeasuredSweep;
use crate::report::show::html::{DifferencePicture, ScenePictures};

/// Reason why a picture could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The picture could not be drawn.
    #[error(transparent)]
    Frame(#[from] frame::Error),
    /// The picture does not fit its truth.
    #[error(transparent)]
    Difference(#[from] metrics::Error),
    /// The PNG encoder failed.
    #[error("a picture of the report cannot be encoded: {0}")]
    Encode(#[from] std::io::Error),
}

/// Draws the pictures of one scene. `measured`: its sweeps of projected light.
///
/// # Errors
///
/// An error of the device; a picture that does not fit its truth.
pub fn of(
    sweep: &Sweep,
    report: &SceneReport,
    measured: &[MeasuredSweep],
    goals: &Goals,
    renderer: &mut Renderer,
) -> Result<ScenePictures, Error> {
    let light = light(sweep, report, measured, renderer)?;
    if report.unshaded.is_some() {
        return Ok(ScenePictures {
            picture: Some(picture(sweep, report, renderer)?),
            light,
            ..ScenePictures::default()
        });
    }
    let mut differences = Vec::new();
    for (row, caption) in rows_that_matter(report, goals) {
        let Some(scene) = sweep.scene_of(row.index) else { continue };
        let shade = draw_shade(&in_clear_air(&scene), report.light, renderer)?;
        let texts = of_driver(report, "differences of a row's shade from the truth", renderer);
        let texts = texts
            .with("Row", row.index.to_string())
            .with("Settings", format!("technique = \"{}\", {}", row.technique, row.settings_text()));
        let png = png_file::of_rgb(&difference_picture(&sweep.truth, &shade)?, &texts)?;
        differences.push(DifferencePicture { row: row.index, caption, png });
    }
    Ok(ScenePictures {
        picture: Some(picture(sweep, report, renderer)?),
        truth: Some(png_file::of_rgb(&truth_picture(&sweep.truth), &titled(report, "exact visibility"))?),
        differences,
        light,
    })
}

/// Pictures of projected light: the colours to compare with and FLIP of the scene as written; those of its sweeps.
fn light(
    sweep: &Sweep,
    report: &SceneReport,
    measured: &[MeasuredSweep],
    renderer: &mut Renderer,
) -> Result<Vec<(String, Vec<u8>)>, Error> {
    let mut pictures = Vec::new();
    let driver = renderer.driver();
    let mut add = |name: String, picture: &image::RgbImage| {
        let texts = titled(report, &format!("projected light: {name}")).with(PngTexts::DRIVER, driver.clone());
        png_file::of_rgb(picture, &texts).map(|png| pictures.push((name, png)))
    };
    if let Some(reference) = &sweep.colors {
        let drawn = draw_colors(&sweep.scene, false, renderer)?;
        add(light_pictures::COLORS.to_owned(), &known_or_drawn(&reference.colors, &drawn))?;
        if let Some((_, Some(map))) = errors_of(&reference.colors, &drawn) {
            add(light_pictures::FLIP.to_owned(), &map.picture())?;
        }
    }
    for (index, sweep) in measured.iter().enumerate() {
        add(light_pictures::reference_name(index), &sweep.reference)?;
        let points = sweep.points.iter().enumerate().flat_map(|(series, points)| {
            points.iter().enumerate().filter_map(move |(point, pictures)| Some(([series, point], pictures.as_ref()?)))
        });
        for (at, pictures) in points {
            if at[1] == 0 {
                add(light_pictures::drawn_name(index, at), &pictures.drawn)?;
            }
            if let Some(flip) = &pictures.flip {
                add(light_pictures::flip_name(index, at), flip)?;
            }
        }
    }
    Ok(pictures)
}

/// The scene as written, the rows that reach the goals, and the most wrong one; each once.
pub(super) fn rows_that_matter<'r>(report: &'r SceneReport, goals: &Goals) -> Vec<(&'r Row, String)> {
    let measured = || report.rows.iter().filter(|row| row.measured().is_some());
    let wrong = |row: &Row| row.measured().map_or(0.0, |measured| measured.wrong_percent());
    let picks = Picks::of(report, goals);
    let picked = |pick: &Option<Pick<'r>>| pick.as_ref().map(|pick| pick.row);
    let candidates = [
        (measured().find(|row| row.index == 0), String::from("as the scene is written")),
        (picked(&picks.cheapest), format!("the cheapest that is wrong in at most {} %", goals.wrong_percent)),
        (picked(&picks.most_exact), format!("the most exact within {} ms", goals.milliseconds)),
        (measured().min_by(|a, b| wrong(a).total_cmp(&wrong(b))), String::from("the most exact of all")),
        (measured().max_by(|a, b| wrong(a).total_cmp(&wrong(b))), String::from("the most wrong of all")),
    ];
    let mut rows: Vec<(&Row, String)> = Vec::new();
    for (row, caption) in candidates {
        let Some(row) = row else { continue };
        match rows.iter_mut().find(|(have, _)| have.index == row.index) {
            Some((_, have)) => have.push_str(&format!("; {caption}")),
            None => rows.push((row, caption)),
        }
    }
    rows
}

/// Texts of a picture of the report's scene.
fn titled(report: &SceneReport, title: &str) -> PngTexts {
    PngTexts::titled(title).with(PngTexts::SCENE, report.path.display().to_string())
}

/// Texts of a picture that the renderer draws.
fn of_driver(report: &SceneReport, title: &str, renderer: &Renderer) -> PngTexts {
    titled(report, title).with(PngTexts::DRIVER, renderer.driver())
}

fn picture(sweep: &Sweep, report: &SceneReport, renderer: &mut Renderer) -> Result<Vec<u8>, Error> {
    let plan = renderer.plan(&sweep.scene, &Request::default())?;
    renderer.draw(&plan)?;
    let [width, height] = sweep.report.size;
    let rgb = match renderer.read(&plan)?.picture {
        Pixels::Rgba8 { data, .. } => data.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect(),
        _ => Vec::new(),
    };
    let picture = image::RgbImage::from_raw(width, height, rgb).unwrap_or_default();
    Ok(png_file::of_rgb(&picture, &of_driver(report, "the scene as written", renderer))?)
}
