//! A light as techniques see it, and the term that they give the lit pass for it.

use std::ops::{Deref, Range};
use std::sync::Arc;

use glam::{DMat4, Vec4};

use super::camera_visibility::CameraView;
use super::coordinates::Coordinates;
use super::guard::Guard;
use super::map::MapInfo;
use super::projector::Projector;
use super::{Drawable, Viewer, drawable};
use crate::geometry::Derived;
use crate::math::Aabb;
use crate::pass::{
    Attribute, Batch, Chunk, Define, Draw, DrawState, Face, FixedFunctionDesc, ImageId, IndexOrder, Input, MeshRef,
    Primitive, Program, Redraw, Shade, Uniform, glsl,
};
use crate::scene::{Light, Scene};

/// Input of a technique that describes its passes for a light.
#[derive(Clone, Copy, Debug)]
pub struct LightView<'a> {
    pub scene: &'a Scene,
    pub items: &'a [Drawable],
    pub camera: &'a CameraView<'a>,
    /// Facts that earlier plans found from meshes.
    pub derived: &'a Derived,
    /// Into [`Scene::lights`]; beyond them, their number and that of a photograph.
    pub index: usize,
    /// That light, the photograph's camera, or what a part of its lens sends.
    pub source: &'a Light,
    /// True if more than the camera's picture of what the light reaches shows the light's map or volumes, as a view of the map
    /// does: then all of it is drawn.
    pub shown_whole: bool,
    /// True if things that no picture can show are drawn too, to prove that they change none.
    pub keep_all: bool,
    /// True if warnings may cost some milliseconds.
    pub sampled_warnings: bool,
}

impl<'a> LightView<'a> {
    pub fn light(&self) -> &'a Light {
        self.source
    }

    /// Number of the photograph whose camera it is.
    pub fn photo(&self) -> Option<usize> {
        self.index.checked_sub(self.scene.lights.len())
    }

    /// The light in messages and labels: by its number, or the photograph whose camera it is.
    pub fn name(&self) -> String {
        name_of(self.scene, self.index)
    }
}

/// Light `index` of a scene in messages and labels. Numbers beyond its lights are those of photographs.
pub fn name_of(scene: &Scene, index: usize) -> String {
    match index.checked_sub(scene.lights.len()) {
        None => format!("light {index}"),
        Some(photo) => format!("photograph {photo}"),
    }
}

/// A light as one map sees it: from a spotlight's own frustum, or from one that a technique made.
#[derive(Clone, Debug)]
pub struct FrustumView<'a> {
    pub light_view: LightView<'a>,
    pub projector: Projector,
}

impl<'a> Deref for FrustumView<'a> {
    type Target = LightView<'a>;

    fn deref(&self) -> &LightView<'a> {
        &self.light_view
    }
}

impl FrustumView<'_> {
    /// `P_light · L⁻¹`.
    pub fn clip_from_world(&self) -> DMat4 {
        self.projector.clip_from_world()
    }
}

/// A light in the lit pass: its shade, its reach, and what they need.
///
/// A technique makes one by [`LightTerm::new`] or [`LightTerm::unshadowed`] and fills
///
/// - `shade`: how a shader finds the visibility; its `meaning` is [`Shade::Shader`] with a reason where fixed function cannot;
/// - `coordinates` and `frustum_from_map`, if its map is not of the light's whole frustum;
/// - `map` and `map_info`, if it has a map: the image for views, the numbers for bounds of the error. Without `map_info` a wrong
///   pixel beside a shadow's edge is not excused by the map's resolution;
/// - `counting`, if volumes count in the stencil buffer: the picture is then drawn by another composition.
///
/// The other fields are set later: `dimming` and `guard` from the light's own keys, `gain`, `diffuse_weight` and `addition` by
/// compositions that draw a light in parts.
#[derive(Clone, Debug)]
pub struct LightTerm {
    /// Index into [`Scene::lights`]; beyond them, their number and that of a photograph.
    pub index: usize,
    /// That light, the photograph's camera, or what a part of its lens sends.
    pub source: Arc<Light>,
    pub shade: ShadeSource,
    /// Generation of `light_coord_@`; `None`: neither the shade nor the light's reach needs it.
    pub coordinates: Option<Coordinates>,
    /// The fraction of diffuse light that a full shadow leaves, in [0, 1].
    pub dimming: f32,
    /// Scale and offset from the map's (s/q, t/q) to the frustum's [0, 1] square, where they are not the same.
    pub frustum_from_map: Option<Vec4>,
    /// Part of each of the light's colours that is drawn.
    pub gain: Gain,
    /// Factor of the diffuse light behind all else, also behind the clamp of lighting per vertex; in [0, 1].
    pub diffuse_weight: f32,
    /// Light that the picture has already, before this light is added.
    pub addition: Addition,
    /// Guard against back projection.
    pub guard: Guard,
    /// The depth texture, for views of it.
    pub map: Option<ImageId>,
    /// The map in numbers, for bounds of the picture's error.
    pub map_info: Option<MapInfo>,
    /// Passes after which the stencil buffer is 0 where the light reaches. If they tag surfaces by `shade`, the lit pass
    /// does not evaluate it again.
    pub counting: Option<StencilCount>,
}

