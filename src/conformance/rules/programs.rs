//! GL-I2: passes of several programs that meet the same depths and add up [GL 4.6, A.3; GLSL 4.60, 4.8.1].

use glam::{Mat4, Vec3};

use crate::conformance::bench::{
    Error, GlBlend, GlCompare, GlDraw, GlFace, GlFormat, GlOffset, GlState, GlUniform, Shader, Vertex,
};
use crate::conformance::random::Random;
use crate::conformance::verify::Grade;
use crate::conformance::{DriverUnderTest, Findings};
use crate::math::spaces;

const SIDE: u32 = 64;
const DECLARATIONS: &str = "uniform mat4 clip_from_model; uniform vec4 share;
#ifdef VERTEX
invariant gl_Position;
void set_position() { gl_Position = clip_from_model * position; }
#endif";
const MORE: &str = "uniform mat4 clip_from_model; uniform vec4 share;
#ifdef VERTEX
invariant gl_Position; out vec3 a; out vec2 b; flat out vec4 c; noperspective out float d;
void set_position() { gl_Position = clip_from_model * position; }
#else
in vec3 a; in vec2 b; flat in vec4 c; noperspective in float d;
#endif";

const fn program(vertex: &'static str, fragment: &'static str) -> Shader {
    Shader { declarations: DECLARATIONS, vertex, fragment, ..Shader::PLAIN }
}

/// Shaders of the same position: each adds its share.
const PROGRAMS: [Shader; 5] = [
    program("set_position(); passed = value;", "result = share;"),
    program("passed = value + position; set_position();", "result = share + max(vec4(0.0), passed - 1e6);"),
    program("set_position(); passed = clip_from_model * value;", "if (passed.x > 1e6) discard; result = share;"),
    Shader {
        declarations: MORE,
        ..program(
            "a = position.xyz; b = value.xy; c = value; d = position.x; passed = value; set_position();",
            "result = share + max(vec4(0.0), vec4(a + b.x + c.x + d, passed.x) - 1e6);",
        )
    },
    program(
        "vec4 sum = vec4(0.0); for (int i = 0; i < 4; ++i) sum += position * float(i); passed = sum; set_position();",
        "result = share; for (int i = 0; i < 3; ++i) result += max(vec4(0.0), sin(passed) - 2.0);",
    ),
];

fn mesh(near_too: bool) -> Vec<Vertex> {
    let mut random = Random::new(371);
    let nearest = if near_too { 3.4 } else { 1.5 };
    (0..60)
        .map(|_| {
            let position = [random.between(-1.5, 1.5), random.between(-1.5, 1.5), random.between(-1.5, nearest), 1.0];
            Vertex { position, value: [random.unit(), random.unit(), random.unit(), 1.0] }
        })
        .collect()
}

/// States that first pass and later ones share.
fn shared() -> [(&'static str, GlState, bool); 7] {
    let plain = GlState::WRITE;
    let offset = Some(GlOffset { factor: 2.0, units: 4.0, clamp: 0.0 });
    [
        ("alone", plain, false),
        ("with depth clamp, across the near plane", GlState { depth_clamp: true, ..plain }, true),
        ("in a depth range", GlState { depth_range: [0.25, 0.75], ..plain }, false),
        ("in a depth range that is turned", GlState { depth_range: [0.9, 0.1], short_calls: true, ..plain }, false),
        ("with an offset", GlState { offset, ..plain }, false),
        ("back faces culled", GlState { cull: Some(GlFace::Back), ..plain }, false),
        ("front faces culled", GlState { cull: Some(GlFace::Front), ..plain }, false),
    ]
}

/// GL-I2: the nearest depth by one program, then five under EQUAL, blended by ONE, ONE: each pixel gets each share once.
pub fn add_up(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let eye_from_model = Mat4::from_translation(Vec3::new(0.05, -0.03, -3.3))
        * Mat4::from_axis_angle(Vec3::new(0.2, 0.8, -0.3).normalize(), 0.9);
    let clip_from_model = spaces::perspective(0.9, 1.0, 0.7, 40.0).as_mat4() * eye_from_model;
    for format in [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth24Stencil8, GlFormat::Depth32F] {
        findings.part(|findings| {
            let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), Some(format))?;
            // Drivers compile each state: 16 bits and 24 alone have the first.
            let all = matches!(format, GlFormat::Depth24Stencil8 | GlFormat::Depth32F);
            for (name, state, near_too) in shared().into_iter().take(if all { 7 } else { 1 }) {
                let mesh = mesh(near_too);
                let turned = state.depth_range[0] > state.depth_range[1];
                let (cleared, nearest) = if turned { (0.0, GlCompare::Greater) } else { (1.0, GlCompare::Less) };
                surface.clear_depth(cleared);
                surface.clear_color([0.0; 4]);
                let draw = |shader: Shader, state: GlState, code: u8| {
                    let uniforms = [
                        ("clip_from_model", GlUniform::Mat4(clip_from_model.to_cols_array())),
                        ("share", GlUniform::Vec4([f32::from(code) / 255.0; 4])),
                    ];
                    subject.bench.draw(&GlDraw { shader, uniforms: &uniforms, ..GlDraw::plain(&surface, state, &mesh) })
                };
                draw(PROGRAMS[0], GlState { depth: Some(nearest), color_write: false, ..state }, 0)?;
                let blend = Some(GlBlend::Add);
                let equal = GlState { depth: Some(GlCompare::Equal), depth_write: false, blend, ..state };
                for (index, shader) in PROGRAMS.into_iter().enumerate() {
                    draw(shader, equal, 1 << index)?;
                }
                let (colors, depths) = (surface.colors(), surface.depths());
                let drawn = colors.iter().zip(&depths).filter(|(_, depth)| **depth != cleared);
                let wrong = drawn.clone().filter(|(color, _)| **color != [31; 4]).count();
                let beside =
                    colors.iter().zip(&depths).filter(|(color, depth)| **depth == cleared && **color != [0; 4]);
                let (count, wrong) = (drawn.count(), wrong + beside.count());
                // `invariant` covers positions: an offset's slope is computed anew, and may round otherwise.
                let grade = match wrong {
                    0 if count > 100 => Grade::Good,
                    _ if state.offset.is_some() && wrong < count / 100 => Grade::Allowed,
                    _ => Grade::Wrong,
                };
                let measured = format!("{wrong} of {count} pixels wrong");
                findings.grade(format!("{}: 5 programs under EQUAL, {name}", format.name()), grade, measured);
            }
            Ok(())
        });
    }
    Ok(())
}
