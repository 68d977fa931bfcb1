//! Connections of a mesh's triangles: places (vertices welded by position), edges, closedness.

use glam::DVec3;

use super::Mesh;
use crate::process::work;

/// The place of each vertex, and the number of places: vertices whose positions are equal (0 = -0) share one. Places are
/// numbered as they are first met.
pub fn weld(positions: &[[f32; 3]]) -> (Vec<u32>, usize) {
    const FREE: u32 = u32::MAX;
    let capacity = (2 * positions.len()).next_power_of_two().max(2);
    let mask = capacity - 1;
    // Open addressing: vertex that stands for the place.
    let mut table = vec![FREE; capacity];
    let mut places = Vec::with_capacity(positions.len());
    let mut count = 0;
    for (vertex, position) in (0u32..).zip(positions) {
        let mut slot = hash(position) as usize & mask;
        loop {
            let held = table[slot];
            if held == FREE {
                table[slot] = vertex;
                places.push(count);
                count += 1;
                break;
            }
            if positions[held as usize] == *position {
                places.push(places[held as usize]);
                break;
            }
            slot = (slot + 1) & mask;
        }
    }
    (places, count as usize)
}

fn hash(position: &[f32; 3]) -> u64 {
    // Adding zero makes 0 of -0, as they compare equal.
    let [x, y, z] = position.map(|value| u64::from((value + 0.0).to_bits()));
    let mut h = (x | (y << 32)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    h = (h ^ (h >> 29) ^ z).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 32)).wrapping_mul(0x94d0_49bb_1331_11eb);
    h ^ (h >> 31)
}

/// Counts of a mesh's edges and triangles. Triangles two of whose corners share a place do not count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Topology {
    /// Places that a triangle uses.
    pub places: usize,
    pub edges: usize,
    pub triangles: usize,
    /// Edges with one triangle.
    pub open_edges: usize,
    /// Edges with two triangles that run through them in the same direction.
    pub turned_edges: usize,
    /// Edges with more than two triangles.
    pub crowded_edges: usize,
}

impl Topology {
    /// Tests whether every edge has two triangles, which run through it in opposite directions.
    pub fn is_closed(&self) -> bool {
        self.triangles > 0 && self.open_edges == 0 && self.turned_edges == 0 && self.crowded_edges == 0
    }

    /// V - E + F; 2 for each closed surface without holes.
    pub fn euler_characteristic(&self) -> i64 {
        self.places as i64 - self.edges as i64 + self.triangles as i64
    }
}

/// Counts the mesh's places, edges and triangles.
pub fn inspect(mesh: &Mesh) -> Topology {
    let (places, count) = weld(&mesh.positions);
    let mut topology = Topology::default();
    let mut used = vec![false; count];
    // Each edge as the smaller place, the larger place, and in the last bit whether it runs from small to large.
    let mut edges: Vec<u64> = Vec::with_capacity(mesh.indices.len());
    work::count_triangles(mesh.indices.len());
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|index| places[index as usize]);
        if a == b || b == c || c == a {
            continue;
        }
        topology.triangles += 1;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            used[from as usize] = true;
            let (low, high) = (u64::from(from.min(to)), u64::from(from.max(to)));
            edges.push((low << 33) | (high << 1) | u64::from(from < to));
        }
    }
    edges.sort_unstable();
    for uses in edges.chunk_by(|a, b| a >> 1 == b >> 1) {
        topology.edges += 1;
        match uses {
            [_] => topology.open_edges += 1,
            [a, b] => topology.turned_edges += usize::from(a == b),
            _ => topology.crowded_edges += 1,
        }
    }
    topology.places = used.into_iter().filter(|used| *used).count();
    topology
}

impl Mesh {
    /// Tests whether the mesh bounds a solid: see [`Topology::is_closed`].
    pub fn is_closed(&self) -> bool {
        inspect(self).is_closed()
    }

    /// The volume that a closed mesh bounds, in its own units; negative where more of it is inside out than not.
    pub fn signed_volume(&self) -> f64 {
        let corner = |index: &u32| DVec3::from(self.positions[*index as usize].map(f64::from)) - self.bounds.center();
        let sixfold = |t: &[u32]| corner(&t[0]).dot(corner(&t[1]).cross(corner(&t[2])));
        self.indices.chunks_exact(3).map(sixfold).sum::<f64>() / 6.0
    }
}
