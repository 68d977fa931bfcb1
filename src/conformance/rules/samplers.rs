//! GL-C7 and GL-C8: sampler objects beside and over a texture's parameters, and LINEAR for all eight comparisons [GL 4.6,
//! 8.2, 8.23.1].

use crate::conformance::bench::{
    Error, GlCompare, GlFormat, GlImage, GlImageDesc, GlMipmap, GlSampledBy, GlShape, GlWrap, Sampling, Shader,
};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const COMPARE: &str = "result = vec4(compare(texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).xyz));";

/// Three units with the same depths.
const THREE: Shader = Shader {
    declarations: "uniform sampler2DShadow first; uniform sampler2DShadow second; uniform sampler2DShadow third;",
    ..Shader::of(
        "vec3 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).xyz;
        result = vec4(texture(first, at), texture(second, at), texture(third, at), 1.0);",
    )
};

/// A colour and a comparison of the same depths.
const RAW_AND_COMPARED: Shader = Shader {
    declarations: "uniform sampler2D raw; uniform sampler2DShadow compared;",
    ..Shader::of(
        "vec3 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).xyz;
        result = vec4(texture(raw, at.xy).r, texture(compared, at), 0.0, 1.0);",
    )
};

/// GL-C7: a bound sampler object's parameters are in force, unit by unit; without one the texture's own.
pub fn objects(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::PURE_DEPTHS {
        findings.part(|findings| units(subject, findings, format));
    }
    findings.part(|findings| in_turn(subject, findings));
    findings.part(|findings| colors(subject, findings));
    findings.part(|findings| shapes(subject, findings));
    findings.part(|findings| all_units(subject, findings));
    Ok(())
}

const FOUR: Shader = Shader {
    declarations: "uniform sampler1D line; uniform sampler2DArray layers;",
    ..Shader::of(
        "result = vec4(texture(map, vec2(0.5)).r, texture(cube, vec3(0.1, 0.2, -1.0)).r, texture(line, 0.5).r,
            texture(layers, vec3(0.5, 0.5, 1.0)).r);",
    )
};

/// Textures of four shapes on four units, by turns: each is bound where it should be.
fn shapes(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let one = |shape, layers, value: u8| {
        let desc = GlImageDesc { shape, layers, ..GlImageDesc::flat(GlFormat::Rgba8, [1, 1]) };
        subject.bench.filled(desc, |_, _| vec![value; 4])
    };
    let images = [
        ("map", one(GlShape::Flat, 1, 50)?),
        ("cube", one(GlShape::Cube, 6, 100)?),
        ("line", one(GlShape::Line, 1, 150)?),
        ("layers", one(GlShape::Array, 2, 200)?),
    ];
    let (mut wrong, mut count) = (0, 0);
    for turn in 0..8 {
        let by = GlSampledBy::ALL[turn % 2];
        let sampling = Sampling { by, ..Sampling::NEAREST };
        let mut bound: Vec<_> = images.iter().map(|(name, image)| (*name, image, sampling)).collect();
        bound.rotate_left(turn / 2);
        let seen = subject.bench.map_by(FOUR, &[[0.0; 4]], &bound)?[0].map(|value| (value * 255.0).round() as u8);
        wrong += usize::from(seen != [50, 100, 150, 200]);
        count += 1;
    }
    findings.none_wrong("1D, 2D, cube and array on four units by turns", wrong, count);
    Ok(())
}

