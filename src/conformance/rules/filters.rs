//! GL-L5 to GL-L7: wrap modes of each coordinate, borders beyond [0, 1], and swizzles, in each format [GL 4.6, 8.14.2, 8.10].

use crate::conformance::bench::{
    Error, GlFormat, GlImage, GlImageDesc, GlSampledBy, GlShape, GlSwizzle, GlWrap, Sampling, Shader,
};
use crate::conformance::random::Random;
use crate::conformance::verify::flat::{Flat, Wrapping};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const LOOK_UP: Shader = Shader::of("result = texture(map, texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).xy);");
const LINE: Shader = Shader {
    declarations: "uniform sampler1D line;",
    ..Shader::of("result = texture(line, texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).x);")
};

/// Colour formats, with the bytes of random texels and what a shader sees of them.
const FORMATS: [GlFormat; 6] =
    [GlFormat::Rgba8, GlFormat::Rgba8Signed, GlFormat::Rgba16F, GlFormat::Rgba32F, GlFormat::R32F, GlFormat::Depth24];

/// Random texels: bytes as uploaded, and values as due.
pub(super) fn texels(random: &mut Random, format: GlFormat, count: usize) -> (Vec<u8>, Vec<[f64; 4]>) {
    let mut bytes = Vec::new();
    let mut values = Vec::new();
    for _ in 0..count {
        let codes = [(); 4].map(|()| (random.unit() * 256.0) as u8);
        // Quarters of codes: exact as halves. Floats of 32 bits have more.
        let floats = codes.map(|code| f32::from(code) / 64.0 - 1.0);
        values.push(match format {
            GlFormat::Rgba8 => {
                bytes.extend(codes);
                codes.map(|code| f64::from(code) / 255.0)
            }
            GlFormat::R8 => {
                bytes.push(codes[0]);
                [f64::from(codes[0]) / 255.0, 0.0, 0.0, 1.0]
            }
            GlFormat::Rgba8Signed => {
                bytes.extend(codes);
                codes.map(|code| (f64::from(code as i8) / 127.0).max(-1.0))
            }
            GlFormat::Rgba32F => {
                let floats = floats.map(|value| value + random.unit() / 64.0);
                bytes.extend(floats.map(f32::to_ne_bytes).concat());
                floats.map(f64::from)
            }
            GlFormat::Rgba16F => {
                bytes.extend(floats.map(f32::to_ne_bytes).concat());
                floats.map(f64::from)
            }
            GlFormat::R32F => {
                let value = floats[0] + random.unit() / 64.0;
                bytes.extend(value.to_ne_bytes());
                [f64::from(value), 0.0, 0.0, 1.0]
            }
            _ => {
                // A depth as red alone: GLSL's `sampler2D` gives (D, 0, 0, 1), or what DEPTH_TEXTURE_MODE says.
                let depth = f32::from(codes[0]) / 255.0;
                bytes.extend(depth.to_ne_bytes());
                [f64::from(depth), 0.0, 0.0, 1.0]
            }
        });
    }
    (bytes, values)
}

/// The wrap modes that this context has.
fn wraps(subject: &DriverUnderTest) -> Vec<(GlWrap, Wrapping)> {
    let mut wraps = vec![
        (GlWrap::Repeat, Wrapping::Repeat),
        (GlWrap::MirroredRepeat, Wrapping::Mirror),
        (GlWrap::ClampToEdge, Wrapping::Edge),
        (GlWrap::ClampToBorder, Wrapping::Border),
    ];
    if subject.bench.is_compatible() {
        wraps.push((GlWrap::Clamp, Wrapping::Half));
    }
    wraps
}

/// Error of a value in a format: a code of 8 bits where weights may be as coarse, else what 16 or 24 bits keep.
fn error(format: GlFormat, linear: bool) -> f64 {
    match format {
        _ if linear => 1.0 / 255.0 + 1e-5,
        GlFormat::Depth24 => f64::from(-22).exp2(),
        _ => 1e-5,
    }
}

