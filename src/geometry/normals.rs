//! Normals that a file lacks: smooth where neighbouring triangles meet at less than the crease angle.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::{Mesh, topology};

/// A sine below which two edges of a triangle are taken for parallel: the triangle has no normal.
const LEAST_SINE: f64 = 1e-12;

/// Gives every vertex of `mesh` a unit normal: given ones are scaled; those of no length or not finite are computed from
/// the triangles around the vertex's place, each weighted by its angle there, up to edges whose triangles differ by more
/// than `crease_radians`. Vertices on such edges are split. Returns how many given ones (not of zeros) were unusable.
///
/// `mesh.normals` is as long as `mesh.positions`; (0, 0, 0) stands for a missing normal.
pub(super) fn complete(mesh: &mut Mesh, crease_radians: f64) -> usize {
    let mut unusable = 0;
    let mut lacking = vec![false; mesh.normals.len()];
    for (normal, lacks) in mesh.normals.iter_mut().zip(&mut lacking) {
        match Vec3::from_array(*normal).as_dvec3().try_normalize() {
            Some(unit) if normal.iter().all(|x| x.is_finite()) => *normal = unit.as_vec3().to_array(),
            _ => {
                unusable += usize::from(*normal != [0.0; 3]);
                *normal = [0.0; 3];
                *lacks = true;
            }
        }
    }
    if lacking.contains(&true) {
        Smoother::new(mesh, crease_radians).fill(mesh, &lacking);
    }
    unusable
}

struct Smoother {
    crease_cosine: f64,
    /// Cosine of the angle to the mean within which all pairs are within the crease angle.
    half_crease_cosine: f64,
    /// The place (welded vertex) of each vertex.
    places: Vec<u32>,
    /// Start of each place's corners in `corners`; one more than places.
    starts: Vec<u32>,
    /// Corners (indices into the mesh's indices), by place.
    corners: Vec<u32>,
    /// Normal of each triangle; zero if it has none.
    normals: Vec<DVec3>,
    /// Angle of each corner, in radians.
    angles: Vec<f32>,
}

impl Smoother {
    fn new(mesh: &Mesh, crease_radians: f64) -> Self {
        let (places, count) = topology::weld(&mesh.positions);
        let mut starts = vec![0u32; count + 1];
        for index in &mesh.indices {
            starts[places[*index as usize] as usize + 1] += 1;
        }
        for place in 0..count {
            starts[place + 1] += starts[place];
        }
        let mut next = starts.clone();
        let mut corners = vec![0u32; mesh.indices.len()];
        for (corner, index) in (0u32..).zip(&mesh.indices) {
            let slot = &mut next[places[*index as usize] as usize];
            corners[*slot as usize] = corner;
            *slot += 1;
        }
        let (normals, angles) = measure_triangles(mesh);
        Self {
            crease_cosine: crease_radians.cos(),
            half_crease_cosine: (0.5 * crease_radians).cos(),
            places,
            starts,
            corners,
            normals,
            angles,
        }
    }

    /// Gives each corner at a `lacking` vertex its normal, and splits the vertices that get several.
    fn fill(&self, mesh: &mut Mesh, lacking: &[bool]) {
        let vertices = mesh.positions.len();
        let mut fan = Fan::default();
        let mut split: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
        // Corners with their new vertices; put in place at the end, as the indices are still read.
        let mut moved = Vec::new();
        for span in self.starts.windows(2) {
            let corners = &self.corners[span[0] as usize..span[1] as usize];
            if !corners.iter().any(|corner| lacking[mesh.indices[*corner as usize] as usize]) {
                continue;
            }
            self.smooth(corners, mesh, &mut fan);
            for (corner, normal) in corners.iter().zip(&fan.result) {
                let vertex = mesh.indices[*corner as usize];
                if !lacking[vertex as usize] {
                    continue;
                }
                let current = mesh.normals[vertex as usize];
                if current == [0.0; 3] {
                    mesh.normals[vertex as usize] = *normal;
                } else if current != *normal {
                    let key = (vertex, normal.map(f32::to_bits));
                    let new = *split.entry(key).or_insert_with(|| push_copy(mesh, vertex, *normal));
                    moved.push((*corner, new));
                }
            }
        }
        for (corner, vertex) in moved {
            mesh.indices[corner as usize] = vertex;
        }
        // Vertices that no triangle uses.
        for normal in &mut mesh.normals[..vertices] {
            if *normal == [0.0; 3] {
                *normal = [0.0, 0.0, 1.0];
            }
        }
    }

