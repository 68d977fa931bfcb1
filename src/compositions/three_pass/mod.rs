//! Bumps in three passes [GDC, "Three Passes"]: ambient and diffuse light, clamped to 1; the decal, multiplied in, with the gloss
//! in destination alpha; the highlights, weighed by that alpha and added. The first and the third have a pass for each light.
//! Surfaces without bumps are lit in the same passes. Knows terms and endings; no combiner.

use super::groups;
use super::once::Once;
use super::passes::{Onto, Passes};
use super::projection::CameraProjection;
use super::{Composition, Error};
use crate::lights::ending::FormulaPart;
use crate::lights::light::Addition;
use crate::lights::{CameraView, Drawable, Ending, LightTerm};
use crate::pass::{Blend, DrawState, Redraw, Target, glsl};
use crate::scene::{PicturePasses, Scene};

pub struct ThreePass;

impl Composition for ThreePass {
    fn name(&self) -> &'static str {
        "three-pass"
    }

    fn serves(&self, scene: &Scene, terms: &[&LightTerm]) -> bool {
        scene.shading.passes == PicturePasses::One
            && groups::three_passes(scene)
            && terms.iter().all(|term| term.counting.is_none())
    }

    fn needs_stencil(&self, passes: &Passes<'_>, _terms: &[&LightTerm]) -> bool {
        Once::find(passes, &CameraProjection::of_scene(passes.scene)).0
    }

    fn check(&self, scene: &Scene, terms: &[&LightTerm]) -> Result<(), Error> {
        if !scene.photos().is_empty() {
            return Err(Error::PhotoParts);
        }
        let cutting = terms.iter().find(|term| term.guard == crate::lights::guard::Guard::ClipPlane);
        cutting.map_or(Ok(()), |term| Err(Error::CutParts { light: term.index }))
    }

    fn picture(
        &self,
        passes: &mut Passes<'_>,
        target: Target,
        lens: &CameraProjection,
        terms: &[&LightTerm],
    ) -> Result<(), Error> {
        let once = Once::find(passes, lens);
        once.explain(passes);
        let terms: Vec<LightTerm> = terms.iter().copied().cloned().collect();
        let onto = passes.first("ambient and diffuse light", target, lens, passes.background());
        passes.lit_part(&onto, &terms, once.0, &Ending::Part(FormulaPart::Diffuse))?;
        let shines = passes.shines(&terms);
        passes.decals(target, lens, once, shines)?;
        if !shines {
            passes.notes.left_out("passes of highlights", "no light and no surface in view is specular");
            return Ok(());
        }
        terms.iter().try_for_each(|term| passes.highlights(target, lens, once, term))
    }
}

/// Tests whether an item may show highlights.
fn shines(item: &Drawable) -> bool {
    item.lit && item.material.specular != [0.0; 3]
}

impl Passes<'_> {
    /// Tests whether any light makes a highlight on a surface in view.
    fn shines(&self, terms: &[LightTerm]) -> bool {
        let is_specular = |term: &LightTerm| term.source.specular != [0.0; 3];
        let visible = CameraView::new(self.scene, self.items).visible;
        self.keep_all || (terms.iter().any(is_specular) && visible.iter().any(|item| shines(item)))
    }

    /// The second pass. Without highlights its alpha is not read.
    fn decals(&mut self, target: Target, lens: &CameraProjection, once: Once, shines: bool) -> Result<(), Error> {
        // Their alpha is 1 since the first pass.
        let is_white = |item: &Drawable| {
            item.decal().is_none() && item.mesh.colors.is_none() && (!shines || item.gloss().is_none())
        };
        if !self.keep_all && CameraView::new(self.scene, self.items).visible.iter().all(|item| is_white(item)) {
            self.notes.left_out(
                "pass \"decals and gloss\"",
                "no surface in view has a decal, a gloss map or colours of vertices",
            );
            return Ok(());
        }
        let (stencil, blend) = (once.stencil(), Some(Blend::MultiplyAndStoreAlpha));
        let state = DrawState { stencil, blend, ..DrawState::REPEAT };
        let first = self.first("decals and gloss", target, lens, [0.0; 4]);
        let onto = Onto { state: lens.of_surfaces(state), clear: once.clear(), ..first };
        let why = "no decal, no gloss map and no colours of vertices";
        let items = Once::items(self, lens, (onto.label, why), is_white);
        let ending = Ending::Part(FormulaPart::Decal(glsl!("three_pass/decal.frag")));
        self.surfaces_of(&items, Redraw::Always, &onto, &[], &ending)
    }

    /// The third pass of one light, in the pixels that it may reach.
    fn highlights(
        &mut self,
        target: Target,
        lens: &CameraProjection,
        once: Once,
        term: &LightTerm,
    ) -> Result<(), Error> {
        let source = &self.scene.lights[term.index];
        if source.specular == [0.0; 3] && !self.keep_all {
            let why = "it is not specular";
            self.notes.left_out(format!("pass \"highlights of light {}\"", term.index), why);
            return Ok(());
        }
        let view = CameraView::new(self.scene, self.items);
        let scissor = view.scissor(source, self.scene.image.size).filter(|_| !self.keep_all);
        let (stencil, blend) = (once.stencil(), Some(Blend::AddByStoredAlpha));
        let state = DrawState { stencil, blend, scissor, ..DrawState::REPEAT };
        let label = format!("highlights of light {}", term.index);
        let first = self.first(&label, target, lens, [0.0; 4]);
        let onto = Onto { state: lens.of_surfaces(state), clear: once.clear(), ..first };
        let term = LightTerm { addition: Addition::Light, ..term.clone() };
        let items = Once::items(self, lens, (&label, "not specular"), |item| !shines(item));
        self.surfaces_of(&items, Redraw::Always, &onto, &[term], &Ending::Part(FormulaPart::Specular))
    }
}
