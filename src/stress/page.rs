//! A run's outcome as one page that needs no other file.

use super::plot::SweepPlot;
use super::results::{CaseResult, CaseRow, RowPictures, Verdict, tally};
use super::table::{shares, techniques_of};
use crate::judge::MOST_WRONG;
use crate::judge::difference::LEGEND;
use crate::report::show::html::STYLE;
use crate::report::show::html::tags::{escape, figure};

/// Cases shown with pictures at most: those that fail come first.
const MOST_CASES: usize = 80;

/// The whole page.
pub fn to_html(results: &[CaseResult], plots: &[SweepPlot]) -> String {
    let mut listed: Vec<&CaseResult> = results.iter().filter(|result| result.has_news()).collect();
    listed.sort_by_key(|result| !result.fails());
    let more = listed.len().saturating_sub(MOST_CASES);
    let more = if more > 0 { format!("<p>{more} more cases are in stress.json.</p>\n") } else { String::new() };
    let cases: String = listed.into_iter().take(MOST_CASES).map(case).collect();
    let plots: String = plots
        .iter()
        .map(|plot| format!("<h3>{}</h3>\n<div class=\"plot\">{}</div>\n", escape(&plot.name), plot.svg))
        .collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Stress: scenes against truth</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n\
         <h1>Stress: scenes against truth</h1>\n{}{}{}<h2>What is not right</h2>\n{}{cases}{more}\
         <h2>Error against the stiff parameter</h2>\n{plots}</main>\n</body>\n</html>\n",
        meaning(),
        verdicts(results),
        paragraphs(&shares(results)),
        legend(),
    )
}

fn meaning() -> String {
    format!(
        "<p>Every scene is drawn by every technique and its settings, and compared with exact visibility pixel by pixel. \
         A shadow volume may have no wrong pixel; a map only such that its own texels account for, within a lookup's reach \
         of a shadow's edge or the reach of its bias, and at most {} % of the surfaces that face the light.</p>\n\
         <dl><dt>right</dt><dd>within that bound</dd><dt>false alarm</dt><dd>within it, although the plan warns</dd>\
         <dt>warned</dt><dd>outside it, with a warning in the plan</dd><dt>refused</dt><dd>an error instead of a picture</dd>\
         <dt>silently wrong</dt><dd>outside it, without a warning</dd></dl>\n",
        100.0 * MOST_WRONG
    )
}

fn paragraphs(text: &str) -> String {
    text.lines().map(|line| format!("<p>{}</p>\n", escape(line))).collect()
}

fn legend() -> String {
    let item = |([r, g, b], name): &([u8; 3], &str)| {
        format!("<li><span class=\"color\" style=\"background:#{r:02x}{g:02x}{b:02x}\"></span>{}</li>", escape(name))
    };
    format!("<ul class=\"legend\">{}</ul>\n", LEGEND.iter().map(item).collect::<String>())
}

fn verdicts(results: &[CaseResult]) -> String {
    let head: String = Verdict::ALL.iter().map(|verdict| format!("<th>{}</th>", verdict.name())).collect();
    let line = |name: &str, rows: Vec<&CaseRow>| {
        let counts: String = tally(rows.iter().copied()).iter().map(|count| format!("<td>{count}</td>")).collect();
        format!("<tr><td>{}</td><td>{}</td>{counts}</tr>\n", escape(name), rows.len())
    };
    let rows = || results.iter().flat_map(|result| &result.rows);
    let mut body: String = techniques_of(results)
        .into_iter()
        .map(|name| line(name, rows().filter(|row| row.settings.technique == name).collect()))
        .collect();
    body.push_str(&line("all", rows().collect()));
    format!(
        "<div class=\"wide\"><table class=\"rows\"><thead><tr><th>technique</th><th>rows</th>{head}</tr></thead>\
         <tbody>\n{body}</tbody></table></div>\n"
    )
}

fn case(result: &CaseResult) -> String {
    let mut html = format!("<h3>{}</h3>\n<p>{}</p>\n", escape(&result.name), escape(&result.why));
    if let Some(why) = &result.refused {
        html.push_str(&format!("<p class=\"failure\">refused: {}</p>\n", escape(why)));
    }
    html.push_str("<table class=\"claims\"><tbody>\n");
    for row in result.rows.iter().filter(|row| row.verdict != Verdict::Right) {
        let class = if row.verdict == Verdict::SilentlyWrong { " class=\"failure\"" } else { "" };
        html.push_str(&format!(
            "<tr><td>light {}</td><td>{}</td><td>{}</td><td{class}>{}</td><td>{:.3} % of {}, {} beyond the bound</td>\
             <td>{}</td></tr>\n",
            row.light,
            escape(&row.settings.technique),
            escape(&row.keys()),
            row.verdict.name(),
            row.wrong_percent(),
            row.compared,
            row.beyond,
            escape(&row.why)
        ));
    }
    html.push_str("</tbody></table>\n");
    result.pictures.iter().for_each(|pictures| html.push_str(&three(result, pictures)));
    html
}

fn three(result: &CaseResult, pictures: &RowPictures) -> String {
    let row = &result.rows[pictures.row];
    let what = format!("{}, light {}, {}", row.settings.technique, row.light, row.keys());
    let one =
        |png: &[u8], name: &str| figure(png, pictures.size, &format!("{name}: {what}"), &format!("{name}: {what}"));
    format!(
        "<div class=\"figures\">\n{}{}{}</div>\n",
        one(&pictures.drawn, "drawn"),
        one(&pictures.truth, "truth"),
        one(&pictures.difference, "difference")
    )
}
