//! The command `glumbra` as a person meets it: pictures in the files that were asked for, and for bad input one clear
//! error, exit code 1, and no file.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use assert_cmd::cargo::CommandCargoExt;

/// Runs `glumbra` with `arguments` in `folder`.
fn glumbra(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("glumbra").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn data(path: &str) -> String {
    root().join(path).to_str().unwrap().to_owned()
}

fn boxes() -> String {
    data("data/cases/scenes/box.toml")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The names in a folder, hidden ones too, sorted.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Checks a refusal: `expected` in one error on standard error, nothing on standard output. An error says what is wrong.
fn refusal(output: &Output, code: i32, expected: &str) -> Result<(), String> {
    let error = text(&output.stderr);
    let errors = error.lines().filter(|line| line.starts_with("error: ")).count();
    let wrong = [
        (output.status.code() != Some(code), format!("exit {:?}, not {code}", output.status.code())),
        (error.contains("panicked"), String::from("panics")),
        (errors != 1, format!("{errors} errors")),
        (!error.contains(expected), format!("does not say \"{expected}\"")),
        (!output.stdout.is_empty(), String::from("writes to standard output")),
    ];
    match wrong.into_iter().find(|(wrong, _)| *wrong) {
        Some((_, how)) => Err(format!("{how}: {error}")),
        None => Ok(()),
    }
}

const LIGHT: &str = "[[light]]\nposition = [2, 4, 3]\ntarget = [0, 0, 0]\ncone = 60\nnear = 0.5\nfar = 20\n";
const QUAD: &str = "[[object]]\nmesh = \"quad\"\n";
const SMALL_SCENE: &str = "image = { size = [32, 24] }\n{LIGHT}{QUAD}";

/// Name, scene (`{LIGHT}` and `{QUAD}` stand for the above), what the error must say.
const SCENES: &[(&str, &str, &str)] = &[
    ("empty", "", "scene.toml:1: `object` is missing: a scene needs at least one [[object]]"),
    ("no objects", "{LIGHT}", "`object` is missing"),
    ("syntax", "[camera]\neye = [1, 2\n[image]\n", "scene.toml:3: "),
    ("unknown table", "{QUAD}[kamera]\n", "scene.toml:3: unknown key `kamera` in the scene: did you mean `camera`?"),
    ("unknown key", "[camera]\nfov = 40\n{QUAD}", "scene.toml:2: unknown key `fov` in [camera]: did you mean `fov_y`?"),
    ("nan", "[camera]\neye = [0, nan, 0]\n{QUAD}", "scene.toml:2: `camera.eye` must be finite, not NaN"),
    ("infinite", "{QUAD}translate = [inf, 0, 0]\n", "scene.toml:3: `object.translate` must be finite, not inf"),
    ("beyond f32", "[camera]\neye = [0, 1e39, 0]\n{QUAD}", "must be in [-1e18, 1e18], not 1e39"),
    ("0x0", "[image]\nsize = [0, 0]\n{QUAD}", "two whole numbers in 1..=16384, not [0, 0]"),
    ("huge", "[image]\nsize = [100000, 100000]\n{QUAD}", "two whole numbers in 1..=16384, not [100000, 100000]"),
    ("flat", "{QUAD}scale = [1, 0, 1]\n", "`object.scale` must not be zero"),
    ("no mesh", "[[object]]\nmesh = \"tepot\"\n", "did you mean `teapot`?"),
    ("no file", "[[object]]\nmesh = \"no.obj\"\n", "scene.toml:2: "),
    ("no decal", "{QUAD}material = { decal = \"no.png\" }\n", "no.png"),
    (
        "light kind",
        "{LIGHT}kind = \"spott\"\n{QUAD}",
        "scene.toml:7: `light.kind` cannot be \"spott\": did you mean `spot`?",
    ),
    ("no cone", "[[light]]\nposition = [0, 1, 0]\ntarget = [0, 0, 0]\n{QUAD}", "scene.toml:1: `light.cone` is missing"),
    (
        "technique",
        "{LIGHT}[light.shadow]\ntechnique = \"shadow-mapp\"\n{QUAD}",
        "scene.toml:8: `light.shadow.technique` cannot be \"shadow-mapp\": did you mean `shadow-map`?",
    ),
    (
        "shadow key",
        "{LIGHT}[light.shadow]\ntechnique = \"shadow-map\"\nfilterr = \"linear\"\n{QUAD}",
        "scene.toml:9: unknown key `filterr` in [light.shadow]: did you mean `filter`?",
    ),
    (
        "offset key",
        "{LIGHT}[light.shadow]\ntechnique = \"shadow-map\"\noffset = { factr = 1 }\n{QUAD}",
        "scene.toml:9: unknown key `factr` in [light.shadow.offset]: did you mean `factor`?",
    ),
    (
        "format",
        "{LIGHT}[light.shadow]\ntechnique = \"shadow-map\"\nformat = \"depth48\"\n{QUAD}",
        "scene.toml:9: `light.shadow.format` cannot be \"depth48\"",
    ),
    (
        "map of no size",
        "{LIGHT}[light.shadow]\ntechnique = \"shadow-map\"\nsize = 0\n{QUAD}",
        "scene.toml:9: `light.shadow.size` must be in",
    ),
    (
        "map size in words",
        "{LIGHT}[light.shadow]\ntechnique = \"shadow-map\"\nsize = \"big\"\n{QUAD}",
        "scene.toml:9: `light.shadow.size` must be",
    ),
    (
        "dimming",
        "{LIGHT}[light.shadow]\ntechnique = \"shadow-map\"\ndimming = 1.5\n{QUAD}",
        "`light.shadow.dimming` must be in [0, 1], not 1.5",
    ),
];

#[test]
fn malformed_scenes_are_refused() {
    let (input, output) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let mut wrong = Vec::new();
    for (name, scene, expected) in SCENES {
        let scene = scene.replace("{LIGHT}", LIGHT).replace("{QUAD}", QUAD);
        fs::write(input.path().join("scene.toml"), scene).unwrap();
        let file = output.path().join("x.png");
        let done = glumbra(input.path(), &["render", "scene.toml", "-o", file.to_str().unwrap(), "--aov", "shade"]);
        wrong.extend(refusal(&done, 1, expected).err().map(|how| format!("{name}: {how}")));
        if names(output.path()) != [""; 0] || names(input.path()) != ["scene.toml"] {
            wrong.push(format!("{name}: leaves {:?} {:?}", names(output.path()), names(input.path())));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every malformed OBJ, MTL and PNG of `tests/bad`, both rendered by itself and named by a scene.
#[test]
fn malformed_models_are_refused() {
    let table: toml::Table = fs::read_to_string(root().join("tests/bad/geometry.toml")).unwrap().parse().unwrap();
    assert!(table.len() >= 30, "{}", table.len());
    let output = tempfile::tempdir().unwrap();
    let mut wrong = Vec::new();
    for (name, expected) in table.iter().filter(|(name, _)| name.ends_with(".obj")) {
        let model = data(&format!("tests/bad/{name}"));
        let done = glumbra(output.path(), &["render", &model, "-o", "x.png"]);
        wrong.extend(refusal(&done, 1, expected.as_str().unwrap()).err().map(|how| format!("{name}: {how}")));
        if names(output.path()) != [""; 0] {
            wrong.push(format!("{name}: leaves {:?}", names(output.path())));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let scene = format!("{QUAD}[[object]]\nmesh = {:?}\n", data("tests/bad/nan-coordinate.obj"));
    fs::write(output.path().join("scene.toml"), scene).unwrap();
    let done = glumbra(output.path(), &["render", "scene.toml"]);
    refusal(&done, 1, "scene.toml:4: ").unwrap();
    assert_eq!(names(output.path()), ["scene.toml"]);
}

/// Arguments after the scene, exit code, what the error must say.
const ARGUMENTS: &[(&[&str], i32, &str)] = &[
    (
        &["--set", "light.shadow.siez=64"],
        1,
        "--set light.shadow.siez=64: unknown key `siez` in [light.shadow]: did you mean `size`?",
    ),
    (&["--set", "light.7.cone=40"], 1, "`light` has 1 entry, numbered from 0"),
    (&["--set", "light.cone"], 1, "must be written key=value"),
    (&["--set", "light.cone=wide"], 1, "`light.cone` must be a number"),
    (&["--set", "image.size=[0, 4]"], 1, "two whole numbers in 1..=16384"),
    (&["--size", "0x0"], 1, "two whole numbers in 1..=16384, not [0, 0]"),
    (&["--size", "100000x100000"], 1, "two whole numbers in 1..=16384, not [100000, 100000]"),
    (&["--size", "12"], 2, "write it as 640x480"),
    (&["--size", "axb"], 2, "'a' is no number of pixels"),
    (&["--aov", "shad"], 2, "did you mean `shade`?"),
    (&["--aov", "shade@x"], 2, "'x' is no number of a light"),
    (&["--aov", "shade@3"], 1, "--aov shade@3: the scene has 1 light"),
    (&["--aov", "light-depth", "--set", "light.shadow={}"], 1, "light 0 has no shadow map"),
    (&["--frames", "0"], 2, "0 is not in 1..=1000000"),
    (&["--frames", "many"], 2, "invalid digit"),
    (&["--context", "vulkan"], 2, "possible values: auto, egl, osmesa, window"),
    (&["--device", "999"], 1, "999"),
    (&["--nonsense"], 2, "unexpected argument '--nonsense'"),
    (&["-o", "absent/x.png"], 1, "absent/x.png: the folder absent does not exist"),
    (&["-o", "x.jpeg"], 1, "x.jpeg: cannot tell the format: end it in .png, .exr or .npy"),
    (&["-o", "x"], 1, "cannot tell the format"),
    (&["-o", ""], 2, "a value is required"),
];

#[test]
fn bad_arguments_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut wrong = Vec::new();
    for (arguments, code, expected) in ARGUMENTS {
        let done = glumbra(folder.path(), &[&["render", &boxes()], *arguments].concat());
        wrong.extend(refusal(&done, *code, expected).err().map(|how| format!("{arguments:?}: {how}")));
        if names(folder.path()) != [""; 0] {
            wrong.push(format!("{arguments:?}: leaves {:?}", names(folder.path())));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_that_are_no_scenes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("latin.toml"), b"# caf\xe9\n").unwrap();
    fs::write(folder.path().join("scene.json"), "{}").unwrap();
    let before = names(folder.path());
    for (scene, expected) in [
        ("absent.toml", "absent.toml: cannot be read: No such file"),
        ("absent.obj", "absent.obj: cannot be read: No such file"),
        (".", ".: is a folder"),
        ("latin.toml", "latin.toml:1: is not UTF-8 text"),
        ("scene.json", "a scene ends in .toml, a model in .obj"),
    ] {
        refusal(&glumbra(folder.path(), &["render", scene, "-o", "x.png"]), 1, expected).unwrap();
        assert_eq!(names(folder.path()), before, "{scene}");
    }
    refusal(&glumbra(folder.path(), &["render"]), 2, "<SCENE>").unwrap();
    refusal(&glumbra(folder.path(), &["draw"]), 2, "unrecognized subcommand 'draw'").unwrap();
}

/// A map or a picture within our own limit and beyond the driver's: by the command where the driver's is the lesser, and
/// by the plan everywhere.
#[test]
fn what_the_driver_cannot_hold_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let info = glumbra(folder.path(), &["info", "--json", "-"]);
    let info: serde_json::Value = serde_json::from_slice(&info.stdout).unwrap();
    let limits = &info["context"]["limits"];
    let sides = [&limits["texture_size"], &limits["renderbuffer_size"], &limits["viewport"][0], &limits["viewport"][1]];
    let limit = sides.iter().map(|side| side.as_u64().unwrap_or_else(|| panic!("{info}"))).min().unwrap();
    if limit < 16384 {
        let size = format!("light.shadow.size={}", limit + 1);
        let done = glumbra(folder.path(), &["render", &boxes(), "-o", "x.png", "--set", &size]);
        refusal(&done, 1, &format!("more than the driver's limit of {limit}")).unwrap();
        assert_eq!(names(folder.path()), [""; 0]);
    }
    let scene = glumbra::load(Path::new(&boxes()), &[]).unwrap().scene;
    let limits = glumbra::plan::Limits { max_image_size: 255, ..Default::default() };
    let error = glumbra::plan::make(&scene, &glumbra::plan::Request { limits, ..Default::default() }).unwrap_err();
    assert_eq!(error.to_string(), "light 0 map is 256x256, more than the driver's limit of 255: choose a smaller one");
}

/// A limit on file sizes stands in for a full disk where nothing can be mounted.
#[cfg(unix)]
#[test]
fn a_file_that_may_not_grow_is_an_error_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let binary = assert_cmd::cargo::cargo_bin("glumbra");
    let script = "trap '' XFSZ; ulimit -f 8; exec \"$0\" render \"$1\" -o x.npy --aov shade";
    let done = Command::new("bash")
        .args(["-c", script])
        .arg(binary)
        .arg(boxes())
        .current_dir(folder.path())
        // The driver's own cache must not meet the limit.
        .env("MESA_SHADER_CACHE_DISABLE", "true")
        .output()
        .unwrap();
    refusal(&done, 1, "x.npy: cannot be written: File too large").unwrap();
    assert_eq!(names(folder.path()), [""; 0]);
}

/// The shape and the floats of an NPY file of version 1.0.
fn read_npy(path: &Path) -> (Vec<usize>, Vec<f32>) {
    let bytes = fs::read(path).unwrap();
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = text(&bytes[10..10 + length]);
    assert!(header.contains("'<f4'") && header.contains("'fortran_order': False"), "{header}");
    let shape = header.split_once("'shape': (").unwrap().1.split_once(')').unwrap().0;
    let shape = shape.split(',').filter_map(|side| side.trim().parse().ok()).collect();
    let values = bytes[10 + length..].chunks_exact(4).map(|four| f32::from_le_bytes(four.try_into().unwrap()));
    (shape, values.collect())
}

/// The channels of an EXR file by name, in the file's order.
fn read_exr(path: &Path) -> Vec<(String, Vec<f32>)> {
    let image = exr::prelude::read_all_flat_layers_from_file(path).unwrap();
    let channels = &image.layer_data[0].channel_data.list;
    channels.iter().map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect())).collect()
}

fn render(folder: &Path, arguments: &[&str]) -> Output {
    let done = glumbra(folder, &[&["render", &boxes(), "--size", "64x48"], arguments].concat());
    assert!(done.status.success(), "{}", text(&done.stderr));
    done
}

const ALL_VIEWS: [&str; 6] = ["shade", "depth", "light-depth", "light-view", "light-distance", "projected-map"];

#[test]
fn pictures_and_views_get_the_stated_names() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("a")).unwrap();
    let views: Vec<&str> = ALL_VIEWS.iter().flat_map(|view| ["--aov", view]).collect();
    let done = render(folder.path(), &[&["-o", "a/x.png"], &views[..]].concat());
    assert!(done.stdout.is_empty());
    let mut expected: Vec<String> = ALL_VIEWS.iter().map(|view| format!("x.{view}.png")).collect();
    expected.push(String::from("x.png"));
    expected.sort();
    assert_eq!(names(&folder.path().join("a")), expected);
    let sizes = |name: &str| image::image_dimensions(folder.path().join("a").join(name)).unwrap();
    assert_eq!(sizes("x.png"), (64, 48));
    assert_eq!(sizes("x.shade.png"), (64, 48));
    assert_eq!(sizes("x.light-depth.png"), (256, 256));
    let kind = image::open(folder.path().join("a/x.shade.png")).unwrap().color();
    assert_eq!(kind, image::ColorType::La8);
}

#[test]
fn the_second_lights_views_have_its_number() {
    let folder = tempfile::tempdir().unwrap();
    let scene = data("data/cases/scenes/two_lights.toml");
    let arguments = ["render", &scene, "--size", "32x32", "-o", "x.png", "--aov", "shade@1", "--aov", "shade"];
    assert!(glumbra(folder.path(), &arguments).status.success());
    assert_eq!(names(folder.path()), ["x.png", "x.shade.1.png", "x.shade.png"]);
}

/// The ray tracer's picture, and differences from it: as lit and shadowed, or in colours where the light is projected.
#[test]
fn truth_and_difference_stand_beside_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let views = ["--aov", "difference", "--aov", "shade", "--aov", "truth"];
    render(folder.path(), &[&["-o", "x.png"], &views[..]].concat());
    assert_eq!(names(folder.path()), ["x.difference.png", "x.png", "x.shade.png", "x.truth.png"]);
    let open = |name: &str| image::open(folder.path().join(name)).unwrap().to_rgb8();
    let blue = |name: &str| open(name).pixels().filter(|pixel| pixel.0 == [0x00, 0x72, 0xb2]).count();
    let gray = |name: &str| open(name).pixels().filter(|pixel| pixel.0 == [0xf2; 3]).count();
    assert!(gray("x.truth.png") > 500 && blue("x.difference.png") < 10);
    let acne = ["-o", "x.png", "--aov", "difference", "--set", "light.shadow.offset={ factor = 0.0, units = 0.0 }"];
    render(folder.path(), &acne);
    assert!(blue("x.difference.png") > 200, "{}", blue("x.difference.png"));
    // A slide: colours.
    let slide = data("data/figures/slide.toml");
    let draw = |more: &[&str]| {
        let arguments = ["render", &slide, "--size", "96x64", "-o", "y.png", "--aov", "difference", "--aov", "truth"];
        let done = glumbra(folder.path(), &[&arguments, more].concat());
        assert!(done.status.success(), "{}", text(&done.stderr));
    };
    draw(&[]);
    let [picture, truth, difference] = ["y.png", "y.truth.png", "y.difference.png"].map(open);
    let apart = |a: u8, b: u8| i32::from(a).abs_diff(i32::from(b));
    let ambiguous = |pixel: &image::Rgb<u8>| pixel.0 == [0xa6; 3];
    let mut known = 0;
    for ((is, due), difference) in picture.pixels().zip(truth.pixels()).zip(difference.pixels()) {
        if ambiguous(due) {
            continue;
        }
        known += 1;
        for k in 0..3 {
            // Sixteen times as far apart as they are, or less where a colour has bounds; both are rounded.
            let (found, stated) = (apart(is.0[k], due.0[k]), u32::from(difference.0[k]));
            assert!(stated <= 16 * found + 16 + 1, "{is:?} {due:?} {difference:?}");
        }
    }
    let bright = |picture: &image::RgbImage| {
        picture.pixels().filter(|pixel| !ambiguous(pixel) && pixel.0.iter().any(|code| *code > 100)).count()
    };
    assert!(known > 4500 && bright(&difference) < 200, "{known} known, {} differ", bright(&difference));
    for view in ["truth@7", "difference@7"] {
        let done = glumbra(folder.path(), &["render", &slide, "--size", "96x64", "-o", "z.png", "--aov", view]);
        let error = text(&done.stderr);
        assert!(!done.status.success() && error.contains("there is no light 7"), "{view}: {error}");
        assert!(names(folder.path()).iter().all(|name| !name.starts_with('z')));
    }
    draw(&["--set", "light.0.interpolate=affine"]);
    assert!(bright(&open("y.difference.png")) > 300, "{}", bright(&open("y.difference.png")));
    // What cannot be known is said.
    let arguments = ["render", &slide, "--set", "light.0.frustum=shown", "-o", "z.png", "--aov", "truth"];
    let done = glumbra(folder.path(), &arguments);
    assert!(!done.status.success() && text(&done.stderr).contains("lines of its frustum"), "{}", text(&done.stderr));
    assert!(!folder.path().join("z.png").exists());
}

