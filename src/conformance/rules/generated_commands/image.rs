//! Images of the model: pixels of levels and layers.

use super::pixel::KnownPixel;
use crate::conformance::bench::{GlCompare, GlFormat, GlMipmap, GlShape, GlSwizzle, GlWrap, level_size};

/// Sampling state of a texture or of a sampler object; at the start as GL has it [GL 4.6, table 23.18].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampler {
    pub linear: [bool; 2],
    pub mipmap: GlMipmap,
    pub wrap: [GlWrap; 2],
    pub border: [f32; 4],
    pub compare: Option<GlCompare>,
    pub lod: [f32; 2],
}

impl Sampler {
    pub const START: Self = Self {
        linear: [false, true],
        mipmap: GlMipmap::Linear,
        wrap: [GlWrap::Repeat; 2],
        border: [0.0; 4],
        compare: None,
        lod: [-1000.0, 1000.0],
    };
}

/// A texture or a renderbuffer.
#[derive(Clone, Debug)]
pub struct Image {
    pub shape: GlShape,
    pub format: GlFormat,
    pub size: [u32; 2],
    pub layers: u32,
    pub levels: u32,
    pub samples: u32,
    pub planes: Vec<Vec<KnownPixel>>,
    pub sampler: Sampler,
    /// TEXTURE_BASE_LEVEL and TEXTURE_MAX_LEVEL.
    pub range: [u32; 2],
    pub swizzle: [GlSwizzle; 4],
}

impl Image {
    pub fn new(shape: GlShape, format: GlFormat, size: [u32; 2], layers: u32, levels: u32, samples: u32) -> Self {
        let plane = |level: u32| {
            let [width, height] = level_size(size, level);
            vec![KnownPixel::UNKNOWN; (width * height) as usize]
        };
        Self {
            shape,
            format,
            size,
            layers,
            levels,
            samples,
            planes: (0..levels).flat_map(|level| (0..layers).map(move |_| level)).map(plane).collect(),
            sampler: Sampler::START,
            range: [0, levels - 1],
            swizzle: GlSwizzle::SAME,
        }
    }

    pub fn size_of(&self, level: u32) -> [u32; 2] {
        level_size(self.size, level)
    }

    pub fn plane(&self, level: u32, layer: u32) -> &[KnownPixel] {
        &self.planes[(level * self.layers + layer) as usize]
    }

    pub fn plane_mut(&mut self, level: u32, layer: u32) -> &mut [KnownPixel] {
        &mut self.planes[(level * self.layers + layer) as usize]
    }

    pub fn at(&self, level: u32, layer: u32, [x, y]: [u32; 2]) -> KnownPixel {
        self.plane(level, layer)[(y * self.size_of(level)[0] + x) as usize]
    }
}
