//! Tangent planes of key frames, made once, and their bases at any blend [GDC, "Per-Polygon Tangent Space Basis", "Aside
//! About Bump Mapping Keyframed Models"].
//!
//! P_s and P_t are sums of a triangle's edges with weights that the skin gives, and edges are linear in the blend: the
//! derivatives of two frames, blended, are those of the blended positions.

use glam::DVec3;

use super::super::Mesh;
use super::super::tangents::{BasisFit, Directions, TangentBasis, Tangents, derivatives, skin_area};
use super::{Model, Pose};

/// Derivatives of the triangles of a model by the skin, in every key frame.
#[derive(Clone, Debug)]
pub struct KeyTangents {
    /// Of each frame: x, y, z of P_s, then of P_t, a number a triangle.
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
        found.corners.clear();
        (found.mirrored, found.skewed, found.without) = (0, 0, 0);
        for ((triangle, indices), sense) in mesh.indices.as_chunks::<3>().0.iter().enumerate().zip(&self.senses) {
            let normals = indices.map(|index| DVec3::from_array(mesh.normals[index as usize].map(f64::from)));
            if *sense == Sense::Without {
                found.without += 1;
                found.corners.extend(normals.map(TangentBasis::around));
                continue;
            }
            let directions = self.directions(pose, triangle, *sense, fit);
            found.mirrored += usize::from(directions.is_mirrored);
            found.skewed += usize::from(directions.is_skewed());
            found.corners.extend(normals.map(|normal| directions.fitted(normal, fit)));
        }
    }

    /// Directions of a triangle that has some; the normal only where the fit uses it.
    fn directions(&self, pose: &Pose, triangle: usize, sense: Sense, fit: BasisFit) -> Directions {
        let [tangent, bitangent] = self.derivatives(pose, triangle).map(DVec3::normalize_or_zero);
        let is_mirrored = sense == Sense::Mirrored;
        let normal = match fit {
            BasisFit::PerPolygon if is_mirrored => bitangent.cross(tangent).normalize_or_zero(),
            BasisFit::PerPolygon => tangent.cross(bitangent).normalize_or_zero(),
            BasisFit::Orthogonal | BasisFit::Skewed => DVec3::ZERO,
        };
        Directions { tangent, bitangent, normal, is_mirrored }
    }
}
