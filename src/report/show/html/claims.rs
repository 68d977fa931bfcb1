//! Table of published claims on one scene: each with its numbers, and whether it holds; then the sweeps that they rest on.

use super::svg::plot;
use super::tags::escape;
use crate::report::numbers::{first_upper, plain};
use crate::report::show::plots;
use crate::report::store::claim_sweep::ClaimSweep;
use crate::report::store::claimed::{ClaimVerdict, Claimed, Measurement};
use crate::report::store::results::{Machine, SceneReport};

/// The section; empty if no claim was measured.
pub(super) fn section(scene: &SceneReport, machine: &Machine) -> String {
    if scene.claims.is_empty() {
        return String::new();
    }
    let rows: String = scene.claims.iter().map(row).collect();
    let sweeps: String = scene.claim_sweeps.iter().map(|sweep| of_sweep(scene, machine, sweep)).collect();
    format!(
        "<h3>Published claims, on this scene</h3>\n<div class=\"wide\"><table class=\"claims\"><thead><tr>\
         <th>claim</th><th>measured</th><th>first</th><th></th><th>second</th><th>ratio</th><th>here it</th></tr></thead>\
         <tbody>\n{rows}</tbody></table></div>\n{sweeps}"
    )
}

/// A sweep's plot, its fits and its numbers.
fn of_sweep(scene: &SceneReport, machine: &Machine, sweep: &ClaimSweep) -> String {
    let fits: String = sweep
        .series
        .iter()
        .filter(|series| !series.fit.is_empty())
        .map(|series| format!("<li>{}: {}</li>\n", escape(&series.name), escape(&series.fit)))
        .collect();
    let fits = if fits.is_empty() { fits } else { format!("<ul class=\"fits\">\n{fits}</ul>\n") };
    let points = sweep.series.iter().flat_map(|series| series.points.iter().map(move |point| (series, point)));
    let rows: String = points
        .map(|(series, point)| {
            format!(
                "<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                escape(&series.name),
                plain(point.x),
                measurement(&point.measured)
            )
        })
        .collect();
    format!(
        "<h4>{} [{}]</h4>\n<p>{}.</p>\n{fits}{}<div class=\"wide\"><table class=\"claims\"><thead><tr><th>series</th><th>{}</th>\
         <th>{}</th></tr></thead><tbody>\n{rows}</tbody></table></div>\n",
        escape(&first_upper(&sweep.name)),
        escape(&sweep.source),
        escape(&sweep.says),
        plot(plots::claim_sweep(scene, machine, sweep), "There is no point to plot."),
        escape(&sweep.x),
        escape(&sweep.y)
    )
}

fn row(claim: &Claimed) -> String {
    let class = match claim.verdict {
        ClaimVerdict::Holds | ClaimVerdict::NotMeasured => "",
        ClaimVerdict::Fails | ClaimVerdict::FailsHere | ClaimVerdict::Unknown => " class=\"failure\"",
    };
    format!(
        "<tr><td><b>{}</b>: {}<div><small>{}</small></div></td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>\
         <td{class}>{}</td></tr>\n",
        escape(&claim.technique),
        escape(&claim.says),
        escape(&claim.source),
        escape(&claim.quantity),
        measurement(&claim.first),
        escape(&claim.relation),
        measurement(&claim.second),
        ratio(claim),
        claim.verdict.name()
    )
}

/// The ratio, and its range below it.
fn ratio(claim: &Claimed) -> String {
    let ratio = claim.ratio().map_or_else(|| String::from("–"), plain);
    let range = claim.ratio_range.map(|range| range.map(plain));
    range.map_or_else(
        || ratio.clone(),
        |[least, greatest]| format!("{ratio}<div><small>{least} to {greatest}</small></div>"),
    )
}

fn measurement(measurement: &Measurement) -> String {
    let value = match (measurement.value, &measurement.why) {
        (Some(value), _) => format!("<b>{}</b>", plain(value)),
        (None, why) => escape(why.as_deref().unwrap_or("–")),
    };
    format!("{value}<div><small><code>{}</code></small></div>", escape(&measurement.settings))
}
