//! The bench's textures: their shapes, levels and layers, uploads.

use std::rc::Rc;

use glow::HasContext;

use super::format::{Encoding, GlFormat};
use super::{Bench, Error};

/// Shape of a texture: its target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlShape {
    /// GL_TEXTURE_1D.
    Line,
    /// GL_TEXTURE_2D.
    Flat,
    /// GL_TEXTURE_CUBE_MAP: six layers.
    Cube,
    /// GL_TEXTURE_2D_ARRAY.
    Array,
    /// GL_TEXTURE_CUBE_MAP_ARRAY: six layers for each cube.
    CubeArray,
    /// GL_TEXTURE_3D: layers along r, of one level.
    Volume,
}

impl GlShape {
    pub(crate) fn target(self) -> u32 {
        match self {
            Self::Line => glow::TEXTURE_1D,
            Self::Flat => glow::TEXTURE_2D,
            Self::Cube => glow::TEXTURE_CUBE_MAP,
            Self::Array => glow::TEXTURE_2D_ARRAY,
            Self::CubeArray => glow::TEXTURE_CUBE_MAP_ARRAY,
            Self::Volume => glow::TEXTURE_3D,
        }
    }

    /// Target of one layer's texels.
    pub(super) fn place(self, layer: u32) -> u32 {
        if self == Self::Cube { glow::TEXTURE_CUBE_MAP_POSITIVE_X + layer } else { self.target() }
    }
}

/// Description of an image.
#[derive(Clone, Copy, Debug)]
pub struct GlImageDesc {
    pub shape: GlShape,
    pub format: GlFormat,
    /// Width and height of level 0, of a layer or face.
    pub size: [u32; 2],
    /// Six for a cube map, 1 but for arrays otherwise.
    pub layers: u32,
    pub levels: u32,
}

impl GlImageDesc {
    /// An image of one level and one layer.
    pub const fn flat(format: GlFormat, size: [u32; 2]) -> Self {
        Self { shape: GlShape::Flat, format, size, layers: 1, levels: 1 }
    }

    /// A cube map of one level.
    pub const fn cube(format: GlFormat, side: u32) -> Self {
        Self { shape: GlShape::Cube, format, size: [side; 2], layers: 6, levels: 1 }
    }
}

/// Size of a level.
pub fn level_size(size: [u32; 2], level: u32) -> [u32; 2] {
    size.map(|side| (side >> level).max(1))
}

/// A texture, deleted on drop.
pub struct GlImage {
    gl: Rc<glow::Context>,
    pub(crate) name: glow::Texture,
    pub shape: GlShape,
    pub format: GlFormat,
    /// Width and height in texels, of a face or layer of level 0.
    pub size: [u32; 2],
    pub layers: u32,
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

/// Texels of a rectangle, as the client has them.
#[derive(Clone, Copy, Debug)]
pub struct GlUpload<'a> {
    pub level: u32,
    /// Layer or face.
    pub layer: u32,
    /// x, y, width, height.
    pub area: [u32; 4],
    /// Format and type of the client's texels, like GL_RGBA and GL_UNSIGNED_BYTE.
    pub layout: [u32; 2],
    /// UNPACK_ALIGNMENT.
    pub alignment: u32,
    /// UNPACK_ROW_LENGTH; 0: the width.
    pub row: u32,
    pub bytes: &'a [u8],
}

impl Bench {
    /// An image without content.
    ///
    /// # Errors
    ///
    /// [`Error::Refused`], with GL's reason.
    pub fn image(&self, format: GlFormat, size: [u32; 2]) -> Result<GlImage, Error> {
        self.blank(GlImageDesc::flat(format, size))
    }

    /// A depth image with these depths, a level each: level 0 is of `size`, each next one half as large.
    ///
    /// # Errors
    ///
    /// As [`image`](Self::image).
    pub fn depth_image(&self, format: GlFormat, size: [u32; 2], levels: &[&[f32]]) -> Result<GlImage, Error> {
        let desc = GlImageDesc { levels: levels.len() as u32, ..GlImageDesc::flat(format, size) };
        self.filled(desc, |level, _| bytemuck::cast_slice(levels[level as usize]).to_vec())
    }

    /// An RGBA32F image with these texels, rows from below.
    ///
    /// # Errors
    ///
    /// As [`image`](Self::image).
    pub fn float_image(&self, size: [u32; 2], texels: &[[f32; 4]]) -> Result<GlImage, Error> {
        self.filled(GlImageDesc::flat(GlFormat::Rgba32F, size), |_, _| bytemuck::cast_slice(texels).to_vec())
    }

    /// An RGBA8 image with these texels, rows from below.
    ///
    /// # Errors
    ///
    /// As [`image`](Self::image).
    pub fn byte_image(&self, size: [u32; 2], texels: &[[u8; 4]]) -> Result<GlImage, Error> {
        self.filled(GlImageDesc::flat(GlFormat::Rgba8, size), |_, _| texels.as_flattened().to_vec())
    }

    /// An RGBA8 cube map of `side` texels: +x, -x, +y, -y, +z, -z, rows from t = 0.
    ///
    /// # Errors
    ///
    /// As [`image`](Self::image).
    pub fn cube_image(&self, side: u32, faces: &[Vec<[u8; 4]>; 6]) -> Result<GlImage, Error> {
        let faces = self.mutation.map_or_else(|| faces.clone(), |mutation| mutation.faces(side, faces.clone()));
        let desc = GlImageDesc::cube(GlFormat::Rgba8, side);
        self.filled(desc, |_, layer| faces[layer as usize].as_flattened().to_vec())
    }

