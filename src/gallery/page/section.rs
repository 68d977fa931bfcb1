//! One entry's part of the page.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::RgbImage;

use super::PageFacts;
use super::command::render_command;
use crate::gallery::diagrams::{self, Diagram};
use crate::gallery::draw::{self, EntrySide, ShownEntry};
use crate::gallery::entry::{EntryMeasure, GalleryEntry};
use crate::gallery::{Error, scenes};
use crate::judge::truth_pictures::LOUDER;
use crate::report::numbers::plain;
use crate::report::show::html::tags::escape;

/// An entry's section, the `number`th of the page.
pub fn section(entry: &GalleryEntry, shown: &ShownEntry, number: usize, facts: &PageFacts) -> Result<String, Error> {
    let says: String = entry.explanation.iter().map(|text| format!("<p>{}</p>\n", with_code(text))).collect();
    let drawn: Vec<Diagram> = entry.diagram.map_or_else(Vec::new, |kind| diagrams::draw(kind, shown));
    let diagrams: String = drawn
        .iter()
        .map(|diagram| format!("<figure>{}<figcaption>{}</figcaption></figure>\n", diagram.svg, escape(&diagram.says)))
        .collect();
    let diagrams = if diagrams.is_empty() { diagrams } else { format!("<div class=\"diagrams\">\n{diagrams}</div>\n") };
    Ok(format!(
        "<section class=\"entry\" id=\"{id}\" tabindex=\"-1\">\n<h2><span class=\"number\">{number}</span> {title}</h2>\n\
         <p class=\"question\">{question}</p>\n<div class=\"words\">\n{says}</div>\n{pictures}{numbers}{diagrams}{commands}\
         {source}{more}</section>\n",
        id = entry.id,
        title = escape(&entry.title),
        question = escape(&entry.question),
        pictures = pictures(entry, shown)?,
        numbers = numbers(entry, shown),
        commands = commands(entry, shown, facts),
        source = source(entry),
        more = more(entry, shown),
    ))
}

/// Escaped text, with what stands between backquotes as code.
fn with_code(text: &str) -> String {
    let parts = text.split('`').enumerate();
    let words = parts.map(|(index, part)| match index % 2 {
        0 => escape(part),
        _ => format!("<code>{}</code>", escape(part)),
    });
    words.collect()
}

fn pictures(entry: &GalleryEntry, shown: &ShownEntry) -> Result<String, Error> {
    let wrong = if entry.measure.is_of_colors() {
        format!("What the failure has wrong: differences from the true colours, {} times as large", LOUDER)
    } else {
        String::from("What the failure has wrong: blue is false shadow, orange is leak")
    };
    let rows = [
        ("failure", "Failure", entry.failure.says.as_str(), &shown.failure.picture),
        ("cure", "Cure", entry.cure.says.as_str(), &shown.cure.picture),
        ("truth", "Truth", "By ray casting", &shown.truth),
        ("difference", "Wrong", wrong.as_str(), &shown.difference),
    ];
    let mut figures = String::new();
    for (kind, name, says, picture) in rows {
        figures += &figure(entry, kind, name, says, picture)?;
    }
    Ok(format!("<div class=\"pictures\">\n{figures}</div>\n"))
}

fn figure(entry: &GalleryEntry, kind: &str, name: &str, says: &str, picture: &RgbImage) -> Result<String, Error> {
    let png = draw::to_png(picture).map_err(|reason| Error::Png { id: entry.id.clone(), reason })?;
    let (id, title, says) = (&entry.id, escape(&entry.title), escape(says));
    Ok(format!(
        "<figure id=\"{id}-{kind}\" class=\"{kind}\"><a href=\"#{id}-{kind}\" data-picture=\"{kind}\">\
         <img width=\"{}\" height=\"{}\" alt=\"{name}: {title}. {says}\" src=\"data:image/png;base64,{}\"/></a>\
         <figcaption><b>{name}</b> {says}</figcaption></figure>\n",
        picture.width(),
        picture.height(),
        STANDARD.encode(png),
    ))
}

/// The table of numbers, and whether they are as far apart as the entry says.
fn numbers(entry: &GalleryEntry, shown: &ShownEntry) -> String {
    let measures: &[EntryMeasure] = match entry.measure.is_of_colors() {
        true => &[EntryMeasure::Colors, EntryMeasure::Rmse],
        false => &[EntryMeasure::FalseShadow, EntryMeasure::Leak, EntryMeasure::Wrong],
    };
    let cell = |value: Option<f64>, unit| value.map_or(String::from("–"), |value| format!("{} {unit}", plain(value)));
    let mut rows = String::new();
    for measure in measures {
        let [failure, cure] =
            [&shown.failure, &shown.cure].map(|side| cell(side.numbers.get(*measure), measure.unit()));
        let class = if *measure == entry.measure { " class=\"shows\"" } else { "" };
        let _ = writeln!(
            rows,
            "<tr{class}><th scope=\"row\">{}</th><td>{failure}</td><td>{cure}</td></tr>",
            measure.name()
        );
    }
    let [failure, cure] = [&shown.failure, &shown.cure].map(|side| side.numbers.get(entry.measure).unwrap_or_default());
    let note = if entry.is_kept_by(failure, cure) {
        String::new()
    } else {
        format!(
            "<p class=\"note\">On this driver the failure is not {} times as wrong as the cure.</p>\n",
            plain(entry.factor)
        )
    };
    format!(
        "<table class=\"numbers\"><thead><tr><th></th><th scope=\"col\">failure</th><th scope=\"col\">cure</th></tr></thead>\
         <tbody>\n{rows}</tbody></table>\n{note}"
    )
}

fn commands(entry: &GalleryEntry, shown: &ShownEntry, facts: &PageFacts) -> String {
    let full = entry.scene_of(EntrySide::Cure, false).map_or(shown.cure.scene.image.size, |scene| scene.image.size);
    let failing = match entry.fault {
        Some(_) => "Draw the failure: no key of a scene makes this mistake, so the gallery makes it in the passes",
        None => "Draw the failure",
    };
    let line = |side, class: &str, name: &str| {
        let command = render_command(entry, side, facts.quick, full);
        format!("<dt>{name}</dt><dd><pre class=\"command {class}\">{}</pre></dd>\n", escape(&command))
    };
    format!(
        "<dl class=\"commands\">\n{}{}</dl>\n",
        line(EntrySide::Failure, "failure", failing),
        line(EntrySide::Cure, "cure", "Draw the cure")
    )
}

fn source(entry: &GalleryEntry) -> String {
    let figure = entry
        .figure
        .as_ref()
        .map_or_else(String::new, |name| format!(" More of it: <code>glumbra figures --only {}</code>.", escape(name)));
    format!(
        "<p class=\"source\">[{}] <cite>{}</cite> (data/documents.md).{figure}</p>\n",
        escape(&entry.document),
        escape(&entry.section)
    )
}

/// The scene and the passes, folded up.
fn more(entry: &GalleryEntry, shown: &ShownEntry) -> String {
    let scene = scenes::find(&entry.scene).map_or("", |scene| scene.text);
    let mut folded = format!(
        "<details><summary>The scene, to paste: {}</summary><pre>{}</pre></details>\n",
        escape(&entry.scene),
        escape(scene)
    );
    for (name, side) in [("failure", &shown.failure), ("cure", &shown.cure)] {
        let passes = side.plan.summary().to_string();
        let _ = writeln!(
            folded,
            "<details><summary>The passes of the {name}, as <code>glumbra plan</code> says them</summary><pre>{}</pre>\
             </details>",
            escape(passes.trim_end())
        );
    }
    folded
}
