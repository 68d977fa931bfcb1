//! GL-L1 and GL-L2: which levels of a texture are sampled, and by which filter [GL 4.6, 8.14.1 to 8.14.3].

use crate::conformance::bench::{
    Error, GlDraw, GlFormat, GlImage, GlImageDesc, GlMipmap, GlSampledBy, GlShape, GlState, GlWrap, Sampling, Shader,
    Surface, Vertex, level_size, rectangle,
};
use crate::conformance::verify::flat::{blended_level, level_of};
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Texels along a side of level 0, and levels.
const SIDE: u32 = 32;
const LEVELS: u32 = 6;

/// Each level has one value, its number / 8: a blend of levels is their fraction.
fn numbered(subject: &DriverUnderTest, shape: GlShape, format: GlFormat, size: [u32; 2]) -> Result<GlImage, Error> {
    let layers = if shape == GlShape::Cube { 6 } else { 1 };
    let desc = GlImageDesc { shape, format, size, layers, levels: LEVELS };
    subject.bench.filled(desc, |level, _| {
        let [width, height] = level_size(size, level);
        let (count, value) = (width as usize * height as usize, level as f32 / 8.0);
        match format {
            GlFormat::Rgba8 => vec![level as u8 * 32; 4 * count],
            GlFormat::Rgba32F => bytemuck::cast_slice(&vec![[value; 4]; count]).to_vec(),
            _ => bytemuck::cast_slice(&vec![value; count]).to_vec(),
        }
    })
}

/// The level that a value is of.
fn level_in(format: GlFormat, value: f32) -> f64 {
    if format == GlFormat::Rgba8 { f64::from(value) * 255.0 / 32.0 } else { f64::from(value) * 8.0 }
}

const MAP_LOD: Shader = Shader::of(
    "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(textureLod(map, vec2(0.5), at.w).r);",
);
const CUBE_LOD: Shader = Shader::of(
    "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(textureLod(cube, vec3(0.9, 0.2, 1.0), at.w).r);",
);
const LINE_LOD: Shader = Shader {
    declarations: "uniform sampler1D line;",
    ..Shader::of(
        "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(textureLod(line, 0.5, at.w).r);",
    )
};

/// GL-L1: a stated level, clamped by the sampler's and the texture's bounds.
pub fn stated(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let shapes = [
        (GlShape::Flat, GlFormat::Rgba32F, MAP_LOD, "map"),
        (GlShape::Flat, GlFormat::Rgba8, MAP_LOD, "map"),
        (GlShape::Flat, GlFormat::Depth16, MAP_LOD, "map"),
        (GlShape::Flat, GlFormat::Depth24, MAP_LOD, "map"),
        (GlShape::Flat, GlFormat::Depth32F, MAP_LOD, "map"),
        (GlShape::Cube, GlFormat::Rgba32F, CUBE_LOD, "cube"),
        (GlShape::Line, GlFormat::R32F, LINE_LOD, "line"),
    ];
    for (shape, format, shader, name) in shapes {
        findings.part(|findings| {
            let size = if shape == GlShape::Line { [SIDE, 1] } else { [SIDE; 2] };
            let image = numbered(subject, shape, format, size)?;
            let all = shape == GlShape::Flat && format == GlFormat::Rgba32F;
            for by in GlSampledBy::ALL.into_iter().filter(|by| all || *by == GlSampledBy::Sampler) {
                let what = format!("{shape:?} {}{}", format.name(), by.suffix());
                findings.tally(what, stated_of(subject, &image, shader, name, by)?, "levels");
            }
            Ok(())
        });
    }
    Ok(())
}

fn stated_of(
    subject: &DriverUnderTest,
    image: &GlImage,
    shader: Shader,
    name: &str,
    by: GlSampledBy,
) -> Result<GradeTally, Error> {
    let lods: Vec<f32> = (-4..=28).map(|step| step as f32 * 0.25 + 0.03).collect();
    let inputs: Vec<_> = lods.iter().map(|&lod| [0.5, 0.5, 0.0, lod]).collect();
    let bounds = [
        ([0.5, 3.5], Some([1, 4])),
        ([-1000.0, 1000.0], None),
        ([1.25, 1000.0], None),
        ([-1000.0, 2.75], None),
        ([-1000.0, 1000.0], Some([2, 5])),
        ([-1000.0, 1000.0], Some([0, 3])),
        ([2.0, 2.0], None),
    ];
    // What bounds do is no question of the format.
    let all = image.shape == GlShape::Flat && image.format == GlFormat::Rgba32F;
    let bounds = if all { &bounds[..] } else { &bounds[..2] };
    let mut tally = GradeTally::default();
    for &(lod, levels) in bounds {
        for mipmap in [GlMipmap::Off, GlMipmap::Nearest, GlMipmap::Linear] {
            for &linear in if all { &[false, true][..] } else { &[true] } {
                let sampling = Sampling { linear, mipmap, lod, levels, by, ..Sampling::NEAREST };
                let values = subject.bench.map_by(shader, &inputs, &[(name, image, sampling)])?;
                let [base, most] = levels.unwrap_or([0, LEVELS - 1]).map(f64::from);
                for (&stated, value) in lods.iter().zip(values) {
                    let lambda = base + f64::from(stated).clamp(f64::from(lod[0]), f64::from(lod[1]));
                    let seen = level_in(image.format, value[0]);
                    // A depth of 16 bits is good to 2^-14 of a level, a code of 8 bits to 2^-3 of 32.
                    let (grade, off) = match mipmap {
                        GlMipmap::Off => one_of(seen, [base; 3]),
                        GlMipmap::Nearest => {
                            let near = [-1.0, 0.0, 1.0].map(|slack| nearest_level(lambda + slack / 64.0, base, most));
                            one_of(seen, near)
                        }
                        GlMipmap::Linear => blended_level(seen, [lambda; 3], [base, most]),
                    };
                    tally.add(grade, off);
                }
            }
        }
    }
    Ok(tally)
}

