//! The player: calls of each command, and the textures that commands name by slots.

use std::rc::Rc;

use glow::HasContext;

use super::super::fixed_function::FixedBench;
use super::super::{Bench, Error, Surface, no};
use super::{FixedCommand, FixedGiven, FixedTexture};
use crate::context::compatibility::{Binding, raw};

/// Display lists.
pub const LISTS: u32 = 3;

/// Bytes before the indices as unsigned integers: more than 16 bits count.
pub const FIRST_INDEX: usize = 70_000;

/// Textures and lists, deleted on drop.
pub struct FixedPlayer<'a> {
    bench: &'a Bench,
    pub(super) gl: Rc<glow::Context>,
    pub(super) fixed: &'a FixedBench,
    textures: Vec<(u32, glow::Texture)>,
    lists: u32,
    /// Indices 0, 1, 2 and on, as bytes.
    pub(super) indices: glow::Buffer,
    /// The same as unsigned integers, from [`FIRST_INDEX`] on.
    pub(super) wide_indices: glow::Buffer,
    /// Buffers of a draw's attributes: position, colour, secondary colour, normal, fog, coordinates of each unit.
    pub(super) arrays: Vec<glow::Buffer>,
    /// Arrays that are enabled.
    pub(super) enabled: FixedGiven,
}

impl FixedBench {
    /// A player with these textures that draws into a surface.
    ///
    /// # Errors
    ///
    /// Objects that the driver does not make.
    pub fn player<'a>(
        &'a self,
        bench: &'a Bench,
        surface: &Surface,
        textures: &[FixedTexture],
    ) -> Result<FixedPlayer<'a>, Error> {
        let gl = bench.raw().clone();
        // SAFETY: the context is current; the buffer is deleted on drop.
        let buffer = || unsafe { gl.create_buffer().map_err(no("buffer")) };
        let arrays = (0..5 + super::FIXED_UNITS).map(|_| buffer()).collect::<Result<Vec<_>, _>>()?;
        let (indices, wide_indices) = (buffer()?, buffer()?);
        let mut player = FixedPlayer {
            bench,
            indices,
            wide_indices,
            arrays,
            gl: gl.clone(),
            fixed: self,
            textures: Vec::new(),
            // SAFETY: the context is current; the names are deleted on drop.
            lists: unsafe { self.binding().GenLists(LISTS as i32) },
            enabled: FixedGiven::default(),
        };
        bench.prepare(surface, super::super::GlState { depth: None, ..super::super::GlState::WRITE });
        // SAFETY: the context is current; texels fill each image, and no unpack buffer is bound.
        unsafe {
            gl.use_program(None);
            gl.bind_vertex_array(None);
            gl.bind_buffer(glow::ARRAY_BUFFER, None);
            let all: Vec<u8> = (0..=u8::MAX).collect();
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(indices));
            gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, &all, glow::STATIC_DRAW);
            let wide: Vec<u8> = (0..u32::from(u8::MAX)).flat_map(u32::to_ne_bytes).collect();
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(wide_indices));
            let before = vec![0; FIRST_INDEX];
            gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, &[before, wide].concat(), glow::STATIC_DRAW);
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, None);
            gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 4);
            for unit in 0..super::FIXED_UNITS as u32 {
                gl.bind_sampler(unit, None);
            }
            gl.active_texture(glow::TEXTURE0);
            for texture in textures {
                let name = gl.create_texture().map_err(no("texture"))?;
                player.textures.push((texture.target, name));
                gl.bind_texture(texture.target, Some(name));
                upload(&gl, texture);
            }
        }
        bench.check("textures of every format")?;
        Ok(player)
    }
}

