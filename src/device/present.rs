//! From an image of the list to the window that the context belongs to, and back from the window.

use glow::HasContext;

use super::readback::flip_rows;
use super::{Device, Error, Pixels};
use crate::pass::{ImageId, PassList, Target};

impl Device {
    /// Copies an RGBA8 image of the list that was run last into the default framebuffer, texel by pixel from the lower
    /// left corner. `window` is the default framebuffer's size; what the image does not cover stays as it is.
    ///
    /// # Errors
    ///
    /// GL errors, and images that the driver cannot read.
    pub fn present(&mut self, list: &PassList, image: ImageId, window: [u32; 2]) -> Result<(), Error> {
        const LABEL: &str = "presenting";
        self.bind_target(list, LABEL, Target { color: Some(image), depth: None, level: 0 })?;
        let size = list.desc(image).size;
        let [width, height] = [0, 1].map(|axis| size[axis].min(window[axis]) as i32);
        unsafe {
            self.gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, None);
            self.gl.blit_framebuffer(0, 0, width, height, 0, 0, width, height, glow::COLOR_BUFFER_BIT, glow::NEAREST);
        }
        self.check(LABEL)
    }

    /// Reads the default framebuffer, before its buffers are swapped.
    ///
    /// # Errors
    ///
    /// GL errors.
    pub fn read_window(&mut self, size: [u32; 2]) -> Result<Pixels, Error> {
        unsafe { self.gl.bind_framebuffer(glow::FRAMEBUFFER, None) };
        let mut data = vec![0; 4 * size[0] as usize * size[1] as usize];
        self.read_into(size, glow::RGBA, glow::UNSIGNED_BYTE, &mut data);
        flip_rows(&mut data, 4 * size[0] as usize);
        self.check("reading the window")?;
        Ok(Pixels::Rgba8 { size, data })
    }
}
