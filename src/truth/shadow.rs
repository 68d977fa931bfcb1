//! Tests whether light reaches a seen point, and whether all points that the sample may mean agree.

use std::ops::ControlFlow;

use glam::DVec3;

use super::answers::Reason;
use super::beam::{Beam, BeamSide, Meeting};
use super::primary::SeenPoint;
use super::slab::Segment;
use super::tube::Tube;
use super::world::Triangle;
use super::{ENOUGH, Tracer, doubt};

/// Effect of one triangle on a shadow ray.
enum TriangleVerdict {
    /// It stops the whole beam.
    Blocks,
    /// It stops the centre ray (or not), for the stated reason perhaps not the rest.
    Perhaps {
        center: bool,
        reason: Option<Reason>,
    },
    Passes,
}

impl Tracer<'_> {
    /// Tests whether the light reaches the centre point, and what makes that doubtful. Of a point that `is_sure` denies, for the
    /// answer is doubtful anyway, only the first.
    pub fn light_reaches(&self, seen: &SeenPoint<'_>, is_sure: bool) -> (bool, Option<Reason>) {
        let (height, tilt) = self.height_of_light(seen);
        let mut reason = (height.abs() <= tilt).then_some(Reason::GrazingLight);
        let beam = self.shadow_beam(seen);
        let (is_clear, found) =
            if is_sure { self.trace_to_light(&beam, seen) } else { (self.is_clear_at_center(&beam, seen), None) };
        // If the light is behind the visible side, the surface itself blocks it.
        let lit = is_clear && !(height < 0.0 && seen.triangle.placed.casts_shadow);
        doubt(&mut reason, found);
        // A point that something else surely shades is dark, whichever way its surface is turned.
        let reason = if !is_clear && found.is_none() { None } else { reason };
        (lit, reason)
    }

    /// Height of the light over the visible surface, times its distance if that is finite; and the error of that.
    pub fn height_of_light(&self, seen: &SeenPoint<'_>) -> (f64, f64) {
        let to_light = self.lamp.towards(seen.position);
        // A corner's error tilts the plane by error over the triangle's least height; a light that has a place is seen
        // from a point that is off, too.
        let moved = if self.lamp.place().is_some() { 2.0 } else { 0.0 };
        let tilt = seen.error * (moved + to_light.length() / seen.triangle.least_height());
        (seen.normal.dot(to_light), tilt)
    }

    pub(super) fn shadow_beam(&self, seen: &SeenPoint<'_>) -> Beam {
        Beam {
            apex: self.lamp.apex(seen.position),
            base: seen.position,
            spread: seen.spread,
            surface_spread: seen.spread,
            slip: [DVec3::ZERO; 2],
            error: seen.error,
            depth_error: seen.error,
            start: 0.0,
            levers: true,
        }
    }

    fn trace_to_light(&self, beam: &Beam, seen: &SeenPoint<'_>) -> (bool, Option<Reason>) {
        let direction = beam.axis();
        let radius = beam.radius(self.largest_error);
        let segment =
            Segment { origin: beam.origin(), direction, start: beam.start, end: 1.0 + radius / direction.length() };
        let (mut lit, mut reason, mut looked_at) = (true, None, 0);
        self.visit(beam, &segment, |triangle| {
            match self.judge_shadow(beam, seen, triangle) {
                TriangleVerdict::Blocks => {
                    (lit, reason) = (false, None);
                    return ControlFlow::Break(());
                }
                TriangleVerdict::Perhaps { center, reason: found } => {
                    lit &= !center;
                    doubt(&mut reason, found);
                }
                TriangleVerdict::Passes => {}
            }
            looked_at += 1;
            if reason.is_some() && looked_at > ENOUGH { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let is_cut_short = reason.is_some() && looked_at > ENOUGH;
        if is_cut_short { (self.is_clear_at_center(beam, seen), reason) } else { (lit, reason) }
    }

    /// Tests whether nothing blocks the beam's middle.
    pub(super) fn is_clear_at_center(&self, beam: &Beam, seen: &SeenPoint<'_>) -> bool {
        let segment = Segment { origin: beam.origin(), direction: beam.axis(), start: beam.start, end: 1.0 };
        let mut is_clear = true;
        self.world.visit(
            &segment,
            Tube::LINE,
            0.0,
            |_| 0.0,
            |triangle| {
                is_clear = matches!(
                    self.judge_shadow(beam, seen, triangle),
                    TriangleVerdict::Passes | TriangleVerdict::Perhaps { center: false, .. }
                );
                if is_clear { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            },
        );
        is_clear
    }

    fn judge_shadow(&self, beam: &Beam, seen: &SeenPoint<'_>, triangle: &Triangle<'_>) -> TriangleVerdict {
        if !triangle.placed.casts_shadow || triangle.is(&seen.triangle) || triangle.is_degenerate() {
            return TriangleVerdict::Passes;
        }
        let error = self.error_in(beam, triangle);
        let Some(meeting) = beam.meet(&triangle.corners, error) else { return TriangleVerdict::Passes };
        let near_edge = !meeting.surely_inside && self.passes_any_edge(beam, triangle, error);
        if !(meeting.surely_inside || near_edge || meeting.center.is_some()) {
            return TriangleVerdict::Passes;
        }
        let alpha = self.alpha_in(beam, triangle);
        if alpha.surely_clear() {
            return TriangleVerdict::Passes;
        }
        let is_between = meeting.at_base == BeamSide::Before && meeting.at_start == BeamSide::Beyond;
        if meeting.surely_inside && is_between && alpha.surely_opaque() {
            return TriangleVerdict::Blocks;
        }
        let is_fold = near_edge && self.folds_inside(beam, triangle, error);
        let reason = if is_fold {
            Some(Reason::ShadowEdge)
        } else {
            self.doubt_depth(&meeting, seen, triangle)
                .or((!alpha.surely_opaque() && meeting.at_base != BeamSide::Beyond).then_some(Reason::AlphaTest))
        };
        let own = !is_fold && meeting.at_base == BeamSide::Near && seen.triangle.touches(triangle);
        let is_crossed = meeting.center.is_some_and(|at| beam.start < at && at < 1.0);
        TriangleVerdict::Perhaps { center: is_crossed && !own && alpha.passes_test(), reason }
    }

    /// Tests whether the triangle may cut the beam off at one of its ends: at the light, to which it may be arbitrarily
    /// near; within the error of both, it may be on either side. A triangle that shares a corner with the visible one is
    /// the same surface: within the error of the point, and without a fold between, it cannot be in the way.
    fn doubt_depth(&self, meeting: &Meeting, seen: &SeenPoint<'_>, triangle: &Triangle<'_>) -> Option<Reason> {
        match (meeting.at_base, meeting.at_start) {
            (BeamSide::Near, _) if !seen.triangle.touches(triangle) => Some(Reason::Contact),
            (BeamSide::Before | BeamSide::Near, BeamSide::Near) => Some(Reason::Contact),
            _ => None,
        }
    }
}
