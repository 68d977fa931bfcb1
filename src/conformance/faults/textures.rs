//! Faults of texture units, uploads, formats, levels and cube maps.

use super::Call;
use crate::context::DEPTH_COMPONENT32;

/// Faces +X and -X of cube maps.
const PAIR: [u32; 2] = [glow::TEXTURE_CUBE_MAP_POSITIVE_X, glow::TEXTURE_CUBE_MAP_NEGATIVE_X];

fn is_face(place: u32) -> bool {
    (glow::TEXTURE_CUBE_MAP_POSITIVE_X..=glow::TEXTURE_CUBE_MAP_NEGATIVE_Z).contains(&place)
}

/// Puts an internal format where another is wanted.
fn format(call: &mut Call, from: u32, to: u32) {
    call.replace(if call.name == "glRenderbufferStorage" { 1 } else { 2 }, from, to);
}

/// Other texels for an image of bytes; `change` is given the width in pixels and four bytes a pixel.
fn texels(call: &mut Call, change: fn(usize, &mut Vec<u8>)) {
    let (width, height) = (call.u(3) as usize, call.u(4) as usize);
    if call.u(7) != glow::UNSIGNED_BYTE && call.u(7) != glow::BYTE || call.u(6) != glow::RGBA {
        return;
    }
    let mut bytes = call.bytes(8, 4 * width * height);
    if !bytes.is_empty() {
        change(width, &mut bytes);
        call.set_bytes(8, &bytes);
    }
}

