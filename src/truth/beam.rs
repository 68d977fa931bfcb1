//! A beam: every segment from a fixed apex (the eye or the light) to the points that a sample may mean. Which
//! triangles stop all of it, none of it, or perhaps a part. An apex at infinity makes the segments parallel: they come
//! from beyond the whole scene, and where a formula would divide by the distance to the apex its limit stands.
//!
//! The base is a parallelogram `base ± spread[0] ± spread[1]` grown by a ball of radius `error`; corners of other triangles
//! may be off by `error` of their own. As the base point moves, the number of times that its segment crosses the scene's
//! surfaces changes only where the segment sweeps over an open edge or a fold as seen from the apex, or where the base
//! itself (or the near end) passes through a surface. So it is enough to look for those events inside the beam: without
//! one, the centre ray's answer holds for all.

use glam::DVec3;

use super::tube::Tube;

/// Crossing of a line and a triangle, if there is one.
///
/// Watertight [Woop 2013], in f64: corners relative to the origin are sheared so that the ray is the z axis; each edge's
/// sign is then computed from that edge's two corners alone, and two triangles that share it get exactly opposite signs.
/// Zero counts as inside for both. Returns t with the crossing at `origin + t * direction`; negative behind the origin.
pub(super) fn crossing(origin: DVec3, direction: DVec3, corners: &[DVec3; 3]) -> Option<f64> {
    let [a, b, c] = sheared(origin, direction, corners);
    let edge = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
    let (u, v, w) = (edge(b, c), edge(c, a), edge(a, b));
    let is_inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    let area = u + v + w;
    if !is_inside || area == 0.0 {
        return None;
    }
    Some((u * a[2] + v * b[2] + w * c[2]) / area)
}

/// The corners as the ray sees them: it is the third axis, and its parameter the third coordinate.
fn sheared(origin: DVec3, direction: DVec3, corners: &[DVec3; 3]) -> [[f64; 3]; 3] {
    let size = direction.abs();
    let z = if size.x >= size.y && size.x >= size.z { 0 } else { usize::from(size.z > size.y) + 1 };
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    let (shear_x, shear_y) = (direction[x] / direction[z], direction[y] / direction[z]);
    corners.map(|corner| {
        let local = corner - origin;
        [local[x] - shear_x * local[z], local[y] - shear_y * local[z], local[z] / direction[z]]
    })
}

/// Crossing of a segment's line and a triangle, counted once if it passes an edge or a corner that several triangles share:
/// as [`crossing`], for a line moved aside by next to nothing.
pub(super) fn crossing_once(origin: DVec3, direction: DVec3, corners: &[DVec3; 3]) -> Option<f64> {
    let [a, b, c] = sheared(origin, direction, corners);
    // Zero is decided by the edge's own way, which the neighbour sees reversed: (dx, dy) aside by (e, e^2) with e > 0.
    let edge = |p: [f64; 3], q: [f64; 3]| {
        let value = p[0] * q[1] - p[1] * q[0];
        let tie = if q[1] == p[1] { p[0] - q[0] } else { q[1] - p[1] };
        (value, if value == 0.0 { tie } else { value })
    };
    let weights = [edge(b, c), edge(c, a), edge(a, b)];
    let is_inside = weights.iter().all(|(_, side)| *side > 0.0) || weights.iter().all(|(_, side)| *side < 0.0);
    let [u, v, w] = weights.map(|(value, _)| value);
    let area = u + v + w;
    (is_inside && area != 0.0).then(|| (u * a[2] + v * b[2] + w * c[2]) / area)
}

/// Origin of a beam's segments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Apex {
    At(DVec3),
    /// Infinitely far away. `travel`: along the segments to the base, of unit length; `length`: their piece before any
    /// base that may have something in its way.
    Infinity {
        travel: DVec3,
        length: f64,
    },
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    pub apex: Apex,
    pub base: DVec3,
    /// Movement of the base, one vector for each direction of the sample.
    pub spread: [DVec3; 2],
    /// Movement of the base on its own surface: equal to `spread` for shadow rays; for primary rays the spread lies in the
    /// image plane and this on the surface seen.
    pub surface_spread: [DVec3; 2],
    /// Displacement of a surface that the beam meets, one vector for each direction, for the sides of shadow volumes: they
    /// are drawn as the visible surface is, and each is rounded for itself. Zero for rays.
    pub slip: [DVec3; 2],
    /// Radius of the ball around each base point.
    pub error: f64,
    /// The same error against surfaces that may lie at the base's own depth; not below `error`.
    pub depth_error: f64,
    /// The fraction of the way from apex to base before which nothing counts; in [0, 1). 0 for parallel beams.
    pub start: f64,
    /// True if a corner's error turns the rays past it, so that it grows with the distance from the apex. Shadow volumes
    /// move each corner along its own ray: there it does not.
    pub levers: bool,
}

