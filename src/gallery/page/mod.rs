//! The gallery as one page that needs no other file: readable without its script, which only moves between entries and
//! enlarges pictures. Written as XML that is HTML, too, so that a test can parse it.

mod choices;
mod command;
mod section;

use std::fmt::Write;

use super::Error;
use super::choices::MeasuredChoice;
use super::draw::ShownEntry;
use super::entry::GalleryEntry;
use crate::judge::difference;
use crate::report::show::html::tags::escape;

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

/// Facts that the page states of itself.
#[derive(Clone, Debug)]
pub struct PageFacts {
    /// Driver that drew the pictures.
    pub driver: String,
    /// True if pictures have half as many pixels a side.
    pub quick: bool,
}

/// The whole page.
///
/// # Errors
///
/// A picture that cannot be encoded.
pub fn to_html(
    entries: &[(GalleryEntry, ShownEntry)],
    cases: &[MeasuredChoice],
    facts: &PageFacts,
) -> Result<String, Error> {
    let mut sections = String::new();
    for (index, (entry, shown)) in entries.iter().enumerate() {
        sections += &section::section(entry, shown, index + 1, facts)?;
    }
    Ok(format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <title>Shadows that go wrong, and what cures them</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <header>\n<h1>Shadows that go wrong, and what cures them</h1>\n{intro}</header>\n{nav}<main>\n{sections}{choices}</main>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        intro = intro(facts),
        nav = contents(entries, cases),
        choices = choices::section(cases),
    ))
}

fn intro(facts: &PageFacts) -> String {
    let legend: String = difference::LEGEND
        .iter()
        .map(|([red, green, blue], name)| {
            format!(
                "<li><span class=\"color\" style=\"background:rgb({red},{green},{blue})\"></span>{}</li>\n",
                escape(name)
            )
        })
        .collect();
    let quick = if facts.quick { " They are quick pictures, of half as many pixels a side." } else { "" };
    format!(
        "<p>Each entry shows a failure on purpose and its cure, drawn by glumbra from one scene, beside the truth, which a \
         ray tracer found in double precision. The command below a picture draws it again to the bit, from the folder of \
         glumbra's sources; <code>glumbra gallery --entry ID --picture failure -o failure.png</code> does so from \
         anywhere.</p>\n\
         <p class=\"faint\">Pictures by {}.{quick} Shares are of the surfaces that face the light: on the others shading \
         leaves no light.</p>\n\
         <p class=\"faint keys\">Keys: <kbd>←</kbd> <kbd>→</kbd> the entry before and the next one; <kbd>f</kbd> the \
         failure, <kbd>c</kbd> the cure, <kbd>t</kbd> the truth and <kbd>d</kbd> what is wrong, large and in one place; \
         <kbd>Esc</kbd> back.</p>\n\
         <details><summary>Colours of what is wrong</summary><ul class=\"legend\">\n{legend}</ul></details>\n",
        escape(&facts.driver)
    )
}

/// Links to the entries.
fn contents(entries: &[(GalleryEntry, ShownEntry)], cases: &[MeasuredChoice]) -> String {
    let mut links = String::new();
    for (entry, _) in entries {
        let _ = writeln!(links, "<li><a href=\"#{}\">{}</a></li>", entry.id, escape(&entry.title));
    }
    if !cases.is_empty() {
        let _ = writeln!(links, "<li><a href=\"#{}\">{}</a></li>", choices::ID, choices::TITLE);
    }
    format!("<nav aria-label=\"Entries\">\n<ol>\n{links}</ol>\n</nav>\n")
}
