//! Surroundings of a visible point, which a shadow map may see in place of the point: its texels sample the scene a little
//! aside. If nothing changes within a lookup's reach, as the light sees it, a map has no reason to be wrong.
//!
//! The reach is a parallelogram around the point, across the light's axis, as a map's texels are. Silhouettes and open
//! edges inside it are found exactly, by the same beam that finds the doubt of a shadow ray (`beam.rs`). What rises
//! before the visible plane, or beside the point, is greatest at a corner of the part of a triangle that lies in the reach.

use std::ops::ControlFlow;

use glam::DVec3;

use super::beam::{Apex, Beam, crossing};
use super::primary::SeenPoint;
use super::slab::Segment;
use super::world::Triangle;
use super::{Error, Options, Tracer, Truth};
use crate::scene::{Light, Scene};

/// One light of one scene, prepared for queries of single pixels.
pub struct Surroundings<'a> {
    pub(super) tracer: Tracer<'a>,
    scene: &'a Scene,
    options: Options,
}

/// Surroundings of a visible point, as the light sees them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Around {
    /// True if a silhouette or an open edge of a caster lies within the reach. The other answers are then not complete.
    pub edge: bool,
    /// True if the visible surface itself ends or folds over within the reach. It does not shadow the visible point, but
    /// may be the second layer of a map that stores the middle of two.
    pub own_edge: bool,
    /// Greatest distance of a caster before the plane of the visible surface within the reach, along the light's ray and in
    /// world units; 0: none.
    pub rise: f64,
    /// Surfaces that the point's own ray meets before the point.
    pub blockers: Vec<Blocker>,
    /// Surfaces of other planes within the reach that lie nearer to the light than the point itself, each at its nearest.
    pub nearer: Vec<Nearer>,
    /// Slope of the visible surface's depth along the light's axis across a map, as GL's polygon offset has it but over
    /// both axes together: without unit.
    pub slope: f64,
    /// Length in world units at the point of a length of 1 on the plane at distance 1 from the light; 1 for parallel light.
    pub scale: f64,
    /// Length of the light's ray for a depth of 1 along the light's axis: 1 on the axis and for parallel light, the greater
    /// the farther off the axis.
    pub ray: f64,
}

/// A surface beside a point that is nearer to the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearer {
    /// Distance along the light's axis, in world units.
    pub by: f64,
    /// Slope as in [`Around::slope`].
    pub slope: f64,
}

/// A surface between the light and a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocker {
    /// Into [`crate::scene::Scene::objects`].
    pub object: u32,
    /// Distance from the surface to the point along the ray, in world units.
    pub gap: f64,
    /// The steepest slope of the surface within the reach, as [`Around::slope`].
    pub slope: f64,
    /// True if its front looks away from the light.
    pub is_far_side: bool,
}

/// A triangle by its object's and its own number.
type Place = (u32, u32);

/// The cosine between the normals of two triangles of one plane, at least.
const SAME_PLANE: f64 = 1.0 - 1e-9;

/// Greatest slope: a surface seen edge-on.
const STEEPEST: f64 = 1e6;

impl<'a> Surroundings<'a> {
    /// Prepares light number `light` of `scene`.
    ///
    /// # Errors
    ///
    /// As [`super::trace`], but never [`Error::TooAmbiguous`].
    pub fn new(scene: &'a Scene, light: usize, options: &Options) -> Result<Self, Error> {
        Ok(Self { tracer: Tracer::new(scene, light, options)?, scene, options: options.clone() })
    }

    /// The same for a light that the scene does not have.
    pub(super) fn of_light(scene: &'a Scene, light: &Light, options: &Options) -> Result<Self, Error> {
        Ok(Self { tracer: Tracer::of_light(scene, light, options)?, scene, options: options.clone() })
    }

    /// The truth of every pixel, as [`super::trace`] finds it.
    ///
    /// # Errors
    ///
    /// [`Error::TooAmbiguous`] where more than [`Options::most_ambiguous`] of the drawn pixels are undecided.
    pub fn truth(&self) -> Result<Truth, Error> {
        self.tracer.trace(self.scene, &self.options)
    }

