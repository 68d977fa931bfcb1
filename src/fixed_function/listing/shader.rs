//! A batch by its program, as the device draws it.

use super::c::{self, columns, float, vector};
use super::state::ListingState;
use super::{Listing, names};
use crate::pass::{Batch, DrawPass, Projection, Uniform, UniformValue};

impl<'a> Listing<'a> {
    pub(super) fn shader_batch(&mut self, pass: &DrawPass, batch: &'a Batch, now: &mut ListingState) {
        let program = self.objects.program(&batch.program);
        self.title(&format!("{} by program {}, \"{}\"", names(batch), program + 1, batch.program.label));
        self.change(now, ListingState::of(batch.state(&pass.state)));
        self.body.call(&format!("glUseProgram(programs[{program}])"));
        for (unit, input) in batch.inputs.iter().enumerate() {
            let image = input.image.0;
            let binding = c::binding(&self.list.images[image].storage);
            let sampler = self.objects.sampler(input.sampler);
            self.body.call(&format!("glActiveTexture(GL_TEXTURE{unit})"));
            self.body.call(&format!("glBindTexture({binding}, images[{image}])"));
            self.body.call(&format!("glBindSampler({unit}, samplers[{sampler}])"));
            self.body.call(&format!("glUniform1i({}, {unit})", location(program, &input.name)));
        }
        for uniform in &batch.uniforms {
            match projection_of(batch, uniform) {
                Some(projection) => self.eye_planes(program, uniform, projection),
                None => self.uniform(program, uniform),
            }
        }
        for draw in &batch.draws {
            self.title(&draw.label);
            let matrix = columns(&draw.clip_from_model.as_mat4().to_cols_array(), 4);
            let place = location(program, "clip_from_model");
            self.body.call(&format!("glUniformMatrix4fv({place}, 1, GL_FALSE, {matrix})"));
            draw.uniforms.iter().for_each(|uniform| self.uniform(program, uniform));
            self.mirror(now, draw.mirrored);
            self.bind_mesh(draw);
            self.draw_elements(draw);
        }
    }

    /// Gives the planes to glTexGen, under the modelview of the scene's set-up, and GL's resulting planes to the program.
    fn eye_planes(&mut self, program: usize, uniform: &Uniform, projection: &Projection) {
        let planes = self.objects.planes(&projection.texgen.planes, &projection.texgen.modelview);
        self.body.call(&format!("load_planes_{planes}()"));
        self.body.call(&format!("use_eye_planes(programs[{program}], \"{}\")", uniform.name));
        self.objects.uses_eye_planes = true;
    }

    fn uniform(&mut self, program: usize, uniform: &Uniform) {
        let place = location(program, &uniform.name);
        self.body.call(&match &uniform.value {
            UniformValue::Float(x) => format!("glUniform1f({place}, {})", float(*x)),
            UniformValue::Vec2(v) => format!("glUniform2fv({place}, 1, {})", vector(&v.to_array())),
            UniformValue::Vec3(v) => format!("glUniform3fv({place}, 1, {})", vector(&v.to_array())),
            UniformValue::Vec4(v) => format!("glUniform4fv({place}, 1, {})", vector(&v.to_array())),
            UniformValue::Vec4Array(array) => {
                let flat: Vec<f32> = array.iter().flat_map(|v| v.to_array()).collect();
                format!("glUniform4fv({place}, {}, {})", array.len(), columns(&flat, 4))
            }
            UniformValue::Mat3(m) => {
                format!("glUniformMatrix3fv({place}, 1, GL_FALSE, {})", columns(&m.to_cols_array(), 3))
            }
            UniformValue::Mat4(m) => {
                format!("glUniformMatrix4fv({place}, 1, GL_FALSE, {})", columns(&m.to_cols_array(), 4))
            }
        });
    }
}

fn location(program: usize, name: &str) -> String {
    format!("glGetUniformLocation(programs[{program}], \"{name}\")")
}

/// Making of the eye planes that a uniform holds.
fn projection_of<'a>(batch: &'a Batch, uniform: &Uniform) -> Option<&'a Projection> {
    let light: usize = uniform.name.strip_prefix("eye_planes_")?.parse().ok()?;
    let is_of_light = |projection: &&Projection| projection.light == light;
    batch.meaning.projections().into_iter().find(is_of_light)
}
