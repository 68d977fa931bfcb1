//! `--aov truth` and `--aov difference`: what the ray tracer finds of a scene, and how the picture differs from that. In
//! colours where a scene has projected light, and else as lit and shadowed.

use image::RgbImage;

use super::Error;
use super::scene_args::parse_view;
use crate::device::Pixels;
use crate::frame::{Frame, ShadeImage};
use crate::judge::colors::{color_options, has_projected_light, shadow_of};
use crate::judge::difference::{AMBIGUOUS, difference_picture, truth_picture};
use crate::plan::ViewRequest;
use crate::scene::Scene;
use crate::truth::{self, ColorRequest};
use crate::views::View;

/// Factor of a difference of colours in a PNG, so that a code of 255 is visible.
const LOUDER: f32 = 16.0;

/// Greatest width of a colour's bounds, in codes of 1/255, at which pictures are compared with its value, not its bounds.
const SMOOTH_CODES: f64 = 8.0;

/// Value of `--aov`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aov {
    /// A view that is drawn.
    Drawn(ViewRequest),
    /// The ray tracer's own picture.
    Truth { light: usize },
    /// Differences of the picture from it.
    Difference { light: usize },
}

/// Reads `NAME` or `NAME@LIGHT`.
pub fn parse_aov(text: &str) -> Result<Aov, String> {
    let (name, light) = text.split_once('@').unwrap_or((text, "0"));
    let number = || light.parse().map_err(|_| format!("'{light}' is no number of a light"));
    match name {
        "truth" => Ok(Aov::Truth { light: number()? }),
        "difference" => Ok(Aov::Difference { light: number()? }),
        _ => parse_view(text, &["truth", "difference"]).map(Aov::Drawn),
    }
}

impl Aov {
    /// The name in a file's name.
    pub fn file_name(self) -> String {
        let (name, light) = match self {
            Self::Drawn(wanted) => (wanted.view.name(), wanted.light),
            Self::Truth { light } => ("truth", light),
            Self::Difference { light } => ("difference", light),
        };
        if light == 0 { name.to_owned() } else { format!("{name}.{light}") }
    }

    /// The view that is drawn for it; `None`: the picture suffices.
    pub fn drawn(self, scene: &Scene) -> Option<ViewRequest> {
        match self {
            Self::Drawn(wanted) => Some(wanted),
            Self::Difference { light } if !has_projected_light(scene) => Some(ViewRequest { view: View::Shade, light }),
            _ => None,
        }
    }

    /// Its picture; `drawn`: what was drawn for it. `is_exact`: for a format with 32-bit values.
    ///
    /// # Errors
    ///
    /// A scene that the ray tracer cannot answer.
    pub fn picture(
        self,
        scene: &Scene,
        frame: &Frame,
        drawn: Option<&Pixels>,
        is_exact: bool,
    ) -> Result<Option<Pixels>, Error> {
        let (light, is_difference) = match self {
            Self::Drawn(_) => return Ok(None),
            Self::Truth { light } => (light, false),
            Self::Difference { light } => (light, true),
        };
        let count = scene.lights.len();
        if light > 0 && light >= count {
            return Err(truth::Error::NoLight { index: light, count }.into());
        }
        if has_projected_light(scene) {
            return colors(scene, &frame.picture, is_difference, is_exact).map(Some);
        }
        let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
        let truth = truth::trace(scene, light, &options)?;
        let picture = match drawn {
            Some(Pixels::RgbaF32 { data, .. }) if is_difference => {
                difference_picture(&truth, &ShadeImage::of_view(scene.image.size, data))?
            }
            _ => truth_picture(&truth),
        };
        Ok(Some(opaque(&picture, is_exact)))
    }
}

/// Colours in f64, or the picture's differences from them, channel by channel. At edges, and where images are filtered by
/// mipmaps, a colour has bounds, and within them there is no difference. Where it is not known: grey, and alpha 0.
fn colors(scene: &Scene, picture: &Pixels, is_difference: bool, is_exact: bool) -> Result<Pixels, Error> {
    let shadows: Vec<_> = scene.lights.iter().map(|light| shadow_of(&light.shadow, false)).collect();
    let request = ColorRequest { float_picture: is_exact, ..ColorRequest::default() };
    let truth = truth::color_as(scene, &shadows, &request, &color_options(scene))?;
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
    Ok(Pixels::RgbaF32 { size: scene.image.size, data })
}

fn opaque(picture: &RgbImage, is_exact: bool) -> Pixels {
    let size = [picture.width(), picture.height()];
    let codes = || picture.pixels().flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2], u8::MAX]);
    match is_exact {
        true => Pixels::RgbaF32 { size, data: codes().map(|code| f32::from(code) / 255.0).collect() },
        false => Pixels::Rgba8 { size, data: codes().collect() },
    }
}
