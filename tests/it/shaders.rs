//! Shaders as they are put together, printed, compiled and given their uniforms.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::ffi::{c_char, c_void};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use glumbra::context::{self, Context, ContextRequest};
use glumbra::device::{Device, Error, Measure};
use glumbra::pass::{Batch, DrawPass, PassList, Program, Stage, Uniform, Work};
use glumbra::plan::{self, Plan, Request, ViewRequest};
use glumbra::views::View;

use crate::support::replaced::Replaced;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn planned(scene: &str, changes: &[&str], views: &[View]) -> Plan {
    let changes: Vec<String> = changes.iter().map(|text| (*text).to_owned()).collect();
    let scene = glumbra::load(&root().join(scene), &changes).unwrap().scene;
    let views = views.iter().map(|view| ViewRequest { view: *view, light: 0 }).collect();
    plan::make(&scene, &Request { views, ..Request::default() }).unwrap()
}

fn draw_passes(list: &PassList) -> impl Iterator<Item = &DrawPass> {
    list.passes.iter().filter_map(|pass| match &pass.work {
        Work::Draw(draw) => Some(draw),
        Work::CopyDepth { .. } => None,
    })
}

fn programs(plan: &Plan) -> Vec<&Program> {
    draw_passes(&plan.list).flat_map(|draw| &draw.batches).map(|batch| &batch.program).collect()
}

const BOX: &str = "data/cases/scenes/box.toml";
const POINT: &str = "data/stress/scenes/point.toml";
const SUN: &str = "data/stress/scenes/sun.toml";

/// Scenes and settings that between them use every chunk.
fn plans() -> Vec<Plan> {
    let technique = |name: &str| format!("light.shadow.technique=\"{name}\"");
    let [volume, midpoint, map] = ["shadow-volume", "midpoint", "shadow-map"].map(technique);
    let mut plans = vec![
        planned(BOX, &[], &[View::Shade, View::LightDistance, View::ProjectedMap, View::TexelsPerPixel]),
        planned(BOX, &["light.shadow.kernel=\"3x3\"", "light.shadow.format=\"depth32f\""], &[]),
        planned(BOX, &["light.shadow.into=\"stencil\""], &[]),
        planned(BOX, &["light.shadow.guard=\"stencil\""], &[]),
        planned(BOX, &["light.shadow.addressing=\"direct3d\""], &[]),
        planned(BOX, &["light.frustum=\"shown\""], &[]),
        planned(BOX, &["shading.lighting=\"per-vertex\"", "light.shadow.dimming=0.3"], &[]),
        planned(BOX, &[&midpoint, "light.shadow.single=\"first\"", "light.shadow.peel=\"compare\""], &[]),
        planned(BOX, &[&midpoint, "light.shadow.average=\"eye-linear\"", "light.shadow.compare=\"gequal\""], &[]),
        planned(BOX, &[&volume], &[View::Volume, View::Shade]),
        planned("data/cases/scenes/room.toml", &[&volume], &[]),
        planned(POINT, &[&map, "light.shadow.kernel=\"3x3\""], &[]),
        planned(SUN, &[&map, "light.shadow.bias=\"normal-offset\""], &[]),
        planned("data/scenes/hw_shadowmaps_simple.toml", &[], &[]),
        planned("data/cases/shadow-map/alpha-test/scene.toml", &[], &[View::Shade]),
        planned("data/cases/shadow-map/wave/scene.toml", &[], &[]),
        planned("data/scenes/main.toml", &[], &[]),
    ];
    for bias in ["receiver-plane", "adaptive", "normal-offset"] {
        plans.push(planned(BOX, &[&format!("light.shadow.bias=\"{bias}\"")], &[View::Shade]));
    }
    plans.push(planned(BOX, &["light.shadow.bias=\"adaptive\"", "light.shadow.filter=\"nearest\""], &[]));
    for guard in ["none", "fragment", "texture-1d", "spot-cutoff", "clip-plane", "cull"] {
        plans.push(planned("data/cases/scenes/guards.toml", &[&format!("light.shadow.guard=\"{guard}\"")], &[]));
    }
    let views = [View::Normal, View::NormalMap, View::Decal, View::Gloss, View::TangentLight, View::Diffuse];
    for bump in ["reference", "one-pass", "three-pass"] {
        plans.push(planned("data/scenes/doughnut.toml", &[&format!("shading.bump={bump}")], &views));
    }
    plans
}

