//! `instances` of an object: one mesh at many places, from the scene or from a file, is what the objects written out are.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use glumbra::context::{self, ContextRequest};
use glumbra::device::Pixels;
use glumbra::frame::Renderer;
use glumbra::plan::Request;
use glumbra::scene::Scene;
use glumbra::truth;
use proptest::prelude::*;

/// A place as keys of TOML and as a line of JSON.
struct Place {
    toml: &'static [&'static str],
    json: &'static str,
}

const PLACES: [Place; 4] = [
    Place {
        toml: &["translate = [-1.5, 0.6, 0.2]", "scale = 0.5"],
        json: r#"{"translate": [-1.5, 0.6, 0.2], "scale": 0.5}"#,
    },
    Place {
        toml: &["translate = [1.1, 1, -0.7]", "rotate = { axis = [1, 2, 0.3], angle = 33.3 }"],
        json: r#"{"translate": [1.1, 1, -0.7], "rotate": {"axis": [1, 2, 0.3], "angle": 33.3}}"#,
    },
    Place {
        toml: &[
            "rotate = [{ axis = [0, 1, 0], angle = 20 }, { axis = [1, 0, 0], angle = 400 }]",
            "scale = [-0.3, 0.4, 0.3]",
        ],
        json: r#"{"rotate": [{"axis": [0, 1, 0], "angle": 20}, {"axis": [1, 0, 0], "angle": 400}], "scale": [-0.3, 0.4, 0.3]}"#,
    },
    Place { toml: &[], json: "{}" },
];

/// A scene's text before the object with instances.
fn start(technique: &str) -> String {
    format!(
        "[image]\nsize = [160, 120]\n[camera]\neye = [2, 3, 6]\ntarget = [0, 0.4, 0]\n\
         [[light]]\nposition = [3, 6, 2]\ntarget = [0, 0, 0]\ncone = 60\nshadow = {{ technique = \"{technique}\" }}\n\
         [[object]]\nmesh = \"quad\"\nscale = 5.0\n"
    )
}

/// Keys that all instances share.
const SHARED: &str = "mesh = \"torus\"\nmaterial = { diffuse = [0.8, 0.4, 0.2], specular = [0.5, 0.5, 0.5] }\n";

fn load(folder: &Path, text: &str) -> Result<Scene, String> {
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    let loaded = glumbra::load(&path, &[]).map_err(|error| error.to_string())?;
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    Ok(loaded.scene)
}

/// The scene with its objects written out, with an array of instances, and with a file of them.
fn three(folder: &Path, technique: &str) -> [Scene; 3] {
    let mut written = start(technique);
    for (number, place) in PLACES.iter().enumerate() {
        let keys = place.toml.join("\n");
        let _ = writeln!(written, "[[object]]\nname = \"torus[{number}]\"\n{SHARED}{keys}");
    }
    let array: Vec<String> = PLACES.iter().map(|place| format!("{{ {} }}", place.toml.join(", "))).collect();
    let array = format!("{}[[object]]\n{SHARED}instances = [{}]\n", start(technique), array.join(", "));
    // A blank line is no instance.
    let lines: Vec<&str> = PLACES.iter().map(|place| place.json).collect();
    fs::write(folder.join("places.jsonl"), format!("{}\n\n", lines.join("\n"))).unwrap();
    let file = format!("{}[[object]]\n{SHARED}instances = \"places.jsonl\"\n", start(technique));
    [written, array, file].map(|text| load(folder, &text).unwrap())
}

fn picture(renderer: &mut Renderer, scene: &Scene) -> Pixels {
    renderer.render(scene, &Request::default()).unwrap().picture
}

