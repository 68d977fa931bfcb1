//! Draws an entry's pictures and finds its numbers.

use std::io;

use image::RgbImage;

use super::entry::{EntryMeasure, GalleryEntry, WrittenSide};
use super::faults::Fault;
use super::{Error, scenes};
use crate::device::Pixels;
use crate::frame::{Renderer, ShadeImage};
use crate::judge::colors::{self, ColorErrors, DrawnColors};
use crate::judge::difference::difference_picture;
use crate::judge::metrics::{self, Band, Errors};
use crate::judge::truth_pictures::of_colors;
use crate::output;
use crate::plan::{Plan, Request, ViewRequest};
use crate::png_file::{self, PngTexts};
use crate::scene::{Embedded, Scene};
use crate::truth::{self, ColorTruth, Truth};
use crate::views::View;

/// One of an entry's two sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntrySide {
    Failure,
    Cure,
}

/// An entry with its pictures and numbers.
#[derive(Clone, Debug)]
pub struct ShownEntry {
    pub failure: DrawnSide,
    pub cure: DrawnSide,
    /// The scene of the cure by ray casting.
    pub truth: RgbImage,
    /// Errors of the failure over the truth.
    pub difference: RgbImage,
}

/// One side as it was drawn.
#[derive(Clone, Debug)]
pub struct DrawnSide {
    pub scene: Scene,
    pub picture: RgbImage,
    pub plan: Plan,
    pub numbers: Numbers,
}

/// Shares in percent of what was compared, and errors of colours; `None`: not measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Numbers {
    pub false_shadow: Option<f64>,
    pub leak: Option<f64>,
    pub colors: Option<ColorErrors>,
}

impl Numbers {
    /// A measure's number.
    pub fn get(&self, measure: EntryMeasure) -> Option<f64> {
        match measure {
            EntryMeasure::FalseShadow => self.false_shadow,
            EntryMeasure::Leak => self.leak,
            EntryMeasure::Wrong => Some(self.false_shadow? + self.leak?),
            EntryMeasure::Colors => Some(self.colors?.beyond_percent),
            EntryMeasure::Rmse => Some(self.colors?.rmse_codes),
        }
    }
}

impl GalleryEntry {
    /// The side as written.
    pub fn side(&self, side: EntrySide) -> &WrittenSide {
        match side {
            EntrySide::Failure => &self.failure,
            EntrySide::Cure => &self.cure,
        }
    }

    /// Overrides of a side in their order, as `--set` takes them.
    pub fn overrides(&self, side: EntrySide) -> Vec<String> {
        self.set.iter().chain(&self.side(side).set).cloned().collect()
    }

    /// Scene of a side. `quick`: half as many pixels a side.
    ///
    /// # Errors
    ///
    /// A scene that is not compiled in, or an override that does not fit it.
    pub fn scene_of(&self, side: EntrySide, quick: bool) -> Result<Scene, Error> {
        let embedded = scenes::find(&self.scene)
            .ok_or_else(|| Error::NoScene { id: self.id.clone(), scene: self.scene.clone() })?;
        let mut overrides = self.overrides(side);
        let scene = load(&self.id, embedded, &overrides)?;
        if !quick {
            return Ok(scene);
        }
        let [width, height] = quick_size(scene.image.size);
        overrides.insert(0, format!("image.size=[{width}, {height}]"));
        load(&self.id, embedded, &overrides)
    }
}

/// Loads a scene for the entry of this id.
pub fn load(id: &str, embedded: &Embedded, overrides: &[String]) -> Result<Scene, Error> {
    let loaded = crate::techniques::load_embedded(embedded, overrides);
    loaded.map(|loaded| loaded.scene).map_err(|reason| Error::Scene { id: id.to_owned(), reason: Box::new(reason) })
}

/// Size of a quick picture.
pub fn quick_size(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| (side / 2).max(1))
}

/// Truth that both sides are compared with.
enum Compared {
    Shade(Truth),
    Colors(ColorTruth),
}

/// Draws and measures an entry.
///
/// # Errors
///
/// A scene that cannot be loaded, planned, drawn or traced.
pub fn show(entry: &GalleryEntry, quick: bool, renderer: &mut Renderer) -> Result<ShownEntry, Error> {
    let [failing, cured] = [entry.scene_of(EntrySide::Failure, quick)?, entry.scene_of(EntrySide::Cure, quick)?];
    let traced = |reason| Error::Truth { id: entry.id.clone(), reason };
    let true_colors = colors::true_colors(&cured, entry.light);
    let compared = if entry.measure.is_of_colors() {
        Compared::Colors(true_colors.as_ref().map_err(|_| Error::NothingKnown { id: entry.id.clone() })?.clone())
    } else {
        let options = truth::Options { most_ambiguous: 1.0, ..truth::Options::default() };
        Compared::Shade(truth::trace(&cured, entry.light, &options).map_err(traced)?)
    };
    let (failure, difference) = draw(entry, entry.fault, failing, &compared, renderer)?;
    let (cure, _) = draw(entry, None, cured, &compared, renderer)?;
    let truth = match (&true_colors, &compared) {
        (Ok(truth), _) | (Err(_), Compared::Colors(truth)) => {
            colors::known_or_drawn(truth, &drawn_colors(&cure.picture))
        }
        (Err(_), Compared::Shade(truth)) => crate::judge::difference::truth_picture(truth),
    };
    Ok(ShownEntry { failure, cure, truth, difference })
}

