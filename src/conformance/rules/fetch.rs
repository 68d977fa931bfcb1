//! GL-V1: vertices by index: attributes in buffers of their own, offsets, strides, index types, primitives [GL 4.6, 10].

use crate::conformance::bench::{
    Error, GlAttribute, GlElements, GlFormat, GlIndices, GlPrimitive, GlState, Shader, Surface,
};
use crate::conformance::verify::Grade;
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: usize = 16;
const FLAT: GlState = GlState { depth: None, ..GlState::WRITE };
/// Attributes as a device declares them: three numbers for a position, which GL completes with 1, three and two more.
const DECLARATIONS: &str = "#ifdef VERTEX
layout(location = 2) in vec3 third; layout(location = 3) in vec2 fourth; layout(location = 4) in vec4 fifth;
flat out vec4 first_seen; flat out vec4 second_seen;
#else
flat in vec4 first_seen; flat in vec4 second_seen;
#endif";

const fn shader(fragment: &'static str) -> Shader {
    Shader {
        version: "#version 330",
        declarations: DECLARATIONS,
        vertex: "gl_Position = position; passed = value; first_seen = vec4(third, value.x); second_seen = vec4(fourth, fifth.x, fifth.y + fifth.z + 2.0 * fifth.w);",
        fragment,
    }
}

/// Numbers of the vertices: a triangle that holds one pixel's centre alone for each of 256 pixels, and two vertices that are
/// never drawn before and behind.
struct Vertices {
    positions: Vec<f32>,
    values: Vec<f32>,
    third: Vec<f32>,
    fourth: Vec<f32>,
    fifth: Vec<f32>,
}

const TRIANGLES: usize = SIDE * SIDE;

impl Vertices {
    fn new() -> Self {
        let mut new = Self { positions: vec![], values: vec![], third: vec![], fourth: vec![], fifth: vec![] };
        for vertex in 0..3 * TRIANGLES {
            let (pixel, corner) = (vertex / 3, vertex % 3);
            let [dx, dy] = [[0.1, 0.1], [1.2, 0.2], [0.2, 1.2]][corner];
            let ndc = |at: usize, by: f32| (at as f32 + by) * 2.0 / SIDE as f32 - 1.0;
            new.positions.extend([ndc(pixel % SIDE, dx), ndc(pixel / SIDE, dy), 0.25]);
            let at = vertex as f32;
            new.values.extend([at + 0.5, -at]);
            new.third.extend([at, at + 1.0, at + 2.0]);
            new.fourth.extend([-at, 0.5 * at]);
            // One number: GL completes it with 0, 0, 1.
            new.fifth.extend([at]);
        }
        new
    }

    fn attributes(&self) -> [GlAttribute<'_>; 5] {
        let plain = |location, components, numbers| GlAttribute { location, components, numbers, stride: 0, offset: 0 };
        [
            plain(0, 3, &self.positions[..]),
            plain(1, 2, &self.values),
            plain(2, 3, &self.third),
            plain(3, 2, &self.fourth),
            plain(4, 1, &self.fifth),
        ]
    }
}

/// Colours that a pixel must show: the attributes of the triangle's last vertex.
fn due(vertex: usize) -> [[f32; 4]; 2] {
    let at = vertex as f32;
    [[at, at + 1.0, at + 2.0, at + 0.5], [-at, 0.5 * at, at, 2.0]]
}

/// GL-V1: the product's way of drawing, then other index types, strides, offsets, bases and primitives.
pub fn fetch(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE as u32; 2], Some(GlFormat::Rgba32F), None)?;
    let vertices = Vertices::new();
    let attributes = vertices.attributes();
    // Triangles backwards, each turned by one: vertices are no longer in the order of the buffer.
    let long: Vec<u32> = (0..TRIANGLES as u32).rev().flat_map(|t| [3 * t + 2, 3 * t, 3 * t + 1]).collect();
    let short: Vec<u16> = long.iter().map(|index| *index as u16).collect();
    let (long, short) = (GlIndices::Long(&long), GlIndices::Short(&short));
    let count = 3 * TRIANGLES as u32;
    for (name, indices, range) in [
        ("indices of 32 bits", long, [0, count]),
        ("a range of 32-bit indices", long, [300, 240]),
        ("indices of 16 bits", short, [0, count]),
        ("a range of 16-bit indices", short, [300, 240]),
        ("the last triangle", long, [count - 3, 3]),
    ] {
        judge(subject, findings, name, &surface, &attributes, indices, range)?;
    }
    let mixed = Interleaved::of(&vertices);
    judge(
        subject,
        findings,
        "attributes in turn in one buffer, behind others",
        &surface,
        &mixed.attributes(),
        long,
        [0, count],
    )?;
    far_indices(subject, findings, &surface, &vertices)?;
    based(subject, findings, &surface, &vertices)?;
    primitives(subject, findings, &surface)
}

