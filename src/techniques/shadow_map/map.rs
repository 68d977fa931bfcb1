//! A shadow map in numbers: see [`MapInfo`].

use super::settings::Settings;
use super::{bias, fit};
use crate::lights::projector::{Projector, Rays};
use crate::lights::{FrustumView, MapInfo, MapShape};
use crate::pass::PolygonOffset;
use crate::scene::LightKind;

/// Describes a map as its projector sees it, one face of a cube or the whole of a square map, drawn without polygon offset.
pub(super) fn map_info(view: &FrustumView<'_>, settings: &Settings, texels: f64) -> MapInfo {
    MapInfo {
        light: view.index,
        shape: shape(&view.light().kind, &view.projector),
        size: settings.size,
        levels: bias::levels(settings),
        format: settings.format,
        texel: bias::texel_at_one(&view.projector, settings),
        texel_short: bias::texel_sides_at_one(&view.projector, settings).min_element(),
        reach_texels: fit::lookup_texels(settings, slant(&view.projector)),
        bias: settings.bias,
        cull: settings.cull,
        polygon: PolygonOffset { factor: 0.0, units: 0.0 },
        texels,
        middle: false,
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
