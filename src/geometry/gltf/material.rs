//! Materials of a glTF in the terms of fixed-function GL: base colour, alpha test and normal map [Khronos, "glTF 2.0
//! Specification", 3.9]. What metals, rough surfaces, occlusion and emitted light add is named and left out.

use std::sync::Arc;

use gltf::json::extensions::texture::TextureTransform;
use gltf::json::material::{AlphaMode, NormalTexture};
use gltf::json::validation::Checked;

use super::super::bump::{Bump, BumpSource, NormalFormat};
use super::super::normal_map::{HeightWrap, MipColors};
use super::super::tally::WarningTally;
use super::super::tangents::BasisFit;
use super::super::{Error, Material, Placement, Texture};
use super::file::File;
use super::texture::{Info, Pictures, Sampled, Uv};

/// A material, and the coordinates that its textures take.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub material: Material,
    /// `None`: it has no texture.
    pub uv: Option<Uv>,
    pub double_sided: bool,
}

impl Surface {
    /// The material of a primitive that names none.
    pub fn absent() -> Self {
        let white = [1.0; 3];
        let material = Material { ambient: white, diffuse: white, ..Material::default() };
        Self { material, uv: None, double_sided: false }
    }

    /// Reads `materials[index]`.
    pub fn read(index: usize, file: &File, pictures: &mut Pictures, odd: &mut WarningTally) -> Result<Self, Error> {
        let source = &file.root.materials[index];
        let place = format!("materials[{index}]");
        note_left_out(source, &place, file, odd);
        let pbr = &source.pbr_metallic_roughness;
        let base = pbr.base_color_texture.as_ref().map(|info| {
            let transform = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.as_ref());
            let place = format!("{place}.pbrMetallicRoughness.baseColorTexture");
            Info { index: info.index, set: info.tex_coord, transform, place }
        });
        let base = base.map(|info| pictures.sampled(&info, file, odd)).transpose()?.flatten();
        let turned = source.normal_texture.as_ref().map(|normal| normal_transform(normal, &place, file));
        let turned = turned.transpose()?.flatten();
        let normal = source.normal_texture.as_ref().map(|info| {
            let place = format!("{place}.normalTexture");
            Info { index: info.index, set: info.tex_coord, transform: turned.as_ref(), place }
        });
        let normal = normal.map(|info| pictures.sampled(&info, file, odd)).transpose()?.flatten();
        let normal = normal.filter(|normal| agrees(normal, base.as_ref(), &place, file, odd));
        let [red, green, blue, alpha] = pbr.base_color_factor.0;
        let factors = [red, green, blue, alpha];
        if let Some(wrong) = factors.iter().find(|factor| !(0.0..=1.0).contains(*factor)) {
            let what = format!("has a factor of {wrong}; one lies in [0, 1]");
            return Err(file.error(format!("{place}.pbrMetallicRoughness.baseColorFactor"), what));
        }
        let color = [red, green, blue];
        let mode = alpha_mode(source, &place, file, odd)?;
        let (opacity, decal) = mode.apply(alpha, base.as_ref());
        let bump = normal.as_ref().map(|normal| Arc::new(bump(normal)));
        let clamped = base.as_ref().is_some_and(|base| base.clamped);
        let material = Material {
            name: source.name.clone().unwrap_or_else(|| place.clone()),
            ambient: color,
            diffuse: color,
            opacity,
            decal,
            decal_placement: Placement { clamped, ..Placement::default() },
            bump,
            opacity_origin: format!("{}: {place}", file.path.display()),
            ..Material::default()
        };
        let uv = base.as_ref().or(normal.as_ref()).map(|sampled| sampled.uv);
        Ok(Self { material, uv, double_sided: source.double_sided })
    }
}

/// The transform of a normal map, which the reader of its JSON keeps as it is written.
fn normal_transform(normal: &NormalTexture, place: &str, file: &File) -> Result<Option<TextureTransform>, Error> {
    const KEY: &str = "KHR_texture_transform";
    let written = normal.extensions.as_ref().and_then(|extensions| extensions.others.get(KEY));
    let read = written.map(|written| gltf::json::deserialize::from_value(written.clone())).transpose();
    read.map_err(|error| {
        file.error(format!("{place}.normalTexture.extensions.{KEY}"), format!("cannot be read: {error}"))
    })
}

