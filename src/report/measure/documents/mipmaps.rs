//! Smaller levels of a shadow map [LEC, "Mipmapping for Depth Textures"]: how much more offset they need, and how much more
//! is wrong if their depths are averaged from the level before instead of being drawn.
//!
//! Levels are maps that the renderer draws without an offset; lookups are made here, in f64, at the ray tracer's points.

use glam::DMat4;

use super::{ClaimRequest, Number, Said, depths, with_keys};
use crate::frame::Renderer;
use crate::report::measure::claims::{slope, window_from_world};
use crate::report::measure::fit::power_law;
use crate::report::numbers::plain;
use crate::report::store::claim_sweep::{ClaimPoint, ClaimSeries, ClaimSweep};
use crate::report::store::claimed::Claimed;
use crate::techniques::claims::Relation;
use crate::techniques::{self, LightShadow};
use crate::truth::{Answer, Hit};
use crate::views::View;

const SOURCE: &str = "LEC, \"Mipmapping for Depth Textures\"";

/// The level that the claims compare with the first: a texel of it is four times as wide.
const COMPARED: usize = 2;

/// Share of the lit points, away from shadows, that an offset leaves dark.
const DARK: f64 = 0.002;

/// A point that faces the light.
struct Receiver {
    /// Place in the map, right and down from its upper left corner, in [0, 1].
    place: [f64; 2],
    /// Window depth from the light.
    depth: f64,
    /// GL's depth slope, for texels of the first level.
    slope: f64,
    is_lit: bool,
}

/// One level, rows from the top.
#[derive(Clone)]
struct Level {
    side: usize,
    depths: Vec<f64>,
}

/// Levels that were drawn, and the same with depths averaged.
struct Levels {
    drawn: Vec<Level>,
    averaged: Vec<Level>,
    receivers: Vec<Receiver>,
}

pub(super) fn measure(request: &ClaimRequest<'_>, renderer: &mut Renderer) -> (Vec<Claimed>, Vec<ClaimSweep>) {
    let levels = levels(request, renderer);
    let of = |pick: &dyn Fn(&Levels) -> Number| levels.as_ref().map_err(Clone::clone).and_then(pick);
    let offset = |level: usize| of(&|levels| levels.offset(&levels.drawn[level]));
    let wrong = |averaged: bool| {
        of(&|levels| {
            let factor = levels.offset(&levels.drawn[COMPARED])?;
            let level = if averaged { &levels.averaged[COMPARED] } else { &levels.drawn[COMPARED] };
            Ok(levels.wrong_percent(level, factor))
        })
    };
    let said = |says, quantity| Said { technique: "shadow-map", source: SOURCE, says, quantity };
    let claims = vec![
        said(
            "a smaller level needs more polygon offset against self-shadowing",
            "offset factor, in depth slopes over a texel of the first level, that leaves 0.2 % of the lit points dark",
        )
        .compare(
            Relation::Greater,
            (format!("level {COMPARED}, drawn"), offset(COMPARED)),
            (String::from("level 0"), offset(0)),
        ),
        said(
            "depths cannot be averaged into smaller levels: more is wrong than in a level that is drawn",
            "wrong facing the light, %, both under the drawn level's offset",
        )
        .compare(
            Relation::Greater,
            (format!("level {COMPARED}, depths averaged"), wrong(true)),
            (format!("level {COMPARED}, drawn"), wrong(false)),
        ),
    ];
    (claims, levels.map_or_else(|_| Vec::new(), |levels| levels.sweeps()))
}

/// Draws the levels and averages them.
fn levels(request: &ClaimRequest<'_>, renderer: &mut Renderer) -> Result<Levels, String> {
    let light = request.scene.lights.get(request.light).ok_or("there is no such light")?;
    let size = LightShadow::of(&light.shadow).map(|_| techniques::map_size(&light.shadow));
    let size = size.filter(|size| *size > 1).unwrap_or(1024).next_power_of_two();
    let window_from_world = window_from_world(request.scene, request.light, size)
        .ok_or("only a spotlight's map is one perspective picture")?;
    let count = if request.quick { COMPARED + 1 } else { 6 };
    let count = count.min(size.ilog2() as usize);
    if count <= COMPARED {
        return Err(format!("a map of {size} texels a side has no level that is four times as coarse"));
    }
    let mut drawn = Vec::new();
    for level in 0..count {
        let side = size >> level;
        let keys = format!(
            "technique = \"shadow-map\", size = {side}, fit = \"none\", mipmaps = false, bias = \"offset\", \
             addressing = \"opengl\", offset = {{ factor = 0.0, units = 0.0 }}"
        );
        let scene = with_keys(request.scene, request.light, &keys)?;
        let ([side, _], depths) = depths(&scene, request.light, View::LightDepth, renderer)?;
        drawn.push(Level { side, depths });
    }
    let mut averaged: Vec<Level> = drawn.first().cloned().into_iter().collect();
    while averaged.len() < count {
        let next = averaged.last().and_then(half).ok_or("a level has no texels")?;
        averaged.push(next);
    }
    let receivers = receivers(request, &window_from_world, size);
    if receivers.len() < crate::judge::metrics::FEWEST_COMPARED {
        return Err(format!("{} points face the light: too few", receivers.len()));
    }
    Ok(Levels { drawn, averaged, receivers })
}

