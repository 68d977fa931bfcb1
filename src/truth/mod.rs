//! Exact visibility by ray casting in f64, from the scene alone: the truth that shadows are measured against.
//!
//! It must not know techniques, light matrices, texture-coordinate generation or GL. It shares no formula with them:
//! camera and light are places, directions and angles (`camera.rs`, `light.rs`).
//!
//! # What it answers
//! A ray through each pixel's centre finds the nearest surface between the camera's near and far planes; a second finds
//! whether anything lies between that point and the light. Triangles cast from both sides; the alpha test cuts holes for
//! sight and light; objects with `casts_shadow = false` are seen and do not cast. A surface that casts and whose visible
//! side is turned away from the light is in its own shadow. A point outside the cone (or the square frustum), nearer than
//! its near plane or beyond its far plane along its axis is [`Answer::OutsideCone`]. Blockers count from the light on: near
//! and far belong to its maps, not to its rays. A point light's planes are the six of a cube around it; a directional light
//! has none, and its rays are parallel: infinity is not replaced by a far point.
//! A light with a lens is taken from its middle; `truth::lens` has all of its lens points.
//!
//! # When it does not answer
//! A sample may mean any point that a move by `2^-subpixel_bits` pixel in x and y reaches, and any position may be off by
//! the rounding of f32 transforms (see [`Options`]). `beam.rs` says what can change within that, and why the search for
//! silhouettes, ends and holes inside the beam finds every such change: no sampling is involved, and nothing depends on the
//! scene's size. No epsilon hides a contact: the visible triangle is left out by its number; another triangle of the same
//! surface that touches the point counts only by its folds; any other surface within the error of the point makes it
//! [`Reason::Contact`].

mod answers;
mod around;
mod beam;
mod camera;
mod color;
mod cutout;
mod dust;
mod lens;
mod light;
mod middle;
mod portions;
mod primary;
mod shadow;
mod shells;
mod slab;
mod slivers;
mod solid;
mod tube;
mod volumes;
mod wave;
mod world;

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use crate::scene::{Light, Scene};
pub use answers::{Answer, Hit, Pixel, Reason, Truth};
#[doc(hidden)]
pub use around::{Around, Blocker, Nearer, Surroundings};
use beam::Beam;
use camera::Eye;
pub use color::{Bounds, ColorPixel, ColorRequest, ColorTruth, color};
#[doc(hidden)]
pub use color::{color_as, has_combined_bumps, why_no_colors};
use cutout::Alpha;
#[doc(hidden)]
pub use dust::{Air, dust, dust_at};
#[doc(hidden)]
pub use lens::{LensLight, lens, lens_points};
use light::Lamp;
use primary::SeenPoint;
use slab::Segment;
#[doc(hidden)]
pub use volumes::{Count, CountPixel, VolumeCounts, volume_count, volume_count_at};
use world::{PlacedObject, Triangle, World};

/// Amount of doubt that is granted.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// GL's SUBPIXEL_BITS: a sample may lie 2^-bits pixel aside. 8 on llvmpipe; GL requires at least 4.
    pub subpixel_bits: u32,
    /// A position is off by at most this many roundings of 2⁻²⁴ of the coordinates in its computation: its distance from
    /// its object's origin, and the origin's from eye and light (from the eye again for a directional one, whose map may
    /// lie around what is seen). A row of a 4×4 product makes four. How far the scene or a triangle reaches elsewhere does
    /// not count: if that makes a picture wrong here, the picture is wrong.
    pub position_roundings: f64,
    /// For shadow volumes, whose sides a depth buffer compares with what is seen: its bits, in 1..=32. Where the count of
    /// volumes may come to 0 or leave it because rounding misplaces a side against the visible surface, [`trace`] cannot
    /// decide. `None`, for shadow maps: no such doubt. [`volume_count`] takes 24 bits then.
    pub depth_buffer_bits: Option<u32>,
    /// The greatest share of drawn pixels that may be ambiguous, in [0, 1]. Above it there is no truth. Left out on both
    /// sides are pixels of [`Reason::GrazingLight`] on surfaces that shading keeps dark either way: walls under an
    /// overhead sun are undecided by nature, and show less than a 256th of the light.
    pub most_ambiguous: f64,
    /// For colours: texels a side of photographs' depth maps. What their eyes see is in doubt within two texels of an edge.
    /// `None`: the exact rays.
    pub photo_map_size: Option<u32>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            subpixel_bits: 8,
            position_roundings: 4.0,
            depth_buffer_bits: None,
            most_ambiguous: 0.03,
            photo_map_size: None,
        }
    }
}

