//! The single pass: every surface once, in the light of all lights [LEC, "Advice for Shadowed Illumination Model"]; once for
//! each group, if there are more than one pass holds.

use super::groups;
use super::passes::Passes;
use super::projection::CameraProjection;
use super::{Composition, Error};
use crate::lights::LightTerm;
use crate::pass::{Format, Target};
use crate::scene::{PicturePasses, Scene};

pub struct SinglePass;

impl Composition for SinglePass {
    fn name(&self) -> &'static str {
        "single-pass"
    }

    fn serves(&self, scene: &Scene, terms: &[&LightTerm]) -> bool {
        scene.shading.passes == PicturePasses::One
            && terms.iter().all(|term| term.counting.is_none())
            && !groups::three_passes(scene)
    }

    fn needs_stencil(&self, passes: &Passes<'_>, terms: &[&LightTerm]) -> bool {
        groups::sizes(terms.iter().copied(), groups::Room::of(passes.scene)).len() > 1
    }

    fn check(&self, scene: &Scene, terms: &[&LightTerm]) -> Result<(), Error> {
        groups::check(scene, terms)
    }

    fn picture(
        &self,
        passes: &mut Passes<'_>,
        target: Target,
        lens: &CameraProjection,
        terms: &[&LightTerm],
    ) -> Result<(), Error> {
        let has_stencil = self.needs_stencil(passes, terms);
        let depth = target.depth.map(|depth| passes.list.desc(depth).format);
        if !has_stencil && depth != Some(Format::Depth24Stencil8) {
            passes.notes.left_out("stencil buffer", "no technique of this scene counts in it");
        }
        let terms: Vec<LightTerm> = terms.iter().copied().cloned().collect();
        let onto = passes.first("lit", target, lens, passes.background());
        passes.lit(&onto, &terms, has_stencil)
    }
}
