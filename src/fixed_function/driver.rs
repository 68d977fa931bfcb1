//! A pass list with the driver's own arithmetic: what the driver would compute in 32 bits for fixed function is computed by
//! it and put into the shaders' uniforms. If both pipelines still differ, it is not by how planes and matrices round.

use glam::{Mat4, Vec4};
use glow::HasContext;

use super::{FixedFunction, bounds, units};
use crate::context::compatibility::raw;
use crate::pass::{Batch, PassList, Projection, UniformValue, Work};

impl FixedFunction {
    /// `list`, where eye planes are those that glTexGen keeps for the scene's set-up (read by glGetTexGen), and
    /// `clip_from_model` is the product of projection and modelview by glMultMatrix.
    pub fn in_driver_arithmetic(&self, list: &PassList) -> PassList {
        let mut list = list.clone();
        for pass in &mut list.passes {
            let Work::Draw(draw) = &mut pass.work else { continue };
            draw.batches.iter_mut().for_each(|batch| self.take_over(batch));
        }
        list
    }

    fn take_over(&self, batch: &mut Batch) {
        let Some(clip_from_eye) = batch.meaning.clip_from_eye() else { return };
        for projection in batch.meaning.projections() {
            let name = format!("eye_planes_{}", projection.light);
            if let Some(uniform) = batch.uniforms.iter_mut().find(|uniform| uniform.name == name) {
                uniform.value = UniformValue::Vec4Array(self.eye_planes(projection));
            }
        }
        for draw in &mut batch.draws {
            if let Ok(eye_from_model) = bounds::eye_from_model(draw) {
                draw.clip_from_model = self.product(&clip_from_eye.as_mat4(), &eye_from_model).as_dmat4();
            }
        }
    }

    fn eye_planes(&self, projection: &Projection) -> Vec<Vec4> {
        units::set_eye_planes(&self.binding, &projection.texgen.planes, &projection.texgen.modelview);
        units::eye_planes(&self.binding).map(Vec4::from_array).to_vec()
    }

    fn product(&self, projection: &Mat4, modelview: &Mat4) -> Mat4 {
        let mut product = [0.0; 16];
        // SAFETY: the context is current and of the compatibility profile; each pointer is to sixteen values.
        unsafe {
            self.binding.MatrixMode(raw::PROJECTION);
            self.binding.LoadMatrixf(projection.to_cols_array().as_ptr());
            self.binding.MultMatrixf(modelview.to_cols_array().as_ptr());
            self.gl.get_parameter_f32_slice(raw::PROJECTION_MATRIX, &mut product);
        }
        Mat4::from_cols_array(&product)
    }
}
