//! A light's shadow map in numbers that bound the error of a picture. Lengths are in world units.

use crate::pass::{DepthFormat, Face, PolygonOffset};

/// A light's shadow map in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapInfo {
    /// Index into [`crate::scene::Scene::lights`].
    pub light: usize,
    pub shape: MapShape,
    /// Texels a side of the first level; for a cube, a side of each face.
    pub size: u32,
    /// Number of levels; 1 without mipmaps. A texel of level n, from 0, is 2^n times as wide as `texel`.
    pub levels: u32,
    pub format: DepthFormat,
    /// The width of a texel along its longer side. For a parallel map, anywhere. For a perspective map, at a distance of 1
    /// along its axis: at a distance d along that axis (for a cube, the face's axis) it is d times as wide.
    pub texel: f64,
    /// The width of a texel along its shorter side, as `texel`.
    pub texel_short: f64,
    /// Reach of one lookup from its point along each axis of the map, in texels: the kernel's taps, the texels that each
    /// tap's filter weighs, and the movement of the point by a normal offset. With several levels, in texels of the first
    /// under "8-tap", and of the finer one of the two that are used under `mipmaps = true`.
    pub reach_texels: f64,
    pub bias: Bias,
    /// Faces that the map leaves out, as the light sees them.
    pub cull: Option<Face>,
    /// The polygon offset that the map is drawn with, positive away from the light; 0 for techniques that need none.
    pub polygon: PolygonOffset,
    /// Movement of a receiver towards the light before it is compared, in widths of a texel at the receiver.
    pub texels: f64,
    /// True if a texel holds the middle between the two nearest layers, in place of the nearest one.
    pub middle: bool,
}

/// The frustum of a map, and the depths that it can hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MapShape {
    /// One frustum. At a distance d along its axis the depth is `far (d - near) / (d (far - near))`, from 0 to 1.
    Spot { near: f64, far: f64 },
    /// Six faces, each a frustum as a spotlight's.
    Cube { near: f64, far: f64 },
    /// A box across the rays. Depth is linear, from 0 to 1 over the length `depth`.
    Parallel { depth: f64 },
}

/// Bias: keeps a surface from shading itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bias {
    /// glPolygonOffset while the map is drawn [HSM, "Why Is Polygon Offset Needed?"].
    Offset,
    /// The reference follows the receiver's plane to each tap, and is moved back by the reach of the tap's filter [Isidoro
    /// 2006].
    ReceiverPlane,
    /// The receiver is looked up a little off its surface.
    NormalOffset,
    /// The reference is the receiver's plane at each texel's centre [Dou 2014].
    Adaptive,
}
