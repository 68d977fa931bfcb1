//! Pictures of lights whose shadow is counted in the stencil buffer [GDC, "Shadow Volume Algorithm"]: depth and all light
//! that needs no count first; then, for each such light, its volumes, or the surfaces that its own shade tags [LEC,
//! "Combining Shadow Mapping with other Techniques"], and its light where the count is 0, with depth EQUAL. Or, for one
//! light, the two passes of [GDC, "Shadow Volume Algorithm"]: depth, its count, then the scene with that light where the
//! count is 0 and without it where it is not.

mod views;

use super::groups;
use super::parts::left_by_shadow;
use super::passes::{Onto, Passes};
use super::projection::CameraProjection;
use super::{Composition, Error};
use crate::lights::drawable::depth_batches;
use crate::lights::guard::Guard;
use crate::lights::light::{Addition, Counted, Gain, Lighting, ShadeSource, StencilCount, VolumeDepths, VolumeDraw};
use crate::lights::sides::shows_no_back_face;
use crate::lights::{Drawable, Ending, LightTerm};
use crate::pass::{
    Blend, Clear, Compare, DrawPass, DrawState, Face, FixedFunctionDesc, ImageId, Redraw, Shade, Stencil, StencilOp,
    StencilOps, Target, Texturing, glsl,
};
use crate::scene::{PicturePasses, Scene};
use crate::views::View;

/// Stencil state that passes where the count is 0, and keeps it.
const LIT: Stencil = Stencil {
    test: Compare::Equal,
    reference: 0,
    read_mask: 0xFF,
    write_mask: 0,
    front: StencilOps::KEEP,
    back: StencilOps::KEEP,
};

/// The same for a count that is not needed afterwards: surfaces that coincide are lit once.
const LIT_ONCE: Stencil = Stencil { write_mask: 0xFF, front: COUNTED_ON, back: COUNTED_ON, ..LIT };

const COUNTED_ON: StencilOps = StencilOps { pass: StencilOp::Increment, ..StencilOps::KEEP };

/// Stencil state that passes where the count is not 0, and keeps it.
const UNLIT: Stencil = Stencil { test: Compare::NotEqual, ..LIT };

/// Pictures in which some lights are counted.
pub struct StencilCounted;

impl Composition for StencilCounted {
    fn name(&self) -> &'static str {
        "stencil-counted"
    }

    fn serves(&self, scene: &Scene, terms: &[&LightTerm]) -> bool {
        scene.shading.passes == PicturePasses::One && terms.iter().any(|term| term.counting.is_some())
    }

    fn needs_stencil(&self, _passes: &Passes<'_>, _terms: &[&LightTerm]) -> bool {
        true
    }

    fn check(&self, scene: &Scene, terms: &[&LightTerm]) -> Result<(), Error> {
        let cutting = terms.iter().find(|term| term.guard == Guard::ClipPlane);
        let counted = terms.iter().find(|term| term.counting.is_some());
        if let Some(counted) = counted.filter(|_| groups::three_passes(scene)) {
            return Err(Error::CountedParts { light: counted.index });
        }
        if let (Some(cutting), Some(counted)) = (cutting, counted) {
            return Err(Error::CutDepths { light: cutting.index, counted: counted.index });
        }
        check_ledges(terms)
    }

    fn picture(
        &self,
        passes: &mut Passes<'_>,
        target: Target,
        lens: &CameraProjection,
        terms: &[&LightTerm],
    ) -> Result<(), Error> {
        passes.counted_picture(target, lens, terms)
    }

    fn view(
        &self,
        passes: &mut Passes<'_>,
        view: View,
        label: &str,
        term: &LightTerm,
    ) -> Result<Option<ImageId>, Error> {
        term.counting.as_ref().map(|counting| passes.counted_view(view, label, term, counting)).transpose()
    }
}

/// Refuses lights with different ledges: all volumes are counted in one depth buffer.
fn check_ledges(terms: &[&LightTerm]) -> Result<(), Error> {
    let ledge =
        |term: &&LightTerm| term.counting.as_ref().and_then(|counting| counting.ledge).map(|ledge| (term.index, ledge));
    let mut ledges = terms.iter().filter_map(ledge);
    let Some((first, depths)) = ledges.next() else { return Ok(()) };
    let other = ledges.find(|(_, other)| *other != depths);
    other.map_or(Ok(()), |(second, _)| Err(Error::TwoLedges { first, second }))
}

