//! A report as one flat table: one line for each row of the grid, for a spreadsheet or a data frame. RFC 4180.
//!
//! Every setting that occurs anywhere has a column, `setting.key`, and `setting.table.key` where it is a table. Texts have
//! no TOML quotes. A cell is empty where a row has no such value; a row that failed has its reason in the last column and
//! no measures.

use std::fmt::Write;

use super::claimed::{Claimed, Measurement};
use super::results::{Measured, Outcome, PassCost, Report, Row, SceneReport, Spread};
use super::swept::PointOutcome;
use crate::judge::colors::ColorErrors;
use crate::judge::metrics::{EdgeDistance, Errors};

/// A header line, then the rows of each scene by index. Lines end in CR LF.
pub fn to_csv(report: &Report) -> String {
    let keys = setting_keys(report);
    let mut text = String::new();
    let settings = keys.iter().map(|key| format!("setting.{key}"));
    let columns = measured_columns(None).into_iter().map(|(name, _)| name);
    let first = ["scene", "index", "technique"].map(str::to_owned);
    push_line(&mut text, first.into_iter().chain(settings).chain(columns).chain(["failure".to_owned()]));
    for scene in &report.scenes {
        for row in &scene.rows {
            push_line(&mut text, cells(scene, row, &keys));
        }
    }
    text
}

/// The sweeps over the keys of projected light, one line for each picture; `None`: no scene has one.
pub fn sweeps_to_csv(report: &Report) -> Option<String> {
    const ERRORS: [&str; 5] = ["compared", "rmse_codes", "most_codes", "beyond_percent", "flip"];
    let mut text = String::new();
    let second = ERRORS.map(|name| format!("second_{name}"));
    let first = ["scene", "sweep", "series", "setting", "count"].map(str::to_owned);
    let times = ["redrawn_ms_median", "redrawn_ms_least", "redrawn_ms_greatest", "redrawn_runs", "failure"];
    let names = first.into_iter().chain(ERRORS.map(str::to_owned)).chain(second).chain(times.map(str::to_owned));
    push_line(&mut text, names);
    for scene in &report.scenes {
        for sweep in &scene.sweeps {
            for (series, point) in sweep.series.iter().flat_map(|series| series.points.iter().map(move |p| (series, p)))
            {
                let first = [scene.path.display().to_string(), sweep.name.clone(), series.name.clone()];
                let second = [point.setting.clone(), point.count.map_or_else(String::new, |count| count.to_string())];
                push_line(&mut text, first.into_iter().chain(second).chain(point_cells(&point.outcome)));
            }
        }
    }
    report.scenes.iter().any(|scene| !scene.sweeps.is_empty()).then_some(text)
}

/// Claims of the documents, one line for each; `None`: no scene has one.
pub fn claims_to_csv(report: &Report) -> Option<String> {
    let mut text = String::new();
    let side = |name: &str| ["settings", "value", "why"].map(|what| format!("{name}_{what}"));
    let first = ["scene", "technique", "source", "says", "quantity"].map(str::to_owned);
    let last = ["ratio", "ratio_least", "ratio_greatest", "verdict"].map(str::to_owned);
    let names = first.into_iter().chain(side("first")).chain(["relation".to_owned()]).chain(side("second")).chain(last);
    push_line(&mut text, names);
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let measured =
        |side: &Measurement| [side.settings.clone(), number(side.value), side.why.clone().unwrap_or_default()];
    for (scene, claim) in report.scenes.iter().flat_map(|scene| scene.claims.iter().map(move |claim| (scene, claim))) {
        let Claimed { technique, source, says, quantity, .. } = claim.clone();
        let first = [scene.path.display().to_string(), technique, source, says, quantity];
        let range = [0, 1].map(|end| number(claim.ratio_range.map(|range| range[end])));
        let relation = [claim.relation.clone()];
        let last = [number(claim.ratio())].into_iter().chain(range).chain([claim.verdict.name().to_owned()]);
        let both = measured(&claim.first).into_iter().chain(relation).chain(measured(&claim.second));
        push_line(&mut text, first.into_iter().chain(both).chain(last));
    }
    report.scenes.iter().any(|scene| !scene.claims.is_empty()).then_some(text)
}

