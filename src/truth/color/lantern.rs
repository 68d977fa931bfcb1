//! A spotlight, or one point of its lens: its reach, its image, beam and law of distance, each by its formula.

use glam::{DVec2, DVec3};

use super::bounds::Bounds;
use super::projected::{Picture, Place, Wrapped, nearest, window};
use super::sample::Sample;
use super::unit;
use crate::scene::{BeamProfile, FalloffLaw, ImageFilter, LightBeam, LightShape, Spot};

/// A spotlight's place and axes.
pub(super) struct Lantern<'a> {
    spot: &'a Spot,
    pub position: DVec3,
    ahead: DVec3,
    right: DVec3,
    up: DVec3,
    /// Half width and half height of the cross-section at distance 1.
    half: DVec2,
    /// Place of the lens point over the focal distance.
    shift: DVec2,
    image: Option<Picture<'a>>,
    shield: Option<Picture<'a>>,
}

impl<'a> Lantern<'a> {
    /// The spotlight from a point of its lens, in shares of the radius.
    pub fn through(spot: &'a Spot, lens_point: DVec2) -> Self {
        let frustum = &spot.frustum;
        let ahead = unit(frustum.target - frustum.position);
        let right = unit(ahead.cross(frustum.up));
        let up = right.cross(ahead);
        let half = (0.5 * frustum.cone_radians).tan();
        let half = DVec2::new(half * frustum.aspect, half);
        let aside = spot.lens().map_or(DVec2::ZERO, |focus| focus.radius * lens_point);
        let shift = spot.lens().map_or(DVec2::ZERO, |focus| aside / focus.distance);
        let position = frustum.position + aside.x * right + aside.y * up;
        let image = spot.image.as_deref().map(Picture::new);
        let shield = spot.beam.as_ref().and_then(|beam| beam.shield.as_deref()).map(Picture::new);
        Self { spot, position, ahead, right, up, half, shift, image, shield }
    }

    /// Way from the light's own place to that of its lens point.
    pub fn way(&self) -> DVec3 {
        self.position - self.spot.frustum.position
    }

    /// Depth of a point along the axis, and its normalized device coordinates, in [-1, 1] within the frustum. Through a
    /// lens, of the point where the line from the lens point meets the focal plane, projected from the lens's centre.
    fn place(&self, point: DVec3) -> (f64, DVec2) {
        let away = point - self.position;
        let depth = away.dot(self.ahead);
        (depth, (DVec2::new(away.dot(self.right), away.dot(self.up)) / depth + self.shift) / self.half)
    }

    /// How far a point may be off, in half widths and half heights: by the sample, and by rounding.
    fn error(&self, at: &Sample, depth: f64, across: DVec2) -> DVec2 {
        let [a, b] = at.spread;
        let moved = [a + b, a - b, b - a, -a - b].map(|way| (self.place(at.position + way).1 - across).abs());
        let moved = moved.into_iter().fold(DVec2::ZERO, DVec2::max);
        let rounded = at.error / depth.abs() * (self.half.recip() + across.abs());
        // Twice: by the sample's own place, and by those of the corners that coordinates are interpolated between.
        2.0 * moved + rounded + 1e-5 * (1.0 + across.abs()) + 2e-6 * self.shift.abs() / self.half
    }

    pub fn reach(&self, at: &Sample) -> Bounds {
        let (depth, across) = self.place(at.position);
        let moved = at.spread[0].length() + at.spread[1].length() + at.error;
        if depth.abs() <= moved {
            return Bounds::anything(0.0);
        }
        if depth < 0.0 {
            return Bounds::exactly(0.0);
        }
        let error = self.error(at, depth, across);
        let (inside, doubt) = match self.spot.shape {
            LightShape::Cone => (1.0 - across.length(), error.length()),
            LightShape::Frustum => (1.0 - across.abs().max_element(), error.max_element()),
        };
        let value = f64::from(u8::from(inside >= 0.0));
        if inside.abs() <= doubt { Bounds::anything(value) } else { Bounds::exactly(value) }
    }

