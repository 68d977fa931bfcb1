//! GL-C1 to GL-C5: comparison with depth textures [GL 4.6, 8.14, 8.23].

use crate::conformance::bench::{Error, GlCompare, GlFormat, GlImage, GlMipmap, GlSampledBy, GlWrap, Sampling};
use crate::conformance::verify::{self, GradeTally, NEAR_TIE};
use crate::conformance::{DriverUnderTest, Findings};

/// Reads `at.xy` against the reference `at.z`.
const COMPARE: &str = "result = vec4(compare(texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).xyz));";
/// The same at the level `at.w`.
const COMPARE_LEVEL: &str =
    "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(compare_lod(at.xyz, at.w));";
/// The depth itself.
const FETCH: &str = "result = vec4(texture(map, texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).xy).r);";

/// GL-C1: eight functions, references below, at and above stored depths.
pub fn function(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::PURE_DEPTHS {
        for by in GlSampledBy::ALL {
            findings.part(|findings| function_of(subject, findings, format, by));
        }
    }
    Ok(())
}

fn function_of(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    format: GlFormat,
    by: GlSampledBy,
) -> Result<(), Error> {
    const STORED: [f32; 3] = [0.0, 0.5, 1.0];
    const REFERENCES: [f32; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
    let image = subject.bench.depth_image(format, [4, 1], &[&[STORED[0], STORED[1], STORED[2], 0.0]])?;
    let stored = subject.bench.image_depths(&image)?;
    let pairs: Vec<(usize, f32)> = (0..3).flat_map(|texel| REFERENCES.map(|reference| (texel, reference))).collect();
    let inputs: Vec<_> = pairs.iter().map(|&(texel, r)| [(texel as f32 + 0.5) / 4.0, 0.5, r, 0.0]).collect();
    let mut results = vec![[0.0_f32; 8]; pairs.len()];
    for (index, compare) in GlCompare::ALL.into_iter().enumerate() {
        let sampling = Sampling { by, ..Sampling::compare(compare) };
        let values = subject.bench.map(COMPARE, &inputs, &[("shadow", &image, sampling)])?;
        values.iter().zip(&mut results).for_each(|(value, results)| results[index] = value[0]);
    }
    let mut tally = GradeTally::default();
    for (&(texel, reference), results) in pairs.iter().zip(results) {
        let exact = image.encoding.float || texel != 1;
        let error = if exact { 0.0 } else { NEAR_TIE };
        tally.add(verify::comparisons(results, f64::from(reference), stored[texel], error), 0.0);
    }
    // A near tie may go either way; quality does not depend on it.
    tally.good += std::mem::take(&mut tally.allowed);
    findings.tally(format!("{}, 8 functions{}", format.name(), by.suffix()), tally, "");
    Ok(())
}

/// GL-C2: references beyond [0, 1], and uploads.
pub fn clamp(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::PURE_DEPTHS {
        let clamps = format != GlFormat::Depth32F;
        findings.part(|findings| {
            let image = subject.bench.depth_image(format, [2, 1], &[&[0.0, 1.0]])?;
            let ask = |texel: f32, reference: f32, compare| {
                let input = [(texel + 0.5) / 2.0, 0.5, reference, 0.0];
                let sampling = Sampling::compare(compare);
                Ok(subject.bench.map(COMPARE, &[input], &[("shadow", &image, sampling)])?[0][0])
            };
            let above = ask(1.0, 1.5, GlCompare::Equal)?;
            let below = ask(0.0, -0.5, GlCompare::GreaterEqual)?;
            let expected = f32::from(u8::from(clamps));
            let measured = format!("1.5 EQUAL 1 gives {above}, -0.5 GEQUAL 0 gives {below}; {expected} is due");
            let kind = if clamps { "is clamped" } else { "is not clamped" };
            findings.must_hold(
                format!("{}: the reference {kind}", format.name()),
                [above, below] == [expected; 2],
                measured,
            );
            let mut passing = Vec::new();
            for compare in GlCompare::ALL {
                if ask(1.0, f32::NAN, compare)? > 0.5 {
                    passing.push(format!("{compare:?}"));
                }
            }
            findings.fact(
                format!("{}: a reference that is no number, against 1, passes", format.name()),
                passing.join(", "),
            );
            Ok(())
        });
    }
    for format in GlFormat::PURE_DEPTHS {
        findings.part(|findings| {
            let image = subject.bench.depth_image(format, [2, 1], &[&[-0.5, 1.5]])?;
            let stored = subject.bench.image_depths(&image)?;
            let measured = format!("-0.5 and 1.5 are stored as {} and {}", stored[0], stored[1]);
            findings.must_hold(format!("{}: an upload is clamped", format.name()), stored == [0.0, 1.0], measured);
            Ok(())
        });
    }
    Ok(())
}

/// Weights along x and along y that are no simple fractions, and some that are.
const WEIGHTS: [f32; 9] = [0.0, 0.1, 0.2, 0.3, 0.5, 0.625, 0.7, 0.9, 1.0];

/// GL-C3: filtered comparison, as a verifier of texture filters sees it.
pub fn filtered(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::PURE_DEPTHS {
        for by in GlSampledBy::ALL {
            findings.part(|findings| filtered_of(subject, findings, format, by));
        }
    }
    findings.part(|findings| weight_bits(subject, findings));
    Ok(())
}

/// All sixteen outcomes of four comparisons, at every pair of weights. The depths are apart so far from each other that
/// filtering them first gives other results.
fn filtered_of(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    format: GlFormat,
    by: GlSampledBy,
) -> Result<(), Error> {
    let mut tally = GradeTally::default();
    let weights: Vec<[f32; 2]> = WEIGHTS.iter().flat_map(|&beta| WEIGHTS.map(|alpha| [alpha, beta])).collect();
    // Centres of texels (0, 0) and (1, 1) lie at 0.25 and 0.75.
    let inputs: Vec<_> = weights.iter().map(|[a, b]| [0.25 + a / 2.0, 0.25 + b / 2.0, 0.5, 0.0]).collect();
    for outcome in 0..16_u8 {
        let passes = [0, 1, 2, 3].map(|texel| outcome >> texel & 1 == 1);
        let depths = passes.map(|pass| if pass { 0.8 } else { 0.4 });
        let image = subject.bench.depth_image(format, [2, 2], &[&depths])?;
        let sampling = Sampling { by, ..Sampling::compare_linear(GlCompare::LessEqual) };
        let values = subject.bench.map(COMPARE, &inputs, &[("shadow", &image, sampling)])?;
        for ([alpha, beta], value) in weights.iter().zip(values) {
            let weights = [f64::from(*alpha), f64::from(*beta)];
            let value = f64::from(value[0]);
            let ideal = verify::bilinear(passes.map(|pass| f64::from(u8::from(pass))), weights[0], weights[1]);
            tally.add(verify::filtered(value, passes, weights), value - ideal);
        }
    }
    findings.tally(
        format!("{}, 16 outcomes of 2x2 texels{}", format.name(), by.suffix()),
        tally,
        "of the ideal weight",
    );
    Ok(())
}

/// Number of results between a texel that passes and one that fails.
fn weight_bits(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const STEPS: usize = 4096;
    let image = subject.bench.depth_image(GlFormat::Depth24, [2, 1], &[&[1.0, 0.0]])?;
    let alpha = |step: usize| step as f32 / STEPS as f32;
    let inputs: Vec<_> = (0..STEPS).map(|step| [0.25 + alpha(step) / 2.0, 0.5, 0.5, 0.0]).collect();
    let sampling = Sampling::compare_linear(GlCompare::LessEqual);
    let values = subject.bench.map(COMPARE, &inputs, &[("shadow", &image, sampling)])?;
    let mut codes: Vec<u32> = values.iter().map(|value| value[0].to_bits()).collect();
    codes.sort_unstable();
    codes.dedup();
    let bits = (codes.len() as f64).log2();
    let least = if codes.len() == STEPS { "at least " } else { "" };
    findings.fact("bits of a filter's weight, compared", format!("{least}{bits:.1}"));
    Ok(())
}

/// GL-C4: each level is compared, then levels are blended.
pub fn levels(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for (format, by) in GlFormat::PURE_DEPTHS.into_iter().flat_map(|format| GlSampledBy::ALL.map(|by| (format, by))) {
        findings.part(|findings| {
            let image = subject.bench.depth_image(format, [2, 2], &[&[1.0; 4], &[0.0]])?;
            let lods: Vec<f32> = (0..=16).map(|step| step as f32 / 16.0).collect();
            let inputs: Vec<_> = lods.iter().map(|&lod| [0.5, 0.5, 0.5, lod]).collect();
            let sampling = Sampling { mipmap: GlMipmap::Linear, by, ..Sampling::compare_linear(GlCompare::LessEqual) };
            let values = subject.bench.map(COMPARE_LEVEL, &inputs, &[("shadow", &image, sampling)])?;
            let mut tally = GradeTally::default();
            for (lod, value) in lods.iter().zip(values) {
                let off = f64::from(value[0]) - f64::from(1.0 - lod);
                tally.add(verify::within(off, 1.0 / 64.0 + 1.0 / 256.0, 1.0 / 16.0 + 1.0 / 256.0), off);
            }
            findings.tally(
                format!("{}, between two levels{}", format.name(), by.suffix()),
                tally,
                "of the level's weight",
            );
            Ok(())
        });
    }
    Ok(())
}

/// GL-C5: wrap modes and the border's depth.
pub fn border(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for (format, by) in GlFormat::PURE_DEPTHS.into_iter().flat_map(|format| GlSampledBy::ALL.map(|by| (format, by))) {
        findings.part(|findings| {
            let row = subject.bench.depth_image(format, [2, 1], &[&[0.25, 0.75]])?;
            let flat = subject.bench.depth_image(format, [2, 2], &[&[0.5; 4]])?;
            wraps(subject, findings, &row, by)?;
            borders(subject, findings, &flat, by)
        });
    }
    Ok(())
}

/// The second texel alone passes against 0.5.
fn wraps(subject: &DriverUnderTest, findings: &mut Findings, row: &GlImage, by: GlSampledBy) -> Result<(), Error> {
    let cases = [
        (GlWrap::Repeat, [(1.25, 0.0), (1.75, 1.0), (-0.25, 1.0), (-0.75, 0.0)]),
        (GlWrap::MirroredRepeat, [(1.25, 1.0), (1.75, 0.0), (-0.25, 0.0), (-0.75, 1.0)]),
        (GlWrap::ClampToEdge, [(1.25, 1.0), (9.0, 1.0), (-0.25, 0.0), (-9.0, 0.0)]),
    ];
    let (mut wrong, mut count) = (0, 0);
    for (wrap, expected) in cases {
        let sampling = Sampling { wrap: [wrap; 3], by, ..Sampling::compare(GlCompare::LessEqual) };
        let inputs = expected.map(|(s, _)| [s, 0.5, 0.5, 0.0]);
        let values = subject.bench.map(COMPARE, &inputs, &[("shadow", row, sampling)])?;
        wrong += values.iter().zip(expected).filter(|(value, (_, expected))| value[0] != *expected).count();
        count += expected.len();
    }
    findings.none_wrong(format!("{}: repeat, mirror, edge{}", row.format.name(), by.suffix()), wrong, count);
    Ok(())
}

/// Inside 0.75 fails against 0.5; the border's depth is the first component, 1, and passes.
fn borders(subject: &DriverUnderTest, findings: &mut Findings, flat: &GlImage, by: GlSampledBy) -> Result<(), Error> {
    let mut cases = vec![
        ("CLAMP_TO_BORDER", false, GlWrap::ClampToBorder, -0.25, 1.0),
        ("CLAMP_TO_BORDER inside", false, GlWrap::ClampToBorder, 0.25, 0.0),
        ("CLAMP_TO_BORDER, LINEAR at the edge", true, GlWrap::ClampToBorder, 0.0, 0.5),
    ];
    if subject.bench.is_compatible() {
        cases.push(("CLAMP, LINEAR", true, GlWrap::Clamp, -0.25, 0.5));
        cases.push(("CLAMP, NEAREST", false, GlWrap::Clamp, -0.25, 0.0));
    } else {
        findings.untestable(format!("CLAMP{}", by.suffix()), "a core context has no GL_CLAMP");
    }
    for (name, linear, wrap, s, expected) in cases {
        let compare = Sampling::compare(GlCompare::LessEqual);
        let sampling = Sampling { wrap: [wrap; 3], linear, border: [1.0, 0.0, 0.0, 0.0], by, ..compare };
        let value = subject.bench.map(COMPARE, &[[s, 0.5, 0.75, 0.0]], &[("shadow", flat, sampling)])?[0][0];
        let grade = verify::within(f64::from(value) - expected, 1.0 / 64.0, 1.0 / 8.0);
        // A nearest texel's result is never 'about right' here.
        let grade = if linear { grade } else { grade.max(verify::within(f64::from(value) - expected, 0.0, 0.0)) };
        findings.grade(
            format!("{}: {name}{}", flat.format.name(), by.suffix()),
            grade,
            format!("{value}; {expected} is due"),
        );
    }
    Ok(())
}

/// Compares depths that a shader reads with the stored ones: used by GL-D1.
pub(super) fn fetched(subject: &DriverUnderTest, image: &GlImage) -> Result<GradeTally, Error> {
    let stored = subject.bench.image_depths(image)?;
    let width = image.size[0] as usize;
    let centre = |texel: usize| {
        let [x, y] = [texel % width, texel / width].map(|place| place as f32 + 0.5);
        [x / image.size[0] as f32, y / image.size[1] as f32, 0.0, 0.0]
    };
    let inputs: Vec<_> = (0..stored.len()).map(centre).collect();
    let values = subject.bench.map(FETCH, &inputs, &[("map", image, Sampling::NEAREST)])?;
    let mut tally = GradeTally::default();
    for (value, stored) in values.iter().zip(stored) {
        // Two steps of a float: one of rounding, one of multiplying by a rounded reciprocal.
        let off = (f64::from(value[0]) - stored).abs() * 2f64.powi(24);
        let grade = if image.encoding.float { verify::within(off, 0.0, 0.0) } else { verify::within(off, 1.01, 2.01) };
        tally.add(grade, off);
    }
    Ok(tally)
}
