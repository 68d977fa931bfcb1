//! Objects in a viewer's pyramid: their least and greatest depth along its axis, and what a plane across the axis cuts off.
//! Triangles are clipped one by one: a box's corners do not describe a floor that passes under the eye. The work is linear
//! in the triangles.

use glam::{DMat4, DVec2, DVec3, DVec4};

use super::{Camera, Frustum, Object};
use crate::math::frustum::{clip_polygon, faces};
use crate::math::{Aabb, spaces};
use crate::process::work;

/// Area in pixels below which a piece does not count.
pub(super) const LEAST_PIECE: f64 = 0.5;

/// A pyramid of view, without end: x right, y up, -z ahead.
#[derive(Clone, Debug)]
pub(super) struct Pyramid {
    view_from_world: DMat4,
    /// Half its width and half its height at depth 1.
    pub(super) tan: DVec2,
}

/// Depths, least and most, of what is in view; empty where `least` exceeds `most`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub least: f64,
    pub most: f64,
    /// Greatest coordinate, from the viewer or from the object's origin, of triangles that are partly in view.
    pub reach: f64,
}

impl Span {
    pub const EMPTY: Self = Self { least: f64::INFINITY, most: f64::NEG_INFINITY, reach: 0.0 };

    pub fn is_empty(&self) -> bool {
        self.least > self.most
    }

    pub fn union(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), most: self.most.max(other.most), reach: self.reach.max(other.reach) }
    }

    fn including(self, polygon: &[DVec3]) -> Self {
        polygon.iter().fold(self, |span, point| span.union(Self { least: -point.z, most: -point.z, reach: 0.0 }))
    }
}

impl Pyramid {
    /// `aspect` is the picture's width over its height.
    pub fn of_camera(camera: &Camera, aspect: f64) -> Self {
        let tan = (0.5 * camera.fov_y_radians).tan();
        Self { view_from_world: camera.view_from_world(), tan: DVec2::new(tan * aspect, tan) }
    }

    pub fn of_frustum(frustum: &Frustum) -> Self {
        Self { view_from_world: frustum.view_from_world(), tan: frustum.tangents() }
    }

    /// The six of a cube around `position`, which together hold everything.
    pub fn of_cube(position: DVec3) -> [Self; 6] {
        [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z].map(|way| {
            let up = if way.y == 0.0 { DVec3::Y } else { DVec3::Z };
            let view_from_world = spaces::view_from_world(DVec3::ZERO, way, up) * DMat4::from_translation(-position);
            Self { view_from_world, tan: DVec2::ONE }
        })
    }

    /// The depths of all of `object` that is in view.
    pub fn span(&self, object: &Object) -> Span {
        let mut span = Span::EMPTY;
        let origin = self.view_from_world.transform_point3(object.world_from_model.w_axis.truncate());
        self.visit_triangles(object, |corners, polygon| {
            span = span.including(polygon);
            let reach = corners.iter().map(|corner| corner.length_squared().max(corner.distance_squared(origin)));
            span.reach = reach.fold(span.reach, f64::max);
            true
        });
        span.reach = span.reach.sqrt();
        span
    }

    /// The depths of the faces of the object's box that are in view.
    pub fn span_of_box(&self, object: &Object) -> Span {
        let bounds = object.reach(object.mesh.bounds);
        let view_from_model = self.view_from_world * object.world_from_model;
        let corners = bounds.corners().map(|corner| view_from_model.transform_point3(corner));
        let inside =
            |face: [DVec3; 4]| self.planes().iter().fold(face.to_vec(), |left, plane| clip_polygon(&left, plane));
        faces(&corners).into_iter().fold(Span::EMPTY, |span, face| span.including(&inside(face)))
    }

    /// Tests whether the pieces of `object` at the depths that `cut` means fill `least` pixels or more of a picture of `size`.
    pub fn is_cut(&self, object: &Object, cut: Cut, size: [u32; 2], least: f64) -> bool {
        let mut area = 0.0;
        self.visit(object, |polygon| {
            area += self.pixels(&cut.piece(polygon), size);
            area < least
        });
        area >= least
    }

