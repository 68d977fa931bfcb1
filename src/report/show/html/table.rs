//! All rows of a scene as one table, and what its columns mean. Sorting is the script's; without it the table is by row.

use std::collections::HashMap;
use std::fmt::Write;

use super::columns::{COLUMNS, GROUPS, REDRAWN};
use super::tags::escape;
use crate::report::numbers::{fixed, grouped};
use crate::report::store::results::{Measured, Outcome, Row, SceneReport, Spread};

/// Reasons for a row's mark, by its index.
pub(super) type Marks = HashMap<usize, Vec<&'static str>>;

/// `number`: the scene's, for the ids of rows.
pub(super) fn table(scene: &SceneReport, number: usize, marks: &Marks) -> String {
    let mut text = String::from("<div class=\"wide\"><table class=\"rows\">\n<thead>\n<tr><th colspan=\"5\"></th>");
    for (group, meaning) in GROUPS {
        let columns = COLUMNS.iter().filter(|column| column.group == group).count();
        push(&mut text, format_args!("<th colspan=\"{columns}\" title=\"{}\">{}</th>", escape(meaning), escape(group)));
    }
    text.push_str("</tr>\n<tr class=\"names\"><th>row</th><th>marks</th><th>technique</th><th>settings</th>");
    text.push_str("<th class=\"plain\">passes</th>");
    for column in &COLUMNS {
        let short = column
            .name
            .split_once(": ")
            .map_or(column.name, |(group, part)| if group == "facing" { part } else { column.name });
        push(&mut text, format_args!("<th title=\"{}\">{}</th>", escape(column.meaning), escape(short)));
    }
    text.push_str("</tr>\n</thead>\n<tbody>\n");
    let scale = Scale::of(scene);
    for row in &scene.rows {
        push_row(&mut text, row, number, &scale, marks.get(&row.index).map_or(&[][..], Vec::as_slice));
    }
    text.push_str("</tbody>\n</table></div>\n");
    text
}

fn push_row(text: &mut String, row: &Row, number: usize, scale: &Scale, marks: &[&str]) {
    let class = match (&row.outcome, marks.is_empty()) {
        (Outcome::Failed(_), _) => " class=\"failed\"",
        (_, false) => " class=\"marked\"",
        _ => "",
    };
    let chips: String = marks.iter().map(|mark| format!("<span class=\"chip\">{}</span> ", escape(mark))).collect();
    let failure = match &row.outcome {
        Outcome::Failed(why) => format!("<div class=\"failure\">failed: {}</div>", escape(why)),
        Outcome::Measured(_) => String::new(),
    };
    push(
        text,
        format_args!(
            "<tr id=\"s{number}r{index}\"{class}><td>{index}</td><td>{chips}</td><td>{technique}</td>\
             <td class=\"settings\">{settings}{failure}</td><td>{passes}</td>",
            index = row.index,
            technique = escape(&row.technique),
            settings = match escape(&row.settings_text()).as_str() {
                "" => "–".to_owned(),
                settings => format!("<code>{settings}</code>"),
            },
            passes = row.measured().map(folded_passes).unwrap_or_default(),
        ),
    );
    for column in &COLUMNS {
        let bar =
            row.measured().filter(|_| column.name == REDRAWN).map(|m| scale.bar(&m.frame_redrawn)).unwrap_or_default();
        push(text, format_args!("<td>{}{bar}</td>", escape(&column.text(row.measured()))));
    }
    text.push_str("</tr>\n");
}

/// Scale of error bars: from the least to the greatest run of all rows, logarithmic as in the plot.
struct Scale {
    least: f64,
    greatest: f64,
}

impl Scale {
    fn of(scene: &SceneReport) -> Self {
        let spreads = || scene.rows.iter().filter_map(Row::measured).map(|measured| measured.frame_redrawn);
        Self {
            least: spreads().map(|spread| spread.least).filter(|time| *time > 0.0).fold(f64::INFINITY, f64::min),
            greatest: spreads().map(|spread| spread.greatest).fold(0.0, f64::max),
        }
    }

    /// Place in percent of the way from the least to the greatest.
    fn place(&self, time: f64) -> f64 {
        let place = 100.0 * (time / self.least).ln() / (self.greatest / self.least).ln();
        if place.is_finite() { place.clamp(0.0, 100.0) } else { 0.0 }
    }

    fn bar(&self, spread: &Spread) -> String {
        let [from, at, to] = [spread.least, spread.median, spread.greatest].map(|time| self.place(time));
        format!(
            "<span class=\"bar\" title=\"{} to {} ms\"><i style=\"left:{from:.1}%;width:{:.1}%\"></i><b \
             style=\"left:{at:.1}%\"></b></span>",
            fixed(spread.least, 3),
            fixed(spread.greatest, 3),
            to - from
        )
        .replace("\"<", "\"&lt;")
    }
}

fn folded_passes(measured: &Measured) -> String {
    format!("<details><summary>{}</summary>{}</details>", measured.passes.len(), passes(measured))
}

/// Costs of each pass.
pub(super) fn passes(measured: &Measured) -> String {
    let mut text = String::from(
        "<table class=\"passes\"><thead><tr><th>pass</th><th>ms</th><th>least–most</th><th>GPU ms</th>\
         <th>triangles</th><th>fragments</th></tr></thead><tbody>\n",
    );
    let dash = || "–".to_owned();
    for pass in &measured.passes {
        push(
            &mut text,
            format_args!(
                "<tr><td>{}</td><td>{}</td><td>{}–{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                escape(&pass.label),
                escape(&fixed(pass.wall.median, 3)),
                escape(&fixed(pass.wall.least, 3)),
                escape(&fixed(pass.wall.greatest, 3)),
                escape(&pass.gpu.map_or_else(dash, |gpu| fixed(gpu.median, 3))),
                grouped(pass.triangles),
                pass.fragments.map_or_else(dash, grouped),
            ),
        );
    }
    text.push_str("</tbody></table>");
    text
}

/// The columns' meanings, for all scenes at once.
pub(super) fn meanings() -> String {
    let mut text = String::new();
    for (group, meaning) in GROUPS {
        push(&mut text, format_args!("<h4>{}</h4>\n<p>{}</p>\n<dl>\n", escape(group), escape(meaning)));
        for column in COLUMNS.iter().filter(|column| column.group == group) {
            push(&mut text, format_args!("<dt>{}</dt><dd>{}</dd>\n", escape(column.name), escape(column.meaning)));
        }
        text.push_str("</dl>\n");
    }
    text
}

/// Writing to a string cannot fail.
fn push(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    let _ = text.write_fmt(arguments);
}
