//! GL-G5: the vertex that a flat varying is taken from, of each primitive [GL 4.6, 13.6, table 13.2].

use crate::conformance::bench::{
    Error, GlAttribute, GlElements, GlFormat, GlIndices, GlPrimitive, GlState, Shader, Surface,
};
use crate::conformance::verify;
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along a side.
const SIDE: usize = 16;

const SHADER: Shader = Shader {
    declarations: "#ifdef VERTEX\nflat out float of_one;\n#else\nflat in float of_one;\n#endif",
    vertex: "gl_Position = position; passed = value; of_one = value.x;",
    fragment: "result = vec4(of_one);",
    ..Shader::PLAIN
};

/// A primitive of a draw: its corners, and the vertices that a flat varying is of by the first and by the last convention.
type Triangle = ([usize; 3], [usize; 2]);

fn triangles(primitive: GlPrimitive, vertices: usize) -> Vec<Triangle> {
    match primitive {
        GlPrimitive::Triangles => {
            (0..vertices / 3).map(|i| ([3 * i, 3 * i + 1, 3 * i + 2], [3 * i, 3 * i + 2])).collect()
        }
        GlPrimitive::TriangleStrip => (0..vertices - 2).map(|i| ([i, i + 1, i + 2], [i, i + 2])).collect(),
        _ => (0..vertices - 2).map(|i| ([0, i + 1, i + 2], [i + 1, i + 2])).collect(),
    }
}

/// Places of the vertices.
fn places(primitive: GlPrimitive) -> Vec<[f32; 2]> {
    match primitive {
        GlPrimitive::Triangles => {
            vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [0.0, 1.0], [-1.0, 0.5]]
        }
        GlPrimitive::TriangleStrip => {
            (0..8).map(|index| [(index / 2) as f32 * 2.0 / 3.0 - 1.0, [-1.0, 1.0][index % 2]]).collect()
        }
        _ => vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [-1.0, 1.0]],
    }
}

/// GL-G5: each convention and the other again, for triangles, strips and fans.
pub fn provoking(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba32F), None)?;
    if !subject.bench.provoke(false) {
        findings.untestable("glProvokingVertex", "the driver does not have the function");
        return Ok(());
    }
    let mut result = Ok(());
    for (name, first) in [("the last vertex", false), ("the first vertex", true), ("the last vertex again", false)] {
        subject.bench.provoke(first);
        for primitive in [GlPrimitive::Triangles, GlPrimitive::TriangleStrip, GlPrimitive::TriangleFan] {
            match differ(subject, &surface, primitive, first) {
                Ok((wrong, count)) => findings.none_wrong(format!("{primitive:?}: {name}"), wrong, count),
                Err(error) => result = Err(error),
            }
        }
    }
    subject.bench.provoke(false);
    result
}

/// Pixels well inside of one primitive whose value is another vertex's, and how many there are.
fn differ(
    subject: &DriverUnderTest,
    surface: &Surface,
    primitive: GlPrimitive,
    first: bool,
) -> Result<(usize, usize), Error> {
    let places = places(primitive);
    let positions: Vec<f32> = places.iter().flat_map(|[x, y]| [*x, *y]).collect();
    let numbers: Vec<f32> = (1..=places.len()).map(|number| number as f32).collect();
    let attribute = |location, components, numbers| GlAttribute { location, components, numbers, stride: 0, offset: 0 };
    let indices: Vec<u32> = (0..places.len() as u32).collect();
    surface.clear_color([0.0; 4]);
    subject.bench.draw_elements(&GlElements {
        surface,
        state: GlState { depth: None, ..GlState::WRITE },
        shader: SHADER,
        attributes: &[attribute(0, 2, &positions), attribute(1, 1, &numbers)],
        indices: GlIndices::Long(&indices),
        range: [0, places.len() as u32],
        primitive,
        base: 0,
    })?;
    let in_window = |vertex: usize| places[vertex].map(|at| (f64::from(at) + 1.0) * SIDE as f64 / 2.0);
    let triangles = triangles(primitive, places.len());
    let (mut wrong, mut count) = (0, 0);
    for (pixel, seen) in surface.floats().into_iter().enumerate() {
        let center = [pixel % SIDE, pixel / SIDE].map(|at| at as f64 + 0.5);
        let mut covering = triangles
            .iter()
            .filter(|(corners, _)| verify::covers(corners.map(in_window), center, 0.05) == Some(true))
            .map(|(_, provoking)| provoking[usize::from(!first)]);
        if let (Some(vertex), None) = (covering.next(), covering.next()) {
            wrong += usize::from(seen[0] != numbers[vertex]);
            count += 1;
        }
    }
    Ok((wrong, count))
}
