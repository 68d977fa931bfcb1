//! A light as techniques see it, and what they give the lit pass for it.

use glam::{DMat4, Vec4};

use super::Item;
use crate::math::texgen::{SetUp, Split, scale_bias};
use crate::pass::{Chunk, ImageId, Input, Uniform};
use crate::scene::{Light, Scene};

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

    /// `P_light · L⁻¹`.
    pub fn clip_from_world(&self) -> DMat4 {
        self.light().clip_from_view() * self.light().view_from_world()
    }
}

/// How the lit pass asks for a light's shade, and how its texture coordinates are made.
#[derive(Clone, Debug)]
pub struct LightTerm {
    /// Into [`Scene::lights`].
    pub index: usize,
    /// Defines `float shade_@()`.
    pub shade: Chunk,
    /// Beside what [`super::surface`] adds for every light; names end in the light's index, a value may follow.
    pub defines: Vec<String>,
    pub uniforms: Vec<Uniform>,
    pub inputs: Vec<Input>,
    /// `S`: texture space from the light's clip space.
    pub texture_from_light_clip: DMat4,
    pub set_up: SetUp,
    pub split: Split,
    /// The fraction of diffuse light that a full shadow leaves, in [0, 1].
    pub dimming: f32,
    /// Scale and offset from the map's (s/q, t/q) to the frustum's [0, 1] square, where they are not the same.
    pub frustum_from_map: Option<Vec4>,
    /// The depth texture, for views of it.
    pub map: Option<ImageId>,
}

impl LightTerm {
    /// A light whose shade `shade` finds, with the documents' ordinary texture coordinates.
    pub fn new(index: usize, shade: Chunk) -> Self {
        Self {
            index,
            shade,
            defines: Vec::new(),
            uniforms: Vec::new(),
            inputs: Vec::new(),
            texture_from_light_clip: scale_bias(0.5, 0.5),
            set_up: SetUp::World,
            split: Split::Planes,
            dimming: 0.0,
            frustum_from_map: None,
            map: None,
        }
    }
}
