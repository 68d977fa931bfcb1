//! GL-R1 and GL-R2: which pixels a triangle covers, and clipping in homogeneous coordinates [GL 4.6, 13.7, 14.6.1].

use crate::conformance::bench::{
    Error, GlDraw, GlFormat, GlState, GlStencilOp, GlUniform, Shader, Surface, Vertex, full, triangle,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along a side.
const SIDE: u32 = 64;
const COUNT: GlState = GlState::counting(GlStencilOp::IncrementWrap, GlStencilOp::IncrementWrap);

/// Number of fragments of each pixel.
fn counts(subject: &DriverUnderTest, surface: &Surface, vertices: &[Vertex]) -> Result<Vec<u8>, Error> {
    surface.clear_stencil(0);
    subject.bench.draw(&GlDraw::plain(surface, COUNT, vertices))?;
    Ok(surface.stencils())
}

fn not_one(counts: &[u8]) -> usize {
    counts.iter().filter(|count| **count != 1).count()
}

fn surface(subject: &DriverUnderTest) -> Result<Surface, Error> {
    subject.bench.surface([SIDE; 2], None, Some(GlFormat::Depth24Stencil8))
}

/// GL-R1: every pixel of a seamless mesh is drawn once, and by the triangle that covers its centre.
pub fn coverage(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const ROUNDS: usize = 12;
    let surface = surface(subject)?;
    let mut random = Random::new(41);
    let pixels = (SIDE * SIDE) as usize;
    let (mut grid_wrong, mut fan_wrong) = (0, 0);
    for _ in 0..ROUNDS {
        grid_wrong += not_one(&counts(subject, &surface, &grid(&mut random))?);
        let rim = |angle: f32| [2.0 * angle.cos(), 2.0 * angle.sin(), 0.0, 1.0];
        fan_wrong += not_one(&counts(subject, &surface, &fan(&mut random, rim))?);
    }
    findings.none_wrong("jittered grids, one fragment a pixel", grid_wrong, ROUNDS * pixels);
    findings.none_wrong("fans, one fragment a pixel", fan_wrong, ROUNDS * pixels);
    centers(subject, findings, &surface, &mut random)?;
    findings.part(|findings| subpixel_bits(subject, findings));
    Ok(())
}

/// 10 by 10 cells of 0.22 over more than the viewport, whose inner corners are moved by less than a quarter of a cell, so
/// that every cell stays convex; diagonals both ways.
fn grid(random: &mut Random) -> Vec<Vertex> {
    const CELLS: usize = 10;
    let place = |index: usize| index as f32 / CELLS as f32 * 2.2 - 1.1;
    let inner = 1..CELLS;
    let mut corners = Vec::new();
    for y in 0..=CELLS {
        for x in 0..=CELLS {
            let moved = if inner.contains(&x) && inner.contains(&y) { 0.05 } else { 0.0 };
            let [dx, dy] = [0; 2].map(|_| random.between(-moved, moved));
            corners.push([place(x) + dx, place(y) + dy, 0.0, 1.0]);
        }
    }
    let at = |x: usize, y: usize| corners[y * (CELLS + 1) + x];
    let cells = (0..CELLS * CELLS).map(|cell| (cell % CELLS, cell / CELLS));
    cells
        .flat_map(|(x, y)| {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            if (x + y) % 2 == 0 {
                [triangle([a, b, c]), triangle([a, c, d])]
            } else {
                [triangle([a, b, d]), triangle([b, c, d])]
            }
        })
        .flatten()
        .collect()
}

/// 17 triangles around a point of the viewport; the rim lies outside of it.
fn fan(random: &mut Random, rim: impl Fn(f32) -> [f32; 4]) -> Vec<Vertex> {
    const COUNT: usize = 17;
    let center = [random.between(-0.9, 0.9), random.between(-0.9, 0.9), 0.0, 1.0];
    let turn = random.unit();
    let corner = |index: usize| rim(((index % COUNT) as f32 + turn) / COUNT as f32 * std::f32::consts::TAU);
    (0..COUNT).flat_map(|index| triangle([center, corner(index), corner(index + 1)])).collect()
}

/// Random triangles against the signs of their edges in f64, but for 3/256 pixel along the edges.
fn centers(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    surface: &Surface,
    random: &mut Random,
) -> Result<(), Error> {
    let mut tally = GradeTally::default();
    for _ in 0..24 {
        let corners = [0; 3].map(|_| [random.between(-1.2, 1.2), random.between(-1.2, 1.2), 0.0, 1.0]);
        let counts = counts(subject, surface, &triangle(corners))?;
        let pixels = corners.map(|[x, y, ..]| [x, y].map(|ndc| (f64::from(ndc) + 1.0) * f64::from(SIDE) / 2.0));
        for (index, count) in counts.into_iter().enumerate() {
            let center = [index as u32 % SIDE, index as u32 / SIDE].map(|place| f64::from(place) + 0.5);
            if let Some(covers) = verify::covers(pixels, center, 3.0 / 256.0) {
                tally.add(verify::within(f64::from(count) - f64::from(u8::from(covers)), 0.0, 0.0), 0.0);
            }
        }
    }
    findings.tally("centres well inside and outside of 24 triangles", tally, "");
    Ok(())
}

/// An edge that rises by 1 in 1024 pixels, raised by 1/1024 pixel 64 times: the number of different crossings shows the
/// grid to which vertices are snapped.
fn subpixel_bits(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const WIDTH: u32 = 1024;
    const STEPS: u32 = 64;
    let surface = subject.bench.surface([WIDTH, 2 * STEPS], None, Some(GlFormat::Depth24Stencil8))?;
    let ndc = |x: f32, y: f32| [x * 2.0 / WIDTH as f32 - 1.0, y / STEPS as f32 - 1.0, 0.0, 1.0];
    let vertices: Vec<_> = (0..STEPS)
        .flat_map(|step| {
            let (row, rise) = ((2 * step) as f32, step as f32 / 1024.0);
            triangle([ndc(0.0, row - rise), ndc(WIDTH as f32, row + 1.0 - rise), ndc(0.0, row + 1.9)])
        })
        .collect();
    let counts = counts(subject, &surface, &vertices)?;
    let crossing = |step: u32| {
        let row = (2 * step * WIDTH) as usize;
        counts[row..row + WIDTH as usize].iter().filter(|count| **count > 0).count()
    };
    let mut crossings: Vec<usize> = (0..STEPS).map(crossing).collect();
    crossings.dedup();
    let bits = (16.0 * crossings.len() as f64).log2().round() as u32;
    let claimed = subject.bench.subpixel_bits();
    findings.fact(
        "bits below the pixel, measured",
        format!("{}{bits}; the driver says {claimed}", if bits >= 10 { "at least " } else { "" }),
    );
    findings.must_hold("vertices keep 4 bits below the pixel", bits >= 4, format!("{bits} bits"));
    Ok(())
}

/// GL-R2: w = 0 and w < 0, planes of one's own.
pub fn clipping(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = surface(subject)?;
    directions(subject, findings, &surface)?;
    let mut random = Random::new(42);
    type Rim = (&'static str, fn(f32) -> [f32; 4]);
    let rims: [Rim; 3] = [
        ("w = 0", |angle| [angle.cos(), angle.sin(), 0.0, 0.0]),
        ("w = 1e-6", |angle| [angle.cos(), angle.sin(), 0.0, 1e-6]),
        ("100,000 viewports away", |angle| [1e5 * angle.cos(), 1e5 * angle.sin(), 0.0, 1.0]),
    ];
    for (name, rim) in rims {
        let (mut wrong, mut count) = (0, 0);
        for _ in 0..8 {
            let counts = counts(subject, &surface, &fan(&mut random, rim))?;
            wrong += not_one(&counts);
            count += counts.len();
        }
        findings.none_wrong(format!("fans with a rim of {name}, one fragment a pixel"), wrong, count);
    }
    behind(subject, findings, &surface, &mut random)?;
    complements(subject, findings, &surface, &mut random)
}

/// Triangles with corners that are directions cover strips and quadrants, to the pixel.
fn directions(subject: &DriverUnderTest, findings: &mut Findings, surface: &Surface) -> Result<(), Error> {
    type Inside = fn(u32, u32) -> bool;
    let strip = [[0.0, -0.5, 0.0, 1.0], [0.0, 0.5, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0]];
    let quadrant = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]];
    let nowhere = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [-1.0, -1.0, 0.0, 0.0]];
    let cases: [(&str, [[f32; 4]; 3], Inside); 3] = [
        ("a strip: one corner with w = 0", strip, |x, y| x >= 32 && (16..48).contains(&y)),
        ("a quadrant: two corners with w = 0", quadrant, |x, y| x >= 32 && y >= 32),
        ("nothing: three corners with w = 0", nowhere, |_, _| false),
    ];
    for (name, corners, inside) in cases {
        let counts = counts(subject, surface, &triangle(corners))?;
        let pixels = counts.iter().enumerate().map(|(index, count)| (index as u32 % SIDE, index as u32 / SIDE, count));
        let wrong = pixels.filter(|&(x, y, count)| *count != u8::from(inside(x, y))).count();
        findings.none_wrong(name, wrong, counts.len());
    }
    Ok(())
}