/// # Safety
///
/// The context is current, and the texture is bound.
unsafe fn upload(gl: &glow::Context, texture: &FixedTexture) {
    let FixedTexture { target, format, size: [width, height, depth], texels, depths } = texture;
    let (width, height, depth) = (*width as i32, *height as i32, *depth as i32);
    let (layout, kind, bytes): (u32, u32, &[u8]) = if depths.is_empty() {
        (glow::RGBA, glow::UNSIGNED_BYTE, texels.as_flattened())
    } else {
        (glow::DEPTH_COMPONENT, glow::FLOAT, bytemuck::cast_slice(depths))
    };
    let internal = *format as i32;
    let data = |from: usize, count: usize| glow::PixelUnpackData::Slice(Some(&bytes[from..from + count]));
    // SAFETY: as the caller promises; the texels of each image are as many as its size says.
    unsafe {
        match *target {
            glow::TEXTURE_1D => {
                gl.tex_image_1d(*target, 0, internal, width, 0, layout, kind, data(0, bytes.len()));
            }
            glow::TEXTURE_3D => {
                gl.tex_image_3d(*target, 0, internal, width, height, depth, 0, layout, kind, data(0, bytes.len()));
            }
            glow::TEXTURE_CUBE_MAP => {
                let part = bytes.len() / 6;
                for face in 0..6 {
                    let place = glow::TEXTURE_CUBE_MAP_POSITIVE_X + face;
                    let texels = data(face as usize * part, part);
                    gl.tex_image_2d(place, 0, internal, width, height, 0, layout, kind, texels);
                }
            }
            _ => gl.tex_image_2d(*target, 0, internal, width, height, 0, layout, kind, data(0, bytes.len())),
        }
        for (name, value) in [
            (glow::TEXTURE_MIN_FILTER, glow::NEAREST),
            (glow::TEXTURE_MAG_FILTER, glow::NEAREST),
            (glow::TEXTURE_WRAP_S, glow::REPEAT),
            (glow::TEXTURE_WRAP_T, glow::REPEAT),
            (glow::TEXTURE_WRAP_R, glow::REPEAT),
        ] {
            gl.tex_parameter_i32(*target, name, value as i32);
        }
    }
}

