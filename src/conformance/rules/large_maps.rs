//! GL-K9: look-ups in maps of thousands of texels find the texel that the coordinates name [GL 4.6, 8.14.2, 2.3.4.1].

use crate::conformance::bench::{Error, GlCompare, GlFormat, Sampling};
use crate::conformance::random::Random;
use crate::conformance::{DriverUnderTest, Findings};

/// Texels of the longer side.
const LONG: u32 = 4096;

/// A look-up of `at.xy` against 0.5.
struct Lookup {
    name: &'static str,
    fragment: &'static str,
}

const COMPARED: [Lookup; 3] = [
    Lookup {
        name: "texture, compared",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(compare(at.xyz));",
    },
    Lookup {
        name: "textureProj, compared",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(compare_proj(vec4(3.0 * at.xyz, 3.0)));",
    },
    Lookup {
        name: "textureLod, compared",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(compare_lod(at.xyz, 0.0));",
    },
];

const PLAIN: [Lookup; 2] = [
    Lookup {
        name: "texture",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = texture(map, at.xy);",
    },
    Lookup {
        name: "textureProj",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = textureProj(map, vec3(3.0 * at.xy, 3.0));",
    },
];

/// GL-K9: a wide map and a high one. Floats are good to one part in 10^5, which is a twenty-fifth of a texel here; the
/// look-ups stay a tenth away from the next one.
pub fn large(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let long = LONG.min(subject.bench.largest_side());
    let mut random = Random::new(933);
    let near: Vec<bool> = (0..long).map(|_| random.unit() < 0.5).collect();
    let depths: Vec<f32> = near.iter().map(|near| if *near { 0.25 } else { 0.75 }).collect();
    let colors: Vec<[u8; 4]> = near.iter().map(|near| [if *near { 0 } else { 255 }; 4]).collect();
    for (name, size) in [("wide", [long, 1]), ("high", [1, long])] {
        findings.part(|findings| {
            let depth = subject.bench.depth_image(GlFormat::Depth24, size, &[&depths])?;
            let color = subject.bench.byte_image(size, &colors)?;
            let places: Vec<_> = (0..long).flat_map(|texel| [0.1, 0.5, 0.9].map(|part| (texel, part))).collect();
            let input = |(texel, part): &(u32, f64)| {
                let along = ((f64::from(*texel) + part) / f64::from(long)) as f32;
                if size[1] == 1 { [along, 0.5, 0.5, 1.0] } else { [0.5, along, 0.5, 1.0] }
            };
            let inputs: Vec<_> = places.iter().map(input).collect();
            let mut judge = |lookup: &Lookup, image: &_, sampler: &'static str, sampling: Sampling| {
                let seen = subject.bench.map(lookup.fragment, &inputs, &[(sampler, image, sampling)])?;
                let due = |texel: u32| if near[texel as usize] { 0.0 } else { 1.0 };
                let off = seen.iter().zip(&places).filter(|(seen, (texel, _))| seen[0] != due(*texel)).count();
                findings.none_wrong(format!("{} in a {name} map", lookup.name), off, seen.len());
                Ok::<_, Error>(())
            };
            // 0.5 <= 0.75 is 1.
            for lookup in &COMPARED {
                judge(lookup, &depth, "shadow", Sampling::compare(GlCompare::LessEqual))?;
            }
            for lookup in &PLAIN {
                judge(lookup, &color, "map", Sampling::NEAREST)?;
            }
            Ok(())
        });
    }
    Ok(())
}