/// How a shader finds a light's shade.
#[derive(Clone, Debug)]
pub struct ShadeSource {
    /// Chunks that define `float shade_@()`, together.
    pub chunks: Vec<Chunk>,
    /// Description of the shade in the terms of fixed function.
    pub meaning: Shade,
    /// Defines in addition to those that [`crate::surfaces`] adds for every light.
    pub defines: Vec<Define>,
    pub uniforms: Vec<Uniform>,
    pub inputs: Vec<Input>,
}

impl ShadeSource {
    /// A shade that `chunk` finds alone.
    pub fn of(chunk: Chunk, meaning: Shade) -> Self {
        Self { chunks: vec![chunk], meaning, defines: Vec::new(), uniforms: Vec::new(), inputs: Vec::new() }
    }

    /// Light everywhere.
    pub fn lit() -> Self {
        Self::of(glsl!("common/unshadowed.frag"), Shade::Lit)
    }

    /// Shadow everywhere.
    pub fn dark() -> Self {
        Self::of(glsl!("common/shadowed.frag"), Shade::Dark)
    }
}

/// Factors of a light's colours, each in [0, 1]: a light may be drawn in parts, by several passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gain {
    pub ambient: f32,
    pub diffuse: f32,
    pub specular: f32,
}

impl Gain {
    /// The whole light.
    pub const ALL: Self = Self { ambient: 1.0, diffuse: 1.0, specular: 1.0 };
}

/// Picture that a light is added to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Addition {
    /// Nothing: its pass has the scene's ambient light, too.
    None,
    /// A picture that has the scene's ambient light. Surfaces that the light does not reach are skipped.
    Light,
    /// The same, for lighting per vertex that is clamped beside all ambient light: what that light adds beside it.
    Clamped,
}

/// A light's shadow as a count in the stencil buffer [GDC, "Review: Stenciled Shadow Volumes"]: plain data, for any target
/// and eye. The plan draws the surfaces' depth first.
#[derive(Clone, Debug)]
pub struct StencilCount {
    pub passes: Vec<CountPass>,
    /// Rule for keeping the count of the frame before.
    pub redraw: Redraw,
    /// `true`: a non-zero count removes this light completely (used behind a spotlight). `false`: it removes only what a
    /// shadow takes; `dimming` stays.
    pub of_all: bool,
    /// The far plane must not cut volumes: surfaces and volumes are drawn with it at infinity.
    pub infinite: bool,
    /// Volumes are counted under the scene's own projection, without clipping at near and far planes.
    pub clamped: bool,
    /// Volumes need a part of the depth range before the surfaces' near plane.
    pub ledge: Option<LedgeDepths>,
    pub lighting: Lighting,
    /// Objects whose surfaces must not be cut, because volumes' caps meet them: indices into [`Scene::objects`].
    pub casters: Vec<usize>,
    /// The pixels that the light may reach, as [`DrawState::scissor`]; `None`: any.
    pub scissor: Option<[u32; 4]>,
    /// All sides and caps of the volumes, for a picture of them.
    pub volumes: Vec<VolumeDraw>,
    /// Their possible silhouettes, as lines.
    pub silhouettes: Vec<VolumeDraw>,
}

/// Depth range of the ledge before the near plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LedgeDepths {
    /// The fewest codes, from depth 0, that keep caps and surfaces apart.
    Fewest,
    /// Window depths: where volumes begin, where the scene begins, where both end; `n'`, `n` and `f` of [GDC, "Building a
    /// "Ledge" at the Front of the Depth Buffer"].
    Given([f64; 3]),
}

/// Passes in which the light joins the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lighting {
    /// All other light first, over the whole picture; then this light is added where the count is 0.
    Added,
    /// Two passes that replace each other's pixels [GDC, "Shadow Volume Algorithm"]: the scene with the light where the
    /// count is 0, and without it elsewhere.
    LitAndUnlit,
}

