//! The resolved scene, in world space, angles in radians.

use std::sync::Arc;

use glam::{DMat4, DVec3};

use super::{Falloff, ImageFilter, Interpolation, LightBeam, Settings};
use crate::geometry::{Material, Mesh, Texture, Wave};

/// Everything that a frame shows. It knows no GL, and of a technique only the name.
#[derive(Clone, Debug)]
pub struct Scene {
    pub image: Image,
    pub camera: Camera,
    pub shading: Shading,
    pub lights: Vec<Light>,
    pub objects: Vec<Object>,
}

impl Scene {
    /// The textures of lights, objects and meshes; one that is used twice comes twice.
    pub fn textures(&self) -> impl Iterator<Item = &Texture> {
        let of_lights = self.lights.iter().filter_map(Light::spot).flat_map(|spot| {
            let of_beam = spot.beam.iter().flat_map(|beam| [Some(&*beam.map), beam.shield.as_deref()]);
            of_beam.chain([spot.image.as_deref()]).flatten()
        });
        let materials =
            self.objects.iter().flat_map(|object| object.material.as_deref().into_iter().chain(&object.mesh.materials));
        let of_materials =
            materials.flat_map(|material| material.decal.as_deref().into_iter().chain(material.alpha.as_deref()));
        of_lights.chain(of_materials)
    }
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
    /// Unit vector, not parallel to the view direction.
    pub up: DVec3,
    /// Full vertical angle, in (0, pi).
    pub fov_y_radians: f64,
    /// 0 < near < far.
    pub near: f64,
    pub far: f64,
}

/// Settings of shading.
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
    pub ambient: [f32; 3],
    pub diffuse: [f32; 3],
    pub specular: [f32; 3],
    /// Name as written, or `light 0` by its place in the file.
    pub name: String,
    /// `[light.shadow]` as written; the technique that it names reads it. Empty: no shadow.
    pub shadow: Settings,
}

/// Kind of a light, with the values that only this kind has.
#[derive(Clone, Debug)]
pub enum LightKind {
    Spot(Spot),
    Point(Point),
    /// Parallel light from infinitely far away. `direction`: the way that it travels, of unit length.
    Directional {
        direction: DVec3,
    },
}

/// A spotlight: it lights everything within its frustum's sides, or within the cone inscribed in them.
#[derive(Clone, Debug)]
pub struct Spot {
    pub frustum: Frustum,
    pub shape: LightShape,
    /// GL's constant, linear and quadratic attenuation; (1, 0, 0): none.
    pub attenuation: [f32; 3],
    /// The spot image, projected through the frustum; modulates diffuse and specular. Its first row lies towards
    /// [`Frustum::up`].
    pub image: Option<Arc<Texture>>,
    pub image_filter: ImageFilter,
    /// Intensity over the cross-section; modulates diffuse and specular, too.
    pub beam: Option<LightBeam>,
    /// Intensity along the axis; modulates diffuse and specular, too, beside `attenuation`.
    pub falloff: Option<Falloff>,
    pub interpolation: Interpolation,
    /// True if the frustum is drawn as a wire cube in the camera's picture.
    pub frustum_shown: bool,
}

/// A point light: it lights equally in all directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    pub position: DVec3,
    /// 0 < near < far: range of the light's maps, along the coordinate axis nearest to the direction (the largest of |x|,
    /// |y| and |z|), as the six faces of a cube map measure depth. They do not bound the light.
    pub near: f64,
    pub far: f64,
    /// Attenuation as in [`Spot::attenuation`].
    pub attenuation: [f32; 3],
}

/// A symmetric frustum.
#[derive(Clone, Debug, PartialEq)]
pub struct Frustum {
    pub position: DVec3,
    pub target: DVec3,
    /// Unit vector, not parallel to the way from position to target.
    pub up: DVec3,
    /// Full angle between its lower and upper side, in (0, pi).
    pub cone_radians: f64,
    /// Width over height of its cross-section, in [1e-3, 1e3]; 1: square.
    pub aspect: f64,
    /// 0 < near < far, along the axis.
    pub near: f64,
    pub far: f64,
}

/// Shape at which a spotlight's light ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightShape {
    /// At the circular cone inscribed in the frustum (GL_SPOT_CUTOFF).
    Cone,
    /// At the frustum's sides, as in the sample programs.
    Frustum,
}

/// A mesh placed in the world.
#[derive(Clone, Debug)]
pub struct Object {
    pub name: String,
    /// Shared: the same file is loaded once however often it is used.
    pub mesh: Arc<Mesh>,
    /// Affine, invertible transform of the mesh's positions; may mirror. It includes [`Mesh::origin`].
    pub world_from_model: DMat4,
    /// Wave that moves the mesh's vertices; `None`: they stay.
    pub wave: Option<Wave>,
    /// Replaces every material of the mesh.
    pub material: Option<Arc<Material>>,
    /// True if fixed-function or Phong lighting applies; `false`: the decal or diffuse colour as it is.
    pub lit: bool,
    /// True if it is drawn into shadow maps.
    pub casts_shadow: bool,
    /// Declared and checked by the scene: the mesh is closed and its faces look outwards, so that no back face is ever seen
    /// from outside of it.
    pub closed: bool,
}
