//! A map's texels as rays from the light find them, each found when it is first needed. f64; depths are those of the
//! window, in [0, 1] and growing away from the light, whichever way the map's own run.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};

use super::Map;
use super::points::{Items, Placed};
use crate::geometry::rays::Ray;
use crate::lights::Drawable;
use crate::lights::box_raster::{At, BoxRaster, Sighting};
use crate::lights::projector::{Projector, Rays};
use crate::pass::{DepthFormat, Face, PolygonOffset};
use crate::techniques::shadow_map::bias;
use crate::techniques::shadow_map::settings::Settings;
use crate::techniques::shadow_map::term::raster_from_clip;

/// Layer that a texel stores.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stored {
    /// The nearest face of a caster, under the map's polygon offset.
    Nearest,
    /// The middle between the nearest caster and the next surface more than `margin` behind it, caster or not; `alone` if
    /// there is none.
    Middle { margin: f64, eye_linear: bool, alone: Alone },
}

/// Value of a texel with only one layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alone {
    Far,
    /// The layer, under the map's polygon offset.
    Nearest,
}

/// A map, or one face of a cube.
#[derive(Clone)]
pub struct Texels<'a> {
    items: &'a Items<'a>,
    settings: &'a Settings,
    stored: Stored,
    offset: PolygonOffset,
    /// True if each item is a caster that the map is drawn from.
    casts: Arc<[bool]>,
    projector: Projector,
    world_from_light: DMat4,
    /// The map's clip space.
    map_from_light: DMat4,
    clip_from_raster: DMat4,
    /// The items by their places in the map.
    raster: Arc<BoxRaster>,
    /// Depths by level and place, as one number each.
    known: HashMap<u64, f64>,
    /// The last of these, by the last bits of their places: a kernel's texels are looked up again and again.
    recent: [(u64, f64); RECENT * RECENT],
}

/// Texels a side of those that are kept at hand.
const RECENT: usize = 16;

/// No texel's number.
const NONE: u64 = u64::MAX;

/// A layer that a texel's ray crosses.
#[derive(Clone, Copy)]
struct Crossing {
    /// Depth, not clamped.
    depth: f64,
    item: usize,
    triangle: u32,
    casts: bool,
}

impl<'a> Texels<'a> {
    pub fn new(items: &'a Items<'a>, map: &'a Map<'a>, projector: Projector) -> Self {
        let casters: HashSet<*const Drawable> = map.casters.iter().map(|caster| std::ptr::from_ref(*caster)).collect();
        let casts = |placed: &Placed<'_>| casters.contains(&std::ptr::from_ref(placed.item));
        let raster_from_clip = raster_from_clip(map.settings);
        let map_from_light = raster_from_clip * projector.crop.map_clip_from_light_clip() * projector.clip_from_light;
        let mut texels = Self {
            items,
            settings: map.settings,
            stored: map.stored,
            offset: map.offset.polygon,
            casts: items.placed.iter().map(casts).collect(),
            world_from_light: projector.light_from_world.inverse(),
            map_from_light,
            clip_from_raster: raster_from_clip.inverse(),
            raster: Arc::default(),
            projector,
            known: HashMap::new(),
            recent: [(NONE, 0.0); RECENT * RECENT],
        };
        texels.raster = Arc::new(items.raster(|point| texels.sighting(point)));
        texels
    }

    pub fn projector(&self) -> &Projector {
        &self.projector
    }

    /// Texels a side of a level.
    pub fn size(&self, level: u32) -> u32 {
        (self.settings.size >> level).max(1)
    }

    /// The width of a texel of level 0 at a point in light space, along its longer side.
    pub fn width_at(&self, light: DVec3) -> f64 {
        let one = bias::texel_at_one(&self.projector, self.settings);
        if matches!(self.projector.rays, Rays::From { .. }) { -light.z * one } else { one }
    }

    /// Place where a point in light space is looked up, in texels of level 0 from a corner of the map, and its window
    /// depth.
    pub fn place(&self, light: DVec3) -> (DVec2, f64) {
        let clip = self.map_from_light * light.extend(1.0);
        let ndc = clip.truncate() / clip.w;
        let size = f64::from(self.settings.size);
        ((0.5 + 0.5 * ndc.truncate()) * size, 0.5 + 0.5 * ndc.z)
    }

