//! GL-S3: closed shadow volumes to infinity [GL 4.6, 13.7, 14.6.1]: ways in and out cancel, and the far cap lies at 1.

use crate::conformance::bench::{Error, GlCompare, GlDraw, GlFormat, GlState, GlStencilOp, triangle};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, Grade, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

/// Pixels along a side.
const SIDE: u32 = 64;
const NEAR: f32 = 0.5;

/// Clip space of a camera at the origin that looks along -z, 90 degrees, with its far plane at infinity: a direction
/// (w = 0) gets z = w, without rounding.
fn clip_from_eye([x, y, z, w]: [f32; 4]) -> [f32; 4] {
    [x, y, -z - 2.0 * NEAR * w, -z]
}

/// The volume of a triangle before the camera, away from a light at `light`: triangles that wind counter-clockwise seen
/// from outside.
fn volume(caster: [[f32; 3]; 3], light: [f32; 3]) -> Vec<[[f32; 4]; 3]> {
    let near = caster.map(|[x, y, z]| [x, y, z, 1.0]);
    let far = caster.map(|[x, y, z]| [x - light[0], y - light[1], z - light[2], 0.0]);
    let mut triangles = vec![[near[0], near[1], near[2]], [far[0], far[2], far[1]]];
    for edge in 0..3 {
        let next = (edge + 1) % 3;
        triangles.push([near[edge], far[edge], far[next]]);
        triangles.push([near[edge], far[next], near[next]]);
    }
    triangles
}

/// A caster of the camera's view that faces the light, and its volume, wholly beyond the near plane.
fn random_volume(random: &mut Random) -> Vec<[[f32; 4]; 3]> {
    let light = [random.between(-3.0, 3.0), random.between(-3.0, 3.0), random.between(0.5, 3.0)];
    let mut caster = [0; 3].map(|_| {
        let z = random.between(-9.0, -1.5);
        [random.between(z, -z), random.between(z, -z), z]
    });
    let [a, b, c] = caster.map(|corner| [corner[0] - light[0], corner[1] - light[1], corner[2] - light[2]]);
    let facing =
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    if facing > 0.0 {
        caster.swap(1, 2);
    }
    volume(caster, light)
}

/// GL-S3: net counts, and the far cap's depth.
pub fn closure(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    const VOLUMES: usize = 48;
    let surface = subject.bench.surface([SIDE; 2], None, Some(GlFormat::Depth24Stencil8))?;
    let mut random = Random::new(33);
    let (mut broken, mut entered) = (0, 0);
    for _ in 0..VOLUMES {
        let triangles = random_volume(&mut random);
        let vertices: Vec<_> = triangles.iter().flat_map(|corners| triangle(corners.map(clip_from_eye))).collect();
        let count = |front, back| {
            surface.clear_stencil(128);
            subject.bench.draw(&GlDraw::plain(&surface, GlState::counting(front, back), &vertices))?;
            Ok::<_, Error>(surface.stencils().into_iter().filter(|value| *value != 128).count())
        };
        broken += count(GlStencilOp::IncrementWrap, GlStencilOp::DecrementWrap)?;
        entered += count(GlStencilOp::IncrementWrap, GlStencilOp::Keep)?;
    }
    findings.none_wrong(format!("{VOLUMES} volumes to infinity, net count by pixel"), broken, entered);
    wrapped(subject, findings)?;
    for format in [GlFormat::Depth16, GlFormat::Depth24, GlFormat::Depth32F] {
        findings.part(|findings| far_cap(subject, findings, format));
    }
    Ok(())
}

/// Three hundred volumes in one another: counts pass 255 and come back.
fn wrapped(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([16; 2], None, Some(GlFormat::Depth24Stencil8))?;
    let one = volume([[-1.0, -1.0, -2.0], [1.0, -1.0, -2.0], [0.0, 1.0, -2.0]], [0.0, 0.0, 1.0]);
    let fronts = one.iter().flat_map(|corners| triangle(corners.map(clip_from_eye))).collect::<Vec<_>>();
    let all: Vec<_> = (0..300).flat_map(|_| fronts.clone()).collect();
    surface.clear_stencil(0);
    // All that enters first, then all that leaves.
    let enter = GlState::counting(GlStencilOp::IncrementWrap, GlStencilOp::Keep);
    subject.bench.draw(&GlDraw::plain(&surface, enter, &all))?;
    let entered = surface.stencils().into_iter().filter(|value| *value == 300_u32 as u8).count();
    let leave = GlState::counting(GlStencilOp::Keep, GlStencilOp::DecrementWrap);
    subject.bench.draw(&GlDraw::plain(&surface, leave, &all))?;
    let broken = surface.stencils().into_iter().filter(|value| *value != 0).count();
    findings.none_wrong("300 volumes in one another, wrapped counts", broken, entered);
    Ok(())
}

/// Triangles whose corners are all directions lie at depth 1, and fail LESS against a cleared 1.
fn far_cap(subject: &DriverUnderTest, findings: &mut Findings, format: GlFormat) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], None, Some(format))?;
    let Some(encoding) = surface.depth_image().map(|image| image.encoding) else { return Ok(()) };
    let mut random = Random::new(34);
    let vertices: Vec<_> = (0..64)
        .flat_map(|_| {
            let corners =
                [0; 3].map(|_| [random.between(-2.0, 2.0), random.between(-2.0, 2.0), -random.between(0.3, 3.0), 0.0]);
            triangle(corners.map(clip_from_eye))
        })
        .collect();
    surface.clear_depth(0.0);
    subject.bench.draw(&GlDraw::plain(&surface, GlState::WRITE, &vertices))?;
    let mut tally = GradeTally::default();
    for depth in surface.depths().into_iter().filter(|depth| *depth > 0.0) {
        let codes = (1.0 - depth) / encoding.step(0.75);
        tally.add(verify::within(codes, 0.0, 1.0 + 1e-6), codes);
    }
    findings.tally(format!("{}: the cap at infinity", format.name()), tally, "codes before 1");
    surface.clear_depth(1.0);
    subject.bench.draw(&GlDraw::plain(
        &surface,
        GlState { depth: Some(GlCompare::Less), ..GlState::WRITE },
        &vertices,
    ))?;
    let passed = surface.depths().into_iter().filter(|depth| *depth != 1.0).count();
    let grade = if passed == 0 { Grade::Good } else { Grade::Allowed };
    findings.grade(
        format!("{}: that cap and LESS against a cleared 1", format.name()),
        grade,
        format!("{passed} pixels pass"),
    );
    Ok(())
}
