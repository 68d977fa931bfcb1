//! Forecasts wrong pixels of a map's picture, by sampling. Points that the camera sees in the middles of pixels are looked
//! up in the map as in the lit pass, in texels that rays find (`texels.rs`, `lookup.rs`), and compared with a ray to the
//! light. Warns, with the share, if
//! - more than about 1.2 % of the points that the light reaches are wrong, for too few texels or too few codes of depth;
//! - a point before the near plane is lit by mistake;
//! - a point is wrong although nothing changes as far as a lookup reaches (*evenly* wrong): a surface that shades itself,
//!   or a caster that the map does not hold.

mod even;
mod lookup;
mod places;
mod points;
mod texels;
mod told;

use glam::DVec3;
use rayon::prelude::*;

use self::lookup::Receiver;
use self::places::{code, is_in, length_of_depth, receiver, sighting};
use self::points::{Items, Met, Seen, on_the_way, seen, to_light};
use self::texels::Texels;
pub use self::texels::{Alone, Stored};
use super::bias;
use crate::lights::box_raster::BoxRaster;
use crate::lights::projector::{Projector, Rays};
use crate::lights::{Drawable, LightView, Notes};
use crate::pass::{DepthFormat, Face, PolygonOffset};
use crate::scene::{LightKind, LightShape};
use crate::techniques::shadow_map::settings::{Mipmaps, Offset, Settings};

/// Fewest pixels that the light must reach for a share to be meaningful.
const FEWEST_PIXELS: u32 = 1000;

/// Greatest number of points to sample first, and if any of them is wrong.
const MOST_SAMPLES: [u32; 2] = [2_000, 20_000];

/// Lengths below this share of a point's coordinates and of its distance from the eye count as zero.
const SLACK: f64 = 1e-7;

/// Error of an interpolated value, in steps of 2^-24 of its value at the window's origin: two products and three sums are
/// rounded on the way there and back, each by up to one step, and add up by chance to √5 of it.
const ROUNDINGS: f64 = 2.24;

/// Error of a place in a map, in texels: weights have 8 bits, and a caster's edge is snapped to 1/256 of a texel, on both axes.
const PLACE_ERROR: f64 = 0.02;

/// Greatest error of a filtered shade that is allowed for: beyond it nothing could be decided.
const MOST_SHADE_ERROR: f64 = 0.25;

/// No polygon offset.
pub const NO_OFFSET: Offset = Offset { polygon: PolygonOffset { factor: 0.0, units: 0.0 }, texels: 0.0 };

/// A map whose pictures are forecast.
pub struct Map<'a> {
    pub settings: &'a Settings,
    pub offset: Offset,
    pub stored: Stored,
    /// Casters in the map.
    pub casters: &'a [&'a Drawable],
    /// One projector, or a cube's six.
    pub projectors: Vec<Projector>,
}

/// Warns of points that will be wrong.
pub fn warn(view: &LightView<'_>, map: &Map<'_>, notes: &mut Notes) {
    if !view.sampled_warnings {
        return;
    }
    let items = Items::new(view);
    let mut forecast = Forecast::new(view, map, &items);
    let [few, many] = MOST_SAMPLES.map(|most| step(view, most));
    // A map of far sides may be wrong in single pixels where a caster is open: a few samples do not show the rest.
    let starts_with_few = map.settings.cull.is_none() && few > many;
    if starts_with_few {
        forecast.sample(few);
    }
    if !starts_with_few || forecast.is_uncertain() {
        forecast.sample(many);
    }
    told::all(&forecast, notes);
}

/// Pixels from one sample to the next, on each axis.
fn step(view: &LightView<'_>, most: u32) -> u32 {
    let [width, height] = view.scene.image.size;
    (1..).find(|step| width.div_ceil(*step) * height.div_ceil(*step) <= most).unwrap_or(1)
}

/// A point that the picture will show wrong.
struct Wrong {
    /// True if lit by mistake, false if dark by mistake.
    is_lit: bool,
    /// True if wrong by the rounding of depths and the offset's units.
    is_rounded: bool,
    /// True if wrong only within the error of a filtered shade: such a point may be wrong, and a share of them is not.
    is_close: bool,
    /// True if wrong although nothing changes as far as a lookup reaches.
    is_even: bool,
    /// True if lit by mistake before the near plane, where a map has no depths.
    is_before_near: bool,
    /// Item whose shadow is missing, or that is dark: index into the items.
    item: usize,
    /// The width of a texel, in pixels.
    texel_pixels: f64,
    /// Length of one code of depth there, and distance from the light, in world units.
    code: f64,
    distance: f64,
}

