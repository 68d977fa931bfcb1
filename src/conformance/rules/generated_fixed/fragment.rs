//! Pixels of a draw in the model: triangles of its corners, environments, colour sum, fog and alpha test, as ranges
//! [GL 4.6 compatibility, 14.6, 16, 17.3].

use glam::{DVec2, DVec4};

use super::environment::{Color, Texel, exact, hull};
use super::state::{FixedState, PLANES};
use super::vertex::FixedCorner;
use crate::conformance::bench::fixed_commands::{FIXED_UNITS, FixedTexture};
use crate::context::compatibility::raw;

/// Share of a triangle within which a pixel may be another's.
const EDGE: f64 = 0.02;

/// Offsets in pixels by which an edge of a clip plane may be off.
const CLIPPED: f64 = 1.0 / 32.0;

/// Slack of a colour behind lighting: half a code of 8 bits, for powers and square roots of few bits. Without: of f32.
const LIT: [f64; 2] = [1e-5, 0.5 / 255.0];

/// Colours that a pixel may hold.
#[derive(Clone, Copy, Debug)]
pub enum FixedPixel {
    Unsure,
    Background,
    Color(Color),
}

/// A triangle: three corners, and that whose flat colours it has.
pub struct FixedTriangle {
    pub corners: [FixedCorner; 3],
    pub provoking: FixedCorner,
}

/// Linear weights of a triangle's corners at a place.
fn linear_weights(corners: &[FixedCorner; 3], at: DVec2) -> [f64; 3] {
    let [a, b, c] = corners.map(|corner| corner.window);
    let area = (b - a).perp_dot(c - a);
    [(b - at).perp_dot(c - at), (c - at).perp_dot(a - at), (a - at).perp_dot(b - at)].map(|part| part / area)
}

/// With perspective.
fn weights(corners: &[FixedCorner; 3], at: DVec2) -> [f64; 3] {
    let linear = linear_weights(corners, at);
    let over: [f64; 3] = std::array::from_fn(|index| linear[index] / corners[index].clip.w);
    let sum: f64 = over.iter().sum();
    over.map(|weight| weight / sum)
}

impl FixedTriangle {
    /// How surely it covers a pixel.
    pub fn covers(&self, at: DVec2) -> Option<bool> {
        let weights = linear_weights(&self.corners, at);
        match () {
            () if weights.iter().any(|weight| !weight.is_finite() || *weight < -EDGE) => Some(false),
            () if weights.iter().all(|weight| *weight > EDGE) => Some(true),
            () => None,
        }
    }

    fn is_front(&self, front: u32) -> bool {
        let [a, b, c] = self.corners.map(|corner| corner.window);
        ((b - a).perp_dot(c - a) > 0.0) == (front == glow::CCW)
    }
}

impl FixedState {
    /// A pixel that a triangle covers.
    pub fn shade(&self, triangle: &FixedTriangle, at: DVec2, textures: &[FixedTexture]) -> FixedPixel {
        let corners = &triangle.corners;
        if corners.iter().any(|corner| !corner.sure) || !triangle.provoking.sure {
            return FixedPixel::Unsure;
        }
        match self.is_clipped(corners, at) {
            Some(true) => return FixedPixel::Background,
            None => return FixedPixel::Unsure,
            Some(false) => {}
        }
        let weights = weights(corners, at);
        let mean = |of: &dyn Fn(&FixedCorner) -> DVec4| {
            weights.iter().zip(corners).map(|(weight, corner)| *weight * of(corner)).sum::<DVec4>()
        };
        let side = usize::from(self.two_side && self.on.has(raw::LIGHTING) && !triangle.is_front(self.front));
        let flat = self.shade == raw::FLAT;
        let primary = |corner: &FixedCorner| corner.shaded[side].primary;
        let secondary = |corner: &FixedCorner| corner.shaded[side].secondary.extend(0.0);
        let of = |get: &dyn Fn(&FixedCorner) -> DVec4| if flat { get(&triangle.provoking) } else { mean(get) };
        let slack = LIT[usize::from(self.on.has(raw::LIGHTING))];
        let wide = |color: DVec4| color.to_array().map(|value| [value - slack, value + slack]);
        let (primary, secondary) = (wide(of(&primary)), wide(of(&secondary)));
        let mut texels = [None::<Texel>; FIXED_UNITS];
        for (unit, texel) in texels.iter_mut().enumerate() {
            let Some(slot) = self.texture_of(unit) else { continue };
            let at = mean(&|corner: &FixedCorner| corner.coordinates[unit]);
            let Some(found) = self.texel(slot, &textures[slot], at) else { return FixedPixel::Unsure };
            *texel = Some(found);
        }
        let clamped = |color: Color| color.map(|range| range.map(|value| value.clamp(0.0, 1.0)));
        let mut color = self.combined(clamped(primary), &texels);
        // Always where there is lighting [GL 4.6 compatibility, 16.2].
        if self.on.has(raw::COLOR_SUM) || self.on.has(raw::LIGHTING) {
            for (channel, more) in color.iter_mut().zip(secondary).take(3) {
                // Clamped by 16.2; Mesa 22.3.6 takes the sum to the fog as it is.
                let most = if self.on.has(raw::FOG) { 2.0 } else { 1.0 };
                *channel = [(channel[0] + more[0]).clamp(0.0, 1.0), (channel[1] + more[1]).clamp(0.0, most)];
            }
        }
        if self.on.has(raw::FOG) {
            color = self.fogged(color, corners, [weights, linear_weights(corners, at)]);
        }
        match self.alpha_passes(color[3]) {
            Some(true) => FixedPixel::Color(color),
            Some(false) => FixedPixel::Background,
            None => FixedPixel::Unsure,
        }
    }