/// A side, and its differences from the truth as a picture.
fn draw(
    entry: &GalleryEntry,
    fault: Option<Fault>,
    mut scene: Scene,
    compared: &Compared,
    renderer: &mut Renderer,
) -> Result<(DrawnSide, RgbImage), Error> {
    let failed = |reason| Error::Frame { id: entry.id.clone(), reason: Box::new(reason) };
    if let Some(change) = fault.and_then(Fault::change) {
        change.apply(&mut scene).map_err(|reason| Error::Skin { id: entry.id.clone(), reason })?;
    }
    let mut plan = renderer.plan(&scene, &request(fault, Vec::new())).map_err(failed)?;
    make(fault, &mut plan, &scene).ok_or_else(|| Error::NoFault { id: entry.id.clone() })?;
    renderer.draw(&plan).map_err(failed)?;
    let pixels = renderer.read(&plan).map_err(failed)?.picture;
    let picture = to_rgb(&pixels);
    let (numbers, difference) = match compared {
        Compared::Colors(truth) => {
            let drawn = drawn_colors(&picture);
            let errors = colors::errors_of(truth, &drawn).map(|(errors, _)| errors);
            let errors = errors.ok_or_else(|| Error::NothingKnown { id: entry.id.clone() })?;
            (Numbers { colors: Some(errors), ..Numbers::default() }, to_rgb(&of_colors(truth, &pixels, true, false)))
        }
        Compared::Shade(truth) => {
            let (facing, difference) = facing_errors(&entry.id, &scene, (entry.light, truth), fault, renderer)?;
            let numbers = Numbers {
                false_shadow: Some(facing.false_shadow_percent),
                leak: Some(facing.leak_percent),
                colors: None,
            };
            (numbers, difference)
        }
    };
    Ok((DrawnSide { scene, picture, plan, numbers }, difference))
}

/// Errors of a light's shade on surfaces that face the light, and a picture of them.
///
/// # Errors
///
/// A scene that cannot be planned or drawn.
pub fn facing_errors(
    id: &str,
    scene: &Scene,
    (light, truth): (usize, &Truth),
    fault: Option<Fault>,
    renderer: &mut Renderer,
) -> Result<(Errors, RgbImage), Error> {
    let judged = |reason| Error::Judge { id: id.to_owned(), reason };
    let shade = shade(scene, light, fault, renderer);
    let mut shade = shade.map_err(|reason| Error::Frame { id: id.to_owned(), reason: Box::new(reason) })?;
    // Shares are wanted, not where they lie: no band.
    let band = Band { texels: 0.0, map_size: [1, 1] };
    let facing = metrics::compare(truth, &shade, &band).map_err(judged)?.facing;
    // On the other surfaces shading leaves no light: no error is seen.
    for (value, pixel) in shade.shade.iter_mut().zip(&truth.pixels) {
        if pixel.hit.is_some_and(|hit| !hit.faces_light()) {
            *value = f32::NAN;
        }
    }
    Ok((facing, difference_picture(truth, &shade).map_err(judged)?))
}

/// A plan that the fault can be made in.
fn request(fault: Option<Fault>, views: Vec<ViewRequest>) -> Request {
    Request { views, keep_all: fault.is_some_and(Fault::keeps_all), ..Request::default() }
}

/// Makes a mistake in the passes; `None`: they have nothing that it changes.
fn make(fault: Option<Fault>, plan: &mut Plan, scene: &Scene) -> Option<()> {
    match fault {
        Some(fault) if fault.change().is_none() => (fault.apply(plan, &scene.camera) > 0).then_some(()),
        _ => Some(()),
    }
}

/// The shade of a light.
fn shade(
    scene: &Scene,
    light: usize,
    fault: Option<Fault>,
    renderer: &mut Renderer,
) -> Result<ShadeImage, crate::frame::Error> {
    let views = vec![ViewRequest { view: View::Shade, light }];
    let mut plan = renderer.plan(scene, &Request { sampled_warnings: false, ..request(fault, views) })?;
    make(fault, &mut plan, scene);
    renderer.draw(&plan)?;
    let texels = match renderer.read(&plan)?.views.pop() {
        Some(Pixels::RgbaF32 { data, .. }) => data,
        _ => Vec::new(),
    };
    Ok(ShadeImage::of_view(scene.image.size, &texels))
}

fn to_rgb(pixels: &Pixels) -> RgbImage {
    let canvas = output::to_canvas(pixels, None);
    let [width, height] = canvas.size();
    RgbImage::from_raw(width, height, canvas.into_bytes()).unwrap_or_default()
}

fn drawn_colors(picture: &RgbImage) -> DrawnColors {
    let codes = picture.pixels().map(|pixel| pixel.0.map(f64::from));
    DrawnColors { size: [picture.width(), picture.height()], codes: codes.collect() }
}

/// A picture as a PNG file.
///
/// # Errors
///
/// A picture that cannot be encoded.
pub fn to_png(picture: &RgbImage) -> io::Result<Vec<u8>> {
    png_file::of_rgb(picture, &PngTexts::titled("glumbra gallery"))
}