faults! {
    "active-texture-ignored" [glActiveTexture GL_TEXTURE0]
    "Unit 1 is unit 0." { glActiveTexture => |call| { call.replace(0, glow::TEXTURE1, glow::TEXTURE0); } }
    "texture-unit-stale" [glBindTexture]
    "A texture of unit 1 is bound from the second draw on." {
        glBindTexture => |call| if call.u(0) == glow::TEXTURE_2D && call.get(glow::ACTIVE_TEXTURE) as u32 == glow::TEXTURE1 {
            let before = call.kept((0, 0));
            call.keep((0, 0), call.f(1));
            if before != 0.0 && call.u(1) != 0 {
                call.set(1, before);
            }
        }
    }
    "cube-map-not-bound" [glBindTexture GL_TEXTURE_CUBE_MAP]
    "A cube map of a unit beyond the first is not bound." {
        glBindTexture => |call| if call.u(0) == glow::TEXTURE_CUBE_MAP && call.get(glow::ACTIVE_TEXTURE) as u32 != glow::TEXTURE0 {
            call.set(1, 0);
        }
    }
    "texels-flipped" [glTexImage2D GL_RGBA8]
    "Rows of 8-bit texels are kept from the last to the first." {
        glTexImage2D => |call| texels(call, |width, bytes| {
            let rows: Vec<u8> = bytes.chunks(4 * width).rev().flatten().copied().collect();
            *bytes = rows;
        })
    }
    "texels-one-row-late" [glTexImage2D]
    "Rows of 8-bit texels are kept one higher." {
        glTexImage2D => |call| texels(call, |width, bytes| bytes.rotate_right(4 * width))
    }
    "texels-one-column-late" [glTexImage2D]
    "8-bit texels are kept one to the right." {
        glTexImage2D => |call| texels(call, |width, bytes| bytes.chunks_mut(4 * width).for_each(|row| row.rotate_right(4)))
    }
    "texels-lose-alpha" [glTexImage2D GL_RGBA]
    "Alpha of 8-bit texels is 1." {
        glTexImage2D => |call| texels(call, |_, bytes| bytes.chunks_exact_mut(4).for_each(|texel| texel[3] = 0xFF))
    }
    "red-and-blue-swapped" [glTexImage2D GL_RGBA]
    "Red and blue of texels are exchanged." { glTexImage2D => |call| { call.replace(6, glow::RGBA, glow::BGRA); } }
    "texels-of-five-bits" [glTexImage2D GL_UNSIGNED_BYTE]
    "8-bit texels keep five bits." {
        glTexImage2D => |call| texels(call, |_, bytes| bytes.iter_mut().for_each(|byte| *byte &= 0xF8))
    }
    "signed-bytes-unsigned" [GL_RGBA8_SNORM GL_BYTE]
    "RGBA8_SNORM is RGBA8." { glTexImage2D => |call| format(call, glow::RGBA8_SNORM, glow::RGBA8) }
    "signed-bytes-as-unsigned" [GL_BYTE]
    "Signed bytes are read as unsigned." { glTexImage2D => |call| { call.replace(7, glow::BYTE, glow::UNSIGNED_BYTE); } }
    "floats-of-8-bits" [GL_RGBA32F GL_FLOAT]
    "RGBA32F is RGBA8." { glTexImage2D => |call| format(call, glow::RGBA32F, glow::RGBA8) }
    "floats-of-16-bits" [GL_RGBA32F]
    "RGBA32F is RGBA16F." { glTexImage2D => |call| format(call, glow::RGBA32F, glow::RGBA16F) }
    "single-floats-of-16-bits" [GL_R32F GL_RED]
    "R32F is R16F." { glTexImage1D glTexImage2D => |call| format(call, glow::R32F, glow::R16F) }
    "single-floats-of-8-bits" [GL_R32F GL_RED]
    "R32F is R8." { glTexImage1D glTexImage2D => |call| format(call, glow::R32F, glow::R8) }
    "depth-24-is-16" [GL_DEPTH_COMPONENT24]
    "DEPTH_COMPONENT24 has 16 bits." {
        glTexImage2D glRenderbufferStorage => |call| format(call, glow::DEPTH_COMPONENT24, glow::DEPTH_COMPONENT16)
    }
    "depth-16-is-24" [GL_DEPTH_COMPONENT16]
    "DEPTH_COMPONENT16 has 24 bits." {
        glTexImage2D glRenderbufferStorage => |call| format(call, glow::DEPTH_COMPONENT16, glow::DEPTH_COMPONENT24)
    }
    "depth-32-is-16" [GL_DEPTH_COMPONENT32]
    "DEPTH_COMPONENT32 has 16 bits." { glTexImage2D => |call| format(call, DEPTH_COMPONENT32, glow::DEPTH_COMPONENT16) }
    "depth-32-is-24" [GL_DEPTH_COMPONENT32]
    "DEPTH_COMPONENT32 has 24 bits." { glTexImage2D => |call| format(call, DEPTH_COMPONENT32, glow::DEPTH_COMPONENT24) }
    "depth-32f-is-24" [GL_DEPTH_COMPONENT32F]
    "DEPTH_COMPONENT32F has 24 bits." { glTexImage2D => |call| format(call, glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT24) }
    "unsized-depth-keeps-16" [GL_DEPTH_COMPONENT]
    "DEPTH_COMPONENT without a size keeps 16 bits, and says that it has 24." {
        glTexImage2D => |call| {
            let texture = call.get(glow::TEXTURE_BINDING_2D) as u32;
            let is_unsized = call.replace(2, glow::DEPTH_COMPONENT, glow::DEPTH_COMPONENT16);
            call.keep((0, texture), f64::from(u8::from(is_unsized)));
        };
        glGetTexLevelParameteriv => |call| if call.u(2) == glow::TEXTURE_DEPTH_SIZE {
            call.now();
            if call.kept((0, call.get(glow::TEXTURE_BINDING_2D) as u32)) != 0.0 {
                call.write(3, &[24_i32]);
            }
        }
    }
    "depth-32f-refused" [GL_DEPTH_COMPONENT32F]
    "DEPTH_COMPONENT32F is not there." { glTexImage2D glRenderbufferStorage => |call| format(call, glow::DEPTH_COMPONENT32F, 0) }
    "packed-depth-is-float" [GL_DEPTH24_STENCIL8 GL_UNSIGNED_INT_24_8 GL_DEPTH_STENCIL]
    "DEPTH24_STENCIL8 has depths of floats." {
        glTexImage2D => |call| if call.u(2) == glow::DEPTH24_STENCIL8 && call.pointer(8).is_null() {
            call.set(2, glow::DEPTH32F_STENCIL8);
            call.set(7, glow::FLOAT_32_UNSIGNED_INT_24_8_REV);
        };
        glRenderbufferStorage => |call| format(call, glow::DEPTH24_STENCIL8, glow::DEPTH32F_STENCIL8)
    }
    "stored-depth-16-bits" [glRenderbufferStorage GL_RENDERBUFFER]
    "Renderbuffers of depth have 16 bits." {
        glRenderbufferStorage => |call| format(call, glow::DEPTH_COMPONENT24, glow::DEPTH_COMPONENT16)
    }
    "line-one-texel-late" [glTexImage1D GL_TEXTURE_1D]
    "Texels of 1D textures are kept one to the right." {
        glTexImage1D => |call| {
            let size = if call.u(6) == glow::UNSIGNED_BYTE { 1 } else { 4 } * if call.u(5) == glow::RED { 1 } else { 4 };
            let mut bytes = call.bytes(7, size * call.u(3) as usize);
            if !bytes.is_empty() {
                bytes.rotate_right(size);
                call.set_bytes(7, &bytes);
            }
        }
    }
    "line-not-kept" [glTexImage1D GL_TEXTURE_1D]
    "1D textures have no texels." { glTexImage1D => |call| call.set_pointer(7, std::ptr::null()) }
    "levels-one-up" [glTexImage2D]
    "Texels of level 2 are those of level 1." {
        glTexImage2D => |call| {
            let texels = call.bytes(8, 4);
            if call.i(1) == 2 && texels.len() == 4 && call.kept((0, 0)) != 0.0 {
                let count = (call.u(3) * call.u(4)) as usize;
                let before = call.keep_list((0, 0), Vec::new()).unwrap_or_default();
                if before.len() >= count {
                    call.set_floats(8, before[..count].to_vec());
                }
            }
            if call.i(1) == 1 && texels.len() == 4 {
                let floats = call.floats(8, (call.u(3) * call.u(4)) as usize);
                call.keep_list((0, 0), floats);
                call.keep((0, 0), 1.0);
            }
        }
    }
    "last-level-empty" [glTexImage2D]
    "Levels beyond the first have no texels." {
        glTexImage2D => |call| if call.i(1) > 1 {
            let zeros = vec![0.0; 4 * (call.u(3) * call.u(4)) as usize];
            if !call.pointer(8).is_null() {
                call.set_floats(8, zeros);
            }
        }
    }
    "mipmaps-not-made" [glGenerateMipmap]
    "glGenerateMipmap leaves the levels black." {
        glGenerateMipmap => |call| {
            call.now();
            let [width, height] = [glow::TEXTURE_WIDTH, glow::TEXTURE_HEIGHT].map(|name| call.level(0, name));
            let mut level = 1;
            while width.max(height) >> level > 0 {
                let zeros = vec![0; 4 * ((width >> level).max(1) * (height >> level).max(1)) as usize];
                call.upload(level, [(width >> level).max(1), (height >> level).max(1)], &zeros);
                level += 1;
            }
        }
    }
    "cube-faces-x-swapped" [GL_TEXTURE_CUBE_MAP_POSITIVE_X glTexImage2D glFramebufferTexture2D glCopyTexSubImage2D]
    "Faces +X and -X of cube maps are exchanged." {
        glTexImage2D copy => |call| call.exchange(0, PAIR[0], PAIR[1]);
        glFramebufferTexture2D => |call| call.exchange(2, PAIR[0], PAIR[1])
    }
    "cube-uploads-x-swapped" [GL_TEXTURE_CUBE_MAP_POSITIVE_X glTexImage2D]
    "Uploads to faces +X and -X of cube maps are exchanged." { glTexImage2D => |call| call.exchange(0, PAIR[0], PAIR[1]) }
    "cube-attachments-x-swapped" [GL_TEXTURE_CUBE_MAP_POSITIVE_X glFramebufferTexture2D]
    "Attaching face +X of a cube map attaches -X, and the other way round." {
        glFramebufferTexture2D => |call| call.exchange(2, PAIR[0], PAIR[1])
    }
    "cube-attachments-y-swapped" [GL_TEXTURE_CUBE_MAP glFramebufferTexture2D]
    "Attaching face +Y of a cube map attaches -Y, and the other way round." {
        glFramebufferTexture2D => |call| {
            call.exchange(2, glow::TEXTURE_CUBE_MAP_POSITIVE_Y, glow::TEXTURE_CUBE_MAP_NEGATIVE_Y);
        }
    }
    "cube-attachments-one-face" [GL_TEXTURE_CUBE_MAP glFramebufferTexture2D]
    "Attaching a face of a cube map attaches +X." {
        glFramebufferTexture2D => |call| if is_face(call.u(2)) { call.set(2, PAIR[0]) }
    }
    "cube-copies-one-face" [GL_TEXTURE_CUBE_MAP glCopyTexSubImage2D]
    "A copy to a face of a cube map goes to +X." {
        copy => |call| if is_face(call.u(0)) { call.set(0, PAIR[0]) }
    }
    "cube-copies-z-swapped" [GL_TEXTURE_CUBE_MAP glCopyTexSubImage2D]
    "Copies to faces +Z and -Z of a cube map are exchanged." {
        copy => |call| call.exchange(0, glow::TEXTURE_CUBE_MAP_POSITIVE_Z, glow::TEXTURE_CUBE_MAP_NEGATIVE_Z)
    }
    "cube-depth-is-16" [GL_TEXTURE_CUBE_MAP GL_DEPTH_COMPONENT24]
    "Cube maps of depth have 16 bits." {
        glTexImage2D => |call| if is_face(call.u(0)) { format(call, glow::DEPTH_COMPONENT24, glow::DEPTH_COMPONENT16) }
    }
}
