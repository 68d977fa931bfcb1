//! GL-M1 to GL-M3: cube maps: faces, filters across edges, and the error of a map that normalises [GL 4.6, 8.13, 8.14].

use super::fixed;
use crate::conformance::bench::environment::{GlCombine, GlCombiner, GlCoordinates, GlEnvironment, GlSource, GlUnit};
use crate::conformance::bench::fixed_function::UnitsDraw;
use crate::conformance::bench::{Error, GlFormat, GlImage, GlState, Sampling, Vertex, rectangle};
use crate::conformance::random::Random;
use crate::conformance::verify::cube::{self, Cube};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const LOOK_UP: &str = "result = texture(cube, texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).xyz);";
const FACES: [&str; 6] = ["+x", "-x", "+y", "-y", "+z", "-z"];

fn random_faces(random: &mut Random, side: u32) -> [Vec<[u8; 4]>; 6] {
    [(); 6].map(|()| (0..side * side).map(|_| [(); 4].map(|()| (random.unit() * 256.0) as u8)).collect())
}

/// A vector that meets a face at s and t, of a length between 2^-20 and 2^20; in f32.
pub(super) fn vector(random: &mut Random, face: usize, place: [f32; 2]) -> [f32; 4] {
    let length = f64::from(random.between(-20.0, 20.0)).exp2();
    let [x, y, z] = cube::direction(face, place.map(f64::from)).map(|part| (part * length) as f32);
    [x, y, z, 1.0]
}

pub(super) fn direction([x, y, z, _]: [f32; 4]) -> [f64; 3] {
    [x, y, z].map(f64::from)
}

fn in_codes(color: [f32; 4]) -> [f64; 4] {
    color.map(|value| f64::from(value) * 255.0)
}

/// The map's colours at each vector, in codes: by a shader.
fn by_shader(
    subject: &DriverUnderTest,
    image: &GlImage,
    sampling: Sampling,
    vectors: &[[f32; 4]],
) -> Result<Vec<[f64; 4]>, Error> {
    let colors = subject.bench.map(LOOK_UP, vectors, &[("cube", image, sampling)])?;
    Ok(colors.into_iter().map(in_codes).collect())
}

/// A rectangle for each vector, rows of `side` from below.
fn rectangles(side: usize, vectors: &[[f32; 4]]) -> Vec<Vertex> {
    let edge = |index: usize| index as f32 * 2.0 / side as f32 - 1.0;
    let cell = |(index, value): (usize, &[f32; 4])| {
        let [x, y] = [index % side, index / side];
        rectangle([edge(x), edge(y)], [edge(x + 1), edge(y + 1)], 0.0, *value)
    };
    vectors.iter().enumerate().flat_map(cell).collect()
}

/// The same by texture coordinates of the fixed-function pipeline, from the first [`FIXED`] vectors.
fn by_coordinates(
    subject: &DriverUnderTest,
    fixed: &crate::conformance::bench::fixed_function::FixedBench,
    image: &GlImage,
    sampling: Sampling,
    vectors: &[[f32; 4]],
) -> Result<Vec<[f64; 4]>, Error> {
    let surface = subject.bench.surface([FIXED_SIDE as u32; 2], Some(GlFormat::Rgba8), None)?;
    let replace = GlCombiner::replace(GlSource::Texture);
    let environment = GlEnvironment { rgb: replace, alpha: replace, constant: [0.0; 4] };
    let unit = GlUnit { image, sampling, coordinates: GlCoordinates::Value, environment };
    let (state, vertices) = (GlState { depth: None, ..GlState::WRITE }, rectangles(FIXED_SIDE, vectors));
    let draw = UnitsDraw { surface: &surface, state, units: &[unit], color: Some([1.0; 4]), vertices: &vertices };
    fixed.draw_units(&subject.bench, &draw)?;
    Ok(surface.colors().into_iter().map(|color| color.map(f64::from)).collect())
}

/// Pixels along a side of a fixed-function draw, one for each vector.
const FIXED_SIDE: usize = 24;
const FIXED: usize = FIXED_SIDE * FIXED_SIDE;

/// GL-M1: the face of a vector, and the ways of s and t on it.
pub fn faces(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const SIDE: u32 = 8;
    let mut random = Random::new(41);
    let texels = random_faces(&mut random, SIDE);
    let image = subject.bench.cube_image(SIDE, &texels)?;
    let cube = Cube { side: SIDE, faces: &texels, seamless: false };
    for (face, name) in FACES.into_iter().enumerate() {
        let vectors: Vec<_> = (0..512)
            .map(|_| {
                let place = [random.unit(), random.unit()];
                vector(&mut random, face, place)
            })
            .collect();
        let mut tally = GradeTally::default();
        for (vector, color) in vectors.iter().zip(by_shader(subject, &image, Sampling::NEAREST, &vectors)?) {
            tally.add(cube.nearest(color, direction(*vector)), 0.0);
        }
        findings.tally(format!("{name}, NEAREST"), tally, "");
    }
    let what = "fixed function: all faces, NEAREST";
    let Some(fixed) = fixed::pipeline(subject, findings, what) else { return Ok(()) };
    let vectors: Vec<_> = (0..FIXED)
        .map(|index| {
            let place = [random.unit(), random.unit()];
            vector(&mut random, index % 6, place)
        })
        .collect();
    let mut tally = GradeTally::default();
    for (vector, color) in vectors.iter().zip(by_coordinates(subject, fixed, &image, Sampling::NEAREST, &vectors)?) {
        tally.add(cube.nearest(color, direction(*vector)), 0.0);
    }
    findings.tally(what, tally, "");
    Ok(())
}

