//! Table of published claims on one scene: each with its numbers, and whether it holds.

use super::tags::escape;
use crate::report::numbers::plain;
use crate::report::store::claimed::{ClaimVerdict, Claimed, Measurement};
use crate::report::store::results::SceneReport;

/// The section; empty if no claim was measured.
pub(super) fn section(scene: &SceneReport) -> String {
    if scene.claims.is_empty() {
        return String::new();
    }
    let rows: String = scene.claims.iter().map(row).collect();
    format!(
        "<h3>Published claims, on this scene</h3>\n<div class=\"wide\"><table class=\"claims\"><thead><tr>\
         <th>claim</th><th>measured</th><th>first</th><th></th><th>second</th><th>ratio</th><th>here it</th></tr></thead>\
         <tbody>\n{rows}</tbody></table></div>\n"
    )
}

fn row(claim: &Claimed) -> String {
    let class = match claim.verdict {
        ClaimVerdict::Holds => "",
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
