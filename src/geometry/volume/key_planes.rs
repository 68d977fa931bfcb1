//! Planes of triangles whose corners move in straight lines from one key frame to the next [GDC, "Aside About Bump Mapping
//! Keyframed Models"].
//!
//! An edge at blend τ is (1 - τ) e + τ e', so that the normal, the product of two edges, is quadratic:
//! n(τ) = (1 - τ)² e₁×e₂ + τ (1 - τ) (e₁×e₂' + e₁'×e₂) + τ² e₁'×e₂'. The plane's distance n(τ)·p(τ) is cubic. The talk
//! blends the two frames' planes instead: right at both ends, and off between them wherever a triangle turns or changes its
//! size.

use glam::DVec3;

use super::LightSource;

/// Way in which planes are found between two key frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PlaneBlend {
    /// Planes of the blended positions. A light that is as near to a plane as f32 rounds positions is left in doubt.
    #[default]
    Exact,
    /// The talk's: plane equations of both frames, blended.
    Lerped,
}

/// Planes of triangles between two key frames. Distances are from a centre, a corner of the first triangle.
#[derive(Clone, Debug, Default)]
pub struct KeyPlanes {
    /// x, y, z of the normal's three terms: of the first frame, of both, of the second. A number a triangle.
    normals: [[Vec<f64>; 3]; 3],
    /// The distance's four terms, from the first frame's to the second's.
    distances: [Vec<f64>; 4],
    /// Longest edge in either frame.
    edges: Vec<f64>,
    center: DVec3,
    /// Greatest distance of a corner from the centre.
    reach: f64,
    /// Greatest distance by which f32 moves a corner.
    rounding: f64,
}

/// Bounds the change of a side's value by f32 positions: a normal changes by at most 4 times a corner's move times the edges,
/// the product of normal and distance by 2 times more; the rest is for second order and the roundings in f64.
const DOUBT: f64 = 7.0;

/// Weights of the normal's and of the distance's terms at a blend.
struct Weights {
    normal: [f64; 3],
    distance: [f64; 4],
}

impl PlaneBlend {
    fn weights(self, blend: f64) -> Weights {
        let rest = 1.0 - blend;
        match self {
            Self::Exact => {
                let normal = [rest * rest, rest * blend, blend * blend];
                let distance = [rest * normal[0], rest * normal[1], blend * normal[1], blend * normal[2]];
                Weights { normal, distance }
            }
            Self::Lerped => Weights { normal: [rest, 0.0, blend], distance: [rest, 0.0, 0.0, blend] },
        }
    }
}

impl KeyPlanes {
    /// Planes of `triangles` of indices into the positions of two frames.
    pub fn new(triangles: &[[u32; 3]], first: &[DVec3], second: &[DVec3]) -> Self {
        let mut planes = Self::default();
        planes.set(triangles, first, second);
        planes
    }

    /// As [`Self::new`], in the same buffers.
    pub fn set(&mut self, triangles: &[[u32; 3]], first: &[DVec3], second: &[DVec3]) {
        let arrays = self.normals.iter_mut().flatten().chain(&mut self.distances);
        arrays.chain(std::iter::once(&mut self.edges)).for_each(|array| {
            array.clear();
            array.reserve(triangles.len());
        });
        self.center = triangles.first().map_or(DVec3::ZERO, |triangle| first[triangle[0] as usize]);
        (self.reach, self.rounding) = (0.0, 0.0);
        for triangle in triangles {
            let corners = |frame: &[DVec3]| triangle.map(|index| frame[index as usize]);
            self.push(corners(first), corners(second));
        }
    }

    fn push(&mut self, first: [DVec3; 3], second: [DVec3; 3]) {
        let edges = |corners: &[DVec3; 3]| [corners[1] - corners[0], corners[2] - corners[0]];
        let ([u, v], [to_u, to_v]) = (edges(&first), edges(&second));
        let normals = [u.cross(v), u.cross(to_v) + to_u.cross(v), to_u.cross(to_v)];
        let [start, end] = [first[0] - self.center, second[0] - self.center];
        let distances = [
            normals[0].dot(start),
            normals[0].dot(end) + normals[1].dot(start),
            normals[1].dot(end) + normals[2].dot(start),
            normals[2].dot(end),
        ];
        for (arrays, normal) in self.normals.iter_mut().zip(normals) {
            arrays.iter_mut().zip(normal.to_array()).for_each(|(array, number)| array.push(number));
        }
        self.distances.iter_mut().zip(distances).for_each(|(array, number)| array.push(number));
        let longest = [u, v, u - v, to_u, to_v, to_u - to_v].map(DVec3::length).into_iter().fold(0.0, f64::max);
        self.edges.push(longest);
        for corner in first.into_iter().chain(second) {
            self.reach = self.reach.max((corner - self.center).length());
            let to_f32 = 3_f64.sqrt() * 0.5 * f64::from(f32::EPSILON) * corner.abs().max_element();
            self.rounding = self.rounding.max(to_f32);
        }
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.edges.len()
    }

    /// Tests whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// Normal, twice as long as the triangle's area, and distance of a triangle's plane: normal · p = distance.
    pub fn plane(&self, triangle: usize, blend: f64, planes: PlaneBlend) -> (DVec3, f64) {
        let weights = planes.weights(blend);
        let axis = |axis: usize| (0..3).map(|term| weights.normal[term] * self.normals[term][axis][triangle]).sum();
        let normal = DVec3::new(axis(0), axis(1), axis(2));
        let distance: f64 = (0..4).map(|term| weights.distance[term] * self.distances[term][triangle]).sum();
        (normal, distance + normal.dot(self.center))
    }

    /// Writes the side of each triangle's plane on which a light lies: 1 where it sees the corners run counter-clockwise, -1
    /// clockwise. 0: with [`PlaneBlend::Exact`] the light is so near to the plane that positions rounded to f32 may see it on
    /// another side, else it is in the plane.
    pub fn sides(&self, blend: f64, planes: PlaneBlend, source: LightSource, sides: &mut [i8]) {
        let light = match source {
            LightSource::Point(position) => position - self.center,
            LightSource::Direction(direction) => direction,
        };
        let w = source.homogeneous().w;
        let weights = planes.weights(blend);
        let doubt = match planes {
            PlaneBlend::Exact => DOUBT * self.rounding * (light.length() + w * (self.reach + self.rounding)),
            PlaneBlend::Lerped => 0.0,
        };
        let count = self.len().min(sides.len());
        let [first, both, second] =
            self.normals.each_ref().map(|arrays| arrays.each_ref().map(|array| &array[..count]));
        let distances = self.distances.each_ref().map(|array| &array[..count]);
        let edges = &self.edges[..count];
        let factors = weights.normal.map(|weight| light * weight);
        let far = weights.distance.map(|weight| w * weight);
        for (k, side) in sides[..count].iter_mut().enumerate() {
            let dot = |factor: DVec3, normal: &[&[f64]; 3]| {
                factor.x * normal[0][k] + factor.y * normal[1][k] + factor.z * normal[2][k]
            };
            let height = dot(factors[0], &first) + dot(factors[1], &both) + dot(factors[2], &second);
            let distance = (far[0] * distances[0][k] + far[1] * distances[1][k])
                + (far[2] * distances[2][k] + far[3] * distances[3][k]);
            let (value, doubt) = (height - distance, doubt * (edges[k] + self.rounding));
            *side = i8::from(value > doubt) - i8::from(value < -doubt);
        }
    }
}
