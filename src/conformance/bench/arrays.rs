//! Draws by arrays of positions and of each texture unit's coordinates, as a device draws by the fixed-function pipeline.

use glam::DMat4;
use glow::HasContext;

use super::environment::{GlCombiner, GlEnvironment, GlSource, set};
use super::fixed_function::FixedBench;
use super::{Bench, Error, GlImage, GlState, Sampling, Surface};
use crate::context::compatibility::raw;

/// Texture coordinates of a unit.
#[derive(Clone, Copy, Debug)]
pub enum GlUnitCoordinates<'a> {
    /// An array of so many numbers a vertex.
    Array(u32, &'a [f32]),
    /// No array: the same for each vertex.
    Current([f32; 4]),
}

/// A draw in clip space with one image on every unit.
#[derive(Clone, Copy)]
pub struct ArraysDraw<'a> {
    pub surface: &'a Surface,
    pub state: GlState,
    pub image: &'a GlImage,
    pub sampling: Sampling,
    /// Three for each triangle.
    pub positions: &'a [[f32; 4]],
    /// A unit for each.
    pub units: &'a [GlUnitCoordinates<'a>],
    /// The unit whose texture is drawn; the others pass it on.
    pub shown: usize,
}

impl FixedBench {
    /// Draws by arrays, and switches them off again. They must outlive what is drawn next.
    ///
    /// # Errors
    ///
    /// GL's errors.
    pub fn draw_arrays(&self, bench: &Bench, draw: &ArraysDraw) -> Result<(), Error> {
        bench.prepare(draw.surface, draw.state);
        let (gl, fixed) = (self.gl(), self.binding());
        // SAFETY: the context is current; every pointer is to values that outlive the draw, and no buffer is bound.
        unsafe {
            gl.use_program(None);
            for off in [raw::LIGHTING, raw::FOG, raw::ALPHA_TEST] {
                gl.disable(off);
            }
            for mode in [raw::PROJECTION, raw::MODELVIEW] {
                self.load_matrix(mode, DMat4::IDENTITY);
            }
            gl.bind_vertex_array(None);
            gl.bind_buffer(glow::ARRAY_BUFFER, None);
            fixed.Color4f(0.0, 0.0, 0.0, 1.0);
            for (index, coordinates) in (0..).zip(draw.units) {
                bench.bind_image(index, draw.image, draw.sampling)?;
                self.load_matrix(glow::TEXTURE, DMat4::IDENTITY);
                gl.enable(draw.image.shape.target());
                let shown = index as usize == draw.shown;
                let source = GlCombiner::replace(if shown { GlSource::Texture } else { GlSource::Previous });
                set(fixed, &GlEnvironment { rgb: source, alpha: source, constant: [0.0; 4] });
                match coordinates {
                    GlUnitCoordinates::Array(components, numbers) => {
                        fixed.ClientActiveTexture(glow::TEXTURE0 + index);
                        fixed.TexCoordPointer(*components as i32, glow::FLOAT, 0, numbers.as_ptr().cast());
                        fixed.EnableClientState(raw::TEXTURE_COORD_ARRAY);
                    }
                    GlUnitCoordinates::Current(at) => {
                        fixed.MultiTexCoord4fv(glow::TEXTURE0 + index, at.as_ptr());
                    }
                }
            }
            fixed.VertexPointer(4, glow::FLOAT, 0, draw.positions.as_ptr().cast());
            fixed.EnableClientState(raw::VERTEX_ARRAY);
            gl.draw_arrays(glow::TRIANGLES, 0, draw.positions.len() as i32);
            fixed.DisableClientState(raw::VERTEX_ARRAY);
            for (index, coordinates) in (0..).zip(draw.units) {
                if let GlUnitCoordinates::Array(..) = coordinates {
                    fixed.ClientActiveTexture(glow::TEXTURE0 + index);
                    fixed.DisableClientState(raw::TEXTURE_COORD_ARRAY);
                }
                gl.active_texture(glow::TEXTURE0 + index);
                gl.disable(draw.image.shape.target());
            }
            fixed.ClientActiveTexture(glow::TEXTURE0);
            gl.active_texture(glow::TEXTURE0);
        }
        bench.check("a draw by arrays")
    }
}
