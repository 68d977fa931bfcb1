//! Discontinuities of tangent bases across edges: how far a vector jumps in tangent space where one triangle ends and the
//! next begins [GDC, "Worst-case Tangent Vector Discontinuities"].
//!
//! Two triangles at an edge have bases around the same vertex normal N. Where neither or both are mirrored, one basis is the
//! other turned about N by some angle, and a light vector in tangent space jumps by at most that angle: by all of it where
//! the light stands at right angles to N. Where one is mirrored, the two are reflections of each other: some light vector is
//! reversed whatever the angle. The angle given is then that between the t axes.

use glam::{DVec2, DVec3};
use serde::Serialize;

use super::{Derivatives, Skin, SkinTriangle};

/// Upper ends of the classes of angles, in degrees; the first begins at 0.
pub const CLASS_ENDS: [f64; 5] = [5.0, 15.0, 45.0, 90.0, 180.0];

/// Angles between the bases of neighbouring triangles, over all edges with two triangles that have a basis.
///
/// An edge of more than two triangles counts for each two that follow each other in the file.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Discontinuity {
    /// One for each of [`CLASS_ENDS`].
    pub classes: [TurnClass; 5],
    /// Mean angle in degrees, weighted by the edges' lengths.
    pub mean_degrees: f64,
    pub largest_degrees: f64,
    /// Pairs of a mirrored triangle and one that is not.
    pub mirrored_pairs: usize,
    /// Share of their edges in the length of all, in [0, 1].
    pub mirrored_share: f64,
    /// Pairs of which a triangle has no basis; they are in no class.
    pub without: usize,
}

/// Edges whose angle is in a class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TurnClass {
    pub edges: usize,
    /// Share in the length of all edges, in [0, 1].
    pub share: f64,
}

impl Discontinuity {
    /// Pairs with a basis on both sides.
    pub fn pairs(&self) -> usize {
        self.classes.iter().map(|class| class.edges).sum()
    }
}

/// Two triangles with an edge in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct SharedEdge {
    pub triangles: [usize; 2],
    /// For each triangle, its corners at the edge's ends, which are in the same order for both.
    pub corners: [[usize; 2]; 2],
}

/// Every edge's neighbouring triangles, in the order of their places.
pub(super) fn shared_edges(skin: &Skin) -> Vec<SharedEdge> {
    struct Side {
        places: [u32; 2],
        triangle: usize,
        corners: [usize; 2],
    }
    let mut sides = Vec::with_capacity(3 * skin.triangles.len());
    for (number, triangle) in skin.triangles.iter().enumerate() {
        for [a, b] in [[0, 1], [1, 2], [2, 0]] {
            let corners = if triangle.places[a] <= triangle.places[b] { [a, b] } else { [b, a] };
            let places = corners.map(|corner| triangle.places[corner]);
            if places[0] != places[1] {
                sides.push(Side { places, triangle: number, corners });
            }
        }
    }
    sides.sort_by_key(|side| (side.places, side.triangle));
    let pair = |pair: &[Side]| match pair {
        [a, b] if a.places == b.places && a.triangle != b.triangle => {
            Some(SharedEdge { triangles: [a.triangle, b.triangle], corners: [a.corners, b.corners] })
        }
        _ => None,
    };
    sides.windows(2).filter_map(pair).collect()
}

/// An edge between two triangles that have bases.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeAxes {
    pub triangles: [usize; 2],
    pub length: f64,
    /// For each of the edge's ends and each triangle, its axes there.
    ends: [[Axes; 2]; 2],
}

/// A triangle's derivatives by texels in the plane of a vertex's normal.
#[derive(Clone, Copy, Debug)]
struct Axes {
    by_s: DVec2,
    by_t: DVec2,
    /// Angle in radians from the s axis to the t axis of the basis: a right angle, negative if mirrored.
    across: f64,
}

/// A rotation of texels, counter-clockwise with y upwards, as its sine and cosine.
pub(super) type Turn = [f64; 2];

/// No rotation.
pub(super) const NO_TURN: Turn = [0.0, 1.0];

impl Axes {
    fn of(derivatives: &Derivatives, [right, up]: [DVec3; 2]) -> Self {
        let flat = |vector: DVec3| DVec2::new(vector.dot(right), vector.dot(up));
        let across = if derivatives.is_mirrored { -std::f64::consts::FRAC_PI_2 } else { std::f64::consts::FRAC_PI_2 };
        Self { by_s: flat(derivatives.by_s), by_t: flat(derivatives.by_t), across }
    }

    /// Direction of the t axis in radians after the texels are turned.
    fn t_axis(&self, [sine, cosine]: Turn) -> f64 {
        let s_axis = cosine * self.by_s - sine * self.by_t;
        s_axis.to_angle() + self.across
    }
}

