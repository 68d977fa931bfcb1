//! `beam = { … }` of a spotlight: profile, shield and lens, and the intensity map that is made of them [Segal 1992, 3.2].

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::geometry::Texture;
use crate::scene::assets::Assets;
use crate::scene::settings::{Reader, Settings, SettingsError, Value};
use crate::scene::{BeamProfile, Error, Frustum, LightBeam, LightShape, Origin, Spot};

/// Longest side of a map, in texels.
const LONGEST: u32 = 2048;
/// Sides of a map without a picture, the first that is fine enough.
const SIDES: [u32; 6] = [64, 128, 256, 512, 1024, LONGEST];
/// Texels of a map for one of its picture's. Odd: centres of the picture's texels are centres of the map's, so that
/// what is linear between the former is linear between the latter.
const MULTIPLES: [u32; 8] = [1, 3, 5, 7, 15, 63, 255, 1023];
/// Error between texels that is small enough, in codes.
const FINE: f64 = 0.5;
/// Most entries of a profile.
const LONGEST_PROFILE: usize = 4096;

/// `beam` as written.
pub(super) struct BeamKeys<'a> {
    profile: BeamProfile,
    shield: Option<(&'a str, &'a Origin)>,
    lens: f64,
}

/// Reads the keys; the files are not loaded yet.
pub(super) fn read(table: &Settings) -> Result<BeamKeys<'_>, SettingsError> {
    let mut reader = table.read();
    let profile = match (profile(&mut reader)?, reader.number("exponent", 0.0..=1000.0)?) {
        (Some(_), Some(_)) => return Err(reader.error("exponent", "cannot stand beside `profile`: write one of them")),
        (Some(profile), None) => BeamProfile::Table(profile),
        (None, Some(exponent)) => BeamProfile::Exponent(exponent),
        (None, None) => BeamProfile::Even,
    };
    let shield = reader.file("shield")?;
    let lens = reader.number("lens", -1.0..=1.0)?.unwrap_or(0.0);
    reader.finish()?;
    Ok(BeamKeys { profile, shield, lens })
}

fn profile(reader: &mut Reader<'_>) -> Result<Option<Vec<f64>>, SettingsError> {
    let Some(entry) = reader.entry("profile") else { return Ok(None) };
    let wrong = || {
        let message = format!("must be 2 to {LONGEST_PROFILE} numbers in [0, 1], from the axis to the border");
        reader.error("profile", message)
    };
    let Value::Array(items) = &entry.value else { return Err(wrong()) };
    let values = items.iter().map(|item| match &item.value {
        Value::Integer(value) => Some(*value as f64),
        Value::Float(value) => Some(*value),
        _ => None,
    });
    let values: Vec<f64> = values.collect::<Option<_>>().ok_or_else(wrong)?;
    let is_fit =
        (2..=LONGEST_PROFILE).contains(&values.len()) && values.iter().all(|value| (0.0..=1.0).contains(value));
    if is_fit { Ok(Some(values)) } else { Err(wrong()) }
}

/// Loads what the keys name and makes the map.
pub(super) fn bake(keys: BeamKeys<'_>, spot: &Spot, name: &str, assets: &mut Assets) -> Result<LightBeam, Error> {
    let BeamKeys { profile, shield, lens } = keys;
    let shield = shield.map(|(file, origin)| assets.texture(file, origin)).transpose()?;
    let image = spot.image.as_deref().filter(|_| lens != 0.0);
    let light = Source { profile: &profile, shield: shield.as_deref(), image, lens, frustum: &spot.frustum };
    let (map, map_error_codes) = light.finest_map(name, spot.shape);
    Ok(LightBeam { map: Arc::new(map), map_error_codes, profile, shield, lens })
}

/// Parts that a map is made of.
struct Source<'a> {
    profile: &'a BeamProfile,
    shield: Option<&'a Texture>,
    /// The light's image, where the lens moves it.
    image: Option<&'a Texture>,
    lens: f64,
    frustum: &'a Frustum,
}

