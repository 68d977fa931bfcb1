//! Picks of a made-up report, whose times are made steady, loaded, or alike.

use super::*;
use crate::report::samples;
use crate::report::store::results::{Outcome, Report};

/// The sample's scene; `times` gives each row's least, median and greatest run.
fn scene(times: impl Fn(&Row, Spread) -> [f64; 3]) -> SceneReport {
    let Report { mut scenes, .. } = samples::report();
    let mut scene = scenes.remove(0);
    for row in &mut scene.rows {
        let copy = row.clone();
        if let Outcome::Measured(measured) = &mut row.outcome {
            let [least, median, greatest] = times(&copy, measured.frame_redrawn);
            measured.frame_redrawn = Spread { least, median, greatest, runs: 5 };
        }
    }
    scene
}

fn steady(_: &Row, spread: Spread) -> [f64; 3] {
    [0.98 * spread.median, spread.median, 1.02 * spread.median]
}

const GOALS: Goals = Goals { wrong_percent: 0.5, milliseconds: 10.0 };

#[test]
fn a_steady_machine_is_picked_from_by_the_median() {
    let scene = scene(steady);
    let picks = Picks::of(&scene, &GOALS);
    assert!(!picks.times.is_loaded() && picks.times.warning().is_none());
    let cheapest = picks.cheapest.unwrap();
    assert_eq!(cheapest.milliseconds, cheapest.measured.frame_redrawn.median);
    assert!(cheapest.measured.wrong_percent() <= 0.5);
    let most_exact = picks.most_exact.unwrap();
    assert!(most_exact.milliseconds <= 10.0 && !most_exact.may_be_late && most_exact.doubts(&GOALS).is_empty());
}

/// One row's runs were all disturbed: of the rows that do the same work the fastest says what it takes.
#[test]
fn a_twin_at_another_time_is_told() {
    let quiet = scene(steady);
    let pick = Picks::of(&quiet, &GOALS).most_exact.unwrap().row.index;
    let work = quiet.rows[pick].measured().unwrap().work.clone();
    let is_twin = |row: &Row| row.index != pick && row.measured().is_some_and(|measured| measured.work == work);
    let disturbed = quiet.rows.iter().find(|row| is_twin(row)).unwrap().index;
    let slow = |row: &Row, spread: Spread| match row.index == disturbed {
        true => [74.0, 75.0, 76.0],
        false => steady(row, spread),
    };
    let scene = scene(slow);
    let picks = Picks::of(&scene, &GOALS);
    let most_exact = picks.most_exact.unwrap();
    assert_eq!(most_exact.row.index, pick);
    assert!(most_exact.may_be_late && most_exact.bar[1] == 76.0, "{:?}", most_exact.bar);
    assert!(most_exact.doubts(&GOALS)[0].starts_with("Not sure: some runs of this work took longer than 10 ms"));
    assert!(to_text(&scene, &GOALS).contains("# Not sure:"), "{}", to_text(&scene, &GOALS));
}

/// Every median is doubled, the least runs are as they were: the picks are those of a quiet machine.
#[test]
fn on_a_loaded_machine_the_least_decides() {
    let quiet = scene(steady);
    let loaded = scene(|row, spread| {
        let [least, ..] = steady(row, spread);
        let noise = 1.5 + f64::from(row.index as u32 * 7919 % 13) / 4.0;
        [least, noise * least, 1.4 * noise * least]
    });
    let (before, after) = (Picks::of(&quiet, &GOALS), Picks::of(&loaded, &GOALS));
    assert!(after.times.is_loaded() && after.times.name() == "least");
    let indices = |picks: &Picks<'_>| [&picks.cheapest, &picks.most_exact].map(|pick| pick.as_ref().unwrap().row.index);
    assert_eq!(indices(&before), indices(&after));
    assert!(to_text(&loaded, &GOALS).contains("The machine did other work meanwhile"));
    assert!(!after.cheapest.unwrap().rivals.is_empty());
}

#[test]
fn bars_that_meet_cannot_be_told_apart() {
    let scene = scene(|row, spread| match row.measured().is_some_and(|measured| measured.wrong_percent() <= 0.5) {
        true => [9.0, 9.0 + 1e-3 * row.index as f64, 10.0],
        false => steady(row, spread),
    });
    let cheapest = Picks::of(&scene, &GOALS).cheapest.unwrap();
    let alike = scene.rows.iter().filter_map(Row::measured).filter(|measured| measured.wrong_percent() <= 0.5).count();
    assert_eq!(cheapest.rivals.len(), alike - 1);
    let doubt = &cheapest.doubts(&GOALS)[0];
    assert!(doubt.contains("cannot rule out that rows") && doubt.contains(" more are better"), "{doubt}");
}

#[test]
fn the_front_is_sorted_and_descends() {
    let scene = scene(steady);
    let times = RowTimes::of(&scene);
    let front = pareto(&scene, &times);
    assert!(front.len() > 3);
    for pair in front.windows(2) {
        assert!(times.of_row(pair[0].1) <= times.of_row(pair[1].1));
        assert!(pair[0].1.wrong_percent() > pair[1].1.wrong_percent());
    }
}

#[test]
fn nothing_is_named_from_too_few_pixels() {
    let mut scene = scene(steady);
    for row in &mut scene.rows {
        if let Outcome::Measured(measured) = &mut row.outcome {
            measured.metrics.all.compared = 999;
        }
    }
    let picks = Picks::of(&scene, &GOALS);
    assert!(picks.cheapest.is_none() && picks.most_exact.is_none());
    let text = to_text(&scene, &GOALS);
    assert!(text.contains("999 pixels could be compared") && !text.contains("[light.shadow]"), "{text}");
}

/// The answer is TOML that parses, piece by piece, and comments.
#[test]
fn the_answer_is_toml_to_paste() {
    let scene = scene(steady);
    let text = to_text(&scene, &GOALS);
    assert_eq!(text.matches("[light.shadow]\n").count(), 2, "{text}");
    for part in text.split("[light.shadow]").skip(1) {
        let table: toml::Table = part.parse().unwrap();
        assert!(table.contains_key("technique") && table.contains_key("size"), "{part}");
    }
}
