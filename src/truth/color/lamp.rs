//! A light on a surface: its lighting, its reach, its image, beam and law of distance, each by its formula.

use glam::{DVec2, DVec3};

use super::bounds::Bounds;
use super::projected::{Place, Wrapped, nearest, window};
use super::surface::Shaded;
use super::unit;
use crate::scene::{BeamProfile, FalloffLaw, ImageFilter, Light, LightBeam, LightKind, LightShape, Spot};

/// A light, with a spotlight's axes.
pub(super) struct Source<'a> {
    light: &'a Light,
    spot: Option<Lantern<'a>>,
}

/// A spotlight.
struct Lantern<'a> {
    spot: &'a Spot,
    position: DVec3,
    ahead: DVec3,
    right: DVec3,
    up: DVec3,
    /// Half width and half height of the cross-section at distance 1.
    half: DVec2,
}

/// Light on a surface before shadow and beam.
#[derive(Clone, Copy)]
pub(super) struct Wash {
    pub ambient: [f64; 3],
    pub diffuse: [f64; 3],
    pub specular: [f64; 3],
}

impl Wash {
    /// Clamped as fixed-function lighting clamps its one colour, to the `room` that the scene's ambient light leaves.
    pub fn clamped(self, room: [f64; 3]) -> Self {
        let ambient = [0, 1, 2].map(|k: usize| self.ambient[k].min(room[k]));
        let diffuse = [0, 1, 2].map(|k: usize| self.diffuse[k].min(room[k] - ambient[k]));
        let specular = [0, 1, 2].map(|k: usize| self.specular[k].min(room[k] - ambient[k] - diffuse[k]));
        Self { ambient, diffuse, specular }
    }

    pub fn between(corners: &[Self; 3], weights: [f64; 3]) -> Self {
        let mix = |part: fn(&Self) -> &[f64; 3]| {
            [0, 1, 2].map(|k: usize| (0..3).map(|corner| weights[corner] * part(&corners[corner])[k]).sum())
        };
        Self {
            ambient: mix(|wash| &wash.ambient),
            diffuse: mix(|wash| &wash.diffuse),
            specular: mix(|wash| &wash.specular),
        }
    }
}

impl<'a> Source<'a> {
    pub fn new(light: &'a Light) -> Self {
        let spot = match &light.kind {
            LightKind::Spot(spot) => Some(Lantern::new(spot)),
            LightKind::Point(_) | LightKind::Directional { .. } => None,
        };
        Self { light, spot }
    }

    /// Light at a point with this normal.
    pub fn wash(&self, surface: &Shaded<'_>, position: DVec3, normal: DVec3, to_viewer: DVec3) -> Wash {
        let (to_light, attenuation) = match &self.light.kind {
            LightKind::Spot(spot) => (spot.frustum.position - position, spot.attenuation),
            LightKind::Point(point) => (point.position - position, point.attenuation),
            LightKind::Directional { direction } => (-*direction, [1.0, 0.0, 0.0]),
        };
        let [constant, linear, quadratic] = attenuation.map(f64::from);
        let distance = to_light.length();
        let strength = 1.0 / (constant + linear * distance + quadratic * distance * distance);
        let facing = normal.dot(unit(to_light));
        let half = unit(unit(to_light) + to_viewer);
        let gloss =
            if facing > 0.0 { normal.dot(half).max(0.0).powf(f64::from(surface.material.shininess)) } else { 0.0 };
        let (facing, gloss) = if surface.lit { (facing.max(0.0), gloss) } else { (1.0, 0.0) };
        let product = |light: &[f32; 3], material: &[f32; 3], factor: f64| {
            [0, 1, 2].map(|k: usize| strength * factor * f64::from(light[k]) * f64::from(material[k]))
        };
        let (light, material) = (self.light, surface.material);
        Wash {
            ambient: product(&light.ambient, &material.ambient, 1.0),
            diffuse: product(&light.diffuse, &material.diffuse, facing),
            specular: product(&light.specular, &material.specular, gloss),
        }
    }

