//! Way in which a component counts under a light, and whether the light is inside of it.

use glam::DVec3;
use robust::{Coord, orient2d};

use super::{Caster, Component, CountedFaces, LightSource, SurfaceKind};
use crate::math::Aabb;

impl Caster {
    /// Chooses the way in which a shell counts under a light: [`CountedFaces::Facing`] only if it is [`SurfaceKind::Closed`] and does
    /// not hold the light, inside or on its surface. Then each crossing of the surface outwards has one inwards before it,
    /// so that facing triangles alone miss no shadow; elsewhere they may.
    pub fn counting(&self, shell: &Component, source: LightSource) -> CountedFaces {
        match (shell.kind, source) {
            (SurfaceKind::Closed, LightSource::Direction(_)) => CountedFaces::Facing,
            (SurfaceKind::Closed, LightSource::Point(light)) if !self.holds(shell, light) => CountedFaces::Facing,
            _ => CountedFaces::All,
        }
    }

    fn holds(&self, shell: &Component, light: DVec3) -> bool {
        let Aabb { min, max } = shell.bounds;
        let in_box = light.cmpge(min).all() && light.cmple(max).all();
        in_box && (self.winding(shell, light) != 0 || shell.triangles.clone().any(|index| self.has_on_it(index, light)))
    }

    /// Tests whether a point lies on a triangle, its edges included. Exact.
    fn has_on_it(&self, triangle: u32, point: DVec3) -> bool {
        let corners = self.corners(triangle as usize);
        let (min, max) = (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]));
        let in_box = point.cmpge(min).all() && point.cmple(max).all();
        if !in_box
            || self.planes.exact_side(&self.corners(triangle as usize), triangle as usize, LightSource::Point(point))
                != 0
        {
            return false;
        }
        // In a plane, and within the edges in all three projections: one of them keeps the triangle's area.
        [[0, 1], [1, 2], [2, 0]].into_iter().all(|[x, y]| {
            let flat = |corner: DVec3| Coord { x: corner[x], y: corner[y] };
            let sides = [0, 1, 2].map(|k| orient2d(flat(corners[k]), flat(corners[(k + 1) % 3]), flat(point)));
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        })
    }

    /// Winding number of the shell around a point that is not on it, by the triangles that a ray in +x crosses. Exact: an
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
            if seen != 0
                && i32::from(self.planes.exact_side(
                    &self.corners(triangle as usize),
                    triangle as usize,
                    LightSource::Point(point),
                )) == -seen
            {
                winding += seen;
            }
        }
        winding
    }
}