/// The next level by the mean of four texels.
fn half(level: &Level) -> Option<Level> {
    let side = level.side / 2;
    let at = |x: usize, y: usize| level.depths.get(y * level.side + x).copied();
    let mean = |index: usize| {
        let (x, y) = (2 * (index % side), 2 * (index / side));
        Some(0.25 * (at(x, y)? + at(x + 1, y)? + at(x, y + 1)? + at(x + 1, y + 1)?))
    };
    let depths = (0..side * side).map(mean).collect::<Option<Vec<f64>>>()?;
    (side > 0).then_some(Level { side, depths })
}

/// Points of which the ray tracer is certain, inside the map.
fn receivers(request: &ClaimRequest<'_>, window_from_world: &DMat4, size: u32) -> Vec<Receiver> {
    let size = f64::from(size);
    let of = |(hit, is_lit): (Hit, bool)| {
        let window = window_from_world.project_point3(hit.position);
        let place = [window.x / size, 1.0 - window.y / size];
        let is_inside = place.iter().all(|value| (0.0..1.0).contains(value)) && (0.0..1.0).contains(&window.z);
        let slope = slope(&hit, window_from_world);
        is_inside.then_some(Receiver { place, depth: window.z, slope, is_lit })
    };
    let certain = request.truth.pixels.iter().filter_map(|pixel| match pixel.answer {
        Answer::Lit => Some((pixel.hit?, true)),
        Answer::Shadowed => Some((pixel.hit?, false)),
        _ => None,
    });
    certain.filter(|(hit, _)| hit.faces_light()).filter_map(of).collect()
}

impl Level {
    fn texel(&self, receiver: &Receiver) -> [usize; 2] {
        receiver.place.map(|value| ((value * self.side as f64) as usize).min(self.side.saturating_sub(1)))
    }

    /// Stored depth where the receiver looks it up.
    fn depth(&self, receiver: &Receiver) -> f64 {
        let [x, y] = self.texel(receiver);
        self.depths.get(y * self.side + x).copied().unwrap_or(1.0)
    }
}

impl Levels {
    /// The least factor that leaves at most [`DARK`] of the lit points dark, of those with no shadow within two texels:
    /// there a texel holds what shadows its neighbour.
    fn offset(&self, level: &Level) -> Number {
        let side = level.side;
        let mut is_shadowed = vec![false; side * side];
        for receiver in self.receivers.iter().filter(|receiver| !receiver.is_lit) {
            let [x, y] = level.texel(receiver);
            is_shadowed[y * side + x] = true;
        }
        let is_clear = |receiver: &&Receiver| {
            let [x, y] = level.texel(receiver);
            let around = |at: usize| at.saturating_sub(2)..(at + 3).min(side);
            receiver.is_lit && !around(y).any(|y| around(x).any(|x| is_shadowed[y * side + x]))
        };
        let needed = |receiver: &Receiver| (receiver.depth - level.depth(receiver)) / receiver.slope.max(1e-12);
        let mut factors: Vec<f64> = self.receivers.iter().filter(is_clear).map(needed).collect();
        factors.sort_by(f64::total_cmp);
        let place = ((1.0 - DARK) * factors.len() as f64) as usize;
        let factor = factors.get(place).or(factors.last()).copied();
        factor.map(|factor| factor.max(0.0)).ok_or_else(|| String::from("no lit point is away from shadows"))
    }