    /// 1 within the light's shape, 0 outside; for near and far planes see the shade.
    pub fn reach(&self, surface: &Shaded<'_>) -> Bounds {
        self.spot.as_ref().map_or(Bounds::exactly(1.0), |lantern| lantern.reach(surface))
    }

    /// 1 before the spotlight, 0 behind it.
    pub fn is_ahead(&self, surface: &Shaded<'_>) -> Bounds {
        let Some(lantern) = &self.spot else { return Bounds::exactly(1.0) };
        let (depth, _) = lantern.place(surface.position);
        let ahead = f64::from(u8::from(depth > 0.0));
        let moved = surface.spread[0].length() + surface.spread[1].length() + surface.error;
        if depth.abs() <= moved { Bounds::anything(ahead) } else { Bounds::exactly(ahead) }
    }

    /// The spotlight's image alone, that of its edge beyond its frame.
    pub fn photograph(&self, surface: &Shaded<'_>) -> [Bounds; 3] {
        let Some(lantern) = &self.spot else { return [Bounds::exactly(1.0); 3] };
        let (depth, across) = lantern.place(surface.position);
        if depth <= 0.0 || !across.is_finite() {
            return [Bounds::anything(0.5); 3];
        }
        let place = lantern.image_place(surface, depth, across);
        // The filter goes on inwards from the frame's edge, however far beyond it the place lies.
        lantern.image(&Place { st: place.st.clamp(DVec2::ZERO, DVec2::ONE), ..place })
    }

    /// The factor of image, beam and law of distance.
    pub fn projected(&self, surface: &Shaded<'_>) -> [Bounds; 3] {
        self.spot.as_ref().map_or([Bounds::exactly(1.0); 3], |lantern| lantern.projected(surface))
    }
}

impl<'a> Lantern<'a> {
    fn new(spot: &'a Spot) -> Self {
        let frustum = &spot.frustum;
        let ahead = unit(frustum.target - frustum.position);
        let right = unit(ahead.cross(frustum.up));
        let half = (0.5 * frustum.cone_radians).tan();
        let half = DVec2::new(half * frustum.aspect, half);
        Self { spot, position: frustum.position, ahead, right, up: right.cross(ahead), half }
    }

    /// Distance along the axis, and place across it in half widths and half heights, from the middle.
    fn place(&self, point: DVec3) -> (f64, DVec2) {
        let away = point - self.position;
        let depth = away.dot(self.ahead);
        (depth, DVec2::new(away.dot(self.right), away.dot(self.up)) / (depth * self.half))
    }

    /// How far a point may be off, in half widths and half heights: by the sample, and by rounding.
    fn error(&self, surface: &Shaded<'_>, depth: f64, across: DVec2) -> DVec2 {
        let [a, b] = surface.spread;
        let moved = [a + b, a - b, b - a, -a - b].map(|way| (self.place(surface.position + way).1 - across).abs());
        let moved = moved.into_iter().fold(DVec2::ZERO, DVec2::max);
        let rounded = surface.error / depth.abs() * (self.half.recip() + across.abs());
        // Twice: by the sample's own place, and by those of the corners that coordinates are interpolated between.
        2.0 * moved + rounded + 1e-5 * (1.0 + across.abs())
    }

    fn reach(&self, surface: &Shaded<'_>) -> Bounds {
        let (depth, across) = self.place(surface.position);
        let moved = surface.spread[0].length() + surface.spread[1].length() + surface.error;
        if depth.abs() <= moved {
            return Bounds::anything(0.0);
        }
        if depth < 0.0 {
            return Bounds::exactly(0.0);
        }
        let error = self.error(surface, depth, across);
        let (inside, doubt) = match self.spot.shape {
            LightShape::Cone => (1.0 - across.length(), error.length()),
            LightShape::Frustum => (1.0 - across.abs().max_element(), error.max_element()),
        };
        let value = f64::from(u8::from(inside >= 0.0));
        if inside.abs() <= doubt { Bounds::anything(value) } else { Bounds::exactly(value) }
    }

