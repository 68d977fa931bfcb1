//! The page of a made-up report.

use super::*;
use crate::report::measure::picks::{Picks, pareto};
use crate::report::samples;
use crate::report::store::results::Outcome;

const GOALS: Goals = Goals { wrong_percent: 0.5, milliseconds: 10.0 };

fn page(change: impl FnOnce(&mut Report)) -> String {
    let mut report = samples::report();
    change(&mut report);
    let png = |name: &str| Some(name.as_bytes().to_vec());
    let difference = DifferencePicture { row: 5, caption: "5 < 6".to_owned(), png: b"difference".to_vec() };
    let scene = ScenePictures {
        picture: png("picture"),
        truth: png("truth"),
        differences: vec![difference],
        light: Vec::new(),
    };
    to_html(&report, &ReportPictures { scenes: vec![scene] }, &GOALS)
}

/// Every tag that is opened is closed, in order.
fn check_nesting(page: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = page;
    while let Some(start) = rest.find('<') {
        rest = &rest[start + 1..];
        let end = rest.find('>').expect("a tag that does not end");
        let tag = &rest[..end];
        let name = tag.split_whitespace().next().unwrap_or_default();
        rest = &rest[end + 1..];
        match name.strip_prefix('/') {
            Some(closed) => {
                assert_eq!(open.pop(), Some(closed), "before: {}", rest.chars().take(80).collect::<String>())
            }
            None if name.starts_with('!') || tag.ends_with('/') || ["meta", "img"].contains(&name) => {}
            None => {
                open.push(name);
                if let "script" | "style" = name {
                    rest = &rest[rest.find(&format!("</{name}")).expect("raw text that does not end")..];
                }
            }
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

#[test]
fn tags_are_closed() {
    check_nesting(&page(|_| ()));
    check_nesting(&page(|report| report.scenes.clear()));
    check_nesting(&page(|report| report.scenes[0].rows.clear()));
    check_nesting(&to_html(&samples::report(), &ReportPictures::default(), &Goals::default()));
}

/// A page of projected light with all its pictures.
fn projected_page() -> String {
    use crate::report::store::light_pictures;
    let mut report = samples::report();
    report.scenes = vec![samples::projected_scene("scenes/main.toml", "f1")];
    let names = light_pictures::names(&report.scenes[0]);
    let light = names.iter().map(|picture| (picture.name.clone(), picture.name.clone().into_bytes())).collect();
    let scene = ScenePictures { light, ..ScenePictures::default() };
    to_html(&report, &ReportPictures { scenes: vec![scene] }, &GOALS)
}

#[test]
fn projected_light_has_its_section() {
    let page = projected_page();
    check_nesting(&page);
    for part in [
        "Pictures are compared with colours of &lt;f64&gt;.",
        "RMSE 0.5 codes of 1/255, at most 4.5 codes, 1 % of the pixels beyond",
        "<h3>Sweep: lens points</h3>",
        "RMSE ∝ count^-0.50, 95 % range 0.49 to 0.51, 4 points; expected 0.5 to 1: holds",
        "<td colspan=\"8\" class=\"failure\">out of &lt;memory&gt;</td>",
        "Lens points, FLIP against time: main.toml",
        "focus.samples = 16: FLIP, mean 0.02",
        "FLIP 0.25 and more",
        "<dt>FLIP</dt>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // Colours and FLIP of row 0; the sweep's reference, its first picture, FLIP of the four that were drawn.
    assert_eq!(page.matches("data:image/png;base64,").count(), 8);
    assert!(!page.contains("<f64>") && !page.contains("<memory>") && !page.contains("<many>"));
    let plain = self::page(|_| ());
    assert!(!plain.contains("<h3>Colours</h3>") && !plain.contains("Sweep:"));
}

#[test]
fn a_light_without_a_shade_has_colours_only() {
    let page = page(|report| {
        report.scenes[0] = samples::projected_scene("a.toml", "f");
        report.scenes[0].unshaded = Some(String::from("it is a <slide>"));
    });
    assert!(page.contains("No setting is named: it is a &lt;slide&gt;."));
    assert!(!page.contains("% wrong in") && !page.contains("to trace:"), "nothing is said of a shade");
    assert!(!page.contains("<h3>Error against time</h3>") && page.contains("<h3>Colours</h3>"));
}

#[test]
fn claims_are_told_with_their_verdicts() {
    let page = page(|_| ());
    assert!(page.contains("Published claims, on this scene"));
    assert!(page.contains("0.2<div><small>0.15 to 0.25</small></div>"), "the range of a ratio");
    assert!(page.contains(">holds</td>") && page.contains(" class=\"failure\">does not hold</td>"));
    let without = self::page(|report| report.scenes[0].claims.clear());
    assert!(!without.contains("Published claims"));
}

#[test]
fn the_page_needs_no_other_file() {
    let page = page(|_| ());
    for part in page.split(" src=\"").skip(1) {
        assert!(part.starts_with("data:image/png;base64,"), "{}", &part[..40]);
    }
    for part in page.split("href=\"").skip(1) {
        assert!(part.starts_with('#'), "{}", &part[..40]);
    }
    assert!(!page.contains("@import") && !page.contains("url("));
    assert!(page.contains("base64,ZGlmZmVyZW5jZQ=="), "the difference picture");
}

#[test]
fn what_the_system_says_is_escaped() {
    let page = page(|report| {
        report.machine.renderer = "<script>alert(1)</script>".to_owned();
        report.scenes[0].path = "a\"><em>.toml".into();
        report.scenes[0].rows[1].technique = "<i>".to_owned();
    });
    for raw in ["<script>alert", "<CPU>", "<em>", "<i>", "<nothing else>"] {
        assert!(!page.contains(raw), "{raw}");
    }
    assert!(page.contains("&lt;script&gt;alert(1)") && page.contains("5 &lt; 6"));
}

#[test]
fn every_row_is_there_and_the_best_are_marked() {
    let report = samples::report();
    let page = page(|_| ());
    let scene = &report.scenes[0];
    for row in &scene.rows {
        assert!(page.contains(&format!("<tr id=\"s1r{}\"", row.index)), "row {}", row.index);
    }
    let picks = Picks::of(scene, &GOALS);
    assert_eq!(page.matches(">Pareto front</span>").count(), pareto(scene, &picks.times).len());
    let cheapest = picks.cheapest.unwrap().row;
    assert!(page.contains(&tags::escape(&cheapest.to_toml())));
    let line = page.lines().find(|line| line.contains(&format!("<tr id=\"s1r{}\"", cheapest.index))).unwrap();
    assert!(line.contains(">cheapest</span>"), "{line}");
    let failed = scene.rows.iter().find(|row| matches!(row.outcome, Outcome::Failed(_))).unwrap();
    let line = page.lines().find(|line| line.contains(&format!("<tr id=\"s1r{}\"", failed.index))).unwrap();
    assert!(line.contains("16384 &gt; GL_MAX_TEXTURE_SIZE"), "{line}");
}

#[test]
fn every_row_has_every_column() {
    let page = page(|_| ());
    let head = page.lines().find(|line| line.contains("<tr class=\"names\"")).unwrap();
    assert_eq!(head.matches("<th").count(), 5 + columns::COLUMNS.len());
    for column in &columns::COLUMNS {
        assert!(page.contains(&format!("<dt>{}</dt>", tags::escape(column.name))), "{}", column.name);
    }
}

#[test]
fn goals_that_nothing_meets_name_what_comes_nearest() {
    let mut report = samples::report();
    report.scenes[0].rows.retain(|row| row.technique == "shadow-map");
    let page = to_html(&report, &ReportPictures::default(), &Goals { wrong_percent: 1e-9, milliseconds: 1e-3 });
    assert!(page.contains("The least wrong is row") && page.contains("The fastest is row"));
}

#[test]
fn doubts_are_told() {
    let said = "This report is not complete";
    assert!(!page(|_| ()).contains(said));
    let cut = |report: &mut Report| {
        report.complete = false;
        report.scenes[0].rows.truncate(7);
    };
    assert!(page(cut).contains(said) && page(cut).contains("7 of 94 rows"));
    assert!(page(|report| report.machine.jobs = 3).contains("3 rows were measured at once"));
    assert!(page(|report| report.notes.push("a < b".to_owned())).contains("a &lt; b"));
}

#[test]
fn the_answer_stands_first() {
    let page = page(|_| ());
    let at = |text: &str| page.find(text).unwrap_or_else(|| panic!("{text}"));
    let answer = at("<h3>The settings to take</h3>");
    for later in ["<figure>", "<div class=\"plot\">", "Measured on</h2>", "Published claims", "All 94 rows"] {
        assert!(answer < at(later), "{later}");
    }
}

#[test]
fn times_have_error_bars_and_doubts() {
    let rows = samples::report().scenes[0].rows.iter().filter(|row| row.measured().is_some()).count();
    let sure = page(|_| ());
    assert_eq!(sure.matches("<span class=\"bar\" title=").count(), rows);
    assert!(!sure.contains("The machine did other work meanwhile"));
    let doubtful = page(|report| {
        for row in &mut report.scenes[0].rows {
            if let Outcome::Measured(measured) = &mut row.outcome {
                measured.frame_redrawn.median *= 2.0;
                measured.frame_redrawn.greatest *= 2.0;
            }
        }
    });
    for part in [
        "The machine did other work meanwhile",
        "<p class=\"doubt\">",
        ">perhaps cheapest</span>",
        "The least of 5 runs",
    ] {
        assert!(doubtful.contains(part), "{part}");
    }
}

#[test]
fn pictures_say_what_they_show_and_points_lead_to_rows() {
    let page = page(|_| ());
    for alt in [
        "alt=\"scenes/main.toml as it is written, rendered in 512 × 512 pixels\"",
        "alt=\"the truth by ray casting: of the drawn pixels 75 % lit, 24 % shadowed, 1 % ambiguous",
        "alt=\"where row 5, shadow-map size = 256",
        "<title>Error against time: main.toml</title>",
        "<a href=\"#s1r5\"><title>row 5: shadow-map",
        "@media print",
    ] {
        assert!(page.contains(alt), "{alt}");
    }
}