/// Reason why there is no truth.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
#[non_exhaustive]
pub enum Error {
    /// The scene does not have the light.
    #[error("there is no light {index}: the scene's number of lights is {count}")]
    NoLight { index: usize, count: usize },
    /// Camera or light has a position that is not finite.
    #[error("the camera or the light has no usable position")]
    View,
    /// The transform of an object cannot be inverted.
    #[error("object `{name}`: its transform has no inverse")]
    Transform { name: String },
    /// The triangles of a mesh cannot be traced.
    #[error("mesh `{name}`: {what}")]
    Mesh { name: String, what: String },
    /// The scene has something whose colour cannot be known.
    #[error("no colours to compare with: {why}")]
    Colors { why: String },
    /// More pixels are ambiguous than [`Options::most_ambiguous`] allows.
    #[error(
        "the ray tracer cannot decide {percent:.2} % of the drawn pixels (limit {most_percent} %; {reasons}): \
         there is no truth to measure against"
    )]
    TooAmbiguous { percent: f64, most_percent: f64, reasons: String },
}

/// Finds for each pixel of the scene's image whether light number `light` reaches it.
pub fn trace(scene: &Scene, light: usize, options: &Options) -> Result<Truth, Error> {
    Tracer::new(scene, light, options)?.trace(scene, options)
}

/// Undecided pixels among those answered so far.
#[derive(Default)]
struct Doubts {
    answered: usize,
    drawn: usize,
    /// Ambiguous ones that are dark by shading alone: they count neither as drawn nor as ambiguous.
    dark: usize,
    by_reason: [usize; Reason::ALL.len()],
}

impl Doubts {
    fn add(&mut self, pixel: &Pixel, scene: &Scene) {
        self.answered += 1;
        self.drawn += usize::from(pixel.answer != Answer::Background);
        let Answer::Ambiguous(reason) = pixel.answer else { return };
        let is_dark = |hit: &Hit| {
            let is_lit = scene.objects.get(hit.object as usize).is_none_or(|object| object.lit);
            is_lit && hit.cos_light.abs() < FAINT
        };
        self.dark += usize::from(reason == Reason::GrazingLight && pixel.hit.as_ref().is_some_and(is_dark));
        for (known, count) in Reason::ALL.iter().zip(&mut self.by_reason) {
            *count += usize::from(*known == reason);
        }
    }

    fn ambiguous(&self) -> usize {
        self.by_reason.iter().sum::<usize>() - self.dark
    }

    /// The least share of ambiguous pixels that `left` more can leave.
    fn share_of(&self, left: usize) -> f64 {
        self.ambiguous() as f64 / (self.drawn - self.dark + left).max(1) as f64
    }

    /// The picture has `count` pixels.
    fn error(&self, options: &Options, count: usize) -> Error {
        let reasons = Reason::ALL.iter().zip(self.by_reason).filter(|(_, count)| *count > 0);
        let reasons: Vec<String> = reasons.map(|(reason, count)| format!("{count} {}", reason.name())).collect();
        let stopped = match self.answered {
            all if all == count => String::new(),
            answered => format!("; stopped after {answered} of {count} pixels"),
        };
        Error::TooAmbiguous {
            percent: 100.0 * self.share_of(0),
            most_percent: 100.0 * options.most_ambiguous,
            reasons: format!("{}{stopped}", reasons.join(", ")),
        }
    }
}

/// A cosine below which diffuse light is less than a code of eight bits.
const FAINT: f64 = 1.0 / 256.0;

/// Once one point of a beam is doubtful, only this many of its other triangles are examined: if f32 may move surfaces by
/// more than a mesh's size, each beam meets all of its triangles.
const ENOUGH: u32 = 1024;

/// Everything that an answer for a pixel needs.
struct Tracer<'a> {
    /// Shared by the tracers of a scene's lights.
    world: Arc<World<'a>>,
    eye: Eye,
    lamp: Lamp,
    /// In pixels.
    subpixel: f64,
    /// [`Options::position_roundings`] times 2⁻²⁴.
    rounding: f64,
    /// See [`Options::depth_buffer_bits`].
    depth_buffer_bits: Option<u32>,
    /// Each object's error of position at its farthest vertex, in world units.
    errors: Vec<f64>,
    largest_error: f64,
}

impl<'a> Tracer<'a> {
    fn new(scene: &'a Scene, light: usize, options: &Options) -> Result<Self, Error> {
        let missing = || Error::NoLight { index: light, count: scene.lights.len() };
        Self::of_light(scene, scene.lights.get(light).ok_or_else(missing)?, options)
    }

