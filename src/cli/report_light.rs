//! Projected light in `glumbra report`: its sweeps, measured and printed.

use std::io::Write;

use super::Error;
use super::screen::Screen;
use crate::context;
use crate::frame::Renderer;
use crate::report::measure::run::{self, MeasureOptions, Sweep};
use crate::report::measure::sweeps::{self, MeasuredSweep, SweepRequest};
use crate::report::store::results::{Report, SceneReport};
use crate::report::store::swept::SweepSeries;

/// Measures the sweeps over keys of projected light on each scene.
pub(super) fn measure_light(
    (sweeps, screen): (&[Sweep], Screen),
    report: &mut Report,
    quick: bool,
    options: &MeasureOptions,
) -> Result<Vec<Vec<MeasuredSweep>>, Error> {
    let context = context::open(&options.context)?;
    let mut renderer = Renderer::new(&context);
    let bar = screen.spinner("projected light, {msg}");
    let mut all = Vec::new();
    for (sweep, scene) in sweeps.iter().zip(&mut report.scenes) {
        let (light, runs) = (options.light, options.runs);
        let request = SweepRequest { scene: &sweep.scene, light, truth: &sweep.truth, quick, runs };
        let tick = |what: &str| {
            bar.set_message(format!("{}: {what}", sweep.report.path.display()));
            bar.tick();
        };
        let measured = sweeps::measure(&request, &mut renderer, tick);
        let measured =
            measured.map_err(|reason| run::Error::Reference { scene: scene.path.clone(), reason: Box::new(reason) })?;
        scene.sweeps = measured.iter().map(|measured| measured.sweep.clone()).collect();
        all.push(measured);
    }
    bar.finish_and_clear();
    Ok(all)
}

/// Prints each picture's errors and time, and the fits.
pub(super) fn print_sweeps(scene: &SceneReport, out: &mut impl Write) -> std::io::Result<()> {
    for sweep in &scene.sweeps {
        writeln!(out, "# {}, {}:", sweep.name, scene.path.display())?;
        for (series, point) in sweep.series.iter().flat_map(|series| series.points.iter().map(move |p| (series, p))) {
            writeln!(out, "#   {}: {}: {}", series.name, point.setting, point.numbers())?;
        }
        let fits = sweep.series.iter().filter_map(SweepSeries::fit_text);
        fits.into_iter().try_for_each(|fit| writeln!(out, "#   {fit}"))?;
    }
    Ok(())
}
