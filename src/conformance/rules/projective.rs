//! GL-T5 to GL-T7: divisions by a negative q and by one near 0, texture coordinate generation on every unit, and 1D textures
//! by planes [GL 4.6, 8.14; compatibility 12.1.3; GLSL 4.60, 8.9.2].

use glam::{DMat4, DVec3, DVec4};

use super::coordinates::texel_grade;
use super::fixed;
use crate::conformance::bench::environment::{GlCombiner, GlCoordinates, GlEnvironment, GlSource, GlUnit};
use crate::conformance::bench::fixed_function::{FixedBench, UnitsDraw};
use crate::conformance::bench::{
    Error, GlCompare, GlDraw, GlFormat, GlImage, GlImageDesc, GlShape, GlState, GlTexgen, Sampling, Shader, Surface,
    Vertex, full,
};
use crate::conformance::random::Random;
use crate::conformance::verify::flat::{Flat, Wrapping};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Texels along a side of a map.
const SIDE: u32 = 16;

const PROJECTED: &str = "result = vec4(compare_proj(texelFetch(inputs, ivec2(gl_FragCoord.xy), 0)));";
const COLORED: &str = "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0);
    vec4 four = textureProj(map, at), three = textureProj(map, at.xyw);
    result = vec4(four.rg, three.rg);";

/// GL-T5: GLSL divides by any q.
pub fn divisors(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut random = Random::new(601);
    let depths: Vec<f32> = (0..SIDE * SIDE).map(|_| random.unit()).collect();
    let texels: Vec<[f32; 4]> = (0..SIDE * SIDE).map(|_| [(); 4].map(|()| random.unit())).collect();
    let values: Vec<_> = texels.iter().map(|texel| [texel[0], texel[1], texel[0], texel[1]].map(f64::from)).collect();
    let map = subject.bench.float_image([SIDE; 2], &texels)?;
    let flat = Flat { size: [SIDE; 2], texels: &values, wrap: [Wrapping::Edge; 2], border: [0.0; 4] };
    for (name, divisors) in [
        ("q < 0", [-0.1_f32, -1.0, -7.0, -300.0]),
        ("q near 0", [1e-6, -1e-6, 3e-12, -3e-12]),
        ("q great", [1e6, -1e6, 4e12, -4e12]),
    ] {
        let inputs: Vec<[f32; 4]> = (0..1024)
            .map(|index| {
                let q = divisors[index % 4];
                [random.unit() * q, random.unit() * q, random.unit() * q, q]
            })
            .collect();
        for format in [GlFormat::Depth24, GlFormat::Depth32F] {
            let image = subject.bench.depth_image(format, [SIDE; 2], &[&depths])?;
            let stored = subject.bench.image_depths(&image)?;
            for linear in [false, true] {
                let sampling = Sampling { linear, ..Sampling::compare(GlCompare::LessEqual) };
                let mut tally = GradeTally::default();
                let seen = subject.bench.map(PROJECTED, &inputs, &[("shadow", &image, sampling)])?;
                for (input, value) in inputs.iter().zip(seen) {
                    tally.add(texel_grade(f64::from(value[0]), *input, &stored, linear), 0.0);
                }
                let filter = if linear { "LINEAR" } else { "NEAREST" };
                findings.tally(format!("{name}: {}, compared, {filter}", format.name()), tally, "");
            }
        }
        let mut tally = GradeTally::default();
        for (input, value) in
            inputs.iter().zip(subject.bench.map(COLORED, &inputs, &[("map", &map, Sampling::LINEAR)])?)
        {
            let at = [0, 1].map(|axis| f64::from(input[axis]) / f64::from(input[3]));
            let (grade, off) = flat.linear(value.map(f64::from), at, 1.0 / 255.0);
            tally.add(grade, off);
        }
        findings.tally(format!("{name}: colours"), tally, "");
    }
    let zero = [[0.5, 0.5, 0.5, 0.0], [0.0; 4]];
    let image = subject.bench.depth_image(GlFormat::Depth24, [SIDE; 2], &[&depths])?;
    let sampling = Sampling::compare(GlCompare::LessEqual);
    let seen = subject.bench.map(PROJECTED, &zero, &[("shadow", &image, sampling)])?;
    findings.fact("a projective comparison with q = 0", format!("{} and {}", seen[0][0], seen[1][0]));
    Ok(())
}

