//! A triangle as the model draws it, by functions that are linear in the [window](crate::conformance::model::window)
//! [GL 4.6, 13.7, 13.8.1, 14.6.1, 14.6.5]. Its corners are known to a bound, as a vertex shader leaves them.

use super::glsl::Varies;
use crate::conformance::model::number::{Num, SLACK};
use crate::conformance::model::window::{
    BAND, Covered, EPSILON, Linear, Weights, covers, covers_unknown, is_inside, rounding_factor,
};

/// A vertex as the vertex shader puts it out.
#[derive(Clone, Debug)]
pub struct Corner {
    pub clip: [Num; 4],
    pub distances: Vec<Num>,
    pub values: Vec<Num>,
}

/// State that a triangle is set up with.
#[derive(Clone, Copy, Debug)]
pub struct SetUp {
    pub viewport: [f64; 2],
    pub depth_clamp: bool,
    pub depth_range: [f64; 2],
    pub clip_distances: usize,
    pub clockwise: bool,
}

pub struct Triangle<'a> {
    corners: [&'a Corner; 3],
    /// `None`: it may face either way.
    pub front: Option<bool>,
    weights: [Linear; 3],
    over_w: Linear,
    planes: Vec<Linear>,
    depth: Linear,
    /// Factor of the roundings: corners that are clipped have been interpolated.
    rounding: f64,
    /// Width of the strip along edges, in pixels.
    band: f64,
    /// Least and most of the window, in pixels, where there may be fragments that the model does not know.
    unknown: Option<[[f64; 2]; 2]>,
    /// It has no area, or lies outside of the view.
    pub empty: bool,
    /// Nothing is clipped.
    is_whole: bool,
    /// Least and most of the window where fragments may be.
    pub bounds: [[f64; 2]; 2],
}

