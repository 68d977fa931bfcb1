//! Render target of the bench: a framebuffer with its own images; clears, exact read-back, copies.

use std::rc::Rc;

use glow::HasContext;

use super::image::{GlFormat, GlImage};
use super::mutation::Mutation;
use super::{Bench, Error};

/// A framebuffer and its attachments, deleted on drop.
pub struct Surface {
    gl: Rc<glow::Context>,
    pub(crate) name: glow::Framebuffer,
    pub size: [u32; 2],
    color: Option<GlImage>,
    depth: Option<GlImage>,
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: the framebuffer is the surface's own and is not used again.
        unsafe { self.gl.delete_framebuffer(self.name) };
    }
}

impl Bench {
    /// A framebuffer of new images; depth and stencil of one format.
    ///
    /// # Errors
    ///
    /// [`Error::Refused`] where the driver has no such image or framebuffer.
    pub fn surface(&self, size: [u32; 2], color: Option<GlFormat>, depth: Option<GlFormat>) -> Result<Surface, Error> {
        let image = |format: Option<GlFormat>| format.map(|format| self.image(format, size)).transpose();
        let (color, depth) = (image(color)?, image(depth)?);
        let gl = &self.gl;
        // SAFETY: the context is current; the textures are complete.
        let (surface, status) = unsafe {
            let name = gl.create_framebuffer().map_err(super::no("framebuffer"))?;
            let surface = Surface { gl: gl.clone(), name, size, color, depth };
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(name));
            attach(gl, glow::COLOR_ATTACHMENT0, surface.color.as_ref());
            let stencil = surface.depth.as_ref().is_some_and(|image| image.format.has_stencil());
            let point = if stencil { glow::DEPTH_STENCIL_ATTACHMENT } else { glow::DEPTH_ATTACHMENT };
            attach(gl, point, surface.depth.as_ref());
            let buffer = if surface.color.is_some() { glow::COLOR_ATTACHMENT0 } else { glow::NONE };
            gl.draw_buffer(buffer);
            gl.read_buffer(buffer);
            (surface, gl.check_framebuffer_status(glow::FRAMEBUFFER))
        };
        let format = depth_or_color(&surface);
        self.check("a framebuffer")?;
        match status {
            glow::FRAMEBUFFER_COMPLETE => Ok(surface),
            glow::FRAMEBUFFER_UNSUPPORTED => {
                Err(Error::Refused { format, reason: "GL_FRAMEBUFFER_UNSUPPORTED".to_owned() })
            }
            status => Err(Error::Refused { format, reason: format!("framebuffer status {status:#06x}") }),
        }
    }

    /// Tests whether a separate depth texture and stencil renderbuffer make a complete framebuffer.
    ///
    /// # Errors
    ///
    /// GL's, but not that of a framebuffer that it does not support.
    pub fn separate_stencil_is_complete(&self) -> Result<bool, Error> {
        let surface = self.surface([4, 4], None, Some(GlFormat::Depth24))?;
        let gl = &self.gl;
        // SAFETY: the context is current; the renderbuffer is deleted here.
        let status = unsafe {
            let buffer = gl.create_renderbuffer().map_err(super::no("renderbuffer"))?;
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
            gl.renderbuffer_storage(glow::RENDERBUFFER, glow::STENCIL_INDEX8, 4, 4);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name));
            let point = glow::STENCIL_ATTACHMENT;
            gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, point, glow::RENDERBUFFER, Some(buffer));
            let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
            gl.delete_renderbuffer(buffer);
            status
        };
        self.check("a stencil buffer of its own")?;
        Ok(status == glow::FRAMEBUFFER_COMPLETE)
    }

    /// glCopyTexSubImage2D from the surface's rectangle `from` (x, y, width, height) to `to` in `image`; GL's error, if
    /// it makes one, is the answer.
    pub fn copy_depth(&self, surface: &Surface, from: [i32; 4], image: &GlImage, to: [i32; 2]) -> Option<String> {
        self.take_errors();
        let [x, y, width, height] = from;
        let x = if self.mutation == Some(Mutation::CopyShifted) { x + 1 } else { x };
        // SAFETY: the context is current; both are not deleted. GL checks the rectangles.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name));
            self.gl.active_texture(glow::TEXTURE0);
            self.gl.bind_texture(glow::TEXTURE_2D, Some(image.name));
            self.gl.copy_tex_sub_image_2d(glow::TEXTURE_2D, 0, to[0], to[1], x, y, width, height);
        }
        self.take_errors()
    }

    /// The depths of an image, read through a framebuffer made for that.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn image_depths(&self, image: &GlImage) -> Result<Vec<f64>, Error> {
        let gl = &self.gl;
        // SAFETY: the context is current; the framebuffer is deleted here.
        unsafe {
            let name = gl.create_framebuffer().map_err(super::no("framebuffer"))?;
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(name));
            let stencil = image.format.has_stencil();
            attach(gl, if stencil { glow::DEPTH_STENCIL_ATTACHMENT } else { glow::DEPTH_ATTACHMENT }, Some(image));
            gl.draw_buffer(glow::NONE);
            gl.read_buffer(glow::NONE);
            let depths = read_depths(gl, image, [0, 0, image.size[0] as i32, image.size[1] as i32]);
            gl.delete_framebuffer(name);
            self.check("reading depths")?;
            Ok(depths)
        }
    }
}

