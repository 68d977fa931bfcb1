//! The zero surface of a field as triangles, by marching tetrahedra. The lattice's points may be moved: which triangles
//! there are depends on signs only, so that the surface is closed whatever the points' places.

use std::collections::HashMap;

use glam::DVec3;

/// A lattice of cells, each of six tetrahedra around the diagonal from its lowest to its highest corner.
pub struct Lattice {
    /// Points along x, y and z.
    pub size: [usize; 3],
    /// Places, x fastest, then y, then z.
    pub points: Vec<DVec3>,
    /// The field at the points; negative inside. No point on the lattice's border is inside.
    pub values: Vec<f64>,
}

/// Least distance of a vertex from the end of a lattice edge, as a share of its length.
const LEAST_SHARE: f64 = 0.06;

/// The axes' orders in which a tetrahedron's edges walk from a cell's lowest corner to its highest, and whether the
/// order is an odd permutation.
const WALKS: [([usize; 3], bool); 6] = [
    ([0, 1, 2], false),
    ([1, 2, 0], false),
    ([2, 0, 1], false),
    ([0, 2, 1], true),
    ([1, 0, 2], true),
    ([2, 1, 0], true),
];

/// Vertices in the order in which a sweep along y (from the top), z and x meets them; triangles wound
/// counter-clockwise seen from outside.
pub fn polygonise(lattice: &Lattice) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut surface = Surface { lattice, vertices: HashMap::new(), positions: Vec::new(), triangles: Vec::new() };
    let [nx, ny, nz] = lattice.size;
    let strides = [1, nx, nx * ny];
    for y in (0..ny - 1).rev() {
        for z in 0..nz - 1 {
            for x in 0..nx - 1 {
                let lowest = x * strides[0] + y * strides[1] + z * strides[2];
                for (walk, odd) in WALKS {
                    let second = lowest + strides[walk[0]];
                    let third = second + strides[walk[1]];
                    let highest = third + strides[walk[2]];
                    // Exchanging two corners makes all tetrahedra of one orientation.
                    let corners = if odd { [lowest, third, second, highest] } else { [lowest, second, third, highest] };
                    surface.add_tetrahedron(corners);
                }
            }
        }
    }
    (surface.positions, surface.triangles)
}

struct Surface<'a> {
    lattice: &'a Lattice,
    /// The vertex on each lattice edge, the edge's ends in order.
    vertices: HashMap<(usize, usize), u32>,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Surface<'_> {
    /// `corners` are such that the last three turn counter-clockwise seen from within, from the first.
    fn add_tetrahedron(&mut self, corners: [usize; 4]) {
        let inside = corners.map(|corner| self.lattice.values[corner] < 0.0);
        let count = inside.iter().filter(|inside| **inside).count();
        match count {
            1 | 3 => {
                let alone = inside.iter().position(|inside| *inside == (count == 1)).unwrap_or(0);
                let [i, j, k, l] = even_order(alone).map(|at| corners[at]);
                let [a, b, c] = [self.vertex(i, j), self.vertex(i, k), self.vertex(i, l)];
                self.triangles.push(if count == 1 { [a, b, c] } else { [a, c, b] });
            }
            2 => {
                let order = even_order_of_pair(inside);
                let [i, j, k, l] = order.map(|at| corners[at]);
                let quad = [self.vertex(i, k), self.vertex(i, l), self.vertex(j, l), self.vertex(j, k)];
                let [a, b, c, d] = quad;
                // Either diagonal is right; the shorter makes fewer slivers.
                let length = |p: u32, q: u32| self.positions[p as usize].distance_squared(self.positions[q as usize]);
                let split = if length(a, c) < length(b, d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                self.triangles.extend(split);
            }
            _ => {}
        }
    }

    /// The vertex on the edge between two lattice points of different sign.
    fn vertex(&mut self, a: usize, b: usize) -> u32 {
        let (a, b) = (a.min(b), a.max(b));
        let Lattice { points, values, .. } = self.lattice;
        let positions = &mut self.positions;
        *self.vertices.entry((a, b)).or_insert_with(|| {
            let share = (values[a] / (values[a] - values[b])).clamp(LEAST_SHARE, 1.0 - LEAST_SHARE);
            positions.push(points[a] + (points[b] - points[a]) * share);
            positions.len() as u32 - 1
        })
    }
}

/// The corners' even permutation that begins with `first`.
fn even_order(first: usize) -> [usize; 4] {
    [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]][first]
}

/// The corners' even permutation that begins with the two that are inside.
fn even_order_of_pair(inside: [bool; 4]) -> [usize; 4] {
    const ORDERS: [[usize; 4]; 6] =
        [[0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2], [1, 2, 0, 3], [1, 3, 2, 0], [2, 3, 0, 1]];
    ORDERS.into_iter().find(|order| inside[order[0]] && inside[order[1]]).unwrap_or(ORDERS[0])
}
