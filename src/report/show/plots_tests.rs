//! Plots of a made-up report, by what their SVG says.

use super::*;
use crate::report::samples;
use crate::report::store::results::Outcome;

const LINKS: Links<'_> = Links { page: "../report.html", scene: 1 };

fn time_plot(change: impl FnOnce(&mut SceneReport)) -> Option<String> {
    let mut report = samples::report();
    change(&mut report.scenes[0]);
    error_against_time(&report.scenes[0], &report.machine, LINKS).unwrap()
}

/// Text between tags.
fn texts(svg: &str) -> Vec<String> {
    let inner = svg.split("<text").skip(1).filter_map(|text| text.split('>').nth(1));
    inner.map(|text| text.split('<').next().unwrap_or_default().trim().to_owned()).collect()
}

#[test]
fn a_plot_names_scene_driver_machine_units_and_techniques() {
    let svg = time_plot(|_| ()).unwrap();
    let all = texts(&svg).join("\n");
    for word in [
        "main.toml",
        "llvmpipe",
        "Mesa 22.3.6",
        "2 cores",
        "in ms",
        "in %",
        "shadow-map",
        "variance",
        "Pareto",
        "as written",
    ] {
        assert!(all.contains(word), "{word} is not in:\n{all}");
    }
    assert!(!svg.contains("<CPU>"), "what the system says is not escaped");
}

#[test]
fn labels_are_plain_numbers() {
    let texts = texts(&time_plot(|_| ()).unwrap());
    for label in ["0", "0.1", "1", "10", "20", "50"] {
        assert!(texts.iter().any(|text| text == label), "{label} is not in {texts:?}");
    }
}

#[test]
fn zeros_are_marked_only_where_there_are_any() {
    assert!(time_plot(|_| ()).unwrap().contains("no wrong pixel"));
    assert!(!time_plot(|scene| scene.rows.retain(|row| row.technique != "exact")).unwrap().contains("no wrong pixel"));
}

#[test]
fn a_report_without_measures_has_no_plot() {
    assert_eq!(time_plot(|scene| scene.rows.clear()), None);
    let fail = |scene: &mut SceneReport| {
        for row in &mut scene.rows {
            row.outcome = Outcome::Failed("lost".to_owned());
        }
    };
    assert_eq!(time_plot(fail), None);
}

#[test]
fn a_single_row_has_a_plot() {
    for index in [0, 1] {
        assert!(time_plot(|scene| scene.rows.retain(|row| row.index == index)).is_some());
    }
    assert!(time_plot(|scene| scene.rows.retain(|row| row.technique == "exact")).is_some());
}

#[test]
fn map_sizes_are_plotted_where_several_exist() {
    let report = samples::report();
    let svg = error_against_map_size(&report.scenes[0], &report.machine, LINKS).unwrap().unwrap();
    for size in ["256", "512", "1024", "2048", "4096"] {
        assert!(texts(&svg).iter().any(|text| text == size), "{size}");
    }
    let mut one = report.scenes[0].clone();
    one.rows.retain(|row| row.settings.iter().all(|(key, value)| key != "size" || value == "512"));
    assert_eq!(error_against_map_size(&one, &report.machine, LINKS).unwrap(), None);
}

#[test]
fn points_link_to_their_rows_and_say_what_they_are() {
    let report = samples::report();
    let svg = time_plot(|_| ()).unwrap();
    for row in report.scenes[0].rows.iter().filter(|row| row.measured().is_some()) {
        let link = format!("<a href=\"../report.html#s1r{}\"><title>row {0}: {} ", row.index, row.technique);
        assert!(svg.contains(&link), "{link}");
    }
    assert_eq!(svg.matches("</a>").count(), svg.matches("<a ").count());
}

#[test]
fn a_plot_has_a_title_and_a_description() {
    let report = samples::report();
    let size = error_against_map_size(&report.scenes[0], &report.machine, LINKS).unwrap().unwrap();
    for (svg, title) in [(time_plot(|_| ()).unwrap(), "time"), (size, "map size")] {
        let title = format!("Error against {title}: main.toml");
        assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"));
        assert!(
            svg.contains(&format!("role=\"img\" aria-label=\"{title}\">\n<title>{title}</title>\n<desc>wrong pixels"))
        );
    }
}

/// A bar ends in two strokes across it, six pixels long.
#[test]
fn every_point_has_its_error_bar() {
    let report = samples::report();
    let svg = time_plot(|_| ()).unwrap();
    let is_end = |points: &str| {
        let numbers: Vec<i32> = points.split([',', ' ']).filter_map(|number| number.parse().ok()).collect();
        matches!(numbers[..], [a, b, c, d] if a == c && (b - d).abs() == 6)
    };
    let ends = svg.split("points=\"").skip(1).filter(|part| is_end(part.split('"').next().unwrap_or_default())).count();
    let rows = report.scenes[0].rows.iter().filter(|row| row.measured().is_some()).count();
    let front = pareto(&report.scenes[0], &RowTimes::of(&report.scenes[0])).len();
    // Those of the front are drawn once more above its line; one stands in the legend.
    assert_eq!(ends, 2 * (rows + front + 1));
    assert!(texts(&svg).iter().any(|text| text == "least to greatest run"));
}

#[test]
fn a_sweep_has_its_points_its_bars_and_its_exponent() {
    let report = samples::report();
    let mut scene = samples::projected_scene("scenes/main.toml", "f");
    let of = |scene: &SceneReport, measure| sweep(scene, &report.machine, &scene.sweeps[0], measure).unwrap();
    let [rmse, flip] = [Measure::Rmse, Measure::Flip].map(|measure| of(&scene, measure).unwrap());
    let (rmse_texts, flip_texts) = (texts(&rmse).join("\n"), texts(&flip).join("\n"));
    for text in [&rmse_texts, &flip_texts] {
        for word in ["lens points", "main.toml", "in ms", "1", "4", "16", "64", "least to greatest run"] {
            assert!(text.lines().any(|line| line.contains(word)), "{word} is not in:\n{text}");
        }
        assert!(!text.lines().any(|line| line == "256"), "what was not drawn is not plotted");
    }
    assert!(rmse_texts.contains("-0.50, 0.49 to 0.51") && rmse_texts.contains("codes of 1/255"), "{rmse_texts}");
    assert!(!flip_texts.contains("0.49 to 0.51") && flip_texts.contains("mean of FLIP"), "{flip_texts}");
    assert!(rmse.contains("<title>focus.samples = 16: RMSE 2 codes, 30.4 to 38.4 ms</title>"), "{rmse}");
    scene.sweeps[0].series[0].points.clear();
    assert_eq!(of(&scene, Measure::Rmse), None);
}
