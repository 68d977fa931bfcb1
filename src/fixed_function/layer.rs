//! One drawing of a batch by the fixed-function pipeline, as plain values: what the primary colour is, which texture units
//! are on and what they combine, and how the result is blended into the framebuffer. Knows no GL.

use glam::DMat4;

use crate::geometry::{ObjectLinear, Placement};
use crate::pass::{Compare, DrawState};

/// One drawing of all the draws of a batch.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name for errors: `ambient`, `light 0`.
    pub name: String,
    pub primary: Primary,
    /// Units in the order of the texture units.
    pub units: Vec<Unit>,
    /// GL_ALPHA_TEST with its reference value.
    pub alpha_test: Option<(Compare, f32)>,
    pub blend: LayerBlend,
    /// True if it decides visibility by the pass's own depth test; `false`: depth EQUAL to what an earlier layer left.
    pub first: bool,
    pub alpha_write: bool,
}

impl Layer {
    /// State of a pass as layer `number` of a batch, from 0, changes it. A stencil test that draws each pixel once lets
    /// each layer pass where the layer before it did.
    pub fn state(&self, number: usize, pass: &DrawState) -> DrawState {
        let mut state = *pass;
        if !self.first {
            state.depth_test = state.depth_test.map(|_| Compare::Equal);
            state.depth_write = false;
        }
        if let Some(stencil) = &mut state.stencil {
            stencil.reference = number as u8;
        }
        if self.blend != LayerBlend::Replace {
            state.blend = None; // its own, which the state has no word for
        }
        state
    }
}

/// Blending of a fragment with the stored colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerBlend {
    Replace,
    /// ONE, ONE.
    Add,
    /// ZERO, ZERO: what passes the tests becomes 0.
    Erase,
    /// DST_ALPHA, ONE.
    AddByStoredAlpha,
    /// DST_COLOR, ZERO.
    Multiply,
    /// DST_COLOR, ZERO for RGB; ONE, ZERO for alpha.
    MultiplyAndStoreAlpha,
}

/// The colour before texturing.
#[derive(Clone, Debug, PartialEq)]
pub enum Primary {
    /// glColor.
    Color([f32; 4]),
    /// GL_LIGHTING, per vertex and clamped to [0, 1].
    Lighting(LayerLighting),
}

/// glMaterial and glLight.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerLighting {
    pub emission: [f32; 3],
    pub ambient: [f32; 3],
    pub diffuse: [f32; 3],
    pub specular: [f32; 3],
    /// Exponent in [0, 128].
    pub shininess: f32,
    pub opacity: f32,
    pub sources: Vec<PointLight>,
}

/// A point light.
#[derive(Clone, Debug, PartialEq)]
pub struct PointLight {
    /// Position in eye space.
    pub position: [f32; 4],
    pub ambient: [f32; 3],
    pub diffuse: [f32; 3],
    pub specular: [f32; 3],
    pub attenuation: [f32; 3],
}

/// One texture unit: its image, the coordinates, and the two combiners.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    pub image: UnitImage,
    pub coordinates: UnitCoordinates,
    /// Texture matrix for coordinates of the surface's own textures.
    pub placement: Placement,
    pub rgb: Combine,
    pub alpha: Combine,
    /// 1, 2 or 4; what it makes of RGB is clamped to [0, 1].
    pub rgb_scale: f32,
    /// 1, 2 or 4; what it makes of alpha is clamped to [0, 1].
    pub alpha_scale: f32,
    pub constant: [f32; 4],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitImage {
    /// A texture of the batch's inputs.
    Input {
        index: usize,
        alpha: AlphaSource,
    },
    /// A cube map of the batch's inputs, by its index.
    Cube(usize),
    Mask(Mask),
}

/// Value that a unit reads as its texture's alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlphaSource {
    /// Its own; 1 of a depth texture.
    Own,
    /// Its red channel (GL_TEXTURE_SWIZZLE_A).
    Red,
    /// The comparison's result (GL_DEPTH_TEXTURE_MODE GL_INTENSITY).
    Comparison,
}

/// Small textures of our own, which say where a light reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mask {
    /// 1 everywhere.
    White,
    /// 1 inside [0, 1] x [0, 1], 0 outside.
    Square,
    /// 0 for s < 0.5, 1 from there on [LEC, "Careful about Back Projecting Shadow Maps"].
    Step,
    /// (s', t', 0.5, 1) with s' and t' from 0 to 1 as s and t go from 0.25 to 0.75, in 32-bit float.
    Ramp,
}

/// Source of a unit's (s, t, r, q).
#[derive(Clone, Debug, PartialEq)]
pub enum UnitCoordinates {
    /// Nothing that varies.
    Constant,
    /// glTexCoordPointer.
    Mesh,
    /// glTexGen GL_OBJECT_LINEAR for s and t; the texture matrix scales both.
    ObjectLinear(ObjectLinear),
    /// glTexGen GL_EYE_LINEAR for all four.
    EyeLinear(Box<EyeLinear>),
    /// A vector in the surface's tangent space, found for each vertex: s, t and r.
    Tangent(TangentVector),
}

/// The vector to a light, or the half-angle vector between it and the way to the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentVector {
    /// The light's position in eye space, homogeneous.
    pub light: [f32; 4],
    /// True for the half-angle vector.
    pub half: bool,
}

/// Planes, the modelview under which they are set, and the texture matrix behind them.
#[derive(Clone, Debug, PartialEq)]
pub struct EyeLinear {
    /// Rows: s, t, r, q.
    pub planes: DMat4,
    pub modelview: DMat4,
    pub texture_matrix: DMat4,
}

/// Argument of a combiner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    Texture,
    Constant,
    /// The constant's alpha, also for RGB.
    ConstantAlpha,
    Primary,
    /// The unit before; the primary colour for the first.
    Previous,
    /// The alpha of the unit before, also for RGB.
    PreviousAlpha,
    /// The texture of the unit of this number.
    Other(u32),
    /// The alpha of that texture, also for RGB.
    OtherAlpha(u32),
}

/// GL_COMBINE's functions [GL 4.6 compatibility, table 16.20].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Combine {
    Replace(Operand),
    Modulate(Operand, Operand),
    Subtract(Operand, Operand),
    /// The first by the third, the second by 1 less the third.
    Interpolate(Operand, Operand, Operand),
    /// Four times the dot product of both less 0.5, into RGB and alpha.
    Dot3Rgba(Operand, Operand),
    /// The same into RGB alone.
    Dot3Rgb(Operand, Operand),
}

impl Operand {
    /// Tests whether it is an alpha for RGB too.
    pub fn is_alpha(self) -> bool {
        matches!(self, Self::ConstantAlpha | Self::PreviousAlpha | Self::OtherAlpha(_))
    }
}
