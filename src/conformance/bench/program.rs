//! The bench's shaders: a snippet each stage between lines that are always the same.

use std::rc::Rc;

use glow::HasContext;

use super::{Bench, Error, no};

/// Bodies of the two main functions, and what they declare.
///
/// The vertex body sets gl_Position from `position`, and `passed`; it may read `value`. The fragment body sets
/// `result` from `passed`, and may call `compare(vec3)`, `compare_proj(vec4)` and `compare_lod(vec3, float)`, which
/// read the image bound as `shadow`; `map` and `cube` are images of colour, `inputs` those of [`Bench::map`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Shader {
    /// Before all else: `#version`, and extensions.
    pub version: &'static str,
    /// Before both bodies; VERTEX is defined before the vertex shader's.
    pub declarations: &'static str,
    pub vertex: &'static str,
    pub fragment: &'static str,
}

impl Shader {
    /// Clip-space positions as they come; the fragment's value is its colour.
    pub const PLAIN: Self = Self {
        version: "#version 150",
        declarations: "",
        vertex: "gl_Position = position; passed = value;",
        fragment: "result = passed;",
    };

    /// The plain vertex stage, and this fragment's body.
    pub const fn of(fragment: &'static str) -> Self {
        Self { fragment, ..Self::PLAIN }
    }
}

const VERTEX_HEAD: &str = "
#define VERTEX
in vec4 position;
in vec4 value;
out vec4 passed;
";

const FRAGMENT_HEAD: &str = "
in vec4 passed;
out vec4 result;
uniform sampler2D map;
uniform samplerCube cube;
uniform sampler2D inputs;
";

const COMPARE: &str = "
uniform sampler2DShadow shadow;
float compare(vec3 at) { return texture(shadow, at); }
float compare_proj(vec4 at) { return textureProj(shadow, at); }
float compare_lod(vec3 at, float lod) { return textureLod(shadow, at, lod); }
";

/// The mistake of filtering before comparing.
const FILTER_THEN_COMPARE: &str = "
uniform sampler2D shadow;
uniform int shadow_function;
float decide(float reference, float depth) {
    bool less = reference < depth, equal = reference == depth;
    bool holds = (less && (shadow_function & 1) != 0) || (equal && (shadow_function & 2) != 0)
        || (!less && !equal && (shadow_function & 4) != 0);
    return holds ? 1.0 : 0.0;
}
float compare(vec3 at) { return decide(at.z, texture(shadow, at.xy).r); }
float compare_proj(vec4 at) { return decide(at.z / at.w, texture(shadow, at.xy / at.w).r); }
float compare_lod(vec3 at, float lod) { return decide(at.z, textureLod(shadow, at.xy, lod).r); }
";

/// Outputs of a fragment shader, in the order of draw buffers; others than the first are declared by the snippet.
const OUTPUTS: [&str; 8] = ["result", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth"];

/// A linked program, deleted on drop.
pub(crate) struct GlProgram {
    gl: Rc<glow::Context>,
    pub(crate) name: glow::Program,
}

impl Drop for GlProgram {
    fn drop(&mut self) {
        // SAFETY: the program is the bench's own and is not used again.
        unsafe { self.gl.delete_program(self.name) };
    }
}

impl Bench {
    /// Compiled once.
    pub(super) fn program(&self, shader: Shader, filter_first: bool) -> Result<glow::Program, Error> {
        let key = (shader, filter_first);
        if let Some(known) = self.programs.borrow().get(&key) {
            return Ok(known.name);
        }
        let Shader { version, declarations, .. } = shader;
        let vertex = format!("{version}{VERTEX_HEAD}{declarations}\nvoid main() {{\n{}\n}}\n", shader.vertex);
        let compare = if filter_first { FILTER_THEN_COMPARE } else { COMPARE };
        let fragment =
            format!("{version}{FRAGMENT_HEAD}{compare}{declarations}\nvoid main() {{\n{}\n}}\n", shader.fragment);
        let program = build(&self.gl, &vertex, &fragment)?;
        let name = program.name;
        self.programs.borrow_mut().insert(key, program);
        Ok(name)
    }
}

/// Whole sources, linked.
pub(crate) fn build(gl: &Rc<glow::Context>, vertex: &str, fragment: &str) -> Result<GlProgram, Error> {
    build_stages(gl, &[(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)])
}

/// The same of any stages.
pub(super) fn build_stages(gl: &Rc<glow::Context>, stages: &[(u32, &str)]) -> Result<GlProgram, Error> {
    build_with(gl, stages, |_, _| ())
}

/// The same with attributes of these names, by location.
pub(super) fn build_named(
    gl: &Rc<glow::Context>,
    stages: &[(u32, &str)],
    attributes: &[&str],
) -> Result<GlProgram, Error> {
    build_with(gl, stages, |gl, program| {
        for (location, name) in (0..).zip(attributes) {
            // SAFETY: the context is current, and the program is in it.
            unsafe { gl.bind_attrib_location(program, location, name) };
        }
    })
}

/// The same with calls before the program is linked.
pub(super) fn build_with(
    gl: &Rc<glow::Context>,
    stages: &[(u32, &str)],
    before: impl Fn(&glow::Context, glow::Program),
) -> Result<GlProgram, Error> {
    // SAFETY: the context is current; the program deletes itself, also on failure.
    unsafe {
        let program = GlProgram { gl: gl.clone(), name: gl.create_program().map_err(no("program"))? };
        for (stage, source) in stages {
            attach(gl, program.name, *stage, source)?;
        }
        gl.bind_attrib_location(program.name, 0, "position");
        gl.bind_attrib_location(program.name, 1, "value");
        for (buffer, output) in (0..).zip(OUTPUTS) {
            gl.bind_frag_data_location(program.name, buffer, output);
        }
        before(gl, program.name);
        gl.link_program(program.name);
        if gl.get_program_link_status(program.name) {
            Ok(program)
        } else {
            Err(Error::Shader(gl.get_program_info_log(program.name)))
        }
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
