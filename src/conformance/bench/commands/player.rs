//! The player: the objects that commands name by slots, and the calls of each command.

use std::rc::Rc;

use glow::HasContext;

use super::super::program::GlProgram;
use super::super::{Bench, Error, GlImageDesc, GlShape, level_size, no};
use super::{
    ARRAYS, CAPACITY, Clear, Command, Drawing, FRAMEBUFFERS, Filling, OUTPUTS, Place, Point, RENDERBUFFERS, Rectangle,
    SAMPLERS, TEXTURES, programs,
};

/// Objects by slot. All are deleted on drop, and the context's state is set back.
pub struct Player<'a> {
    pub(super) bench: &'a Bench,
    pub(super) gl: &'a Rc<glow::Context>,
    pub(super) programs: Vec<GlProgram>,
    pub(super) textures: [Option<(glow::Texture, GlImageDesc)>; TEXTURES],
    pub(super) renderbuffers: [Option<glow::Renderbuffer>; RENDERBUFFERS],
    /// With the points that are attached by depth formats with stencil.
    pub(super) framebuffers: [Option<glow::Framebuffer>; FRAMEBUFFERS],
    pub(super) samplers: Vec<glow::Sampler>,
    pub(super) arrays: Vec<(glow::VertexArray, glow::Buffer)>,
    pub(super) pixels: glow::Buffer,
    indices: glow::Buffer,
    query: glow::Query,
    /// Tests whether renderbuffers hold stencil, by slot.
    pub(super) with_stencil: [bool; RENDERBUFFERS],
}

/// Indices of all rectangles of an array: of one byte, then of two, then of four.
fn indices() -> Vec<u8> {
    let all: Vec<u32> = (0..CAPACITY as u32).flat_map(|of| [0, 1, 2, 0, 2, 3].map(|corner| 4 * of + corner)).collect();
    let bytes = all.iter().map(|index| *index as u8);
    let shorts = all.iter().flat_map(|index| (*index as u16).to_ne_bytes());
    let longs = all.iter().flat_map(|index| index.to_ne_bytes());
    bytes.chain(shorts).chain(longs).collect()
}

impl Bench {
    /// A player without textures, renderbuffers and framebuffers.
    ///
    /// # Errors
    ///
    /// Objects that the driver does not make.
    pub fn player(&self) -> Result<Player<'_>, Error> {
        let gl = &self.gl;
        let programs = programs::build(gl)?;
        // SAFETY: the context is current; the player deletes what it has, and offsets lie within the buffers.
        unsafe {
            let samplers = (0..SAMPLERS).map(|_| gl.create_sampler().map_err(no("sampler object")));
            let samplers = samplers.collect::<Result<Vec<_>, _>>()?;
            let indices_name = gl.create_buffer().map_err(no("buffer"))?;
            let mut arrays = Vec::new();
            for _ in 0..ARRAYS {
                let array = gl.create_vertex_array().map_err(no("vertex array"))?;
                let buffer = gl.create_buffer().map_err(no("buffer"))?;
                gl.bind_vertex_array(Some(array));
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
                gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(indices_name));
                for index in 0..2 {
                    gl.enable_vertex_attrib_array(index);
                    gl.vertex_attrib_pointer_f32(index, 4, glow::FLOAT, false, 32, 16 * index as i32);
                }
                arrays.push((array, buffer));
            }
            gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, &indices(), glow::STATIC_DRAW);
            let player = Player {
                bench: self,
                gl,
                programs,
                textures: [None; TEXTURES],
                renderbuffers: [None; RENDERBUFFERS],
                framebuffers: [None; FRAMEBUFFERS],
                samplers,
                arrays,
                pixels: gl.create_buffer().map_err(no("buffer"))?,
                indices: indices_name,
                query: gl.create_query().map_err(no("query"))?,
                with_stencil: [false; RENDERBUFFERS],
            };
            gl.active_texture(glow::TEXTURE0);
            gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 4);
            gl.pixel_store_i32(glow::PACK_ALIGNMENT, 4);
            self.check("objects of the player")?;
            Ok(player)
        }
    }
}

