//! GL-G4: gl_FragCoord, gl_VertexID, gl_FrontFacing, and how varyings are interpolated [GLSL 4.60, 4.5, 7.1].

use super::planes::{perspective_weights, weights, window};
use crate::conformance::bench::{Error, GlDraw, GlFormat, GlState, Shader, Surface, Vertex, full};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: usize = 32;
const FLAT: GlState = GlState { depth: None, ..GlState::WRITE };
const QUALIFIED: &str = "#ifdef VERTEX
flat out vec4 of_one; noperspective out vec4 in_window; smooth out vec4 in_space; centroid out vec4 in_center;
#else
flat in vec4 of_one; noperspective in vec4 in_window; smooth in vec4 in_space; centroid in vec4 in_center;
#endif";
const SET: &str =
    "gl_Position = position; passed = value; of_one = value; in_window = value; in_space = value; in_center = value;";

/// Two triangles over more than the viewport, whose corners have several w.
const CLIP: [[[f32; 4]; 3]; 2] = [
    [[-1.0, -1.0, 0.0, 1.0], [4.0, -4.0, 0.0, 4.0], [2.0, 2.0, 0.0, 2.0]],
    [[-1.0, -1.0, 0.0, 1.0], [2.0, 2.0, 0.0, 2.0], [-3.0, 3.0, 0.0, 3.0]],
];

fn value(triangle: usize, corner: usize) -> [f32; 4] {
    let at = (3 * triangle + corner) as f32;
    [at, 1.0 - 0.5 * at, if corner == 1 { 1.0 } else { 0.0 }, if corner == 2 { 8.0 } else { 2.0 }]
}

fn vertices() -> Vec<Vertex> {
    let corner = |(triangle, corner): (usize, usize)| Vertex {
        position: CLIP[triangle][corner],
        value: value(triangle, corner),
    };
    (0..6).map(|index| corner((index / 3, index % 3))).collect()
}

/// GL-G4: variables of GLSL and qualifiers of varyings.
pub fn varyings(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface(
        [SIDE as u32; 2],
        Some(GlFormat::Rgba32F),
        Some(crate::conformance::bench::GlFormat::Depth24),
    )?;
    coordinates(subject, findings, &surface)?;
    for (name, fragment, perspective) in [
        ("smooth", "result = in_space;", true),
        ("noperspective", "result = in_window;", false),
        ("centroid, without multisampling", "result = in_center;", true),
        ("without a qualifier", "result = passed;", true),
    ] {
        let tally = interpolated(subject, &surface, fragment, perspective)?;
        findings.tally(name, tally, "of the values");
    }
    constant(subject, findings, &surface)?;
    identities(subject, findings, &surface)
}

fn center(pixel: usize) -> [f64; 2] {
    [pixel % SIDE, pixel / SIDE].map(|at| at as f64 + 0.5)
}

/// The triangle that surely covers a pixel.
fn covering(pixel: usize) -> Option<usize> {
    let [x, y] = center(pixel);
    match y - x {
        d if d > 0.1 => Some(1),
        d if d < -0.1 => Some(0),
        _ => None,
    }
}

/// Weights of the corners of a triangle at a pixel's centre.
fn corner_weights(triangle: usize, pixel: usize, perspective: bool) -> [f64; 3] {
    let corners = window(CLIP[triangle], [0.0; 2], SIDE as f64);
    match perspective {
        true => perspective_weights(corners, CLIP[triangle], center(pixel)),
        false => weights(corners, center(pixel)),
    }
}

