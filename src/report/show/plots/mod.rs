//! Plots of a scene's errors, as SVG: against the time of a frame, and against the size of the map.
//!
//! Both axes are logarithmic. A picture without any wrong pixel has no place there, so it is drawn on a marked floor. Knows
//! a report's values only.

pub(crate) mod axis;
pub(crate) mod canvas;
mod claims;
mod sweeps;

use std::path::Path;

use crate::report::measure::picks::{RowTimes, pareto};
use crate::report::numbers::{grouped, plain};
use crate::report::store::results::{Machine, Measured, Row, SceneReport};
use axis::PlotAxis;
use canvas::{Marker, PlotCanvas, Words};
pub use claims::claim_sweep;
pub use sweeps::{Measure, sweep};

/// Reason why a plot could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The plotting library failed.
    #[error("the plot cannot be drawn: {0}")]
    Draw(String),
}

/// Target of a point's link: `#s1r5` on the page itself.
#[derive(Clone, Copy, Debug)]
pub struct Links<'a> {
    /// The page's place, seen from the plot; empty on the page itself.
    pub page: &'a str,
    /// The scene's number on it.
    pub scene: usize,
}

impl Links<'_> {
    fn to(self, row: &Row) -> String {
        format!("{}#s{}r{}", self.page, self.scene, row.index)
    }
}

/// A row that can be placed.
struct Point<'a> {
    row: &'a Row,
    milliseconds: f64,
    /// The least and the greatest of its own runs.
    bar: [f64; 2],
    wrong_percent: f64,
    size: Option<f64>,
    technique: usize,
}

/// All of a scene's points, and what their markers mean.
struct Points<'a> {
    points: Vec<Point<'a>>,
    techniques: Vec<&'a str>,
    /// Ascending, each once.
    sizes: Vec<f64>,
    times: RowTimes<'a>,
}

impl<'a> Points<'a> {
    fn of(scene: &'a SceneReport) -> Self {
        let times = RowTimes::of(scene);
        let mut all = Self { points: Vec::new(), techniques: Vec::new(), sizes: Vec::new(), times };
        let compared = |m: &&Measured| m.metrics.all.compared > 0 && m.frame_redrawn.median > 0.0;
        for (row, measured) in scene.rows.iter().filter_map(|row| Some((row, row.measured().filter(compared)?))) {
            let name = row.technique.as_str();
            let technique = all.techniques.iter().position(|known| *known == name).unwrap_or_else(|| {
                all.techniques.push(name);
                all.techniques.len() - 1
            });
            let size = row.map_size.map(f64::from);
            let (milliseconds, wrong_percent) = (all.times.of_row(measured), measured.wrong_percent());
            let bar = [measured.frame_redrawn.least, measured.frame_redrawn.greatest];
            all.points.push(Point { row, milliseconds, bar, wrong_percent, size, technique });
        }
        all.sizes = all.points.iter().filter_map(|point| point.size).collect();
        all.sizes.sort_by(f64::total_cmp);
        all.sizes.dedup();
        all
    }

    /// Radius of a marker, larger for a larger map.
    fn radius(&self, size: Option<f64>) -> i32 {
        match size.and_then(|size| self.sizes.iter().position(|known| *known == size)) {
            Some(rank) if self.sizes.len() > 1 => 3 + (4 * rank / (self.sizes.len() - 1)) as i32,
            _ => 5,
        }
    }

    fn techniques_legend(&self, canvas: &mut PlotCanvas<'_>) -> Result<(), Error> {
        canvas.legend_heading("Technique")?;
        let has_points = |kind: usize| self.points.iter().any(|point| point.technique == kind);
        for (kind, name) in self.techniques.iter().enumerate().filter(|(kind, _)| has_points(*kind)) {
            let marker = Marker { kind, radius: 5, opacity: 0.8, is_outlined: false };
            canvas.legend_row(name, |canvas, at| canvas.marker(at, marker))?;
        }
        Ok(())
    }
}

