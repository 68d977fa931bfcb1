//! Looks of a file's meshes: the same scene as OBJ and MTL gives the same picture.

use glam::DVec3;
use glumbra::geometry::Mesh;
use serde_json::{Value, json};

use super::glb::{COORDINATES, CORNERS, Glb, NORMALS, TRIANGLES, wedge, wedge_attributes, wedge_obj};
use super::{assert_same, scene};

/// A PNG of four by two texels, each another colour, half of them transparent.
fn picture() -> Vec<u8> {
    let colors = (0..8u8).map(|at| [30 * at, 255 - 20 * at, 17 * at, if at % 3 == 0 { 40 } else { 255 }]);
    let image = image::RgbaImage::from_raw(4, 2, colors.flatten().collect()).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// A wedge with a texture of [`picture`] in the file itself.
pub fn textured(sampler: Value, material: impl FnOnce(usize) -> Value) -> Glb {
    let mut glb = Glb::new();
    let view = glb.view(&picture());
    let image = glb.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
    let sampler = glb.push("samplers", sampler);
    let texture = glb.push("textures", json!({ "source": image, "sampler": sampler }));
    let material = glb.push("materials", material(texture));
    let mesh = wedge(&mut glb, Some(material));
    glb.root(json!({ "mesh": mesh }));
    glb
}

fn base(texture: usize) -> Value {
    json!({ "baseColorTexture": { "index": texture }, "baseColorFactor": [1.0, 0.5, 0.75, 1.0], "metallicFactor": 0.0 })
}

/// Compares a file with the wedge as an OBJ whose library has these statements; the texture `p.png` lies beside it.
fn compare(glb: &Glb, statements: &str) {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    glb.write(folder.path(), "w.glb");
    std::fs::write(at("p.png"), picture()).unwrap();
    std::fs::write(at("w.mtl"), format!("newmtl m\nKa 1 0.5 0.75\nKd 1 0.5 0.75\n{statements}\n")).unwrap();
    std::fs::write(at("w.obj"), wedge_obj(Some(("w.mtl", "m")))).unwrap();
    let found = scene(folder.path(), "a.toml", "[[object]]\nmesh = \"w.glb\"\n");
    let expected = scene(folder.path(), "b.toml", "[[object]]\nmesh = \"w.obj\"\n");
    assert_same(&found, &expected);
}

#[test]
fn an_opaque_texture_is_drawn_without_its_alpha() {
    let glb = textured(json!({}), |texture| json!({ "pbrMetallicRoughness": base(texture) }));
    let folder = tempfile::tempdir().unwrap();
    glb.write(folder.path(), "w.glb");
    let mut solid = image::load_from_memory(&picture()).unwrap().into_rgba8();
    solid.pixels_mut().for_each(|texel| texel.0[3] = 255);
    solid.save(folder.path().join("s.png")).unwrap();
    std::fs::write(folder.path().join("w.mtl"), "newmtl m\nKa 1 0.5 0.75\nKd 1 0.5 0.75\nmap_Kd s.png\n").unwrap();
    std::fs::write(folder.path().join("w.obj"), wedge_obj(Some(("w.mtl", "m")))).unwrap();
    let found = scene(folder.path(), "a.toml", "[[object]]\nmesh = \"w.glb\"\n");
    assert_same(&found, &scene(folder.path(), "b.toml", "[[object]]\nmesh = \"w.obj\"\n"));
}

#[test]
fn a_mask_is_an_alpha_test_and_a_sampler_clamps() {
    let clamped = json!({ "wrapS": 33071, "wrapT": 33071, "magFilter": 9729, "minFilter": 9987 });
    for (sampler, option) in [(json!({}), ""), (clamped, "-clamp on ")] {
        let masked = |texture| json!({ "pbrMetallicRoughness": base(texture), "alphaMode": "MASK" });
        compare(&textured(sampler, masked), &format!("map_Kd {option}p.png"));
    }
}

/// A cut-off of 0.75 with a factor of 1 discards what an opacity of 2/3 does at 0.5.
#[test]
fn a_cut_off_is_an_opacity() {
    let masked = |texture| json!({ "pbrMetallicRoughness": base(texture), "alphaMode": "MASK", "alphaCutoff": 0.625 });
    compare(&textured(json!({}), masked), "map_Kd p.png\nd 0.8");
}

#[test]
fn a_texture_transform_moves_scales_and_turns() {
    let moved = |texture: usize| {
        let mut pbr = base(texture);
        let transform = json!({ "offset": [0.25, -0.5], "scale": [2.0, 0.5] });
        pbr["baseColorTexture"]["extensions"] = json!({ "KHR_texture_transform": transform });
        json!({ "pbrMetallicRoughness": pbr, "alphaMode": "MASK" })
    };
    // t = 1 - v: t' = 1 - (0.5 (1 - t) - 0.5) = 0.5 t + 1.
    compare(&textured(json!({}), moved), "map_Kd -s 2 0.5 -o 0.25 1 p.png");
}

/// A turn by a right angle, which MTL has not: (u, v) becomes (v, -u), halved and moved by (0, 1), with v downwards.
#[test]
fn a_texture_transform_turns() {
    let turned = |texture: usize| {
        let mut pbr = base(texture);
        let transform = json!({ "offset": [0.0, 1.0], "rotation": std::f32::consts::FRAC_PI_2, "scale": [0.5, 0.5] });
        pbr["baseColorTexture"]["extensions"] = json!({ "KHR_texture_transform": transform });
        json!({ "pbrMetallicRoughness": pbr })
    };
    let folder = tempfile::tempdir().unwrap();
    textured(json!({}), turned).write(folder.path(), "w.glb");
    let loaded = scene(folder.path(), "a.toml", "[[object]]\nmesh = \"w.glb\"\n");
    let found = loaded.scene.objects[1].mesh.texcoords.as_ref().unwrap();
    for (found, [u, v]) in found.iter().zip(COORDINATES) {
        // t = 1 - (1 - u / 2)
        let expected = [0.5 * v, 0.5 * u];
        assert!((0..2).all(|k| (found[k] - expected[k]).abs() < 1e-6), "{found:?}: {expected:?}");
    }
}

/// Six times the volume that triangles enclose, above 0 where they are counter-clockwise from outside; seen from a point in
/// none of their planes, so that each of them counts.
fn volume(mesh: &Mesh, scale: f64) -> f64 {
    let from = DVec3::new(0.3, -1.0, 0.2);
    let corner = |index: &u32| scale * DVec3::from_array(mesh.positions[*index as usize].map(f64::from)) - from;
    let of = |[a, b, c]: &[u32; 3]| corner(a).dot(corner(b).cross(corner(c)));
    mesh.indices.as_chunks::<3>().0.iter().map(of).sum()
}

/// Primitives of one wedge: its triangles in strips and fans, its positions as normalised and as whole numbers, or as zeros
/// that a sparse accessor replaces.
#[test]
fn other_shapes_of_the_same_triangles_look_the_same() {
    let strip = |glb: &mut Glb, mode: u32, orders: &[&[u16]]| {
        let attributes = wedge_attributes(glb);
        let primitives: Vec<Value> = orders
            .iter()
            .map(|order| json!({ "attributes": attributes, "indices": glb.indices(order), "mode": mode }))
            .collect();
        json!({ "primitives": primitives })
    };
    let quantized = |glb: &mut Glb| {
        // Four times the positions as bytes, in elements of four bytes: half of 0.25 is no whole number.
        let bytes: Vec<u8> = CORNERS
            .iter()
            .flat_map(|corner| [corner[0], corner[1], corner[2], 0.0].map(|x| (4.0 * x) as i8 as u8))
            .collect();
        let view = glb.view(&bytes);
        glb.json["bufferViews"][view]["byteStride"] = json!(4);
        let accessor = json!({ "bufferView": view, "componentType": 5120, "type": "VEC3", "count": 5 });
        let position = glb.push("accessors", accessor);
        let bytes: Vec<u8> = NORMALS.iter().flat_map(|normal| normal.map(|x| (127.0 * x) as i8 as u8)).collect();
        let normal = glb.accessor(&bytes, 5120, "VEC3", 5);
        glb.json["accessors"][normal]["normalized"] = json!(true);
        glb.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        let indices = glb.indices(&TRIANGLES);
        json!({ "primitives": [{ "attributes": { "POSITION": position, "NORMAL": normal }, "indices": indices }] })
    };
    let sparse = |glb: &mut Glb| {
        let attributes = wedge_attributes(glb);
        let (places, values) = (glb.view(&[0, 1, 2, 3, 4]), glb.view(bytemuck::cast_slice(&CORNERS)));
        let accessor = json!({
            "componentType": 5126, "type": "VEC3", "count": 5,
            "sparse": { "count": 5, "indices": { "bufferView": places, "componentType": 5121 }, "values": { "bufferView": values } },
        });
        let position = glb.push("accessors", accessor);
        let indices = glb.indices(&TRIANGLES);
        let attributes = json!({ "POSITION": position, "NORMAL": attributes["NORMAL"] });
        json!({ "primitives": [{ "attributes": attributes, "indices": indices }] })
    };
    // Strips and fans whose triangles are those of the wedge, each with the same last corner, which decides nothing here.
    let strips: &[&[u16]] = &[&[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4], &[0, 3, 1, 2]];
    let fans: &[&[u16]] = &[&[4, 0, 1, 2, 3, 0], &[0, 3, 2, 1]];
    type Make<'a> = &'a dyn Fn(&mut Glb) -> Value;
    let kinds: [(&str, f64, Make<'_>); 4] = [
        ("strips", 1.0, &|glb| strip(glb, 5, strips)),
        ("fans", 1.0, &|glb| strip(glb, 6, fans)),
        ("quantised", 0.25, &quantized),
        ("sparse", 1.0, &sparse),
    ];
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("w.obj"), wedge_obj(None)).unwrap();
    let material = "material = { diffuse = [1, 1, 1] }\n";
    for (name, scale, make) in kinds {
        let mut glb = Glb::new();
        let mesh = make(&mut glb);
        let mesh = glb.push("meshes", mesh);
        glb.root(json!({ "mesh": mesh, "scale": [scale, scale, scale] }));
        glb.write(folder.path(), &format!("{name}.glb"));
        let found = scene(folder.path(), "a.toml", &format!("[[object]]\nmesh = \"{name}.glb\"\n"));
        let expected = scene(folder.path(), "b.toml", &format!("[[object]]\nmesh = \"w.obj\"\n{material}"));
        assert_same(&found, &expected);
        // A picture shows both sides alike: the turn of each triangle is seen here.
        let [found, expected] =
            [(found, scale), (expected, 1.0)].map(|(loaded, scale)| volume(&loaded.scene.objects[1].mesh, scale));
        assert!((found - expected).abs() < 1e-6, "{name}: {found}, {expected}");
    }
}

/// Without normals each triangle has its own.
#[test]
fn triangles_without_normals_are_flat() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = Glb::new();
    let (position, indices) = (glb.floats(&CORNERS), glb.indices(&TRIANGLES));
    let mesh =
        glb.push("meshes", json!({ "primitives": [{ "attributes": { "POSITION": position }, "indices": indices }] }));
    glb.root(json!({ "mesh": mesh }));
    glb.write(folder.path(), "flat.glb");
    let loaded = scene(folder.path(), "a.toml", "[[object]]\nmesh = \"flat.glb\"\n");
    let mesh = &loaded.scene.objects[1].mesh;
    assert!(mesh.is_closed());
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|index| glam::Vec3::from_array(mesh.positions[index as usize]));
        let normal = (b - a).cross(c - a).normalize();
        for index in triangle {
            assert!(normal.distance(glam::Vec3::from_array(mesh.normals[*index as usize])) < 1e-6);
        }
    }
}

