//! The resolved scene, in world space, angles in radians.

use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};

use super::{BumpShading, Falloff, ImageFilter, Interpolation, LightBeam, Shadow};
use crate::geometry::md2::{NormalSource, Pose};
use crate::geometry::tangents::BasisCounts;
use crate::geometry::{Gloss, Material, Mesh, Texture, Wave};

/// Everything that a frame shows. It knows no GL, and of a technique only the name.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Size and background of the picture.
    pub image: Image,
    /// The camera.
    pub camera: Camera,
    /// Shading of all surfaces.
    pub shading: Shading,
    /// Lights in the file's order.
    pub lights: Vec<Light>,
    /// Objects in the file's order.
    pub objects: Vec<Object>,
}

impl Scene {
    /// The textures of lights, objects, meshes and photographs; one that is used twice comes twice.
    pub fn textures(&self) -> impl Iterator<Item = &Texture> {
        let of_lights = self.lights.iter().filter_map(Light::spot).flat_map(|spot| {
            let of_beam = spot.beam.iter().flat_map(|beam| [Some(&*beam.map), beam.shield.as_deref()]);
            of_beam.chain([spot.image.as_deref()]).flatten()
        });
        let materials =
            self.objects.iter().flat_map(|object| object.material.as_deref().into_iter().chain(&object.mesh.materials));
        let of_materials = materials.flat_map(|material| {
            let gloss = if let Some(Gloss::Map(map)) = &material.gloss { Some(&**map) } else { None };
            material.decal.as_deref().into_iter().chain(material.alpha.as_deref()).chain(gloss)
        });
        let of_photos = self.objects.iter().filter_map(|object| object.photo.as_ref()?.image());
        of_lights.chain(of_materials).chain(of_photos.map(|image| &**image))
    }
}

/// The picture.
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
    /// Position, in world space.
    pub eye: DVec3,
    /// Point that it looks at, in world space; not `eye`.
    pub target: DVec3,
    /// Unit vector, not parallel to the view direction.
    pub up: DVec3,
    /// Full vertical angle, in (0, pi).
    pub fov_y_radians: f64,
    /// Distance of the near plane along the view direction; 0 < near < far.
    pub near: f64,
    /// Distance of the far plane along the view direction.
    pub far: f64,
}

/// Settings of shading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shading {
    /// GL_LIGHT_MODEL_AMBIENT, RGB; GL's default is 0.2.
    pub ambient: [f32; 3],
    /// Fixed-function lighting per vertex, or Phong per fragment.
    pub per_vertex: bool,
    /// Passes that make the picture.
    pub passes: PicturePasses,
    /// How bumps are lit.
    pub bumps: BumpShading,
    /// Content of pixels without a surface, where projectors' light is multiplied in.
    pub background: Background,
}

/// Passes in which light becomes a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PicturePasses {
    /// As few as the lights allow.
    #[default]
    One,
    /// Those of the slide projector: depth, each projector's light, the surfaces' colour [Segal 1992, 3.1].
    Slide,
    /// Those of shadows in destination alpha: ambient light; for each light its shade, then its colour [Segal 1992, 3.3].
    Shadow,
}

/// Content of pixels without a surface in the passes of the slide projector.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Background {
    /// The scene's background.
    #[default]
    Scene,
    /// The ambient light that every pixel is cleared to [Segal 1992, 3.1].
    Ambient,
}

/// A light.
#[derive(Clone, Debug)]
pub struct Light {
    /// Place of the light, and what it reaches.
    pub kind: LightKind,
    /// Ambient colour, RGB; GL's GL_AMBIENT.
    pub ambient: [f32; 3],
    /// Diffuse colour, RGB.
    pub diffuse: [f32; 3],
    /// Specular colour, RGB.
    pub specular: [f32; 3],
    /// Law by which it lights surfaces.
    pub law: Law,
    /// Name as written, or `light 0` by its place in the file.
    pub name: String,
    /// Dust in the light's way; `None`: clear air.
    pub dust: Option<Dust>,
    /// `[light.shadow]`, as written and as its technique has read it.
    pub shadow: Shadow,
}

/// Dusty air that shows a spotlight's beam between its near and far planes [LEC, "Combining Shadows with Atmospherics"].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dust {
    /// Extinction per world unit, >= 0: air of length l leaves exp(-density l) of what lies behind it.
    pub density: f64,
    /// Number of slices that the beam is drawn in, in 1..=4096.
    pub slices: u32,
    /// How slices are summed.
    pub blend: DustBlend,
    /// True if dust that no light reaches hides what lies behind it, too.
    pub hides_in_shadow: bool,
    /// True if a slice counts as thick as the pixel's ray goes through it; `false`: as it is along the view axis, which makes
    /// dust too thin towards the picture's corners.
    pub thickness_along_ray: bool,
    /// True if each pixel's slices are moved by a share of their distance: noise in place of bands.
    pub jitter: bool,
}

/// Sum of a beam's slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DustBlend {
    /// Slices lie over each other, from back to front: each hides a part of what lies behind it.
    Over,
    /// Slices are added up, and hide nothing.
    Add,
}

/// Law by which a light lights surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Law {
    /// Diffuse light by the angle to the normal, and specular light.
    #[default]
    Lit,
    /// A slide projector's: the image as it is, whatever the angle; nothing occludes it [Segal 1992, 3.1]. Spotlights only.
    Slide,
}

/// Kind of a light, with the values that only this kind has.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "a scene has few lights, and most are spotlights")]
pub enum LightKind {
    /// A spotlight.
    Spot(Spot),
    /// A point light.
    Point(Point),
    /// Parallel light from infinitely far away. `direction`: the way that it travels, of unit length.
    Directional {
        /// Unit vector in world space.
        direction: DVec3,
    },
}

