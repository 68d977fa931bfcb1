//! Meaning of a variant of a surface to fixed function.

use glam::Vec3;

use super::bump;
use super::lights::{ADDED, LightParts};
use crate::lights::appearance::Appearance;
use crate::lights::drawable::Cutout;
use crate::lights::ending::FormulaPart;
use crate::lights::{Ending, Viewer};
use crate::pass::{BumpMap, Decal, FixedFunctionDesc, FixedFunctionLight, Lit, ShadeView};
use crate::scene::Scene;

/// Light that the variant shows.
#[derive(Clone, Copy)]
pub struct ShownColors {
    /// True if anything is specular.
    pub specular: bool,
    /// True if a light has ambient light of its own.
    pub ambient: bool,
    /// The scene's ambient light times the material's.
    pub scene_ambient: [f32; 3],
}

/// The variant in the terms of fixed function.
pub fn of(
    scene: &Scene,
    item: &Appearance<'_>,
    lights: &[&LightParts],
    viewer: &Viewer,
    ending: &Ending,
    shown: ShownColors,
    (cut, bumps): (&Cutout, Option<BumpMap>),
) -> FixedFunctionDesc {
    let clip_from_eye = viewer.clip_from_eye;
    let texturing = cut.meaning.clone();
    let material = item.material;
    let shines_alone = *ending == Ending::Part(FormulaPart::Specular);
    match (ending, lights.first()) {
        (Ending::Lit | Ending::Part(FormulaPart::Diffuse | FormulaPart::Specular), _) => {
            FixedFunctionDesc::Lit(Box::new(Lit {
                clip_from_eye,
                per_vertex: scene.shading.per_vertex,
                lit: item.lit,
                added: lights.iter().any(|light| light.defines.contains(&ADDED)),
                scene_ambient: if shines_alone { [0.0; 3] } else { shown.scene_ambient },
                ambient: if shown.ambient && !shines_alone { material.ambient } else { [0.0; 3] },
                diffuse: if lights.is_empty() || shines_alone { [0.0; 3] } else { material.diffuse },
                specular: if shown.specular { material.specular } else { [0.0; 3] },
                shininess: if shown.specular { material.shininess } else { 0.0 },
                texturing,
                bumps,
                lights: lights.iter().map(|light| light.meaning.clone()).collect(),
            }))
        }
        (Ending::Part(FormulaPart::Decal(_)), _) => {
            FixedFunctionDesc::Decal(Box::new(Decal { clip_from_eye, texturing, gloss: bump::gloss_source(item) }))
        }
        (Ending::Factors(factors), _) => {
            // A factor that a pass lacks is 1, and its light 0.
            let own = if factors.color { Vec3::from(material.diffuse) } else { Vec3::ONE };
            let alone = !factors.ambient && lights.is_empty();
            let ambient = if factors.ambient { Vec3::from(scene.shading.ambient) } else { Vec3::splat(alone.into()) };
            FixedFunctionDesc::Lit(Box::new(Lit {
                clip_from_eye,
                per_vertex: false,
                lit: false,
                added: false,
                scene_ambient: (ambient * own).to_array(),
                ambient: [0.0; 3],
                diffuse: own.to_array(),
                specular: [0.0; 3],
                shininess: 0.0,
                texturing,
                bumps: None,
                lights: lights.iter().map(|light| light.meaning.clone()).collect(),
            }))
        }
        (Ending::View { .. } | Ending::Alpha(_), Some(light)) => {
            let FixedFunctionLight { projection, shade, .. } = light.meaning.clone();
            let shown = Box::new(ShadeView { clip_from_eye, texturing, projection, shade });
            if let Ending::Alpha(_) = ending {
                FixedFunctionDesc::Alpha(shown)
            } else {
                FixedFunctionDesc::Sampled(shown)
            }
        }
        (Ending::Surface { .. } | Ending::TangentVector { .. }, _) => {
            FixedFunctionDesc::Shader("a view of a surface's property")
        }
        (Ending::Slice { .. }, _) => FixedFunctionDesc::Shader("slices of a beam of light in dust"),
        (Ending::View { .. } | Ending::Alpha(_), None) => FixedFunctionDesc::Shader("a view of no light"),
    }
}
