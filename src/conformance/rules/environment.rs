//! GL-E1 to GL-E3: texture environments by GL_COMBINE: functions, operands and scales, the dot product of bump mapping, and
//! textures of other units [GL 4.6 compatibility, 16.1].

use super::fixed::pipeline;
use crate::conformance::bench::environment::{
    GlArgument, GlCombine, GlCombiner, GlCoordinates, GlEnvironment, GlOperand, GlSource, GlUnit,
};
use crate::conformance::bench::fixed_function::{FixedBench, UnitsDraw};
use crate::conformance::bench::{Error, GlFormat, GlImage, GlState, Sampling, Surface, Vertex, rectangle};
use crate::conformance::random::Random;
use crate::conformance::verify::{GradeTally, environment};
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along a side: one texel each.
const SIDE: usize = 16;
/// Cells along a side: one primary colour each.
const CELLS: usize = 4;
/// Units in a row; GL has at least two.
const MOST_UNITS: usize = 3;

/// Random textures and primary colours, all of whole codes.
struct Setup<'a> {
    subject: &'a DriverUnderTest,
    fixed: &'a FixedBench,
    surface: Surface,
    images: Vec<GlImage>,
    texels: Vec<Vec<[u8; 4]>>,
    primaries: Vec<[u8; 4]>,
    vertices: Vec<Vertex>,
    random: Random,
}

fn unit(color: [u8; 4]) -> [f64; 4] {
    color.map(|code| f64::from(code) / 255.0)
}

impl<'a> Setup<'a> {
    fn new(subject: &'a DriverUnderTest, fixed: &'a FixedBench, seed: u64) -> Result<Self, Error> {
        let mut random = Random::new(seed);
        let mut colors = |count: usize| -> Vec<[u8; 4]> {
            (0..count).map(|_| [(); 4].map(|()| (random.unit() * 256.0) as u8)).collect()
        };
        let primaries = colors(CELLS * CELLS);
        let texels: Vec<_> = (0..MOST_UNITS.min(fixed.most_units())).map(|_| colors(SIDE * SIDE)).collect();
        let images = texels.iter().map(|texels| subject.bench.byte_image([SIDE as u32; 2], texels));
        let images = images.collect::<Result<_, _>>()?;
        let edge = |index: usize| index as f32 * 2.0 / CELLS as f32 - 1.0;
        let cell = |(index, color): (usize, &[u8; 4])| {
            let [x, y] = [index % CELLS, index / CELLS];
            let value = unit(*color).map(|part| part as f32);
            rectangle([edge(x), edge(y)], [edge(x + 1), edge(y + 1)], 0.0, value)
        };
        let vertices = primaries.iter().enumerate().flat_map(cell).collect();
        let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba8), None)?;
        Ok(Self { subject, fixed, surface, images, texels, primaries, vertices, random })
    }

    fn constant(&mut self) -> [f32; 4] {
        [(); 4].map(|()| (self.random.unit() * 256.0).floor() / 255.0)
    }

    fn one_of<T: Copy, const N: usize>(&mut self, all: [T; N]) -> T {
        all[((self.random.unit() * N as f32) as usize).min(N - 1)]
    }

    /// Arguments from these sources, with random operands.
    fn combiner<const N: usize>(&mut self, function: GlCombine, scale: u32, sources: [GlSource; N]) -> GlCombiner {
        let arguments =
            [(); 3].map(|()| GlArgument { source: self.one_of(sources), operand: self.one_of(GlOperand::ALL) });
        GlCombiner { function, arguments, scale }
    }

    /// Draws a unit for each environment, and grades each pixel's channels together.
    fn draw(&self, environments: &[GlEnvironment], tally: &mut GradeTally) -> Result<(), Error> {
        let units: Vec<_> = environments
            .iter()
            .zip(&self.images)
            .map(|(environment, image)| GlUnit {
                image,
                sampling: Sampling::NEAREST,
                coordinates: GlCoordinates::Square,
                environment: *environment,
            })
            .collect();
        let state = GlState { depth: None, ..GlState::WRITE };
        let draw = UnitsDraw { surface: &self.surface, state, units: &units, color: None, vertices: &self.vertices };
        self.fixed.draw_units(&self.subject.bench, &draw)?;
        for (pixel, seen) in self.surface.colors().into_iter().enumerate() {
            let textures: Vec<_> = self.texels.iter().map(|texels| unit(texels[pixel])).collect();
            let cell = |at: usize| at * CELLS / SIDE;
            let primary = unit(self.primaries[cell(pixel / SIDE) * CELLS + cell(pixel % SIDE)]);
            let [strict, allowed] =
                environment::ROUNDING.map(|rounding| environment::color(environments, &textures, primary, rounding));
            let graded = [0, 1, 2, 3].map(|at| environment::code(seen[at], strict[at], allowed[at]));
            let grade = graded.iter().map(|(grade, _)| *grade).max();
            let off = graded.iter().map(|(_, off)| off.abs()).fold(0.0, f64::max);
            if let Some(grade) = grade {
                tally.add(grade, off);
            }
        }
        Ok(())
    }
}