/// Sixteen units, the least that a fragment shader has: fifteen textures beside the inputs'.
fn all_units(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const UNITS: [&str; 15] = [
        "units[0]",
        "units[1]",
        "units[2]",
        "units[3]",
        "units[4]",
        "units[5]",
        "units[6]",
        "units[7]",
        "units[8]",
        "units[9]",
        "units[10]",
        "units[11]",
        "units[12]",
        "units[13]",
        "units[14]",
    ];
    const SHADER: Shader = Shader {
        declarations: "uniform sampler2D units[15];\n#define AT(k) texture(units[k], vec2(0.4, 0.5)).r",
        ..Shader::of(
            "float four = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).x;
            result = four < 0.5 ? vec4(AT(0), AT(1), AT(2), AT(3)) : four < 1.5 ? vec4(AT(4), AT(5), AT(6), AT(7))
                : four < 2.5 ? vec4(AT(8), AT(9), AT(10), AT(11)) : vec4(AT(12), AT(13), AT(14), 1.0);",
        )
    };
    let value = |unit: usize| (unit as f32 + 1.0) / 16.0;
    let image = |unit| subject.bench.float_image([2, 1], &[[value(unit); 4], [1.0 - value(unit); 4]]);
    let images = (0..UNITS.len()).map(image).collect::<Result<Vec<_>, _>>()?;
    let inputs = [0.0, 1.0, 2.0, 3.0].map(|four| [four; 4]);
    for (by, linear) in GlSampledBy::ALL.into_iter().flat_map(|by| [(by, false), (by, true)]) {
        let sampling = Sampling { by, linear, ..Sampling::NEAREST };
        let bound: Vec<_> = UNITS.into_iter().zip(&images).map(|(name, image)| (name, image, sampling)).collect();
        let seen = subject.bench.map_by(SHADER, &inputs, &bound)?;
        let wrong = (0..UNITS.len()).filter(|unit| {
            // 0.3 of the way to the second texel.
            let due = if linear { 0.7 * value(*unit) + 0.3 * (1.0 - value(*unit)) } else { value(*unit) };
            (seen[unit / 4][unit % 4] - due).abs() > 1.0 / 64.0
        });
        let filter = if linear { "LINEAR" } else { "NEAREST" };
        findings.none_wrong(
            format!("15 textures on as many units, {filter}{}", by.suffix()),
            wrong.count(),
            UNITS.len(),
        );
    }
    Ok(())
}

/// The texture on three units: two sampler objects, and its own parameters on the last.
fn units(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    const STORED: [f32; 4] = [0.25, 0.75, 0.75, 0.25];
    let image = subject.bench.depth_image(format, [4, 1], &[&STORED])?;
    let inputs: Vec<_> = (0..4)
        .flat_map(|texel| [0.0, 0.5, 1.0].map(|reference| [(texel as f32 + 0.5) / 4.0, 0.5, reference, 0.0]))
        .collect();
    let (mut wrong, mut count) = (0, 0);
    for functions in [
        [GlCompare::LessEqual, GlCompare::Greater, GlCompare::Always],
        [GlCompare::GreaterEqual, GlCompare::Less, GlCompare::LessEqual],
        [GlCompare::Never, GlCompare::LessEqual, GlCompare::Greater],
    ] {
        let sampling = |unit: usize| {
            let by = if unit < 2 { GlSampledBy::Sampler } else { GlSampledBy::Texture };
            Sampling { by, ..Sampling::compare(functions[unit]) }
        };
        let images = [("first", &image, sampling(0)), ("second", &image, sampling(1)), ("third", &image, sampling(2))];
        let values = subject.bench.map_by(THREE, &inputs, &images)?;
        for (input, value) in inputs.iter().zip(values) {
            let stored = STORED[(input[0] * 4.0) as usize];
            let due = functions.map(|function| f32::from(u8::from(function.holds(input[2].total_cmp(&stored)))));
            wrong += usize::from(value[..3] != due);
            count += 1;
        }
    }
    findings.none_wrong(format!("{}: two sampler objects and the texture's parameters", format.name()), wrong, count);
    let raw = Sampling { by: GlSampledBy::Sampler, ..Sampling::NEAREST };
    let images = [("raw", &image, raw), ("compared", &image, Sampling::compare(GlCompare::LessEqual))];
    let values = subject.bench.map_by(RAW_AND_COMPARED, &inputs, &images)?;
    let wrong = inputs.iter().zip(values).filter(|(input, value)| {
        let stored = STORED[(input[0] * 4.0) as usize];
        // Two codes of 16 bits.
        (value[0] - stored).abs() > 2.0 / 65535.0 || value[1] != f32::from(u8::from(input[2] <= stored))
    });
    findings.none_wrong(format!("{}: not compared beside compared", format.name()), wrong.count(), inputs.len());
    Ok(())
}