    /// The normals of `corners`, which are all at one place, into `fan.result`.
    fn smooth(&self, corners: &[u32], mesh: &Mesh, fan: &mut Fan) {
        fan.result.clear();
        let weighted = |corner: &u32| self.normals[*corner as usize / 3] * f64::from(self.angles[*corner as usize]);
        let sum: DVec3 = corners.iter().map(weighted).sum();
        let mean = sum.normalize_or_zero();
        let agree = |corner: &u32| {
            let normal = self.normals[*corner as usize / 3];
            normal == DVec3::ZERO || normal.dot(mean) >= self.half_crease_cosine
        };
        if corners.iter().all(agree) {
            fan.result.resize(corners.len(), unit_or_z(sum));
            return;
        }
        fan.join_over_smooth_edges(self, corners, mesh);
        fan.sums.clear();
        fan.sums.resize(corners.len(), DVec3::ZERO);
        for (k, corner) in corners.iter().enumerate() {
            let group = fan.find(k);
            fan.sums[group] += weighted(corner);
        }
        // Triangles without area go with any that has one: they cover no pixel.
        let any = fan.sums.iter().copied().find(|sum| *sum != DVec3::ZERO).unwrap_or(DVec3::ZERO);
        for k in 0..corners.len() {
            let group = fan.find(k);
            let sum = fan.sums[group];
            fan.result.push(unit_or_z(if sum == DVec3::ZERO { any } else { sum }));
        }
    }
}

/// The corners at one place while they are grouped; kept between places to save allocations.
#[derive(Default)]
struct Fan {
    /// Union-find over the corners.
    parent: Vec<usize>,
    /// (the place at the other end of an edge, the corner whose triangle has it).
    edges: Vec<(u32, usize)>,
    sums: Vec<DVec3>,
    result: Vec<[f32; 3]>,
}

impl Fan {
    fn join_over_smooth_edges(&mut self, smoother: &Smoother, corners: &[u32], mesh: &Mesh) {
        self.parent.clear();
        self.parent.extend(0..corners.len());
        self.edges.clear();
        for (k, corner) in corners.iter().enumerate() {
            let first = corner - corner % 3;
            for other in [first + (corner + 1) % 3, first + (corner + 2) % 3] {
                self.edges.push((smoother.places[mesh.indices[other as usize] as usize], k));
            }
        }
        self.edges.sort_unstable();
        for at in 1..self.edges.len() {
            let ((place_a, a), (place_b, b)) = (self.edges[at - 1], self.edges[at]);
            let normal = |k: usize| smoother.normals[corners[k] as usize / 3];
            if place_a == place_b && normal(a).dot(normal(b)) >= smoother.crease_cosine {
                let (a, b) = (self.find(a), self.find(b));
                self.parent[a.max(b)] = a.min(b);
            }
        }
    }

    fn find(&mut self, mut k: usize) -> usize {
        while self.parent[k] != k {
            self.parent[k] = self.parent[self.parent[k]];
            k = self.parent[k];
        }
        k
    }
}

/// The unit normal of each triangle and the angle of each corner; zero where a triangle has no area.
fn measure_triangles(mesh: &Mesh) -> (Vec<DVec3>, Vec<f32>) {
    let mut normals = Vec::with_capacity(mesh.triangle_count());
    let mut angles = Vec::with_capacity(mesh.indices.len());
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|index| Vec3::from_array(mesh.positions[index as usize]).as_dvec3());
        let [ab, bc, ca] = [b - a, c - b, a - c].map(DVec3::normalize_or_zero);
        // The sines of all corners; the largest is the best conditioned.
        let crosses = [ab.cross(-ca), bc.cross(-ab), ca.cross(-bc)];
        let best =
            crosses.into_iter().max_by(|p, q| p.length_squared().total_cmp(&q.length_squared())).unwrap_or_default();
        if best.length() <= LEAST_SINE {
            normals.push(DVec3::ZERO);
            angles.extend([0.0; 3]);
            continue;
        }
        normals.push(best.normalize_or_zero());
        let angle_a = (ab.dot(-ca)).clamp(-1.0, 1.0).acos();
        let angle_b = (bc.dot(-ab)).clamp(-1.0, 1.0).acos();
        angles.extend([angle_a, angle_b, std::f64::consts::PI - angle_a - angle_b].map(|angle| angle.max(0.0) as f32));
    }
    (normals, angles)
}

/// Appends a copy of `vertex` with another normal; returns its index.
fn push_copy(mesh: &mut Mesh, vertex: u32, normal: [f32; 3]) -> u32 {
    let new = mesh.positions.len() as u32;
    mesh.positions.push(mesh.positions[vertex as usize]);
    mesh.normals.push(normal);
    if let Some(texcoords) = &mut mesh.texcoords {
        texcoords.push(texcoords[vertex as usize]);
    }
    if let Some(colors) = &mut mesh.colors {
        colors.push(colors[vertex as usize]);
    }
    if let Some(tangents) = &mut mesh.tangents {
        tangents.tangents.push(tangents.tangents[vertex as usize]);
        tangents.bitangents.push(tangents.bitangents[vertex as usize]);
    }
    new
}

fn unit_or_z(sum: DVec3) -> [f32; 3] {
    sum.normalize_or(DVec3::Z).as_vec3().to_array()
}
