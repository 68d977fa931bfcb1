//! One scene's section: pictures, plots, the settings to take, all rows.

use super::super::difference::LEGEND;
use super::super::metrics::Band;
use super::super::numbers::{bytes, grouped, plain};
use super::super::plots;
use super::super::results::{Cost, Machine, Measured, Row, SceneReport};
use super::claims;
use super::table::{self, Marks};
use super::tags::{escape, figure, list};
use super::{Goals, ScenePictures};

pub(super) fn section(
    scene: &SceneReport,
    number: usize,
    machine: &Machine,
    pictures: &ScenePictures,
    goals: &Goals,
) -> String {
    let [width, height] = scene.size;
    let truth = &scene.truth;
    let mut text = format!(
        "<section id=\"scene-{number}\">\n<h2>{}</h2>\n<p>Light {}, {width} × {height} pixels, {} triangles. The truth \
         took {} ms to trace: of {} drawn pixels {} are lit, {} shadowed, {} ambiguous ({} %).</p>\n",
        escape(&scene.path.display().to_string()),
        scene.light,
        grouped(scene.triangles),
        plain(truth.trace_ms),
        grouped(truth.drawn as u64),
        grouped(truth.lit as u64),
        grouped(truth.shadowed as u64),
        grouped(truth.ambiguous as u64),
        plain(truth.ambiguous_percent),
    );
    if scene.rows.len() < scene.grid_rows {
        text +=
            &format!("<p class=\"note\">{} of {} rows of the grid are here.</p>\n", scene.rows.len(), scene.grid_rows);
    }
    text += &figures(scene, pictures);
    text += "<h3>The settings to take</h3>\n<div class=\"cards\">\n";
    text += &cards(scene, number, goals);
    text += "</div>\n";
    text += &claims::section(scene);
    text += &saved_text(scene);
    text += "<h3>Error against time</h3>\n";
    text += &plot(plots::error_against_time(scene, machine), "There is no row to plot.");
    text += &plot(plots::error_against_map_size(scene, machine), "");
    text += &format!("<h3>All {} rows</h3>\n{}", scene.rows.len(), band_text(scene));
    text += &table::table(scene, number, &marks(scene, goals));
    text + "</section>\n"
}

/// What the plan of the scene as written leaves out, and what that saves.
fn saved_text(scene: &SceneReport) -> String {
    let Some(saved) = &scene.saved else { return String::new() };
    if !saved.same_pixels {
        return "<p class=\"note\">Drawing what the plan leaves out changed the picture: that is a bug, and no saving is \
                claimed.</p>\n"
            .to_owned();
    }
    let cost = |cost: &Cost| {
        format!(
            "{} ms, {} MiB, {} triangles in {} draws",
            plain(cost.frame.median),
            plain(cost.image_bytes as f64 / f64::from(1 << 20)),
            grouped(cost.triangles),
            cost.draw_calls
        )
    };
    let items = saved.left_out.iter().map(|left| format!("<li>{}: {}</li>\n", escape(&left.what), escape(&left.why)));
    format!(
        "<h3>What is left out</h3>\n<p>A frame of the scene as written that draws everything: {}. What the plan keeps, with \
         the same pixels to the bit, once the maps are there: {}.</p>\n<details><summary>{} things left out</summary><ul>\n{}</ul></details>\n",
        cost(&saved.whole),
        cost(&saved.pruned),
        saved.left_out.len(),
        items.collect::<String>()
    )
}

fn figures(scene: &SceneReport, pictures: &ScenePictures) -> String {
    let mut figures = String::new();
    if let Some(png) = &pictures.picture {
        figures += &figure(png, scene.size, "the scene as rendered", "The scene as it is written, rendered");
    }
    if let Some(png) = &pictures.truth {
        figures += &figure(png, scene.size, "the truth by ray casting", "The truth, by ray casting");
    }
    for difference in &pictures.differences {
        let caption = format!("Row {}: {}", difference.row, difference.caption);
        figures += &figure(&difference.png, scene.size, &format!("what row {} has wrong", difference.row), &caption);
    }
    if figures.is_empty() {
        return "<p class=\"note\">This report was written without pictures.</p>\n".to_owned();
    }
    let item = |([r, g, b], name): &([u8; 3], &str)| {
        format!("<li><span class=\"color\" style=\"background:#{r:02x}{g:02x}{b:02x}\"></span>{}</li>", escape(name))
    };
    let legend: String = LEGEND.iter().map(item).collect();
    format!("<div class=\"figures\">\n{figures}</div>\n<ul class=\"legend\" aria-label=\"colours\">{legend}</ul>\n")
}

