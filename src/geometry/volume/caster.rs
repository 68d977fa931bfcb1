//! Adjacency of a caster: everything that depends only on its mesh, in flat arrays. Made once for each mesh, shared by all
//! instances, lights and frames (`Arc`). Knows no light.

use std::ops::Range;

use glam::DVec3;

use super::components::{self, Component};
use super::edges::{OtherEdges, PlainEdges, find_edges, renumber, uses};
use super::planes::Planes;
use crate::geometry::Mesh;
use crate::geometry::topology::weld;
use crate::process::work;

/// The triangles of some ranges of a mesh, welded by exact position, with their edges, planes and shells.
///
/// Triangles two of whose corners lie at one place are left out: they cover nothing, and their two remaining edges
/// cancel. Triangles are numbered by shell, in the mesh's order within each. Places are numbered as the mesh's vertices
/// first meet them, over the whole mesh.
#[derive(Clone, Debug)]
pub struct Caster {
    /// Position of each place, by its first vertex. Others at the place are equal (0 = -0).
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
        Self::of_places(positions, corners.collect())
    }

    /// All triangles of a mesh.
    pub fn of_mesh(mesh: &Mesh) -> Self {
        let all = 0..mesh.indices.len() as u32;
        Self::new(mesh, std::slice::from_ref(&all))
    }

    /// Triangles of places, three indices into `positions` each, for vertices that move: two of them are one place if they are
    /// so in every pose.
    pub fn of_places(positions: Vec<[f32; 3]>, mut triangles: Vec<[u32; 3]>) -> Self {
        work::count_triangles(3 * triangles.len());
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        let mut uses = uses(&triangles);
        let order = components::sorted_by_shell(triangles.len(), uses.chunk_by(|a, b| a.places == b.places));
        let triangles: Vec<[u32; 3]> = order.iter().map(|(_, triangle)| triangles[*triangle as usize]).collect();
        if !order.is_sorted_by_key(|(_, triangle)| *triangle) {
            renumber(&mut uses, &order);
        }
        let (plain, other) = find_edges(&uses);
        let planes = Planes::new(&positions, &triangles);
        let mut caster = Self { positions, triangles, planes, shells: Vec::new(), plain, other };
        caster.shells = components::describe(&order, &caster.other, |triangle| caster.corners(triangle));
        caster
    }

    /// Moves every place to `position` of its number. Edges and shells stay, even where places meet.
    pub fn move_to(&mut self, position: impl FnMut(usize) -> [f32; 3]) {
        self.move_places(position);
        self.planes.set(&self.positions, &self.triangles);
    }

    /// [`Self::move_to`] without the triangles' planes, for [`Outline::find_between`](super::Outline::find_between), which has
    /// its own; [`Outline::find`](super::Outline::find) then tests each triangle by exact arithmetic.
    pub fn move_places(&mut self, mut position: impl FnMut(usize) -> [f32; 3]) {
        self.planes.clear();
        self.positions.iter_mut().enumerate().for_each(|(place, own)| *own = position(place));
        let Self { positions, triangles, shells, .. } = self;
        let corners = |triangle: usize| triangles[triangle].map(|place| corner(positions, place));
        shells.iter_mut().for_each(|shell| shell.update(corners));
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

    /// Tests whether every shell is closed and consistently wound.
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
        corner(&self.positions, place)
    }

    pub(super) fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|place| self.position(place))
    }
}

fn corner(positions: &[[f32; 3]], place: u32) -> DVec3 {
    DVec3::from_array(positions[place as usize].map(f64::from))
}
