//! Light in dusty air, by marching along each pixel's ray in f64: the truth that slices of a beam are measured against.
//!
//! Between the light's near and far planes, within its cone or frustum, and before the surface that is seen, air of the
//! length l takes 1 - exp(-density l) of the light that passes, and sends as large a share of the light that reaches it to
//! the eye [LEC, "Combining Shadows with Atmospherics"]. The layers of [`dust`] are of one thickness along each ray, from
//! where it enters the beam to where it leaves it; those of [`dust_at`] lie where the caller says.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::beam::crossing;
use super::slab::Segment;
use super::tube::Tube;
use super::{Error, Options, Tracer};
use crate::geometry::Texture;
use crate::scene::{Dust, DustBlend, Light, Scene};

/// Dust before a pixel's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Light that it sends to the eye, RGB, linear, unclamped.
    pub color: DVec3,
    /// Share of the surface's light that it takes, in [0, 1]; 0 where slices are added.
    pub opacity: f64,
    /// Depths along the view axis at which the ray enters and leaves the beam, or meets a surface; `None`: it misses it.
    pub span: Option<[f64; 2]>,
}

const CLEAR: Air = Air { color: DVec3::ZERO, opacity: 0.0, span: None };

/// Finds the dust of light number `light` for each pixel, row by row from the top, in `layers` layers a ray. `None`: the
/// light has no dust, or is no spotlight.
///
/// # Errors
///
/// As [`super::trace`].
pub fn dust(scene: &Scene, light: usize, layers: u32) -> Result<Option<Vec<Air>>, Error> {
    march(scene, light, |[start, end]| {
        let step = (end - start) / f64::from(layers);
        (0..layers).map(|layer| [start + (f64::from(layer) + 0.5) * step, step]).collect()
    })
}

/// The same with layers at these depths along the view axis, in any order, each of `thickness` along it.
///
/// # Errors
///
/// As [`super::trace`].
pub fn dust_at(scene: &Scene, light: usize, depths: &[f64], thickness: f64) -> Result<Option<Vec<Air>>, Error> {
    let mut sorted = depths.to_vec();
    sorted.sort_by(f64::total_cmp);
    march(scene, light, |[start, end]| {
        sorted.iter().filter(|depth| (start..=end).contains(*depth)).map(|depth| [*depth, thickness]).collect()
    })
}

/// Sums the layers that `layers` places in a ray's span: each a depth and a thickness along the view axis, nearest first.
fn march(
    scene: &Scene,
    light: usize,
    layers: impl Fn([f64; 2]) -> Vec<[f64; 2]> + Sync,
) -> Result<Option<Vec<Air>>, Error> {
    let tracer = Tracer::new(scene, light, &Options::default())?;
    let source = &scene.lights[light];
    let Some(dust) = source.dust.filter(|_| source.spot().is_some()) else { return Ok(None) };
    let [width, height] = scene.image.size;
    let of = |index: u32| {
        let (x, y) = (index % width, index / width);
        let direction = tracer.eye.direction(x, y);
        let end =
            tracer.look(x, y).0.map_or(tracer.eye.far, |seen| tracer.eye.depth_of(seen.position - tracer.eye.position));
        let whole = [tracer.eye.near, end];
        let span = tracer.lamp.span(tracer.eye.position, direction, whole).filter(|[start, end]| start < end);
        span.map_or(CLEAR, |span| tracer.sum(source, &dust, direction, span, layers(span)))
    };
    Ok(Some((0..width * height).into_par_iter().map(of).collect()))
}

impl Tracer<'_> {
    fn sum(&self, source: &Light, dust: &Dust, direction: DVec3, span: [f64; 2], layers: Vec<[f64; 2]>) -> Air {
        let (mut color, mut passes) = (DVec3::ZERO, 1.0);
        for [depth, thickness] in layers {
            let point = self.eye.position + depth * direction;
            if !self.lamp.holds_exactly(point) {
                continue;
            }
            let optical = dust.density * thickness * direction.length();
            let is_lit = self.reaches_air(point);
            let light = if is_lit { self.light_at(source, point) } else { DVec3::ZERO };
            match dust.blend {
                DustBlend::Add => color += optical * light,
                DustBlend::Over => {
                    let opacity = -f64::exp_m1(-optical);
                    color += passes * opacity * light;
                    if is_lit || dust.hides_in_shadow {
                        passes *= 1.0 - opacity;
                    }
                }
            }
        }
        Air { color, opacity: 1.0 - passes, span: Some(span) }
    }

    /// Tests whether nothing that casts a shadow lies between a point of the air and the light.
    pub(super) fn reaches_air(&self, point: DVec3) -> bool {
        let Some(place) = self.lamp.place() else { return true };
        let segment = Segment { origin: point, direction: place - point, start: 0.0, end: 1.0 };
        let mut is_clear = true;
        let look = |triangle: &super::Triangle<'_>| {
            let met =
                crossing(segment.origin, segment.direction, &triangle.corners).filter(|t| (0.0..=1.0).contains(t));
            let blocks = met.is_some_and(|t| {
                triangle.placed.casts_shadow
                    && triangle.alpha(segment.origin + t * segment.direction, &[]).passes_test()
            });
            is_clear = !blocks;
            if blocks { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        self.world.visit(&segment, Tube::LINE, 0.0, |_| 0.0, look);
        is_clear
    }

    /// Diffuse colour of the light at a point of its beam, with its image and attenuation.
    fn light_at(&self, source: &Light, point: DVec3) -> DVec3 {
        let color = DVec3::from_array(source.diffuse.map(f64::from));
        let image = source.spot().and_then(|spot| spot.image.as_deref());
        let image = image.map_or(DVec3::ONE, |image| {
            let place = self.lamp.in_map(point);
            linear(image, 0.5 * (DVec2::ONE + place.truncate()))
        });
        let [constant, linear, quadratic] = source.attenuation().map(f64::from);
        let away = self.lamp.towards(point).length();
        color * image / (constant + away * (linear + away * quadratic))
    }
}

/// The image at (s, t), of the four texels around it; beyond the rim the rim's own.
pub(super) fn linear(image: &Texture, st: DVec2) -> DVec3 {
    let size = [image.width, image.height];
    let texel = |x: i64, y: i64| {
        let [x, y] = [(x, size[0]), (y, size[1])].map(|(at, size)| at.clamp(0, i64::from(size) - 1) as usize);
        let at = 4 * (y * size[0] as usize + x);
        DVec3::new(f64::from(image.rgba[at]), f64::from(image.rgba[at + 1]), f64::from(image.rgba[at + 2])) / 255.0
    };
    let at = st * DVec2::new(f64::from(size[0]), f64::from(size[1])) - 0.5;
    let (base, share) = (at.floor(), at - at.floor());
    let [x, y] = [base.x as i64, base.y as i64];
    let row = |y: i64| texel(x, y).lerp(texel(x + 1, y), share.x);
    row(y).lerp(row(y + 1), share.y)
}
