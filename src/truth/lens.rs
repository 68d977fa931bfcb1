//! Light through a lens, by a ray to each of its points in f64: the truth that accumulated pictures are measured against.
//!
//! A lens point is a place beside the light. What it sends to a point X goes on, or back, to the focal plane, and is there
//! what the light's middle projects to that place of the plane [SEG, 3.2]: so the light ends where the focal plane's
//! picture ends. No frustum is sheared here.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::beam::{Apex, Beam};
use super::dust::linear;
use super::primary::SeenPoint;
use super::{Error, Options, Tracer};
use crate::scene::{Focus, Light, LightShape, Scene, Spot};

/// Light that a pixel's surface gets through a lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensLight {
    /// Object that is seen, into [`Scene::objects`]; `None`: background.
    pub object: Option<u32>,
    /// Share of the lens points whose light arrives, in [0, 1].
    pub share: f64,
    /// Mean of their diffuse light on a white surface that faces as the seen triangle does: colour, image and attenuation,
    /// times the cosine on surfaces that are lit. RGB.
    pub light: DVec3,
}

const DARK: LensLight = LensLight { object: None, share: 0.0, light: DVec3::ZERO };

/// Lens points of the key `samples`, to the right and up, in shares of the radius: the rule of `data/scenes/README.md`.
pub fn lens_points(samples: u32) -> Vec<DVec2> {
    let mut points = Vec::new();
    // The area up to where a pair lies, in shares of the lens; the middle alone has a share of its own.
    let each = 1.0 / f64::from(samples);
    let mut inner = 0.0;
    if samples % 2 == 1 {
        points.push(DVec2::ZERO);
        inner = each;
    }
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let turn = std::f64::consts::PI / golden;
    let mut angle = 0.0_f64;
    while points.len() < samples as usize {
        let (sin, cos) = angle.sin_cos();
        let place = (inner + each).sqrt() * DVec2::new(cos, sin);
        points.extend([place, -place]);
        inner += 2.0 * each;
        angle += turn;
    }
    points
}

/// Finds for each pixel, row by row from the top, the light of light number `light` through these points of its lens, in
/// shares of its radius. `None`: the light has no `focus`.
///
/// # Errors
///
/// As [`super::trace`].
pub fn lens(scene: &Scene, light: usize, points: &[DVec2]) -> Result<Option<Vec<LensLight>>, Error> {
    let tracer = Tracer::new(scene, light, &Options::default())?;
    let source = &scene.lights[light];
    let Some((spot, focus)) = source.spot().and_then(|spot| Some((spot, spot.focus?))) else { return Ok(None) };
    let projector = Lens::new(spot, focus);
    let [width, height] = scene.image.size;
    let of = |index: u32| {
        let Some(seen) = tracer.look(index % width, index / width).0 else { return DARK };
        let is_lit = scene.objects.get(seen.triangle.object as usize).is_none_or(|object| object.lit);
        let mut sum = LensLight { object: Some(seen.triangle.object), ..DARK };
        for point in points {
            let place = projector.place(*point);
            let Some(at) = projector.on_focal_plane(place, seen.position) else { continue };
            if !tracer.reaches(&seen, place) {
                continue;
            }
            sum.share += 1.0;
            sum.light += projector.light(source, at, place, &seen, is_lit);
        }
        let count = points.len() as f64;
        LensLight { share: sum.share / count, light: sum.light / count, ..sum }
    };
    Ok(Some((0..width * height).into_par_iter().map(of).collect()))
}

/// A spotlight with a lens.
struct Lens<'a> {
    spot: &'a Spot,
    focus: Focus,
    ahead: DVec3,
    right: DVec3,
    up: DVec3,
    /// Half the width and half the height of the picture on the focal plane, over the focal distance.
    half: DVec2,
}

impl<'a> Lens<'a> {
    fn new(spot: &'a Spot, focus: Focus) -> Self {
        let frustum = &spot.frustum;
        let ahead = (frustum.target - frustum.position).normalize();
        let right = ahead.cross(frustum.up).normalize();
        let tangent = (0.5 * frustum.cone_radians).tan();
        let half = DVec2::new(tangent * frustum.aspect, tangent);
        Self { spot, focus, ahead, right, up: right.cross(ahead), half }
    }

    fn place(&self, point: DVec2) -> DVec3 {
        self.spot.frustum.position + self.focus.radius * (point.x * self.right + point.y * self.up)
    }

    /// Place in the light's picture, in halves of its width and height, of what goes from a lens point through `point`.
    /// `None`: the picture does not reach there, or the point lies behind the lens.
    fn on_focal_plane(&self, place: DVec3, point: DVec3) -> Option<DVec2> {
        let (way, beside) = (point - place, place - self.spot.frustum.position);
        let depth = self.ahead.dot(way);
        // Over the focal distance: the lens point's own place, and the way from there.
        let along = |axis: DVec3| axis.dot(beside) / self.focus.distance + axis.dot(way) / depth;
        let at = DVec2::new(along(self.right), along(self.up)) / self.half;
        let inside = match self.spot.shape {
            LightShape::Cone => at.length() <= 1.0,
            LightShape::Frustum => at.abs().max_element() <= 1.0,
        };
        (depth > 0.0 && inside).then_some(at)
    }

    fn light(&self, source: &Light, at: DVec2, place: DVec3, seen: &SeenPoint<'_>, is_lit: bool) -> DVec3 {
        let color = DVec3::from_array(source.diffuse.map(f64::from));
        let image = self.spot.image.as_deref().map_or(DVec3::ONE, |image| linear(image, 0.5 * (DVec2::ONE + at)));
        let way = place - seen.position;
        let cosine = if is_lit { seen.normal.dot(way.normalize()).max(0.0) } else { 1.0 };
        let [constant, linear, quadratic] = source.attenuation().map(f64::from);
        let away = way.length();
        cosine * color * image / (constant + away * (linear + away * quadratic))
    }
}

impl Tracer<'_> {
    /// Tests whether nothing lies between a seen point and a place.
    fn reaches(&self, seen: &SeenPoint<'_>, place: DVec3) -> bool {
        let is_own = seen.normal.dot(place - seen.position) < 0.0 && seen.triangle.placed.casts_shadow;
        let beam = Beam { apex: Apex::At(place), ..self.shadow_beam(seen) };
        !is_own && self.is_clear_at_center(&beam, seen)
    }
}