impl Player<'_> {
    /// Gives one command. The answer is the memory that it has read into.
    ///
    /// # Errors
    ///
    /// GL's: the command makes one, or an object is refused.
    pub fn play(&mut self, command: &Command) -> Result<Option<Vec<u8>>, Error> {
        let gl = self.gl;
        let mut answer = None;
        // SAFETY: the context is current; slots that a command names are filled, and areas lie within their images.
        unsafe {
            match *command {
                Command::Texture { slot, desc, fresh } => self.make_texture(slot, desc, fresh)?,
                Command::DeleteTexture(slot) => {
                    if let Some((name, _)) = self.textures[slot].take() {
                        gl.delete_texture(name);
                    }
                }
                Command::Upload { slot, level, layer, area, packing, ref bytes, anew } => {
                    self.upload(slot, [level, layer], area, packing, bytes, anew);
                }
                Command::Levels(slot) => {
                    let target = self.bind_texture(slot);
                    gl.generate_mipmap(target);
                }
                Command::Renderbuffer { slot, format, size, samples } => {
                    let name = match self.renderbuffers[slot] {
                        Some(name) => name,
                        None => gl.create_renderbuffer().map_err(no("renderbuffer"))?,
                    };
                    self.renderbuffers[slot] = Some(name);
                    self.with_stencil[slot] = format.has_stencil();
                    gl.bind_renderbuffer(glow::RENDERBUFFER, Some(name));
                    let ([width, height], (internal, ..)) = (size.map(|side| side as i32), format.codes());
                    if samples == 0 {
                        gl.renderbuffer_storage(glow::RENDERBUFFER, internal, width, height);
                    } else {
                        let samples = samples as i32;
                        gl.renderbuffer_storage_multisample(glow::RENDERBUFFER, samples, internal, width, height);
                    }
                }
                Command::Framebuffer(slot) => {
                    if let Some(name) = self.framebuffers[slot].take() {
                        gl.delete_framebuffer(name);
                    }
                    self.framebuffers[slot] = Some(gl.create_framebuffer().map_err(no("framebuffer"))?);
                }
                Command::Attach { slot, point, place } => {
                    // As the framebuffer to draw into; what is bound for reading stays.
                    gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, self.framebuffers[slot]);
                    self.attach(point, place);
                }
                Command::DrawBuffers(outputs) => {
                    let code = |of: Option<u32>| of.map_or(glow::NONE, |index| glow::COLOR_ATTACHMENT0 + index);
                    match outputs {
                        [only, None] => gl.draw_buffer(code(only)),
                        several => gl.draw_buffers(&several.map(code)),
                    }
                }
                Command::ReadBuffer(index) => {
                    gl.read_buffer(index.map_or(glow::NONE, |index| glow::COLOR_ATTACHMENT0 + index));
                }
                Command::Bind { draw, read, slot } => {
                    let target = match (draw, read) {
                        (true, true) => glow::FRAMEBUFFER,
                        (true, false) => glow::DRAW_FRAMEBUFFER,
                        _ => glow::READ_FRAMEBUFFER,
                    };
                    gl.bind_framebuffer(target, self.framebuffers[slot]);
                }
                Command::Set(setting) => self.set(setting),
                Command::Clear(clear) => self.clear(clear),
                Command::Fill { array, first, ref rectangles, filling } => {
                    self.fill(array, first, rectangles, filling);
                }
                Command::Draw { array, first, count, drawing } => self.draw(array, first, count, drawing),
                Command::Blit { from: [a, b, c, d], to: [e, f, g, h], bits } => {
                    gl.blit_framebuffer(a, b, c, d, e, f, g, h, mask(bits), glow::NEAREST);
                }
                Command::Copy { from: [x, y, width, height], slot, level, layer, at } => {
                    let target = self.bind_texture(slot);
                    let (level, [to_x, to_y]) = (level as i32, at);
                    match self.textures[slot].map(|(_, desc)| desc.shape) {
                        Some(GlShape::Array) => {
                            let layer = layer as i32;
                            gl.copy_tex_sub_image_3d(target, level, to_x, to_y, layer, x, y, width, height);
                        }
                        Some(shape) => {
                            gl.copy_tex_sub_image_2d(shape.place(layer), level, to_x, to_y, x, y, width, height);
                        }
                        None => {}
                    }
                }
                Command::Read { area, packing } => answer = Some(self.read(area, packing)),
                Command::BeginQuery => gl.begin_query(glow::SAMPLES_PASSED, self.query),
                Command::EndQuery => {
                    gl.end_query(glow::SAMPLES_PASSED);
                    // Waits for the count.
                    gl.get_query_parameter_u32(self.query, glow::QUERY_RESULT);
                }
                Command::Flush => gl.flush(),
            }
        }
        self.bench.check("a generated command")?;
        Ok(answer)
    }

    unsafe fn make_texture(&mut self, slot: usize, desc: GlImageDesc, fresh: bool) -> Result<(), Error> {
        let gl = self.gl;
        // SAFETY: as the caller's: the context is current.
        unsafe {
            let same = self.textures[slot].filter(|(_, before)| !fresh && before.shape == desc.shape);
            let name = match (same, self.textures[slot].take()) {
                (Some((name, _)), _) => name,
                (None, before) => {
                    if let Some((name, _)) = before {
                        gl.delete_texture(name);
                    }
                    gl.create_texture().map_err(no("texture"))?
                }
            };
            self.textures[slot] = Some((name, desc));
            let target = self.bind_texture(slot);
            let (internal, layout, kind) = desc.format.codes();
            for level in 0..desc.levels {
                let [width, height] = level_size(desc.size, level).map(|side| side as i32);
                let (at, internal) = (level as i32, internal as i32);
                let none = || glow::PixelUnpackData::Slice(None);
                if desc.shape == GlShape::Array {
                    let layers = desc.layers as i32;
                    gl.tex_image_3d(target, at, internal, width, height, layers, 0, layout, kind, none());
                } else {
                    for layer in 0..desc.layers {
                        let place = desc.shape.place(layer);
                        gl.tex_image_2d(place, at, internal, width, height, 0, layout, kind, none());
                    }
                }
            }
            gl.tex_parameter_i32(target, glow::TEXTURE_BASE_LEVEL, 0);
            gl.tex_parameter_i32(target, glow::TEXTURE_MAX_LEVEL, desc.levels as i32 - 1);
        }
        Ok(())
    }

    unsafe fn attach(&self, point: Point, place: Option<Place>) {
        let gl = self.gl;
        let color = |index| glow::COLOR_ATTACHMENT0 + index;
        // SAFETY: as the caller's: the context is current, and the place exists.
        unsafe {
            let depth = |stencil| if stencil { glow::DEPTH_STENCIL_ATTACHMENT } else { glow::DEPTH_ATTACHMENT };
            if point == Point::Depth && place.is_some() {
                // A format without stencil leaves the other point as it is.
                let renderbuffer = glow::RENDERBUFFER;
                gl.framebuffer_renderbuffer(glow::DRAW_FRAMEBUFFER, glow::STENCIL_ATTACHMENT, renderbuffer, None);
            }
            match place {
                None => {
                    let at = if let Point::Color(index) = point { color(index) } else { depth(true) };
                    gl.framebuffer_renderbuffer(glow::DRAW_FRAMEBUFFER, at, glow::RENDERBUFFER, None);
                }
                Some(Place::Renderbuffer(slot)) => {
                    let at =
                        if let Point::Color(index) = point { color(index) } else { depth(self.with_stencil[slot]) };
                    let name = self.renderbuffers[slot];
                    gl.framebuffer_renderbuffer(glow::DRAW_FRAMEBUFFER, at, glow::RENDERBUFFER, name);
                }
                Some(Place::Texture { slot, level, layer }) => {
                    let Some((name, desc)) = self.textures[slot] else { return };
                    let stencil = desc.format.has_stencil();
                    let at = if let Point::Color(index) = point { color(index) } else { depth(stencil) };
                    let (name, level) = (Some(name), level as i32);
                    if desc.shape == GlShape::Array {
                        gl.framebuffer_texture_layer(glow::DRAW_FRAMEBUFFER, at, name, level, layer as i32);
                    } else {
                        let target = desc.shape.place(layer);
                        gl.framebuffer_texture_2d(glow::DRAW_FRAMEBUFFER, at, target, name, level);
                    }
                }
            }
        }
    }

    unsafe fn clear(&self, clear: Clear) {
        let gl = self.gl;
        // SAFETY: as the caller's: the context is current, and a framebuffer is bound.
        unsafe {
            match clear {
                Clear::Bits(bits) => gl.clear(mask(bits)),
                Clear::Color(output, color) => gl.clear_buffer_f32_slice(glow::COLOR, output, &color),
                Clear::Depth(depth) => gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[depth]),
                Clear::Stencil(value) => gl.clear_buffer_i32_slice(glow::STENCIL, 0, &[value]),
                Clear::Both(depth, value) => gl.clear_buffer_depth_stencil(glow::DEPTH_STENCIL, 0, depth, value),
            }
        }
    }

    unsafe fn fill(&self, array: usize, first: usize, rectangles: &[Rectangle], filling: Filling) {
        let gl = self.gl;
        let floats: Vec<f32> = rectangles.iter().flat_map(Rectangle::vertices).flatten().collect();
        // SAFETY: as the caller's: the context is current; parts lie within the array, which was given whole before.
        unsafe {
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(self.arrays[array].1));
            let bytes = bytemuck::cast_slice(&floats);
            match filling {
                Filling::Whole => gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytes, glow::DYNAMIC_DRAW),
                Filling::Part => gl.buffer_sub_data_u8_slice(glow::ARRAY_BUFFER, 128 * first as i32, bytes),
            }
        }
    }

    unsafe fn draw(&self, array: usize, first: usize, count: usize, drawing: Drawing) {
        let gl = self.gl;
        let [first, count, all] = [first, count, CAPACITY].map(|number| number as i32);
        // SAFETY: as the caller's: the context is current; rectangles and indices lie within the buffers.
        unsafe {
            gl.bind_vertex_array(Some(self.arrays[array].0));
            match drawing {
                Drawing::Fans => (first..first + count).for_each(|of| gl.draw_arrays(glow::TRIANGLE_FAN, 4 * of, 4)),
                Drawing::Elements(bytes) => {
                    let (kind, before) = match bytes {
                        1 => (glow::UNSIGNED_BYTE, 0),
                        2 => (glow::UNSIGNED_SHORT, 6 * all),
                        _ => (glow::UNSIGNED_INT, 18 * all),
                    };
                    gl.draw_elements(glow::TRIANGLES, 6 * count, kind, before + 6 * first * bytes as i32);
                }
                Drawing::Based => {
                    let (kind, before) = (glow::UNSIGNED_SHORT, 6 * all);
                    gl.draw_elements_base_vertex(glow::TRIANGLES, 6 * count, kind, before, 4 * first);
                }
            }
        }
    }
}

