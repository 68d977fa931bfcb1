//! Each technique's frame against the floor's shadow-map frame, in processes taken in turn:
//! `ci/bench --techniques [--scene s1]`. Everything that a technique can draw anew is drawn anew in every frame, but for
//! the rows that say otherwise.

use super::child::Sample;
use super::rounds::{Bench, for_each_scene};
use super::table::{Row, print};
use super::{Arguments, Redraw, Result, Who};

/// A way to draw the scene.
struct Way {
    name: &'static str,
    redraw: Redraw,
    sets: &'static [&'static str],
    /// The greatest ratio to the floor that the issues expect on one model.
    expected: Option<f64>,
}

const fn way(name: &'static str, sets: &'static [&'static str], expected: Option<f64>) -> Way {
    Way { name, redraw: Redraw::Always, sets, expected }
}

const VOLUMES: &str = "light.shadow.technique=shadow-volume";

const WAYS: &[Way] = &[
    way("shadow-map", &[], None),
    way("shadow-map, casters at its resolution", &["light.shadow.casters=texel"], None),
    way("shadow-map, fitted to what is seen", &["light.shadow.fit=view"], None),
    way("shadow-map, 3x3 comparisons", &["light.shadow.kernel=3x3"], None),
    way("shadow-map, tagged in the stencil buffer", &["light.shadow.into=stencil"], None),
    way("midpoint", &["light.shadow.technique=midpoint"], None),
    way("second-depth", &["light.shadow.technique=second-depth", "light.shadow.closed=assume"], None),
    way("shadow-volume, auto", &[VOLUMES], Some(1.0)),
    Way { redraw: Redraw::Once, ..way("shadow-volume, auto, counted once", &[VOLUMES], None) },
    way("shadow-volume, z-pass", &[VOLUMES, "light.shadow.method=z-pass"], None),
    way("shadow-volume, z-pass-two-sided", &[VOLUMES, "light.shadow.method=z-pass-two-sided"], None),
    way("shadow-volume, z-pass-capped", &[VOLUMES, "light.shadow.method=z-pass-capped"], None),
    way("shadow-volume, z-fail", &[VOLUMES, "light.shadow.method=z-fail"], None),
];

/// Measures each way on each scene.
pub fn run(arguments: &Arguments) -> Result<()> {
    let rounds = if arguments.quick { 3 } else { arguments.rounds.max(1) };
    for_each_scene(arguments, |bench| {
        let mut rows: Vec<Row> = Vec::new();
        let mut processor: Vec<Row> = Vec::new();
        let mut shadow: Vec<Row> = Vec::new();
        for way in WAYS {
            rows.push(Row { name: way.name, unit: "ms", expected: way.expected, pairs: Vec::new() });
            shadow.push(Row { name: way.name, unit: "ms of shadow passes", expected: None, pairs: Vec::new() });
            processor.push(Row { name: way.name, unit: "ms of processor time", expected: None, pairs: Vec::new() });
        }
        for round in 0..rounds {
            eprintln!("{:?}: round {} of {rounds}", bench.scene, round + 1);
            let (floor, samples) = measure(bench)?;
            for (index, sample) in samples.iter().enumerate() {
                rows[index].pairs.push((floor.frame_ms, sample.frame_ms));
                processor[index].pairs.push((floor.cpu_ms, sample.cpu_ms));
                shadow[index].pairs.push((floor.depth_ms, sample.shadow_ms));
            }
        }
        println!("\n{:?}: {rounds} rounds; base: the floor's shadow map, drawn anew", bench.scene);
        rows.extend(processor);
        rows.extend(shadow);
        print(&rows);
        Ok(())
    })
}

/// The floor, and each way.
fn measure(bench: &Bench) -> Result<(Sample, Vec<Sample>)> {
    let floor = bench.frames_of(Who::Floor, Redraw::Always, &[])?;
    let samples = WAYS.iter().map(|way| bench.frames_of(Who::Glumbra, way.redraw, way.sets));
    Ok((floor, samples.collect::<Result<_>>()?))
}