/// A ramp: red is s and green is t between the middles of four texels.
fn ramp(subject: &DriverUnderTest) -> Result<GlImage, Error> {
    let texel = |s: f32, t: f32| [s, t, 0.5, 1.0];
    subject.bench.float_image([2, 2], &[texel(0.0, 0.0), texel(1.0, 0.0), texel(0.0, 1.0), texel(1.0, 1.0)])
}

/// Planes of a unit: s / q and t / q lie in [0.3, 0.7] over the viewport, other ones for each unit.
fn planes(unit: usize, eye: bool) -> (GlTexgen, DMat4, DMat4) {
    let turn = 0.4 + 0.7 * unit as f64;
    let q = 1.0 + 0.25 * unit as f64;
    let row = |angle: f64| DVec4::new(0.12 * angle.cos(), 0.12 * angle.sin(), 0.0, 0.5) * q;
    let planes =
        DMat4::from_cols(row(turn), row(turn + 1.3), DVec4::new(0.1, 0.2, 0.3, 0.4), DVec4::new(0.0, 0.0, 0.0, q))
            .transpose();
    let modelview = DMat4::from_rotation_z(0.3 * unit as f64) * DMat4::from_scale(DVec3::new(1.1, 0.9, 1.0));
    // A texture matrix of the unit's own, which moves a little.
    let matrix = DMat4::from_translation(DVec3::new(0.01 * unit as f64, -0.02, 0.0));
    let from_eye = if eye { planes * modelview.inverse() } else { planes };
    (GlTexgen { eye, planes, modelview }, matrix, matrix * from_eye)
}

/// Pixels along a side of what is drawn.
const PIXELS: usize = 16;

/// All units are on, and generate coordinates; one alone gives its texture's colour.
fn draw_units(
    subject: &DriverUnderTest,
    fixed: &FixedBench,
    surface: &Surface,
    image: &GlImage,
    (chosen, count): (usize, usize),
    eye: bool,
    sampling: Sampling,
) -> Result<Vec<[f32; 4]>, Error> {
    let environment = |source| GlEnvironment {
        rgb: GlCombiner::replace(source),
        alpha: GlCombiner::replace(source),
        constant: [0.0; 4],
    };
    let units: Vec<_> = (0..count)
        .map(|unit| {
            let (texgen, matrix, _) = planes(unit, eye);
            let source = if unit == chosen { GlSource::Texture } else { GlSource::Previous };
            let coordinates = GlCoordinates::Generated(texgen, matrix);
            GlUnit { image, sampling, coordinates, environment: environment(source) }
        })
        .collect();
    let (state, vertices) = (GlState { depth: None, ..GlState::WRITE }, full(0.0));
    fixed.draw_units(
        &subject.bench,
        &UnitsDraw { surface, state, units: &units, color: Some([0.25; 4]), vertices: &vertices },
    )?;
    Ok(surface.floats())
}

/// Clip coordinates of a pixel's centre.
fn centre(index: usize) -> DVec4 {
    let [x, y] = [index % PIXELS, index / PIXELS].map(|at| (at as f64 + 0.5) * 2.0 / PIXELS as f64 - 1.0);
    DVec4::new(x, y, 0.0, 1.0)
}

/// GL-T6: planes, modes and texture matrices are each unit's own.
pub fn units(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let Some(fixed) = fixed::pipeline(subject, findings, "glTexGen on every unit") else { return Ok(()) };
    let surface = subject.bench.surface([PIXELS as u32; 2], Some(GlFormat::Rgba32F), None)?;
    let image = ramp(subject)?;
    let count = fixed.most_units().min(8);
    for eye in [true, false] {
        // Object planes are kept as eye planes are: two units will do.
        for unit in (0..count).step_by(if eye { 1 } else { count.max(2) - 1 }) {
            let seen = draw_units(subject, fixed, &surface, &image, (unit, count), eye, Sampling::LINEAR)?;
            let (.., generated) = planes(unit, eye);
            let mut tally = GradeTally::default();
            for (index, color) in seen.iter().enumerate() {
                let at = generated * centre(index);
                for (channel, coordinate) in [at.x / at.w, at.y / at.w].into_iter().enumerate() {
                    // The ramp is twice as steep as its coordinate; a weight is good to 2^-7, else to 2^-4.
                    let off = f64::from(color[channel]) - (2.0 * coordinate - 0.5);
                    tally.add(verify::within(off, 1.0 / 64.0, 1.0 / 8.0), off);
                }
            }
            let mode = if eye { "EYE_LINEAR" } else { "OBJECT_LINEAR" };
            findings.tally(format!("unit {unit} of {count}, {mode}"), tally, "");
        }
    }
    Ok(())
}

