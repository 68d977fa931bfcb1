//! Judges of a broken driver: the rules of `glumbra check`, and pictures of small scenes.

#![allow(dead_code, reason = "the test and the program use parts of it")]

use std::path::Path;
use std::rc::Rc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use glumbra::conformance::faults::{self, Fault};
use glumbra::conformance::{self, DriverUnderTest, Rule, RuleVerdict, waivers};
use glumbra::context::{self, Context, ContextRequest, Profile};
use glumbra::device::Pixels;
use glumbra::fixed_function::FixedFunction;
use glumbra::frame::Renderer;
use glumbra::plan::{Plan, Request, View, ViewRequest};

/// A compatibility context, with the fault or sound.
pub fn context(fault: Option<&Fault>) -> Rc<dyn Context> {
    let request = ContextRequest { profile: Profile::Compatibility, ..ContextRequest::default() };
    let sound = context::open(&request).expect("a compatibility context");
    fault.map_or(sound.clone(), |fault| faults::broken(sound, fault))
}

/// Ids of the rules that fail, of `rules` in their order; with `first` no more than the first that does.
pub fn red(fault: Option<&Fault>, rules: &[&'static Rule], first: bool) -> Vec<&'static str> {
    let context = context(fault);
    let Ok(subject) = DriverUnderTest::new(&context, None) else { return vec!["no bench"] };
    let known = waivers::load(None).expect("the waivers");
    let fails = |rule: &&'static Rule| {
        let mut outcomes = conformance::run(&subject, &[rule], |_| {});
        waivers::apply(&known, &subject.info, &mut outcomes);
        outcomes.iter().any(|outcome| outcome.verdict == RuleVerdict::Fail)
    };
    let red = rules.iter().copied().filter(fails).map(|rule| rule.id);
    if first { red.take(1).collect() } else { red.collect() }
}

/// The rules, those that took the least time on a sound driver first.
pub fn quickest() -> Vec<&'static Rule> {
    let context = context(None);
    let subject = DriverUnderTest::new(&context, None).expect("a bench");
    let rules: Vec<_> = conformance::TABLE.iter().collect();
    let outcomes = conformance::run(&subject, &rules, |_| {});
    let mut timed: Vec<_> = outcomes.iter().map(|outcome| outcome.seconds).zip(rules).collect();
    timed.sort_by(|a, b| a.0.total_cmp(&b.0));
    timed.into_iter().map(|(_, rule)| rule).collect()
}

/// A scene: a name, a file below data/ and what is set over it.
pub type SceneRow = (&'static str, &'static str, &'static [&'static str]);

