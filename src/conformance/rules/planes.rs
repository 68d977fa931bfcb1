//! Planes of GL-T3: stored depths against the plane through a triangle's corners in f64, near the framebuffer's origin and
//! far from it; and the weights of interpolation with perspective.

use crate::conformance::bench::{Error, GlDraw, GlFormat, GlState, Surface, triangle};
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Corners in window space: x and y in pixels, z in [0, 1], of a square viewport at `origin`.
pub fn window(clip: [[f32; 4]; 3], origin: [f64; 2], side: f64) -> [[f64; 3]; 3] {
    clip.map(|position| {
        let [x, y, z, w] = position.map(f64::from);
        [origin[0] + (x / w + 1.0) * side / 2.0, origin[1] + (y / w + 1.0) * side / 2.0, (z / w + 1.0) / 2.0]
    })
}

/// Weights of the corners at a point, linear in window space.
pub fn weights(corners: [[f64; 3]; 3], at: [f64; 2]) -> [f64; 3] {
    let area = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let [a, b, c] = corners.map(|corner| [corner[0], corner[1]]);
    let whole = area(a, b, c);
    [area(at, b, c) / whole, area(a, at, c) / whole, area(a, b, at) / whole]
}

/// Weights with perspective: each over its corner's w [GL 4.6, 14.6.1].
pub fn perspective_weights(corners: [[f64; 3]; 3], clip: [[f32; 4]; 3], at: [f64; 2]) -> [f64; 3] {
    let linear = weights(corners, at);
    let over = [0, 1, 2].map(|corner| linear[corner] / f64::from(clip[corner][3]));
    let sum: f64 = over.iter().sum();
    over.map(|weight| weight / sum)
}

/// Depth of the plane at a point, and its slope along x and along y.
fn plane(corners: [[f64; 3]; 3], at: [f64; 2]) -> (f64, [f64; 2]) {
    let depth = |at| weights(corners, at).iter().zip(corners).map(|(weight, corner)| weight * corner[2]).sum::<f64>();
    let here = depth(at);
    (here, [depth([at[0] + 1.0, at[1]]) - here, depth([at[0], at[1] + 1.0]) - here])
}

/// Stored depths inside of the triangle against its plane.
fn compare(subject: &DriverUnderTest, surface: &Surface, corners: [[f64; 3]; 3], area: [i32; 4]) -> (GradeTally, f64) {
    let (mut tally, mut worst) = (GradeTally::default(), 0.0_f64);
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return (tally, worst) };
    let stored = surface.depths_in(area);
    for (index, stored) in stored.iter().enumerate() {
        let [x, y] = [index as i32 % area[2], index as i32 / area[2]];
        let at = [f64::from(area[0] + x) + 0.5, f64::from(area[1] + y) + 0.5];
        if verify::covers(corners.map(|corner| [corner[0], corner[1]]), at, 0.05) != Some(true) {
            continue;
        }
        let (depth, slope) = plane(corners, at);
        let error = stored - depth;
        let codes = error.abs() / encoding.step(0.75);
        worst = worst.max(codes);
        tally.add(verify::plane_depth(error, slope, subject.bench.subpixel_bits(), encoding), codes);
    }
    (tally, worst)
}

/// Triangles of several slopes on a small surface.
pub fn near_origin(subject: &DriverUnderTest, findings: &mut Findings) {
    const SIZE: i32 = 64;
    const SHAPES: [[[f32; 4]; 3]; 3] = [
        [[-1.0, -1.0, -0.9, 1.0], [1.0, -0.75, 0.3, 1.0], [-0.5, 1.0, 0.7, 1.0]],
        [[-0.5, -0.25, -1.0, 1.0], [0.0, -0.25, 1.0, 1.0], [-0.25, 0.75, 0.1, 1.0]],
        [[-1.0, -1.0, 0.0, 1.0], [2.0, -2.0, 1.0, 2.0], [-2.0, 4.0, 3.0, 4.0]],
    ];
    for format in [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth32F] {
        findings.part(|findings| {
            let surface = subject.bench.surface([SIZE as u32; 2], None, Some(format))?;
            let mut whole = GradeTally::default();
            for clip in SHAPES {
                subject.bench.draw(&GlDraw::plain(&surface, GlState::WRITE, &triangle(clip)))?;
                let corners = window(clip, [0.0; 2], f64::from(SIZE));
                let (tally, _) = compare(subject, &surface, corners, [0, 0, SIZE, SIZE]);
                whole.good += tally.good;
                whole.allowed += tally.allowed;
                whole.wrong += tally.wrong;
                whole.worst = whole.worst.max(tally.worst);
            }
            findings.tally(format!("{}: depth of planes near the origin", format.name()), whole, "codes");
            Ok(())
        });
    }
}

/// A steep triangle of 12 pixels at growing distances. Its corners are whole pixels, exact in clip space and in window
/// space, so that all error is of the plane.
pub fn far_from_origin(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let side = subject.bench.largest_side().min(2048) as i32;
    let surface = subject.bench.surface([side as u32; 2], None, Some(GlFormat::Depth24))?;
    let mut row = Vec::new();
    let mut whole = GradeTally::default();
    for distance in [0, 16, 64, 256, 1024, 2032] {
        if distance + 16 > side {
            continue;
        }
        let clip = [[0, 0], [12, 0], [0, 12]].map(|[x, y]| {
            let [x, y] = [x, y].map(|offset: i32| (distance + offset) as f32 * 2.0 / side as f32 - 1.0);
            [x, y, 0.0, 1.0]
        });
        let mut clip = clip;
        for (corner, z) in clip.iter_mut().zip([-0.95, 0.93, 0.87]) {
            corner[2] = z;
        }
        let area = [distance, distance, 12, 12];
        let state = GlState { scissor: Some(area), ..GlState::WRITE };
        subject.bench.draw(&GlDraw::plain(&surface, state, &triangle(clip)))?;
        let (tally, worst) = compare(subject, &surface, window(clip, [0.0; 2], f64::from(side)), area);
        row.push(format!("{worst:.0} at {distance}"));
        whole.good += tally.good;
        whole.allowed += tally.allowed;
        whole.wrong += tally.wrong;
        whole.worst = whole.worst.max(tally.worst);
    }
    findings.tally("DEPTH_COMPONENT24: depth of a steep plane far from the origin", whole, "codes");
    findings.fact("depth error (codes of 24 bits) at pixels from the origin, slope 0.08 a pixel", row.join(", "));
    Ok(())
}
