//! GL-U1 to GL-U3: texels from the client and back, and sRGB [GL 4.6, 8.4, 8.5, 8.24, 18.2].

use std::rc::Rc;

use super::filters::texels;
use super::mipmaps::fetched;
use crate::conformance::bench::{
    Error, GlFormat, GlImageDesc, GlPlace, GlReading, GlShape, GlState, GlUpload, Sampling, Shader, level_size,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const FORMATS: [GlFormat; 6] =
    [GlFormat::Rgba8, GlFormat::R8, GlFormat::Rgba8Signed, GlFormat::Rgba16F, GlFormat::Rgba32F, GlFormat::R32F];

/// GL-U1: texels go where they should, whatever the rows' alignment and length.
pub fn uploads(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in FORMATS {
        findings.part(|findings| levels_of(subject, findings, format));
    }
    findings.part(|findings| rectangles(subject, findings));
    findings.part(|findings| faces(subject, findings));
    findings.part(|findings| depth_rectangle(subject, findings));
    Ok(())
}

/// Every texel of every level.
fn levels_of(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    const LEVELS: u32 = 3;
    let size = [7, 5];
    let mut random = Random::new(201);
    let levels: Vec<_> = (0..LEVELS)
        .map(|level| texels(&mut random, format, level_size(size, level).into_iter().product::<u32>() as usize))
        .collect();
    let desc = GlImageDesc { levels: LEVELS, ..GlImageDesc::flat(format, size) };
    let image = subject.bench.filled(desc, |level, _| levels[level as usize].0.clone())?;
    let mut tally = GradeTally::default();
    for level in 0..LEVELS {
        for (seen, due) in fetched(subject, &image, level)?.iter().zip(&levels[level as usize].1) {
            for channel in 0..4 {
                let off = seen[channel] - due[channel];
                // c / 255 in f32; floats are exact.
                tally.add(verify::within(off, f64::from(-22).exp2(), f64::from(-20).exp2()), off);
            }
        }
    }
    findings.tally(format!("{}, levels", format.name()), tally, "");
    Ok(())
}

/// Rectangles in levels, rows of the client's memory padded by UNPACK_ALIGNMENT or longer by UNPACK_ROW_LENGTH.
fn rectangles(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let size = [16, 12];
    for (format, texel) in [(GlFormat::R8, 1_u32), (GlFormat::Rgba8, 4), (GlFormat::R32F, 4)] {
        let layout = match format {
            GlFormat::R8 => [glow::RED, glow::UNSIGNED_BYTE],
            GlFormat::Rgba8 => [glow::RGBA, glow::UNSIGNED_BYTE],
            _ => [glow::RED, glow::FLOAT],
        };
        let mut random = Random::new(202);
        let (mut wrong, mut count) = (0, 0);
        for (alignment, row, level, area) in [
            (1, 0, 0, [0, 0, 16, 12]),
            (1, 0, 0, [3, 2, 5, 7]),
            (2, 0, 0, [9, 1, 3, 3]),
            (4, 0, 1, [1, 2, 5, 3]),
            (8, 0, 0, [2, 5, 7, 4]),
            (1, 9, 1, [0, 1, 6, 4]),
            (4, 11, 0, [5, 0, 9, 6]),
        ] {
            let desc = GlImageDesc { levels: 2, ..GlImageDesc::flat(format, size) };
            let [before, inside] = [size, [area[2], area[3]]]
                .map(|[width, height]| texels(&mut random, format, (width * height) as usize));
            let image = subject.bench.filled(desc, |level, _| {
                let [width, height] = level_size(size, level);
                before.0[..(width * height * texel) as usize].to_vec()
            })?;
            let length = (if row == 0 { area[2] } else { row }) * texel;
            let stride = length.next_multiple_of(alignment) as usize;
            let mut bytes = vec![0xEE; stride * area[3] as usize + 64];
            for (index, line) in inside.0.chunks((area[2] * texel) as usize).enumerate() {
                bytes[index * stride..][..line.len()].copy_from_slice(line);
            }
            let upload = GlUpload { level, layer: 0, area, layout, alignment, row, bytes: &bytes };
            subject.bench.upload(&image, &upload)?;
            let [width, _] = level_size(size, level);
            for (index, seen) in fetched(subject, &image, level)?.iter().enumerate() {
                let [x, y] = [index as u32 % width, index as u32 / width];
                let there = (area[0]..area[0] + area[2]).contains(&x) && (area[1]..area[1] + area[3]).contains(&y);
                let due =
                    if there { inside.1[((y - area[1]) * area[2] + x - area[0]) as usize] } else { before.1[index] };
                wrong += usize::from((0..4).any(|channel| (seen[channel] - due[channel]).abs() > 1e-5));
                count += 1;
            }
        }
        findings.none_wrong(format!("{}: rectangles, alignment, row length", format.name()), wrong, count);
    }
    Ok(())
}

const FACE: Shader =
    Shader::of("vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = textureLod(cube, at.xyz, at.w);");
const LAYER: Shader = Shader {
    declarations: "uniform sampler2DArray layers;",
    ..Shader::of("result = texelFetch(layers, ivec3(texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).xyz), 0);")
};

/// Faces of a cube map by level, and layers of an array.
fn faces(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let color = |level: u32, layer: u32| [40 * layer as u8 + 20, 90 * level as u8, 200 - 30 * layer as u8, 255];
    let desc = GlImageDesc { levels: 2, ..GlImageDesc::cube(GlFormat::Rgba8, 2) };
    let texels = |level: u32, layer: u32| color(level, layer).repeat(if level == 0 { 4 } else { 1 });
    let image = subject.bench.filled(desc, texels)?;
    let (mut wrong, mut count) = (0, 0);
    let ways =
        [[1.0, 0.1, 0.2], [-1.0, 0.1, 0.2], [0.1, 1.0, 0.2], [0.1, -1.0, 0.2], [0.1, 0.2, 1.0], [0.1, 0.2, -1.0]];
    for level in 0..2 {
        let inputs = ways.map(|[x, y, z]| [x, y, z, level as f32]);
        let seen = subject.bench.map_by(FACE, &inputs, &[("cube", &image, Sampling::NEAREST_LEVEL)])?;
        for (layer, seen) in (0..).zip(seen) {
            wrong += usize::from(seen.map(|value| (value * 255.0).round() as u8) != color(level, layer));
            count += 1;
        }
    }
    findings.none_wrong("faces of a cube map, two levels", wrong, count);
    let desc = GlImageDesc { shape: GlShape::Array, layers: 5, ..GlImageDesc::flat(GlFormat::Rgba8, [3, 2]) };
    let image = subject.bench.filled(desc, |_, layer| color(1, layer).repeat(6))?;
    let inputs: Vec<_> = (0..5).map(|layer| [2.0, 1.0, layer as f32, 0.0]).collect();
    let seen = subject.bench.map_by(LAYER, &inputs, &[("layers", &image, Sampling::NEAREST)])?;
    let wrong =
        (0..).zip(seen).filter(|(layer, seen)| seen.map(|value| (value * 255.0).round() as u8) != color(1, *layer));
    findings.none_wrong("layers of an array", wrong.count(), 5);
    Ok(())
}

/// Depths that replace a rectangle.
fn depth_rectangle(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::PURE_DEPTHS {
        let image = subject.bench.depth_image(format, [6, 4], &[&[0.0; 24]])?;
        let texels = [1.0_f32, 0.0, 1.0, 1.0, 1.0, 0.0];
        let (area, layout) = ([2, 1, 3, 2], [glow::DEPTH_COMPONENT, glow::FLOAT]);
        let bytes = bytemuck::cast_slice(&texels);
        subject.bench.upload(&image, &GlUpload { level: 0, layer: 0, area, layout, alignment: 4, row: 0, bytes })?;
        let wrong = subject.bench.image_depths(&image)?.into_iter().enumerate().filter(|&(index, seen)| {
            let [x, y] = [index % 6, index / 6];
            let there = (2..5).contains(&x) && (1..3).contains(&y);
            seen != if there { f64::from(texels[(y - 1) * 3 + x - 2]) } else { 0.0 }
        });
        findings.none_wrong(format!("{}: a rectangle", format.name()), wrong.count(), 24);
    }
    Ok(())
}

/// GL-U2: glReadPixels of rectangles, in the layouts that pictures are read in.
pub fn read_backs(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let size = [9, 6];
    for (format, layouts) in [
        (GlFormat::Rgba8, &[glow::UNSIGNED_BYTE, glow::FLOAT][..]),
        (GlFormat::Rgba8Signed, &[glow::FLOAT]),
        (GlFormat::Rgba16F, &[glow::FLOAT]),
        (GlFormat::Rgba32F, &[glow::FLOAT]),
        (GlFormat::R32F, &[glow::FLOAT]),
    ] {
        findings.part(|findings| {
            let (bytes, due) = texels(&mut Random::new(203), format, (size[0] * size[1]) as usize);
            let image = Rc::new(subject.bench.filled(GlImageDesc::flat(format, size), |_, _| bytes.clone())?);
            let surface = subject.bench.surface_at(Some(GlPlace::whole(&image)), None)?;
            for &kind in layouts {
                let mut tally = GradeTally::default();
                for (area, alignment) in [([0, 0, 9, 6], 1), ([2, 1, 5, 4], 1), ([4, 3, 3, 2], 4), ([0, 5, 1, 1], 8)] {
                    let texel = if kind == glow::FLOAT { 16 } else { 4 };
                    let stride = (area[2] as usize * texel).next_multiple_of(alignment as usize);
                    let bytes = stride * area[3] as usize;
                    let reading = GlReading { area, layout: [glow::RGBA, kind], alignment, bytes };
                    let read = subject.bench.read_pixels(&surface, &reading)?;
                    for (index, (x, y)) in (0..area[3]).flat_map(|y| (0..area[2]).map(move |x| (x, y))).enumerate() {
                        let at = index % area[2] as usize * texel + y as usize * stride;
                        let due = due[((area[1] + y) * size[0] as i32 + area[0] + x) as usize];
                        for channel in 0..4 {
                            // CLAMP_READ_COLOR clamps what is no float to [0, 1].
                            let signed = format == GlFormat::Rgba8Signed;
                            let due = if signed { due[channel].max(0.0) } else { due[channel] };
                            let off = value(&read[at..], kind, channel) - due;
                            tally.add(verify::within(off, f64::from(-22).exp2(), f64::from(-20).exp2()), off);
                        }
                    }
                }
                let kind = if kind == glow::FLOAT { "floats" } else { "bytes" };
                findings.tally(format!("{} read as {kind}", format.name()), tally, "");
            }
            Ok(())
        });
    }
    findings.part(|findings| packed_rows(subject, findings));
    Ok(())
}

fn value(texel: &[u8], kind: u32, channel: usize) -> f64 {
    if kind == glow::FLOAT {
        let bytes = [0, 1, 2, 3].map(|byte| texel[4 * channel + byte]);
        f64::from(f32::from_ne_bytes(bytes))
    } else {
        f64::from(texel[channel]) / 255.0
    }
}

/// Rows of three bytes a pixel: PACK_ALIGNMENT tells.
fn packed_rows(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let size = [5, 3];
    let (bytes, due) = texels(&mut Random::new(204), GlFormat::Rgba8, 15);
    let image = Rc::new(subject.bench.filled(GlImageDesc::flat(GlFormat::Rgba8, size), |_, _| bytes.clone())?);
    let surface = subject.bench.surface_at(Some(GlPlace::whole(&image)), None)?;
    for alignment in [1_u32, 2, 4, 8] {
        let stride = 15_u32.next_multiple_of(alignment) as usize;
        let layout = [glow::RGB, glow::UNSIGNED_BYTE];
        let reading = GlReading { area: [0, 0, 5, 3], layout, alignment, bytes: 3 * stride };
        let read = subject.bench.read_pixels(&surface, &reading)?;
        let wrong = due.iter().enumerate().filter(|(index, due)| {
            let texel = &read[index / 5 * stride + index % 5 * 3..][..3];
            (0..3).any(|channel| (f64::from(texel[channel]) / 255.0 - due[channel]).abs() > 1e-6)
        });
        findings.none_wrong(format!("RGB rows, PACK_ALIGNMENT {alignment}"), wrong.count(), due.len());
    }
    Ok(())
}

/// GL-U3: sRGB texels are decoded by a shader's look-up, alpha is not; a code that is written is the same again.
pub fn srgb(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let codes: Vec<u8> =
        (0..256).flat_map(|code| [code as u8, 255 - code as u8, (code * 7 % 256) as u8, code as u8]).collect();
    let desc = GlImageDesc::flat(GlFormat::Srgb8Alpha8, [16, 16]);
    let image = subject.bench.filled(desc, |_, _| codes.clone())?;
    let mut tally = GradeTally::default();
    for (texel, code) in fetched(subject, &image, 0)?.iter().zip(codes.chunks(4)) {
        for channel in 0..4 {
            let encoded = f64::from(code[channel]) / 255.0;
            let due = if channel == 3 { encoded } else { linear(encoded) };
            // 10 bits, as conformance tests ask of a table; a code of 8 bits at most.
            let off = texel[channel] - due;
            tally.add(verify::within(off, 1.0 / 1024.0, 0.5 / 255.0), off * 255.0);
        }
    }
    findings.tally("decoded", tally, "of 1/255");
    let surface = subject.bench.surface([16, 16], Some(GlFormat::Srgb8Alpha8), None)?;
    let state = GlState { depth: None, encode_srgb: true, ..GlState::WRITE };
    let fragment = "result = texelFetch(map, ivec2(gl_FragCoord.xy), 0);";
    subject.bench.map_into(&surface, state, fragment, &[], &[("map", &image, Sampling::NEAREST)])?;
    let mut tally = GradeTally::default();
    for (seen, code) in surface.colors().iter().zip(codes.chunks(4)) {
        for channel in 0..4 {
            let off = f64::from(seen[channel]) - f64::from(code[channel]);
            tally.add(verify::within(off, 0.0, 1.0), off);
        }
    }
    findings.tally("decoded and encoded again", tally, "codes");
    let plain = GlState { encode_srgb: false, ..state };
    subject.bench.map_into(&surface, plain, fragment, &[], &[("map", &image, Sampling::NEAREST)])?;
    let colors = surface.colors();
    let wrong = colors.iter().zip(codes.chunks(4)).filter(|(seen, code)| {
        let due = linear(f64::from(code[0]) / 255.0) * 255.0;
        (f64::from(seen[0]) - due).abs() > 1.3
    });
    findings.none_wrong("written without FRAMEBUFFER_SRGB: not encoded", wrong.count(), 256);
    Ok(())
}

/// sRGB to linear [GL 4.6, 8.24].
pub(super) fn linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}