    /// 1 between the near and the far plane, 0 beyond.
    pub fn between_planes(&self, at: &Sample) -> Bounds {
        let depth = (at.position - self.position).dot(self.ahead);
        let frustum = &self.spot.frustum;
        let inside = (depth - frustum.near).min(frustum.far - depth);
        let moved = at.spread.iter().map(|way| way.dot(self.ahead).abs()).sum::<f64>() + at.error + 1e-6 * depth.abs();
        let value = f64::from(u8::from(inside >= 0.0));
        if inside.abs() <= moved { Bounds::anything(value) } else { Bounds::exactly(value) }
    }

    pub fn projected(&self, at: &Sample) -> [Bounds; 3] {
        let (depth, across) = self.place(at.position);
        if depth <= 0.0 || !across.is_finite() || across.abs().max_element() > 1.5 {
            // Out of reach, but for a doubtful border.
            return [Bounds::anything(1.0); 3];
        }
        let place = self.image_place(at, depth, across);
        let image = self.image(&place);
        let beam = self.beam(&place);
        let falloff = self.falloff(depth, at);
        [0, 1, 2].map(|k: usize| image[k].times(beam[k]).times(falloff))
    }

    /// 1 before the spotlight, 0 behind it.
    pub fn is_ahead(&self, at: &Sample) -> Bounds {
        let (depth, _) = self.place(at.position);
        let ahead = f64::from(u8::from(depth > 0.0));
        let moved = at.spread[0].length() + at.spread[1].length() + at.error;
        if depth.abs() <= moved { Bounds::anything(ahead) } else { Bounds::exactly(ahead) }
    }

    /// The image without beam and law; beyond its border the colour of its edge, as by GL_CLAMP_TO_EDGE.
    pub fn photograph(&self, at: &Sample) -> [Bounds; 3] {
        let (depth, across) = self.place(at.position);
        if depth <= 0.0 || !across.is_finite() {
            return [Bounds::anything(0.5); 3];
        }
        let place = self.image_place(at, depth, across);
        // The filter goes on inwards from the frame's edge, however far beyond it the place lies.
        self.image(&Place { st: place.st.clamp(DVec2::ZERO, DVec2::ONE), ..place })
    }

    /// The place in its image of a point at such a distance along its axis and place across it.
    fn image_place(&self, at: &Sample, depth: f64, across: DVec2) -> Place {
        let error = self.error(at, depth, across);
        let pixel = at.beside.map(|way| 0.5 * (self.place(at.position + way).1 - across).abs());
        Place { st: 0.5 + 0.5 * across, error: 0.5 * error, pixel }
    }

    /// The image, where no lens stands before it.
    fn image(&self, place: &Place) -> [Bounds; 3] {
        let has_lens = self.spot.beam.as_ref().is_some_and(|beam| beam.lens != 0.0);
        match (&self.image, self.spot.image_filter) {
            (Some(image), _) if !has_lens => match self.spot.image_filter {
                ImageFilter::Nearest => nearest(image, place),
                ImageFilter::Linear => window(image, Wrapped::Clamped, place, false),
                ImageFilter::Trilinear => window(image, Wrapped::Clamped, place, true),
            },
            _ => [Bounds::exactly(1.0); 3],
        }
    }

