//! What files write in odd ways, and the normals that they lack.

use std::path::PathBuf;

use glam::Vec3;

use super::*;

fn written(name: &str, files: &[(&str, &str)]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().join(name);
    (folder, path)
}

fn load(text: &str) -> (Mesh, Vec<Warning>) {
    let (_folder, path) = written("a.obj", &[("a.obj", text)]);
    load_obj(&path).unwrap()
}

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 5 6 7 8\nf 2 1 4 3\nf 6 2 3 7\nf 1 5 8 4\nf 8 7 3 4\nf 1 2 6 5\n";

#[test]
fn edges_sharper_than_the_crease_are_split() {
    let (mesh, warnings) = load(CUBE);
    assert!(warnings.is_empty() && mesh.is_closed());
    assert_eq!((mesh.positions.len(), mesh.triangle_count()), (24, 12));
    for triangle in mesh.indices.chunks(3) {
        let [a, b, c] = [0, 1, 2].map(|k| Vec3::from_array(mesh.positions[triangle[k] as usize]));
        let own = (b - a).cross(c - a).normalize();
        for index in triangle {
            assert_eq!(mesh.normals[*index as usize], own.to_array());
        }
    }
}

/// A pyramid as flat as this is smooth: its top's normal is the axis, though one side is cut into slivers.
#[test]
fn smooth_normals_are_weighted_by_angle() {
    let base = "v 1 0 1\nv 1 0 -1\nv -1 0 -1\nv -1 0 1\nv 0 0.5 0\nv 1 0 0\n";
    let (mesh, _) = load(&format!("{base}f 1 6 5\nf 6 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"));
    let top = mesh.positions.iter().position(|position| *position == [0.0, 0.5, 0.0]).unwrap();
    assert!(Vec3::from_array(mesh.normals[top]).distance(Vec3::Y) < 1e-6);
    assert_eq!(mesh.positions.len(), 6);
}

#[test]
fn sphere_without_normals_gets_those_of_the_sphere() {
    let sphere = super::super::primitive("sphere").unwrap();
    let mut text = String::new();
    for [x, y, z] in &sphere.positions {
        text += &format!("v {x} {y} {z}\n");
    }
    for triangle in sphere.indices.chunks(3) {
        text += &format!("f {} {} {}\n", triangle[0] + 1, triangle[1] + 1, triangle[2] + 1);
    }
    let (mesh, _) = load(&text);
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        assert!(Vec3::from_array(*position).distance(Vec3::from_array(*normal)) < 2e-3);
    }
}

#[test]
fn unusable_normals_are_made_anew_and_others_kept() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let (mesh, warnings) = load(&format!("{triangle}vn 0 0 0\nvn nan 0 1\nvn 0 3 4\nf 1//1 2//2 3//3\n"));
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.6, 0.8]]);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    // Overflows to infinity, and some corners without.
    let (mesh, _) = load(&format!("{triangle}vn 1e39 0 0\nvn 0 3 4\nf 1//1 2 3//2\n"));
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.6, 0.8]]);
}

#[test]
fn triangles_without_area_do_not_bend_normals() {
    let (mesh, _) = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 3\n");
    assert_eq!(mesh.triangle_count(), 3);
    assert!(mesh.normals.iter().all(|normal| *normal == [0.0, 0.0, 1.0]));
    let (mesh, _) = load("v 0 0 0\nf 1 1 1\n");
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]]);
}

#[test]
fn coordinates_near_the_limits_of_floats_give_unit_normals() {
    for size in ["3e38", "1e-40"] {
        let (mesh, _) = load(&format!("v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nf 1 2 3\n"));
        assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3], "{size}");
    }
}

#[test]
fn odd_spellings_are_read() {
    let text = "\u{feff}# a\r\no\tbox one\r\n  v 0 0 0 1 0 0 1\r\nv 1 0 0 2\r\n\tv 0 1. +0e0\r\nvt 0.5\r\n\
        l 1 2 3\r\np 1\r\nusemtl\r\ng\r\nf 4/1 5/1 6/1\r\nv 0 0 1\nv 1 0 1\nv 0 1 1\ncstype bezier\nf 1 2 3 # end";
    let (mesh, warnings) = load(text);
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!((mesh.triangle_count(), mesh.positions.len()), (2, 6));
    assert_eq!((mesh.positions[0], mesh.positions[4]), ([0.0, 0.0, 1.0], [0.5, 0.0, 0.0]));
    assert_eq!(mesh.texcoords.unwrap(), [[0.5, 0.0], [0.5, 0.0], [0.5, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]]);
}