/// ceil(lambda + 1/2) - 1, within what there is [GL 4.6, equation 8.15].
fn nearest_level(lambda: f64, base: f64, most: f64) -> f64 {
    ((lambda + 0.5).ceil() - 1.0).clamp(base, most)
}

fn one_of(seen: f64, due: [f64; 3]) -> (Grade, f64) {
    let off = due.into_iter().map(|due| (seen - due).abs()).fold(f64::MAX, f64::min);
    (verify::within(off, 1.0 / 512.0, 1.0 / 512.0), off)
}

/// Pixels along a side of a cell, which has derivatives of its own.
const PIXELS: u32 = 8;

const IMPLICIT: Shader = Shader::of("result = vec4(texture(map, passed.xy).r);");
/// A lookup before a discard that no fragment takes.
const TESTED: Shader = Shader::of("result = vec4(texture(map, passed.xy).r); if (result.r < -1e30) discard;");
/// A quarter of a texel off the middle of a texel, where the coordinate is whole.
const OFF_MIDDLE: Shader =
    Shader::of("vec2 slope = dFdx(passed.xy); result = vec4(textureGrad(map, vec2(0.38), slope, dFdy(passed.xy)).r);");
const BIASED: Shader = Shader::of("result = vec4(texture(map, passed.xy, 1.5).r);");
const PROJECTED: Shader = Shader::of("result = vec4(textureProj(map, vec3(passed.xy * 3.0, 3.0)).r);");
const GRADIENT: Shader = Shader::of("result = vec4(textureGrad(map, vec2(0.4), dFdx(passed.xy), dFdy(passed.xy)).r);");
const GRADIENT_OF_FOUR: Shader =
    Shader::of("result = vec4(textureGrad(map, passed.xy, 4.0 * dFdx(passed.xy), 4.0 * dFdy(passed.xy)).r);");

/// GL-L2: a level from derivatives, with biases and bounds.
pub fn derived(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let slopes = slopes();
    let surface = subject.bench.surface([PIXELS * slopes.len() as u32, PIXELS], Some(GlFormat::Rgba32F), None)?;
    let cases: [(&str, Shader, f64, Sampling); 10] = [
        ("texture", IMPLICIT, 0.0, Sampling::TRILINEAR),
        ("texture, then a discard", TESTED, 0.0, Sampling::TRILINEAR),
        ("texture with a bias", BIASED, 1.5, Sampling::TRILINEAR),
        ("textureProj", PROJECTED, 0.0, Sampling::TRILINEAR),
        ("textureGrad", GRADIENT, 0.0, Sampling::TRILINEAR),
        ("textureGrad, four times", GRADIENT_OF_FOUR, 2.0, Sampling::TRILINEAR),
        ("TEXTURE_LOD_BIAS", IMPLICIT, -0.75, Sampling { bias: -0.75, ..Sampling::TRILINEAR }),
        ("both biases", BIASED, 2.0, Sampling { bias: 0.5, ..Sampling::TRILINEAR }),
        ("bounds of levels", IMPLICIT, 0.0, Sampling { lod: [0.5, 2.25], ..Sampling::TRILINEAR }),
        ("BASE_LEVEL and MAX_LEVEL", IMPLICIT, 0.0, Sampling { levels: Some([1, 3]), ..Sampling::TRILINEAR }),
    ];
    for size in [[SIDE, SIDE], [SIDE, SIDE / 4], [SIDE / 4, SIDE]] {
        let image = numbered(subject, GlShape::Flat, GlFormat::Rgba32F, size)?;
        for (name, shader, bias, sampling) in cases {
            for by in GlSampledBy::ALL {
                let sampling = Sampling { by, wrap: [GlWrap::Repeat; 3], ..sampling };
                let [base, most] = sampling.levels.unwrap_or([0, LEVELS - 1]).map(f64::from);
                let mut tally = GradeTally::default();
                let values = drawn_with(subject, &surface, shader, (&image, sampling), &slopes)?;
                for (along, value) in slopes.iter().zip(values) {
                    // Slopes are in texels of level 0; lambda counts from the base level, whose texels are larger.
                    let lambda = level_of(*along).map(|level| {
                        let clamped =
                            (level - base + bias).clamp(f64::from(sampling.lod[0]), f64::from(sampling.lod[1]));
                        base + clamped
                    });
                    let (grade, off) = blended_level(level_in(image.format, value), lambda, [base, most]);
                    tally.add(grade, off);
                }
                let [width, height] = size;
                findings.tally(format!("{width} x {height}, {name}{}", by.suffix()), tally, "levels");
            }
        }
    }
    let one = subject.bench.surface([PIXELS; 2], Some(GlFormat::Rgba32F), None)?;
    findings.part(|findings| filters(subject, findings, &one));
    Ok(())
}