/// Scenes that together use the whole product.
#[rustfmt::skip]
pub const SCENES: &[SceneRow] = &[
    ("map", "cases/scenes/box", &[]),
    ("map with a filter", "cases/scenes/box", &["light.shadow.filter=linear", "light.shadow.format=depth24"]),
    ("map of 16 bits, copied", "cases/scenes/box", &["light.shadow.format=depth16", "light.shadow.transfer=copy"]),
    ("map of floats, reversed", "cases/scenes/box", &["light.shadow.compare=gequal", "light.shadow.format=depth32f", "light.shadow.filter=linear"]),
    ("map of 32 bits", "cases/scenes/box", &["light.shadow.format=depth32", "light.shadow.dimming=0.3"]),
    ("unsized map, copied", "cases/scenes/box", &["light.shadow.format=depth", "light.shadow.transfer=copy"]),
    ("Direct3D's addressing", "cases/scenes/box", &["light.shadow.addressing=direct3d-viewport", "light.shadow.filter=linear"]),
    ("cube map", "cases/scenes/box", &["light.0={ kind = \"point\", position = [-2.0, 3.0, 1.5], near = 0.5, far = 14.0, shadow = { technique = \"shadow-map\", size = 128, filter = \"linear\" } }"]),
    ("cube map, copied", "cases/scenes/box", &["light.0={ kind = \"point\", position = [0.3, 0.4, 2.0], near = 0.5, far = 14.0, shadow = { technique = \"shadow-map\", size = 64, transfer = \"copy\" } }"]),
    ("midpoint", "cases/scenes/box", &["light.shadow.technique=midpoint"]),
    ("midpoint compared", "cases/scenes/box", &["light.shadow.technique=midpoint", "light.shadow.peel=compare", "light.shadow.average=eye-linear", "light.shadow.compare=gequal"]),
    ("second depth", "cases/scenes/box", &["light.shadow.technique=second-depth"]),
    ("volumes, z-pass", "cases/scenes/box", &["light.shadow.technique=shadow-volume", "light.shadow.method=z-pass"]),
    ("volumes, z-fail", "cases/scenes/box", &["light.shadow.technique=shadow-volume", "light.shadow.method=z-fail", "camera.eye=[0.9, 0.15, -0.45]", "camera.target=[1.8, 0.0, 0.2]", "camera.near=0.02"]),
    ("volumes, parity", "cases/scenes/box", &["light.shadow.technique=shadow-volume", "light.shadow.method=parity"]),
    ("counted lights", "cases/scenes/two_lights", &["light.shadow.technique=shadow-volume"]),
    ("two lights", "cases/scenes/two_lights", &["shading.lighting=per-vertex"]),
    ("alpha shadows", "cases/scenes/two_lights", &["shading.passes=shadow"]),
    ("guard by stencil", "cases/scenes/guards", &["light.shadow.guard=stencil"]),
    ("guard by a clip plane", "cases/scenes/guards", &["light.shadow.guard=clip-plane"]),
    ("guard by a 1D texture", "cases/scenes/guards", &["light.shadow.guard=texture-1d"]),
    ("bumps in one pass", "scenes/doughnut", &["shading.bump=one-pass"]),
    ("bumps in three passes", "scenes/doughnut", &["shading.bump=three-pass"]),
    ("combiners", "scenes/doughnut", &["shading.bump=one-pass", "shading.combiners=data/combiners/gdc2001.rc"]),
    ("holes of alpha", "cases/shadow-map/alpha-test/scene", &[]),
    ("wave", "cases/shadow-map/wave/scene", &[]),
    ("slides", "cases/slide-projector/room/scene", &[]),
    ("photograph", "cases/single-pass/photo/scene", &[]),
    ("beam", "cases/scenes/above", &["light.shadow.technique=none", "light.cone=60", "light.beam={ profile = [1.0, 1.0, 0.5, 0.5, 0.0] }"]),
    ("lens", "cases/scenes/box", &["light.focus={ distance = 5.0, radius = 0.2, samples = 4 }"]),
    ("dust", "cases/scenes/box", &["light.dust={ density = 0.2, slices = 24 }"]),
    ("example", "scenes/main", &[]),
];

/// A scene of [`SCENES`] planned, and what the sound driver draws.
pub struct Sound {
    name: &'static str,
    plan: Plan,
    pixels: Vec<Pixels>,
}

fn draw(renderer: &mut Renderer, plan: &Plan) -> Result<Vec<Pixels>, String> {
    renderer.draw(plan).map_err(|error| error.to_string())?;
    let frame = renderer.read(plan).map_err(|error| error.to_string())?;
    Ok([vec![frame.picture], frame.views].concat())
}

/// Draws a plan by the fixed-function pipeline; nothing where it cannot.
fn draw_fixed(fixed: &mut FixedFunction, plan: &Plan) -> Result<Option<Pixels>, String> {
    if !fixed.inexpressible(&plan.list).is_empty() {
        return Ok(None);
    }
    fixed.run(&plan.list).map_err(|error| error.to_string())?;
    fixed.read(&plan.list, plan.picture).map(Some).map_err(|error| error.to_string())
}

