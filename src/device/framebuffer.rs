//! Framebuffer objects: one for each target.

use std::rc::Rc;

use glow::HasContext;

use super::Error;
use super::image::{ImageName, face_code};
use crate::pass::{CubeFace, Target};

/// A framebuffer object, deleted on drop.
pub struct Framebuffer {
    gl: Rc<glow::Context>,
    pub name: glow::Framebuffer,
}

impl Drop for Framebuffer {
    fn drop(&mut self) {
        unsafe { self.gl.delete_framebuffer(self.name) };
    }
}

/// Makes a framebuffer of the attachments and checks that the driver can draw into it. It is left bound for drawing
/// and reading. Without colour its draw and read buffers are GL_NONE. `depth` comes with where it is attached: as depth,
/// or as depth and stencil. Level and face are those of `target`.
pub fn create(
    gl: &Rc<glow::Context>,
    color: Option<ImageName>,
    depth: Option<(ImageName, u32)>,
    target: Target,
    describe: impl Fn() -> (String, String),
) -> Result<Framebuffer, Error> {
    unsafe {
        let name = gl.create_framebuffer().map_err(Error::Create)?;
        let framebuffer = Framebuffer { gl: gl.clone(), name };
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(name));
        if let Some(image) = color {
            attach(gl, glow::COLOR_ATTACHMENT0, image, target);
        } else {
            gl.draw_buffers(&[glow::NONE]);
            gl.read_buffer(glow::NONE);
        }
        if let Some((image, point)) = depth {
            attach(gl, point, image, target);
        }
        let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
        if status == glow::FRAMEBUFFER_COMPLETE {
            return Ok(framebuffer);
        }
        let (pass, target) = describe();
        Err(Error::Incomplete { pass, target, status: status_name(status) })
    }
}

fn attach(gl: &glow::Context, point: u32, image: ImageName, target: Target) {
    let level = target.level as i32;
    match image {
        ImageName::Texture(texture) => unsafe {
            gl.framebuffer_texture_2d(glow::FRAMEBUFFER, point, glow::TEXTURE_2D, Some(texture), level);
        },
        ImageName::Line(texture) => unsafe {
            gl.framebuffer_texture(glow::FRAMEBUFFER, point, Some(texture), level);
        },
        ImageName::Cube(texture) => {
            let face = face_code(target.face.unwrap_or(CubeFace::PositiveX));
            unsafe { gl.framebuffer_texture_2d(glow::FRAMEBUFFER, point, face, Some(texture), level) };
        }
        ImageName::Renderbuffer(buffer) => unsafe {
            gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, point, glow::RENDERBUFFER, Some(buffer));
        },
    }
}

fn status_name(status: u32) -> String {
    match status {
        glow::FRAMEBUFFER_UNSUPPORTED => String::from("GL_FRAMEBUFFER_UNSUPPORTED"),
        glow::FRAMEBUFFER_INCOMPLETE_ATTACHMENT => {
            String::from("GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT; it may have no memory for images of this size")
        }
        glow::FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER => String::from("GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER"),
        other => format!("status 0x{other:04X}"),
    }
}
