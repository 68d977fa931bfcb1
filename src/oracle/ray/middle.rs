//! The middle between the two surfaces that the light meets first, as a midpoint map stores it: where, within a lookup's
//! reach of a visible point, it lies before that point.
//!
//! Where both surfaces are planes, the mean of their depths as a map has them is linear across the map. So it is greatest at a
//! corner of the part of the reach in which one triangle covers the other.

use std::ops::ControlFlow;

use glam::DVec3;

use super::Surroundings;
use super::beam::Beam;
use super::primary::Seen;
use super::world::Triangle;

/// The part of a triangle within the reach.
struct Cell<'w> {
    triangle: Triangle<'w>,
    polygon: Vec<DVec3>,
    /// The greatest of its rises.
    most: f64,
}

impl Surroundings<'_> {
    /// How far before the point that the pixel shows the middle between two layers lies at most, somewhere within `reach`
    /// as [`Surroundings::around`] has it, in world units along the light's axis; 0: nowhere before it. Layers no farther
    /// apart than `apart` count as one. The first of two casts; the second may be any surface.
    ///
    /// Under a perspective the middle is that of window depths, which are linear in one over the distance. It lies before
    /// the middle of both places.
    pub fn middle(&self, x: u32, y: u32, reach: f64, apart: f64) -> f64 {
        let Some(seen) = self.tracer.look(x, y).0 else { return 0.0 };
        let beam = self.beam(&seen, reach);
        let mut cells: Vec<Cell<'_>> = Vec::new();
        let mut places = Vec::new();
        self.visit(&beam, |triangle| {
            places.push((triangle.object, triangle.index));
            ControlFlow::Continue(())
        });
        for place in &places {
            let triangle = self.triangle(place);
            let polygon = if triangle.is_degenerate() { Vec::new() } else { beam.clip(&triangle.corners) };
            let most = polygon.iter().map(|corner| self.rise(*corner, &seen)).fold(f64::NEG_INFINITY, f64::max);
            if most > f64::NEG_INFINITY {
                cells.push(Cell { triangle, polygon, most });
            }
        }
        let firsts = cells.iter().filter(|cell| cell.triangle.placed.casts_shadow);
        let pairs = firsts.flat_map(|first| cells.iter().map(move |second| (first, second)));
        let near = pairs.filter(|(first, second)| first.most + second.most > 0.0 && !first.triangle.is(&second.triangle));
        near.map(|(first, second)| self.middle_of(first, second, &beam, &seen, apart)).fold(0.0, f64::max)
    }

    /// The same of two triangles, where the first is nearer to the light.
    fn middle_of(&self, first: &Cell<'_>, second: &Cell<'_>, beam: &Beam, seen: &Seen<'_>, apart: f64) -> f64 {
        let normal = second.triangle.normal();
        let (mut most, mut are_apart) = (0.0_f64, false);
        for corner in beam.overlap(first.polygon.clone(), &second.triangle.corners) {
            let way = beam.way_to(corner);
            let behind = corner + way * (normal.dot(second.triangle.corners[0] - corner) / normal.dot(way));
            let rises = [corner, behind].map(|point| self.rise(point, seen));
            let between = rises[0] - rises[1];
            if between > -apart && rises[1].is_finite() {
                are_apart |= between > apart;
                most = most.max(0.5 * (rises[0] + rises[1]));
            }
        }
        if are_apart { most } else { 0.0 }
    }

    /// By how much a point is nearer to the light than the visible one, as a map's depth has it: linear across the map on any
    /// plane, and in world units next to the visible point.
    fn rise(&self, point: DVec3, seen: &Seen<'_>) -> f64 {
        let lamp = &self.tracer.lamp;
        let by = lamp.depth_between(point, seen.position);
        if lamp.place().is_none() {
            return by;
        }
        let depth = lamp.depth_at(seen.position);
        by * depth / (depth - by)
    }
}
