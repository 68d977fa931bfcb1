//! Sides of an item that a viewer can see, so that the lit pass leaves out work for the others.

use glam::{DMat4, DVec3};

use super::Drawable;
use crate::process::work;

/// Most triangles of an item that is tested: the test must cost less than it saves.
const MOST_TRIANGLES: usize = 64;

/// Cosines below this are undecided: far above f32 rounding, far below what shows.
const LEAST_COSINE: f64 = 1e-4;

/// Tests whether no back face of the item can be seen: it is declared closed, has no holes by alpha, and all of it lies before
/// the near plane, so that the viewer is outside of it.
pub fn shows_no_back_face(item: &Drawable, clip_from_model: &DMat4) -> bool {
    let before_near = |corner: DVec3| {
        let clip = *clip_from_model * corner.extend(1.0);
        clip.z > -clip.w
    };
    item.closed && !item.needs_alpha_test() && item.bounds.corners().into_iter().all(before_near)
}

/// Tests whether every normal of the item, wherever it is interpolated, looks towards the viewer's eye: then none of them is
/// ever turned. False for large meshes, and where the vertex stage moves vertices.
///
/// At a point of a triangle both the normal and the way to the eye are mixtures of the corners' by the same weights, so
/// that their product is a mixture of the nine products of one corner's normal and another's way.
pub fn normals_face_eye(item: &Drawable, eye_from_model: &DMat4) -> bool {
    let indices = item.mesh.indices.get(item.indices.start as usize..item.indices.end as usize).unwrap_or_default();
    if indices.len() > 3 * MOST_TRIANGLES || item.wave.is_some() {
        return false;
    }
    work::count_triangles(indices.len());
    let normal_matrix = eye_from_model.inverse().transpose();
    let vector =
        |list: &[[f32; 3]], index: u32| list.get(index as usize).map(|vector| DVec3::from_array(vector.map(f64::from)));
    let faces =
        |normal: DVec3, position: DVec3| -normal.dot(position) > LEAST_COSINE * normal.length() * position.length();
    indices.chunks_exact(3).all(|triangle| {
        let normals = triangle.iter().map(|index| vector(&item.mesh.normals, *index));
        let normals: Option<Vec<DVec3>> =
            normals.map(|normal| Some(normal_matrix.transform_vector3(normal?))).collect();
        let ways = triangle.iter().map(|index| vector(&item.mesh.positions, *index));
        let ways: Option<Vec<DVec3>> = ways.map(|way| Some(eye_from_model.transform_point3(way?))).collect();
        normals
            .zip(ways)
            .is_some_and(|(normals, ways)| normals.iter().all(|normal| ways.iter().all(|way| faces(*normal, *way))))
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::lights::drawable::items;
    use crate::math::spaces::view_from_world;

    #[test]
    fn normals_face_an_eye_on_their_side_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let faces = |object: &str, eye: DVec3| {
            std::fs::write(&path, format!("[[object]]\n{object}\n")).unwrap();
            let scene = crate::techniques::load(Path::new(&path), &[]).unwrap().scene;
            let item = &items(&scene, None)[0];
            let view = view_from_world(eye, DVec3::ZERO, DVec3::new(0.1, 0.7, 0.5));
            normals_face_eye(item, &(view * item.world_from_model))
        };
        for (object, eye, expected) in [
            ("mesh = \"quad\"", DVec3::new(3.0, 0.1, 2.0), true),
            ("mesh = \"quad\"", DVec3::new(3.0, -0.1, 2.0), false),
            ("mesh = \"quad\"", DVec3::new(3.0, 1e-6, 2.0), false),
            ("mesh = \"quad\"\nscale = [-9, 0.5, 2]", DVec3::new(30.0, 1.0, 2.0), true),
            // Mirrored in y, the side that was above looks down.
            ("mesh = \"quad\"\nscale = [1, -1, 1]", DVec3::new(3.0, 1.0, 2.0), false),
            ("mesh = \"quad\"\nrotate = { axis = [0, 0, 1], angle = 180 }", DVec3::new(3.0, -1.0, 2.0), true),
            ("mesh = \"box\"", DVec3::new(9.0, 9.0, 9.0), false),
            ("mesh = \"torus\"", DVec3::new(9.0, 9.0, 9.0), false),
        ] {
            assert_eq!(faces(object, eye), expected, "{object} from {eye}");
        }
    }
}
