//! A light on a surface: its lighting, its reach, and what is projected through it.

use glam::{DVec2, DVec3};

use super::bounds::Bounds;
use super::lantern::Lantern;
use super::sample::Sample;
use super::surface::Shaded;
use super::unit;
use crate::scene::{Law, Light, LightKind};

/// A light, or one point of its lens.
pub(super) struct Source<'a> {
    light: &'a Light,
    /// A spotlight with its axes.
    spot: Option<Lantern<'a>>,
}

/// Light on a surface before shadow and beam.
#[derive(Clone, Copy)]
pub(super) struct Wash {
    pub ambient: [f64; 3],
    pub diffuse: [f64; 3],
    pub specular: [f64; 3],
    /// Factors of diffuse and specular light that bumps make; 1 on other surfaces, where these have theirs already.
    pub cosine: Bounds,
    pub shine: Bounds,
}

impl Wash {
    /// Clamped as fixed-function lighting clamps its one colour, to the `room` that the scene's ambient light leaves.
    pub fn clamped(self, room: [f64; 3]) -> Self {
        let ambient = [0, 1, 2].map(|k: usize| self.ambient[k].min(room[k]));
        let diffuse = [0, 1, 2].map(|k: usize| self.diffuse[k].min(room[k] - ambient[k]));
        let specular = [0, 1, 2].map(|k: usize| self.specular[k].min(room[k] - ambient[k] - diffuse[k]));
        Self { ambient, diffuse, specular, ..self }
    }

    pub fn between(corners: &[Self; 3], weights: [f64; 3]) -> Self {
        let mix = |part: fn(&Self) -> &[f64; 3]| {
            [0, 1, 2].map(|k: usize| (0..3).map(|corner| weights[corner] * part(&corners[corner])[k]).sum())
        };
        Self {
            ambient: mix(|wash| &wash.ambient),
            diffuse: mix(|wash| &wash.diffuse),
            specular: mix(|wash| &wash.specular),
            cosine: Bounds::ALL,
            shine: Bounds::ALL,
        }
    }
}

impl<'a> Source<'a> {
    /// The light from a point of its lens, in shares of the radius to the right of and above its middle.
    pub fn through(light: &'a Light, lens_point: DVec2) -> Self {
        Self { light, spot: light.spot().map(|spot| Lantern::through(spot, lens_point)) }
    }

    /// Way from the light's own place to that of its lens point.
    pub fn way(&self) -> DVec3 {
        self.spot.as_ref().map_or(DVec3::ZERO, Lantern::way)
    }

    /// The way to the light; of unit length if it is infinitely far away.
    fn way_from(&self, position: DVec3) -> DVec3 {
        match (&self.light.kind, &self.spot) {
            (LightKind::Directional { direction }, _) => -*direction,
            (LightKind::Point(point), _) => point.position - position,
            (LightKind::Spot(spot), lantern) => {
                lantern.as_ref().map_or(spot.frustum.position, |lantern| lantern.position) - position
            }
        }
    }

    /// Unit vector to the light, and the factor of its attenuation.
    fn strength(&self, position: DVec3) -> (DVec3, f64) {
        let to_light = self.way_from(position);
        let [constant, linear, quadratic] = self.light.attenuation().map(f64::from);
        let distance = to_light.length();
        (unit(to_light), 1.0 / (constant + linear * distance + quadratic * distance * distance))
    }

    /// Light at a point with this normal.
    pub fn wash(&self, surface: &Shaded<'_>, position: DVec3, normal: DVec3, to_viewer: DVec3) -> Wash {
        let (to_light, strength) = self.strength(position);
        let facing = normal.dot(to_light);
        let half = unit(to_light + to_viewer);
        let gloss =
            if facing > 0.0 { normal.dot(half).max(0.0).powf(f64::from(surface.material.shininess)) } else { 0.0 };
        let is_lit = surface.lit && self.light.law == Law::Lit;
        let bumps = surface.bumps.as_ref().filter(|_| is_lit);
        let (facing, gloss) = match (is_lit, bumps) {
            (true, None) => (facing.max(0.0), gloss),
            (true, Some(_)) => (1.0, 1.0),
            (false, _) => (1.0, 0.0),
        };
        let shininess = f64::from(surface.material.shininess);
        let bumps = bumps.map(|bumps| bumps.response(&|point| self.way_from(point), shininess, &surface.at));
        let (cosine, shine) = bumps.map_or((Bounds::ALL, Bounds::ALL), |found| (found.cosine, found.shine));
        let product = |light: &[f32; 3], material: &[f32; 3], factor: f64| {
            [0, 1, 2].map(|k: usize| strength * factor * f64::from(light[k]) * f64::from(material[k]))
        };
        let (light, material) = (self.light, surface.material);
        Wash {
            ambient: product(&light.ambient, &material.ambient, 1.0),
            diffuse: product(&light.diffuse, &material.diffuse, facing),
            specular: product(&light.specular, &material.specular, gloss),
            cosine,
            shine,
        }
    }

    /// A projector's light alone, whatever it falls on.
    pub fn slide(&self, surface: &Shaded<'_>) -> Wash {
        let none = [0.0; 3];
        let [cosine, shine] = [Bounds::ALL; 2];
        Wash { ambient: none, diffuse: self.in_air(surface.at.position), specular: none, cosine, shine }
    }

    /// Diffuse light at a point, before shadow and beam.
    pub fn in_air(&self, position: DVec3) -> [f64; 3] {
        let (_, strength) = self.strength(position);
        self.light.diffuse.map(|channel| strength * f64::from(channel))
    }

    /// 1 within the light's shape, 0 outside; for near and far planes see the shade.
    pub fn reach(&self, at: &Sample) -> Bounds {
        self.spot.as_ref().map_or(Bounds::exactly(1.0), |lantern| lantern.reach(at))
    }

    /// 1 between the light's near and far planes, 0 beyond.
    pub fn between_planes(&self, at: &Sample) -> Bounds {
        self.spot.as_ref().map_or(Bounds::exactly(1.0), |lantern| lantern.between_planes(at))
    }

    /// 1 before the spotlight, 0 behind it.
    pub fn is_ahead(&self, at: &Sample) -> Bounds {
        self.spot.as_ref().map_or(Bounds::exactly(1.0), |lantern| lantern.is_ahead(at))
    }

    /// The spotlight's image alone, that of its edge beyond its frame.
    pub fn photograph(&self, at: &Sample) -> [Bounds; 3] {
        self.spot.as_ref().map_or([Bounds::exactly(1.0); 3], |lantern| lantern.photograph(at))
    }

    /// The factor of image, beam and law of distance.
    pub fn projected(&self, at: &Sample) -> [Bounds; 3] {
        self.spot.as_ref().map_or([Bounds::exactly(1.0); 3], |lantern| lantern.projected(at))
    }
}
