//! A shadow map in numbers: see [`MapInfo`].

use super::settings::Settings;
use super::{bias, fit};
use crate::lights::projector::Projector;
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
        reach_texels: fit::lookup_texels(settings, fit::slant(&view.projector)),
        bias: settings.bias,
        cull: settings.cull,
        polygon: PolygonOffset { factor: 0.0, units: 0.0 },
        texels,
        middle: false,
    }
}

fn shape(kind: &LightKind, projector: &Projector) -> MapShape {
    match kind {
        LightKind::Spot(spot) => MapShape::Spot { near: spot.frustum.near, far: spot.frustum.far },
        LightKind::Point(point) => MapShape::Cube { near: point.near, far: point.far },
        LightKind::Directional { .. } => MapShape::Parallel { depth: 2.0 / projector.clip_from_light.z_axis.z.abs() },
    }
}
