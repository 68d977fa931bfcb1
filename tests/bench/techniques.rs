//! Each technique, and each setting that costs, against its floor, in processes taken in turn:
//! `ci/bench --techniques [--scene s1]`. Everything that a technique can redraw is redrawn in every frame, but for
//! the rows that say otherwise. A way whose picture is neither its floor's nor, by ray-traced truth, as right gets no time.

use std::collections::HashMap;

use clap::ValueEnum;

use super::child::Sample;
use super::judge::Judge;
use super::kinds::Kind;
use super::rounds::{Bench, for_each_scene};
use super::table::{Row, print};
use super::{Arguments, Redraw, Result, Scene, Who, pictures};

/// A way to draw the scene.
struct Way {
    name: &'static str,
    redraw: Redraw,
    sets: &'static [&'static str],
    floor: Kind,
    /// `None`: every scene.
    scene: Option<Scene>,
    /// The greatest ratio to the floor that the issues expect, in each scene.
    expected: [Option<f64>; 2],
}

const fn way(name: &'static str, floor: Kind, sets: &'static [&'static str]) -> Way {
    Way { name, redraw: Redraw::Always, sets, floor, scene: None, expected: [None; 2] }
}

/// By a light that only the first scene has.
const fn by_light(name: &'static str, floor: Kind, sets: &'static [&'static str]) -> Way {
    Way { scene: Some(Scene::S1), ..way(name, floor, sets) }
}

/// The light as a projector, with white light: the sum saturates, so that the passes are not one.
const SLIDE_S1: &str = "light.0={ position = [2.0, 4.0, 3.0], target = [0.0, 0.5, 0.0], cone = 60.0, near = 0.5, far = 20.0, shape = \"frustum\", law = \"slide\", shadow = { technique = \"none\" } }";
const SLIDE_S2: &str = "light.0={ position = [8.0, 26.0, 12.0], target = [0.0, 0.0, 0.0], cone = 70.0, near = 5.0, far = 70.0, shape = \"frustum\", law = \"slide\", shadow = { technique = \"none\" } }";

const VOLUMES: &str = "light.shadow.technique=shadow-volume";

/// A light in the place of the first scene's own, with the same map.
macro_rules! light {
    ($light:literal) => {
        concat!(
            "light.0={ ",
            $light,
            ", shadow = { technique = \"shadow-map\", size = 1024, offset = { factor = 1.1, units = 4.0 }, ",
            "cull = \"back\", redraw = \"always\" } }"
        )
    };
}

/// Beside the model, and above it, where it meets one face of its cube.
pub const POINT_ASIDE: &str = light!("kind = \"point\", position = [2.0, 4.0, 3.0], near = 0.5, far = 20.0");
pub const POINT_ABOVE: &str = light!("kind = \"point\", position = [0.0, 5.0, 0.0], near = 0.5, far = 20.0");
/// A spotlight that sees the same as that face.
pub const SPOT_ABOVE: &str = light!(
    "kind = \"spot\", position = [0.0, 5.0, 0.0], target = [0.0, 0.0, 0.0], up = [0.0, 0.0, -1.0], cone = 90.0, near = 0.5, far = 20.0"
);
pub const PARALLEL: &str = light!("kind = \"directional\", direction = [-2.0, -3.5, -3.0]");

const WAYS: &[Way] = &[
    way("shadow-map", Kind::Map, &[]),
    Way {
        expected: [None, Some(0.35)],
        ..way("shadow-map, casters at its resolution", Kind::Map, &["light.shadow.casters=texel"])
    },
    way("shadow-map, fitted to what is seen", Kind::Map, &["light.shadow.fit=view"]),
    way("the same, half the texels a side", Kind::Map, FITTED),
    way("shadow-map, 3x3 comparisons", Kind::Kernel, &["light.shadow.kernel=3x3"]),
    way("shadow-map, two levels, 8 taps", Kind::EightTaps, &["light.shadow.mipmaps=8-tap"]),
    way("shadow-map, bias receiver-plane", Kind::ReceiverPlane, &["light.shadow.bias=receiver-plane"]),
    way("shadow-map, bias normal-offset", Kind::NormalOffset, &["light.shadow.bias=normal-offset"]),
    way("shadow-map, bias adaptive", Kind::Adaptive, &["light.shadow.bias=adaptive"]),
    way("shadow-map, tagged in the stencil buffer", Kind::Map, &["light.shadow.into=stencil"]),
    way("midpoint", Kind::Midpoint, &["light.shadow.technique=midpoint"]),
    way("midpoint, all faces drawn", Kind::Midpoint, &["light.shadow.technique=midpoint", "light.shadow.cull=none"]),
    way("second-depth", Kind::SecondDepth, &["light.shadow.technique=second-depth", "light.shadow.closed=assume"]),
    by_light("cube, light aside: three faces needed", Kind::Cube, &[POINT_ASIDE]),
    by_light("cube, light above: one face needed", Kind::Face, &[POINT_ABOVE]),
    Way { scene: Some(Scene::S1), expected: [Some(0.6), None], ..way("through a lens, 64 points", Kind::Lens, LENS) },
    Way {
        scene: Some(Scene::S1),
        expected: [Some(0.6), None],
        ..way("the same, casters at the map's resolution", Kind::Lens, LENS_AT_RESOLUTION)
    },
    Way { scene: Some(Scene::S1), expected: [Some(1.0), None], ..way("dusty air, 64 slices", Kind::Dust, DUST) },
    by_light("directional", Kind::Parallel, &[PARALLEL]),
    Way {
        expected: [Some(0.8); 2],
        ..way("shadow-map, its shade in alpha", Kind::AlphaShadow, &["shading.passes=shadow"])
    },
    Way {
        expected: [Some(0.8), None],
        ..by_light("slide projector", Kind::Slide, &[SLIDE_S1, "shading.passes=slide"])
    },
    Way {
        scene: Some(Scene::S2),
        expected: [None, Some(0.8)],
        ..way("slide projector", Kind::Slide, &[SLIDE_S2, "shading.passes=slide"])
    },
    Way { expected: [Some(1.0), None], ..way("shadow-volume, auto", Kind::Map, &[VOLUMES]) },
    Way { redraw: Redraw::Once, ..way("shadow-volume, auto, counted once", Kind::Map, &[VOLUMES]) },
    way("shadow-volume, z-pass", Kind::Map, &[VOLUMES, "light.shadow.method=z-pass"]),
    way("shadow-volume, z-pass-two-sided", Kind::Map, &[VOLUMES, "light.shadow.method=z-pass-two-sided"]),
    way("shadow-volume, z-pass-capped", Kind::Map, &[VOLUMES, "light.shadow.method=z-pass-capped"]),
    way("shadow-volume, z-fail", Kind::Map, &[VOLUMES, "light.shadow.method=z-fail"]),
];

/// As [`super::kinds::LENS_POINTS`] and so on.
const LENS: &[&str] = &["light.focus={ distance = 5.0, radius = 0.25, samples = 64 }"];
/// As [`super::kinds::DUST_SLICES`] and so on.
const DUST: &[&str] = &["light.dust={ density = 0.1, slices = 64, extinct = \"lit\" }"];
const LENS_AT_RESOLUTION: &[&str] = &[LENS[0], "light.shadow.casters=texel"];

const FITTED: &[&str] = &["light.shadow.fit=view", "light.shadow.size=512"];

/// Measures each way on each scene.
pub fn run(arguments: &Arguments) -> Result<()> {
    let rounds = if arguments.quick { 3 } else { arguments.rounds.max(1) };
    for_each_scene(arguments, |bench| {
        let judge = Judge::new(bench)?;
        let ways = right_ones(bench, &judge, arguments.only.as_deref().unwrap_or_default())?;
        let table = |unit: &'static str, is_frame: bool| -> Vec<Row> {
            let row = |way: &&Way| {
                let expected = if is_frame { way.expected[bench.scene as usize] } else { None };
                Row { name: way.name, unit, expected, pairs: Vec::new() }
            };
            ways.iter().map(row).collect()
        };
        let (mut frames, mut shadow) = (table("ms", true), table("ms of shadow passes", false));
        for round in 0..rounds {
            eprintln!("{:?}: round {} of {rounds}", bench.scene, round + 1);
            for (index, (floor, sample)) in measure(bench, &ways)?.iter().enumerate() {
                frames[index].pairs.push((floor.cpu_ms, sample.cpu_ms));
                shadow[index].pairs.push((floor.shadow_cpu_ms, sample.shadow_cpu_ms));
            }
        }
        println!("\n{:?}: {rounds} rounds; processor time; base: the technique's floor, redrawn", bench.scene);
        frames.extend(shadow);
        print(&frames);
        judge.print_texel(bench)
    })
}

/// The ways whose pictures are their floors', or whose shadows are no more wrong than the plain map's: of other texels,
/// of one bit, of volumes. Says how far each is off.
fn right_ones(bench: &Bench, judge: &Judge, only: &str) -> Result<Vec<&'static Way>> {
    let mut right = Vec::new();
    println!("\n{:?}", bench.scene);
    let chosen = |way: &&Way| way.scene.is_none_or(|scene| scene == bench.scene) && way.name.contains(only);
    for way in WAYS.iter().filter(chosen) {
        bench.start_with(Who::Floor, &[], &["--floor", &name(way.floor)])?;
        bench.start_with(Who::Glumbra, way.sets, &[])?;
        let difference = pictures::compare(&bench.picture(Who::Floor), &bench.picture(Who::Glumbra))?;
        let (is_right, why) = match difference.check() {
            Ok(()) => (true, String::new()),
            // Another light has another truth.
            Err(_) if way.scene.is_some() => (false, String::from(": NOT THE SAME, not timed")),
            Err(_) => {
                let (is_right, words) = judge.is_as_right(way.sets)?;
                (is_right, format!(": another picture, {words}{}", if is_right { "" } else { ": not timed" }))
            }
        };
        println!("{}: {difference}{why}", way.name);
        right.extend(is_right.then_some(way));
    }
    Ok(right)
}

/// Each way beside its floor, which is drawn once a round and kind.
fn measure(bench: &Bench, ways: &[&'static Way]) -> Result<Vec<(Sample, Sample)>> {
    let mut floors: HashMap<String, Sample> = HashMap::new();
    let mut samples = Vec::new();
    for way in ways {
        let kind = name(way.floor);
        if !floors.contains_key(&kind) {
            floors.insert(kind.clone(), bench.frames_with(Who::Floor, Redraw::Always, &[], &["--floor", &kind])?);
        }
        samples.push((floors[&kind].clone(), bench.frames_of(Who::Glumbra, way.redraw, way.sets)?));
    }
    Ok(samples)
}

fn name(kind: Kind) -> String {
    kind.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}
