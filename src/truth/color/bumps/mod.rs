//! Bump-mapped surfaces in f64, with bounds [GDC, "Per-Pixel Lighting Math"]: the normal from the file's heights, the
//! surface's directions by a formula of their own, and the factors of diffuse and specular light. For the reference vectors
//! are exact; for register combiners they are interpolated between a triangle's corners and looked up in a cube map, both in
//! f64.

mod basis;
mod cube;
mod levels;
mod span;

use glam::{DMat3, DVec2, DVec3};

use self::basis::Axes;
pub(super) use self::levels::BumpMap;
use self::span::{Ball, Span};
use super::bounds::Bounds;
use super::known::Method;
use super::projected::Place;
use super::sample::Sample;
use super::unit;
use crate::geometry::bump::Bump;
use crate::geometry::tangents::BasisFit;
use crate::scene::{Normalize, Object, Scene};
use crate::truth::wave;

/// Error of f32 in an interpolated vector, as a share of the corners' longest.
const INTERPOLATION: f64 = 1e-6;

/// A point of a bump-mapped surface.
pub(super) struct BumpedPoint {
    method: Method,
    self_shadow: bool,
    normalize: Normalize,
    eye: DVec3,
    /// The normal map's vector, in tangent space.
    texel: Ball,
    dim: Bounds,
    /// World-space axes at the triangle's corners, by the object's matrix of normals.
    axes: [Axes; 3],
    corners: [DVec3; 3],
    weights: [f64; 3],
    /// By how much a sample's place in its pixel moves these.
    moved: [[f64; 3]; 2],
    /// -1 where the surface is seen from behind.
    side: f64,
}

/// Factors of diffuse and of specular light.
pub(super) struct Response {
    pub cosine: Bounds,
    pub shine: Bounds,
}

/// The triangle that a pixel shows.
pub(super) struct Facet<'a> {
    pub object: &'a Object,
    /// Vertices of the mesh.
    pub indices: [usize; 3],
    /// World space.
    pub corners: [DVec3; 3],
    pub texcoords: [DVec2; 3],
    pub weights: [f64; 3],
    pub moved: [[f64; 3]; 2],
    /// Share by which the distance from the eye changes from a pixel to those beside it.
    pub perspective: f64,
    /// -1 where it is seen from behind.
    pub side: f64,
}

impl BumpedPoint {
    pub fn new(facet: &Facet<'_>, bump: &Bump, map: &BumpMap, scene: &Scene, matrix: DMat3, place: &Place) -> Self {
        let object = facet.object;
        let vector = |all: &[[f32; 3]], index: usize| DVec3::from_array(all[index].map(f64::from));
        let places = facet.indices.map(|index| vector(&object.mesh.positions, index));
        let normals = facet.indices.map(|index| vector(&object.mesh.normals, index));
        let generated = object.material.as_ref().is_some_and(|material| material.texgen.is_some());
        let has_own = object.mesh.name == "torus" && bump.fit == BasisFit::Orthogonal && !generated;
        let (axes, is_known) = match has_own {
            true => ([0, 1, 2].map(|k: usize| basis::torus_axes(places[k], normals[k])), true),
            false => basis::corner_axes(places, facet.texcoords, normals, bump.fit),
        };
        let world = |place: DVec3, axes: Axes| {
            let turned = object.wave.map_or(axes, |wave| wave::turned_axes(axes, place, &wave));
            turned.map(|axis| matrix * axis)
        };
        let filtered = map.look(place, facet.perspective);
        let mut texel = filtered.normal;
        if !is_known {
            texel.error += 2.0 * texel.at.truncate().length();
        }
        let shading = &scene.shading.bumps;
        Self {
            method: Method::of(shading),
            self_shadow: shading.self_shadow,
            normalize: shading.normalize,
            eye: scene.camera.eye,
            texel,
            dim: filtered.dim,
            axes: [0, 1, 2].map(|k: usize| world(places[k], axes[k])),
            corners: facet.corners,
            weights: facet.weights,
            moved: facet.moved,
            side: facet.side,
        }
    }

    /// True if each light is clamped before it meets the surface.
    pub fn is_combined(&self) -> bool {
        self.method != Method::Reference
    }