/// Derivatives along x and y, in texels: along the axes, of unequal lengths, turned.
fn slopes() -> Vec<[[f64; 2]; 2]> {
    let lengths = (-1..=9).map(|step| (f64::from(step) * 0.5 + 0.1).exp2());
    let mut slopes: Vec<_> = lengths.map(|length| [[length, 0.0], [0.0, length]]).collect();
    for length in [2.0, 5.0] {
        slopes.push([[length, 0.0], [0.0, 0.25 * length]]);
        slopes.push([[0.25 * length, 0.0], [0.0, length]]);
        slopes.push([[0.0, length], [-length, 0.0]]);
        slopes.push([[0.8 * length, 0.6 * length], [-0.6 * length, 0.8 * length]]);
    }
    slopes
}

/// Draws a cell for each pair of derivatives: texture coordinates change by so many texels a pixel. What a pixel in the middle
/// of each has.
fn drawn_with(
    subject: &DriverUnderTest,
    surface: &Surface,
    shader: Shader,
    (image, sampling): (&GlImage, Sampling),
    slopes: &[[[f64; 2]; 2]],
) -> Result<Vec<f32>, Error> {
    let mut vertices = Vec::new();
    for (cell, along) in slopes.iter().enumerate() {
        let [left, right] = [cell, cell + 1].map(|edge| edge as f32 * 2.0 / slopes.len() as f32 - 1.0);
        for vertex in rectangle([left, -1.0], [right, 1.0], 0.0, [0.0; 4]) {
            let half = f64::from(PIXELS) / 2.0;
            let x = if vertex.position[0] == left { -half } else { half };
            let y = f64::from(vertex.position[1]) * half;
            let at = |axis: usize| ((along[0][axis] * x + along[1][axis] * y) / f64::from(image.size[axis])) as f32;
            vertices.push(Vertex { value: [at(0), at(1), 0.0, 1.0], ..vertex });
        }
    }
    let state = GlState { depth: None, ..GlState::WRITE };
    let images = [("map", image, sampling)];
    subject.bench.draw(&GlDraw { shader, images: &images, ..GlDraw::plain(surface, state, &vertices) })?;
    let middle = surface.floats().into_iter().skip((PIXELS / 2 * surface.size[0]) as usize);
    Ok(middle.skip(PIXELS as usize / 2).step_by(PIXELS as usize).map(|color| color[0]).take(slopes.len()).collect())
}

/// The filter where a texture is magnified, and where it is not.
fn filters(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    const TEXELS: [[f32; 4]; 4] = [[0.0; 4], [1.0; 4], [1.0; 4], [0.0; 4]];
    let image = subject.bench.float_image([2, 2], &TEXELS)?;
    for by in GlSampledBy::ALL {
        let (mut worst, mut wrong) = (Grade::Good, Vec::new());
        for (linear, magnified, mipmap, step) in [
            (false, true, GlMipmap::Off, -1.0),
            (false, true, GlMipmap::Off, 1.0),
            (true, false, GlMipmap::Off, -1.0),
            (true, false, GlMipmap::Off, 1.0),
            // From NEAREST by levels to LINEAR the change is at half a level.
            (false, true, GlMipmap::Nearest, 0.25),
            (false, true, GlMipmap::Nearest, 0.75),
            (false, true, GlMipmap::Linear, 0.25),
            (false, true, GlMipmap::Linear, 0.75),
        ] {
            let wrap = [GlWrap::Repeat; 3];
            let sampling = Sampling { linear, magnified: Some(magnified), mipmap, wrap, by, ..Sampling::NEAREST };
            let slope = f64::exp2(step);
            let values = drawn_with(subject, surface, OFF_MIDDLE, (&image, sampling), &[[[slope, 0.0], [0.0, slope]]])?;
            let is_linear = values[0] > 0.02 && values[0] < 0.98;
            let half = if mipmap == GlMipmap::Off { 0.0 } else { 0.5 };
            if is_linear != if step <= half { magnified } else { linear } {
                // lambda may be greater by one than ideal.
                worst = worst.max(if step <= half && step + 1.0 > half { Grade::Allowed } else { Grade::Wrong });
                wrong.push(format!("{mipmap:?} at level {step}"));
            }
        }
        let measured = if wrong.is_empty() { "all right".to_owned() } else { wrong.join(", ") };
        findings.grade(format!("filters of magnified and minified{}", by.suffix()), worst, measured);
    }
    Ok(())
}
