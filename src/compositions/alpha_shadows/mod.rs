//! Shadows in three passes [Segal 1992, 3.3]: ambient light; for each light its shade into destination alpha, where depth is
//! EQUAL; then its colour, added by DST_ALPHA, ONE. Lights of any number and colour; each overwrites alpha.

use super::once::Once;
use super::parts::{left_by_shadow, unshadowed};
use super::passes::{Onto, Passes};
use super::projection::CameraProjection;
use super::{Composition, Error, groups};
use crate::lights::guard::Guard;
use crate::lights::light::{Addition, Gain};
use crate::lights::{CameraView, Ending, LightTerm};
use crate::pass::{Blend, Channels, Clear, DrawState, Shade, Target, glsl};
use crate::scene::{PicturePasses, Scene};

pub struct AlphaShadows;

impl Composition for AlphaShadows {
    fn name(&self) -> &'static str {
        "alpha-shadows"
    }

    fn serves(&self, scene: &Scene, _terms: &[&LightTerm]) -> bool {
        scene.shading.passes == PicturePasses::Shadow
    }

    fn needs_stencil(&self, passes: &Passes<'_>, terms: &[&LightTerm]) -> bool {
        let parts = first_parts(passes.scene, terms);
        groups::sizes(&parts, groups::Room::of(passes.scene)).len() > 1
            || (!terms.is_empty() && Once::find(passes, &CameraProjection::of_scene(passes.scene)).0)
    }

    fn check(&self, _scene: &Scene, terms: &[&LightTerm]) -> Result<(), Error> {
        if let Some(term) = terms.iter().find(|term| term.counting.is_some()) {
            return Err(Error::CountedShade { light: term.index });
        }
        let cutting = terms.iter().find(|term| term.guard == Guard::ClipPlane);
        cutting.map_or(Ok(()), |term| Err(Error::CutShade { light: term.index }))
    }

    fn picture(
        &self,
        passes: &mut Passes<'_>,
        target: Target,
        lens: &CameraProjection,
        terms: &[&LightTerm],
    ) -> Result<(), Error> {
        let has_stencil = self.needs_stencil(passes, terms);
        let [red, green, blue, _] = passes.background();
        let parts = first_parts(passes.scene, terms);
        let onto = passes.first("ambient light", target, lens, [red, green, blue, 0.0]);
        passes.lit(&onto, &parts, has_stencil)?;
        let once = Once::find(passes, lens);
        if !terms.is_empty() {
            once.explain(passes);
        }
        terms.iter().try_for_each(|term| passes.shade_and_light(target, lens, term, once))
    }
}

/// Parts of the lights that shadows leave.
fn first_parts(scene: &Scene, terms: &[&LightTerm]) -> Vec<LightTerm> {
    terms.iter().filter_map(|term| left_by_shadow(scene, term, term.dimming)).collect()
}

impl Passes<'_> {
    /// Passes 2 and 3 of one light, in the pixels that it may reach.
    fn shade_and_light(
        &mut self,
        target: Target,
        lens: &CameraProjection,
        term: &LightTerm,
        once: Once,
    ) -> Result<(), Error> {
        let (index, source) = (term.index, &self.scene.lights[term.index]);
        if source.diffuse == [0.0; 3] && source.specular == [0.0; 3] && !self.keep_all {
            self.notes.left_out(
                format!("passes \"shade of light {index}\" and \"light {index}\""),
                "it is ambient light alone",
            );
            return Ok(());
        }
        let view = CameraView::new(self.scene, self.items);
        let scissor = view.scissor(source, self.scene.image.size).filter(|_| !self.keep_all);
        let is_shadowed = term.shade.meaning != Shade::Lit || self.keep_all;
        if is_shadowed {
            self.note_clamp(term);
            let state = DrawState { color_write: Channels::Alpha, scissor, ..DrawState::REPEAT };
            let label = format!("shade of light {index}");
            let first = self.first(&label, target, lens, [0.0; 4]);
            let onto = Onto { clear: Clear::default(), state: lens.of_surfaces(state), ..first };
            let ending = Ending::Alpha(glsl!("alpha_shadows/shade.frag"));
            self.surfaces(&onto, std::slice::from_ref(term), &ending)?;
        } else {
            self.notes
                .left_out(format!("pass \"shade of light {index}\""), "it has no shadow: nothing would read its alpha");
        }
        let blend = Some(if is_shadowed { Blend::AddByStoredAlpha } else { Blend::Add });
        let state =
            DrawState { color_write: Channels::Rgb, stencil: once.stencil(), blend, scissor, ..DrawState::REPEAT };
        let label = format!("light {index}");
        let first = self.first(&label, target, lens, [0.0; 4]);
        let onto = Onto { clear: once.clear(), state: lens.of_surfaces(state), ..first };
        self.surfaces(&onto, &[self.light_alone(term)], &Ending::Lit)
    }

    /// The part of a light that its shadow takes, without the shadow.
    fn light_alone(&self, term: &LightTerm) -> LightTerm {
        let mut alone = LightTerm { dimming: 0.0, ..unshadowed(term) };
        if self.scene.shading.per_vertex {
            // Lighting per vertex is clamped beside the ambient light, which is there already.
            alone.addition = Addition::Clamped;
            alone.diffuse_weight = 1.0 - term.dimming;
        } else {
            alone.addition = Addition::Light;
            alone.gain = Gain { ambient: 0.0, diffuse: 1.0 - term.dimming, specular: 1.0 };
        }
        alone
    }

    /// Notes light above 1, which the picture's format clamps before alpha weighs it.
    fn note_clamp(&mut self, term: &LightTerm) {
        let source = &self.scene.lights[term.index];
        let attenuation = source.attenuation()[0];
        let most = |item: &crate::lights::Drawable, channel: usize| {
            let material = &item.material;
            let specular = if item.lit { source.specular[channel] * material.specular[channel] } else { 0.0 };
            (source.diffuse[channel] * material.diffuse[channel] + specular) / attenuation
        };
        let brightest = self.items.iter().flat_map(|item| (0..3).map(move |channel| most(item, channel)));
        let brightest = brightest.filter(|value| !value.is_nan()).fold(0.0, f32::max);
        if self.clamps && brightest > 1.0 {
            let why = format!(
                "it reaches {brightest} where nothing shadows it; a float picture (.exr, .npy) does not clamp it, and its filtered shadow edges may be brighter"
            );
            self.notes.chosen(format!("light {}", term.index), "clamped to 1 before its shade", why);
        }
    }
}
