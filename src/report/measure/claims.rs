//! Claims of the techniques' documents, measured on a report's scene: each with its two numbers, and whether it holds here.
//! The claims are the techniques' own data; their contenders are drawn and tuned here.

use glam::{DMat4, DVec3, DVec4};

use super::grid::to_inline;
use super::tune::{self, Search, TunedPoint};
use crate::frame::{Renderer, draw_shade};
use crate::judge::metrics::{self, Band, ErrorSplit, FEWEST_COMPARED, Metrics, Ruler};
use crate::pass::DepthFormat;
use crate::report::numbers::plain;
use crate::report::store::claimed::{ClaimVerdict, Claimed, Measurement};
use crate::scene::{self, Scene, Settings, with_shadow};
use crate::techniques::claims::{Contender, Quantity, Relation};
use crate::techniques::{self, LightShadow, TABLE, vary};
use crate::truth::{Answer, Hit, Truth};

/// Slope factors that are tried; a constant offset has none.
const FACTORS: [f64; 5] = [1.0, 1.5, 2.0, 3.0, 4.0];

/// Measures every claim of the techniques that serve the light on its scene.
///
/// # Errors
///
/// A frame that cannot be drawn, for reasons other than a technique's: see [`tune::Error`].
pub fn measure(
    scene: &Scene,
    light: usize,
    truth: &Truth,
    band_texels: f64,
    renderer: &mut Renderer,
) -> Result<Vec<Claimed>, tune::Error> {
    let source = &scene.lights[light];
    let as_tuned = techniques::read(vary::tunable(source.shadow.written()), &source.kind, &scene.objects)?;
    let size = techniques::map_size(&as_tuned);
    let format = LightShadow::of(&as_tuned).and_then(LightShadow::map).map_or(DepthFormat::Depth24, |map| map.format);
    let options =
        tune::TuneOptions { light, sizes: vec![size], leak_percent: 0.0, false_per_100_000: 1.0, band_texels };
    let ruler = Ruler::new(truth);
    let mut contest = Contest { scene, ruler: &ruler, options, size, format, renderer, seen: Vec::new() };
    let mut claimed = Vec::new();
    for technique in TABLE.iter().filter(|technique| technique.serves(&source.kind).is_ok()) {
        for claim in technique.claims() {
            let [first, second] = [claim.first, claim.second].map(|who| contest.measurement(who, claim.quantity));
            let (first, second) = (first?, second?);
            claimed.push(Claimed {
                technique: technique.name().to_owned(),
                source: technique.source().to_owned(),
                says: claim.says.to_owned(),
                quantity: name(claim.quantity).to_owned(),
                verdict: judge(claim.relation, &first, &second),
                relation: in_words(claim.relation),
                first,
                second,
                ratio_range: None,
            });
        }
    }
    Ok(claimed)
}

/// The relation in words.
pub(super) fn in_words(relation: Relation) -> String {
    match relation {
        Relation::AtMost(times) => format!("at most {} ×", plain(times)),
        Relation::Greater => String::from("more than"),
    }
}

fn name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::FalseShadow => "false shadow facing the light, beyond the band, %",
        Quantity::FalseShadowWithBand => "false shadow facing the light, %",
        Quantity::Leak => "leak on all surfaces, %",
        Quantity::LeakFacing => "leak facing the light, %",
        Quantity::WrongFacing => "wrong facing the light, %",
        Quantity::WrongAway => "wrong of what is turned away, %",
        Quantity::Offset => "median offset, 2⁻²⁴ of the depth range",
    }
}

pub(super) fn judge(relation: Relation, first: &Measurement, second: &Measurement) -> ClaimVerdict {
    let (Some(a), Some(b)) = (first.value, second.value) else { return ClaimVerdict::Unknown };
    let holds = match relation {
        Relation::AtMost(times) => a <= times * b,
        Relation::Greater => a > b,
    };
    if holds { ClaimVerdict::Holds } else { ClaimVerdict::Fails }
}

/// The contenders of one scene, each drawn once.
struct Contest<'a> {
    scene: &'a Scene,
    ruler: &'a Ruler<'a>,
    options: tune::TuneOptions,
    size: u32,
    format: DepthFormat,
    renderer: &'a mut Renderer,
    seen: Vec<(Contender, Seen)>,
}

/// One contender: its settings, its offset where it has one, and its errors, or the reason why it has none.
#[derive(Clone)]
struct Seen {
    settings: String,
    point: Option<TunedPoint>,
    metrics: Result<Metrics, String>,
}

