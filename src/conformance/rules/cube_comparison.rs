//! GL-C9 and GL-C10: comparison in cube maps, in arrays and in arrays of cube maps [GL 4.6, 8.13, 8.14, 8.23.1].

use super::cube_maps::{Region, direction, places, vector};
use crate::conformance::bench::{
    Error, GlCompare, GlFormat, GlImage, GlImageDesc, GlSampledBy, GlShape, Sampling, Shader,
};
use crate::conformance::random::Random;
use crate::conformance::verify::cube::Cube;
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const COMPARE: Shader = Shader {
    declarations: "uniform samplerCubeShadow cube_shadow;",
    ..Shader::of("result = vec4(texture(cube_shadow, texelFetch(inputs, ivec2(gl_FragCoord.xy), 0)));")
};

/// Exact in floats, and far from the references between them.
const STORED: [f32; 4] = [0.125, 0.375, 0.625, 0.875];
const REFERENCES: [f32; 3] = [0.25, 0.5, 0.75];

fn random_depths(random: &mut Random, side: u32) -> Vec<f32> {
    (0..side * side).map(|_| STORED[(random.unit() * 4.0) as usize % 4]).collect()
}

/// Faces of comparisons: 255 where one passes.
fn compared(faces: &[Vec<f32>], compare: GlCompare, reference: f32) -> [Vec<[u8; 4]>; 6] {
    let texel = |stored: &f32| if compare.holds(reference.total_cmp(stored)) { [255; 4] } else { [0; 4] };
    [0, 1, 2, 3, 4, 5].map(|face| faces[face].iter().map(texel).collect())
}

/// GL-C9: faces, edges and corners, with seams and without.
pub fn cubes(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut random = Random::new(91);
    for format in GlFormat::PURE_DEPTHS {
        for side in [2, 4] {
            let by = GlSampledBy::ALL[usize::from(side == 2)];
            findings.part(|findings| cube_of(subject, findings, &mut random, format, side, by));
        }
        let vectors = places(&mut random, Region::Inside, 2, 64);
        let places: Vec<_> = vectors.iter().map(|&[x, y, z, _]| [x, y, z]).collect();
        let images = (GlImageDesc::cube(format, 2), COMPARE, "cube_shadow");
        findings.part(|findings| close(subject, findings, "cube map", images, &places));
    }
    Ok(())
}

fn cube_of(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    random: &mut Random,
    format: GlFormat,
    side: u32,
    by: GlSampledBy,
) -> Result<(), Error> {
    let faces: Vec<Vec<f32>> = (0..6).map(|_| random_depths(random, side)).collect();
    let image = subject
        .bench
        .filled(GlImageDesc::cube(format, side), |_, layer| bytemuck::cast_slice(&faces[layer as usize]).to_vec())?;
    let name = format!("{}, {side} texels a side", format.name());
    // Each face by itself: none may stand for another.
    let mut wrong_faces = Vec::new();
    for (face, label) in ["+x", "-x", "+y", "-y", "+z", "-z"].into_iter().enumerate() {
        let vectors: Vec<_> = (0..64)
            .map(|_| {
                let place = [random.unit(), random.unit()];
                vector(random, face, place)
            })
            .collect();
        let tally = nearest(subject, &image, &faces, side, by, &vectors)?;
        if tally.wrong > 0 {
            wrong_faces.push(format!("{label} {} of {}", tally.wrong, tally.count()));
        }
    }
    let measured = if wrong_faces.is_empty() { "all right".to_owned() } else { wrong_faces.join(", ") + " wrong" };
    findings.must_hold(format!("{name}: NEAREST, face by face{}", by.suffix()), wrong_faces.is_empty(), measured);
    for seamless in [false, true] {
        let mode = if seamless { "seamless" } else { "each face alone" };
        for (region, place) in
            [(Region::Inside, "inside"), (Region::Edge, "at an edge"), (Region::Corner, "at a corner")]
        {
            let vectors = places(random, region, side, 192);
            let mut tally = GradeTally::default();
            for (compare, reference) in [GlCompare::LessEqual, GlCompare::Greater]
                .into_iter()
                .flat_map(|compare| REFERENCES.map(|reference| (compare, reference)))
            {
                let passing = compared(&faces, compare, reference);
                let cube = Cube { side, faces: &passing, seamless };
                let inputs: Vec<_> = vectors.iter().map(|&[x, y, z, _]| [x, y, z, reference]).collect();
                let sampling = Sampling { seamless, by, ..Sampling::compare_linear(compare) };
                let values = subject.bench.map_by(COMPARE, &inputs, &[("cube_shadow", &image, sampling)])?;
                for (vector, value) in vectors.iter().zip(values) {
                    tally.add(cube.compared(f64::from(value[0]), direction(*vector)), 0.0);
                }
            }
            findings.tally(format!("{name}: {mode}, {place}{}", by.suffix()), tally, "");
        }
    }
    Ok(())
}