/// Surfaces between a point and the light.
struct Way<'p> {
    point: &'p Seen,
    met: Vec<Met>,
    /// Parameters up to this are the point's own place, and from `end` on the light's.
    slack: f64,
    end: f64,
    /// World units for a parameter of 1.
    length: f64,
}

impl Way<'_> {
    /// Surfaces that shadow the point.
    fn blockers(&self) -> impl Iterator<Item = &Met> {
        self.met.iter().filter(|met| !met.is_own && met.t > self.slack && met.t < self.end)
    }

    /// Distance from something met to the point, in world units.
    fn gap(&self, met: &Met) -> f64 {
        met.t * self.length
    }
}

/// Samples of some rows.
#[derive(Default)]
struct Samples {
    reached: u32,
    wrong: Vec<Wrong>,
}

/// Every `step`-th of `size` pixels.
fn middles(step: u32, size: u32) -> impl Iterator<Item = u32> {
    (step / 2..size).step_by(step as usize)
}

struct Forecast<'a> {
    view: &'a LightView<'a>,
    map: &'a Map<'a>,
    items: &'a Items<'a>,
    /// The maps, without texels: each core finds its own.
    texels: Vec<Texels<'a>>,
    /// The items by their places in the picture.
    raster: BoxRaster,
    /// Pixels from sample to sample.
    step: u32,
    /// Samples that face the light, within its reach.
    reached: u32,
    wrong: Vec<Wrong>,
}

impl<'a> Forecast<'a> {
    fn new(view: &'a LightView<'a>, map: &'a Map<'a>, items: &'a Items<'a>) -> Self {
        let texels = |projector: &Projector| Texels::new(items, map, projector.clone());
        let texels = map.projectors.iter().map(texels).collect();
        let raster = items.raster(|point| sighting(view, point));
        Self { view, map, items, texels, raster, step: 1, reached: 0, wrong: Vec::new() }
    }

    /// Tests whether a few samples do not show that all is well.
    fn is_uncertain(&self) -> bool {
        self.reached < FEWEST_PIXELS || !self.wrong.is_empty()
    }

    /// Samples every `step`-th pixel of every `step`-th row, from scratch, on all cores.
    fn sample(&mut self, step: u32) {
        let height = self.view.scene.image.size[1];
        let rows: Vec<u32> = middles(step, height).collect();
        // A few bands a core: rows with many casters take longer.
        let band = rows.len().div_ceil(4 * rayon::current_num_threads()).max(1);
        let samples: Vec<Samples> = rows.par_chunks(band).map(|rows| self.sample_rows(rows, step)).collect();
        self.step = step;
        self.reached = samples.iter().map(|samples| samples.reached).sum();
        self.wrong = samples.into_iter().flat_map(|samples| samples.wrong).collect();
    }

    /// Samples every `step`-th pixel of these rows.
    fn sample_rows(&self, rows: &[u32], step: u32) -> Samples {
        let size = self.view.scene.image.size;
        let world_from_clip = self.view.camera.clip_from_world.inverse();
        let ray = |x: u32, y: u32| {
            let [x, y] =
                [(x, size[0]), (y, size[1])].map(|(at, size)| (2.0 * f64::from(at) + 1.0) / f64::from(size) - 1.0);
            [-1.0, 1.0].map(|z| world_from_clip.project_point3(DVec3::new(x, y, z)))
        };
        let mut texels = self.texels.clone();
        let mut samples = Samples::default();
        for (x, y) in rows.iter().flat_map(|y| middles(step, size[0]).map(move |x| (x, *y))) {
            let [near, far] = ray(x, y);
            let at = self.raster.at_both([near, far], |point| sighting(self.view, point));
            let Some(point) = seen(self.items, at, self.view.scene.camera.eye, near, far - near) else { continue };
            // Points where the rays of the neighbouring pixels meet the same plane.
            let beside = [ray(x + 1, y), ray(x, y + 1)].map(|[near, far]| {
                near + (far - near) * (point.normal.dot(point.point - near) / point.normal.dot(far - near))
            });
            let Some(index) = self.face_of(&point) else { continue };
            samples.reached += 1;
            samples.wrong.extend(self.judge(&point, [x, y], beside, index, &mut texels[index]));
        }
        samples
    }

