//! Faults of framebuffers: attachments, buffers to draw to and to read, copies, blits, pixels that are read.

use super::fourth::bytes_of_pixel;
use super::{Call, hold, release};

/// Bytes of the pixels that glReadPixels writes without padding: a row's, and the rows. None of a layout that is not known: what
/// lies behind the caller's memory is nobody's.
fn pixels(call: &Call) -> (usize, usize) {
    (bytes_of_pixel(call.u(4), call.u(5)) * call.u(2) as usize, call.u(3) as usize)
}

/// Changes what glReadPixels has written.
fn read(call: &mut Call, change: fn(usize, &mut Vec<u8>)) {
    call.now();
    let (row, rows) = pixels(call);
    let mut bytes = call.bytes(6, row * rows);
    if row > 0 && !bytes.is_empty() {
        change(row, &mut bytes);
        call.write(6, &bytes);
    }
}

/// Other buffers for glDrawBuffers, from each output's number and buffer.
fn change_buffers(call: &mut Call, change: fn(u32, u32) -> u32) {
    let given = call.integers(1, call.u(0) as usize);
    let other = (0..).zip(given).map(|(output, buffer)| change(output, buffer as u32));
    call.set_bytes(1, &other.flat_map(u32::to_ne_bytes).collect::<Vec<_>>());
}