#[test]
fn the_picture_is_named_after_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    render(folder.path(), &[]);
    assert_eq!(names(folder.path()), ["box.png"]);
}

#[test]
fn an_old_picture_is_replaced_and_kept_when_the_new_one_fails() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.png");
    fs::write(&path, "old").unwrap();
    let done = glumbra(folder.path(), &["render", &boxes(), "-o", "x.png", "--set", "light.cone=0"]);
    assert_eq!(done.status.code(), Some(1));
    assert_eq!(fs::read(&path).unwrap(), b"old");
    render(folder.path(), &["-o", "x.png"]);
    assert_eq!(image::image_dimensions(&path).unwrap(), (64, 48));
}

/// EXR and NPY hold the same bits, and the PNG what they round to.
#[test]
fn exact_files_agree_with_the_png() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for extension in ["png", "exr", "npy"] {
        let output = format!("x.{extension}");
        render(folder.path(), &["-o", &output, "--aov", "shade", "--aov", "depth"]);
    }
    let png = image::open(at("x.png")).unwrap().to_rgb8().into_raw();
    let (shape, picture) = read_npy(&at("x.npy"));
    assert_eq!(shape, [48, 64, 3]);
    let worst = png.iter().zip(&picture).map(|(a, b)| (f32::from(*a) - 255.0 * b).abs()).fold(0.0, f32::max);
    assert!(worst <= 0.5 + 1e-3, "{worst}");
    assert_same_channels(&read_exr(&at("x.exr")), &["B", "G", "R"], &[2, 1, 0], &picture, 3);

    let png = image::open(at("x.shade.png")).unwrap().to_luma_alpha8().into_raw();
    let (shape, shade) = read_npy(&at("x.shade.npy"));
    assert_eq!(shape, [48, 64, 2]);
    assert!(png.iter().zip(&shade).all(|(a, b)| (f32::from(*a) - 255.0 * b).abs() <= 0.5 + 1e-3));
    assert!(shade.chunks_exact(2).any(|p| p == [0.0, 1.0]) && shade.chunks_exact(2).any(|p| p == [1.0, 1.0]));
    assert_same_channels(&read_exr(&at("x.shade.exr")), &["A", "Y"], &[1, 0], &shade, 2);

    let (shape, depth) = read_npy(&at("x.depth.npy"));
    assert_eq!(shape, [48, 64]);
    assert_same_channels(&read_exr(&at("x.depth.exr")), &["Z"], &[0], &depth, 1);
}