    fn of_light(scene: &'a Scene, light: &Light, options: &Options) -> Result<Self, Error> {
        let world = Arc::new(World::new(scene)?);
        let (center, radius) = world.ball();
        Self::of_lamp(&world, scene, Lamp::new(light, center, radius), options)
    }

    /// The tracer of a lamp in a world that is there.
    fn of_lamp(world: &Arc<World<'a>>, scene: &'a Scene, lamp: Lamp, options: &Options) -> Result<Self, Error> {
        let eye = Eye::new(scene);
        if !(eye.is_finite() && lamp.is_finite()) {
            return Err(Error::View);
        }
        let rounding = options.position_roundings * 0.5 * f64::from(f32::EPSILON);
        let subpixel = (-f64::from(options.subpixel_bits)).exp2();
        let depth_buffer_bits = options.depth_buffer_bits;
        let (errors, largest_error) = (Vec::new(), 0.0);
        let world = Arc::clone(world);
        let mut tracer = Self { world, eye, lamp, subpixel, rounding, depth_buffer_bits, errors, largest_error };
        tracer.errors = tracer.world.placed.iter().map(|placed| tracer.error_of(placed, placed.reach)).collect();
        tracer.largest_error = tracer.errors.iter().copied().fold(0.0, f64::max);
        Ok(tracer)
    }

    /// The answers for every pixel of the scene's picture.
    fn trace(&self, scene: &Scene, options: &Options) -> Result<Truth, Error> {
        let [width, height] = scene.image.size;
        let counting = options.depth_buffer_bits.map(|_| volumes::VolumeCounter::new(scene, self));
        let answer = |(x, y)| {
            let pixel = self.answer(x, y);
            let reason = counting.as_ref().and_then(|counting| counting.doubt(x, y, pixel.answer));
            Pixel { answer: reason.map_or(pixel.answer, Answer::Ambiguous), ..pixel }
        };
        let count = width as usize * height as usize;
        let mut tally = Doubts::default();
        // Pixels take so much memory that each copy of them costs as long as some of their rays.
        let mut found = vec![Pixel { answer: Answer::Background, lit_at_center: None, hit: None }; count];
        let mut pixels: Vec<Pixel> = Vec::new();
        for first in 0..portions::COUNT {
            let places = portions::pixels(first, [width, height]);
            let at = |index: &usize| answer(((index % width as usize) as u32, (index / width as usize) as u32));
            places.par_iter().map(at).collect_into_vec(&mut pixels);
            pixels.iter().for_each(|pixel| tally.add(pixel, scene));
            places.into_iter().zip(&pixels).for_each(|(index, pixel)| found[index] = *pixel);
            let left = count - tally.answered;
            if tally.share_of(left) > options.most_ambiguous {
                return Err(tally.error(options, count));
            }
        }
        Ok(Truth { width, height, pixels: found })
    }

    /// The error of a point at `reach` from its object's origin. The second term is the rounding of this computation itself, in
    /// which the object's farthest vertex enters too.
    fn error_of(&self, placed: &PlacedObject, reach: f64) -> f64 {
        let (origin, eye) = (placed.origin(), self.eye.position);
        let met = reach + origin.distance(eye) + origin.distance(self.lamp.place().unwrap_or(eye));
        let own = 64.0 * f64::EPSILON * (origin.abs().max_element() + met + placed.reach);
        self.rounding * met + own + placed.wave_error
    }

    fn position_error(&self, triangle: &Triangle<'_>, position: DVec3) -> f64 {
        self.error_of(triangle.placed, position.distance(triangle.placed.origin()))
    }

    /// Distance in world units along the view ray by which a depth buffer may misplace the visible point against another
    /// surface of the same pixel: each of the two by its own error.
    fn depth_misplacement(&self, seen: &SeenPoint<'_>, bits: u32) -> f64 {
        let ray = seen.position - self.eye.position;
        let depth = self.eye.depth_of(ray);
        let rise = seen.spread.iter().map(|way| self.eye.depth_of(*way).abs()).sum::<f64>() / self.subpixel;
        2.0 * self.eye.infinite_depth_error(bits, depth, rise) * ray.length() / depth
    }