impl Contest<'_> {
    fn measurement(&mut self, who: Contender, quantity: Quantity) -> Result<Measurement, tune::Error> {
        let seen = self.seen(who)?;
        let (value, why) = match &seen.metrics {
            Err(why) => (None, Some(why.clone())),
            Ok(metrics) if compared(metrics, quantity) < FEWEST_COMPARED => {
                (None, Some(format!("fewer than {FEWEST_COMPARED} pixels could be compared")))
            }
            Ok(metrics) => {
                let value = match quantity {
                    Quantity::FalseShadow => Some(metrics.facing.false_shadow.outside_percent),
                    Quantity::FalseShadowWithBand => Some(metrics.facing.false_shadow_percent),
                    Quantity::Leak => Some(metrics.all.leak_percent),
                    Quantity::LeakFacing => Some(metrics.facing.leak_percent),
                    Quantity::WrongFacing => Some(metrics.facing.wrong_percent),
                    Quantity::WrongAway => wrong_away(metrics),
                    Quantity::Offset => seen.point.and_then(|point| self.median_offset(&point)),
                };
                let why = value.is_none().then(|| String::from("nothing in the picture shows it"));
                (value, why)
            }
        };
        Ok(Measurement { settings: seen.settings, value, why })
    }

    fn seen(&mut self, who: Contender) -> Result<Seen, tune::Error> {
        if let Some((_, seen)) = self.seen.iter().find(|(other, _)| *other == who) {
            return Ok(seen.clone());
        }
        let seen = match who {
            Contender::SlopeScaled => self.tuned(&FACTORS, &|point| point.clean)?,
            Contender::Constant => {
                let most = self.seen(Contender::SlopeScaled)?.point.map_or(0.0, |p| p.false_shadow_with_band_percent);
                self.tuned(&[0.0], &|point| point.false_shadow_with_band_percent <= most)?
            }
            Contender::Keys(keys) => {
                let keys = scene::shadow_settings(keys)?;
                let table = vary::beside_tuned(self.written(), self.size, &keys);
                Seen {
                    settings: format!("{}, size = {}", to_inline(&keys), self.size),
                    point: None,
                    metrics: self.errors(table),
                }
            }
        };
        self.seen.push((who, seen.clone()));
        Ok(seen)
    }

    /// A shadow map whose offset has one of these factors and is `enough`.
    fn tuned(&mut self, factors: &[f64], enough: &dyn Fn(&TunedPoint) -> bool) -> Result<Seen, tune::Error> {
        let mut tick = |_: &TunedPoint| ();
        let mut search = Search::new(self.scene, self.ruler, &self.options, self.renderer, &mut tick);
        let Some(point) = search.best_of(self.size, factors, |point| point.leak_facing_percent, enough)? else {
            let metrics = Err(String::from("no such offset has as little false shadow"));
            return Ok(Seen { settings: to_inline(&vary::tuned()), point: None, metrics });
        };
        let point = search.refined(point, enough)?;
        let table = vary::with_offset(self.written(), point.size, point.factor, point.units);
        let settings = to_inline(&vary::offset_keys(point.size, point.factor, point.units));
        Ok(Seen { settings, point: Some(point), metrics: self.errors(table) })
    }

    /// The scene's own `[light.shadow]`.
    fn written(&self) -> &Settings {
        self.scene.lights[self.options.light].shadow.written()
    }

    fn errors(&mut self, table: Settings) -> Result<Metrics, String> {
        let light = self.options.light;
        let shadow = techniques::read(table, &self.scene.lights[light].kind, &self.scene.objects);
        let shadow = shadow.map_err(|e| e.to_string())?;
        let shade = draw_shade(&with_shadow(self.scene, light, &shadow), light, self.renderer);
        let band = Band { texels: self.options.band_texels, map_size: [self.size; 2] };
        self.ruler.count(&shade.map_err(|e| e.to_string())?, &band).map_err(|e| e.to_string())
    }

    /// Median offset over the lit pixels that face the light, in 2⁻²⁴ of the depth range; `None` without such a pixel, or
    /// without a frustum whose depth it could be measured in.
    fn median_offset(&self, point: &TunedPoint) -> Option<f64> {
        let window_from_world = window_from_world(self.scene, self.options.light, point.size)?;
        let unit = match self.format {
            DepthFormat::Depth16 => 1.0 / 65535.0,
            DepthFormat::Depth24 | DepthFormat::Depth32 | DepthFormat::Depth32F => (-24.0_f64).exp2(),
        };
        let lit =
            self.ruler.truth().pixels.iter().filter(|pixel| pixel.answer == Answer::Lit).filter_map(|pixel| pixel.hit);
        let offset = |hit: Hit| point.factor * slope(&hit, &window_from_world) + point.units * unit;
        let mut offsets: Vec<f64> = lit.filter(Hit::faces_light).map(offset).collect();
        offsets.sort_by(f64::total_cmp);
        Some(offsets.get(offsets.len() / 2)? * 24.0_f64.exp2())
    }
}

/// Matrix to texels and depths in [0, 1].
pub(super) fn window_from_world(scene: &Scene, light: usize, size: u32) -> Option<DMat4> {
    let clip_from_world = scene.lights[light].frustum()?.clip_from_world();
    let half = 0.5 * f64::from(size);
    let scale = DMat4::from_scale(DVec3::new(half, half, 0.5));
    Some(scale * DMat4::from_translation(DVec3::ONE) * clip_from_world)
}

/// GL's maximum depth slope of the plane that a pixel shows [GL 4.6, 14.6.5]: a projection maps planes to planes.
pub(super) fn slope(hit: &Hit, window_from_world: &DMat4) -> f64 {
    let plane: DVec4 = hit.normal.extend(-hit.normal.dot(hit.position));
    let plane = window_from_world.inverse().transpose() * plane;
    (plane.x / plane.z).abs().max((plane.y / plane.z).abs())
}

/// The pixels that a quantity is measured over, or those beside them.
fn compared(metrics: &Metrics, quantity: Quantity) -> usize {
    match quantity {
        Quantity::Leak | Quantity::WrongAway => metrics.all.compared,
        _ => metrics.facing.compared,
    }
}

/// Share of wrong pixels on surfaces turned away; `None` if none was compared.
fn wrong_away(metrics: &Metrics) -> Option<f64> {
    let count = |split: ErrorSplit| split.inside + split.outside;
    let wrong = |errors: &metrics::Errors| count(errors.false_shadow) + count(errors.leak);
    let compared = metrics.all.compared.checked_sub(metrics.facing.compared).filter(|count| *count > 0)?;
    Some(100.0 * wrong(&metrics.all).saturating_sub(wrong(&metrics.facing)) as f64 / compared as f64)
}
