//! A picture's colours against those that they should be: for scenes whose light is more than lit or shadowed.

use image::{Rgb, RgbImage};

use crate::device::Pixels;
use crate::frame::{self, Renderer};
use crate::pictures::flip::{FlipMap, flip};
use crate::plan::Request;
use crate::scene::{Law, Light, Object, PicturePasses, Scene, Shadow, Spot};
use crate::techniques::{self, LightShadow};
use crate::truth::{self, Bounds, ColorPixel, ColorTruth};

/// Errors of a picture's colours, over the pixels whose colour is known.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ColorErrors {
    /// Pixels compared.
    pub compared: usize,
    /// Root mean square over pixels and channels, in codes of 1/255.
    pub rmse_codes: f64,
    /// The greatest difference of a channel, in codes.
    pub most_codes: f64,
    /// Pixels further than two codes outside of what the error of a sample explains, in percent.
    pub beyond_percent: f64,
    /// Mean of FLIP over the picture, in [0, 1]; pixels that are not compared count as equal. `None`: the picture has more
    /// than [`crate::pictures::flip::MOST_PIXELS`], or FLIP is not compiled in ([`crate::pictures::flip::HAS_FLIP`]).
    pub flip: Option<f64>,
}

/// Codes that a picture may be off beyond the bounds of a colour: its own rounding, and that of tables.
const ALLOWED_CODES: f64 = 2.0;

/// A picture's colours, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnColors {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// RGB in codes of 1/255. Of a picture in floats they are not rounded, and may lie beyond 255.
    pub codes: Vec<[f64; 3]>,
}

/// Tests whether the scene's light is more than lit or shadowed: a light has an image, a beam, a law of distance, a lens or
/// dust, or is a slide projector; or an object shows a photograph, or has bumps or a gloss map.
pub fn has_projected_light(scene: &Scene) -> bool {
    let is_more = |light: &Light| {
        let is_projected = |spot: &Spot| {
            spot.image.is_some() || spot.beam.is_some() || spot.falloff.is_some() || spot.lens().is_some()
        };
        light.law == Law::Slide || light.dust.is_some() || light.spot().is_some_and(is_projected)
    };
    let has_relief = |object: &Object| {
        object.lit && (object.bases.is_some() || object.material.as_ref().is_some_and(|own| own.gloss.is_some()))
    };
    scene.shading.passes == PicturePasses::Slide
        || scene.lights.iter().any(is_more)
        || !scene.photos().is_empty()
        || scene.objects.iter().any(has_relief)
}

/// Options of [`truth::color`] for a scene: photographs are in doubt by the texels of the smallest of their depth maps.
pub fn color_options(scene: &Scene) -> truth::Options {
    let sizes = scene.photos().into_iter().map(|photo| techniques::map_size(&photo.projector.shadow));
    truth::Options { photo_map_size: sizes.min(), ..truth::Options::default() }
}

/// Reason why light number `light` has no shade that could be compared.
pub fn why_unshaded(scene: &Scene, light: usize) -> Option<&'static str> {
    let is_slide = |light: &Light| light.law == Law::Slide;
    let is_projector = scene.shading.passes == PicturePasses::Slide || scene.lights.get(light).is_some_and(is_slide);
    is_projector.then_some("a slide projector casts no shadow, so that only its colours are compared")
}

/// Colours of the scene, in which light `measured` casts its shadow whatever its technique, and others by their own.
///
/// # Errors
///
/// See [`truth::color`].
pub fn true_colors(scene: &Scene, measured: usize) -> Result<ColorTruth, truth::Error> {
    let lights = scene.lights.iter().enumerate();
    let shadows: Vec<_> = lights.map(|(index, light)| shadow_of(&light.shadow, index == measured)).collect();
    truth::color(scene, &shadows, &color_options(scene))
}