/// NEAREST, all references, LEQUAL.
fn nearest(
    subject: &DriverUnderTest,
    image: &GlImage,
    faces: &[Vec<f32>],
    side: u32,
    by: GlSampledBy,
    vectors: &[[f32; 4]],
) -> Result<GradeTally, Error> {
    let mut tally = GradeTally::default();
    for reference in REFERENCES {
        let passing = compared(faces, GlCompare::LessEqual, reference);
        let cube = Cube { side, faces: &passing, seamless: true };
        let inputs: Vec<_> = vectors.iter().map(|&[x, y, z, _]| [x, y, z, reference]).collect();
        let sampling = Sampling { seamless: true, by, ..Sampling::compare(GlCompare::LessEqual) };
        let values = subject.bench.map_by(COMPARE, &inputs, &[("cube_shadow", image, sampling)])?;
        for (vector, value) in vectors.iter().zip(values) {
            tally.add(cube.nearest([f64::from(value[0]) * 255.0; 4], direction(*vector)), 0.0);
        }
    }
    Ok(tally)
}

/// References just before and behind the depth that all texels have: farther away than its storage rounds, nearer than 16 bits tell.
fn close(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    what: &str,
    (desc, shader, map): (GlImageDesc, Shader, &str),
    places: &[[f32; 3]],
) -> Result<(), Error> {
    const DEPTH: f32 = 0.625;
    let format = desc.format;
    let image = subject.bench.filled(desc, |_, _| bytemuck::cast_slice(&[DEPTH; 4]).to_vec())?;
    let power = if format == GlFormat::Depth16 { -15 } else { -21 };
    let sides = [-1.0, 1.0].map(|side: f32| side * (power as f32).exp2());
    let beside = |&[x, y, z]: &[f32; 3]| sides.map(|side| [x, y, z, DEPTH + side]);
    let inputs: Vec<[f32; 4]> = places.iter().flat_map(beside).collect();
    let mut tally = GradeTally::default();
    for compare in [GlCompare::LessEqual, GlCompare::Greater] {
        let values = subject.bench.map_by(shader, &inputs, &[(map, &image, Sampling::compare(compare))])?;
        for (input, value) in inputs.iter().zip(values) {
            let due = u8::from(compare.holds(input[3].total_cmp(&DEPTH)));
            tally.add(verify::within(f64::from(value[0]) - f64::from(due), 0.0, 0.0), 0.0);
        }
    }
    findings.tally(format!("{}: references 2^{power} beside the depth of a {what}", format.name()), tally, "");
    Ok(())
}

const ARRAY: Shader = Shader {
    declarations: "uniform sampler2DArrayShadow layers_shadow;",
    ..Shader::of("result = vec4(texture(layers_shadow, texelFetch(inputs, ivec2(gl_FragCoord.xy), 0)));")
};
const CUBE_ARRAY: Shader = Shader {
    version: "#version 150\n#extension GL_ARB_texture_cube_map_array : require",
    declarations: "uniform samplerCubeArrayShadow cubes_shadow;",
    ..Shader::of(
        "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0);
        float low = texture(cubes_shadow, at, 0.25), middle = texture(cubes_shadow, at, 0.5);
        result = vec4(low, middle, texture(cubes_shadow, at, 0.75), 1.0);",
    )
};

/// GL-C10: a layer is the nearest whole number of the third coordinate, or the fourth in an array of cube maps.
pub fn arrays(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in GlFormat::PURE_DEPTHS {
        findings.part(|findings| layers(subject, findings, format));
        let desc = GlImageDesc { shape: GlShape::Array, layers: 2, ..GlImageDesc::flat(format, [2, 2]) };
        let places = [[0.25, 0.25, 0.0], [0.75, 0.25, 1.0], [0.25, 0.75, 1.0], [0.75, 0.75, 0.0]];
        findings.part(|findings| close(subject, findings, "array", (desc, ARRAY, "layers_shadow"), &places));
    }
    if subject.bench.has((4, 0), "GL_ARB_texture_cube_map_array") {
        for format in GlFormat::PURE_DEPTHS {
            findings.part(|findings| cube_layers(subject, findings, format));
        }
    } else {
        findings.untestable("arrays of cube maps", "neither OpenGL 4.0 nor ARB_texture_cube_map_array");
    }
    Ok(())
}

