//! Draws lit by glLight and glMaterial, from arrays of positions and normals. Knows no pass and no scene.

use glam::{DMat4, DVec3};
use glow::HasContext;

use super::fixed_function::FixedBench;
use super::{Bench, Error, GlState, Surface};
use crate::context::compatibility::raw;

/// A light in eye space. A position with w = 0 is the direction to it.
#[derive(Clone, Copy, Debug)]
pub struct GlLight {
    pub position: [f32; 4],
    pub ambient: [f32; 3],
    pub diffuse: [f32; 3],
    pub specular: [f32; 3],
    /// Constant, linear and quadratic.
    pub attenuation: [f32; 3],
}

/// A material of both sides, and the light on it.
#[derive(Clone, Debug)]
pub struct GlLighting {
    pub scene_ambient: [f32; 3],
    pub emission: [f32; 3],
    pub ambient: [f32; 3],
    pub diffuse: [f32; 3],
    pub specular: [f32; 3],
    pub alpha: f32,
    pub shininess: f32,
    /// At most eight.
    pub lights: Vec<GlLight>,
}

/// A draw by an orthographic projection. Eye space is model space, scaled and then moved.
#[derive(Clone, Copy)]
pub struct LitDraw<'a> {
    pub surface: &'a Surface,
    pub state: GlState,
    pub lighting: &'a GlLighting,
    pub scale: DVec3,
    pub offset: DVec3,
    /// Matrix from eye space to clip space.
    pub projection: DMat4,
    /// Three for each triangle, in model space.
    pub positions: &'a [[f32; 3]],
    /// One for each position, of any length.
    pub normals: &'a [[f32; 3]],
}

fn opaque([red, green, blue]: [f32; 3]) -> [f32; 4] {
    [red, green, blue, 1.0]
}

impl FixedBench {
    /// Draws with lighting, which it switches off again.
    ///
    /// # Errors
    ///
    /// GL's errors.
    pub fn draw_lit(&self, bench: &Bench, draw: &LitDraw) -> Result<(), Error> {
        assert_eq!(draw.positions.len(), draw.normals.len(), "a normal for each position");
        bench.prepare(draw.surface, draw.state);
        let (gl, fixed) = (self.gl(), self.binding());
        let lights = (raw::LIGHT0..).zip(&draw.lighting.lights);
        // SAFETY: the context is current; every pointer is to values that outlive the draw, and no buffer is bound.
        unsafe {
            gl.use_program(None);
            for off in [raw::FOG, raw::ALPHA_TEST, raw::COLOR_MATERIAL, raw::COLOR_SUM, glow::TEXTURE_2D] {
                gl.disable(off);
            }
            for on in [raw::LIGHTING, raw::NORMALIZE] {
                gl.enable(on);
            }
            fixed.ShadeModel(raw::SMOOTH);
            fixed.LightModeli(raw::LIGHT_MODEL_LOCAL_VIEWER, 0);
            fixed.LightModeli(raw::LIGHT_MODEL_TWO_SIDE, 0);
            // Positions of lights are given in eye space.
            fixed.MatrixMode(raw::MODELVIEW);
            fixed.LoadIdentity();
            self.set_colors(draw.lighting);
            for (light, source) in lights.clone() {
                gl.enable(light);
                self.set_light(light, source);
            }
            fixed.MatrixMode(raw::PROJECTION);
            fixed.LoadIdentity();
            fixed.MultMatrixf(draw.projection.as_mat4().to_cols_array().as_ptr());
            fixed.MatrixMode(raw::MODELVIEW);
            let offset = glam::Mat4::from_translation(glam::Vec3::new(draw.offset.x as f32, draw.offset.y as f32, 0.0));
            fixed.LoadMatrixf(offset.to_cols_array().as_ptr());
            fixed.Translatef(0.0, 0.0, draw.offset.z as f32);
            fixed.Scalef(draw.scale.x as f32, draw.scale.y as f32, draw.scale.z as f32);
            gl.bind_vertex_array(None);
            gl.bind_buffer(glow::ARRAY_BUFFER, None);
            fixed.VertexPointer(3, glow::FLOAT, 0, draw.positions.as_ptr().cast());
            fixed.NormalPointer(glow::FLOAT, 0, draw.normals.as_ptr().cast());
            fixed.EnableClientState(raw::VERTEX_ARRAY);
            fixed.EnableClientState(raw::NORMAL_ARRAY);
            gl.draw_arrays(glow::TRIANGLES, 0, draw.positions.len() as i32);
            fixed.DisableClientState(raw::VERTEX_ARRAY);
            fixed.DisableClientState(raw::NORMAL_ARRAY);
            lights.for_each(|(light, _)| gl.disable(light));
            for off in [raw::LIGHTING, raw::NORMALIZE] {
                gl.disable(off);
            }
        }
        bench.check("a lit draw")
    }

    /// # Safety
    ///
    /// The context is current.
    unsafe fn set_colors(&self, lighting: &GlLighting) {
        let [red, green, blue] = lighting.diffuse;
        let colors = [
            (raw::EMISSION, opaque(lighting.emission)),
            (raw::AMBIENT, opaque(lighting.ambient)),
            (raw::DIFFUSE, [red, green, blue, lighting.alpha]),
            (raw::SPECULAR, opaque(lighting.specular)),
        ];
        // SAFETY: as the caller promises; each call reads four numbers.
        unsafe {
            self.binding().LightModelfv(raw::LIGHT_MODEL_AMBIENT, opaque(lighting.scene_ambient).as_ptr());
            for (name, color) in colors {
                self.binding().Materialfv(glow::FRONT_AND_BACK, name, color.as_ptr());
            }
            self.binding().Materialf(glow::FRONT_AND_BACK, raw::SHININESS, lighting.shininess);
        }
    }

    /// # Safety
    ///
    /// The context is current.
    unsafe fn set_light(&self, light: u32, source: &GlLight) {
        let vectors = [
            (raw::POSITION, source.position),
            (raw::AMBIENT, opaque(source.ambient)),
            (raw::DIFFUSE, opaque(source.diffuse)),
            (raw::SPECULAR, opaque(source.specular)),
        ];
        let [constant, linear, quadratic] = source.attenuation;
        let numbers = [
            (raw::SPOT_CUTOFF, 180.0),
            (raw::CONSTANT_ATTENUATION, constant),
            (raw::LINEAR_ATTENUATION, linear),
            (raw::QUADRATIC_ATTENUATION, quadratic),
        ];
        // SAFETY: as the caller promises; each call reads four numbers, or takes one.
        unsafe {
            vectors.iter().for_each(|(name, vector)| self.binding().Lightfv(light, *name, vector.as_ptr()));
            numbers.iter().for_each(|(name, number)| self.binding().Lightf(light, *name, *number));
        }
    }
}
