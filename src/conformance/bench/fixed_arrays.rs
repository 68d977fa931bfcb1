//! Draws of the fixed-function [bench](super::FixedBench): most from vertex arrays in buffers, as renderers draw, the others
//! between glBegin and glEnd.

use glow::HasContext;

use super::{Bench, Error, no};
use crate::context::compatibility::{Binding, raw};

/// One draw in so many is between glBegin and glEnd. No rule's loops have this length, so that it falls on another case of
/// a rule each time.
const IMMEDIATE: u32 = 7;

/// Primary colours.
pub(super) enum ArraysColors {
    /// glColor4f before the draw; no array.
    Current([f32; 4]),
    /// One for each vertex.
    Each(Vec<[f32; 4]>),
}

/// Vertices of triangles, each as its arrays have it.
pub(super) struct ArraysFigure<'v> {
    pub positions: Vec<[f32; 4]>,
    pub colors: ArraysColors,
    /// Texture coordinates for each unit from 0 on.
    pub coordinates: Vec<Vec<[f32; 4]>>,
    pub fixed: &'v Binding,
}

impl ArraysFigure<'_> {
    /// Draws under the state that there is. `place` counts the draws before.
    ///
    /// # Errors
    ///
    /// A buffer that GL does not give.
    pub(super) fn draw(&self, bench: &Bench, place: u32) -> Result<(), Error> {
        if let ArraysColors::Current([red, green, blue, alpha]) = self.colors {
            // SAFETY: the context is current.
            unsafe { self.fixed.Color4f(red, green, blue, alpha) };
        }
        if place % IMMEDIATE == IMMEDIATE - 1 {
            self.draw_at_once();
            return Ok(());
        }
        self.draw_elements(bench)
    }

    fn draw_at_once(&self) {
        // SAFETY: the context is current; each call reads four numbers, and nothing but vertices comes between.
        unsafe {
            self.fixed.Begin(glow::TRIANGLES);
            for (index, position) in self.positions.iter().enumerate() {
                if let ArraysColors::Each(colors) = &self.colors {
                    self.fixed.Color4fv(colors[index].as_ptr());
                }
                for (unit, coordinates) in (0..).zip(&self.coordinates) {
                    self.fixed.MultiTexCoord4fv(glow::TEXTURE0 + unit, coordinates[index].as_ptr());
                }
                self.fixed.Vertex4fv(position.as_ptr());
            }
            self.fixed.End();
        }
    }

    fn draw_elements(&self, bench: &Bench) -> Result<(), Error> {
        let (gl, fixed, float) = (&*bench.gl, self.fixed, glow::FLOAT);
        let colors = match &self.colors {
            ArraysColors::Current(_) => None,
            ArraysColors::Each(colors) => Some(colors),
        };
        let arrays = std::iter::once(&self.positions).chain(&self.coordinates).chain(colors);
        let numbers: Vec<u8> = arrays.flatten().flatten().flat_map(|number| number.to_ne_bytes()).collect();
        let count = self.positions.len() as u32;
        let order: Vec<u8> = (0..count).flat_map(u32::to_ne_bytes).collect();
        // The array of this index begins there in the buffer.
        let start = |array: usize| std::ptr::without_provenance(array * self.positions.len() * size_of::<[f32; 4]>());
        // SAFETY: the context is current; the arrays have four numbers for each vertex, and the indices are below their number.
        unsafe {
            let buffers = [(); 2].map(|()| gl.create_buffer());
            let delete = || buffers.iter().flatten().for_each(|buffer| gl.delete_buffer(*buffer));
            let [Ok(vertices), Ok(indices)] = buffers else {
                delete();
                return Err(no("buffer")(String::new()));
            };
            gl.bind_vertex_array(None);
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(vertices));
            gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, &numbers, glow::STATIC_DRAW);
            fixed.VertexPointer(4, float, 0, start(0));
            fixed.EnableClientState(raw::VERTEX_ARRAY);
            if colors.is_some() {
                fixed.ColorPointer(4, float, 0, start(1 + self.coordinates.len()));
                fixed.EnableClientState(raw::COLOR_ARRAY);
            }
            for unit in 0..self.coordinates.len() {
                fixed.ClientActiveTexture(glow::TEXTURE0 + unit as u32);
                fixed.TexCoordPointer(4, float, 0, start(1 + unit));
                fixed.EnableClientState(raw::TEXTURE_COORD_ARRAY);
            }
            gl.bind_buffer(glow::ARRAY_BUFFER, None);
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(indices));
            gl.buffer_data_u8_slice(glow::ELEMENT_ARRAY_BUFFER, &order, glow::STATIC_DRAW);
            gl.draw_elements(glow::TRIANGLES, count as i32, glow::UNSIGNED_INT, 0);
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, None);
            for unit in 0..self.coordinates.len() {
                fixed.ClientActiveTexture(glow::TEXTURE0 + unit as u32);
                fixed.DisableClientState(raw::TEXTURE_COORD_ARRAY);
            }
            fixed.ClientActiveTexture(glow::TEXTURE0);
            fixed.DisableClientState(raw::COLOR_ARRAY);
            fixed.DisableClientState(raw::VERTEX_ARRAY);
            delete();
        }
        Ok(())
    }
}
