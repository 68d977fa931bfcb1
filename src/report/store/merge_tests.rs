//! A made-up report, cut into parts and joined again.

use super::*;
use crate::report::samples;

/// Row i goes to part i mod `count`, as a sweep's shards do it.
fn shards(report: &Report, count: usize) -> Vec<(PathBuf, Report)> {
    let part = |number: usize| {
        let mut part = report.clone();
        part.complete = false;
        for scene in &mut part.scenes {
            scene.rows.retain(|row| row.index % count == number);
        }
        (PathBuf::from(format!("part{number}")), part)
    };
    (0..count).map(part).collect()
}

fn two_scenes() -> Report {
    let mut report = samples::report();
    report.scenes.push(samples::scene("scenes/other.toml", "f2"));
    report.asked_scenes = 2;
    report
}

fn measured(row: &mut Row) -> &mut Measured {
    match &mut row.outcome {
        Outcome::Measured(measured) => measured,
        Outcome::Failed(why) => panic!("{why}"),
    }
}

#[test]
fn parts_in_any_order_make_the_whole() {
    let whole = two_scenes();
    for count in [1, 2, 3, 7] {
        let mut parts = shards(&whole, count);
        parts.reverse();
        assert_eq!(merge(parts).unwrap(), whole, "{count} parts");
    }
}

#[test]
fn a_missing_part_leaves_the_report_incomplete() {
    let mut parts = shards(&two_scenes(), 3);
    parts.remove(1);
    assert!(!merge(parts).unwrap().complete);
}

#[test]
fn a_scene_that_no_part_came_to_leaves_the_report_incomplete() {
    let mut parts = shards(&two_scenes(), 2);
    for (_, part) in &mut parts {
        part.scenes.pop();
    }
    assert!(!merge(parts).unwrap().complete);
}

#[test]
fn a_part_that_was_cut_short_has_the_first_scenes_only() {
    let mut parts = shards(&two_scenes(), 2);
    parts[0].1.scenes.pop();
    let report = merge(parts).unwrap();
    assert_eq!((report.scenes.len(), report.complete), (2, false));
}

#[test]
fn a_row_measured_twice_may_differ_in_times() {
    let whole = samples::report();
    let mut parts = shards(&whole, 2);
    parts.push(parts[0].clone());
    let again = measured(&mut parts[2].1.scenes[0].rows[0]);
    again.frame_redrawn.median *= 2.0;
    again.passes[0].wall.median *= 2.0;
    assert_eq!(merge(parts).unwrap(), whole);
}

#[test]
fn a_row_measured_twice_must_not_differ_in_errors() {
    let mut parts = shards(&samples::report(), 2);
    parts.push((PathBuf::from("again"), parts[0].1.clone()));
    measured(&mut parts[2].1.scenes[0].rows[1]).metrics.all.wrong_percent += 0.1;
    let error = merge(parts).unwrap_err().to_string();
    for word in ["part0", "again", "row 2", "scenes/main.toml", "size = 256"] {
        assert!(error.contains(word), "{word} is not in: {error}");
    }
}

#[test]
fn parts_of_other_scenes_are_refused() {
    let mut parts = shards(&samples::report(), 2);
    parts[1].1.scenes[0].fingerprint = "other".to_owned();
    let error = merge(parts).unwrap_err().to_string();
    for word in ["part0", "part1", "scenes/main.toml", "same scenes"] {
        assert!(error.contains(word), "{word} is not in: {error}");
    }
}

#[test]
fn parts_of_other_drivers_are_refused() {
    let mut parts = shards(&samples::report(), 2);
    parts[1].1.machine.renderer = "SuperGL 9".to_owned();
    let error = merge(parts).unwrap_err().to_string();
    for word in ["part0", "part1", "SuperGL 9", "llvmpipe"] {
        assert!(error.contains(word), "{word} is not in: {error}");
    }
}

#[test]
fn several_processors_are_noted() {
    let mut parts = shards(&samples::report(), 3);
    parts[1].1.machine.processor = "Other".to_owned();
    let report = merge(parts).unwrap();
    assert!(report.complete);
    assert_eq!(report.notes.len(), 1);
    assert!(report.notes[0].contains("Other") && report.notes[0].contains("Made-up"), "{}", report.notes[0]);
}

#[test]
fn a_truth_that_differs_is_refused() {
    let mut parts = shards(&samples::report(), 2);
    parts[1].1.scenes[0].truth.lit += 1;
    assert!(merge(parts).unwrap_err().to_string().contains("the truth"));
}

#[test]
fn nothing_is_no_report() {
    assert!(matches!(merge(Vec::new()), Err(Error::Nothing)));
}

#[test]
fn a_report_is_read_back_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let mut report = samples::report();
    let rows = report.scenes[0].rows.iter_mut().filter(|row| row.measured().is_some());
    for (index, row) in rows.enumerate() {
        measured(row).frame_redrawn.median = (index as f64 + 2.0).sqrt() / 3.0;
    }
    let path = folder.path().join("report.json");
    std::fs::write(&path, serde_json::to_vec(&report).unwrap()).unwrap();
    assert_eq!(load(&path).unwrap(), report);
    assert_eq!(load(folder.path()).unwrap(), report);
}

#[test]
fn damaged_files_are_refused_by_name() {
    let text = serde_json::to_string(&samples::report()).unwrap();
    let mut twice = samples::report();
    let row = twice.scenes[0].rows[3].clone();
    twice.scenes[0].rows.insert(3, row);
    let cases = [
        ("cut", text[..text.len() / 2].to_owned(), "cut off"),
        ("empty", String::new(), "cut off"),
        ("other", "{\"a\": 1}".to_owned(), "no `version`"),
        ("newer", text.replacen("\"version\":3", "\"version\":99", 1), "layout 99"),
        ("older", text.replacen("\"version\":3", "\"version\":2", 1), "layout 2, this glumbra reads 3: measure again"),
        ("type", text.replacen("\"cores\":2", "\"cores\":\"two\"", 1), "no report"),
        ("twice", serde_json::to_string(&twice).unwrap(), "row 3 stands twice"),
        ("outside", text.replacen("\"grid_rows\":94", "\"grid_rows\":9", 1), "outside its grid"),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (name, text, words) in cases {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        let error = load(&path).unwrap_err().to_string();
        assert!(error.contains(words) && error.contains(name), "{name}: {error}");
    }
    assert!(load(&folder.path().join("missing")).unwrap_err().to_string().contains("cannot be read"));
}

#[test]
fn a_report_that_calls_itself_complete_is_counted() {
    let folder = tempfile::tempdir().unwrap();
    let mut report = samples::report();
    report.scenes[0].rows.pop();
    let path = folder.path().join("report.json");
    std::fs::write(&path, serde_json::to_vec(&report).unwrap()).unwrap();
    assert!(!load(&path).unwrap().complete);
}

/// The first part alone has sweeps; the whole has them whatever the order of the parts.
#[test]
fn sweeps_of_one_part_are_those_of_the_whole() {
    let mut whole = samples::report();
    whole.scenes = vec![samples::projected_scene("scenes/main.toml", "f1")];
    let mut parts = shards(&whole, 3);
    parts[1..].iter_mut().for_each(|(_, part)| part.scenes[0].sweeps.clear());
    parts.reverse();
    assert_eq!(merge(parts).unwrap(), whole);
}