    /// Index of the map that the light reaches a point by; `None`: it does not reach it, or lies behind its surface.
    fn face_of(&self, point: &Seen) -> Option<usize> {
        // A photograph counts on what has it alone.
        if self.view.photo().is_some_and(|photo| self.items.placed[point.item].item.photo != Some(photo)) {
            return None;
        }
        let index = self.texels.iter().position(|texels| is_in(texels.projector(), point.point))?;
        let is_lit = self.is_in_cone(point.point) && point.normal.dot(to_light(point.point, &self.rays())) > 0.0;
        is_lit.then_some(index)
    }

    /// Says what the picture will show wrong at a point that the light reaches, by map number `index`, whose `texels` are
    /// found where they are needed.
    fn judge(
        &self,
        point: &Seen,
        pixel: [u32; 2],
        beside: [DVec3; 2],
        index: usize,
        texels: &mut Texels<'a>,
    ) -> Option<Wrong> {
        let map = self.map;
        let way = self.way(point, index);
        let receiver = receiver(&self.texels[index], point, beside);
        let is_blocked = way.blockers().next().is_some();
        // The texels are rounded to their format as they are found; f32 may take more, of the stored depth and of the
        // compared one.
        let interpolation = self.interpolation_error(index, point, pixel, beside);
        let rounding = 2.0 * code(DepthFormat::Depth32F) + interpolation;
        // The place in the map is interpolated as the depth is; a filtered shade changes by as much as its weights.
        let shade_error = (PLACE_ERROR + interpolation * f64::from(map.settings.size)).min(MOST_SHADE_ERROR);
        let mut shade = |deeper: f64| lookup::lit(texels, map.settings, map.offset.texels, &receiver, deeper);
        let doubt = if is_blocked { -shade_error } else { shade_error };
        let [outcome, moved] = [0.0, if is_blocked { -rounding } else { rounding }].map(&mut shade);
        let is_lit = |doubt: f64| {
            let outcome = outcome >= 0.5 + doubt;
            if is_blocked { outcome || moved >= 0.5 } else { outcome && moved >= 0.5 }
        };
        let lit = is_lit(doubt);
        if lit != is_blocked {
            return None;
        }
        let is_close = is_lit(0.0) != lit;
        let is_rounded = !is_close && (outcome >= 0.5) != lit;
        let pixel_width = beside.map(|beside| beside.distance(point.point)).into_iter().fold(f64::INFINITY, f64::min);
        let wrong = self.wrong(&way, &receiver, &self.texels[index], lit);
        let texel_pixels = wrong.texel_pixels / pixel_width;
        Some(Wrong { is_rounded: wrong.is_rounded || is_rounded, is_close, texel_pixels, ..wrong })
    }

    /// Error of a point's window depth by interpolation in f32. A rasterizer starts from the value at the window's origin,
    /// which lies the farther off the more steeply the camera sees the surface. Both r and q, each divided by the camera's w,
    /// are rounded there ([`ROUNDINGS`]).
    fn interpolation_error(&self, texels: usize, point: &Seen, pixel: [u32; 2], beside: [DVec3; 2]) -> f64 {
        let camera = &self.view.scene.camera;
        let ahead = (camera.target - camera.eye).normalize_or_zero();
        let texels = &self.texels[texels];
        let is_parallel = matches!(texels.projector().rays, Rays::Along(_));
        let value = |at: DVec3| {
            let light = texels.projector().light_from_world.transform_point3(at);
            if is_parallel { texels.place(light).1 } else { -light.z }
        };
        let w = |at: DVec3| ahead.dot(at - camera.eye);
        let here = value(point.point);
        let steps = beside.map(|beside| (value(beside) / w(beside) - here / w(point.point)).abs());
        let at_origin = f64::from(pixel[0]) * steps[0] + f64::from(pixel[1]) * steps[1];
        // For parallel light only z counts, a depth in [0, 1].
        let relative = if is_parallel { 1.0 } else { 2.0 / here };
        let error = ROUNDINGS * 2.0_f64.powi(-24) * at_origin * w(point.point) * relative;
        if error.is_finite() { error.abs().min(1.0) } else { 1.0 }
    }

