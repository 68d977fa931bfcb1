//! GL-D6 to GL-D8: what a fragment leaves behind that is discarded, that has a depth of its own, or that may not write
//! [GL 4.6, 15.2, 17.3.4].

use crate::conformance::bench::{
    Error, GlCompare, GlDraw, GlFormat, GlState, GlStencil, GlStencilOp, Shader, Surface, full,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 8;
const IN_FUNCTION: &str = "#ifndef VERTEX
void drop(float by) { if (by > 0.5) discard; }
#endif";

/// Shaders that discard every second fragment.
const DISCARDING: [(&str, Shader); 5] = [
    ("discard", Shader::of("if ((int(gl_FragCoord.x) + int(gl_FragCoord.y)) % 2 == 1) discard; result = vec4(1.0);")),
    (
        "discard after the colour",
        Shader::of("result = vec4(1.0); if ((int(gl_FragCoord.x) + int(gl_FragCoord.y)) % 2 == 1) discard;"),
    ),
    (
        "discard beside gl_FragDepth",
        Shader::of(
            "gl_FragDepth = 0.25; result = vec4(1.0);
            if ((int(gl_FragCoord.x) + int(gl_FragCoord.y)) % 2 == 1) discard;",
        ),
    ),
    (
        "discard in a function",
        Shader {
            declarations: IN_FUNCTION,
            ..Shader::of("drop(mod(floor(gl_FragCoord.x) + floor(gl_FragCoord.y), 2.0)); result = vec4(1.0);")
        },
    ),
    (
        "discard in a loop",
        Shader::of(
            "for (int i = 0; i < 4; ++i) { if (i == 2 && (int(gl_FragCoord.x) + int(gl_FragCoord.y)) % 2 == 1) discard; }
            result = vec4(1.0);",
        ),
    ),
];

/// States of which each writes something, and what is due of colour, depth and stencil where a fragment is not discarded.
fn states() -> [(&'static str, GlState, [f64; 3]); 4] {
    let ops = [GlStencilOp::Invert, GlStencilOp::IncrementWrap, GlStencilOp::Replace];
    let side = |compare| GlStencil { compare, reference: 7, ops, ..GlStencil::on_pass(GlStencilOp::Keep) };
    let state = |depth, compare| GlState { depth, stencil: Some([side(compare); 2]), ..GlState::WRITE };
    [
        ("all tests pass", state(Some(GlCompare::Less), GlCompare::Always), [255.0, 0.25, 7.0]),
        ("the depth test fails", state(Some(GlCompare::Greater), GlCompare::Always), [0.0, 0.75, 4.0]),
        ("the stencil test fails", state(Some(GlCompare::Less), GlCompare::Never), [0.0, 0.75, 252.0]),
        ("no depth test", state(None, GlCompare::Always), [255.0, 0.75, 7.0]),
    ]
}

/// Colour, depth and stencil of each pixel.
fn stored(surface: &Surface) -> Vec<[f64; 3]> {
    let rest = surface.depths().into_iter().zip(surface.stencils());
    surface.colors().into_iter().zip(rest).map(|(c, (depth, s))| [f64::from(c[0]), depth, f64::from(s)]).collect()
}

fn same(seen: [f64; 3], due: [f64; 3]) -> bool {
    seen[0] == due[0] && (seen[1] - due[1]).abs() < 1e-6 && seen[2] == due[2]
}

fn cleared(surface: &Surface) {
    surface.clear_color([0.0; 4]);
    surface.clear_depth(0.75);
    surface.clear_stencil(3);
}

/// GL-D6: a fragment that is discarded leaves colour, depth and stencil alone, whatever the tests would say.
pub fn discarded(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), Some(GlFormat::Depth24Stencil8))?;
    for (index, (name, shader)) in DISCARDING.into_iter().enumerate() {
        // The ways of discarding differ in the shader: one of them with every state.
        for (tests, state, due) in states().into_iter().take(if index == 0 { 4 } else { 2 }) {
            cleared(&surface);
            // Depth 0.25, which is less than 0.75.
            subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(&surface, state, &full(-0.5)) })?;
            let seen = stored(&surface);
            let wrong = seen.iter().enumerate().filter(|(index, seen)| {
                let odd = (index % SIDE as usize + index / SIDE as usize) % 2 == 1;
                !same(**seen, if odd { [0.0, 0.75, 3.0] } else { due })
            });
            findings.none_wrong(format!("{name}, {tests}"), wrong.count(), seen.len());
        }
    }
    findings.part(|findings| super::alpha_test::leaves_alone(subject, findings));
    Ok(())
}