    /// Factors of a light. `to_light`: the way to it from a point, of any length.
    pub fn response(&self, to_light: &dyn Fn(DVec3) -> DVec3, shininess: f64, at: &Sample) -> Response {
        match self.method {
            Method::Reference => self.computed(to_light, shininess, at),
            Method::Combined { reads_light, rounds } => self.combined(to_light, reads_light, rounds),
        }
    }

    /// Exact vectors at the point.
    fn computed(&self, to_light: &dyn Fn(DVec3) -> DVec3, shininess: f64, at: &Sample) -> Response {
        let axes = [0, 1, 2].map(|axis: usize| mix([0, 1, 2].map(|k: usize| self.axes[k][axis]), self.weights));
        let smooth = Ball { at: self.side * unit(axes[2]), error: 0.0 };
        // As long as the texel.
        let bent =
            |texel: DVec3| self.side * texel.length() * unit(texel.x * axes[0] + texel.y * axes[1] + texel.z * axes[2]);
        let normal = self.texel.through(bent);
        let moved = at.spread[0].length() + at.spread[1].length() + at.error;
        let direction = |way: DVec3| Ball { at: unit(way), error: (moved / way.length()).min(2.0) };
        let (light, viewer) = (direction(to_light(at.position)), direction(self.eye - at.position));
        let sum = light.at + viewer.at;
        let half = Ball { at: unit(sum), error: ((light.error + viewer.error + 1e-6) / sum.length()).min(2.0) };
        let self_light = if self.self_shadow { smooth.dot(&light).ramp() } else { Bounds::ALL };
        let facing = normal.dot(&light);
        let shine = normal.dot(&half).power(shininess);
        let seen = if self.self_shadow { self_light.times(smooth.dot(&half).ramp()) } else { facing.is_positive() };
        Response { cosine: self.dim.times(facing.unbounded()).times(self_light), shine: shine.times(seen) }
    }

    /// Vectors interpolated between the corners, and looked up. `rounds`: each result to a code of 255.
    fn combined(&self, to_light: &dyn Fn(DVec3) -> DVec3, reads_light: bool, rounds: bool) -> Response {
        let tangent = |k: usize, way: DVec3| DVec3::from_array(self.axes[k].map(|axis| way.dot(axis)));
        let lights = [0, 1, 2].map(|k: usize| tangent(k, to_light(self.corners[k])));
        let halves = [0, 1, 2].map(|k: usize| unit(lights[k]) + unit(tangent(k, self.eye - self.corners[k])));
        let [light, half] = [lights, halves].map(|vectors| self.looked_up(vectors));
        let round = |span: Span| if rounds { span.rounded() } else { span };
        let rounded = |bounds: Bounds| round(Span::of(bounds)).positive();
        let along = |vector: &Ball| round(Span::within(8.0 * vector.at.z, 8.0 * vector.error)).positive();
        let [self_light, self_half] = [along(&light), along(&half)];
        let facing = round(self.texel.dot(&light)).positive();
        let mut shine = round(self.texel.dot(&half)).positive();
        for _ in 0..3 {
            shine = rounded(shine.times(shine));
        }
        let cosine = rounded(rounded(facing.times(self_light)).times(self.dim));
        let seen = if reads_light { rounded(self_light.times(self_half)) } else { self_half };
        Response { cosine, shine: shine.times(seen) }
    }

    /// A vector between those of the corners, of unit length by a cube map or exactly.
    fn looked_up(&self, corners: [DVec3; 3]) -> Ball {
        let way = mix(corners, self.weights);
        let longest = corners.iter().map(|corner| corner.length()).fold(0.0, f64::max);
        let moved: f64 = self.moved.iter().map(|moved| mix(corners, *moved).length()).sum();
        let way = Ball { at: self.side * way, error: moved + INTERPOLATION * longest };
        match self.normalize {
            Normalize::Cube { size, seamless } => cube::lookup(size, seamless, way),
            Normalize::Exact => Ball { at: unit(way.at), error: (way.error / way.at.length()).min(2.0) },
        }
    }
}

fn mix(corners: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    (0..3).map(|k| corners[k] * weights[k]).sum()
}
