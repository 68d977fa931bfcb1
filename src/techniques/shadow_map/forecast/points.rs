//! Points that the camera sees, and what lies on their way to the light: found by rays through the items' triangles.

use glam::{DMat4, DVec3};

use crate::geometry::rays::{Boxes, Ray};
use crate::geometry::sampled::{Crossing, SampledMesh};
use crate::lights::box_raster::{At, BoxRaster, Sighting};
use crate::lights::projector::Rays;
use crate::lights::{Drawable, LightView, alpha};
use crate::math::Aabb;

/// An item made ready for rays.
pub struct Placed<'a> {
    pub item: &'a Drawable,
    model_from_world: DMat4,
    mesh: SampledMesh,
}

/// A point that the camera sees.
pub struct Seen {
    /// Index into the items.
    pub item: usize,
    pub point: DVec3,
    /// The surface's normal, of unit length, towards the eye.
    pub normal: DVec3,
    /// The triangle's number in its item.
    pub triangle: u32,
}

/// A surface that a ray to the light meets.
pub struct Met {
    /// Index into the items.
    pub item: usize,
    pub triangle: u32,
    /// Parameter from the seen point towards the light, negative behind it; 1 at the light, or world units for parallel
    /// light.
    pub t: f64,
    /// True if its front looks away from the light.
    pub is_far_side: bool,
    /// True if it is the seen triangle itself.
    pub is_own: bool,
}

/// All items made ready for rays, in a hierarchy of boxes.
pub struct Items<'a> {
    pub placed: Vec<Placed<'a>>,
    boxes: Boxes,
}

impl<'a> Items<'a> {
    pub fn new(view: &LightView<'a>) -> Self {
        let placed = placed(view);
        let bounds = placed.iter().map(Placed::bounds).map(|bounds| [bounds.min, bounds.max]);
        Self { boxes: Boxes::new(bounds), placed }
    }

    /// Calls `look` with every crossing of a ray in world space with an item that is `wanted`, and the item; holes are left
    /// out. `at`: the ray's place in a raster of these items, if it has one.
    pub fn crossings(
        &self,
        ray: &Ray,
        at: Option<At<'_>>,
        wanted: impl Fn(usize) -> bool,
        mut look: impl FnMut(usize, Crossing),
    ) {
        let mut cross = |index: u32| {
            let index = index as usize;
            if wanted(index) {
                self.placed[index].crossings(ray, |met| look(index, met));
            }
        };
        if at.and_then(|at| at.raster.met(at.place, &mut cross)).is_none() {
            self.boxes.met(ray, cross);
        }
    }

    /// The items by their places, which `see` finds for points in world space.
    pub fn raster(&self, see: impl Fn(DVec3) -> Sighting) -> BoxRaster {
        let corners = |placed: &Placed<'_>| {
            placed.item.bounds.corners().map(|corner| placed.item.world_from_model.transform_point3(corner))
        };
        BoxRaster::new(self.placed.iter().map(corners), see)
    }
}

/// Every item but those whose transform has no inverse.
fn placed<'a>(view: &LightView<'a>) -> Vec<Placed<'a>> {
    let of = |item: &'a Drawable| {
        let mesh = match &item.wave {
            Some(wave) => wave.moved_once(&item.mesh.0, view.derived),
            None => item.mesh.0.clone(),
        };
        let mesh = SampledMesh::new(&mesh, item.indices.clone(), view.derived);
        Placed { item, model_from_world: item.world_from_model.inverse(), mesh }
    };
    view.items.iter().map(of).filter(|placed| placed.model_from_world.is_finite()).collect()
}

impl Placed<'_> {
    /// The box around the item's own box, in world space.
    fn bounds(&self) -> Aabb {
        self.item.bounds.transformed(&self.item.world_from_model)
    }

    /// Calls `look` with every crossing of a ray in world space; holes are left out.
    fn crossings(&self, ray: &Ray, mut look: impl FnMut(Crossing)) {
        let origin = self.model_from_world.transform_point3(ray.origin);
        let ray = Ray { origin, way: self.model_from_world.transform_vector3(ray.way), ..*ray };
        self.mesh.crossings(&ray, |met| {
            if alpha::passes(self.item, met.triangle, &self.mesh.corners(met.triangle), ray.origin + met.t * ray.way) {
                look(met);
            }
        });
    }

    /// A triangle's normal, of unit length and to either side, in world space; zero where it has no area.
    pub fn normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// A triangle's corners in world space.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.mesh.corners(triangle).map(|corner| self.item.world_from_model.transform_point3(corner))
    }
}

/// The nearest point on the way from the near plane to the far plane, `origin` to `origin + way`, at a place of the picture.
pub fn seen(items: &Items<'_>, at: Option<At<'_>>, eye: DVec3, origin: DVec3, way: DVec3) -> Option<Seen> {
    let ray = Ray { origin, way, start: 0.0, end: 1.0 };
    let mut nearest: Option<(f64, usize, u32)> = None;
    items.crossings(
        &ray,
        at,
        |_| true,
        |item, met| {
            if nearest.is_none_or(|(t, ..)| met.t < t) {
                nearest = Some((met.t, item, met.triangle));
            }
        },
    );
    let (t, item, triangle) = nearest?;
    let (point, normal) = (origin + t * way, items.placed[item].normal(triangle));
    let normal = if normal.dot(eye - point) < 0.0 { -normal } else { normal };
    (normal != DVec3::ZERO).then_some(Seen { item, point, normal, triangle })
}

/// Vector from a point to the light, or a unit vector for parallel light.
pub fn to_light(point: DVec3, rays: &Rays) -> DVec3 {
    match rays {
        Rays::From { position, .. } => *position - point,
        Rays::Along(direction) => -*direction,
    }
}

/// All casters on the line through the point and the light, from `behind` of it (a parameter below 0) on. `at`: the
/// point's place in a map.
pub fn on_the_way(items: &Items<'_>, seen: &Seen, behind: f64, rays: &Rays, at: Option<At<'_>>) -> Vec<Met> {
    let end = if matches!(rays, Rays::From { .. }) { 1.0 } else { f64::MAX };
    let way = to_light(seen.point, rays);
    let ray = Ray { origin: seen.point, way, start: behind, end };
    let mut all = Vec::new();
    let casts_shadow = |item: usize| items.placed[item].item.casts_shadow;
    items.crossings(&ray, at, casts_shadow, |item, met| {
        let is_own = (item, met.triangle) == (seen.item, seen.triangle);
        // The ray runs to the light: a surface that it meets from the front looks away from the light.
        all.push(Met { item, triangle: met.triangle, t: met.t, is_far_side: !met.from_behind, is_own });
    });
    all
}
