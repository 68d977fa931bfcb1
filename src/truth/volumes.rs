//! Number of shadow volumes that hold each visible point: the right stencil count, by rays alone.
//!
//! # What is counted
//! A triangle that counts has a volume: what lies behind it as seen from the light, without end. The count of a point is
//! the number of such triangles that the segment from the light to the point crosses. In a shell (triangles of one
//! object connected across edges) that is closed, looks outwards and does not hold the light, those count that face the
//! light, by the order of their corners; in any other shell all do. A volume knows no near plane of the light and no
//! hole of the alpha test: whole triangles count.
//!
//! # The visible surface itself
//! The point lies on its own triangle (and on all that coincide with it), at the very border of that triangle's volume.
//! The count is that of the space just before the visible side: on the side that the light sees, the own triangle does
//! not count; on the averted side it does, if it counts at all. A stencil agrees: z-fail draws the triangle itself as the
//! volume's cap, by the same arithmetic, so that its depth is equal and fails LESS, a way out of the volume or into it
//! that is counted as lying behind the point; z-pass counts only what passes LESS, strictly before it.

use std::ops::ControlFlow;

use glam::DVec3;
use rayon::prelude::*;

use super::answers::{Answer, Hit, Reason};
use super::beam::{Beam, BeamSide, crossing_once};
use super::primary::SeenPoint;
use super::shells::{CountRule, rules};
use super::slab::Segment;
use super::slivers::Slivers;
use super::world::Triangle;
use super::{Error, Options, Tracer, doubt};
use crate::scene::Scene;

/// The counts for one light. Row 0 is the top of the picture.
#[derive(Clone, Debug)]
pub struct VolumeCounts {
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// `width * height`, row by row from the top.
    pub pixels: Vec<CountPixel>,
}

/// One pixel's count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountPixel {
    /// Count over all places where the sample may lie.
    pub count: Count,
    /// Count of the centre ray alone, also for ambiguous pixels; it is not truth there.
    pub at_center: Option<u32>,
    /// Hit of the centre ray.
    pub hit: Option<Hit>,
}

/// Number of shadow volumes that hold the point behind a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// Nothing is drawn here.
    Background,
    /// This many.
    Exactly(u32),
    /// A sample moved by less than the stated error may count otherwise.
    Ambiguous(Reason),
}

impl VolumeCounts {
    /// Ambiguous over drawn pixels, in [0, 1].
    pub fn ambiguous_share(&self) -> f64 {
        let ambiguous = self.count(|count| matches!(count, Count::Ambiguous(_)));
        if ambiguous == 0 { 0.0 } else { ambiguous as f64 / self.count(|count| count != Count::Background) as f64 }
    }

    /// Number of pixels whose count is `wanted`.
    pub fn count(&self, wanted: impl Fn(Count) -> bool) -> usize {
        self.pixels.iter().filter(|pixel| wanted(pixel.count)).count()
    }
}

/// Counts, for each pixel of the scene's image, the shadow volumes of light number `light` that hold the visible point.
///
/// Besides the doubt of [`super::trace`], the depth buffer's is granted: a volume's side may be compared with a surface
/// as much nearer or farther as 24 bits may misplace both.
pub fn volume_count(scene: &Scene, light: usize, options: &Options) -> Result<VolumeCounts, Error> {
    let tracer = Tracer::new(scene, light, options)?;
    let counting = VolumeCounter::new(scene, &tracer);
    let [width, height] = scene.image.size;
    let places = (0..height).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| (x, y)));
    let pixels = places.map(|(x, y)| counting.pixel(x, y)).collect();
    let counts = VolumeCounts { width, height, pixels };
    let share = counts.ambiguous_share();
    if share > options.most_ambiguous {
        let reasons = Reason::ALL.map(|reason| (reason, counts.count(|count| count == Count::Ambiguous(reason))));
        let some = reasons.iter().filter(|(_, count)| *count > 0);
        return Err(Error::TooAmbiguous {
            percent: 100.0 * share,
            most_percent: 100.0 * options.most_ambiguous,
            reasons: some.map(|(reason, count)| format!("{count} {}", reason.name())).collect::<Vec<_>>().join(", "),
        });
    }
    Ok(counts)
}

