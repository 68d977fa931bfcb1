//! GL-X4: random shader programs, held against an interpreter with bounds of error [GLSL 4.60, 4.7.1, 5, 6, 8].

mod assemble;
mod calls;
mod code;
mod functions;
mod inputs;
mod leaves;
mod make;
mod run;
mod statements;

use self::assemble::{Assembled, DueNumber, RESULTS, Stage, Uses, assemble};
use self::inputs::{GivenUniforms, PIXELS, VECTORS};
use crate::conformance::bench::{Error, GlFormat, GlPoints, Sampling, Surface};
use crate::conformance::model::number::{Num, SLACK};
use crate::conformance::random::Random;
use crate::conformance::{DriverUnderTest, Findings, RuleVerdict};

/// Stages, and how many programs each has: a driver compiles a vertex shader faster.
const PROGRAMS: [(Stage, usize); 3] = [(Stage::Vertex, 11), (Stage::Fragment, 5), (Stage::Fetching, 4)];

/// Colour of pixels that nothing is drawn to.
const CLEAR: f32 = 77.0;

/// Results of one stage's programs.
#[derive(Default)]
struct Tally {
    good: usize,
    allowed: usize,
    wrong: usize,
    unsure: usize,
    first: Option<String>,
}

impl Tally {
    fn add(&mut self, due: Num, seen: f32, said: impl FnOnce() -> String) {
        let off = (f64::from(seen) - due.value).abs();
        match () {
            () if !due.is_known() => self.unsure += 1,
            // Sums may be taken in another order.
            () if off <= 2.0 * due.error => self.good += 1,
            () => {
                let is_wrong = off.is_nan() || off > SLACK * due.error;
                if is_wrong && self.wrong == 0 {
                    self.first = None;
                }
                (self.wrong, self.allowed) =
                    if is_wrong { (self.wrong + 1, self.allowed) } else { (self.wrong, self.allowed + 1) };
                let error = due.error;
                self.first.get_or_insert_with(|| {
                    format!("first: {}: {seen:?} is not {:?} within {error:.1e}", said(), due.value)
                });
            }
        }
    }

    fn report(self, findings: &mut Findings, what: &str) {
        let Self { good, allowed, wrong, unsure, first } = self;
        let count = good + allowed + wrong;
        let verdict = match () {
            () if wrong > 0 || 4 * unsure > count => RuleVerdict::Fail,
            () if allowed > 0 => RuleVerdict::Warning,
            () => RuleVerdict::Pass,
        };
        let first = first.map_or(String::new(), |first| format!("; {first}"));
        let measured = format!("{wrong} of {count} wrong, {allowed} only just allowed, {unsure} left open{first}");
        findings.add(what, verdict, measured);
    }
}

/// GL-X4: programs of each stage, each with several sets of inputs and uniforms.
pub fn programs(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.several([PIXELS as u32, 1], &[GlFormat::Rgba32F; 8])?;
    surface.draw_to(&[0, 1, 2, 3, 4, 5, 6, 7].map(Some));
    let versions: &[u32] = if subject.bench.has((3, 3), "GL 3.3") { &[150, 330] } else { &[150] };
    let mut uses = Uses::default();
    for (stage, count) in PROGRAMS {
        findings.part(|findings| {
            let mut tally = Tally::default();
            for number in 0..count {
                let random = Random::new(7000 + 100 * stage as u64 + number as u64);
                let version = versions[number % versions.len()];
                let number = format!("program {number} in GLSL {version}");
                one(subject, &surface, Kind { stage, version, number }, random, &mut uses, &mut tally)?;
            }
            tally.report(findings, stage.name());
            Ok(())
        });
    }
    Ok(())
}

/// Settings of a program.
struct Kind {
    stage: Stage,
    version: u32,
    number: String,
}

/// Inputs of draws: the float vectors change places, so that each meets numbers of another range.
const TURNS: [usize; 4] = [0, 0, 1, 3];

fn one(
    subject: &DriverUnderTest,
    surface: &Surface,
    kind: Kind,
    mut random: Random,
    uses: &mut Uses,
    tally: &mut Tally,
) -> Result<(), Error> {
    let Kind { stage, version, number } = kind;
    let draws = TURNS.map(|turn| (turn, inputs::vectors(&mut random, turn), GivenUniforms::new(&mut random)));
    // A third of the pixels tells which statements say enough.
    let some = inputs::values(&draws[0].1, &draws[0].2).into_iter().step_by(3).collect();
    let made = assemble(random, version, stage, some, uses);
    let [vertex, fragment] = made.sources();
    let names: Vec<String> = (0..VECTORS).map(|index| format!("x{index}")).collect();
    let attributes: Vec<&str> = std::iter::once("position").chain(names.iter().map(String::as_str)).collect();
    let program = subject.bench.points_program(&vertex, &fragment, &attributes)?;
    let place = |index: usize| [(2.0 * index as f32 + 1.0) / PIXELS as f32 - 1.0, 0.0, 0.0, 1.0];
    let places: Vec<[f32; 4]> = (0..PIXELS).map(place).collect();
    for (which, (turn, vectors, uniforms)) in draws.iter().enumerate() {
        let due = made.due(inputs::values(vectors, uniforms));
        let arrays: Vec<&[[f32; 4]]> = std::iter::once(&places).chain(vectors).map(Vec::as_slice).collect();
        let image = match stage {
            Stage::Fetching => Some(subject.bench.float_image([PIXELS as u32, VECTORS as u32], &vectors.concat())?),
            _ => None,
        };
        let images: Vec<_> = image.iter().map(|image| ("inputs", image, Sampling::NEAREST)).collect();
        surface.clear_color([CLEAR; 4]);
        let points = GlPoints { surface, attributes: &arrays, uniforms: &uniforms.list(), images: &images };
        subject.bench.draw_points(&program, &points)?;
        let before = tally.unsure;
        judge(surface, &made, &due, tally, &|| format!("{number}, draw {which}"));
        if *turn > 0 {
            // Made for other numbers: not all of it is defined.
            tally.unsure = before;
        }
    }
    Ok(())
}

fn judge(surface: &Surface, made: &Assembled, due: &[DueNumber], tally: &mut Tally, said: &dyn Fn() -> String) {
    for target in 0..RESULTS / 4 {
        surface.read_from(target as u32);
        for (pixel, (seen, due)) in surface.floats().iter().zip(due).enumerate() {
            for (part, seen) in seen.iter().enumerate() {
                let result = 4 * target + part;
                let known = if due.is_discarded { Num::exact(f64::from(CLEAR)) } else { due.results[result] };
                let text = || format!("{}, {}, pixel {pixel}", said(), made.source_of(result));
                tally.add(known, *seen, text);
            }
        }
    }
}