/// GL-L5: each wrap mode for s beside each for t.
pub fn wrapping(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in FORMATS {
        findings.part(|findings| wrapping_of(subject, findings, format));
    }
    findings.part(|findings| lines(subject, findings));
    findings.part(|findings| volumes(subject, findings));
    Ok(())
}

fn wrapping_of(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    // No power of two; wider than high.
    let size = [5, 3];
    let mut random = Random::new(125);
    let (bytes, values) = texels(&mut random, format, (size[0] * size[1]) as usize);
    let image = subject.bench.filled(GlImageDesc::flat(format, size), |_, _| bytes.clone())?;
    let inputs: Vec<_> = (0..256).map(|_| [random.between(-2.5, 3.5), random.between(-2.5, 3.5), 0.0, 0.0]).collect();
    let (border, border_due) = border(format, [0.25, 0.75, 0.5, 0.125]);
    // All modes by either way for one format; for others the modes for s are few: modes are no question of the format.
    let all = format == GlFormat::Rgba8;
    let wraps = wraps(subject);
    for by in GlSampledBy::ALL.into_iter().filter(|by| all || *by == GlSampledBy::Sampler) {
        for linear in [false, true] {
            let mut tally = GradeTally::default();
            // Each mode for s, and each for t beside another.
            let apart = if by == GlSampledBy::Texture { 1 } else { 2 };
            for (index, (s, first)) in wraps.iter().copied().enumerate().filter(|(index, _)| all || index % 2 == 1) {
                let (t, second) = wraps[(index + apart) % wraps.len()];
                let wrap = [s, t, GlWrap::Repeat];
                let sampling = Sampling { linear, wrap, border, by, ..Sampling::NEAREST };
                let seen = subject.bench.map_by(LOOK_UP, &inputs, &[("map", &image, sampling)])?;
                let flat = Flat { size, texels: &values, wrap: [first, second], border: border_due };
                for (input, value) in inputs.iter().zip(seen) {
                    let at = [input[0], input[1]].map(f64::from);
                    let (grade, off) = judged(&flat, format, value, at, linear);
                    tally.add(grade, off);
                }
            }
            let filter = if linear { "LINEAR" } else { "NEAREST" };
            findings.tally(format!("{}, {filter}{}", format.name(), by.suffix()), tally, "");
        }
    }
    Ok(())
}

/// By the channels that the format has: what a shader sees of a depth beside red depends on DEPTH_TEXTURE_MODE.
fn judged(flat: &Flat, format: GlFormat, value: [f32; 4], at: [f64; 2], linear: bool) -> (verify::Grade, f64) {
    let mut value = value.map(f64::from);
    if format.is_depth() {
        value = [value[0], 0.0, 0.0, 1.0];
    }
    let error = error(format, linear);
    if linear { flat.linear(value, at, error) } else { (flat.nearest(value, at, error), 0.0) }
}

/// A border's colour, and what a shader sees of it.
fn border(format: GlFormat, color: [f32; 4]) -> ([f32; 4], [f64; 4]) {
    let due = match format {
        GlFormat::Rgba8 | GlFormat::R8 => color.map(|value| value.clamp(0.0, 1.0)),
        GlFormat::Rgba8Signed => color.map(|value| value.clamp(-1.0, 1.0)),
        GlFormat::R32F => [color[0], 0.0, 0.0, 1.0],
        GlFormat::Rgba16F | GlFormat::Rgba32F => color,
        GlFormat::Depth32F => [color[0], 0.0, 0.0, 1.0],
        _ => [color[0].clamp(0.0, 1.0), 0.0, 0.0, 1.0],
    };
    (color, due.map(f64::from))
}

/// 1D textures, and how many texels they have: long ones are tables of a falloff or of the depths of a side map.
const LINES: [(GlFormat, u32); 4] =
    [(GlFormat::Rgba8, 6), (GlFormat::R32F, 6), (GlFormat::R32F, 300), (GlFormat::R32F, 1500)];

