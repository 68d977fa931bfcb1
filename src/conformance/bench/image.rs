//! The bench's textures: their formats, how a depth format is encoded on this driver, uploads, sampling.

use std::rc::Rc;

use glow::HasContext;

use super::state::GlCompare;
use super::{Bench, Error};
use crate::context::DEPTH_COMPONENT32;

/// GL_CLAMP, which only a compatibility context knows.
const CLAMP: u32 = 0x2900;

/// Internal formats: sized ones, and the unsized one of depth textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GlFormat {
    /// Unsized: the driver chooses the bits [GL 4.6, 8.5.1].
    Depth,
    Depth16,
    Depth24,
    Depth32,
    Depth32F,
    Depth24Stencil8,
    Depth32FStencil8,
    Rgba8,
    Srgb8Alpha8,
    Rgba32F,
}

impl GlFormat {
    /// The sized depth formats.
    pub const DEPTHS: [Self; 6] =
        [Self::Depth16, Self::Depth24, Self::Depth32, Self::Depth32F, Self::Depth24Stencil8, Self::Depth32FStencil8];

    /// GL's name, without GL_.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "DEPTH_COMPONENT",
            Self::Depth16 => "DEPTH_COMPONENT16",
            Self::Depth24 => "DEPTH_COMPONENT24",
            Self::Depth32 => "DEPTH_COMPONENT32",
            Self::Depth32F => "DEPTH_COMPONENT32F",
            Self::Depth24Stencil8 => "DEPTH24_STENCIL8",
            Self::Depth32FStencil8 => "DEPTH32F_STENCIL8",
            Self::Rgba8 => "RGBA8",
            Self::Srgb8Alpha8 => "SRGB8_ALPHA8",
            Self::Rgba32F => "RGBA32F",
        }
    }

    pub fn is_depth(self) -> bool {
        self == Self::Depth || Self::DEPTHS.contains(&self)
    }

    pub fn has_stencil(self) -> bool {
        matches!(self, Self::Depth24Stencil8 | Self::Depth32FStencil8)
    }

    /// The internal format, and format and type of an upload.
    pub(super) fn codes(self) -> (u32, u32, u32) {
        match self {
            Self::Depth => (glow::DEPTH_COMPONENT, glow::DEPTH_COMPONENT, glow::FLOAT),
            Self::Depth16 => (glow::DEPTH_COMPONENT16, glow::DEPTH_COMPONENT, glow::FLOAT),
            Self::Depth24 => (glow::DEPTH_COMPONENT24, glow::DEPTH_COMPONENT, glow::FLOAT),
            Self::Depth32 => (DEPTH_COMPONENT32, glow::DEPTH_COMPONENT, glow::FLOAT),
            Self::Depth32F => (glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT, glow::FLOAT),
            Self::Depth24Stencil8 => (glow::DEPTH24_STENCIL8, glow::DEPTH_STENCIL, glow::UNSIGNED_INT_24_8),
            Self::Depth32FStencil8 => {
                (glow::DEPTH32F_STENCIL8, glow::DEPTH_STENCIL, glow::FLOAT_32_UNSIGNED_INT_24_8_REV)
            }
            Self::Rgba8 => (glow::RGBA8, glow::RGBA, glow::UNSIGNED_BYTE),
            Self::Srgb8Alpha8 => (glow::SRGB8_ALPHA8, glow::RGBA, glow::UNSIGNED_BYTE),
            Self::Rgba32F => (glow::RGBA32F, glow::RGBA, glow::FLOAT),
        }
    }
}

/// The driver's choice for a depth format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encoding {
    /// True bits of depth, which may differ from those requested.
    pub bits: u32,
    pub stencil_bits: u32,
    pub float: bool,
}

impl Encoding {
    /// The largest code of a fixed-point format; for a float, of as many codes as it has significant bits.
    pub fn most(self) -> f64 {
        if self.float { f64::from(1u32 << 24) } else { f64::from(self.bits).exp2() - 1.0 }
    }

    /// The least difference of stored depths: of a fixed-point format, or of a float's at `depth` in (0, 1).
    pub fn step(self, depth: f64) -> f64 {
        if self.float { (depth.log2().floor() - 23.0).exp2() } else { 1.0 / self.most() }
    }
}

/// A texture, deleted on drop.
pub struct GlImage {
    gl: Rc<glow::Context>,
    pub(crate) name: glow::Texture,
    /// GL_TEXTURE_2D or GL_TEXTURE_CUBE_MAP.
    pub(crate) target: u32,
    pub format: GlFormat,
    /// Width and height in texels, of a face.
    pub size: [u32; 2],
    pub levels: u32,
    /// Encoding of a depth format.
    pub encoding: Encoding,
}

