//! The scene's objects, prepared for rays: one [`Solid`] for each mesh, one placement for each object, a box hierarchy over
//! both. Triangles are returned in world space, each vertex transformed by the same operations wherever it is used, so that
//! neighbours share their edges to the bit.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, TraversalAction};

use super::beam::crossing;
use super::cutout::{Alpha, AlphaCutout};
use super::slab::{Segment, Slab};
use super::solid::{OPEN, Solid};
use super::tube::Tube;
use super::{Error, wave};
use crate::geometry::{Material, Mesh};
use crate::scene::{Object, Scene};

pub(super) struct World<'a> {
    solids: Vec<Solid<'a>>,
    pub placed: Vec<PlacedObject>,
    top: Bvh,
}

/// An object of the scene.
pub(super) struct PlacedObject {
    solid: usize,
    pub casts_shadow: bool,
    world_from_model: DMat4,
    model_from_world: DMat4,
    /// Greatest factor by which `model_from_world` stretches a length.
    shrink: f64,
    /// The farthest vertex from the object's origin, in world units.
    pub reach: f64,
    /// Error of a vertex's wave in f32, in world units.
    pub wave_error: f64,
    /// Cut-out of each part, and last of triangles that no part holds.
    cutouts: Vec<Option<AlphaCutout>>,
    has_cutouts: bool,
}

/// A triangle in world space, with its place.
#[derive(Clone, Copy)]
pub(super) struct Triangle<'w> {
    pub object: u32,
    pub index: u32,
    pub corners: [DVec3; 3],
    pub placed: &'w PlacedObject,
    solid: &'w Solid<'w>,
}

