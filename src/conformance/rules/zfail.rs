//! GL-S5: volumes counted where the depth test fails, under depth clamp, with parts behind the eye and beyond the far
//! plane [GL 4.6, 13.7, 17.3.3].

use crate::conformance::bench::{
    Error, GlCompare, GlDraw, GlFormat, GlState, GlStencil, GlStencilOp, Surface, Vertex, triangle,
};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 48;
const NEAR: f64 = 0.5;
const FAR: f64 = 12.0;
/// Distance from a volume's faces within which a point may lie on either side: far more than a sub-pixel's and a code's
/// worth of the plane that is seen.
const BAND: f64 = 0.03;

type Point = [f64; 3];

fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Clip space of a camera at the origin that looks along -z, 90 degrees.
fn clip_from_eye([x, y, z]: Point) -> [f32; 4] {
    let depth = -(FAR + NEAR) / (FAR - NEAR) * z - 2.0 * FAR * NEAR / (FAR - NEAR);
    [x, y, depth, -z].map(|value| value as f32)
}

/// A triangle and its shadow away from a point, to a finite distance: a convex body, its corners and its triangles, which
/// wind counter-clockwise seen from outside.
struct Volume {
    near: [Point; 3],
    far: [Point; 3],
}

impl Volume {
    fn random(random: &mut Random) -> Self {
        let mut between = |low: f32, high: f32| f64::from(random.between(low, high));
        let light = [between(-4.0, 4.0), between(2.0, 5.0), between(-8.0, 6.0)];
        let mut near = [(); 3].map(|()| [between(-5.0, 5.0), between(-1.0, 2.0), between(-9.0, 4.0)]);
        if dot(cross(minus(near[1], near[0]), minus(near[2], near[0])), minus(near[0], light)) > 0.0 {
            near.swap(1, 2);
        }
        let length = between(1.5, 4.0);
        let far = near.map(|corner| [0, 1, 2].map(|axis| light[axis] + (corner[axis] - light[axis]) * length));
        Self { near, far }
    }

    fn triangles(&self) -> Vec<[Point; 3]> {
        let (near, far) = (self.near, self.far);
        let mut triangles = vec![near, [far[0], far[2], far[1]]];
        for edge in 0..3 {
            let next = (edge + 1) % 3;
            triangles.push([near[edge], far[edge], far[next]]);
            triangles.push([near[edge], far[next], near[next]]);
        }
        triangles
    }

    /// Tests whether the point is inside; `None` near a face.
    fn contains(&self, point: Point) -> Option<bool> {
        let distances = self.triangles().into_iter().map(|[a, b, c]| {
            let normal = cross(minus(b, a), minus(c, a));
            dot(normal, minus(point, a)) / dot(normal, normal).sqrt()
        });
        let most = distances.fold(f64::MIN, f64::max);
        (most.abs() > BAND).then_some(most < 0.0)
    }

    /// Tests whether some corners lie behind the eye, and others before it.
    fn crosses_the_eye(&self) -> bool {
        let behind = self.near.iter().chain(&self.far).filter(|corner| corner[2] > -NEAR).count();
        (1..6).contains(&behind)
    }
}

/// A floor that rises from before the near plane towards the far one: y = a z + b.
const FLOOR: [f64; 2] = [0.06, -0.9];

/// The point of the floor behind a pixel, if it lies between near and far.
fn seen(pixel: [u32; 2]) -> Option<Point> {
    let [x, y] = pixel.map(|at| (f64::from(at) + 0.5) * 2.0 / f64::from(SIDE) - 1.0);
    // The ray is t (x, y, -1).
    let t = FLOOR[1] / (y + FLOOR[0]);
    (t > NEAR + BAND && t < FAR - 0.5).then_some([x * t, y * t, -t])
}

/// GL-S5: counts by z-fail against the number of volumes that contain the visible point.
pub fn counts(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    for format in [GlFormat::Depth24Stencil8, GlFormat::Depth32FStencil8] {
        findings.part(|findings| {
            let surface = subject.bench.surface([SIDE; 2], None, Some(format))?;
            let mut random = Random::new(35);
            let (mut tally, mut inside) = (GradeTally::default(), 0);
            for _ in 0..12 {
                let volumes: Vec<Volume> = std::iter::repeat_with(|| Volume::random(&mut random))
                    .filter(Volume::crosses_the_eye)
                    .take(3)
                    .collect();
                inside += count(subject, &surface, &volumes, &mut tally)?;
            }
            let what = format!("{}: 36 volumes across the eye, depth clamp, by z-fail", format.name());
            findings.tally(what, tally, "");
            let what = format!("{}: some points lie inside", format.name());
            findings.must_hold(what, inside > 100, format!("{inside} pixels"));
            Ok(())
        });
    }
    Ok(())
}

/// Counts these volumes over the floor; the number of pixels that lie in at least one.
fn count(
    subject: &DriverUnderTest,
    surface: &Surface,
    volumes: &[Volume],
    tally: &mut GradeTally,
) -> Result<usize, Error> {
    surface.clear_depth(1.0);
    surface.clear_stencil(0);
    let corner = |x: f64, z: f64| clip_from_eye([x, FLOOR[0] * z + FLOOR[1], z]);
    let corners = [corner(-20.0, 1.0), corner(20.0, 1.0), corner(20.0, -FAR), corner(-20.0, -FAR)];
    let floor: Vec<Vertex> =
        [[0, 1, 2], [0, 2, 3]].iter().flat_map(|ids| triangle(ids.map(|id| corners[id]))).collect();
    subject.bench.draw(&GlDraw::plain(surface, GlState { depth: Some(GlCompare::Less), ..GlState::WRITE }, &floor))?;
    let on_fail = |op| GlStencil { ops: [GlStencilOp::Keep, op, GlStencilOp::Keep], ..GlStencil::on_pass(op) };
    let state = GlState {
        depth: Some(GlCompare::Less),
        depth_write: false,
        depth_clamp: true,
        color_write: false,
        // Fronts may come first: counts go below 0 and back.
        stencil: Some([on_fail(GlStencilOp::DecrementWrap), on_fail(GlStencilOp::IncrementWrap)]),
        ..GlState::WRITE
    };
    let triangles = volumes.iter().flat_map(Volume::triangles);
    let vertices: Vec<Vertex> = triangles.flat_map(|corners| triangle(corners.map(clip_from_eye))).collect();
    subject.bench.draw(&GlDraw::plain(surface, state, &vertices))?;
    let mut inside = 0;
    for (index, value) in surface.stencils().into_iter().enumerate() {
        let Some(point) = seen([index as u32 % SIDE, index as u32 / SIDE]) else { continue };
        let holds: Option<Vec<bool>> = volumes.iter().map(|volume| volume.contains(point)).collect();
        let Some(due) = holds.map(|holds| holds.into_iter().filter(|inside| *inside).count()) else { continue };
        inside += usize::from(due > 0);
        tally.add(verify::within(f64::from(value) - due as f64, 0.0, 0.0), 0.0);
    }
    Ok(inside)
}