    /// The beam by its formula: bounds of the profile over a grid of places within the error, times those of the pictures
    /// over the texels around.
    fn beam(&self, place: &Place) -> [Bounds; 3] {
        const GRID: i32 = 3;
        let Some(beam) = &self.spot.beam else { return [Bounds::exactly(1.0); 3] };
        let image = self.image.as_ref().filter(|_| beam.lens != 0.0);
        let pictures = self.shield.iter().chain(image);
        let reach = place.error;
        let mut intensity = Bounds::exactly(self.intensity(beam, place.st));
        for (i, j) in (-GRID..=GRID).flat_map(|i| (-GRID..=GRID).map(move |j| (i, j))) {
            let aside = DVec2::new(f64::from(i), f64::from(j)) / f64::from(GRID);
            let other = self.intensity(beam, place.st + aside * reach);
            intensity = Bounds::around(intensity.value, [intensity.least, intensity.most, other]);
        }
        let (st, stretch) = self.through_lens(beam, place.st);
        let source = Place { st, error: reach * stretch, pixel: place.pixel };
        pictures.fold([intensity; 3], |color, picture| {
            let texels = window(picture, Wrapped::Clamped, &source, false);
            [0, 1, 2].map(|k: usize| color[k].times(texels[k]))
        })
    }

    /// Where light that comes through the lens at (s, t) left the lamp: at radius r (1 + k r²); and how much farther apart
    /// neighbours left it.
    fn through_lens(&self, beam: &LightBeam, st: DVec2) -> (DVec2, f64) {
        let aspect = DVec2::new(self.half.x / self.half.y, 1.0);
        let direction = (st * 2.0 - 1.0) * aspect;
        let radius_squared = direction.x * direction.x + direction.y * direction.y;
        let bent = direction + direction * (beam.lens * radius_squared);
        (bent / aspect * 0.5 + 0.5, 1.0 + 3.0 * beam.lens.abs() * radius_squared)
    }

    /// The profile at (s, t); 0 where a lens shows what lies beyond the cross-section.
    fn intensity(&self, beam: &LightBeam, st: DVec2) -> f64 {
        let (source, _) = self.through_lens(beam, st);
        let across = source * 2.0 - 1.0;
        if beam.lens != 0.0 && (across.x.abs() > 1.0 || across.y.abs() > 1.0) {
            return 0.0;
        }
        let tangent = DVec2::new(across.x * self.half.x, across.y * self.half.y).length();
        match &beam.profile {
            BeamProfile::Even => 1.0,
            BeamProfile::Exponent(exponent) => tangent.atan().cos().powf(*exponent),
            BeamProfile::Table(values) => profile(values, tangent / self.half.y),
        }
    }

    fn falloff(&self, depth: f64, at: &Sample) -> Bounds {
        let Some(falloff) = &self.spot.falloff else { return Bounds::exactly(1.0) };
        let [a, b] = at.spread.map(|way| way.dot(self.ahead).abs());
        let moved = a + b + at.error + 1e-6 * depth;
        let frustum = &self.spot.frustum;
        let factor = |distance: f64| law(&falloff.law, distance.clamp(frustum.near, frustum.far));
        Bounds::around(factor(depth), [factor(depth - moved), factor(depth + moved)])
    }
}

/// The value between the two entries that a radius from 0 to 1 lies between.
fn profile(values: &[f64], radius: f64) -> f64 {
    let step = radius * (values.len() - 1) as f64;
    let weight = |k: usize| (1.0 - (step - k as f64).abs()).max(0.0);
    if radius >= 1.0 {
        return values.last().copied().unwrap_or(1.0);
    }
    values.iter().enumerate().map(|(k, value)| weight(k) * value).sum()
}

fn law(law: &FalloffLaw, distance: f64) -> f64 {
    match law {
        FalloffLaw::Inverse(full) => (full / distance).min(1.0),
        FalloffLaw::InverseSquare(full) => (full / distance).powi(2).min(1.0),
        FalloffLaw::Table(pairs) => {
            let inner = pairs.windows(2).find(|pair| pair[0][0] <= distance && distance <= pair[1][0]);
            match inner {
                Some([[from, low], [to, high]]) => {
                    let part = (distance - from) / (to - from);
                    low * (1.0 - part) + high * part
                }
                _ if pairs.first().is_some_and(|[first, _]| distance < *first) => pairs[0][1],
                _ => pairs.last().map_or(1.0, |[_, last]| *last),
            }
        }
    }
}