/// Plot of each setting's error against its time, with the Pareto front; `None` where no row was measured.
///
/// # Errors
///
/// An error of the plotting library.
pub fn error_against_time(scene: &SceneReport, machine: &Machine, links: Links<'_>) -> Result<Option<String>, Error> {
    let all = Points::of(scene);
    let x = PlotAxis::over(all.points.iter().flat_map(|point| point.bar));
    let y = PlotAxis::over(all.points.iter().map(|point| point.wrong_percent));
    let Some((x, y)) = x.zip(y) else { return Ok(None) };
    let words = Words {
        title: format!("Error against time: {}", file_name(&scene.path)),
        captions: &captions(scene, machine),
        x: &format!("time of a frame with its maps redrawn, {} of its runs, in ms", all.times.name()),
        y: "wrong pixels, in % of those compared",
    };
    let front: Vec<usize> = pareto(scene, &all.times).iter().map(|(row, _)| row.index).collect();
    let draw = |canvas: &mut PlotCanvas<'_>| {
        if let Some(floor) = y.floor {
            canvas.floor(&x, floor)?;
        }
        for point in &all.points {
            let marker = Marker { kind: point.technique, radius: 0, opacity: 0.5, is_outlined: false };
            let [from, to] = point.bar.map(|time| canvas.place(time, y.place(point.wrong_percent)));
            canvas.bar(from, to, marker)?;
        }
        for point in &all.points {
            let radius = all.radius(point.size);
            let at = canvas.place(point.milliseconds, y.place(point.wrong_percent));
            canvas.marker(at, Marker { kind: point.technique, radius, opacity: 0.6, is_outlined: false })?;
            canvas.link(at, &links.to(point.row), &tip(point));
        }
        draw_front(canvas, &all, &front, &y)?;
        if let Some(point) = all.points.iter().find(|point| point.row.index == 0) {
            canvas.ring(canvas.place(point.milliseconds, y.place(point.wrong_percent)), 12)?;
        }
        draw_time_legend(canvas, &all)
    };
    canvas::draw(&words, [&x, &y], draw).map(Some)
}

fn tip(point: &Point<'_>) -> String {
    let [least, greatest] = point.bar.map(plain);
    let (row, technique, settings) = (point.row.index, &point.row.technique, point.row.settings_text());
    let wrong = plain(point.wrong_percent);
    format!("row {row}: {technique} {settings}: {wrong} % wrong, {least} to {greatest} ms")
}

/// A staircase, since nothing is known between two settings: right of and above it lies what a setting attains.
fn draw_front(canvas: &PlotCanvas<'_>, all: &Points<'_>, front: &[usize], y: &PlotAxis) -> Result<(), Error> {
    let of = |index: &usize| all.points.iter().find(|point| point.row.index == *index);
    let places: Vec<_> = front
        .iter()
        .filter_map(of)
        .map(|point| (point, canvas.place(point.milliseconds, y.place(point.wrong_percent))))
        .collect();
    let mut stairs: Vec<(i32, i32)> = Vec::new();
    for (_, at) in &places {
        stairs.extend(stairs.last().map(|last| (at.0, last.1)));
        stairs.push(*at);
    }
    if stairs.len() > 1 {
        canvas.line(stairs, None)?;
    }
    let mut last_label: Option<(i32, i32)> = None;
    for (point, at) in places {
        let [from, to] = point.bar.map(|time| canvas.place(time, y.place(point.wrong_percent)));
        canvas.bar(from, to, Marker { kind: point.technique, radius: 0, opacity: 1.0, is_outlined: false })?;
        let marker = Marker { kind: point.technique, radius: all.radius(point.size), opacity: 1.0, is_outlined: true };
        canvas.marker(at, marker)?;
        if last_label.is_none_or(|last| at.0 - last.0 > 34 || at.1 - last.1 > 15) {
            canvas.label(&format!("#{}", point.row.index), at)?;
            last_label = Some(at);
        }
    }
    Ok(())
}

fn draw_time_legend(canvas: &mut PlotCanvas<'_>, all: &Points<'_>) -> Result<(), Error> {
    all.techniques_legend(canvas)?;
    if all.sizes.len() > 1 {
        canvas.legend_heading("Map size")?;
        for size in &all.sizes {
            let marker = Marker { kind: 0, radius: all.radius(Some(*size)), opacity: 0.3, is_outlined: false };
            canvas.legend_row(&format!("{} texels", plain_size(*size)), |canvas, at| canvas.marker(at, marker))?;
        }
    }
    canvas.legend_heading("Marks")?;
    let marker = Marker { kind: 0, radius: 5, opacity: 0.3, is_outlined: true };
    canvas.legend_row("Pareto front, #row", |canvas, at| {
        canvas.line(vec![(at.0 - 12, at.1), (at.0 + 12, at.1)], None)?;
        canvas.marker(at, marker)
    })?;
    let bar = Marker { opacity: 0.6, is_outlined: false, ..marker };
    canvas.legend_row("least to greatest run", |canvas, at| canvas.bar((at.0 - 12, at.1), (at.0 + 12, at.1), bar))?;
    if all.points.iter().any(|point| point.row.index == 0) {
        canvas.legend_row("scene as written, #0", |canvas, at| canvas.ring(at, 8))?;
    }
    Ok(())
}