fn assert_same_channels(exr: &[(String, Vec<f32>)], names: &[&str], places: &[usize], npy: &[f32], stride: usize) {
    assert_eq!(exr.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), names);
    for ((name, values), place) in exr.iter().zip(places) {
        let expected = npy[*place..].iter().step_by(stride);
        assert!(values.iter().map(|v| v.to_bits()).eq(expected.map(|v| v.to_bits())), "{name}");
    }
}

/// Depth and distance at the picture's middle, where the camera's target lies in it, by their formulas.
#[test]
fn exact_values_are_right() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["-o", "x.npy", "--aov", "depth", "--aov", "light-distance", "--aov", "light-depth"];
    // The middle of an odd picture is a pixel's centre: the target, on the floor.
    let sizes = ["--set", "image.size=[65, 49]", "--set", "camera.target=[-0.6, 0, 1.2]"];
    let done = glumbra(folder.path(), &[&["render", &boxes()][..], &arguments, &sizes].concat());
    assert!(done.status.success(), "{}", text(&done.stderr));
    let middle = 24 * 65 + 32;
    let window = |z: f64, near: f64, far: f64| far / (far - near) * (1.0 - near / z);

    let (_, depth) = read_npy(&folder.path().join("x.depth.npy"));
    let z = (glam::DVec3::new(2.5, 4.5, 5.0) - glam::DVec3::new(-0.6, 0.0, 1.2)).length();
    assert!((f64::from(depth[middle]) - window(z, 0.5, 30.0)).abs() < 3e-7, "{} {z}", depth[middle]);

    let (shape, distance) = read_npy(&folder.path().join("x.light-distance.npy"));
    assert_eq!(shape, [49, 65, 2]);
    let axis = glam::DVec3::new(2.0, -5.0, -1.5).normalize();
    let z = glam::DVec3::new(1.4, -5.0, -0.3).dot(axis);
    let found = &distance[2 * middle..][..2];
    assert!((f64::from(found[0]) - window(z, 1.0, 12.0)).abs() < 1e-6 && found[1] == 1.0, "{found:?} {z}");

    let (shape, map) = read_npy(&folder.path().join("x.light-depth.npy"));
    assert_eq!(shape, [256, 256]);
    assert!(map.iter().all(|depth| (0.0..=1.0).contains(depth)));
}

