//! The command `glumbra repack`: the knight, an OBJ model, refusals.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use assert_cmd::cargo::CommandCargoExt;
use glam::{DVec2, DVec3};
use glumbra::geometry::md2::{Model, NormalSource, Pose};
use glumbra::geometry::skin::{self, Raster, Skin};
use glumbra::geometry::{Mesh, load_obj};
use glumbra::png_file::PngTexts;

use super::meshes::*;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn data(path: &str) -> String {
    root().join(path).to_str().unwrap().to_owned()
}

fn glumbra(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("glumbra").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

/// The skin of an MD2 file's first frame.
fn md2_skin(path: &Path) -> Skin {
    let (model, warnings) = Model::load(path).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    let mesh = model.mesh(&Pose::default(), NormalSource::File);
    let texels = model.texels().map(|texel| DVec2::from_array(texel.map(f64::from)));
    Skin::of_texels(&mesh, model.file().skin_size.map(i32::cast_unsigned), texels)
}

/// Texels move whole in quarter turns: a lookup finds the same code, where the texel's centre lies in the triangle.
#[test]
fn the_knight_keeps_its_codes_and_loses_its_mirrors() {
    let folder = tempfile::tempdir().unwrap();
    let maps = ["knight.png", "knight-height.png", "knight-gloss.png"];
    let [decal, height, gloss] = maps.map(|name| data(&format!("data/textures/{name}")));
    let knight = data("data/meshes/knight.md2");
    let repack = |out: &str, more: &[&str]| {
        let mut arguments =
            vec!["repack", &knight, "--decal", &decal, "--height", &height, "--gloss", &gloss, "-o", out];
        arguments.extend(more);
        let output = glumbra(folder.path(), &arguments);
        assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let old = md2_skin(Path::new(&knight));
    let before = old.discontinuity();
    assert_eq!((old.mirrored(), before.mirrored_pairs), (410, 42));
    let mut random = fastrand::Rng::with_seed(17);
    for (out, more, mirrored) in [("shared", &[][..], (410, 42)), ("own", &["--unmirror"][..], (0, 0))] {
        let text = repack(out, more);
        println!("{text}");
        let at_out = folder.path().join(out);
        assert_eq!(names(&at_out), ["knight-gloss.png", "knight-height.png", "knight.md2", "knight.png"]);
        let new = md2_skin(&at_out.join("knight.md2"));
        let after = new.discontinuity();
        assert_eq!((new.mirrored(), after.mirrored_pairs), mirrored);
        assert!(after.mean_degrees <= before.mean_degrees);
        assert!(
            text.contains(&format!("{:.3}", after.mean_degrees))
                && text.contains(&format!("{:.3}", before.mean_degrees))
        );
        for name in maps {
            let [old_map, new_map] = [data(&format!("data/textures/{name}")).into(), at_out.join(name)]
                .map(|path: PathBuf| Raster::load(&path).unwrap());
            assert_eq!((new_map.size, new_map.channels), (new.size(), old_map.channels));
            let (mut compared, mut same) = (0, 0);
            for (before, after) in old.texels().zip(new.texels()) {
                for _ in 0..20 {
                    let weights = random_weights(&mut random);
                    let (from, to) = (at(&before, weights), at(&after, weights));
                    let centre = to.floor() + 0.5;
                    let side = |a: usize, b: usize| (after[b] - after[a]).perp_dot(centre - after[a]);
                    let sides = [side(0, 1), side(1, 2), side(2, 0)];
                    if sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0) {
                        compared += 1;
                        same += usize::from(lookup(&old_map, from) == lookup(&new_map, to));
                    }
                }
            }
            println!("{out}/{name}: {same} of {compared} lookups are the same");
            assert!(compared > 10_000);
            // Pieces turned by odd angles are filtered; without --unmirror there are none.
            assert!(out == "own" && same > compared / 2 || same == compared);
        }
    }
    let json: serde_json::Value = serde_json::from_str(&repack("numbers", &["--unmirror", "--json", "-"])).unwrap();
    assert_eq!((&json["islands"], &json["before"]["mirrored_triangles"]), (&20.into(), &410.into()));
    assert_eq!(json["before"]["across_edges"]["mean_degrees"].as_f64(), Some(before.mean_degrees));
    assert_eq!(json["after"]["across_edges"]["mirrored_pairs"], 0);
    // The same again, to the byte.
    repack("again", &["--unmirror"]);
    for name in names(&folder.path().join("own")) {
        let [first, second] = ["own", "again"].map(|out| fs::read(folder.path().join(out).join(&name)).unwrap());
        assert_eq!(first, second, "{name}");
    }
}

#[test]
fn md2_commands_are_strips_of_the_new_skin() {
    let path = root().join("data/meshes/knight.md2");
    let mut file = glumbra::geometry::md2::read(&fs::read(&path).unwrap(), &path).unwrap();
    file.gl_commands = vec![3, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0];
    let model = Model::new(file, "knight", |warning| panic!("{warning}"));
    let texels: Vec<[i16; 2]> = (0..model.indices().len()).map(|corner| [corner as i16 % 100, 7]).collect();
    let new = model.with_skin([128, 64], &texels).unwrap();
    assert_eq!((new.skin_size, new.triangles.len()), ([128, 64], model.indices().len() / 3));
    assert_eq!(new.frames, model.file().frames);
    let (strips, end) = new.gl_commands.as_chunks::<10>();
    assert_eq!(end, [0]);
    for (strip, triangle) in strips.iter().zip(&new.triangles) {
        assert_eq!(strip[0], 3);
        for corner in 0..3 {
            let [s, t] = [1, 2].map(|at| f32::from_bits(strip[3 * corner + at].cast_unsigned()));
            let [x, y] = new.texcoords[usize::from(triangle.texcoords[corner])].map(f32::from);
            assert_eq!([s, t], [x / 128.0, y / 64.0]);
            assert_eq!(strip[3 * corner + 3], i32::from(triangle.vertices[corner]));
        }
    }
}

/// Writes a cylinder of turned islands as an OBJ file with a decal beside it.
fn write_cylinder(folder: &Path) -> Mesh {
    let mut random = fastrand::Rng::with_seed(18);
    let mut mesh = Blocks { blocks: [4, 3], cells: [2, 2] }.mesh(cylinder, |_| (any_turn(&mut random), random.bool()));
    let indices = mesh.indices.len() as u32;
    let bounds = glumbra::math::Aabb::EMPTY;
    mesh.parts = vec![glumbra::geometry::Part { name: "can".into(), indices: 0..indices, material: None, bounds }];
    let skin = Skin::of_mesh(&mesh, [SIDE; 2]).unwrap();
    fs::write(folder.join("can.obj"), skin::write_obj(&mesh, &skin, None)).unwrap();
    fs::write(folder.join("label.png"), smooth_decal(&mut random).to_png(&PngTexts::default()).unwrap()).unwrap();
    mesh
}

#[test]
fn an_obj_model_comes_with_its_decal() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = write_cylinder(folder.path());
    let arguments = ["repack", "can.obj", "--decal", "label.png", "--unmirror", "-o", "new"];
    let output = glumbra(folder.path(), &arguments);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{}", String::from_utf8_lossy(&output.stdout));
    let out = folder.path().join("new");
    assert_eq!(names(&out), ["can.mtl", "can.obj", "label.png"]);
    let (new, warnings) = load_obj(&out.join("can.obj")).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    assert_eq!((new.parts.len(), new.parts[0].name.as_str()), (1, "can"));
    let texture = new.materials[new.parts[0].material.unwrap()].decal.as_ref().unwrap();
    let skin = Skin::of_mesh(&new, [texture.width, texture.height]).unwrap();
    let after = skin.discontinuity();
    assert!(after.mean_degrees < 0.06 && after.mirrored_pairs == 0, "{after:?}");
    let corners = |mesh: &Mesh| -> Vec<([f32; 3], [f32; 3])> {
        mesh.indices.iter().map(|index| (mesh.positions[*index as usize], mesh.normals[*index as usize])).collect()
    };
    for ((place, normal), (new_place, new_normal)) in corners(&mesh).into_iter().zip(corners(&new)) {
        assert_eq!(place, new_place);
        assert!(DVec3::from(normal.map(f64::from)).distance(DVec3::from(new_normal.map(f64::from))) < 1e-6);
    }
    // Deep pictures stay deep.
    let deep = Raster { size: [8; 2], channels: 1, is_deep: true, samples: vec![40_000; 64] };
    fs::write(folder.path().join("deep.png"), deep.to_png(&PngTexts::default()).unwrap()).unwrap();
    let output = glumbra(folder.path(), &["repack", "can.obj", "--height", "deep.png", "--size", "64x64", "-o", "low"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let map = Raster::load(&folder.path().join("low/deep.png")).unwrap();
    assert!(map.is_deep && map.size == [64; 2] && map.samples.iter().all(|code| *code == 40_000));
}

#[test]
fn bad_input_gets_one_clear_error_and_no_file() {
    let folder = tempfile::tempdir().unwrap();
    write_cylinder(folder.path());
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let knight = data("data/meshes/knight.md2");
    let bytes = fs::read(&knight).unwrap();
    write("short.md2", &bytes[..1000]);
    write("bare.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("far.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1e30 0\nvt 0 1e30\nf 1/1 2/2 3/3\n");
    write("broken.png", b"no picture");
    write("model.txt", b"");
    fs::create_dir(folder.path().join("copy")).unwrap();
    fs::copy(folder.path().join("label.png"), folder.path().join("copy/label.png")).unwrap();
    write("file", b"");
    fs::create_dir_all(folder.path().join("taken/label.png")).unwrap();
    let cases: &[(&[&str], &str)] = &[
        (&["missing.md2", "-o", "out"], "missing.md2: cannot be read"),
        (&["short.md2", "-o", "out"], "short.md2: at byte 48: "),
        (&["model.txt", "-o", "out"], "model.txt: cannot tell the format: a model ends in .md2 or .obj"),
        (&["bare.obj", "--decal", "label.png", "-o", "out"], "bare.obj: has no texture coordinates"),
        (&["can.obj", "-o", "out"], "can.obj: an OBJ model does not say how many texels"),
        (&["can.obj", "--decal", "broken.png", "-o", "out"], "broken.png: is not a picture"),
        (&["can.obj", "--decal", "label.png", "--size", "0x9", "-o", "out"], "--size 0x9: a skin has 1 to 8192"),
        (
            &["can.obj", "--decal", "label.png", "--size", "20x20", "-o", "out"],
            "20x20 texels have no room for 12 pieces",
        ),
        (&["far.obj", "--decal", "label.png", "-o", "out"], "need more than 8192x8192 texels"),
        (&["can.obj", "--decal", "label.png", "-o", "."], "can.obj: is read by this command; name another folder"),
        (&["can.obj", "--decal", "label.png", "--height", "copy/label.png", "-o", "out"], "rename copy/label.png"),
        (&["can.obj", "--decal", "label.png", "--frame", "3", "-o", "out"], "--frame is of MD2 models"),
        (&["can.obj", "--decal", "label.png", "--steps", "8", "-o", "out"], "--steps is of MD2 models"),
        (&[&knight, "--frame", "16", "-o", "out"], "has 16 frames; --frame 16 counts from 0"),
        (&[&knight, "--steps", "128", "-o", "out"], "--steps 128 makes a side of the skin 65536 steps long"),
        (&["can.obj", "--decal", "label.png", "-o", "file"], "file: cannot be written"),
        (&["can.obj", "--decal", "label.png", "-o", "taken"], "label.png: is a folder, where a file would be written"),
    ];
    for (arguments, expected) in cases {
        let output = glumbra(folder.path(), &[&["repack"], *arguments].concat());
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {error}");
        assert!(error.starts_with("error: ") && error.lines().count() == 1, "{arguments:?}: {error}");
        assert!(error.contains(expected), "{arguments:?}: {error}");
        assert!(output.stdout.is_empty() && !folder.path().join("out").exists(), "{arguments:?}");
    }
    assert_eq!(names(&folder.path().join("taken")), ["label.png"]);
    for wrong in [&["--gutter", "0"][..], &["--cut", "200"], &["--cut", "nan"], &["--size", "9"]] {
        let output = glumbra(folder.path(), &[&["repack", "can.obj", "-o", "out"], wrong].concat());
        assert_eq!(output.status.code(), Some(2), "{wrong:?}");
    }
}