#[test]
fn missing_libraries_and_materials_are_warned_of() {
    let text = "mtllib no.mtl\nmtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n";
    let (_folder, path) = written("a.obj", &[("a.obj", text), ("a b.mtl", "newmtl red\nKd 1 0 0\n")]);
    let (mesh, warnings) = load_obj(&path).unwrap();
    let said: Vec<_> = warnings.iter().map(|warning| (warning.line, warning.message.as_str())).collect();
    let missing = "there is no material library 'no.mtl'";
    assert_eq!(said, [(1, missing), (8, "no material is named 'blue'; the default stands in")]);
    assert_eq!(mesh.parts.iter().map(|part| part.material).collect::<Vec<_>>(), [Some(0), None]);
    assert_eq!(mesh.materials[0].diffuse, [1.0, 0.0, 0.0]);
}

#[test]
fn material_statements_are_read_in_odd_spellings() {
    let library = "newmtl  a b \nkd 0.5\nKa 0 0.25 2\nKs spectral x.rfl\nNs 5000\nd -halo 0.25\nillum 9\nKe 1\n\
        newmtl c\nTr 0.75\nnewmtl c\nKd 0 1 0\n";
    let text = "usemtl c\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl a b\nf 1 2 3\n";
    let (_folder, path) = written("a.obj", &[("a.obj", text), ("a.mtl", library)]);
    let (mesh, warnings) = load_obj(&path).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!(mesh.parts.iter().map(|part| part.material).collect::<Vec<_>>(), [Some(2), Some(0)]);
    let [ab, first_c, c] = &mesh.materials[..] else { panic!("{:?}", mesh.materials) };
    assert_eq!((ab.ambient, ab.diffuse, ab.specular), ([0.0, 0.25, 1.0], [0.5; 3], [0.0; 3]));
    assert_eq!((ab.shininess, ab.opacity, first_c.opacity, c.diffuse), (1000.0, 0.25, 0.25, [0.0, 1.0, 0.0]));
}

#[test]
fn cache_order_keeps_triangles_and_parts() {
    let sphere = super::super::primitive("sphere").unwrap();
    let mut triangles = [sphere.indices.clone(), sphere.cache_ordered()].map(|indices| {
        let turned = |t: &[u32; 3]| {
            let mut t = *t;
            let first = (0..3).min_by_key(|k| t[*k]).unwrap();
            t.rotate_left(first);
            t
        };
        indices.as_chunks::<3>().0.iter().map(turned).collect::<Vec<_>>()
    });
    assert_ne!(triangles[0], triangles[1]);
    triangles.iter_mut().for_each(|triangles| triangles.sort_unstable());
    assert_eq!(triangles[0], triangles[1]);
    let optimized = sphere.cache_optimized();
    assert!(optimized.is_closed() && optimized.bounds == sphere.bounds && optimized.parts == sphere.parts);
    let ratio = |mesh: &Mesh| meshopt::analyze_vertex_cache(&mesh.indices, mesh.positions.len(), 16, 0, 0).acmr;
    assert!(ratio(&optimized) < 0.75 && ratio(&sphere) > 0.9, "{} {}", ratio(&optimized), ratio(&sphere));
}

#[test]
fn topology_tells_open_turned_and_crowded_edges() {
    let count = |text: &str| {
        let topology = super::super::topology::inspect(&load(text).0);
        [topology.open_edges, topology.turned_edges, topology.crowded_edges]
    };
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\n";
    assert_eq!(count(&format!("{vertices}f 1 2 3\n")), [3, 0, 0]);
    assert_eq!(count(&format!("{vertices}f 1 2 3\nf 1 2 4\n")), [4, 1, 0]);
    assert_eq!(count(&format!("{vertices}f 1 2 3\nf 2 1 4\nf 1 2 5\n")), [6, 0, 1]);
    assert_eq!(count(&format!("{vertices}f 1 2 3\nf 3 2 1\nf 1 1 4\n")), [0, 0, 0]);
}
