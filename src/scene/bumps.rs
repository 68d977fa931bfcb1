//! How bump-mapped surfaces are lit: programs, passes, accuracy. Plain values; `resolve/bump.rs` reads them.

use std::sync::Arc;

use crate::combiners::{CombinerProgram, Precision};

/// How bump-mapped surfaces are lit [GDC, "Per-Pixel Lighting Math"].
#[derive(Clone, Debug, PartialEq)]
pub struct BumpShading {
    /// Programs and passes.
    pub method: BumpMethod,
    /// True if light and highlights end where the light, or the half-angle vector, sinks below the smooth surface: factors
    /// min(1, 8 L_z) and min(1, 8 H_z).
    pub self_shadow: bool,
    /// Normalisation of the interpolated vectors; the reference always computes it.
    pub normalize: Normalize,
    /// Accuracy of the register combiners.
    pub precision: Precision,
    /// True if the program of one pass is a file's, in place of the talk's.
    pub has_own_program: bool,
}

impl Default for BumpShading {
    fn default() -> Self {
        Self {
            method: BumpMethod::Reference,
            self_shadow: true,
            normalize: Normalize::default(),
            precision: Precision::Float,
            has_own_program: false,
        }
    }
}

/// Programs and passes that light bumps.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum BumpMethod {
    /// Vectors per fragment, computed and normalised in floats; any number of lights in a pass.
    #[default]
    Reference,
    /// Register combiners in one pass for each light [GDC, "Same Math in a Single Pass on GeForce3"].
    OnePass(Arc<CombinerProgram>),
    /// Register combiners in passes of their own for diffuse light, decal and highlights [GDC, "Three Passes"].
    ThreePass {
        /// Program of the first pass.
        diffuse: Arc<CombinerProgram>,
        /// Program of the third.
        specular: Arc<CombinerProgram>,
    },
}

impl BumpShading {
    /// Tests whether specular light has the exponent 8, by three squarings.
    pub fn squares_eighth(&self) -> bool {
        self.method != BumpMethod::Reference && !self.has_own_program
    }
}

impl BumpMethod {
    /// The value of `bump` in a scene file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::OnePass(_) => "one-pass",
            Self::ThreePass { .. } => "three-pass",
        }
    }
}

/// Normalisation of interpolated vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Normalize {
    /// Computed in floats.
    Exact,
    /// Looked up in a cube map of `size` texels a side.
    Cube {
        /// Texels a side, a power of two in 1..=1024.
        size: u32,
        /// True if texels of neighbouring faces are averaged at the cube's edges (GL_TEXTURE_CUBE_MAP_SEAMLESS).
        seamless: bool,
    },
}

impl Default for Normalize {
    fn default() -> Self {
        Self::Cube { size: 64, seamless: true }
    }
}
