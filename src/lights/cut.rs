//! Cuts surfaces that reach far beyond a picture or a map, on the CPU, in f64, before they are drawn.
//!
//! GL clips in f32: where it cuts an edge, the new vertex and all that is interpolated to it are off by about 2^-24 of the
//! edge's ends. For a floor whose corners lie 10⁵ units away, with light and eye 4 units above it, this is 0.006 units:
//! more than the offset of its own texels, so that it is dark in patches, or all over. A surface that was cut before needs
//! no clipping by GL, and is off by 2^-24 of its own distance. Positions are off by 2^-24 of their distance from their
//! origin. For an eye this origin is the eye. In a map, surfaces that lie much farther than the rest become a mesh of their
//! own with an origin of its own. Every pass for the same eye, and every pass of the same map, draws the same cut meshes,
//! so that depths agree to the bit.

use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::Arc;

use glam::{DMat4, DVec3, DVec4, Vec2, Vec3};

use super::projector::{Projector, Rays};
use super::{Drawable, Viewer};
use crate::geometry::{Derived, Mesh, MeshTangents, Most, Part};
use crate::math::Aabb;
use crate::pass::MeshRef;
use crate::process::work;
use crate::scene::{LightKind, Scene};

/// Roundings of 2^-24 of the greatest clip coordinate in a vertex that GL makes where it clips: one in each end's
/// transform, one in the distance from the plane, one in the product.
const CLIP_ROUNDINGS: f64 = 4.0;

/// Planes of clip space; points that are kept have a product >= 0 with each. They lie a quarter beyond the visible sides,
/// so that GL has nothing to clip there, and at the far plane. The near plane is not among them: a map may have to show
/// casters before it, at depth 0.
const PLANES: [DVec4; 5] = [
    DVec4::new(1.0, 0.0, 0.0, 1.25),
    DVec4::new(-1.0, 0.0, 0.0, 1.25),
    DVec4::new(0.0, 1.0, 0.0, 1.25),
    DVec4::new(0.0, -1.0, 0.0, 1.25),
    DVec4::new(0.0, 0.0, -1.0, 1.0),
];

/// Greatest ratio of a piece's farthest to its nearest distance. GL clips what crosses a side of the picture after all, and
/// with an error that is 2^-24 of the piece's farthest end.
const PIECE: f64 = 4.0;

/// Number of pieces behind one another that share an origin in a map: up to [`PIECE`] to this power times as far as the
/// nearest one, about as far as [`ORDINARY`] has it.
const SHARE_ORIGIN: usize = 2;

/// Ratio of a clip coordinate to w that is never too large: ordinary scenes stay below it.
const ORDINARY: f64 = 16.0;

/// The same ratio for a camera: 2^-24 of these is a ten-thousandth of what is seen, a tenth of a texel of a map that shows
/// it. Where volumes are counted, [`ORDINARY`] holds: their sides meet the surfaces themselves, to a hundredth of a pixel.
const ORDINARY_FOR_CAMERA: f64 = 400.0;

/// Texels a side of the map that [`ordinary_for_camera`] assumes.
const MAP_SIZE: f64 = 1024.0;

/// Share of a clip coordinate that is more than f64 rounds in it.
const SURE: f64 = 1e-12;

/// Meshes of more triangles are not cut: their triangles are small.
const MOST_TRIANGLES: u32 = 1 << 16;

/// Ratio of a clip coordinate to w that is not too large for a camera, between [`ORDINARY`] and [`ORDINARY_FOR_CAMERA`]:
/// fewer where a light's near plane is so near that its map resolves few depths.
///
/// The place of a fragment in a map is interpolated as (s, t, r, q). Where corners have k times the fragment's own w, r/q
/// is off by some roundings of k · 2^-24. A map whose near plane is at n has r/q = 1 - n / q, nearly: over one texel a
/// slope of 45 degrees falls away by n texel / q, a texel being `texel` wide where q is 1. The error may be half of that.
fn ordinary_for_camera(scene: &Scene) -> f64 {
    let allowed = scene.lights.iter().filter_map(|light| {
        let (position, near, tangent) = match &light.kind {
            LightKind::Spot(spot) => (spot.frustum.position, spot.frustum.near, spot.frustum.tangents().min_element()),
            LightKind::Point(point) => (point.position, point.near, 1.0),
            LightKind::Directional { .. } => return None,
        };
        let fall = near * 2.0 * tangent / MAP_SIZE / position.distance(scene.camera.target);
        Some(0.5 * fall / (CLIP_ROUNDINGS * 2.0_f64.powi(-24)))
    });
    allowed.fold(ORDINARY_FOR_CAMERA, f64::min).max(ORDINARY)
}

