//! Vectors in a surface's tangent space, for each vertex, as the applications of the day found them [GDC, "Surface Space"].
//! Knows no GL.

use glam::{Vec3, Vec4};

use super::layer::TangentVector;
use crate::pass::Draw;

/// Places the light and the eye in the model space of a draw. Homogeneous: w = 0 for parallel light.
pub fn in_model(draw: &Draw, vector: TangentVector) -> [Vec4; 2] {
    let model_from_eye = draw.eye_from_model.unwrap_or_default().inverse();
    [Vec4::from(vector.light), Vec4::W].map(|position| (model_from_eye * position.as_dvec4()).as_vec4())
}

/// Vectors of all vertices of the draw's mesh. Their coordinates are products with T, B and N in model space; those in eye
/// space by the matrix of normals are the same. Vectors to a light are of any length.
pub fn of_vertices(draw: &Draw, vector: TangentVector) -> Vec<[f32; 3]> {
    let (mesh, [light, eye]) = (&draw.mesh, in_model(draw, vector));
    let Some(directions) = &mesh.tangents else { return vec![[0.0, 0.0, 1.0]; mesh.positions.len()] };
    let of_vertex = |(index, position): (usize, &[f32; 3])| {
        let towards = |point: Vec4| {
            let way = point.truncate() - point.w * Vec3::from(*position);
            let along = |axes: &[[f32; 3]]| axes.get(index).map_or(0.0, |axis| way.dot(Vec3::from(*axis)));
            Vec3::new(along(&directions.tangents), along(&directions.bitangents), along(&mesh.normals))
        };
        let to_light = towards(light);
        let vector = if vector.half { unit(to_light) + unit(towards(eye)) } else { to_light };
        vector.to_array()
    };
    mesh.positions.iter().enumerate().map(of_vertex).collect()
}

/// Gives a vector unit length, whatever length it has; a zero vector stays one.
fn unit(vector: Vec3) -> Vec3 {
    let most = vector.abs().max_element();
    if most > 0.0 { (vector / most).normalize() } else { Vec3::ZERO }
}