/// A map of n bits holds multiples of 1 / (2^n - 1), and not of a coarser format's.
#[test]
fn maps_hold_the_codes_of_their_format() {
    let folder = tempfile::tempdir().unwrap();
    let off_grid = |values: &[f32], bits: i32| {
        let most = 2.0_f64.powi(bits) - 1.0;
        // An f32 near 1 is 2^-25 off at most.
        let off = |v: &&f32| (f64::from(**v) * most - (f64::from(**v) * most).round()).abs() > 2.0_f64.powi(bits - 24);
        values.iter().filter(off).count()
    };
    let map = |format: &str| {
        let set = format!("light.shadow.format={format}");
        // The default offset of a float map is that of 24 bits in other units, to the bit at depths above one half.
        let offset = "light.shadow.offset={ factor = 1.1, units = 4.0 }";
        render(folder.path(), &["-o", "x.npy", "--aov", "light-depth", "--set", &set, "--set", offset]);
        read_npy(&folder.path().join("x.light-depth.npy")).1
    };
    let (map16, map24, map32f) = (map("depth16"), map("depth24"), map("depth32f"));
    assert_eq!(off_grid(&map16, 16), 0);
    assert!(off_grid(&map24, 16) > map24.len() / 2);
    for (a, b) in map32f.iter().zip(&map16) {
        assert!((a - b).abs() < 2e-4, "{a} {b}"); // the offset is eight codes of 16 bits
    }
    assert!(map32f.iter().zip(&map24).any(|(a, b)| a != b));
}

