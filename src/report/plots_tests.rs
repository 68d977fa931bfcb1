//! Plots of a made-up report, by what their SVG says.

use super::super::results::Outcome;
use super::super::samples;
use super::*;

fn time_plot(change: impl FnOnce(&mut SceneReport)) -> Option<String> {
    let mut report = samples::report();
    change(&mut report.scenes[0]);
    error_against_time(&report.scenes[0], &report.machine).unwrap()
}

/// What stands between tags.
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
    let svg = error_against_map_size(&report.scenes[0], &report.machine).unwrap().unwrap();
    for size in ["256", "512", "1024", "2048", "4096"] {
        assert!(texts(&svg).iter().any(|text| text == size), "{size}");
    }
    let mut one = report.scenes[0].clone();
    one.rows.retain(|row| row.settings.iter().all(|(key, value)| key != "size" || value == "512"));
    assert_eq!(error_against_map_size(&one, &report.machine).unwrap(), None);
}
