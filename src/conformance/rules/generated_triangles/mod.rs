//! GL-X3: random triangles under random state of rasterization against a model in f64 [GL 4.6, 13.4 to 13.8, 14.6].
//!
//! Draws follow one another in one target, and one piece of state changes between two of them. After each draw every pixel
//! is compared: gl_FragCoord, gl_FrontFacing, gl_PrimitiveID, varyings of all kinds or their derivatives, and depth. A pixel
//! that the specification leaves open is not judged until it is drawn anew.

mod judge;
mod lines;
mod meshes;
mod model;
mod picture;
mod pipeline;
mod points;
mod programs;
mod shapes;

use self::judge::Judge;
use self::picture::{CLEARED, Picture, Shown, clear_depth};
use self::pipeline::Pipeline;
use self::programs::{Text, Traits};
use crate::conformance::bench::{Error, GlFormat, GlIndices, GlStream, GlWhole, Surface};
use crate::conformance::random::Random;
use crate::conformance::{DriverUnderTest, Findings};

/// Draws in a sequence.
const DRAWS: usize = 90;

/// A sequence of draws into one target.
struct Sequence {
    size: [u32; 2],
    depth: GlFormat,
    /// Traits of its two programs.
    traits: [Traits; 2],
    /// Numbers of their varyings, at most.
    numbers: [usize; 2],
}

const PLAIN: Traits =
    Traits { distances: false, depth: false, discards: false, upper_left: false, whole_centers: false };

const SEQUENCES: [Sequence; 6] = [
    Sequence {
        size: [37, 29],
        depth: GlFormat::Depth24,
        traits: [PLAIN, Traits { distances: true, ..PLAIN }],
        numbers: [12, 20],
    },
    Sequence {
        size: [48, 20],
        depth: GlFormat::Depth32F,
        traits: [PLAIN, Traits { discards: true, whole_centers: true, ..PLAIN }],
        numbers: [26, 9],
    },
    Sequence {
        size: [21, 45],
        depth: GlFormat::Depth16,
        traits: [Traits { distances: true, discards: true, ..PLAIN }, Traits { upper_left: true, ..PLAIN }],
        numbers: [18, 12],
    },
    Sequence {
        size: [64, 16],
        depth: GlFormat::Depth24Stencil8,
        traits: [Traits { depth: true, ..PLAIN }, PLAIN],
        numbers: [10, 44],
    },
    Sequence {
        size: [33, 33],
        depth: GlFormat::Depth32FStencil8,
        traits: [
            Traits { upper_left: true, whole_centers: true, ..PLAIN },
            Traits { distances: true, depth: true, ..PLAIN },
        ],
        numbers: [16, 16],
    },
    Sequence {
        size: [40, 30],
        depth: GlFormat::Depth24,
        traits: [Traits { distances: true, ..PLAIN }, Traits { depth: true, discards: true, ..PLAIN }],
        numbers: [24, 6],
    },
];

/// A program and its text.
struct Program {
    text: Text,
    whole: GlWhole,
}

/// GL-X3.
pub fn triangles(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut judge = Judge::default();
    for (number, sequence) in SEQUENCES.iter().enumerate() {
        findings.part(|_| run(subject, number, sequence, &mut judge));
    }
    judge.report(findings);
    findings.part(|findings| {
        findings.tally("meshes, one fragment a pixel", meshes::meshes(subject)?, "fragments");
        Ok(())
    });
    findings.part(|findings| {
        let [places, numbers] = lines::lines(subject)?;
        findings.tally("pixels of lines", places, "pixels");
        findings.tally("varyings and depth of lines", numbers, "");
        Ok(())
    });
    findings.part(|findings| {
        let [places, numbers] = points::points(subject)?;
        findings.tally("pixels of points", places, "");
        findings.tally("gl_PointCoord, varyings and depth of points", numbers, "");
        Ok(())
    });
    Ok(())
}