/// The same of 1D textures.
fn lines(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut random = Random::new(126);
    for (format, length) in LINES {
        let size = [length, 1];
        let (bytes, values) = texels(&mut random, format, length as usize);
        let desc = GlImageDesc { shape: GlShape::Line, ..GlImageDesc::flat(format, size) };
        let image = subject.bench.filled(desc, |_, _| bytes.clone())?;
        let inputs: Vec<_> = (0..256).map(|_| [random.between(-2.5, 3.5), 0.5, 0.0, 0.0]).collect();
        let (border, border_due) = border(format, [0.25, 0.75, 0.5, 0.125]);
        for linear in [false, true] {
            let mut tally = GradeTally::default();
            let few = format == GlFormat::Rgba8 || length > 6;
            for (s, wrapping) in wraps(subject).into_iter().step_by(if few { 3 } else { 1 }) {
                let sampling =
                    Sampling { linear, wrap: [s, GlWrap::Repeat, GlWrap::Repeat], border, ..Sampling::NEAREST };
                let seen = subject.bench.map_by(LINE, &inputs, &[("line", &image, sampling)])?;
                let flat = Flat { size, texels: &values, wrap: [wrapping, Wrapping::Edge], border: border_due };
                for (input, value) in inputs.iter().zip(seen) {
                    let (grade, off) = judged(&flat, format, value, [f64::from(input[0]), 0.5], linear);
                    tally.add(grade, off);
                }
            }
            let filter = if linear { "LINEAR" } else { "NEAREST" };
            let long = if length > 6 { format!(" of {length}") } else { String::new() };
            findings.tally(format!("1D {}{long}, {filter}", format.name()), tally, "");
        }
    }
    Ok(())
}

/// r of 3D textures: a row of layers. The modes of s and t are others, and change nothing in the middle of one texel.
fn volumes(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const VOLUME: Shader = Shader {
        declarations: "uniform sampler3D volume;",
        ..Shader::of("result = texture(volume, vec3(0.5, 0.5, texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).x));")
    };
    let mut random = Random::new(129);
    let (bytes, values) = texels(&mut random, GlFormat::Rgba8, 5);
    let desc = GlImageDesc { shape: GlShape::Volume, layers: 5, ..GlImageDesc::flat(GlFormat::Rgba8, [1, 1]) };
    let image = subject.bench.filled(desc, |_, layer| bytes[4 * layer as usize..][..4].to_vec())?;
    let inputs: Vec<_> = (0..256).map(|_| [random.between(-2.5, 3.5), 0.0, 0.0, 0.0]).collect();
    let (border, border_due) = border(GlFormat::Rgba8, [0.25, 0.75, 0.5, 0.125]);
    for (by, linear) in GlSampledBy::ALL.into_iter().flat_map(|by| [(by, false), (by, true)]) {
        let mut tally = GradeTally::default();
        for (r, wrapping) in wraps(subject) {
            let across = if r == GlWrap::Repeat { GlWrap::ClampToEdge } else { GlWrap::Repeat };
            let sampling = Sampling { linear, wrap: [across, across, r], border, by, ..Sampling::NEAREST };
            let seen = subject.bench.map_by(VOLUME, &inputs, &[("volume", &image, sampling)])?;
            let flat = Flat { size: [5, 1], texels: &values, wrap: [wrapping, Wrapping::Edge], border: border_due };
            for (input, value) in inputs.iter().zip(seen) {
                let (grade, off) = judged(&flat, GlFormat::Rgba8, value, [f64::from(input[0]), 0.5], linear);
                tally.add(grade, off);
            }
        }
        let filter = if linear { "LINEAR" } else { "NEAREST" };
        findings.tally(format!("r of 3D RGBA8, {filter}{}", by.suffix()), tally, "");
    }
    Ok(())
}

