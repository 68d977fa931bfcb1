//! GL-L3 and GL-L4: glGenerateMipmap, and what GLSL's functions say of levels and texels [GL 4.6, 8.14.4; GLSL 4.60, 8.9].

use crate::conformance::bench::{Error, GlFormat, GlImage, GlImageDesc, GlShape, Sampling, Shader, level_size};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const FETCH: Shader = Shader::of(
    "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = texelFetch(map, ivec2(at.xy), int(at.w));",
);

/// A level's texels by texelFetch, rows from t = 0.
pub(super) fn fetched(subject: &DriverUnderTest, image: &GlImage, level: u32) -> Result<Vec<[f64; 4]>, Error> {
    let [width, height] = level_size(image.size, level);
    let inputs: Vec<_> =
        (0..width * height).map(|index| [(index % width) as f32, (index / width) as f32, 0.0, level as f32]).collect();
    let values = subject.bench.map_by(FETCH, &inputs, &[("map", image, Sampling::NEAREST_LEVEL)])?;
    Ok(values.into_iter().map(|value| value.map(f64::from)).collect())
}

/// GL-L3: levels that GL makes. Any filter keeps a constant and stays within the texels that it takes; along a slope each
/// symmetric one finds the middle. A box is recommended.
pub fn generated(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for (size, levels) in [([16, 16], 5), ([16, 4], 5), ([1, 8], 4), ([5, 3], 3), ([7, 1], 3)] {
        for format in [GlFormat::Rgba8, GlFormat::Rgba32F] {
            findings.part(|findings| generated_of(subject, findings, format, size, levels));
        }
    }
    Ok(())
}

/// Red is a slope along s, green one along t, blue random, alpha a constant: in codes of 8 bits.
fn slopes(size: [u32; 2]) -> Vec<[f64; 4]> {
    let mut random = Random::new(113);
    (0..size[0] * size[1])
        .map(|index| {
            let [x, y] = [index % size[0], index / size[0]].map(f64::from);
            [12.0 * x, 14.0 * y, f64::from((random.unit() * 255.0).round()), 90.0]
        })
        .collect()
}

fn generated_of(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    format: GlFormat,
    size: [u32; 2],
    levels: u32,
) -> Result<(), Error> {
    let texels = slopes(size);
    let junk = vec![[1.0_f64, 250.0, 3.0, 200.0]; texels.len()];
    let desc = GlImageDesc { levels, ..GlImageDesc::flat(format, size) };
    // Levels have other texels before.
    let image = subject.bench.filled(desc, |level, _| {
        let [width, height] = level_size(size, level);
        let source = if level == 0 { &texels } else { &junk };
        let texels = source.iter().take((width * height) as usize);
        match format {
            GlFormat::Rgba8 => texels.flat_map(|texel| texel.map(|code| code as u8)).collect(),
            _ => texels.flat_map(|texel| texel.map(|code| (code / 255.0) as f32)).flat_map(f32::to_ne_bytes).collect(),
        }
    })?;
    subject.bench.generate_mipmap(&image)?;
    let even = size.iter().all(|side| side.is_power_of_two());
    let (mut slope, mut box_, mut constant) = (GradeTally::default(), GradeTally::default(), GradeTally::default());
    let mut above = texels.clone();
    for level in 1..levels {
        let [width, _] = level_size(size, level);
        let seen: Vec<_> =
            fetched(subject, &image, level)?.into_iter().map(|texel| texel.map(|value| value * 255.0)).collect();
        let from = level_size(size, level - 1);
        for (index, texel) in seen.iter().enumerate() {
            let [x, y] = [index as u32 % width, index as u32 / width];
            let mean = mean_of(&above, from, [x, y]);
            // Each level rounds once; an even filter of more texels differs at the border by half of a texel's slope.
            let rounds = if format == GlFormat::Rgba8 { 0.5 * f64::from(level) + 0.51 } else { 0.01 };
            constant.add(verify::within(texel[3] - 90.0, 0.01, rounds), texel[3] - 90.0);
            if even {
                for (channel, step) in [(0, 12.0), (1, 14.0)] {
                    let off = texel[channel] - slope_at(size, level, [x, y], channel, step);
                    slope.add(verify::within(off, rounds, rounds + 0.5 * step * f64::from(1 << (level - 1))), off);
                }
                box_.add(verify::within(texel[2] - mean[2], 0.52, 255.0), texel[2] - mean[2]);
            } else {
                let bounds = |channel: usize| {
                    texels
                        .iter()
                        .map(|texel| texel[channel])
                        .fold([f64::MAX, f64::MIN], |[low, high], value| [low.min(value), high.max(value)])
                };
                for (channel, value) in texel.iter().enumerate().take(3) {
                    let [low, high] = bounds(channel);
                    let off = (low - value).max(value - high).max(0.0);
                    slope.add(verify::within(off, rounds, rounds), off);
                }
                // The last level's one texel takes all: it is near the middle of a slope.
                if level + 1 == levels {
                    for (channel, step) in [(0, 12.0), (1, 14.0)] {
                        let length = step * f64::from(size[channel] - 1);
                        let off = texel[channel] - 0.5 * length;
                        slope.add(verify::within(off, 0.25 * length + 1.0, 0.5 * length + 1.0), off);
                    }
                }
            }
        }
        above = seen;
    }
    let name = format!("{} {} x {}", format.name(), size[0], size[1]);
    findings.tally(format!("{name}: a constant"), constant, "codes");
    findings.tally(format!("{name}: slopes"), slope, "codes");
    if even {
        findings.tally(format!("{name}: the mean of the level above"), box_, "codes");
    }
    Ok(())
}

