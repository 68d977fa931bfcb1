//! A plane through the scene, what it cuts out of objects, and its place in a picture.

use glam::{DVec2, DVec3, dvec2};

use super::svg::WIDTH;
use crate::scene::Object;

/// A plane with coordinates, upright as far as it can be.
pub struct Section {
    origin: DVec3,
    right: DVec3,
    up: DVec3,
}

impl Section {
    /// The plane through three points, its first at (0, 0); `None`: they are on a line.
    pub fn through(origin: DVec3, one: DVec3, other: DVec3) -> Option<Self> {
        let normal = (one - origin).cross(other - origin).try_normalize()?;
        let up = (DVec3::Y - normal * normal.y).try_normalize()?;
        Some(Self { origin, right: up.cross(normal), up })
    }

    /// Coordinates of a point, after it is moved into the plane.
    pub fn flat(&self, point: DVec3) -> DVec2 {
        let from = point - self.origin;
        dvec2(from.dot(self.right), from.dot(self.up))
    }

    /// The lines in which the plane cuts an object's triangles.
    pub fn cut(&self, object: &Object) -> Vec<[DVec2; 2]> {
        let normal = self.right.cross(self.up);
        let world = |index: &u32| {
            let corner = object
                .mesh
                .positions
                .get(*index as usize)
                .map(|[x, y, z]| DVec3::new(f64::from(*x), f64::from(*y), f64::from(*z)));
            object.world_from_model.transform_point3(corner.unwrap_or_default())
        };
        let mut lines = Vec::new();
        for triangle in object.mesh.indices.chunks_exact(3) {
            let corners = [&triangle[0], &triangle[1], &triangle[2]].map(world);
            let side = corners.map(|corner| normal.dot(corner - self.origin));
            let crossing = |a: usize, b: usize| {
                let is_crossed = (side[a] < 0.0) != (side[b] < 0.0);
                is_crossed.then(|| self.flat(corners[a].lerp(corners[b], side[a] / (side[a] - side[b]))))
            };
            let ends: Vec<DVec2> = [(0, 1), (1, 2), (2, 0)].into_iter().filter_map(|(a, b)| crossing(a, b)).collect();
            if let [one, other] = ends[..] {
                lines.push([one, other]);
            }
        }
        lines
    }
}

/// Place of a section in a picture.
pub struct Placement {
    least: DVec2,
    scale: f64,
    edge: f64,
    /// Height of the picture.
    pub height: f64,
}

impl Placement {
    /// A picture that shows all of `points`, with an edge around them, at most `highest` high.
    pub fn around(points: &[DVec2], edge: f64, highest: f64) -> Self {
        let least = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let most = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let span = (most - least).max(DVec2::splat(1e-6));
        let scale = ((WIDTH - 2.0 * edge) / span.x).min((highest - 2.0 * edge) / span.y);
        let middle = 0.5 * (WIDTH - 2.0 * edge - scale * span.x) / scale;
        Self { least: least - dvec2(middle, 0.0), scale, edge, height: 2.0 * edge + scale * span.y }
    }

    /// Place of a point of the section.
    pub fn at(&self, point: DVec2) -> DVec2 {
        let place = (point - self.least) * self.scale;
        dvec2(self.edge + place.x, self.height - self.edge - place.y)
    }
}
