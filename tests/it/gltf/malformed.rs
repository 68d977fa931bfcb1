//! Files that are wrong: one error each, which names the file and the place; no byte that is changed makes the reader panic.

use serde_json::{Value, json};

use super::glb::{Glb, wedge};
use super::refusal;
use crate::support::random::Random;

fn whole() -> Glb {
    let mut glb = Glb::new();
    let material = glb.push("materials", json!({ "alphaMode": "MASK" }));
    let mesh = wedge(&mut glb, Some(material));
    glb.root(json!({ "mesh": mesh }));
    glb
}

/// A change of the file, and a part of its error.
type Wrong = (&'static str, fn(&mut Value), &'static str);

const WRONG: [Wrong; 22] = [
    (
        "needs an extension",
        |j| j["extensionsRequired"] = json!(["KHR_draco_mesh_compression", "KHR_mesh_quantization"]),
        "extensionsRequired: needs KHR_draco_mesh_compression, which",
    ),
    ("version", |j| j["asset"]["version"] = json!("1.0"), "asset: is of glTF 1.0; 2.0 can be read"),
    ("index beyond the list", |j| j["nodes"][0]["mesh"] = json!(7), "nodes[0].mesh: names meshes[7], which"),
    ("scene", |j| j["scene"] = json!(3), "scene: names scenes[3], which"),
    ("circle", |j| j["nodes"][0]["children"] = json!([0]), "nodes[0]: lies below two nodes, or below itself"),
    ("child", |j| j["nodes"][0]["children"] = json!([9]), "nodes[0].children: names nodes[9]"),
    (
        "matrix",
        |j| j["nodes"][0]["matrix"] = json!([1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
        "nodes[0]: has a matrix that is not affine",
    ),
    ("rotation", |j| j["nodes"][0]["rotation"] = json!([0, 0, 0, 0]), "nodes[0]: has a rotation without a length"),
    (
        "no numbers of bytes",
        |j| j["accessors"][0]["componentType"] = json!(5125),
        "accessors[0]: is VEC3 of unsigned integers, which meshes[0].primitives[0].attributes.POSITION cannot be",
    ),
    ("type", |j| j["accessors"][1]["type"] = json!("VEC2"), "accessors[1]: is VEC2 of floats"),
    (
        "unknown type",
        |j| j["accessors"][1]["type"] = json!("VEC9"),
        "accessors[1]: has a `type` that glTF does not know",
    ),
    ("unknown component", |j| j["accessors"][1]["componentType"] = json!(1), "accessors[1]: has a `componentType`"),
    ("count", |j| j["accessors"][1]["count"] = json!(4), "attributes.NORMAL: has 4 elements for 5 vertices"),
    (
        "beyond the view",
        |j| j["accessors"][0]["count"] = json!(4_000_000_000_u64),
        "accessors[0]: has 4000000000 elements, which go beyond",
    ),
    ("offset", |j| j["accessors"][0]["byteOffset"] = json!(u64::MAX), "accessors[0]: has 5 elements, which go beyond"),
    (
        "stride",
        |j| j["bufferViews"][0]["byteStride"] = json!(4),
        "accessors[0]: has elements of 12 bytes, 4 bytes apart",
    ),
    ("view", |j| j["bufferViews"][0]["byteLength"] = json!(1000), "bufferViews[0]: ends at byte 1000 of a buffer of"),
    (
        "sparse",
        |j| j["accessors"][0]["sparse"] = json!({ "count": 1, "indices": { "bufferView": 3, "componentType": 5123, "byteOffset": 0 }, "values": { "bufferView": 77 } }),
        "accessors[0].sparse: names bufferViews[77]",
    ),
    (
        "index",
        |j| j["accessors"][0]["count"] = json!(4),
        "indices: is 4 at element 2, and the primitive has 4 vertices",
    ),
    (
        "buffer",
        |j| j["buffers"][0]["uri"] = json!("gone.bin"),
        "buffers[0]: names gone.bin, which is not beside the model",
    ),
    (
        "data",
        |j| j["buffers"][0]["uri"] = json!("data:application/octet-stream;base64,AAAA"),
        "buffers[0]: has 3 bytes of the",
    ),
    ("mode", |j| j["meshes"][0]["primitives"][0]["mode"] = json!(99), "meshes[0].primitives[0].mode: is none"),
];

#[test]
fn each_wrong_file_has_its_own_error() {
    let folder = tempfile::tempdir().unwrap();
    for (name, change, expected) in WRONG {
        let mut glb = whole();
        change(&mut glb.json);
        let path = glb.write(folder.path(), "w.glb");
        let error = refusal(&path);
        let start = format!("{}: ", path.display());
        assert!(error.starts_with(&start) && error.contains(expected), "{name}: {error}");
        assert!(!error.contains('\n'), "{error}");
    }
}

#[test]
fn numbers_that_are_not_finite_and_indices_that_are_not_there_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let error = |at: usize, bytes: &[u8]| {
        let mut glb = whole();
        glb.binary[at..at + bytes.len()].copy_from_slice(bytes);
        refusal(&glb.write(folder.path(), "w.glb"))
    };
    let nan = error(16, &f32::NAN.to_le_bytes());
    assert!(nan.contains("w.glb: accessors[0]: has a number that is not finite, at element 1"), "{nan}");
    // Positions, normals, coordinates, then indices.
    let beyond = error(5 * (12 + 12 + 8) + 4, &5u16.to_le_bytes());
    let expected = "w.glb: meshes[0].primitives[0].indices: is 5 at element 2, and the primitive has 5 vertices";
    assert!(beyond.contains(expected), "{beyond}");
}

#[test]
fn a_file_that_is_cut_off_is_an_error_wherever_it_ends() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = whole().bytes();
    let path = folder.path().join("cut.glb");
    for length in 0..bytes.len() {
        std::fs::write(&path, &bytes[..length]).unwrap();
        let error = refusal(&path);
        assert!(error.starts_with(&path.display().to_string()), "{length}: {error}");
    }
}

/// Bytes changed at random: the file loads or has an error that names it.
#[test]
fn no_changed_byte_makes_the_reader_panic() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = whole().bytes();
    let path = folder.path().join("changed.glb");
    let mut random = Random::new(0x617f);
    let mut loaded = 0;
    for round in 0..1500 {
        let mut changed = bytes.clone();
        for _ in 0..1 + random.below(3) {
            let at = random.below(changed.len());
            changed[at] = if round % 2 == 0 { changed[at] ^ (1 << random.below(8)) } else { random.below(256) as u8 };
        }
        std::fs::write(&path, &changed).unwrap();
        match glumbra::load(&path, &[]) {
            Ok(_) => loaded += 1,
            Err(error) => assert!(error.to_string().contains(&path.display().to_string()), "{error}"),
        }
    }
    assert!((100..1400).contains(&loaded), "{loaded} of 1500 load: the changes are too small or too large");
}
