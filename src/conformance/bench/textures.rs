//! Textures and sampler objects call by call, under slots: each step sets what it says and leaves all else as it was.

use glow::HasContext;

use super::program::GlProgram;
use super::{Bench, Error, GlImage, GlState, Sampling, Surface, Vertex, no};

/// Texels of a step, and where they come from.
#[derive(Clone, Debug)]
pub struct GlTexels {
    /// Format and type of the client's texels, like GL_RGBA and GL_UNSIGNED_BYTE.
    pub layout: [u32; 2],
    /// UNPACK_ALIGNMENT, UNPACK_ROW_LENGTH, UNPACK_SKIP_ROWS, UNPACK_SKIP_PIXELS, UNPACK_IMAGE_HEIGHT, UNPACK_SKIP_IMAGES.
    pub store: [u32; 6],
    /// All bytes, with those that are skipped.
    pub bytes: Vec<u8>,
    /// Bytes of a pixel unpack buffer before these; `None`: client memory.
    pub in_buffer: Option<u32>,
}

/// Part of a texture's level: the target that names it, the level, and the first texel.
#[derive(Clone, Copy, Debug)]
pub struct GlTexelPlace {
    pub slot: usize,
    pub target: u32,
    pub level: u32,
    pub at: [u32; 3],
}

/// One step. A texture is bound, by its slot, to the active unit before the step that changes it.
#[derive(Clone, Debug)]
pub enum GlTextureStep {
    /// glGenTextures for a slot; the slot's texture before is deleted first.
    New(usize),
    /// glActiveTexture and glBindTexture.
    Bind { unit: u32, target: u32, slot: usize },
    /// glTexImage; 1, 2 or 3 dimensions by the target.
    Define { place: GlTexelPlace, internal: u32, size: [u32; 3], texels: Option<GlTexels> },
    /// glTexSubImage.
    Replace { place: GlTexelPlace, size: [u32; 3], texels: GlTexels },
    /// glCopyTexSubImage from x, y of a surface: width and height.
    Copy { place: GlTexelPlace, surface: usize, from: [u32; 2], size: [u32; 2] },
    /// Clears a rectangle of a level by way of a framebuffer: x, y, width, height.
    Clear { place: GlTexelPlace, area: [u32; 4], color: [f32; 4], depth: bool },
    /// glGenerateMipmap.
    Mipmap { target: u32 },
    /// Parameters of the texture that is bound, where they differ.
    Parameters { target: u32, from: Option<Sampling>, to: Sampling },
    /// glGenSamplers for a slot; the slot's object before is deleted first.
    NewSampler(usize),
    /// Parameters of a sampler object, where they differ.
    SamplerParameters { object: usize, from: Option<Sampling>, to: Sampling },
    /// glBindSampler.
    BindSampler { unit: u32, object: Option<usize> },
    /// GL_TEXTURE_CUBE_MAP_SEAMLESS.
    Seamless(bool),
    /// An integer uniform of a program.
    Uniform { program: usize, name: &'static str, value: i32 },
    /// Triangles by a program, with the numbers of the uniform array `more`.
    Draw { program: usize, more: Vec<[f32; 4]>, vertices: Vec<Vertex> },
}

/// Objects that steps work on.
pub struct GlTextureBench<'a> {
    bench: &'a Bench,
    textures: Vec<Option<glow::Texture>>,
    samplers: Vec<Option<glow::Sampler>>,
    programs: &'a [GlProgram],
    surfaces: &'a [Surface],
    framebuffer: glow::Framebuffer,
    buffer: glow::Buffer,
}

impl Drop for GlTextureBench<'_> {
    fn drop(&mut self) {
        let gl = &self.bench.gl;
        // SAFETY: the context is current; the objects are the bench's own and are not used again.
        unsafe {
            for (unit, _) in (0..).zip(0..32) {
                gl.bind_sampler(unit, None);
            }
            self.textures.iter().flatten().for_each(|name| gl.delete_texture(*name));
            self.samplers.iter().flatten().for_each(|name| gl.delete_sampler(*name));
            gl.delete_framebuffer(self.framebuffer);
            gl.delete_buffer(self.buffer);
            gl.disable(glow::TEXTURE_CUBE_MAP_SEAMLESS);
            gl.active_texture(glow::TEXTURE0);
        }
    }
}