impl<'a> Triangle<'a> {
    pub fn new(corners: [&'a Corner; 3], state: &SetUp) -> Self {
        let [width, height] = state.viewport;
        let clip = corners.map(|corner| corner.clip.map(|number| number.value));
        let is_known = corners.iter().all(|corner| corner.clip.iter().all(|number| number.is_known()));
        let window = clip.map(|[x, y, _, w]| [(x + w) * width / 2.0, (y + w) * height / 2.0, w]);
        let edges = Weights::new(window);
        let Weights { of: weights, area, area_size } = edges;
        let part = |index: usize| clip.map(|corner| corner[index]);
        let (z, w) = (part(2), part(3));
        let mut planes = edges.planes(&clip, state.depth_clamp);
        for index in 0..state.clip_distances {
            planes.push(Linear::sum(&weights, corners.map(|corner| corner.distances[index].value)));
        }
        let sizes = clip.map(|corner| corner.map(f64::abs).into_iter().fold(0.0, f64::max));
        let is_out = |side: &dyn Fn([f64; 4], f64) -> f64| {
            clip.iter().zip(sizes).all(|(corner, size)| side(*corner, size) < 0.0)
        };
        let margin = 1e-4;
        let mut is_outside = false;
        for axis in 0..if state.depth_clamp { 2 } else { 3 } {
            is_outside |= is_out(&|corner, size| corner[3] - corner[axis] + margin * size);
            is_outside |= is_out(&|corner, size| corner[3] + corner[axis] + margin * size);
        }
        let before_eye = w.iter().all(|w| *w > 0.0);
        let same = (0..3).any(|index| clip[index] == clip[(index + 1) % 3]);
        // Errors of the vertex shader: as a share of the corner, and in pixels.
        let (mut share, mut band) = (0.0_f64, BAND);
        for (corner, size) in corners.iter().zip(sizes) {
            let error = corner.clip.iter().map(|number| number.error).fold(0.0, f64::max);
            share = share.max(SLACK * error / size.max(f64::MIN_POSITIVE));
            if before_eye {
                let doubt = |part: usize| {
                    SLACK * (corner.clip[part].error + error) * state.viewport[part] / corner.clip[3].value
                };
                band += doubt(0).max(doubt(1));
            }
        }
        let distance_doubt = corners
            .iter()
            .flat_map(|corner| &corner.distances[..state.clip_distances])
            .any(|distance| !distance.is_known());
        let rounding = (EPSILON + share) * rounding_factor(&clip);
        let [near, far] = state.depth_range;
        let (scale, middle) = ((far - near) / 2.0, (far + near) / 2.0);
        let depth = Linear::sum(&weights, [0, 1, 2].map(|corner| z[corner] * scale + w[corner] * middle));
        let mut triangle = Self {
            corners,
            front: Some((area > 0.0) != state.clockwise),
            weights,
            over_w: Linear::sum(&weights, [1.0; 3]),
            planes,
            depth,
            rounding,
            band,
            unknown: None,
            empty: is_known && (same || is_outside),
            is_whole: is_inside(&clip) && state.clip_distances == 0,
            bounds: [[0.0; 2], state.viewport],
        };
        if before_eye {
            let places = window.map(|[x, y, w]| [x / w, y / w]);
            for axis in 0..2 {
                let parts = || places.iter().map(|place| place[axis]);
                triangle.bounds[0][axis] = parts().fold(f64::MAX, f64::min).max(0.0) - 1.0;
                triangle.bounds[1][axis] = parts().fold(f64::MIN, f64::max).min(state.viewport[axis]) + 1.0;
            }
        }
        let is_thin = area.abs() < 4.0 * triangle.rounding * area_size;
        if !is_known || distance_doubt || (!triangle.empty && is_thin) {
            triangle.front = None;
            triangle.unknown = Some(match before_eye && is_known {
                true => triangle.bounds,
                false => [[f64::MIN; 2], [f64::MAX; 2]],
            });
        }
        triangle
    }

    /// Tests whether a pixel has a fragment; `at`: its centre. The viewport's sides are between pixels, and exact.
    pub fn covers(&self, at: [f64; 2]) -> Covered {
        if self.empty {
            return Covered::No;
        }
        match self.unknown {
            Some(area) => covers_unknown(area, at),
            None => covers(&self.planes, at, self.band, self.rounding),
        }
    }

    fn known(value: f64, slack: f64) -> Num {
        if value.is_finite() && slack.is_finite() { Num { value, error: slack / SLACK } } else { Num::UNKNOWN }
    }

    /// How far a place may be off, in pixels, where corners are snapped to 2^-8; farther outside of the triangle, as beside its
    /// edges in a quad, by more.
    fn moves(&self, at: [f64; 2]) -> f64 {
        let weights = self.weights.map(|weight| weight.at(at).abs());
        let sum: f64 = weights.iter().sum();
        let parts = weights.iter().zip(&self.corners).map(|(weight, corner)| weight * corner.clip[3].value.abs());
        parts.sum::<f64>().max(sum / self.over_w.at(at).abs()).max(1.0) / 256.0
    }

    /// 1/w of the fragment.
    pub fn over_w(&self, at: [f64; 2]) -> Num {
        self.linear_at(&self.over_w, at)
    }

    fn linear_at(&self, linear: &Linear, at: [f64; 2]) -> Num {
        let moved = (linear.terms[0].abs() + linear.terms[1].abs()) * self.moves(at);
        Self::known(linear.at(at), self.rounding * linear.size_at(at) + moved)
    }

    /// Window depth before polygon offset.
    pub fn depth(&self, at: [f64; 2]) -> Num {
        let known = self.linear_at(&self.depth, at);
        Num { error: known.error + EPSILON / 4.0 / SLACK, ..known }
    }

    /// Changes of the depth from pixel to pixel.
    pub fn slopes(&self) -> [f64; 2] {
        [self.depth.terms[0], self.depth.terms[1]]
    }

    /// A value of the corners at a place.
    pub fn interpolate(&self, index: usize, how: Varies, at: [f64; 2]) -> Num {
        let numbers = self.corners.map(|corner| corner.values[index]);
        if numbers.iter().any(|number| !number.is_known()) || self.unknown.is_some() {
            return Num::UNKNOWN;
        }
        if how == Varies::Flat {
            return numbers[2];
        }
        let values = numbers.map(|number| number.value);
        let worst = numbers.iter().map(|number| number.error).fold(0.0, f64::max);
        let own = numbers.map(|number| number.error);
        if how == Varies::NoPerspective {
            // Mesa's llvmpipe gives NaN or coarse values where such polygons are cut.
            if !self.is_whole {
                return Num::UNKNOWN;
            }
            let factors = [0, 1, 2].map(|corner| values[corner] * self.corners[corner].clip[3].value);
            let known = self.linear_at(&Linear::sum(&self.weights, factors), at);
            return Num { error: known.error + worst, ..known };
        }
        let above = Linear::sum(&self.weights, values);
        let bottom = self.over_w.at(at);
        // Beside the triangle 1/w may be near 0, or past the horizon.
        if bottom <= 4.0 * self.rounding * self.over_w.size_at(at) {
            return Num::UNKNOWN;
        }
        if values == [values[0]; 3] && worst == 0.0 {
            return Num { value: values[0], error: EPSILON * values[0].abs() / SLACK };
        }
        let value = above.at(at) / bottom;
        let slope = |part: usize| (above.terms[part] - value * self.over_w.terms[part]) / bottom;
        let rounding = self.rounding * (above.size_at(at) + value.abs() * self.over_w.size_at(at)) / bottom;
        let slack = rounding + (slope(0).abs() + slope(1).abs()) * self.moves(at) + EPSILON * value.abs();
        let weights = self.weights.iter().zip(own).map(|(weight, error)| weight.at(at).abs() * error).sum::<f64>();
        let known = Self::known(value, slack);
        Num { error: known.error + weights / bottom, ..known }
    }
}
