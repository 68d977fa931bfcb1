//! GL-G2: GLSL's functions on numbers, vectors and matrices, held against f64 [GLSL 4.60, 4.7.1, 8.1 to 8.7].

use super::chosen_functions;
use crate::conformance::bench::{Error, Shader};
use crate::conformance::random::Random;
use crate::conformance::verify::{Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// A function of a vec4: four results, in f64 from the f32 input.
struct Function {
    name: &'static str,
    /// Sets `result` from the vec4 `a`.
    body: &'static str,
    due: fn([f64; 4]) -> [f64; 4],
    /// Range of the inputs.
    from: [f32; 2],
    /// Bound of the strict tier in units of 2^-24 of `scale`: GLSL 4.60, 4.7.1, with the roundings of sums and products.
    strict: f64,
    /// Bound that is taken for the minimum. OpenGL states none ("undefined" for 3.3): 2^-11 where not said otherwise, what
    /// half floats keep.
    allowed: f64,
}

const LOOSE: f64 = 1.0 / 2048.0;

const fn function(
    name: &'static str,
    body: &'static str,
    from: [f32; 2],
    strict: f64,
    due: fn([f64; 4]) -> [f64; 4],
) -> Function {
    Function { name, body, due, from, strict, allowed: LOOSE }
}

fn dot3(a: [f64; 4], b: [f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length3(a: [f64; 4]) -> f64 {
    dot3(a, a).sqrt()
}

/// 1 if it holds, else 0.
fn number(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

const FUNCTIONS: &[Function] = &[
    function("abs", "result = abs(a);", [-4.0, 4.0], 0.0, |a| a.map(f64::abs)),
    function("sign", "result = sign(a);", [-4.0, 4.0], 0.0, |a| a.map(|x| if x == 0.0 { 0.0 } else { x.signum() })),
    function("floor", "result = floor(a);", [-9.0, 9.0], 0.0, |a| a.map(f64::floor)),
    function("ceil", "result = ceil(a);", [-9.0, 9.0], 0.0, |a| a.map(f64::ceil)),
    function("fract", "result = fract(a);", [-9.0, 9.0], 16.0, |a| a.map(|x| x - x.floor())),
    function("fract of large numbers", "result = fract(a);", [-5000.0, 5000.0], 16.0, |a| a.map(|x| x - x.floor())),
    function("mod", "result = mod(a, 2.0);", [-9.0, 9.0], 64.0, |a| a.map(|x| x - 2.0 * (x / 2.0).floor())),
    function("min", "result = vec4(min(a.xy, a.zw), min(a.x, a.y), min(a.w, 0.25));", [-4.0, 4.0], 0.0, |a| {
        [a[0].min(a[2]), a[1].min(a[3]), a[0].min(a[1]), a[3].min(0.25)]
    }),
    function("max", "result = vec4(max(a.xy, a.zw), max(a.x, a.y), max(a.w, 0.25));", [-4.0, 4.0], 0.0, |a| {
        [a[0].max(a[2]), a[1].max(a[3]), a[0].max(a[1]), a[3].max(0.25)]
    }),
    function("clamp", "result = clamp(a, -0.75, 1.25);", [-4.0, 4.0], 0.0, |a| a.map(|x| x.clamp(-0.75, 1.25))),
    function(
        "mix",
        "result = vec4(mix(a.xy, a.zw, 0.25), mix(a.x, a.y, a.z), mix(a.x, a.y, 1.0));",
        [0.0, 1.0],
        4.0,
        |a| {
            let mix = |x: f64, y: f64, t: f64| x * (1.0 - t) + y * t;
            [mix(a[0], a[2], 0.25), mix(a[1], a[3], 0.25), mix(a[0], a[1], a[2]), a[1]]
        },
    ),
    function("mix by bvec", "result = mix(a, -a.wzyx, greaterThanEqual(a, vec4(0.5)));", [0.0, 1.0], 0.0, |a| {
        [0, 1, 2, 3].map(|i| if a[i] >= 0.5 { -a[3 - i] } else { a[i] })
    }),
    function("greaterThanEqual", "result = vec4(greaterThanEqual(floor(a), floor(a.yzwx)));", [0.0, 4.0], 0.0, |a| {
        [0, 1, 2, 3].map(|i| number(a[i].floor() >= a[(i + 1) % 4].floor()))
    }),
    function(
        "lessThan, any, all, not",
        "bvec4 b = lessThan(a, vec4(0.5)); result = vec4(any(b), all(b), not(b).x, b.w);",
        [0.0, 1.0],
        0.0,
        |a| {
            let b = a.map(|x| x < 0.5);
            [number(b.contains(&true)), number(!b.contains(&false)), number(!b[0]), number(b[3])]
        },
    ),
    function(
        "step, smoothstep",
        "result = vec4(step(0.5, a.xy), smoothstep(0.25, 0.75, a.zw));",
        [0.0, 1.0],
        16.0,
        |a| [number(a[0] >= 0.5), number(a[1] >= 0.5), smoothstep(0.25, 0.75, a[2]), smoothstep(0.25, 0.75, a[3])],
    ),
    function("sqrt", "result = sqrt(a);", [0.001, 90.0], 8.0, |a| a.map(f64::sqrt)),
    function("inversesqrt", "result = inversesqrt(a);", [0.01, 90.0], 4.0, |a| a.map(|x| 1.0 / x.sqrt())),
    function("division", "result = a.xyzw / a.yzwx;", [0.5, 40.0], 5.0, |a| {
        [0, 1, 2, 3].map(|i| a[i] / a[(i + 1) % 4])
    }),
    function("reciprocals", "result = vec4(1.0 / a.x, 1.0 / (a.y + a.z), 1.0 / a.zw);", [0.03, 2.0], 8.0, |a| {
        [1.0 / a[0], 1.0 / (a[1] + a[2]), 1.0 / a[2], 1.0 / a[3]]
    }),
    function("exp, exp2", "result = vec4(exp(a.xy), exp2(a.zw));", [-8.0, 4.0], 40.0, |a| {
        [a[0].exp(), a[1].exp(), a[2].exp2(), a[3].exp2()]
    }),
    function("log, log2", "result = vec4(log(a.xy), log2(a.zw));", [0.01, 90.0], 8.0, |a| {
        [a[0].ln(), a[1].ln(), a[2].log2(), a[3].log2()]
    }),
    function(
        "pow",
        "result = vec4(pow(a.x, 3.0), pow(a.y, 16.0), pow(a.z, 0.5), pow(a.w, 64.0));",
        [0.3, 1.0],
        400.0,
        |a| [a[0].powf(3.0), a[1].powf(16.0), a[2].powf(0.5), a[3].powf(64.0)],
    ),
    function(
        "pow of 0",
        "result = vec4(pow(a.x * 0.0, 3.0), pow(0.0 * a.y, 64.0), pow(a.z * 0.0, 0.5), pow(a.w, 0.0));",
        [0.3, 1.0],
        4.0,
        |_| [0.0, 0.0, 0.0, 1.0],
    ),
    Function {
        allowed: 1.0 / 256.0,
        ..function("sin, cos", "result = vec4(sin(a.xy), cos(a.zw));", [-3.2, 3.2], 8192.0, |a| {
            [a[0].sin(), a[1].sin(), a[2].cos(), a[3].cos()]
        })
    },
    Function {
        allowed: 1.0 / 128.0,
        ..function("sin, cos of many turns", "result = vec4(sin(a.xy), cos(a.zw));", [-40.0, 40.0], 16384.0, |a| {
            [a[0].sin(), a[1].sin(), a[2].cos(), a[3].cos()]
        })
    },
    Function {
        allowed: 1.0 / 256.0,
        ..function(
            "tan, atan",
            "result = vec4(tan(a.x), atan(a.y), atan(a.z, a.w), atan(a.w, -a.x));",
            [0.1, 1.2],
            8192.0,
            |a| [a[0].tan(), a[1].atan(), a[2].atan2(a[3]), a[3].atan2(-a[0])],
        )
    },
    function(
        "dot",
        "result = vec4(dot(a.xy, a.zw), dot(a.xyz, a.yzw), dot(a, a.wzyx), dot(a, a));",
        [-2.0, 2.0],
        16.0,
        |a| {
            [
                a[0] * a[2] + a[1] * a[3],
                a[0] * a[1] + a[1] * a[2] + a[2] * a[3],
                2.0 * (a[0] * a[3] + a[1] * a[2]),
                a.iter().map(|x| x * x).sum(),
            ]
        },
    ),
    function("cross", "result = vec4(cross(a.xyz, a.wzx), 0.0);", [-2.0, 2.0], 16.0, |a| {
        let b = [a[3], a[2], a[0]];
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0.0]
    }),
    function(
        "length, distance",
        "result = vec4(length(a.xyz), length(a.xy), distance(a.xyz, a.yzw), length(a));",
        [-2.0, 2.0],
        24.0,
        |a| {
            let apart = [a[0] - a[1], a[1] - a[2], a[2] - a[3], 0.0];
            [length3(a), a[0].hypot(a[1]), length3(apart), (dot3(a, a) + a[3] * a[3]).sqrt()]
        },
    ),
    function("normalize", "result = vec4(normalize(a.xyz), normalize(a).w);", [0.25, 2.0], 24.0, |a| {
        let (three, four) = (length3(a), (dot3(a, a) + a[3] * a[3]).sqrt());
        [a[0] / three, a[1] / three, a[2] / three, a[3] / four]
    }),
    function("reflect", "result = vec4(reflect(a.xyz, normalize(a.yzw)), 0.0);", [0.25, 2.0], 64.0, |a| {
        let n = [a[1], a[2], a[3], 0.0];
        let along = 2.0 * dot3(a, n) / dot3(n, n);
        [a[0] - along * n[0], a[1] - along * n[1], a[2] - along * n[2], 0.0]
    }),
    function(
        "mat3: columns and products",
        "mat3 m = mat3(a.xyz, a.yzw, vec3(1.0, 2.0, 3.0)); result = vec4(m * a.xyz, (a.xyz * m).y);",
        [-2.0, 2.0],
        64.0,
        |a| {
            let third = [1.0, 2.0, 3.0];
            let row = |i: usize| a[i] * a[0] + a[i + 1] * a[1] + third[i] * a[2];
            [row(0), row(1), row(2), a[0] * a[1] + a[1] * a[2] + a[2] * a[3]]
        },
    ),
    function(
        "transpose, inverse",
        "mat2 m = mat2(2.0, 1.0, 0.5, 1.0 + a.x); vec2 i = inverse(m) * a.zw; result = vec4(i, transpose(m) * a.zw);",
        [0.25, 2.0],
        128.0,
        |a| {
            // Columns (2, 1) and (0.5, 1 + x).
            let (d, det) = (1.0 + a[0], 2.0 * (1.0 + a[0]) - 0.5);
            [(d * a[2] - 0.5 * a[3]) / det, (2.0 * a[3] - a[2]) / det, 2.0 * a[2] + a[3], 0.5 * a[2] + d * a[3]]
        },
    ),
    function(
        "integers and bits",
        "ivec4 i = ivec4(floor(a)); result = vec4((i.x << 3) | (i.y & 5), (i.z ^ i.w) >> 1, i.x / 7, (i.y + 13) % 5);",
        [0.0, 30.0],
        0.0,
        |a| {
            let i = a.map(|x| x.floor() as i32);
            [(i[0] << 3) | (i[1] & 5), (i[2] ^ i[3]) >> 1, i[0] / 7, (i[1] + 13) % 5].map(f64::from)
        },
    ),
    function("conversions to int", "result = vec4(float(int(a.x)), vec3(ivec3(a.yzw)));", [-9.0, 9.0], 0.0, |a| {
        a.map(f64::trunc)
    }),
    function(
        "isnan, isinf",
        "float zero = floor(0.25 * a.x); result = vec4(isinf(a.y / zero), isinf(a.x), isnan(a.z), isnan(a.w));",
        [0.5, 2.0],
        0.0,
        |_| [1.0, 0.0, 0.0, 0.0],
    ),
];

/// Inputs of a function: random ones, and where the range has them whole numbers and equal components.
fn inputs(from: [f32; 2], random: &mut Random) -> Vec<[f32; 4]> {
    let mut inputs: Vec<[f32; 4]> = (0..240).map(|_| [(); 4].map(|()| random.between(from[0], from[1]))).collect();
    for (index, input) in inputs.iter_mut().enumerate().take(64) {
        let whole = (from[0].ceil() + (index % 19) as f32).min(from[1].floor());
        if whole >= from[0] && whole != 0.0 {
            input[index % 4] = whole;
            input[(index + 1) % 4] = if index % 3 == 0 { whole } else { input[(index + 1) % 4] };
        }
    }
    inputs
}

/// GL-G2: each function in a fragment shader.
pub fn functions(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for function in FUNCTIONS {
        findings.part(|findings| one(subject, findings, function));
    }
    findings.part(|findings| loops(subject, findings));
    findings.part(|findings| structures(subject, findings));
    findings.part(|findings| chosen_functions::chosen(subject, findings));
    Ok(())
}

/// A function that takes a structure and gives it back, all of its members [GLSL 4.60, 6.1.1].
const STRUCTURES: Shader = Shader {
    declarations: "struct Cone {
    vec3 way;
    float reach;
    vec2 ends;
};
void turn(inout Cone cone) {
    cone.way = cone.way.yzx * cone.reach;
    cone.reach += cone.ends.x;
    cone.ends = cone.ends.yx + cone.way.z;
}
",
    fragment: "vec4 at = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0);
Cone cone = Cone(at.xyz, at.w, at.xw);
turn(cone);
turn(cone);
result = vec4(cone.way.x + cone.way.y, cone.reach, cone.ends);",
    ..Shader::PLAIN
};

fn structures(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    // Whole numbers that are small enough for f32 to be exact.
    let inputs: Vec<[f32; 4]> =
        (0..64).map(|of| [of % 4, of / 4 % 4, of / 16, of % 5].map(|number| number as f32)).collect();
    let due = |[x, y, z, w]: [f32; 4]| {
        let (mut way, mut reach, mut ends) = ([x, y, z], w, [x, w]);
        for _ in 0..2 {
            way = [way[1], way[2], way[0]].map(|part| part * reach);
            reach += ends[0];
            ends = [ends[1] + way[2], ends[0] + way[2]];
        }
        [way[0] + way[1], reach, ends[0], ends[1]]
    };
    let seen = subject.bench.map_by(STRUCTURES, &inputs, &[])?;
    let wrong = seen.iter().zip(&inputs).filter(|(seen, input)| **seen != due(**input)).count();
    findings.none_wrong("a structure that is inout", wrong, inputs.len());
    Ok(())
}

fn one(subject: &DriverUnderTest, findings: &mut Findings, function: &Function) -> Result<(), Error> {
    let mut random = Random::new(341);
    let inputs = inputs(function.from, &mut random);
    let results = run(subject, function.body, &inputs)?;
    let mut tally = GradeTally::default();
    for (input, seen) in inputs.iter().zip(results) {
        let due = (function.due)(input.map(f64::from));
        for (seen, due) in seen.into_iter().zip(due) {
            let (seen, scale) = (f64::from(seen), due.abs().max(0.25));
            let off = (seen - due).abs() / scale * f64::from(24).exp2();
            let grade = match off {
                off if off <= function.strict => Grade::Good,
                // What takes no rounding has no second tier.
                off if function.strict > 0.0 && off <= function.allowed * f64::from(24).exp2() => Grade::Allowed,
                _ => Grade::Wrong,
            };
            tally.add(grade, off);
        }
    }
    findings.tally(function.name, tally, "x 2^-24");
    Ok(())
}

fn run(subject: &DriverUnderTest, body: &'static str, inputs: &[[f32; 4]]) -> Result<Vec<[f32; 4]>, Error> {
    const FETCH: &str = "#ifndef VERTEX
#define a texelFetch(inputs, ivec2(gl_FragCoord.xy), 0)
#endif";
    subject.bench.map_by(Shader { declarations: FETCH, ..Shader::of(body) }, inputs, &[])
}

/// Loops whose bound is an input, nested ones, a break, and arrays whose index is one.
fn loops(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let inputs: Vec<[f32; 4]> =
        (0..64).map(|index| [index as f32, (index % 7) as f32, (index % 5) as f32, 0.0]).collect();
    let body = "vec4 at = a; float sum = 0.0, nested = 0.0, broken = 0.0; float squares[8];
        for (int i = 0; i < 8; ++i) squares[i] = float(i * i);
        for (int i = 0; i < int(at.x); ++i) sum += float(i);
        for (int y = 0; y < int(at.y); ++y) for (int x = 0; x <= y; ++x) nested += 1.0;
        for (int i = 0; i < 100; ++i) { if (float(i) >= at.x) break; if (i % 2 == 0) continue; broken += 1.0; }
        result = vec4(sum, nested, broken, squares[int(at.z)]);";
    let results = run(subject, body, &inputs)?;
    let due = |[x, y, z, _]: [f32; 4]| [x * (x - 1.0) / 2.0, y * (y + 1.0) / 2.0, (x / 2.0).floor(), z * z];
    let wrong = inputs.iter().zip(&results).filter(|(input, seen)| due(**input) != **seen).count();
    findings.none_wrong("loops, breaks, arrays by index", wrong, results.len());
    Ok(())
}
