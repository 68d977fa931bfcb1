//! The built-in meshes against their formulas.

use std::collections::HashMap;

use glam::Vec3;

use super::*;
use crate::geometry::topology;

fn made(name: &str) -> Mesh {
    primitive(name).unwrap()
}

/// Each triangle's own normal (of twice its area's length) and the mean of its vertices' normals.
fn triangle_normals(mesh: &Mesh) -> impl Iterator<Item = (DVec3, DVec3)> {
    mesh.indices.as_chunks::<3>().0.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|index| Vec3::from_array(mesh.positions[index as usize]).as_dvec3());
        let mean = triangle.map(|index| Vec3::from_array(mesh.normals[index as usize]).as_dvec3()).into_iter().sum();
        ((b - a).cross(c - a), mean)
    })
}

#[test]
fn every_name_is_made_sound() {
    for name in PRIMITIVES {
        let mesh = made(name);
        assert_eq!(
            (mesh.normals.len(), mesh.texcoords.as_ref().unwrap().len()),
            (mesh.positions.len(), mesh.positions.len())
        );
        assert!(mesh.indices.iter().all(|index| (*index as usize) < mesh.positions.len()));
        assert_eq!(mesh.parts[0].indices, 0..mesh.indices.len() as u32);
        for normal in &mesh.normals {
            assert!((Vec3::from_array(*normal).length() - 1.0).abs() < 1e-6, "{name}");
        }
        for (own, mean) in triangle_normals(&mesh) {
            assert!(own.length() > 0.0 && own.dot(mean) > 0.0, "{name}: {own} {mean}");
        }
        for [s, t] in mesh.texcoords.unwrap() {
            assert!((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t));
        }
    }
    assert_eq!(primitive("cone"), None);
}

#[test]
fn quad_faces_up_and_is_textured_from_its_near_left_corner() {
    let mesh = made("quad");
    assert_eq!(mesh.bounds, Aabb { min: DVec3::new(-1.0, 0.0, -1.0), max: DVec3::new(1.0, 0.0, 1.0) });
    assert!(mesh.normals.iter().all(|normal| *normal == [0.0, 1.0, 0.0]));
    assert_eq!((mesh.positions[0], mesh.texcoords.unwrap()[0]), ([-1.0, 0.0, 1.0], [0.0, 0.0]));
}

#[test]
fn closed_meshes_are_closed_and_have_the_right_holes() {
    for (name, euler, triangles) in [("box", 2, 12), ("sphere", 2, 2 * 96 * 47), ("torus", 0, 2 * 96 * 48)] {
        let topology = topology::inspect(&made(name));
        assert!(topology.is_closed(), "{name}: {topology:?}");
        assert_eq!((topology.euler_characteristic(), topology.triangles), (euler, triangles), "{name}");
    }
    assert!(!made("quad").is_closed());
}

#[test]
fn sphere_and_torus_lie_on_their_surfaces() {
    let sphere = made("sphere");
    for (position, normal) in sphere.positions.iter().zip(&sphere.normals) {
        let position = Vec3::from_array(*position);
        assert!((position.length() - 1.0).abs() < 2e-7 && position.distance(Vec3::from_array(*normal)) < 3e-7);
    }
    let torus = made("torus");
    for (position, normal) in torus.positions.iter().zip(&torus.normals) {
        let position = Vec3::from_array(*position).as_dvec3();
        let center = DVec3::new(position.x, 0.0, position.z).normalize();
        let outwards = (position - center) / 0.4;
        assert!((outwards.length() - 1.0).abs() < 1e-6);
        assert!(outwards.distance(Vec3::from_array(*normal).as_dvec3()) < 1e-6);
    }
    assert_eq!(torus.bounds.max.y, f64::from(0.4f32));
    assert_eq!(torus.bounds.min.x, f64::from(-1.4f32));
}

#[test]
fn teapot_has_the_known_size() {
    let mesh = made("teapot");
    // In Newell's space: x from -3 to 3.4335..., y from -2 to 2, z from 0 to 3.15.
    let Aabb { min, max } = mesh.bounds;
    assert_eq!((min.x, min.y, min.z), (-1.5, -0.75, -1.0));
    assert_eq!((max.y, max.z), (f64::from(0.825f32), 1.0));
    assert!((2.0 * max.x - 3.4335).abs() < 2e-3, "{}", 2.0 * max.x);
    assert_eq!(teapot::patches().map(|(mirrorings, _)| mirrorings.len()).sum::<usize>(), 32);
}

/// The teapot's loose edges are where its parts end: the rim's inside, the lid's edge, both ends of handle and spout.
#[test]
fn teapot_patches_meet_to_the_bit() {
    let mesh = made("teapot");
    let topology = topology::inspect(&mesh);
    assert_eq!((topology.turned_edges, topology.crowded_edges), (0, 0));
    let ends = (4 + 4) * 16 + (2 + 2) * (2 * 16);
    assert_eq!(topology.open_edges, ends, "{topology:?}");
}

/// The surface is smooth across all seams of patches; only where the handle's lower end touches the body two surfaces
/// share a place.
#[test]
fn teapot_normals_agree_along_seams() {
    let mesh = made("teapot");
    let mut at: HashMap<[u32; 3], Vec<Vec3>> = HashMap::new();
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        at.entry(position.map(f32::to_bits)).or_default().push(Vec3::from_array(*normal));
    }
    at.remove(&[-1.0f32, -0.3, 0.0].map(f32::to_bits)).unwrap();
    for (place, normals) in at {
        for normal in &normals {
            assert!(normal.distance(normals[0]) < 1e-6, "{:?} {normals:?}", place.map(f32::from_bits));
        }
    }
    let top = mesh.positions.iter().position(|[x, y, z]| (*x, *y, *z) == (0.0, 0.825, 0.0)).unwrap();
    let bottom = mesh.positions.iter().position(|[x, y, z]| (*x, *y, *z) == (0.0, -0.75, 0.0)).unwrap();
    assert_eq!((mesh.normals[top], mesh.normals[bottom]), ([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]));
}