/// Cuts meshes for one map or picture, with the error of a clip coordinate that it does not show.
pub struct Cutter<'d> {
    /// Cut meshes of earlier plans: a pass that draws the same meshes is not redrawn.
    derived: &'d Derived,
    clip_from_world: DMat4,
    /// The error of x and y that does not show, where w is 1.
    across: f64,
    /// The error of z that does not show.
    along: f64,
    /// The least w.
    nearest: f64,
    /// The planes of [`PLANES`] that cut.
    planes: &'static [DVec4],
    /// The origin of all that is cut, in world space; `None`: pieces have their own.
    origin: Option<DVec3>,
}

impl<'d> Cutter<'d> {
    /// A cutter for a map of `size` texels a side, each `texel` wide at a distance of 1 along its axis, or anywhere in
    /// parallel light. What is drawn `clamped` shows what lies beyond the far plane, too.
    pub fn for_map(
        projector: &Projector,
        clip_from_world: &DMat4,
        texel: f64,
        size: u32,
        clamped: bool,
        derived: &'d Derived,
    ) -> Self {
        // An eighth of what a slope of 45 degrees falls away by over one texel; offsets have a multiple of that.
        let (along, nearest) = match projector.rays {
            // z = A w - B, and B is about twice the distance of the near plane: z / w grows by B / w² along the ray, and
            // a texel is `texel` w wide.
            Rays::From { near, .. } => (0.25 * near * texel, near),
            Rays::Along(_) => (0.125 * texel * projector.clip_from_light.z_axis.z.abs(), 1.0),
        };
        // A twentieth of a texel, of which a width of 2 has as many as the map's size.
        let planes = if clamped { &PLANES[..4] } else { &PLANES[..] };
        let across = 0.1 / f64::from(size);
        Self { derived, clip_from_world: *clip_from_world, across, along, nearest, planes, origin: None }
    }

    /// A cutter for an eye; `None` if vertices must stay as they are: per-vertex light is computed at the file's vertices.
    /// Surfaces that volumes' caps meet must not be cut either. `counted`: volumes' sides meet what is drawn.
    pub fn for_eye(scene: &Scene, viewer: &Viewer, counted: bool, derived: &'d Derived) -> Option<Self> {
        let ordinary = if counted { ORDINARY } else { ordinary_for_camera(scene) };
        (!scene.shading.per_vertex).then_some(Self {
            derived,
            clip_from_world: viewer.clip_from_world(),
            across: ordinary * CLIP_ROUNDINGS * 2.0_f64.powi(-24),
            along: f64::INFINITY,
            nearest: viewer.near(),
            planes: &PLANES,
            origin: Some(viewer.eye_from_world.inverse().w_axis.truncate()),
        })
    }

