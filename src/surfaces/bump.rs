//! Bump-mapped surfaces [GDC, "Per-Pixel Lighting Math"]: vectors computed per fragment, or register combiners. Knows
//! materials and variants; of lights only their number.

use std::sync::Arc;

use super::lights::LightParts;
use crate::combiners::{self, CombinerProgram, Precision, Register};
use crate::geometry::bump::{Bump, Gloss, NormalFormat, TexelLevels};
use crate::geometry::normal_map::HeightWrap;
use crate::lights::Ending;
use crate::lights::appearance::Appearance;
use crate::lights::drawable::upload;
use crate::lights::ending::FormulaPart;
use crate::pass::{
    BumpMap, Chunk, Define, Filter, Format, GlossSource, ImageDesc, ImageId, Input, PassList, Sampler, Storage,
    Uniform, UniformValue, Wrap, glsl,
};
use crate::scene::{BumpMethod, BumpShading, Normalize};

/// Bumps of an item in one pass.
#[derive(Clone)]
pub enum Bumps {
    /// Flat, or nothing that depends on normals.
    None,
    /// Vectors per fragment.
    Computed,
    /// Register combiners, for one light.
    Combined(Arc<CombinerProgram>),
}

impl Bumps {
    /// The bumps of `item` where `lights` light it by its normals.
    pub fn of(item: &Appearance<'_>, lights: &[&LightParts], shading: &BumpShading, ending: &Ending) -> Self {
        if item.bump().is_none() {
            return Self::None;
        }
        match (&shading.method, ending, lights) {
            // Without highlights and decal: a view.
            (BumpMethod::OnePass(program), Ending::Lit | Ending::Part(FormulaPart::Diffuse), [_]) => {
                Self::Combined(program.clone())
            }
            (BumpMethod::ThreePass { diffuse, .. }, Ending::Part(FormulaPart::Diffuse), [_]) => {
                Self::Combined(diffuse.clone())
            }
            (BumpMethod::ThreePass { specular, .. }, Ending::Part(FormulaPart::Specular), [_]) => {
                Self::Combined(specular.clone())
            }
            _ => Self::Computed,
        }
    }

    pub fn any(&self) -> bool {
        !matches!(self, Self::None)
    }

    pub fn are_combined(&self) -> bool {
        matches!(self, Self::Combined(_))
    }

    pub fn are_computed(&self) -> bool {
        matches!(self, Self::Computed)
    }

    /// Defines, beside those of other surfaces.
    pub fn defines(&self, bump: Option<&Bump>, shading: &BumpShading, lights: &[&LightParts]) -> Vec<Define> {
        let Some(bump) = bump.filter(|_| self.any()) else { return Vec::new() };
        let flags = [
            ("BUMP", self.are_computed()),
            ("SELF_SHADOW", self.are_computed() && shading.self_shadow),
            ("COMBINED", self.are_combined()),
            ("NORMAL_SIGNED", bump.format == NormalFormat::Signed),
            ("UNIT_VECTORS", self.are_combined() && shading.normalize != Normalize::Exact),
        ];
        let mut defines: Vec<Define> =
            flags.into_iter().filter(|(_, set)| *set).map(|(name, _)| Define::flag(name)).collect();
        if self.are_combined() {
            let calls = lights.iter().map(|light| format!("set_tangent_vectors_{}(eye, basis);", light.index));
            defines.push(Define::calls("TANGENT_VECTORS", "eye, basis", calls.collect()));
        }
        defines
    }

