//! Textures, renderbuffers and samplers.

use std::rc::Rc;

use glow::HasContext;

use super::Error;
use super::state::compare_code;
use crate::context::{DEPTH_COMPONENT32, error_name};
use crate::geometry::normal_cube;
use crate::pass::{Cube, CubeFace, DepthFormat, Filter, Format, ImageDesc, Sampler, Storage, Wrap};

/// A texture or renderbuffer, deleted on drop.
pub struct GpuImage {
    gl: Rc<glow::Context>,
    pub name: ImageName,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageName {
    Texture(glow::Texture),
    Cube(glow::Texture),
    Line(glow::Texture),
    Renderbuffer(glow::Renderbuffer),
}

impl ImageName {
    /// GL's number for it; the sign bit distinguishes textures and renderbuffers.
    pub fn number(self) -> u32 {
        match self {
            Self::Texture(texture) | Self::Cube(texture) | Self::Line(texture) => texture.0.get(),
            Self::Renderbuffer(buffer) => buffer.0.get() | 1 << 31,
        }
    }

    /// Texture target that it is bound to.
    pub fn binding(self) -> u32 {
        match self {
            Self::Cube(_) => glow::TEXTURE_CUBE_MAP,
            Self::Line(_) => glow::TEXTURE_1D,
            Self::Texture(_) | Self::Renderbuffer(_) => glow::TEXTURE_2D,
        }
    }

    /// The texture; `None` for a renderbuffer.
    pub fn texture(self) -> Option<glow::Texture> {
        match self {
            Self::Texture(texture) | Self::Cube(texture) | Self::Line(texture) => Some(texture),
            Self::Renderbuffer(_) => None,
        }
    }
}

/// The target of one face.
pub fn face_code(face: CubeFace) -> u32 {
    glow::TEXTURE_CUBE_MAP_POSITIVE_X + face as u32
}

impl Drop for GpuImage {
    fn drop(&mut self) {
        match self.name {
            ImageName::Texture(texture) | ImageName::Cube(texture) | ImageName::Line(texture) => unsafe {
                self.gl.delete_texture(texture)
            },
            ImageName::Renderbuffer(buffer) => unsafe { self.gl.delete_renderbuffer(buffer) },
        }
    }
}

/// GL's internal format, and the format and type of an upload.
fn codes(format: Format) -> (u32, u32, u32) {
    match format {
        Format::Rgba8 => (glow::RGBA8, glow::RGBA, glow::UNSIGNED_BYTE),
        Format::Rgba8Signed => (glow::RGBA8_SNORM, glow::RGBA, glow::BYTE),
        Format::Rgba32F => (glow::RGBA32F, glow::RGBA, glow::FLOAT),
        Format::R32F => (glow::R32F, glow::RED, glow::FLOAT),
        Format::Depth(depth) => {
            let internal = match depth {
                DepthFormat::Depth16 => glow::DEPTH_COMPONENT16,
                DepthFormat::Depth24 => glow::DEPTH_COMPONENT24,
                DepthFormat::Depth32 => DEPTH_COMPONENT32,
                DepthFormat::Depth32F => glow::DEPTH_COMPONENT32F,
            };
            (internal, glow::DEPTH_COMPONENT, glow::FLOAT)
        }
        Format::UnsizedDepth => (glow::DEPTH_COMPONENT, glow::DEPTH_COMPONENT, glow::FLOAT),
        Format::Depth24Stencil8 => (glow::DEPTH24_STENCIL8, glow::DEPTH_STENCIL, glow::UNSIGNED_INT_24_8),
    }
}

/// Makes the image that `desc` describes.
pub fn create(gl: &Rc<glow::Context>, desc: &ImageDesc) -> Result<GpuImage, Error> {
    let name = match &desc.storage {
        Storage::Renderbuffer => create_renderbuffer(gl, desc)?,
        Storage::Texture => create_texture(gl, desc, None, 1)?,
        Storage::Cube(cube) => create_cube(gl, desc, cube)?,
        Storage::Mipmapped(levels) => create_texture(gl, desc, None, *levels)?,
        Storage::Levels(levels) => create_levels(gl, desc, &levels.levels)?,
        Storage::UnitVectors => create_unit_vectors(gl, desc)?,
        Storage::Line(texels) => create_line(gl, desc, texels.len(), bytemuck::cast_slice(texels))?,
        Storage::Values(values) => create_line(gl, desc, values.len(), bytemuck::cast_slice(values))?,
        Storage::Uploaded(texture) => create_texture(gl, desc, Some(&texture.rgba), 1)?,
    };
    let image = GpuImage { gl: gl.clone(), name };
    match unsafe { gl.get_error() } {
        glow::NO_ERROR => Ok(image),
        code => Err(Error::Allocation { image: desc.label.clone(), codes: error_name(code) }),
    }
}

fn create_renderbuffer(gl: &glow::Context, desc: &ImageDesc) -> Result<ImageName, Error> {
    let (internal, _, _) = codes(desc.format);
    let [width, height] = desc.size.map(|side| side as i32);
    unsafe {
        let buffer = gl.create_renderbuffer().map_err(Error::Create)?;
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
        gl.renderbuffer_storage(glow::RENDERBUFFER, internal, width, height);
        Ok(ImageName::Renderbuffer(buffer))
    }
}

/// A texture of `levels` levels; with `texels`, of all that there are.
fn create_texture(
    gl: &glow::Context,
    desc: &ImageDesc,
    texels: Option<&[u8]>,
    levels: u32,
) -> Result<ImageName, Error> {
    let (internal, format, kind) = codes(desc.format);
    unsafe {
        let texture = gl.create_texture().map_err(Error::Create)?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        for level in 0..levels.max(1) {
            let [width, height] = desc.size.map(|side| (side >> level).max(1) as i32);
            let (level, internal) = (level as i32, internal as i32);
            let pixels = glow::PixelUnpackData::Slice(texels);
            gl.tex_image_2d(glow::TEXTURE_2D, level, internal, width, height, 0, format, kind, pixels);
        }
        if texels.is_some() {
            gl.generate_mipmap(glow::TEXTURE_2D);
        } else {
            gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, levels as i32 - 1);
        }
        gl.bind_texture(glow::TEXTURE_2D, None);
        Ok(ImageName::Texture(texture))
    }
}

