//! Faults of glReadPixels write no more than GL does: what lies behind the caller's memory is another's.

use std::rc::Rc;

use glow::HasContext;

use super::*;

/// Formats and types that are read, with the bytes of a pixel.
const LAYOUTS: [([u32; 2], usize); 10] = [
    ([glow::RGBA, glow::UNSIGNED_BYTE], 4),
    ([glow::RGBA, glow::FLOAT], 16),
    ([glow::RGB, glow::UNSIGNED_BYTE], 3),
    ([glow::RED, glow::UNSIGNED_BYTE], 1),
    ([glow::RED, glow::FLOAT], 4),
    ([glow::DEPTH_COMPONENT, glow::UNSIGNED_SHORT], 2),
    ([glow::DEPTH_COMPONENT, glow::UNSIGNED_INT], 4),
    ([glow::DEPTH_COMPONENT, glow::FLOAT], 4),
    ([glow::DEPTH_STENCIL, glow::UNSIGNED_INT_24_8], 4),
    ([glow::STENCIL_INDEX, glow::UNSIGNED_BYTE], 1),
];

/// Width and height, more than 64 KiB in some layouts and no block of theirs.
const SIZE: [i32; 2] = [203, 101];

/// Reads each layout into memory with a mark behind it; those whose mark is gone.
fn beyond(context: &Rc<dyn glumbra::context::Context>) -> Vec<[u32; 2]> {
    const MARK: [u8; 4096] = [0xA5; 4096];
    let gl = context.gl();
    let [width, height] = SIZE;
    // SAFETY: the context is current; each slice has more bytes than are read.
    unsafe {
        let framebuffer = gl.create_framebuffer().unwrap();
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        for (point, format) in
            [(glow::COLOR_ATTACHMENT0, glow::RGBA8), (glow::DEPTH_STENCIL_ATTACHMENT, glow::DEPTH24_STENCIL8)]
        {
            let buffer = gl.create_renderbuffer().unwrap();
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
            gl.renderbuffer_storage(glow::RENDERBUFFER, format, width, height);
            gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, point, glow::RENDERBUFFER, Some(buffer));
        }
        gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
        let is_over = |([format, kind], size): &([u32; 2], usize)| {
            let length = size * (width * height) as usize;
            let mut bytes = [vec![0; length], MARK.to_vec()].concat();
            let into = glow::PixelPackData::Slice(Some(&mut bytes));
            gl.read_pixels(0, 0, width, height, *format, *kind, into);
            bytes[length..] != MARK
        };
        LAYOUTS.into_iter().filter(is_over).map(|(layout, _)| layout).collect()
    }
}

#[test]
fn faults_of_reading_write_no_more_than_is_read() {
    let faults: Vec<_> = faults::all().filter(|fault| fault.changes().any(|name| name == "glReadPixels")).collect();
    assert!(faults.len() >= 10, "{}", faults.len());
    let over = |fault: &&Fault| {
        let over = beyond(&judge::context(Some(fault)));
        (!over.is_empty()).then(|| format!("{}: {over:x?}", fault.name))
    };
    let wrong: Vec<_> = faults.iter().filter_map(over).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}