fn depth_or_color(surface: &Surface) -> &'static str {
    surface.depth.as_ref().or(surface.color.as_ref()).map_or("nothing", |image| image.format.name())
}

unsafe fn attach(gl: &glow::Context, point: u32, image: Option<&GlImage>) {
    if let Some(image) = image {
        // SAFETY: as the caller's: a framebuffer is bound, the texture exists.
        unsafe { gl.framebuffer_texture_2d(glow::FRAMEBUFFER, point, glow::TEXTURE_2D, Some(image.name), 0) };
    }
}

impl Surface {
    /// The colour image.
    pub fn color_image(&self) -> Option<&GlImage> {
        self.color.as_ref()
    }

    /// The depth image.
    pub fn depth_image(&self) -> Option<&GlImage> {
        self.depth.as_ref()
    }

    fn whole(&self) -> [i32; 4] {
        [0, 0, self.size[0] as i32, self.size[1] as i32]
    }

    /// Binds, with all writes on, clears inside `area` alone, and gives the scissor up.
    fn clear(&self, area: Option<[i32; 4]>, mask: u32) {
        let gl = &self.gl;
        // SAFETY: the context is current; only state is set and the surface's own images are cleared.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.name));
            gl.depth_mask(true);
            gl.stencil_mask(!0);
            gl.color_mask(true, true, true, true);
            let [x, y, width, height] = area.unwrap_or(self.whole());
            gl.enable(glow::SCISSOR_TEST);
            gl.scissor(x, y, width, height);
            gl.clear(mask);
            gl.disable(glow::SCISSOR_TEST);
        }
    }

    pub fn clear_depth(&self, depth: f64) {
        self.clear_depth_in(None, depth);
    }

    /// In a rectangle: x, y, width, height.
    pub fn clear_depth_in(&self, area: Option<[i32; 4]>, depth: f64) {
        // SAFETY: sets state.
        unsafe { self.gl.clear_depth(depth) };
        self.clear(area, glow::DEPTH_BUFFER_BIT);
    }

    pub fn clear_stencil(&self, value: u8) {
        self.clear_stencil_in(None, value);
    }

    /// In a rectangle: x, y, width, height.
    pub fn clear_stencil_in(&self, area: Option<[i32; 4]>, value: u8) {
        // SAFETY: sets state.
        unsafe { self.gl.clear_stencil(i32::from(value)) };
        self.clear(area, glow::STENCIL_BUFFER_BIT);
    }

    pub fn clear_color(&self, color: [f32; 4]) {
        // SAFETY: sets state.
        unsafe {
            self.gl.disable(glow::FRAMEBUFFER_SRGB);
            self.gl.clear_color(color[0], color[1], color[2], color[3]);
        }
        self.clear(None, glow::COLOR_BUFFER_BIT);
    }

    /// Every stored depth, rows from below: exactly code / (2^bits - 1), or the float. Empty without a depth image.
    pub fn depths(&self) -> Vec<f64> {
        self.depths_in(self.whole())
    }

    /// Reads depths of a rectangle: x, y, width, height.
    pub fn depths_in(&self, area: [i32; 4]) -> Vec<f64> {
        let Some(image) = &self.depth else { return Vec::new() };
        // SAFETY: the context is current, and the framebuffer has the image.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.name));
            read_depths(&self.gl, image, area)
        }
    }

    /// Every stencil value, rows from below.
    pub fn stencils(&self) -> Vec<u8> {
        let mut values = vec![0; self.size[0] as usize * self.size[1] as usize];
        self.read(self.whole(), glow::STENCIL_INDEX, glow::UNSIGNED_BYTE, &mut values);
        values
    }

    /// Every colour of an 8-bit image, rows from below, as stored.
    pub fn colors(&self) -> Vec<[u8; 4]> {
        let mut values = vec![[0; 4]; self.size[0] as usize * self.size[1] as usize];
        self.read(self.whole(), glow::RGBA, glow::UNSIGNED_BYTE, values.as_flattened_mut());
        values
    }

    /// Every colour of a float image, rows from below.
    pub fn floats(&self) -> Vec<[f32; 4]> {
        let mut values = vec![[0.0_f32; 4]; self.size[0] as usize * self.size[1] as usize];
        self.read(self.whole(), glow::RGBA, glow::FLOAT, bytemuck::cast_slice_mut(&mut values));
        values
    }

    fn read(&self, area: [i32; 4], format: u32, kind: u32, bytes: &mut [u8]) {
        // SAFETY: the context is current; the rectangle's pixels fill `bytes`.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.name));
            read_pixels(&self.gl, area, format, kind, bytes);
        }
    }
}

