//! The small textures that say where a light reaches. Made once for each context.

use std::collections::HashMap;
use std::rc::Rc;

use glow::HasContext;

use super::layer::Mask;
use crate::device::Error;

/// One texture a mask, deleted on drop.
pub struct Masks {
    gl: Rc<glow::Context>,
    textures: HashMap<Mask, glow::Texture>,
}

impl Drop for Masks {
    fn drop(&mut self) {
        // SAFETY: the context is current, as for every object of ours.
        self.textures.values().for_each(|texture| unsafe { self.gl.delete_texture(*texture) });
    }
}

impl Masks {
    pub fn new(gl: &Rc<glow::Context>) -> Self {
        Self { gl: gl.clone(), textures: HashMap::new() }
    }

    /// The texture of a mask.
    ///
    /// # Errors
    ///
    /// A driver that can make no texture.
    pub fn get(&mut self, mask: Mask) -> Result<glow::Texture, Error> {
        if let Some(texture) = self.textures.get(&mask) {
            return Ok(*texture);
        }
        let texture = create(&self.gl, mask)?;
        self.textures.insert(mask, texture);
        Ok(texture)
    }
}

/// Width and height, RGBA, filter and wrap of each; borders are (0, 0, 0, 0).
fn create(gl: &glow::Context, mask: Mask) -> Result<glow::Texture, Error> {
    let (black, white) = ([0.0; 4], [1.0_f32; 4]);
    let (size, texels, filter, wrap) = match mask {
        Mask::White => ([1, 1], vec![white], glow::NEAREST, glow::CLAMP_TO_EDGE),
        Mask::Square => ([1, 1], vec![white], glow::NEAREST, glow::CLAMP_TO_BORDER),
        Mask::Step => ([2, 1], vec![black, white], glow::NEAREST, glow::CLAMP_TO_EDGE),
        Mask::Ramp => {
            let texel = |s, t| [s, t, 0.5, 1.0];
            let corners = vec![texel(0.0, 0.0), texel(1.0, 0.0), texel(0.0, 1.0), texel(1.0, 1.0)];
            ([2, 2], corners, glow::LINEAR, glow::CLAMP_TO_EDGE)
        }
    };
    // SAFETY: the context is current; the texels are as many as the size says.
    unsafe {
        let texture = gl.create_texture().map_err(Error::Create)?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        let data = glow::PixelUnpackData::Slice(Some(bytemuck::cast_slice(&texels)));
        let [width, height] = size;
        gl.tex_image_2d(glow::TEXTURE_2D, 0, glow::RGBA32F as i32, width, height, 0, glow::RGBA, glow::FLOAT, data);
        let parameters = [
            (glow::TEXTURE_MAX_LEVEL, 0),
            (glow::TEXTURE_MIN_FILTER, filter),
            (glow::TEXTURE_MAG_FILTER, filter),
            (glow::TEXTURE_WRAP_S, wrap),
            (glow::TEXTURE_WRAP_T, wrap),
        ];
        for (name, value) in parameters {
            gl.tex_parameter_i32(glow::TEXTURE_2D, name, value as i32);
        }
        gl.bind_texture(glow::TEXTURE_2D, None);
        Ok(texture)
    }
}
