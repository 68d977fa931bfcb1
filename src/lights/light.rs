//! A light as techniques see it, and what they give the lit pass for it.

use std::ops::{Deref, Range};

use glam::{DMat4, Vec4};

use super::camera_visibility::CameraView;
use super::coordinates::Coordinates;
use super::guard::Guard;
use super::map::MapInfo;
use super::projector::Projector;
use super::{Drawable, Viewer, drawable};
use crate::math::Aabb;
use crate::pass::{
    Attribute, Batch, Chunk, Draw, DrawState, Face, FixedFunctionDesc, ImageId, IndexOrder, Input, MeshRef, Primitive,
    Program, Redraw, Shade, Uniform, glsl,
};
use crate::scene::{Light, Scene};

/// What a technique may know when it describes its passes for a light.
#[derive(Clone, Copy, Debug)]
pub struct LightView<'a> {
    pub scene: &'a Scene,
    pub items: &'a [Drawable],
    pub camera: &'a CameraView<'a>,
    /// Into [`Scene::lights`].
    pub index: usize,
    /// Whether a view shows what the light's passes draw: then they draw all of it, not only what the picture needs.
    pub shown_whole: bool,
    /// Whether even what no picture can show is drawn, to prove that it changes none.
    pub keep_all: bool,
    /// Whether warnings are worth some milliseconds.
    pub sampled_warnings: bool,
}

impl<'a> LightView<'a> {
    pub fn light(&self) -> &'a Light {
        &self.scene.lights[self.index]
    }
}

/// A light as one map sees it: from a spotlight's own frustum, or from what a technique made.
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

/// How the lit pass asks for a light's shade.
#[derive(Clone, Debug)]
pub struct LightTerm {
    /// Into [`Scene::lights`].
    pub index: usize,
    /// Defines `float shade_@()`.
    pub shade: Chunk,
    /// What that computes, in the terms of fixed function.
    pub meaning: Shade,
    /// Beside what [`crate::surfaces`] adds for every light; names end in the light's index, a value may follow.
    pub defines: Vec<String>,
    pub uniforms: Vec<Uniform>,
    pub inputs: Vec<Input>,
    /// How `light_coord_@` is generated; `None`: the shade needs none, and nor does the light's reach.
    pub coordinates: Option<Coordinates>,
    /// The fraction of diffuse light that a full shadow leaves, in [0, 1].
    pub dimming: f32,
    /// Scale and offset from the map's (s/q, t/q) to the frustum's [0, 1] square, where they are not the same.
    pub frustum_from_map: Option<Vec4>,
    /// Whether its light is added to a picture that has its ambient part: what it does not reach is then not drawn.
    pub added: bool,
    /// What keeps a spotlight's light from what lies behind it.
    pub guard: Guard,
    /// The depth texture, for views of it.
    pub map: Option<ImageId>,
    /// The same in numbers, for bounds of the picture's error.
    pub map_info: Option<MapInfo>,
    /// Passes after which the stencil buffer is 0 where the light reaches; where they tag surfaces by `shade`, it is not
    /// asked again.
    pub counting: Option<Counting>,
}

/// A light's shadow as a count in the stencil buffer [GDC 2001; techniques C3–C9]: plain data, put into whichever target
/// and before whichever eye needs the count. What the stencil counts in is drawn first, by the plan.
#[derive(Clone, Debug)]
pub struct Counting {
    pub passes: Vec<CountPass>,
    /// Whether a frame may keep the count of the one before.
    pub redraw: Redraw,
    /// Whether the count says where any of the light is, what a shadow would leave of it too, and not what a shadow takes.
    pub of_all: bool,
    /// The far plane must not cut volumes: surfaces and volumes are drawn with it at infinity.
    pub infinite: bool,
    /// Volumes are counted under the scene's own projection, without clipping at near and far planes.
    pub clamped: bool,
    /// Volumes need depth before the near plane, which surfaces leave to them.
    pub ledge: Option<LedgeDepths>,
    pub lighting: Lighting,
    /// Objects whose surfaces must stay as they are, since volumes' caps meet them: into [`Scene::objects`].
    pub casters: Vec<usize>,
    /// The pixels that the light may reach, as [`DrawState::scissor`]; `None`: any.
    pub scissor: Option<[u32; 4]>,
    /// What a picture of the volumes shows: all of their sides and caps.
    pub volumes: Vec<VolumeDraw>,
    /// Their possible silhouettes, as lines (C1).
    pub silhouettes: Vec<VolumeDraw>,
}

