//! The floors of the techniques: each the fewest GL calls to its picture. Says which maps are drawn, from where, and with
//! what shader; knows no GL.

use glam::camera::rh::proj::opengl;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3};

use super::numbers::Numbers;

/// Kinds of picture that the floor draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// One map, one comparison.
    Map,
    Kernel,
    EightTaps,
    ReceiverPlane,
    NormalOffset,
    Adaptive,
    Midpoint,
    SecondDepth,
    /// A point light's cube, all six faces.
    Cube,
    /// The one face that a light above the middle needs.
    Face,
    Parallel,
    /// A slide projector's three passes, of a plain square.
    Slide,
    /// The shade in destination alpha.
    AlphaShadow,
    /// A light through a lens: a map and an added pass for each of its points.
    Lens,
    /// The map's picture under dusty air.
    Dust,
}

/// The dust of [`Kind::Dust`], over each other.
pub const DUST_SLICES: u32 = 64;
pub const DUST_DENSITY: f32 = 0.1;

/// The lens of [`Kind::Lens`].
pub const LENS_POINTS: u32 = 64;
pub const LENS_DISTANCE: f32 = 5.0;
pub const LENS_RADIUS: f32 = 0.25;

/// The shader that finds the shade, glumbra's own where it is more than one lookup: the floor is of calls.
pub fn shade(kind: Kind) -> (&'static str, String) {
    const MAP: &str = include_str!("../../glsl/shadow_map/map.glsl");
    const CLOSER: &str = include_str!("../../glsl/shadow_map/percentage_closer.glsl");
    const KERNEL: &str = include_str!("../../glsl/shadow_map/kernel.frag");
    const SLOPE: &str = include_str!("../../glsl/shadow_map/slope.glsl");
    let of = |chunks: &[&str]| chunks.concat().replace('@', "0");
    match kind {
        Kind::Kernel => ("#define SHADE\n#define KERNEL_0 3\n", of(&[MAP, CLOSER, KERNEL])),
        Kind::ReceiverPlane => (
            "#define SHADE\n#define DERIVE\n#define KERNEL_0 1\n",
            of(&[MAP, CLOSER, SLOPE, include_str!("../../glsl/shadow_map/receiver_plane.frag")]),
        ),
        Kind::NormalOffset => (
            "#define SHADE\n#define DERIVE\n#define KERNEL_0 1\n#define NORMAL_OFFSET_0\n#define CLAMP_REFERENCE_0\n",
            of(&[MAP, CLOSER, include_str!("../../glsl/shadow_map/normal_offset.frag"), KERNEL]),
        ),
        Kind::Adaptive => (
            "#define SHADE\n#define DERIVE\n#define KERNEL_0 1\n",
            of(&[
                MAP,
                SLOPE,
                include_str!("../../glsl/shadow_map/adaptive.glsl"),
                include_str!("../../glsl/shadow_map/adaptive_linear.frag"),
            ]),
        ),
        Kind::Cube | Kind::Face => ("#define CUBE\n", String::new()),
        Kind::Parallel => ("#define PARALLEL\n", String::new()),
        Kind::Lens => ("#define LENS\n", String::new()),
        Kind::Map | Kind::EightTaps | Kind::Midpoint | Kind::SecondDepth => ("", String::new()),
        Kind::Slide | Kind::AlphaShadow | Kind::Dust => ("", String::new()),
    }
}

/// Position of the light.
pub fn light(kind: Kind, numbers: &Numbers) -> Vec3 {
    if kind == Kind::Face { Vec3::new(0.0, 5.0, 0.0) } else { numbers.light }
}

/// The light's projection and view.
pub fn light_matrices(kind: Kind, numbers: &Numbers) -> (Mat4, Mat4) {
    let [near, far] = numbers.light_near_far;
    let view = look_at_mat4(numbers.light, numbers.light_target, Vec3::Y);
    if kind == Kind::Parallel {
        // Around what casts: the floor has nothing behind it, and what is looked up beside the map is lit.
        let half = 0.56;
        let corners: Vec<Vec3> = (0..8)
            .map(|k| {
                let side = |bit: u32| if k >> bit & 1 == 1 { half } else { -half };
                view.transform_point3(Vec3::new(side(0), if k & 2 == 2 { 1.62 } else { -0.02 }, side(2)))
            })
            .collect();
        let low = corners.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = corners.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        return (opengl::orthographic(low.x, high.x, low.y, high.y, -high.z - 1.0, -low.z + 1.0), view);
    }
    (opengl::perspective(numbers.cone_degrees.to_radians(), 1.0, near, far), view)
}

/// `clip_from_world` of a face of the cube, as GL numbers them.
pub fn face(index: usize, kind: Kind, numbers: &Numbers) -> Mat4 {
    let (way, up) = [
        (Vec3::X, -Vec3::Y),
        (-Vec3::X, -Vec3::Y),
        (Vec3::Y, Vec3::Z),
        (-Vec3::Y, -Vec3::Z),
        (Vec3::Z, -Vec3::Y),
        (-Vec3::Z, -Vec3::Y),
    ][index];
    let [near, far] = numbers.light_near_far;
    let eye = light(kind, numbers);
    opengl::perspective(std::f32::consts::FRAC_PI_2, 1.0, near, far) * look_at_mat4(eye, eye + way, up)
}

/// The faces that are drawn.
pub fn faces(kind: Kind) -> std::ops::Range<usize> {
    match kind {
        Kind::Cube => 0..6,
        Kind::Face => 3..4,
        _ => 0..0,
    }
}
