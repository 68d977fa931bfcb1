//! A mesh made ready for rays, in its own space: a box hierarchy, welded corners and the triangles across each edge.
//! One for each mesh, however often it is placed.

use std::collections::HashMap;

use glam::DVec3;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};

use super::{Error, wave};
use crate::geometry::{Mesh, Wave};

/// No single triangle lies across this edge: it is open, or three triangles or more meet in it.
pub(super) const OPEN: u32 = u32::MAX;

pub(super) struct Solid<'a> {
    pub mesh: &'a Mesh,
    /// In model space, where a wave has moved them to.
    positions: Vec<DVec3>,
    pub bvh: Bvh,
    /// Each triangle's corners by place: equal where the positions are equal, whatever their normals.
    pub welded: Vec<[u32; 3]>,
    /// For a triangle's edge k (corner k to k+1) the corner opposite that edge in the one triangle across it, an index
    /// into the mesh's positions, or [`OPEN`].
    pub across: Vec<[u32; 3]>,
    /// True if edge k joins two parts or vertices of other texture coordinates: alpha may jump there.
    pub seam: Vec<[bool; 3]>,
    /// Each triangle's part; `u32::MAX` where no part holds it.
    pub part: Vec<u32>,
}

impl<'a> Solid<'a> {
    /// Fails where the mesh breaks its own rules: an index too large, a position not finite.
    pub fn new(mesh: &'a Mesh, wave: Option<&Wave>) -> Result<Self, Error> {
        check(mesh)?;
        let places = mesh.positions.iter().map(|position| DVec3::from_array(position.map(f64::from)));
        let positions: Vec<DVec3> = places.map(|place| wave.map_or(place, |wave| wave::moved(place, wave))).collect();
        let corners: Vec<[u32; 3]> = mesh.indices.as_chunks::<3>().0.to_vec();
        let hierarchy = || {
            let boxes: Vec<Aabb> = corners.iter().map(|triangle| bound(&positions, triangle)).collect();
            Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
        };
        let part = parts(mesh, corners.len());
        let (bvh, joined) = rayon::join(hierarchy, || join_edges(mesh, &corners, &part));
        let JoinedEdges { welded, across, seam } = joined;
        Ok(Self { mesh, positions, bvh, welded, across, seam, part })
    }

    /// A vertex in model space.
    pub fn position(&self, index: u32) -> DVec3 {
        self.positions[index as usize]
    }

    /// All vertices in model space.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The triangle's three indices.
    pub fn corners(&self, triangle: u32) -> [u32; 3] {
        let first = 3 * triangle as usize;
        [self.mesh.indices[first], self.mesh.indices[first + 1], self.mesh.indices[first + 2]]
    }

    /// Tests whether two corners fall together, so that the triangle covers nothing.
    pub fn is_degenerate(&self, triangle: u32) -> bool {
        is_flat(&self.welded[triangle as usize])
    }

    /// Tests whether two triangles share a corner.
    pub fn touch(&self, one: u32, other: u32) -> bool {
        let other = self.welded[other as usize];
        self.welded[one as usize].iter().any(|corner| other.contains(corner))
    }
}

/// Each triangle's corners by place, and by edge what lies across it, as in [`Solid`].
struct JoinedEdges {
    welded: Vec<[u32; 3]>,
    across: Vec<[u32; 3]>,
    seam: Vec<[bool; 3]>,
}

fn join_edges(mesh: &Mesh, corners: &[[u32; 3]], part: &[u32]) -> JoinedEdges {
    let welded = weld(mesh, corners);
    let beside = find_beside(&welded);
    let across = (0u32..).zip(&beside).map(|(triangle, beside)| {
        [0, 1, 2].map(|k| beside[k].map_or(OPEN, |other| opposite(corners, &welded, triangle, k, other)))
    });
    let across = across.collect();
    let is_seam = |triangle: usize, k: usize, other: u32| {
        let edge = [corners[triangle][k], corners[triangle][(k + 1) % 3]];
        part[triangle] != part[other as usize] || !edge.iter().all(|end| corners[other as usize].contains(end))
    };
    let seam = beside.iter().enumerate();
    let seam =
        seam.map(|(triangle, beside)| [0, 1, 2].map(|k| beside[k].is_some_and(|other| is_seam(triangle, k, other))));
    let seam = seam.collect();
    JoinedEdges { welded, across, seam }
}