/// Sweeps that claims rest on, one line for each point; `None`: no scene has one.
pub fn claim_sweeps_to_csv(report: &Report) -> Option<String> {
    let mut text = String::new();
    let names = ["scene", "sweep", "source", "series", "setting", "x_quantity", "x", "y_quantity", "y", "why"];
    push_line(&mut text, names.map(str::to_owned));
    for scene in &report.scenes {
        for sweep in &scene.claim_sweeps {
            for (series, point) in sweep.series.iter().flat_map(|series| series.points.iter().map(move |p| (series, p)))
            {
                let path = scene.path.display().to_string();
                let value = point.measured.value.map_or_else(String::new, |value| value.to_string());
                let first = [path, sweep.name.clone(), sweep.source.clone(), series.name.clone()];
                let point_cells = [
                    point.measured.settings.clone(),
                    sweep.x.clone(),
                    point.x.to_string(),
                    sweep.y.clone(),
                    value,
                    point.measured.why.clone().unwrap_or_default(),
                ];
                push_line(&mut text, first.into_iter().chain(point_cells));
            }
        }
    }
    report.scenes.iter().any(|scene| !scene.claim_sweeps.is_empty()).then_some(text)
}

fn point_cells(outcome: &PointOutcome) -> Vec<String> {
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let errors = |errors: Option<ColorErrors>| {
        let of = |part: fn(&ColorErrors) -> f64| number(errors.as_ref().map(part));
        let compared = of(|errors| errors.compared as f64);
        let flip = number(errors.and_then(|errors| errors.flip));
        [
            compared,
            of(|errors| errors.rmse_codes),
            of(|errors| errors.most_codes),
            of(|errors| errors.beyond_percent),
            flip,
        ]
    };
    let (measured, why) = match outcome {
        PointOutcome::Measured(measured) => (Some(measured), String::new()),
        PointOutcome::Failed(why) => (None, why.clone()),
    };
    let both = [errors(measured.map(|m| m.errors)), errors(measured.and_then(|m| m.second))].concat();
    let time = |of: fn(&Spread) -> f64| number(measured.map(|m| of(&m.frame)));
    let times = [time(|s| s.median), time(|s| s.least), time(|s| s.greatest), time(|s| s.runs as f64), why];
    both.into_iter().chain(times).collect()
}

/// Union of the keys of all rows, in order of occurrence.
fn setting_keys(report: &Report) -> Vec<String> {
    let mut keys: Vec<String> = Vec::new();
    for (key, _) in report.scenes.iter().flat_map(|scene| &scene.rows).flat_map(plain_settings) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}

/// A row's settings with the keys of tables apart, and without TOML's quotes.
fn plain_settings(row: &Row) -> Vec<(String, String)> {
    let mut settings = Vec::new();
    for (key, value) in &row.settings {
        match format!("value = {value}").parse::<toml::Table>().ok().and_then(|mut table| table.remove("value")) {
            Some(toml::Value::Table(table)) if !table.is_empty() => {
                settings.extend(table.iter().map(|(inner, value)| (format!("{key}.{inner}"), unquoted(value))));
            }
            Some(value) => settings.push((key.clone(), unquoted(&value))),
            None => settings.push((key.clone(), value.clone())),
        }
    }
    settings
}

