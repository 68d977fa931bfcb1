//! The volumes themselves, as meshes to draw [GDC, "Computing Shadow Volumes For Polygonal Models", "Near Clip Plane
//! Capping Cases"], each with the ends that its way of counting needs.

use std::ops::Range;
use std::sync::Arc;

use glam::{DMat4, DVec3};
use rayon::prelude::*;

use super::casters::CastingObject;
use super::choice::{CountMethod, FEWEST_IN_PARALLEL};
use super::extent;
use super::settings::Settings;
use crate::geometry::Mesh;
use crate::geometry::volume::{self, CameraHulls, CappedVolume, Caps, Extent, LightSource, Outline, Volume};
use crate::lights::light::{VolumeDraw, VolumeSpace};
use crate::lights::{LightView, Notes};
use crate::pass::{MeshRef, Primitive};

/// A caster's volume. Ranges that are empty are not drawn.
pub struct Shape {
    pub way: CountMethod,
    /// Index of its caster among the scene's objects.
    pub object: usize,
    pub sides: VolumeDraw,
    /// Caps at the caster's own surface or on the near plane; the same with front faces reversed; caps at the far end.
    pub caps: Vec<VolumeDraw>,
    pub silhouette: VolumeDraw,
}

impl Shape {
    pub fn whole(&self) -> impl Iterator<Item = VolumeDraw> {
        std::iter::once(&self.sides).chain(&self.caps).cloned()
    }

    /// Tests whether it has a cap whose depths must equal its caster's to the bit.
    pub fn meets_surface(&self) -> bool {
        self.way != CountMethod::ZPassCapped && !self.caps.is_empty()
    }
}

/// Shapes of the casters that are drawn.
pub fn shapes(
    view: &LightView<'_>,
    casting: &[CastingObject],
    ways: &[CountMethod],
    source: LightSource,
    settings: &Settings,
    notes: &mut Notes,
) -> Vec<Shape> {
    let viewer = CameraHulls::new(&view.camera.clip_from_world);
    let drawn: Vec<(&CastingObject, CountMethod)> =
        casting.iter().zip(ways.iter().copied()).filter(|(_, way)| *way != CountMethod::LeftOut).collect();
    let is_truncated = drawn.iter().any(|(_, way)| *way == CountMethod::ZFailTruncated);
    let truncated = if is_truncated { distance(view, settings) } else { 0.0 };
    let found = drawn
        .par_iter()
        .with_min_len(FEWEST_IN_PARALLEL)
        .map_init(Room::default, |room, (caster, way)| shape(view, caster, *way, (source, &viewer), truncated, room));
    let found: Vec<Option<Shape>> = found.collect();
    for ((caster, way), shape) in drawn.iter().zip(&found) {
        let is_touched = |shape: &Shape| shape.way == CountMethod::ZFailClamped && *way == CountMethod::ZPassCapped;
        if shape.as_ref().is_some_and(is_touched) {
            let why = "the light touches its surface, whose cap on the near plane has no area";
            notes.chosen(format!("{} for light {}", caster.label, view.index), "z-fail-clamped", why);
        }
    }
    found.into_iter().flatten().collect()
}

/// Room for volumes in the making, which casters share one after another.
#[derive(Default)]
struct Room {
    outline: Outline,
    volume: Volume,
    capped: CappedVolume,
}

/// The shape of one caster; `None`: it casts nothing. A cap on the near plane is replaced where the light touches the caster.
/// `truncated`: the length of volumes that are truncated, in world units.
fn shape(
    view: &LightView<'_>,
    caster: &CastingObject,
    way: CountMethod,
    (source, viewer): (LightSource, &CameraHulls),
    truncated: f64,
    Room { outline, volume, capped }: &mut Room,
) -> Option<Shape> {
    outline.find(&caster.caster, source.transformed(&caster.world_from_model.inverse()));
    if outline.edges().is_empty() && outline.weights().iter().all(|weight| *weight == 0) {
        return None;
    }
    let name = Name { caster, light: view.index };
    let silhouette = name.silhouette(outline);
    let touches = way == CountMethod::ZPassCapped && volume::light_touches(&caster.caster, outline);
    let way = if touches { CountMethod::ZFailClamped } else { way };
    Some(if way == CountMethod::ZPassCapped {
        let view_from_model = view.camera.viewer.eye_from_world * caster.world_from_model;
        let beyond = extent::beyond_all(view, caster, source).filter(|_| !view.keep_all);
        let end = beyond.map(|plane| in_view(&view.camera.viewer.eye_from_world, plane));
        capped.cut_before(&caster.caster, outline, &view_from_model, view.scene.camera.near, end);
        name.capped(capped, silhouette)
    } else {
        let seen = volume::VolumeHulls::new(&caster.bounds, &caster.world_from_model, source);
        let touches = || volume::light_touches(&caster.caster, outline);
        let extent = match way {
            CountMethod::ZFailTruncated => Extent::Truncated(model_distance(caster, truncated)),
            CountMethod::ZFail | CountMethod::ZFailClamped if touches() => Extent::Infinite,
            _ => end(view, caster, source),
        };
        let caps = caps(way, &seen, viewer, view.keep_all, extent);
        volume.extrude(&caster.caster, outline, extent, caps);
        name.volume(way, volume, silhouette)
    })
}

