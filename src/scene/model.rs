//! The resolved scene: what a frame shows, in world space, angles in radians.

use std::sync::Arc;

use glam::{DMat4, DVec3};

use super::Settings;
use crate::geometry::{Material, Mesh, Texture};

/// All that a frame shows. Nothing in it refers to GL or to a technique by more than its name.
#[derive(Clone, Debug)]
pub struct Scene {
    pub image: Image,
    pub camera: Camera,
    pub shading: Shading,
    pub lights: Vec<Light>,
    pub objects: Vec<Object>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Width and height in pixels, each in 1..=16384.
    pub size: [u32; 2],
    /// Clear colour, RGB in [0, 1].
    pub background: [f32; 3],
}

/// A symmetric perspective camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    pub eye: DVec3,
    pub target: DVec3,
    /// Of unit length, not parallel to the view direction.
    pub up: DVec3,
    /// Full vertical angle, in (0, pi).
    pub fov_y_radians: f64,
    /// 0 < near < far.
    pub near: f64,
    pub far: f64,
}

/// How surfaces answer light.
#[derive(Clone, Debug, PartialEq)]
pub struct Shading {
    /// GL_LIGHT_MODEL_AMBIENT, RGB; GL's default is 0.2.
    pub ambient: [f32; 3],
    /// Fixed-function lighting per vertex, or Phong per fragment.
    pub per_vertex: bool,
}

#[derive(Clone, Debug)]
pub struct Light {
    pub kind: LightKind,
    pub position: DVec3,
    pub target: DVec3,
    /// Of unit length, not parallel to the light's direction.
    pub up: DVec3,
    /// 0 < near < far, of the light's frustum.
    pub near: f64,
    pub far: f64,
    pub ambient: [f32; 3],
    pub diffuse: [f32; 3],
    pub specular: [f32; 3],
    /// GL's constant, linear and quadratic attenuation; (1, 0, 0): none.
    pub attenuation: [f32; 3],
    /// The spot image, projected through the light's frustum; modulates diffuse and specular.
    pub image: Option<Arc<Texture>>,
    /// Whether the light's frustum is drawn as a wire cube in the camera's picture.
    pub frustum_shown: bool,
    /// As written, or `light 0` by its place in the file.
    pub name: String,
    /// `[light.shadow]` as written; the technique that it names reads it. Empty: no shadow.
    pub shadow: Settings,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Lights what its frustum holds. `cone_radians`: the frustum's full angle, in (0, pi).
    Spot { cone_radians: f64, shape: LightShape },
}

/// Where a spotlight's light ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightShape {
    /// At the circular cone inscribed in the frustum (GL_SPOT_CUTOFF).
    Cone,
    /// At the square frustum's sides, as in the sample programs.
    Frustum,
}

/// A mesh placed in the world.
#[derive(Clone, Debug)]
pub struct Object {
    pub name: String,
    /// Shared: the same file is loaded once however often it is used.
    pub mesh: Arc<Mesh>,
    /// Affine and invertible; may mirror.
    pub world_from_model: DMat4,
    /// Stands in for every material of the mesh.
    pub material: Option<Arc<Material>>,
    /// Whether fixed-function or Phong lighting applies; `false`: the decal or diffuse colour as it is.
    pub lit: bool,
    /// Whether it is drawn into shadow maps.
    pub casts_shadow: bool,
    /// Declared, and checked: the mesh is closed and its faces look outwards, so that no back face is ever seen from
    /// outside of it.
    pub closed: bool,
}
