//! The map of a directional light: an orthographic box around the casters that have something behind them to shadow [HSM,
//! "How To Do It"]. The box depends on the scene alone, never on the camera.
//!
//! Across the light the box is a rectangle of whole texels of a grid that stands still in the world, and the texel's width
//! is one of a few steps: a caster that moves a little moves the map by whole texels or not at all. Along the light the box
//! holds the casters; receivers behind them all are compared at depth 1, which is still behind.
//!
//! Nothing outside the box is shadowed, and no shader has to test it: lookups there meet the texels at the rim
//! (GL_CLAMP_TO_EDGE). Those hold nothing where the casters end. Where the box ends before its casters, nothing lies behind
//! them there.

use glam::{DMat4, DVec3, DVec4};

use super::behind::Behind;
use super::fit::rim_texels;
use super::settings::{Mipmaps, Settings};
use crate::lights::projector::{Projector, Rays};
use crate::lights::{Crop, Drawable, LightView, Notes};
use crate::math::frustum::{clip_polygon, faces};
use crate::math::{Aabb, spaces};
use crate::scene::{Reader, SettingsError};

/// Widths of a texel in a factor of 2.
const STEPS: f64 = 8.0;

/// Refuses keys that a directional light's map cannot serve.
///
/// # Errors
///
/// Mipmaps, of which one level would reach across the whole map, or a map too small for its own rim.
pub fn refuse(settings: &Settings, keys: &Reader<'_>) -> Result<(), SettingsError> {
    if settings.mipmaps == Mipmaps::All {
        return Err(keys.error(
            "mipmaps",
            "= true does not go with a directional light, whose map has an end: of the smallest level one texel reaches \
             across it; \"8-tap\" does",
        ));
    }
    let least = 4 * rim(settings);
    if settings.size < least {
        return Err(
            keys.error("size", format_args!("must be at least {least} for a directional light's map with its rim"))
        );
    }
    Ok(())
}

/// Width of a lookup, in whole texels, Direct3D's half texel included.
fn rim(settings: &Settings) -> u32 {
    rim_texels(settings).ceil() as u32 + 1
}

/// The box around what `view` shows; `None` where nothing casts a shadow on anything.
pub fn projector(view: &LightView<'_>, direction: DVec3, settings: &Settings, notes: &mut Notes) -> Option<Projector> {
    let (projector, size) = around(view.items, direction, settings)?;
    notes.chosen(
        format!("the map of light {}", view.index),
        format!("a box of {:.4} x {:.4} x {:.4}", size.x, size.y, size.z),
        "around what casts, as far as something lies behind it",
    );
    Some(projector)
}

/// The box around `items`, and its size; `None` where nothing casts a shadow on anything.
pub fn around(items: &[Drawable], direction: DVec3, settings: &Settings) -> Option<(Projector, DVec3)> {
    let up = if direction.y.abs() < 0.99 { DVec3::Y } else { DVec3::Z };
    let light_from_world = spaces::view_from_world(DVec3::ZERO, direction, up);
    let boxes: Vec<Aabb> =
        items.iter().map(|item| item.bounds.transformed(&(light_from_world * item.world_from_model))).collect();
    let needed = needed(items, &boxes)?;
    let (min, max) = match shallow(items, &light_from_world, &needed, settings) {
        Some(sides) => sides,
        None => whole_texels(&needed, settings),
    };
    let clip_from_light = spaces::orthographic(min, max);
    Some((Projector { clip_from_light, light_from_world, rays: Rays::Along(direction), crop: Crop::WHOLE }, max - min))
}

/// Bounds, in light space, of every caster as far as other items, or itself if it is not flat, reach behind it. In z,
/// bounds of these casters as a whole; z falls along the rays.
fn needed(items: &[Drawable], boxes: &[Aabb]) -> Option<Aabb> {
    let mut needed = Aabb::EMPTY;
    let behind = Behind::new(boxes);
    for (index, caster) in items.iter().enumerate().filter(|(_, item)| item.casts_shadow) {
        let own = boxes[index];
        let behind = behind.of(own.max.z, caster.bounds.flat_axis().is_some().then_some(index));
        let mut shadowed = Aabb { min: own.min.max(behind.min), max: own.max.min(behind.max) };
        (shadowed.min.z, shadowed.max.z) = (own.min.z, own.max.z);
        if !shadowed.is_empty() {
            needed = needed.union(shadowed);
        }
    }
    (!needed.is_empty() && needed.min.is_finite() && needed.max.is_finite()).then_some(needed)
}

/// Ratio of depth to width above which a box may be deep only because of items beside it.
const DEEP: f64 = 16.0;

/// Margin within which casters are examined, as a share of the longer side.
const BESIDE: f64 = 0.5;

/// The sides of a box that holds no more of the casters' depth than they have within it: an oblique floor is as deep as it
/// is long. `None` where `needed` is not deep, or nothing is gained.
fn shallow(items: &[Drawable], light_from_world: &DMat4, needed: &Aabb, settings: &Settings) -> Option<(DVec3, DVec3)> {
    let extent = needed.max - needed.min;
    let longer = extent.x.max(extent.y);
    if longer == 0.0 || extent.z <= DEEP * longer {
        return None;
    }
    let (low, high) = (needed.min - BESIDE * longer, needed.max + BESIDE * longer);
    let sides = [
        DVec4::new(1.0, 0.0, 0.0, -low.x),
        DVec4::new(-1.0, 0.0, 0.0, high.x),
        DVec4::new(0.0, 1.0, 0.0, -low.y),
        DVec4::new(0.0, -1.0, 0.0, high.y),
    ];
    let mut depth = Aabb::EMPTY;
    for item in items.iter().filter(|item| item.casts_shadow) {
        let light_from_model = *light_from_world * item.world_from_model;
        let corners = item.bounds.corners().map(|corner| light_from_model.transform_point3(corner));
        for face in faces(&corners) {
            let within = sides.iter().fold(face.to_vec(), |polygon, side| clip_polygon(&polygon, side));
            depth = depth.union(Aabb::from_points(within));
        }
    }
    let mut narrow = *needed;
    (narrow.min.z, narrow.max.z) = (needed.min.z.max(depth.min.z), needed.max.z.min(depth.max.z));
    let (min, max) = whole_texels(&narrow, settings);
    let is_looked_at = min.truncate().cmpge(low.truncate()).all() && max.truncate().cmple(high.truncate()).all();
    (narrow.min.z <= narrow.max.z && is_looked_at).then_some((min, max))
}

