//! Part of GL-G2: a function's value or its argument, whichever a condition chooses, in both stages. Compilers join the
//! choice and the function's own selections [GLSL 4.60, 5.9, 8.1 to 8.3].

use crate::conformance::bench::{Error, GlFormat, GlPoints};
use crate::conformance::random::Random;
use crate::conformance::verify::{Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// A function of a number in [-0.95, 0.95] that is at least 0.05 from 0.
type OfNumber = fn(f64) -> f64;

/// Expressions of a number x with their values. Each has a program of its own: beside others a driver joins less.
const FUNCTIONS: [(&str, OfNumber); 16] = [
    ("atan(x)", f64::atan),
    ("asin(x)", f64::asin),
    ("acos(x)", f64::acos),
    ("tan(x)", f64::tan),
    ("sin(x)", f64::sin),
    ("cos(x)", f64::cos),
    ("exp(x)", f64::exp),
    ("exp2(x)", f64::exp2),
    ("abs(x)", f64::abs),
    ("sign(x)", f64::signum),
    ("floor(x)", f64::floor),
    ("fract(x)", |x| x - x.floor()),
    ("sqrt(abs(x))", |x| x.abs().sqrt()),
    ("inversesqrt(abs(x))", |x| 1.0 / x.abs().sqrt()),
    ("log2(abs(x))", |x| x.abs().log2()),
    ("atan(x, 0.5)", |x| x.atan2(0.5)),
];

/// Stage that computes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    Vertex,
    Fragment,
}

/// Points that are drawn, in a row.
const POINTS: usize = 256;

/// Errors, strictly and at most, as shares of the value: GLSL states none for angles [GLSL 4.60, 4.7.1], so what half
/// floats keep, and eight times as much.
const ERRORS: [f64; 2] = [1.0 / 2048.0, 1.0 / 256.0];

/// Each function where a number is below 0, its argument elsewhere.
pub fn chosen(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut random = Random::new(349);
    let inputs: Vec<[f32; 4]> = (0..POINTS)
        .map(|_| {
            let x = random.between(0.05, 0.95) * if random.chance(0.5) { 1.0 } else { -1.0 };
            [x, random.between(-1.0, 1.0), 0.0, 0.0]
        })
        .collect();
    let places: Vec<[f32; 4]> =
        (0..POINTS).map(|index| [(2.0 * index as f32 + 1.0) / POINTS as f32 - 1.0, 0.0, 0.0, 1.0]).collect();
    let surface = subject.bench.surface([POINTS as u32, 1], Some(GlFormat::Rgba32F), None)?;
    for (stage, name) in [(Stage::Vertex, "a vertex shader"), (Stage::Fragment, "a fragment shader")] {
        for (text, function) in FUNCTIONS {
            let [vertex, fragment] = sources(stage, text);
            let program = subject.bench.points_program(&vertex, &fragment, &["position", "value"])?;
            let attributes: [&[[f32; 4]]; 2] = [&places, &inputs];
            let points = GlPoints { surface: &surface, attributes: &attributes, uniforms: &[], images: &[] };
            subject.bench.draw_points(&program, &points)?;
            let mut tally = GradeTally::default();
            for ([x, at, ..], seen) in inputs.iter().zip(surface.floats()) {
                let x = f64::from(*x);
                let due = if *at < 0.0 { function(x) } else { x };
                let off = (f64::from(seen[0]) - due).abs() / due.abs().max(0.25);
                let grade = match () {
                    () if off <= ERRORS[0] => Grade::Good,
                    () if off <= ERRORS[1] => Grade::Allowed,
                    () => Grade::Wrong,
                };
                tally.add(grade, off * f64::from(24).exp2());
            }
            findings.tally(format!("{text} or x, in {name}"), tally, "x 2^-24");
        }
    }
    Ok(())
}

/// Both stages' text.
fn sources(stage: Stage, function: &str) -> [String; 2] {
    let chosen = |from: &str| format!("float x = {from}.x; x = 0.0 > {from}.y ? {function} : x;");
    let [vertex, fragment] = match stage {
        Stage::Vertex => [chosen("value") + " passed = vec4(x);", String::from("result = passed;")],
        Stage::Fragment => [String::from("passed = value;"), chosen("passed") + " result = vec4(x);"],
    };
    let head = "#version 150\nin vec4 position;\nin vec4 value;\nflat out vec4 passed;\n";
    [
        format!("{head}void main()\n{{\n    gl_Position = position;\n    {vertex}\n}}\n"),
        format!("#version 150\nflat in vec4 passed;\nout vec4 result;\nvoid main()\n{{\n    {fragment}\n}}\n"),
    ]
}
