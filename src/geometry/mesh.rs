//! A mesh of triangles or of line segments, indexed, as GL draws it.

use std::ops::Range;

use glam::{DVec3, Vec3};

use super::Material;
use crate::math::Aabb;

/// An indexed triangle mesh in its own (model) space.
///
/// `positions`, `normals` and, where present, `texcoords` and `colors` have the same length; `indices` holds three
/// entries a triangle, each below that length. All values are finite.
///
/// A mesh of lines has two entries of `indices` for each segment; only the draw that uses it says so. Nothing that loads or
/// resolves a scene makes such a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Origin of the mesh: a built-in's name or the file's path as written.
    pub name: String,
    pub positions: Vec<[f32; 3]>,
    /// Origin of `positions` in the file's space: zero, unless that is so far away that f32 would lose the vertices'
    /// places. An object's `world_from_model` includes it; code that takes a mesh from elsewhere than a scene must add it.
    pub origin: DVec3,
    /// Positions with w, instead of `positions`, which is then empty: for shadow volumes, whose far vertices have w = 0.
    pub homogeneous: Vec<[f32; 4]>,
    /// Unit normals; (0, 0, 1) for a vertex without a triangle of any area.
    pub normals: Vec<[f32; 3]>,
    /// (s, t), t upwards as in GL and OBJ.
    pub texcoords: Option<Vec<[f32; 2]>>,
    /// Colours of the vertices, RGB in [0, 1], which multiply every material's ambient and diffuse colour; `None`: none.
    pub colors: Option<Vec<[f32; 3]>>,
    /// Directions of s and t at the vertices, for bump maps; `None`: the mesh has none, or no bump map needs them.
    pub tangents: Option<MeshTangents>,
    pub indices: Vec<u32>,
    /// Ranges of `indices` that share a material; together they cover `indices`.
    pub parts: Vec<Part>,
    /// Materials that the parts' `material` indexes. Empty for built-in meshes.
    pub materials: Vec<Material>,
    pub bounds: Aabb,
}

/// Directions on a surface along which s and t grow, in model space: one for each vertex. From a file, by a built-in's formula,
/// or from the skin ([`Mesh::with_bases`]).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshTangents {
    /// Unit vectors along s.
    pub tangents: Vec<[f32; 3]>,
    /// Unit vectors along t.
    pub bitangents: Vec<[f32; 3]>,
}

impl MeshTangents {
    /// Makes them from tangents whose fourth component is the sense of the bitangent, 1 or -1, as glTF stores them:
    /// B = w N × T.
    pub fn from_signed(normals: &[[f32; 3]], signed: &[[f32; 4]]) -> Self {
        let across = |(normal, [x, y, z, w]): (&[f32; 3], &[f32; 4])| {
            (*w * Vec3::from_array(*normal).cross(Vec3::new(*x, *y, *z))).to_array()
        };
        let tangents = signed.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect();
        Self { tangents, bitangents: normals.iter().zip(signed).map(across).collect() }
    }

    /// The vertices of these old numbers, in this order.
    #[must_use]
    pub fn picked(&self, old: &[usize]) -> Self {
        let pick = |all: &[[f32; 3]]| old.iter().map(|index| all[*index]).collect();
        Self { tangents: pick(&self.tangents), bitangents: pick(&self.bitangents) }
    }
}

/// A run of triangles with one material.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The OBJ object's or group's name, or the built-in's.
    pub name: String,
    /// Range of [`Mesh::indices`]; both ends are multiples of three.
    pub indices: Range<u32>,
    /// Index into [`Mesh::materials`]; `None`: the scene's object or the default material decides.
    pub material: Option<usize>,
    /// Bounds of the vertices that the part's triangles use.
    pub bounds: Aabb,
}

impl Mesh {
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// Sets the bounds of the parts and of the whole from the vertices that the triangles use.
    pub(super) fn update_bounds(&mut self) {
        for part in &mut self.parts {
            let indices = &self.indices[part.indices.start as usize..part.indices.end as usize];
            let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
            for index in indices {
                let position = Vec3::from_array(self.positions[*index as usize]);
                (min, max) = (min.min(position), max.max(position));
            }
            part.bounds = Aabb { min: min.as_dvec3(), max: max.as_dvec3() };
        }
        self.bounds = self.parts.iter().map(|part| part.bounds).fold(Aabb::EMPTY, Aabb::union);
    }
}