/// Three answers: yes, no, or within the error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BeamSide {
    Before,
    Near,
    Beyond,
}

/// Meeting of a beam and a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// The fraction at which the centre segment's line crosses the triangle; `None` where it misses it.
    pub center: Option<f64>,
    /// True if all of the beam's lines pass within all three edges.
    pub surely_inside: bool,
    /// The crossing against the base.
    pub at_base: BeamSide,
    /// The crossing against the start.
    pub at_start: BeamSide,
}

impl Beam {
    /// The largest distance from the centre segment that belongs to the beam, for corners off by `error`.
    pub fn radius(&self, error: f64) -> f64 {
        let moves = self.spread.iter().chain(&self.slip).map(|way| way.length());
        moves.sum::<f64>() + self.error + error
    }

    /// Space that the beam fills if all corners are in their places.
    pub fn tube(&self) -> Tube {
        Tube { radius: self.radius(0.0), tapers: matches!(self.apex, Apex::At(_)) }
    }

    /// Start of the centre segment.
    pub fn origin(&self) -> DVec3 {
        match self.apex {
            Apex::At(apex) => apex,
            Apex::Infinity { travel, length } => self.base - length * travel,
        }
    }

    /// The centre segment, from its origin to the base.
    pub fn axis(&self) -> DVec3 {
        match self.apex {
            Apex::At(apex) => self.base - apex,
            Apex::Infinity { travel, length } => length * travel,
        }
    }

    /// Along the segment that ends in `base`, of any length.
    pub fn way_to(&self, base: DVec3) -> DVec3 {
        match self.apex {
            Apex::At(apex) => base - apex,
            Apex::Infinity { travel, .. } => travel,
        }
    }

    /// The plane of all segments that meet the edge: its normal, of the length that the edge has as seen from the apex
    /// (times its distance, where that is finite), and one of its points.
    fn plane_through(&self, from: DVec3, to: DVec3) -> (DVec3, DVec3) {
        match self.apex {
            Apex::At(apex) => ((from - apex).cross(to - apex), apex),
            Apex::Infinity { travel, .. } => ((to - from).cross(travel), from),
        }
    }

    /// Width of the beam at its base over that at a fraction of the way.
    fn taper(&self, fraction: f64) -> f64 {
        if let Apex::At(_) = self.apex { fraction } else { 1.0 }
    }

    /// Movement of a corner's image on the beam's base, over the corner's error.
    fn lever(&self, corners: &[DVec3; 3]) -> f64 {
        let (Apex::At(apex), true) = (self.apex, self.levers) else { return 1.0 };
        let axis = self.base - apex;
        // The nearest corner has the longest lever; behind the apex there is none.
        let along = corners.map(|corner| (corner - apex).dot(axis));
        let least = along.into_iter().fold(f64::MAX, f64::min) / axis.length_squared();
        if least > 0.0 { least.recip() } else { f64::INFINITY }
    }