/// Depths that the ledge before the near plane takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LedgeDepths {
    /// From 0 on, and as few as keep caps and surfaces apart.
    Fewest,
    /// Window depths: where volumes begin, where the scene begins, where both end; `n'`, `n` and `f` of the talk.
    Given([f64; 3]),
}

/// Passes in which the light joins the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lighting {
    /// All other light first, over the whole picture; then this light is added where the count is 0.
    Added,
    /// The talk's two passes, each of which replaces what is there: the scene with the light where the count is 0, and the
    /// scene without it where it is not.
    LitAndUnlit,
}

/// What is counted under one draw state. The first pass clears the stencil buffer.
#[derive(Clone, Debug)]
pub struct CountPass {
    pub label: String,
    /// `depth_range` is the plan's to set.
    pub state: DrawState,
    pub layer: Layer,
    pub counted: Counted,
}

/// What a pass counts.
#[derive(Clone, Debug)]
pub enum Counted {
    Volumes(Vec<VolumeDraw>),
    /// The surfaces themselves, where the light's own shade is below one half (A20).
    Shadowed,
}

/// Which depth range volumes are drawn into [techniques C8].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// The surfaces' own.
    Scene,
    /// From before the surfaces' near plane on.
    Ledge,
    /// At the ledge's very front, whatever their depth: caps on the near plane.
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
    /// Triangles look outwards where they wind clockwise.
    pub reversed: bool,
}

/// The space of a volume's vertices.
#[derive(Clone, Copy, Debug)]
pub enum VolumeSpace {
    /// Its caster's own, so that caps are transformed as surfaces are.
    Model { world_from_model: DMat4 },
    /// The camera's, for volumes that are cut at its near plane.
    Eye,
}

impl Counting {
    /// Whether what the light's own shade says is in the stencil buffer.
    pub fn tags(&self) -> bool {
        self.passes.iter().any(|pass| matches!(pass.counted, Counted::Shadowed))
    }

    /// The batches that draw `draws`, which `fragment` colours.
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
            // Volumes have no end; the technique knows which of them can be seen.
            bounds: Aabb::EVERYTHING,
            clip_from_model,
            mirrored: drawable::mirrors(&clip_from_model) != self.reversed,
            uniforms: Vec::new(),
        }
    }
}

impl LightTerm {
    /// Light `index` of `scene`, which nothing shadows.
    pub fn unshadowed(scene: &Scene, index: usize) -> Self {
        Self { meaning: Shade::Lit, ..Self::new(scene, index, glsl!("common/unshadowed.frag")) }
    }

    /// The same light under a shade that asks nothing, and that is no longer counted.
    pub fn under(&self, scene: &Scene, shade: Chunk, meaning: Shade) -> Self {
        let bounded = scene.lights.get(self.index).is_some_and(|source| source.spot().is_some());
        Self {
            shade,
            meaning,
            defines: Vec::new(),
            uniforms: Vec::new(),
            inputs: Vec::new(),
            coordinates: self.coordinates.clone().filter(|_| bounded),
            counting: None,
            ..self.clone()
        }
    }

    /// Light `index` of `scene`, whose shade `shade` finds; with the coordinates that the light's own reach needs: those
    /// of a spotlight's frustum. Where texture units find the shade too, its technique sets [`LightTerm::meaning`].
    pub fn new(scene: &Scene, index: usize, shade: Chunk) -> Self {
        Self {
            index,
            shade,
            meaning: Shade::Shader("a shade that its technique has a shader for"),
            defines: Vec::new(),
            uniforms: Vec::new(),
            inputs: Vec::new(),
            coordinates: scene.lights.get(index).and_then(Light::frustum).map(Coordinates::of_frustum),
            dimming: 0.0,
            frustum_from_map: None,
            added: false,
            guard: Guard::Auto,
            map: None,
            map_info: None,
            counting: None,
        }
    }
}
