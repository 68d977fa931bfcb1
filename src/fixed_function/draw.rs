//! Draws a pass: each batch's layers in turn, each with its units, its primary colour, its tests and its blending.

use glow::HasContext;

use super::layer::{AlphaSource, Layer, LayerBlend, Primary, UnitCoordinates, UnitImage};
use super::units::{self, BoundTexture};
use super::{Error, FixedFunction, bounds, lighting, tangent_vectors};
use crate::context::compatibility::raw;
use crate::device::compare_code;
use crate::pass::{Attribute, Batch, Draw, DrawPass, DrawState, PassList, Primitive};

impl FixedFunction {
    /// Draws one pass, and restores the state that passes with shaders need.
    pub(super) fn draw(&mut self, list: &PassList, label: &str, pass: &DrawPass) -> Result<(), Error> {
        self.device.begin(list, label, pass)?;
        // SAFETY: the context is current.
        unsafe {
            self.gl.use_program(None);
            // Mesa 22.3.6 keeps the fragment program that it made for a framebuffer without colour when the next one has
            // colour and no texture or fog state has changed: the colour is then undefined. This makes it choose again.
            self.gl.enable(raw::COLOR_SUM);
            self.gl.disable(raw::COLOR_SUM);
        }
        for batch in &pass.batches {
            // The list was checked before.
            for (number, layer) in self.layers(pass, batch).unwrap_or_default().into_iter().enumerate() {
                self.set_up(batch, &layer)?;
                let state = layer.state(number, &batch.state(&pass.state));
                let drawn = batch.draws.iter().try_for_each(|draw| self.draw_one(label, &state, batch, &layer, draw));
                self.take_down(&layer);
                drawn?;
            }
        }
        Ok(())
    }

    /// All of a layer but its matrices and its raster state.
    fn set_up(&mut self, batch: &Batch, layer: &Layer) -> Result<(), Error> {
        // SAFETY: the context is current and of the compatibility profile.
        unsafe {
            self.binding.MatrixMode(raw::MODELVIEW);
            self.binding.LoadIdentity();
        }
        // Masks are made when they are first needed, on a unit that must not yet be set up.
        let mut textures = Vec::new();
        for unit in &layer.units {
            textures.push(match unit.image {
                UnitImage::Mask(mask) => {
                    Some(BoundTexture { texture: self.masks.get(mask)?, sampler: None, alpha: AlphaSource::Own })
                }
                UnitImage::Cube(index) => batch.inputs.get(index).and_then(|input| {
                    let texture = self.device.cube_map(input.image)?;
                    Some(BoundTexture { texture, sampler: Some(input.sampler), alpha: AlphaSource::Own })
                }),
                UnitImage::Input { index, alpha } => batch.inputs.get(index).and_then(|input| {
                    let texture = self.device.texture(input.image)?;
                    Some(BoundTexture { texture, sampler: Some(input.sampler), alpha })
                }),
            });
        }
        for ((index, unit), bound) in (0..).zip(&layer.units).zip(textures) {
            if let Some(bound) = bound {
                units::enable(&self.gl, &self.binding, index, unit, bound);
            }
        }
        lighting::set(&self.gl, &self.binding, &layer.primary);
        // SAFETY: as above.
        unsafe {
            if let Some((function, reference)) = layer.alpha_test {
                self.gl.enable(raw::ALPHA_TEST);
                self.binding.AlphaFunc(compare_code(function), reference);
            }
        }
        Ok(())
    }

