//! Shells: the pieces of a caster that hang together across edges. Which of them are closed, which way they look, and
//! whether a light stands inside.

use std::ops::Range;

use glam::DVec3;
use robust::{Coord, orient2d};

use super::caster::Use;
use super::{Caster, Source};
use crate::math::Aabb;

/// A signed volume below this share of the sum of its terms' magnitudes counts as none: far above the sum's rounding,
/// far below any body.
const LEAST_VOLUME: f64 = 1.0 / (1u64 << 30) as f64;

/// A piece of a caster whose triangles hang together across edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Of [`Caster::triangles`].
    pub triangles: Range<u32>,
    pub kind: Kind,
    /// In model space.
    pub bounds: Aabb,
}

/// What a shell is as a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Every edge has exactly two triangles, in opposite directions, and the normals look outwards: the signed volume is
    /// positive.
    Closed,
    /// Closed, but looking inwards, or without volume (a sheet with two sides).
    InsideOut,
    /// Some edge has one triangle, more than two, or two that run the same way.
    Open,
}

impl Kind {
    pub fn is_closed(self) -> bool {
        self != Self::Open
    }
}

/// Which triangles of a shell make its volume, under one light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counting {
    /// Those that face the light.
    Facing,
    /// All but those in whose plane the light stands; averted ones turned over.
    All,
}

impl Caster {
    /// How a shell counts under a light: [`Counting::Facing`] only where it is [`Kind::Closed`] and does not hold the light,
    /// inside or on its surface. Then each crossing of the surface outwards has one inwards before it, so that facing
    /// triangles alone miss no shadow; elsewhere they may.
    pub fn counting(&self, shell: &Component, source: Source) -> Counting {
        match (shell.kind, source) {
            (Kind::Closed, Source::Direction(_)) => Counting::Facing,
            (Kind::Closed, Source::Point(light)) if !self.holds(shell, light) => Counting::Facing,
            _ => Counting::All,
        }
    }

    fn holds(&self, shell: &Component, light: DVec3) -> bool {
        let Aabb { min, max } = shell.bounds;
        let in_box = light.cmpge(min).all() && light.cmple(max).all();
        in_box && (self.winding(shell, light) != 0 || shell.triangles.clone().any(|index| self.has_on_it(index, light)))
    }

    /// Whether a point lies on a triangle, its edges included. Exact.
    fn has_on_it(&self, triangle: u32, point: DVec3) -> bool {
        let corners = self.corners(triangle as usize);
        let (min, max) = (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]));
        let in_box = point.cmpge(min).all() && point.cmple(max).all();
        if !in_box || self.planes.exact_side(self, triangle as usize, Source::Point(point)) != 0 {
            return false;
        }
        // In a plane, and within the edges in all three projections: one of them keeps the triangle's area.
        [[0, 1], [1, 2], [2, 0]].into_iter().all(|[x, y]| {
            let flat = |corner: DVec3| Coord { x: corner[x], y: corner[y] };
            let sides = [0, 1, 2].map(|k| orient2d(flat(corners[k]), flat(corners[(k + 1) % 3]), flat(point)));
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        })
    }

    /// How often the shell winds around a point that is not on it, by the triangles that a ray in +x crosses. Exact: an
    /// edge or corner that the ray meets belongs to one of its triangles, whichever way the predicates' signs fall.
    fn winding(&self, shell: &Component, point: DVec3) -> i32 {
        let at = Coord { x: point.y, y: point.z };
        let mut winding = 0;
        for triangle in shell.triangles.clone() {
            let corners = self.corners(triangle as usize);
            if corners.iter().all(|corner| corner.x < point.x) {
                continue;
            }
            // Winding of the triangle's projection to the yz plane, an edge at a time: the same sum for both users.
            let mut seen = 0;
            for k in 0..3 {
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                let (rises, falls) = (from.z <= point.z && point.z < to.z, to.z <= point.z && point.z < from.z);
                if !(rises || falls) {
                    continue;
                }
                let ends = [if rises { from } else { to }, if rises { to } else { from }];
                let [low, high] = ends.map(|end| Coord { x: end.y, y: end.z });
                if orient2d(low, high, at) > 0.0 {
                    seen += if rises { 1 } else { -1 };
                }
            }
            // Seen along +x, the normal's x has the sign of `seen`; the plane lies ahead if the point sees its other side.
            if seen != 0 && i32::from(self.planes.exact_side(self, triangle as usize, Source::Point(point))) == -seen {
                winding += seen;
            }
        }
        winding
    }
}

/// The triangles in an order that keeps shells together: (shell, triangle), shells by their first triangle. `edges`: the
/// triangles of each edge.
pub(super) fn sorted_by_shell<'e>(triangles: usize, edges: impl Iterator<Item = &'e [Use]>) -> Vec<(u32, u32)> {
    // Union-find; the smaller triangle stands for both.
    let mut parents: Vec<u32> = (0..triangles as u32).collect();
    for edge in edges {
        for pair in edge.windows(2) {
            let (a, b) = (find(&mut parents, pair[0].triangle), find(&mut parents, pair[1].triangle));
            parents[a.max(b) as usize] = a.min(b);
        }
    }
    let mut order: Vec<(u32, u32)> =
        (0..triangles as u32).map(|triangle| (find(&mut parents, triangle), triangle)).collect();
    order.sort_unstable();
    order
}

fn find(parents: &mut [u32], mut item: u32) -> u32 {
    while parents[item as usize] != item {
        parents[item as usize] = parents[parents[item as usize] as usize];
        item = parents[item as usize];
    }
    item
}

/// The shells of a caster whose triangles stand as [`sorted_by_shell`] has ordered them.
pub(super) fn describe(caster: &Caster, order: &[(u32, u32)]) -> Vec<Component> {
    let mut is_open = vec![false; order.len()];
    for (triangle, _) in &caster.other.uses {
        is_open[*triangle as usize] = true;
    }
    let mut start = 0u32;
    let runs = order.chunk_by(|a, b| a.0 == b.0).map(|run| {
        let triangles = start..start + run.len() as u32;
        start = triangles.end;
        triangles
    });
    runs.map(|triangles| {
        let own = triangles.start as usize..triangles.end as usize;
        let kind = match is_open[own.clone()].iter().any(|open| *open) {
            true => Kind::Open,
            false if looks_outwards(caster, own.clone()) => Kind::Closed,
            false => Kind::InsideOut,
        };
        let bounds = Aabb::from_points(own.flat_map(|triangle| caster.corners(triangle)));
        Component { triangles, kind, bounds }
    })
    .collect()
}

fn looks_outwards(caster: &Caster, triangles: Range<usize>) -> bool {
    let origin = caster.corners(triangles.start)[0];
    let (mut volume, mut size) = (0.0, 0.0);
    for triangle in triangles {
        let [a, b, c] = caster.corners(triangle).map(|corner| corner - origin);
        let term = a.dot(b.cross(c));
        (volume, size) = (volume + term, size + f64::abs(term));
    }
    volume > LEAST_VOLUME * size
}