    /// Bumps in the terms of fixed function.
    ///
    /// # Errors
    ///
    /// Something that it cannot express, in words.
    pub fn meaning(
        &self,
        bump: &Bump,
        shading: &BumpShading,
        ending: &Ending,
        [two_sided, specular]: [bool; 2],
    ) -> Result<BumpMap, &'static str> {
        let alone = *ending == Ending::Part(FormulaPart::Specular);
        let reads_light = |program: &CombinerProgram| {
            let portions = program.stages.iter().flat_map(|stage| [&stage.rgb, &stage.alpha]).flatten();
            portions.flat_map(|portion| portion.inputs).any(|input| input.register == Register::Texture(1))
        };
        let why = match () {
            () if !self.are_combined() => {
                "bumps by vectors that are found for each fragment: choose bump = \"three-pass\""
            }
            () if shading.has_own_program => "bumps by a program of register combiners of the scene's own",
            () if shading.normalize == Normalize::Exact => {
                "bumps by vectors that are normalised for each fragment: choose normalize = { cube = 64 }"
            }
            () if shading.precision != Precision::Float => "bumps by register combiners of 9 bits",
            () if two_sided => "bumps that may be seen from behind: write closed = true where none are",
            () if specular && !alone => {
                "highlights on bumps beside diffuse light, whose products take one alpha each: choose bump = \"three-pass\""
            }
            () if alone && matches!(self, Self::Combined(program) if reads_light(program)) => {
                "highlights that end where the light sinks below the surface, by a third texture: choose two_units = true"
            }
            () => return Ok(BumpMap { is_signed: bump.map.is_signed }),
        };
        Err(why)
    }

    /// Textures.
    pub fn inputs(&self, bump: Option<&Bump>, shading: &BumpShading, list: &mut PassList) -> Vec<Input> {
        let Some(bump) = bump.filter(|_| self.any()) else { return Vec::new() };
        let mut inputs = vec![normal_map(bump, list)];
        if let (Self::Combined(_), Normalize::Cube { size, .. }) = (self, shading.normalize) {
            inputs.push(unit_vectors(size, list));
        }
        inputs
    }

    /// The chunk that ends the fragment stage of combined bumps, after that of their program.
    pub fn combiner_chunks(&self, precision: Precision, lights: &[&LightParts]) -> Option<[Chunk; 2]> {
        let (Self::Combined(program), [light]) = (self, lights) else { return None };
        let text = combiners::fragment(program, precision);
        let program = Chunk { name: "register combiners".into(), text: text.into() };
        Some([program, glsl!("surfaces/combined.frag").for_light(light.index)])
    }
}

/// Tests whether the colours of `lights` on a surface lie in [0, 1] without a clamp: products of colours and shares that do.
pub fn are_in_range(uniforms: &[Uniform], lights: &[&LightParts]) -> bool {
    let starts = ["scene_ambient", "material_diffuse", "material_specular", "light_diffuse_", "light_specular_"];
    let is_color = |uniform: &&Uniform| starts.iter().any(|start| uniform.name.starts_with(start));
    let is_in_range = |value: &UniformValue| match value {
        UniformValue::Vec3(color) => color.min_element() >= 0.0 && color.max_element() <= 1.0,
        _ => false,
    };
    let is_plain = |light: &&LightParts| !light.has_ambient && !light.has_attenuation && light.projected.is_none();
    lights.iter().all(is_plain) && uniforms.iter().filter(is_color).all(|uniform| is_in_range(&uniform.value))
}

/// Binds a normal map.
pub fn normal_map(bump: &Bump, list: &mut PassList) -> Input {
    let format = if bump.map.is_signed { Format::Rgba8Signed } else { Format::Rgba8 };
    let image = level_image(&bump.map, format, list);
    let wrap = if bump.border == HeightWrap::Clamp { Wrap::ClampToEdge } else { Wrap::Repeat };
    Input {
        name: "normal_map".into(),
        image,
        sampler: Sampler { filter: Filter::Trilinear, wrap, compare: None, lod_halves: None },
    }
}

fn level_image(map: &Arc<TexelLevels>, format: Format, list: &mut PassList) -> ImageId {
    let (label, storage) = (format!("normals of {}", map.name), Storage::Levels(map.clone()));
    list.filled_image(ImageDesc { label, size: [map.width, map.height], format, storage })
}

/// Binds the cube map that normalises.
fn unit_vectors(size: u32, list: &mut PassList) -> Input {
    let label = String::from("unit vectors");
    let desc = ImageDesc { label, size: [size; 2], format: Format::Rgba8, storage: Storage::UnitVectors };
    let image = list.filled_image(desc);
    let sampler = Sampler { filter: Filter::Linear, wrap: Wrap::ClampToEdge, compare: None, lod_halves: None };
    Input { name: "unit_vectors".into(), image, sampler }
}

/// Source of an item's gloss in the terms of fixed function.
pub fn gloss_source(item: &Appearance<'_>) -> GlossSource {
    match item.gloss() {
        None => GlossSource::One,
        Some(Gloss::DecalAlpha) => GlossSource::DecalAlpha,
        Some(Gloss::Map(map)) => GlossSource::Map { in_red: !map.has_alpha },
    }
}

/// Defines and textures of an item's gloss; none where all of it shines.
pub fn gloss(item: &Appearance<'_>, list: &mut PassList) -> (Vec<Define>, Vec<Input>) {
    match item.gloss() {
        None => (Vec::new(), Vec::new()),
        Some(Gloss::DecalAlpha) => (vec![Define::flag("GLOSS_DECAL")], Vec::new()),
        Some(Gloss::Map(map)) => {
            let channel = if map.has_alpha { "a" } else { "r" };
            let input = upload("gloss_map", map, crate::lights::drawable::DECAL_SAMPLER, list);
            (vec![Define::word("GLOSS_MAP", channel)], vec![input])
        }
    }
}
