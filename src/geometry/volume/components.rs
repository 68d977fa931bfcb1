//! Shells: the pieces of a caster that are connected across edges; whether each is closed, and which way it looks.

use std::ops::Range;

use glam::DVec3;

use super::edges::{OtherEdges, Use};
use crate::math::Aabb;

/// A signed volume below this share of the sum of its terms' magnitudes counts as none: far above the sum's rounding,
/// far below any body.
const LEAST_VOLUME: f64 = 1.0 / (1u64 << 30) as f64;

/// A piece of a caster whose triangles are connected across edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Range of [`Caster::triangles`](super::Caster::triangles).
    pub triangles: Range<u32>,
    pub kind: SurfaceKind,
    /// Bounds in model space.
    pub bounds: Aabb,
}

/// Kind of a shell's surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceKind {
    /// Every edge has exactly two triangles, in opposite directions, and the normals look outwards: the signed volume is
    /// positive.
    Closed,
    /// Closed, but looking inwards, or without volume (a sheet with two sides).
    InsideOut,
    /// Some edge has one triangle, more than two, or two that run the same way.
    Open,
}

impl SurfaceKind {
    pub fn is_closed(self) -> bool {
        self != Self::Open
    }
}

/// Triangles of a shell that make its volume, under one light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountedFaces {
    /// Those that face the light.
    Facing,
    /// All except those in whose plane the light lies; averted ones are reversed.
    All,
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

/// The shells of a caster whose triangles are in the order of [`sorted_by_shell`].
pub(super) fn describe(
    order: &[(u32, u32)],
    other: &OtherEdges,
    corners: impl Fn(usize) -> [DVec3; 3],
) -> Vec<Component> {
    let mut is_open = vec![false; order.len()];
    for (triangle, _) in &other.uses {
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
        let is_open = is_open[own].iter().any(|open| *open);
        let kind = if is_open { SurfaceKind::Open } else { SurfaceKind::Closed };
        let mut shell = Component { triangles, kind, bounds: Aabb::EMPTY };
        shell.update(&corners);
        shell
    })
    .collect()
}

impl Component {
    /// Sets the bounds and the way that a closed shell looks, by the corners of its triangles.
    pub(super) fn update(&mut self, corners: impl Fn(usize) -> [DVec3; 3]) {
        let own = self.triangles.start as usize..self.triangles.end as usize;
        if self.kind.is_closed() {
            let outwards = looks_outwards(&corners, own.clone());
            self.kind = if outwards { SurfaceKind::Closed } else { SurfaceKind::InsideOut };
        }
        self.bounds = Aabb::from_points(own.flat_map(corners));
    }
}

fn looks_outwards(corners: &impl Fn(usize) -> [DVec3; 3], triangles: Range<usize>) -> bool {
    let origin = corners(triangles.start)[0];
    let (mut volume, mut size) = (0.0, 0.0);
    for triangle in triangles {
        let [a, b, c] = corners(triangle).map(|corner| corner - origin);
        let term = a.dot(b.cross(c));
        (volume, size) = (volume + term, size + f64::abs(term));
    }
    volume > LEAST_VOLUME * size
}
