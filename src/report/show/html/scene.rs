//! One scene's section: pictures, plots, the settings to take, all rows.

use super::svg::plot;
use super::table::{self, Marks};
use super::tags::{escape, figure, list};
use super::{ScenePictures, claims, sweeps};
use crate::judge::difference::LEGEND;
use crate::judge::metrics::Band;
use crate::report::measure::picks::{Goals, Picks, RowTimes, pareto, titles, unjudged};
use crate::report::numbers::{bytes, grouped, plain};
use crate::report::show::plots::{self, Links};
use crate::report::store::results::{Cost, Machine, Measured, Row, SceneReport, TruthSummary};

pub(super) fn section(
    scene: &SceneReport,
    number: usize,
    machine: &Machine,
    pictures: &ScenePictures,
    goals: &Goals,
) -> String {
    let [width, height] = scene.size;
    let times = RowTimes::of(scene);
    let mut text = format!(
        "<section id=\"scene-{number}\">\n<h2>{}</h2>\n<p>Light {}, {width} × {height} pixels, {} triangles.{}</p>\n",
        escape(&scene.path.display().to_string()),
        scene.light,
        grouped(scene.triangles),
        if scene.unshaded.is_none() { truth_text(&scene.truth) } else { String::new() },
    );
    if scene.rows.len() < scene.grid_rows {
        text +=
            &format!("<p class=\"note\">{} of {} rows of the grid are here.</p>\n", scene.rows.len(), scene.grid_rows);
    }
    text += &answers(scene, number, goals);
    if scene.unshaded.is_none() {
        text += "<h3>Error against time</h3>\n";
        let links = Links { page: "", scene: number };
        text += &plot(plots::error_against_time(scene, machine, links), "There is no row to plot.");
        text += &plot(plots::error_against_map_size(scene, machine, links), "");
    }
    text += &figures(scene, pictures);
    text += &sweeps::section(scene, machine, pictures);
    text += &claims::section(scene, machine);
    text += &saved_text(scene);
    text += &format!("<h3>All {} rows</h3>\n{}", scene.rows.len(), band_text(scene));
    text += &table::table(scene, number, &marks(scene, &times, goals));
    text + "</section>\n"
}

fn truth_text(truth: &TruthSummary) -> String {
    format!(
        " The truth took {} ms to trace: of {} drawn pixels {} are lit, {} shadowed, {} ambiguous ({} %).",
        plain(truth.trace_ms),
        grouped(truth.drawn as u64),
        grouped(truth.lit as u64),
        grouped(truth.shadowed as u64),
        grouped(truth.ambiguous as u64),
        plain(truth.ambiguous_percent),
    )
}

/// Text on what the plan of the scene as written leaves out, and what that saves.
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
    let [width, height] = scene.size;
    let name = scene.path.display();
    let mut figures = String::new();
    if let Some(png) = &pictures.picture {
        let alt = format!("{name} as it is written, rendered in {width} × {height} pixels");
        figures += &figure(png, scene.size, &alt, "The scene as it is written, rendered");
    }
    if let Some(png) = &pictures.truth {
        let truth = &scene.truth;
        let share = |count: usize| plain(100.0 * count as f64 / truth.drawn.max(1) as f64);
        let (lit, shadowed, ambiguous) = (share(truth.lit), share(truth.shadowed), share(truth.ambiguous));
        let alt = format!(
            "the truth by ray casting: of the drawn pixels {lit} % lit, {shadowed} % shadowed, {ambiguous} % ambiguous, the \
             rest outside the light"
        );
        figures += &figure(png, scene.size, &alt, "The truth, by ray casting");
    }
    for difference in &pictures.differences {
        let caption = format!("Row {}: {}", difference.row, difference.caption);
        figures += &figure(&difference.png, scene.size, &difference_alt(scene, difference.row), &caption);
    }
    if figures.is_empty() {
        return "<p class=\"note\">This report was written without pictures.</p>\n".to_owned();
    }
    let item = |([r, g, b], name): &([u8; 3], &str)| {
        format!("<li><span class=\"color\" style=\"background:#{r:02x}{g:02x}{b:02x}\"></span>{}</li>", escape(name))
    };
    let legend: String = LEGEND.iter().map(item).collect();
    let legend = match pictures.truth.is_some() || !pictures.differences.is_empty() {
        true => format!("<ul class=\"legend\" aria-label=\"colours\">{legend}</ul>\n"),
        false => String::new(),
    };
    format!("<div class=\"figures\">\n{figures}</div>\n{legend}")
}

/// Description of a difference picture.
fn difference_alt(scene: &SceneReport, index: usize) -> String {
    let row = scene.rows.iter().find(|row| row.index == index);
    match row.and_then(|row| Some((row, row.measured()?))) {
        None => format!("where row {index} differs from the truth"),
        Some((row, measured)) => format!(
            "where row {index}, {} {}, differs from the truth: {} % false shadow in blue, {} % leak in orange",
            row.technique,
            row.settings_text(),
            plain(measured.metrics.all.false_shadow_percent),
            plain(measured.metrics.all.leak_percent)
        ),
    }
}

