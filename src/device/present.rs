//! From an image of the list to the window that the context belongs to, and back from the window.

use std::sync::Arc;

use glow::HasContext;

use super::readback::flip_rows;
use super::{Device, Error, Pixels, framebuffer, image};
use crate::geometry::Texture;
use crate::pass::{Format, ImageDesc, ImageId, PassList, Storage, Target};

impl Device {
    /// Copies an RGBA8 image of the list that was run last into the default framebuffer, texel by pixel from the lower
    /// left corner. `window` is the default framebuffer's size; what the image does not cover stays as it is.
    ///
    /// # Errors
    ///
    /// GL errors, and images that the driver cannot read.
    pub fn present(&mut self, list: &PassList, image: ImageId, window: [u32; 2]) -> Result<(), Error> {
        const LABEL: &str = "presenting";
        self.make_current()?;
        self.bind_target(list, LABEL, Target { color: Some(image), depth: None, level: 0, face: None })?;
        let size = list.desc(image).size;
        let [width, height] = [0, 1].map(|axis| size[axis].min(window[axis]) as i32);
        self.without_scissor();
        unsafe {
            self.gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, None);
            self.gl.blit_framebuffer(0, 0, width, height, 0, 0, width, height, glow::COLOR_BUFFER_BIT, glow::NEAREST);
        }
        self.check(LABEL)
    }

    /// Copies `sheet` into the default framebuffer, texel by pixel, `place` pixels from its left and upper edge. `window` is
    /// the default framebuffer's size; what does not fit at the right and below is cut off.
    ///
    /// # Errors
    ///
    /// GL errors.
    pub fn present_sheet(&mut self, sheet: &Arc<Texture>, place: [u32; 2], window: [u32; 2]) -> Result<(), Error> {
        const LABEL: &str = "presenting a sheet";
        self.make_current()?;
        let size = [sheet.width, sheet.height];
        let storage = Storage::Uploaded(sheet.clone());
        let desc = ImageDesc { label: sheet.name.clone(), size, format: Format::Rgba8, storage };
        let texture = image::create(&self.gl, &desc)?;
        let target = Target { color: Some(ImageId(0)), depth: None, level: 0, face: None };
        let describe = || (String::from(LABEL), desc.label.clone());
        self.without_scissor();
        let _read = framebuffer::create(&self.gl, Some(texture.name), None, target, describe)?;
        let room = [0, 1].map(|axis| window[axis].saturating_sub(place[axis]));
        let [width, height] = [0, 1].map(|axis| size[axis].min(room[axis]) as i32);
        let (left, top, rows) = (place[0] as i32, room[1] as i32, size[1] as i32);
        let (from, to) = ([0, rows - height, width, rows], [left, top - height, left + width, top]);
        unsafe {
            self.gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, None);
            let ([a, b, c, d], [e, f, g, h]) = (from, to);
            self.gl.blit_framebuffer(a, b, c, d, e, f, g, h, glow::COLOR_BUFFER_BIT, glow::NEAREST);
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        }
        self.check(LABEL)
    }

    /// A blit obeys the scissor test [GL 4.6, 18.3.1], which the last pass may have left on.
    fn without_scissor(&mut self) {
        self.state = None;
        unsafe { self.gl.disable(glow::SCISSOR_TEST) };
    }

    /// Reads the default framebuffer, before its buffers are swapped.
    ///
    /// # Errors
    ///
    /// GL errors.
    pub fn read_window(&mut self, size: [u32; 2]) -> Result<Pixels, Error> {
        self.make_current()?;
        unsafe { self.gl.bind_framebuffer(glow::FRAMEBUFFER, None) };
        let mut data = vec![0; 4 * size[0] as usize * size[1] as usize];
        self.read_into(size, glow::RGBA, glow::UNSIGNED_BYTE, &mut data);
        flip_rows(&mut data, 4 * size[0] as usize);
        self.check("reading the window")?;
        Ok(Pixels::Rgba8 { size, data })
    }
}
