//! Models a million units from their file's origin: moved back, they are drawn to the bits of the same model there.

use serde_json::json;

use super::glb::{CORNERS, Glb, NORMALS, TRIANGLES};
use super::{assert_same, load, scene};

/// A distance from which positions of an eighth of a unit are whole 32-bit floats.
const FAR: f32 = 1_048_576.0;

/// The wedge's corners, aside by `x`, and made a cube's size about the middle so that the origin is found exactly.
fn corners(x: f32) -> Vec<[f32; 3]> {
    CORNERS.iter().map(|corner| [corner[0] + x, corner[1] - 0.75, corner[2]]).collect()
}

fn glb(x: f32) -> Vec<u8> {
    let mut glb = Glb::new();
    let (position, normal) = (glb.floats(&corners(x)), glb.floats(&NORMALS));
    let indices = glb.indices(&TRIANGLES);
    let primitive = json!({ "attributes": { "POSITION": position, "NORMAL": normal }, "indices": indices });
    let mesh = glb.push("meshes", json!({ "primitives": [primitive] }));
    glb.root(json!({ "mesh": mesh }));
    glb.bytes()
}

fn ply(x: f32) -> Vec<u8> {
    let mut text = String::from(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty double z\n\
         element face 6\nproperty list uchar int vertex_indices\nend_header\n",
    );
    corners(x).iter().for_each(|[x, y, z]| text += &format!("{x} {y} {z}\n"));
    TRIANGLES.as_chunks::<3>().0.iter().for_each(|[a, b, c]| text += &format!("3 {a} {b} {c}\n"));
    text.into_bytes()
}

fn stl(x: f32) -> Vec<u8> {
    let corners = corners(x);
    let mut bytes = [vec![0; 80], 6_u32.to_le_bytes().to_vec()].concat();
    for triangle in TRIANGLES.as_chunks::<3>().0 {
        bytes.extend([0; 12]);
        for at in triangle {
            bytes.extend(corners[usize::from(*at)].iter().flat_map(|number| number.to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn a_far_model_moved_back_is_the_near_one_to_the_bit() {
    type Make = fn(f32) -> Vec<u8>;
    for (end, make) in [("glb", glb as Make), ("ply", ply), ("stl", stl)] {
        let folder = tempfile::tempdir().unwrap();
        for (name, x) in [("near", 0.0), ("far", FAR)] {
            std::fs::write(folder.path().join(format!("{name}.{end}")), make(x)).unwrap();
        }
        let material = "material = { diffuse = [0.8, 0.6, 0.4] }\n";
        let near = scene(folder.path(), "near.toml", &format!("[[object]]\nmesh = \"near.{end}\"\n{material}"));
        let back = format!("[[object]]\nmesh = \"far.{end}\"\ntranslate = [{}, 0, 0]\n{material}", -FAR);
        let far = scene(folder.path(), "far.toml", &back);
        let place = far.scene.objects[1].mesh.origin;
        assert!((place.x - f64::from(FAR)).abs() <= 2.0, "{end}: {place}");
        assert_same(&far, &near);
        // The supplied camera and light stand around the model where it is.
        let supplied = load(&folder.path().join(format!("far.{end}")), &[]);
        let target = supplied.scene.camera.target;
        assert!((target.x - f64::from(FAR)).abs() < 8.0, "{end}: {target}");
    }
}
