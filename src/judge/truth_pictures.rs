//! Pictures of what the ray tracer finds of a scene, and of how a drawn picture differs from that: in colours where a scene
//! has projected light, and else as lit and shadowed. Each has a legend.

use image::RgbImage;

use super::colors::{color_options, has_projected_light, shadow_of};
use super::difference::{AMBIGUOUS, LEGEND, difference_picture, truth_picture};
use super::metrics;
use crate::device::Pixels;
use crate::frame::ShadeImage;
use crate::plan::ViewRequest;
use crate::scene::Scene;
use crate::truth::{self, ColorRequest};
use crate::views::View;

/// Factor of a difference of colours in a picture of 8 bits, so that a code of 255 is visible.
pub const LOUDER: f32 = 16.0;

/// Greatest width of a colour's bounds, in codes of 1/255, at which pictures are compared with its value, not its bounds.
const SMOOTH_CODES: f64 = 8.0;

/// Reason why there is no such picture.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The ray tracer cannot answer the scene.
    #[error(transparent)]
    Truth(#[from] truth::Error),
    /// The drawn picture has another size.
    #[error(transparent)]
    Size(#[from] metrics::Error),
}

/// A picture by the ray tracer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TruthView {
    /// Light whose shadow is shown, by its place in the scene; colours are those of all lights.
    pub light: usize,
    /// True for the drawn picture's differences from the truth, false for the truth itself.
    pub is_difference: bool,
}

impl TruthView {
    /// The name on the command line and in file names.
    pub fn name(self) -> &'static str {
        if self.is_difference { "difference" } else { "truth" }
    }

    /// The view that must be drawn beside the picture; `None`: the picture suffices.
    pub fn drawn(self, scene: &Scene) -> Option<ViewRequest> {
        let wanted = self.is_difference && !has_projected_light(scene);
        wanted.then_some(ViewRequest { view: View::Shade, light: self.light })
    }

    /// The picture. `picture`: the scene as it was drawn; `drawn`: the view by [`TruthView::drawn`]. `is_exact`: in 32-bit
    /// floats, and differences of colours not enlarged.
    ///
    /// # Errors
    ///
    /// A scene that the ray tracer cannot answer, a light that the scene does not have.
    pub fn picture(
        self,
        scene: &Scene,
        picture: &Pixels,
        drawn: Option<&Pixels>,
        is_exact: bool,
    ) -> Result<Pixels, Error> {
        self.of_traced(&self.trace(scene, is_exact)?, scene, picture, drawn, is_exact)
    }

    fn trace(self, scene: &Scene, is_exact: bool) -> Result<Traced, Error> {
        let (light, count) = (self.light, scene.lights.len());
        if light > 0 && light >= count {
            return Err(truth::Error::NoLight { index: light, count }.into());
        }
        if has_projected_light(scene) {
            let shadows: Vec<_> = scene.lights.iter().map(|light| shadow_of(&light.shadow, false)).collect();
            let request = ColorRequest { float_picture: is_exact, ..ColorRequest::default() };
            return Ok(Traced::Colors(truth::color_as(scene, &shadows, &request, &color_options(scene))?));
        }
        let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
        Ok(Traced::Shade(truth::trace(scene, light, &options)?))
    }

    fn of_traced(
        self,
        traced: &Traced,
        scene: &Scene,
        picture: &Pixels,
        drawn: Option<&Pixels>,
        is_exact: bool,
    ) -> Result<Pixels, Error> {
        let truth = match traced {
            Traced::Colors(truth) => return Ok(of_colors(truth, picture, self.is_difference, is_exact)),
            Traced::Shade(truth) => truth,
        };
        let picture = match drawn {
            Some(Pixels::RgbaF32 { data, .. }) if self.is_difference => {
                difference_picture(truth, &ShadeImage::of_view(scene.image.size, data))?
            }
            _ => truth_picture(truth),
        };
        Ok(opaque(&picture, is_exact))
    }

    /// Meanings of the colours of a picture in 8 bits.
    pub fn legend(self, scene: &Scene) -> Vec<([u8; 3], String)> {
        let owned = |(color, words): &([u8; 3], &str)| (*color, (*words).to_owned());
        match (has_projected_light(scene), self.is_difference) {
            (false, true) => LEGEND.iter().map(owned).collect(),
            (false, false) => LEGEND[ONLY_DIFFERENT..].iter().map(owned).collect(),
            (true, true) => vec![
                ([0; 3], String::from("right, or within the bounds of a colour at an edge")),
                ([u8::MAX; 3], format!("wrong by 1/{LOUDER} or more; each channel is {LOUDER} times its error")),
                (AMBIGUOUS, String::from("the truth is not known")),
            ],
            (true, false) => vec![(AMBIGUOUS, String::from("the truth is not known; else the colours of all lights"))],
        }
    }
}