impl Drop for GlImage {
    fn drop(&mut self) {
        // SAFETY: the texture is the image's own and is not used again.
        unsafe { self.gl.delete_texture(self.name) };
    }
}

/// Wrap mode for coordinates outside [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlWrap {
    Repeat,
    MirroredRepeat,
    ClampToEdge,
    ClampToBorder,
    /// GL_CLAMP: halfway to the border, of a compatibility context.
    Clamp,
}

/// The complete sampling state of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    pub linear: bool,
    /// Blends levels.
    pub mipmap: bool,
    pub wrap: GlWrap,
    pub border: [f32; 4],
    pub compare: Option<GlCompare>,
    /// GL_TEXTURE_CUBE_MAP_SEAMLESS, of the whole context; set where a cube map is bound.
    pub seamless: bool,
}

impl Sampling {
    pub const NEAREST: Self = Self {
        linear: false,
        mipmap: false,
        wrap: GlWrap::ClampToEdge,
        border: [0.0; 4],
        compare: None,
        seamless: false,
    };

    /// The linear filter.
    pub const LINEAR: Self = Self { linear: true, ..Self::NEAREST };

    /// Compares the nearest texel.
    pub const fn compare(compare: GlCompare) -> Self {
        Self { compare: Some(compare), ..Self::NEAREST }
    }

    /// Compares four texels.
    pub const fn compare_linear(compare: GlCompare) -> Self {
        Self { linear: true, ..Self::compare(compare) }
    }
}

impl Bench {
    /// An image without content.
    ///
    /// # Errors
    ///
    /// [`Error::Refused`], with GL's reason.
    pub fn image(&self, format: GlFormat, size: [u32; 2]) -> Result<GlImage, Error> {
        self.define(glow::TEXTURE_2D, format, size, &[None])
    }

    /// A depth image with these depths, a level each: level 0 is of `size`, each next one half as large.
    ///
    /// # Errors
    ///
    /// As [`image`](Self::image).
    pub fn depth_image(&self, format: GlFormat, size: [u32; 2], levels: &[&[f32]]) -> Result<GlImage, Error> {
        let bytes: Vec<_> = levels.iter().map(|level| Some(bytemuck::cast_slice(level))).collect();
        self.define(glow::TEXTURE_2D, format, size, &bytes)
    }

    /// An RGBA32F image with these texels, rows from below.
    ///
    /// # Errors
    ///
    /// As [`image`](Self::image).
    pub fn float_image(&self, size: [u32; 2], texels: &[[f32; 4]]) -> Result<GlImage, Error> {
        self.define(glow::TEXTURE_2D, GlFormat::Rgba32F, size, &[Some(bytemuck::cast_slice(texels))])
    }

    /// An RGBA8 image with these texels, rows from below.
    ///
    /// # Errors
    ///
    /// As [`image`](Self::image).
    pub fn byte_image(&self, size: [u32; 2], texels: &[[u8; 4]]) -> Result<GlImage, Error> {
        self.define(glow::TEXTURE_2D, GlFormat::Rgba8, size, &[Some(texels.as_flattened())])
    }

    /// An RGBA8 cube map of `side` texels: +x, -x, +y, -y, +z, -z, rows from t = 0.
    ///
    /// # Errors
    ///
    /// As [`image`](Self::image).
    pub fn cube_image(&self, side: u32, faces: &[Vec<[u8; 4]>; 6]) -> Result<GlImage, Error> {
        let faces = self.mutation.map_or_else(|| faces.clone(), |mutation| mutation.faces(side, faces.clone()));
        let bytes = faces.each_ref().map(|face| Some(face.as_flattened()));
        self.define(glow::TEXTURE_CUBE_MAP, GlFormat::Rgba8, [side; 2], &bytes)
    }

