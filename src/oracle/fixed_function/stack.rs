//! Stacks up a layer's texture units: a surface's own textures, a light's shade, beam and reach.

use glam::{DMat4, DVec4};

use super::layer::{Combine, Coordinates, Mask, Operand, Unit, UnitImage};
use crate::pass::{Batch, Projection, Shade, Texturing};

/// The units so far, and where the next finds what they came to.
pub struct Stack<'a> {
    batch: &'a Batch,
    pub units: Vec<Unit>,
    rgb: Operand,
}

impl<'a> Stack<'a> {
    pub fn new(batch: &'a Batch) -> Self {
        Self { batch, units: Vec::new(), rgb: Operand::Previous }
    }

    fn push(&mut self, image: UnitImage, coordinates: Coordinates, rgb: Combine, alpha: Combine) {
        self.units.push(Unit { image, coordinates, rgb, alpha, constant: [1.0; 4] });
        self.rgb = Operand::Previous;
    }

    fn input(&self, name: &str) -> Result<UnitImage, String> {
        let index = self.batch.inputs.iter().position(|input| input.name == name);
        let index = index.ok_or_else(|| format!("what its program means names an input `{name}` that it lacks"))?;
        Ok(UnitImage::Input { index, red_as_alpha: false })
    }

    fn modulated(&self) -> Combine {
        Combine::Modulate(self.rgb, Operand::Texture)
    }

    /// The surface's own textures: the decal's RGB where `decal` says so, and alpha for the alpha test.
    pub fn surface(&mut self, texturing: &Texturing, decal: bool, tested: bool) -> Result<(), String> {
        let coordinates = texturing.object_linear.map_or(Coordinates::Mesh, Coordinates::ObjectLinear);
        let test = texturing.alpha_test.as_ref().filter(|_| tested);
        let kept = Combine::Replace(Operand::Previous);
        let by_texture = Combine::Modulate(Operand::Previous, Operand::Texture);
        let decal_alpha = test.is_some_and(|test| test.decal);
        if decal || decal_alpha {
            let rgb = if decal { self.modulated() } else { Combine::Replace(self.rgb) };
            let alpha = if decal_alpha { by_texture } else { kept };
            self.push(self.input("decal_map")?, coordinates.clone(), rgb, alpha);
        }
        if let (Some(test), Ok(UnitImage::Input { index, .. })) = (test, self.input("alpha_map")) {
            let image = UnitImage::Input { index, red_as_alpha: test.map_in_red };
            self.push(image, coordinates, Combine::Replace(self.rgb), by_texture);
        }
        Ok(())
    }

    /// Takes `constant` from the primary colour.
    pub fn subtract(&mut self, constant: [f32; 3]) {
        let (rgb, kept) = (Combine::Subtract(self.rgb, Operand::Constant), Combine::Replace(Operand::Previous));
        self.push(UnitImage::Mask(Mask::White), Coordinates::Constant, rgb, kept);
        self.constant([constant[0], constant[1], constant[2], 1.0]);
    }

    fn constant(&mut self, constant: [f32; 4]) {
        if let Some(unit) = self.units.last_mut() {
            unit.constant = constant;
        }
    }

    /// Modulates by the light's shade; with dimming by `dimming + (1 - dimming)·shade`.
    pub fn shade(&mut self, shade: &Shade, projection: &Projection, dimming: f32) -> Result<(), String> {
        let name = match shade {
            Shade::Lit => return Ok(()),
            Shade::Shader(what) => return Err((*what).to_owned()),
            Shade::Texture { input, .. } => input,
        };
        let (image, coordinates) = (self.input(name)?, map_coordinates(projection));
        let kept = Combine::Replace(Operand::Previous);
        if dimming == 0.0 {
            self.push(image, coordinates, self.modulated(), kept);
            return Ok(());
        }
        // The shade first, so that the primary colour is still there to be modulated by what comes of it.
        let dimmed = Combine::Interpolate(Operand::Texture, Operand::Constant, Operand::ConstantAlpha);
        self.push(image, coordinates, dimmed, kept);
        self.constant([1.0, 1.0, 1.0, 1.0 - dimming]);
        let by_primary = Combine::Modulate(Operand::Previous, Operand::Primary);
        self.push(UnitImage::Mask(Mask::White), Coordinates::Constant, by_primary, kept);
        Ok(())
    }

