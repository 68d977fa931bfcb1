//! glLight, glMaterial, glColor: a layer's primary colour.

use glow::HasContext;

use super::layer::{LayerLighting, Primary};
use crate::context::compatibility::{Binding, raw};

/// Sets a layer's primary colour. The modelview is the identity: positions are in eye space.
pub fn set(gl: &glow::Context, fixed: &Binding, primary: &Primary) {
    // SAFETY: the context is current and of the compatibility profile; every pointer is to values that outlive the
    // call.
    unsafe {
        match primary {
            Primary::Color([r, g, b, a]) => {
                gl.disable(raw::LIGHTING);
                fixed.Color4f(*r, *g, *b, *a);
            }
            Primary::Lighting(lighting) => {
                gl.enable(raw::LIGHTING);
                gl.enable(raw::NORMALIZE);
                gl.disable(raw::COLOR_MATERIAL);
                fixed.ShadeModel(raw::SMOOTH);
                fixed.LightModelfv(raw::LIGHT_MODEL_AMBIENT, [0.0_f32, 0.0, 0.0, 1.0].as_ptr());
                fixed.LightModeli(raw::LIGHT_MODEL_LOCAL_VIEWER, 0);
                fixed.LightModeli(raw::LIGHT_MODEL_TWO_SIDE, 0);
                set_material(fixed, lighting);
                set_sources(gl, fixed, lighting);
            }
        }
    }
}

/// Switches lighting off again.
pub fn reset(gl: &glow::Context, most_lights: usize) {
    // SAFETY: as above.
    unsafe {
        gl.disable(raw::LIGHTING);
        gl.disable(raw::NORMALIZE);
        (0..most_lights as u32).for_each(|index| gl.disable(raw::LIGHT0 + index));
    }
}

fn opaque([r, g, b]: [f32; 3]) -> [f32; 4] {
    [r, g, b, 1.0]
}

unsafe fn set_material(fixed: &Binding, lighting: &LayerLighting) {
    let [r, g, b] = lighting.diffuse;
    let colors = [
        (raw::EMISSION, opaque(lighting.emission)),
        (raw::AMBIENT, opaque(lighting.ambient)),
        (raw::DIFFUSE, [r, g, b, lighting.opacity]),
        (raw::SPECULAR, opaque(lighting.specular)),
    ];
    for (name, color) in colors {
        // SAFETY: as the caller's.
        unsafe { fixed.Materialfv(glow::FRONT_AND_BACK, name, color.as_ptr()) };
    }
    // SAFETY: as the caller's.
    unsafe { fixed.Materialf(glow::FRONT_AND_BACK, raw::SHININESS, lighting.shininess) };
}

unsafe fn set_sources(gl: &glow::Context, fixed: &Binding, lighting: &LayerLighting) {
    for (index, source) in (raw::LIGHT0..).zip(&lighting.sources) {
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
        // SAFETY: as the caller's.
        unsafe {
            gl.enable(index);
            vectors.iter().for_each(|(name, vector)| fixed.Lightfv(index, *name, vector.as_ptr()));
            numbers.iter().for_each(|(name, number)| fixed.Lightf(index, *name, *number));
        }
    }
}
