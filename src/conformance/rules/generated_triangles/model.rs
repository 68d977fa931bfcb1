//! A triangle as the model draws it, by functions that are linear in the [window](crate::conformance::model::window)
//! [GL 4.6, 13.7, 13.8.1, 14.6.1, 14.6.5].

use super::pipeline::Pipeline;
use crate::conformance::model::window::{
    BAND, Covered, EPSILON, Linear, Weights, covers, covers_unknown, is_inside, rounding_factor,
};

/// A vertex as the vertex shader puts it out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    pub clip: [f32; 4],
    pub value: [f32; 4],
    pub distances: [f32; 8],
}

impl Corner {
    /// Floats of the vertex in a buffer.
    pub const FLOATS: usize = 16;

    pub fn floats(&self) -> [f32; Self::FLOATS] {
        let mut floats = [0.0; Self::FLOATS];
        floats[..4].copy_from_slice(&self.clip);
        floats[4..8].copy_from_slice(&self.value);
        floats[8..].copy_from_slice(&self.distances);
        floats
    }
}

/// A number that is known to `slack`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    pub value: f64,
    pub slack: f64,
}

impl Known {
    pub const fn exact(value: f64) -> Self {
        Self { value, slack: 0.0 }
    }

    /// Anything at all.
    pub const ANY: Self = Self { value: 0.0, slack: f64::INFINITY };

    /// The least that holds both.
    pub fn spanning(low: f64, high: f64) -> Self {
        Self { value: (low + high) / 2.0, slack: (high - low).abs() / 2.0 }
    }
}

/// Interpolation of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    Smooth,
    NoPerspective,
    Flat,
}

pub struct Triangle {
    pub corners: [Corner; 3],
    /// The corner whose flat values hold.
    pub provoking: usize,
    pub front: bool,
    weights: [Linear; 3],
    planes: Vec<Linear>,
    /// Factor of the roundings: corners that are clipped have been interpolated.
    rounding: f64,
    /// Tests whether all corners are before the eye.
    pub before_eye: bool,
    /// Least and most of the window, in pixels, where there may be fragments that the model does not know.
    unknown: Option<[[f64; 2]; 2]>,
    /// It has no area.
    empty: bool,
    /// Nothing is clipped.
    is_whole: bool,
}

impl Triangle {
    pub fn new(corners: [Corner; 3], provoking: usize, pipeline: &Pipeline, writes_distances: bool) -> Self {
        let [x, y, width, height] = pipeline.viewport.map(f64::from);
        let window = corners.map(|corner| {
            let [cx, cy, _, w] = corner.clip.map(f64::from);
            [cx * width / 2.0 + w * (x + width / 2.0), cy * height / 2.0 + w * (y + height / 2.0), w]
        });
        let edges = Weights::new(window);
        let Weights { of: weights, area, area_size } = edges;
        let clip = corners.map(|corner| corner.clip.map(f64::from));
        let mut planes = edges.planes(&clip, pipeline.depth_clamp);
        for index in (0..8).filter(|index| writes_distances && pipeline.clips >> index & 1 == 1) {
            planes.push(Linear::sum(&weights, corners.map(|corner| f64::from(corner.distances[index]))));
        }
        let before_eye = clip.iter().all(|corner| corner[3] > 0.0);
        let same = (0..3).any(|index| corners[index].clip == corners[(index + 1) % 3].clip);
        let mut triangle = Self {
            corners,
            provoking,
            front: (area > 0.0) != pipeline.clockwise,
            weights,
            planes,
            rounding: EPSILON * rounding_factor(&clip),
            before_eye,
            unknown: None,
            empty: same,
            is_whole: is_inside(&clip) && pipeline.clips == 0,
        };
        if !same && area.abs() < 4.0 * triangle.rounding * area_size {
            let places = window.map(|[x, y, w]| [x / w, y / w]);
            let bound = |part: usize, least: bool| {
                let parts = places.iter().map(|place| place[part]);
                if least { parts.fold(f64::MAX, f64::min) - 2.0 } else { parts.fold(f64::MIN, f64::max) + 2.0 }
            };
            triangle.unknown = Some(match before_eye {
                true => [[bound(0, true), bound(1, true)], [bound(0, false), bound(1, false)]],
                false => [[f64::MIN; 2], [f64::MAX; 2]],
            });
        }
        triangle
    }

