//! Section of projected light: what colours are compared with, and for each sweep its plots, fits, numbers and pictures.

use super::ScenePictures;
use super::svg::plot;
use super::tags::{escape, figure};
use crate::pictures::flip;
use crate::report::numbers::{fixed, plain};
use crate::report::show::plots::{self, Measure};
use crate::report::store::light_pictures::{self, LightPictureName};
use crate::report::store::results::{Machine, Row, SceneReport};
use crate::report::store::swept::{LightSweep, PointOutcome, SweepPoint, SweepSeries};

/// The section; empty if colours are not compared.
pub(super) fn section(scene: &SceneReport, machine: &Machine, pictures: &ScenePictures) -> String {
    let mut text = String::new();
    if let Some(from) = &scene.colors_from {
        text += &format!("<h3>Colours</h3>\n<p>Pictures are compared with {}.</p>\n{}", escape(from), row_text(scene));
        text += &figures(scene, pictures, None);
    }
    for (index, sweep) in scene.sweeps.iter().enumerate() {
        text += &of_sweep(scene, machine, sweep);
        text += &figures(scene, pictures, Some(index));
    }
    text
}

/// Errors of the scene as written.
fn row_text(scene: &SceneReport) -> String {
    let row = scene.rows.iter().find(|row| row.index == 0).and_then(Row::measured);
    let Some(errors) = row.and_then(|row| row.colors) else { return String::new() };
    let flip = errors.flip.map_or_else(|| String::from("not measured"), plain);
    format!(
        "<p>The scene as it is written: RMSE {} codes of 1/255, at most {} codes, {} % of the pixels beyond what a sample's own \
         error explains, FLIP {flip}.</p>\n",
        plain(errors.rmse_codes),
        plain(errors.most_codes),
        plain(errors.beyond_percent)
    )
}

fn of_sweep(scene: &SceneReport, machine: &Machine, sweep: &LightSweep) -> String {
    let law = if sweep.law.is_empty() { String::new() } else { format!("<p>{}</p>\n", escape(&sweep.law)) };
    let second = sweep.second_reference.as_ref();
    let second = second.map_or_else(String::new, |from| format!(" The second errors are against {}.", escape(from)));
    let fits: String = sweep
        .series
        .iter()
        .filter_map(SweepSeries::fit_text)
        .map(|text| format!("<li>{}</li>\n", escape(&text)))
        .collect();
    let fits = if fits.is_empty() { fits } else { format!("<ul class=\"fits\">\n{fits}</ul>\n") };
    let plots = [Measure::Rmse, Measure::Flip].map(|measure| plot(plots::sweep(scene, machine, sweep, measure), ""));
    format!(
        "<h3>Sweep: {}</h3>\n<p><code>{}</code> [{}]. Pictures are compared with {}.{second}</p>\n{law}{fits}{}{}",
        escape(&sweep.name),
        escape(&sweep.key),
        escape(&sweep.source),
        escape(&sweep.reference),
        plots.concat(),
        table(sweep)
    )
}

fn table(sweep: &LightSweep) -> String {
    let has_second = sweep.second_reference.is_some();
    let second = if has_second { "<th>second RMSE</th><th>second FLIP</th>" } else { "" };
    let rows: String = sweep
        .series
        .iter()
        .flat_map(|series| series.points.iter().map(move |point| row(series, point, has_second)))
        .collect();
    format!(
        "<div class=\"wide\"><table class=\"claims\"><thead><tr><th>series</th><th>setting</th><th>RMSE, codes</th>\
         <th>most, codes</th><th>beyond 2 codes, %</th><th>FLIP</th>{second}<th>redrawn, ms</th><th>least–most</th></tr></thead>\
         <tbody>\n{rows}</tbody></table></div>\n"
    )
}

fn row(series: &SweepSeries, point: &SweepPoint, has_second: bool) -> String {
    let (name, setting) = (escape(&series.name), escape(&point.setting));
    let first = format!("<tr><td>{name}</td><td><code>{setting}</code></td>");
    let measured = match &point.outcome {
        PointOutcome::Measured(measured) => measured,
        PointOutcome::Failed(why) => {
            let columns = if has_second { 8 } else { 6 };
            return format!("{first}<td colspan=\"{columns}\" class=\"failure\">{}</td></tr>\n", escape(why));
        }
    };
    let cell = |value: Option<f64>, decimals: usize| {
        format!("<td>{}</td>", value.map_or_else(|| String::from("–"), |value| escape(&fixed(value, decimals))))
    };
    let (errors, second, frame) = (&measured.errors, measured.second.as_ref(), &measured.frame);
    let mut cells = [
        cell(Some(errors.rmse_codes), 4),
        cell(Some(errors.most_codes), 2),
        cell(Some(errors.beyond_percent), 3),
        cell(errors.flip, 5),
    ]
    .concat();
    if has_second {
        cells += &cell(second.map(|errors| errors.rmse_codes), 4);
        cells += &cell(second.and_then(|errors| errors.flip), 5);
    }
    cells += &cell(Some(frame.median), 3);
    format!("{first}{cells}<td>{}–{}</td></tr>\n", escape(&fixed(frame.least, 3)), escape(&fixed(frame.greatest, 3)))
}

/// Pictures of a sweep, or of the scene as written; with the colours of FLIP where they have them.
fn figures(scene: &SceneReport, pictures: &ScenePictures, sweep: Option<usize>) -> String {
    let names = light_pictures::names(scene);
    let here = |name: &&LightPictureName| name.sweep == sweep;
    let (mut figures, mut has_flip) = (String::new(), false);
    for name in names.iter().filter(here) {
        let Some((_, png)) = pictures.light.iter().find(|(known, _)| *known == name.name) else { continue };
        has_flip |= name.is_flip;
        figures += &figure(png, scene.size, &name.caption, &name.caption);
    }
    if figures.is_empty() {
        return figures;
    }
    let legend = if has_flip { flip_legend() } else { String::new() };
    format!("<div class=\"figures\">\n{figures}</div>\n{legend}")
}

fn flip_legend() -> String {
    let item = |([r, g, b], value): ([u8; 3], f32)| {
        let more = if value >= flip::BRIGHTEST { " and more" } else { "" };
        let name = format!("FLIP {}{more}", plain(f64::from(value)));
        format!("<li><span class=\"color\" style=\"background:#{r:02x}{g:02x}{b:02x}\"></span>{}</li>", escape(&name))
    };
    let items: String = flip::legend().into_iter().map(item).collect();
    format!("<ul class=\"legend\" aria-label=\"colours of FLIP\">{items}</ul>\n")
}
