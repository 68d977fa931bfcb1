//! Stacks up a layer's texture units: a surface's own textures, a light's shade, beam and reach.

use glam::{DMat4, DVec4};

use super::layer::{AlphaSource, Combine, EyeLinear, Mask, Operand, TangentVector, Unit, UnitCoordinates, UnitImage};
use crate::geometry::Placement;
use crate::pass::{Batch, BumpMap, Decal, GlossSource, Projection, Shade, Texturing};

/// Result of the unit before.
const KEPT: Combine = Combine::Replace(Operand::Previous);
/// The result of the unit before, modulated by the unit's texture.
const BY_TEXTURE: Combine = Combine::Modulate(Operand::Previous, Operand::Texture);

/// The units so far, and where the next finds their result.
pub struct Stack<'a> {
    batch: &'a Batch,
    units: Vec<Unit>,
    /// True if alpha holds what [`Stack::cone`] put there, to be made steeper.
    cone: bool,
}

/// Weight of a layer's light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weight {
    Shade,
    /// `dimming + (1 - dimming)·shade`.
    Dimmed(f32),
    /// `dimming·(1 - shade)`.
    Left(f32),
}

/// The units that make a cone's alpha steeper, each by [`STEEPER`]. The alpha test may compare in the precision of the
/// colour buffer: with 8 bits of alpha the cone would end early by 1/510 of its radius's square; so, by 256 times
/// less.
const STEEP_UNITS: usize = 4;
const STEEPER: f32 = 4.0;

impl<'a> Stack<'a> {
    pub fn new(batch: &'a Batch) -> Self {
        Self { batch, units: Vec::new(), cone: false }
    }

    fn push(&mut self, image: UnitImage, coordinates: UnitCoordinates, rgb: Combine, alpha: Combine) {
        let alpha_scale = if self.cone { STEEPER } else { 1.0 };
        let (placement, rgb_scale, constant) = (Placement::default(), 1.0, [1.0; 4]);
        self.units.push(Unit { image, coordinates, placement, rgb, alpha, rgb_scale, alpha_scale, constant });
    }

    /// Sets the scales of the unit that was pushed last.
    fn scale(&mut self, rgb: f32, alpha: f32) {
        if let Some(unit) = self.units.last_mut() {
            (unit.rgb_scale, unit.alpha_scale) = (rgb, alpha);
        }
    }

    /// Places the texture of the unit that was pushed last.
    fn place(&mut self, placement: Placement) {
        if let Some(unit) = self.units.last_mut() {
            unit.placement = placement;
        }
    }

    fn input(&self, name: &str) -> Result<UnitImage, String> {
        let index = self.batch.inputs.iter().position(|input| input.name == name);
        let index = index.ok_or_else(|| format!("what its program means names an input `{name}` that it lacks"))?;
        Ok(UnitImage::Input { index, alpha: AlphaSource::Own })
    }

    /// The surface's own textures: the decal's RGB where `decal` says so, and alpha for the alpha test.
    pub fn surface(&mut self, texturing: &Texturing, decal: bool, tested: bool) -> Result<(), String> {
        let coordinates = own_coordinates(texturing);
        let test = texturing.alpha_test.as_ref().filter(|_| tested);
        if decal {
            self.push(self.input("decal_map")?, coordinates.clone(), BY_TEXTURE, KEPT);
            self.place(texturing.decal_placement);
        }
        if test.is_some_and(|test| test.decal) {
            self.push(self.input("decal_alpha_map")?, coordinates.clone(), KEPT, BY_TEXTURE);
            self.place(texturing.decal_placement);
        }
        if let (Some(test), Ok(UnitImage::Input { index, .. })) = (test, self.input("alpha_map")) {
            let alpha = if test.map_in_red { AlphaSource::Red } else { AlphaSource::Own };
            let image = UnitImage::Input { index, alpha };
            self.push(image, coordinates, KEPT, BY_TEXTURE);
            self.place(texturing.alpha_placement);
        }
        Ok(())
    }

    /// The decal, with the gloss in alpha.
    pub fn decal(&mut self, decal: &Decal) -> Result<(), String> {
        let coordinates = own_coordinates(&decal.texturing);
        let own = Combine::Replace(Operand::Texture);
        if decal.texturing.decal {
            let alpha = if decal.gloss == GlossSource::DecalAlpha { own } else { KEPT };
            self.push(self.input("decal_map")?, coordinates.clone(), own, alpha);
            self.place(decal.texturing.decal_placement);
        }
        if let GlossSource::Map { in_red } = decal.gloss
            && let UnitImage::Input { index, .. } = self.input("gloss_map")?
        {
            let alpha = if in_red { AlphaSource::Red } else { AlphaSource::Own };
            self.push(UnitImage::Input { index, alpha }, coordinates, KEPT, own);
        }
        Ok(())
    }

