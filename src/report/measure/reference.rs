//! Colours that a picture should have: the ray tracer's, or those of a picture of so many samples that it has next to no
//! error of its own.

use crate::frame::{self, Renderer};
use crate::judge::colors::{self, DrawnColors, draw_colors};
use crate::plan::Limits;
use crate::scene::{Light, LightKind, PicturePasses, Scene, Spot};
use crate::truth::{self, ColorTruth, Truth};

/// Colours to compare with.
pub struct Reference {
    /// The colours.
    pub colors: ColorTruth,
    /// Their source, in a sentence without a full stop.
    pub from: String,
}

/// Reason why there is no reference.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The ray tracer has no colours.
    #[error(transparent)]
    Truth(#[from] truth::Error),
    /// The picture of many samples cannot be drawn.
    #[error(transparent)]
    Frame(#[from] frame::Error),
}

/// Lens points, and slices of dust, of a picture that others are compared with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Samples {
    /// Points of a lens, in 1..=4096.
    pub lens_points: u32,
    /// Slices of dusty air, in 1..=4096.
    pub slices: u32,
}

/// Samples for a row's colours.
pub const MANY: Samples = Samples { lens_points: 1024, slices: 4096 };

/// The most samples, over all pixels, whose rays are cast for a reference: minutes of one core.
const MOST_RAYS: u64 = 1 << 24;

/// The colours of a scene: by the ray tracer, in which light `measured` casts its shadow; else by a drawn picture.
///
/// # Errors
///
/// A truth that the ray tracer cannot find; an error of the plan or the device.
pub fn reference(scene: &Scene, measured: usize, renderer: &mut Renderer) -> Result<Reference, Error> {
    let Some(why) = truth::why_no_colors(scene).or_else(|| why_too_many(scene)) else {
        let colors = colors::true_colors(scene, measured)?;
        let own = if has_samples(scene) { ", with the scene's own lens points and slices" } else { "" };
        return Ok(Reference { colors, from: format!("each pixel's colour in f64, by casting rays{own}") });
    };
    if !has_samples(scene) {
        let Some((drawn, side)) = supersampled(scene, renderer)? else {
            let colors = draw_colors(scene, false, renderer)?.to_truth(|_| false);
            return Ok(Reference {
                colors,
                from: format!("nothing: {why}, and the picture is too large to be averaged"),
            });
        };
        let from = format!(
            "a picture drawn with {side} × {side} samples a pixel, because the ray tracer has no colours: {why}"
        );
        return Ok(Reference { colors: drawn.to_truth(|_| true), from });
    }
    let own = scene.lights.iter().filter_map(|light| Some(light.spot()?.lens()?.samples)).max().unwrap_or(0);
    let many = Samples { lens_points: MANY.lens_points.max(own), ..MANY };
    let from = format!("{}, because the ray tracer has no colours: {why}", many_in_words(scene, many));
    let drawn = draw_colors(&with_samples(scene, many), in_floats(scene), renderer)?;
    Ok(Reference { colors: drawn.to_truth(|_| true), from })
}

/// Reason why the scene has too many samples to cast rays for all.
fn why_too_many(scene: &Scene) -> Option<String> {
    let [width, height] = scene.image.size.map(u64::from);
    let of_light = |light: &Light| {
        let lens = light.spot().and_then(|spot| spot.lens()).map_or(0, |focus| u64::from(focus.samples));
        lens + light.dust.map_or(0, |dust| u64::from(dust.slices))
    };
    let samples: u64 = scene.lights.iter().map(of_light).sum();
    let rays = samples * width * height;
    (rays > MOST_RAYS).then(|| {
        format!("{width} × {height} pixels of {samples} lens points and slices are more than {MOST_RAYS} samples to cast rays for")
    })
}

/// Describes a picture of many samples.
pub fn many_in_words(scene: &Scene, samples: Samples) -> String {
    let has_lens = scene.lights.iter().any(|light| light.spot().is_some_and(|spot| spot.lens().is_some()));
    let has_dust = scene.lights.iter().any(|light| light.dust.is_some());
    let lens = has_lens.then(|| format!("{} lens points", samples.lens_points));
    let dust = has_dust.then(|| format!("{} slices of dust", samples.slices));
    let parts: Vec<String> = lens.into_iter().chain(dust).collect();
    format!("a picture drawn with {}", parts.join(" and "))
}

