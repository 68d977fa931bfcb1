//! GL-K10: GLSL's geometric functions of short and long vectors [GLSL 4.60, 4.7.1, 8.2, 8.5].

use crate::conformance::bench::Error;
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Powers of two that vectors are scaled by: their squares are floats of full precision.
const POWERS: std::ops::RangeInclusive<i32> = -40..=40;

/// A function of `v`, a vec3, scaled by `s`; what it gives is due for the vector without the scale.
struct Function {
    name: &'static str,
    fragment: &'static str,
    due: fn([f64; 3]) -> [f64; 3],
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

const FUNCTIONS: [Function; 7] = [
    Function {
        name: "normalize",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(normalize(at.xyz * at.w), 0.0);",
        due: |v| v.map(|x| x / length(v)),
    },
    Function {
        name: "normalize of a vec2",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(normalize(at.xy * at.w), 0.0, 0.0);",
        due: |[x, y, _]| [x / x.hypot(y), y / x.hypot(y), 0.0],
    },
    Function {
        name: "length",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(length(at.xyz * at.w) / at.w);",
        due: |v| [length(v); 3],
    },
    Function {
        name: "distance",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0);
result = vec4(distance(at.xyz * at.w, -at.xyz * at.w) / at.w);",
        due: |v| [2.0 * length(v); 3],
    },
    Function {
        name: "dot",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(dot(at.xyz * at.w, at.xyz * at.w) / at.w / at.w);",
        due: |v| [length(v) * length(v); 3],
    },
    Function {
        name: "cross",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); result = vec4(cross(at.xyz * at.w, at.yzx * at.w) / at.w / at.w, 0.0);",
        due: |[x, y, z]| [y * x - z * z, z * y - x * x, x * z - y * y],
    },
    Function {
        name: "inversesqrt and sqrt",
        fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0); float x = at.w * at.w;
result = vec4(inversesqrt(x) * at.w, sqrt(x) / at.w, 1.0, 0.0);",
        due: |_| [1.0; 3],
    },
];

/// GL-K10: each function of twenty directions at each scale. The results may be as far off as those of GL-G2.
pub fn magnitudes(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mut random = Random::new(77);
    let component = |random: &mut Random| random.between(0.25, 1.0) * if random.unit() < 0.5 { -1.0 } else { 1.0 };
    let directions: Vec<[f32; 3]> = (0..20).map(|_| std::array::from_fn(|_| component(&mut random))).collect();
    let inputs: Vec<[f32; 4]> =
        POWERS.flat_map(|power| directions.iter().map(move |[x, y, z]| [*x, *y, *z, (power as f32).exp2()])).collect();
    for function in &FUNCTIONS {
        let seen = subject.bench.map(function.fragment, &inputs, &[])?;
        let mut tally = GradeTally::default();
        for (seen, [x, y, z, _]) in seen.iter().zip(&inputs) {
            let due = (function.due)([*x, *y, *z].map(f64::from));
            for (seen, due) in seen.iter().zip(due) {
                let off = f64::from(*seen) - due;
                // Sixteen roundings; or what half floats keep, as in GL-G2.
                let off = if off.is_nan() { f64::INFINITY } else { off };
                tally.add(verify::within(off, 16.0 / f64::from(1 << 24), 1.0 / 1024.0), off * f64::from(1 << 24));
            }
        }
        findings.tally(format!("{} at 81 scales", function.name), tally, "roundings");
    }
    Ok(())
}