const OWN: [GlSource; 4] = [GlSource::Texture, GlSource::Constant, GlSource::Primary, GlSource::Previous];
const SCALES: [u32; 3] = [1, 2, 4];

/// GL-E1: each function under each scale, with random arguments, and units in a row.
pub fn functions(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = pipeline(subject, findings, "GL_COMBINE") else { return Ok(()) };
    let mut setup = Setup::new(subject, fixed, 31)?;
    for function in GlCombine::SHARED {
        let mut tally = GradeTally::default();
        for scale in SCALES {
            let [rgb, alpha] = [(); 2].map(|()| setup.combiner(function, scale, OWN));
            let environment = GlEnvironment { rgb, alpha, constant: setup.constant() };
            setup.draw(&[environment], &mut tally)?;
        }
        findings.tally(function.name(), tally, "codes");
    }
    let mut tally = GradeTally::default();
    for _ in 0..4 {
        let environments: Vec<_> = (0..setup.images.len())
            .map(|_| {
                let [rgb, alpha] = [(); 2].map(|()| {
                    let (function, scale) = (setup.one_of(GlCombine::SHARED), setup.one_of(SCALES));
                    setup.combiner(function, scale, OWN)
                });
                GlEnvironment { rgb, alpha, constant: setup.constant() }
            })
            .collect();
        setup.draw(&environments, &mut tally)?;
    }
    findings.tally(format!("{} units in a row", setup.images.len()), tally, "codes");
    let mut tally = GradeTally::default();
    for keeps_color in [true, false, true, false] {
        let [before, other] = [(); 2].map(|()| {
            let (function, scale) = (setup.one_of(GlCombine::SHARED), setup.one_of(SCALES));
            setup.combiner(function, scale, OWN)
        });
        let operand = if keeps_color { GlOperand::Color } else { GlOperand::Alpha };
        let argument = GlArgument { source: GlSource::Previous, operand };
        let kept = GlCombiner { function: GlCombine::Replace, arguments: [argument; 3], scale: 1 };
        let [rgb, alpha] = if keeps_color { [kept, other] } else { [other, kept] };
        let constant = setup.constant();
        let first = GlEnvironment { rgb: before, alpha: before, constant };
        setup.draw(&[first, GlEnvironment { rgb, alpha, constant }], &mut tally)?;
    }
    findings.tally("a unit that keeps colour or alpha", tally, "codes");
    Ok(())
}

/// GL-E2: the dot product of every two of texture, constant, primary colour and the unit before, under each scale.
pub fn dot_product(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    use GlSource::{Constant, Previous, Primary, Texture};
    let Some(fixed) = pipeline(subject, findings, "DOT3") else { return Ok(()) };
    let mut setup = Setup::new(subject, fixed, 32)?;
    let pairs = [
        [Texture, Primary],
        [Texture, Previous],
        [Constant, Texture],
        [Previous, Primary],
        [Primary, Constant],
        [Previous, Constant],
    ];
    for function in [GlCombine::Dot3Rgb, GlCombine::Dot3Rgba] {
        let mut tally = GradeTally::default();
        // As they are, at scale 1; then some with random operands, at each scale.
        for (number, pair) in pairs.into_iter().chain(pairs).take(9).enumerate() {
            let first = GlCombiner::plain(GlCombine::Modulate, [Texture, Primary, Texture]);
            let mut rgb = GlCombiner::plain(function, [pair[0], pair[1], Texture]);
            if number >= pairs.len() {
                rgb.scale = SCALES[number % 3];
                rgb.arguments =
                    rgb.arguments.map(|argument| GlArgument { operand: setup.one_of(GlOperand::ALL), ..argument });
            }
            // What alpha's own combiner writes, DOT3_RGBA replaces; its scale is the same.
            let alpha = GlCombiner { scale: rgb.scale, ..setup.combiner(GlCombine::Modulate, 1, OWN) };
            let constant = setup.constant();
            let environments =
                [GlEnvironment { rgb: first, alpha: first, constant }, GlEnvironment { rgb, alpha, constant }];
            setup.draw(&environments, &mut tally)?;
        }
        findings.tally(function.name(), tally, "codes");
    }
    Ok(())
}

/// GL-E3: each unit reads the others' textures.
pub fn crossbar(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = pipeline(subject, findings, "GL_TEXTUREn as a source") else { return Ok(()) };
    let mut setup = Setup::new(subject, fixed, 33)?;
    let count = setup.images.len();
    let mut tally = GradeTally::default();
    for number in 0..4 {
        let environments: Vec<_> = (0..count)
            .map(|unit| {
                let other = GlSource::Crossbar(((unit + 1 + number % (count - 1).max(1)) % count) as u32);
                let [rgb, alpha] = [(); 2].map(|()| {
                    let function = setup.one_of([GlCombine::Replace, GlCombine::Modulate, GlCombine::Interpolate]);
                    let mut combiner = setup.combiner(function, 1, [other, GlSource::Previous]);
                    combiner.arguments[0].source = other;
                    combiner
                });
                GlEnvironment { rgb, alpha, constant: setup.constant() }
            })
            .collect();
        setup.draw(&environments, &mut tally)?;
    }
    findings.tally(format!("{count} units, each with another one's texture"), tally, "codes");
    Ok(())
}