impl<'a> World<'a> {
    pub fn new(scene: &'a Scene) -> Result<Self, Error> {
        let mut solids: Vec<Solid<'a>> = Vec::new();
        let mut known: HashMap<*const Mesh, usize> = HashMap::new();
        let mut placed = Vec::with_capacity(scene.objects.len());
        for object in &scene.objects {
            let solid = match known.get(&Arc::as_ptr(&object.mesh)).filter(|_| object.wave.is_none()) {
                Some(&solid) => solid,
                None => {
                    solids.push(Solid::new(&object.mesh, object.wave.as_ref())?);
                    if object.wave.is_none() {
                        known.insert(Arc::as_ptr(&object.mesh), solids.len() - 1);
                    }
                    solids.len() - 1
                }
            };
            placed.push(place(object, solid, &solids[solid])?);
        }
        let boxes: Vec<Aabb> = placed.iter().map(|placed| world_box(placed, &solids[placed.solid])).collect();
        Ok(Self { solids, placed, top: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes) })
    }

    /// A ball that holds all objects: centre and radius; of no size where there is nothing.
    pub fn ball(&self) -> (DVec3, f64) {
        if self.top.leaf_count() == 0 {
            return (DVec3::ZERO, 0.0);
        }
        let bounds = self.top.root_aabb();
        let [min, max] = [bounds.mins, bounds.maxs].map(|corner| DVec3::from_array(corner.to_array()));
        (0.5 * (min + max), 0.5 * min.distance(max))
    }

    /// An object's mesh, ready for rays.
    pub fn solid(&self, object: u32) -> &Solid<'a> {
        &self.solids[self.placed[object as usize].solid]
    }

    pub fn triangle(&self, object: u32, index: u32) -> Triangle<'_> {
        let placed = &self.placed[object as usize];
        let solid = &self.solids[placed.solid];
        let corners = solid.corners(index).map(|corner| placed.to_world(solid.position(corner)));
        Triangle { object, index, corners, placed, solid }
    }

    /// Calls `look` with each triangle whose box comes as near to the segment as the tube is wide there and the object's
    /// pad besides, in world units; in no order. Stops where `look` breaks. No pad is above `most`.
    pub fn visit(
        &self,
        segment: &Segment,
        tube: Tube,
        most: f64,
        pads: impl Fn(u32) -> f64,
        mut look: impl FnMut(&Triangle<'_>) -> ControlFlow<()>,
    ) {
        let outer = Slab::new(segment, most).around(tube);
        self.top.traverse(|node| {
            if !outer.meets(node, segment.end) {
                return TraversalAction::Prune;
            }
            let Some(object) = node.leaf_data() else { return TraversalAction::Continue };
            match self.visit_object(object, segment, tube, pads(object), &mut look) {
                ControlFlow::Continue(()) => TraversalAction::Continue,
                ControlFlow::Break(()) => TraversalAction::EarlyExit,
            }
        });
    }

    fn visit_object(
        &self,
        object: u32,
        segment: &Segment,
        tube: Tube,
        pad: f64,
        look: &mut impl FnMut(&Triangle<'_>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let placed = &self.placed[object as usize];
        let tube = Tube { radius: tube.radius * placed.shrink, ..tube };
        let inner = Slab::new(&placed.to_model(segment), pad * placed.shrink).around(tube);
        let mut flow = ControlFlow::Continue(());
        self.solids[placed.solid].bvh.traverse(|node| {
            if !inner.meets(node, segment.end) {
                return TraversalAction::Prune;
            }
            if let Some(triangle) = node.leaf_data() {
                flow = look(&self.triangle(object, triangle));
                if flow.is_break() {
                    return TraversalAction::EarlyExit;
                }
            }
            TraversalAction::Continue
        });
        flow
    }

    /// The nearest triangle that the segment crosses and whose alpha test passes there, with its parameter.
    pub fn nearest(&self, segment: &Segment) -> Option<(Triangle<'_>, f64)> {
        let outer = Slab::new(segment, 0.0);
        let best = self.top.find_best(
            segment.end,
            |node, best| outer.enter(node, best),
            |object, best| self.nearest_of(object, &Segment { end: best, ..*segment }),
        );
        best.map(|(object, (t, triangle))| (self.triangle(object, triangle), t))
    }

    fn nearest_of(&self, object: u32, segment: &Segment) -> Option<(f64, u32)> {
        let placed = &self.placed[object as usize];
        let inner = Slab::new(&placed.to_model(segment), 0.0);
        let cross = |index: u32, best: f64| {
            let triangle = self.triangle(object, index);
            let t = crossing(segment.origin, segment.direction, &triangle.corners)?;
            let is_seen = (segment.start..best).contains(&t) && triangle.alpha_at(segment, t).passes_test();
            is_seen.then_some(t)
        };
        let bvh = &self.solids[placed.solid].bvh;
        bvh.find_best(segment.end, |node, best| inner.enter(node, best), cross).map(|(index, t)| (t, index))
    }
}

impl Triangle<'_> {
    /// The corner across edge k (corner k to k+1); `None`: the edge is open, or alpha may jump there.
    pub fn across(&self, k: usize) -> Option<DVec3> {
        if self.placed.has_cutouts && self.solid.seam[self.index as usize][k] {
            return None;
        }
        let corner = self.solid.across[self.index as usize][k];
        (corner != OPEN).then(|| self.placed.to_world(self.solid.position(corner)))
    }

    /// Tests whether both have the same three corners, whatever their order.
    pub fn coincides(&self, other: &Triangle<'_>) -> bool {
        let corners = |triangle: &Triangle<'_>| triangle.solid.welded[triangle.index as usize];
        let others = corners(other);
        self.object == other.object && corners(self).iter().all(|corner| others.contains(corner))
    }

    /// Tests whether `other` continues it across an edge that no third triangle shares.
    pub fn continues_in(&self, other: &Triangle<'_>) -> bool {
        let own = self.solid.welded[self.index as usize];
        let others = other.solid.welded[other.index as usize];
        self.object == other.object
            && (0..3).any(|k| {
                self.solid.across[self.index as usize][k] != OPEN
                    && others.contains(&own[k])
                    && others.contains(&own[(k + 1) % 3])
            })
    }

    pub fn is(&self, other: &Triangle<'_>) -> bool {
        self.object == other.object && self.index == other.index
    }

    /// Tests whether both belong to one object and share a corner.
    pub fn touches(&self, other: &Triangle<'_>) -> bool {
        self.object == other.object && self.solid.touch(self.index, other.index)
    }

    pub fn is_degenerate(&self) -> bool {
        self.solid.is_degenerate(self.index)
    }

    /// Its unit normal by the order of its corners; zero where it has no area.
    pub fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// The shortest of its three heights.
    pub fn least_height(&self) -> f64 {
        let [a, b, c] = self.corners;
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        (b - a).cross(c - a).length() / longest
    }

    pub fn has_cutout(&self) -> bool {
        self.cutout().is_some()
    }

    fn cutout(&self) -> Option<&AlphaCutout> {
        let part = self.solid.part[self.index as usize] as usize;
        self.placed.cutouts.get(part).or(self.placed.cutouts.last())?.as_ref()
    }

    fn alpha_at(&self, segment: &Segment, t: f64) -> Alpha {
        self.alpha(segment.origin + t * segment.direction, &[])
    }

    /// Its alpha at a point of its plane, and the bounds over the box that holds the points `around` too.
    pub fn alpha(&self, middle: DVec3, around: &[DVec3]) -> Alpha {
        let Some(cutout) = self.cutout() else { return Alpha::OPAQUE };
        let at = self.texcoord(middle);
        let reach = around.iter().fold(DVec2::ZERO, |reach, &point| reach.max((self.texcoord(point) - at).abs()));
        // GL interpolates what the corners have, in f32: a few roundings of the largest.
        let largest = self.corners.iter().map(|&corner| self.texcoord(corner).abs().max_element()).fold(0.0, f64::max);
        cutout.alpha(at, reach + 4.0 * f64::from(f32::EPSILON) * largest)
    }

    fn texcoord(&self, point: DVec3) -> DVec2 {
        let [a, b, c] = self.corners;
        let area = (b - a).cross(c - a);
        let scale = area.length_squared().recip();
        let v = (point - a).cross(c - a).dot(area) * scale;
        let w = (b - a).cross(point - a).dot(area) * scale;
        let [ta, tb, tc] = self.solid.corners(self.index).map(|corner| {
            let mesh = self.solid.mesh;
            let at = mesh.positions.get(corner as usize).copied().unwrap_or_default();
            let own = || mesh.texcoords.as_ref()?.get(corner as usize).copied();
            let generated = self.cutout().and_then(|cutout| cutout.texcoord_at(at));
            generated.unwrap_or_else(|| DVec2::from_array(own().unwrap_or_default().map(f64::from)))
        });
        ta + v * (tb - ta) + w * (tc - ta)
    }
}

