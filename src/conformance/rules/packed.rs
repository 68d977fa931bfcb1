//! GL-C11 to GL-C13: packed depth and stencil that a shader reads, DEPTH_TEXTURE_MODE of depths that are not compared, and
//! textureGather with comparison [GL 4.6, 8.19, 8.23.1; compatibility 8.23.1; GLSL 4.60, 8.9.4].

use super::fixed;
use crate::conformance::bench::fixed_function::{DepthMode, FixedDraw};
use crate::conformance::bench::{
    Error, GlCompare, GlFormat, GlImage, GlImageDesc, GlSampledBy, GlState, GlSwizzle, Sampling, Shader, Vertex, full,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 4;

/// Random depths, among them 0 and 1, with stencil values; bytes as they are uploaded.
fn random_texels(random: &mut Random, format: GlFormat) -> (Vec<u8>, Vec<(f64, u8)>) {
    let (mut bytes, mut texels) = (Vec::new(), Vec::new());
    for index in 0..SIDE * SIDE {
        let depth = match index % 4 {
            0 => 0.0,
            1 => 1.0,
            _ => random.unit(),
        };
        let stencil = (random.unit() * 256.0) as u8;
        if format == GlFormat::Depth24Stencil8 {
            let code = (f64::from(depth) * 16_777_215.0).round() as u32;
            bytes.extend((code << 8 | u32::from(stencil)).to_ne_bytes());
            texels.push((f64::from(code) / 16_777_215.0, stencil));
        } else {
            bytes.extend(depth.to_ne_bytes());
            bytes.extend(u32::from(stencil).to_ne_bytes());
            texels.push((f64::from(depth), stencil));
        }
    }
    (bytes, texels)
}

const BOTH: Shader = Shader {
    declarations: "uniform sampler2DShadow compared;",
    ..Shader::of(
        "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0);
        result = vec4(texture(compared, at.xyz), texture(map, at.xy).r, 0.0, 1.0);",
    )
};
const STENCIL: Shader = Shader {
    declarations: "uniform usampler2D stencil;",
    ..Shader::of("result = vec4(texture(stencil, texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).xy).r);")
};

/// Middles of texels, with references.
fn inputs(references: &[f32]) -> Vec<[f32; 4]> {
    let middle = |at: u32| (at as f32 + 0.5) / SIDE as f32;
    (0..SIDE * SIDE)
        .flat_map(|index| {
            references.iter().map(move |&z| [middle(index % SIDE), middle(index / SIDE), z, index as f32])
        })
        .collect()
}

/// GL-C11: the depth of a packed texture, compared or not, and its stencil.
pub fn packed(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in [GlFormat::Depth24Stencil8, GlFormat::Depth32FStencil8] {
        findings.part(|findings| {
            let (bytes, texels) = random_texels(&mut Random::new(501), format);
            let image = subject.bench.filled(GlImageDesc::flat(format, [SIDE; 2]), |_, _| bytes.clone())?;
            for by in GlSampledBy::ALL {
                compared(subject, findings, &image, &texels, by)?;
            }
            let name = format!("{}: stencil", format.name());
            if !subject.bench.reads_stencil() {
                findings.untestable(name, "neither OpenGL 4.3 nor ARB_stencil_texturing");
                return Ok(());
            }
            let inputs = inputs(&[0.0]);
            let sampling = Sampling { stencil: true, ..Sampling::NEAREST };
            let seen = subject.bench.map_by(STENCIL, &inputs, &[("stencil", &image, sampling)])?;
            let wrong = seen.iter().zip(&texels).filter(|(seen, texel)| seen[0] != f32::from(texel.1));
            findings.none_wrong(name, wrong.count(), texels.len());
            Ok(())
        });
    }
    Ok(())
}

/// The texture twice: with a comparison by a sampler object, and as it is.
fn compared(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    image: &GlImage,
    texels: &[(f64, u8)],
    by: GlSampledBy,
) -> Result<(), Error> {
    let references = [0.0, 0.3, 0.7, 1.0];
    let inputs = inputs(&references);
    let (mut wrong, mut count, mut raw) = (0, 0, GradeTally::default());
    for compare in GlCompare::ALL {
        let first = Sampling { by: GlSampledBy::Sampler, ..Sampling::compare(compare) };
        let images = [("compared", image, first), ("map", image, Sampling { by, ..Sampling::NEAREST })];
        for (input, seen) in inputs.iter().zip(subject.bench.map_by(BOTH, &inputs, &images)?) {
            let (depth, _) = texels[input[3] as usize];
            let reference = f64::from(input[2]);
            let off = f64::from(seen[1]) - depth;
            raw.add(verify::within(off, f64::from(-24).exp2(), f64::from(-22).exp2()), off);
            // A tie is sure at 0 and 1 alone.
            if (reference - depth).abs() > verify::NEAR_TIE || depth == 0.0 || depth == 1.0 {
                wrong += usize::from(seen[0] != f32::from(u8::from(compare.holds(reference.total_cmp(&depth)))));
                count += 1;
            }
        }
    }
    let name = image.format.name();
    let other = if by == GlSampledBy::Sampler { "another" } else { "none" };
    findings.none_wrong(format!("{name}: compared, beside {other} sampler object"), wrong, count);
    findings.tally(format!("{name}: depth as it is{}", by.suffix()), raw, "");
    Ok(())
}

const PASS_ON: &str = "#version 120
void main() { gl_TexCoord[0] = gl_MultiTexCoord0; gl_Position = ftransform(); }";
const RAW: &str = "#version 120
uniform sampler2D map;
void main() { gl_FragColor = texture2D(map, gl_TexCoord[0].st); }";

/// GL-C12: a depth that is not compared becomes luminance, intensity, alpha or red, and is swizzled after that.
pub fn raw_mode(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    use GlSwizzle::{Alpha, Blue, Green, One, Red, Zero};
    let Some(fixed) = fixed::pipeline(subject, findings, "DEPTH_TEXTURE_MODE") else { return Ok(()) };
    let surface = subject.bench.surface([4, 4], Some(GlFormat::Rgba8), None)?;
    let state = GlState { depth: None, ..GlState::WRITE };
    let color = [0.5, 0.6, 0.7, 0.8];
    const DEPTH: f32 = 0.25;
    let vertices = full(0.0).map(|vertex| Vertex { value: [0.5, 0.5, 0.0, 1.0], ..vertex });
    for format in [GlFormat::Depth24, GlFormat::Depth32F] {
        let image = subject.bench.depth_image(format, [1, 1], &[&[DEPTH]])?;
        for (mode, replaced, sampled) in [
            (DepthMode::Luminance, [DEPTH, DEPTH, DEPTH, color[3]], [DEPTH, DEPTH, DEPTH, 1.0]),
            (DepthMode::Intensity, [DEPTH; 4], [DEPTH; 4]),
            (DepthMode::Alpha, [color[0], color[1], color[2], DEPTH], [0.0, 0.0, 0.0, DEPTH]),
            (DepthMode::Red, [DEPTH, 0.0, 0.0, color[3]], [DEPTH, 0.0, 0.0, 1.0]),
        ] {
            let draw = |swizzle, shaders| {
                let sampling = Sampling { swizzle, ..Sampling::NEAREST };
                let image = Some((&image, sampling, mode));
                let draw = FixedDraw { image, color, shaders, ..FixedDraw::plain(&surface, state, &vertices) };
                fixed.draw(&subject.bench, &draw)?;
                Ok::<_, Error>(surface.colors()[5])
            };
            let graded = |seen: [u8; 4], due: [f32; 4]| {
                let grades = (0..4).map(|channel| verify::unorm8(seen[channel], f64::from(due[channel])));
                grades.max().unwrap_or(Grade::Wrong)
            };
            // The same texture compared just before: nothing of that is left.
            let image = Some((&image, Sampling::compare(GlCompare::Never), mode));
            fixed.draw(&subject.bench, &FixedDraw { image, color, ..FixedDraw::plain(&surface, state, &vertices) })?;
            let seen = draw(GlSwizzle::SAME, None)?;
            let name = format!("{}: {mode:?}, not compared", format.name());
            findings.grade(name, graded(seen, replaced), format!("{seen:?}; {replaced:?} is due"));
            let mut worst = (Grade::Good, String::from("all right"));
            for swizzle in [GlSwizzle::SAME, [Alpha, Red, One, Zero], [Green, Blue, Red, Alpha]] {
                let due = swizzle.map(|source| match source {
                    Red => sampled[0],
                    Green => sampled[1],
                    Blue => sampled[2],
                    Alpha => sampled[3],
                    Zero => 0.0,
                    One => 1.0,
                });
                let seen = draw(swizzle, Some([PASS_ON, RAW]))?;
                let grade = graded(seen, due);
                if grade > worst.0 {
                    worst = (grade, format!("{swizzle:?}: {seen:?}; {due:?} is due"));
                }
            }
            findings.grade(format!("{}: {mode:?}, swizzled", format.name()), worst.0, worst.1);
        }
    }
    Ok(())
}

const GATHER: Shader = Shader {
    version: "#version 400",
    ..Shader::of(
        "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = textureGather(shadow, at.xy, at.z);",
    )
};

/// GL-C13: four comparisons, from the texel above on the left against the clock.
pub fn gather(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    if !subject.bench.has((4, 0), "none") {
        findings.untestable("textureGather", "no OpenGL 4.0");
        return Ok(());
    }
    for format in GlFormat::PURE_DEPTHS {
        findings.part(|findings| {
            let mut random = Random::new(502);
            let depths: Vec<f32> =
                (0..16).map(|_| [0.125, 0.375, 0.625, 0.875][(random.unit() * 4.0) as usize % 4]).collect();
            let image = subject.bench.depth_image(format, [4, 4], &[&depths])?;
            let inputs: Vec<_> = (0..64_u32)
                .map(|index| {
                    let place = [index % 3, index / 3 % 3].map(|low| (low as f32 + 0.6 + 0.8 * random.unit()) / 4.0);
                    [place[0], place[1], [0.25, 0.5, 0.75][index as usize % 3], 0.0]
                })
                .collect();
            for by in GlSampledBy::ALL {
                let (mut wrong, mut count) = (0, 0);
                for compare in [GlCompare::LessEqual, GlCompare::Greater] {
                    let sampling = Sampling { by, ..Sampling::compare(compare) };
                    let seen = subject.bench.map_by(GATHER, &inputs, &[("shadow", &image, sampling)])?;
                    for (input, seen) in inputs.iter().zip(seen) {
                        let [x, y] = [0, 1].map(|axis| (input[axis] * 4.0 - 0.5).floor() as usize);
                        let due = [[0, 1], [1, 1], [1, 0], [0, 0]].map(|[dx, dy]| {
                            let stored = depths[(y + dy) * 4 + x + dx];
                            f32::from(u8::from(compare.holds(input[2].total_cmp(&stored))))
                        });
                        wrong += usize::from(seen != due);
                        count += 1;
                    }
                }
                findings.none_wrong(format!("{}: textureGather{}", format.name(), by.suffix()), wrong, count);
            }
            Ok(())
        });
    }
    Ok(())
}