impl Passes<'_> {
    /// The surfaces in all lights, of which some are counted.
    fn counted_picture(&mut self, target: Target, lens: &CameraProjection, terms: &[&LightTerm]) -> Result<(), Error> {
        let counted: Vec<&LightTerm> = terms.iter().filter(|term| term.counting.is_some()).copied().collect();
        let keeps = self.keeps_count(&counted);
        if let Some(chosen) = counted.iter().find(|term| lighting(term) == Lighting::LitAndUnlit) {
            return self.lit_and_unlit(target, lens, terms, chosen, keeps);
        }
        let mut uncounted = self.first("uncounted light", target, lens, self.background());
        if keeps {
            self.depth_first(target, lens, Redraw::WhenChanged);
            for term in &counted {
                self.count_term(target, lens, term, Redraw::WhenChanged)?;
            }
            uncounted.clear.depth = None;
            uncounted.state = lens.of_surfaces(DrawState::REPEAT);
        }
        let first: Vec<LightTerm> = terms.iter().filter_map(|term| self.uncounted_part(term)).collect();
        self.lit(&uncounted, &first, !keeps)?;
        for term in &counted {
            if !keeps {
                self.count_term(target, lens, term, Redraw::Always)?;
            }
            self.add_light(target, lens, term, if keeps { LIT } else { LIT_ONCE })?;
        }
        Ok(())
    }

    /// The surfaces in all lights: with `chosen` where its count is 0, without it where it is not. Other counted lights are
    /// added.
    fn lit_and_unlit(
        &mut self,
        target: Target,
        lens: &CameraProjection,
        terms: &[&LightTerm],
        chosen: &LightTerm,
        keeps: bool,
    ) -> Result<(), Error> {
        let redraw = if keeps { Redraw::WhenChanged } else { Redraw::Always };
        self.depth_first(target, lens, redraw);
        self.count_term(target, lens, chosen, redraw)?;
        let index = chosen.index;
        let others = |term: &&&LightTerm| term.counting.is_some() && term.index != index;
        let others: Vec<&LightTerm> = terms.iter().filter(others).copied().collect();
        for (stencil, is_lit) in [(LIT, true), (UNLIT, false)] {
            let part = |term: &&LightTerm| match is_lit && term.index == index {
                true => Some(once_counted(term)),
                false => self.uncounted_part(term),
            };
            let parts: Vec<LightTerm> = terms.iter().filter_map(part).collect();
            let label = format!("{} light {index}", if is_lit { "with" } else { "without" });
            let state = lens.of_surfaces(DrawState { stencil: Some(stencil), ..DrawState::REPEAT });
            let mut onto = Onto { state, ..self.first(&label, target, lens, self.background()) };
            onto.clear.depth = None;
            onto.clear.color = onto.clear.color.filter(|_| is_lit);
            self.lit(&onto, &parts, false)?;
        }
        for term in others {
            if lighting(term) == Lighting::LitAndUnlit {
                let why =
                    format!("light {index} has the two passes of light and shadow: what they show is there already");
                self.notes.chosen(format!("light {}", term.index), "added where its count is 0", why);
            }
            self.count_term(target, lens, term, Redraw::Always)?;
            self.add_light(target, lens, term, LIT_ONCE)?;
        }
        Ok(())
    }

    /// Tests whether depth and count of a frame serve the next: one count, and frames that may use it again.
    fn keeps_count(&self, counted: &[&LightTerm]) -> bool {
        let [term] = counted else { return false };
        let may = term.counting.as_ref().is_some_and(|counting| counting.redraw == Redraw::WhenChanged);
        may && self.frames > 1 && !self.keep_all
    }

    /// A pass of depth only; with [`Redraw::WhenChanged`] it is kept from frame to frame.
    fn depth_first(&mut self, target: Target, lens: &CameraProjection, redraw: Redraw) {
        let clip_from_world = lens.camera.clip_from_world();
        // The same faces as the passes with depth EQUAL draw: at a silhouette a back face may tie with a front one.
        let items = self.cut_items(lens);
        let (front, both): (Vec<&Drawable>, Vec<&Drawable>) =
            items.iter().partition(|item| shows_no_back_face(item, &(clip_from_world * item.world_from_model)));
        let mut batches = depth_batches(&front, &clip_from_world, self.list);
        batches.iter_mut().for_each(|batch| batch.cull = Some(Face::Back));
        batches.extend(depth_batches(&both, &clip_from_world, self.list));
        self.cut_at_far(lens, &mut batches);
        let pass = DrawPass {
            target: Target { color: None, ..target },
            viewport: self.scene.image.size,
            clear: Clear { depth: Some(1.0), ..Clear::default() },
            state: lens.of_surfaces(DrawState::DEPTH_ONLY),
            batches,
        };
        self.push("depth", redraw, pass);
    }

    fn count_term(
        &mut self,
        target: Target,
        lens: &CameraProjection,
        term: &LightTerm,
        redraw: Redraw,
    ) -> Result<(), Error> {
        let Some(counting) = &term.counting else { return Ok(()) };
        self.count(target, lens, term, counting, "", redraw)
    }

    /// Passes that count, over existing depth.
    fn count(
        &mut self,
        target: Target,
        lens: &CameraProjection,
        term: &LightTerm,
        counting: &StencilCount,
        prefix: &str,
        redraw: Redraw,
    ) -> Result<(), Error> {
        for (index, pass) in counting.passes.iter().enumerate() {
            let label = format!("{prefix}{}", pass.label);
            let onto = Onto {
                clear: Clear { stencil: (index == 0).then_some(0), ..Clear::default() },
                state: lens.state(counting, &pass.state, pass.depths),
                ..self.first(&label, Target { color: None, ..target }, lens, [0.0; 4])
            };
            match &pass.counted {
                Counted::Volumes(draws) => self.volumes(redraw, &onto, draws, pass.depths),
                Counted::Shadowed => {
                    // Surfaces are clipped like those whose depth they must equal.
                    let state = lens.of_surfaces(DrawState { scissor: counting.scissor, ..pass.state });
                    let ending = Ending::View { chunk: glsl!("stencil_counted/tag.frag"), shade: true };
                    let mut tagged = term.clone();
                    tagged.shade.meaning = Shade::Shader("a shade that only tags");
                    self.surfaces_if(redraw, &Onto { state, ..onto }, &[tagged], &ending)?;
                }
            }
        }
        Ok(())
    }

    fn volumes(&mut self, redraw: Redraw, onto: &Onto<'_>, draws: &[VolumeDraw], depths: VolumeDepths) {
        let (viewer, meaning) = (onto.lens.viewer(depths), FixedFunctionDesc::Depth(Texturing::default()));
        let batches = StencilCount::batches(draws, &viewer, None, glsl!("common/depth.frag"), meaning, Vec::new());
        let Onto { target, viewport, clear, state, .. } = *onto;
        self.push(onto.label, redraw, DrawPass { target, viewport, clear, state, batches });
    }

    /// Adds one light where `stencil` passes.
    fn add_light(
        &mut self,
        target: Target,
        lens: &CameraProjection,
        term: &LightTerm,
        stencil: Stencil,
    ) -> Result<(), Error> {
        let dimming = if of_all(term) { term.dimming } else { 0.0 };
        let label = format!("light {}", term.index);
        let onto = Onto {
            clear: Clear::default(),
            state: lens.of_surfaces(DrawState {
                stencil: Some(stencil),
                blend: Some(Blend::Add),
                scissor: term.counting.as_ref().and_then(|counting| counting.scissor),
                ..DrawState::REPEAT
            }),
            ..self.first(&label, target, lens, [0.0; 4])
        };
        let mut lit = LightTerm { dimming, ..once_counted(term) };
        if self.scene.shading.per_vertex {
            // Lighting per vertex is clamped beside the ambient light, which is there already.
            lit.addition = Addition::Clamped;
            let left = term.dimming - lit.dimming;
            lit.diffuse_weight = 1.0 - left;
        } else {
            lit.addition = Addition::Light;
            lit.gain = Gain { ambient: 0.0, diffuse: 1.0 - term.dimming + dimming, specular: 1.0 };
        }
        self.surfaces(&onto, &[lit], &Ending::Lit)
    }

    /// The part of a light that needs no count: a light that is not counted, or the part of a counted light that its
    /// shadow leaves.
    fn uncounted_part(&self, term: &LightTerm) -> Option<LightTerm> {
        if term.counting.is_none() {
            return Some(term.clone());
        }
        let left = if of_all(term) { 0.0 } else { term.dimming };
        left_by_shadow(self.scene, term, left)
    }
}

/// Passes in which the light joins the picture.
fn lighting(term: &LightTerm) -> Lighting {
    term.counting.as_ref().map_or(Lighting::Added, |counting| counting.lighting)
}

/// Tests whether the light's own shade finds what a shadow leaves.
fn of_all(term: &LightTerm) -> bool {
    term.counting.as_ref().is_some_and(|counting| counting.of_all)
}

/// The term of a light where its count is 0: the lookup that tagged the surfaces is not repeated.
fn once_counted(term: &LightTerm) -> LightTerm {
    let tagged = term.counting.as_ref().is_some_and(StencilCount::tags);
    if tagged { term.under(ShadeSource::lit()) } else { LightTerm { counting: None, ..term.clone() } }
}