/// A spotlight: it lights everything within its frustum's sides, or within the cone inscribed in them.
#[derive(Clone, Debug)]
pub struct Spot {
    /// Frustum that it lights, and that its maps have.
    pub frustum: Frustum,
    /// Shape at which the light ends.
    pub shape: LightShape,
    /// GL's constant, linear and quadratic attenuation; (1, 0, 0): none.
    pub attenuation: [f32; 3],
    /// The spot image, projected through the frustum; modulates diffuse and specular. Its first row lies towards
    /// [`Frustum::up`].
    pub image: Option<Arc<Texture>>,
    /// Filter of `image`.
    pub image_filter: ImageFilter,
    /// Intensity over the cross-section; modulates diffuse and specular, too.
    pub beam: Option<LightBeam>,
    /// Intensity along the axis; modulates diffuse and specular, too, beside `attenuation`.
    pub falloff: Option<Falloff>,
    /// Interpolation of its texture coordinates.
    pub interpolation: Interpolation,
    /// True if the frustum is drawn as a wire cube in the camera's picture.
    pub frustum_shown: bool,
    /// Lens that the light comes through; `None`: all of it comes from one point.
    pub focus: Option<Focus>,
}

/// A lens: the light comes from points of a disc around its position, across its axis. From each of them it is projected
/// through a frustum of its own; all of these agree in the focal plane [SEG, 3.2; Haeberli and Akeley 1990].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Focus {
    /// Distance of the focal plane along the axis, > 0.
    pub distance: f64,
    /// Radius of the lens in world units, >= 0; 0: one point.
    pub radius: f64,
    /// Number of lens points, in 1..=4096; 1: the lens's middle.
    pub samples: u32,
}

/// A point light: it lights equally in all directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Position, in world space.
    pub position: DVec3,
    /// 0 < near < far: range of the light's maps, along the coordinate axis nearest to the direction (the largest of |x|,
    /// |y| and |z|), as the six faces of a cube map measure depth. They do not bound the light.
    pub near: f64,
    /// Far end of that range.
    pub far: f64,
    /// Attenuation as in [`Spot::attenuation`].
    pub attenuation: [f32; 3],
}

/// A frustum, symmetric unless its axis leans.
#[derive(Clone, Debug, PartialEq)]
pub struct Frustum {
    /// Apex, in world space.
    pub position: DVec3,
    /// Point on the axis, in world space; not `position`.
    pub target: DVec3,
    /// Unit vector, not parallel to the way from position to target.
    pub up: DVec3,
    /// Full angle between its lower and upper side, in (0, pi).
    pub cone_radians: f64,
    /// Width over height of its cross-section, in [1e-3, 1e3]; 1: square.
    pub aspect: f64,
    /// Distance of the near plane along the axis; 0 < near < far.
    pub near: f64,
    /// Distance of the far plane along the axis.
    pub far: f64,
    /// The middle of its cross-section at distance 1, to the right of and above its axis; (0, 0): symmetric.
    pub lean: DVec2,
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
    /// Name as written, or the path of the mesh.
    pub name: String,
    /// Shared: the same file is loaded once however often it is used.
    pub mesh: Arc<Mesh>,
    /// Affine, invertible transform of the mesh's positions; may mirror. It includes [`Mesh::origin`].
    pub world_from_model: DMat4,
    /// Wave that moves the mesh's vertices; `None`: they stay.
    pub wave: Option<Wave>,
    /// Replaces every material of the mesh.
    pub material: Option<Arc<Material>>,
    /// Outcome of the skin that the object's model names; `None`: it names none, or the material has a decal of its own.
    pub skin: Option<ModelSkin>,
    /// A photograph of it, in place of its material's colour where the photograph shows it. Shared: objects with the same
    /// one need one depth map.
    pub photo: Option<Arc<Photo>>,
    /// Pose of a key-framed model, and where its normals come from; `None`: the mesh has one pose.
    pub pose: Option<(Pose, NormalSource)>,
    /// Counts of the tangent bases of a bump-mapped object; `None`: it has no bump map.
    pub bases: Option<BasisCounts>,
    /// True if fixed-function or Phong lighting applies; `false`: the decal or diffuse colour as it is.
    pub lit: bool,
    /// True if it is drawn into shadow maps.
    pub casts_shadow: bool,
    /// Declared and checked by the scene: the mesh is closed and its faces look outwards, so that no back face is ever seen
    /// from outside of it.
    pub closed: bool,
}

/// The first skin that a key-framed model names, for an object without a decal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelSkin {
    /// The picture at this path is the decal.
    Worn(String),
    /// The object has no decal.
    Absent {
        /// Name in the model.
        name: String,
        /// Reason in words.
        why: String,
    },
}

/// A photograph of objects, and the camera that took it.
#[derive(Clone, Debug)]
pub struct Photo {
    /// The camera as a spotlight that projects the photograph back: its frustum is the camera's, its image the photograph,
    /// its shadow settings those of the depth map that tells what the camera saw. It lights nothing.
    pub projector: Light,
    /// Content of points that the photograph does not show.
    pub hidden: Hidden,
}

/// Content of points that a photograph does not show: beyond its frame, behind its eye, or hidden from its eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hidden {
    /// The photograph all the same, without a test of depth: what lies behind something shows its colours. Beyond the frame
    /// those of the frame's edge; behind the eye the material's own colour, lit.
    Smear,
    /// Grey, 128 of 255.
    Grey,
    /// The material's own colour, lit.
    Leave,
}