    /// All of `items`. Those that reach too far are cut, except those of the objects `kept`.
    pub fn cut_all<'a>(&self, items: &'a [Drawable], kept: &HashSet<usize>) -> Cow<'a, [Drawable]> {
        let mut cut: Option<Vec<Drawable>> = None;
        for (index, item) in items.iter().enumerate() {
            let pieces = if kept.contains(&item.object) { None } else { self.pieces(item) };
            match (pieces, &mut cut) {
                (None, None) => {}
                (None, Some(cut)) => cut.push(item.clone()),
                (Some(pieces), cut) => cut.get_or_insert_with(|| items[..index].to_vec()).extend(pieces),
            }
        }
        cut.map_or(Cow::Borrowed(items), Cow::Owned)
    }

    /// The greatest clip coordinate of a triangle that GL may clip where w is at least this.
    fn most(&self, w: f64) -> f64 {
        let most = (self.across * w).min(self.along) / (CLIP_ROUNDINGS * 2.0_f64.powi(-24));
        most.max(ORDINARY * w)
    }

    /// `items`, each as it is or in the visible pieces of it.
    pub fn cut<'a>(&self, items: impl IntoIterator<Item = &'a Drawable>) -> Vec<Cow<'a, Drawable>> {
        let mut cut = Vec::new();
        for item in items {
            match self.pieces(item) {
                None => cut.push(Cow::Borrowed(item)),
                Some(pieces) => cut.extend(pieces.into_iter().map(Cow::Owned)),
            }
        }
        cut
    }

    /// The visible pieces of an item that reaches too far, nearest first; `None`: it is drawn as it is. Waves are not cut: the
    /// vertex stage moves them.
    fn pieces(&self, item: &Drawable) -> Option<Vec<Drawable>> {
        let clip_from_model = self.clip_from_world * item.world_from_model;
        let triangles = (item.indices.end - item.indices.start) / 3;
        if item.wave.is_some() || triangles > MOST_TRIANGLES || !self.may_cut(&item.bounds, &clip_from_model) {
            return None;
        }
        let part = |(mesh, origin): (Arc<Mesh>, DVec3)| Drawable {
            indices: 0..mesh.indices.len() as u32,
            bounds: mesh.bounds,
            world_from_model: item.world_from_model * DMat4::from_translation(origin),
            mesh: MeshRef(mesh),
            ..item.clone()
        };
        let cut = self.cut_once(item, &clip_from_model);
        (!cut.is_empty()).then(|| cut.into_iter().map(part).collect())
    }

    /// Tests whether some triangle in a box may be cut: one whose greatest clip coordinate is too large for its least w, and
    /// that is not within all planes. Both are at their worst at corners of the box.
    fn may_cut(&self, bounds: &Aabb, clip_from_model: &DMat4) -> bool {
        let corners = bounds.corners().map(|corner| *clip_from_model * corner.extend(1.0));
        let reach = corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
        let least = corners.iter().map(|corner| corner.w).fold(f64::INFINITY, f64::min).max(self.nearest);
        let is_inside = |corner: &DVec4| self.planes.iter().all(|plane| plane.dot(*corner) > SURE * reach);
        // A NaN is no proof.
        !(reach < self.most(least) * (1.0 - SURE) || corners.iter().all(is_inside))
    }

    /// The meshes of [`Cutter::cut_mesh`], found once.
    fn cut_once(&self, item: &Drawable, clip_from_model: &DMat4) -> Vec<(Arc<Mesh>, DVec3)> {
        let key = Key {
            indices: (item.indices.start, item.indices.end),
            clip_from_model: clip_from_model.to_cols_array().map(f64::to_bits),
            forgiven: [self.across, self.along].map(f64::to_bits),
            planes: self.planes.len(),
        };
        self.derived.get(&item.mesh.0, Most::OfAll(MOST_KEPT), key, || self.cut_mesh(item, clip_from_model))
    }

    /// Cut meshes, each with an origin of its own in the item's space; none if nothing needs to be cut, or nothing is left.
    fn cut_mesh(&self, item: &Drawable, clip_from_model: &DMat4) -> Vec<(Arc<Mesh>, DVec3)> {
        let mesh = &item.mesh;
        let range = item.indices.start as usize..item.indices.end as usize;
        let (mut whole, mut polygons) = (Vec::new(), Vec::new());
        work::count_triangles(range.len());
        for triangle in mesh.indices[range].chunks_exact(3) {
            let triangle = [0, 1, 2].map(|k| Corner::of(mesh, triangle[k] as usize, clip_from_model));
            match self.cut_triangle(&triangle) {
                Some(polygon) => polygons.push(polygon),
                None => whole.push(triangle),
            }
        }
        if polygons.is_empty() {
            return Vec::new();
        }
        let nearest = polygons.iter().flatten().map(|corner| corner.clip.w).fold(f64::INFINITY, f64::min);
        let to_model = item.world_from_model.inverse();
        let shared = self.origin.map(|origin| to_model.transform_point3(origin)).filter(|origin| origin.is_finite());
        let share = if shared.is_some() { usize::MAX } else { SHARE_ORIGIN };
        let mut groups: Vec<Vec<[Corner; 3]>> = vec![whole];
        for polygon in polygons {
            for (index, piece) in pieces(polygon, nearest.max(self.nearest)).into_iter().enumerate() {
                let group = 1 + index / share;
                groups.resize(groups.len().max(group + 1), Vec::new());
                groups[group].extend((2..piece.len()).map(|k| [piece[0], piece[k - 1], piece[k]]));
            }
        }
        let part = |corners: Vec<[Corner; 3]>| {
            let bounds = Aabb::from_points(corners.iter().flatten().map(|corner| corner.position));
            // Object-linear coordinates are made from the model's own.
            let own = shared.unwrap_or_else(|| bounds.center());
            let origin = if item.material.texgen.is_some() { DVec3::ZERO } else { own };
            (Arc::new(made(mesh, &corners, origin)), origin)
        };
        groups.into_iter().filter(|corners| !corners.is_empty()).map(part).collect()
    }

    /// Part of a triangle that is shown, if GL would lose too much by clipping it.
    fn cut_triangle(&self, triangle: &[Corner; 3]) -> Option<Vec<Corner>> {
        let reach =
            |corners: &[Corner]| corners.iter().map(|corner| corner.clip.abs().max_element()).fold(0.0, f64::max);
        let whole = reach(triangle);
        if whole <= self.most(self.nearest) || triangle.iter().all(|corner| corner.is_inside(self.planes)) {
            return None;
        }
        let within = |polygon: Vec<Corner>, plane: &DVec4| clip(&polygon, |corner| plane.dot(corner.clip));
        let polygon = self.planes.iter().fold(triangle.to_vec(), within);
        let w = polygon.iter().map(|corner| corner.clip.w).fold(f64::INFINITY, f64::min).max(self.nearest);
        (whole > self.most(w)).then_some(polygon)
    }
}

