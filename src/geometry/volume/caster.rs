//! Adjacency of a caster: what depends on its mesh alone, in flat arrays. Made once a mesh, shared by all instances,
//! lights and frames (`Arc`). Knows no light.

use std::ops::Range;

use glam::DVec3;

use super::components::{self, Component};
use super::planes::Planes;
use crate::geometry::Mesh;
use crate::geometry::topology::weld;

/// The triangles of some ranges of a mesh, welded by exact position, with their edges, planes and shells.
///
/// Triangles two of whose corners lie at one place are left out: they cover nothing, and their two remaining edges
/// cancel. Triangles are numbered by shell, in the mesh's order within each. Places are numbered as the mesh's vertices
/// first meet them, over the whole mesh.
#[derive(Clone, Debug)]
pub struct Caster {
    /// Of each place: the position of its first vertex. Others at the place are equal (0 = -0).
    pub(super) positions: Vec<[f32; 3]>,
    /// Places of each triangle's corners, in the order in which the mesh has them.
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) planes: Planes,
    pub(super) shells: Vec<Component>,
    /// Edges of exactly two triangles that run through them in opposite directions.
    pub(super) plain: PlainEdges,
    /// All other edges.
    pub(super) other: OtherEdges,
}

#[derive(Clone, Debug, Default)]
pub(super) struct PlainEdges {
    /// The two places, as the first triangle runs.
    pub places: Vec<[u32; 2]>,
    /// The first triangle and the second, which runs the other way.
    pub triangles: Vec<[u32; 2]>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct OtherEdges {
    /// The smaller place, the larger.
    pub places: Vec<[u32; 2]>,
    /// Edge k's uses are `uses[ends[k - 1]..ends[k]]`.
    pub ends: Vec<u32>,
    /// A triangle, and whether it runs from the smaller to the larger place (1) or back (-1).
    pub uses: Vec<(u32, i8)>,
}

/// One use of an edge: sorted by its two places, then by triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Use {
    /// The smaller place above the larger.
    places: u64,
    pub triangle: u32,
    /// Whether the triangle runs from the smaller to the larger.
    forward: bool,
}

impl Use {
    fn places(self) -> [u32; 2] {
        [(self.places >> 32) as u32, self.places as u32]
    }
}

impl Caster {
    /// The triangles in `ranges` of `mesh.indices` (whole triangles each, not overlapping), taken together: an object's
    /// parts are one caster, since a surface may be closed only across them.
    pub fn new(mesh: &Mesh, ranges: &[Range<u32>]) -> Self {
        let (places, count) = weld(&mesh.positions);
        let mut positions = vec![[0.0; 3]; count];
        for (vertex, place) in places.iter().enumerate().rev() {
            positions[*place as usize] = mesh.positions[vertex];
        }
        let corners = ranges.iter().flat_map(|range| {
            let indices = mesh.indices.get(range.start as usize..range.end as usize).unwrap_or_default();
            indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(|index| places[index as usize]))
        });
        Self::from_places(positions, corners.filter(|[a, b, c]| a != b && b != c && c != a).collect())
    }

    /// All triangles of a mesh.
    pub fn of_mesh(mesh: &Mesh) -> Self {
        let all = 0..mesh.indices.len() as u32;
        Self::new(mesh, std::slice::from_ref(&all))
    }

    fn from_places(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        let mut uses = uses(&triangles);
        let order = components::sorted_by_shell(triangles.len(), uses.chunk_by(|a, b| a.places == b.places));
        let triangles: Vec<[u32; 3]> = order.iter().map(|(_, triangle)| triangles[*triangle as usize]).collect();
        if !order.is_sorted_by_key(|(_, triangle)| *triangle) {
            renumber(&mut uses, &order);
        }
        let (plain, other) = find_edges(&uses);
        let planes = Planes::new(&positions, &triangles);
        let mut caster = Self { positions, triangles, planes, shells: Vec::new(), plain, other };
        caster.shells = components::describe(&caster, &order);
        caster
    }

    /// Triangles that may count: none of them collapsed.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    pub fn edge_count(&self) -> usize {
        self.plain.places.len() + self.other.places.len()
    }

    /// The caster's edge-connected pieces.
    pub fn shells(&self) -> &[Component] {
        &self.shells
    }

    /// Whether every shell is closed and consistently wound.
    pub fn is_closed(&self) -> bool {
        self.shells.iter().all(|shell| shell.kind.is_closed())
    }

    /// Positions by place, in model space.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Places of each triangle's corners, as the mesh runs.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    pub(super) fn position(&self, place: u32) -> DVec3 {
        DVec3::from_array(self.positions[place as usize].map(f64::from))
    }

    pub(super) fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|place| self.position(place))
    }
}

/// All edges of all triangles, those of one edge together.
fn uses(triangles: &[[u32; 3]]) -> Vec<Use> {
    let mut uses = Vec::with_capacity(3 * triangles.len());
    for (triangle, [a, b, c]) in (0u32..).zip(triangles) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let places = (u64::from(*from.min(to)) << 32) | u64::from(*from.max(to));
            uses.push(Use { places, triangle, forward: from < to });
        }
    }
    uses.sort_unstable();
    uses
}

/// For triangles in another order.
fn renumber(uses: &mut [Use], order: &[(u32, u32)]) {
    let mut new_from_old = vec![0; order.len()];
    for (new, (_, old)) in (0u32..).zip(order) {
        new_from_old[*old as usize] = new;
    }
    for each in &mut *uses {
        each.triangle = new_from_old[each.triangle as usize];
    }
    uses.sort_unstable();
}

fn find_edges(uses: &[Use]) -> (PlainEdges, OtherEdges) {
    let (mut plain, mut other) = (PlainEdges::default(), OtherEdges::default());
    for edge in uses.chunk_by(|a, b| a.places == b.places) {
        let [low, high] = edge[0].places();
        match edge {
            [a, b] if a.forward != b.forward => {
                plain.places.push(if a.forward { [low, high] } else { [high, low] });
                plain.triangles.push([a.triangle, b.triangle]);
            }
            _ => {
                other.places.push([low, high]);
                other.uses.extend(edge.iter().map(|each| (each.triangle, if each.forward { 1 } else { -1 })));
                other.ends.push(other.uses.len() as u32);
            }
        }
    }
    (plain, other)
}

impl OtherEdges {
    /// Each edge's places and uses.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], &[(u32, i8)])> {
        let starts = std::iter::once(&0).chain(&self.ends);
        let uses = starts.zip(&self.ends).map(|(start, end)| &self.uses[*start as usize..*end as usize]);
        self.places.iter().copied().zip(uses)
    }
}
