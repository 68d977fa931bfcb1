//! Render target of the bench: a framebuffer with its attachments; clears, exact read-back.

use std::rc::Rc;

use glow::HasContext;

use super::format::{Encoding, GlFormat};
use super::image::GlImage;
use super::{Bench, Error};

/// Texels that a framebuffer has: of an image, or of a renderbuffer.
pub(super) enum Storage {
    Image(Rc<GlImage>),
    Renderbuffer(Renderbuffer),
}

/// A renderbuffer, deleted on drop.
pub(super) struct Renderbuffer {
    pub(super) gl: Rc<glow::Context>,
    pub(super) name: glow::Renderbuffer,
}

impl Drop for Renderbuffer {
    fn drop(&mut self) {
        // SAFETY: the renderbuffer is its own and is not used again.
        unsafe { self.gl.delete_renderbuffer(self.name) };
    }
}

/// An attachment, and how it is read.
pub(super) struct Attached {
    pub(super) storage: Storage,
    pub(super) format: GlFormat,
    pub(super) encoding: Encoding,
}

impl Attached {
    fn image(&self) -> Option<&GlImage> {
        if let Storage::Image(image) = &self.storage { Some(image) } else { None }
    }
}

/// A framebuffer and its attachments, deleted on drop.
pub struct Surface {
    pub(super) gl: Rc<glow::Context>,
    pub(crate) name: glow::Framebuffer,
    pub size: [u32; 2],
    pub(super) color: Option<Attached>,
    pub(super) depth: Option<Attached>,
    /// Colour images behind the first.
    pub(super) others: Vec<Rc<GlImage>>,
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: the framebuffer is the surface's own and is not used again.
        unsafe { self.gl.delete_framebuffer(self.name) };
    }
}

impl Bench {
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
            let point = if stencil { glow::DEPTH_STENCIL_ATTACHMENT } else { glow::DEPTH_ATTACHMENT };
            gl.framebuffer_texture_2d(glow::FRAMEBUFFER, point, glow::TEXTURE_2D, Some(image.name), 0);
            gl.draw_buffer(glow::NONE);
            gl.read_buffer(glow::NONE);
            let area = [0, 0, image.size[0] as i32, image.size[1] as i32];
            let depths = read_depths(gl, image.format, image.encoding, area);
            gl.delete_framebuffer(name);
            self.check("reading depths")?;
            Ok(depths)
        }
    }
}

impl Surface {
    /// The colour image.
    pub fn color_image(&self) -> Option<&GlImage> {
        self.color.as_ref().and_then(Attached::image)
    }

    /// The depth image.
    pub fn depth_image(&self) -> Option<&GlImage> {
        self.depth.as_ref().and_then(Attached::image)
    }

    /// Encoding of depth.
    pub fn depth_encoding(&self) -> Option<Encoding> {
        self.depth.as_ref().map(|depth| depth.encoding)
    }

    /// All of it: x, y, width, height.
    pub fn whole(&self) -> [i32; 4] {
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
        let Some(depth) = &self.depth else { return Vec::new() };
        // SAFETY: the context is current, and the framebuffer has the image.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.name));
            read_depths(&self.gl, depth.format, depth.encoding, area)
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

pub(super) unsafe fn read_pixels(
    gl: &glow::Context,
    [x, y, width, height]: [i32; 4],
    format: u32,
    kind: u32,
    bytes: &mut [u8],
) {
    // SAFETY: as the caller's: a framebuffer is bound, and the rectangle's pixels fill `bytes`.
    unsafe {
        gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
        gl.read_pixels(x, y, width, height, format, kind, glow::PixelPackData::Slice(Some(bytes)));
    }
}

/// Exactly: packed formats as they are stored; what has at most 24 bits as a float that rounds to the one code; more as
/// an integer.
unsafe fn read_depths(gl: &glow::Context, format: GlFormat, encoding: Encoding, area: [i32; 4]) -> Vec<f64> {
    let count = area[2].max(0) as usize * area[3].max(0) as usize;
    let packed = format.has_stencil() && !encoding.float && encoding.bits == 24;
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