/// Objects and parameters by turns on one unit: nothing is left of the draw before.
fn in_turn(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let image = subject.bench.depth_image(GlFormat::Depth24, [1, 1], &[&[0.5]])?;
    let inputs = [0.25, 0.75].map(|reference| [0.5, 0.5, reference, 0.0]);
    let (mut wrong, mut count) = (0, 0);
    for turn in 0..16_usize {
        let by = GlSampledBy::ALL[turn % 2];
        let function = GlCompare::ALL[(turn * 5 + turn / 8) % 8];
        let sampling = Sampling { by, ..Sampling::compare(function) };
        let values = subject.bench.map(COMPARE, &inputs, &[("shadow", &image, sampling)])?;
        for (input, value) in inputs.iter().zip(values) {
            wrong += usize::from(value[0] != f32::from(u8::from(function.holds(input[2].total_cmp(&0.5)))));
            count += 1;
        }
    }
    findings.none_wrong("sampler objects and the texture's parameters by turns", wrong, count);
    Ok(())
}

/// Parameters that colours have: each alone differs from what the texture says. Without an object the texture's are in force.
fn colors(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let desc = GlImageDesc { shape: GlShape::Flat, levels: 2, ..GlImageDesc::flat(GlFormat::Rgba32F, [2, 2]) };
    let texel = |value: f32| [value; 4];
    let levels = [vec![texel(0.0), texel(0.25), texel(0.5), texel(1.0)], vec![texel(0.75)]];
    let image = subject.bench.filled(desc, |level, _| bytemuck::cast_slice(&levels[level as usize]).to_vec())?;
    for by in GlSampledBy::ALL {
        colors_by(subject, findings, &image, by)?;
    }
    Ok(())
}

fn colors_by(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    image: &GlImage,
    by: GlSampledBy,
) -> Result<(), Error> {
    const FETCH: &str =
        "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = textureLod(map, at.xy, at.w);";
    let sampler = Sampling { by, ..Sampling::NEAREST };
    let linear = Sampling { linear: true, ..sampler };
    let wrapped = |s, t| Sampling { wrap: [s, t, GlWrap::ClampToEdge], border: [0.875; 4], ..sampler };
    let cases = [
        ("NEAREST", sampler, [0.3, 0.3, 0.0, 0.0], 0.0),
        ("LINEAR", linear, [0.5, 0.5, 0.0, 0.0], 0.4375),
        ("WRAP_S", wrapped(GlWrap::Repeat, GlWrap::ClampToEdge), [1.25, 1.75, 0.0, 0.0], 0.5),
        ("WRAP_T", wrapped(GlWrap::ClampToEdge, GlWrap::Repeat), [1.75, 1.25, 0.0, 0.0], 0.25),
        ("BORDER_COLOR", wrapped(GlWrap::ClampToBorder, GlWrap::ClampToEdge), [-0.25, 0.25, 0.0, 0.0], 0.875),
        ("levels", Sampling { mipmap: GlMipmap::Nearest, ..sampler }, [0.1, 0.1, 0.0, 1.0], 0.75),
        ("between levels", Sampling { mipmap: GlMipmap::Linear, ..sampler }, [0.1, 0.1, 0.0, 0.5], 0.375),
        ("LINEAR_MIPMAP_LINEAR", Sampling { mipmap: GlMipmap::Linear, ..linear }, [0.5, 0.5, 0.0, 0.5], 0.59375),
        ("LINEAR_MIPMAP_NEAREST", Sampling { mipmap: GlMipmap::Nearest, ..linear }, [0.5, 0.5, 0.0, 0.25], 0.4375),
        ("MIN_LOD", Sampling { mipmap: GlMipmap::Nearest, lod: [1.0, 9.0], ..sampler }, [0.1, 0.1, 0.0, 0.0], 0.75),
        ("MAX_LOD", Sampling { mipmap: GlMipmap::Nearest, lod: [-9.0, 0.0], ..sampler }, [0.1, 0.1, 0.0, 1.0], 0.0),
    ];
    for (name, sampling, input, due) in cases {
        let value = subject.bench.map(FETCH, &[input], &[("map", image, sampling)])?[0][0];
        let off = f64::from(value) - due;
        // Positions and levels to 1/128 of differences of at most 1.
        let blends = name.contains("LINEAR") || name == "between levels";
        let grade = verify::within(off, if blends { 1.0 / 64.0 } else { 0.0 }, 0.0);
        let of = if by == GlSampledBy::Sampler { "a sampler object's" } else { "a texture's own" };
        findings.grade(format!("{of} {name}"), grade, format!("{value}; {due} is due"));
    }
    Ok(())
}