impl EdgeAxes {
    /// `None`: a triangle has no basis at the edge.
    pub fn new(skin: &Skin, edge: &SharedEdge, bases: &[Option<Derivatives>]) -> Option<Self> {
        let triangles = edge.triangles.map(|number| &skin.triangles[number]);
        let [first, second] = edge.triangles.map(|number| bases[number].as_ref());
        let (first, second) = (first?, second?);
        let mut ends = [None; 2];
        for (end, found) in ends.iter_mut().enumerate() {
            let normal = shared_normal(triangles, [edge.corners[0][end], edge.corners[1][end]])?;
            let right = normal.any_orthonormal_vector();
            let plane = [right, normal.cross(right)];
            let axes = [first, second].map(|derivatives| Axes::of(derivatives, plane));
            // T along the normal has no direction in its plane.
            let has_axis = |derivatives: &Derivatives, axes: &Axes| {
                let least = 1e-9 * derivatives.by_s.length().min(derivatives.by_t.length());
                axes.by_s.length() > least && axes.by_t.length() > least
            };
            let both = has_axis(first, &axes[0]) && has_axis(second, &axes[1]);
            *found = both.then_some(axes);
        }
        let [a, b] = edge.corners[0].map(|corner| triangles[0].positions[corner]);
        Some(Self { triangles: edge.triangles, length: a.distance(b), ends: [ends[0]?, ends[1]?] })
    }

    /// Angle between the t axes in degrees after each triangle's texels are turned; the greater of the edge's ends.
    pub fn degrees(&self, turns: [Turn; 2]) -> f64 {
        degrees_between(self.t_axes(0, turns[0]), self.t_axes(1, turns[1]))
    }

    /// Directions of one triangle's t axis at the edge's ends, in radians, after its texels are turned.
    pub fn t_axes(&self, side: usize, turn: Turn) -> [f64; 2] {
        [self.ends[0][side].t_axis(turn), self.ends[1][side].t_axis(turn)]
    }

    /// Tests whether one of the triangles is mirrored and the other is not.
    pub fn is_mirrored(&self) -> bool {
        let [first, second] = &self.ends[0];
        (first.across < 0.0) != (second.across < 0.0)
    }
}

/// Greater of the angles between two triangles' directions at an edge's ends, from radians to degrees.
pub(super) fn degrees_between(first: [f64; 2], second: [f64; 2]) -> f64 {
    let angle = |end: usize| {
        let apart = (first[end] - second[end]).abs() % std::f64::consts::TAU;
        apart.min(std::f64::consts::TAU - apart)
    };
    angle(0).max(angle(1)).to_degrees()
}

/// Mean of two corners' normals; of the triangles' own where that is zero.
fn shared_normal(triangles: [&SkinTriangle; 2], corners: [usize; 2]) -> Option<DVec3> {
    let facet = |triangle: &SkinTriangle| {
        let [a, b, c] = triangle.positions;
        (b - a).cross(c - a).normalize_or_zero()
    };
    let mean = triangles[0].normals[corners[0]] + triangles[1].normals[corners[1]];
    mean.try_normalize().or_else(|| (facet(triangles[0]) + facet(triangles[1])).try_normalize())
}

/// The axes at all edges, and the number of edges where a triangle has none.
pub(super) fn crossings(skin: &Skin, edges: &[SharedEdge]) -> (Vec<EdgeAxes>, usize) {
    let bases: Vec<Option<Derivatives>> = skin.triangles.iter().map(SkinTriangle::derivatives).collect();
    let found: Vec<EdgeAxes> = edges.iter().filter_map(|edge| EdgeAxes::new(skin, edge, &bases)).collect();
    let without = edges.len() - found.len();
    (found, without)
}

/// Measures a skin as it is.
pub(super) fn measure(skin: &Skin) -> Discontinuity {
    let (crossings, without) = crossings(skin, &shared_edges(skin));
    let mut found = Discontinuity { without, ..Discontinuity::default() };
    let total: f64 = crossings.iter().map(|crossing| crossing.length).sum();
    let share = |length: f64| if total > 0.0 { length / total } else { 0.0 };
    for crossing in &crossings {
        let degrees = crossing.degrees([NO_TURN; 2]);
        let class = CLASS_ENDS.iter().position(|end| degrees < *end).unwrap_or(CLASS_ENDS.len() - 1);
        found.classes[class].edges += 1;
        found.classes[class].share += share(crossing.length);
        found.mean_degrees += share(crossing.length) * degrees;
        found.largest_degrees = found.largest_degrees.max(degrees);
        if crossing.is_mirrored() {
            found.mirrored_pairs += 1;
            found.mirrored_share += share(crossing.length);
        }
    }
    found
}