fn judge(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    name: &str,
    surface: &Surface,
    attributes: &[GlAttribute],
    indices: GlIndices,
    range: [u32; 2],
) -> Result<(), Error> {
    let mut wrong = 0;
    for (part, fragment) in ["result = first_seen;", "result = second_seen;"].into_iter().enumerate() {
        surface.clear_color([-1.0; 4]);
        let draw = GlElements {
            surface,
            state: FLAT,
            shader: shader(fragment),
            attributes,
            indices,
            range,
            primitive: GlPrimitive::Triangles,
            base: 0,
        };
        subject.bench.draw_elements(&draw)?;
        let drawn = range[0] as usize / 3..(range[0] + range[1]) as usize / 3;
        for (pixel, seen) in surface.floats().into_iter().enumerate() {
            // Triangle `pixel` is drawn in place TRIANGLES - 1 - pixel, and its last vertex is its second.
            let expected = if drawn.contains(&(TRIANGLES - 1 - pixel)) { due(3 * pixel + 1)[part] } else { [-1.0; 4] };
            wrong += usize::from(seen != expected);
        }
    }
    findings.none_wrong(name, wrong, 2 * TRIANGLES);
    Ok(())
}

/// All attributes of a vertex in turn, after 8 numbers that belong to none.
struct Interleaved {
    numbers: Vec<f32>,
}

const EACH: usize = 12;
const BEFORE: usize = 8;

impl Interleaved {
    fn of(vertices: &Vertices) -> Self {
        let mut numbers = vec![77.0; BEFORE];
        for vertex in 0..3 * TRIANGLES {
            numbers.extend(&vertices.positions[3 * vertex..][..3]);
            numbers.extend(&vertices.values[2 * vertex..][..2]);
            numbers.extend(&vertices.third[3 * vertex..][..3]);
            numbers.extend(&vertices.fourth[2 * vertex..][..2]);
            numbers.extend([vertices.fifth[vertex], 99.0]);
        }
        Self { numbers }
    }

    fn attributes(&self) -> [GlAttribute<'_>; 5] {
        [(0, 3, 0), (1, 2, 3), (2, 3, 5), (3, 2, 8), (4, 1, 10)].map(|(location, components, place)| GlAttribute {
            location,
            components,
            numbers: &self.numbers,
            stride: 4 * EACH as u32,
            offset: 4 * (BEFORE + place) as u32,
        })
    }
}

/// Indices beyond 65535: positions lie behind as many that are not drawn.
fn far_indices(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    surface: &Surface,
    vertices: &Vertices,
) -> Result<(), Error> {
    const BEYOND: usize = 65_536;
    let mut positions = vec![0.0; 3 * BEYOND];
    positions.extend(&vertices.positions);
    let attributes = [GlAttribute { location: 0, components: 3, numbers: &positions, stride: 0, offset: 0 }];
    let indices: Vec<u32> = (BEYOND as u32..(BEYOND + 3 * TRIANGLES) as u32).collect();
    covered(
        subject,
        findings,
        "indices beyond 65535",
        surface,
        &attributes,
        GlIndices::Long(&indices),
        GlPrimitive::Triangles,
        0,
        TRIANGLES,
    )
}

/// glDrawElementsBaseVertex.
fn based(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    surface: &Surface,
    vertices: &Vertices,
) -> Result<(), Error> {
    const FIRST: u32 = 3 * 100;
    let attributes = [GlAttribute { location: 0, components: 3, numbers: &vertices.positions, stride: 0, offset: 0 }];
    let indices: Vec<u32> = (0..3 * (TRIANGLES as u32) - FIRST).collect();
    covered(
        subject,
        findings,
        "a base vertex",
        surface,
        &attributes,
        GlIndices::Long(&indices),
        GlPrimitive::Triangles,
        FIRST as i32,
        TRIANGLES - 100,
    )
}

