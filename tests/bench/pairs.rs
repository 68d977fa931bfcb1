//! glumbra against itself: what one way costs in multiples of another, and what each thing that is left out saves:
//! `ci/bench --pairs`. Both of a pair are drawn in turn, round by round; the ratio is of processor time.

use clap::ValueEnum;

use super::child::{Keep, Sample};
use super::rounds::{Bench, for_each_scene};
use super::table::{Row, print};
use super::techniques::{POINT_ABOVE, POINT_ASIDE, SPOT_ABOVE};
use super::{Arguments, Redraw, Result, Scene, Who};

/// A way to draw the scene.
#[derive(Clone, Copy)]
struct Way {
    sets: &'static [&'static str],
    keep: Keep,
}

const fn by(sets: &'static [&'static str]) -> Way {
    Way { sets, keep: Keep::Nothing }
}

const fn keeping(keep: Keep, sets: &'static [&'static str]) -> Way {
    Way { sets, keep }
}

/// Quantity by which two ways are compared.
#[derive(Clone, Copy)]
enum Of {
    Frame,
    Shadow,
}

struct Pair {
    name: &'static str,
    /// `None`: on both.
    scene: Option<Scene>,
    of: Of,
    base: Way,
    measured: Way,
    expected: Option<f64>,
}

const MIDPOINT: &str = "light.shadow.technique=midpoint";
const ALL_FACES: &str = "light.shadow.cull=none";
/// The camera sees a few of the hundred models, and what they shadow.
const CLOSE: &str = "camera.fov_y=12.0";

const MULTIPLES: &[Pair] = &[
    pair("midpoint : plain map, shadow passes", Of::Shadow, by(&[]), by(&[MIDPOINT]), Some(2.2)),
    pair("the same, all faces drawn", Of::Shadow, by(&[ALL_FACES]), by(&[ALL_FACES, MIDPOINT]), Some(2.2)),
    pair("midpoint : plain map, frame", Of::Frame, by(&[]), by(&[MIDPOINT]), Some(2.2)),
    pair(
        "midpoint, comparing in the texture unit : plain map",
        Of::Shadow,
        by(&[]),
        by(&[MIDPOINT, "light.shadow.peel=compare"]),
        None,
    ),
    on_s1(
        "cube with one needed face : spot map, shadow passes",
        Of::Shadow,
        by(&[SPOT_ABOVE]),
        by(&[POINT_ABOVE]),
        1.1,
    ),
    on_s1("cube with one needed face : spot map, frame", Of::Frame, by(&[SPOT_ABOVE]), by(&[POINT_ABOVE]), 1.1),
];

/// Frames with parts left out, against frames with nothing left out.
const LEFT_OUT: &[Pair] = &[
    of_cube("faces of the cube that hold nothing, and colour buffers", POINT_ABOVE_KEPT, by(&[POINT_ABOVE])),
    of_cube("the same, light aside", POINT_ASIDE_KEPT, by(&[POINT_ASIDE])),
    Pair {
        scene: Some(Scene::S2),
        ..pair("casters whose shadow is unseen", Of::Shadow, keeping(Keep::Casters, &[CLOSE]), by(&[CLOSE]), None)
    },
    pair("the map's colour buffer", Of::Shadow, keeping(Keep::Color, &[]), by(&[]), None),
    pair("normals in the map's pass", Of::Shadow, keeping(Keep::Normals, &[]), by(&[]), None),
    pair("what no seen point looks up (fit), half the texels a side", Of::Frame, by(&[]), FITTED, None),
    pair("a guard where nothing lies behind the light", Of::Frame, by(&["light.shadow.guard=fragment"]), by(&[]), None),
    pair("texels without a second layer", Of::Shadow, keeping(Keep::Scissor, &[MIDPOINT]), by(&[MIDPOINT]), None),
    pair(
        "triangles below a texel (casters = \"texel\")",
        Of::Frame,
        by(&[]),
        by(&["light.shadow.casters=texel"]),
        None,
    ),
    pair("back faces in the map (cull = \"back\")", Of::Shadow, by(&[ALL_FACES]), by(&[]), None),
    Pair {
        scene: Some(Scene::S1),
        ..pair("back faces that the camera cannot see", Of::Frame, by(&["object.1.closed=false"]), by(&[]), None)
    },
    pair(
        "the map of the frame before (redraw = \"once\")",
        Of::Frame,
        by(&[]),
        by(&["light.shadow.redraw=once"]),
        None,
    ),
    pair("all of these that a plan finds", Of::Frame, keeping(Keep::All, &[]), by(&["light.shadow.redraw=once"]), None),
];

const POINT_ABOVE_KEPT: Way = keeping(Keep::All, &[POINT_ABOVE]);
const POINT_ASIDE_KEPT: Way = keeping(Keep::All, &[POINT_ASIDE]);
const FITTED: Way = by(&["light.shadow.fit=view", "light.shadow.size=512"]);

const fn pair(name: &'static str, of: Of, base: Way, measured: Way, expected: Option<f64>) -> Pair {
    Pair { name, scene: None, of, base, measured, expected }
}

const fn on_s1(name: &'static str, of: Of, base: Way, measured: Way, expected: f64) -> Pair {
    Pair { scene: Some(Scene::S1), ..pair(name, of, base, measured, Some(expected)) }
}

const fn of_cube(name: &'static str, base: Way, measured: Way) -> Pair {
    Pair { scene: Some(Scene::S1), ..pair(name, Of::Frame, base, measured, None) }
}

/// Measures each pair on each scene.
pub fn run(arguments: &Arguments) -> Result<()> {
    let rounds = if arguments.quick { 3 } else { arguments.rounds.max(1) };
    for_each_scene(arguments, |bench| {
        for (title, pairs) in [("one way : another", MULTIPLES), ("what is left out : what is not", LEFT_OUT)] {
            let here = |pair: &&Pair| pair.scene.is_none_or(|scene| scene == bench.scene);
            let pairs: Vec<&Pair> = pairs.iter().filter(here).collect();
            let mut rows: Vec<Row> = pairs
                .iter()
                .map(|pair| Row { name: pair.name, unit: "ms", expected: pair.expected, pairs: Vec::new() })
                .collect();
            for round in 0..rounds {
                eprintln!("{:?}: round {} of {rounds}", bench.scene, round + 1);
                for (row, pair) in rows.iter_mut().zip(&pairs) {
                    row.pairs.push(measure(bench, pair, round % 2 == 1)?);
                }
            }
            println!("\n{:?}: {rounds} rounds; {title}, processor time", bench.scene);
            print(&rows);
        }
        Ok(())
    })
}

fn measure(bench: &Bench, pair: &Pair, reversed: bool) -> Result<(f64, f64)> {
    let sample = |way: Way| {
        let keep = way.keep.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
        bench.frames_with(Who::Glumbra, Redraw::Always, way.sets, &["--keep", &keep])
    };
    let of = |sample: Sample| match pair.of {
        Of::Frame => sample.cpu_ms,
        Of::Shadow => sample.shadow_cpu_ms,
    };
    if reversed {
        let measured = of(sample(pair.measured)?);
        return Ok((of(sample(pair.base)?), measured));
    }
    Ok((of(sample(pair.base)?), of(sample(pair.measured)?)))
}
