//! Work grows with a scene no faster than the scene: counts of what planning, uploads and drawing do, over a ladder of sizes,
//! and the exponent of each curve. Counts are the same on every machine, so that a step that visits all objects for each
//! object cannot come back unseen.

use std::cell::Cell;
use std::fmt::Write as _;
use std::rc::Rc;

use glumbra::conformance::layer::{self, functions};
use glumbra::context::{self, Context, ContextRequest};
use glumbra::frame::Renderer;
use glumbra::plan::{self, Plan, Request};
use glumbra::process::work;
use glumbra::scene::Scene;
use glumbra::techniques;

#[path = "../bench/ball.rs"]
mod ball;

use ball::ball;
use serde_json::json;

use crate::gltf::glb::{Glb, wedge};

/// Greatest exponent of a curve: linear, and a tenth for what a fit over a few points of a curve with a constant part, a sort or
/// a grid's rounded sides may add. Four times the size with an exponent of 2 is sixteen times the work: no noise hides it.
const MOST: f64 = 1.1;

/// Calls of GL on their way to the driver.
#[derive(Default)]
struct Calls {
    all: Cell<u64>,
    draws: Cell<u64>,
    /// Bytes of buffers.
    bytes: Cell<u64>,
}

/// A context whose calls are counted.
fn counting(inner: Rc<dyn Context>) -> (Rc<dyn Context>, Rc<Calls>) {
    let calls = Rc::new(Calls::default());
    let counts = calls.clone();
    let add = |cell: &Cell<u64>, number: u64| cell.set(cell.get() + number);
    let context = layer::over(inner, |layer| {
        layer.hook(functions::NAMES, move |call| {
            add(&counts.all, 1);
            match call.name {
                "glDrawElements" => add(&counts.draws, 1),
                "glBufferData" => add(&counts.bytes, call.f(1) as u64),
                _ => {}
            }
        });
    });
    (context, calls)
}