impl FixedPlayer<'_> {
    pub(super) fn binding(&self) -> &Binding {
        self.fixed.binding()
    }

    /// Plays commands.
    ///
    /// # Errors
    ///
    /// GL's errors.
    pub fn play_all(&mut self, commands: &[FixedCommand]) -> Result<(), Error> {
        for command in commands {
            self.give(command);
        }
        self.bench.check("a command of the fixed-function pipeline")
    }

    /// Plays one command.
    ///
    /// # Errors
    ///
    /// GL's errors.
    pub fn play(&mut self, command: &FixedCommand) -> Result<(), Error> {
        self.give(command);
        self.bench.check("a command of the fixed-function pipeline")
    }

    fn give(&mut self, command: &FixedCommand) {
        match command {
            FixedCommand::Draw(figure) => self.draw(figure),
            FixedCommand::NewList(slot, commands) => {
                // SAFETY: the context is current; the list is the player's own.
                unsafe { self.binding().NewList(self.lists + *slot as u32, raw::COMPILE) };
                for command in commands {
                    self.give(command);
                }
                // SAFETY: as above.
                unsafe { self.binding().EndList() };
            }
            command => self.set(command),
        }
    }

    /// Has the driver look at the current values. Those that Mesa 22.3.6 has not looked at since they were set overwrite what
    /// glPopAttrib gives back, and a material misses them whose tracking ends.
    fn settle(&self) {
        let mut color = [0.0; 4];
        // SAFETY: the context is current; four numbers are written.
        unsafe { self.gl.get_parameter_f32_slice(raw::CURRENT_COLOR, &mut color) };
    }

    fn set(&self, command: &FixedCommand) {
        let (gl, fixed) = (&self.gl, self.binding());
        let environment = raw::TEXTURE_ENV;
        // SAFETY: the context is current; each call reads as many numbers as the command has.
        unsafe {
            match *command {
                FixedCommand::Switch(raw::COLOR_MATERIAL, on) => {
                    self.settle();
                    if on { gl.enable(raw::COLOR_MATERIAL) } else { gl.disable(raw::COLOR_MATERIAL) }
                }
                FixedCommand::Switch(what, true) => gl.enable(what),
                FixedCommand::Switch(what, false) => gl.disable(what),
                FixedCommand::ActiveTexture(unit) => gl.active_texture(glow::TEXTURE0 + unit),
                FixedCommand::Texture(slot) => {
                    let (target, name) = self.textures[slot];
                    gl.bind_texture(target, Some(name));
                }
                FixedCommand::TexParameter(target, name, value) => gl.tex_parameter_i32(target, name, value),
                FixedCommand::TexEnv(name, value) => fixed.TexEnvi(environment, name, value),
                FixedCommand::TexEnvScale(name, value) => fixed.TexEnvf(environment, name, value),
                FixedCommand::TexEnvColor(color) => {
                    fixed.TexEnvfv(environment, raw::TEXTURE_ENV_COLOR, color.as_ptr());
                }
                FixedCommand::TexGenMode(coordinate, mode) => {
                    fixed.TexGeni(coordinate, raw::TEXTURE_GEN_MODE, mode as i32);
                }
                FixedCommand::TexGenPlane(coordinate, name, plane, false) => {
                    fixed.TexGenfv(coordinate, name, plane.as_ptr());
                }
                FixedCommand::TexGenPlane(coordinate, name, plane, true) => {
                    fixed.TexGendv(coordinate, name, plane.map(f64::from).as_ptr());
                }
                FixedCommand::MatrixMode(mode) => fixed.MatrixMode(mode),
                FixedCommand::LoadIdentity => fixed.LoadIdentity(),
                FixedCommand::LoadMatrix(matrix) => fixed.LoadMatrixf(matrix.as_ptr()),
                FixedCommand::MultMatrix(matrix) => fixed.MultMatrixf(matrix.as_ptr()),
                FixedCommand::Translate([x, y, z]) => fixed.Translatef(x, y, z),
                FixedCommand::Scale([x, y, z]) => fixed.Scalef(x, y, z),
                FixedCommand::Rotate(degrees, [x, y, z]) => fixed.Rotatef(degrees, x, y, z),
                FixedCommand::PushMatrix => fixed.PushMatrix(),
                FixedCommand::PopMatrix => fixed.PopMatrix(),
                FixedCommand::Light(light, name, values) => {
                    fixed.Lightfv(raw::LIGHT0 + light, name, values.as_ptr());
                }
                FixedCommand::LightNumber(light, name, value) => fixed.Lightf(raw::LIGHT0 + light, name, value),
                FixedCommand::LightModel(name, value) => fixed.LightModeli(name, value),
                FixedCommand::SceneAmbient(color) => fixed.LightModelfv(raw::LIGHT_MODEL_AMBIENT, color.as_ptr()),
                FixedCommand::Material(face, name, color) => fixed.Materialfv(face, name, color.as_ptr()),
                FixedCommand::Shininess(face, value) => fixed.Materialf(face, raw::SHININESS, value),
                FixedCommand::ColorMaterial(face, name) => {
                    self.settle();
                    fixed.ColorMaterial(face, name);
                }
                FixedCommand::ShadeModel(mode) => fixed.ShadeModel(mode),
                FixedCommand::FrontFace(mode) => gl.front_face(mode),
                FixedCommand::Fog(name, value) => fixed.Fogi(name, value),
                FixedCommand::FogNumber(name, value) => fixed.Fogf(name, value),
                FixedCommand::FogColor(color) => fixed.Fogfv(raw::FOG_COLOR, color.as_ptr()),
                FixedCommand::AlphaFunc(function, reference) => fixed.AlphaFunc(function, reference),
                FixedCommand::ClipPlane(index, plane) => fixed.ClipPlane(raw::CLIP_PLANE0 + index, plane.as_ptr()),
                FixedCommand::PushAttrib(mask) => {
                    self.settle();
                    fixed.PushAttrib(mask);
                }
                FixedCommand::PopAttrib => {
                    self.settle();
                    fixed.PopAttrib();
                }
                FixedCommand::Color(color) => self.color(color),
                FixedCommand::SecondaryColor([red, green, blue]) => fixed.SecondaryColor3f(red, green, blue),
                FixedCommand::Normal([x, y, z]) => fixed.Normal3f(x, y, z),
                FixedCommand::FogCoord(value) => fixed.FogCoordf(value),
                FixedCommand::MultiTexCoord(unit, values) => self.coordinates(unit, values),
                FixedCommand::CallList(slot) => fixed.CallList(self.lists + slot as u32),
                FixedCommand::Clear([red, green, blue, alpha]) => {
                    gl.clear_color(red, green, blue, alpha);
                    gl.clear(glow::COLOR_BUFFER_BIT);
                }
                FixedCommand::NewList(..) | FixedCommand::Draw(_) => {}
            }
        }
    }
}

impl Drop for FixedPlayer<'_> {
    fn drop(&mut self) {
        // SAFETY: the objects are the player's own and are not used again.
        unsafe {
            self.enable(FixedGiven::default());
            for (_, name) in self.textures.drain(..) {
                self.gl.delete_texture(name);
            }
            self.binding().DeleteLists(self.lists, LISTS as i32);
            for buffer in self.arrays.drain(..).chain([self.indices, self.wide_indices]) {
                self.gl.delete_buffer(buffer);
            }
            self.gl.active_texture(glow::TEXTURE0);
        }
    }
}