/// Plot of each setting's error against the size of its map, with each technique's best; `None` with fewer than two sizes.
///
/// # Errors
///
/// An error of the plotting library.
pub fn error_against_map_size(
    scene: &SceneReport,
    machine: &Machine,
    links: Links<'_>,
) -> Result<Option<String>, Error> {
    let mut all = Points::of(scene);
    all.points.retain(|point| point.size.is_some());
    if all.sizes.len() < 2 {
        return Ok(None);
    }
    let y = PlotAxis::over(all.points.iter().map(|point| point.wrong_percent));
    let Some((x, y)) = PlotAxis::at(&all.sizes).zip(y) else { return Ok(None) };
    let words = Words {
        title: format!("Error against map size: {}", file_name(&scene.path)),
        captions: &captions(scene, machine),
        x: "size of the map, in texels along a side",
        y: "wrong pixels, in % of those compared",
    };
    let draw = |canvas: &mut PlotCanvas<'_>| {
        if let Some(floor) = y.floor {
            canvas.floor(&x, floor)?;
        }
        for point in &all.points {
            let at = canvas.place(point.size.unwrap_or_default(), y.place(point.wrong_percent));
            canvas.marker(at, Marker { kind: point.technique, radius: 4, opacity: 0.3, is_outlined: false })?;
            canvas.link(at, &links.to(point.row), &tip(point));
        }
        for kind in 0..all.techniques.len() {
            draw_best(canvas, &all, kind, &y)?;
        }
        all.techniques_legend(canvas)?;
        canvas.legend_heading("Marks")?;
        let marker = Marker { kind: 0, radius: 5, opacity: 1.0, is_outlined: true };
        canvas.legend_row("least wrong at a size", |canvas, at| {
            canvas.line(vec![(at.0 - 12, at.1), (at.0 + 12, at.1)], Some(0))?;
            canvas.marker(at, marker)
        })?;
        canvas.legend_row("other settings", |canvas, at| {
            canvas.marker(at, Marker { opacity: 0.3, radius: 4, is_outlined: false, ..marker })
        })
    };
    canvas::draw(&words, [&x, &y], draw).map(Some)
}

/// A technique's least wrong setting at each size, joined.
fn draw_best(canvas: &PlotCanvas<'_>, all: &Points<'_>, kind: usize, y: &PlotAxis) -> Result<(), Error> {
    let best = |size: &f64| {
        let here = all.points.iter().filter(|point| point.technique == kind && point.size == Some(*size));
        let least = here.map(|point| point.wrong_percent).min_by(f64::total_cmp)?;
        Some(canvas.place(*size, y.place(least)))
    };
    let places: Vec<_> = all.sizes.iter().filter_map(best).collect();
    if places.len() > 1 {
        canvas.line(places.clone(), Some(kind))?;
    }
    let marker = Marker { kind, radius: 5, opacity: 1.0, is_outlined: true };
    places.into_iter().try_for_each(|at| canvas.marker(at, marker))
}

/// Driver, machine and scene.
fn captions(scene: &SceneReport, machine: &Machine) -> [String; 2] {
    let [width, height] = scene.size;
    let jobs = if machine.jobs > 1 { format!(" · {} jobs at once", machine.jobs) } else { String::new() };
    [
        format!("{} · OpenGL {} · {}", machine.renderer, machine.gl_version, machine.backend),
        format!(
            "{}, {} cores{jobs} · {width} × {height} pixels · {} triangles · light {}",
            machine.processor,
            machine.cores,
            grouped(scene.triangles),
            scene.light
        ),
    ]
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn plain_size(size: f64) -> String {
    if size.fract() == 0.0 { format!("{size:.0}") } else { plain(size) }
}

#[cfg(test)]
#[path = "../plots_tests.rs"]
mod tests;