/// The diffuse light that a full shadow leaves; `None`: the light has no shadow. `always`: it has one, whatever its technique.
pub fn shadow_of(shadow: &Shadow, always: bool) -> Option<f64> {
    let read = LightShadow::of(shadow);
    let has_shadow = always || read.is_some_and(|read| read.technique.draws_shadows());
    has_shadow.then(|| read.map_or(0.0, |read| f64::from(read.common.dimming)))
}

/// Draws the picture and compares it; `None`: no pixel's colour is known.
///
/// # Errors
///
/// An error of the plan or the device.
pub fn compare_colors(
    scene: &Scene,
    truth: &ColorTruth,
    renderer: &mut Renderer,
) -> Result<Option<ColorErrors>, frame::Error> {
    let drawn = draw_colors(scene, false, renderer)?;
    Ok(errors_of(truth, &drawn).map(|(errors, _)| errors))
}

/// Draws the picture, in floats or in 8 bits.
///
/// # Errors
///
/// An error of the plan or the device.
pub fn draw_colors(scene: &Scene, in_floats: bool, renderer: &mut Renderer) -> Result<DrawnColors, frame::Error> {
    let request = Request { sampled_warnings: false, float_picture: in_floats, ..Request::default() };
    let plan = renderer.plan(scene, &request)?;
    renderer.draw(&plan)?;
    Ok(match renderer.read(&plan)?.picture {
        Pixels::Rgba8 { size, data } => {
            let codes = data.as_chunks::<4>().0.iter().map(|texel| [0, 1, 2].map(|k| f64::from(texel[k])));
            DrawnColors { size, codes: codes.collect() }
        }
        Pixels::RgbaF32 { size, data } => {
            let codes = data.as_chunks::<4>().0.iter().map(|texel| [0, 1, 2].map(|k| 255.0 * f64::from(texel[k])));
            DrawnColors { size, codes: codes.collect() }
        }
        Pixels::Depth { .. } | Pixels::Stencil { .. } => DrawnColors { size: [0, 0], codes: Vec::new() },
    })
}

/// Compares a picture, as it is stored in 8 bits or floats but never beyond 255; with the map of FLIP. `None`: no pixel's
/// colour is known, or the sizes differ.
pub fn errors_of(truth: &ColorTruth, drawn: &DrawnColors) -> Option<(ColorErrors, Option<FlipMap>)> {
    if drawn.size != [truth.width, truth.height] {
        return None;
    }
    let (mut compared, mut squares, mut most, mut beyond) = (0, 0.0, 0.0_f64, 0);
    for (pixel, codes) in truth.pixels.iter().zip(&drawn.codes).filter(|(pixel, _)| pixel.is_known) {
        let codes = codes.map(stored);
        compared += 1;
        squares += (0..3).map(|k| (codes[k] - 255.0 * pixel.rgb[k].value).powi(2)).sum::<f64>();
        most = most.max(pixel.error_codes(codes));
        beyond += usize::from(pixel.excess_codes(codes) > ALLOWED_CODES + truth.between_passes_codes);
    }
    if compared == 0 {
        return None;
    }
    let map = flip(&known_or_drawn(truth, drawn), &drawn.to_image());
    let count = compared as f64;
    let errors = ColorErrors {
        compared,
        rmse_codes: (squares / (3.0 * count)).sqrt(),
        most_codes: most,
        beyond_percent: 100.0 * beyond as f64 / count,
        flip: map.as_ref().map(FlipMap::mean),
    };
    Some((errors, map))
}

/// Tests a pixel that is known against its bounds: `None` within them, and else whether it is too dark.
pub(super) fn excess(truth: &ColorTruth, due: &ColorPixel, codes: [f64; 3]) -> Option<bool> {
    let codes = codes.map(stored);
    if due.excess_codes(codes) <= ALLOWED_CODES + truth.between_passes_codes {
        return None;
    }
    let below = |k: usize| 255.0 * due.rgb[k].least - codes[k];
    let above = |k: usize| codes[k] - 255.0 * due.rgb[k].most;
    let most = |of: &dyn Fn(usize) -> f64| (0..3).map(of).fold(f64::NEG_INFINITY, f64::max);
    Some(most(&below) >= most(&above))
}