const PLANAR: Shader = Shader {
    declarations: "uniform sampler1D line; uniform vec4 plane;",
    vertex: "gl_Position = position; passed = vec4(dot(plane, position));",
    ..Shader::of("result = texture(line, passed.x);")
};

/// GL-T7: a 1D texture by a plane: in a shader, and on each unit of the fixed-function pipeline.
pub fn lines(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    use crate::conformance::bench::GlUniform;
    let mut random = Random::new(602);
    let texels: Vec<[f32; 4]> = (0..8).map(|_| [(); 4].map(|()| random.unit())).collect();
    let values: Vec<_> = texels.iter().map(|texel| texel.map(f64::from)).collect();
    let desc = GlImageDesc { shape: GlShape::Line, ..GlImageDesc::flat(GlFormat::Rgba32F, [8, 1]) };
    let image = subject.bench.filled(desc, |_, _| bytemuck::cast_slice(&texels).to_vec())?;
    let flat = Flat { size: [8, 1], texels: &values, wrap: [Wrapping::Edge; 2], border: [0.0; 4] };
    let surface = subject.bench.surface([PIXELS as u32; 2], Some(GlFormat::Rgba32F), None)?;
    let judged = |seen: Vec<[f32; 4]>, linear: bool, s: &dyn Fn(DVec4) -> f64| {
        let mut tally = GradeTally::default();
        for (index, color) in seen.into_iter().enumerate() {
            let (value, at) = (color.map(f64::from), [s(centre(index)), 0.5]);
            let (grade, off) =
                if linear { flat.linear(value, at, 1.0 / 255.0) } else { (flat.nearest(value, at, 1e-5), 0.0) };
            tally.add(grade, off);
        }
        tally
    };
    let plane = [0.37_f32, 0.21, 0.0, 0.46];
    let vertices: Vec<Vertex> = full(0.0).to_vec();
    for linear in [false, true] {
        let sampling = Sampling { linear, ..Sampling::NEAREST };
        let images = [("line", &image, sampling)];
        let uniforms = [("plane", GlUniform::Vec4(plane))];
        let plain = GlDraw::plain(&surface, GlState { depth: None, ..GlState::WRITE }, &vertices);
        subject.bench.draw(&GlDraw { shader: PLANAR, uniforms: &uniforms, images: &images, ..plain })?;
        let s = |at: DVec4| DVec4::from_array(plane.map(f64::from)).dot(at);
        let filter = if linear { "LINEAR" } else { "NEAREST" };
        findings.tally(format!("by a shader, {filter}"), judged(surface.floats(), linear, &s), "");
    }
    let Some(fixed) = fixed::pipeline(subject, findings, "fixed function: 1D textures") else { return Ok(()) };
    let count = fixed.most_units().min(8);
    for linear in [false, true] {
        let mut all = GradeTally::default();
        for unit in (0..count).step_by(count.max(2) - 1) {
            let sampling = Sampling { linear, ..Sampling::NEAREST };
            let seen = draw_units(subject, fixed, &surface, &image, (unit, count), true, sampling)?;
            let (.., generated) = planes(unit, true);
            let tally = judged(seen, linear, &|at| {
                let at = generated * at;
                at.x / at.w
            });
            all.good += tally.good;
            all.allowed += tally.allowed;
            all.wrong += tally.wrong;
            all.worst = all.worst.max(tally.worst);
        }
        let filter = if linear { "LINEAR" } else { "NEAREST" };
        findings.tally(format!("fixed function: planes of the first and the last of {count} units, {filter}"), all, "");
    }
    Ok(())
}
