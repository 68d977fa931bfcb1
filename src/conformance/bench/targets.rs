//! Framebuffers of several colour images: which of them are drawn into, cleared and read [GL 4.6, 17.4.1, 18.2.1].

use std::rc::Rc;

use glow::HasContext;

use super::attach::GlPlace;
use super::format::GlFormat;
use super::surface::Surface;
use super::{Bench, Error};

impl Bench {
    /// A framebuffer of new images: one for each of `colors`, at the colour attachments in turn.
    ///
    /// # Errors
    ///
    /// As [`surface`](Self::surface).
    pub fn several(&self, size: [u32; 2], colors: &[GlFormat]) -> Result<Surface, Error> {
        self.several_with(size, colors, None)
    }

    /// The same, with a depth image.
    ///
    /// # Errors
    ///
    /// As [`surface`](Self::surface).
    pub fn several_with(&self, size: [u32; 2], colors: &[GlFormat], depth: Option<GlFormat>) -> Result<Surface, Error> {
        let images =
            colors.iter().map(|format| self.image(*format, size).map(Rc::new)).collect::<Result<Vec<_>, _>>()?;
        let depth = depth.map(|format| self.image(format, size).map(Rc::new)).transpose()?;
        let mut surface = self.surface_at(images.first().map(GlPlace::whole), depth.as_ref().map(GlPlace::whole))?;
        // SAFETY: the context is current; the images live as long as the surface.
        let status = unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(surface.name));
            for (point, image) in (glow::COLOR_ATTACHMENT0..).zip(&images).skip(1) {
                self.gl.framebuffer_texture_2d(glow::FRAMEBUFFER, point, glow::TEXTURE_2D, Some(image.name), 0);
            }
            self.gl.check_framebuffer_status(glow::FRAMEBUFFER)
        };
        surface.others = images.into_iter().skip(1).collect();
        self.check("a framebuffer of several images")?;
        match status {
            glow::FRAMEBUFFER_COMPLETE => Ok(surface),
            status => {
                let format = colors.last().map_or("nothing", |format| format.name());
                Err(Error::Refused { format, reason: format!("framebuffer status {status:#06x}") })
            }
        }
    }
}

impl Surface {
    /// glDrawBuffers: the colour attachment of each output; `None`: GL_NONE.
    pub fn draw_to(&self, outputs: &[Option<u32>]) {
        let code = |output: &Option<u32>| output.map_or(glow::NONE, |index| glow::COLOR_ATTACHMENT0 + index);
        let buffers: Vec<u32> = outputs.iter().map(code).collect();
        // SAFETY: the context is current; sets the framebuffer's state.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.name));
            self.gl.draw_buffers(&buffers);
        }
    }

    /// glReadBuffer: the colour attachment that is read from now on.
    pub fn read_from(&self, index: u32) {
        // SAFETY: as above.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.name));
            self.gl.read_buffer(glow::COLOR_ATTACHMENT0 + index);
        }
    }

    /// glClearBufferfv of the draw buffer of one output, all of it.
    pub fn clear_output(&self, output: u32, color: [f32; 4]) {
        // SAFETY: as above; four numbers are read.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.name));
            self.gl.disable(glow::SCISSOR_TEST);
            self.gl.color_mask(true, true, true, true);
            self.gl.clear_buffer_f32_slice(glow::COLOR, output, &color);
        }
    }
}
