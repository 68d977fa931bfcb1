//! The surface that the camera sees through a pixel's centre, and whether it would see the same a sub-pixel aside.

use std::ops::ControlFlow;

use glam::DVec3;

use super::answers::Reason;
use super::beam::{Apex, Beam, BeamSide};
use super::slab::Segment;
use super::world::Triangle;
use super::{ENOUGH, Tracer, doubt};

/// The surface point behind a pixel.
pub(super) struct SeenPoint<'w> {
    pub triangle: Triangle<'w>,
    pub position: DVec3,
    /// Unit normal on the camera's side.
    pub normal: DVec3,
    /// Movement of the point on the surface with the sample, one vector for each direction.
    pub spread: [DVec3; 2],
    /// Radius of the ball that the point may lie in besides.
    pub error: f64,
    /// True if the sample may land on a neighbouring triangle of the surface, whose normal may be another.
    pub is_at_edge: bool,
}

impl Tracer<'_> {
    /// The nearest surface between the near and the far plane, and what makes it doubtful.
    pub fn look(&self, x: u32, y: u32) -> (Option<SeenPoint<'_>>, Option<Reason>) {
        let (origin, direction) = (self.eye.position, self.eye.direction(x, y));
        let ray = Segment { origin, direction, start: self.eye.near, end: self.eye.far };
        let Some((triangle, depth)) = self.world.nearest(&ray) else {
            let (reason, _) = self.search(&self.view_beam(direction, self.eye.far, [DVec3::ZERO; 2], 0.0), None);
            return (None, reason);
        };
        let position = origin + depth * direction;
        let normal = triangle.normal();
        let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
        let error = self.position_error(&triangle, position);
        let spread = self.footprint(direction, depth, normal);
        let known = spread.unwrap_or([DVec3::ZERO; 2]);
        let (reason, widened) = self.search(&self.view_beam(direction, depth, known, error), Some(&triangle));
        let reason = if spread.is_none() { Some(Reason::GrazingView) } else { reason };
        (
            Some(SeenPoint {
                triangle,
                position,
                normal,
                spread: known,
                error: error + widened,
                is_at_edge: widened > 0.0,
            }),
            reason,
        )
    }

    fn view_beam(&self, direction: DVec3, depth: f64, surface_spread: [DVec3; 2], error: f64) -> Beam {
        let rise = surface_spread.iter().map(|&way| self.eye.depth_of(way).abs()).sum::<f64>() / self.subpixel;
        Beam {
            apex: Apex::At(self.eye.position),
            base: self.eye.position + depth * direction,
            spread: [self.eye.right, self.eye.up].map(|way| way * self.subpixel * depth),
            surface_spread,
            slip: [DVec3::ZERO; 2],
            error,
            depth_error: error + self.eye.depth_error(depth, rise),
            start: self.eye.near / depth,
            levers: true,
        }
    }

    /// Movement of the point in the surface's plane when the sample moves by one sub-pixel to the right and up, made longer
    /// so that it holds for both moves at once. `None`: the plane is seen so nearly edge-on that half of the ray's slope is
    /// lost.
    fn footprint(&self, direction: DVec3, depth: f64, normal: DVec3) -> Option<[DVec3; 2]> {
        let slope = normal.dot(direction);
        let moves = [self.eye.right, self.eye.up].map(|way| way * self.subpixel);
        let lost = moves.iter().map(|way| normal.dot(*way).abs()).sum::<f64>() / slope.abs();
        if lost.is_nan() || lost >= 0.5 {
            return None;
        }
        Some(moves.map(|way| (way - direction * (normal.dot(way) / slope)) * (depth / (1.0 - lost))))
    }

    /// Looks for what a small move would change: reasons for doubt, and how much farther the point may move because
    /// connected triangles with other slopes lie within the beam.
    fn search(&self, beam: &Beam, hit: Option<&Triangle<'_>>) -> (Option<Reason>, f64) {
        let (mut reason, mut widened, mut looked_at) = (None, 0.0f64, 0);
        let axis = beam.axis();
        // The longest way that anything may lie behind the base and still matter.
        let behind = beam.surface_spread.iter().map(|way| way.length()).sum::<f64>() + beam.depth_error;
        let end = 1.0 + (behind + self.largest_error) / axis.length();
        let segment = Segment { origin: beam.origin(), direction: axis, start: beam.start, end };
        self.visit(beam, &segment, |triangle| {
            let found = self.judge_view(beam, hit, triangle, &mut widened);
            doubt(&mut reason, found);
            looked_at += 1;
            if reason.is_some() && looked_at > ENOUGH { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        (reason, widened)
    }

    fn judge_view(
        &self,
        beam: &Beam,
        hit: Option<&Triangle<'_>>,
        triangle: &Triangle<'_>,
        widened: &mut f64,
    ) -> Option<Reason> {
        let is_hit = hit.is_some_and(|hit| hit.is(triangle));
        let error = self.error_in(beam, triangle);
        if triangle.is_degenerate() {
            return None;
        }
        let meeting = beam.meet(&triangle.corners, error)?;
        let near_edge = !meeting.surely_inside && self.passes_any_edge(beam, triangle, error);
        if !(meeting.surely_inside || near_edge || meeting.center.is_some()) {
            return None;
        }
        if triangle.has_cutout() && meeting.at_base != BeamSide::Beyond && meeting.at_start != BeamSide::Before {
            let alpha = self.alpha_in(beam, triangle);
            if alpha.surely_clear() {
                return None;
            }
            if !alpha.surely_opaque() {
                return Some(Reason::AlphaTest);
            }
        }
        if near_edge && self.folds_inside(beam, triangle, error) {
            return Some(Reason::Silhouette);
        }
        if meeting.at_start == BeamSide::Near {
            return Some(Reason::ClipPlane);
        }
        if is_hit || meeting.at_base == BeamSide::Beyond || meeting.at_start == BeamSide::Before {
            return None;
        }
        match hit {
            None => Some(Reason::ClipPlane),
            Some(hit) if !hit.touches(triangle) => Some(Reason::DepthTie),
            Some(_) => self.widen(beam, triangle, widened),
        }
    }

    /// The sample may land on this triangle instead: then its point moves as this plane lets it.
    fn widen(&self, beam: &Beam, triangle: &Triangle<'_>, widened: &mut f64) -> Option<Reason> {
        let axis = beam.axis();
        let depth = self.eye.depth_of(axis);
        let normal = triangle.normal();
        let at = normal.dot(triangle.corners[0] - beam.origin()) / normal.dot(axis);
        let Some(spread) = self.footprint(axis / depth, depth * at, normal) else {
            return Some(Reason::GrazingView);
        };
        let [a, b] = [0, 1].map(|k| (spread[k] - beam.surface_spread[k]).length());
        *widened = widened.max(a + b + (at - 1.0).abs() * axis.length());
        None
    }
}
