//! What a shadow map may see in place of a pixel's own point: its texels sample the scene a little aside. Where nothing
//! changes within a lookup's reach, as the light sees it, a map has no reason to be wrong.
//!
//! The reach is a parallelogram around the point, across the light's axis, as a map's texels are. Silhouettes and open
//! edges inside it are found exactly, by the same beam that finds the doubt of a shadow ray (`beam.rs`). What rises
//! before the visible plane, and what lies close before the point, is sampled on a grid: between silhouettes a surface
//! changes slowly.

use std::ops::ControlFlow;

use glam::DVec3;

use super::beam::{Apex, Beam, crossing};
use super::primary::Seen;
use super::world::{Segment, Triangle};
use super::{Error, Options, Tracer, Truth};
use crate::scene::Scene;

/// One light of one scene, ready for questions about single pixels.
pub struct Surroundings<'a> {
    tracer: Tracer<'a>,
    scene: &'a Scene,
    options: Options,
}

/// What lies around a visible point, as the light sees it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Around {
    /// Whether a silhouette or an open edge of a caster lies within the reach. The other answers are then not complete.
    pub edge: bool,
    /// How far a caster stands before the plane of the visible surface somewhere within the reach, along the light's ray
    /// and in world units; 0: nowhere.
    pub rise: f64,
    /// What the point's own ray meets before the point.
    pub blockers: Vec<Blocker>,
    /// Surfaces of other planes within the reach that lie nearer to the light than the point itself.
    pub nearer: Vec<Nearer>,
    /// How fast the visible surface's depth along the light's axis grows across a map, as GL's polygon offset has it but
    /// over both axes together: without unit.
    pub slope: f64,
    /// What a length of 1 on the plane at distance 1 from the light measures at the point, in world units; 1 for parallel
    /// light.
    pub scale: f64,
}

/// A surface beside a point that is nearer to the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearer {
    /// By how much, along the light's axis and in world units.
    pub by: f64,
    /// As [`Around::slope`].
    pub slope: f64,
}

/// A surface between the light and a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocker {
    /// From the surface to the point along the ray, in world units.
    pub gap: f64,
    /// The steepest slope of the surface within the reach, as [`Around::slope`].
    pub slope: f64,
}

/// A triangle by its object's and its own number.
type Place = (u32, u32);

/// Lengths of the reach at which rises are sampled, on each axis.
const STEPS: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];

/// The cosine between the normals of two triangles of one plane, at least.
const SAME_PLANE: f64 = 1.0 - 1e-9;

/// Slopes beyond this one count as this: a surface seen edge-on.
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

    /// The truth of every pixel, as [`super::trace`] finds it.
    ///
    /// # Errors
    ///
    /// [`Error::TooAmbiguous`] where more than [`Options::most_ambiguous`] of the drawn pixels are undecided.
    pub fn truth(&self) -> Result<Truth, Error> {
        self.tracer.trace(self.scene, &self.options)
    }

    /// What lies within `reach` of the point that the pixel shows, in lengths on the plane at distance 1 along the light's
    /// axis, or in world units for parallel light. `None`: the pixel shows nothing.
    pub fn around(&self, x: u32, y: u32, reach: f64) -> Option<Around> {
        let seen = self.tracer.look(x, y).0?;
        let scale = self.tracer.lamp.depth_at(seen.position);
        let beam = self.beam(&seen, reach);
        let mut around = Around { scale, slope: self.slope(&seen, seen.normal), ..Around::default() };
        let axis = beam.axis();
        let radius = beam.radius(self.tracer.largest_error);
        let longer = beam.surface_spread[0].length() + beam.surface_spread[1].length();
        let end = 1.0 + (radius + longer) / axis.length();
        let segment = Segment { origin: beam.origin(), direction: axis, start: beam.start, end };
        let (mut blockers, mut met) = (Vec::new(), Vec::new());
        self.tracer.world.visit(&segment, radius, |triangle| {
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
                Blocker { gap: *gap, slope: steepest }
            })
            .collect();
        Some(around)
    }

    /// The slope of a surface near the visible point, as [`Around::slope`].
    fn slope(&self, seen: &Seen<'_>, normal: DVec3) -> f64 {
        self.tracer.lamp.slope(seen.position, normal).min(STEEPEST)
    }

    fn beam(&self, seen: &Seen<'_>, reach: f64) -> Beam {
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

    fn triangle(&self, &(object, index): &Place) -> Triangle<'_> {
        self.tracer.world.triangle(object, index)
    }

    fn look_at(
        &self,
        triangle: &Triangle<'_>,
        beam: &Beam,
        seen: &Seen<'_>,
        around: &mut Around,
        blockers: &mut Vec<(Place, f64)>,
        met: &mut Vec<Place>,
    ) {
        if !triangle.placed.casts_shadow || triangle.is(&seen.triangle) || triangle.is_degenerate() {
            return;
        }
        let error = self.tracer.error_in(beam, triangle);
        let Some(meeting) = beam.meet(&triangle.corners, error) else { return };
        let near_edge = self.tracer.passes_any_edge(beam, triangle, error);
        if !(meeting.surely_inside || near_edge || meeting.center.is_some()) {
            return;
        }
        let place = (triangle.object, triangle.index);
        met.push(place);
        // The edge of a hole in a cut-out is an edge too, wherever the beam meets the cut-out.
        let is_cut = triangle.has_cutout() && !self.tracer.alpha_in(beam, triangle).surely_opaque();
        around.edge |= is_cut || (near_edge && self.tracer.folds_inside(beam, triangle, error));
        let is_same_plane = triangle.normal().dot(seen.normal).abs() > SAME_PLANE;
        for u in STEPS {
            for v in STEPS {
                let base = beam.base + u * beam.spread[0] + v * beam.spread[1];
                let Some((gap, at)) = gap(beam, base, seen, triangle) else { continue };
                let by = self.tracer.lamp.depth_between(at, seen.position);
                if !is_same_plane && by > seen.error + error {
                    around.nearer.push(Nearer { by, slope: self.slope(seen, triangle.normal()) });
                }
                if gap <= seen.error + error {
                    continue;
                }
                around.rise = around.rise.max(gap);
                if (u, v) == (0.0, 0.0) {
                    blockers.push((place, gap));
                }
            }
        }
    }
}

/// How far before the visible surface's plane the ray to `base` crosses the triangle, and where; `None` where it does not.
fn gap(beam: &Beam, base: DVec3, seen: &Seen<'_>, triangle: &Triangle<'_>) -> Option<(f64, DVec3)> {
    let way = match beam.apex {
        Apex::At(apex) => base - apex,
        Apex::Infinity { travel, length } => length * travel,
    };
    let origin = base - way;
    let at = crossing(origin, way, &triangle.corners)?;
    let plane = seen.normal.dot(seen.position - origin) / seen.normal.dot(way);
    (at > 0.0 && plane.is_finite()).then_some(((plane - at) * way.length(), origin + at * way))
}
