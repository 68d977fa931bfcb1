//! Convex hulls of points and directions, and whether two of them are apart: separating axes, in f64.

use glam::{DMat4, DVec3};

use super::Aabb;

/// All convex combinations of `points` plus all non-negative combinations of `directions`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hull {
    pub points: Vec<DVec3>,
    pub directions: Vec<DVec3>,
    /// Normals of its faces, of any length and either sign: axes along which to look for a gap.
    normals: Vec<DVec3>,
    /// Along its edges, without repeats of parallel ones where they are known.
    edges: Vec<DVec3>,
}

impl Hull {
    /// A flat convex polygon, corners in order.
    pub fn polygon(corners: &[DVec3]) -> Self {
        let edges: Vec<DVec3> = (0..corners.len()).map(|k| corners[(k + 1) % corners.len()] - corners[k]).collect();
        let normals = edges.windows(2).take(1).map(|pair| pair[0].cross(pair[1])).collect();
        Self { points: corners.to_vec(), directions: Vec::new(), normals, edges }
    }

    /// Hull of two quadrilaterals, the nearer of which may be a point.
    pub fn frustum(near: &[DVec3; 4], far: &[DVec3; 4]) -> Self {
        let mut hull = Self::polygon(far);
        hull.points.extend(near);
        for k in 0..4 {
            let side = far[k] - near[k];
            hull.normals.push(side.cross(far[(k + 1) % 4] - far[k]));
            hull.edges.push(side);
        }
        hull
    }

    /// A pyramid from `apex` over a polygon: what a spotlight at the apex may light.
    pub fn pyramid(apex: DVec3, base: &[DVec3; 4]) -> Self {
        Self::frustum(&[apex; 4], base)
    }

    /// A box under an affine transform.
    pub fn parallelepiped(bounds: &Aabb, world_from_model: &DMat4) -> Self {
        let points = bounds.corners().map(|corner| world_from_model.transform_point3(corner)).to_vec();
        let edges = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| world_from_model.transform_vector3(axis));
        let [x, y, z] = edges;
        let normals = vec![x.cross(y), y.cross(z), z.cross(x)];
        Self { points, directions: Vec::new(), normals, edges: edges.to_vec() }
    }

    /// All that lies in `directions` from the origin: only their angles matter.
    pub fn cone(directions: &[DVec3]) -> Self {
        Self { edges: directions.to_vec(), ..Self::default() }.swept(directions)
    }

    /// This hull and all that lies in `directions` from it.
    pub fn swept(&self, directions: &[DVec3]) -> Self {
        let mut hull = self.clone();
        let swept_edges = self.edges.iter().flat_map(|edge| directions.iter().map(|way| edge.cross(*way)));
        hull.normals.extend(swept_edges);
        hull.directions.extend(directions);
        hull.edges.extend(directions);
        hull
    }

    fn size(&self) -> f64 {
        self.points.iter().fold(0.0, |size, point| size.max(point.abs().max_element()))
    }

    fn middle(&self) -> DVec3 {
        match self.points.len() {
            0 => self.directions.iter().map(|way| way.normalize_or_zero()).sum::<DVec3>().normalize_or_zero(),
            count => self.points.iter().sum::<DVec3>() / count as f64,
        }
    }

    /// The hull's interval along an axis of unit length.
    fn interval(&self, axis: DVec3) -> [f64; 2] {
        let (mut low, mut high) = match self.points.is_empty() {
            true => (0.0f64, 0.0f64),
            false => (f64::INFINITY, f64::NEG_INFINITY),
        };
        for point in &self.points {
            let along = axis.dot(*point);
            (low, high) = (low.min(along), high.max(along));
        }
        for way in &self.directions {
            let slope = axis.dot(*way) / way.length();
            if slope.is_nan() || slope > PARALLEL {
                high = f64::INFINITY;
            }
            if slope.is_nan() || slope < -PARALLEL {
                low = f64::NEG_INFINITY;
            }
        }
        [low, high]
    }

    /// The least and the greatest cosine between the hull's directions and an axis of unit length.
    fn cosines(&self, axis: DVec3) -> [f64; 2] {
        let cosines = self.directions.iter().map(|way| axis.dot(*way) / way.length());
        cosines.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], cosine| {
            if cosine.is_nan() { [f64::NEG_INFINITY, f64::INFINITY] } else { [low.min(cosine), high.max(cosine)] }
        })
    }
}

