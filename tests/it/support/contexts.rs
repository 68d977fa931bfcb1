//! Contexts of a named backend, and the command without a display.

use std::process::Command;

use assert_cmd::cargo::CommandCargoExt;
use glow::HasContext;
use glumbra::context::{self, Backend, Choice, Context, ContextRequest, Profile};
use glumbra::device::debug::Debug;

pub const CORE: ContextRequest =
    ContextRequest { choice: Choice::Auto, device: None, profile: Profile::Core33, debug: true };
pub const COMPATIBILITY: ContextRequest = ContextRequest { profile: Profile::Compatibility, ..CORE };

/// Clears a framebuffer of its own to `color` and reads one pixel back.
pub fn cleared_pixel(context: &dyn Context, color: [f32; 4]) -> [u8; 4] {
    let gl = context.gl();
    let mut pixel = [0; 4];
    unsafe {
        let texture = gl.create_texture().unwrap();
        gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        let none = glow::PixelUnpackData::Slice(None);
        gl.tex_image_2d(glow::TEXTURE_2D, 0, glow::RGBA8 as i32, 8, 8, 0, glow::RGBA, glow::UNSIGNED_BYTE, none);
        let framebuffer = gl.create_framebuffer().unwrap();
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, glow::TEXTURE_2D, Some(texture), 0);
        gl.clear_color(color[0], color[1], color[2], color[3]);
        gl.clear(glow::COLOR_BUFFER_BIT);
        let pixels = glow::PixelPackData::Slice(Some(&mut pixel));
        gl.read_pixels(3, 3, 1, 1, glow::RGBA, glow::UNSIGNED_BYTE, pixels);
        gl.delete_framebuffer(framebuffer);
        gl.delete_texture(texture);
    }
    pixel
}

/// The backend works: it draws, twice in turn, in both profiles.
pub fn check_backend(backend: Backend, name: &str) {
    for (request, profile) in [(CORE, "core"), (COMPATIBILITY, "compatibility"), (CORE, "core")] {
        let context = context::open_backend(backend, &request).unwrap();
        assert!(context.backend().starts_with(name), "{} is not {name}", context.backend());
        assert_eq!(context.describe().profile, profile);
        assert_eq!(cleared_pixel(&*context, [1.0, 0.0, 0.2, 1.0]), [255, 0, 51, 255]);
        Debug::new(&*context).check(name).unwrap();
    }
}

pub struct Output {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

/// The command without a display, whatever this machine has.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("glumbra").unwrap();
    command.args(arguments);
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    command
}

pub fn run(mut command: Command) -> Output {
    let output = command.output().unwrap();
    Output {
        code: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}