fn unquoted(value: &toml::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

fn cells(scene: &SceneReport, row: &Row, keys: &[String]) -> Vec<String> {
    let mut cells = vec![scene.path.display().to_string(), row.index.to_string(), row.technique.clone()];
    let settings = plain_settings(row);
    let value = |key: &String| settings.iter().find(|(k, _)| k == key).map_or_else(String::new, |(_, v)| v.clone());
    cells.extend(keys.iter().map(value));
    cells.extend(measured_columns(row.measured()).into_iter().map(|(_, cell)| cell));
    cells.push(match &row.outcome {
        Outcome::Measured(_) => String::new(),
        Outcome::Failed(why) => why.clone(),
    });
    cells
}

/// The columns between settings and failure, in order; empty cells without measures.
fn measured_columns(measured: Option<&Measured>) -> Vec<(String, String)> {
    let mut columns = Vec::new();
    let mut push = |name: String, value: Option<String>| columns.push((name, value.unwrap_or_default()));
    for (part, errors) in [("", measured.map(|m| &m.metrics.all)), ("facing_", measured.map(|m| &m.metrics.facing))] {
        for (name, value) in error_columns(errors) {
            push(format!("{part}{name}"), value);
        }
    }
    for (name, value) in left_out_columns(measured) {
        push(name.to_owned(), value);
    }
    let colors = measured.and_then(|m| m.colors);
    push("color_compared".to_owned(), colors.map(|c| c.compared.to_string()));
    push("color_rmse_codes".to_owned(), colors.map(|c| c.rmse_codes.to_string()));
    push("color_most_codes".to_owned(), colors.map(|c| c.most_codes.to_string()));
    push("color_beyond_percent".to_owned(), colors.map(|c| c.beyond_percent.to_string()));
    push("color_flip".to_owned(), colors.and_then(|c| c.flip).map(|flip| flip.to_string()));
    for (name, spread) in [("redrawn", measured.map(|m| &m.frame_redrawn)), ("kept", measured.map(|m| &m.frame_kept))] {
        let part =
            |what: &str, of: fn(&Spread) -> f64| (format!("{name}_ms_{what}"), spread.map(|s| of(s).to_string()));
        for (name, value) in
            [part("median", |s| s.median), part("least", |s| s.least), part("greatest", |s| s.greatest)]
        {
            push(name, value);
        }
        push(format!("{name}_runs"), spread.map(|s| s.runs.to_string()));
    }
    push("image_bytes".to_owned(), measured.map(|m| m.image_bytes.to_string()));
    push("buffer_bytes".to_owned(), measured.map(|m| m.buffer_bytes.to_string()));
    push("triangles".to_owned(), measured.map(|m| m.triangles.to_string()));
    push("draw_calls".to_owned(), measured.map(|m| m.draw_calls.to_string()));
    push("fragments".to_owned(), measured.and_then(total_fragments).map(|count| count.to_string()));
    push("passes".to_owned(), measured.map(|m| m.passes.iter().map(pass_text).collect::<Vec<_>>().join("; ")));
    columns
}

fn error_columns(errors: Option<&Errors>) -> Vec<(String, Option<String>)> {
    let column = |name: &str, of: fn(&Errors) -> f64| (name.to_owned(), errors.map(|e| of(e).to_string()));
    let mut columns = vec![
        column("compared", |e| e.compared as f64),
        column("compared_in_band", |e| e.compared_in_band as f64),
        column("wrong_percent", |e| e.wrong_percent),
        column("wrong_outside_band_percent", |e| e.wrong_outside_percent),
        column("false_shadow_percent", |e| e.false_shadow_percent),
        column("false_shadow_in_band_percent", |e| e.false_shadow.inside_percent),
        column("false_shadow_outside_band_percent", |e| e.false_shadow.outside_percent),
        column("leak_percent", |e| e.leak_percent),
        column("leak_in_band_percent", |e| e.leak.inside_percent),
        column("leak_outside_band_percent", |e| e.leak.outside_percent),
        column("rmse", |e| e.rmse),
    ];
    let directions = [
        ("rendered_to_true", errors.and_then(|errors| errors.rendered_to_true)),
        ("true_to_rendered", errors.and_then(|errors| errors.true_to_rendered)),
    ];
    for (name, distance) in directions {
        let part = |what: &str, of: fn(&EdgeDistance) -> f64| {
            (format!("{name}_{what}"), distance.as_ref().map(|distance| of(distance).to_string()))
        };
        columns.extend([
            part("edges", |d| d.edges as f64),
            part("mean_pixels", |d| d.mean_pixels),
            part("p95_pixels", |d| d.p95_pixels),
            part("max_pixels", |d| d.max_pixels),
        ]);
    }
    columns
}

fn left_out_columns(measured: Option<&Measured>) -> [(&'static str, Option<String>); 5] {
    let column = |name, of: fn(&crate::judge::metrics::NotCompared) -> usize| {
        (name, measured.map(|measured| of(&measured.metrics.left_out).to_string()))
    };
    [
        column("left_out_background", |l| l.background),
        column("left_out_ambiguous", |l| l.ambiguous),
        column("left_out_outside_cone", |l| l.outside_cone),
        column("left_out_not_drawn", |l| l.not_drawn),
        column("left_out_only_drawn", |l| l.only_drawn),
    ]
}

/// Fragments of all passes; `None` if the driver does not count them in every pass.
pub(crate) fn total_fragments(measured: &Measured) -> Option<u64> {
    if measured.passes.is_empty() {
        return None;
    }
    measured.passes.iter().map(|pass| pass.fragments).sum()
}

/// `label 1.25 ms (GPU 1.1 ms)`.
fn pass_text(pass: &PassCost) -> String {
    let gpu = pass.gpu.map_or_else(String::new, |gpu| format!(" (GPU {} ms)", gpu.median));
    format!("{} {} ms{gpu}", pass.label, pass.wall.median)
}

fn push_line(text: &mut String, cells: impl IntoIterator<Item = String>) {
    for (index, cell) in cells.into_iter().enumerate() {
        let comma = if index > 0 { "," } else { "" };
        // Writing to a string cannot fail.
        let _ = write!(text, "{comma}{}", quoted(&cell));
    }
    text.push_str("\r\n");
}

/// Quotes a cell that a reader would otherwise split (RFC 4180, 2.6 and 2.7).
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\r', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::samples;

    /// Reads RFC 4180 back.
    fn parse(text: &str) -> Vec<Vec<String>> {
        let (mut lines, mut cells, mut cell, mut is_quoted) = (Vec::new(), Vec::new(), String::new(), false);
        let mut letters = text.chars().peekable();
        while let Some(letter) = letters.next() {
            match letter {
                '"' if is_quoted && letters.peek() == Some(&'"') => cell.extend(letters.next()),
                '"' => is_quoted = !is_quoted,
                ',' if !is_quoted => cells.push(std::mem::take(&mut cell)),
                '\r' if !is_quoted => {}
                '\n' if !is_quoted => {
                    cells.push(std::mem::take(&mut cell));
                    lines.push(std::mem::take(&mut cells));
                }
                _ => cell.push(letter),
            }
        }
        lines
    }

    #[test]
    fn every_row_has_every_column() {
        let report = samples::report();
        let lines = parse(&to_csv(&report));
        assert_eq!(lines.len(), 1 + report.scenes[0].rows.len());
        assert!(lines.iter().all(|line| line.len() == lines[0].len()));
        let names: std::collections::HashSet<&String> = lines[0].iter().collect();
        assert_eq!(names.len(), lines[0].len(), "two columns of one name");
    }

    #[test]
    fn cells_come_back_as_they_were() {
        let report = samples::report();
        let lines = parse(&to_csv(&report));
        let column = |name: &str| lines[0].iter().position(|column| column == name).unwrap();
        for (row, line) in report.scenes[0].rows.iter().zip(&lines[1..]) {
            assert_eq!(line[column("technique")], row.technique);
            for (key, value) in plain_settings(row) {
                assert_eq!(line[column(&format!("setting.{key}"))], value);
            }
            match &row.outcome {
                Outcome::Failed(why) => {
                    assert_eq!((&line[column("failure")], ""), (why, &*line[column("wrong_percent")]))
                }
                Outcome::Measured(measured) => {
                    assert_eq!(line[column("wrong_percent")].parse(), Ok(measured.wrong_percent()));
                    assert_eq!(line[column("redrawn_ms_median")].parse(), Ok(measured.frame_redrawn.median));
                }
            }
        }
    }

    #[test]
    fn settings_stand_without_toml() {
        let report = samples::report();
        let lines = parse(&to_csv(&report));
        let cell = |name: &str| lines[1][lines[0].iter().position(|column| column == name).unwrap()].as_str();
        let cells = ["size", "filter", "offset.factor", "offset.units"].map(|key| cell(&format!("setting.{key}")));
        assert_eq!(cells, ["1024", "linear", "1.1", "4.0"]);
        assert!(!lines[0].iter().any(|column| column == "setting.offset"));
    }

    #[test]
    fn sweeps_have_a_line_for_each_picture() {
        let mut report = samples::report();
        assert_eq!(sweeps_to_csv(&report), None);
        report.scenes.push(samples::projected_scene("b.toml", "f2"));
        let lines = parse(&sweeps_to_csv(&report).unwrap());
        assert_eq!(lines.len(), 1 + 5);
        assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{lines:?}");
        let cell =
            |line: usize, name: &str| lines[line][lines[0].iter().position(|column| column == name).unwrap()].as_str();
        let third = ["scene", "setting", "count", "rmse_codes", "second_rmse_codes", "redrawn_ms_median", "failure"];
        assert_eq!(third.map(|name| cell(3, name)), ["b.toml", "focus.samples = 16", "16", "2", "2.25", "32", ""]);
        assert_eq!(["rmse_codes", "failure"].map(|name| cell(5, name)), ["", "out of <memory>"]);
    }

    #[test]
    fn quotes_only_where_needed() {
        let cases =
            [("a", "a"), ("a,b", "\"a,b\""), ("say \"x\"", "\"say \"\"x\"\"\""), ("a\nb", "\"a\nb\""), ("", "")];
        for (cell, text) in cases {
            assert_eq!(quoted(cell), text);
        }
    }
}