/// Volumes that are counted under one draw state. The first pass clears the stencil buffer.
#[derive(Clone, Debug)]
pub struct CountPass {
    pub label: String,
    /// Draw state; the plan sets `depth_range`.
    pub state: DrawState,
    pub depths: VolumeDepths,
    pub counted: Counted,
}

/// Geometry that a pass counts.
#[derive(Clone, Debug)]
pub enum Counted {
    Volumes(Vec<VolumeDraw>),
    /// The surfaces themselves, where the light's own shade is below one half [LEC, "Combining Shadow Mapping with other
    /// Techniques"].
    Shadowed,
}

/// Depth range that volumes are drawn into [GDC, "Building a "Ledge" at the Front of the Depth Buffer"].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeDepths {
    /// The surfaces' depth range.
    Scene,
    /// The depth range from the ledge on.
    Ledge,
    /// The ledge's very front, for caps on the near plane.
    LedgeCap,
}

/// A range of a volume's triangles, or of a silhouette's lines.
#[derive(Clone, Debug)]
pub struct VolumeDraw {
    pub label: String,
    pub mesh: MeshRef,
    pub primitive: Primitive,
    pub indices: Range<u32>,
    pub space: VolumeSpace,
    /// True if triangles that wind clockwise look outwards.
    pub reversed: bool,
}

/// The space of a volume's vertices.
#[derive(Clone, Copy, Debug)]
pub enum VolumeSpace {
    /// The caster's model space, so that caps are transformed as surfaces are.
    Model { world_from_model: DMat4 },
    /// The camera's view space, for volumes that are cut at its near plane.
    Eye,
}

impl StencilCount {
    /// Tests whether the light's own shade is tagged in the stencil buffer.
    pub fn tags(&self) -> bool {
        self.passes.iter().any(|pass| matches!(pass.counted, Counted::Shadowed))
    }

    /// Batches that draw `draws`, coloured by `fragment`.
    pub fn batches(
        draws: &[VolumeDraw],
        viewer: &Viewer,
        cull: Option<Face>,
        fragment: Chunk,
        meaning: FixedFunctionDesc,
        uniforms: Vec<Uniform>,
    ) -> Vec<Batch> {
        if draws.is_empty() {
            return Vec::new();
        }
        let program = Program {
            label: String::from("volume"),
            defines: Vec::new(),
            vertex: vec![glsl!("common/position.vert"), glsl!("common/depth.vert")],
            fragment: vec![fragment],
            attributes: vec![Attribute::Position],
        };
        let draws = draws.iter().map(|draw| draw.under(viewer)).collect();
        vec![Batch { program, meaning, uniforms, inputs: Vec::new(), cull, scissor: None, clip_planes: 0, draws }]
    }
}

impl VolumeDraw {
    fn under(&self, viewer: &Viewer) -> Draw {
        let clip_from_model = match self.space {
            VolumeSpace::Model { world_from_model } => viewer.clip_from_world() * world_from_model,
            VolumeSpace::Eye => viewer.clip_from_eye,
        };
        Draw {
            label: self.label.clone(),
            mesh: self.mesh.clone(),
            primitive: self.primitive,
            indices: self.indices.clone(),
            order: IndexOrder::File,
            // Volumes have no bounds; the technique has chosen those that can be seen.
            bounds: Aabb::EVERYTHING,
            clip_from_model,
            eye_from_model: None,
            mirrored: drawable::mirrors(&clip_from_model) != self.reversed,
            uniforms: Vec::new(),
        }
    }
}

impl LightTerm {
    /// Light `index` of a scene, `source`, which nothing shadows.
    pub fn unshadowed(source: &Light, index: usize) -> Self {
        Self::new(source, index, ShadeSource::lit())
    }

    /// A copy of this term with the given shade and without a stencil count.
    pub fn under(&self, shade: ShadeSource) -> Self {
        let coordinates = self.coordinates.clone().filter(|_| self.source.spot().is_some());
        Self { shade, coordinates, counting: None, ..self.clone() }
    }

    /// Light `index` of a scene, `source`, with a shade, and with the coordinates that the light's own reach needs: those of
    /// a spotlight's frustum.
    pub fn new(source: &Light, index: usize, shade: ShadeSource) -> Self {
        Self {
            index,
            source: Arc::new(source.clone()),
            shade,
            coordinates: source.frustum().map(Coordinates::of_frustum),
            dimming: 0.0,
            frustum_from_map: None,
            gain: Gain::ALL,
            diffuse_weight: 1.0,
            addition: Addition::None,
            guard: Guard::Auto,
            map: None,
            map_info: None,
            counting: None,
        }
    }
}
