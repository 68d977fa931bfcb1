//! GL-G6: centroid varyings of pixels that are covered in part [GL 4.6, 14.3.1; GLSL 4.60, 4.5].

use crate::conformance::bench::{Error, GlBlit, GlDraw, GlFormat, GlState, Shader, Vertex};
use crate::conformance::random::Random;
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 32;
const SAMPLES: u32 = 4;

/// A vertex's value is its weight: within a triangle none of the three is below 0. Positions are known to a sixteenth of a
/// pixel, along which a weight changes by less than 1/128. Red tells of a place that lies outside.
const SHADER: Shader = Shader {
    declarations: "#ifdef VERTEX\ncentroid out vec3 weights;\n#else\ncentroid in vec3 weights;\n#endif",
    vertex: "gl_Position = position; passed = value; weights = value.xyz;",
    fragment: "float least = min(min(weights.x, weights.y), weights.z);
        result = least < -0.0078125 ? vec4(1.0, 0.0, 0.0, 1.0) : vec4(0.0, 1.0, 0.0, 1.0);",
    ..Shader::PLAIN
};

/// GL-G6: along the edges of triangles no centroid lies outside.
pub fn centroid(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    if subject.bench.most_samples() < SAMPLES {
        findings.untestable("4 samples", format!("GL_MAX_SAMPLES is {}", subject.bench.most_samples()));
        return Ok(());
    }
    let many = subject.bench.renderbuffers([SIDE; 2], Some(GlFormat::Rgba8), None, SAMPLES)?;
    let one = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba8), None)?;
    let mut random = Random::new(381);
    let (mut outside, mut partial) = (0, 0);
    for _ in 0..12 {
        many.clear_color([0.0; 4]);
        let turn = random.between(0.0, std::f32::consts::TAU);
        let vertices: Vec<Vertex> = (0..3)
            .map(|corner| {
                let angle = turn + corner as f32 * std::f32::consts::TAU / 3.0;
                let mut value = [0.0; 4];
                value[corner] = 1.0;
                Vertex { position: [0.9 * angle.cos(), 0.9 * angle.sin(), 0.0, 1.0], value }
            })
            .collect();
        let state = GlState { depth: None, ..GlState::WRITE };
        subject.bench.draw(&GlDraw { shader: SHADER, ..GlDraw::plain(&many, state, &vertices) })?;
        let (corners, mask) = ([[0, 0, SIDE as i32, SIDE as i32]; 2], glow::COLOR_BUFFER_BIT);
        let blit = GlBlit { from: &many, to: &one, corners, mask, linear: false, scissor: None };
        if let Some(codes) = subject.bench.blit(&blit) {
            return Err(Error::Gl { what: "a resolve", codes });
        }
        let colors = one.colors();
        outside += colors.iter().filter(|color| color[0] > 0).count();
        partial += colors.iter().filter(|color| color[3] > 0 && color[3] < 255).count();
    }
    findings.none_wrong("weights within the triangle, along its edges", outside, partial);
    Ok(())
}