#[test]
fn json_has_passes_times_bytes_and_what_was_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let done = render(folder.path(), &["-o", "x.png", "--aov", "shade", "--json", "-", "--frames", "3"]);
    let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!((&json["schema"], &json["schema_version"]), (&"glumbra-render".into(), &1.into()));
    let json = &json["scenes"][0];
    assert_eq!(json["files"], serde_json::json!(["x.png", "x.shade.png"]));
    assert_eq!(json["times"]["frames_ms"].as_array().unwrap().len(), 3);
    let labels = |list: &serde_json::Value| -> Vec<String> {
        list.as_array().unwrap().iter().map(|pass| pass["label"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(labels(&json["passes"]), labels(&json["times"]["passes"]));
    assert!(labels(&json["passes"]).contains(&String::from("light 0: depth")), "{json}");
    assert!(json["image_bytes"].as_u64().unwrap() >= 256 * 256 * 4 + 64 * 48 * 8);
    let left_out = json["left_out"].as_array().unwrap();
    assert!(left_out.iter().any(|left| left["what"].as_str().unwrap().starts_with("colour attachment")), "{json}");
    assert_eq!(names(folder.path()), ["x.png", "x.shade.png"]);
}

#[test]
fn several_scenes_are_drawn_into_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let (boxes, plane) = (boxes(), boxes().replace("box.toml", "plane.toml"));
    let arguments = ["render", &boxes, &plane, "-o", "out", "--size", "64x48", "--aov", "shade", "--json", "all.json"];
    let done = glumbra(folder.path(), &arguments);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let said = text(&done.stderr);
    for file in ["box.png", "box.shade.png", "plane.png", "plane.shade.png"] {
        assert!(said.contains(&format!("wrote out/{file}: ")), "{said}");
    }
    assert_eq!(names(&folder.path().join("out")), ["box.png", "box.shade.png", "plane.png", "plane.shade.png"]);
    let json: serde_json::Value = serde_json::from_slice(&fs::read(folder.path().join("all.json")).unwrap()).unwrap();
    assert_eq!(json["scenes"].as_array().unwrap().len(), 2);
    glumbra(folder.path(), &["render", &plane, "-o", "alone.png", "--size", "64x48"]);
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("alone.png") == read("out/plane.png"), "a picture depends on what was drawn before");

    let twice = glumbra(folder.path(), &["render", &boxes, &boxes, "-o", "twice"]);
    refusal(&twice, 1, "would both be written there").unwrap();
    let bad = glumbra(folder.path(), &["render", &boxes, "none.toml", "-o", "late"]);
    refusal(&bad, 1, "none.toml").unwrap();
    assert!(!folder.path().join("late").exists(), "a picture beside a scene that cannot be read");
}