    /// An image without content, of any shape.
    ///
    /// # Errors
    ///
    /// As [`image`](Self::image).
    pub fn blank(&self, desc: GlImageDesc) -> Result<GlImage, Error> {
        self.define(desc, None)
    }

    /// An image of any shape; `texels` gives the bytes of a level's layer, in the format's own layout.
    ///
    /// # Errors
    ///
    /// As [`image`](Self::image).
    pub fn filled(&self, desc: GlImageDesc, texels: impl Fn(u32, u32) -> Vec<u8>) -> Result<GlImage, Error> {
        self.define(desc, Some(&texels))
    }

    fn define(&self, desc: GlImageDesc, texels: Option<&dyn Fn(u32, u32) -> Vec<u8>>) -> Result<GlImage, Error> {
        let gl = &self.gl;
        self.take_errors();
        let GlImageDesc { shape, format, size, layers, levels } = desc;
        let (target, (internal, layout, kind)) = (shape.target(), format.codes());
        let internal = internal as i32;
        // SAFETY: the context is current; where pixels are given there are as many as the level has.
        let name = unsafe {
            let name = gl.create_texture().map_err(super::no("texture"))?;
            gl.active_texture(glow::TEXTURE0);
            gl.bind_texture(target, Some(name));
            gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
            for level in 0..levels {
                let [width, height] = level_size(size, level).map(|side| side as i32);
                let at = level as i32;
                let bytes: Vec<_> = (0..layers).map(|layer| texels.map(|texels| texels(level, layer))).collect();
                let whole: Option<Vec<u8>> = bytes.iter().cloned().collect::<Option<Vec<_>>>().map(|all| all.concat());
                match shape {
                    GlShape::Line => {
                        let pixels = glow::PixelUnpackData::Slice(whole.as_deref());
                        gl.tex_image_1d(target, at, internal, width, 0, layout, kind, pixels);
                    }
                    GlShape::Flat | GlShape::Cube => {
                        for (layer, bytes) in (0..).zip(&bytes) {
                            let (place, pixels) = (shape.place(layer), glow::PixelUnpackData::Slice(bytes.as_deref()));
                            gl.tex_image_2d(place, at, internal, width, height, 0, layout, kind, pixels);
                        }
                    }
                    GlShape::Array | GlShape::CubeArray | GlShape::Volume => {
                        let (depth, pixels) = (layers as i32, glow::PixelUnpackData::Slice(whole.as_deref()));
                        gl.tex_image_3d(target, at, internal, width, height, depth, 0, layout, kind, pixels);
                    }
                }
            }
            gl.tex_parameter_i32(target, glow::TEXTURE_MAX_LEVEL, levels as i32 - 1);
            name
        };
        let encoding = self.encoding(shape, format);
        let image = GlImage { gl: gl.clone(), name, shape, format, size, layers, levels, encoding };
        match self.take_errors() {
            None => Ok(image),
            Some(reason) => Err(Error::Refused { format: format.name(), reason }),
        }
    }

    /// Reads the encoding of the bound texture.
    fn encoding(&self, shape: GlShape, format: GlFormat) -> Encoding {
        if !format.is_depth() {
            return Encoding { bits: 0, stencil_bits: 0, float: false };
        }
        // SAFETY: level 0 exists.
        let level = |name| unsafe { self.gl.get_tex_level_parameter_i32(shape.place(0), 0, name) };
        Encoding {
            bits: level(glow::TEXTURE_DEPTH_SIZE).max(0) as u32,
            stencil_bits: if format.has_stencil() { level(glow::TEXTURE_STENCIL_SIZE).max(0) as u32 } else { 0 },
            float: level(glow::TEXTURE_DEPTH_TYPE) == glow::FLOAT as i32,
        }
    }

    /// Replaces a rectangle of a 2D image's level or of a cube map's face: glTexSubImage2D.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn upload(&self, image: &GlImage, upload: &GlUpload) -> Result<(), Error> {
        let [x, y, width, height] = upload.area.map(|place| place as i32);
        let [layout, kind] = upload.layout;
        let place = image.shape.place(upload.layer);
        let pixels = glow::PixelUnpackData::Slice(Some(upload.bytes));
        // SAFETY: the context is current; the bytes are those of the rectangle, by alignment and row length.
        unsafe {
            self.gl.active_texture(glow::TEXTURE0);
            self.gl.bind_texture(image.shape.target(), Some(image.name));
            self.gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, upload.alignment as i32);
            self.gl.pixel_store_i32(glow::UNPACK_ROW_LENGTH, upload.row as i32);
            self.gl.tex_sub_image_2d(place, upload.level as i32, x, y, width, height, layout, kind, pixels);
            self.gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
            self.gl.pixel_store_i32(glow::UNPACK_ROW_LENGTH, 0);
        }
        self.check("an upload")
    }

    /// Makes the levels from level 0: glGenerateMipmap.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn generate_mipmap(&self, image: &GlImage) -> Result<(), Error> {
        let target = image.shape.target();
        // SAFETY: the context is current; the texture is not deleted.
        unsafe {
            self.gl.active_texture(glow::TEXTURE0);
            self.gl.bind_texture(target, Some(image.name));
            self.gl.tex_parameter_i32(target, glow::TEXTURE_BASE_LEVEL, 0);
            self.gl.tex_parameter_i32(target, glow::TEXTURE_MAX_LEVEL, image.levels as i32 - 1);
            self.gl.generate_mipmap(target);
        }
        self.check("glGenerateMipmap")
    }
}