/// Number of shadow volumes that hold each of `points` (world space, on no surface); `None` within `error` (world units) of
/// a place with another count.
pub fn volume_count_at(
    scene: &Scene,
    light: usize,
    points: &[DVec3],
    error: f64,
    options: &Options,
) -> Result<Vec<Option<u32>>, Error> {
    let tracer = Tracer::new(scene, light, options)?;
    let counting = VolumeCounter::new(scene, &tracer);
    let count = |point: &DVec3| {
        let tally = counting.along(&counting.beam(*point, [DVec3::ZERO; 2], error), None);
        tally.reason.is_none().then_some(tally.center)
    };
    Ok(points.par_iter().map(count).collect())
}

/// Contribution of one triangle.
struct Share {
    center: u32,
    reason: Option<Reason>,
}

/// Sum over all triangles.
struct Tally {
    center: u32,
    /// Triangles that may count or not: by so much the count may be off, either way.
    doubtful: u32,
    reason: Option<Reason>,
}

pub(super) struct VolumeCounter<'t, 'a> {
    tracer: &'t Tracer<'a>,
    /// Rule of each triangle of each object.
    rules: Vec<Vec<CountRule>>,
    slivers: Slivers,
}

impl<'t, 'a> VolumeCounter<'t, 'a> {
    pub fn new(scene: &Scene, tracer: &'t Tracer<'a>) -> Self {
        let light = tracer.lamp.place();
        let of_object = |(object, placed): (usize, _)| {
            rules(&scene.objects[object], tracer.world.solid(object as u32), placed, light)
        };
        let rules: Vec<Vec<CountRule>> = tracer.world.placed.iter().enumerate().map(of_object).collect();
        Self { tracer, slivers: Slivers::new(tracer, &rules), rules }
    }

    fn pixel(&self, x: u32, y: u32) -> CountPixel {
        let (seen, doubtful_view) = self.tracer.look(x, y);
        let Some(seen) = seen else {
            let count = doubtful_view.map_or(Count::Background, Count::Ambiguous);
            return CountPixel { count, at_center: None, hit: None };
        };
        let tally = self.behind(&seen);
        let reason = doubtful_view.or(tally.reason);
        let count = reason.map_or(Count::Exactly(tally.center), Count::Ambiguous);
        CountPixel { count, at_center: Some(tally.center), hit: Some(self.tracer.describe(&seen)) }
    }

    /// Reason why a stencil count may differ from `answer` at a pixel, although that answer is certain.
    pub fn doubt(&self, x: u32, y: u32, answer: Answer) -> Option<Reason> {
        if !matches!(answer, Answer::Lit | Answer::Shadowed) {
            return None;
        }
        let tally = self.behind(&self.tracer.look(x, y).0?);
        let stays_dark = answer == Answer::Shadowed && tally.center > tally.doubtful;
        tally.reason.filter(|_| !stays_dark)
    }

    /// The count at a visible point, and what a small move of the sample or a depth buffer's error would change.
    fn behind(&self, seen: &SeenPoint<'_>) -> Tally {
        let bits = self.tracer.depth_buffer_bits.unwrap_or(24);
        let error = seen.error + self.tracer.depth_misplacement(seen, bits);
        let mut tally = self.along(&self.beam_of(seen, error), Some(seen));
        if let Some(reason) = self.grazing(seen) {
            tally.doubtful += 1;
            tally.reason = Some(reason);
        }
        let by_slivers = self.slivers.doubtful(self.tracer, seen);
        tally.doubtful += by_slivers;
        doubt(&mut tally.reason, (by_slivers > 0).then_some(Reason::ShadowEdge));
        tally
    }

    /// From the light to what a pixel shows. GL rounds the places of vertices in the picture and leaves their depths: at a
    /// pixel's centre the visible surface has the depth of a place aside, and a volume's side that of another.
    fn beam_of(&self, seen: &SeenPoint<'_>, error: f64) -> Beam {
        let eye = &self.tracer.eye;
        let width = self.tracer.subpixel * eye.depth_of(seen.position - eye.position);
        let slip = [eye.right, eye.up].map(|way| way * width);
        let deeper = [0, 1].map(|k| seen.spread[k] - slip[k]);
        let beam = self.beam(seen.position, deeper, error);
        Beam { surface_spread: seen.spread, slip, ..beam }
    }

