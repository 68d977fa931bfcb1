//! GL-F1 to GL-F4: copies of depth, completeness, reading what is attached, and 8-bit colour [GL 4.6, 8.6, 9.3, 9.4, 17.3].

use crate::conformance::bench::{
    Error, GlBlend, GlDraw, GlFormat, GlState, Sampling, Shader, Surface, Vertex, full, rectangle, triangle,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 32;

/// Overlapping triangles of many depths.
fn scene() -> Vec<Vertex> {
    let mut random = Random::new(61);
    let corner = |random: &mut Random| [0; 3].map(|_| random.between(-1.0, 1.0));
    (0..24)
        .flat_map(|_| {
            triangle([0; 3].map(|_| {
                let [x, y, z] = corner(&mut random);
                [x * 1.3, y * 1.3, z, 1.0]
            }))
        })
        .collect()
}

pub(super) fn drawn(subject: &DriverUnderTest, format: GlFormat) -> Result<Surface, Error> {
    let surface = subject.bench.surface([SIDE; 2], None, Some(format))?;
    surface.clear_depth(1.0);
    subject.bench.draw(&GlDraw::plain(&surface, GlState { color_write: false, ..GlState::WRITE }, &scene()))?;
    Ok(surface)
}

/// GL-F1: glCopyTexSubImage2D of depth.
pub fn copy(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth32F, GlFormat::Depth24Stencil8] {
        findings.part(|findings| same_format(subject, findings, format));
    }
    for (from, to) in [
        (GlFormat::Depth24, GlFormat::Depth16),
        (GlFormat::Depth24, GlFormat::Depth32F),
        (GlFormat::Depth32F, GlFormat::Depth24),
        (GlFormat::Depth16, GlFormat::Depth24),
        (GlFormat::Depth24, GlFormat::Depth32),
    ] {
        findings.part(|findings| other_format(subject, findings, from, to));
    }
    findings.part(|findings| refusals(subject, findings));
    Ok(())
}

/// The whole, and a rectangle whose surroundings stay as they were.
fn same_format(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    let surface = drawn(subject, format)?;
    let image = subject.bench.image(format, [SIDE; 2])?;
    let whole = [0, 0, SIDE as i32, SIDE as i32];
    let error = subject.bench.copy_depth(&surface, whole, &image, [0, 0]);
    let (stored, copied) = (surface.depths(), subject.bench.image_depths(&image)?);
    let wrong = stored.iter().zip(&copied).filter(|(stored, copied)| stored != copied).count();
    findings.none_wrong(format!("{}: copied", format.name()), wrong, stored.len());
    let part = subject.bench.copy_depth(&surface, [3, 5, 20, 16], &image, [9, 2]);
    let after = subject.bench.image_depths(&image)?;
    let at = |x: usize, y: usize| y * SIDE as usize + x;
    let due = |index: usize| {
        let [x, y] = [index % SIDE as usize, index / SIDE as usize];
        let inside = (9..29).contains(&x) && (2..18).contains(&y);
        if inside { stored[at(x - 6, y + 3)] } else { copied[index] }
    };
    let wrong = after.iter().enumerate().filter(|(index, depth)| **depth != due(*index)).count();
    findings.none_wrong(format!("{}: a rectangle copied", format.name()), wrong, after.len());
    if let Some(error) = error.or(part) {
        findings.must_hold(format!("{}: copying", format.name()), false, error);
    }
    Ok(())
}

fn other_format(subject: &DriverUnderTest, findings: &mut Findings, from: GlFormat, to: GlFormat) -> Result<(), Error> {
    let surface = drawn(subject, from)?;
    let image = subject.bench.image(to, [SIDE; 2])?;
    let name = format!("{} copied to {}", from.name(), to.name());
    if let Some(error) = subject.bench.copy_depth(&surface, [0, 0, SIDE as i32, SIDE as i32], &image, [0, 0]) {
        findings.must_hold(name, false, error);
        return Ok(());
    }
    let mut tally = GradeTally::default();
    for (stored, copied) in surface.depths().iter().zip(subject.bench.image_depths(&image)?) {
        let step = image.encoding.step(0.75);
        let off = (copied - stored) / step;
        // f32 arithmetic has no more than 24 bits: there one step of f32 is allowed.
        let allowed = 1.5_f64.max(f64::from(-23).exp2() / step);
        tally.add(verify::within(off, 0.5 + 1e-3, allowed), off);
    }
    findings.tally(name, tally, "codes");
    Ok(())
}

/// Errors that GL must make.
fn refusals(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let without = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), None)?;
    let with = drawn(subject, GlFormat::Depth24)?;
    let image = subject.bench.image(GlFormat::Depth24, [SIDE; 2])?;
    let packed = subject.bench.image(GlFormat::Depth24Stencil8, [SIDE; 2])?;
    let area = [0, 0, 8, 8];
    let cases = [
        ("from a framebuffer without depth", &without, &image, [0, 0], "GL_INVALID_OPERATION"),
        ("from depth to depth and stencil", &with, &packed, [0, 0], "GL_INVALID_OPERATION"),
        ("beyond the texture", &with, &image, [SIDE as i32 - 4, 0], "GL_INVALID_VALUE"),
    ];
    for (name, surface, image, to, due) in cases {
        let error = subject.bench.copy_depth(surface, area, image, to).unwrap_or_else(|| "no error".to_owned());
        findings.must_hold(format!("a copy {name}"), error == due, format!("{error}; {due} is due"));
    }
    Ok(())
}

