//! Points around which nothing changes, as far as a lookup reaches.

use glam::DVec2;

use super::points::{Met, Seen, on_the_way, to_light};
use super::{Forecast, Way};
use crate::techniques::shadow_map::bias;

impl Forecast<'_> {
    /// Tests whether the rays to the light all around a point meet the same sides of the same items, as far as a lookup
    /// reaches; or, for a map of far sides, nothing at all before the plane of the seen surface.
    pub(super) fn is_even(&self, way: &Way<'_>, texel: f64) -> bool {
        let Way { point: seen, slack, .. } = *way;
        let reach = texel * (bias::reach_texels(self.map.settings) + 1.0);
        let rays = self.rays();
        let Some(projector) = self.map.projectors.first() else { return false };
        let rows = projector.light_from_world.transpose();
        let axes = match self.map.projectors.len() {
            1 => [rows.x_axis, rows.y_axis].map(|axis| axis.truncate()),
            _ => {
                let way = to_light(seen.point, &rays).normalize_or_zero();
                [way.any_orthonormal_vector(), way.cross(way.any_orthonormal_vector())]
            }
        };
        let signature = signature(&way.met, slack);
        let mut is_lit = self.has_far_sides();
        let around = (-2..=2).flat_map(|u| (-2..=2).map(move |v| 0.5 * DVec2::new(f64::from(u), f64::from(v))));
        let mut is_alike = true;
        for step in around {
            let across = seen.point + reach * (step.x * axes[0] + step.y * axes[1]);
            let way = to_light(across, &rays);
            // In the seen triangle's plane, so that surfaces at its depth stay there.
            let moved = across + way * (seen.normal.dot(seen.point - across) / seen.normal.dot(way));
            let met = on_the_way(self.items, &Seen { point: moved, ..*seen }, -slack, &rays, None);
            is_alike = is_alike && self::signature(&met, slack) == signature;
            is_lit = is_lit && !met.iter().any(|met| !met.is_own && met.t > slack);
            if !(is_alike || is_lit) {
                return false;
            }
        }
        true
    }
}

/// Sides of items that a ray meets, whatever their order.
fn signature(met: &[Met], slack: f64) -> Vec<(usize, bool, bool)> {
    let mut all: Vec<_> = met.iter().map(|met| (met.item, met.is_far_side, met.t.abs() <= slack)).collect();
    all.sort_unstable();
    all
}