/// A texture whose levels have texels of their own.
fn create_levels(gl: &glow::Context, desc: &ImageDesc, levels: &[Vec<[u8; 4]>]) -> Result<ImageName, Error> {
    let (internal, format, kind) = codes(desc.format);
    // SAFETY: the context is current; each level has the texels of its size.
    unsafe {
        let texture = gl.create_texture().map_err(Error::Create)?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        for (level, texels) in levels.iter().enumerate() {
            let [width, height] = desc.size.map(|side| (side >> level).max(1) as i32);
            let pixels = glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(texels)));
            gl.tex_image_2d(glow::TEXTURE_2D, level as i32, internal as i32, width, height, 0, format, kind, pixels);
        }
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAX_LEVEL, levels.len() as i32 - 1);
        gl.bind_texture(glow::TEXTURE_2D, None);
        Ok(ImageName::Texture(texture))
    }
}

/// A cube map of unit vectors, of one level.
fn create_unit_vectors(gl: &glow::Context, desc: &ImageDesc) -> Result<ImageName, Error> {
    let (internal, format, kind) = codes(desc.format);
    let side = desc.size[0];
    // SAFETY: the context is current; a face has the texels of its size.
    unsafe {
        let texture = gl.create_texture().map_err(Error::Create)?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_CUBE_MAP, Some(texture));
        for (index, face) in CubeFace::ALL.into_iter().enumerate() {
            let texels = normal_cube::packed_face(index, side);
            let (pixels, side) = (glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(&texels))), side as i32);
            gl.tex_image_2d(face_code(face), 0, internal as i32, side, side, 0, format, kind, pixels);
        }
        gl.tex_parameter_i32(glow::TEXTURE_CUBE_MAP, glow::TEXTURE_MAX_LEVEL, 0);
        gl.bind_texture(glow::TEXTURE_CUBE_MAP, None);
        Ok(ImageName::Cube(texture))
    }
}

