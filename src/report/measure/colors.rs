//! A picture's colours against those in f64: for scenes whose light is more than lit or shadowed.

use crate::device::Pixels;
use crate::frame::{self, Renderer};
use crate::plan::Request;
use crate::scene::{Law, Light, PicturePasses, Scene, Shadow, Spot};
use crate::techniques::{self, LightShadow};
use crate::truth::{self, ColorTruth};

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
}

/// Codes that a picture may be off beyond the bounds of a colour: its own rounding, and that of tables.
const ALLOWED_CODES: f64 = 2.0;

/// Tests whether the scene's light is more than lit or shadowed: a light has an image, a beam, a law of distance, a lens or
/// dust, or is a slide projector; or an object shows a photograph.
pub fn has_projected_light(scene: &Scene) -> bool {
    let is_more = |light: &Light| {
        let is_projected = |spot: &Spot| {
            spot.image.is_some() || spot.beam.is_some() || spot.falloff.is_some() || spot.lens().is_some()
        };
        light.law == Law::Slide || light.dust.is_some() || light.spot().is_some_and(is_projected)
    };
    scene.shading.passes == PicturePasses::Slide || scene.lights.iter().any(is_more) || !scene.photos().is_empty()
}

/// Options of [`truth::color`] for a scene: photographs are in doubt by the texels of the smallest of their depth maps.
pub fn color_options(scene: &Scene) -> truth::Options {
    let sizes = scene.photos().into_iter().map(|photo| techniques::map_size(&photo.projector.shadow));
    truth::Options { photo_map_size: sizes.min(), ..truth::Options::default() }
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
    let plan = renderer.plan(scene, &Request { sampled_warnings: false, ..Request::default() })?;
    renderer.draw(&plan)?;
    let Pixels::Rgba8 { data, .. } = renderer.read(&plan)?.picture else { return Ok(None) };
    let (mut compared, mut squares, mut most, mut beyond) = (0, 0.0, 0.0_f64, 0);
    for (pixel, codes) in truth.pixels.iter().zip(data.as_chunks::<4>().0).filter(|(pixel, _)| pixel.is_known) {
        let codes = [0, 1, 2].map(|k| f64::from(codes[k]));
        compared += 1;
        squares += (0..3).map(|k| (codes[k] - 255.0 * pixel.rgb[k].value).powi(2)).sum::<f64>();
        most = most.max(pixel.error_codes(codes));
        beyond += usize::from(pixel.excess_codes(codes) > ALLOWED_CODES + truth.between_passes_codes);
    }
    let count = compared as f64;
    Ok((compared > 0).then(|| ColorErrors {
        compared,
        rmse_codes: (squares / (3.0 * count)).sqrt(),
        most_codes: most,
        beyond_percent: 100.0 * beyond as f64 / count,
    }))
}
