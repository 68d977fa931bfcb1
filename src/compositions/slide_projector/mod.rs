//! The slide projector's passes [Segal 1992, 3.1]: depth over ambient light; for each projector its image, added where depth
//! is EQUAL; the surfaces' own colour, multiplied in, where depth is EQUAL. The result is c (ambient + Σ images), without
//! cosine and without occlusion. One projector at most, and no sum above 1: all in one pass.

use super::once::Once;
use super::passes::{Onto, Passes};
use super::projection::CameraProjection;
use super::{Composition, Error};
use crate::lights::light::Addition;
use crate::lights::{CameraView, Ending, Factors, LightTerm};
use crate::pass::{Blend, DrawState, Target, glsl};
use crate::scene::{Background, Law, Light, PicturePasses, Scene};

pub struct SlideProjector;

impl Composition for SlideProjector {
    fn name(&self) -> &'static str {
        "slide-projector"
    }

    fn serves(&self, scene: &Scene, _terms: &[&LightTerm]) -> bool {
        scene.shading.passes == PicturePasses::Slide
    }

    fn needs_stencil(&self, passes: &Passes<'_>, terms: &[&LightTerm]) -> bool {
        !is_merged(passes, terms) && Once::find(passes, &CameraProjection::of_scene(passes.scene)).0
    }

    fn check(&self, scene: &Scene, _terms: &[&LightTerm]) -> Result<(), Error> {
        let lit = scene.lights.iter().enumerate().find(|(_, light)| light.law != Law::Slide);
        lit.map_or(Ok(()), |(index, light)| Err(Error::NoSlide { light: index, name: light.name.clone() }))
    }

    fn picture(
        &self,
        passes: &mut Passes<'_>,
        target: Target,
        lens: &CameraProjection,
        terms: &[&LightTerm],
    ) -> Result<(), Error> {
        passes.note_alpha(terms);
        if is_merged(passes, terms) {
            return passes.merged_slide(target, lens, terms);
        }
        let once = Once::find(passes, lens);
        once.explain(passes);
        passes.note_saturation(terms);
        passes.depth_and_ambient(target, lens)?;
        terms.iter().try_for_each(|term| passes.slide(target, lens, term, once))?;
        passes.own_colors(target, lens, once)
    }
}

/// Tests whether one pass shows the same: one projector at most, whose light and the ambient light never exceed 1 together,
/// or a picture that does not clamp.
fn is_merged(passes: &Passes<'_>, terms: &[&LightTerm]) -> bool {
    !passes.keep_all && terms.len() <= 1 && !(passes.clamps && sum_of(passes.scene, terms) > 1.0)
}

/// Greatest channel of the ambient light and all projectors' light together, with white images.
fn sum_of(scene: &Scene, terms: &[&LightTerm]) -> f32 {
    let light = |channel: usize| terms.iter().map(|term| brightest(&scene.lights[term.index], channel)).sum::<f32>();
    (0..3).map(|channel| scene.shading.ambient[channel] + light(channel)).fold(0.0, f32::max)
}

/// Greatest value of a channel of a light's diffuse colour, at the light itself.
fn brightest(light: &Light, channel: usize) -> f32 {
    let [constant, ..] = light.attenuation();
    let color = light.diffuse[channel];
    if color == 0.0 { 0.0 } else { color / constant }
}

fn ending(ambient: bool, color: bool) -> Ending {
    Ending::Factors(Factors { chunk: glsl!("slide_projector/factors.frag"), ambient, color })
}

