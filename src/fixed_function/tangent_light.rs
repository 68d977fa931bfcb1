//! The vector to a light in a surface's tangent space, for each vertex, as the applications of the day found it [GDC, "Surface
//! Space"]. Knows no GL.

use glam::{DVec4, Vec3, Vec4};

use crate::pass::Draw;

/// Places a light of eye space in the model space of a draw. Homogeneous: w = 0 for parallel light.
pub fn in_model(draw: &Draw, light: [f32; 4]) -> DVec4 {
    let eye_from_model = draw.eye_from_model.unwrap_or_default();
    eye_from_model.inverse() * Vec4::from(light).as_dvec4()
}

/// Vectors of all vertices of the draw's mesh, of any length: their products with T, B and N in model space. Those in eye
/// space by the matrix of normals are the same.
pub fn vectors(draw: &Draw, light: [f32; 4]) -> Vec<[f32; 3]> {
    let (mesh, light) = (&draw.mesh, in_model(draw, light).as_vec4());
    let Some(directions) = &mesh.tangents else { return vec![[0.0, 0.0, 1.0]; mesh.positions.len()] };
    let of_vertex = |(index, position): (usize, &[f32; 3])| {
        let to_light = light.truncate() - light.w * Vec3::from(*position);
        [&directions.tangents, &directions.bitangents, &mesh.normals]
            .map(|axes| axes.get(index).map_or(0.0, |axis| to_light.dot(Vec3::from(*axis))))
    };
    mesh.positions.iter().enumerate().map(of_vertex).collect()
}
