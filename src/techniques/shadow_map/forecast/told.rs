//! Warnings of a forecast.

use std::collections::BTreeMap;

use super::{FEWEST_PIXELS, Forecast, Wrong};
use crate::lights::Notes;
use crate::lights::projector::Rays;
use crate::pass::DepthFormat;

/// The greatest share of the points in the light's reach that may be wrong without a warning. A picture with more than 1.5 %
/// is too coarse; a forecast is off by up to 10 %.
const MOST_WRONG: f64 = 0.9 * 0.015;

/// Standard deviations by which a count may fall short: `n` points found by chance are off by √n.
const DEVIATIONS: f64 = 2.0;

/// Adds every warning.
pub fn all(forecast: &Forecast<'_>, notes: &mut Notes) {
    forecast.warn_of_share(notes);
    forecast.warn_of_even(notes);
    forecast.warn_of_near(notes);
}

impl Forecast<'_> {
    /// Share in percent of the points that the light reaches.
    fn percent(&self, count: usize) -> f64 {
        100.0 * count as f64 / f64::from(self.reached.max(1))
    }

    /// Warns of too many wrong points.
    fn warn_of_share(&self, notes: &mut Notes) {
        let pixels = self.reached.saturating_mul(self.step.pow(2));
        let wrong: Vec<&Wrong> = self.wrong.iter().filter(|wrong| !wrong.is_close).collect();
        let count = wrong.len() as f64;
        if pixels < FEWEST_PIXELS || count + DEVIATIONS * count.sqrt() <= MOST_WRONG * f64::from(self.reached) {
            return;
        }
        let (of, percent) = (self.view.name(), self.percent(wrong.len()));
        let rounded: Vec<&Wrong> = wrong.iter().copied().filter(|wrong| wrong.is_rounded).collect();
        let widest = rounded.iter().max_by(|a, b| a.code.total_cmp(&b.code));
        if let Some(widest) = widest.filter(|_| 2 * rounded.len() > wrong.len()) {
            notes.warnings.push(format!(
                "{of}: one code of {} is up to {:.2} units wide at {:.2} units from the light, so that about \
                 {percent:.1} % of what it reaches is wrong, as near behind its caster as that: move `near` away, or take a \
                 format of more bits",
                name(self.map.settings.format),
                widest.code,
                widest.distance
            ));
            return;
        }
        let coarsest = wrong.iter().map(|wrong| wrong.texel_pixels).fold(0.0, f64::max);
        let why = if coarsest > 1.0 {
            format!(
                "a texel of its map covers up to {coarsest:.0} pixels of the picture, and its shadows are that coarse: raise \
                 `size`, narrow the cone, or move the light nearer"
            )
        } else {
            String::from(
                "it grazes much of that, whose depth changes within a texel of its map: raise `size`, or move the light",
            )
        };
        notes.warnings.push(format!("{of}: about {percent:.1} % of what it reaches gets the wrong shade: {why}"));
    }

    /// Warns of points before the near plane.
    fn warn_of_near(&self, notes: &mut Notes) {
        let before = || self.wrong.iter().filter(|wrong| wrong.is_before_near && !wrong.is_close);
        let (Rays::From { near, .. }, Some(first)) = (self.rays(), before().next()) else { return };
        notes.warnings.push(format!(
            "{}'s near plane at {near}: {:.2} % of what it reaches lies before it in a shadow, such as that of {}, and is \
             lit there: a map has no depths before its near plane",
            self.view.name(),
            self.percent(before().count()),
            self.items.placed[first.item].item.label
        ));
    }

    /// Warns of points that are wrong away from any shadow edge, item by item.
    fn warn_of_even(&self, notes: &mut Notes) {
        let mut counts: BTreeMap<(usize, bool), usize> = BTreeMap::new();
        for wrong in self.wrong.iter().filter(|wrong| wrong.is_even) {
            *counts.entry((wrong.item, !wrong.is_lit)).or_default() += 1;
        }
        for ((item, is_dark), count) in counts {
            let (what, why) = match (is_dark, self.has_far_sides()) {
                (false, _) => ("lit by mistake", "that it shadows: it has no far side there"),
                (true, true) => ("dark by mistake", "on it: a far side lies at the very depth of what is lit"),
                (true, false) => ("dark by mistake", "on it: it shades itself"),
            };
            notes.warnings.push(format!(
                "{} in the map of {}: {what} are {:.2} % of what the light reaches, {why}",
                self.items.placed[item].item.label,
                self.view.name(),
                self.percent(count)
            ));
        }
    }
}

fn name(format: DepthFormat) -> &'static str {
    match format {
        DepthFormat::Depth16 => "depth16",
        DepthFormat::Depth24 => "depth24",
        DepthFormat::Depth32 => "depth32",
        DepthFormat::Depth32F => "depth32f",
    }
}