    /// Distance of the base from the apex, over that of the nearest corner or edge of a triangle; infinite if the apex may
    /// lie in the triangle. 1 where there is no apex.
    fn turn(&self, corners: &[DVec3; 3]) -> f64 {
        let (Apex::At(apex), true) = (self.apex, self.levers) else { return 1.0 };
        let edges = || (0..3).map(|k| (corners[k], corners[(k + 1) % 3]));
        let away = edges().map(|(from, to)| {
            let along = ((apex - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
            apex.distance(from + along * (to - from))
        });
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let is_over = edges().all(|(from, to)| (to - from).cross(apex - from).dot(normal) >= 0.0);
        let nearest = if is_over { 0.0 } else { away.fold(f64::INFINITY, f64::min) };
        if nearest > 0.0 { self.axis().length() / nearest } else { f64::INFINITY }
    }

    /// `None`: no line of the beam meets the triangle within its edges.
    pub fn meet(&self, corners: &[DVec3; 3], error: f64) -> Option<Meeting> {
        let error_at_base = error * self.lever(corners);
        let mut surely_inside = true;
        for k in 0..3 {
            match self.beside(corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3], [error, error_at_base]) {
                BeamSide::Before => return None,
                BeamSide::Near => surely_inside = false,
                BeamSide::Beyond => {}
            }
        }
        let center = crossing(self.origin(), self.axis(), corners);
        let (at_base, at_start) = self.depth(corners, error);
        Some(Meeting { center, surely_inside, at_base, at_start })
    }

    /// Side of the plane through apex and edge on which the whole base lies: `Beyond`: on the third corner's.
    ///
    /// Where the third corner lies in that plane within its error, the triangle is seen edge-on: what lies beside the plane,
    /// on either side, misses it. Beside is farther than the plane turns about the apex when the triangle moves by its error:
    /// next to the apex that is all around it.
    fn beside(&self, from: DVec3, to: DVec3, third: DVec3, [error, error_at_base]: [f64; 2]) -> BeamSide {
        let (normal, on_plane) = self.plane_through(from, to);
        let normal = normal.normalize_or_zero();
        let inward = normal.dot(third - on_plane);
        // A corner that moves along its own ray stays on its side.
        let is_edge_on = if self.levers { inward.abs() <= error } else { inward == 0.0 };
        let corners_error =
            if is_edge_on { 2.0 * error_at_base.max(error * self.turn(&[from, to, third])) } else { error_at_base };
        let slack = self.moved_along(normal) + self.error + corners_error;
        let value = normal.dot(self.base - on_plane) * inward.signum();
        if !slack.is_finite() || normal == DVec3::ZERO || value.abs() <= slack {
            BeamSide::Near
        } else if value > 0.0 && !is_edge_on {
            BeamSide::Beyond
        } else {
            BeamSide::Before
        }
    }

    /// The part of a triangle that lies in the beam's parallelogram as the apex sees it, without any error: a convex polygon, of
    /// no corners where there is none.
    pub fn clip(&self, corners: &[DVec3; 3]) -> Vec<DVec3> {
        let [a, b] = self.spread;
        [(a, b), (-a, b), (b, a), (-b, a)].into_iter().fold(corners.to_vec(), |polygon, (aside, along)| {
            let side = self.base + aside;
            let normal = self.way_to(side).cross(along);
            cut(&polygon, normal * -normal.dot(aside).signum(), side)
        })
    }

    /// The part of a convex polygon that a triangle covers, or that covers it, as the apex sees both.
    pub fn overlap(&self, polygon: Vec<DVec3>, corners: &[DVec3; 3]) -> Vec<DVec3> {
        (0..3).fold(polygon, |polygon, k| {
            let [from, to, third] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
            let (normal, on_plane) = self.plane_through(from, to);
            let inward = normal.dot(third - on_plane);
            if inward == 0.0 { Vec::new() } else { cut(&polygon, normal * inward.signum(), on_plane) }
        })
    }

    /// Relative movement of base and surface.
    fn moved_along(&self, normal: DVec3) -> f64 {
        self.reach_along(normal, &self.spread) + self.reach_along(normal, &self.slip)
    }

    fn reach_along(&self, normal: DVec3, spread: &[DVec3; 2]) -> f64 {
        normal.dot(spread[0]).abs() + normal.dot(spread[1]).abs()
    }

    /// The triangle's plane against both ends. Where the crossing lies inside the triangle, its plane is off by no more
    /// than its corners are, so that no lever enters.
    fn depth(&self, corners: &[DVec3; 3], error: f64) -> (BeamSide, BeamSide) {
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        // On which side of the plane the apex is; 0: in it.
        let apex_side = match self.apex {
            Apex::At(apex) => normal.dot(apex - a),
            Apex::Infinity { travel, .. } => -normal.dot(travel),
        };
        let side = |value: f64, slack: f64| {
            let signed = value * apex_side.signum();
            if apex_side == 0.0 || value.abs() <= slack {
                BeamSide::Near
            } else if signed > 0.0 {
                // The end lies on the apex's side: the plane is farther away than this end.
                BeamSide::Beyond
            } else {
                BeamSide::Before
            }
        };
        let moved = self.moved_along(normal).max(self.reach_along(normal, &self.surface_spread));
        let at_base = side(normal.dot(self.base - a), moved + self.depth_error + 2.0 * error);
        let Apex::At(apex) = self.apex else { return (at_base, BeamSide::Beyond) };
        let start = apex + self.start * (self.base - apex);
        let at_start = side(normal.dot(start - a), self.start * (moved + self.error) + 2.0 * error);
        (at_base, at_start)
    }

    /// Tests whether the edge is so near that a segment of the beam may sweep over it before its base.
    pub fn passes_edge(&self, from: DVec3, to: DVec3, error: f64) -> bool {
        let axis = self.axis();
        let longer = (self.surface_spread[0].length() + self.surface_spread[1].length()) / axis.length();
        let (fraction, distance) = closest(self.origin(), axis, self.start, 1.0 + longer, from, to);
        // The taper between here and the true closest point of the cone is of second order; 1 % holds it.
        let taper = self.taper(fraction);
        let error = if self.levers { error } else { taper * error };
        let width = taper * self.radius(0.0) * 1.01 + error;
        if distance > width {
            return false;
        }
        let (normal, on_plane) = self.plane_through(from, to);
        let normal = normal.normalize_or_zero();
        let slack = taper * (self.moved_along(normal) + self.error) * 1.01 + error;
        normal.dot(self.base - on_plane).abs() * taper <= slack
    }

    /// Tests whether the surface ends or folds over at this edge as seen from the apex: `across` is the far corner of the
    /// triangle on the other side, `third` that of this one. An edge that is too short to decide counts as a fold.
    pub fn is_fold(&self, edge: [DVec3; 2], third: DVec3, across: Option<DVec3>, error: f64) -> bool {
        let Some(across) = across else { return true };
        let [from, to] = edge;
        let (normal, _) = self.plane_through(from, to);
        // Angular width of the edge from the apex; a corner's error turns the plane by error over this.
        let wide = match self.apex {
            Apex::At(apex) => normal.length() / (from - apex).length().min((to - apex).length()),
            Apex::Infinity { .. } => normal.length(),
        };
        let normal = normal.normalize_or_zero();
        let signed = |corner: DVec3| {
            let local = corner - from;
            let value = normal.dot(local);
            let slack = error * (2.0 + local.length() / wide);
            if value.abs() > slack { value.signum() } else { 0.0 }
        };
        signed(third) * signed(across) != -1.0
    }
}

/// The part of a convex polygon on the side of a plane that `inward` points to.
fn cut(polygon: &[DVec3], inward: DVec3, on_plane: DVec3) -> Vec<DVec3> {
    let heights: Vec<f64> = polygon.iter().map(|corner| inward.dot(*corner - on_plane)).collect();
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &corner) in polygon.iter().enumerate() {
        let next = (k + 1) % polygon.len();
        let (height, next_height) = (heights[k], heights[next]);
        if height >= 0.0 {
            kept.push(corner);
        }
        if (height < 0.0) != (next_height < 0.0) {
            kept.push(corner.lerp(polygon[next], height / (height - next_height)));
        }
    }
    kept
}

/// The closest points of a ray's piece [start, end] and of an edge: the ray's parameter, and their distance.
fn closest(origin: DVec3, axis: DVec3, start: f64, end: f64, from: DVec3, to: DVec3) -> (f64, f64) {
    let (edge, offset) = (to - from, origin - from);
    let (aa, ee, ae) = (axis.length_squared(), edge.length_squared(), axis.dot(edge));
    let (ao, eo) = (axis.dot(offset), edge.dot(offset));
    let determinant = aa * ee - ae * ae;
    let on_axis = if determinant > 0.0 { (ae * eo - ao * ee) / determinant } else { start };
    let mut s = on_axis.clamp(start, end);
    let mut u = if ee > 0.0 { (ae * s + eo) / ee } else { 0.0 };
    if !(0.0..=1.0).contains(&u) {
        u = u.clamp(0.0, 1.0);
        s = ((u * ae - ao) / aa).clamp(start, end);
    }
    (s, (offset + s * axis - u * edge).length())
}

#[cfg(test)]
mod tests;