#[test]
fn a_dash_is_standard_input_and_output() {
    let folder = tempfile::tempdir().unwrap();
    let scene = SMALL_SCENE.replace("{LIGHT}", LIGHT).replace("{QUAD}", QUAD);
    fs::write(folder.path().join("scene.toml"), &scene).unwrap();
    let piped = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("glumbra").unwrap();
        command.current_dir(folder.path()).args(arguments).write_stdin(scene.clone()).output().unwrap()
    };
    let pixels = |png: &[u8]| image::load_from_memory(png).unwrap().into_rgb8();
    let file = glumbra(folder.path(), &["render", "scene.toml", "-o", "x.png"]);
    assert!(file.status.success(), "{}", text(&file.stderr));
    let through = piped(&["render", "-", "-o", "-", "--quiet"]);
    assert_eq!((through.status.code(), text(&through.stderr)), (Some(0), String::new()));
    assert!(pixels(&through.stdout) == pixels(&fs::read(folder.path().join("x.png")).unwrap()));
    assert!(piped(&["render", "-"]).status.success());
    assert_eq!(names(folder.path()), ["scene.png", "scene.toml", "x.png"]);
    assert!(text(&piped(&["plan", "-"]).stdout).contains("lit"));
    for (arguments, expected) in [
        (&["render", "-", "-o", "-", "--aov", "shade"][..], "leave out --aov"),
        (&["render", "-", "-o", "-", "--json", "-"], "leave out --json -"),
        (&["render", "-", "scene.toml", "-o", "-"], "leave out the other scenes"),
        (&["plan", "-", "--print-scene"], "save it first"),
        (&["render", "-", "--set", "light.cone=none"], "`light.cone` must be a number"),
    ] {
        refusal(&piped(arguments), 1, expected).unwrap();
    }
}

