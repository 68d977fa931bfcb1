//! GL-K11: depth and varyings of triangles that the view volume cuts [GL 4.6, 13.7, 13.7.1, 14.6.1].

use glam::{DMat3, DVec3};

use crate::conformance::bench::{Error, GlCompare, GlDraw, GlFormat, GlState, Shader, Surface, Vertex};
use crate::conformance::random::Random;
use crate::conformance::verify::{self, GradeTally};
use crate::conformance::{DriverUnderTest, Findings};

const SIDE: u32 = 32;
/// The clip position is a varying too: it says of each fragment where it must lie. `passed` is the vertex's position.
const SHADER: Shader = Shader {
    version: "#version 150",
    declarations: "",
    vertex: "gl_Position = position; passed = position;",
    fragment: "result = vec4(passed.xyz / passed.w, passed.w * gl_FragCoord.w);",
};

/// A kind of triangles that the near or the far plane cuts, or an edge far away.
#[derive(Clone, Copy)]
struct Kind {
    name: &'static str,
    /// Ranges of a corner's w, before the plane and behind it.
    w: [[f32; 2]; 2],
    /// The reach of x / w and y / w.
    reach: f32,
    /// z / w of corners before the plane, and behind it.
    z: [[f32; 2]; 2],
}

const KINDS: [Kind; 4] = [
    Kind { name: "across the near plane", w: [[1.0, 4.0], [1.0, 4.0]], reach: 2.0, z: [[-0.5, 0.5], [-4.0, -2.0]] },
    Kind { name: "across the far plane", w: [[1.0, 4.0], [1.0, 4.0]], reach: 2.0, z: [[-0.5, 0.5], [2.0, 4.0]] },
    Kind {
        name: "with a corner behind the eye",
        w: [[1.0, 4.0], [-4.0, -1.0]],
        reach: 2.0,
        z: [[-0.5, 0.5], [1.5, 3.0]],
    },
    Kind {
        name: "with corners thousands of viewports away",
        w: [[1.0, 4.0], [1.0, 4.0]],
        reach: 3000.0,
        z: [[-0.5, 0.5], [-0.5, 0.5]],
    },
];

fn corner(random: &mut Random, kind: Kind, behind: bool) -> Vertex {
    let side = usize::from(behind);
    let [w, z] = [kind.w[side], kind.z[side]].map(|[low, high]| random.between(low, high));
    let [x, y] = [(); 2].map(|()| random.between(-kind.reach, kind.reach));
    Vertex {
        position: [x * w.abs(), y * w.abs(), z * w.abs().min(4.0) * if behind { 1.0 } else { w.signum() }, w],
        value: [0.0; 4],
    }
}

/// GL-K11: triangles of each kind, one to a draw.
pub fn clipped(subject: &DriverUnderTest, findings: &mut Findings) -> Result<(), Error> {
    let surface = subject.bench.surface([SIDE; 2], Some(GlFormat::Rgba32F), Some(GlFormat::Depth32F))?;
    for kind in KINDS {
        let mut random = Random::new(401);
        let mut tallies = [GradeTally::default(); 3];
        for number in 0..60 {
            let behind = [false, number % 2 == 1, true];
            let vertices: Vec<_> = behind.into_iter().map(|behind| corner(&mut random, kind, behind)).collect();
            surface.clear_color([7.0; 4]);
            surface.clear_depth(1.0);
            let state = GlState { depth: Some(GlCompare::Always), ..GlState::WRITE };
            subject.bench.draw(&GlDraw { shader: SHADER, ..GlDraw::plain(&surface, state, &vertices) })?;
            let bits = subject.bench.subpixel_bits().min(8) as i32;
            let sub_pixel = 2.0 / f64::from(SIDE) * f64::from(-bits).exp2();
            judge(&surface, if kind.reach > 100.0 { 16.0 } else { 1.0 } * sub_pixel, slope(&vertices), &mut tallies);
        }
        let [places, depths, shares] = tallies;
        findings.tally(format!("varyings of triangles {}", kind.name), places, "sub-pixels");
        findings.tally(format!("depths of triangles {}", kind.name), depths, "sub-pixels");
        findings.tally(format!("gl_FragCoord.w of triangles {}", kind.name), shares, "2^-16");
    }
    Ok(())
}

/// Change of z / w in one unit of x / w and of y / w, together: the plane through three clip positions.
fn slope(corners: &[Vertex]) -> f64 {
    let column = |part: usize| {
        let [a, b, c] = [0, 1, 2].map(|corner| f64::from(corners[corner].position[part]));
        DVec3::new(a, b, c)
    };
    let plane = DMat3::from_cols(column(0), column(1), column(3)).inverse() * column(2);
    plane.x.abs() + plane.y.abs()
}

/// Each fragment lies where the interpolated position says, at the depth that it says. Vertices are moved to whole
/// sub-pixels, and values may be of the vertices as they were.
fn judge(surface: &Surface, sub_pixel: f64, slope: f64, [places, depths, shares]: &mut [GradeTally; 3]) {
    for (index, (seen, depth)) in (0..).zip(surface.floats().into_iter().zip(surface.depths())) {
        if seen[3] == 7.0 {
            continue;
        }
        let center = |at: u32| (f64::from(at) + 0.5) * 2.0 / f64::from(SIDE) - 1.0;
        let due = [center(index % SIDE), center(index / SIDE), 2.0 * depth - 1.0, 1.0];
        let off = [0, 1].map(|part| (f64::from(seen[part]) - due[part]).abs());
        let off = off.into_iter().fold(0.0_f64, |most, off| if off.is_nan() { f64::INFINITY } else { most.max(off) });
        places.add(verify::within(off, sub_pixel, 4.0 * sub_pixel), off / sub_pixel);
        let off = (f64::from(seen[2]) - due[2]).abs();
        let off = if off.is_nan() { f64::INFINITY } else { off };
        let strict = sub_pixel * (0.25 + slope);
        depths.add(verify::within(off, strict, 2.0 * strict), off / strict);
        // 1 / w and w of one point, wherever it lies: a few parts in 10^5.
        let off = (f64::from(seen[3]) - due[3]).abs();
        let off = if off.is_nan() { f64::INFINITY } else { off };
        shares.add(verify::within(off, 4.0 / 65536.0, 8.0 / 65536.0), off * 65536.0);
    }
}
