//! GL-M4: random shader programs, held against an interpreter with bounds of error [GLSL 4.60, 4.7.1, 5, 6, 8].

mod assemble;
mod code;
mod functions;
mod inputs;
mod make;
mod number;
mod run;
mod scalars;
mod statements;
mod value;
mod vectors;

use self::assemble::{Assembled, Due, RESULTS, Stage, assemble};
use self::inputs::{PIXELS, Uniforms, VECTORS};
use self::number::{Num, SLACK};
use crate::conformance::bench::{Error, GlFormat, GlPoints, Sampling, Surface};
use crate::conformance::random::Random;
use crate::conformance::{DriverUnderTest, Findings, RuleVerdict};

/// Programs of each stage.
const PROGRAMS: usize = 12;

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
            () if off <= due.error => self.good += 1,
            () if off <= SLACK * due.error => self.allowed += 1,
            () => {
                self.wrong += 1;
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

/// GL-M4: programs of each stage, each with two sets of inputs and uniforms.
pub fn programs(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.several([PIXELS as u32, 1], &[GlFormat::Rgba32F; 8])?;
    surface.draw_to(&[0, 1, 2, 3, 4, 5, 6, 7].map(Some));
    let versions: &[u32] = if subject.bench.has((3, 3), "GL 3.3") { &[150, 330] } else { &[150] };
    for stage in Stage::ALL {
        findings.part(|findings| {
            let mut tally = Tally::default();
            for number in 0..PROGRAMS {
                one(subject, &surface, stage, versions[number % versions.len()], number, &mut tally)?;
            }
            tally.report(findings, stage.name());
            Ok(())
        });
    }
    Ok(())
}

fn one(
    subject: &DriverUnderTest,
    surface: &Surface,
    stage: Stage,
    version: u32,
    number: usize,
    tally: &mut Tally,
) -> Result<(), Error> {
    // Programs of the two kinds of fragment shaders are not the same.
    let seed = 7000 + 100 * stage as u64 + number as u64;
    let mut random = Random::new(seed);
    let draws = [(); 2].map(|()| (inputs::vectors(&mut random), Uniforms::new(&mut random)));
    // A third of the pixels tells which statements say enough.
    let some = inputs::values(&draws[0].0, &draws[0].1).into_iter().step_by(3).collect();
    let timer = std::time::Instant::now();
    let made = assemble(random, version, stage, some);
    let t0 = timer.elapsed();
    let [vertex, fragment] = made.sources();
    if std::env::var("EXPR_SHOW").is_ok_and(|show| show == seed.to_string()) {
        eprintln!("{vertex}\n{fragment}");
    }
    let names: Vec<String> = (0..VECTORS).map(|index| format!("x{index}")).collect();
    let mut attributes = vec!["position"];
    attributes.extend(names.iter().map(String::as_str));
    let program = subject.bench.points_program(&vertex, &fragment, &attributes)?;
    let (mut t1, mut t2) = (timer.elapsed() - t0, std::time::Duration::ZERO);
    for (which, (vectors, uniforms)) in draws.iter().enumerate() {
        let timer = std::time::Instant::now();
        let due = made.due(inputs::values(vectors, uniforms));
        t2 += timer.elapsed();
        let timer = std::time::Instant::now();
        let place = |index: usize| [(2.0 * index as f32 + 1.0) / PIXELS as f32 - 1.0, 0.0, 0.0, 1.0];
        let places: Vec<[f32; 4]> = (0..PIXELS).map(place).collect();
        let mut arrays = vec![places.as_slice()];
        arrays.extend(vectors.iter().map(Vec::as_slice));
        let image = match stage {
            Stage::Fetching => {
                Some(subject.bench.float_image([PIXELS as u32, VECTORS as u32], &vectors.concat())?)
            }
            _ => None,
        };
        let images: Vec<_> = image.iter().map(|image| ("inputs", image, Sampling::NEAREST)).collect();
        surface.clear_color([CLEAR; 4]);
        let points = GlPoints { surface, attributes: &arrays, uniforms: &uniforms.list(), images: &images };
        subject.bench.draw_points(&program, &points)?;
        judge(surface, &made, &due, tally, &|| format!("program {seed}, draw {which}"));
        t1 += timer.elapsed();
    }
    if std::env::var("EXPR_TIME").is_ok() {
        eprintln!("{seed} make {t0:?} gl {t1:?} due {t2:?}");
    }
    Ok(())
}

fn judge(surface: &Surface, made: &Assembled, due: &[Due], tally: &mut Tally, said: &dyn Fn() -> String) {
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
