//! Casters at the map's resolution (`casters = "texel"`): triangles that no texel shows are not drawn.

use std::sync::Arc;

use super::bias;
use super::settings::Settings;
use crate::geometry::{Derived, Mesh, Most};
use crate::lights::projector::Rays;
use crate::lights::{Drawable, FrustumView, Notes};
use crate::pass::MeshRef;

/// Fewest triangles that are worth simplifying.
const FEWEST: u32 = 200;

/// `casters` with fewer triangles, if that moves their surface by less than half a texel; all, and a warning, where
/// meshoptimizer is not compiled in.
pub fn simplified(
    view: &FrustumView<'_>,
    casters: &[&Drawable],
    settings: &Settings,
    notes: &mut Notes,
) -> Vec<Drawable> {
    if cfg!(not(feature = "meshopt")) {
        notes.warnings.push(format!(
            "casters = \"texel\": the map of {} is drawn from all triangles; fewer need glumbra's cargo feature `meshopt`",
            view.name()
        ));
        return casters.iter().map(|item| (*item).clone()).collect();
    }
    let of = |item: &&Drawable| {
        let mut item = (*item).clone();
        let before = (item.indices.end - item.indices.start) / 3;
        // Fewer vertices would follow a wave less closely.
        if before < FEWEST || item.needs_alpha_test() || item.wave.is_some() {
            return item;
        }
        let mesh = simplified_once(&item, allowed_error(view, &item, settings), view.derived);
        let after = mesh.triangle_count() as u32;
        if after < before {
            notes.left_out(
                format!("{} of {before} triangles of {} in the map of {}", before - after, item.label, view.name()),
                "no texel shows them: the surface moves by less than half of one",
            );
            item.indices = 0..mesh.indices.len() as u32;
            item.mesh = MeshRef(mesh);
        }
        item
    };
    casters.iter().map(of).collect()
}

/// Greatest error: an eleventh of a texel by quadrics, which average over curved parts; at most places that is below a
/// sixth. A silhouette that moves by a share of a texel makes that share of its pixels wrong: with a quarter, the bench's
/// hundred models had 0.037 percentage points more wrong pixels than full ones, with this 0.007 (`ci/bench --techniques
/// --scene s2 --only resolution`). In the item's own units, for the smallest texels that it meets, nearest to the light.
fn allowed_error(view: &FrustumView<'_>, item: &Drawable, settings: &Settings) -> f64 {
    let projector = &view.projector;
    let light_from_model = projector.light_from_world * item.world_from_model;
    let corners = item.bounds.corners().into_iter();
    let nearest = corners.map(|corner| -light_from_model.transform_point3(corner).z).fold(f64::INFINITY, f64::min);
    let distance = match projector.rays {
        Rays::From { near, .. } => nearest.max(near),
        Rays::Along(_) => 1.0,
    };
    let allowed = 0.088 * bias::texel_at_one(projector, settings) * distance;
    let axes = [item.world_from_model.x_axis, item.world_from_model.y_axis, item.world_from_model.z_axis];
    allowed / axes.map(|axis| axis.truncate().length()).into_iter().fold(0.0, f64::max)
}

/// Number of simplified meshes that are kept for each part of a mesh.
const MOST_ERRORS: usize = 32;

/// A simplified mesh. The error is rounded down to a power of two, so that casters at all distances share a few meshes.
fn simplified_once(item: &Drawable, error: f64, derived: &Derived) -> Arc<Mesh> {
    let exponent = error.log2().floor().clamp(-120.0, 120.0) as i32;
    let (most, key) = (MOST_ERRORS * item.mesh.parts.len().max(1), (item.indices.clone(), exponent));
    derived.get(&item.mesh.0, Most::OfMesh(most), key, || {
        Arc::new(item.mesh.simplified(item.indices.clone(), f64::from(exponent).exp2() as f32))
    })
}
