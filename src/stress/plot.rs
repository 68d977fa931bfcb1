//! The error of each technique as a function of a sweep's stiff parameter.

use super::results::CaseResult;
use super::table::techniques_of;
use crate::report::show::plots::Error;
use crate::report::show::plots::axis::PlotAxis;
use crate::report::show::plots::canvas::{self, Marker, Words};

/// A named sweep and its plot as SVG.
pub struct SweepPlot {
    pub name: String,
    pub svg: String,
}

/// One plot a sweep with two values or more.
///
/// # Errors
///
/// An error of the plotting library.
pub fn sweeps(results: &[CaseResult]) -> Result<Vec<SweepPlot>, Error> {
    let mut names: Vec<String> = Vec::new();
    for name in results.iter().filter_map(base_name) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let mut plots = Vec::new();
    for name in names {
        let of: Vec<&CaseResult> = results.iter().filter(|r| base_name(r).as_deref() == Some(&name)).collect();
        if of.len() > 1
            && let Some(svg) = plot(&name, &of)?
        {
            plots.push(SweepPlot { name, svg });
        }
    }
    Ok(plots)
}

/// A sweep's name, without the value.
fn base_name(result: &CaseResult) -> Option<String> {
    let (_, value) = result.sweep.as_ref()?;
    Some(result.name.strip_suffix(&format!("-{value:e}")).unwrap_or(&result.name).to_owned())
}

/// A value of the parameter, and the wrong percent there.
type Curve = Vec<(f64, f64)>;

fn plot(name: &str, results: &[&CaseResult]) -> Result<Option<String>, Error> {
    let owned: Vec<CaseResult> = results.iter().map(|result| (*result).clone()).collect();
    let techniques = techniques_of(&owned);
    let curves: Vec<(&str, Curve)> = techniques.iter().map(|name| (*name, curve(results, name))).collect();
    let all = || curves.iter().flat_map(|(_, curve)| curve);
    let x = PlotAxis::over(all().map(|(value, _)| *value));
    let y = PlotAxis::over(all().map(|(_, wrong)| *wrong));
    let Some((x, y)) = x.zip(y) else { return Ok(None) };
    let parameter = results[0].sweep.as_ref().map_or("", |(parameter, _)| parameter.as_str());
    let words = Words {
        title: format!("{name}: error against {parameter}"),
        captions: &[String::from("each technique's default settings; a point without a picture is left out")],
        x: parameter,
        y: "wrong pixels, in % of those compared",
    };
    let draw = |canvas: &mut canvas::PlotCanvas<'_>| {
        if let Some(floor) = y.floor {
            canvas.floor(&x, floor)?;
        }
        canvas.legend_heading("Technique")?;
        for (kind, (name, curve)) in curves.iter().enumerate() {
            let places: Vec<_> = curve.iter().map(|(value, wrong)| canvas.place(*value, y.place(*wrong))).collect();
            if places.len() > 1 {
                canvas.line(places.clone(), Some(kind))?;
            }
            let marker = Marker { kind, radius: 5, opacity: 0.9, is_outlined: false };
            places.into_iter().try_for_each(|at| canvas.marker(at, marker))?;
            canvas.legend_row(name, |canvas, at| canvas.marker(at, marker))?;
        }
        Ok(())
    };
    canvas::draw(&words, [&x, &y], draw).map(Some)
}

/// The first row of the technique at each value that was drawn.
fn curve(results: &[&CaseResult], technique: &str) -> Curve {
    let point = |result: &&CaseResult| {
        let row = result.rows.iter().find(|row| row.settings.technique == technique && row.compared > 0)?;
        Some((result.sweep.as_ref()?.1, row.wrong_percent()))
    };
    let mut curve: Curve = results.iter().filter_map(point).collect();
    curve.sort_by(|a, b| a.0.total_cmp(&b.0));
    curve
}