    fn projected(&self, surface: &Shaded<'_>) -> [Bounds; 3] {
        let (depth, across) = self.place(surface.position);
        if depth <= 0.0 || !across.is_finite() || across.abs().max_element() > 1.5 {
            // Out of reach, but for a doubtful border.
            return [Bounds::anything(1.0); 3];
        }
        let place = self.image_place(surface, depth, across);
        let image = self.image(&place);
        let beam = self.beam(&place);
        let falloff = self.falloff(depth, surface);
        [0, 1, 2].map(|k: usize| image[k].times(beam[k]).times(falloff))
    }

    /// The place in its image of a point at such a distance along its axis and place across it.
    fn image_place(&self, surface: &Shaded<'_>, depth: f64, across: DVec2) -> Place {
        let error = self.error(surface, depth, across);
        let pixel = surface.beside.map(|way| 0.5 * (self.place(surface.position + way).1 - across).abs());
        Place { st: 0.5 + 0.5 * across, error: 0.5 * error, pixel }
    }

    /// The image, where no lens stands before it.
    fn image(&self, place: &Place) -> [Bounds; 3] {
        let has_lens = self.spot.beam.as_ref().is_some_and(|beam| beam.lens != 0.0);
        match (&self.spot.image, self.spot.image_filter) {
            (Some(image), _) if !has_lens => match self.spot.image_filter {
                ImageFilter::Nearest => nearest(image, place),
                ImageFilter::Linear => window(image, Wrapped::Clamped, place, false),
                ImageFilter::Trilinear => window(image, Wrapped::Clamped, place, true),
            },
            _ => [Bounds::exactly(1.0); 3],
        }
    }

    /// The beam by its formula: bounds of the profile over a grid of places as far away as a texel, times those of the
    /// pictures over the texels around.
    fn beam(&self, place: &Place) -> [Bounds; 3] {
        const GRID: i32 = 3;
        let Some(beam) = &self.spot.beam else { return [Bounds::exactly(1.0); 3] };
        let image = self.spot.image.as_deref().filter(|_| beam.lens != 0.0);
        let pictures = || beam.shield.as_deref().into_iter().chain(image);
        let texel = pictures().map(|picture| 1.0 / DVec2::new(f64::from(picture.width), f64::from(picture.height)));
        let reach = place.error + if beam.lens == 0.0 { DVec2::ZERO } else { texel.fold(DVec2::ZERO, DVec2::max) };
        let mut intensity = Bounds::exactly(self.intensity(beam, place.st));
        for (i, j) in (-GRID..=GRID).flat_map(|i| (-GRID..=GRID).map(move |j| (i, j))) {
            let aside = DVec2::new(f64::from(i), f64::from(j)) / f64::from(GRID);
            let other = self.intensity(beam, place.st + aside * reach);
            intensity = Bounds::around(intensity.value, [intensity.least, intensity.most, other]);
        }
        let (st, stretch) = self.through_lens(beam, place.st);
        let source = Place { st, error: reach * stretch, pixel: place.pixel };
        pictures().fold([intensity; 3], |color, picture| {
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

    fn falloff(&self, depth: f64, surface: &Shaded<'_>) -> Bounds {
        let Some(falloff) = &self.spot.falloff else { return Bounds::exactly(1.0) };
        let [a, b] = surface.spread.map(|way| way.dot(self.ahead).abs());
        let moved = a + b + surface.error + 1e-6 * depth;
        let at = |distance: f64| law(&falloff.law, distance.clamp(self.spot.frustum.near, self.spot.frustum.far));
        Bounds::around(at(depth), [at(depth - moved), at(depth + moved)])
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
