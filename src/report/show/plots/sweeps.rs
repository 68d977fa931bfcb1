//! Plots of a sweep over a key of projected light: colour error against the time of a frame, joined in the order of the key.

use super::axis::PlotAxis;
use super::canvas::{self, Marker, PlotCanvas, Words};
use super::{Error, captions, file_name};
use crate::report::numbers::{first_upper, plain};
use crate::report::store::results::{Machine, SceneReport};
use crate::report::store::swept::{LightSweep, PointErrors, SweepPoint};

/// Error that a plot shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Root mean square over pixels and channels, in codes of 1/255.
    Rmse,
    /// Mean of FLIP.
    Flip,
}

impl Measure {
    fn of(self, point: &PointErrors) -> Option<f64> {
        match self {
            Self::Rmse => Some(point.errors.rmse_codes),
            Self::Flip => point.errors.flip,
        }
    }

    fn axis(self) -> &'static str {
        match self {
            Self::Rmse => "RMSE of the colours, in codes of 1/255",
            Self::Flip => "mean of FLIP, from 0 to 1",
        }
    }

    fn title(self) -> &'static str {
        match self {
            Self::Rmse => "colour error",
            Self::Flip => "FLIP",
        }
    }
}

/// A point that can be placed.
struct Place<'a> {
    point: &'a SweepPoint,
    milliseconds: f64,
    bar: [f64; 2],
    error: f64,
}

fn places<'a>(points: &'a [SweepPoint], measure: Measure) -> Vec<Place<'a>> {
    let place = |point: &'a SweepPoint| {
        let measured = point.measured().filter(|measured| measured.frame.least > 0.0)?;
        let bar = [measured.frame.least, measured.frame.greatest];
        Some(Place { point, milliseconds: measured.frame.least, bar, error: measure.of(measured)? })
    };
    points.iter().filter_map(place).collect()
}

/// Plot of each picture's error against its time; `None` where none was measured.
///
/// # Errors
///
/// An error of the plotting library.
pub fn sweep(
    scene: &SceneReport,
    machine: &Machine,
    sweep: &LightSweep,
    measure: Measure,
) -> Result<Option<String>, Error> {
    let series: Vec<_> = sweep.series.iter().map(|series| (series, places(&series.points, measure))).collect();
    let all = || series.iter().flat_map(|(_, places)| places);
    let x = PlotAxis::over(all().flat_map(|place| place.bar));
    let y = PlotAxis::over(all().map(|place| place.error));
    let Some((x, y)) = x.zip(y) else { return Ok(None) };
    let words = Words {
        title: format!("{}, {} against time: {}", first_upper(&sweep.name), measure.title(), file_name(&scene.path)),
        captions: &captions(scene, machine),
        // Other work of the machine only adds.
        x: "time of a frame with its maps redrawn, least of its runs, in ms",
        y: measure.axis(),
    };
    let draw = |canvas: &mut PlotCanvas<'_>| {
        if let Some(floor) = y.floor {
            canvas.zeros(&x, floor, "no difference")?;
        }
        for (kind, (series, places)) in series.iter().enumerate() {
            let marker = Marker { kind, radius: 5, opacity: 1.0, is_outlined: true };
            let at = |place: &Place<'_>| canvas.place(place.milliseconds, y.place(place.error));
            // Only numbers have an order in which they can be joined.
            if series.fit.is_some() || series.points.iter().all(|point| point.count.is_some()) {
                canvas.line(places.iter().map(at).collect(), Some(kind))?;
            }
            for place in places {
                let [from, to] = place.bar.map(|time| canvas.place(time, y.place(place.error)));
                canvas.bar(from, to, marker)?;
                canvas.marker(at(place), marker)?;
                canvas.label(&place.point.label, at(place))?;
            }
        }
        for place in series.iter().flat_map(|(_, places)| places) {
            let at = canvas.place(place.milliseconds, y.place(place.error));
            canvas.tip(at, &tip(place, measure));
        }
        canvas.legend_heading("Series")?;
        for (kind, (series, _)) in series.iter().enumerate() {
            let marker = Marker { kind, radius: 5, opacity: 1.0, is_outlined: true };
            canvas.legend_row(&series.name, |canvas, at| canvas.marker(at, marker))?;
        }
        if measure == Measure::Rmse && sweep.series.iter().any(|series| series.fit.is_some()) {
            canvas.legend_heading("Exponents of RMSE")?;
        }
        for (kind, series) in sweep.series.iter().enumerate().filter(|_| measure == Measure::Rmse) {
            if let Some(fit) = series.fit {
                let marker = Marker { kind, radius: 4, opacity: 0.5, is_outlined: false };
                let [least, greatest] = fit.range;
                let text = format!("-{:.2}, {least:.2} to {greatest:.2}", fit.exponent);
                canvas.legend_row(&text, |canvas, at| canvas.marker(at, marker))?;
            }
        }
        canvas.legend_heading("Marks")?;
        let bar = Marker { kind: 0, radius: 5, opacity: 0.6, is_outlined: false };
        canvas.legend_row("least to greatest run", |canvas, at| canvas.bar((at.0 - 12, at.1), (at.0 + 12, at.1), bar))
    };
    canvas::draw(&words, [&x, &y], draw).map(Some)
}

fn tip(place: &Place<'_>, measure: Measure) -> String {
    let [least, greatest] = place.bar.map(plain);
    let error = plain(place.error);
    let error = match measure {
        Measure::Rmse => format!("RMSE {error} codes"),
        Measure::Flip => format!("FLIP {error}"),
    };
    format!("{}: {error}, {least} to {greatest} ms", place.point.setting)
}
