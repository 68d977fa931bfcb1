//! Mistakes that no key of a scene makes: edits of a plan's passes, which are data, before they are drawn. Changes of bump
//! maps are those of figures. An entry with a fault cannot be drawn by `glumbra render`.

use glam::{DVec4, Vec4};
use serde::Deserialize;

use crate::figures::SceneChange;
use crate::pass::{Batch, Chunk, DepthFormat, DrawPass, Filter, PassList, UniformValue, Work, glsl};
use crate::plan::Plan;
use crate::report::measure::documents::{copy_from, cut_by_far};
use crate::scene::Camera;

/// A mistake.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// Texture coordinates of [-1, 1] where the texture has [0, 1]: the matrix S of the chain is left out [HSM, Equation 1].
    WithoutScaleBias,
    /// Eye planes given while the modelview matrix was not the view's: GL multiplies them by another inverse.
    WrongModelview,
    /// Depths averaged by the filter, and then compared.
    AveragedDepths,
    /// Shadow volumes without their near and far caps.
    Uncapped,
    /// Volumes counted behind what is seen, under the scene's own far plane.
    FiniteFar,
    /// A map of 24 bits copied from a depth buffer of 16.
    NarrowCopy,
    /// A cube map's comparison that takes the depth along the one axis also where a lookup reaches the next face.
    Seams,
    /// T and B turned around where the skin is mirrored.
    TangentsTurned,
    /// Smaller levels of a normal map made of unit length, without dimming.
    Undimmed,
}

impl Fault {
    /// Change of the scene, where it is one; else the passes are changed.
    pub fn change(self) -> Option<SceneChange> {
        match self {
            Self::TangentsTurned => Some(SceneChange::TangentsTurned),
            Self::Undimmed => Some(SceneChange::Undimmed),
            _ => None,
        }
    }

    /// Tests whether nothing may be left out: volumes that end just beyond what is seen lie before the far plane.
    pub fn keeps_all(self) -> bool {
        self == Self::FiniteFar
    }

    /// Edits the passes; returns how many batches or draws it changed.
    pub fn apply(self, plan: &mut Plan, camera: &Camera) -> usize {
        if self == Self::FiniteFar {
            return cut_by_far(plan, [camera.near, camera.far]);
        }
        if self == Self::NarrowCopy {
            return usize::from(copy_from(plan, DepthFormat::Depth16));
        }
        let eye_from_world = plan.matrices.eye_from_world;
        let passes = draw_passes(&mut plan.list);
        match self {
            Self::WithoutScaleBias => each_batch(passes, |batch| edit_texgen(batch, &|planes| unscaled(planes))),
            Self::WrongModelview => each_batch(passes, |batch| {
                edit_texgen(batch, &|planes| planes.map(|plane| eye_from_world.transpose() * plane))
            }),
            Self::AveragedDepths => each_batch(passes, average_depths),
            Self::Uncapped => passes.map(|pass| pass.batches.iter_mut().map(without_caps).sum::<usize>()).sum(),
            Self::Seams => each_batch(passes, without_seams),
            Self::FiniteFar | Self::NarrowCopy | Self::TangentsTurned | Self::Undimmed => 0,
        }
    }
}

fn draw_passes(list: &mut PassList) -> impl Iterator<Item = &mut DrawPass> {
    list.passes.iter_mut().filter_map(|pass| match &mut pass.work {
        Work::Draw(draw) => Some(draw),
        Work::CopyDepth { .. } => None,
    })
}

/// Number of batches that `edit` changed.
fn each_batch<'a>(passes: impl Iterator<Item = &'a mut DrawPass>, mut edit: impl FnMut(&mut Batch) -> bool) -> usize {
    passes.flat_map(|pass| &mut pass.batches).map(|batch| usize::from(edit(batch))).sum()
}

/// Edits the planes that make a light's (s, t, r, q). They are the product of the whole chain where the texture matrix is the
/// identity, which is the default.
fn edit_texgen(batch: &mut Batch, edit: &dyn Fn([DVec4; 4]) -> [DVec4; 4]) -> bool {
    let mut changed = false;
    for uniform in &mut batch.uniforms {
        let UniformValue::Vec4Array(planes) = &mut uniform.value else { continue };
        let Ok(whole) = <[Vec4; 4]>::try_from(planes.as_slice()) else { continue };
        if uniform.name.starts_with("eye_planes_") {
            *planes = edit(whole.map(|plane| plane.as_dvec4())).map(|plane| plane.as_vec4()).into();
            changed = true;
        }
    }
    changed
}

/// s = (s' + q) / 2, and so t and r: back to s', t' and r'.
fn unscaled([s, t, r, q]: [DVec4; 4]) -> [DVec4; 4] {
    [2.0 * s - q, 2.0 * t - q, 2.0 * r - q, q]
}

const AVERAGED: Chunk = glsl!("shadow_map/averaged_depths.frag");
const MAP: &str = "shadow_map/map.glsl";
const SHADE: &str = "shadow_map/shade.frag";

/// The texture unit filters the depths themselves, and the shader compares their mean.
fn average_depths(batch: &mut Batch) -> bool {
    let is_of = |chunk: &Chunk, file: &str| chunk.name.starts_with(file);
    let Some(shade) = batch.program.fragment.iter().position(|chunk| is_of(chunk, SHADE)) else { return false };
    batch.program.fragment[shade] = AVERAGED.for_light(0);
    batch.program.fragment.retain(|chunk| !is_of(chunk, MAP));
    for input in batch.inputs.iter_mut().filter(|input| input.sampler.compare.is_some()) {
        (input.sampler.compare, input.sampler.filter) = (None, Filter::Linear);
    }
    true
}

/// The shader does not look where faces meet.
fn without_seams(batch: &mut Batch) -> bool {
    let before = batch.program.defines.len();
    batch.program.defines.retain(|define| define.name() != "SEAMS");
    batch.uniforms.retain(|uniform| !uniform.name.starts_with("seam_"));
    batch.program.defines.len() < before
}

/// Number of draws that are left out.
fn without_caps(batch: &mut Batch) -> usize {
    let before = batch.draws.len();
    batch.draws.retain(|draw| !["far cap", "light cap", "near cap"].iter().any(|cap| draw.label.starts_with(cap)));
    before - batch.draws.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_s_the_corners_of_the_map_are_at_minus_one_and_one() {
        let planes = [[0.5, 0.0, 0.0, 0.5], [0.0, 0.5, 0.0, 0.5], [0.0, 0.0, 0.5, 0.5], [0.0, 0.0, 0.0, 1.0]];
        let planes = planes.map(DVec4::from_array);
        assert_eq!(unscaled(planes), [DVec4::X, DVec4::Y, DVec4::Z, DVec4::W]);
    }
}