impl<'a> GlTextureBench<'a> {
    /// A bench of so many slots for textures and for sampler objects; copies come from `surfaces`.
    ///
    /// # Errors
    ///
    /// A driver that makes no framebuffer or buffer.
    pub(crate) fn new(
        bench: &'a Bench,
        slots: [usize; 2],
        programs: &'a [GlProgram],
        surfaces: &'a [Surface],
    ) -> Result<Self, Error> {
        let gl = &bench.gl;
        // SAFETY: the context is current; the objects are deleted on drop.
        let (framebuffer, buffer) =
            unsafe { (gl.create_framebuffer().map_err(no("framebuffer"))?, gl.create_buffer().map_err(no("buffer"))?) };
        // SAFETY: sets state. Other rules may have left sampler objects on units.
        unsafe { (0..32).for_each(|unit| gl.bind_sampler(unit, None)) };
        let (textures, samplers) = (vec![None; slots[0]], vec![None; slots[1]]);
        Ok(Self { bench, textures, samplers, programs, surfaces, framebuffer, buffer })
    }

    /// Binds an image to a unit that no step uses, and sets the uniform `name` of every program to it.
    pub fn give_all(&self, unit: u32, image: &GlImage, name: &str) -> Result<(), Error> {
        self.bench.bind_image(unit, image, Sampling::NEAREST)?;
        let gl = &self.bench.gl;
        // SAFETY: the context is current, and the programs are in it.
        unsafe {
            for program in self.programs {
                gl.use_program(Some(program.name));
                gl.uniform_1_i32(gl.get_uniform_location(program.name, name).as_ref(), unit as i32);
            }
        }
        self.bench.check("inputs")
    }

    /// Takes steps one after another; draws go to `surface` under `state`.
    ///
    /// # Errors
    ///
    /// GL's, with the number of the step.
    pub fn take(&mut self, steps: &[GlTextureStep], surface: &Surface, state: GlState) -> Result<(), Error> {
        self.bench.prepare(surface, state);
        for (number, step) in steps.iter().enumerate() {
            self.step(step, surface)?;
            if let Some(codes) = self.bench.take_errors() {
                let codes = format!("{codes}, at step {number}: {}", short(step));
                return Err(Error::Gl { what: "a step of a texture", codes });
            }
        }
        Ok(())
    }