    fn take_down(&mut self, layer: &Layer) {
        // SAFETY: as above.
        unsafe {
            (0..layer.units.len() as u32).for_each(|index| units::disable(&self.gl, &self.binding, index));
            self.gl.active_texture(glow::TEXTURE0);
            lighting::reset(&self.gl, self.most_lights);
            self.gl.disable(raw::ALPHA_TEST);
            self.gl.disable(glow::BLEND);
            self.gl.bind_buffer(glow::ARRAY_BUFFER, None);
            self.gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, None);
        }
    }

    fn draw_one(
        &mut self,
        label: &str,
        state: &DrawState,
        batch: &Batch,
        layer: &Layer,
        draw: &Draw,
    ) -> Result<(), Error> {
        self.set_state(state, layer, draw.mirrored);
        self.set_matrices(batch, draw);
        let attributes = attributes(layer);
        let buffers = self.device.buffers(label, draw, &attributes)?;
        let mode = match draw.primitive {
            Primitive::Triangles => glow::TRIANGLES,
            Primitive::Lines => glow::LINES,
        };
        let (gl, fixed) = (&self.gl, &self.binding);
        let float = glow::FLOAT;
        let vectors: Vec<_> = (0..)
            .zip(&layer.units)
            .filter_map(|(index, unit)| match unit.coordinates {
                UnitCoordinates::Tangent(vector) => Some((index, tangent_vectors::of_vertices(draw, vector))),
                _ => None,
            })
            .collect();
        // SAFETY: as above; the arrays are offsets into buffers that hold what the mesh holds, or vectors, one a vertex, that
        // outlive the draw.
        unsafe {
            for (attribute, buffer) in attributes.iter().zip(&buffers.attributes) {
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(*buffer));
                match attribute {
                    Attribute::Position => fixed.VertexPointer(3, float, 0, std::ptr::null()),
                    Attribute::Normal => fixed.NormalPointer(float, 0, std::ptr::null()),
                    Attribute::Texcoord | Attribute::Tangent | Attribute::Bitangent | Attribute::Color => {}
                }
                if *attribute == Attribute::Texcoord {
                    for (unit, _) in mesh_units(layer) {
                        fixed.ClientActiveTexture(glow::TEXTURE0 + unit);
                        fixed.TexCoordPointer(2, float, 0, std::ptr::null());
                        fixed.EnableClientState(raw::TEXTURE_COORD_ARRAY);
                    }
                } else if let Some(array) = array(*attribute) {
                    fixed.EnableClientState(array);
                }
            }
            gl.bind_buffer(glow::ARRAY_BUFFER, None);
            for (unit, vectors) in &vectors {
                fixed.ClientActiveTexture(glow::TEXTURE0 + unit);
                fixed.TexCoordPointer(3, float, 0, vectors.as_ptr().cast());
                fixed.EnableClientState(raw::TEXTURE_COORD_ARRAY);
            }
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(buffers.indices));
            let count = draw.indices.end - draw.indices.start;
            gl.draw_elements(mode, count as i32, glow::UNSIGNED_INT, 4 * draw.indices.start as i32);
            for unit in mesh_units(layer).map(|(unit, _)| unit).chain(vectors.iter().map(|(unit, _)| *unit)) {
                fixed.ClientActiveTexture(glow::TEXTURE0 + unit);
                fixed.DisableClientState(raw::TEXTURE_COORD_ARRAY);
            }
            fixed.DisableClientState(raw::VERTEX_ARRAY);
            fixed.DisableClientState(raw::NORMAL_ARRAY);
        }
        Ok(())
    }

    /// Raster state of a layer, and its blending.
    fn set_state(&mut self, state: &DrawState, layer: &Layer, mirrored: bool) {
        self.device.set_state(state, mirrored);
        // SAFETY: as above.
        unsafe {
            let [red, green, blue, alpha] = state.color_write.mask();
            self.gl.color_mask(red, green, blue, alpha && layer.alpha_write);
            let (source, stored) = match layer.blend {
                LayerBlend::Replace => return,
                LayerBlend::Add => (glow::ONE, glow::ONE),
                LayerBlend::Erase => (glow::ZERO, glow::ZERO),
                LayerBlend::AddByStoredAlpha => (glow::DST_ALPHA, glow::ONE),
                LayerBlend::Multiply | LayerBlend::MultiplyAndStoreAlpha => (glow::DST_COLOR, glow::ZERO),
            };
            let stores = layer.blend == LayerBlend::MultiplyAndStoreAlpha;
            let (source_alpha, stored_alpha) = if stores { (glow::ONE, glow::ZERO) } else { (source, stored) };
            self.gl.enable(glow::BLEND);
            self.gl.blend_equation(glow::FUNC_ADD);
            self.gl.blend_func_separate(source, stored, source_alpha, stored_alpha);
        }
    }

    /// Projection and modelview, the same for all layers of a batch, so that depth EQUAL agrees to the bit. A draw without
    /// an eye space has everything in the projection.
    fn set_matrices(&self, batch: &Batch, draw: &Draw) {
        let (projection, modelview) = match (batch.meaning.clip_from_eye(), bounds::eye_from_model(draw)) {
            (Some(clip_from_eye), Ok(eye_from_model)) => (clip_from_eye, eye_from_model),
            _ => (draw.clip_from_model, glam::Mat4::IDENTITY),
        };
        // SAFETY: as above; each pointer is to sixteen values.
        unsafe {
            self.binding.MatrixMode(raw::PROJECTION);
            self.binding.LoadMatrixf(projection.as_mat4().to_cols_array().as_ptr());
            self.binding.MatrixMode(raw::MODELVIEW);
            self.binding.LoadMatrixf(modelview.to_cols_array().as_ptr());
        }
    }
}

/// Vertex attributes that a layer reads.
fn attributes(layer: &Layer) -> Vec<Attribute> {
    let mut attributes = vec![Attribute::Position];
    if matches!(layer.primary, Primary::Lighting(_)) {
        attributes.push(Attribute::Normal);
    }
    if mesh_units(layer).next().is_some() {
        attributes.push(Attribute::Texcoord);
    }
    attributes
}

/// The units that read the mesh's own coordinates.
fn mesh_units(layer: &Layer) -> impl Iterator<Item = (u32, &crate::fixed_function::layer::Unit)> {
    (0..).zip(&layer.units).filter(|(_, unit)| unit.coordinates == UnitCoordinates::Mesh)
}

/// The array of an attribute; `None`: fixed function has none.
fn array(attribute: Attribute) -> Option<u32> {
    match attribute {
        Attribute::Position => Some(raw::VERTEX_ARRAY),
        Attribute::Normal => Some(raw::NORMAL_ARRAY),
        Attribute::Texcoord => Some(raw::TEXTURE_COORD_ARRAY),
        Attribute::Tangent | Attribute::Bitangent | Attribute::Color => None,
    }
}