    /// Finds the surroundings within `reach` of the point that the pixel shows, in lengths on the plane at distance 1 along
    /// the light's axis, or in world units for parallel light. `None`: the pixel shows nothing.
    pub fn around(&self, x: u32, y: u32, reach: f64) -> Option<Around> {
        let seen = self.tracer.look(x, y).0?;
        let scale = self.tracer.lamp.depth_at(seen.position);
        let beam = self.beam(&seen, reach);
        let ray = match self.tracer.lamp.apex(seen.position) {
            Apex::At(apex) => seen.position.distance(apex) / scale,
            Apex::Infinity { .. } => 1.0,
        };
        let mut around = Around { scale, ray, slope: self.slope(&seen, seen.normal), ..Around::default() };
        let (mut blockers, mut met) = (Vec::new(), Vec::new());
        let longer = beam.surface_spread[0].length() + beam.surface_spread[1].length();
        self.visit(&beam, beam.radius(self.tracer.largest_error) + longer, |triangle| {
            self.look_at(triangle, &beam, &seen, &mut around, &mut blockers, &mut met);
            if around.edge { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        around.blockers = blockers
            .iter()
            .map(|(place, gap)| {
                let blocker = self.triangle(place);
                let beside = met.iter().map(|place| self.triangle(place));
                let same = beside.filter(|other| other.is(&blocker) || other.touches(&blocker));
                let steepest = same.map(|other| self.slope(&seen, other.normal())).fold(0.0, f64::max);
                let looks_away = blocker.normal().dot(beam.axis()) > 0.0;
                Blocker {
                    object: place.0,
                    gap: *gap,
                    slope: steepest,
                    is_far_side: looks_away != blocker.placed.mirrors(),
                }
            })
            .collect();
        Some(around)
    }

    /// Calls `look` with each triangle that the beam may meet, up to so far behind its base.
    pub(super) fn visit(&self, beam: &Beam, behind: f64, look: impl FnMut(&Triangle<'_>) -> ControlFlow<()>) {
        let axis = beam.axis();
        let end = 1.0 + behind / axis.length();
        let segment = Segment { origin: beam.origin(), direction: axis, start: beam.start, end };
        self.tracer.visit(beam, &segment, look);
    }

    /// The slope of a surface near the visible point, as [`Around::slope`].
    fn slope(&self, seen: &SeenPoint<'_>, normal: DVec3) -> f64 {
        self.tracer.lamp.slope(seen.position, normal).min(STEEPEST)
    }

    pub(super) fn beam(&self, seen: &SeenPoint<'_>, reach: f64) -> Beam {
        let spread = self.tracer.lamp.footprint(seen.position, reach);
        let apex = self.tracer.lamp.apex(seen.position);
        let way = match apex {
            Apex::At(apex) => (seen.position - apex).normalize_or_zero(),
            Apex::Infinity { travel, .. } => travel,
        };
        // On the visible surface, at most fifty times as far: beyond that the surface is seen edge-on.
        let across = seen.normal.dot(way);
        let across = if across.abs() < 0.02 { 0.02_f64.copysign(across) } else { across };
        let surface_spread = spread.map(|side| side - way * (seen.normal.dot(side) / across));
        Beam {
            apex,
            base: seen.position,
            spread: [spread[0] + seen.spread[0], spread[1] + seen.spread[1]],
            surface_spread,
            slip: [DVec3::ZERO; 2],
            error: seen.error,
            depth_error: seen.error,
            start: 0.0,
            levers: true,
        }
    }

    pub(super) fn triangle(&self, &(object, index): &Place) -> Triangle<'_> {
        self.tracer.world.triangle(object, index)
    }

    fn look_at(
        &self,
        triangle: &Triangle<'_>,
        beam: &Beam,
        seen: &SeenPoint<'_>,
        around: &mut Around,
        blockers: &mut Vec<(Place, f64)>,
        met: &mut Vec<Place>,
    ) {
        let is_own = triangle.is(&seen.triangle);
        let may_shade = triangle.placed.casts_shadow && !is_own;
        if triangle.is_degenerate() || !(may_shade || triangle.object == seen.triangle.object) {
            return;
        }
        let error = self.tracer.error_in(beam, triangle);
        let Some(meeting) = beam.meet(&triangle.corners, error) else { return };
        let near_edge = self.tracer.passes_any_edge(beam, triangle, error);
        if !(meeting.surely_inside || near_edge || meeting.center.is_some()) {
            return;
        }
        // The edge of a hole in a cut-out is an edge too, wherever the beam meets the cut-out.
        let is_cut = triangle.has_cutout() && !self.tracer.alpha_in(beam, triangle).surely_opaque();
        let ends = is_cut || (near_edge && self.tracer.folds_inside(beam, triangle, error));
        if !may_shade {
            around.own_edge |= ends;
            return;
        }
        around.edge |= ends;
        let place = (triangle.object, triangle.index);
        met.push(place);
        let doubt = seen.error + error;
        let gap = |base: DVec3| gap(beam, base, seen, &triangle.corners).filter(|gap| *gap > doubt);
        blockers.extend(gap(beam.base).map(|gap| (place, gap)));
        let is_same_plane = triangle.normal().dot(seen.normal).abs() > SAME_PLANE;
        let (mut by, mut rise) = (0.0_f64, 0.0_f64);
        for corner in beam.clip(&triangle.corners) {
            by = by.max(self.tracer.lamp.depth_between(corner, seen.position));
            rise = rise.max(before_plane(beam, corner, seen));
        }
        if rise > doubt {
            around.rise = around.rise.max(rise);
        }
        if by > 0.0 && !is_same_plane {
            around.nearer.push(Nearer { by, slope: self.slope(seen, triangle.normal()) });
        }
    }
}

/// Distance before the visible surface's plane at which the ray to `base` crosses the triangle; `None` if it does not.
fn gap(beam: &Beam, base: DVec3, seen: &SeenPoint<'_>, corners: &[DVec3; 3]) -> Option<f64> {
    let way = match beam.apex {
        Apex::At(apex) => base - apex,
        Apex::Infinity { travel, length } => length * travel,
    };
    let at = crossing(base - way, way, corners).filter(|at| *at > 0.0)?;
    Some(before_plane(beam, base - way + at * way, seen))
}

/// Distance of a point before the visible surface's plane, along its own ray; negative behind it, 0 if the ray does not
/// meet it.
fn before_plane(beam: &Beam, point: DVec3, seen: &SeenPoint<'_>) -> f64 {
    let way = beam.way_to(point);
    let ahead = seen.normal.dot(seen.position - point) / seen.normal.dot(way);
    // A ray that leaves the light away from the plane meets it behind the light.
    let is_met = ahead.is_finite() && (ahead > -1.0 || matches!(beam.apex, Apex::Infinity { .. }));
    if is_met { ahead * way.length() } else { 0.0 }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Objects under a sun straight above, seen in one pixel that shows `target` from `eye`.
    pub fn seen(objects: &str, eye: DVec3, target: DVec3) -> Scene {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let camera = format!(
            "[image]\nsize = [1, 1]\n[camera]\neye = {:?}\ntarget = {:?}\nfov_y = 5.0\n",
            eye.to_array(),
            target.to_array()
        );
        let light = "[[light]]\nkind = \"directional\"\ndirection = [0.0, -1.0, 0.0]\n";
        std::fs::write(&path, format!("{camera}{light}{objects}")).unwrap();
        crate::techniques::load(&path, &[]).unwrap().scene
    }

    fn around(objects: &str, eye: DVec3, target: DVec3, reach: f64) -> Around {
        let scene = seen(objects, eye, target);
        Surroundings::new(&scene, 0, &Options::default()).unwrap().around(0, 0, reach).unwrap()
    }

    #[test]
    fn what_is_nearer_is_found_at_its_nearest() {
        let roof = "[[object]]\nmesh = \"box\"\nrotate = { axis = [0.0, 0.0, 1.0], angle = 30.0 }\n";
        let (sin, cos) = 30_f64.to_radians().sin_cos();
        let ridge = DVec3::new(cos - sin, cos + sin, 0.1);
        // Down the steep side, 0.1 aside.
        let point = ridge + 0.2 * DVec3::new(sin, -cos, 0.0);
        for reach in [0.2, 0.3, 0.35] {
            let found = around(roof, point + 3.0 * DVec3::new(cos, sin, 0.0), point, reach);
            assert!(!found.edge && found.rise == 0.0, "{found:?}");
            let most = found.nearer.iter().map(|near| near.by).fold(0.0, f64::max);
            assert!((most - 0.2 * cos).abs() < 1e-3, "{reach}: {most}");
        }
    }

    #[test]
    fn the_visible_surface_ends_at_its_own_edge() {
        let quad = "[[object]]\nmesh = \"quad\"\n";
        for (x, ends) in [(0.5, false), (0.95, true)] {
            let point = DVec3::new(x, 0.0, 0.1);
            for objects in [quad.to_owned(), format!("{quad}casts_shadow = false\n")] {
                let found = around(&objects, point + 3.0 * DVec3::Y + DVec3::X, point, 0.1);
                assert_eq!([found.own_edge, found.edge], [ends, false], "{x}");
            }
        }
    }
}