    /// Tests whether a pixel has a fragment; `at`: its centre. The viewport's sides are between pixels, and exact.
    pub fn covers(&self, at: [f64; 2], viewport: [i32; 4]) -> Covered {
        if self.empty {
            return Covered::No;
        }
        for part in 0..2 {
            let [low, side] = [viewport[part], viewport[part + 2]].map(f64::from);
            if at[part] < low || at[part] > low + side {
                return Covered::No;
            }
        }
        match self.unknown {
            Some(area) => covers_unknown(area, at),
            None => covers(&self.planes, at, BAND, self.rounding),
        }
    }

    /// 1/w of the fragment.
    pub fn over_w(&self, at: [f64; 2]) -> Known {
        self.linear_at(&Linear::sum(&self.weights, [1.0; 3]), at)
    }

    fn linear_at(&self, linear: &Linear, at: [f64; 2]) -> Known {
        let moved = (linear.terms[0].abs() + linear.terms[1].abs()) / 256.0;
        Known { value: linear.at(at), slack: self.rounding * linear.size_at(at) + moved }
    }

    /// Window depth before polygon offset, and its slopes.
    pub fn depth(&self, at: [f64; 2], depth_range: [f64; 2]) -> (Known, [f64; 2]) {
        let [near, far] = depth_range.map(|end| end.clamp(0.0, 1.0));
        let linear = Linear::sum(&self.weights, self.corners.map(|corner| f64::from(corner.clip[2])));
        let Known { value, slack } = self.linear_at(&linear, at);
        let scale = (far - near) / 2.0;
        let slopes = [linear.terms[0] * scale, linear.terms[1] * scale];
        let known = Known { value: value * scale + (near + far) / 2.0, slack: slack * scale.abs() + EPSILON / 4.0 };
        (known, slopes)
    }

    /// A value of each corner at a place.
    pub fn interpolate(&self, values: [f64; 3], how: Interpolation, at: [f64; 2]) -> Known {
        match how {
            Interpolation::Flat => Known::exact(values[self.provoking]),
            // Mesa's llvmpipe gives NaN or coarse values where such polygons are cut.
            Interpolation::NoPerspective if !self.is_whole => Known::ANY,
            Interpolation::NoPerspective => {
                let factors = [0, 1, 2].map(|index| values[index] * f64::from(self.corners[index].clip[3]));
                self.linear_at(&Linear::sum(&self.weights, factors), at)
            }
            Interpolation::Smooth => {
                let (above, below) = (Linear::sum(&self.weights, values), Linear::sum(&self.weights, [1.0; 3]));
                let (top, bottom) = (above.at(at), below.at(at));
                let value = top / bottom;
                let slope = |part: usize| (above.terms[part] - value * below.terms[part]) / bottom;
                let rounding = self.rounding * (above.size_at(at) + value.abs() * below.size_at(at)) / bottom.abs();
                Known { value, slack: rounding + (slope(0).abs() + slope(1).abs()) / 256.0 + EPSILON * value.abs() }
            }
        }
    }

    /// Tests whether a polygon that is drawn by lines or points may touch a pixel.
    pub fn may_line(&self, at: [f64; 2]) -> bool {
        let reach = 3.0;
        if self.empty || !self.before_eye || self.unknown.is_some() || !self.is_whole {
            return true;
        }
        let near = |plane: &Linear| plane.at(at) / plane.terms[0].hypot(plane.terms[1]);
        let distances = [0, 1, 2].map(|index| near(&self.planes[index]));
        let least = distances.into_iter().fold(f64::MAX, f64::min);
        least.abs() < reach || (least < 0.0 && least > -reach)
    }
}