/// Answers of the ray tracer.
#[derive(Clone, Debug)]
enum Traced {
    Shade(truth::Truth),
    Colors(truth::ColorTruth),
}

/// The answers that were traced last, for pictures in 8 bits of a scene that stands still.
#[derive(Clone, Debug, Default)]
pub struct TruthMemory {
    /// The light, and the scene as its owner describes it.
    kept: Option<(usize, String, Traced)>,
    traces: u64,
}

impl TruthMemory {
    /// As [`TruthView::picture`]. Rays are traced if the light or `state` is another than in the last call; `state`: a text
    /// that differs for scenes with different answers.
    ///
    /// # Errors
    ///
    /// As [`TruthView::picture`].
    pub fn picture(
        &mut self,
        view: TruthView,
        state: &str,
        scene: &Scene,
        picture: &Pixels,
        drawn: Option<&Pixels>,
    ) -> Result<Pixels, Error> {
        let kept = self.kept.take().filter(|(light, known, _)| *light == view.light && known == state);
        let traced = match kept {
            Some((_, _, traced)) => traced,
            None => {
                self.traces += 1;
                view.trace(scene, false)?
            }
        };
        let (_, _, traced) = self.kept.insert((view.light, state.to_owned(), traced));
        view.of_traced(traced, scene, picture, drawn, false)
    }

    /// Number of times that rays were traced.
    pub fn traces(&self) -> u64 {
        self.traces
    }
}

/// Number of the first colours of [`LEGEND`], which only a difference has.
const ONLY_DIFFERENT: usize = 3;

/// Colours in f64, or the differences from them of `picture`, which has their size, channel by channel. At edges, and where
/// images are filtered by mipmaps, a colour has bounds, and within them there is no difference. Where it is not known: grey, and
/// alpha 0.
pub fn of_colors(truth: &truth::ColorTruth, picture: &Pixels, is_difference: bool, is_exact: bool) -> Pixels {
    let drawn: Vec<f32> = match picture {
        Pixels::Rgba8 { data, .. } => data.iter().map(|code| f32::from(*code) / 255.0).collect(),
        Pixels::RgbaF32 { data, .. } => data.clone(),
        Pixels::Depth { .. } | Pixels::Stencil { .. } => Vec::new(),
    };
    let factor = if is_exact { 1.0 } else { LOUDER };
    let of = |(pixel, drawn): (&truth::ColorPixel, &[f32])| {
        if !pixel.is_known {
            let [red, green, blue] = AMBIGUOUS.map(|code| f32::from(code) / 255.0);
            return [red, green, blue, 0.0];
        }
        let is_smooth = pixel.is_smooth(SMOOTH_CODES);
        let value = |k: usize| {
            let due = pixel.rgb[k];
            let [least, most] = if is_smooth { [due.value; 2] } else { [due.least, due.most] };
            let off = (least as f32 - drawn[k]).max(drawn[k] - most as f32).max(0.0);
            if is_difference { factor * off } else { due.value as f32 }
        };
        [value(0), value(1), value(2), 1.0]
    };
    let data = truth.pixels.iter().zip(drawn.chunks_exact(4)).flat_map(of).collect();
    Pixels::RgbaF32 { size: [truth.width, truth.height], data }
}

fn opaque(picture: &RgbImage, is_exact: bool) -> Pixels {
    let size = [picture.width(), picture.height()];
    let codes = || picture.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2], u8::MAX]);
    match is_exact {
        true => Pixels::RgbaF32 { size, data: codes().map(|code| f32::from(code) / 255.0).collect() },
        false => Pixels::Rgba8 { size, data: codes().collect() },
    }
}