type ShaderSource = unsafe extern "system" fn(u32, i32, *const *const c_char, *const i32);

thread_local! {
    static COMPILED: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
    static DRIVERS: Cell<*const c_void> = const { Cell::new(std::ptr::null()) };
}

/// In the place of the driver's glShaderSource: keeps the text and passes it on.
unsafe extern "system" fn keep_source(shader: u32, count: i32, strings: *const *const c_char, lengths: *const i32) {
    let mut text = Vec::new();
    for index in 0..count as usize {
        // SAFETY: GL is given `count` strings and lengths.
        unsafe {
            let length = *lengths.add(index) as usize;
            text.extend_from_slice(std::slice::from_raw_parts((*strings.add(index)).cast::<u8>(), length));
        }
    }
    COMPILED.with_borrow_mut(|compiled| compiled.push(String::from_utf8(text).unwrap()));
    // SAFETY: the driver's function has this signature.
    unsafe { std::mem::transmute::<*const c_void, ShaderSource>(DRIVERS.get())(shader, count, strings, lengths) };
}

/// A context whose glShaderSource is [`keep_source`].
fn keeping(inner: Rc<dyn Context>) -> Rc<dyn Context> {
    Replaced::new(inner, |name, driver| {
        (name == c"glShaderSource").then(|| {
            DRIVERS.set(driver);
            keep_source as *const c_void
        })
    })
}

#[test]
fn the_device_compiles_what_is_printed() {
    let context = keeping(context::open(&ContextRequest::default()).unwrap());
    let mut device = Device::new(&context);
    let mut compiled = BTreeSet::new();
    for plan in plans() {
        device.run(&plan.list, Measure::No).unwrap();
        let new = COMPILED.with_borrow_mut(std::mem::take);
        let printed = plan.shaders("").unwrap();
        let sources: BTreeSet<String> =
            programs(&plan).iter().flat_map(|program| Stage::ALL.map(|stage| program.source(stage).text)).collect();
        assert!(new.iter().all(|text| sources.contains(text)), "compiled, and of no program of the plan");
        compiled.extend(new);
        for source in sources {
            assert!(printed.contains(&source), "not printed: {source}");
            assert!(compiled.contains(&source), "not compiled: {source}");
        }
    }
}

/// Text in the place of the first chunk of this name, in every program of the plan.
fn replace(plan: &mut Plan, name: &str, change: impl Fn(&str) -> String) {
    let mut changed = 0;
    for pass in &mut plan.list.passes {
        let Work::Draw(draw) = &mut pass.work else { continue };
        let chunks = draw.batches.iter_mut().flat_map(|batch| &mut batch.program.fragment);
        for chunk in chunks.filter(|chunk| chunk.name == name) {
            chunk.text = change(&chunk.text).into();
            changed += 1;
        }
    }
    assert!(changed > 0, "no chunk is called {name}");
}

#[test]
fn a_compile_error_shows_file_line_and_text() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut device = Device::new(&context);
    // The third of the four files of a shade, and the last of the whole program.
    for (name, line) in [("shadow_map/slope.glsl (light 0)", 9), ("surfaces/surface.frag", 53)] {
        let mut plan = planned(BOX, &["light.shadow.bias=\"receiver-plane\""], &[]);
        replace(&mut plan, name, |text| {
            let mut lines: Vec<&str> = text.lines().collect();
            lines.insert(line - 1, "    float wrong = missing_name;");
            lines.join("\n")
        });
        let error = device.run(&plan.list, Measure::No).unwrap_err().to_string();
        let expected = format!("\n{name}:{line}(");
        assert!(error.starts_with("the fragment shader of surface does not compile:\n"), "{error}");
        let (_, message) = error.split_once(&expected).unwrap_or_else(|| panic!("{error}\nlacks {expected}"));
        let lines: Vec<&str> = message.lines().take(2).collect();
        assert!(lines[0].ends_with("error: `missing_name' undeclared"), "{error}");
        assert_eq!(lines[1], "    float wrong = missing_name;", "{error}");
    }
}

/// Two boxes on a floor: the boxes differ in what `change` says of the second.
fn boxes(change: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let text = std::fs::read_to_string(root().join(BOX)).unwrap();
    let second = "[[object]]\nname = \"second\"\nmesh = \"box\"\ntranslate = [1.5, 0.5, 0.0]\nscale = 0.5\n";
    std::fs::write(&path, format!("{text}\n{second}material = {{ diffuse = {change} }}\n")).unwrap();
    (folder, path)
}