/// Draws with white; pixels other than `last` ones of the surface must be empty, and those be drawn.
#[expect(clippy::too_many_arguments, reason = "one call")]
fn covered(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    name: &str,
    surface: &Surface,
    attributes: &[GlAttribute],
    indices: GlIndices,
    primitive: GlPrimitive,
    base: i32,
    last: usize,
) -> Result<(), Error> {
    let shader = Shader::of("result = vec4(1.0);");
    let count = match indices {
        GlIndices::Long(indices) => indices.len(),
        GlIndices::Short(indices) => indices.len(),
    };
    let range = [0, count as u32];
    surface.clear_color([0.0; 4]);
    subject.bench.draw_elements(&GlElements {
        surface,
        state: FLAT,
        shader,
        attributes,
        indices,
        range,
        primitive,
        base,
    })?;
    let seen = surface.floats();
    let wrong = seen.iter().enumerate().filter(|(pixel, color)| (color[0] == 1.0) != (*pixel >= TRIANGLES - last));
    findings.none_wrong(name, wrong.count(), seen.len());
    Ok(())
}

/// Strips, fans, points, and lines along a row.
fn primitives(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let corners = [-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, -1.0, 1.0, 0.0, 1.0, 1.0, 0.0];
    let attributes = [GlAttribute { location: 0, components: 3, numbers: &corners, stride: 0, offset: 0 }];
    let strip = GlIndices::Short(&[0, 1, 2, 3]);
    covered(subject, findings, "a strip", surface, &attributes, strip, GlPrimitive::TriangleStrip, 0, TRIANGLES)?;
    let fan = GlIndices::Long(&[0, 1, 3, 2]);
    covered(subject, findings, "a fan", surface, &attributes, fan, GlPrimitive::TriangleFan, 0, TRIANGLES)?;
    let ndc = |at: f32| at * 2.0 / SIDE as f32 - 1.0;
    // The uppermost row: a line through its centres from before the surface to beyond it, then a point in each pixel.
    let y = ndc(SIDE as f32 - 0.5);
    let line = [-1.5, y, 0.0, 1.5, y, 0.0];
    line_along(subject, findings, surface, &line)?;
    let points: Vec<f32> = (0..SIDE).flat_map(|x| [ndc(x as f32 + 0.5), y, 0.0]).collect();
    let attributes = [GlAttribute { location: 0, components: 3, numbers: &points, stride: 0, offset: 0 }];
    let all: Vec<u32> = (0..SIDE as u32).collect();
    covered(subject, findings, "points", surface, &attributes, GlIndices::Long(&all), GlPrimitive::Points, 0, SIDE)
}

/// A line through the centres of the uppermost row. A driver may be off by one pixel across a line, but leaves no column out
/// and draws none twice [GL 4.6, 14.5.1].
fn line_along(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    surface: &Surface,
    line: &[f32],
) -> Result<(), Error> {
    surface.clear_color([0.0; 4]);
    subject.bench.draw_elements(&GlElements {
        surface,
        state: FLAT,
        shader: Shader::of("result = vec4(1.0);"),
        attributes: &[GlAttribute { location: 0, components: 3, numbers: line, stride: 0, offset: 0 }],
        indices: GlIndices::Long(&[0, 1]),
        range: [0, 2],
        primitive: GlPrimitive::Lines,
        base: 0,
    })?;
    let seen = surface.floats();
    let drawn: Vec<[usize; 2]> =
        (0..TRIANGLES).filter(|pixel| seen[*pixel][0] == 1.0).map(|pixel| [pixel % SIDE, pixel / SIDE]).collect();
    let once = (0..SIDE).all(|column| drawn.iter().filter(|[x, _]| *x == column).count() == 1);
    let grade = match once {
        true if drawn.iter().all(|[_, y]| *y == SIDE - 1) => Grade::Good,
        true if drawn.iter().all(|[_, y]| *y + 2 >= SIDE) => Grade::Allowed,
        _ => Grade::Wrong,
    };
    findings.grade("a line", grade, format!("{} pixels", drawn.len()));
    Ok(())
}
