//! GL-X2: random look-ups in random textures, in sequences in which little is set anew, against a model in f64 [GL 4.6, 8;
//! GLSL 4.60, 8.9].

mod coordinates;
mod draws;
mod edits;
mod formats;
mod layouts;
mod lookups;
mod model;
mod parameters;
mod programs;
mod query;
mod uploads;
mod world;

use std::collections::BTreeMap;

use self::draws::{COLUMNS, Chunk, Drawn};
use self::lookups::{Class, DueTexel, Inputs};
use self::programs::{LookUpProgram, ROWS};
use self::world::{CopySource, SAMPLERS, TEXTURES, World};
use crate::conformance::bench::{
    Error, GlFormat, GlImage, GlPlace, GlState, GlSwizzle, GlTextureBench, Surface, build,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SEED: u64 = 20_318;
/// Unit of the texture of inputs, beyond those that steps use.
const INPUTS: u32 = 30;

/// Results of one kind of look-up.
#[derive(Default)]
struct Results {
    tally: GradeTally,
    open: usize,
    /// The first draw that is wrong, in words.
    wrong: Option<String>,
}

/// GL-X2.
pub fn lookups(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let bench = &subject.bench;
    let mut random = Random::new(SEED + 2);
    let texts = LookUpProgram::all(bench.has((4, 0), "GL_ARB_texture_gather"), &mut random);
    let programs = texts
        .iter()
        .map(|program| {
            let [vertex, fragment] = program.sources();
            build(bench.raw(), &vertex, &fragment)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let surface = bench.surface([COLUMNS as u32, ROWS as u32], Some(GlFormat::Rgba32F), None)?;
    let (source, colors) = source(subject)?;
    let mut world = World::new(SEED, bench.is_compatible(), &colors);
    let mut uniforms = vec![[0; 4]; texts.len()];
    let surfaces = [source];
    let mut textures = GlTextureBench::new(bench, [TEXTURES, SAMPLERS], &programs, &surfaces)?;
    let mut results: BTreeMap<String, Results> = BTreeMap::new();
    // In the second round most textures are made anew, and every second program draws again.
    for (fresh, step) in [(0.35, 1), (0.8, 2)] {
        let chunk = world.chunk(&texts, &mut uniforms, fresh, step);
        let inputs = bench.float_image([COLUMNS as u32, 2 * ROWS as u32], &chunk.inputs)?;
        textures.give_all(INPUTS, &inputs, "inputs")?;
        let steps = std::mem::take(&mut world.steps);
        textures.take(&steps, &surface, GlState { depth: None, ..GlState::WRITE })?;
        judge(&chunk, &surface.floats(), &mut results);
    }
    for (name, Results { tally, open, wrong }) in results {
        let count = tally.count() + open;
        // Either tier will do here: rules of chosen cases tell one from the other.
        findings.none_wrong(&name, tally.wrong, tally.count());
        if let Some(wrong) = wrong {
            findings.must_hold(format!("{name}: the first that is wrong"), false, wrong);
        }
        findings.must_hold(format!("{name}: not left open"), open * 5 <= count, format!("{open} of {count} open"));
        findings.fact(format!("{name}: only just allowed"), format!("{} of {count}", tally.allowed));
    }
    Ok(())
}

/// A surface of 8-bit colours, and these.
fn source(subject: &DriverUnderTest) -> Result<(Surface, CopySource), Error> {
    const SIZE: [usize; 2] = [48, 40];
    let mut random = Random::new(SEED + 1);
    let colors: Vec<_> = (0..SIZE[0] * SIZE[1]).map(|_| [(); 4].map(|()| (random.unit() * 256.0) as u8)).collect();
    let image: std::rc::Rc<GlImage> = subject.bench.byte_image(SIZE.map(|side| side as u32), &colors)?.into();
    let surface = subject.bench.surface_at(Some(GlPlace::whole(&image)), None)?;
    Ok((surface, CopySource { size: SIZE, colors }))
}

fn judge(chunk: &Chunk, seen: &[[f32; 4]], results: &mut BTreeMap<String, Results>) {
    for (number, drawn) in chunk.drawn.iter().enumerate() {
        let name = format!("{:?}, {:?}", drawn.kind.shape, drawn.kind.class);
        let results = results.entry(name).or_default();
        for ([x, y], inputs) in &drawn.lookups {
            let value = seen[y * COLUMNS + x].map(f64::from);
            match grade(drawn, inputs, value) {
                None => results.open += 1,
                Some((grade, off)) => {
                    results.tally.add(grade, off);
                    if grade == Grade::Wrong && results.wrong.is_none() {
                        results.wrong = Some(words(number, drawn, inputs, value));
                    }
                }
            }
        }
    }
}

/// Grade of a value, and its distance from what is strictly due; `None` if too much may come out.
fn grade(drawn: &Drawn, inputs: &Inputs, value: [f64; 4]) -> Option<(Grade, f64)> {
    let format = drawn.texture.format;
    let mut swizzle = drawn.sampling.swizzle;
    if drawn.compatible && format.is_depth() && drawn.kind.class == Class::Float {
        // DEPTH_TEXTURE_MODE is LUMINANCE as long as nothing else is said [GL 4.6, 8.24].
        swizzle = swizzle.map(|from| match from {
            GlSwizzle::Green | GlSwizzle::Blue => GlSwizzle::Red,
            from => from,
        });
    }
    let exact = |off: f64, error: f64| (if off <= error { Grade::Good } else { Grade::Wrong }, off);
    match drawn.kind.due(&drawn.texture, &drawn.sampling, drawn.seamless, inputs) {
        DueTexel::Open => None,
        DueTexel::Exactly(due) => {
            let off = (0..4).map(|part| (value[part] - due[part]).abs()).fold(0.0, f64::max);
            Some(exact(off, 0.0))
        }
        DueTexel::Texel(span) => {
            let [strict, most] = [0, 1].map(|tier| span.distance(value, format, tier, swizzle));
            let grade = if strict <= 0.0 {
                Grade::Good
            } else if most <= 0.0 {
                Grade::Allowed
            } else {
                Grade::Wrong
            };
            Some((grade, strict.max(0.0)))
        }
        DueTexel::Four(query) => {
            let four = query.gathered()?;
            let shadow = drawn.kind.class == Class::Shadow;
            let mut worst = 0.0_f64;
            for (part, texel) in four.into_iter().enumerate() {
                let due = match swizzle[0] {
                    GlSwizzle::Zero => 0.0,
                    GlSwizzle::One => 1.0,
                    from => texel[from as usize],
                };
                let most = texel.into_iter().map(f64::abs).fold(0.0, f64::max);
                let slack = drawn.texture.levels.iter().map(|level| level.slack).fold(0.0, f64::max);
                let error = if shadow { 0.0 } else { format.error(most, false)[1] + slack };
                worst = worst.max((value[part] - due).abs() - error);
            }
            Some(exact(worst.max(0.0), 0.0))
        }
        DueTexel::Filtered(query) => {
            let nearest = |tier: usize| {
                let spans = query.spans(tier)?;
                Some(spans.iter().map(|span| span.distance(value, format, tier, swizzle)).fold(f64::INFINITY, f64::min))
            };
            let strict = nearest(0)?;
            if strict <= 0.0 {
                return Some((Grade::Good, 0.0));
            }
            let most = nearest(1)?;
            Some((if most <= 0.0 { Grade::Allowed } else { Grade::Wrong }, strict))
        }
    }
}

/// A draw in words.
fn words(number: usize, drawn: &Drawn, inputs: &Inputs, value: [f64; 4]) -> String {
    let Drawn { kind, texture, sampling, seamless, by_object, unit, .. } = drawn;
    let due = match kind.due(texture, sampling, *seamless, inputs) {
        DueTexel::Open => "anything".to_owned(),
        DueTexel::Exactly(due) => format!("{due:?}"),
        DueTexel::Texel(span) => format!("{:?}", span.low),
        DueTexel::Four(query) => format!("{:?}", query.gathered()),
        DueTexel::Filtered(query) => {
            let spans = query.spans(0).unwrap_or_default();
            let some: Vec<_> = spans.iter().take(2).map(|span| [span.low, span.high]).collect();
            format!("{some:.5?}")
        }
    };
    let size = texture.levels[0].size;
    format!(
        "draw {number}, {:?} of a {:?} {:?} of {} levels, {} (texture {}), on unit {unit}{}: {sampling:?}, seamless \
         {seamless}, at {:?}, {:?}: {value:.5?}; {due} is due",
        kind.function,
        kind.source,
        size,
        texture.levels.len(),
        texture.format.name,
        texture.name,
        if *by_object { " by a sampler object" } else { "" },
        inputs.at,
        inputs.by,
    )
}
