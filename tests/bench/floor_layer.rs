//! A layer of floats over the picture, with the picture's depth: for what is added up from many parts.

use glow::HasContext;

use super::Result;
use super::floor_gl::Program;

const EVERYWHERE: &str = "#version 330 core
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }
";
const FETCH: &str = "#version 330 core
uniform sampler2D layer;
out vec4 color;
void main() { color = texelFetch(layer, ivec2(gl_FragCoord.xy), 0); }
";

/// Targets, and the program that puts the layer over the picture.
pub struct Layer {
    pub picture: glow::Framebuffer,
    layer: glow::Framebuffer,
    over: Program,
}

impl Layer {
    /// The layer's texture is left bound to unit 1.
    pub fn new(gl: &glow::Context, size: i32) -> Result<Self> {
        let over = Program::new(gl, "", EVERYWHERE, FETCH)?;
        unsafe {
            gl.use_program(Some(over.name));
            gl.uniform_1_i32(over.at(gl, "layer").as_ref(), 1);
        }
        let [picture, layer] = targets(gl, size)?;
        Ok(Self { picture, layer, over })
    }

    pub fn bind(&self, gl: &glow::Context) {
        unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.layer)) };
    }

    /// Binds and clears it.
    pub fn clear(&self, gl: &glow::Context) {
        self.bind(gl);
        unsafe {
            gl.clear_color(0.0, 0.0, 0.0, 0.0);
            gl.clear(glow::COLOR_BUFFER_BIT);
        }
    }

    /// Blends it over the picture by its alpha, which its colour has as a factor already.
    pub fn put_over(&self, gl: &glow::Context) {
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.picture));
            gl.disable(glow::DEPTH_TEST);
            gl.enable(glow::BLEND);
            gl.blend_func(glow::ONE, glow::ONE_MINUS_SRC_ALPHA);
            gl.use_program(Some(self.over.name));
            gl.draw_arrays(glow::TRIANGLES, 0, 3);
            gl.disable(glow::BLEND);
            gl.enable(glow::DEPTH_TEST);
        }
    }
}

/// The picture and the layer of floats, with one depth buffer.
fn targets(gl: &glow::Context, size: i32) -> Result<[glow::Framebuffer; 2]> {
    unsafe {
        let [color, depth] = [gl.create_renderbuffer()?, gl.create_renderbuffer()?];
        for (buffer, format) in [(color, glow::RGBA8), (depth, glow::DEPTH_COMPONENT24)] {
            gl.bind_renderbuffer(glow::RENDERBUFFER, Some(buffer));
            gl.renderbuffer_storage(glow::RENDERBUFFER, format, size, size);
        }
        gl.active_texture(glow::TEXTURE1);
        let texture = gl.create_texture()?;
        gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        let (format, pixels) = (glow::RGBA32F as i32, glow::PixelUnpackData::Slice(None));
        gl.tex_image_2d(glow::TEXTURE_2D, 0, format, size, size, 0, glow::RGBA, glow::FLOAT, pixels);
        gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER, glow::NEAREST as i32);
        gl.active_texture(glow::TEXTURE0);
        let [picture, layer] = [gl.create_framebuffer()?, gl.create_framebuffer()?];
        for target in [picture, layer] {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(target));
            gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, glow::DEPTH_ATTACHMENT, glow::RENDERBUFFER, Some(depth));
        }
        let attachment = glow::COLOR_ATTACHMENT0;
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, attachment, glow::TEXTURE_2D, Some(texture), 0);
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(picture));
        gl.framebuffer_renderbuffer(glow::FRAMEBUFFER, attachment, glow::RENDERBUFFER, Some(color));
        Ok([picture, layer])
    }
}
