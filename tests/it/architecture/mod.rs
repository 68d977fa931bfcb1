//! The library's order: which module may use which, that no files use each other in a circle, where `unsafe` and raw GL
//! may stand, that neighbours have no two types of one name, and that every row of a table has its folders.

mod code;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use code::{Arrow, Code, File, Module};

/// Each module, and those that it may use directly; it may use what these may use, too.
const ARROWS: &[(&str, &[&str])] = &[
    ("cli", &["viewer", "keys", "gallery", "figures", "stress", "report", "cases", "fixed_function", "conformance"]),
    // Names of other modules.
    ("prelude", &["frame", "truth", "output"]),
    ("viewer", &["frame", "output", "judge"]),
    // Shadow techniques read a part of the keys.
    ("keys", &["techniques"]),
    // Its scenes are embedded as those of figures are, with the same pictures and models.
    ("gallery", &["figures"]),
    // The measures and the plots of both are a report's.
    ("figures", &["report"]),
    ("stress", &["report"]),
    ("cases", &["judge", "output"]),
    ("report", &["judge", "output"]),
    // What a device reads back is a picture, too.
    ("pictures", &["output"]),
    // The bound between right and wrong is that of a technique's map.
    ("judge", &["frame", "truth", "pictures"]),
    // A view decides the channels of its file.
    ("output", &["device", "views", "png_file"]),
    // A renderer warns of depth formats that are not what they are called: it has them measured.
    ("frame", &["plan", "device", "conformance"]),
    ("plan", &["techniques", "surfaces", "compositions", "views"]),
    ("techniques", &["lights"]),
    ("surfaces", &["lights"]),
    // A counted light has views of its own: its volumes, its silhouettes, the count.
    ("compositions", &["lights", "views"]),
    ("views", &["lights"]),
    // Programs as data, run on the CPU or made GLSL: text in, text out.
    ("combiners", &[]),
    ("lights", &["pass", "scene"]),
    // The images and the raster state of its passes are the device's.
    ("fixed_function", &["device", "c_text"]),
    ("c_text", &[]),
    ("device", &["pass", "context"]),
    // Frames of the renderer, planned and drawn on the driver at hand, beside a model of GL.
    ("conformance", &["plan", "device", "c_text"]),
    ("context", &["process"]),
    ("pass", &["geometry"]),
    ("truth", &["scene"]),
    // A scene names programs of register combiners.
    ("scene", &["geometry", "combiners"]),
    // A skin that was packed again is written as it was read.
    ("geometry", &["math", "png_file"]),
    ("png_file", &[]),
    ("math", &[]),
    // What the process is doing when it crashes; locks and signals.
    ("process", &[]),
];

/// Modules that any module may use.
const EVERYWHERE: &[&str] = &["process"];

/// Modules that talk to GL, in which `unsafe` may stand.
const GL: &[&str] = &["context", "device", "fixed_function", "conformance"];

/// Modules in which `unsafe` may stand besides: signal handlers, and locks on files, are calls to the C library.
const UNSAFE: &[&str] = &["process"];

/// Type names that neighbours may share, each with the reason.
const SHARED_NAMES: &[(&str, &str)] = &[
    ("Error", "each module has its own, and names it with the module: `scene::Error`"),
    ("Settings", "each technique has its own, as each has its own `Technique`"),
];

/// Folders of `glsl/` that belong to no row: what rows share, what surfaces and views are made of, and dust, which lies over
/// the picture of any composition.
const SHARED_SHADERS: &[&str] = &["common", "surfaces", "views", "dust"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The library's code, read once for all tests.
fn library() -> &'static Code {
    static CODE: LazyLock<Code> = LazyLock::new(|| Code::read(&root().join("src")));
    &CODE
}

/// Tests whether `from` may use `to`, directly or through others.
fn may_use(from: &str, to: &str) -> bool {
    let direct = ARROWS.iter().find(|(name, _)| *name == from).map_or(&[][..], |(_, direct)| direct);
    from == to || EVERYWHERE.contains(&to) || direct.iter().any(|next| may_use(next, to))
}

fn wrong_arrows(code: &Code) -> Vec<String> {
    let is_wrong = |arrow: &Arrow| {
        let (from, to) = (&arrow.from[0], &arrow.to[0]);
        // Ray casting shares no formula with the renderer.
        let shares = from == "truth" && arrow.to.starts_with(&["math".into(), "texgen".into()]);
        !may_use(from, to) || shares
    };
    let arrows = code.arrows();
    let wrong = arrows.iter().filter(|arrow| !arrow.from.is_empty()).filter(|arrow| is_wrong(arrow));
    wrong.map(|arrow| in_words(code, arrow)).collect()
}