fn plot(svg: Result<Option<String>, plots::Error>, none: &str) -> String {
    match svg {
        Ok(Some(svg)) => format!("<div class=\"plot\">{}</div>\n", svg.trim()),
        Ok(None) if none.is_empty() => String::new(),
        Ok(None) => format!("<p class=\"note\">{}</p>\n", escape(none)),
        Err(error) => format!("<p class=\"note\">{}</p>\n", escape(&error.to_string())),
    }
}

/// A row's band may be of its own map's size.
fn band_text(scene: &SceneReport) -> String {
    let bands = || scene.rows.iter().filter_map(Row::measured).map(|measured| measured.metrics.band);
    let by_area = |band: &Band| u64::from(band.map_size[0]) * u64::from(band.map_size[1]);
    let Some((least, greatest)) = bands().min_by_key(by_area).zip(bands().max_by_key(by_area)) else {
        return String::new();
    };
    let map =
        |band: &Band| format!("{} texels of a {} × {} map", plain(band.texels), band.map_size[0], band.map_size[1]);
    let range = if least == greatest { map(&least) } else { format!("from {} to {}", map(&greatest), map(&least)) };
    format!("<p>The band reaches {range} away from true shadow edges.</p>\n")
}

fn marks(scene: &SceneReport, goals: &Goals) -> Marks {
    let mut marks = Marks::new();
    let mut mark = |row: Option<&Row>, why| {
        if let Some(row) = row {
            marks.entry(row.index).or_default().push(why);
        }
    };
    mark(scene.rows.iter().find(|row| row.index == 0), "as written");
    mark(scene.cheapest_below(goals.wrong_percent), "cheapest");
    mark(scene.best_within(goals.milliseconds), "most exact");
    for row in scene.pareto() {
        mark(Some(row), "Pareto front");
    }
    marks
}

fn cards(scene: &SceneReport, number: usize, goals: &Goals) -> String {
    let front = scene.pareto();
    let instead = |row: Option<&&Row>, what: &str| match row.and_then(|row| Some((row, row.measured()?))) {
        Some((row, measured)) => format!(
            "No setting measured is. The {what} is row {}: {} % wrong in {} ms.",
            row.index,
            plain(measured.wrong_percent()),
            plain(measured.frame_redrawn.median)
        ),
        None => "No setting was measured.".to_owned(),
    };
    let cheapest = card(
        &format!("Cheapest with at most {} % wrong", plain(goals.wrong_percent)),
        scene.cheapest_below(goals.wrong_percent),
        &instead(front.last(), "least wrong"),
        number,
    );
    let best = card(
        &format!("Most exact within {} ms", plain(goals.milliseconds)),
        scene.best_within(goals.milliseconds),
        &instead(front.first(), "fastest"),
        number,
    );
    let written = scene.rows.iter().find(|row| row.index == 0);
    cheapest + &best + &card("The scene as it is written", written, "Row 0 was not measured.", number)
}

fn card(title: &str, row: Option<&Row>, instead: &str, number: usize) -> String {
    let title = escape(title);
    let Some((row, measured)) = row.and_then(|row| Some((row, row.measured()?))) else {
        return format!("<div class=\"card\"><h4>{title}</h4>\n<p>{}</p></div>\n", escape(instead));
    };
    format!(
        "<div class=\"card\"><h4>{title}</h4>\n<p class=\"key\"><b>{}</b> % wrong in <b>{}</b> ms, {} · \
         <a href=\"#s{number}r{index}\">row {index}</a></p>\n<pre><code>{}</code></pre>\n{}</div>\n",
        plain(measured.wrong_percent()),
        plain(measured.frame_redrawn.median),
        bytes(measured.image_bytes + measured.buffer_bytes),
        escape(&row.to_toml()),
        plan_text(measured),
        index = row.index,
    )
}

/// Passes, what the plan left out, and its warnings.
fn plan_text(measured: &Measured) -> String {
    let left_out = list(measured.left_out.iter().map(|item| format!("{}: {}", item.what, item.why)));
    let left_out = if left_out.is_empty() { "<p>Nothing.</p>\n".to_owned() } else { left_out };
    let mut text =
        format!("<div class=\"wide\">{}</div>\n<h5>Left out of its plan</h5>\n{left_out}", table::passes(measured));
    if !measured.warnings.is_empty() {
        text += &format!("<h5>Warnings</h5>\n{}", list(measured.warnings.iter().cloned()));
    }
    text
}
