//! The probe's own GL objects: a shader that draws one flat quad, and a small depth texture to draw it to.

use glow::HasContext;

use super::Format;

#[derive(Clone, Debug, thiserror::Error)]
pub enum Error {
    #[error("the driver makes no {what}: {reason}")]
    Object { what: &'static str, reason: String },
    #[error("the probe's shader: {0}")]
    Shader(String),
}

fn no(what: &'static str) -> impl FnOnce(String) -> Error {
    move |reason| Error::Object { what, reason }
}

const VERTEX: &str = "#version 150
uniform float ndc_depth;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(2.0 * corner - 1.0, ndc_depth, 1.0);
}";

const FRAGMENT: &str = "#version 150
void main() {}";

/// A flat quad over the whole viewport, at a depth of one's choice.
pub(super) struct Program<'a> {
    gl: &'a glow::Context,
    program: glow::Program,
    vertices: glow::VertexArray,
    ndc_depth: Option<glow::UniformLocation>,
}

impl<'a> Program<'a> {
    pub fn new(gl: &'a glow::Context) -> Result<Self, Error> {
        // SAFETY: the context is current; what is made here is deleted on drop or, on failure, below.
        unsafe {
            let program = gl.create_program().map_err(no("program"))?;
            let built = attach(gl, program, glow::VERTEX_SHADER, VERTEX)
                .and_then(|()| attach(gl, program, glow::FRAGMENT_SHADER, FRAGMENT))
                .and_then(|()| link(gl, program))
                .and_then(|()| gl.create_vertex_array().map_err(no("vertex array")));
            match built {
                Ok(vertices) => {
                    Ok(Self { gl, program, vertices, ndc_depth: gl.get_uniform_location(program, "ndc_depth") })
                }
                Err(error) => {
                    gl.delete_program(program);
                    Err(error)
                }
            }
        }
    }

    pub fn gl(&self) -> &'a glow::Context {
        self.gl
    }
}

unsafe fn attach(gl: &glow::Context, program: glow::Program, stage: u32, source: &str) -> Result<(), Error> {
    // SAFETY: as the caller's; the shader lives on as long as the program it is attached to.
    unsafe {
        let shader = gl.create_shader(stage).map_err(no("shader"))?;
        gl.shader_source(shader, source);
        gl.compile_shader(shader);
        let compiled = gl.get_shader_compile_status(shader);
        let log = if compiled { String::new() } else { gl.get_shader_info_log(shader) };
        gl.attach_shader(program, shader);
        gl.delete_shader(shader);
        if compiled { Ok(()) } else { Err(Error::Shader(log)) }
    }
}

unsafe fn link(gl: &glow::Context, program: glow::Program) -> Result<(), Error> {
    // SAFETY: as the caller's.
    unsafe {
        gl.link_program(program);
        if gl.get_program_link_status(program) { Ok(()) } else { Err(Error::Shader(gl.get_program_info_log(program))) }
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        // SAFETY: the objects are the probe's own and are not used again.
        unsafe {
            self.gl.use_program(None);
            self.gl.bind_vertex_array(None);
            self.gl.delete_vertex_array(self.vertices);
            self.gl.delete_program(self.program);
        }
    }
}

const SIDE: i32 = 4;

/// A depth texture in a framebuffer of its own, both bound until dropped.
pub(super) struct DepthTarget<'a> {
    gl: &'a glow::Context,
    texture: glow::Texture,
    framebuffer: glow::Framebuffer,
}

impl<'a> DepthTarget<'a> {
    /// The inner error is the driver's refusal of the format.
    pub fn new(gl: &'a glow::Context, format: &Format) -> Result<Result<Self, String>, Error> {
        // SAFETY: the context is current; the framebuffer's deletion is taken over by the target, and the texture's.
        unsafe {
            let texture = gl.create_texture().map_err(no("texture"))?;
            let framebuffer = gl.create_framebuffer().inspect_err(|_| gl.delete_texture(texture));
            let target = Self { gl, texture, framebuffer: framebuffer.map_err(no("framebuffer"))? };
            while gl.get_error() != glow::NO_ERROR {}
            target.define(format);
            let error = gl.get_error();
            let status = gl.check_framebuffer_status(glow::FRAMEBUFFER);
            Ok(match (error, status) {
                (glow::NO_ERROR, glow::FRAMEBUFFER_COMPLETE) => Ok(target),
                (glow::NO_ERROR, glow::FRAMEBUFFER_UNSUPPORTED) => Err("GL_FRAMEBUFFER_UNSUPPORTED".to_owned()),
                (glow::NO_ERROR, status) => Err(format!("framebuffer status {status:#06x}")),
                (error, _) => Err(format!("GL error {error:#06x}")),
            })
        }
    }

