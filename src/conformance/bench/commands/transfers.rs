//! Pixels between the client, buffer objects and images, in every layout.

use glow::HasContext;

use super::super::GlShape;
use super::{Packing, Player};

/// Bytes of memory that nothing writes.
pub const UNTOUCHED: u8 = 0xA5;

impl Player<'_> {
    /// # Safety
    ///
    /// The context is current; the area lies within the level, and `bytes` are those of the packing.
    pub(super) unsafe fn upload(
        &mut self,
        slot: usize,
        [level, layer]: [u32; 2],
        area: [u32; 4],
        packing: Packing,
        bytes: &[u8],
        anew: bool,
    ) {
        let gl = self.gl;
        let [x, y, width, height] = area.map(|side| side as i32);
        let ([format, kind], level) = (packing.layout, level as i32);
        // SAFETY: as the caller promises.
        unsafe {
            let target = self.bind_texture(slot);
            let Some((_, desc)) = self.textures[slot] else { return };
            let (shape, (internal, ..)) = (desc.shape, desc.format.codes());
            store(gl, packing, true);
            if packing.buffer.is_some() {
                gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, Some(self.pixels));
                gl.buffer_data_u8_slice(glow::PIXEL_UNPACK_BUFFER, bytes, glow::STREAM_DRAW);
            }
            let pixels = match packing.buffer {
                Some(offset) => glow::PixelUnpackData::BufferOffset(offset),
                None => glow::PixelUnpackData::Slice(Some(bytes)),
            };
            if anew {
                let (place, internal) = (shape.place(layer), internal as i32);
                gl.tex_image_2d(place, level, internal, width, height, 0, format, kind, pixels);
            } else if shape == GlShape::Array {
                let layer = layer as i32;
                gl.tex_sub_image_3d(target, level, x, y, layer, width, height, 1, format, kind, pixels);
            } else {
                gl.tex_sub_image_2d(shape.place(layer), level, x, y, width, height, format, kind, pixels);
            }
            if packing.buffer.is_some() {
                gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            }
        }
    }

    /// # Safety
    ///
    /// The context is current, and the framebuffer that is bound for reading has what is read.
    pub(super) unsafe fn read(&mut self, area: [i32; 4], packing: Packing) -> Vec<u8> {
        let gl = self.gl;
        let ([x, y, width, height], [format, kind]) = (area, packing.layout);
        let mut bytes = vec![UNTOUCHED; packing.bytes([width as u32, height as u32])];
        // SAFETY: as the caller promises; there is room for all rows.
        unsafe {
            store(gl, packing, false);
            if let Some(offset) = packing.buffer {
                gl.bind_buffer(glow::PIXEL_PACK_BUFFER, Some(self.pixels));
                gl.buffer_data_u8_slice(glow::PIXEL_PACK_BUFFER, &bytes, glow::STREAM_READ);
                gl.read_pixels(x, y, width, height, format, kind, glow::PixelPackData::BufferOffset(offset));
                gl.get_buffer_sub_data(glow::PIXEL_PACK_BUFFER, 0, &mut bytes);
                gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            } else {
                gl.read_pixels(x, y, width, height, format, kind, glow::PixelPackData::Slice(Some(&mut bytes)));
            }
        }
        bytes
    }

    /// Sets the layout of the client's memory as the bench expects it.
    ///
    /// # Safety
    ///
    /// The context is current.
    pub(super) unsafe fn restore_packing(&self) {
        let plain = Packing { layout: [glow::RGBA, glow::FLOAT], alignment: 1, row: 0, skip: [0; 2], buffer: None };
        // SAFETY: as the caller promises.
        unsafe { [true, false].into_iter().for_each(|unpack| store(self.gl, plain, unpack)) };
    }
}

/// # Safety
///
/// The context is current.
unsafe fn store(gl: &glow::Context, packing: Packing, unpack: bool) {
    let Packing { alignment, row, skip: [pixels, rows], .. } = packing;
    let names = if unpack {
        [glow::UNPACK_ALIGNMENT, glow::UNPACK_ROW_LENGTH, glow::UNPACK_SKIP_PIXELS, glow::UNPACK_SKIP_ROWS]
    } else {
        [glow::PACK_ALIGNMENT, glow::PACK_ROW_LENGTH, glow::PACK_SKIP_PIXELS, glow::PACK_SKIP_ROWS]
    };
    // SAFETY: as the caller promises; only state is set.
    unsafe {
        for (name, value) in names.into_iter().zip([alignment, row, pixels, rows]) {
            gl.pixel_store_i32(name, value as i32);
        }
    }
}