    /// The place among the items of the light's ray through a point in world space.
    pub fn at(&self, point: DVec3) -> Option<At<'_>> {
        self.raster.at(&self.sighting(point))
    }

    fn sighting(&self, point: DVec3) -> Sighting {
        let light = self.projector.light_from_world.transform_point3(point);
        Sighting::new(self.map_from_light * light.extend(1.0), light.abs().max_element() + point.abs().max_element())
    }

    /// The depth that a texel holds.
    pub fn depth(&mut self, level: u32, [x, y]: [u32; 2]) -> f64 {
        let key = u64::from(level) << 48 | u64::from(y) << 24 | u64::from(x);
        let slot = y as usize % RECENT * RECENT + x as usize % RECENT;
        if self.recent[slot].0 == key {
            return self.recent[slot].1;
        }
        let depth = match self.known.get(&key) {
            Some(depth) => *depth,
            None => {
                let depth = rounded(self.settings.format, self.found(level, [x, y]));
                self.known.insert(key, depth);
                depth
            }
        };
        self.recent[slot] = (key, depth);
        depth
    }

    fn found(&self, level: u32, at: [u32; 2]) -> f64 {
        let center = DVec2::new(f64::from(at[0]) + 0.5, f64::from(at[1]) + 0.5);
        let ray = self.ray(level, center);
        let layers = self.layers(&ray, center / f64::from(self.size(level)));
        let casting = || layers.iter().filter(|layer| layer.casts);
        // The depth test compares depths after the offset, and GL_DEPTH_CLAMP clamps those [GL 4.6, 14.6.5 and 17.3.4].
        let moved = || {
            casting().fold(1.0, |nearest, layer| match layer.depth + self.least_move(layer) < nearest {
                true => f64::min(nearest, layer.depth + self.moved(level, center, layer)),
                false => nearest,
            })
        };
        match self.stored {
            Stored::Nearest => moved(),
            Stored::Middle { margin, eye_linear, alone } => {
                let clamped = |layer: &Crossing| layer.depth.clamp(0.0, 1.0);
                let nearest = casting().map(clamped).fold(1.0, f64::min);
                let behind = layers.iter().map(clamped).filter(|depth| depth - margin > nearest);
                match behind.min_by(f64::total_cmp) {
                    Some(second) => self.middle(nearest, second, eye_linear),
                    None if alone == Alone::Nearest => moved(),
                    None => 1.0,
                }
            }
        }
    }

    fn middle(&self, first: f64, second: f64, eye_linear: bool) -> f64 {
        if !eye_linear || matches!(self.projector.rays, Rays::Along(_)) {
            return 0.5 * (first + second);
        }
        // A window depth is linear in 1 over the distance.
        let distance = |depth: f64| self.distance(depth);
        self.depth_at(0.5 * (distance(first) + distance(second)))
    }

    /// The window depth at a distance along the axis.
    fn depth_at(&self, distance: f64) -> f64 {
        let clip = self.projector.clip_from_light;
        let z = clip.w_axis.z - clip.z_axis.z * distance;
        0.5 + 0.5 * if matches!(self.projector.rays, Rays::From { .. }) { z / distance } else { z }
    }

    /// The distance along the axis at a window depth.
    fn distance(&self, depth: f64) -> f64 {
        let clip = self.projector.clip_from_light;
        let z = 2.0 * depth - 1.0;
        match self.projector.rays {
            Rays::From { .. } => clip.w_axis.z / (z + clip.z_axis.z),
            Rays::Along(_) => (clip.w_axis.z - z) / clip.z_axis.z,
        }
    }

    /// The light's ray through a place of the map, in texels of a level, from the light (or the box's near side) to the far
    /// plane.
    fn ray(&self, level: u32, place: DVec2) -> Ray {
        let clip = &self.projector.clip_from_light;
        let map = 2.0 * place / f64::from(self.size(level)) - 1.0;
        let map = self.clip_from_raster.transform_point3(map.extend(0.0)).truncate();
        let light = self.projector.crop.light_clip(map);
        let scale = DVec2::new(clip.x_axis.x, clip.y_axis.y);
        let (from, to) = match self.projector.rays {
            Rays::From { .. } => {
                let far = self.distance(1.0);
                (DVec3::ZERO, ((light + clip.z_axis.truncate().truncate()) / scale).extend(-1.0) * far)
            }
            Rays::Along(_) => {
                let at = (light - clip.w_axis.truncate().truncate()) / scale;
                (at.extend(-self.distance(0.0)), at.extend(-self.distance(1.0)))
            }
        };
        let [from, to] = [from, to].map(|point| self.world_from_light.transform_point3(point));
        // Not a surface that the light lies in: it is edge-on.
        Ray { origin: from, way: to - from, start: 1e-9, end: 1.0 }
    }

    /// Layers that the ray through a place in [0, 1]² crosses and the map draws, in no order.
    fn layers(&self, ray: &Ray, place: DVec2) -> Vec<Crossing> {
        let mut layers = Vec::new();
        let far_sides = match self.settings.cull {
            None => None,
            Some(Face::Front) => Some(true),
            Some(Face::Back) => Some(false),
        };
        let with_receivers = matches!(self.stored, Stored::Middle { .. });
        // Surfaces beyond the far plane are a second layer at depth 1.
        let ray = &Ray { end: if with_receivers { f64::MAX } else { 1.0 }, ..*ray };
        let at = Some(At { raster: &self.raster, place });
        self.items.crossings(
            ray,
            at,
            |item| with_receivers || self.casts[item],
            |item, met| {
                // The ray runs away from the light: a surface that it meets from behind looks away from the light.
                if far_sides.is_none_or(|far| far == met.from_behind) {
                    let depth = self.depth_along(met.t);
                    layers.push(Crossing { depth, item, triangle: met.triangle, casts: self.casts[item] });
                }
            },
        );
        layers
    }

    /// The window depth at a share of a texel's ray; below 0 before the near plane.
    fn depth_along(&self, t: f64) -> f64 {
        let start = if matches!(self.projector.rays, Rays::From { .. }) { 0.0 } else { self.distance(0.0) };
        self.depth_at(start + t * (self.distance(1.0) - start))
    }

    /// The least that the polygon offset may move a layer by: seen head-on for a factor above 0, edge-on below.
    fn least_move(&self, layer: &Crossing) -> f64 {
        let PolygonOffset { factor, units } = self.offset;
        f64::from(factor.min(0.0)) + f64::from(units) * unit(self.settings.format, layer.depth)
    }

    /// Movement of a layer by the polygon offset, in window depth [GL 4.6, 14.6.5].
    fn moved(&self, level: u32, center: DVec2, layer: &Crossing) -> f64 {
        let PolygonOffset { factor, units } = self.offset;
        let unit = unit(self.settings.format, layer.depth);
        if factor == 0.0 {
            return f64::from(units) * unit;
        }
        let placed = &self.items.placed[layer.item];
        let (corner, normal) = (placed.corners(layer.triangle)[0], placed.normal(layer.triangle));
        let beside = |step: DVec2| {
            let ray = self.ray(level, center + step);
            let t = normal.dot(corner - ray.origin) / normal.dot(ray.way);
            (self.depth_along(t) - layer.depth).abs()
        };
        let slope = beside(DVec2::X).max(beside(DVec2::Y));
        // A surface seen edge-on is moved to the far plane.
        let slope = if slope.is_finite() { slope.min(1.0) } else { 1.0 };
        f64::from(factor) * slope + f64::from(units) * unit
    }
}

/// GL's r, the length of one unit of polygon offset, in window depth [GL 4.6, 14.6.5]: of fixed-point formats drivers take two
/// codes, of floats the last bit of the depth.
pub(super) fn unit(format: DepthFormat, depth: f64) -> f64 {
    match format {
        DepthFormat::Depth16 => 2.0_f64.powi(-15),
        DepthFormat::Depth24 | DepthFormat::Depth32 => 2.0_f64.powi(-23),
        DepthFormat::Depth32F => 2.0_f64.powf(depth.clamp(1e-30, 1.0).log2().floor() - 23.0),
    }
}

/// A depth as the map's format keeps it.
fn rounded(format: DepthFormat, depth: f64) -> f64 {
    let depth = depth.clamp(0.0, 1.0);
    match format {
        DepthFormat::Depth16 => (depth * 65535.0).round() / 65535.0,
        _ => depth,
    }
}