    /// Levels of a two-dimensional image, or faces of a cube map.
    fn define(&self, target: u32, format: GlFormat, size: [u32; 2], parts: &[Option<&[u8]>]) -> Result<GlImage, Error> {
        let gl = &self.gl;
        self.take_errors();
        let (internal, layout, kind) = format.codes();
        let is_cube = target == glow::TEXTURE_CUBE_MAP;
        let levels = if is_cube { 1 } else { parts.len() as u32 };
        // SAFETY: the context is current; where pixels are given there are as many as the level has.
        let name = unsafe {
            let name = gl.create_texture().map_err(super::no("texture"))?;
            gl.active_texture(glow::TEXTURE0);
            gl.bind_texture(target, Some(name));
            gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
            for (part, bytes) in (0..).zip(parts) {
                let (at, level) = if is_cube { (glow::TEXTURE_CUBE_MAP_POSITIVE_X + part, 0) } else { (target, part) };
                let [width, height] = size.map(|side| (side >> level).max(1) as i32);
                let pixels = glow::PixelUnpackData::Slice(*bytes);
                gl.tex_image_2d(at, level as i32, internal as i32, width, height, 0, layout, kind, pixels);
            }
            gl.tex_parameter_i32(target, glow::TEXTURE_MAX_LEVEL, levels as i32 - 1);
            name
        };
        let encoding = self.encoding(format);
        let image = GlImage { gl: gl.clone(), name, target, format, size, levels, encoding };
        match self.take_errors() {
            None => Ok(image),
            Some(reason) => Err(Error::Refused { format: format.name(), reason }),
        }
    }

    /// Reads the encoding of the bound texture.
    fn encoding(&self, format: GlFormat) -> Encoding {
        if !format.is_depth() {
            return Encoding { bits: 0, stencil_bits: 0, float: false };
        }
        // SAFETY: level 0 exists.
        let level = |name| unsafe { self.gl.get_tex_level_parameter_i32(glow::TEXTURE_2D, 0, name) };
        Encoding {
            bits: level(glow::TEXTURE_DEPTH_SIZE).max(0) as u32,
            stencil_bits: if format.has_stencil() { level(glow::TEXTURE_STENCIL_SIZE).max(0) as u32 } else { 0 },
            float: level(glow::TEXTURE_DEPTH_TYPE) == glow::FLOAT as i32,
        }
    }

    /// Binds to a unit and sets the whole sampling state.
    pub(crate) fn bind_image(&self, unit: u32, image: &GlImage, sampling: Sampling) {
        let sampling = self.mutation.map_or(sampling, |mutation| mutation.sampling(sampling));
        let filter = |linear| if linear { glow::LINEAR } else { glow::NEAREST };
        let min = match (sampling.mipmap, sampling.linear) {
            (true, true) => glow::LINEAR_MIPMAP_LINEAR,
            (true, false) => glow::NEAREST_MIPMAP_LINEAR,
            (false, linear) => filter(linear),
        };
        let wrap = match sampling.wrap {
            GlWrap::Repeat => glow::REPEAT,
            GlWrap::MirroredRepeat => glow::MIRRORED_REPEAT,
            GlWrap::ClampToEdge => glow::CLAMP_TO_EDGE,
            GlWrap::ClampToBorder => glow::CLAMP_TO_BORDER,
            GlWrap::Clamp => CLAMP,
        };
        let mode = if sampling.compare.is_some() { glow::COMPARE_REF_TO_TEXTURE } else { glow::NONE };
        let compare = sampling.compare.unwrap_or(GlCompare::LessEqual).code();
        let parameters = [
            (glow::TEXTURE_MIN_FILTER, min),
            (glow::TEXTURE_MAG_FILTER, filter(sampling.linear)),
            (glow::TEXTURE_WRAP_S, wrap),
            (glow::TEXTURE_WRAP_T, wrap),
            (glow::TEXTURE_WRAP_R, wrap),
            (glow::TEXTURE_COMPARE_MODE, mode),
            (glow::TEXTURE_COMPARE_FUNC, compare),
        ];
        // SAFETY: the context is current and the texture is not deleted.
        unsafe {
            self.gl.active_texture(glow::TEXTURE0 + unit);
            self.gl.bind_texture(image.target, Some(image.name));
            for (name, value) in parameters {
                // A colour image knows no comparison, but keeps the parameter.
                self.gl.tex_parameter_i32(image.target, name, value as i32);
            }
            self.gl.tex_parameter_f32_slice(image.target, glow::TEXTURE_BORDER_COLOR, &sampling.border);
            if image.target == glow::TEXTURE_CUBE_MAP {
                let switch = if sampling.seamless { glow::Context::enable } else { glow::Context::disable };
                switch(&self.gl, glow::TEXTURE_CUBE_MAP_SEAMLESS);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Encoding;

    #[test]
    fn steps_of_formats() {
        let float = Encoding { bits: 32, stencil_bits: 0, float: true };
        assert_eq!(float.step(0.75), 2f64.powi(-24));
        assert_eq!(float.step(0.1875), 2f64.powi(-26));
        assert_eq!(Encoding { bits: 16, stencil_bits: 0, float: false }.step(0.75), 1.0 / 65535.0);
    }
}