fn in_words(code: &Code, arrow: &Arrow) -> String {
    format!("src/{} uses {} (src/{})", code.files[&arrow.from].path, arrow.path, code.files[&arrow.to].path)
}

fn circles(code: &Code) -> Vec<String> {
    let lines = |circle: &Vec<Arrow>| {
        // One path for each two files.
        let mut arrows = circle.clone();
        arrows.dedup_by(|a, b| (&a.from, &a.to) == (&b.from, &b.to));
        arrows.iter().map(|arrow| in_words(code, arrow)).collect::<Vec<_>>().join("\n  ")
    };
    code.circles().iter().map(lines).collect()
}

#[test]
fn no_module_uses_one_above_it() {
    let code = library();
    let wrong = wrong_arrows(code);
    assert!(wrong.is_empty(), "arrows that `ARROWS` does not have:\n{}", wrong.join("\n"));
}

#[test]
fn every_module_has_its_arrows() {
    let code = library();
    let there: BTreeSet<&str> = code.files.keys().filter(|path| path.len() == 1).map(|path| path[0].as_str()).collect();
    let listed: BTreeSet<&str> = ARROWS.iter().map(|(name, _)| *name).collect();
    assert_eq!(there, listed, "modules of src/lib.rs, and rows of `ARROWS`");
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let code = library();
    let circles = circles(code);
    assert!(circles.is_empty(), "{} circles:\n{}", circles.len(), circles.join("\n\n"));
}

#[test]
fn unsafe_code_and_gl_stand_where_they_may() {
    let code = library();
    for (module, file) in code.files.iter().filter(|(module, _)| !module.is_empty()) {
        let top = module[0].as_str();
        assert!(!file.names_gl || GL.contains(&top), "src/{} names glow: only {GL:?} may", file.path);
        let may = GL.contains(&top) || UNSAFE.contains(&top);
        assert!(!file.is_unsafe || may, "src/{} is unsafe: only {GL:?} and {UNSAFE:?} may be", file.path);
    }
}

/// Types of one name in one folder, in a folder and its parent, or in two folders of one parent.
fn doubled_names(code: &Code) -> Vec<String> {
    let mut places: BTreeMap<&str, Vec<&File>> = BTreeMap::new();
    for file in code.files.values() {
        for name in &file.types {
            places.entry(name).or_default().push(file);
        }
    }
    let are_neighbours = |a: &File, b: &File| {
        let (a, b) = (a.folder(), b.folder());
        a == b || a.parent() == b.parent() || a.parent() == Some(&b) || b.parent() == Some(&a)
    };
    let mut found = Vec::new();
    for (name, files) in places {
        for (index, a) in files.iter().enumerate() {
            for b in files[index + 1..].iter().filter(|b| are_neighbours(a, b)) {
                found.push(format!("{name}: src/{} and src/{}", a.path, b.path));
            }
        }
    }
    found
}

#[test]
fn no_two_types_of_neighbours_have_one_name() {
    let is_shared = |line: &String| SHARED_NAMES.iter().any(|(name, _)| line.starts_with(&format!("{name}:")));
    let found: Vec<String> = doubled_names(library()).into_iter().filter(|line| !is_shared(line)).collect();
    assert!(found.is_empty(), "types of one name in neighbouring folders:\n{}", found.join("\n"));
}

#[test]
fn a_doubled_name_that_is_planted_is_found() {
    let lib = ("lib.rs", "mod pass; mod frame; mod truth;");
    let found = |image: &str, frame: &str, beam: &str| {
        let pass = ("pass/mod.rs", "mod image; pub struct Pass;");
        let truth = [("truth/mod.rs", "mod rays;"), ("truth/rays/mod.rs", "mod beam;"), ("truth/rays/beam.rs", beam)];
        let files = [lib, pass, ("pass/image.rs", image), ("frame.rs", frame)];
        doubled_names(&planted(&[&files[..], &truth].concat()))
    };
    assert_eq!(found("pub(super) struct Pass;", "", ""), ["Pass: src/pass/mod.rs and src/pass/image.rs"]);
    assert_eq!(found("pub trait T {}", "pub type T = u8;", ""), ["T: src/frame.rs and src/pass/image.rs"]);
    assert_eq!(found("struct Pass;", "struct Pass;", ""), Vec::<String>::new(), "private types are their file's");
    assert_eq!(found("pub enum Side {}", "", "pub enum Side {}"), Vec::<String>::new(), "far apart");
}