/// Bases of the file's own tangents, the third with a turned sense; a normal map's green points up.
#[test]
fn normal_maps_take_the_files_tangents() {
    let folder = tempfile::tempdir().unwrap();
    let mut glb = textured(
        json!({}),
        |texture| json!({ "normalTexture": { "index": texture }, "pbrMetallicRoughness": { "metallicFactor": 0.0 } }),
    );
    let tangents: Vec<[f32; 4]> =
        NORMALS.iter().zip([1.0, 1.0, -1.0, 1.0, 1.0]).map(|([x, y, z], sense)| [*y, *z, *x, sense]).collect();
    let accessor = glb.floats(&tangents);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = json!(accessor);
    glb.write(folder.path(), "n.glb");
    let loaded = scene(folder.path(), "a.toml", "[[object]]\nmesh = \"n.glb\"\n");
    let mesh = &loaded.scene.objects[1].mesh;
    assert!(mesh.materials[0].bump.is_some());
    let found = mesh.tangents.as_ref().unwrap();
    for (at, ([x, y, z, sense], normal)) in tangents.iter().zip(&NORMALS).enumerate() {
        let tangent = glam::Vec3::new(*x, *y, *z);
        let across = *sense * glam::Vec3::from_array(*normal).cross(tangent);
        assert_eq!((found.tangents[at], found.bitangents[at]), (tangent.to_array(), across.to_array()), "{at}");
    }
}