/// A row's band may be of its own map's size.
fn band_text(scene: &SceneReport) -> String {
    let judged = || scene.rows.iter().filter_map(Row::measured).filter(|measured| measured.metrics.all.compared > 0);
    let bands = || judged().map(|measured| measured.metrics.band);
    let by_area = |band: &Band| u64::from(band.map_size[0]) * u64::from(band.map_size[1]);
    let Some((least, greatest)) = bands().min_by_key(by_area).zip(bands().max_by_key(by_area)) else {
        return String::new();
    };
    let map =
        |band: &Band| format!("{} texels of a {} × {} map", plain(band.texels), band.map_size[0], band.map_size[1]);
    let range = if least == greatest { map(&least) } else { format!("from {} to {}", map(&greatest), map(&least)) };
    format!("<p>The band reaches {range} away from true shadow edges.</p>\n")
}

fn marks(scene: &SceneReport, times: &RowTimes<'_>, goals: &Goals) -> Marks {
    let mut marks = Marks::new();
    let mut mark = |row: &Row, why| marks.entry(row.index).or_default().push(why);
    if let Some(row) = scene.rows.iter().find(|row| row.index == 0) {
        mark(row, "as written");
    }
    let picks = Picks::of(scene, goals);
    let chips = [("cheapest", "perhaps cheapest"), ("most exact", "perhaps most exact")];
    for (pick, (chip, perhaps)) in [picks.cheapest, picks.most_exact].iter().flatten().zip(chips) {
        mark(pick.row, chip);
        pick.rivals.iter().for_each(|row| mark(row, perhaps));
    }
    for (row, _) in pareto(scene, times) {
        mark(row, "Pareto front");
    }
    marks
}

/// The settings to take, or why none is named.
fn answers(scene: &SceneReport, number: usize, goals: &Goals) -> String {
    let mut text = String::from("<h3>The settings to take</h3>\n");
    let picks = Picks::of(scene, goals);
    let warnings = unjudged(scene).or_else(|| picks.times.warning());
    text.extend(warnings.map(|warning| format!("<p class=\"note\">{}</p>\n", escape(&warning))));
    if scene.unshaded.is_some() {
        return text;
    }
    format!("{text}<div class=\"cards\">\n{}</div>\n", cards(scene, &picks, number, goals))
}

fn cards(scene: &SceneReport, picks: &Picks<'_>, number: usize, goals: &Goals) -> String {
    let front = pareto(scene, &picks.times);
    let instead = |best: Option<&(&Row, &Measured)>, what: &str| match best {
        Some((row, measured)) => format!(
            "No setting measured is. The {what} is row {}: {} % wrong in {} ms.",
            row.index,
            plain(measured.wrong_percent()),
            plain(picks.times.of_row(measured))
        ),
        None => "No setting was measured.".to_owned(),
    };
    let picked = [&picks.cheapest, &picks.most_exact];
    let instead = [instead(front.last(), "least wrong"), instead(front.first(), "fastest")];
    let mut text = String::new();
    for ((title, pick), instead) in titles(goals).iter().zip(picked).zip(instead) {
        text += &match pick {
            Some(pick) => card(title, (pick.row, pick.measured), &pick.doubts(goals), number, &picks.times),
            None => empty_card(title, &instead),
        };
    }
    let written = scene.rows.iter().find(|row| row.index == 0).and_then(|row| Some((row, row.measured()?)));
    let title = "The scene as it is written";
    text + &match written {
        Some(written) => card(title, written, &[], number, &picks.times),
        None => empty_card(title, "Row 0 was not measured."),
    }
}

fn empty_card(title: &str, instead: &str) -> String {
    format!("<div class=\"card\"><h4>{}</h4>\n<p>{}</p></div>\n", escape(title), escape(instead))
}

fn card(
    title: &str,
    (row, measured): (&Row, &Measured),
    doubts: &[String],
    number: usize,
    times: &RowTimes<'_>,
) -> String {
    let [least, greatest] = times.bar(measured).map(plain);
    let doubts: String = doubts.iter().map(|doubt| format!("<p class=\"doubt\">{}</p>\n", escape(doubt))).collect();
    format!(
        "<div class=\"card\"><h4>{}</h4>\n<p class=\"key\"><b>{}</b> % wrong in <b>{}</b> ms, {} · \
         <a href=\"#s{number}r{index}\">row {index}</a></p>\n<p>The {} of {} runs; runs of this work took {least} to \
         {greatest} ms.</p>\n{doubts}<pre><code>{}</code></pre>\n{}</div>\n",
        escape(title),
        plain(measured.wrong_percent()),
        plain(times.of_row(measured)),
        bytes(measured.image_bytes + measured.buffer_bytes),
        times.name(),
        measured.frame_redrawn.runs,
        escape(&row.to_toml()),
        plan_text(measured),
        index = row.index,
    )
}

/// Passes, what the plan left out, and its warnings.
fn plan_text(measured: &Measured) -> String {
    let left_out = list(measured.left_out.iter().map(|item| format!("{}: {}", item.what, item.why)));
    let left_out = if left_out.is_empty() { "<p>Nothing.</p>\n".to_owned() } else { left_out };
    let warnings = match measured.warnings.is_empty() {
        true => String::new(),
        false => format!("<h5>Warnings</h5>\n{}", list(measured.warnings.iter().cloned())),
    };
    format!(
        "{warnings}<details><summary>Its passes, and what is left out</summary>\n<div class=\"wide\">{}</div>\n<h5>Left out \
         of its plan</h5>\n{left_out}</details>\n",
        table::passes(measured)
    )
}
