//! The middle between the two surfaces that the light meets first, as a midpoint map stores it: where, within a lookup's
//! reach of a visible point, it lies before that point.
//!
//! Where both surfaces are planes, the mean of their depths as a map has them is linear across the map. So it is greatest at a
//! corner of the part of the reach in which one triangle covers the other and lies before it.

use std::ops::ControlFlow;

use glam::DVec3;

use super::Surroundings;
use super::beam::Beam;
use super::primary::SeenPoint;
use super::world::Triangle;

/// The part of a triangle within the reach.
struct Cell<'w> {
    triangle: Triangle<'w>,
    polygon: Vec<DVec3>,
    /// The greatest of its rises.
    most: f64,
}

impl Surroundings<'_> {
    /// Greatest distance of the middle between two layers before the point that the pixel shows, within `reach` as in
    /// [`Surroundings::around`], in world units along the light's axis; negative behind it, up to `apart`; minus infinity:
    /// there is none. Layers no farther apart than `apart` count as one. The first of two casts; the second may be any
    /// surface.
    ///
    /// Under a perspective the middle is that of window depths, which are linear in one over the distance. It lies before
    /// the middle of both places.
    pub fn middle(&self, x: u32, y: u32, reach: f64, apart: f64) -> f64 {
        let Some(seen) = self.tracer.look(x, y).0 else { return f64::NEG_INFINITY };
        let beam = self.beam(&seen, reach);
        let mut cells: Vec<Cell<'_>> = Vec::new();
        let mut places = Vec::new();
        // However far behind the point the second layer lies: the first may be as near to the light.
        let (center, radius) = self.tracer.world.ball();
        self.visit(&beam, center.distance(seen.position) + radius, |triangle| {
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
        let near = pairs
            .filter(|(first, second)| first.most + second.most > -2.0 * apart && !first.triangle.is(&second.triangle));
        near.map(|(first, second)| self.middle_of(first, second, &beam, &seen, apart)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The same of two triangles, where the first is nearer to the light.
    fn middle_of(&self, first: &Cell<'_>, second: &Cell<'_>, beam: &Beam, seen: &SeenPoint<'_>, apart: f64) -> f64 {
        let normal = second.triangle.normal();
        // The middle, and how far the second lies behind the first: each linear across the map.
        let at = |corner: &DVec3| {
            let way = beam.way_to(*corner);
            let behind = *corner + way * (normal.dot(second.triangle.corners[0] - *corner) / normal.dot(way));
            let rises = [*corner, behind].map(|point| self.rise(point, seen));
            (0.5 * (rises[0] + rises[1]), rises[0] - rises[1])
        };
        let corners: Vec<(f64, f64)> =
            beam.overlap(first.polygon.clone(), &second.triangle.corners).iter().map(at).collect();
        let (mut most, mut are_apart) = (f64::NEG_INFINITY, false);
        for (k, &(middle, between)) in corners.iter().enumerate() {
            let (next_middle, next) = corners[(k + 1) % corners.len()];
            if between > -apart && middle.is_finite() {
                are_apart |= between > apart;
                most = most.max(middle);
            }
            // The part ends where the second layer comes before the first.
            if (between > -apart) != (next > -apart) {
                let part = (between + apart) / (between - next);
                let crossing = middle + part * (next_middle - middle);
                most = if crossing.is_finite() { most.max(crossing) } else { most };
            }
        }
        if are_apart { most } else { f64::NEG_INFINITY }
    }

    /// By how much a point is nearer to the light than the visible one, as a map's depth has it: linear across the map on any
    /// plane, and in world units next to the visible point.
    fn rise(&self, point: DVec3, seen: &SeenPoint<'_>) -> f64 {
        let lamp = &self.tracer.lamp;
        let by = lamp.depth_between(point, seen.position);
        if lamp.place().is_none() {
            return by;
        }
        let depth = lamp.depth_at(seen.position);
        by * depth / (depth - by)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::Options;
    use crate::truth::around::tests::seen;

    /// The middle over objects that are turned by 30 degrees, from above.
    fn middle(objects: &str, reach: f64) -> f64 {
        let turn = "rotate = { axis = [0.0, 0.0, 1.0], angle = 30.0 }\n";
        let objects = objects.replace("[[object]]\n", &format!("[[object]]\n{turn}"));
        let scene = seen(&objects, DVec3::new(0.05, 4.0, 0.2), DVec3::new(0.05, 0.0, 0.1));
        Surroundings::new(&scene, 0, &Options::default()).unwrap().middle(0, 0, reach, 1e-5)
    }

    #[test]
    fn the_middle_of_a_thin_caster_lies_before_its_lit_side_where_that_is_steep() {
        let slab = "[[object]]\nmesh = \"box\"\nscale = [1.0, 0.01, 1.0]\n";
        // Half its thickness along the light, and what a slope of 30 degrees rises within the reach's square at least.
        let half = 0.01 / 30_f64.to_radians().cos();
        let rise = |reach: f64| 30_f64.to_radians().tan() * std::f64::consts::SQRT_2 * reach;
        assert!(middle(slab, 0.005) < 0.0);
        for reach in [0.03, 0.06] {
            let [least, most] = [1.0, std::f64::consts::SQRT_2].map(|turned| turned * rise(reach) - half);
            let found = middle(slab, reach);
            assert!((least..=most * 1.001).contains(&found), "{reach}: {found}, of {least} to {most}");
        }
        assert_eq!(middle(&slab.replace("0.01", "0.5"), 0.06), f64::NEG_INFINITY);
    }

    /// A caster that rises out of a steeper floor, which falls away: the middle is greatest where they cross.
    #[test]
    fn the_middle_of_two_that_cross_is_sought_where_they_cross() {
        let turned = |angle: f64| {
            format!("[[object]]\nmesh = \"quad\"\nrotate = {{ axis = [0.0, 0.0, 1.0], angle = {angle:?} }}\n")
        };
        // No corner of a triangle lies on the line where they cross.
        let objects = format!("{}casts_shadow = false\n{}translate = [0.0, 0.0, 0.3]\n", turned(50.0), turned(-20.0));
        let scene = seen(&objects, DVec3::new(0.05, 4.0, 0.15), DVec3::new(0.05, 0.0, 0.15));
        let surroundings = Surroundings::new(&scene, 0, &Options::default()).unwrap();
        let found = [0.06, 0.08, 0.1].map(|reach| surroundings.middle(0, 0, reach, 1e-5));
        // Both lie at the crossing's own height: less than a thousandth of their distances from it is within 1e-5 of it.
        assert!(found.iter().all(|middle| (middle - found[0]).abs() < 1e-3) && found[0] < 0.0, "{found:?}");
    }

    #[test]
    fn two_surfaces_in_one_plane_have_no_middle() {
        let quad = "[[object]]\nmesh = \"quad\"\n";
        assert_eq!(middle(&format!("{quad}{quad}"), 0.1), f64::NEG_INFINITY);
        let below = format!("{quad}translate = [0.0, -0.01, 0.0]\n");
        assert!(middle(&format!("{quad}{below}"), 0.1) > 0.0);
        // A surface that casts nothing may be the second layer, but not the first.
        assert!(middle(&format!("{quad}{below}casts_shadow = false\n"), 0.1) > 0.0);
        assert_eq!(middle(&format!("{quad}casts_shadow = false\n{below}"), 0.1), f64::NEG_INFINITY);
    }
}