    /// Surfaces between a point and the light, on a map that shows it.
    fn way<'p>(&self, point: &'p Seen, texels: usize) -> Way<'p> {
        let slack = self.slack(point);
        // A surface that the light lies in is edge-on to it, and shadows nothing.
        let end = if matches!(self.rays(), Rays::From { .. }) { 1.0 - SLACK } else { f64::INFINITY };
        let length = to_light(point.point, &self.rays()).length();
        let at = self.texels[texels].at(point.point);
        Way { point, met: on_the_way(self.items, point, -slack, &self.rays(), at), slack, end, length }
    }

    /// Reason why a point is wrong, whose pixel is one world unit wide.
    fn wrong(&self, way: &Way<'_>, receiver: &Receiver, texels: &Texels<'_>, lit: bool) -> Wrong {
        let map = self.map;
        let texel = texels.width_at(receiver.point);
        let distance = if matches!(texels.projector().rays, Rays::From { .. }) { -receiver.point.z } else { 1.0 };
        let code = code(map.settings.format) * length_of_depth(texels.projector(), distance);
        // The coarser one of the two levels that are met.
        let coarse = if map.settings.mipmaps == Mipmaps::All { 2.0 * receiver.pixel_texels.max(1.0) } else { 1.0 };
        let is_even = || self.is_even(way, coarse * texel);
        let is_even = match (lit, self.has_far_sides()) {
            (false, _) => is_even(),
            (true, false) => false,
            (true, true) => {
                let far_sides = || way.blockers().filter(|met| met.is_far_side);
                let is_apart = |met: &Met| way.gap(met) > self.taken(way.point, met, texel, code);
                far_sides().next().is_none() || (far_sides().any(is_apart) && is_even())
            }
        };
        let nearest = way.blockers().min_by(|a, b| a.t.total_cmp(&b.t));
        let taken = (2.0 + self.unit_codes() * f64::from(map.offset.polygon.units)) * code;
        Wrong {
            is_lit: lit,
            is_rounded: lit && nearest.is_some_and(|met| way.gap(met) < taken),
            is_even,
            is_close: false,
            is_before_near: lit && texels.place(receiver.point).1 <= 0.0,
            item: nearest.map_or(way.point.item, |met| met.item),
            texel_pixels: texel,
            code,
            distance,
        }
    }

    /// Length that counts as zero at a point, as a share of its way to the light.
    fn slack(&self, point: &Seen) -> f64 {
        let length = match self.rays() {
            Rays::From { position, .. } => position.distance(point.point),
            Rays::Along(_) => 1.0,
        };
        let eye = point.point.distance(self.view.scene.camera.eye);
        SLACK * (point.point.abs().max_element() + eye) / length
    }

    /// Greatest distance before a point of a caster whose shadow bias and slopes remove, along the ray and in world units.
    fn taken(&self, point: &Seen, met: &Met, texel: f64, code: f64) -> f64 {
        let map = self.map;
        let reach = bias::reach_texels(map.settings);
        let factor = f64::from(map.offset.polygon.factor.abs());
        let slope = |normal: DVec3| self.slope(point.point, normal);
        let caster = slope(self.items.placed[met.item].normal(met.triangle));
        let slopes = (factor + reach) * caster + reach * slope(point.normal);
        let units = self.unit_codes() * f64::from(map.offset.polygon.units.abs());
        texel * (slopes + map.offset.texels + 1.0) + (units + 2.0) * code
    }

    /// Slope of a plane along the light's ray for a step across it, both of unit length.
    fn slope(&self, point: DVec3, normal: DVec3) -> f64 {
        let way = to_light(point, &self.rays()).normalize_or_zero();
        let along = normal.dot(way).abs();
        (1.0 - along * along).max(0.0).sqrt() / along.max(1e-6)
    }

    /// Codes that one unit of polygon offset moves a depth by, at most.
    fn unit_codes(&self) -> f64 {
        let format = self.map.settings.format;
        texels::unit(format, 1.0) / code(format)
    }

    fn has_far_sides(&self) -> bool {
        self.map.settings.cull == Some(Face::Front)
    }

    fn rays(&self) -> Rays {
        self.map.projectors.first().map_or(Rays::Along(DVec3::NEG_Y), |projector| projector.rays)
    }

    fn is_in_cone(&self, point: DVec3) -> bool {
        match &self.view.light().kind {
            LightKind::Spot(spot) if spot.shape == LightShape::Cone => {
                let clip = spot.frustum.clip_from_world() * point.extend(1.0);
                clip.truncate().truncate().length() <= clip.w
            }
            _ => true,
        }
    }
}