/// Cuts a polygon by distance: where w is a power of [`PIECE`] times that of the nearest point of all, at the same places
/// in every triangle, so that neighbours share their vertices.
fn pieces(polygon: Vec<Corner>, nearest: f64) -> Vec<Vec<Corner>> {
    let mut pieces = Vec::new();
    let (mut rest, mut end) = (polygon, PIECE * nearest);
    while rest.iter().any(|corner| corner.clip.w > end) && end.is_finite() {
        pieces.push(clip(&rest, |corner| end - corner.clip.w));
        rest = clip(&rest, |corner| corner.clip.w - end);
        end *= PIECE;
    }
    pieces.push(rest);
    pieces
}

/// Number of cut casters that are kept.
const MOST_KEPT: usize = 256;

#[derive(Clone, Debug, PartialEq)]
struct Key {
    indices: (u32, u32),
    clip_from_model: [u64; 16],
    forgiven: [u64; 2],
    planes: usize,
}

/// A vertex, in f64, with all that passes read of one.
#[derive(Clone, Copy, Debug)]
struct Corner {
    position: DVec3,
    clip: DVec4,
    normal: Vec3,
    texcoord: Vec2,
    color: Vec3,
    /// Tangent and bitangent.
    tangents: [Vec3; 2],
}

impl Corner {
    fn of(mesh: &Mesh, index: usize, clip_from_model: &DMat4) -> Self {
        let position = DVec3::from_array(mesh.positions[index].map(f64::from));
        Self {
            position,
            clip: *clip_from_model * position.extend(1.0),
            normal: mesh.normals.get(index).copied().map_or(Vec3::Z, Vec3::from_array),
            texcoord: mesh.texcoords.as_ref().map_or(Vec2::ZERO, |all| Vec2::from_array(all[index])),
            color: mesh.colors.as_ref().map_or(Vec3::ONE, |all| Vec3::from_array(all[index])),
            tangents: mesh.tangents.as_ref().map_or([Vec3::ZERO; 2], |all| {
                [&all.tangents, &all.bitangents].map(|all| Vec3::from_array(all[index]))
            }),
        }
    }

    /// Tests whether GL does not clip it, except at the near plane.
    fn is_inside(&self, planes: &[DVec4]) -> bool {
        planes.iter().all(|plane| plane.dot(self.clip) >= 0.0)
    }

    fn lerp(&self, other: &Self, share: f64) -> Self {
        Self {
            position: self.position.lerp(other.position, share),
            clip: self.clip.lerp(other.clip, share),
            normal: self.normal.lerp(other.normal, share as f32),
            texcoord: self.texcoord.lerp(other.texcoord, share as f32),
            color: self.color.lerp(other.color, share as f32),
            tangents: [0, 1].map(|k: usize| self.tangents[k].lerp(other.tangents[k], share as f32)),
        }
    }
}

/// Part of a convex polygon without a distance below zero [Sutherland and Hodgman 1974].
fn clip(polygon: &[Corner], distance: impl Fn(&Corner) -> f64) -> Vec<Corner> {
    let mut clipped = Vec::with_capacity(polygon.len() + 1);
    for (index, corner) in polygon.iter().enumerate() {
        let next = &polygon[(index + 1) % polygon.len()];
        let (here, there) = (distance(corner), distance(next));
        if here >= 0.0 {
            clipped.push(*corner);
        }
        if (here >= 0.0) != (there >= 0.0) {
            clipped.push(corner.lerp(next, here / (here - there)));
        }
    }
    clipped
}

fn made(source: &Mesh, corners: &[[Corner; 3]], origin: DVec3) -> Mesh {
    let all = || corners.iter().flatten();
    let mut mesh = Mesh {
        name: source.name.clone(),
        positions: all().map(|corner| (corner.position - origin).as_vec3().to_array()).collect(),
        normals: all().map(|corner| corner.normal.to_array()).collect(),
        texcoords: source.texcoords.is_some().then(|| all().map(|corner| corner.texcoord.to_array()).collect()),
        colors: source.colors.is_some().then(|| all().map(|corner| corner.color.to_array()).collect()),
        tangents: source.tangents.is_some().then(|| MeshTangents {
            tangents: all().map(|corner| corner.tangents[0].to_array()).collect(),
            bitangents: all().map(|corner| corner.tangents[1].to_array()).collect(),
        }),
        indices: (0..3 * corners.len() as u32).collect(),
        ..Mesh::default()
    };
    let points = mesh.positions.iter().map(|position| DVec3::from_array(position.map(f64::from)));
    mesh.bounds = Aabb::from_points(points);
    let (name, indices, bounds) = (source.name.clone(), 0..mesh.indices.len() as u32, mesh.bounds);
    mesh.parts = vec![Part { name, indices, material: None, bounds }];
    mesh
}