/// Caps that can be seen, if the way of counting needs them.
fn caps(way: CountMethod, seen: &volume::VolumeHulls, viewer: &CameraHulls, all: bool, extent: Extent) -> Caps {
    match way {
        CountMethod::ZFailTruncated => Caps::BOTH,
        CountMethod::ZFail | CountMethod::ZFailClamped => {
            let far = all || extent != Extent::Infinite || seen.far_cap_may_be_seen(viewer);
            Caps { light: all || seen.light_cap_may_be_seen(viewer), far }
        }
        _ => Caps::NONE,
    }
}

/// End of a volume that is counted only before visible surfaces: a plane beyond all that is seen and the eye. Sides that go
/// on behind the floor would be wasted fragments.
fn end(view: &LightView<'_>, caster: &CastingObject, source: LightSource) -> Extent {
    let Some(end) = extent::beyond_all(view, caster, source).filter(|_| !view.keep_all) else {
        return Extent::Infinite;
    };
    let model_from_world = caster.world_from_model.transpose();
    let normal = model_from_world.transform_vector3(end.normal);
    let distance = end.distance - end.normal.dot(caster.world_from_model.w_axis.truncate());
    Extent::ToPlane { normal, distance }
}

/// The same plane in view space: normal and distance.
fn in_view(view_from_world: &DMat4, plane: extent::Plane) -> (DVec3, f64) {
    let normal = view_from_world.transform_vector3(plane.normal);
    (normal, plane.distance + normal.dot(view_from_world.w_axis.truncate()))
}

/// The distance that truncated volumes reach, in world units.
pub fn distance(view: &LightView<'_>, settings: &Settings) -> f64 {
    settings.distance.unwrap_or_else(|| default_distance(view))
}

/// That distance, `world`, in the caster's model units.
pub fn model_distance(caster: &CastingObject, world: f64) -> f64 {
    let scale = caster.world_from_model.determinant().abs().cbrt();
    world / scale
}

/// Default length of truncated volumes, in world units.
fn default_distance(view: &LightView<'_>) -> f64 {
    2.0 * view.scene.world_bounds().radius()
}

/// Name and transform of a draw.
struct Name<'a> {
    caster: &'a CastingObject,
    light: usize,
}

impl Name<'_> {
    fn draw(&self, what: &str, mesh: &MeshRef, indices: Range<u32>, space: VolumeSpace) -> VolumeDraw {
        VolumeDraw {
            label: format!("{what} of {}", self.caster.label),
            mesh: mesh.clone(),
            primitive: Primitive::Triangles,
            indices,
            space,
            reversed: false,
        }
    }

    fn model(&self) -> VolumeSpace {
        VolumeSpace::Model { world_from_model: self.caster.world_from_model }
    }

    fn mesh(&self, what: &str, homogeneous: Vec<[f32; 4]>, indices: Vec<u32>) -> MeshRef {
        let name = format!("{what} of {} for light {}", self.caster.label, self.light);
        MeshRef(Arc::new(Mesh { name, homogeneous, indices, ..Mesh::default() }))
    }

    fn volume(&self, way: CountMethod, volume: &Volume, silhouette: VolumeDraw) -> Shape {
        let mesh = self.mesh("volume", volume.vertices().to_vec(), volume.indices().to_vec());
        let draw = |what, indices| self.draw(what, &mesh, indices, self.model());
        let reversed = VolumeDraw { reversed: true, ..draw("averted light cap", volume.light_cap_reversed()) };
        let caps = [draw("light cap", volume.light_cap()), reversed, draw("far cap", volume.far_cap())];
        let caps = caps.into_iter().filter(|cap| !cap.indices.is_empty()).collect();
        Shape { way, object: self.caster.object, sides: draw("sides", volume.sides()), caps, silhouette }
    }

    fn capped(&self, volume: &CappedVolume, silhouette: VolumeDraw) -> Shape {
        let mesh = self.mesh("volume", volume.vertices().to_vec(), volume.indices().to_vec());
        let draw = |what, indices| self.draw(what, &mesh, indices, VolumeSpace::Eye);
        let cap = draw("near cap", volume.near_cap());
        let caps = if cap.indices.is_empty() { Vec::new() } else { vec![cap] };
        Shape {
            way: CountMethod::ZPassCapped,
            object: self.caster.object,
            sides: draw("sides", volume.sides()),
            caps,
            silhouette,
        }
    }

    fn silhouette(&self, outline: &Outline) -> VolumeDraw {
        let positions = self.caster.caster.positions();
        let ends = outline.edges().iter().flat_map(|edge| [edge.from, edge.to]);
        let points: Vec<[f32; 4]> =
            ends.map(|place| positions[place as usize]).map(|[x, y, z]| [x, y, z, 1.0]).collect();
        let indices: Vec<u32> = (0..points.len() as u32).collect();
        let count = points.len() as u32;
        let mesh = self.mesh("silhouette", points, indices);
        VolumeDraw { primitive: Primitive::Lines, ..self.draw("silhouette", &mesh, 0..count, self.model()) }
    }
}