/// Counts of one scene, each with its name.
type Counts = Vec<(&'static str, u64)>;

/// Something of a scene that grows.
struct Ladder {
    name: &'static str,
    sizes: &'static [usize],
    /// The scene's text at a size, lit by a technique.
    text: fn(usize, &str) -> String,
    /// True if frames are drawn, too.
    drawn: bool,
}

/// Steps that come once are below or above a ladder: from 256 volumes on planning looks for counts that eight bits cannot hold.
const LADDERS: &[Ladder] = &[
    Ladder { name: "objects", sizes: &[512, 1024, 2048], text: objects, drawn: false },
    Ladder { name: "objects drawn", sizes: &[16, 64, 240], text: objects, drawn: true },
    Ladder { name: "objects of a file's nodes", sizes: &[512, 1024, 2048], text: nodes, drawn: false },
    Ladder { name: "objects of a file's nodes drawn", sizes: &[16, 64, 240], text: nodes, drawn: true },
    Ladder { name: "materials", sizes: &[16, 64, 240], text: materials, drawn: true },
    Ladder { name: "textures", sizes: &[16, 64, 240], text: textures, drawn: true },
    Ladder { name: "objects hidden beyond far", sizes: &[512, 1024, 2048], text: hidden, drawn: false },
    Ladder { name: "triangles", sizes: &[1 << 8, 1 << 10, 1 << 12, 1 << 14], text: triangles, drawn: true },
    Ladder { name: "lights", sizes: &[1, 4, 16, 64], text: lights, drawn: false },
    Ladder { name: "lights drawn", sizes: &[1, 2, 4, 8], text: lights, drawn: true },
    Ladder { name: "nested casters", sizes: &[512, 1024, 2048], text: nested, drawn: false },
    Ladder { name: "nested casters drawn", sizes: &[8, 32, 128], text: nested, drawn: true },
    Ladder { name: "picture", sizes: &[32, 64, 128, 256], text: picture, drawn: true },
    Ladder { name: "map", sizes: &[32, 128, 512, 2048], text: map, drawn: true },
];

/// A scene of `size` pixels a side, with `lights` above a floor.
fn start(size: usize, lights: usize, technique: &str, keys: &str) -> String {
    let mut text = format!(
        "[image]\nsize = [{size}, {size}]\n[camera]\neye = [6, 9, 14]\ntarget = [0, 0, 0]\nnear = 1.0\nfar = 60.0\n\
         [[object]]\nmesh = \"quad\"\nscale = 8.0\n"
    );
    for light in 0..lights {
        let angle = light as f64;
        let place = [5.0 * angle.cos(), 14.0, 5.0 * angle.sin()];
        let _ = writeln!(
            text,
            "[[light]]\nposition = {place:?}\ntarget = [0, 0, 0]\ncone = 60\nnear = 1.0\nfar = 40.0\n\
             shadow = {{ technique = \"{technique}\"{keys} }}"
        );
    }
    text
}

/// Keys of a light for techniques that have a map of so many texels a side.
fn map_keys(technique: &str, size: usize) -> String {
    match technique {
        "none" | "shadow-volume" => String::new(),
        _ => format!(", size = {size}"),
    }
}

/// Places on a grid in the light, the boxes the smaller the more they are.
fn places(count: usize) -> impl Iterator<Item = (f64, f64, f64)> {
    let side = (count as f64).sqrt().ceil();
    let step = 10.0 / side;
    (0..count).map(move |k| {
        let [x, z] = [k as f64 % side, (k as f64 / side).floor()].map(|at| step * (at + 0.5) - 5.0);
        (x, z, 0.3 * step)
    })
}

fn objects(count: usize, technique: &str) -> String {
    let mut text = start(48, 1, technique, &map_keys(technique, 64)) + "[[object]]\nmesh = \"box\"\ninstances = [\n";
    for (x, z, scale) in places(count) {
        let _ = writeln!(text, "{{ translate = [{x:?}, 2, {z:?}], scale = {scale:?} }},");
    }
    text + "]\n"
}

/// Wedges that the nodes of a glTF file place, each below another node; the file is in the scene's folder: see [`load`].
fn nodes(_: usize, technique: &str) -> String {
    start(48, 1, technique, &map_keys(technique, 64)) + "[[object]]\nmesh = \"nodes.glb\"\n"
}

/// The file of [`nodes`]: a wedge of one mesh at each place.
fn nodes_file(count: usize) -> Vec<u8> {
    let mut glb = Glb::new();
    let mesh = wedge(&mut glb, None);
    for (x, z, scale) in places(count) {
        let child = glb.push("nodes", json!({ "mesh": mesh, "scale": [scale, scale, scale] }));
        glb.root(json!({ "children": [child], "translation": [x, 2.0, z] }));
    }
    glb.bytes()
}

fn materials(count: usize, technique: &str) -> String {
    let mut text = start(48, 1, technique, &map_keys(technique, 64));
    for (k, (x, z, scale)) in places(count).enumerate() {
        let color = k as f64 / count as f64;
        let _ = writeln!(
            text,
            "[[object]]\nmesh = \"box\"\ntranslate = [{x:?}, 2, {z:?}]\nscale = {scale:?}\n\
             material = {{ diffuse = [{color:?}, 0.5, 0.5] }}"
        );
    }
    text
}

/// Objects with a picture each, whose files are in the scene's folder: see [`load`].
fn textures(count: usize, technique: &str) -> String {
    let mut text = start(48, 1, technique, &map_keys(technique, 64));
    for (k, (x, z, scale)) in places(count).enumerate() {
        let _ = writeln!(
            text,
            "[[object]]\nmesh = \"box\"\ntranslate = [{x:?}, 2, {z:?}]\nscale = {scale:?}\n\
             material = {{ decal = \"{k}.png\" }}"
        );
    }
    text
}

/// Boxes beyond the far plane, all behind the floor as the camera sees it.
fn hidden(count: usize, technique: &str) -> String {
    let text = start(256, 1, technique, &map_keys(technique, 64));
    let mut text = text.replace("eye = [6, 9, 14]", "eye = [0, 9, 0.1]").replace("far = 60.0", "far = 12.0");
    text = text.replace("scale = 8.0", "scale = 8.0\ncasts_shadow = false");
    text += "[[object]]\nmesh = \"box\"\ninstances = [\n";
    for (x, z, scale) in places(count) {
        let _ = writeln!(text, "{{ translate = [{x:?}, -6, {z:?}], scale = {scale:?} }},");
    }
    text + "]\n"
}

/// A closed ball of so many triangles, which volumes count by its outline; its file is in the scene's folder: see [`load`].
fn triangles(_: usize, technique: &str) -> String {
    start(48, 1, technique, &map_keys(technique, 64)) + "[[object]]\nmesh = \"ball.obj\"\ntranslate = [0, 1, 0]\n"
}

fn lights(count: usize, technique: &str) -> String {
    start(48, count, technique, &map_keys(technique, 16)) + "[[object]]\nmesh = \"box\"\ntranslate = [0, 1, 0]\n"
}

/// Boxes within boxes: each pixel lies in the shadow of all.
fn nested(count: usize, technique: &str) -> String {
    let mut text = start(48, 1, technique, &map_keys(technique, 64)) + "[[object]]\nmesh = \"box\"\ninstances = [\n";
    for depth in 0..count {
        let scale = 2.0 * (depth + 1) as f64 / count as f64;
        let _ = writeln!(text, "{{ translate = [0, 3, 0], scale = {scale:?} }},");
    }
    text + "]\n"
}

fn picture(side: usize, technique: &str) -> String {
    start(side, 1, technique, &map_keys(technique, 64)) + "[[object]]\nmesh = \"box\"\ntranslate = [0, 1, 0]\n"
}

fn map(side: usize, technique: &str) -> String {
    start(48, 1, technique, &map_keys(technique, side)) + "[[object]]\nmesh = \"box\"\ntranslate = [0, 1, 0]\n"
}

fn load(text: &str, size: usize) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    if text.contains("ball.obj") {
        std::fs::write(folder.path().join("ball.obj"), ball(size, 1.0)).unwrap();
    }
    if text.contains(".png") {
        (0..size).for_each(|k| image::RgbImage::new(1, 1).save(folder.path().join(format!("{k}.png"))).unwrap());
    }
    if text.contains("nodes.glb") {
        std::fs::write(folder.path().join("nodes.glb"), nodes_file(size)).unwrap();
    }
    glumbra::load(&path, &[]).unwrap().scene
}

