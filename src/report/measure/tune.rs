//! Finds the polygon offset, and the smallest map, that a scene needs: by search, judged by the ray tracer.
//!
//! A larger offset only ever removes false shadow and adds leak. So for each slope factor there is a least number of
//! units without false shadow, found by bisection over powers of two; of all factors the pair with the least leak wins.

use super::grid;
use crate::frame::{self, Renderer, draw_shade};
use crate::judge::metrics::{self, Band, FEWEST_COMPARED, Metrics, Ruler};
use crate::scene::{self, Light, Scene, Settings, SettingsError, Shadow, with_shadow};
use crate::techniques::{self, vary};
use crate::truth::{self, Answer, Pixel};

/// Reason why nothing can be tuned.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
pub enum Error {
    /// A setting of the search makes no valid scene.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A value of a technique's table that is no TOML.
    #[error(transparent)]
    Table(#[from] scene::Error),
    /// The ray tracer has no answer for the scene.
    #[error(transparent)]
    Truth(#[from] truth::Error),
    /// A setting could not be drawn.
    #[error(transparent)]
    Frame(#[from] frame::Error),
    /// A picture does not fit its truth.
    #[error(transparent)]
    Metrics(#[from] metrics::Error),
    /// The scene does not have the light.
    #[error("there is no light {index}: the scene's number of lights is {count}")]
    NoLight { index: usize, count: usize },
    /// Too few pixels can be compared.
    #[error(
        "nothing can be tuned: of light {light} {compared} pixels could be compared, {facing} of them on surfaces that face \
         it; each needs {FEWEST_COMPARED} at least. Does the light reach what the camera sees? Is the picture large enough \
         (--size)? Did you mean another light (--light)?"
    )]
    TooFew { light: usize, compared: usize, facing: usize },
}

/// Search range, and limits of a good result.
#[derive(Clone, Debug)]
pub struct TuneOptions {
    /// Index of the tuned light.
    pub light: usize,
    /// Map sizes to try, smallest first.
    pub sizes: Vec<u32>,
    /// The most leak in percent of the pixels compared that the smallest map may have.
    pub leak_percent: f64,
    /// The most pixels in 100,000 that face the light, lie beyond the edge band and may be falsely dark; two always may.
    pub false_per_100_000: f64,
    /// The edge band's half width in texels.
    pub band_texels: f64,
}

/// One point of the curve.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct TunedPoint {
    /// Side of the map in texels.
    pub size: u32,
    /// Slope factor of glPolygonOffset.
    pub factor: f64,
    /// Units of glPolygonOffset.
    pub units: f64,
    /// False shadow on surfaces that face the light, beyond the edge band, in percent of those compared.
    pub false_shadow_percent: f64,
    /// False shadow on surfaces that face the light, the band included, in percent of those compared.
    pub false_shadow_with_band_percent: f64,
    /// Leak, in percent of all pixels that were compared.
    pub leak_percent: f64,
    /// Leak on surfaces that face the light, where shading does not hide it, in percent of those compared.
    pub leak_facing_percent: f64,
    /// False shadow and leak, in percent of all pixels that were compared.
    pub wrong_percent: f64,
    /// True if the false shadow is within [`TuneOptions::false_per_100_000`].
    pub clean: bool,
    /// Pixels that the percentages are of.
    pub compared: usize,
    /// Number of these on surfaces that face the light.
    pub compared_facing: usize,
}

/// Points that the search measured, and its choice.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Tuned {
    /// Every point that was measured, in the order of the search.
    pub curve: Vec<TunedPoint>,
    /// The best offset of each size that has a clean one, by size.
    pub best: Vec<TunedPoint>,
    /// The smallest map that leaks no more than it may, or, where none does, the one that leaks least.
    pub chosen: Option<TunedPoint>,
    /// The chosen point as `[light.shadow]`, with the other keys of the scene's own: it replaces that table.
    pub chosen_toml: Option<String>,
    /// Pixels of which the truth is sure and which were drawn.
    pub compared: usize,
    /// Number of these on surfaces that face the light.
    pub compared_facing: usize,
    /// Number of these in shadow.
    pub compared_shadowed: usize,
    /// True if `chosen` is within the requested leak.
    pub within_leak: bool,
    /// Techniques that have no offset to tune, as they are by default.
    pub rivals: Vec<Rival>,
}

/// A technique without polygon offset on the same scene.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Rival {
    /// Name of the technique, as in a scene file.
    pub technique: &'static str,
    /// Settings in TOML.
    pub settings: String,
    /// Errors as in [`TunedPoint`]; or why it cannot draw this scene.
    pub errors: Result<RivalErrors, String>,
}

