//! GL-V3: instances: gl_InstanceID, and attributes that go on by instances [GL 4.6, 10.3.4, 10.4; GLSL 4.60, 7.1].

use crate::conformance::bench::{Error, GlFormat, GlInstances, GlState, Shader, Surface, Vertex, rectangle};
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along a side: an instance each.
const SIDE: usize = 8;
const MOST: usize = SIDE * SIDE;

/// Instance n lies in pixel n.
const SHADER: Shader = Shader {
    version: "#version 330",
    declarations: "#ifdef VERTEX
layout(location = 2) in vec4 each;
flat out vec4 seen;
#else
flat in vec4 seen;
#endif",
    vertex: "gl_Position = position + vec4(0.25 * float(gl_InstanceID % 8), 0.25 * float(gl_InstanceID / 8), 0.0, 0.0);
        passed = value; seen = vec4(float(gl_InstanceID), each.xy, float(gl_VertexID));",
    fragment: "result = seen;",
};

/// Colour of pixels without an instance.
const NONE: [f32; 4] = [-1.0; 4];

fn each(index: usize) -> [f32; 4] {
    [100.0 + index as f32, 0.5 * index as f32, 0.0, 1.0]
}

/// GL-V3: several counts and divisors, by both calls.
pub fn instances(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba32F), None)?;
    let all: Vec<_> = (0..MOST).map(each).collect();
    // The lower left pixel.
    let vertices = rectangle([-1.0; 2], [-0.75; 2], 0.0, [0.0; 4]);
    for by_index in [false, true] {
        let call = if by_index { "glDrawElementsInstanced" } else { "glDrawArraysInstanced" };
        for divisor in [0, 1, 2, 3, 7] {
            let mut wrong = 0;
            // One by one, and the divisor that was before must not last.
            for count in [MOST, 1, 33, MOST - 1] {
                wrong += differ(subject, &surface, &vertices, &all, divisor, count, by_index)?;
            }
            findings.none_wrong(format!("{call}, divisor {divisor}"), wrong, 4 * MOST);
        }
    }
    Ok(())
}

fn differ(
    subject: &DriverUnderTest,
    surface: &Surface,
    vertices: &[Vertex],
    all: &[[f32; 4]],
    divisor: u32,
    count: usize,
    by_index: bool,
) -> Result<usize, Error> {
    surface.clear_color(NONE);
    let state = GlState { depth: None, ..GlState::WRITE };
    subject.bench.draw_instances(&GlInstances {
        surface,
        state,
        shader: SHADER,
        vertices,
        each: all,
        divisor,
        count: count as u32,
        by_index,
    })?;
    let wrong = surface.floats().into_iter().enumerate().filter(|(pixel, seen)| {
        if *pixel >= count {
            return *seen != NONE;
        }
        // A flat varying is the last vertex's, of one of two triangles.
        let due = |vertex: usize| {
            let index = if divisor == 0 { vertex } else { pixel / divisor as usize };
            [*pixel as f32, all[index][0], all[index][1], vertex as f32]
        };
        ![due(2), due(5)].contains(seen)
    });
    Ok(wrong.count())
}