/// GL-F2: framebuffers of depth alone.
pub fn completeness(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::DEPTHS {
        // Table 8.13 has DEPTH_COMPONENT32, but 8.5.1 does not require it.
        let refused = if format == GlFormat::Depth32 { Grade::Allowed } else { Grade::Wrong };
        match subject.bench.surface([4, 4], None, Some(format)) {
            Ok(_) => findings.grade(format.name(), Grade::Good, "complete without colour"),
            Err(error @ Error::Refused { .. }) => findings.grade(format.name(), refused, error.to_string()),
            Err(error) => return Err(error),
        }
    }
    let separate = subject.bench.separate_stencil_is_complete()?;
    findings
        .fact("a depth texture with a stencil buffer of its own", if separate { "complete" } else { "not supported" });
    Ok(())
}

/// GL-F3: a depth texture is read while it is attached and not written.
pub fn feedback(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba32F), Some(GlFormat::Depth24))?;
    surface.clear_depth(1.0);
    subject.bench.draw(&GlDraw::plain(&surface, GlState::WRITE, &scene()))?;
    let Some(image) = surface.depth_image() else { return Ok(()) };
    let shader = Shader { fragment: "result = vec4(texelFetch(map, ivec2(gl_FragCoord.xy), 0).r);", ..Shader::PLAIN };
    let state = GlState { depth_write: false, ..GlState::WRITE };
    let images = [("map", image, Sampling::NEAREST)];
    subject.bench.draw(&GlDraw { shader, images: &images, ..GlDraw::plain(&surface, state, &full(0.0)) })?;
    let pairs: Vec<_> = surface.floats().into_iter().zip(surface.depths()).collect();
    let wrong = pairs.iter().filter(|(color, depth)| (f64::from(color[0]) - depth).abs() > 2f64.powi(-22)).count();
    let grade = if wrong == 0 { Grade::Good } else { Grade::Allowed };
    findings.grade("read-only depth, read", grade, format!("{wrong} of {} pixels are not what is stored", pairs.len()));
    Ok(())
}

/// GL-F4: floats to 8 bits, sums and products of 8 bits, sRGB.
pub fn eight_bits(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const WIDTH: u32 = 128;
    let mut random = Random::new(64);
    let values: Vec<f32> = (0..WIDTH * WIDTH).map(|_| random.between(-0.05, 1.05)).collect();
    let inputs: Vec<_> = values.iter().map(|value| [*value; 4]).collect();
    for format in [GlFormat::Rgba8, GlFormat::Srgb8Alpha8] {
        let encode = format == GlFormat::Srgb8Alpha8;
        let surface = subject.bench.surface([WIDTH; 2], Some(format), None)?;
        let state = GlState { depth: None, encode_srgb: encode, ..GlState::WRITE };
        let fragment = "result = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0);";
        subject.bench.map_into(&surface, state, fragment, &inputs, &[])?;
        let mut tally = GradeTally::default();
        for (value, color) in values.iter().zip(surface.colors()) {
            let value = f64::from(*value).clamp(0.0, 1.0);
            let due = if encode { srgb(value) } else { value };
            let off = f64::from(color[0]) - due * 255.0;
            // sRGB must be exact to 0.6 of a code (GL 4.6, 17.3.7, after EXT_framebuffer_sRGB); 1 is allowed.
            let grade = if encode { verify::within(off, 0.6, 1.5) } else { verify::unorm8(color[0], due) };
            tally.add(grade, off);
        }
        findings.tally(format!("{}: a shader's floats", format.name()), tally, "codes");
    }
    for (blend, name) in [(GlBlend::Add, "ONE, ONE"), (GlBlend::Multiply, "DST_COLOR, ZERO")] {
        findings.tally(format!("RGBA8: blended by {name}"), blended(subject, blend)?, "codes");
    }
    Ok(())
}

/// Linear to sRGB [GL 4.6, 17.3.7].
pub(super) fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// 64 codes over 64 codes: columns first, rows upon them.
fn blended(subject: &DriverUnderTest, blend: GlBlend) -> Result<GradeTally, Error> {
    const CODES: i32 = 64;
    let surface = subject.bench.surface([CODES as u32; 2], Some(GlFormat::Rgba8), None)?;
    let code = |index: i32| (index * 4 + 1) as f32 / 255.0;
    let ndc = |index: i32| index as f32 * 2.0 / CODES as f32 - 1.0;
    let columns: Vec<_> =
        (0..CODES).flat_map(|x| rectangle([ndc(x), -1.0], [ndc(x + 1), 1.0], 0.0, [code(x); 4])).collect();
    let rows: Vec<_> =
        (0..CODES).flat_map(|y| rectangle([-1.0, ndc(y)], [1.0, ndc(y + 1)], 0.0, [code(y); 4])).collect();
    let plain = GlState { depth: None, ..GlState::WRITE };
    subject.bench.draw(&GlDraw::plain(&surface, plain, &columns))?;
    subject.bench.draw(&GlDraw::plain(&surface, GlState { blend: Some(blend), ..plain }, &rows))?;
    let mut tally = GradeTally::default();
    for (index, color) in surface.colors().iter().enumerate() {
        let [x, y] = [index as i32 % CODES, index as i32 / CODES].map(|index| f64::from(index * 4 + 1));
        let (due, strict) = if blend == GlBlend::Add { ((x + y).min(255.0), 0.0) } else { (x * y / 255.0, 0.5 + 1e-9) };
        let off = f64::from(color[0]) - due;
        tally.add(verify::within(off, strict, if blend == GlBlend::Add { 0.0 } else { 1.5 }), off);
    }
    Ok(tally)
}