/// A code as a picture stores it; no number counts as 0.
fn stored(code: f64) -> f64 {
    if code.is_nan() { 0.0 } else { code.clamp(0.0, 255.0) }
}

impl DrawnColors {
    /// The picture in 8 bits.
    pub fn to_image(&self) -> RgbImage {
        let [width, height] = self.size;
        let codes = self.codes.iter().flat_map(|codes| codes.map(|code| stored(code).round() as u8)).collect();
        RgbImage::from_raw(width, height, codes).unwrap_or_default()
    }

    /// The picture as colours that another is compared with: each exactly, and known where `is_known` says so.
    pub fn to_truth(&self, is_known: impl Fn(usize) -> bool) -> ColorTruth {
        let exactly = |code: f64| {
            let value = stored(code) / 255.0;
            Bounds { least: value, value, most: value, jumps: false }
        };
        let pixel =
            |(index, codes): (usize, &[f64; 3])| ColorPixel { rgb: codes.map(exactly), is_known: is_known(index) };
        let pixels = self.codes.iter().enumerate().map(pixel).collect();
        ColorTruth { width: self.size[0], height: self.size[1], pixels, between_passes_codes: 0.0 }
    }
}

/// The colours as a picture; those of `drawn` where they are not known.
pub fn known_or_drawn(truth: &ColorTruth, drawn: &DrawnColors) -> RgbImage {
    RgbImage::from_fn(truth.width, truth.height, |x, y| {
        let index = y as usize * truth.width as usize + x as usize;
        let of_drawn = || drawn.codes.get(index).copied().unwrap_or_default();
        let codes = match truth.pixels.get(index) {
            Some(pixel) if pixel.is_known => pixel.rgb.map(|channel| 255.0 * channel.value),
            _ => of_drawn(),
        };
        Rgb(codes.map(|code| stored(code).round() as u8))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(codes: &[[f64; 3]]) -> DrawnColors {
        DrawnColors { size: [codes.len() as u32, 1], codes: codes.to_vec() }
    }

    #[test]
    fn errors_are_those_of_known_pixels() {
        let truth = drawn(&[[100.0; 3], [200.0; 3], [0.0; 3], [255.0; 3]]).to_truth(|index| index != 2);
        // 3 codes off in one channel; equal; not compared; brighter than white, which a picture stores as white.
        let picture = drawn(&[[103.0, 100.0, 100.0], [200.0; 3], [90.0; 3], [400.0; 3]]);
        let (errors, map) = errors_of(&truth, &picture).unwrap();
        assert_eq!(errors.compared, 3);
        assert!((errors.rmse_codes - 1.0).abs() < 1e-12, "{errors:?}");
        assert_eq!((errors.most_codes, (100.0 / 3.0 - errors.beyond_percent).abs() < 1e-9), (3.0, true));
        // What is not compared has no part in FLIP: there both pictures are the drawn one.
        let map = map.unwrap();
        assert!(map.values[3] < 0.1 && errors.flip.unwrap() < 0.05, "{map:?}");
    }

    #[test]
    fn nothing_known_and_other_sizes_have_no_errors() {
        let picture = drawn(&[[1.0; 3]]);
        assert!(errors_of(&picture.to_truth(|_| false), &picture).is_none());
        assert!(errors_of(&drawn(&[[1.0; 3]; 2]).to_truth(|_| true), &picture).is_none());
    }

    #[test]
    fn no_number_is_no_color() {
        assert_eq!(drawn(&[[f64::NAN, -4.0, 300.0]]).to_image().get_pixel(0, 0).0, [0, 0, 255]);
    }
}