/// Triangles with corners before, at and behind the eye, against a solution in homogeneous coordinates in f64.
fn behind(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    surface: &Surface,
    random: &mut Random,
) -> Result<(), Error> {
    let mut tally = GradeTally::default();
    for _ in 0..32 {
        let corners = [0; 3].map(|_| {
            let w = random.between(-1.5, 2.5);
            [random.between(-2.0, 2.0), random.between(-2.0, 2.0), random.between(-1.0, 1.0) * w.abs(), w]
        });
        let counts = counts(subject, surface, &triangle(corners))?;
        for (index, count) in counts.into_iter().enumerate() {
            let [x, y] = [index as u32 % SIDE, index as u32 / SIDE].map(|place| f64::from(place) + 0.5);
            let seen =
                |dx: f64, dy: f64| homogeneous(corners, [x + dx, y + dy].map(|at| at * 2.0 / f64::from(SIDE) - 1.0));
            let here = seen(0.0, 0.0);
            const BAND: f64 = 1.0 / 32.0;
            let around = [[BAND, BAND], [-BAND, BAND], [BAND, -BAND], [-BAND, -BAND]];
            if around.iter().all(|[dx, dy]| seen(*dx, *dy) == here) {
                tally.add(verify::within(f64::from(count) - f64::from(u8::from(here)), 0.0, 0.0), 0.0);
            }
        }
    }
    findings.tally("32 triangles with corners behind the eye", tally, "");
    Ok(())
}

