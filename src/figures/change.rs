//! Changes of a panel's scene that no key makes: bump mapping that is wrong on purpose, surfaces that it is compared with, and
//! skins that are made in memory. They apply to every object with a bump map.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::relief;
use super::skins;
use crate::geometry::bump::{Bump, TexelLevels};
use crate::geometry::normal_map::MipColors;
use crate::geometry::{Material, Mesh, skin};
use crate::scene::{Object, Scene};

/// A change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneChange {
    /// Highlights everywhere as strong as the material says.
    WithoutGloss,
    /// The decal has light from above painted in, on the bumps of its skin.
    PreLit,
    /// The same without a bump map.
    PreLitFlat,
    /// Wrong on purpose: T and B turned around where the skin is mirrored.
    TangentsTurned,
    /// Wrong on purpose: N as T × B, which looks inwards where the skin is mirrored.
    NormalsInwards,
    /// Wrong on purpose: means of normals made as long as one, and no dimming.
    Undimmed,
    /// Wrong on purpose: means of normals as long as they are, and dimmed by their length once more.
    DimmedTwice,
    /// The surface really displaced, without a bump map.
    Displaced,
    /// Wrong on purpose: the skin's pieces turned at random, and apart; `repacked`: packed again after that. Maps are no
    /// longer those of the skin: only its directions are.
    Careless { repacked: bool },
    /// The skin packed again; `unmirror`: mirrored pieces with texels of their own.
    Repacked { unmirror: bool },
}

impl SceneChange {
    /// Changes a scene.
    ///
    /// # Errors
    ///
    /// A skin that cannot be packed.
    pub fn apply(self, scene: &mut Scene) -> Result<(), skin::Error> {
        scene.objects.iter_mut().try_for_each(|object| self.apply_to(object))
    }

    fn apply_to(self, object: &mut Object) -> Result<(), skin::Error> {
        let Some(mut material) = object.material.as_deref().cloned() else { return Ok(()) };
        let Some(bump) = material.bump.clone() else { return Ok(()) };
        match self {
            Self::WithoutGloss => material.gloss = None,
            Self::PreLit => pre_light(object, &mut material, &bump),
            Self::PreLitFlat => {
                pre_light(object, &mut material, &bump);
                (object.bases, material.bump) = (None, None);
            }
            Self::TangentsTurned => {
                let mesh = Arc::make_mut(&mut object.mesh);
                let mirrored = mirrored(mesh);
                if let Some(tangents) = &mut mesh.tangents {
                    reverse(&mut tangents.tangents, &mirrored);
                    reverse(&mut tangents.bitangents, &mirrored);
                }
            }
            Self::NormalsInwards => {
                let mesh = Arc::make_mut(&mut object.mesh);
                let mirrored = mirrored(mesh);
                reverse(&mut mesh.normals, &mirrored);
            }
            Self::Undimmed => material.bump = Some(Arc::new(with_alpha(&bump, MipColors::UnitAndLength, |_| 1.0))),
            Self::DimmedTwice => {
                material.bump = Some(Arc::new(with_alpha(&bump, MipColors::Mean, |mean| mean.length())));
            }
            Self::Displaced => {
                object.mesh = Arc::new(relief::displaced(&object.mesh, &bump));
                (object.bases, material.bump) = (None, None);
            }
            Self::Careless { repacked } => skins::turn_carelessly(object, &bump, repacked)?,
            Self::Repacked { unmirror } => skins::repack(object, &mut material, &bump, unmirror)?,
        }
        object.material = Some(Arc::new(material));
        Ok(())
    }
}

/// Vertices whose skin is mirrored: T × B looks inwards.
fn mirrored(mesh: &Mesh) -> Vec<bool> {
    let Some(tangents) = &mesh.tangents else { return Vec::new() };
    let ways = tangents.tangents.iter().zip(&tangents.bitangents).zip(&mesh.normals);
    ways.map(|((t, b), n)| Vec3::from_array(*t).cross(Vec3::from_array(*b)).dot(Vec3::from_array(*n)) < 0.0).collect()
}

fn reverse(ways: &mut [[f32; 3]], chosen: &[bool]) {
    let chosen = ways.iter_mut().zip(chosen).filter(|(_, is_chosen)| **is_chosen);
    chosen.for_each(|(way, _)| *way = way.map(|part| -part));
}

fn pre_light(object: &Object, material: &mut Material, bump: &Bump) {
    let up = object.world_from_model.inverse().transform_vector3(DVec3::Y).normalize_or_zero();
    if let Some(decal) = &material.decal {
        material.decal = Some(Arc::new(skins::pre_lit(decal, &object.mesh, bump, up)));
    }
}

/// The bump map with other colours in its levels, and an alpha by each texel's mean.
fn with_alpha(bump: &Bump, colors: MipColors, alpha: impl Fn(DVec3) -> f64) -> Bump {
    let levels = relief::normals(&bump.source, bump.border).levels();
    let packed = |level: &crate::geometry::normal_map::NormalLevel| {
        let (most, mut bytes) = match bump.map.is_signed {
            true => (127.0, bytemuck::cast_vec(level.signed(colors))),
            false => (255.0, level.unsigned(colors)),
        };
        for (texel, mean) in bytes.iter_mut().zip(&level.means) {
            texel[3] = (most * alpha(*mean).clamp(0.0, 1.0)).round() as u8;
        }
        bytes
    };
    let map = TexelLevels { levels: levels.iter().map(packed).collect(), ..(*bump.map).clone() };
    Bump { map: Arc::new(map), ..bump.clone() }
}
