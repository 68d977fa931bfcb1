//! The single pass: every surface once, in the light of all lights [LEC, "Advice for Shadowed Illumination Model"].

use super::passes::Passes;
use super::projection::CameraProjection;
use super::{Composition, Error};
use crate::lights::{Ending, LightTerm};
use crate::pass::Target;

pub struct SinglePass;

impl Composition for SinglePass {
    fn name(&self) -> &'static str {
        "single-pass"
    }

    fn serves(&self, terms: &[&LightTerm]) -> bool {
        terms.iter().all(|term| term.counting.is_none())
    }

    fn picture(
        &self,
        passes: &mut Passes<'_>,
        target: Target,
        lens: &CameraProjection,
        terms: &[&LightTerm],
    ) -> Result<(), Error> {
        passes.notes.left_out("stencil buffer", "no technique of this scene counts in it");
        let terms: Vec<LightTerm> = terms.iter().copied().cloned().collect();
        let onto = passes.first("lit", target, lens, passes.background());
        passes.surfaces(passes.scene, &onto, &terms, &Ending::Lit)
    }
}
