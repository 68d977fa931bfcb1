//! GL-K7: meshes of many vertices and triangles, each attribute in a buffer of its own [GL 4.6, 10.3.1, 10.3.6, 10.4].

use crate::conformance::bench::{Error, GlAttribute, GlElements, GlFormat, GlIndices, GlPrimitive, GlState, Shader};
use crate::conformance::{DriverUnderTest, Findings};

const WIDTH: usize = 256;
const HEIGHT: usize = 128;
/// A triangle for each pixel: more than 65536 vertices, and the index 65535 among them.
const TRIANGLES: usize = WIDTH * HEIGHT;
/// The last triangle that indices of 16 bits reach.
const SHORT_LAST: u32 = 21_844;
/// All attributes have three numbers, and so the same stride; the last one is the last that GL is sure to have.
const SHADER: Shader = Shader {
    version: "#version 330",
    declarations: "#ifdef VERTEX
layout(location = 2) in vec3 number; layout(location = 4) in vec3 fifth; layout(location = 15) in vec3 last;
#endif",
    vertex: "gl_Position = position; passed = vec4(number, dot(fifth - number, vec3(1.0, 4.0, 16.0)) + 64.0 * last.z);",
    fragment: "result = passed;",
};

/// A number for a vertex's triangle, in three digits of base 64.
fn digits(triangle: usize) -> [f32; 3] {
    [triangle % 64, triangle / 64 % 64, triangle / 4096].map(|digit| digit as f32)
}

/// Colour of a triangle's pixel: its number, and how much more the attributes at 4 and 15 are.
fn due(triangle: usize) -> [f32; 4] {
    let [low, middle, high] = digits(triangle);
    [low, middle, high, 1.0 + 4.0 * 2.0 + 16.0 * 3.0 + 64.0 * (low + 5.0)]
}

/// GL-K7: by indices of 32 bits, and of 16.
pub fn many(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([WIDTH as u32, HEIGHT as u32], Some(GlFormat::Rgba32F), None)?;
    // Before all triangles lies a vertex that none has, so that 65533 to 65535 are of one.
    let (mut positions, mut numbers) = (vec![0.0; 3], vec![-7.0; 3]);
    let (mut fifth, mut last) = (vec![-7.0; 3], vec![-7.0; 3]);
    for triangle in 0..TRIANGLES {
        let [x, y] = [triangle % WIDTH, triangle / WIDTH].map(|at| at as f32);
        for [dx, dy] in [[0.1, 0.1], [1.2, 0.2], [0.2, 1.2]] {
            positions.extend([(x + dx) * 2.0 / WIDTH as f32 - 1.0, (y + dy) * 2.0 / HEIGHT as f32 - 1.0, 0.0]);
            let [low, middle, high] = digits(triangle);
            numbers.extend([low, middle, high]);
            fifth.extend([low + 1.0, middle + 2.0, high + 3.0]);
            last.extend([-9.0, -9.0, low + 5.0]);
        }
    }
    let attribute = |location, numbers| GlAttribute { location, components: 3, numbers, stride: 12, offset: 0 };
    let attributes =
        [attribute(0, &positions[..]), attribute(2, &numbers[..]), attribute(4, &fifth[..]), attribute(15, &last[..])];
    // From the last triangle to the first.
    let from = |last: u32| (0..=last).rev().flat_map(|triangle| [1, 2, 3].map(|corner| 3 * triangle + corner));
    let long: Vec<u32> = from(TRIANGLES as u32 - 1).collect();
    let short: Vec<u16> = from(SHORT_LAST).map(|index| index as u16).collect();
    let draws = [
        ("98304 indices of 32 bits", GlIndices::Long(&long), TRIANGLES),
        ("65535 indices of 16 bits", GlIndices::Short(&short), SHORT_LAST as usize + 1),
    ];
    for (name, indices, drawn) in draws {
        surface.clear_color([-1.0; 4]);
        subject.bench.draw_elements(&GlElements {
            surface: &surface,
            state: GlState { depth: None, ..GlState::WRITE },
            shader: SHADER,
            attributes: &attributes,
            indices,
            range: [0, 3 * drawn as u32],
            primitive: GlPrimitive::Triangles,
            base: 0,
        })?;
        let due = |triangle: usize| if triangle < drawn { due(triangle) } else { [-1.0; 4] };
        // All corners of a triangle have its number; what is interpolated may be off by a rounding or two.
        let is_wrong = |triangle: usize, seen: &[f32; 4]| {
            !seen.iter().zip(due(triangle)).all(|(seen, due)| (seen - due).abs() < 0.1)
        };
        let seen = surface.floats();
        let wrong = seen.iter().enumerate().filter(|(triangle, seen)| is_wrong(*triangle, seen)).count();
        findings.none_wrong(name, wrong, TRIANGLES);
    }
    Ok(())
}