impl Source<'_> {
    /// The smallest map that is fine enough, or the largest; with its error in codes.
    fn finest_map(&self, name: &str, shape: LightShape) -> (Texture, f64) {
        let mut best: Option<(Texture, f64)> = None;
        for [width, height] in self.sizes() {
            let map = self.map(name, width, height);
            let error = self.error_codes(&map, shape);
            if best.as_ref().is_none_or(|(_, least)| error < *least) {
                best = Some((map, error));
            }
            if error < FINE {
                break;
            }
        }
        best.unwrap_or_else(|| (self.map(name, 1, 1), f64::INFINITY))
    }

    /// Sizes of maps to try, the smallest first.
    fn sizes(&self) -> Vec<[u32; 2]> {
        let pictures = || self.shield.into_iter().chain(self.image);
        let Some(width) = pictures().map(|picture| picture.width).max() else {
            return SIDES.map(|side| [side; 2]).to_vec();
        };
        let height = pictures().map(|picture| picture.height).max().unwrap_or(width);
        if width.max(height) >= LONGEST {
            return vec![[width, height]];
        }
        // Each side by itself: a picture one texel wide may need many.
        let multiples = |side: u32| MULTIPLES.map(|multiple| side * multiple);
        let capped = |sides: [u32; 8]| {
            let mut last = sides[0];
            sides.map(|side| {
                last = if side <= LONGEST { side } else { last };
                last
            })
        };
        let (widths, heights) = (capped(multiples(width)), capped(multiples(height)));
        let mut sizes: Vec<[u32; 2]> = widths.into_iter().zip(heights).map(|(width, height)| [width, height]).collect();
        sizes.dedup();
        sizes
    }

    fn map(&self, name: &str, width: u32, height: u32) -> Texture {
        let size = DVec2::new(f64::from(width), f64::from(height));
        let mut rgba = Vec::with_capacity(4 * width as usize * height as usize);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let color = self.light((DVec2::new(f64::from(x), f64::from(y)) + 0.5) / size);
            rgba.extend(color.to_array().map(|value| (255.0 * value).round() as u8));
            rgba.push(255);
        }
        Texture { name: format!("beam of {name}"), width, height, rgba, has_alpha: false }
    }

    /// The greatest difference of the map from what it is made of, less the rounding of a texel: at the places of a grid
    /// that is finer than the map in both directions where the map is small, and else at as many that meet no pattern.
    fn error_codes(&self, map: &Texture, shape: LightShape) -> f64 {
        const PLACES: u32 = 1 << 16;
        let mut most: f64 = 0.0;
        for k in 0..PLACES {
            // The R2 sequence, which spreads evenly; every fourth place lies near the middle, where narrow beams are.
            let turn = DVec2::new(0.754_877_666_246_693, 0.569_840_290_998_053) * f64::from(k);
            let even = turn - turn.floor();
            let st = if k % 4 == 0 { 0.5 + (even - 0.5) / 16.0 } else { even };
            if shape == LightShape::Cone && (2.0 * st - 1.0).length() > 1.0 {
                continue;
            }
            let difference = (map.bilinear(st) - self.light(st)).abs().max_element();
            most = most.max(255.0 * difference);
        }
        (most - 0.5).max(0.0)
    }

    /// The light at (s, t).
    fn light(&self, st: DVec2) -> DVec3 {
        let tangents = self.frustum.tangents();
        // From the axis, in half heights.
        let place = (2.0 * st - 1.0) * DVec2::new(self.frustum.aspect, 1.0);
        let place = place * (1.0 + self.lens * place.length_squared());
        let source = 0.5 + 0.5 * place / DVec2::new(self.frustum.aspect, 1.0);
        let is_inside = source.min_element() >= 0.0 && source.max_element() <= 1.0;
        if self.lens != 0.0 && !is_inside {
            return DVec3::ZERO;
        }
        let picture = |picture: Option<&Texture>| picture.map_or(DVec3::ONE, |picture| picture.bilinear(source));
        let radius = place.length();
        let intensity = match self.profile {
            BeamProfile::Even => 1.0,
            BeamProfile::Table(values) => at_step(values, radius),
            BeamProfile::Exponent(exponent) => (1.0 + (tangents.y * radius).powi(2)).powf(-0.5 * exponent),
        };
        intensity * picture(self.shield) * picture(self.image)
    }
}

/// The value at a share of the way from the first to the last, linear between; the last beyond.
fn at_step(values: &[f64], share: f64) -> f64 {
    let last = values.len() - 1;
    let at = (share * last as f64).min(last as f64);
    let below = (at.floor() as usize).min(last);
    let above = (below + 1).min(last);
    values[below] + (at - below as f64) * (values[above] - values[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_are_linear_between_their_steps_and_go_on_after_the_last() {
        for (share, expected) in [(0.0, 1.0), (0.25, 0.75), (0.5, 0.5), (0.75, 0.25), (1.0, 0.0), (1.4, 0.0)] {
            assert_eq!(at_step(&[1.0, 0.5, 0.0], share), expected);
        }
    }
}