fn draws(plan: &Plan) -> u64 {
    plan.summary().passes.iter().map(|pass| pass.draw_calls as u64).sum()
}

fn measure(ladder: &Ladder, size: usize, technique: &str, gl: &(Rc<dyn Context>, Rc<Calls>)) -> Counts {
    let text = (ladder.text)(size, technique);
    let mut counts = Counts::new();
    let mut worked = |what: [&'static str; 3], before: work::WorkDone| {
        let done = work::done();
        counts.push((what[0], done.boxes - before.boxes));
        counts.push((what[1], done.triangles - before.triangles));
        counts.push((what[2], done.comparisons - before.comparisons));
    };
    let before = work::done();
    let scene = load(&text, size);
    worked(["boxes at loading", "triangles at loading", "comparisons at loading"], before);
    let request = Request { frames: 2, ..Request::default() };
    let before = work::done();
    if !ladder.drawn {
        let plan = plan::make(&scene, &request).unwrap();
        worked(["boxes in planning", "triangles in planning", "comparisons in planning"], before);
        counts.push(("passes", plan.list.passes.len() as u64));
        counts.push(("draws planned", draws(&plan)));
        return counts;
    }
    let (context, calls) = gl;
    let mut renderer = Renderer::new(context);
    let plan = renderer.plan(&scene, &request).unwrap();
    worked(["boxes in planning", "triangles in planning", "comparisons in planning"], before);
    for names in [
        ["GL calls", "draws", "bytes uploaded", "comparisons in drawing"],
        ["GL calls again", "draws again", "bytes uploaded again", "comparisons in drawing again"],
    ] {
        let at = |calls: &Calls| [calls.all.get(), calls.draws.get(), calls.bytes.get()];
        let (before, worked) = (at(calls), work::done());
        renderer.draw(&plan).unwrap();
        let after = at(calls);
        counts.extend((0..3).map(|k| (names[k], after[k] - before[k])));
        counts.push((names[3], work::done().comparisons - worked.comparisons));
    }
    counts
}