/// GL-D7: the depth that a shader writes is the one that is tested and stored.
pub fn written_depth(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const WRITE: &str = "gl_FragDepth = texelFetch(inputs, ivec2(gl_FragCoord.xy), 0).x; result = vec4(1.0);";
    const COUNT: usize = 1024;
    let mut random = Random::new(307);
    let mut depths = || (0..COUNT).map(|_| (random.unit() * 64.0).round() / 64.0).collect::<Vec<f32>>();
    let (first, second) = (depths(), depths());
    let inputs = |depths: &[f32]| depths.iter().map(|depth| [*depth; 4]).collect::<Vec<_>>();
    for format in [GlFormat::Depth24, GlFormat::Depth32F] {
        findings.part(|findings| {
            let surface = subject.bench.surface([32; 2], Some(GlFormat::Rgba8), Some(format))?;
            let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
            let mut tally = GradeTally::default();
            for compare in GlCompare::ALL {
                subject.bench.map_into(&surface, GlState::WRITE, WRITE, &inputs(&first), &[])?;
                surface.clear_color([0.0; 4]);
                let before = surface.depths();
                let state = GlState { depth: Some(compare), ..GlState::WRITE };
                // The surface that is drawn lies at depth 0.5.
                subject.bench.map_into(&surface, state, WRITE, &inputs(&second), &[])?;
                for (index, (depth, color)) in surface.depths().into_iter().zip(surface.colors()).enumerate() {
                    let [old, new] = [first[index], second[index]].map(f64::from);
                    let passes = compare.holds(new.total_cmp(&old));
                    let off = (depth - if passes { new } else { before[index] }) / encoding.step(0.75);
                    let grade = if (color[0] == 255) == passes { verify::within(off, 1.5, 1.5) } else { Grade::Wrong };
                    tally.add(grade, off);
                }
            }
            findings.tally(format!("{}: 8 functions on depths that a shader writes", format.name()), tally, "codes");
            Ok(())
        });
    }
    Ok(())
}

/// GL-D8: depth is written where its test is on, its mask is on, and the tests pass.
pub fn writes(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let never = GlStencil { compare: GlCompare::Never, ..GlStencil::on_pass(GlStencilOp::Keep) };
    let always = GlStencil::on_pass(GlStencilOp::Keep);
    let less = GlState { depth: Some(GlCompare::Less), ..GlState::WRITE };
    let stencil = |side| Some([side; 2]);
    let cases = [
        ("depth test, mask on", less, true),
        ("no depth test, mask on", GlState { depth: None, ..less }, false),
        ("depth test, mask off", GlState { depth_write: false, ..less }, false),
        ("depth test, mask on again", less, true),
        ("no depth test, mask off", GlState { depth: None, depth_write: false, ..less }, false),
        ("depth test, colour off", GlState { color_write: false, ..less }, true),
        ("no depth test, colour off", GlState { depth: None, color_write: false, ..less }, false),
        ("the stencil test fails", GlState { stencil: stencil(never), ..less }, false),
        ("the stencil test passes", GlState { stencil: stencil(always), ..less }, true),
        ("the stencil test fails, ALWAYS", GlState { stencil: stencil(never), ..GlState::WRITE }, false),
        ("no depth test, stencil on", GlState { depth: None, stencil: stencil(always), ..less }, false),
        ("the depth test fails", GlState { depth: Some(GlCompare::Greater), ..less }, false),
        ("NEVER", GlState { depth: Some(GlCompare::Never), ..less }, false),
        ("ALWAYS", GlState::WRITE, true),
        ("blending", GlState { blend: Some(crate::conformance::bench::GlBlend::Add), ..less }, true),
    ];
    for format in [GlFormat::Depth24Stencil8, GlFormat::Depth32FStencil8] {
        findings.part(|findings| {
            let surface = subject.bench.surface([4, 4], Some(GlFormat::Rgba8), Some(format))?;
            for depth_of_shader in [false, true] {
                let fragment =
                    if depth_of_shader { "gl_FragDepth = 0.25; result = vec4(1.0);" } else { "result = vec4(1.0);" };
                let mut wrong = Vec::new();
                for (name, state, written) in cases {
                    surface.clear_depth(0.75);
                    let shader = Shader::of(fragment);
                    subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(&surface, state, &full(-0.5)) })?;
                    let due = if written { 0.25 } else { 0.75 };
                    if surface.depths().into_iter().any(|depth| (depth - due).abs() > 1e-6) {
                        wrong.push(name);
                    }
                }
                let by = if depth_of_shader { "gl_FragDepth" } else { "the plane's depth" };
                let measured =
                    if wrong.is_empty() { "as due".to_owned() } else { format!("wrong: {}", wrong.join("; ")) };
                findings.must_hold(
                    format!("{}: {by}, {} states", format.name(), cases.len()),
                    wrong.is_empty(),
                    measured,
                );
            }
            Ok(())
        });
    }
    Ok(())
}
