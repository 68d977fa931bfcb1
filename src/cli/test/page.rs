//! A run as one page that needs no other file: failing cases first, each with its pictures side by side. The script adds a
//! slider and a blink between actual and expected.

use super::results::TestResults;
use crate::cases::{CaseOutcome, CaseVerdict};
use crate::report::show::html::STYLE;
use crate::report::show::html::tags::{escape, figure, list};

const OWN_STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The whole page.
pub fn to_html(results: &TestResults) -> String {
    let (passing, failing): (Vec<_>, Vec<_>) = results.cases.iter().partition(|case| case.verdict == CaseVerdict::Pass);
    let title = match failing.len() {
        0 => String::from("No case fails"),
        1 => String::from("1 case fails"),
        count => format!("{count} cases fail"),
    };
    let driver = results.driver.as_ref().map(|driver| format!("<p>{}</p>\n", escape(driver))).unwrap_or_default();
    let unfinished = match results.unfinished.is_empty() {
        true => String::new(),
        false => format!("<h2>Unfinished</h2>\n{}", list(results.unfinished.iter().cloned())),
    };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}{OWN_STYLE}</style>\n</head>\n<body>\n<main>\n<h1>{title}</h1>\n\
         <p>{} of {} pass; {:.1} s.</p>\n{driver}{contents}{failures}{unfinished}{passes}</main>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        passing.len(),
        results.cases.len(),
        results.seconds,
        contents = contents(&failing),
        failures = failing.iter().map(|case| failure(case)).collect::<String>(),
        passes = passes(&passing),
    )
}

fn contents(failing: &[&CaseOutcome]) -> String {
    if failing.len() < 2 {
        return String::new();
    }
    let link = |case: &&CaseOutcome| format!("<li><a href=\"#{name}\">{name}</a></li>\n", name = escape(&case.name));
    format!("<nav><ul>\n{}</ul></nav>\n", failing.iter().map(link).collect::<String>())
}

fn failure(case: &CaseOutcome) -> String {
    let at = case.at.as_ref().map(|at| format!("<p><code>{}</code></p>\n", escape(at))).unwrap_or_default();
    let check = case.check.as_ref().map(|check| format!(" <span class=\"chip\">{}</span>", escape(check)));
    let difference = match case.check.as_deref() {
        Some("truth") => "difference: blue a false shadow, orange a leak",
        _ => "difference, from black for none to white",
    };
    let pictures: String = case.files.named().map(|(name, path)| picture(name, path, difference)).collect();
    let pictures = match pictures.is_empty() {
        true => pictures,
        false => format!("<div class=\"figures pictures\">\n{pictures}</div>\n"),
    };
    format!(
        "<section id=\"{name}\">\n<h2>{name}</h2>\n<p><b class=\"failure\">{verdict}</b>{check} after {seconds:.2} s. {asks}</p>\n\
         {at}<pre>{message}</pre>\n{pictures}</section>\n",
        name = escape(&case.name),
        verdict = case.verdict.name(),
        check = check.unwrap_or_default(),
        seconds = case.seconds,
        asks = escape(&case.asks),
        message = escape(case.message.as_deref().unwrap_or_default()),
    )
}

/// A picture of a failure, from its file. `difference`: what is said below one of differences.
fn picture(name: &'static str, path: &std::path::Path, difference: &str) -> String {
    let read = std::fs::read(path).map_err(|error| error.to_string());
    let size = image::image_dimensions(path).map_err(|error| error.to_string());
    match (read, size) {
        (Ok(png), Ok((width, height))) => {
            let caption = match name {
                "difference" => difference,
                name => name,
            };
            let html = figure(&png, [width, height], name, caption);
            html.replacen("<figure>", &format!("<figure data-picture=\"{name}\">"), 1)
        }
        (Err(error), _) | (_, Err(error)) => {
            format!("<p class=\"failure\">{}: {}</p>\n", escape(&path.display().to_string()), escape(&error))
        }
    }
}

fn passes(passing: &[&CaseOutcome]) -> String {
    if passing.is_empty() {
        return String::new();
    }
    let row = |case: &&CaseOutcome| {
        format!("<tr><td>{}</td><td>{}</td><td>{:.2}</td></tr>\n", escape(&case.name), escape(&case.asks), case.seconds)
    };
    format!(
        "<h2>Pass</h2>\n<div class=\"wide\"><table class=\"claims\"><thead><tr><th>case</th><th>asks</th><th>seconds</th></tr>\
         </thead><tbody>\n{}</tbody></table></div>\n",
        passing.iter().map(row).collect::<String>()
    )
}