/// Errors of a rival, in percent as in [`TunedPoint`].
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct RivalErrors {
    /// As [`TunedPoint::false_shadow_percent`].
    pub false_shadow_percent: f64,
    /// As [`TunedPoint::leak_percent`].
    pub leak_percent: f64,
    /// As [`TunedPoint::wrong_percent`].
    pub wrong_percent: f64,
}

/// Slope factors that are tried; [HSM, "Why Is Polygon Offset Needed?"] says about 1.0.
const FACTORS: [f64; 8] = [0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0];
/// Powers of two of units that are tried; 0 stands before them.
const MOST_UNITS_LOG2: i32 = 20;

/// Searches. `tick` is called with each measured point.
///
/// # Errors
///
/// A light that is not there or has no map, a truth that is not known, a frame that cannot be drawn.
pub fn tune(
    scene: &Scene,
    options: &TuneOptions,
    renderer: &mut Renderer,
    mut tick: impl FnMut(&TunedPoint),
) -> Result<Tuned, Error> {
    let count = scene.lights.len();
    scene.lights.get(options.light).ok_or(Error::NoLight { index: options.light, count })?;
    let truth = truth::trace(scene, options.light, &truth::Options::default())?;
    let is_sure = |pixel: &&Pixel| matches!(pixel.answer, Answer::Lit | Answer::Shadowed);
    let faces = |pixel: &&Pixel| pixel.hit.is_some_and(|hit| hit.faces_light());
    let sure = || truth.pixels.iter().filter(is_sure);
    check_count(options.light, sure().count(), sure().filter(faces).count())?;
    let ruler = Ruler::new(&truth);
    let mut search = Search::new(scene, &ruler, options, renderer, &mut tick);
    let mut best = Vec::new();
    for size in &options.sizes {
        if let Some(point) = search.best_of(*size, &FACTORS, |point| point.leak_percent, &|point| point.clean)? {
            best.push(point);
            if point.leak_percent <= options.leak_percent {
                break; // the smallest: larger maps cost more
            }
        }
    }
    let within = best.iter().find(|point| point.leak_percent <= options.leak_percent).copied();
    let least = best.iter().min_by(|a, b| a.leak_percent.total_cmp(&b.leak_percent)).copied();
    let rivals = search.rivals()?;
    let curve = search.curve;
    let (compared, compared_facing) = curve.first().map_or((0, 0), |point| (point.compared, point.compared_facing));
    check_count(options.light, compared, compared_facing)?;
    let chosen = within.or(least);
    let toml = |point: TunedPoint| {
        let written = scene.lights[options.light].shadow.written();
        let table = vary::with_offset(written, point.size, point.factor, point.units);
        let lines = table.entries.iter().map(|(key, entry)| format!("{key} = {}\n", entry.value.to_toml()));
        format!("[light.shadow]\n{}", lines.collect::<String>())
    };
    Ok(Tuned {
        curve,
        best,
        chosen,
        chosen_toml: chosen.map(toml),
        compared,
        compared_facing,
        compared_shadowed: truth.count(|answer| answer == Answer::Shadowed),
        within_leak: within.is_some(),
        rivals,
    })
}

/// Refuses to conclude from too few pixels.
fn check_count(light: usize, compared: usize, facing: usize) -> Result<(), Error> {
    if compared.min(facing) < FEWEST_COMPARED { Err(Error::TooFew { light, compared, facing }) } else { Ok(()) }
}

/// State of the search on a scene.
pub(super) struct Search<'a> {
    scene: &'a Scene,
    ruler: &'a Ruler<'a>,
    options: &'a TuneOptions,
    renderer: &'a mut Renderer,
    curve: Vec<TunedPoint>,
    tick: &'a mut dyn FnMut(&TunedPoint),
}