/// Tests whether a point of normalised device coordinates lies in a triangle's part before the eye and between near and far:
/// the weights w of its corners solve sum w (x, y, w) = (X, Y, 1).
fn homogeneous(corners: [[f32; 4]; 3], [x, y]: [f64; 2]) -> bool {
    let rows = corners.map(|corner| corner.map(f64::from)).map(|[x, y, _, w]| [x, y, w]);
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let whole = dot(rows[0], cross(rows[1], rows[2]));
    let weights = [0, 1, 2].map(|index| dot(cross(rows[(index + 1) % 3], rows[(index + 2) % 3]), [x, y, 1.0]) / whole);
    let z: f64 = weights.iter().zip(corners).map(|(weight, corner)| weight * f64::from(corner[2])).sum();
    weights.iter().all(|weight| *weight > 0.0) && z.abs() <= 1.0
}

/// Tests that a plane and its opposite clip complementary parts, each pixel once.
fn complements(
    subject: &DriverUnderTest,
    findings: &mut Findings,
    surface: &Surface,
    random: &mut Random,
) -> Result<(), Error> {
    const SHADER: Shader = Shader {
        declarations: "uniform float side;\n#ifdef VERTEX\nout float gl_ClipDistance[2];\n#endif",
        vertex: "gl_Position = position; passed = value; gl_ClipDistance[0] = side * value.x; gl_ClipDistance[1] = side * value.y;",
        ..Shader::PLAIN
    };
    let (mut wrong, mut count, mut cut) = (0, 0, 0);
    for _ in 0..8 {
        let [a, b, c] = [0; 3].map(|_| random.between(-1.0, 1.0));
        let vertices = full(0.0).map(|mut vertex| {
            vertex.value[0] = a * vertex.position[0] + b * vertex.position[1] + 0.5 * c;
            vertex.value[1] = -1.0;
            vertex
        });
        let drawn = |draws: &[(f32, u32)]| {
            surface.clear_stencil(0);
            for &(side, clip_distances) in draws {
                let uniforms = [("side", GlUniform::Float(side))];
                let plain = GlDraw::plain(surface, GlState { clip_distances, ..COUNT }, &vertices);
                subject.bench.draw(&GlDraw { shader: SHADER, uniforms: &uniforms, ..plain })?;
            }
            Ok::<_, Error>(surface.stencils())
        };
        // The second distance is never enabled, and would leave nothing of one of the two.
        let counts = drawn(&[(1.0, 1), (-1.0, 1)])?;
        wrong += not_one(&counts);
        count += counts.len();
        cut += not_one(&drawn(&[(-1.0, 0)])?);
    }
    findings.none_wrong("a clip plane and its opposite", wrong, count);
    findings.none_wrong("clip distances that are written, none of them enabled", cut, count);
    Ok(())
}