#[test]
fn quiet_and_verbose_say_less_and_more() {
    let folder = tempfile::tempdir().unwrap();
    let said = |option: &str| text(&render(folder.path(), &["-o", "x.png", option]).stderr);
    assert_eq!(said("--quiet"), "");
    assert_eq!(said("--color=never").lines().count(), 1);
    let more = said("--verbose");
    for part in ["driver: ", "left out: colour attachment", "wrote x.png: picture, 64 x 48", "pass lit: "] {
        assert!(more.contains(part), "{part}: {more}");
    }
}

#[test]
fn completions_and_manual_pages_know_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let help = text(&glumbra(folder.path(), &["--help"]).stdout);
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let commands: Vec<String> = listed
        .filter(|line| !line.starts_with("   "))
        .filter_map(|line| Some(line.split_whitespace().next()?.to_owned()))
        .filter(|name| name != "help")
        .collect();
    assert!(commands.len() >= 9 && !commands.contains(&"generate".to_owned()), "{commands:?}");
    let script = text(&glumbra(folder.path(), &["generate", "completions", "bash"]).stdout);
    assert!(glumbra(folder.path(), &["generate", "man", "pages", "--quiet"]).status.success());
    for command in &commands {
        assert!(script.contains(&format!("glumbra__subcmd__{command}")), "{command} has no completions");
        let page = fs::read_to_string(folder.path().join(format!("pages/glumbra-{command}.1"))).unwrap();
        assert!(page.contains(".SH OPTIONS"), "{command}: {page}");
    }
    assert!(!folder.path().join("pages/glumbra-generate.1").exists());
}

#[test]
fn frames_draw_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    render(folder.path(), &["-o", "one.npy"]);
    render(folder.path(), &["-o", "three.npy", "--frames", "3"]);
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("one.npy") == read("three.npy"));
}

/// Runs without any way to a GL context: no display, and libraries that no loader finds.
fn without_gl(arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    for name in ["libEGL.so.1", "libEGL.so", "libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"] {
        fs::write(folder.path().join(name), "no library").unwrap();
    }
    let mut command = Command::cargo_bin("glumbra").unwrap();
    command.env("LD_LIBRARY_PATH", folder.path()).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    command.current_dir(folder.path()).args(arguments).output().unwrap()
}