fn boxes_plan(diffuse: &str) -> Plan {
    let (_folder, path) = boxes(diffuse);
    plan::make(&glumbra::load(&path, &[]).unwrap().scene, &Request::default()).unwrap()
}

/// The batches of the lit pass that draw a box.
fn box_batches(plan: &mut Plan) -> Vec<&mut Batch> {
    let lit = plan.list.passes.iter_mut().find(|pass| pass.label == "lit").unwrap();
    let Work::Draw(draw) = &mut lit.work else { panic!("lit copies") };
    let has_box = |batch: &&mut Batch| batch.draws.iter().any(|draw| draw.mesh.name.contains("box"));
    draw.batches.iter_mut().filter(has_box).collect()
}

#[test]
fn a_uniform_that_a_second_batch_forgets_is_an_error() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut device = Device::new(&context);
    let mut plan = boxes_plan("[0.1, 0.2, 0.9]");
    device.run(&plan.list, Measure::No).unwrap();
    let batches = box_batches(&mut plan);
    assert!(batches.len() == 2 && batches[0].program == batches[1].program, "two batches of one variant");
    batches.into_iter().last().unwrap().uniforms.retain(|uniform| uniform.name != "material_diffuse");
    // The program is known by now, and a new device meets the right batch first.
    for device in [&mut device, &mut Device::new(&context)] {
        match device.run(&plan.list, Measure::No) {
            Err(Error::MissingUniform { name, draw, .. }) => {
                assert_eq!((name.as_str(), draw.as_str()), ("material_diffuse", "second"));
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn a_uniform_of_a_second_draw_is_checked() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut device = Device::new(&context);
    let plan = boxes_plan("[0.8, 0.5, 0.3]");
    let run = |device: &mut Device, change: &dyn Fn(&mut Batch)| {
        let mut plan = plan.clone();
        let mut batches = box_batches(&mut plan);
        assert!(batches.len() == 1 && batches[0].draws.len() == 2, "one batch of two draws");
        change(batches[0]);
        device.run(&plan.list, Measure::No)
    };
    run(&mut device, &|_| ()).unwrap();
    let missing = run(&mut device, &|batch| batch.draws[1].uniforms.retain(|uniform| uniform.name != "eye_from_model"));
    assert!(matches!(missing, Err(Error::MissingUniform { ref name, .. }) if name == "eye_from_model"), "{missing:?}");
    let unknown = run(&mut device, &|batch| batch.draws[1].uniforms.push(Uniform::new("mistyped", 1.0_f32)));
    assert!(matches!(unknown, Err(Error::UnknownUniform { ref name, .. }) if name == "mistyped"), "{unknown:?}");
    let twice = run(&mut device, &|batch| {
        let diffuse = batch.uniforms.iter().find(|uniform| uniform.name == "material_diffuse").unwrap().clone();
        batch.draws[0].uniforms.push(diffuse);
    });
    assert!(matches!(twice, Err(Error::UniformSetTwice { ref name, .. }) if name == "material_diffuse"), "{twice:?}");
}

/// The files below a folder, by their path from it, and their texts.
fn files(folder: &Path) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(below, text)| (format!("{name}/{below}"), text)));
        } else {
            found.push((name, std::fs::read_to_string(&path).unwrap()));
        }
    }
    found
}

/// The first cells of the rows of a table in `glsl/README.md`, without their backquotes.
fn readme_rows(heading: &str) -> BTreeSet<String> {
    let text = std::fs::read_to_string(root().join("glsl/README.md")).unwrap();
    let section = text.split("\n## ").find(|section| section.starts_with(heading)).unwrap();
    section.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next()).map(str::to_owned).collect()
}