/// Bits of glClear and glBlitFramebuffer.
fn mask(bits: [bool; 3]) -> u32 {
    let names = [glow::COLOR_BUFFER_BIT, glow::DEPTH_BUFFER_BIT, glow::STENCIL_BUFFER_BIT];
    bits.into_iter().zip(names).filter(|(on, _)| *on).fold(0, |mask, (_, bit)| mask | bit)
}

impl Drop for Player<'_> {
    fn drop(&mut self) {
        let gl = self.gl;
        // SAFETY: the objects are the player's own and are not used again; the rest sets state.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, None);
            gl.bind_vertex_array(None);
            gl.use_program(None);
            gl.bind_buffer(glow::ARRAY_BUFFER, None);
            for unit in 0..super::UNITS {
                gl.bind_sampler(unit, None);
            }
            gl.active_texture(glow::TEXTURE0);
            self.restore_packing();
            gl.disable(glow::CLIP_DISTANCE0);
            let off = [glow::SCISSOR_TEST, glow::BLEND, glow::CULL_FACE, glow::STENCIL_TEST, glow::POLYGON_OFFSET_FILL];
            off.into_iter().for_each(|what| gl.disable(what));
            gl.color_mask(true, true, true, true);
            gl.depth_mask(true);
            gl.stencil_mask(!0);
            gl.depth_range(0.0, 1.0);
            self.textures.iter().flatten().for_each(|(name, _)| gl.delete_texture(*name));
            self.renderbuffers.iter().flatten().for_each(|name| gl.delete_renderbuffer(*name));
            self.framebuffers.iter().flatten().for_each(|name| gl.delete_framebuffer(*name));
            self.samplers.iter().for_each(|name| gl.delete_sampler(*name));
            for (array, buffer) in &self.arrays {
                gl.delete_vertex_array(*array);
                gl.delete_buffer(*buffer);
            }
            gl.delete_buffer(self.pixels);
            gl.delete_buffer(self.indices);
            gl.delete_query(self.query);
        }
    }
}

const _: () = assert!(OUTPUTS == 2, "draw buffers of the player");