unsafe fn read_pixels(gl: &glow::Context, [x, y, width, height]: [i32; 4], format: u32, kind: u32, bytes: &mut [u8]) {
    // SAFETY: as the caller's: a framebuffer is bound, and the rectangle's pixels fill `bytes`.
    unsafe {
        gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
        gl.read_pixels(x, y, width, height, format, kind, glow::PixelPackData::Slice(Some(bytes)));
    }
}

/// Exactly: packed formats as they are stored; what has at most 24 bits as a float that rounds to the one code; more as
/// an integer.
unsafe fn read_depths(gl: &glow::Context, image: &GlImage, area: [i32; 4]) -> Vec<f64> {
    let (encoding, count) = (image.encoding, area[2].max(0) as usize * area[3].max(0) as usize);
    let packed = image.format.has_stencil() && !encoding.float && encoding.bits == 24;
    let (format, kind) = match () {
        () if packed => (glow::DEPTH_STENCIL, glow::UNSIGNED_INT_24_8),
        () if !encoding.float && encoding.bits > 24 => (glow::DEPTH_COMPONENT, glow::UNSIGNED_INT),
        () => (glow::DEPTH_COMPONENT, glow::FLOAT),
    };
    let mut words = vec![0_u32; count];
    // SAFETY: as the caller's: a framebuffer with the image is bound; four bytes a pixel.
    unsafe { read_pixels(gl, area, format, kind, bytemuck::cast_slice_mut(&mut words)) };
    let most = encoding.most();
    let depth = |word: u32| match kind {
        glow::UNSIGNED_INT_24_8 => f64::from(word >> 8) / most,
        glow::UNSIGNED_INT => (f64::from(word) / f64::from(u32::MAX) * most).round() / most,
        _ if encoding.float => f64::from(f32::from_bits(word)),
        _ => (f64::from(f32::from_bits(word)) * most).round() / most,
    };
    words.into_iter().map(depth).collect()
}
