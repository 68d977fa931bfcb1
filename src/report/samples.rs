//! A made-up report for tests: times grow with the map, errors shrink with it.

use super::measure::fit::PowerFit;
use super::store::claimed::{ClaimVerdict, Claimed, Measurement};
use super::store::results::{
    Machine, Measured, Outcome, PassCost, Report, Row, SceneReport, Spread, TruthSummary, VERSION,
};
use super::store::swept::{LightSweep, PointErrors, PointOutcome, SweepPoint, SweepSeries};
use crate::judge::colors::ColorErrors;
use crate::judge::metrics::{Band, EdgeDistance, ErrorSplit, Errors, Metrics, NotCompared};

/// One scene; row 0 as written, three techniques, one row that failed and one without an error.
pub fn report() -> Report {
    Report {
        version: VERSION,
        complete: true,
        machine: Machine {
            processor: "Made-up <CPU> & Co @ 2.00GHz".to_owned(),
            cores: 2,
            renderer: "llvmpipe (LLVM 15.0.6, 256 bits)".to_owned(),
            gl_version: "4.5 (Core Profile) Mesa 22.3.6".to_owned(),
            backend: "egl surfaceless".to_owned(),
            glumbra: "0.1.0".to_owned(),
            jobs: 1,
        },
        notes: Vec::new(),
        asked_scenes: 1,
        scenes: vec![scene("scenes/main.toml", "f1")],
    }
}

fn claimed(value: f64, verdict: ClaimVerdict) -> Claimed {
    let side = |value| Measurement { settings: String::from("technique = \"a <b>\""), value: Some(value), why: None };
    Claimed {
        technique: String::from("pcf"),
        source: String::from("Papers & Pages"),
        says: String::from("leaks less"),
        quantity: String::from("leak, %"),
        first: side(value),
        relation: String::from("at most 0.5 ×"),
        second: side(1.0),
        ratio_range: (value < 0.5).then_some([0.15, 0.25]),
        verdict,
    }
}

pub fn scene(path: &str, fingerprint: &str) -> SceneReport {
    let mut rows = vec![("shadow-map", keys(1024, "linear", "1.1"))];
    for technique in ["shadow-map", "pcf", "variance"] {
        for size in [256, 512, 1024, 2048, 4096] {
            for filter in ["nearest", "linear"] {
                for factor in ["0.0", "1.1", "4.0"] {
                    rows.push((technique, keys(size, filter, factor)));
                }
            }
        }
    }
    rows.push(("unshadowed", Vec::new()));
    rows.push(("exact", vec![("note".to_owned(), "\"a, \\\"b\\\"\"".to_owned())]));
    rows.push(("broken", keys(16384, "linear", "1.1")));
    let rows: Vec<Row> = rows.into_iter().enumerate().map(|(index, (name, keys))| row(index, name, keys)).collect();
    SceneReport {
        path: path.into(),
        path_bytes: None,
        fingerprint: fingerprint.to_owned(),
        light: 0,
        size: [512, 512],
        triangles: 69_451,
        truth: TruthSummary {
            drawn: 200_000,
            lit: 150_000,
            shadowed: 48_000,
            ambiguous: 2_000,
            ambiguous_percent: 1.0,
            trace_ms: 1_834.2,
        },
        unshaded: None,
        colors_from: None,
        saved: None,
        sweeps: Vec::new(),
        claim_sweeps: Vec::new(),
        claims: vec![claimed(0.2, ClaimVerdict::Holds), claimed(0.9, ClaimVerdict::Fails)],
        grid_rows: rows.len(),
        rows,
    }
}

/// A scene whose colours are compared, with a sweep: errors fall with the number of samples, the last could not be drawn.
pub fn projected_scene(path: &str, fingerprint: &str) -> SceneReport {
    let mut scene = scene(path, fingerprint);
    scene.colors_from = Some(String::from("colours of <f64>"));
    let colors = |rmse: f64| ColorErrors {
        compared: 200_000,
        rmse_codes: rmse,
        most_codes: 9.0 * rmse,
        beyond_percent: 2.0 * rmse,
        flip: Some(0.01 * rmse),
    };
    if let Some(Row { outcome: Outcome::Measured(measured), .. }) = scene.rows.first_mut() {
        measured.colors = Some(colors(0.5));
    }
    let point = |count: f64| SweepPoint {
        setting: format!("focus.samples = {count}"),
        label: count.to_string(),
        count: Some(count),
        outcome: match count < 256.0 {
            true => PointOutcome::Measured(PointErrors {
                errors: colors(8.0 / count.sqrt()),
                second: Some(colors(9.0 / count.sqrt())),
                frame: Spread { median: 2.0 * count, least: 1.9 * count, greatest: 2.4 * count, runs: 5 },
            }),
            false => PointOutcome::Failed(String::from("out of <memory>")),
        },
    };
    let points = [1.0, 4.0, 16.0, 64.0, 256.0].map(point).to_vec();
    let fit = Some(PowerFit { exponent: 0.5, range: [0.49, 0.51], points: 4 });
    scene.sweeps = vec![LightSweep {
        name: String::from("lens points"),
        key: String::from("focus.samples"),
        source: String::from("Papers & Pages"),
        reference: String::from("a picture of <many> points"),
        law: String::from("It falls."),
        second_reference: Some(String::from("rays")),
        series: vec![SweepSeries { name: String::from("lens points"), points, fit, expected: Some([0.5, 1.0]) }],
    }];
    scene
}