    /// The primary colour in the light of bumps: times dim (N' . L) min(1, 8 L_z), or times (N' . H)^8 min(1, 8 H_z) [GDC,
    /// "Per-Pixel Lighting Math"]. Must come first: it names textures by their units. Alpha is the primary colour's.
    pub fn bumps(&mut self, map: BumpMap, texturing: &Texturing, vector: TangentVector) -> Result<(), String> {
        let (UnitImage::Input { index: cube, .. }, normals) = (self.input("unit_vectors")?, self.input("normal_map")?)
        else {
            return Ok(());
        };
        // Alpha: DOT3 of the packed vector and (1/2, 1/2, 1) is z. This unit scales it by 4, the next one by 2; each
        // clamps: min(1, 8 z).
        let down = Combine::Dot3Rgba(Operand::Texture, Operand::Constant);
        self.push(UnitImage::Cube(cube), UnitCoordinates::Tangent(vector), down, KEPT);
        self.constant([0.5, 0.5, 1.0, 1.0]);
        self.scale(4.0, 4.0);
        let coordinates = own_coordinates(texturing);
        if map.is_signed {
            let packed = Combine::Interpolate(Operand::Texture, Operand::Constant, Operand::ConstantAlpha);
            self.push(normals, coordinates, packed, KEPT);
            self.constant([1.0, 1.0, 1.0, 0.5]);
            self.scale(1.0, 2.0);
            self.pass_on(Combine::Dot3Rgb(Operand::Previous, Operand::Other(0)), KEPT);
        } else {
            self.push(normals, coordinates, Combine::Dot3Rgb(Operand::Texture, Operand::Other(0)), KEPT);
            self.scale(1.0, 2.0);
        }
        let by = |factor| Combine::Modulate(Operand::Previous, factor);
        if vector.half {
            (0..3).for_each(|_| self.pass_on(by(Operand::Previous), KEPT));
        } else {
            self.pass_on(by(Operand::OtherAlpha(1)), KEPT);
        }
        self.pass_on(by(Operand::PreviousAlpha), KEPT);
        self.pass_on(by(Operand::Primary), Combine::Replace(Operand::Primary));
        Ok(())
    }

    /// Takes `constant` from the primary colour.
    pub fn subtract(&mut self, constant: [f32; 3]) {
        self.pass_on(Combine::Subtract(Operand::Previous, Operand::Constant), KEPT);
        self.constant([constant[0], constant[1], constant[2], 1.0]);
    }

    fn constant(&mut self, constant: [f32; 4]) {
        if let Some(unit) = self.units.last_mut() {
            unit.constant = constant;
        }
    }

    /// Modulates by the light's shade, or by the dimmed shade.
    pub fn shade(&mut self, shade: &Shade, projection: Option<&Projection>, weight: Weight) -> Result<(), String> {
        let name = match shade {
            Shade::Lit => return Ok(()),
            Shade::Dark if weight == Weight::Shade => {
                self.pass_on(Combine::Replace(Operand::Constant), KEPT);
                self.constant([0.0, 0.0, 0.0, 1.0]);
                return Ok(());
            }
            Shade::Dark => return Err(String::from("a shadow everywhere, dimmed")),
            Shade::Shader(what) => return Err((*what).to_owned()),
            Shade::Texture { input, .. } => input,
        };
        let projection = projection.ok_or("a shade texture of a light without texture coordinates")?;
        let (image, coordinates) = (self.input(name)?, map_coordinates(projection));
        let (combine, constant) = match weight {
            Weight::Shade => {
                self.push(image, coordinates, BY_TEXTURE, KEPT);
                return Ok(());
            }
            Weight::Dimmed(dimming) => {
                let combine = Combine::Interpolate(Operand::Texture, Operand::Constant, Operand::ConstantAlpha);
                (combine, [1.0, 1.0, 1.0, 1.0 - dimming])
            }
            Weight::Left(dimming) => {
                let combine = Combine::Interpolate(Operand::Constant, Operand::ConstantAlpha, Operand::Texture);
                (combine, [0.0, 0.0, 0.0, dimming])
            }
        };
        // The shade first, so that the primary colour is still available for its result.
        self.push(image, coordinates, combine, KEPT);
        self.constant(constant);
        let by_primary = Combine::Modulate(Operand::Previous, Operand::Primary);
        self.pass_on(by_primary, KEPT);
        Ok(())
    }

    /// Modulates by a constant.
    pub fn weigh(&mut self, weight: f32) {
        self.pass_on(Combine::Modulate(Operand::Previous, Operand::Constant), KEPT);
        self.constant([weight, weight, weight, 1.0]);
    }