/// Types that a static changes in: what is kept from frame to frame belongs to a renderer.
const CHANGING: &[&str] = &["Mutex<", "RwLock<", "RefCell<", "Cell<"];

#[test]
fn nothing_is_kept_in_globals() {
    let mut files = vec![root().join("src")];
    while let Some(path) = files.pop() {
        if path.is_dir() {
            files.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
            continue;
        }
        // Signals and crash messages are the process's own; a window system's events are the thread's.
        let inside = path.strip_prefix(root().join("src")).unwrap().to_owned();
        // A GL function's arguments do not name the layer that it goes through.
        let is_excused =
            ["context/window.rs", "conformance/layer/call.rs"].iter().any(|path| inside == Path::new(path));
        if inside.starts_with("process") || is_excused {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]\nmod ").next().unwrap();
        for line in code.lines().filter(|line| line.trim_start().trim_start_matches("pub ").starts_with("static ")) {
            assert!(!CHANGING.iter().any(|kind| line.contains(kind)), "src/{}: {line}", inside.display());
        }
    }
}

/// Reads a library of a few files.
fn planted(files: &[(&str, &str)]) -> Code {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    Code::read(folder.path())
}

#[test]
fn an_arrow_that_is_planted_is_found() {
    let lib = ("lib.rs", "pub mod math; pub mod lights; pub mod truth;");
    let math = ("math/mod.rs", "pub mod texgen;");
    let texgen = ("math/texgen.rs", "pub struct Texgen;");
    let lights = ("lights/mod.rs", "mod light; pub use light::LightTerm;");
    let light = ("lights/light.rs", "pub struct LightTerm;");
    let wrong = |truth: &str| wrong_arrows(&planted(&[lib, math, texgen, lights, light, ("truth.rs", truth)]));
    assert_eq!(wrong("pub struct Ray;"), Vec::<String>::new());
    let expected = ["src/truth.rs uses lights::LightTerm (src/lights/light.rs)"];
    for text in [
        "use crate::lights::LightTerm;",
        "use crate::lights::{self, LightTerm as Term};",
        "fn f(_: super::lights::LightTerm) {}",
        "fn f() { println!(\"{}\", crate::lights::LightTerm); }",
        "use crate::lights; fn f() { let _ = lights::LightTerm; }",
    ] {
        let found = wrong(text);
        assert!(found.iter().any(|line| expected.contains(&line.as_str())), "{text}: {found:?}");
    }
    assert_eq!(wrong("#[cfg(test)] mod tests { use crate::lights::LightTerm; }"), Vec::<String>::new());
    assert_eq!(
        wrong("use crate::math::texgen::Texgen;"),
        ["src/truth.rs uses math::texgen::Texgen (src/math/texgen.rs)"]
    );
}

#[test]
fn a_circle_that_is_planted_is_found() {
    let lib = ("lib.rs", "mod pass;");
    let head = ("pass/mod.rs", "mod image; mod state; pub use image::Image; pub struct PassList;");
    let circles = |state: &str| {
        let image = ("pass/image.rs", "use super::PassList; use super::state::State; pub struct Image;");
        circles(&planted(&[lib, head, image, ("pass/state.rs", state)])).len()
    };
    assert_eq!(circles("use super::PassList; pub struct State;"), 0, "what the head has is no circle");
    assert_eq!(circles("use super::image::Image; pub struct State;"), 1);
    assert_eq!(circles("use super::Image; pub struct State;"), 1, "a name that the head re-exports is its file's");
}

#[test]
fn every_folder_of_a_table_has_a_row_and_every_row_a_folder() {
    let techniques: Module = glumbra::techniques::TABLE.iter().map(|row| row.name().replace('-', "_")).collect();
    let compositions: Module = glumbra::compositions::TABLE.iter().map(|row| row.name().replace('-', "_")).collect();
    for (table, rows) in [("techniques", &techniques), ("compositions", &compositions)] {
        let rows: BTreeSet<String> = rows.iter().cloned().collect();
        assert_eq!(folders(&root().join("src").join(table)), rows, "folders of src/{table}, and rows of its TABLE");
    }
    for folder in folders(&root().join("glsl")) {
        let known = techniques.contains(&folder) || compositions.contains(&folder);
        assert!(known || SHARED_SHADERS.contains(&folder.as_str()), "glsl/{folder} is the folder of no row");
    }
}

fn folders(path: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(path).unwrap().map(Result::unwrap).filter(|entry| entry.path().is_dir());
    entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
}