#[test]
fn instances_are_the_objects_written_out_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let context = context::open(&ContextRequest::default()).unwrap();
    for technique in ["shadow-map", "midpoint", "shadow-volume"] {
        let scenes = three(folder.path(), technique);
        let bits = |scene: &Scene| -> Vec<(String, [u64; 16])> {
            let of = |object: &glumbra::scene::Object| object.world_from_model.to_cols_array().map(f64::to_bits);
            scene.objects.iter().map(|object| (object.name.clone(), of(object))).collect()
        };
        let names: Vec<&str> = scenes[1].objects.iter().map(|object| object.name.as_str()).collect();
        assert_eq!(names, ["quad", "torus[0]", "torus[1]", "torus[2]", "torus[3]"]);
        let drawn = scenes.each_ref().map(|scene| picture(&mut Renderer::new(&context), scene));
        let traced = scenes.each_ref().map(|scene| truth::trace(scene, 0, &truth::Options::default()).unwrap());
        for other in 1..3 {
            assert_eq!(bits(&scenes[0]), bits(&scenes[other]), "{technique}");
            assert!(drawn[0] == drawn[other], "{technique}: pictures of scene {other} differ");
            assert!(format!("{:?}", traced[0]) == format!("{:?}", traced[other]), "{technique}: truth {other} differs");
            let first = &scenes[other].objects[1];
            let rest = &scenes[other].objects[2..];
            assert!(rest.iter().all(|object| Arc::ptr_eq(&object.mesh, &first.mesh)), "one mesh");
            let material = |object: &glumbra::scene::Object| object.material.as_ref().map(Arc::as_ptr);
            assert!(rest.iter().all(|object| material(object) == material(first)), "one material");
        }
        // The picture shows them: without the last of them it is another.
        let mut fewer = scenes[2].clone();
        fewer.objects.pop();
        assert!(picture(&mut Renderer::new(&context), &fewer) != drawn[2]);
    }
}

#[test]
fn the_objects_own_placement_moves_all() {
    let folder = tempfile::tempdir().unwrap();
    let group = "translate = [0.5, 0, 0]\nrotate = { axis = [0, 1, 0], angle = 90 }\nscale = 2.0\n";
    let text =
        format!("{}[[object]]\nmesh = \"box\"\n{group}instances = [{{ translate = [1, 0, 0] }}]\n", start("none"));
    let placed = load(folder.path(), &text).unwrap().objects[1].world_from_model;
    // Turned by 90 degrees about y, x becomes -z.
    let corner = placed.transform_point3(glam::DVec3::new(0.5, 0.5, 0.5));
    assert!(corner.distance(glam::DVec3::new(1.5, 1.0, -3.0)) < 1e-12, "{corner}");
}

#[test]
fn overrides_reach_instances() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let text = format!("{}[[object]]\nmesh = \"box\"\ninstances = [{{}}, {{}}]\n", start("none"));
    fs::write(&path, text).unwrap();
    fs::write(folder.path().join("three.jsonl"), "{}\n{}\n{}\n").unwrap();
    let objects = |set: &str| glumbra::load(&path, &[set.to_owned()]).map(|loaded| loaded.scene.objects);
    let moved = objects("object[1].instances[1].translate=[1, 2, 3]").unwrap();
    let [first, second] = [1, 2].map(|index| moved[index].world_from_model.w_axis.truncate());
    assert_eq!((first, second), (glam::DVec3::ZERO, glam::DVec3::new(1.0, 2.0, 3.0)));
    let file = format!("object.1.instances={}", folder.path().join("three.jsonl").display());
    assert_eq!(objects(&file).unwrap().len(), 4);
    let hidden = objects("object.1.casts_shadow=false").unwrap();
    assert_eq!(hidden.iter().filter(|object| object.casts_shadow).count(), 1);
}

