//! Shader programs: assembled, compiled and linked once a variant; uniforms by name, checked when linked.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use glow::HasContext;

use super::Error;
use crate::pass::{Batch, Chunk, Program, Uniform, UniformValue};

/// A linked program, deleted on drop.
pub struct GpuProgram {
    gl: Rc<glow::Context>,
    pub name: glow::Program,
    /// Active uniforms that are no samplers.
    uniforms: HashMap<String, glow::UniformLocation>,
    /// Active samplers.
    samplers: HashMap<String, glow::UniformLocation>,
    /// Every identifier of the sources: what the compiler dropped is no mistake, what was never there is one.
    identifiers: HashSet<String>,
}

impl Drop for GpuProgram {
    fn drop(&mut self) {
        unsafe { self.gl.delete_program(self.name) };
    }
}

/// Compiles and links a variant.
pub fn create(gl: &Rc<glow::Context>, program: &Program) -> Result<GpuProgram, Error> {
    let vertex = assemble(program, &program.vertex);
    let fragment = assemble(program, &program.fragment);
    let name = unsafe {
        let name = gl.create_program().map_err(Error::Create)?;
        let stages = [(glow::VERTEX_SHADER, "vertex", &vertex), (glow::FRAGMENT_SHADER, "fragment", &fragment)];
        let mut shaders = Vec::new();
        for (kind, stage, source) in stages {
            match compile(gl, program, kind, stage, source) {
                Ok(shader) => {
                    gl.attach_shader(name, shader);
                    shaders.push(shader);
                }
                Err(error) => {
                    gl.delete_program(name);
                    return Err(error);
                }
            }
        }
        gl.link_program(name);
        for shader in shaders {
            gl.detach_shader(name, shader);
            gl.delete_shader(shader);
        }
        name
    };
    let mut linked = GpuProgram {
        gl: gl.clone(),
        name,
        uniforms: HashMap::new(),
        samplers: HashMap::new(),
        identifiers: identifiers(&vertex).chain(identifiers(&fragment)).map(str::to_owned).collect(),
    };
    if !unsafe { gl.get_program_link_status(name) } {
        let log = unsafe { gl.get_program_info_log(name) };
        return Err(Error::Link { program: program.label.clone(), log });
    }
    linked.find_uniforms();
    Ok(linked)
}

/// `EXACT`: what is computed as it is written, where the driver has the word for it [GLSL 4.60, 4.9.1]. Without it Mesa
/// 24.1 and later move arithmetic across interpolation, from the fragments to the vertices, in one program and not in another.
const HEAD: &str = "#version 330 core
#ifdef GL_ARB_gpu_shader5
#extension GL_ARB_gpu_shader5 : enable
#define EXACT precise
#else
#define EXACT
#endif
";

/// `#version`, the defines, then each chunk under a `#line` that numbers its file.
fn assemble(program: &Program, chunks: &[Chunk]) -> String {
    let mut source = String::from(HEAD);
    for (name, value) in &program.defines {
        source.push_str(&format!("#define {name} {value}\n"));
    }
    for (number, chunk) in chunks.iter().enumerate() {
        source.push_str(&format!("#line 1 {number}\n{}", chunk.text));
    }
    source
}

fn identifiers(source: &str) -> impl Iterator<Item = &str> {
    source.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

fn compile(
    gl: &glow::Context,
    program: &Program,
    kind: u32,
    stage: &'static str,
    source: &str,
) -> Result<glow::Shader, Error> {
    unsafe {
        let shader = gl.create_shader(kind).map_err(Error::Create)?;
        gl.shader_source(shader, source);
        gl.compile_shader(shader);
        if gl.get_shader_compile_status(shader) {
            return Ok(shader);
        }
        let log = gl.get_shader_info_log(shader);
        gl.delete_shader(shader);
        let chunks = if kind == glow::VERTEX_SHADER { &program.vertex } else { &program.fragment };
        let files = chunks.iter().enumerate().map(|(number, chunk)| format!("{number} {}", chunk.name));
        let files = files.collect::<Vec<_>>().join(", ");
        Err(Error::Compile { program: program.label.clone(), stage, log, files })
    }
}

impl GpuProgram {
    fn find_uniforms(&mut self) {
        let count = unsafe { self.gl.get_active_uniforms(self.name) };
        for index in 0..count {
            let Some(uniform) = (unsafe { self.gl.get_active_uniform(self.name, index) }) else { continue };
            let Some(location) = (unsafe { self.gl.get_uniform_location(self.name, &uniform.name) }) else { continue };
            let name = uniform.name.trim_end_matches("[0]").to_owned();
            let is_sampler = matches!(
                uniform.utype,
                glow::SAMPLER_1D
                    | glow::SAMPLER_2D
                    | glow::SAMPLER_2D_SHADOW
                    | glow::SAMPLER_CUBE
                    | glow::SAMPLER_CUBE_SHADOW
            );
            if is_sampler { &mut self.samplers } else { &mut self.uniforms }.insert(name, location);
        }
    }

    /// Holds what `batch` sets against what the program reads: nothing missing, nothing unknown.
    pub fn check(&self, pass: &str, batch: &Batch) -> Result<(), Error> {
        let first = batch.draws.first().map_or(&[][..], |draw| &draw.uniforms);
        let set: HashSet<&str> = batch
            .uniforms
            .iter()
            .chain(first)
            .map(|uniform| uniform.name.as_ref())
            .chain(batch.inputs.iter().map(|input| input.name.as_ref()))
            .chain(["clip_from_model"])
            .collect();
        let program = &batch.program.label;
        if let Some(name) = set.iter().find(|name| !self.identifiers.contains(**name)) {
            let (pass, program, name) = (pass.to_owned(), program.clone(), (*name).to_owned());
            return Err(Error::UnknownUniform { pass, program, name });
        }
        if let Some(name) = self.uniforms.keys().chain(self.samplers.keys()).find(|name| !set.contains(name.as_str())) {
            return Err(Error::MissingUniform { pass: pass.to_owned(), program: program.clone(), name: name.clone() });
        }
        Ok(())
    }

    /// The location of a sampler that the compiler kept.
    pub fn sampler(&self, name: &str) -> Option<&glow::UniformLocation> {
        self.samplers.get(name)
    }

    /// Sets a uniform of the program in use; one that the compiler dropped is passed over.
    pub fn set(&self, uniform: &Uniform) {
        self.set_value(&uniform.name, &uniform.value);
    }

    pub fn set_value(&self, name: &str, value: &UniformValue) {
        let Some(location) = self.uniforms.get(name) else { return };
        let location = Some(location);
        unsafe {
            match value {
                UniformValue::Float(x) => self.gl.uniform_1_f32(location, *x),
                UniformValue::Vec2(v) => self.gl.uniform_2_f32(location, v.x, v.y),
                UniformValue::Vec3(v) => self.gl.uniform_3_f32(location, v.x, v.y, v.z),
                UniformValue::Vec4(v) => self.gl.uniform_4_f32(location, v.x, v.y, v.z, v.w),
                UniformValue::Vec4Array(array) => {
                    let flat: Vec<f32> = array.iter().flat_map(|v| v.to_array()).collect();
                    self.gl.uniform_4_f32_slice(location, &flat);
                }
                UniformValue::Mat3(m) => self.gl.uniform_matrix_3_f32_slice(location, false, &m.to_cols_array()),
                UniformValue::Mat4(m) => self.gl.uniform_matrix_4_f32_slice(location, false, &m.to_cols_array()),
            }
        }
    }
}