    fn step(&mut self, step: &GlTextureStep, surface: &Surface) -> Result<(), Error> {
        let bench = self.bench;
        let gl = &bench.gl;
        // SAFETY: the context is current; slots that are named have been made; texels fill what they are for.
        unsafe {
            match step {
                GlTextureStep::New(slot) => {
                    if let Some(before) = self.textures[*slot].take() {
                        gl.delete_texture(before);
                    }
                    self.textures[*slot] = Some(gl.create_texture().map_err(no("texture"))?);
                }
                GlTextureStep::Bind { unit, target, slot } => {
                    gl.active_texture(glow::TEXTURE0 + unit);
                    gl.bind_texture(*target, self.textures[*slot]);
                }
                GlTextureStep::Define { place, internal, size, texels } => {
                    self.define(*place, *internal as i32, size.map(|side| side as i32), texels.as_ref());
                }
                GlTextureStep::Replace { place, size, texels } => {
                    self.unpack(texels, |gl, [layout, kind], pixels| {
                        let ([x, y, z], [width, height, depth]) =
                            (place.at.map(|at| at as i32), size.map(|side| side as i32));
                        let level = place.level as i32;
                        if matches!(place.target, glow::TEXTURE_3D | glow::TEXTURE_2D_ARRAY) {
                            gl.tex_sub_image_3d(
                                place.target,
                                level,
                                x,
                                y,
                                z,
                                width,
                                height,
                                depth,
                                layout,
                                kind,
                                pixels,
                            );
                        } else {
                            gl.tex_sub_image_2d(place.target, level, x, y, width, height, layout, kind, pixels);
                        }
                    });
                }
                GlTextureStep::Copy { place, surface: source, from, size } => {
                    gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(self.surfaces[*source].name));
                    let ([x, y, z], level) = (place.at.map(|at| at as i32), place.level as i32);
                    let ([left, low], [width, height]) = (from.map(|at| at as i32), size.map(|side| side as i32));
                    if matches!(place.target, glow::TEXTURE_3D | glow::TEXTURE_2D_ARRAY) {
                        gl.copy_tex_sub_image_3d(place.target, level, x, y, z, left, low, width, height);
                    } else {
                        gl.copy_tex_sub_image_2d(place.target, level, x, y, left, low, width, height);
                    }
                    gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name));
                }
                GlTextureStep::Clear { place, area, color, depth } => {
                    self.clear(*place, *area, *color, *depth)?;
                    gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name));
                }
                GlTextureStep::Mipmap { target } => gl.generate_mipmap(*target),
                GlTextureStep::Parameters { target, from, to } => bench.set_parameters(*target, from.as_ref(), to),
                GlTextureStep::NewSampler(object) => {
                    if let Some(before) = self.samplers[*object].take() {
                        gl.delete_sampler(before);
                    }
                    self.samplers[*object] = Some(gl.create_sampler().map_err(no("sampler object"))?);
                }
                GlTextureStep::SamplerParameters { object, from, to } => {
                    if let Some(name) = self.samplers[*object] {
                        bench.set_sampler_parameters(name, from.as_ref(), to);
                    }
                }
                GlTextureStep::BindSampler { unit, object } => {
                    gl.bind_sampler(*unit, object.and_then(|object| self.samplers[object]));
                }
                GlTextureStep::Seamless(on) => {
                    let switch = if *on { glow::Context::enable } else { glow::Context::disable };
                    switch(gl, glow::TEXTURE_CUBE_MAP_SEAMLESS);
                }
                GlTextureStep::Uniform { program, name, value } => {
                    let program = self.programs[*program].name;
                    gl.use_program(Some(program));
                    gl.uniform_1_i32(gl.get_uniform_location(program, name).as_ref(), *value);
                }
                GlTextureStep::Draw { program, more, vertices } => {
                    let program = self.programs[*program].name;
                    gl.use_program(Some(program));
                    let location = gl.get_uniform_location(program, "more");
                    gl.uniform_4_f32_slice(location.as_ref(), more.as_flattened());
                    bench.submit(program, vertices);
                }
            }
        }
        Ok(())
    }

    /// # Safety
    ///
    /// The context is current; the texture is bound, and texels fill the level.
    unsafe fn define(&self, place: GlTexelPlace, internal: i32, size: [i32; 3], texels: Option<&GlTexels>) {
        let empty = GlTexels {
            layout: empty_layout(internal as u32),
            store: [4, 0, 0, 0, 0, 0],
            bytes: Vec::new(),
            in_buffer: None,
        };
        let ([width, height, depth], level, target) = (size, place.level as i32, place.target);
        // SAFETY: as the caller promises.
        self.unpack(texels.unwrap_or(&empty), |gl, [layout, kind], pixels| unsafe {
            let pixels = if texels.is_none() { glow::PixelUnpackData::Slice(None) } else { pixels };
            match target {
                glow::TEXTURE_1D => gl.tex_image_1d(target, level, internal, width, 0, layout, kind, pixels),
                glow::TEXTURE_3D | glow::TEXTURE_2D_ARRAY => {
                    gl.tex_image_3d(target, level, internal, width, height, depth, 0, layout, kind, pixels);
                }
                _ => gl.tex_image_2d(target, level, internal, width, height, 0, layout, kind, pixels),
            }
        });
    }

    /// Calls `give` with the texels where they are to come from, under their pixel store.
    fn unpack(&self, texels: &GlTexels, give: impl FnOnce(&glow::Context, [u32; 2], glow::PixelUnpackData)) {
        const NAMES: [u32; 6] = [
            glow::UNPACK_ALIGNMENT,
            glow::UNPACK_ROW_LENGTH,
            glow::UNPACK_SKIP_ROWS,
            glow::UNPACK_SKIP_PIXELS,
            glow::UNPACK_IMAGE_HEIGHT,
            glow::UNPACK_SKIP_IMAGES,
        ];
        let gl = &self.bench.gl;
        // SAFETY: the context is current; the bytes are those that GL reads, by the pixel store.
        unsafe {
            for (name, value) in NAMES.into_iter().zip(texels.store) {
                gl.pixel_store_i32(name, value as i32);
            }
            if let Some(before) = texels.in_buffer {
                let bytes = [&vec![0x5A; before as usize][..], &texels.bytes].concat();
                gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, Some(self.buffer));
                gl.buffer_data_u8_slice(glow::PIXEL_UNPACK_BUFFER, &bytes, glow::STREAM_DRAW);
                give(gl, texels.layout, glow::PixelUnpackData::BufferOffset(before));
                gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            } else {
                give(gl, texels.layout, glow::PixelUnpackData::Slice(Some(&texels.bytes)));
            }
            for (name, value) in NAMES.into_iter().zip([4, 0, 0, 0, 0, 0]) {
                gl.pixel_store_i32(name, value);
            }
        }
    }

    /// # Safety
    ///
    /// The context is current, and the texture's level exists.
    unsafe fn clear(&self, place: GlTexelPlace, area: [u32; 4], color: [f32; 4], is_depth: bool) -> Result<(), Error> {
        let (gl, level, name) = (&self.bench.gl, place.level as i32, self.textures[place.slot]);
        let point = if is_depth { glow::DEPTH_ATTACHMENT } else { glow::COLOR_ATTACHMENT0 };
        // SAFETY: as the caller promises; the rectangle is within the level.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer));
            if matches!(place.target, glow::TEXTURE_3D | glow::TEXTURE_2D_ARRAY) {
                gl.framebuffer_texture_layer(glow::FRAMEBUFFER, point, name, level, place.at[2] as i32);
            } else {
                gl.framebuffer_texture_2d(glow::FRAMEBUFFER, point, place.target, name, level);
            }
            let buffer = if is_depth { glow::NONE } else { point };
            gl.draw_buffer(buffer);
            gl.read_buffer(buffer);
            let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
            if status == glow::FRAMEBUFFER_COMPLETE {
                let [x, y, width, height] = area.map(|number| number as i32);
                gl.enable(glow::SCISSOR_TEST);
                gl.scissor(x, y, width, height);
                if is_depth {
                    gl.depth_mask(true);
                    gl.clear_buffer_f32_slice(glow::DEPTH, 0, &color[..1]);
                } else {
                    gl.clear_buffer_f32_slice(glow::COLOR, 0, &color);
                }
                gl.disable(glow::SCISSOR_TEST);
            }
            gl.framebuffer_texture_2d(glow::FRAMEBUFFER, point, glow::TEXTURE_2D, None, 0);
            match status {
                glow::FRAMEBUFFER_COMPLETE => Ok(()),
                status => Err(Error::Refused {
                    format: "a texture's level",
                    reason: format!("framebuffer status {status:#06x}"),
                }),
            }
        }
    }
}

/// A layout that goes with an internal format where there are no texels.
fn empty_layout(internal: u32) -> [u32; 2] {
    match internal {
        glow::DEPTH_COMPONENT16 | glow::DEPTH_COMPONENT24 | glow::DEPTH_COMPONENT32F => {
            [glow::DEPTH_COMPONENT, glow::FLOAT]
        }
        glow::DEPTH24_STENCIL8 => [glow::DEPTH_STENCIL, glow::UNSIGNED_INT_24_8],
        glow::DEPTH32F_STENCIL8 => [glow::DEPTH_STENCIL, glow::FLOAT_32_UNSIGNED_INT_24_8_REV],
        // The integer formats lie side by side, but for those of one channel and of two.
        glow::RGBA32UI..=glow::RGB8I | glow::R8I..=glow::RG32UI => [glow::RGBA_INTEGER, glow::INT],
        _ => [glow::RGBA, glow::UNSIGNED_BYTE],
    }
}

/// A step in a few words.
fn short(step: &GlTextureStep) -> String {
    let mut text = format!("{step:?}");
    let end = text.char_indices().nth(300).map_or(text.len(), |(at, _)| at);
    text.truncate(end);
    text
}
