//! Tangent planes of key frames, made once, and their bases at any blend [GDC, "Per-Polygon Tangent Space Basis", "Aside
//! About Bump Mapping Keyframed Models"].
//!
//! P_s and P_t are sums of a triangle's edges with weights that the skin gives, and edges are linear in the blend: the
//! derivatives of two frames, blended, are those of the blended positions.

use glam::DVec3;

use super::super::Mesh;
use super::super::tangents::{BasisFit, Directions, TangentBasis, Tangents, derivatives, skin_area};
use super::{Model, Pose};

/// Number of triangles whose derivatives are blended at a time: they stay in the first-level cache.
const BLOCK: usize = 64;

/// Derivatives of the triangles of a model by the skin, in every key frame.
#[derive(Clone, Debug)]
pub struct KeyTangents {
    /// x, y, z of P_s, then of P_t, of each frame; a number a triangle.
    frames: Vec<[Vec<f64>; 6]>,
    senses: Vec<Sense>,
}

/// Sense in which a triangle's skin runs around; it is the same in every pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sense {
    Kept,
    Mirrored,
    /// No area on the skin: no directions.
    Without,
}

impl KeyTangents {
    /// Those of [`Model::mesh`]'s triangles, from positions in f64.
    pub fn new(model: &Model) -> Self {
        let skin: Vec<[f64; 2]> = model.texcoords().map(|texcoord| texcoord.map(f64::from)).collect();
        let vertices: Vec<usize> = model.vertices().collect();
        let triangles = model.indices().as_chunks::<3>().0;
        let of_triangle = |triangle: &[u32; 3]| triangle.map(|index| skin[index as usize]);
        let areas: Vec<Option<f64>> = triangles.iter().map(|triangle| skin_area(of_triangle(triangle))).collect();
        let frames = (0..model.frame_count()).map(|frame| {
            let pose = Pose { frames: [frame; 2], blend: 0.0 };
            let mut arrays = [(); 6].map(|()| Vec::with_capacity(triangles.len()));
            for (triangle, area) in triangles.iter().zip(&areas) {
                let [a, b, c] = triangle.map(|index| model.position(&pose, vertices[index as usize]));
                let found = area.map(|area| derivatives([b - a, c - a], of_triangle(triangle), area));
                let [by_s, by_t] = found.unwrap_or_default();
                let numbers = by_s.to_array().into_iter().chain(by_t.to_array());
                arrays.iter_mut().zip(numbers).for_each(|(array, number)| array.push(number));
            }
            arrays
        });
        let sense = |area: &Option<f64>| match area {
            None => Sense::Without,
            Some(area) if *area < 0.0 => Sense::Mirrored,
            Some(_) => Sense::Kept,
        };
        Self { frames: frames.collect(), senses: areas.iter().map(sense).collect() }
    }

    /// P_s and P_t of a triangle in a pose, in model units for the whole skin; zero where the skin has no direction.
    pub fn derivatives(&self, pose: &Pose, triangle: usize) -> [DVec3; 2] {
        let [first, second] = pose.frames.map(|frame| self.frames[frame].each_ref().map(|array| array[triangle]));
        let at = |axis: usize| first[axis] + pose.blend * (second[axis] - first[axis]);
        [DVec3::new(at(0), at(1), at(2)), DVec3::new(at(3), at(4), at(5))]
    }

    /// Finds the bases of a mesh's corners, as [`Tangents::of_skin`] does, but for the rounding of the mesh's positions to
    /// f32. `mesh`: the model's in this pose, whose normals are used. What `found` held is replaced; nothing is allocated once
    /// it is large enough.
    ///
    /// A triangle that has no area in this pose keeps its P_s, and counts as one without directions only if the skin has none.
    pub fn find(&self, pose: &Pose, mesh: &Mesh, fit: BasisFit, found: &mut Tangents) {
        found.corners.resize(mesh.indices.len(), TangentBasis::flat(DVec3::Z));
        (found.mirrored, found.skewed, found.without) = (0, 0, 0);
        let triangles = mesh.indices.as_chunks::<3>().0.iter().zip(&self.senses);
        let mut triangles = triangles.zip(found.corners.as_chunks_mut::<3>().0);
        let mut start = 0;
        while triangles.len() > 0 {
            let units = self.units(pose, start);
            start += BLOCK;
            for (index, ((indices, sense), corners)) in triangles.by_ref().take(BLOCK).enumerate() {
                let directions = (*sense != Sense::Without).then(|| units.directions(index, *sense, fit));
                match &directions {
                    None => found.without += 1,
                    Some(directions) => {
                        found.mirrored += usize::from(directions.is_mirrored);
                        found.skewed += usize::from(directions.is_skewed());
                    }
                }
                for (corner, index) in corners.iter_mut().zip(indices) {
                    let normal = DVec3::from_array(mesh.normals[*index as usize].map(f64::from));
                    *corner = match &directions {
                        None => TangentBasis::flat(normal),
                        Some(directions) => directions.fitted(normal, fit),
                    };
                }
            }
        }
    }

    /// Directions of up to [`BLOCK`] triangles from `start` on.
    fn units(&self, pose: &Pose, start: usize) -> Units {
        let mut units = Units([[0.0; BLOCK]; 6]);
        let [first, second] = pose.frames.map(|frame| &self.frames[frame]);
        for (axis, array) in units.0.iter_mut().enumerate() {
            let pairs = first[axis].iter().zip(&second[axis]).skip(start);
            array.iter_mut().zip(pairs).for_each(|(at, (a, b))| *at = a + pose.blend * (b - a));
        }
        for xyz in units.0.as_chunks_mut::<3>().0 {
            let [x, y, z] = xyz;
            for ((x, y), z) in x.iter_mut().zip(y).zip(z) {
                let square = *x * *x + *y * *y + *z * *z;
                let scale = if square > 0.0 { 1.0 / square.sqrt() } else { 0.0 };
                (*x, *y, *z) = (*x * scale, *y * scale, *z * scale);
            }
        }
        units
    }
}

/// x, y, z of P_s and of P_t, each of unit length or zero.
struct Units([[f64; BLOCK]; 6]);

impl Units {
    /// Directions of a triangle that has some; the normal only where the fit uses it.
    fn directions(&self, index: usize, sense: Sense, fit: BasisFit) -> Directions {
        let [x, y, z, to_x, to_y, to_z] = self.0.each_ref().map(|array| array[index]);
        let (tangent, bitangent) = (DVec3::new(x, y, z), DVec3::new(to_x, to_y, to_z));
        let is_mirrored = sense == Sense::Mirrored;
        let normal = match fit {
            BasisFit::PerPolygon if is_mirrored => bitangent.cross(tangent).normalize_or_zero(),
            BasisFit::PerPolygon => tangent.cross(bitangent).normalize_or_zero(),
            BasisFit::Orthogonal | BasisFit::Skewed => DVec3::ZERO,
        };
        Directions { tangent, bitangent, normal, is_mirrored }
    }
}