impl PlacedObject {
    fn to_world(&self, point: DVec3) -> DVec3 {
        self.world_from_model.transform_point3(point)
    }

    fn to_model(&self, segment: &Segment) -> Segment {
        let origin = self.model_from_world.transform_point3(segment.origin);
        Segment { origin, direction: self.model_from_world.transform_vector3(segment.direction), ..*segment }
    }

    pub fn to_model_point(&self, point: DVec3) -> DVec3 {
        self.model_from_world.transform_point3(point)
    }

    /// Tests whether its transform turns the winding of triangles around.
    pub fn mirrors(&self) -> bool {
        self.world_from_model.determinant() < 0.0
    }

    pub fn origin(&self) -> DVec3 {
        self.world_from_model.w_axis.truncate()
    }
}

fn place(object: &Object, index: usize, solid: &Solid<'_>) -> Result<PlacedObject, Error> {
    let world_from_model = object.world_from_model;
    let model_from_world = world_from_model.inverse();
    if !(world_from_model.is_finite() && model_from_world.is_finite()) {
        return Err(Error::Transform { name: object.name.clone() });
    }
    let linear = [model_from_world.x_axis, model_from_world.y_axis, model_from_world.z_axis];
    // The Frobenius norm is not below the largest singular value.
    let shrink = linear.iter().map(|axis| axis.truncate().length_squared()).sum::<f64>().sqrt();
    let farthest = |reach: f64, point: &DVec3| reach.max(world_from_model.transform_vector3(*point).length());
    let reach = solid.positions().iter().fold(0.0, farthest);
    let moved_by = object.wave.map_or(0.0, |wave| wave::error(&wave, &object.mesh, &world_from_model));
    let cutouts = find_cutouts(object);
    Ok(PlacedObject {
        solid: index,
        casts_shadow: object.casts_shadow,
        world_from_model,
        model_from_world,
        shrink,
        reach,
        wave_error: moved_by,
        has_cutouts: cutouts.iter().any(Option::is_some),
        cutouts,
    })
}

fn find_cutouts(object: &Object) -> Vec<Option<AlphaCutout>> {
    let mesh = &object.mesh;
    let has_texcoords = mesh.texcoords.is_some();
    let own = object.material.as_deref();
    let test = |material: Option<&Material>| material.and_then(|material| AlphaCutout::new(material, has_texcoords));
    let of_part = |material: Option<usize>| test(own.or_else(|| mesh.materials.get(material?)));
    mesh.parts.iter().map(|part| of_part(part.material)).chain([test(own)]).collect()
}

fn world_box(placed: &PlacedObject, solid: &Solid<'_>) -> Aabb {
    let mut used = solid.mesh.indices.iter().map(|&index| placed.to_world(solid.position(index)));
    let first = used.next().unwrap_or(placed.origin());
    let (min, max) = used.fold((first, first), |(min, max), point| (min.min(point), max.max(point)));
    Aabb::new(Vector::from_array(min.to_array()), Vector::from_array(max.to_array()))
}

#[cfg(test)]
mod tests;