/// `needed` with its rim, in whole texels of a grid through the world's origin.
fn whole_texels(needed: &Aabb, settings: &Settings) -> (DVec3, DVec3) {
    let (size, rim) = (f64::from(settings.size), f64::from(rim(settings)));
    let extent = needed.max - needed.min;
    // Least thickness, for casters that are flat across the light; not below what f32 resolves there.
    let reach = needed.min.abs().max(needed.max.abs()).max_element();
    let least = (1e-3 * extent.max_element()).max(1e-5 * reach).max(f64::MIN_POSITIVE);
    let axis = |min: f64, extent: f64| {
        // One more texel for the place of the first on the grid.
        let texel = extent.max(least) / (size - 2.0 * rim - 1.0);
        let texel = ((texel.log2() * STEPS).ceil() / STEPS).exp2();
        let start = ((min / texel).floor() - rim) * texel;
        (start, start + size * texel)
    };
    let (x, y) = (axis(needed.min.x, extent.x), axis(needed.min.y, extent.y));
    // Room for the offset of the farthest caster, which must not reach the cleared depth.
    let room = (extent.z / 16.0).max(least);
    (DVec3::new(x.0, y.0, needed.min.z - room), DVec3::new(x.1, y.1, needed.max.z + room))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Derived;
    use crate::lights::CameraView;
    use crate::lights::drawable::items;
    use crate::scene;

    fn scene_of(objects: &str, shadow: &str) -> scene::Scene {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let light = format!(
            "[[light]]\nkind = \"directional\"\ndirection = [0, -1, 0]\n[light.shadow]\ntechnique = \"shadow-map\"\n{shadow}\n"
        );
        std::fs::write(&path, light + objects).unwrap();
        crate::techniques::load(&path, &[]).unwrap().scene
    }

    fn box_of(objects: &str, shadow: &str) -> Option<Aabb> {
        let scene = scene_of(objects, shadow);
        let items = items(&scene, None);
        let settings = super::super::settings::read(&mut scene.lights[0].shadow.written().read()).unwrap();
        let (shown_whole, keep_all, sampled_warnings) = (false, false, false);
        let camera = CameraView::new(&scene, &items);
        let derived = Derived::default();
        let view = LightView {
            scene: &scene,
            items: &items,
            camera: &camera,
            derived: &derived,
            index: 0,
            source: &scene.lights[0],
            shown_whole,
            keep_all,
            sampled_warnings,
        };
        let found = projector(&view, -DVec3::Y, &settings, &mut Notes::default())?;
        Some(Aabb::from_points(crate::math::frustum::corners(&found.clip_from_world().inverse())))
    }

    const FLOOR: &str = "[[object]]\nmesh = \"quad\"\nscale = [50.0, 1.0, 50.0]\n";

    #[test]
    fn the_box_holds_casters_with_a_rim_and_no_more_of_the_floor() {
        let column = "[[object]]\nmesh = \"box\"\ntranslate = [3.0, 2.0, -7.0]\n";
        let found = box_of(&format!("{FLOOR}{column}"), "size = 256").unwrap();
        // Side 2, a rim of 3 texels of 256, at most one step of 2^(1/8) and one texel of the grid.
        let least = DVec3::new(2.0, 3.0, -8.0);
        assert!(found.min.cmplt(least).all() && found.max.cmpgt(DVec3::new(4.0, 3.0, -6.0)).all(), "{found:?}");
        let size = found.max - found.min;
        assert!(size.x < 2.0 * 1.0905 * 256.0 / 249.0 && (size.z - size.x).abs() < 1e-9, "{size}");
        // Only the floor's own height is needed: nothing lies behind it.
        assert!(found.min.y < 1.0 && found.min.y > 0.8, "{found:?}");
        assert_eq!(box_of(FLOOR, "size = 256"), None, "a floor alone shadows nothing");
    }

    #[test]
    fn a_caster_that_moves_by_less_than_a_texel_moves_the_box_by_whole_texels() {
        let place = |x: f64| {
            box_of(&format!("{FLOOR}[[object]]\nmesh = \"box\"\ntranslate = [{x:?}, 2.0, 0.3]\n"), "size = 64")
        };
        let (first, texel) = (place(0.0).unwrap(), (place(0.0).unwrap().max.x - place(0.0).unwrap().min.x) / 64.0);
        for x in [1e-4, 0.01, 0.02, 0.1, 0.777, 5.3, 1e3] {
            let moved = place(x).unwrap();
            for (a, b) in [(first.min.x, moved.min.x), (first.max.x, moved.max.x)] {
                let texels = (b - a) / texel;
                assert!((texels - texels.round()).abs() < 1e-6, "{x}: {texels}");
            }
            assert!((moved.min.z - first.min.z).abs() + (moved.max.z - first.max.z).abs() < 1e-9, "rounding alone");
        }
    }
}