#[test]
fn a_plan_needs_no_gl() {
    assert!(!without_gl(&["info"]).status.success(), "the test does not take GL away");
    let done = without_gl(&["plan", &boxes(), "--aov", "shade"]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let plan = text(&done.stdout);
    for expected in ["light 0: depth", "lit", "shade", "DEPTH_COMPONENT24", "colour attachment"] {
        assert!(plan.contains(expected), "{expected}: {plan}");
    }
    let done = without_gl(&["plan", &boxes(), "--json", "-"]);
    let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert!(!json["passes"].as_array().unwrap().is_empty());
}

#[test]
fn without_gl_a_picture_is_refused_and_not_written() {
    let done = without_gl(&["render", &boxes(), "-o", "x.png"]);
    refusal(&done, 1, "EGL").unwrap();
}

#[test]
fn a_printed_scene_is_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let print = |scene: &str| {
        let done = glumbra(folder.path(), &["plan", scene, "--print-scene", "--set", "light.cone=40"]);
        assert!(done.status.success(), "{}", text(&done.stderr));
        text(&done.stdout)
    };
    let first = print(&boxes());
    fs::write(folder.path().join("again.toml"), &first).unwrap();
    assert_eq!(print("again.toml"), first);
    render(folder.path(), &["-o", "a.npy", "--set", "light.cone=40"]);
    assert!(glumbra(folder.path(), &["render", "again.toml", "--size", "64x48", "-o", "b.npy"]).status.success());
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("a.npy") == read("b.npy"));
}

/// Scenes and models that name files, printed into another folder than their own.
#[test]
fn a_printed_scene_is_the_same_from_any_folder() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::copy(root().join("data/meshes/concave.obj"), folder.path().join("model.obj")).unwrap();
    fs::copy(root().join("data/textures/floor.png"), folder.path().join("floor.png")).unwrap();
    let scene = format!("{QUAD}material = {{ decal = \"floor.png\" }}\n[[object]]\nmesh = \"model.obj\"\n{LIGHT}");
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    for from in ["model.obj", "scene.toml"] {
        let printed = glumbra(folder.path(), &["plan", from, "--print-scene", "--size", "64x48"]);
        assert!(printed.status.success(), "{}", text(&printed.stderr));
        fs::write(folder.path().join("sub/printed.toml"), printed.stdout).unwrap();
        for (scene, output) in [(from, "a.npy"), ("sub/printed.toml", "b.npy")] {
            let done = glumbra(folder.path(), &["render", scene, "--size", "64x48", "-o", output]);
            assert!(done.status.success(), "{}", text(&done.stderr));
        }
        let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
        assert!(read("a.npy") == read("b.npy"), "{from}");
    }
}

#[test]
fn a_scene_that_cannot_be_drawn_is_not_printed() {
    let folder = tempfile::tempdir().unwrap();
    let model = data("data/meshes/concave.obj");
    let print = |set: &str| glumbra(folder.path(), &["plan", &model, "--print-scene", "--set", set]);
    refusal(&print("light.0.kind=directional"), 1, "`light.cone` is no key of a directional light").unwrap();
    refusal(&print("light.0={position=[0, 9, 0], target=[0, 0, 0]}"), 1, "`light.cone` is missing").unwrap();
    refusal(&print("light.shadow.siez=64"), 1, "did you mean `size`?").unwrap();
}

#[test]
fn a_floor_is_supplied_unless_it_is_not_wanted() {
    let folder = tempfile::tempdir().unwrap();
    let model = data("data/meshes/courtyard.obj");
    let with = glumbra(folder.path(), &["plan", &model]);
    assert!(text(&with.stderr).contains("has a floor of its own") && text(&with.stdout).contains("of quad"));
    let without = glumbra(folder.path(), &["plan", &model, "--no-floor"]);
    assert!(without.stderr.is_empty() && !text(&without.stdout).contains("of quad"), "{}", text(&without.stderr));
    let scene = glumbra(folder.path(), &["plan", &boxes(), "--no-floor"]);
    refusal(&scene, 1, "only a model is supplied with a floor").unwrap();
}

#[test]
fn a_model_alone_becomes_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let model = data("data/meshes/courtyard.obj");
    let done = glumbra(folder.path(), &["render", &model, "--size", "64x64", "--aov", "shade"]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert_eq!(names(folder.path()), ["courtyard.png", "courtyard.shade.png"]);
    let shade: PathBuf = folder.path().join("courtyard.shade.png");
    let pixels = image::open(shade).unwrap().to_luma_alpha8();
    assert!(pixels.pixels().any(|p| p.0 == [0, 255]) && pixels.pixels().any(|p| p.0 == [255, 255]));
}

#[test]
fn help_has_examples() {
    let done = glumbra(root(), &["render", "--help"]);
    assert!(done.status.success());
    for expected in ["Examples:", "glumbra render data/scenes/main.toml", "--aov", "light-depth"] {
        assert!(text(&done.stdout).contains(expected), "{expected}");
    }
}