    /// Modulates by the image that is projected through the frustum.
    pub fn beam(&mut self, name: &str, projection: &Projection) -> Result<(), String> {
        let image = self.input(name)?;
        self.push(image, frustum_coordinates(projection), self.modulated(), Combine::Replace(Operand::Previous));
        Ok(())
    }

    /// 0 behind the light and outside its frustum's sides; with `alpha` in alpha too.
    pub fn reach(&mut self, projection: &Projection, behind: bool, alpha: bool) {
        let by_texture = Combine::Modulate(Operand::Previous, Operand::Texture);
        let alpha = if alpha { by_texture } else { Combine::Replace(Operand::Previous) };
        if behind {
            self.push(UnitImage::Mask(Mask::Step), before_the_light(projection), self.modulated(), alpha);
        }
        if !projection.cone {
            self.push(UnitImage::Mask(Mask::Square), frustum_coordinates(projection), self.modulated(), alpha);
        }
    }

    /// Alpha: the square of the distance from the light's axis, in units of the cone's radius, at most 1. Must come first;
    /// the units behind it find the primary colour.
    pub fn cone(&mut self, projection: &Projection) {
        let dot = Combine::Dot3Rgba(Operand::Texture, Operand::Texture);
        let kept = Combine::Replace(Operand::Previous);
        self.push(UnitImage::Mask(Mask::Ramp), ramp_coordinates(projection), dot, kept);
        self.rgb = Operand::Primary;
    }

    /// The units; a cone that nothing follows would leave its own colour.
    pub fn finish(mut self) -> Vec<Unit> {
        if self.rgb == Operand::Primary {
            let kept = Combine::Replace(Operand::Previous);
            self.push(UnitImage::Mask(Mask::White), Coordinates::Constant, Combine::Replace(Operand::Primary), kept);
        }
        self.units
    }
}

/// The light's coordinates as the scene has them set up, with `then` behind the texture matrix.
fn coordinates(projection: &Projection, then: DMat4) -> Coordinates {
    let texgen = &projection.texgen;
    Coordinates::EyeLinear {
        planes: texgen.planes,
        modelview: texgen.modelview,
        texture_matrix: then * texgen.texture_matrix,
    }
}

fn map_coordinates(projection: &Projection) -> Coordinates {
    coordinates(projection, DMat4::IDENTITY)
}

/// From the map's coordinates to the frustum's square.
fn frustum_from_map(projection: &Projection) -> DMat4 {
    projection.frustum_from_map.map_or(DMat4::IDENTITY, |by| {
        let [x, y, z, w] = by.as_dvec4().to_array();
        DMat4::from_cols(DVec4::X * x, DVec4::Y * y, DVec4::Z, DVec4::new(z, w, 0.0, 1.0))
    })
}

fn frustum_coordinates(projection: &Projection) -> Coordinates {
    coordinates(projection, frustum_from_map(projection))
}

fn ramp_coordinates(projection: &Projection) -> Coordinates {
    let ramp = DMat4::from_cols(DVec4::X * 0.5, DVec4::Y * 0.5, DVec4::Z, DVec4::new(0.25, 0.25, 0.0, 1.0));
    coordinates(projection, ramp * frustum_from_map(projection))
}

/// s = 0.5 + q: an eye plane of its own, set under the identity.
fn before_the_light(projection: &Projection) -> Coordinates {
    let texgen = &projection.texgen;
    let q = (texgen.texture_matrix * texgen.eye_planes).row(3);
    let planes = DMat4::from_cols(q + DVec4::W * 0.5, DVec4::ZERO, DVec4::ZERO, DVec4::W).transpose();
    Coordinates::EyeLinear { planes, modelview: DMat4::IDENTITY, texture_matrix: DMat4::IDENTITY }
}