    unsafe fn define(&self, format: &Format) {
        let gl = self.gl;
        let (layout, kind) = format.upload;
        let attachment = if format.has_stencil { glow::DEPTH_STENCIL_ATTACHMENT } else { glow::DEPTH_ATTACHMENT };
        let nearest = glow::NEAREST as i32;
        // SAFETY: the context is current; no pixels are read, since none are given.
        unsafe {
            gl.bind_texture(glow::TEXTURE_2D, Some(self.texture));
            gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MIN_FILTER, nearest);
            gl.tex_parameter_i32(glow::TEXTURE_2D, glow::TEXTURE_MAG_FILTER, nearest);
            let (internal, none) = (format.internal as i32, glow::PixelUnpackData::Slice(None));
            gl.tex_image_2d(glow::TEXTURE_2D, 0, internal, SIDE, SIDE, 0, layout, kind, none);
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(self.framebuffer));
            let texture = Some(self.texture);
            gl.framebuffer_texture_2d(glow::FRAMEBUFFER, attachment, glow::TEXTURE_2D, texture, 0);
            gl.draw_buffer(glow::NONE);
            gl.read_buffer(glow::NONE);
        }
    }

    /// The depth that is stored for a flat quad at window depth `depth` under glPolygonOffset(0, `units`).
    pub fn stored(&self, program: &Program, depth: f64, units: f32, bits: u32, float: bool) -> f64 {
        let gl = self.gl;
        // SAFETY: the context is current, the target is bound, and the complete state that matters is set here.
        unsafe {
            gl.viewport(0, 0, SIDE, SIDE);
            gl.depth_range_f32(0.0, 1.0);
            for off in [glow::SCISSOR_TEST, glow::CULL_FACE, glow::STENCIL_TEST, glow::DEPTH_CLAMP] {
                gl.disable(off);
            }
            gl.enable(glow::DEPTH_TEST);
            gl.depth_func(glow::ALWAYS);
            gl.depth_mask(true);
            gl.enable(glow::POLYGON_OFFSET_FILL);
            gl.polygon_offset(0.0, units);
            gl.use_program(Some(program.program));
            gl.bind_vertex_array(Some(program.vertices));
            gl.uniform_1_f32(program.ndc_depth.as_ref(), (2.0 * depth - 1.0) as f32);
            gl.draw_arrays(glow::TRIANGLE_STRIP, 0, 4);
            gl.polygon_offset(0.0, 0.0);
            gl.disable(glow::POLYGON_OFFSET_FILL);
            gl.disable(glow::DEPTH_TEST);
        }
        self.read_center(bits, float)
    }

    /// Exactly: what has at most 24 bits comes back as a float that rounds to the one code, more as an integer.
    fn read_center(&self, bits: u32, float: bool) -> f64 {
        let (gl, at) = (self.gl, SIDE / 2);
        let mut bytes = [0; 4];
        let kind = if !float && bits > 24 { glow::UNSIGNED_INT } else { glow::FLOAT };
        let pixels = glow::PixelPackData::Slice(Some(&mut bytes));
        // SAFETY: one pixel of four bytes is written, into four bytes.
        unsafe { gl.read_pixels(at, at, 1, 1, glow::DEPTH_COMPONENT, kind, pixels) };
        if kind == glow::UNSIGNED_INT {
            return f64::from(u32::from_ne_bytes(bytes)) / f64::from(u32::MAX);
        }
        let value = f64::from(f32::from_ne_bytes(bytes));
        let most = f64::from(bits).exp2() - 1.0;
        if float { value } else { (value * most).round() / most }
    }
}

impl Drop for DepthTarget<'_> {
    fn drop(&mut self) {
        // SAFETY: the objects are the probe's own and are not used again.
        unsafe {
            self.gl.bind_framebuffer(glow::FRAMEBUFFER, None);
            self.gl.bind_texture(glow::TEXTURE_2D, None);
            self.gl.delete_framebuffer(self.framebuffer);
            self.gl.delete_texture(self.texture);
        }
    }
}