    /// The area of a polygon in view, in pixels.
    pub(super) fn pixels(&self, polygon: &[DVec3], size: [u32; 2]) -> f64 {
        if polygon.len() < 3 {
            return 0.0;
        }
        let seen = |point: &DVec3| point.truncate() / (-point.z * self.tan);
        let corner = |k: usize| seen(&polygon[k % polygon.len()]);
        let twice: f64 =
            (1..polygon.len() - 1).map(|k| (corner(k) - corner(0)).perp_dot(corner(k + 1) - corner(0))).sum();
        // At the very apex a polygon fills any part of the picture.
        let area = if twice.is_finite() { 0.5 * twice.abs() } else { 4.0 };
        area * 0.25 * f64::from(size[0]) * f64::from(size[1])
    }

    /// Calls `look` with the part in view of each drawn triangle, in view space, until it says `false`.
    pub(super) fn visit(&self, object: &Object, mut look: impl FnMut(&[DVec3]) -> bool) {
        self.visit_triangles(object, |_, polygon| look(polygon));
    }

    /// The same with each triangle's corners.
    fn visit_triangles(&self, object: &Object, mut look: impl FnMut(&[DVec3; 3], &[DVec3]) -> bool) {
        let (mesh, positions) = (&object.mesh, object.drawn_positions());
        let view_from_model = self.view_from_world * object.world_from_model;
        for part in &mesh.parts {
            if is_clear(object, part.material) || self.misses(&object.reach(part.bounds), &view_from_model) {
                continue;
            }
            let indices = &mesh.indices[part.indices.start as usize..part.indices.end as usize];
            work::count_triangles(indices.len());
            for triangle in indices.as_chunks::<3>().0 {
                let corners = triangle.map(|index| {
                    let place = DVec3::from_array(positions[index as usize].map(f64::from));
                    view_from_model.transform_point3(place)
                });
                let outside = corners.map(|corner| self.outside(corner));
                let goes_on = if outside == [0; 3] {
                    look(&corners, &corners)
                } else if outside.iter().fold(u8::MAX, |all, bits| all & bits) == 0 {
                    let inside = self.planes().iter().fold(corners.to_vec(), |left, plane| clip_polygon(&left, plane));
                    inside.is_empty() || look(&corners, &inside)
                } else {
                    true
                };
                if !goes_on {
                    return;
                }
            }
        }
    }

    fn misses(&self, bounds: &Aabb, view_from_model: &DMat4) -> bool {
        let corners = bounds.corners().map(|corner| self.outside(view_from_model.transform_point3(corner)));
        corners.iter().fold(u8::MAX, |all, bits| all & bits) != 0
    }

    /// A bit for each side that the point lies beyond.
    fn outside(&self, point: DVec3) -> u8 {
        let reach = -point.z * self.tan;
        u8::from(point.x < -reach.x)
            | u8::from(point.x > reach.x) << 1
            | u8::from(point.y < -reach.y) << 2
            | u8::from(point.y > reach.y) << 3
    }

    /// The sides, positive inside.
    fn planes(&self) -> [DVec4; 4] {
        let DVec2 { x, y } = self.tan;
        [[1.0, 0.0, -x], [-1.0, 0.0, -x], [0.0, 1.0, -y], [0.0, -1.0, -y]].map(|[a, b, c]| DVec4::new(a, b, c, 0.0))
    }
}

/// Depths that are cut off.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cut {
    Before(f64),
    Between(f64, f64),
}

impl Cut {
    pub(super) fn piece(self, polygon: &[DVec3]) -> Vec<DVec3> {
        let before = |depth: f64, polygon: &[DVec3]| clip_polygon(polygon, &DVec4::new(0.0, 0.0, 1.0, depth));
        match self {
            Self::Before(depth) => before(depth, polygon),
            Self::Between(from, to) => {
                let beyond = clip_polygon(polygon, &DVec4::new(0.0, 0.0, -1.0, -from));
                if to.is_finite() { before(to, &beyond) } else { beyond }
            }
        }
    }
}

/// Tests whether the alpha test leaves nothing of a part.
fn is_clear(object: &Object, material: Option<usize>) -> bool {
    let own = || object.mesh.materials.get(material?);
    object.material.as_deref().or_else(own).is_some_and(|material| material.opacity < 0.5)
}
