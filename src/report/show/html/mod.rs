//! A report as one page that needs no other file: pictures, plots, the settings to take, and every row.
//!
//! Readable without its script, which only sorts, filters and copies. Everything that comes from a scene, a driver or a
//! system is escaped.

mod claims;
mod columns;
mod scene;
mod svg;
mod sweeps;
mod table;
pub(crate) mod tags;

use crate::report::measure::picks::Goals;
use crate::report::store::results::{Machine, Report};
use tags::{escape, list};

/// All pictures of a report, in the order of its scenes. Scenes without an entry are shown without pictures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReportPictures {
    /// One entry for each scene, from the first.
    pub scenes: Vec<ScenePictures>,
}

/// One scene's pictures as PNG files, each of the scene's size.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScenePictures {
    /// Row 0 with all its lights.
    pub picture: Option<Vec<u8>>,
    /// By [`crate::judge::difference::truth_picture`].
    pub truth: Option<Vec<u8>>,
    /// Differences of the rows that matter most.
    pub differences: Vec<DifferencePicture>,
    /// Pictures of projected light with their names: see [`crate::report::store::light_pictures::names`].
    pub light: Vec<(String, Vec<u8>)>,
}

/// By [`crate::judge::difference::difference_picture`].
#[derive(Clone, Debug, PartialEq)]
pub struct DifferencePicture {
    /// The row's index in the grid.
    pub row: usize,
    /// Sentence below the picture.
    pub caption: String,
    /// PNG file.
    pub png: Vec<u8>,
}

pub(crate) const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

/// The whole page.
pub fn to_html(report: &Report, pictures: &ReportPictures, goals: &Goals) -> String {
    let none = ScenePictures::default();
    let scenes = report.scenes.iter().enumerate().map(|(index, scene)| {
        let pictures = pictures.scenes.get(index).unwrap_or(&none);
        scene::section(scene, index + 1, &report.machine, pictures, goals)
    });
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>How wrong, and for what price</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n\
         <h1>How wrong, and for what price</h1>\n{notes}{contents}{scenes}{head}{meaning}</main>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        head = head(&report.machine),
        notes = notes(report),
        contents = contents(report),
        scenes = scenes.collect::<String>(),
        meaning = meaning(),
    )
}

fn head(machine: &Machine) -> String {
    let rows = [
        ("Processor", format!("{}, {} cores", machine.processor, machine.cores)),
        ("Driver", machine.renderer.clone()),
        ("OpenGL", machine.gl_version.clone()),
        ("Context", machine.backend.clone()),
        ("glumbra", machine.glumbra.clone()),
    ];
    let rows = rows.iter().map(|(name, value)| format!("<dt>{name}</dt><dd>{}</dd>\n", escape(value)));
    format!("<section>\n<h2>Measured on</h2>\n<dl class=\"machine\">\n{}</dl>\n</section>\n", rows.collect::<String>())
}

fn notes(report: &Report) -> String {
    let mut notes = Vec::new();
    if !report.complete {
        let rows =
            |of: fn(&crate::report::store::results::SceneReport) -> usize| report.scenes.iter().map(of).sum::<usize>();
        notes.push(format!(
            "This report is not complete: it has {} of {} rows, and {} of {} scenes. The best of these rows need not \
             be the best of the grid.",
            rows(|scene| scene.rows.len()),
            rows(|scene| scene.grid_rows),
            report.scenes.len(),
            report.asked_scenes,
        ));
    }
    if report.machine.jobs > 1 {
        notes.push(format!(
            "{} rows were measured at once: their times disturb each other. Errors are not touched by this.",
            report.machine.jobs
        ));
    }
    notes.extend(report.notes.iter().cloned());
    if notes.is_empty() { String::new() } else { format!("<div class=\"note\">{}</div>\n", list(notes)) }
}

/// Links to the scenes, where there are several.
fn contents(report: &Report) -> String {
    if report.scenes.len() < 2 {
        return String::new();
    }
    let link = |(index, scene): (usize, &crate::report::store::results::SceneReport)| {
        format!("<li><a href=\"#scene-{}\">{}</a></li>\n", index + 1, escape(&scene.path.display().to_string()))
    };
    format!("<nav><ul>\n{}</ul></nav>\n", report.scenes.iter().enumerate().map(link).collect::<String>())
}

fn meaning() -> String {
    format!(
        "<section>\n<h2>What the numbers mean</h2>\n\
         <p>The truth says of each pixel's centre whether light reaches the surface seen there. It is found by casting \
         rays against the scene itself and knows no shadow map. Compared are the pixels that the truth and the picture \
         both show and of which the truth is sure; where a sample moved by less than the rasteriser's own error would \
         decide otherwise the truth is <b>ambiguous</b> and the pixel is not judged.</p>\n<dl>\n\
         <dt>False shadow</dt><dd>Light belongs there, the picture has shadow: acne, and light lost at edges.</dd>\n\
         <dt>Leak</dt><dd>Shadow belongs there, the picture has light.</dd>\n\
         <dt>Band</dt><dd>Pixels whose point lies within some texels of a true shadow edge, in the map's plane. In the \
         band a map of that size can be wrong by its texels alone; outside it is wrong for another reason.</dd>\n\
         <dt>Loaded machine</dt><dd>A time is the work's own and what else the machine did meanwhile, which only ever adds. \
         Where in over a tenth of the rows the median run took 25 % longer than the least, or the least of a row 25 % longer \
         than that of another of the same work, settings are picked by the least of their runs, otherwise by the \
         median.</dd>\n\
         <dt>Not told apart</dt><dd>A row whose time may as well be the better one: the bars of both, from the least to the \
         greatest run of all rows of their work, meet. Rows do the same work where their passes differ in polygon offset \
         or in the values of uniforms alone.</dd>\n\
         <dt>FLIP</dt><dd>The difference that a viewer sees where two pictures alternate in one place, at 67 pixels a degree: \
         0 none, 1 black for white. It sees edges and points that RMSE weighs like noise, and overlooks detail that no eye \
         resolves.</dd>\n\
         <dt>95 % range of an exponent</dt><dd>Fits of a line to the logarithms of errors that scatter by a normal \
         distribution have the exponent in their range 95 times in 100.</dd>\n\
         <dt>Facing</dt><dd>The visible side of the surface is turned to the light.</dd>\n\
         <dt>Pareto front</dt><dd>The settings than which no other is both faster and less wrong.</dd>\n</dl>\n\
         <p>A shade below one half counts as shadow. Row 0 is the scene as it is written.</p>\n{}</section>\n",
        table::meanings()
    )
}

#[cfg(test)]
#[path = "../html_tests.rs"]
mod tests;
