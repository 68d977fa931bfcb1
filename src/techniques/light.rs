//! A light as techniques see it, and what they give the lit pass for it.

use glam::{DMat4, Vec4};

use super::Item;
use crate::math::texgen::{SetUp, Spaces, Split, scale_bias};
use crate::pass::{Chunk, ImageId, Input, Uniform};
use crate::scene::{Frustum, Light, Scene};

/// What a technique may know when it describes its passes for a light.
#[derive(Clone, Copy, Debug)]
pub struct LightView<'a> {
    pub scene: &'a Scene,
    pub items: &'a [Item],
    /// Into [`Scene::lights`].
    pub index: usize,
    /// Whether a view shows what the light's passes draw: then they draw all of it, not only what the picture needs.
    pub shown_whole: bool,
    /// Whether even what no picture can show is drawn, to prove that it changes none.
    pub keep_all: bool,
}

impl LightView<'_> {
    pub fn light(&self) -> &Light {
        &self.scene.lights[self.index]
    }
}

/// Eye-linear texture coordinates: the matrices that they are made of, and where the planes stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinates {
    /// `S`: texture space from the light's clip space.
    pub texture_from_light_clip: DMat4,
    /// `P_light`, of whatever the technique draws from the light.
    pub light_clip_from_light: DMat4,
    /// `L⁻¹`.
    pub light_from_world: DMat4,
    pub set_up: SetUp,
    pub split: Split,
}

impl Coordinates {
    /// The documents' ordinary ones: (s/q, t/q, r/q) in [0, 1] inside the frustum.
    pub fn of_frustum(frustum: &Frustum) -> Self {
        Self {
            texture_from_light_clip: scale_bias(0.5, 0.5),
            light_clip_from_light: frustum.clip_from_view(),
            light_from_world: frustum.view_from_world(),
            set_up: SetUp::World,
            split: Split::Planes,
        }
    }

    /// What texgen makes them from, for an eye.
    pub fn spaces(&self, eye_from_world: DMat4) -> Spaces {
        Spaces {
            texture_from_light_clip: self.texture_from_light_clip,
            light_clip_from_light: self.light_clip_from_light,
            light_from_world: self.light_from_world,
            eye_from_world,
        }
    }
}

/// How the lit pass asks for a light's shade.
#[derive(Clone, Debug)]
pub struct LightTerm {
    /// Into [`Scene::lights`].
    pub index: usize,
    /// Defines `float shade_@()`.
    pub shade: Chunk,
    /// Beside what [`super::surface`] adds for every light; names end in the light's index.
    pub defines: Vec<String>,
    pub uniforms: Vec<Uniform>,
    pub inputs: Vec<Input>,
    /// How `light_coord_@` is generated; `None`: the shade needs none, and nor does the light's reach.
    pub coordinates: Option<Coordinates>,
    /// The fraction of diffuse light that a full shadow leaves, in [0, 1].
    pub dimming: f32,
    /// Scale and offset from the map's (s/q, t/q) to the frustum's [0, 1] square, where they are not the same.
    pub frustum_from_map: Option<Vec4>,
    /// The depth texture, for views of it.
    pub map: Option<ImageId>,
}

impl LightTerm {
    /// Light `index` of `scene`, whose shade `shade` finds; with the coordinates that the light's own reach needs: those
    /// of a spotlight's frustum.
    pub fn new(scene: &Scene, index: usize, shade: Chunk) -> Self {
        Self {
            index,
            shade,
            defines: Vec::new(),
            uniforms: Vec::new(),
            inputs: Vec::new(),
            coordinates: scene.lights.get(index).and_then(Light::frustum).map(Coordinates::of_frustum),
            dimming: 0.0,
            frustum_from_map: None,
            map: None,
        }
    }
}