/// Part of a face that vectors meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Region {
    Inside,
    Edge,
    Corner,
}

/// Places within half a texel of an edge or a corner, some of them on it; or none of these.
pub(super) fn places(random: &mut Random, region: Region, side: u32, count: usize) -> Vec<[f32; 4]> {
    let half = 0.5 / side as f32;
    let mut beside = |on: bool| {
        let at = if on { 0.0 } else { random.unit() * half };
        let at = if random.unit() < 0.5 { at } else { 1.0 - at };
        (at, random.between(half, 1.0 - half), random.between(half, 1.0 - half), random.unit() < 0.5)
    };
    let mut places = Vec::new();
    for number in 0..count {
        let on = number % 8 == 0;
        let ((first, inside, other, swap), (second, ..)) = (beside(on), beside(on));
        let place = match region {
            Region::Inside => [inside, other],
            Region::Edge if swap => [inside, first],
            Region::Edge => [first, inside],
            Region::Corner => [first, second],
        };
        places.push((number % 6, place));
    }
    places.into_iter().map(|(face, place)| vector(random, face, place)).collect()
}

/// GL-M2: LINEAR within a face, at its edges and at the cube's corners, with seams and without.
pub fn seams(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const SIDE: u32 = 4;
    let mut random = Random::new(42);
    let texels = random_faces(&mut random, SIDE);
    let image = subject.bench.cube_image(SIDE, &texels)?;
    let mut all = Vec::new();
    let regions = [(Region::Inside, "inside"), (Region::Edge, "at an edge"), (Region::Corner, "at a corner")];
    for seamless in [false, true] {
        let mode = if seamless { "seamless" } else { "each face alone" };
        let cube = Cube { side: SIDE, faces: &texels, seamless };
        let sampling = Sampling { seamless, ..Sampling::LINEAR };
        for (region, name) in regions {
            let vectors = places(&mut random, region, SIDE, 1024);
            let mut tally = GradeTally::default();
            for (vector, color) in vectors.iter().zip(by_shader(subject, &image, sampling, &vectors)?) {
                let (grade, off) = cube.linear(color, direction(*vector));
                tally.add(grade, off);
            }
            findings.tally(format!("{mode}, {name}"), tally, "codes");
            all.extend(vectors.into_iter().take(FIXED / 3));
        }
    }
    let Some(fixed) = fixed::pipeline(subject, findings, "fixed function: LINEAR") else { return Ok(()) };
    for (seamless, vectors) in [false, true].into_iter().zip(all.chunks(FIXED)) {
        let mode = if seamless { "seamless" } else { "each face alone" };
        let cube = Cube { side: SIDE, faces: &texels, seamless };
        let sampling = Sampling { seamless, ..Sampling::LINEAR };
        let mut tally = GradeTally::default();
        for (vector, color) in vectors.iter().zip(by_coordinates(subject, fixed, &image, sampling, vectors)?) {
            let (grade, off) = cube.linear(color, direction(*vector));
            tally.add(grade, off);
        }
        findings.tally(format!("fixed function: {mode}"), tally, "codes");
    }
    Ok(())
}

/// Unit vectors through the middles of texels, packed as round(255 (x + 1) / 2); alpha is 255.
fn normal_cube(side: u32) -> [Vec<[u8; 4]>; 6] {
    [0, 1, 2, 3, 4, 5].map(|face| {
        let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(side);
        let texel = |index: u32| {
            let [red, green, blue] = packed(unit(cube::direction(face, [middle(index % side), middle(index / side)])));
            [red, green, blue, 255]
        };
        (0..side * side).map(texel).collect()
    })
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    // The greatest first: squares of a short vector would vanish.
    let most = vector.into_iter().map(f64::abs).fold(0.0, f64::max);
    let scaled = vector.map(|part| part / most);
    let length = scaled.into_iter().map(|part| part * part).sum::<f64>().sqrt();
    scaled.map(|part| part / length)
}

fn packed(vector: [f64; 3]) -> [u8; 3] {
    vector.map(|part| (127.5 * (part + 1.0)).round() as u8)
}