/// Tests whether a normal map lies as the base colour does: a mesh has one set of coordinates.
fn agrees(normal: &Sampled, base: Option<&Sampled>, place: &str, file: &File, odd: &mut WarningTally) -> bool {
    let agrees = base.is_none_or(|base| base.uv == normal.uv);
    if !agrees {
        let what = || format!("{place}: its normal map takes other coordinates than its base colour: not drawn");
        odd.note("normal map of other coordinates", &file.path, 0, what);
    }
    agrees
}

/// The bump map of a normal map: y points up, as in OpenGL.
fn bump(normal: &Sampled) -> Bump {
    let border = if normal.clamped { HeightWrap::Clamp } else { HeightWrap::Repeat };
    let source = BumpSource::normals(&normal.texture, false);
    Bump::new(source, NormalFormat::default(), MipColors::default(), border, BasisFit::Orthogonal)
}

/// Meaning of alpha.
enum Alpha {
    Ignored,
    /// Fragments whose alpha is below the value are not drawn.
    Tested(f32),
}

/// Alpha of the renderer's alpha test.
const TEST: f32 = 0.5;

impl Alpha {
    /// The material's opacity and decal, so that an alpha test at 0.5 passes what this one does. Where the cut-off is below
    /// the half of the factor, the texels' alpha is scaled; it saturates at 1, which moves an edge by less than a texel.
    fn apply(&self, factor: f32, base: Option<&Sampled>) -> (f32, Option<Arc<Texture>>) {
        let texture = base.map(|base| base.texture.clone());
        let Self::Tested(cutoff) = *self else { return (1.0, texture.map(opaque)) };
        if cutoff <= 0.0 {
            return (1.0, texture.map(opaque));
        }
        let opacity = factor * (TEST / cutoff);
        if opacity <= 1.0 { (opacity, texture) } else { (1.0, texture.map(|texture| scaled(&texture, opacity))) }
    }
}

fn alpha_mode(source: &gltf::json::Material, place: &str, file: &File, odd: &mut WarningTally) -> Result<Alpha, Error> {
    Ok(match &source.alpha_mode {
        Checked::Valid(AlphaMode::Opaque) => Alpha::Ignored,
        Checked::Valid(AlphaMode::Mask) => Alpha::Tested(source.alpha_cutoff.map_or(TEST, |cutoff| cutoff.0)),
        Checked::Valid(AlphaMode::Blend) => {
            let what =
                || format!("{place}: alphaMode BLEND is drawn as MASK: what is less than half opaque is not there");
            odd.note("blend", &file.path, 0, what);
            Alpha::Tested(TEST)
        }
        Checked::Invalid => return Err(file.error(format!("{place}.alphaMode"), "is none of OPAQUE, MASK, BLEND")),
    })
}

/// The texture without its alpha.
fn opaque(texture: Arc<Texture>) -> Arc<Texture> {
    if !texture.has_alpha {
        return texture;
    }
    let mut copy = (*texture).clone();
    copy.rgba.iter_mut().skip(3).step_by(4).for_each(|alpha| *alpha = 255);
    copy.has_alpha = false;
    Arc::new(copy)
}

fn scaled(texture: &Texture, factor: f32) -> Arc<Texture> {
    let mut copy = texture.clone();
    for alpha in copy.rgba.iter_mut().skip(3).step_by(4) {
        *alpha = (f32::from(*alpha) * factor).round().min(255.0) as u8;
    }
    copy.has_alpha = copy.rgba.iter().skip(3).step_by(4).any(|alpha| *alpha != 255);
    Arc::new(copy)
}

/// Names what a material says beyond that.
fn note_left_out(source: &gltf::json::Material, place: &str, file: &File, odd: &mut WarningTally) {
    let pbr = &source.pbr_metallic_roughness;
    let is_metal = pbr.metallic_roughness_texture.is_some() || pbr.metallic_factor.0 != 0.0;
    let has_scale = source.normal_texture.as_ref().is_some_and(|normal| normal.scale != 1.0);
    let said = [
        (
            is_metal || pbr.roughness_factor.0 != 1.0,
            "is metallic or glossy: drawn as a rough surface of its base colour",
        ),
        (source.occlusion_texture.is_some(), "its occlusion map is not drawn"),
        (
            source.emissive_texture.is_some() || source.emissive_factor.0 != [0.0; 3],
            "the light that it emits is not drawn",
        ),
        (has_scale, "the scale of its normal map is taken as 1"),
    ];
    for (_, what) in said.into_iter().filter(|(is_said, _)| *is_said) {
        odd.note(what, &file.path, 0, || format!("{place}: {what}"));
    }
}