fn has_samples(scene: &Scene) -> bool {
    let has = |light: &Light| light.dust.is_some() || light.spot().is_some_and(|spot| spot.lens().is_some());
    scene.lights.iter().any(has)
}

/// Tests whether pictures of many samples are compared in floats. The slide projector's passes clamp what 8 bits store
/// between them, and floats do not.
pub fn in_floats(scene: &Scene) -> bool {
    scene.shading.passes != PicturePasses::Slide
}

/// The scene with this many samples in all of its lights, and without the noise of dust.
pub fn with_samples(scene: &Scene, samples: Samples) -> Scene {
    let mut scene = scene.clone();
    for light in &mut scene.lights {
        if let LightKind::Spot(Spot { focus: Some(focus), .. }) = &mut light.kind {
            focus.samples = samples.lens_points;
        }
        if let Some(dust) = &mut light.dust {
            (dust.slices, dust.jitter) = (samples.slices, false);
        }
    }
    scene
}

/// The scene with one light changed.
pub fn with_light(scene: &Scene, index: usize, change: impl FnOnce(&mut Light)) -> Scene {
    let mut scene = scene.clone();
    if let Some(light) = scene.lights.get_mut(index) {
        change(light);
    }
    scene
}

/// The scene with one spotlight changed.
pub fn with_spot(scene: &Scene, index: usize, change: impl FnOnce(&mut Spot)) -> Scene {
    with_light(scene, index, |light| {
        if let LightKind::Spot(spot) = &mut light.kind {
            change(spot);
        }
    })
}

/// The most pixels of a picture that is drawn to be averaged.
const MOST_PIXELS: u64 = 1 << 24;

/// The picture with the mean of several samples in each pixel, and the number of them along a side. `None`: not even four
/// fit into the largest picture.
///
/// # Errors
///
/// An error of the plan or the device.
pub fn supersampled(scene: &Scene, renderer: &mut Renderer) -> Result<Option<(DrawnColors, u32)>, frame::Error> {
    let [width, height] = scene.image.size;
    let limit = u64::from(Limits::default().max_image_size);
    let fits = |side: &u32| {
        let [width, height] = [width, height].map(|size| u64::from(size) * u64::from(*side));
        width.max(height) <= limit && width * height <= MOST_PIXELS
    };
    let Some(side) = [8, 6, 4, 3, 2].into_iter().find(fits) else { return Ok(None) };
    let mut large = scene.clone();
    large.image.size = [width * side, height * side];
    let drawn = draw_colors(&large, false, renderer)?;
    let count = f64::from(side * side);
    let row = (width * side) as usize;
    let mean = |index: usize| {
        let (x, y) = (index % width as usize * side as usize, index / width as usize * side as usize);
        let samples = (y..y + side as usize).flat_map(|y| (x..x + side as usize).map(move |x| y * row + x));
        let sum = samples.fold([0.0; 3], |sum: [f64; 3], at| {
            let codes = drawn.codes.get(at).copied().unwrap_or_default();
            [0, 1, 2].map(|k: usize| sum[k] + codes[k])
        });
        sum.map(|channel| channel / count)
    };
    let codes = (0..width as usize * height as usize).map(mean).collect();
    Ok(Some((DrawnColors { size: [width, height], codes }, side)))
}

/// Tests of each pixel whether it and its four neighbours show one surface: elsewhere the mean of a pixel's samples has
/// several surfaces in it.
pub fn inner_pixels(truth: &Truth) -> Vec<bool> {
    let at = |x: i64, y: i64| {
        let inside = (0..i64::from(truth.width)).contains(&x) && (0..i64::from(truth.height)).contains(&y);
        let pixel = if inside { truth.at(x as u32, y as u32) } else { None };
        pixel.and_then(|pixel| pixel.hit)
    };
    let is_inner = |index: i64| {
        let (x, y) = (index % i64::from(truth.width), index / i64::from(truth.width));
        let Some(hit) = at(x, y) else { return false };
        let same = |(dx, dy): (i64, i64)| {
            at(x + dx, y + dy).is_some_and(|other| other.object == hit.object && other.normal.dot(hit.normal) > 0.9)
        };
        [(1, 0), (-1, 0), (0, 1), (0, -1)].into_iter().all(same)
    };
    (0..i64::from(truth.width) * i64::from(truth.height)).map(is_inner).collect()
}
