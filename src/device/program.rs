//! Shader programs: compiled and linked once a variant; uniforms by name, checked for every batch.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use glow::HasContext;

use super::{Error, compile_log};
use crate::pass::{Batch, Program, Source, Stage, Uniform, UniformValue};

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
    let sources = Stage::ALL.map(|stage| (stage, program.source(stage)));
    let name = unsafe {
        let name = gl.create_program().map_err(Error::Create)?;
        let mut shaders = Vec::new();
        for (stage, source) in &sources {
            match compile(gl, program, *stage, source) {
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
        identifiers: sources.iter().flat_map(|(_, source)| identifiers(&source.text)).map(str::to_owned).collect(),
    };
    if !unsafe { gl.get_program_link_status(name) } {
        let log = unsafe { gl.get_program_info_log(name) };
        return Err(Error::Link { program: program.label.clone(), log });
    }
    linked.find_uniforms();
    Ok(linked)
}

fn identifiers(source: &str) -> impl Iterator<Item = &str> {
    source.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

fn compile(gl: &glow::Context, program: &Program, stage: Stage, source: &Source) -> Result<glow::Shader, Error> {
    let kind = match stage {
        Stage::Vertex => glow::VERTEX_SHADER,
        Stage::Fragment => glow::FRAGMENT_SHADER,
    };
    let log = match compile_text(gl, kind, &source.text)? {
        Ok(shader) => return Ok(shader),
        Err(log) => log,
    };
    // Once more, for the lines of the whole text.
    let log = match compile_text(gl, kind, &source.without_line_marks())? {
        Ok(shader) => {
            // SAFETY: the shader has just been made.
            unsafe { gl.delete_shader(shader) };
            log
        }
        Err(log) => compile_log::explain(&log, source),
    };
    Err(Error::Compile { program: program.label.clone(), stage: stage.name(), log })
}

/// A shader, or the driver's log.
fn compile_text(gl: &glow::Context, kind: u32, text: &str) -> Result<Result<glow::Shader, String>, Error> {
    unsafe {
        let shader = gl.create_shader(kind).map_err(Error::Create)?;
        gl.shader_source(shader, text);
        gl.compile_shader(shader);
        if gl.get_shader_compile_status(shader) {
            return Ok(Ok(shader));
        }
        let log = gl.get_shader_info_log(shader);
        gl.delete_shader(shader);
        Ok(Err(log))
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

    /// Compares what a batch and each of its draws set with what the program reads: nothing is missing, nothing unknown,
    /// and no draw leaves a value to the draws after it.
    pub fn check(&self, pass: &str, batch: &Batch) -> Result<(), Error> {
        let in_batch = |name: &str| {
            batch.uniforms.iter().any(|set| set.name == name) || batch.inputs.iter().any(|set| set.name == name)
        };
        let (pass, program) = (|| pass.to_owned(), || batch.program.label.clone());
        let unknown = |name: &str| Error::UnknownUniform { pass: pass(), program: program(), name: name.to_owned() };
        let uniforms = batch.uniforms.iter().map(|uniform| &uniform.name);
        let mut names = uniforms.chain(batch.inputs.iter().map(|input| &input.name));
        if let Some(name) = names.find(|name| !self.identifiers.contains(name.as_ref())) {
            return Err(unknown(name));
        }
        let read = self.uniforms.keys().chain(self.samplers.keys());
        let left: Vec<&String> = read.filter(|name| *name != "clip_from_model" && !in_batch(name)).collect();
        for draw in &batch.draws {
            if let Some(uniform) = draw.uniforms.iter().find(|set| !self.identifiers.contains(set.name.as_ref())) {
                return Err(unknown(&uniform.name));
            }
            if let Some(uniform) = draw.uniforms.iter().find(|set| in_batch(&set.name)) {
                let name = uniform.name.to_string();
                return Err(Error::UniformSetTwice {
                    pass: pass(),
                    program: program(),
                    name,
                    draw: draw.label.clone(),
                });
            }
            if let Some(name) = left.iter().find(|name| !draw.uniforms.iter().any(|set| set.name == name.as_str())) {
                let name = (*name).clone();
                return Err(Error::MissingUniform { pass: pass(), program: program(), name, draw: draw.label.clone() });
            }
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
