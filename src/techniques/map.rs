//! A light's shadow map in numbers that bound the error of a picture. Lengths are in world units.

use super::FrustumView;
use super::projector::{Projector, Rays};
use super::shadow_map::settings::Settings;
use super::shadow_map::{bias, fit};
use crate::pass::{DepthFormat, Face, PolygonOffset};
use crate::scene::LightKind;

pub use super::shadow_map::settings::Bias;

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

impl MapInfo {
    /// Describes a map as its projector sees it, one face of a cube or the whole of a square map, drawn without polygon offset.
    pub(super) fn new(view: &FrustumView<'_>, settings: &Settings, texels: f64) -> Self {
        Self {
            light: view.index,
            shape: shape(&view.light().kind, &view.projector),
            size: settings.size,
            levels: bias::levels(settings),
            format: settings.format,
            texel: bias::texel_at_one(&view.projector, settings),
            reach_texels: fit::lookup_texels(settings, slant(&view.projector)),
            bias: settings.bias,
            cull: settings.cull,
            polygon: PolygonOffset { factor: 0.0, units: 0.0 },
            texels,
            middle: false,
        }
    }
}

/// The secant of the angle between the axis and the corner of the frustum; 1 for parallel light.
fn slant(projector: &Projector) -> f64 {
    match projector.rays {
        Rays::From { .. } => (1.0 + 0.5 * projector.extent(1.0).powi(2)).sqrt(),
        Rays::Along(_) => 1.0,
    }
}

fn shape(kind: &LightKind, projector: &Projector) -> MapShape {
    match kind {
        LightKind::Spot(spot) => MapShape::Spot { near: spot.frustum.near, far: spot.frustum.far },
        LightKind::Point(point) => MapShape::Cube { near: point.near, far: point.far },
        LightKind::Directional { .. } => MapShape::Parallel { depth: 2.0 / projector.clip_from_light.z_axis.z.abs() },
    }
}