/// GL-L6: a border's colour beyond what the format has is clamped to it, in floats it is not.
pub fn borders(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let formats = [
        GlFormat::Rgba8,
        GlFormat::Rgba8Signed,
        GlFormat::Rgba16F,
        GlFormat::Rgba32F,
        GlFormat::R32F,
        GlFormat::Depth16,
        GlFormat::Depth24,
        GlFormat::Depth32,
        GlFormat::Depth32F,
    ];
    for format in formats {
        findings.part(|findings| {
            let mut random = Random::new(127);
            let (bytes, _) = texels(&mut random, format, 4);
            let image = subject.bench.filled(GlImageDesc::flat(format, [2, 2]), |_, _| bytes.clone())?;
            for by in GlSampledBy::ALL {
                let (mut worst, mut seen) = (0.0_f64, Vec::new());
                for color in [[1.5, -0.5, 0.25, 3.0], [-2.0, 0.75, 1.0, 0.0]] {
                    let (border, due) = border(format, color);
                    let wrap = [GlWrap::ClampToBorder; 3];
                    let sampling = Sampling { wrap, border, by, ..Sampling::NEAREST };
                    let value =
                        subject.bench.map_by(LOOK_UP, &[[-0.5, 0.5, 0.0, 0.0]], &[("map", &image, sampling)])?[0];
                    let channels = if format.is_depth() { 1 } else { 4 };
                    for channel in 0..channels {
                        worst = worst.max((f64::from(value[channel]) - due[channel]).abs());
                    }
                    seen.push(format!("{:?} is {:?}; {:?} is due", color, value, due));
                }
                // A border may be kept as a texel is: in a code.
                let grade = verify::within(worst, 1e-5, 1.0 / 255.0);
                findings.grade(format!("{}{}", format.name(), by.suffix()), grade, seen.join(", "));
            }
            Ok(())
        });
    }
    Ok(())
}

/// GL-L7: TEXTURE_SWIZZLE.
pub fn swizzles(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    use GlSwizzle::{Alpha, Blue, Green, One, Red, Zero};
    for format in [GlFormat::Rgba8, GlFormat::R32F] {
        let mut random = Random::new(128);
        let (bytes, values) = texels(&mut random, format, 1);
        let image = subject.bench.filled(GlImageDesc::flat(format, [1, 1]), |_, _| bytes.clone())?;
        swizzled(
            subject,
            findings,
            &image,
            values[0],
            &[
                GlSwizzle::SAME,
                [Red, Green, Blue, Red],
                [Alpha, Blue, Green, Red],
                [Green, Alpha, Red, Blue],
                [Zero, One, Zero, One],
                [One, Zero, Alpha, Zero],
            ],
        )?;
    }
    Ok(())
}

fn swizzled(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    image: &GlImage,
    texel: [f64; 4],
    swizzles: &[[GlSwizzle; 4]],
) -> Result<(), Error> {
    for by in GlSampledBy::ALL {
        let mut tally = GradeTally::default();
        for &swizzle in swizzles {
            let sampling = Sampling { swizzle, by, ..Sampling::NEAREST };
            let value = subject.bench.map_by(LOOK_UP, &[[0.5, 0.5, 0.0, 0.0]], &[("map", image, sampling)])?[0];
            for (seen, source) in value.into_iter().zip(swizzle) {
                let due = match source {
                    GlSwizzle::Red => texel[0],
                    GlSwizzle::Green => texel[1],
                    GlSwizzle::Blue => texel[2],
                    GlSwizzle::Alpha => texel[3],
                    GlSwizzle::Zero => 0.0,
                    GlSwizzle::One => 1.0,
                };
                let off = f64::from(seen) - due;
                tally.add(verify::within(off, 1e-5, 1e-5), off);
            }
        }
        findings.tally(format!("{}{}", image.format.name(), by.suffix()), tally, "");
    }
    Ok(())
}
