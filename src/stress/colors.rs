//! Colours of a scene in projected light, or with bumps, pixel by pixel against their bounds in f64.
//!
//! # Rows
//! - without shadows, in 8 bits: no pixel may be beyond its bounds, but for roundings and tables;
//! - the same in floats, which nothing clamps; not of register combiners, which do;
//! - with shadow maps. In destination alpha a pixel beyond its bounds may be a texel's: it is excused where one pass shows the
//!   same. Through lenses and in dusty air many maps or slices make a pixel: the mean over the picture counts.

use super::results::{CaseRow, Verdict};
use super::rows::RowSettings;
use crate::device::Pixels;
use crate::frame::{self, Renderer};
use crate::judge::colors::{color_options, has_projected_light, shadow_of};
use crate::plan::Request;
use crate::scene::{Law, PicturePasses, Scene, Spot};
use crate::techniques;
use crate::truth::{self, ColorPixel, ColorRequest, ColorTruth};

/// Names of the rows, in a table's order.
pub const NAMES: [&str; 7] = ["beam", "slide-projector", "alpha-shadows", "focus", "dust", "bump", "colors"];

/// Codes of 1/255 that a pixel may be off beyond what the error of its sample explains: its own rounding, and half a code
/// each for the texels of a map, between them, and between those of a law of distance.
const ALLOWED_CODES: f64 = 2.0;

/// Codes that a picture with shadow maps may be off in the mean over its pixels: a share of what its shadows take, by which
/// the maps' texels move their edges, and what is rounded.
const MEAN_CODES: f64 = 0.25;
const MEAN_SHARE: f64 = 0.04;

/// Name of the rows of a scene's colours.
pub fn name_of(scene: &Scene) -> &'static str {
    let spots = || scene.lights.iter().filter_map(|light| light.spot());
    match scene.shading.passes {
        PicturePasses::Slide => NAMES[1],
        PicturePasses::Shadow => NAMES[2],
        PicturePasses::One if spots().any(|spot| Spot::lens(spot).is_some()) => NAMES[3],
        PicturePasses::One if scene.lights.iter().any(|light| light.dust.is_some()) => NAMES[4],
        PicturePasses::One if scene.objects.iter().any(|object| object.bases.is_some()) => NAMES[5],
        PicturePasses::One if has_projected_light(scene) => NAMES[0],
        PicturePasses::One => NAMES[6],
    }
}

/// The rows of a scene, and the share of pixels whose colour is known.
pub fn rows(scene: &Scene, renderer: &mut Renderer) -> (Vec<CaseRow>, f64) {
    rows_of(scene, scene, renderer)
}

/// The same with pictures of another scene of the same size, to test that a broken scene is noticed.
pub fn rows_of(scene: &Scene, drawn: &Scene, renderer: &mut Renderer) -> (Vec<CaseRow>, f64) {
    let mut judge = ColorJudge { scene, drawn, name: name_of(scene), known: 1.0 };
    let mut rows = vec![judge.unshadowed(false, renderer)];
    if has_projected_light(scene) && judge.name != NAMES[0] && !truth::has_combined_bumps(scene) {
        rows.push(judge.unshadowed(true, renderer));
    }
    if NAMES[2..].contains(&judge.name) {
        rows.push(judge.shadowed(renderer));
    }
    (rows, judge.known)
}

struct ColorJudge<'a> {
    scene: &'a Scene,
    /// The scene whose picture is judged.
    drawn: &'a Scene,
    name: &'static str,
    known: f64,
}

impl ColorJudge<'_> {
    fn row(&self, keys: &str) -> CaseRow {
        let settings = RowSettings { technique: self.name.to_owned(), keys: keys.to_owned(), pictured: true };
        CaseRow::new(0, &settings)
    }

    fn unshadowed(&mut self, float_picture: bool, renderer: &mut Renderer) -> CaseRow {
        let row = self.row(if float_picture { "floats" } else { "" });
        let scene = without_shadows(self.scene);
        let mut judged = || -> Result<_, String> {
            let request = ColorRequest { float_picture, ..ColorRequest::default() };
            let none = vec![None; scene.lights.len()];
            let colors = truth::color_as(&scene, &none, &request, &color_options(&scene));
            let colors = colors.map_err(|error| error.to_string())?;
            let (picture, warnings) = draw(&without_shadows(self.drawn), float_picture, renderer)?;
            Ok((colors, picture, warnings))
        };
        match judged() {
            Ok((colors, picture, warnings)) => {
                let known = colors.pixels.iter().filter(|pixel| pixel.is_known).count();
                self.known = known as f64 / colors.pixels.len().max(1) as f64;
                let beyond = beyond(&colors, &picture);
                let beyond = beyond.into_iter().filter(|beyond| *beyond).count();
                finish(row, known, [beyond; 2], &warnings)
            }
            Err(why) => CaseRow { verdict: Verdict::Refused, why, ..row },
        }
    }

    fn shadowed(&mut self, renderer: &mut Renderer) -> CaseRow {
        let row = self.row("technique = \"shadow-map\"");
        match self.judge_shadows(&row, renderer) {
            Ok(row) => row,
            Err(why) => CaseRow { verdict: Verdict::Refused, why, ..row },
        }
    }

    fn judge_shadows(&self, row: &CaseRow, renderer: &mut Renderer) -> Result<CaseRow, String> {
        let scene = with_shadows(self.scene)?;
        let shadows: Vec<_> = scene.lights.iter().map(|light| shadow_of(&light.shadow, false)).collect();
        let request = ColorRequest::default();
        let options = color_options(&scene);
        let colors = |shadows: &[Option<f64>]| {
            truth::color_as(&scene, shadows, &request, &options).map_err(|error| error.to_string())
        };
        let truth = colors(&shadows)?;
        let (picture, warnings) = draw(&with_shadows(self.drawn)?, false, renderer)?;
        let mut beyond = beyond(&truth, &picture);
        let wrong = beyond.iter().filter(|beyond| **beyond).count();
        if self.name == NAMES[2] {
            let mut one = scene.clone();
            one.shading.passes = PicturePasses::One;
            let (one, _) = draw(&one, false, renderer)?;
            let rounded = truth.between_passes_codes + 0.5;
            for (beyond, (is, due)) in beyond.iter_mut().zip(picture.iter().zip(&one)) {
                *beyond &= (0..3).any(|k| (is[k] - due[k]).abs() > rounded);
            }
        } else {
            let open = colors(&vec![None; scene.lights.len()])?;
            let taken =
                mean(&open, &truth, |open, pixel| pixel.error_codes(open.rgb.map(|channel| 255.0 * channel.value)));
            let excess = mean_excess(&truth, &picture);
            if excess <= MEAN_CODES + MEAN_SHARE * taken {
                beyond.fill(false);
            }
        }
        let known = truth.pixels.iter().filter(|pixel| pixel.is_known).count();
        let beyond = beyond.into_iter().filter(|beyond| *beyond).count();
        Ok(finish(row.clone(), known, [wrong, beyond], &warnings))
    }
}