fn layers(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    const LAYERS: u32 = 5;
    let mut random = Random::new(101);
    let texels: Vec<Vec<f32>> = (0..LAYERS).map(|_| random_depths(&mut random, 2)).collect();
    let desc = GlImageDesc { shape: GlShape::Array, layers: LAYERS, ..GlImageDesc::flat(format, [2, 2]) };
    let image = subject.bench.filled(desc, |_, layer| bytemuck::cast_slice(&texels[layer as usize]).to_vec())?;
    // Beside whole numbers, and beyond both ends.
    let places = [-1.0, 0.0, 0.4, 0.6, 1.0, 1.9, 3.2, 4.0, 7.0];
    let inputs: Vec<[f32; 4]> = (0..256)
        .map(|index| {
            let [alpha, beta] = [random.unit(), random.unit()];
            [0.25 + alpha / 2.0, 0.25 + beta / 2.0, places[index % places.len()], REFERENCES[index % 3]]
        })
        .collect();
    for (linear, compare) in [
        (false, GlCompare::LessEqual),
        (true, GlCompare::LessEqual),
        (false, GlCompare::Greater),
        (true, GlCompare::Greater),
    ] {
        let sampling = Sampling { linear, ..Sampling::compare(compare) };
        let values = subject.bench.map_by(ARRAY, &inputs, &[("layers_shadow", &image, sampling)])?;
        let mut tally = GradeTally::default();
        for ([s, t, layer, reference], value) in inputs.iter().copied().zip(values) {
            let texels = &texels[(layer + 0.5).floor().clamp(0.0, LAYERS as f32 - 1.0) as usize];
            let passes = [0, 1, 2, 3].map(|texel| compare.holds(reference.total_cmp(&texels[texel])));
            let weights = [s, t].map(|coordinate| f64::from((coordinate - 0.25) * 2.0));
            let value = f64::from(value[0]);
            let grade = match weights.map(|weight| (weight - 0.5).abs() < 0.01) {
                _ if linear => verify::filtered(value, passes, weights),
                [false, false] => {
                    let [x, y] = weights.map(|weight| usize::from(weight > 0.5));
                    verify::within(value - f64::from(u8::from(passes[2 * y + x])), 0.0, 0.0)
                }
                _ => Grade::Good,
            };
            tally.add(grade, 0.0);
        }
        let filter = if linear { "LINEAR" } else { "NEAREST" };
        let function = if compare == GlCompare::LessEqual { String::new() } else { format!(", {compare:?}") };
        findings.tally(format!("{}: layers of an array, {filter}{function}", format.name()), tally, "");
    }
    Ok(())
}

fn cube_layers(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    const CUBES: u32 = 3;
    let mut random = Random::new(102);
    let texels: Vec<Vec<f32>> = (0..6 * CUBES).map(|_| random_depths(&mut random, 2)).collect();
    let desc = GlImageDesc { shape: GlShape::CubeArray, layers: 6 * CUBES, ..GlImageDesc::cube(format, 2) };
    let image = subject.bench.filled(desc, |_, layer| bytemuck::cast_slice(&texels[layer as usize]).to_vec())?;
    let vectors = places(&mut random, Region::Inside, 2, 192);
    let inputs: Vec<_> =
        vectors.iter().enumerate().map(|(index, &[x, y, z, _])| [x, y, z, (index % CUBES as usize) as f32]).collect();
    let sampling = Sampling { seamless: true, ..Sampling::compare_linear(GlCompare::LessEqual) };
    let values = subject.bench.map_by(CUBE_ARRAY, &inputs, &[("cubes_shadow", &image, sampling)])?;
    let mut tally = GradeTally::default();
    for (channel, reference) in REFERENCES.into_iter().enumerate() {
        let passing: Vec<_> = texels.chunks(6).map(|faces| compared(faces, GlCompare::LessEqual, reference)).collect();
        for (index, value) in values.iter().enumerate() {
            let cube = Cube { side: 2, faces: &passing[index % CUBES as usize], seamless: true };
            tally.add(cube.compared(f64::from(value[channel]), direction(vectors[index])), 0.0);
        }
    }
    findings.tally(format!("{}: cubes of an array", format.name()), tally, "");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::verify::cube;

    #[test]
    fn faces_of_comparisons() {
        let faces = vec![vec![0.25, 0.75, 0.25, 0.75]; 6];
        let passing = compared(&faces, GlCompare::LessEqual, 0.5);
        let cube = Cube { side: 2, faces: &passing, seamless: false };
        let middle = cube::direction(4, [0.5, 0.5]);
        assert_eq!(cube.compared(0.5, middle), Grade::Good);
        assert_eq!(cube.compared(0.8, middle), Grade::Allowed);
        assert_eq!(cube.compared(1.1, middle), Grade::Wrong);
        assert_eq!(cube.compared(0.0, cube::direction(4, [0.9, 0.5])), Grade::Wrong);
    }
}