impl Passes<'_> {
    /// Colour of pixels before any light is added.
    fn unlit_background(&self) -> [f32; 4] {
        match self.scene.shading.background {
            Background::Scene => self.background(),
            Background::Ambient => {
                let [red, green, blue] = self.scene.shading.ambient;
                [red, green, blue, 1.0]
            }
        }
    }

    /// All factors in one pass.
    fn merged_slide(&mut self, target: Target, lens: &CameraProjection, terms: &[&LightTerm]) -> Result<(), Error> {
        let sum = sum_of(self.scene, terms);
        let why = match self.clamps {
            true => format!("one projector at most, and a sum of {sum} at most, which nothing clamps"),
            false => String::from("one projector at most, and a float picture, which does not clamp the sum of light"),
        };
        self.notes.left_out("passes of the slide projector: all but one", why);
        let terms: Vec<LightTerm> = terms.iter().copied().cloned().collect();
        let onto = self.first("lit", target, lens, self.unlit_background());
        self.surfaces(&onto, &terms, &ending(true, true))
    }

    /// Pass 1. Where pixels without a surface keep the scene's background, the surfaces bring the ambient light along.
    fn depth_and_ambient(&mut self, target: Target, lens: &CameraProjection) -> Result<(), Error> {
        let (label, state) = match self.scene.shading.background {
            Background::Ambient if !self.has_photos() => ("depth", DrawState::DEPTH_ONLY),
            // A photograph has all of its light.
            Background::Scene | Background::Ambient => ("depth and ambient light", DrawState::OPAQUE),
        };
        let onto = Onto { state: lens.of_surfaces(state), ..self.first(label, target, lens, self.unlit_background()) };
        self.surfaces(&onto, &[], &ending(true, false))
    }

    /// Pass 2 of one projector, in the pixels that its frustum may cover.
    fn slide(&mut self, target: Target, lens: &CameraProjection, term: &LightTerm, once: Once) -> Result<(), Error> {
        let view = CameraView::new(self.scene, self.items);
        let scissor = view.scissor(&self.scene.lights[term.index], self.scene.image.size).filter(|_| !self.keep_all);
        let (stencil, blend) = (once.stencil(), Some(Blend::Add));
        let state = lens.of_surfaces(DrawState { stencil, blend, scissor, ..DrawState::REPEAT });
        let label = format!("slide of light {}", term.index);
        let onto = Onto { state, clear: once.clear(), ..self.first(&label, target, lens, [0.0; 4]) };
        let term = LightTerm { addition: Addition::Light, ..term.clone() };
        self.surfaces(&onto, &[term], &ending(false, false))
    }

    /// Pass 3. SEG's has no depth test; without one a hidden surface's colour would be multiplied in, too.
    fn own_colors(&mut self, target: Target, lens: &CameraProjection, once: Once) -> Result<(), Error> {
        let white = |item: &crate::lights::Drawable| {
            let is_plain = item.decal().is_none() && item.photo.is_none() && item.mesh.colors.is_none();
            item.material.diffuse == [1.0; 3] && is_plain
        };
        if !self.keep_all && CameraView::new(self.scene, self.items).visible.iter().all(|item| white(item)) {
            self.notes.left_out("pass \"surfaces' colours\"", "all surfaces in view are white");
            return Ok(());
        }
        let (stencil, blend) = (once.stencil(), Some(Blend::Multiply));
        let state = lens.of_surfaces(DrawState { stencil, blend, ..DrawState::REPEAT });
        let onto = Onto { state, clear: once.clear(), ..self.first("surfaces' colours", target, lens, [0.0; 4]) };
        self.surfaces(&onto, &[], &ending(false, true))
    }

    /// Notes images whose alpha has no meaning.
    fn note_alpha(&mut self, terms: &[&LightTerm]) {
        for term in terms {
            let image = self.scene.lights[term.index].spot().and_then(|spot| spot.image.as_ref());
            if image.is_some_and(|image| image.has_alpha) {
                let of = format!("alpha of the image of light {}", term.index);
                self.notes.chosen(of, "ignored", "a projector's light is added whole");
            }
        }
    }

    /// Notes a sum of light that the picture's format clamps.
    fn note_saturation(&mut self, terms: &[&LightTerm]) {
        let sum = sum_of(self.scene, terms);
        if self.clamps && sum > 1.0 {
            let why = format!(
                "it reaches {sum} where images are white; a float picture (.exr, .npy) does not clamp it, and may differ"
            );
            self.notes.chosen("sum of ambient light and projectors", "clamped to 1 before the surfaces' colours", why);
        }
    }
}