fn check(mesh: &Mesh) -> Result<(), Error> {
    let broken = |what: &str| Err(Error::Mesh { name: mesh.name.clone(), what: what.to_owned() });
    if !mesh.indices.len().is_multiple_of(3) {
        return broken("its indices are not whole triangles");
    }
    if mesh.indices.iter().any(|&index| index as usize >= mesh.positions.len()) {
        return broken("an index points past the last vertex");
    }
    if mesh.positions.iter().flatten().any(|value| !value.is_finite()) {
        return broken("a position is not finite");
    }
    Ok(())
}

fn bound(positions: &[DVec3], triangle: &[u32; 3]) -> Aabb {
    let [a, b, c] = triangle.map(|i| positions[i as usize]);
    let (min, max) = (a.min(b).min(c), a.max(b).max(c));
    Aabb::new(Vector::from_array(min.to_array()), Vector::from_array(max.to_array()))
}

fn weld(mesh: &Mesh, corners: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut first_at: HashMap<[u32; 3], u32> = HashMap::with_capacity(mesh.positions.len());
    let place: Vec<u32> = (0u32..)
        .zip(&mesh.positions)
        .map(|(index, position)| {
            // Adding zero turns -0 into +0, so that equal positions have equal bits.
            let key = position.map(|value| (value + 0.0).to_bits());
            *first_at.entry(key).or_insert(index)
        })
        .collect();
    corners.iter().map(|triangle| triangle.map(|index| place[index as usize])).collect()
}

/// For each triangle and edge the one triangle across it; `None`: open, or three or more meet there.
fn find_beside(welded: &[[u32; 3]]) -> Vec<[Option<u32>; 3]> {
    // The first two triangles of an edge, and how many there are.
    let mut edges: HashMap<(u32, u32), (u32, [u32; 2])> = HashMap::with_capacity(welded.len() * 3 / 2);
    let key = |w: &[u32; 3], k: usize| (w[k].min(w[(k + 1) % 3]), w[k].max(w[(k + 1) % 3]));
    for (triangle, w) in (0u32..).zip(welded).filter(|(_, w)| !is_flat(w)) {
        for k in 0..3 {
            let (count, sides) = edges.entry(key(w, k)).or_insert((0, [OPEN; 2]));
            if let Some(side) = sides.get_mut(*count as usize) {
                *side = triangle;
            }
            *count += 1;
        }
    }
    let beside = |triangle: u32, w: &[u32; 3], k: usize| match edges.get(&key(w, k)) {
        Some(&(2, sides)) if !is_flat(w) => Some(sides[usize::from(sides[0] == triangle)]),
        _ => None,
    };
    (0u32..).zip(welded).map(|(triangle, w)| [0, 1, 2].map(|k| beside(triangle, w, k))).collect()
}

fn is_flat(w: &[u32; 3]) -> bool {
    w[0] == w[1] || w[1] == w[2] || w[2] == w[0]
}

/// The corner of `other` that does not lie on edge k of `triangle`.
fn opposite(corners: &[[u32; 3]], welded: &[[u32; 3]], triangle: u32, k: usize, other: u32) -> u32 {
    let w = welded[triangle as usize];
    let edge = [w[k], w[(k + 1) % 3]];
    let found = (0..3).find(|&i| !edge.contains(&welded[other as usize][i]));
    found.map_or(OPEN, |i| corners[other as usize][i])
}

fn parts(mesh: &Mesh, triangles: usize) -> Vec<u32> {
    let mut part = vec![u32::MAX; triangles];
    for (index, range) in (0u32..).zip(mesh.parts.iter().map(|part| &part.indices)) {
        let (first, end) = (range.start as usize / 3, range.end as usize / 3);
        if let Some(run) = part.get_mut(first.min(triangles)..end.min(triangles).max(first.min(triangles))) {
            run.fill(index);
        }
    }
    part
}