#[test]
fn the_readme_has_every_chunk_and_every_define() {
    let glsl = root().join("glsl");
    let chunks: Vec<(String, String)> = files(&glsl).into_iter().filter(|(name, _)| name != "README.md").collect();
    let names: BTreeSet<String> = chunks.iter().map(|(name, _)| name.clone()).collect();
    let listed = readme_rows("Chunks");
    let differ: Vec<&String> = listed.symmetric_difference(&names).collect();
    assert!(differ.is_empty(), "in glsl/README.md or in glsl/, and not in both: {differ:?}");
    let words = |text: &str| -> Vec<String> {
        text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '@')).map(str::to_owned).collect()
    };
    // What chunks test, less what chunks define.
    let directives = chunks.iter().flat_map(|(_, text)| text.lines().filter(|line| line.starts_with('#')));
    let tested = directives.filter(|line| ["#if", "#elif"].iter().any(|start| line.starts_with(start)));
    let tested: BTreeSet<String> = tested.flat_map(|line| words(line).into_iter().skip(1)).collect();
    let tested: BTreeSet<String> =
        tested.into_iter().filter(|word| word.chars().any(|c| c.is_ascii_uppercase())).collect();
    let listed: BTreeSet<String> =
        readme_rows("Defines").iter().map(|row| row.split('(').next().unwrap_or_default().to_owned()).collect();
    assert_eq!(tested.difference(&listed).collect::<Vec<_>>(), Vec::<&String>::new(), "tested, and not listed");
    let read: BTreeSet<String> = chunks.iter().flat_map(|(_, text)| words(text)).collect();
    assert_eq!(listed.difference(&read).collect::<Vec<_>>(), Vec::<&String>::new(), "listed, and in no chunk");
    let set: BTreeSet<String> = plans()
        .iter()
        .flat_map(|plan| programs(plan).into_iter().flat_map(|program| &program.defines))
        .map(|define| format!("{}{}", define.name(), if define.full_name() == define.name() { "" } else { "_@" }))
        .collect();
    assert_eq!(set.difference(&listed).collect::<Vec<_>>(), Vec::<&String>::new(), "set, and not listed");
    println!("set by no plan of this test: {:?}", listed.difference(&set).collect::<Vec<_>>());
}

#[test]
fn the_percentage_closer_loop_stands_once() {
    let chunks = files(&root().join("glsl"));
    let loops = |text: &str| text.matches("y < KERNEL_@").count();
    let found: Vec<&String> = chunks.iter().filter(|(_, text)| loops(text) > 0).map(|(name, _)| name).collect();
    assert_eq!(found, ["shadow_map/percentage_closer.glsl"]);
}

/// Variables outside of functions have values from the start. Drivers warn of those without one that a function reads before the
/// text has set them, and a driver that keeps compiled shaders warns in the first run alone.
#[test]
fn global_variables_are_initialised() {
    const TYPES: [&str; 11] =
        ["float", "int", "uint", "bool", "vec2", "vec3", "vec4", "mat2", "mat3", "mat4", "Surface"];
    let mut plain = Vec::new();
    for folder in std::fs::read_dir(root().join("glsl")).unwrap().map(|entry| entry.unwrap().path()) {
        for file in std::fs::read_dir(&folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
            for line in std::fs::read_to_string(&file).unwrap().lines() {
                let code = line.split("//").next().unwrap_or_default().trim_end();
                // What is indented is in a function or a structure.
                let declared = code.split_once(' ').filter(|(kind, _)| TYPES.contains(kind)).map(|(_, rest)| rest);
                if declared.is_some_and(|rest| rest.ends_with(';') && !rest.contains(['=', '('])) {
                    plain.push(format!("{}: {code}", file.display()));
                }
            }
        }
    }
    assert!(plain.is_empty(), "{plain:#?}");
}

/// Derivatives, implicit ones of look-ups too, are undefined where a neighbour was discarded before [GLSL 4.60, 6.4]: no main
/// function has any behind a discard. Maps without mipmaps need none.
#[test]
fn no_derivative_is_taken_behind_a_discard() {
    const DERIVED: [&str; 8] =
        ["dFdx", "dFdy", "fwidth", "derive_shade", "ILLUMINATE", "PHOTOGRAPH(", "main_before_far", "texture(decal_map"];
    let mut wrong = Vec::new();
    for folder in std::fs::read_dir(root().join("glsl")).unwrap().map(|entry| entry.unwrap().path()) {
        for file in std::fs::read_dir(&folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
            let text = std::fs::read_to_string(&file).unwrap();
            let Some((_, body)) = text.split_once("void main()") else { continue };
            let Some(first) = ["discard;", "alpha_test();"].iter().filter_map(|jump| body.find(jump)).min() else {
                continue;
            };
            let behind = DERIVED.iter().filter(|name| body[first..].contains(**name));
            wrong.extend(behind.map(|name| format!("{}: {name}", file.display())));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