    /// From the light to a point that may lie anywhere in `spread` and `error`. Corners are extruded along their own
    /// rays, so that their errors do not grow on the way.
    fn beam(&self, point: DVec3, spread: [DVec3; 2], error: f64) -> Beam {
        Beam {
            apex: self.tracer.lamp.apex(point),
            base: point,
            spread,
            surface_spread: spread,
            slip: [DVec3::ZERO; 2],
            error,
            depth_error: error,
            start: 0.0,
            levers: false,
        }
    }

    /// Tests whether the light may stand in the visible triangle's own plane, and it counts.
    fn grazing(&self, seen: &SeenPoint<'_>) -> Option<Reason> {
        if self.rule(&seen.triangle) == CountRule::Never {
            return None;
        }
        let (height, tilt) = self.tracer.height_of_light(seen);
        (height.abs() <= tilt).then_some(Reason::GrazingLight)
    }

    /// From a point towards the light.
    fn to_light(&self, point: DVec3) -> DVec3 {
        self.tracer.lamp.towards(point)
    }

    fn rule(&self, triangle: &Triangle<'_>) -> CountRule {
        self.rules[triangle.object as usize][triangle.index as usize]
    }

    /// Tests whether the triangle has a volume under this light.
    fn counts(&self, triangle: &Triangle<'_>) -> bool {
        let height = triangle.normal().dot(self.to_light(triangle.corners[0]));
        match self.rule(triangle) {
            CountRule::Never => false,
            CountRule::Facing => (height > 0.0) != triangle.placed.mirrors() && height != 0.0,
            CountRule::All => height != 0.0,
        }
    }

    /// The count at the beam's base.
    fn along(&self, beam: &Beam, seen: Option<&SeenPoint<'_>>) -> Tally {
        let direction = beam.axis();
        let radius = beam.radius(self.tracer.largest_error);
        let segment = Segment { origin: beam.origin(), direction, start: 0.0, end: 1.0 + radius / direction.length() };
        let mut tally = Tally { center: 0, doubtful: 0, reason: None };
        self.tracer.visit(beam, &segment, |triangle| {
            if self.rule(triangle) != CountRule::Never && !triangle.is_degenerate() {
                let share = self.share(beam, seen, triangle);
                tally.center += share.center;
                tally.doubtful += u32::from(share.reason.is_some());
                doubt(&mut tally.reason, share.reason);
            }
            ControlFlow::Continue(())
        });
        tally
    }

    fn share(&self, beam: &Beam, seen: Option<&SeenPoint<'_>>, triangle: &Triangle<'_>) -> Share {
        let error = self.tracer.error_in(beam, triangle);
        let near_edge = self.tracer.passes_any_edge(beam, triangle, error);
        let is_fold = near_edge && self.tracer.folds_inside(beam, triangle, error);
        let fold = is_fold.then_some(Reason::ShadowEdge);
        let counts = self.counts(triangle);
        if let Some(seen) = seen.filter(|seen| seen.triangle.coincides(triangle)) {
            // Its own surface: the space before the visible side is in its volume if that side is averted.
            let is_averted = seen.normal.dot(self.to_light(seen.position)) < 0.0;
            return Share { center: u32::from(counts && is_averted), reason: fold };
        }
        let Some(meeting) = beam.meet(&triangle.corners, error) else {
            return Share { center: 0, reason: None };
        };
        if !(meeting.surely_inside || near_edge || meeting.center.is_some()) {
            return Share { center: 0, reason: None };
        }
        let own = seen.is_some_and(|seen| seen.triangle.continues_in(triangle)) && meeting.at_base == BeamSide::Near;
        let at_base = meeting.at_base == BeamSide::Near && counts && !own;
        let crossed = crossing_once(beam.origin(), beam.axis(), &triangle.corners);
        let is_crossed = crossed.is_some_and(|at| 0.0 < at && at < 1.0);
        Share {
            center: u32::from(is_crossed && counts && (is_fold || !own)),
            reason: fold.or(at_base.then_some(Reason::Contact)),
        }
    }
}