impl<'a> Search<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        ruler: &'a Ruler<'a>,
        options: &'a TuneOptions,
        renderer: &'a mut Renderer,
        tick: &'a mut dyn FnMut(&TunedPoint),
    ) -> Self {
        Self { scene, ruler, options, renderer, curve: Vec::new(), tick }
    }

    /// Chooses, among the points at one map size and slope factors that are `enough`, the one of least `leak`.
    pub(super) fn best_of(
        &mut self,
        size: u32,
        factors: &[f64],
        leak: fn(&TunedPoint) -> f64,
        enough: &dyn Fn(&TunedPoint) -> bool,
    ) -> Result<Option<TunedPoint>, Error> {
        let mut best: Option<TunedPoint> = None;
        for factor in factors {
            if let Some(point) = self.least_units(size, *factor, enough)?
                && best.is_none_or(|best| leak(&point) < leak(&best))
            {
                best = Some(point);
            }
        }
        Ok(best)
    }

    /// The least power of two of units, or none at all, that is `enough` with `factor`.
    fn least_units(
        &mut self,
        size: u32,
        factor: f64,
        enough: &dyn Fn(&TunedPoint) -> bool,
    ) -> Result<Option<TunedPoint>, Error> {
        // Exponents; -1 stands for no units.
        let (mut low, mut high) = (-1, MOST_UNITS_LOG2);
        let mut found = self.point(size, factor, units_of(high))?;
        if !enough(&found) {
            return Ok(None);
        }
        while low < high {
            let middle = (low + high).div_euclid(2);
            let point = self.point(size, factor, units_of(middle))?;
            if enough(&point) {
                (found, high) = (point, middle);
            } else {
                low = middle + 1;
            }
        }
        Ok(Some(found))
    }

    /// Units between those of a `point` that is `enough` and half of them, to a sixteenth of them, as few as are enough.
    pub(super) fn refined(
        &mut self,
        point: TunedPoint,
        enough: &dyn Fn(&TunedPoint) -> bool,
    ) -> Result<TunedPoint, Error> {
        let (mut low, mut found) = (0.5 * point.units, point);
        for _ in 0..3 {
            let middle = self.point(point.size, point.factor, 0.5 * (low + found.units))?;
            if enough(&middle) {
                found = middle;
            } else {
                low = middle.units;
            }
        }
        Ok(found)
    }

    /// Every technique that draws shadows and has no offset to tune.
    fn rivals(&mut self) -> Result<Vec<Rival>, Error> {
        let rivals = vary::rivals()?.into_iter().map(|(technique, keys)| {
            let table = vary::over(self.light().shadow.written(), &keys);
            let settings = grid::to_inline(&table);
            let errors = self.read(table).map_err(|error| error.to_string());
            let errors = errors.and_then(|shadow| self.errors_of(&shadow));
            Rival { technique: technique.name(), settings, errors }
        });
        Ok(rivals.collect())
    }

    fn light(&self) -> &'a Light {
        &self.scene.lights[self.options.light]
    }

    /// The settings that a table has for the light.
    fn read(&self, table: Settings) -> Result<Shadow, SettingsError> {
        techniques::read(table, &self.light().kind, &self.scene.objects)
    }

    fn errors_of(&mut self, shadow: &Shadow) -> Result<RivalErrors, String> {
        let scene = with_shadow(self.scene, self.options.light, shadow);
        let shade = draw_shade(&scene, self.options.light, self.renderer).map_err(|error| error.to_string())?;
        let band = Band { texels: self.options.band_texels, map_size: [techniques::map_size(shadow); 2] };
        let metrics = self.ruler.count(&shade, &band).map_err(|error| error.to_string())?;
        Ok(RivalErrors {
            false_shadow_percent: metrics.facing.false_shadow.outside_percent,
            leak_percent: metrics.all.leak_percent,
            wrong_percent: metrics.all.wrong_percent,
        })
    }

    fn point(&mut self, size: u32, factor: f64, units: f64) -> Result<TunedPoint, Error> {
        let shadow = self.read(vary::with_offset(self.light().shadow.written(), size, factor, units))?;
        let scene = with_shadow(self.scene, self.options.light, &shadow);
        let shade = draw_shade(&scene, self.options.light, self.renderer)?;
        let band = Band { texels: self.options.band_texels, map_size: [size; 2] };
        let Metrics { all, facing, .. } = self.ruler.count(&shade, &band)?;
        let false_shadow_percent = facing.false_shadow.outside_percent;
        let point = TunedPoint {
            size,
            factor,
            units,
            false_shadow_percent,
            false_shadow_with_band_percent: facing.false_shadow_percent,
            leak_percent: all.leak_percent,
            leak_facing_percent: facing.leak_percent,
            wrong_percent: all.wrong_percent,
            clean: facing.false_shadow.outside as f64 <= self.spare(facing.compared),
            compared: all.compared,
            compared_facing: facing.compared,
        };
        self.curve.push(point);
        (self.tick)(&point);
        Ok(point)
    }
}

impl Search<'_> {
    /// Number of pixels that may stay falsely dark: single ones at the band's rim are no acne, however small the picture.
    fn spare(&self, compared: usize) -> f64 {
        (1e-5 * self.options.false_per_100_000 * compared as f64).max(SPARE_PIXELS)
    }
}

/// See [`Search::spare`].
const SPARE_PIXELS: f64 = 2.0;

fn units_of(exponent: i32) -> f64 {
    if exponent < 0 { 0.0 } else { f64::from(exponent).exp2() }
}