    /// Wrong points in percent under an offset of this factor.
    fn wrong_percent(&self, level: &Level, factor: f64) -> f64 {
        let is_wrong = |receiver: &&Receiver| {
            let is_lit = receiver.depth <= level.depth(receiver) + factor * receiver.slope;
            is_lit != receiver.is_lit
        };
        100.0 * self.receivers.iter().filter(is_wrong).count() as f64 / self.receivers.len() as f64
    }

    fn sweeps(&self) -> Vec<ClaimSweep> {
        let width = |index: usize| (index as f64).exp2();
        let series = |name: &str, levels: &[Level], value: &dyn Fn(&Level, usize) -> Number| {
            let point = |(index, level): (usize, &Level)| ClaimPoint {
                x: width(index),
                measured: super::number((format!("level {index}, {} texels a side", level.side), value(level, index))),
            };
            let points: Vec<ClaimPoint> = levels.iter().enumerate().map(point).collect();
            ClaimSeries { name: name.to_owned(), points, fit: String::new() }
        };
        let mut offset = series("each level drawn", &self.drawn, &|level, _| self.offset(level));
        if let Some(fit) = power_law(&offset.pairs()) {
            let [least, greatest] = fit.range.map(|value| format!("{:.2}", -value));
            offset.fit = format!(
                "the offset grows as the width of a texel to the power {:.2}, 95 % range {greatest} to {least}; 1 is expected, as \
                 a plane falls away by its slope",
                -fit.exponent
            );
        }
        let wrong = |level: &Level, index: usize| {
            let factor = self.offset(self.drawn.get(index).unwrap_or(level))?;
            Ok(self.wrong_percent(level, factor))
        };
        let x = String::from("width of a texel, in texels of the first level");
        let of = |name: &str, says: String, y: &str, series: Vec<ClaimSeries>| ClaimSweep {
            name: name.to_owned(),
            source: SOURCE.to_owned(),
            says,
            x: x.clone(),
            is_even: false,
            y: y.to_owned(),
            series,
        };
        let dark = plain(100.0 * DARK);
        vec![
            of(
                "offset of smaller levels",
                format!(
                    "The least factor of the polygon offset that leaves {dark} % of the lit points dark, of those with no \
                     shadow within two texels, by the nearest texel"
                ),
                "factor, in slopes over a texel of the first level",
                vec![offset],
            ),
            of(
                "wrong points of smaller levels",
                String::from("Each level under the offset that it needs when it is drawn, by the nearest texel"),
                "wrong facing the light, in %",
                vec![
                    series("each level drawn", &self.drawn, &wrong),
                    series("depths averaged", &self.averaged, &wrong),
                ],
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane that rises by one depth step a texel: its texel's centre lies up to half a texel away, so that a factor of
    /// one half in level 0, and of two in level 2, leaves no point dark.
    #[test]
    fn a_plane_needs_half_a_texel_of_its_slope() {
        let side = 64;
        let step = 1e-3;
        let plane = |side: usize, width: f64| Level {
            side,
            depths: (0..side * side).map(|index| 0.1 + step * width * ((index % side) as f64 + 0.5)).collect(),
        };
        let drawn: Vec<Level> = (0..3).map(|level| plane(side >> level, f64::from(1 << level))).collect();
        let averaged = vec![drawn[0].clone(), half(&drawn[0]).unwrap(), half(&half(&drawn[0]).unwrap()).unwrap()];
        let receiver = |index: usize| {
            let u = (index as f64 + 0.5) / 4000.0;
            Receiver { place: [u, 0.3], depth: 0.1 + step * 64.0 * u, slope: step, is_lit: true }
        };
        let levels = Levels { drawn, averaged, receivers: (0..4000).map(receiver).collect() };
        for (level, expected) in levels.drawn.iter().zip([0.5, 1.0, 2.0]) {
            let factor = levels.offset(level).unwrap();
            assert!(factor > 0.97 * expected && factor <= expected, "{factor}, not {expected}");
            assert!(levels.wrong_percent(level, factor) <= 0.21);
            assert!(levels.wrong_percent(level, 0.0) > 40.0);
        }
        // On a plane the mean of four centres is the depth at the middle of the coarse texel.
        let [drawn, averaged] = [&levels.drawn[2], &levels.averaged[2]];
        assert!(drawn.depths.iter().zip(&averaged.depths).all(|(a, b)| (a - b).abs() < 1e-12));
        let sweeps = levels.sweeps();
        assert!(sweeps[0].series[0].fit.contains("to the power 1.0"), "{}", sweeps[0].series[0].fit);
    }
}