fn interpolated(
    subject: &DriverUnderTest,
    surface: &Surface,
    fragment: &'static str,
    perspective: bool,
) -> Result<GradeTally, Error> {
    let shader = Shader { declarations: QUALIFIED, vertex: SET, fragment, ..Shader::PLAIN };
    let vertices = vertices();
    subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(surface, FLAT, &vertices) })?;
    let mut tally = GradeTally::default();
    for (pixel, color) in surface.floats().into_iter().enumerate() {
        let Some(triangle) = covering(pixel) else { continue };
        let weights = corner_weights(triangle, pixel, perspective);
        for (component, seen) in color.into_iter().enumerate() {
            let due: f64 = (0..3).map(|corner| weights[corner] * f64::from(value(triangle, corner)[component])).sum();
            // Values of up to 8, whose slopes are below 1 a pixel: a sub-pixel of 2^-4 is allowed.
            let off = (f64::from(seen) - due) / 8.0;
            tally.add(verify::within(off, 4e-6, 1.0 / 128.0), off);
        }
    }
    Ok(tally)
}

/// flat takes the last vertex's value, to the bit.
fn constant(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let shader = Shader { declarations: QUALIFIED, vertex: SET, fragment: "result = of_one;", ..Shader::PLAIN };
    let vertices = vertices();
    subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(surface, FLAT, &vertices) })?;
    let seen = surface.floats();
    let pixels = (0..SIDE * SIDE).filter_map(|pixel| covering(pixel).map(|triangle| (pixel, triangle)));
    let wrong = pixels.clone().filter(|(pixel, triangle)| seen[*pixel] != value(*triangle, 2)).count();
    findings.none_wrong("flat: the last vertex's value", wrong, pixels.count());
    Ok(())
}

/// gl_FragCoord: centres of pixels to the bit, depth, and 1/w.
fn coordinates(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let vertices = vertices();
    let shader = Shader::of("result = gl_FragCoord;");
    subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(surface, FLAT, &vertices) })?;
    let (mut wrong, mut depth, mut over_w) = (0, GradeTally::default(), GradeTally::default());
    for (pixel, color) in surface.floats().into_iter().enumerate() {
        let [x, y] = center(pixel);
        wrong += usize::from([f64::from(color[0]), f64::from(color[1])] != [x, y]);
        let Some(triangle) = covering(pixel) else { continue };
        let weights = corner_weights(triangle, pixel, false);
        let due: f64 = (0..3).map(|corner| weights[corner] / f64::from(CLIP[triangle][corner][3])).sum();
        let off = f64::from(color[3]) - due;
        over_w.add(verify::within(off, 1e-6, 1.0 / 256.0), off);
        let off = f64::from(color[2]) - 0.5;
        depth.add(verify::within(off, 1e-6, 1e-5), off);
    }
    findings.none_wrong("gl_FragCoord.xy: centres of pixels", wrong, SIDE * SIDE);
    findings.tally("gl_FragCoord.z", depth, "");
    findings.tally("gl_FragCoord.w: 1/w", over_w, "");
    Ok(())
}

/// gl_VertexID of each triangle's last vertex, and gl_FrontFacing of both windings.
fn identities(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    let shader = Shader {
        declarations: "#ifdef VERTEX\nflat out float id;\n#else\nflat in float id;\n#endif",
        vertex: "gl_Position = position; passed = value; id = float(gl_VertexID);",
        fragment: "result = vec4(id, gl_FrontFacing ? 1.0 : 0.0, 0.0, 0.0);",
        ..Shader::PLAIN
    };
    let (front, mut back) = (full(0.0), full(0.0));
    back.reverse();
    let vertices: Vec<Vertex> = front.iter().chain(&back).copied().collect();
    let (mut wrong, mut turned) = (0, 0);
    for (first, facing) in [(0, 1.0), (6, 0.0)] {
        let drawn = &vertices[..first + 6];
        subject.bench.draw(&GlDraw { shader, ..GlDraw::plain(surface, FLAT, drawn) })?;
        for color in surface.floats() {
            let last = [first as f32 + 2.0, first as f32 + 5.0];
            wrong += usize::from(!last.contains(&color[0]));
            turned += usize::from(color[1] != facing);
        }
    }
    findings.none_wrong("gl_VertexID", wrong, 2 * SIDE * SIDE);
    findings.none_wrong("gl_FrontFacing", turned, 2 * SIDE * SIDE);
    Ok(())
}