    /// Modulates alpha by the light's shade.
    pub fn shade_in_alpha(&mut self, shade: &Shade, projection: Option<&Projection>) -> Result<(), String> {
        let name = match shade {
            Shade::Lit | Shade::Dark => return Ok(()), // the primary colour has it
            Shade::Shader(what) => return Err((*what).to_owned()),
            Shade::Texture { input, .. } => input,
        };
        let projection = projection.ok_or("a shade texture of a light without texture coordinates")?;
        let UnitImage::Input { index, .. } = self.input(name)? else { return Ok(()) };
        let image = UnitImage::Input { index, alpha: AlphaSource::Comparison };
        self.push(image, map_coordinates(projection), KEPT, BY_TEXTURE);
        Ok(())
    }

    /// Modulates by the image that is projected through the frustum.
    pub fn beam(&mut self, name: &str, projection: &Projection) -> Result<(), String> {
        let image = self.input(name)?;
        self.push(image, frustum_coordinates(projection), BY_TEXTURE, KEPT);
        Ok(())
    }

    /// 0 behind the light and outside its frustum's sides, where those bound it; with `alpha` in alpha too.
    pub fn reach(&mut self, projection: &Projection, behind: bool, alpha: bool) {
        if !projection.bounded {
            return;
        }
        let alpha = if alpha { BY_TEXTURE } else { KEPT };
        if behind {
            self.push(UnitImage::Mask(Mask::Step), before_the_light(projection), BY_TEXTURE, alpha);
        }
        if !projection.cone {
            self.push(UnitImage::Mask(Mask::Square), frustum_coordinates(projection), BY_TEXTURE, alpha);
        }
    }

    /// Alpha: above 0 inside the cone, 0 outside. The dot product finds the square of the distance from the light's
    /// axis in units of the cone's radius; alpha is what it lacks of 1, made steep. Must come first: the units behind
    /// it find the primary colour as it was.
    pub fn cone(&mut self, projection: &Projection) {
        let dot = Combine::Dot3Rgba(Operand::Texture, Operand::Texture);
        self.push(UnitImage::Mask(Mask::Ramp), ramp_coordinates(projection), dot, KEPT);
        self.cone = true;
        let inside = Combine::Subtract(Operand::Constant, Operand::Previous);
        self.pass_on(Combine::Replace(Operand::Primary), inside);
    }

    /// A unit that is there for its combiners.
    fn pass_on(&mut self, rgb: Combine, alpha: Combine) {
        self.push(UnitImage::Mask(Mask::White), UnitCoordinates::Constant, rgb, alpha);
    }

    /// The units, with as many more as a cone needs to be steep.
    pub fn finish(mut self) -> Vec<Unit> {
        while self.cone && self.units.len() <= STEEP_UNITS {
            self.pass_on(KEPT, KEPT);
        }
        self.units
    }
}

/// Coordinates of a surface's own textures.
fn own_coordinates(texturing: &Texturing) -> UnitCoordinates {
    texturing.object_linear.map_or(UnitCoordinates::Mesh, UnitCoordinates::ObjectLinear)
}

/// The light's coordinates as the scene has them set up, with `then` behind the texture matrix.
fn coordinates(projection: &Projection, then: DMat4) -> UnitCoordinates {
    let texgen = &projection.texgen;
    let texture_matrix = then * texgen.texture_matrix;
    UnitCoordinates::EyeLinear(Box::new(EyeLinear {
        planes: texgen.planes,
        modelview: texgen.modelview,
        texture_matrix,
    }))
}

fn map_coordinates(projection: &Projection) -> UnitCoordinates {
    coordinates(projection, DMat4::IDENTITY)
}

/// Matrix from the map's coordinates to the frustum's square.
fn frustum_from_map(projection: &Projection) -> DMat4 {
    projection.frustum_from_map.map_or(DMat4::IDENTITY, |by| {
        let [x, y, z, w] = by.as_dvec4().to_array();
        DMat4::from_cols(DVec4::X * x, DVec4::Y * y, DVec4::Z, DVec4::new(z, w, 0.0, 1.0))
    })
}

fn frustum_coordinates(projection: &Projection) -> UnitCoordinates {
    coordinates(projection, frustum_from_map(projection))
}

fn ramp_coordinates(projection: &Projection) -> UnitCoordinates {
    let ramp = DMat4::from_cols(DVec4::X * 0.5, DVec4::Y * 0.5, DVec4::Z, DVec4::new(0.25, 0.25, 0.0, 1.0));
    coordinates(projection, ramp * frustum_from_map(projection))
}

/// s = 0.5 + q: an eye plane of its own, set under the identity.
fn before_the_light(projection: &Projection) -> UnitCoordinates {
    let texgen = &projection.texgen;
    let q = (texgen.texture_matrix * texgen.eye_planes).row(3);
    let planes = DMat4::from_cols(q + DVec4::W * 0.5, DVec4::ZERO, DVec4::ZERO, DVec4::W).transpose();
    let (modelview, texture_matrix) = (DMat4::IDENTITY, DMat4::IDENTITY);
    UnitCoordinates::EyeLinear(Box::new(EyeLinear { planes, modelview, texture_matrix }))
}