fn finish(row: CaseRow, compared: usize, [wrong, beyond]: [usize; 2], warnings: &[String]) -> CaseRow {
    let verdict = match (beyond == 0, warnings.is_empty()) {
        (true, true) => Verdict::Right,
        (true, false) => Verdict::FalseAlarm,
        (false, false) => Verdict::Warned,
        (false, true) => Verdict::SilentlyWrong,
    };
    CaseRow { verdict, compared, wrong, beyond, why: warnings.join("; "), ..row }
}

/// Tests each pixel against its bounds. Above 1, in float pictures, the tolerance grows with the colour: it is the sum of
/// many parts, or their product with a bright light.
fn beyond(colors: &ColorTruth, picture: &[[f64; 3]]) -> Vec<bool> {
    let allowed = ALLOWED_CODES + colors.between_passes_codes;
    let pixels = colors.pixels.iter().zip(picture);
    let is_beyond = |pixel: &ColorPixel, codes: [f64; 3]| {
        let bright = pixel.rgb.iter().map(|channel| channel.most).fold(1.0, f64::max);
        pixel.is_known && pixel.excess_codes(codes) > allowed * bright
    };
    pixels.map(|(pixel, codes)| is_beyond(pixel, *codes)).collect()
}

/// Mean over known pixels of how far they are beyond their bounds and the roundings between passes, in codes.
fn mean_excess(colors: &ColorTruth, picture: &[[f64; 3]]) -> f64 {
    let known = colors.pixels.iter().zip(picture).filter(|(pixel, _)| pixel.is_known);
    let excess = known.map(|(pixel, codes)| (pixel.excess_codes(*codes) - colors.between_passes_codes - 0.5).max(0.0));
    let (sum, count) = excess.fold((0.0, 0), |(sum, count), excess| (sum + excess, count + 1));
    sum / f64::from(count.max(1))
}

/// Mean over pixels that both know.
fn mean(one: &ColorTruth, other: &ColorTruth, value: impl Fn(&ColorPixel, &ColorPixel) -> f64) -> f64 {
    let known = one.pixels.iter().zip(&other.pixels).filter(|(one, other)| one.is_known && other.is_known);
    let (sum, count) = known.fold((0.0, 0), |(sum, count), (one, other)| (sum + value(one, other), count + 1));
    sum / f64::from(count.max(1))
}

fn without_shadows(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.lights.iter_mut().for_each(|light| light.shadow = techniques::unshadowed());
    scene
}

/// The scene with a shadow map for each light that has no shadow and may have one.
fn with_shadows(scene: &Scene) -> Result<Scene, String> {
    let mut scene = scene.clone();
    for light in 0..scene.lights.len() {
        let is_plain = shadow_of(&scene.lights[light].shadow, false).is_none();
        if is_plain && scene.lights[light].law == Law::Lit {
            let read = techniques::with_keys(&scene, light, "technique = \"shadow-map\"");
            scene = read.map_err(|error| error.to_string())?;
        }
    }
    Ok(scene)
}

/// The picture in codes of 1/255, and the plan's warnings.
fn draw(scene: &Scene, float_picture: bool, renderer: &mut Renderer) -> Result<(Vec<[f64; 3]>, Vec<String>), String> {
    let drawn = |renderer: &mut Renderer| -> Result<_, frame::Error> {
        let plan = renderer.plan(scene, &Request { float_picture, ..Request::default() })?;
        renderer.draw(&plan)?;
        Ok((renderer.read(&plan)?.picture, plan.warnings))
    };
    let (picture, warnings) = drawn(renderer).map_err(|error| error.to_string())?;
    let codes: Vec<f64> = match picture {
        Pixels::Rgba8 { data, .. } => data.iter().map(|code| f64::from(*code)).collect(),
        Pixels::RgbaF32 { data, .. } => data.iter().map(|value| 255.0 * f64::from(*value)).collect(),
        _ => return Err(String::from("the picture was not read back as colours")),
    };
    Ok((codes.as_chunks::<4>().0.iter().map(|[red, green, blue, _]| [*red, *green, *blue]).collect(), warnings))
}
