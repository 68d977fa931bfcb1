//! A map's lookup as the lit pass makes it, in f64: bias, kernel, filter, levels.

use glam::{DVec2, DVec3};

use super::texels::Texels;
use crate::lights::projector::Rays;
use crate::pass::Filter;
use crate::techniques::shadow_map::bias;
use crate::techniques::shadow_map::settings::{Bias, Mipmaps, Settings};

/// A point that is compared with the map.
pub struct Receiver {
    /// Point in light space.
    pub point: DVec3,
    /// Unit length, towards the eye, in light space.
    pub normal: DVec3,
    /// The longer side of a pixel on the surface, as the map sees it, in texels of level 0.
    pub pixel_texels: f64,
}

/// Share of the comparisons that find light, with the reference `deeper` by so much window depth.
pub fn lit(texels: &mut Texels<'_>, settings: &Settings, moved_texels: f64, receiver: &Receiver, deeper: f64) -> f64 {
    let mut lookup = Lookup::new(texels, settings, moved_texels, receiver);
    lookup.depth += deeper;
    match settings.mipmaps {
        Mipmaps::None => lookup.kernel(0),
        Mipmaps::EightTaps => 0.5 * (lookup.kernel(0) + lookup.kernel(1)),
        Mipmaps::All => {
            let most = f64::from(bias::levels(settings) - 1);
            let level = receiver.pixel_texels.max(1.0).log2().min(most);
            let (low, share) = (level.floor(), level.fract());
            let finer = lookup.kernel(low as u32);
            if share == 0.0 { finer } else { finer + share * (lookup.kernel(low as u32 + 1) - finer) }
        }
    }
}

struct Lookup<'l, 'a> {
    texels: &'l mut Texels<'a>,
    settings: &'l Settings,
    /// Place in texels of level 0.
    at: DVec2,
    /// The reference: a window depth.
    depth: f64,
    /// Increase of the receiver's depth by a texel of level 0, along each axis.
    slope: DVec2,
    is_parallel: bool,
}

impl<'l, 'a> Lookup<'l, 'a> {
    fn new(texels: &'l mut Texels<'a>, settings: &'l Settings, moved_texels: f64, receiver: &Receiver) -> Self {
        let is_parallel = matches!(texels.projector().rays, Rays::Along(_));
        let width = moved_texels * bias::texel_at_one(texels.projector(), settings);
        let mut point = match is_parallel {
            true => receiver.point + DVec3::Z * width,
            false => receiver.point / (1.0 + bias::growth(width)),
        };
        let slope = if settings.bias == Bias::Offset { DVec2::ZERO } else { slope(texels, point, receiver.normal) };
        if settings.bias == Bias::NormalOffset {
            point += normal_offset(texels, settings, point, receiver.normal) * receiver.normal;
        }
        let (at, depth) = texels.place(point);
        Self { texels, settings, at, depth, slope, is_parallel }
    }

    /// All taps of one level.
    fn kernel(&mut self, level: u32) -> f64 {
        let kernel = self.settings.kernel;
        let first = 0.5 * (1.0 - f64::from(kernel));
        let scale = f64::from(self.texels.size(level)) / f64::from(self.texels.size(0));
        let here = self.at * scale;
        let mut lit = 0.0;
        for (x, y) in (0..kernel).flat_map(|y| (0..kernel).map(move |x| (x, y))) {
            let step = DVec2::new(f64::from(x), f64::from(y)) + first;
            lit += self.tap(level, here, step);
        }
        lit / f64::from(kernel * kernel)
    }

    fn tap(&mut self, level: u32, here: DVec2, step: DVec2) -> f64 {
        let place = here + step;
        let reference = match self.settings.bias {
            Bias::Offset | Bias::NormalOffset | Bias::Adaptive => self.depth,
            Bias::ReceiverPlane => {
                let reach = bias::filter_reach(self.settings) * (self.slope.x.abs() + self.slope.y.abs());
                self.depth + self.slope.dot(step).min(0.0) - reach
            }
        };
        if self.settings.filter == Filter::Nearest {
            return self.compare(level, here, place.floor(), reference);
        }
        let corner = (place - 0.5).floor();
        let part = place - 0.5 - corner;
        let mut lit = 0.0;
        for (step, weight) in [
            (DVec2::ZERO, (1.0 - part.x) * (1.0 - part.y)),
            (DVec2::X, part.x * (1.0 - part.y)),
            (DVec2::Y, (1.0 - part.x) * part.y),
            (DVec2::ONE, part.x * part.y),
        ] {
            if weight > 0.0 {
                lit += weight * self.compare(level, here, corner + step, reference);
            }
        }
        lit
    }

    /// One comparison: 1 is light, 0 shadow.
    fn compare(&mut self, level: u32, here: DVec2, texel: DVec2, reference: f64) -> f64 {
        let last = f64::from(self.texels.size(level) - 1);
        if self.is_parallel && (texel.min_element() < 0.0 || texel.max_element() > last) {
            return 1.0;
        }
        let texel = texel.clamp(DVec2::ZERO, DVec2::splat(last));
        let reference = match self.settings.bias {
            Bias::Adaptive => reference + self.slope.dot(texel + 0.5 - here).min(0.0),
            Bias::Offset | Bias::NormalOffset | Bias::ReceiverPlane => reference,
        };
        let stored = self.texels.depth(level, [texel.x as u32, texel.y as u32]);
        if reference.clamp(0.0, 1.0) <= stored { 1.0 } else { 0.0 }
    }
}

/// Movement of a point along its normal by `normal_offset.frag`, in world units.
fn normal_offset(texels: &Texels<'_>, settings: &Settings, point: DVec3, normal: DVec3) -> f64 {
    let reach = bias::reach_texels(settings) * bias::texel_sides_at_one(texels.projector(), settings);
    let reach = reach.dot(normal.truncate().abs());
    match texels.projector().rays {
        Rays::Along(_) => reach,
        Rays::From { .. } => reach / (1.0 + reach * normal.z).max(0.5) * -point.z,
    }
}

/// Increase of a plane's window depth by a texel of level 0, along each axis of the map.
fn slope(texels: &Texels<'_>, point: DVec3, normal: DVec3) -> DVec2 {
    // Two steps along the plane: a projection maps planes to planes, so that any two will do.
    let [right, up] = [normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector())];
    let length = texels.width_at(point);
    let (here, depth) = texels.place(point);
    let [(a, da), (b, db)] = [right, up].map(|way| {
        let (at, deeper) = texels.place(point + length * way);
        (at - here, deeper - depth)
    });
    let area = a.perp_dot(b);
    if area == 0.0 { DVec2::ZERO } else { DVec2::new(da * b.y - db * a.y, a.x * db - b.x * da) / area }
}