    fn is_clipped(&self, corners: &[FixedCorner; 3], at: DVec2) -> Option<bool> {
        let mut clipped = Some(false);
        for plane in (0..PLANES).filter(|plane| self.on.has(raw::CLIP_PLANE0 + *plane as u32)) {
            let around = [[0.0, 0.0], [1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|by| {
                let weights = weights(corners, at + CLIPPED * DVec2::from_array(by));
                weights.iter().zip(corners).map(|(weight, corner)| weight * corner.planes[plane]).sum::<f64>()
            });
            // A plane through all of the triangle is no edge.
            let near = 1e-4 * corners.iter().map(|corner| corner.planes[plane].abs()).fold(1.0, f64::max);
            match () {
                () if around.iter().all(|side| *side < -near) => return Some(true),
                () if around.iter().all(|side| *side > near) => {}
                () => clipped = None,
            }
        }
        clipped
    }

    fn factor(&self, coordinate: f64) -> f64 {
        let fog = &self.fog;
        match fog.mode {
            glow::LINEAR => (fog.end - coordinate) / (fog.end - fog.start),
            raw::EXP => (-fog.density * coordinate).exp(),
            _ => (-(fog.density * coordinate).powi(2)).exp(),
        }
        .clamp(0.0, 1.0)
    }

    /// Fog by depth or by distance, found for each vertex or for each fragment [GL 4.6 compatibility, 16.4], between corners
    /// with perspective or without.
    fn fogged(&self, color: Color, corners: &[FixedCorner; 3], weights: [[f64; 3]; 2]) -> Color {
        let ways = weights.into_iter().flat_map(|weights| {
            let mean = move |of: &dyn Fn(&FixedCorner) -> f64| -> f64 {
                weights.iter().zip(corners).map(|(weight, corner)| weight * of(corner)).sum()
            };
            [0, 1].map(|way| {
                let fragment = self.factor(mean(&|corner: &FixedCorner| corner.fog[way]));
                hull(exact(fragment), exact(mean(&|corner: &FixedCorner| self.factor(corner.fog[way]))))
            })
        });
        let [low, high] = ways.reduce(hull).unwrap_or([0.0, 1.0]);
        let factor = [low - 0.5 / 255.0, high + 0.5 / 255.0].map(|value| value.clamp(0.0, 1.0));
        let [red, green, blue, alpha] = color;
        let fog = self.fog.color.to_array();
        let mixed = |channel: [f64; 2], fog: f64| {
            let all = channel.map(|value| factor.map(|factor| factor * value + (1.0 - factor) * fog));
            hull(
                [all[0][0].min(all[0][1]), all[0][0].max(all[0][1])],
                [all[1][0].min(all[1][1]), all[1][0].max(all[1][1])],
            )
        };
        [mixed(red, fog[0]), mixed(green, fog[1]), mixed(blue, fog[2]), alpha]
    }

    fn alpha_passes(&self, [low, high]: [f64; 2]) -> Option<bool> {
        let (function, reference) = self.alpha_test;
        if !self.on.has(raw::ALPHA_TEST) {
            return Some(true);
        }
        let (below, above) = (high < reference - 1.0 / 255.0, low > reference + 1.0 / 255.0);
        match function {
            glow::NEVER => Some(false),
            glow::ALWAYS => Some(true),
            _ if !below && !above => None,
            glow::EQUAL => Some(false),
            glow::NOTEQUAL => Some(true),
            glow::LESS | glow::LEQUAL => Some(below),
            _ => Some(above),
        }
    }
}