/// All of [`SCENES`] by a driver: those that differ from `sound`, by shaders or by fixed function.
fn drawn(context: &Rc<dyn Context>, scenes: &[(&'static str, Plan)]) -> Vec<Result<Vec<Pixels>, String>> {
    let mut renderer = Renderer::new(context);
    let shaders: Vec<_> = scenes.iter().map(|(_, plan)| draw(&mut renderer, plan)).collect();
    drop(renderer);
    let Ok(mut fixed) = FixedFunction::new(context) else { return shaders };
    shaders
        .into_iter()
        .zip(scenes)
        .map(|(pixels, (_, plan))| Ok([pixels?, draw_fixed(&mut fixed, plan)?.into_iter().collect()].concat()))
        .collect()
}

/// The judge's scenes, and their pictures by the sound driver.
pub fn sound() -> Vec<Sound> {
    sound_of(SCENES)
}

/// Scenes, and their pictures by the sound driver. Drawn twice: one that the driver draws in two ways is left out.
pub fn sound_of(scenes: &[SceneRow]) -> Vec<Sound> {
    let context = context(None);
    let mut renderer = Renderer::new(&context);
    let plan = |&(name, file, set): &SceneRow| {
        let path = format!("data/{file}.toml");
        let set: Vec<_> = ["image.size=[64, 64]"].iter().chain(set).map(|set| (*set).to_owned()).collect();
        let scene = glumbra::load(Path::new(&path), &set).unwrap_or_else(|error| panic!("{name}: {error}")).scene;
        let views = [View::Shade, View::Depth].map(|view| ViewRequest { view, light: 0 }).to_vec();
        let request = Request { views, sampled_warnings: false, ..Request::default() };
        let plan = renderer
            .plan(&scene, &request)
            .or_else(|_| renderer.plan(&scene, &Request { sampled_warnings: false, ..Request::default() }));
        (name, plan.unwrap_or_else(|error| panic!("{name}: {error}")))
    };
    let scenes: Vec<_> = scenes.iter().map(plan).collect();
    drop(renderer);
    let first = drawn(&context, &scenes);
    let second = drawn(&self::context(None), &scenes);
    let both = first.into_iter().zip(second).zip(scenes);
    both.filter_map(|((pixels, again), (name, plan))| {
        let pixels = pixels.unwrap_or_else(|error| panic!("{name}: {error}"));
        (again.as_ref() == Ok(&pixels)).then_some(Sound { name, plan, pixels })
    })
    .collect()
}

/// Names of the scenes whose pictures the fault changes.
pub fn changed(fault: &Fault, sound: &[Sound]) -> Vec<&'static str> {
    shares(fault, sound).into_iter().map(|(name, _)| name).collect()
}

/// Scenes whose pictures the fault changes, each with the largest share of a picture's pixels that differ.
pub fn shares(fault: &Fault, sound: &[Sound]) -> Vec<(&'static str, f64)> {
    let scenes: Vec<_> = sound.iter().map(|scene| (scene.name, scene.plan.clone())).collect();
    let pictures = drawn(&context(Some(fault)), &scenes);
    let differs = pictures.into_iter().zip(sound).filter(|(pixels, sound)| pixels.as_ref() != Ok(&sound.pixels));
    let share = |pixels: Result<Vec<Pixels>, String>, sound: &Sound| {
        let pixels = pixels.unwrap_or_default();
        let shares = pixels.iter().zip(&sound.pixels).map(|(one, other)| differing(one, other));
        if pixels.len() == sound.pixels.len() { shares.fold(0.0, f64::max) } else { 1.0 }
    };
    differs.map(|(pixels, sound)| (sound.name, share(pixels, sound))).collect()
}

/// Share of the pixels that differ; 1 of pictures of two kinds or sizes.
fn differing(one: &Pixels, other: &Pixels) -> f64 {
    fn share<T: PartialEq>(one: &[T], other: &[T], each: usize) -> f64 {
        let pixels = one.chunks(each).zip(other.chunks(each));
        pixels.filter(|(a, b)| a != b).count() as f64 / (one.len() / each).max(1) as f64
    }
    match (one, other) {
        (Pixels::Rgba8 { size: a, data: one }, Pixels::Rgba8 { size: b, data: other }) if a == b => {
            share(one, other, 4)
        }
        (Pixels::RgbaF32 { size: a, data: one }, Pixels::RgbaF32 { size: b, data: other }) if a == b => {
            share(one, other, 4)
        }
        (Pixels::Depth { size: a, data: one }, Pixels::Depth { size: b, data: other }) if a == b => {
            share(one, other, 1)
        }
        _ => 1.0,
    }
}

/// Does `work` for each fault on two threads; what it gives, in the faults' order.
pub fn each<T: Send>(faults: &[&'static Fault], work: impl Fn(&'static Fault) -> T + Sync) -> Vec<T> {
    let (next, results) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(fault) = faults.get(index) else { return };
                    let result = work(fault);
                    results.lock().expect("no panic").push((index, result));
                }
            });
        }
    });
    let mut results = results.into_inner().expect("no panic");
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

/// The page with the table of faults, and the line above the table.
pub const PAGE: &str = "ci/drivers.md";
pub const MARKER: &str = "<!-- faults: cargo run --release --example faults -- --write -->";
/// The line below it.
pub const END: &str = "<!-- end of the faults -->";

/// A row of the table: the fault, the rules that it turns red, the scenes that it changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    pub fault: String,
    pub red: Vec<String>,
    /// `None`: not drawn.
    pub changed: Option<usize>,
}

/// The rows of the page's table.
pub fn rows(page: &str) -> Vec<Row> {
    let table = page.split(MARKER).nth(1).and_then(|rest| rest.split(END).next()).unwrap_or("");
    let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let row = |line: &str| match cells(line).as_slice() {
        [fault, _, red, changed] if !fault.is_empty() && !fault.starts_with("---") && fault != "fault" => Some(Row {
            fault: fault.clone(),
            red: red.split_whitespace().filter(|id| id.starts_with("GL-")).map(str::to_owned).collect(),
            changed: changed.split_whitespace().next().and_then(|count| count.parse().ok()),
        }),
        _ => None,
    };
    table.lines().filter_map(row).collect()
}
