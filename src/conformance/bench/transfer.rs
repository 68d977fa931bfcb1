//! Transfers between framebuffers and images: copies, blits, and read-backs in the client's layout.

use glow::HasContext;

use super::image::GlImage;
use super::mutation::Mutation;
use super::surface::Surface;
use super::{Bench, Error};

/// Part of an image that a copy writes.
#[derive(Clone, Copy)]
pub struct GlCopyTo<'a> {
    pub image: &'a GlImage,
    pub level: u32,
    /// Layer or face.
    pub layer: u32,
    /// Lower left corner.
    pub at: [i32; 2],
}

/// A blit. Corners are x0, y0, x1, y1: exchanged ones turn the picture.
#[derive(Clone, Copy)]
pub struct GlBlit<'a> {
    pub from: &'a Surface,
    pub to: &'a Surface,
    pub corners: [[i32; 4]; 2],
    /// GL_COLOR_BUFFER_BIT and so on.
    pub mask: u32,
    /// LINEAR, of colour alone.
    pub linear: bool,
    /// x, y, width, height.
    pub scissor: Option<[i32; 4]>,
}

/// Layout of pixels that are read into the client's memory.
#[derive(Clone, Copy, Debug)]
pub struct GlReading {
    /// x, y, width, height.
    pub area: [i32; 4],
    /// Like GL_RGBA and GL_FLOAT.
    pub layout: [u32; 2],
    /// PACK_ALIGNMENT.
    pub alignment: u32,
    /// Bytes of all rows, with what alignment adds.
    pub bytes: usize,
}

impl Bench {
    /// glCopyTexSubImage2D from the surface's rectangle `from` (x, y, width, height) to `to` in `image`; GL's error, if
    /// it makes one, is the answer.
    pub fn copy_depth(&self, surface: &Surface, from: [i32; 4], image: &GlImage, to: [i32; 2]) -> Option<String> {
        self.copy(surface, from, GlCopyTo { image, level: 0, layer: 0, at: to })
    }

    /// The same to any level or face.
    pub fn copy(&self, surface: &Surface, from: [i32; 4], to: GlCopyTo) -> Option<String> {
        self.take_errors();
        let [x, y, width, height] = from;
        let x = if self.mutation == Some(Mutation::CopyShifted) { x + 1 } else { x };
        let (place, level) = (to.image.shape.place(to.layer), to.level as i32);
        // SAFETY: the context is current; both are not deleted. GL checks the rectangles.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name));
            self.gl.active_texture(glow::TEXTURE0);
            self.gl.bind_texture(to.image.shape.target(), Some(to.image.name));
            self.gl.copy_tex_sub_image_2d(place, level, to.at[0], to.at[1], x, y, width, height);
        }
        self.take_errors()
    }

    /// glCopyTexImage2D: makes a level, or a face's level, anew from a rectangle of the surface.
    pub fn copy_anew(&self, surface: &Surface, from: [i32; 4], to: GlCopyTo) -> Option<String> {
        self.take_errors();
        let [x, y, width, height] = from;
        let (internal, ..) = to.image.format.codes();
        let (place, level) = (to.image.shape.place(to.layer), to.level as i32);
        // SAFETY: as above.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name));
            self.gl.active_texture(glow::TEXTURE0);
            self.gl.bind_texture(to.image.shape.target(), Some(to.image.name));
            self.gl.copy_tex_image_2d(place, level, internal, x, y, width, height, 0);
        }
        self.take_errors()
    }

    /// glBlitFramebuffer; GL's error, if it makes one, is the answer.
    pub fn blit(&self, blit: &GlBlit) -> Option<String> {
        self.take_errors();
        let [[a, b, c, d], [e, f, g, h]] = blit.corners;
        let filter = if blit.linear { glow::LINEAR } else { glow::NEAREST };
        // SAFETY: the context is current; both framebuffers are not deleted.
        unsafe {
            self.gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(blit.from.name));
            self.gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(blit.to.name));
            match blit.scissor {
                Some([x, y, width, height]) => {
                    self.gl.enable(glow::SCISSOR_TEST);
                    self.gl.scissor(x, y, width, height);
                }
                None => self.gl.disable(glow::SCISSOR_TEST),
            }
            self.gl.blit_framebuffer(a, b, c, d, e, f, g, h, blit.mask, filter);
            self.gl.disable(glow::SCISSOR_TEST);
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(blit.to.name));
        }
        self.take_errors()
    }

    /// glReadPixels. Bytes that GL leaves alone are 0xA5.
    ///
    /// # Errors
    ///
    /// GL's.
    pub fn read_pixels(&self, surface: &Surface, reading: &GlReading) -> Result<Vec<u8>, Error> {
        let mut bytes = vec![0xA5; reading.bytes];
        let ([x, y, width, height], [format, kind]) = (reading.area, reading.layout);
        // SAFETY: the context is current; rows with their alignment fill the bytes.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name));
            self.gl.pixel_store_i32(glow::PACK_ALIGNMENT, reading.alignment as i32);
            let pixels = glow::PixelPackData::Slice(Some(&mut bytes));
            self.gl.read_pixels(x, y, width, height, format, kind, pixels);
            self.gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
        }
        self.check("glReadPixels")?;
        Ok(bytes)
    }
}