/// A slope below this is that of an edge along the axis's plane: its rise over any visible distance is far below
/// [`SLACK`].
const PARALLEL: f64 = 1e-12;

/// Error of f32 transforms, relative to the greatest operand.
const SLACK: f64 = 1.0 / (1 << 20) as f64;

/// Tests whether a plane parts the two; conservative: `false` where none is found among the likely ones, and where the gap is
/// below 2⁻²⁰ of the sizes that meet, which covers f32 transforms. Two cones (no points) are apart if they share no
/// direction.
pub fn are_apart(a: &Hull, b: &Hull) -> bool {
    let crossed = a.edges.iter().flat_map(|one| b.edges.iter().map(|other| one.cross(*other)));
    // Flat and single-edged hulls have few axes of their own: from the middle of one to that of the other helps.
    let between = b.middle() - a.middle();
    let mut axes = a.normals.iter().chain(&b.normals).copied().chain([between]).chain(crossed);
    let are_cones = a.points.is_empty() && b.points.is_empty();
    let slack = SLACK * a.size().max(b.size());
    axes.any(|axis| {
        let Some(axis) = axis.try_normalize() else { return false };
        if are_cones {
            let ([low_a, high_a], [low_b, high_b]) = (a.cosines(axis), b.cosines(axis));
            let parted = |high: f64, low: f64| high <= PARALLEL && low >= -PARALLEL && low - high > SLACK;
            return parted(high_a, low_b) || parted(high_b, low_a);
        }
        let ([low_a, high_a], [low_b, high_b]) = (a.interval(axis), b.interval(axis));
        low_b - high_a > slack || low_a - high_b > slack
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(center: DVec3) -> Hull {
        let bounds = Aabb { min: center - DVec3::ONE, max: center + DVec3::ONE };
        Hull::parallelepiped(&bounds, &DMat4::IDENTITY)
    }

    #[test]
    fn boxes_pyramids_and_cones() {
        let base =
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, z)| DVec3::new(4.0 * x, -4.0, 4.0 * z));
        let pyramid = Hull::pyramid(DVec3::Y * 4.0, &base);
        for (center, apart) in [
            (DVec3::ZERO, false),
            (DVec3::X * 2.9, false),
            // Beyond a slanted face that no box face parts: x = 2 - y / 2 meets the corner (x - 1, -1) at x = 3.5.
            (DVec3::X * 3.6, true),
            (DVec3::Y * 5.1, true),
            (DVec3::Y * -5.1, true),
        ] {
            assert_eq!(are_apart(&cube(center), &pyramid), apart, "{center}");
        }
        let down = cube(DVec3::ZERO).swept(&[-DVec3::Y]);
        assert!(!are_apart(&down, &cube(DVec3::Y * -50.0)));
        assert!(are_apart(&down, &cube(DVec3::new(2.1, -50.0, 0.0))));
        assert!(are_apart(&down, &cube(DVec3::Y * 2.1)));
        let cones = [[DVec3::X, DVec3::new(1.0, 0.1, 0.0)], [DVec3::Y, DVec3::new(0.1, 1.0, 0.0)]];
        assert!(are_apart(&Hull::cone(&cones[0]), &Hull::cone(&cones[1])));
        assert!(!are_apart(&Hull::cone(&cones[0]), &Hull::cone(&[DVec3::new(1.0, 0.05, 0.0)])));
    }
}