/// Middle of what a texel covers on a slope of `step` a texel of level 0.
fn slope_at(size: [u32; 2], level: u32, place: [u32; 2], channel: usize, step: f64) -> f64 {
    let texels = f64::from(size[channel]) / f64::from(level_size(size, level)[channel]);
    step * ((f64::from(place[channel]) + 0.5) * texels - 0.5)
}

/// Mean of two, or one, texels along each side.
fn mean_of(above: &[[f64; 4]], from: [u32; 2], place: [u32; 2]) -> [f64; 4] {
    let columns = [0, 1].map(|next| (2 * place[0] + next).min(from[0] - 1));
    let rows = [0, 1].map(|next| (2 * place[1] + next).min(from[1] - 1));
    let mut mean = [0.0; 4];
    for (column, row) in rows.into_iter().flat_map(|row| columns.map(|column| (column, row))) {
        let texel = above[(row * from[0] + column) as usize];
        mean.iter_mut().zip(texel).for_each(|(mean, value)| *mean += 0.25 * value);
    }
    mean
}

const SIZES: Shader = Shader {
    declarations: "uniform sampler1D line; uniform sampler2DShadow flat_shadow; uniform samplerCubeShadow cube_shadow;",
    ..Shader::of(
        "int level = int(texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).w);
        result = vec4(textureSize(map, level), textureSize(line, level), textureSize(cube, level).x);
        if (gl_FragCoord.y > 1.0)
            result = vec4(textureSize(flat_shadow, level), textureSize(cube_shadow, level));",
    )
};

/// GL-L4: textureSize of each level, and texelFetch of each texel of each level.
pub fn functions(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const LEVELS: u32 = 3;
    let blank =
        |shape, format, size, layers| subject.bench.blank(GlImageDesc { shape, format, size, layers, levels: LEVELS });
    let flat = blank(GlShape::Flat, GlFormat::Rgba8, [12, 5], 1)?;
    let line = blank(GlShape::Line, GlFormat::R32F, [9, 1], 1)?;
    let cube = blank(GlShape::Cube, GlFormat::Rgba8, [8; 2], 6)?;
    let depth = blank(GlShape::Flat, GlFormat::Depth24, [20, 6], 1)?;
    let depth_cube = blank(GlShape::Cube, GlFormat::Depth24, [16; 2], 6)?;
    let compare =
        Sampling { compare: Some(crate::conformance::bench::GlCompare::LessEqual), ..Sampling::NEAREST_LEVEL };
    let images = [
        ("map", &flat, Sampling::NEAREST_LEVEL),
        ("line", &line, Sampling::NEAREST_LEVEL),
        ("cube", &cube, Sampling::NEAREST_LEVEL),
        ("flat_shadow", &depth, compare),
        ("cube_shadow", &depth_cube, compare),
    ];
    let sizes = |levels: &dyn Fn(u32) -> u32| {
        // Two rows: 256 inputs fill the first.
        let inputs: Vec<_> = (0..512).map(|index| [0.0, 0.0, 0.0, levels(index % 256) as f32]).collect();
        let values = subject.bench.map_by(SIZES, &inputs, &images)?;
        let wrong = values.iter().enumerate().filter(|(index, seen)| {
            let of = |size: [u32; 2]| level_size(size, levels(*index as u32 % 256)).map(|side| side as f32);
            let ([a, b], [c, d]) =
                if *index < 256 { (of([12, 5]), [of([9, 1])[0], of([8; 2])[0]]) } else { (of([20, 6]), of([16; 2])) };
            **seen != [a, b, c, d]
        });
        Ok::<_, Error>(wrong.count())
    };
    let mut wrong = 0;
    for level in 0..LEVELS {
        wrong += sizes(&|_| level)?;
    }
    findings.none_wrong("textureSize of each level and shape", wrong, 512 * LEVELS as usize);
    findings.none_wrong("textureSize of levels that differ pixel by pixel", sizes(&|index| index % LEVELS)?, 512);
    let size = [12, 5];
    let texel = |level: u32, index: u32| [level as u8 * 60, index as u8, 7, 255 - index as u8];
    let desc = GlImageDesc { levels: LEVELS, ..GlImageDesc::flat(GlFormat::Rgba8, size) };
    let image = subject.bench.filled(desc, |level, _| {
        let [width, height] = level_size(size, level);
        (0..width * height).flat_map(|index| texel(level, index)).collect()
    })?;
    let (mut wrong, mut count) = (0, 0);
    for level in 0..LEVELS {
        for (index, value) in fetched(subject, &image, level)?.into_iter().enumerate() {
            let due = texel(level, index as u32).map(f64::from);
            wrong += usize::from((0..4).any(|channel| (value[channel] * 255.0 - due[channel]).abs() > 0.01));
            count += 1;
        }
    }
    findings.none_wrong("texelFetch of each level", wrong, count);
    Ok(())
}