/// A 1D texture of `count` texels, in the format's bytes.
fn create_line(gl: &glow::Context, desc: &ImageDesc, count: usize, texels: &[u8]) -> Result<ImageName, Error> {
    let (internal, format, kind) = codes(desc.format);
    // SAFETY: the context is current; the texels are as many as the size says.
    unsafe {
        let texture = gl.create_texture().map_err(Error::Create)?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_1D, Some(texture));
        let (width, pixels) = (count as i32, glow::PixelUnpackData::Slice(Some(texels)));
        gl.tex_image_1d(glow::TEXTURE_1D, 0, internal as i32, width, 0, format, kind, pixels);
        gl.tex_parameter_i32(glow::TEXTURE_1D, glow::TEXTURE_MAX_LEVEL, 0);
        gl.bind_texture(glow::TEXTURE_1D, None);
        Ok(ImageName::Line(texture))
    }
}

/// The faces that are drawn are left undefined, the others filled.
fn create_cube(gl: &glow::Context, desc: &ImageDesc, cube: &Cube) -> Result<ImageName, Error> {
    let (internal, format, kind) = codes(desc.format);
    let [width, height] = desc.size.map(|side| side as i32);
    let rest = if cube.drawn == [true; 6] { Vec::new() } else { vec![cube.rest; width as usize * height as usize] };
    unsafe {
        let texture = gl.create_texture().map_err(Error::Create)?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_CUBE_MAP, Some(texture));
        for (face, drawn) in CubeFace::ALL.into_iter().zip(cube.drawn) {
            let pixels = glow::PixelUnpackData::Slice((!drawn).then(|| bytemuck::cast_slice(&rest)));
            gl.tex_image_2d(face_code(face), 0, internal as i32, width, height, 0, format, kind, pixels);
        }
        gl.tex_parameter_i32(glow::TEXTURE_CUBE_MAP, glow::TEXTURE_MAX_LEVEL, 0);
        gl.bind_texture(glow::TEXTURE_CUBE_MAP, None);
        Ok(ImageName::Cube(texture))
    }
}

/// A sampler object, deleted on drop.
pub struct GpuSampler {
    gl: Rc<glow::Context>,
    pub name: glow::Sampler,
}

impl Drop for GpuSampler {
    fn drop(&mut self) {
        unsafe { self.gl.delete_sampler(self.name) };
    }
}

/// GL_TEXTURE_MIN_FILTER and GL_TEXTURE_MAG_FILTER.
pub fn filter_codes(filter: Filter) -> [u32; 2] {
    match filter {
        Filter::Nearest => [glow::NEAREST, glow::NEAREST],
        Filter::Linear => [glow::LINEAR, glow::LINEAR],
        Filter::Trilinear => [glow::LINEAR_MIPMAP_LINEAR, glow::LINEAR],
    }
}

/// GL_TEXTURE_WRAP_S and GL_TEXTURE_WRAP_T.
pub fn wrap_code(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => glow::REPEAT,
        Wrap::ClampToEdge => glow::CLAMP_TO_EDGE,
        Wrap::ClampToBorder(_) => glow::CLAMP_TO_BORDER,
    }
}

/// Makes a sampler object with every parameter that a [`Sampler`] names.
pub fn create_sampler(gl: &Rc<glow::Context>, sampler: Sampler) -> Result<GpuSampler, Error> {
    let ([min, mag], wrap) = (filter_codes(sampler.filter), wrap_code(sampler.wrap));
    unsafe {
        let name = gl.create_sampler().map_err(Error::Create)?;
        gl.sampler_parameter_i32(name, glow::TEXTURE_MIN_FILTER, min as i32);
        gl.sampler_parameter_i32(name, glow::TEXTURE_MAG_FILTER, mag as i32);
        gl.sampler_parameter_i32(name, glow::TEXTURE_WRAP_S, wrap as i32);
        gl.sampler_parameter_i32(name, glow::TEXTURE_WRAP_T, wrap as i32);
        if let Wrap::ClampToBorder(border) = sampler.wrap {
            gl.sampler_parameter_f32_slice(name, glow::TEXTURE_BORDER_COLOR, &border.color());
        }
        if let Some(compare) = sampler.compare {
            gl.sampler_parameter_i32(name, glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE as i32);
            gl.sampler_parameter_i32(name, glow::TEXTURE_COMPARE_FUNC, compare_code(compare) as i32);
        }
        if let Some(halves) = sampler.lod_halves {
            gl.sampler_parameter_f32(name, glow::TEXTURE_MIN_LOD, 0.5 * f32::from(halves));
            gl.sampler_parameter_f32(name, glow::TEXTURE_MAX_LOD, 0.5 * f32::from(halves));
        }
        Ok(GpuSampler { gl: gl.clone(), name })
    }
}