/// GL-C8: LINEAR by each of the eight functions.
pub fn linear(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::PURE_DEPTHS {
        for by in GlSampledBy::ALL {
            findings.part(|findings| {
                let image = subject.bench.depth_image(format, [2, 2], &[&STORED])?;
                let (mut blended, mut nearest) = (0, 0);
                for compare in GlCompare::ALL {
                    let tally =
                        linear_of(subject, &image, Sampling { by, ..Sampling::compare_linear(compare) }, compare)?;
                    let name = format!("{}, {compare:?}{}", format.name(), by.suffix());
                    // NEVER and ALWAYS are the same by any filter.
                    if !matches!(compare, GlCompare::Never | GlCompare::Always) {
                        *(if tally.allowed == 0 { &mut blended } else { &mut nearest }) += 1;
                    }
                    findings.tally(name, tally, "of the ideal weight");
                }
                // LINEAR may be coarse, but not for some functions alone: the filter is no question of the function.
                let what = format!("{}, one filter for all functions{}", format.name(), by.suffix());
                findings.must_hold(what, blended * nearest == 0, format!("{blended} blend, {nearest} do not"));
                Ok(())
            });
        }
    }
    Ok(())
}

/// 0 and 1 are exact in each format: EQUAL can tell.
const STORED: [f32; 4] = [0.0, 1.0, 0.0, 0.0];

fn linear_of(
    subject: &DriverUnderTest,
    image: &GlImage,
    sampling: Sampling,
    compare: GlCompare,
) -> Result<GradeTally, Error> {
    const WEIGHTS: [f32; 5] = [0.0, 0.2, 0.5, 0.7, 1.0];
    let places = WEIGHTS.iter().flat_map(|&beta| WEIGHTS.map(|alpha| [alpha, beta]));
    let inputs: Vec<_> = places
        .flat_map(|[alpha, beta]| [0.0, 0.5, 1.0].map(|z| [0.25 + alpha / 2.0, 0.25 + beta / 2.0, z, 0.0]))
        .collect();
    let values = subject.bench.map(COMPARE, &inputs, &[("shadow", image, sampling)])?;
    let mut tally = GradeTally::default();
    for (input, value) in inputs.iter().zip(values) {
        let passes = STORED.map(|stored| compare.holds(input[2].total_cmp(&stored)));
        let weights = [0, 1].map(|axis| f64::from((input[axis] - 0.25) * 2.0));
        let ideal = verify::bilinear(passes.map(|pass| f64::from(u8::from(pass))), weights[0], weights[1]);
        let value = f64::from(value[0]);
        tally.add(verify::filtered(value, passes, weights), value - ideal);
    }
    Ok(tally)
}