faults! {
    "attached-level-one-less" [glFramebufferTexture2D]
    "Level n is attached as level n - 1." { glFramebufferTexture2D => |call| call.set(4, (call.f(4) - 1.0).max(0.0)) }
    "attached-level-zero" [glFramebufferTexture2D]
    "Every level is attached as level 0." { glFramebufferTexture2D => |call| call.set(4, 0) }
    "layer-attached-by-first" [glFramebufferTexture]
    "A 1D texture is not attached." { glFramebufferTexture => |call| call.set(2, 0) }
    "packed-attaches-no-stencil" [GL_DEPTH_STENCIL_ATTACHMENT]
    "A packed image is attached without its stencil." {
        glFramebufferTexture2D glFramebufferRenderbuffer => |call| {
            call.replace(1, glow::DEPTH_STENCIL_ATTACHMENT, glow::DEPTH_ATTACHMENT);
        }
    }
    "packed-attaches-no-depth" [GL_DEPTH_STENCIL_ATTACHMENT GL_DEPTH_ATTACHMENT]
    "A packed image is attached without its depth." {
        glFramebufferTexture2D glFramebufferRenderbuffer => |call| {
            call.replace(1, glow::DEPTH_STENCIL_ATTACHMENT, glow::STENCIL_ATTACHMENT);
        }
    }
    "depth-not-attached" [glFramebufferTexture2D GL_DEPTH_ATTACHMENT]
    "Textures are not attached for depth." {
        glFramebufferTexture2D => |call| if call.u(1) == glow::DEPTH_ATTACHMENT { call.skip() }
    }
    "color-attached-as-second" [GL_COLOR_ATTACHMENT0 glFramebufferTexture2D]
    "The first colour image is attached as the second." {
        glFramebufferTexture2D => |call| { call.replace(1, glow::COLOR_ATTACHMENT0, glow::COLOR_ATTACHMENT1); }
    }
    "renderbuffer-binding-stays" [glBindRenderbuffer]
    "The first renderbuffer stays bound." {
        glBindRenderbuffer => |call| {
            if call.u(1) != 0 && call.kept((0, 0)) != 0.0 {
                call.skip();
            }
            call.keep((0, 0), 1.0);
        }
    }
    "renderbuffer-not-attached" [glFramebufferRenderbuffer]
    "Renderbuffers are not attached." { glFramebufferRenderbuffer => |call| call.skip() }
    "draw-buffer-none-ignored" [glDrawBuffers GL_NONE]
    "A framebuffer without buffers to draw to is incomplete." {
        glDrawBuffers => |call| call.skip();
        glDrawBuffer => |call| { call.replace(0, glow::NONE, glow::COLOR_ATTACHMENT0); };
        glReadBuffer => |call| { call.replace(0, glow::NONE, glow::COLOR_ATTACHMENT0); };
        glCheckFramebufferStatus => |call| {
            call.now();
            if call.attached(glow::COLOR_ATTACHMENT0, glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) == 0 {
                call.result = super::Value::Unsigned(glow::FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER);
            }
        }
    }
    "depth-alone-unsupported" [glCheckFramebufferStatus GL_FRAMEBUFFER_UNSUPPORTED]
    "A framebuffer of depth alone is unsupported." {
        glCheckFramebufferStatus => |call| {
            call.now();
            if call.attached(glow::COLOR_ATTACHMENT0, glow::FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) == 0 {
                call.result = super::Value::Unsigned(glow::FRAMEBUFFER_UNSUPPORTED);
            }
        }
    }
    "framebuffer-a-draw-late" [glBindFramebuffer]
    "Another framebuffer is drawn into from the second draw on." {
        glBindFramebuffer => hold;
        drawn clear glCheckFramebufferStatus glFramebufferTexture2D glReadPixels copy => release
    }
    "framebuffer-read-only" [glBindFramebuffer GL_FRAMEBUFFER GL_DRAW_FRAMEBUFFER]
    "Binding for drawing and reading binds for drawing alone." {
        glBindFramebuffer => |call| { call.replace(0, glow::FRAMEBUFFER, glow::DRAW_FRAMEBUFFER); }
    }
    "copy-one-texel-off" [glCopyTexSubImage2D]
    "Copies start one pixel to the right." { copy => |call| call.add(if call.name == "glCopyTexImage2D" { 3 } else { 4 }, 1.0) }
    "copy-one-row-off" [glCopyTexSubImage2D]
    "Copies start one pixel higher." { copy => |call| call.add(if call.name == "glCopyTexImage2D" { 4 } else { 5 }, 1.0) }
    "copy-last-column-missing" [glCopyTexSubImage2D]
    "Copies leave the last column out." { glCopyTexSubImage2D => |call| call.add(6, -1.0) }
    "copy-last-row-missing" [glCopyTexSubImage2D]
    "Copies leave the last row out." { glCopyTexSubImage2D => |call| call.add(7, -1.0) }
    "copy-ignored" [glCopyTexSubImage2D]
    "Nothing is copied." { glCopyTexSubImage2D => |call| call.skip() }
    "copy-ignored-for-cubes" [glCopyTexSubImage2D GL_TEXTURE_CUBE_MAP_POSITIVE_X]
    "Nothing is copied to cube maps." { glCopyTexSubImage2D => |call| if call.u(0) != glow::TEXTURE_2D { call.skip() } }
    "copy-a-draw-early" [glCopyTexSubImage2D]
    "A copy takes what the draw before the last one left." {
        copy => |call| {
            if call.kept((0, 0)) != 0.0 {
                call.skip();
            }
            let odd = 1.0 - call.kept((0, 0));
            call.keep((0, 0), odd);
        }
    }
    "colors-read-flipped" [glReadPixels]
    "Rows of colours are read from the last to the first." {
        glReadPixels => |call| if call.u(4) == glow::RGBA { read(call, |row, bytes| {
            *bytes = bytes.chunks(row).rev().flatten().copied().collect();
        }) }
    }
    "depths-read-flipped" [glReadPixels GL_DEPTH_COMPONENT]
    "Rows of depths are read from the last to the first." {
        glReadPixels => |call| if call.u(4) == glow::DEPTH_COMPONENT { read(call, |row, bytes| {
            *bytes = bytes.chunks(row).rev().flatten().copied().collect();
        }) }
    }
    "stencil-read-flipped" [glReadPixels GL_STENCIL_INDEX]
    "Rows of stencil values are read from the last to the first." {
        glReadPixels => |call| if call.u(4) == glow::STENCIL_INDEX { read(call, |row, bytes| {
            *bytes = bytes.chunks(row).rev().flatten().copied().collect();
        }) }
    }
    "red-and-blue-read-swapped" [glReadPixels GL_RGBA]
    "Red and blue are exchanged when they are read." { glReadPixels => |call| { call.replace(4, glow::RGBA, glow::BGRA); } }
    "read-one-pixel-off" [glReadPixels]
    "Pixels are read one to the right." { glReadPixels => |call| call.add(0, 1.0) }
    "rows-read-with-gaps" [glPixelStorei GL_PACK_ALIGNMENT]
    "Rows that are read start at whole words." {
        glReadPixels => |call| read(call, |row, bytes| {
            let stride = row.div_ceil(4) * 4;
            let rows: Vec<u8> = bytes.chunks(row).flat_map(|row| {
                row.iter().copied().chain(std::iter::repeat_n(0, stride - row.len()))
            }).collect();
            let length = bytes.len();
            bytes.copy_from_slice(&rows[..length]);
        })
    }
    "blit-flipped" [glBlitFramebuffer]
    "Blits turn the picture upside down." { glBlitFramebuffer => |call| call.swap(5, 7) }
    "blit-one-pixel-off" [glBlitFramebuffer GL_COLOR_BUFFER_BIT]
    "Blits go one pixel to the right." {
        glBlitFramebuffer => |call| {
            call.add(4, 1.0);
            call.add(6, 1.0);
        }
    }
    "copies-of-first-image" [glReadBuffer glCopyTexSubImage2D]
    "Copies take the first colour image, whatever the buffer that is read." {
        copy => |call| if call.get(glow::READ_BUFFER) as u32 > glow::COLOR_ATTACHMENT0 {
            let buffer = f64::from(call.get(glow::READ_BUFFER));
            call.other("glReadBuffer", &[f64::from(glow::COLOR_ATTACHMENT0)]);
            call.now();
            call.other("glReadBuffer", &[buffer]);
        }
    }
    "draw-buffers-in-order" [glDrawBuffers]
    "Outputs go to the images of their own numbers." {
        glDrawBuffers => |call| change_buffers(call, |output, buffer| if buffer == 0 { 0 } else { glow::COLOR_ATTACHMENT0 + output })
    }
    "draw-buffers-beyond-first-none" [glDrawBuffers]
    "Outputs beyond the first are drawn nowhere." {
        glDrawBuffers => |call| change_buffers(call, |output, buffer| if output == 0 { buffer } else { 0 })
    }
    "draw-buffers-without-none" [glDrawBuffers GL_NONE]
    "An output without an image is drawn into the first that none has." {
        glDrawBuffers => |call| {
            let given = call.integers(1, call.u(0) as usize);
            let free = (0..4_u32).map(|image| glow::COLOR_ATTACHMENT0 + image).find(|point| !given.contains(&(*point as i32)));
            if let (Some(free), Some(none)) = (free, given.iter().position(|buffer| *buffer == 0)) {
                let mut buffers = given;
                buffers[none] = free as i32;
                call.set_bytes(1, &buffers.into_iter().flat_map(i32::to_ne_bytes).collect::<Vec<_>>());
            }
        }
    }
    "clears-of-first-image" [glClearBufferfv]
    "glClearBufferfv clears the first output's image." { glClearBufferfv => |call| if call.u(0) == glow::COLOR { call.set(1, 0) } }
    "read-buffer-ignored" [glReadBuffer]
    "The buffer that is read stays as it was." { glReadBuffer => |call| call.skip() }
}
