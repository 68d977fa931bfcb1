//! Counts by brute force: how often a ray crosses a volume's homogeneous triangles, and how many triangles of a mesh
//! stand between a light and a point.

use glam::{DMat4, DVec3, DVec4};
use glumbra::geometry::Mesh;
use glumbra::geometry::volume::{LightSource, Volume};

/// A triangle's corners (w >= 0) and how often it counts.
pub type Triangle = ([DVec4; 3], i32);

/// All triangles of a volume, turned so that they run counter-clockwise seen from outside.
pub fn triangles(volume: &Volume) -> Vec<Triangle> {
    let all = 0..volume.indices().len() as u32;
    let reversed = volume.light_cap_reversed();
    let wound = |first: u32, [a, b, c]: [DVec4; 3]| if reversed.contains(&first) { [a, c, b] } else { [a, b, c] };
    let corners = |range| corners(volume.vertices(), volume.indices(), range);
    (0u32..).step_by(3).zip(corners(all)).map(|(first, corners)| (wound(first, corners), 1)).collect()
}

pub fn corners(vertices: &[[f32; 4]], indices: &[u32], range: std::ops::Range<u32>) -> Vec<[DVec4; 3]> {
    let vertex = |index: u32| DVec4::from_array(vertices[index as usize].map(f64::from));
    indices[range.start as usize..range.end as usize].as_chunks::<3>().0.iter().map(|t| t.map(vertex)).collect()
}

/// Ways out less ways in along the ray from `origin`: what z-fail counts.
pub fn exits(triangles: &[Triangle], origin: DVec3, way: DVec3) -> i32 {
    triangles.iter().map(|triangle| crossing(triangle, origin, way).map_or(0, |(_, sign)| sign)).sum()
}

/// Ways in less ways out on the segment from `origin` to `origin + way`: what z-pass counts.
pub fn entries(triangles: &[Triangle], origin: DVec3, way: DVec3) -> i32 {
    let crossings = triangles.iter().filter_map(|triangle| crossing(triangle, origin, way));
    crossings.filter(|(t, _)| *t < 1.0).map(|(_, sign)| -sign).sum()
}

/// Parameter where the ray crosses it, and 1 for a way out, -1 for a way in.
fn crossing(([a, b, c], count): &Triangle, origin: DVec3, way: DVec3) -> Option<(f64, i32)> {
    let det = |p: &DVec4, q: &DVec4, r: &DVec4, s: &DVec4| DMat4::from_cols(*p, *q, *r, *s).determinant();
    let (o, r) = (origin.extend(1.0), way.extend(0.0));
    let weights = [det(&o, &r, b, c), det(&o, &r, c, a), det(&o, &r, a, b)];
    if !(weights.iter().all(|w| *w > 0.0) || weights.iter().all(|w| *w < 0.0)) {
        return None;
    }
    if a.w == 0.0 && b.w == 0.0 && c.w == 0.0 {
        // At infinity: crossed by rays whose direction is between the corners', outwards if they run so seen from within.
        let [a, b, c] = [a, b, c].map(|corner| corner.truncate());
        let size = a.dot(b.cross(c));
        let is_ahead = [b.cross(c), c.cross(a), a.cross(b)].iter().all(|n| n.dot(way) * size > 0.0);
        return is_ahead.then_some((f64::INFINITY, if size > 0.0 { *count } else { -count }));
    }
    let along = det(a, b, c, &r);
    let t = -det(a, b, c, &o) / along;
    (t > 0.0).then_some((t, if along < 0.0 { *count } else { -count }))
}

/// Number of triangles of `mesh` that the way from the light to `point` crosses: those that face the light, or all. `None`
/// where that is too near to call.
pub fn blockers(mesh: &Mesh, source: LightSource, point: DVec3, facing_only: bool) -> Option<i32> {
    const MARGIN: f64 = 1e-4;
    let way = match source {
        LightSource::Point(light) => light - point,
        LightSource::Direction(way) => way * (20.0 / way.length()),
    };
    let mut count = 0;
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|k| DVec3::from_array(mesh.positions[k as usize].map(f64::from)) - point);
        let normal = (b - a).cross(c - a);
        if normal == DVec3::ZERO {
            continue;
        }
        // Nearly edge-on as seen along the way, or nearly empty: too near if the way passes near it.
        let (rise, height) = (normal.dot(way), normal.dot(a));
        let volumes = [b.cross(c), c.cross(a), a.cross(b)].map(|n| n.dot(way) / (1.0 + n.length()) / way.length());
        let is_near = volumes.iter().all(|v| *v > -MARGIN) || volumes.iter().all(|v| *v < MARGIN);
        let t = height / rise;
        if !is_near || !(-MARGIN..=1.0 + MARGIN).contains(&t) {
            continue;
        }
        if volumes.iter().any(|v| v.abs() < MARGIN) || t.abs() < MARGIN || (t - 1.0).abs() < MARGIN || t.is_nan() {
            return None;
        }
        count += i32::from(!facing_only || rise > 0.0);
    }
    Some(count)
}

pub fn to_world(mesh: &Mesh, world_from_model: &DMat4) -> Mesh {
    let mut mesh = mesh.clone();
    for position in &mut mesh.positions {
        let point = DVec3::from_array(position.map(f64::from));
        *position = world_from_model.transform_point3(point).as_vec3().to_array();
    }
    if world_from_model.determinant() < 0.0 {
        mesh.indices.as_chunks_mut::<3>().0.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    mesh
}

/// Seeded points and directions in the cube of half `size`.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// In [-1, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit()) * size
    }
}