fn keys(size: u32, filter: &str, factor: &str) -> Vec<(String, String)> {
    vec![
        ("size".to_owned(), size.to_string()),
        ("filter".to_owned(), format!("\"{filter}\"")),
        ("offset".to_owned(), format!("{{ factor = {factor}, units = 4.0 }}")),
    ]
}

fn row(index: usize, technique: &str, settings: Vec<(String, String)>) -> Row {
    let has = |key: &str, text: &str| settings.iter().any(|(k, v)| k == key && v.contains(text));
    let size: f64 =
        settings.iter().find(|(key, _)| key == "size").and_then(|(_, value)| value.parse().ok()).unwrap_or(0.0);
    let map_size = (size > 0.0).then_some(size as u32);
    let (wrong, time) = match technique {
        "broken" => {
            let why = "framebuffer incomplete: 16384 > GL_MAX_TEXTURE_SIZE".to_owned();
            return Row { index, technique: technique.to_owned(), settings, map_size, outcome: Outcome::Failed(why) };
        }
        "exact" => (0.0, 96.0),
        "unshadowed" => (24.1, 3.9),
        "pcf" => (0.7, 2.2),
        "variance" => (1.6, 1.7),
        _ => (1.0, 1.0),
    };
    let bias = if has("offset", "0.0") && !has("offset", "4.0,") { 9.0 } else { 1.0 } + 0.01 * index as f64;
    let (wrong, time) = if size == 0.0 {
        (wrong, time)
    } else {
        let linear = if has("filter", "linear") { 0.8 } else { 1.0 };
        (wrong * bias * linear * 400.0 / size, 5.0 + time * (0.8 + size * size / 5e5) + 3.0 * (1.0 - linear))
    };
    let measured = Measured {
        metrics: metrics(wrong, size as u32),
        colors: None,
        frame_redrawn: Spread { median: time, least: 0.96 * time, greatest: 1.08 * time, runs: 5 },
        frame_kept: Spread { median: 4.8, least: 4.7, greatest: 5.1, runs: 5 },
        passes: vec![pass("shadow map of light 0", time - 4.0, true), pass("lit", 4.0, false)],
        image_bytes: (size * size * 4.0) as u64,
        buffer_bytes: 2_500_000,
        draw_calls: 14,
        triangles: 138_902,
        work: format!("{technique} {size} {}", has("filter", "linear")),
        left_out: vec![crate::lights::LeftOut {
            what: "color buffer of the map".to_owned(),
            why: "only depth & <nothing else> is read".to_owned(),
        }],
        warnings: if index == 0 { vec!["1 caster is cut by the near plane".to_owned()] } else { Vec::new() },
    };
    Row { index, technique: technique.to_owned(), settings, map_size, outcome: Outcome::Measured(Box::new(measured)) }
}

fn pass(label: &str, ms: f64, has_gpu: bool) -> PassCost {
    let wall = Spread { median: ms, least: 0.9 * ms, greatest: 1.2 * ms, runs: 5 };
    PassCost {
        label: label.to_owned(),
        wall,
        gpu: has_gpu.then_some(wall),
        triangles: 69_451,
        fragments: has_gpu.then_some(210_345),
    }
}

fn metrics(wrong: f64, size: u32) -> Metrics {
    let split = |percent: f64| ErrorSplit {
        inside: (1980.0 * 0.9 * percent) as usize,
        outside: (1980.0 * 0.1 * percent) as usize,
        inside_percent: 0.9 * percent,
        outside_percent: 0.1 * percent,
    };
    let edges =
        EdgeDistance { edges: 4200, mean_pixels: 0.4 * wrong, p95_pixels: 1.5 * wrong, max_pixels: 7.0 * wrong };
    let all = Errors {
        compared: 198_000,
        compared_in_band: 6_000,
        false_shadow: split(0.7 * wrong),
        leak: split(0.3 * wrong),
        false_shadow_percent: 0.7 * wrong,
        leak_percent: 0.3 * wrong,
        wrong_percent: wrong,
        wrong_outside_percent: 0.1 * wrong,
        rmse: 0.05 * wrong.sqrt(),
        rendered_to_true: (wrong < 24.0).then_some(edges),
        true_to_rendered: Some(edges),
    };
    Metrics {
        band: Band { texels: 1.5, map_size: [size.max(1); 2] },
        all,
        facing: Errors { compared: 150_000, wrong_percent: 0.8 * wrong, ..all },
        left_out: NotCompared { background: 62_000, ambiguous: 2_000, outside_cone: 130, not_drawn: 7, only_drawn: 7 },
    }
}
