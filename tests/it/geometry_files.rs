//! Mesh files: the malformed ones in `tests/bad` each give their own error; the generated ones in `data` are what the
//! generator makes; the small ones load as they are meant.

use std::path::{Path, PathBuf};

use glumbra::geometry::{self, Mesh, topology};

#[path = "../generate_data/made.rs"]
mod made;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn load(name: &str) -> Mesh {
    let (mesh, warnings) = geometry::load_obj(&root().join("data/meshes").join(name)).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    mesh
}

#[test]
fn malformed_files_give_their_own_errors() {
    let folder = root().join("tests/bad");
    let table: toml::Table = std::fs::read_to_string(folder.join("geometry.toml")).unwrap().parse().unwrap();
    let mut wrong = Vec::new();
    for (file, expected) in &table {
        let expected = expected.as_str().unwrap();
        match geometry::load_obj(&folder.join(file)) {
            Ok(_) => wrong.push(format!("{file}: loads")),
            Err(error) if error.to_string().contains(expected) => {}
            Err(error) => wrong.push(format!("{file}: '{error}' does not contain '{expected}'")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // Every bad mesh is in a table.
    let warned: toml::Table = std::fs::read_to_string(folder.join("warned.toml")).unwrap().parse().unwrap();
    let listed = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap();
        table.contains_key(name) != warned.contains_key(name)
    };
    let meshes: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let meshes: Vec<_> = meshes.into_iter().filter(|path| path.extension().is_some_and(|end| end == "obj")).collect();
    assert!(meshes.len() >= 18 && meshes.iter().all(listed), "{meshes:?}");
}

#[test]
fn odd_files_load_with_their_own_warning() {
    let folder = root().join("tests/bad");
    let table: toml::Table = std::fs::read_to_string(folder.join("warned.toml")).unwrap().parse().unwrap();
    assert!(table.len() >= 7);
    for (file, expected) in &table {
        let (mesh, warnings) = geometry::load_obj(&folder.join(file)).unwrap_or_else(|error| panic!("{error}"));
        let [warning] = &warnings[..] else { panic!("{file}: {warnings:?}") };
        assert!(warning.to_string().contains(expected.as_str().unwrap()), "{file}: {warning}");
        assert_eq!(mesh.triangle_count(), 1, "{file}");
        assert!(mesh.materials.iter().all(|material| material.decal.is_none() && material.alpha.is_none()), "{file}");
    }
}

#[test]
fn generated_files_are_what_the_generator_makes() {
    let folder = tempfile::tempdir().unwrap();
    made::write_all(folder.path()).unwrap();
    let both = |name: &str| [root().join("data").join(name), folder.path().join(name)];
    for name in ["dense", "facade-wall", "facade-stone", "facade-wood", "facade-glass", "facade-iron"] {
        let name = format!("meshes/{name}.obj");
        let [committed, made] = both(&name).map(|path| std::fs::read(path).unwrap());
        assert!(committed == made, "data/{name} is not what generate_data makes");
    }
    let [committed, made] = both("meshes/knight.md2").map(|path| std::fs::read(path).unwrap());
    assert!(committed == made, "data/meshes/knight.md2 is not what generate_data makes");
    // Pixels, not bytes: the packing of PNGs may change with the library.
    for name in ["bricks", "floor", "spot", "barn-doors", "head-light", "knight", "knight-height", "knight-gloss"]
        .map(|name| format!("textures/{name}.png"))
    {
        let [committed, made] = both(&name).map(|path| geometry::load_texture(&path).unwrap().rgba);
        assert!(committed == made, "data/{name} is not what generate_data makes");
    }
    let [committed, made] = both("textures/checker.png").map(|path| geometry::load_texture(&path).unwrap().rgba);
    assert!(committed == made, "data/textures/checker.png is not what generate_data makes");
}

#[test]
fn dense_mesh_is_a_closed_statue() {
    let mesh = load("dense.obj");
    let topology = topology::inspect(&mesh);
    assert!(topology.is_closed(), "{topology:?}");
    assert!((60_000..80_000).contains(&topology.triangles), "{topology:?}");
    assert_eq!(topology.triangles, mesh.triangle_count());
    // One surface of genus 4: one sees through between the legs, the haunches and the tail.
    assert_eq!(topology.euler_characteristic(), -6, "{topology:?}");
    assert_eq!(count_pieces(&mesh), 1);
    assert_eq!(mesh.bounds.min.y, 0.0);
    assert!((mesh.bounds.max.y - 1.6).abs() < 0.02, "{:?}", mesh.bounds);
    for side in [mesh.bounds.min.x, -mesh.bounds.max.x, mesh.bounds.min.z, -mesh.bounds.max.z] {
        assert!((side + 0.54).abs() < 0.01, "{:?}", mesh.bounds);
    }
    assert!(signed_volume(&mesh) > 0.1);
}

fn signed_volume(mesh: &Mesh) -> f64 {
    let corner = |index: &u32| glam::Vec3::from_array(mesh.positions[*index as usize]).as_dvec3();
    mesh.indices.chunks(3).map(|t| corner(&t[0]).dot(corner(&t[1]).cross(corner(&t[2]))) / 6.0).sum()
}

/// Sets of triangles that hang together.
fn count_pieces(mesh: &Mesh) -> usize {
    fn root_of(parent: &mut [usize], mut at: usize) -> usize {
        while parent[at] != at {
            parent[at] = parent[parent[at]];
            at = parent[at];
        }
        at
    }
    let (places, count) = topology::weld(&mesh.positions);
    let mut parent: Vec<usize> = (0..count).collect();
    for triangle in mesh.indices.chunks(3) {
        let [a, b, c] = [0, 1, 2].map(|k| root_of(&mut parent, places[triangle[k] as usize] as usize));
        parent[b] = a;
        let c = root_of(&mut parent, c);
        parent[c] = a;
    }
    (0..count).filter(|at| parent[*at] == *at).count()
}

#[test]
fn textures_are_as_they_must_be() {
    let load = |name| geometry::load_texture(&root().join("data/textures").join(name)).unwrap();
    let (floor, spot) = (load("floor.png"), load("spot.png"));
    assert_eq!((floor.width, floor.height, spot.width, spot.height), (512, 512, 256, 256));
    assert!(!floor.has_alpha && !spot.has_alpha);
    let texel = |x: u32, y: u32| &spot.rgba[4 * (256 * y + x) as usize..][..3];
    for k in 0..256 {
        for (x, y) in [(0, k), (255, k), (k, 0), (k, 255)] {
            assert_eq!(texel(x, y), [0, 0, 0]);
        }
    }
    assert!(texel(128, 128).iter().all(|channel| *channel > 230));
}

#[test]
fn negative_indices_count_back() {
    let mesh = load("negative.obj");
    assert!(mesh.is_closed());
    assert!(signed_volume(&mesh) > 0.16);
}

#[test]
fn concave_polygons_and_continued_lines() {
    let mesh = load("concave.obj");
    assert!(mesh.is_closed());
    assert_eq!(mesh.triangle_count(), 2 * 7 + 2 * 9);
    // The U: 9 less a slot of 1 by 2.
    assert!((signed_volume(&mesh) - 7.0).abs() < 1e-6, "{}", signed_volume(&mesh));
    // All its edges are sharp.
    for normal in &mesh.normals {
        assert_eq!(normal.iter().filter(|x| **x == 0.0).count(), 2, "{normal:?}");
    }
}

#[test]
fn objects_materials_and_textures() {
    let mesh = load("courtyard.obj");
    let parts: Vec<_> = mesh.parts.iter().map(|part| (part.name.as_str(), part.material.unwrap())).collect();
    assert_eq!(parts, [("ground", 0), ("fence", 1), ("hedge", 2)]);
    let [stone, fence, leaf] = &mesh.materials[..] else { panic!("{:?}", mesh.materials) };
    assert_eq!((stone.diffuse, stone.ambient, stone.shininess), ([0.8, 0.75, 0.7], [0.5; 3], 20.0));
    assert_eq!(stone.decal.as_ref().map(|decal| decal.width), Some(512));
    assert_eq!((fence.ambient, fence.opacity, leaf.opacity), (fence.diffuse, 1.0, 0.9));
    // One file, loaded once.
    assert!(std::sync::Arc::ptr_eq(fence.alpha.as_ref().unwrap(), leaf.alpha.as_ref().unwrap()));
    let part_normal = |k: usize| mesh.normals[mesh.indices[mesh.parts[k].indices.start as usize] as usize];
    assert_eq!([part_normal(0), part_normal(1), part_normal(2)], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
    assert_eq!(mesh.texcoords.as_ref().map(Vec::len), Some(mesh.positions.len()));
}