fn run(subject: &DriverUnderTest, number: usize, sequence: &Sequence, judge: &mut Judge) -> Result<(), Error> {
    let bench = &subject.bench;
    let mut dice = Random::new(9000 + number as u64);
    let Sequence { size, depth, traits, numbers } = *sequence;
    let surface = bench.several_with(size, &[GlFormat::Rgba32F; 4], Some(depth))?;
    surface.draw_to(&[Some(0), Some(1), Some(2), Some(3)]);
    let Some(encoding) = surface.depth_encoding() else { return Ok(()) };
    let mut programs = Vec::new();
    for (traits, most) in traits.into_iter().zip(numbers) {
        let text = programs::text(&mut dice, most, traits);
        let whole = bench.whole_program(&text.vertex, &text.fragment)?;
        programs.push(Program { text, whole });
    }
    let stream = bench.stream(4)?;
    let mut pipeline = Pipeline::new(size);
    bench.bind_surface(&surface);
    pipeline.whole().into_iter().for_each(|change| bench.change(change));
    let mut picture = Picture::new(size, encoding);
    bench.clear_outputs_as_it_is(4, [CLEARED; 4], 1.0)?;
    picture.clear(&pipeline, 1.0);
    let mut used = 0;
    bench.use_whole(&programs[0].whole);
    for turn in 0..DRAWS {
        if dice.chance(0.3) {
            let depth = clear_depth(&mut dice);
            bench.clear_outputs_as_it_is(4, [CLEARED; 4], depth)?;
            picture.clear(&pipeline, depth);
        }
        if dice.chance(0.2) {
            used = 1 - used;
            bench.use_whole(&programs[used].whole);
        }
        let program = &programs[used];
        change(subject, &mut pipeline, &mut dice, size, program);
        let which = dice.below(program.text.groups() + 1);
        bench.set_whole(&program.whole, "which", which as i32);
        let shapes = shapes::shapes(&mut dice, &pipeline, size);
        draw(subject, &stream, &shapes)?;
        picture.draw(&pipeline, &shapes, &Shown { text: &program.text, which });
        let case = format!(
            "draw {turn} of sequence {number}: {} {} by {:?}{}, {}, {}",
            shapes.corners.len(),
            shapes.kind,
            shapes.primitive,
            if shapes.indices.is_some() { " with indices" } else { "" },
            program.text.summary(),
            pipeline
        );
        let derived = which == program.text.groups();
        judge.picture(&mut picture, &read(&surface), &surface.depths(), derived, &case);
        bench.bind_surface(&surface);
    }
    pipeline = Pipeline::new(size);
    pipeline.whole().into_iter().for_each(|change| bench.change(change));
    bench.change(crate::conformance::bench::GlChange::Provoke(false));
    Ok(())
}

/// Changes one piece of state, or two; a program without clip distances has none enabled, as they would have no value.
fn change(subject: &DriverUnderTest, pipeline: &mut Pipeline, dice: &mut Random, size: [u32; 2], program: &Program) {
    let distances = if program.text.traits.distances { 8 } else { 0 };
    for _ in 0..dice.pick(&[1, 1, 2]) {
        for call in pipeline.change(dice, size, distances) {
            subject.bench.change(call);
        }
    }
    // Mesa's llvmpipe clips by every distance that is written while none is enabled.
    if distances > 0 && pipeline.clips == 0 {
        let call = pipeline.switch_clip(dice.below(8) as u32);
        subject.bench.change(call);
    }
    for index in (0..8).filter(|_| distances == 0) {
        if pipeline.clips >> index & 1 == 1 {
            let call = pipeline.switch_clip(index);
            subject.bench.change(call);
        }
    }
}

fn draw(subject: &DriverUnderTest, stream: &GlStream, shapes: &shapes::Shapes) -> Result<(), Error> {
    let floats: Vec<f32> = shapes.corners.iter().flat_map(|corner| corner.floats()).collect();
    let long = shapes.indices.as_deref();
    let short: Option<Vec<u16>> = long.map(|indices| indices.iter().map(|index| *index as u16).collect());
    let indices = match (long, &short) {
        (Some(_), Some(short)) if shapes.short => Some(GlIndices::Short(short)),
        (Some(long), _) => Some(GlIndices::Long(long)),
        _ => None,
    };
    subject.bench.draw_stream(stream, shapes.primitive, &floats, indices)
}

fn read(surface: &Surface) -> [Vec<[f32; 4]>; 4] {
    [0, 1, 2, 3].map(|output| surface.floats_of(output))
}
