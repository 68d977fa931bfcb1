//! Plot of a sweep that a claim of a document rests on.

use super::axis::PlotAxis;
use super::canvas::{self, Marker, PlotCanvas, Words};
use super::{Error, captions, file_name};
use crate::report::numbers::{first_upper, plain};
use crate::report::store::claim_sweep::ClaimSweep;
use crate::report::store::results::{Machine, SceneReport};

/// Plot of the measured quantity over the varied one; `None` where nothing was measured.
///
/// # Errors
///
/// An error of the plotting library.
pub fn claim_sweep(scene: &SceneReport, machine: &Machine, sweep: &ClaimSweep) -> Result<Option<String>, Error> {
    let all: Vec<[f64; 2]> = sweep.series.iter().flat_map(|series| series.pairs()).collect();
    let asked: Vec<f64> = sweep.series.iter().flat_map(|series| &series.points).map(|point| point.x).collect();
    let x = if sweep.is_even { PlotAxis::even(&asked) } else { PlotAxis::over(all.iter().map(|pair| pair[0])) };
    let y = PlotAxis::over(all.iter().map(|pair| pair[1]));
    let Some((x, y)) = x.zip(y) else { return Ok(None) };
    let words = Words {
        title: format!("{}: {}", first_upper(&sweep.name), file_name(&scene.path)),
        captions: &captions(scene, machine),
        x: &sweep.x,
        y: &sweep.y,
    };
    let draw = |canvas: &mut PlotCanvas<'_>| {
        if let Some(floor) = y.floor {
            canvas.zeros(&x, floor, "none")?;
        }
        for (kind, series) in sweep.series.iter().enumerate() {
            let marker = Marker { kind, radius: 5, opacity: 1.0, is_outlined: true };
            let places: Vec<_> =
                series.pairs().iter().map(|[at, value]| canvas.place(x.place(*at), y.place(*value))).collect();
            canvas.line(places.clone(), Some(kind))?;
            for (place, [at, value]) in places.into_iter().zip(series.pairs()) {
                canvas.marker(place, marker)?;
                canvas.tip(place, &format!("{}: {} at {}", series.name, plain(value), plain(at)));
            }
        }
        canvas.legend_heading("Series")?;
        for (kind, series) in sweep.series.iter().enumerate() {
            let marker = Marker { kind, radius: 5, opacity: 1.0, is_outlined: true };
            canvas.legend_row(&series.name, |canvas, at| canvas.marker(at, marker))?;
        }
        Ok(())
    };
    canvas::draw(&words, [&x, &y], draw).map(Some)
}