/// Greatest distance from the unit vector that a map of `side` texels may have at a place: strictly, and at most. The packed
/// texels are off by half a code in each of three coordinates and the filter by as much, or by three times as much. Between
/// texels 2 / side apart a chord is off by less than 1 / side^2. Where a face is filtered alone, its last half texel has no
/// neighbour: 1 / side in s, or in t too, of which a direction turns by half at most. So at corners where three texels stand
/// for four.
fn most_off(side: u32, seamless: bool, region: Region) -> [f64; 2] {
    let side = f64::from(side);
    let edge = if region == Region::Inside || (seamless && region == Region::Edge) { 0.0 } else { 0.5 / side };
    [1.0, 2.0].map(|codes| edge + side.powi(-2) + codes * 3f64.sqrt() * 2.0 / 255.0)
}

/// GL-M3: a cube map of unit vectors, by size; and what DOT3 makes of it.
pub fn normalization(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut random = Random::new(43);
    for seamless in [false, true] {
        let mode = if seamless { "seamless" } else { "each face alone" };
        let mut worst = Vec::new();
        for side in [16, 32, 64, 128, 256] {
            let image = subject.bench.cube_image(side, &normal_cube(side))?;
            let sampling = Sampling { seamless, ..Sampling::LINEAR };
            let (mut tally, mut angle) = (GradeTally::default(), 0.0_f64);
            for region in [Region::Inside, Region::Edge, Region::Corner] {
                let vectors = places(&mut random, region, side, 1024);
                let [strict, allowed] = most_off(side, seamless, region);
                for (vector, color) in vectors.iter().zip(by_shader(subject, &image, sampling, &vectors)?) {
                    let due = unit(direction(*vector));
                    let seen = [0, 1, 2].map(|axis| color[axis] / 127.5 - 1.0);
                    let off = distance(seen, due);
                    tally.add(verify::within(off, strict, allowed), off);
                    angle = angle.max(2.0 * (0.5 * distance(unit(seen), due)).asin());
                }
            }
            findings.tally(format!("{side} texels a side, {mode}"), tally, "of the length");
            worst.push(format!("{:.2} at {side}", angle.to_degrees()));
        }
        findings.fact(format!("worst direction in degrees, {mode}"), worst.join(", "));
    }
    findings.part(|findings| dotted(subject, findings, &mut random));
    Ok(())
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

/// N.L of a random normal map and vectors that are not of unit length: the cube map in the first unit, DOT3 with the normal
/// map in the second.
fn dotted(subject: &DriverUnderTest, findings: &mut Findings, random: &mut Random) -> Result<(), Error> {
    const SIDE: u32 = 64;
    let what = "fixed function: N.L by DOT3_RGB";
    let Some(fixed) = fixed::pipeline(subject, findings, what) else { return Ok(()) };
    let cube = subject.bench.cube_image(SIDE, &normal_cube(SIDE))?;
    let vectors = places(random, Region::Inside, SIDE, FIXED);
    let normals: Vec<[u8; 4]> = places(random, Region::Inside, SIDE, FIXED)
        .into_iter()
        .map(|normal| {
            let [red, green, blue] = packed(unit(direction(normal)));
            [red, green, blue, 255]
        })
        .collect();
    let map = subject.bench.byte_image([FIXED_SIDE as u32; 2], &normals)?;
    let replace = GlCombiner::replace(GlSource::Previous);
    let dot = GlCombiner::plain(GlCombine::Dot3Rgb, [GlSource::Texture, GlSource::Previous, GlSource::Previous]);
    let environment = |rgb| GlEnvironment { rgb, alpha: replace, constant: [0.0; 4] };
    let units = [
        GlUnit {
            image: &cube,
            sampling: Sampling { seamless: true, ..Sampling::LINEAR },
            coordinates: GlCoordinates::Value,
            environment: environment(GlCombiner::replace(GlSource::Texture)),
        },
        GlUnit {
            image: &map,
            sampling: Sampling::NEAREST,
            coordinates: GlCoordinates::Square,
            environment: environment(dot),
        },
    ];
    let surface = subject.bench.surface([FIXED_SIDE as u32; 2], Some(GlFormat::Rgba8), None)?;
    let (state, vertices) = (GlState { depth: None, ..GlState::WRITE }, rectangles(FIXED_SIDE, &vectors));
    let draw = UnitsDraw { surface: &surface, state, units: &units, color: Some([1.0; 4]), vertices: &vertices };
    fixed.draw_units(&subject.bench, &draw)?;
    // A normal of 8 bits is at most 1.007 long. The sum rounds once more.
    let [strict, allowed] = most_off(SIDE, true, Region::Inside).map(|off| 255.0 * 1.007 * off + 0.5);
    let mut tally = GradeTally::default();
    for ((seen, vector), normal) in surface.colors().into_iter().zip(vectors).zip(normals) {
        let light = unit(direction(vector));
        let dot: f64 = (0..3).map(|axis| (f64::from(normal[axis]) / 127.5 - 1.0) * light[axis]).sum();
        let off = f64::from(seen[0]) - 255.0 * dot.clamp(0.0, 1.0);
        tally.add(verify::within(off, strict, allowed), off);
    }
    findings.tally(what, tally, "codes");
    Ok(())
}