/// Exponent of `count ∝ size^k` by least squares on logarithms, over the upper points of the ladder: three, or all if they are
/// fewer. A count of none has an exponent of 0.
fn exponent(sizes: &[usize], counts: &[u64]) -> f64 {
    let from = sizes.len().saturating_sub(3);
    let points: Vec<[f64; 2]> = sizes[from..]
        .iter()
        .zip(&counts[from..])
        .map(|(size, count)| [(*size as f64).ln(), (*count as f64).max(1.0).ln()])
        .collect();
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let products = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum::<f64>();
    products / points.iter().map(|point| (point[0] - x).powi(2)).sum::<f64>()
}

#[test]
fn exponents_are_those_of_powers() {
    let sizes = [10, 100, 1000, 10_000];
    for (power, constant) in [(0.0, 0), (1.0, 0), (2.0, 0), (1.0, 7)] {
        let counts = sizes.map(|size| constant + (size as f64).powf(power) as u64);
        let found = exponent(&sizes, &counts);
        assert!((found - power).abs() < 0.02, "{power} with {constant}: {found}");
    }
    assert_eq!(exponent(&sizes, &[0; 4]), 0.0);
}

/// Holds the exponents of the ladders whose names `is_wanted` takes, under each technique.
fn hold(is_wanted: impl Fn(&str) -> bool) {
    // Counts are of one thread: what is done on all cores is done on this one.
    let _pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build().unwrap();
    let gl = counting(context::open(&ContextRequest::default()).unwrap());
    let mut wrong = Vec::new();
    for ladder in LADDERS.iter().filter(|ladder| is_wanted(ladder.name)) {
        for technique in techniques::TABLE.iter().map(|technique| technique.name()) {
            let rows: Vec<Counts> = ladder.sizes.iter().map(|size| measure(ladder, *size, technique, &gl)).collect();
            for (index, (name, _)) in rows[0].iter().enumerate() {
                let counts: Vec<u64> = rows.iter().map(|row| row[index].1).collect();
                let found = exponent(ladder.sizes, &counts);
                let line = format!("{}, {technique}, {name}: {counts:?}, exponent {found:.2}", ladder.name);
                println!("{line}");
                if found > MOST {
                    wrong.push(line);
                }
            }
        }
    }
    assert!(wrong.is_empty(), "more than {MOST}:\n{}", wrong.join("\n"));
}

#[test]
fn work_grows_with_objects_as_they_do() {
    hold(|name| name.starts_with("objects") || name == "materials" || name == "textures");
}

#[test]
fn work_grows_with_triangles_as_they_do() {
    hold(|name| name == "triangles");
}

#[test]
fn work_grows_with_lights_as_they_do() {
    hold(|name| name.starts_with("lights"));
}

#[test]
fn work_grows_with_nested_casters_as_they_do() {
    hold(|name| name.starts_with("nested casters"));
}

#[test]
fn work_does_not_grow_with_pixels_and_texels() {
    hold(|name| name == "picture" || name == "map");
}