/// Errors of the scene itself, each with its key and the line of that on which it is found.
#[test]
fn errors_in_a_scene_name_the_line() {
    let folder = tempfile::tempdir().unwrap();
    let before = start("none").lines().count();
    for (keys, line, expected) in [
        ("instances = 3", 3, "`object.instances` must be an array of tables, or a file"),
        ("instances = [1]", 3, "`object.instances` must be an array of tables"),
        ("instances = []", 3, "`object.instances` has none"),
        ("instances = \"\"", 3, "`object.instances` must name a file"),
        ("instances = [{},\n{ scale = 0 }]", 4, "`object.instances.scale` must not be zero"),
        ("instances = [{},\n{ translate = [1e19, 0, 0] }]", 4, "`object.instances.translate` must be"),
        ("instances = [{},\n{ translate = [1e18, 0, 0], scale = 1e17 }]", 4, "object \"box[1]\" reaches out to 1"),
        ("instances = [{ lit = false }]", 3, "unknown key `lit` in [object.instances]"),
    ] {
        let text = format!("{}[[object]]\nmesh = \"box\"\n{keys}\n", start("none"));
        let error = load(folder.path(), &text).map(drop).unwrap_err();
        let place = format!("scene.toml:{}: ", before + line);
        assert!(error.contains(&place) && error.contains(expected), "{keys}: {error}");
    }
}

#[test]
fn errors_in_a_file_name_the_line() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("{}[[object]]\nmesh = \"box\"\ninstances = \"places.jsonl\"\n", start("none"));
    let absent = load(folder.path(), &text).map(drop).unwrap_err();
    assert!(absent.contains("places.jsonl: cannot be read: "), "{absent}");
    let in_scene = format!("scene.toml:{}: ", text.lines().count());
    for (lines, place, expected) in [
        ("\n\n", in_scene.as_str(), "`object.instances` has none"),
        ("{}\n\n{\"scale\": 0}\n", "places.jsonl:3: ", "`object.instances.scale` must not be zero"),
        ("{}\n{\"scal\": 1}\n", "places.jsonl:2: ", "did you mean `scale`"),
        ("{}\n{\"scale\": \"x\"}\n", "places.jsonl:2: ", "must be a number or an array of three"),
        ("{}\n{\"translate\": [1, 2]}\n", "places.jsonl:2: ", "must have 3 numbers, not 2"),
        ("[{}, {}]\n", "places.jsonl:1: ", "expected a JSON object a line"),
        ("{}\n{\"scale\": 1\n", "places.jsonl:2: ", "EOF while parsing an object, in column 11"),
        ("{}\n{\"translate\": [1e18, 0, 0], \"scale\": 1e17}", "places.jsonl:2: ", "object \"box[1]\" reaches out to"),
    ] {
        fs::write(folder.path().join("places.jsonl"), lines).unwrap();
        let error = load(folder.path(), &text).map(drop).unwrap_err();
        assert!(error.contains(place) && error.contains(expected), "{lines}: {error}");
    }
    fs::write(folder.path().join("places.jsonl"), b"{}\n\xff\n").unwrap();
    let error = load(folder.path(), &text).map(drop).unwrap_err();
    assert!(error.contains("places.jsonl:2: is not UTF-8 text"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Bytes changed, cut and put in at random: an error or a scene of no more objects than lines, never a panic.
    #[test]
    fn mutated_files_never_panic(changes in prop::collection::vec((0usize..3, any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let folder = tempfile::tempdir().unwrap();
        let lines: Vec<&str> = PLACES.iter().map(|place| place.json).collect();
        let mut bytes = lines.join("\n").into_bytes();
        for (kind, at, byte) in changes {
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = b"0123456789.-e[]{}\":,\n"[usize::from(byte) % 21],
                1 => { bytes.remove(at); }
                _ => bytes.insert(at, byte),
            }
        }
        fs::write(folder.path().join("places.jsonl"), &bytes).unwrap();
        let path = folder.path().join("scene.toml");
        fs::write(&path, "[[object]]\nmesh = \"box\"\ninstances = \"places.jsonl\"\n").unwrap();
        if let Ok(loaded) = glumbra::load(&path, &[]) {
            let lines = bytes.iter().filter(|byte| **byte == b'\n').count() + 1;
            assert!((1..=lines).contains(&loaded.scene.objects.len()));
        }
    }
}
