//! GL-I1: passes that must meet the same depths [GL 4.6, A.3, 11.1.3.11], and two that need not.

use glam::{Mat4, Vec3};

use crate::conformance::bench::{
    Error, GlBlend, GlCompare, GlDraw, GlFace, GlFormat, GlOffset, GlState, GlStencil, GlStencilOp, GlUniform, Shader,
    Surface, Vertex,
};
use crate::conformance::random::Random;
use crate::conformance::verify::Grade;
use crate::conformance::{DriverUnderTest, Findings};
use crate::math::spaces;

const SIDE: u32 = 96;
const DECLARATIONS: &str = "uniform mat4 clip_from_model; uniform mat4 clip_from_eye; uniform mat4 eye_from_model;
#ifdef VERTEX
invariant gl_Position;
#endif";

const fn shader(vertex: &'static str, fragment: &'static str) -> Shader {
    Shader { declarations: DECLARATIONS, vertex, fragment, ..Shader::PLAIN }
}

const PLAIN: Shader = shader("gl_Position = clip_from_model * position; passed = value;", "result = vec4(1.0);");

/// A pass that is to meet the depths of a first one.
struct Again {
    name: &'static str,
    /// True if the specification demands it; `false`: it only suggests it (enables).
    required: bool,
    shader: Shader,
    /// All of these draw, in turn.
    states: Vec<GlState>,
}

fn passes() -> Vec<Again> {
    let equal = GlState { depth: Some(GlCompare::Equal), ..GlState::WRITE };
    let again = |name, required, shader, state: GlState| Again { name, required, shader, states: vec![state] };
    let changed = "passed = value * 2.0 + position; gl_Position = clip_from_model * position;";
    let zero = Some(GlOffset { factor: 0.0, units: 0.0, clamp: 0.0 });
    let stencil = Some([GlStencil::on_pass(GlStencilOp::Keep); 2]);
    vec![
        again("the same pass", true, PLAIN, equal),
        again("depth writes off", true, PLAIN, GlState { depth_write: false, ..equal }),
        again("another fragment shader", true, shader(PLAIN.vertex, "result = vec4(1.0) + abs(sin(passed));"), equal),
        again("other varyings", true, shader(changed, "result = vec4(1.0) + abs(passed);"), equal),
        again("a discard", true, shader(PLAIN.vertex, "if (passed.x > 2.0) discard; result = vec4(1.0);"), equal),
        again("blending on", false, PLAIN, GlState { blend: Some(GlBlend::Replace), ..equal }),
        again("the scissor on", false, PLAIN, GlState { scissor: Some([0, 0, SIDE as i32, SIDE as i32]), ..equal }),
        again("an offset of nothing", false, PLAIN, GlState { offset: zero, ..equal }),
        again("the stencil test on", false, PLAIN, GlState { stencil, ..equal }),
        Again {
            name: "front and back faces in turn",
            required: false,
            shader: PLAIN,
            states: [GlFace::Back, GlFace::Front].map(|face| GlState { cull: Some(face), ..equal }).to_vec(),
        },
    ]
}

/// Triangles of model space, some of them across the near plane if requested.
fn mesh(near_too: bool) -> Vec<Vertex> {
    let mut random = Random::new(51);
    let depth = if near_too { 3.0 } else { 1.5 };
    (0..120)
        .map(|_| {
            let position = [random.between(-1.5, 1.5), random.between(-1.5, 1.5), random.between(-1.5, depth), 1.0];
            Vertex { position, value: [random.unit(), random.unit(), random.unit(), 1.0] }
        })
        .collect()
}

/// Projection and modelview.
fn matrices() -> [Mat4; 2] {
    let eye_from_model = Mat4::from_translation(Vec3::new(0.03, -0.07, -3.1))
        * Mat4::from_axis_angle(Vec3::new(0.3, 0.9, 0.2).normalize(), 0.7);
    [spaces::perspective(0.9, 1.0, 0.7, 40.0).as_mat4(), eye_from_model]
}

fn draw(
    subject: &DriverUnderTest,
    surface: &Surface,
    shader: Shader,
    state: GlState,
    vertices: &[Vertex],
) -> Result<(), Error> {
    let [clip_from_eye, eye_from_model] = matrices();
    let uniforms = [
        ("clip_from_model", GlUniform::Mat4((clip_from_eye * eye_from_model).to_cols_array())),
        ("clip_from_eye", GlUniform::Mat4(clip_from_eye.to_cols_array())),
        ("eye_from_model", GlUniform::Mat4(eye_from_model.to_cols_array())),
    ];
    subject.bench.draw(&GlDraw { shader, uniforms: &uniforms, ..GlDraw::plain(surface, state, vertices) })
}

/// Pixels of the first pass that the others miss, and how many it has.
fn missed(
    subject: &DriverUnderTest,
    format: GlFormat,
    again: &Again,
    mesh: &[Vertex],
) -> Result<(usize, usize), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), Some(format))?;
    surface.clear_depth(1.0);
    surface.clear_color([0.0; 4]);
    if format.has_stencil() {
        surface.clear_stencil(0);
    }
    let first = GlState { depth: Some(GlCompare::Less), color_write: false, ..GlState::WRITE };
    draw(subject, &surface, PLAIN, first, mesh)?;
    for state in &again.states {
        draw(subject, &surface, again.shader, *state, mesh)?;
    }
    let (colors, depths) = (surface.colors(), surface.depths());
    let pairs = colors.iter().zip(&depths).filter(|(_, depth)| **depth < 1.0);
    Ok((pairs.clone().filter(|(color, _)| color[0] != 255).count(), pairs.count()))
}

/// GL-I1: repeated passes meet the same depths.
pub fn invariance(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let mesh_before = mesh(false);
    for format in [GlFormat::Depth16, GlFormat::Depth24Stencil8, GlFormat::Depth32F] {
        findings.part(|findings| {
            for again in passes() {
                if again.states.iter().any(|state| state.stencil.is_some()) && !format.has_stencil() {
                    continue;
                }
                let (missed, count) = missed(subject, format, &again, &mesh_before)?;
                let name = format!("{}: EQUAL, {}", format.name(), again.name);
                let grade = match missed {
                    0 if count > 0 => Grade::Good,
                    _ if again.required || count == 0 => Grade::Wrong,
                    _ => Grade::Allowed,
                };
                findings.grade(name, grade, format!("{missed} of {count} pixels missed"));
            }
            Ok(())
        });
    }
    findings.part(|findings| not_promised(subject, findings));
    findings.part(|findings| crate::conformance::rules::fixed::invariance(subject, findings));
    Ok(())
}

/// Tests of equality that renderers rely on although GL does not promise it.
fn not_promised(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let equal = GlState { depth: Some(GlCompare::Equal), ..GlState::WRITE };
    let other =
        shader("gl_Position = clip_from_eye * (eye_from_model * position); passed = value;", "result = vec4(1.0);");
    let two = Again { name: "", required: false, shader: other, states: vec![equal] };
    let clamped =
        Again { name: "", required: false, shader: PLAIN, states: vec![GlState { depth_clamp: true, ..equal }] };
    for (name, again, mesh) in [
        ("P (M v) after (P M) v, EQUAL with 24 bits", two, mesh(false)),
        ("depth clamp turned on, across the near plane, EQUAL with 24 bits", clamped, mesh(true)),
    ] {
        let (missed, count) = missed(subject, GlFormat::Depth24, &again, &mesh)?;
        findings.fact(name, format!("misses {:.0} % of the pixels", 100.0 * missed as f64 / count.max(1) as f64));
    }
    Ok(())
}