    /// The error of a triangle where the beam may meet it: the axis within the triangle's box. Elsewhere a huge triangle may be
    /// off by more.
    fn error_in(&self, beam: &Beam, triangle: &Triangle<'_>) -> f64 {
        let most = self.errors[triangle.object as usize];
        let [a, b, c] = triangle.corners;
        let pad = beam.radius(most);
        let (min, max) = (a.min(b).min(c) - pad, a.max(b).max(c) + pad);
        let (origin, axis) = (beam.origin(), beam.axis());
        // Past the base as far as a beam is wide.
        let (mut start, mut end) = (beam.start, 1.0 + pad / axis.length());
        for k in 0..3 {
            let ends = [(min[k] - origin[k]) / axis[k], (max[k] - origin[k]) / axis[k]];
            // f64::min and max leave out a NaN: a face in which the axis lies.
            start = start.max(ends[0].min(ends[1]));
            end = end.min(ends[0].max(ends[1]));
        }
        // A distance along a line is greatest at an end.
        let at = |t: f64| self.position_error(triangle, origin + t * axis);
        if start <= end { at(start).max(at(end)).min(most) } else { most }
    }

    fn answer(&self, x: u32, y: u32) -> Pixel {
        let (seen, doubtful_view) = self.look(x, y);
        let Some(seen) = seen else {
            let answer = doubtful_view.map_or(Answer::Background, Answer::Ambiguous);
            return Pixel { answer, lit_at_center: None, hit: None };
        };
        let is_held = self.lamp.holds(seen.position, &seen.spread, seen.error);
        let is_held_at_center = self.lamp.holds_exactly(seen.position);
        let is_sure = doubtful_view.is_none() && is_held.is_ok();
        let (lit, doubtful_light) = if is_held_at_center { self.light_reaches(&seen, is_sure) } else { (false, None) };
        let answer = match (doubtful_view, is_held, doubtful_light) {
            (Some(reason), _, _) | (None, Err(reason), _) => Answer::Ambiguous(reason),
            (None, Ok(false), _) => Answer::OutsideCone,
            (None, Ok(true), Some(reason)) => Answer::Ambiguous(reason),
            (None, Ok(true), None) if lit => Answer::Lit,
            (None, Ok(true), None) => Answer::Shadowed,
        };
        Pixel { answer, lit_at_center: is_held_at_center.then_some(lit), hit: Some(self.describe(&seen)) }
    }

    fn describe(&self, seen: &SeenPoint<'_>) -> Hit {
        let to_light = self.lamp.towards(seen.position);
        Hit {
            object: seen.triangle.object,
            triangle: seen.triangle.index,
            distance: seen.position.distance(self.eye.position),
            position: seen.position,
            normal: seen.normal,
            cos_light: seen.normal.dot(to_light.normalize_or_zero()),
            pixel_size: (seen.spread[0].length() + seen.spread[1].length()) / self.subpixel,
            in_map: self.lamp.in_map(seen.position),
        }
    }

    /// Calls `look` with each triangle that the beam may meet along `segment`, a piece of its middle.
    fn visit(&self, beam: &Beam, segment: &Segment, look: impl FnMut(&Triangle<'_>) -> ControlFlow<()>) {
        self.world.visit(segment, beam.tube(), self.largest_error, |object| self.errors[object as usize], look);
    }

    fn passes_any_edge(&self, beam: &Beam, triangle: &Triangle<'_>, error: f64) -> bool {
        let [a, b, c] = triangle.corners;
        [(a, b), (b, c), (c, a)].into_iter().any(|(from, to)| beam.passes_edge(from, to, error))
    }

    /// Tests whether the surface ends or folds over, as seen from the beam's apex, at an edge inside the beam.
    fn folds_inside(&self, beam: &Beam, triangle: &Triangle<'_>, error: f64) -> bool {
        (0..3).any(|k| {
            let [from, to, third] = [0, 1, 2].map(|i| triangle.corners[(k + i) % 3]);
            beam.passes_edge(from, to, error) && beam.is_fold([from, to], third, triangle.across(k), error)
        })
    }

    /// The triangle's alpha over all points in which the beam crosses its plane.
    fn alpha_in(&self, beam: &Beam, triangle: &Triangle<'_>) -> Alpha {
        if !triangle.has_cutout() {
            return Alpha::OPAQUE;
        }
        let normal = triangle.normal();
        let cross = |base: DVec3| {
            let way = beam.way_to(base);
            base + way * (normal.dot(triangle.corners[0] - base) / normal.dot(way))
        };
        let [a, b] = beam.spread;
        let around = [a + b, a - b, b - a, -a - b].map(|offset| cross(beam.base + offset));
        triangle.alpha(cross(beam.base), &around)
    }
}

/// Keeps the first reason.
fn doubt(reason: &mut Option<Reason>, found: Option<Reason>) {
    *reason = reason.or(found);
}
