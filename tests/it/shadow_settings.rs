//! `[light.shadow]` is read once, when the scene is loaded: every error in it is found there, also of a light that is never
//! drawn, and what loads can be planned. Keys that every light has act under every technique.

use std::fmt::Write as _;
use std::path::PathBuf;

use glumbra::context::ContextRequest;
use glumbra::lights::{LightTerm, LightView, Notes};
use glumbra::pass::{self, PassList, Redraw};
use glumbra::plan::{self, Plan, Request, ViewRequest};
use glumbra::report::measure::grid::Grid;
use glumbra::report::measure::options::MeasureOptions;
use glumbra::report::measure::run;
use glumbra::report::store::results::Outcome;
use glumbra::scene::{LightKind, Scene};
use glumbra::techniques::{self, LightShadow, TABLE, Technique, vary};
use glumbra::viewer::{Command, Mode, State};
use glumbra::views::View;

use crate::support::random::Random;

/// Lights by their keys, each before its `[light.shadow]`.
const SPOT: &str = "kind = \"spot\"\nposition = [-3.0, 6.0, 2.0]\ntarget = [0.0, 0.0, 0.0]\ncone = 70.0\n";
const POINT: &str = "kind = \"point\"\nposition = [-3.0, 6.0, 2.0]\n";
const SUN: &str = "kind = \"directional\"\ndirection = [0.3, -1.0, 0.2]\n";
/// Adds nothing to the picture.
const BLACK: &str =
    "kind = \"spot\"\nposition = [-3.0, 6.0, 2.0]\ntarget = [0.0, 0.0, 0.0]\ncone = 70.0\ncolor = [0, 0, 0]\n";
/// Lights nothing that the camera sees.
const ASIDE: &str = "kind = \"spot\"\nposition = [40.0, 1.0, 0.0]\ntarget = [50.0, 1.0, 0.0]\ncone = 20.0\n";

const CAMERA: &str =
    "[image]\nsize = [64, 48]\n[camera]\neye = [5.0, 5.0, 8.0]\ntarget = [0.0, 0.5, 0.0]\nfov_y = 40.0\n";
const BOX: &str = "[[object]]\nname = \"floor\"\nmesh = \"quad\"\nscale = [6.0, 1.0, 6.0]\n\
                   [[object]]\nname = \"box\"\nmesh = \"box\"\ntranslate = [0.0, 1.0, 0.0]\n";
/// An open caster above the box.
const ROOF: &str = "[[object]]\nname = \"roof\"\nmesh = \"quad\"\ntranslate = [0.0, 3.0, 0.0]\n";
/// An open caster that nothing of the lights above reaches.
const FAR_ROOF: &str = "[[object]]\nname = \"roof\"\nmesh = \"quad\"\ntranslate = [0.0, 90.0, 0.0]\n";
const WAVING: &str = "[[object]]\nname = \"sheet\"\nmesh = \"quad\"\ntranslate = [1.0, 2.0, 0.0]\n\
                      wave = { direction = [0, 1, 0], axis = [1, 0, 0], amplitude = 0.2, wavelength = 1.0 }\n";

struct Work(tempfile::TempDir);

impl Work {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self) -> PathBuf {
        self.0.path().join("scene.toml")
    }

    fn load(&self, text: &str) -> Result<Scene, String> {
        std::fs::write(self.path(), text).unwrap();
        glumbra::load(&self.path(), &[]).map(|loaded| loaded.scene).map_err(|error| error.to_string())
    }
}

fn light(kind: &str, shadow: &str) -> String {
    format!("[[light]]\n{kind}[light.shadow]\n{shadow}\n")
}

/// A scene whose second light is never drawn, and whose last lines are that light's keys.
fn with_undrawn(undrawn: &str, shadow: &str) -> String {
    let text = format!("{CAMERA}{BOX}{ROOF}{}", light(undrawn, shadow));
    format!("{}{}", light(SPOT, "technique = \"shadow-map\""), text)
}

#[test]
fn a_wrong_key_of_a_light_that_is_never_drawn_fails_at_load() {
    let work = Work::new();
    for undrawn in [BLACK, ASIDE] {
        let text = with_undrawn(undrawn, "technique = \"shadow-map\"\nsize = 64");
        let plan = plan::make(&work.load(&text).unwrap(), &Request::default()).unwrap();
        assert!(plan.left_out.iter().any(|left| left.what == "light 1"), "{:?}", plan.left_out);
        for (shadow, after, expected) in [
            ("technique = \"shadow-map\"\nsiez = 64", 2, "unknown key `siez`"),
            ("technique = \"shadow-mapp\"", 1, "did you mean `shadow-map`?"),
            ("technique = \"shadow-map\"\nsize = \"big\"", 2, "must be an integer"),
            ("technique = \"shadow-volume\"\ndimming = 2", 2, "`light.shadow.dimming` must be in [0, 1], not 2"),
            ("technique = \"none\"\ndimming = 2", 2, "`light.shadow.dimming` must be in [0, 1], not 2"),
            ("technique = \"none\"\nredraw = \"never\"", 2, "`light.shadow.redraw` cannot be \"never\""),
            ("technique = \"shadow-volume\"\nguard = \"clipplane\"", 2, "did you mean `clip-plane`?"),
            ("technique = \"shadow-volume\"\nguard = \"stencil\"", 2, "both tag in the one buffer"),
            // Keys of another technique are checked by that technique.
            ("technique = \"none\"\nmethod = \"z-pas\"", 2, "did you mean `z-pass`?"),
            ("technique = \"shadow-map\"\nmipmaps = true\nfilter = \"nearest\"", 2, "need filter = \"linear\""),
        ] {
            let text = with_undrawn(undrawn, shadow);
            let line = text.lines().count() - shadow.lines().count() + after;
            let error = work.load(&text).unwrap_err();
            assert!(error.contains(&format!("scene.toml:{line}: ")) && error.contains(expected), "{shadow}: {error}");
        }
    }
}

#[test]
fn guards_of_lights_with_nothing_behind_them_are_refused_under_every_technique() {
    let work = Work::new();
    for (kind, name) in [(POINT, "point"), (SUN, "directional")] {
        for technique in TABLE {
            let shadow = format!("technique = \"{}\"\nclosed = \"assume\"\n", technique.name());
            let text = |guard: &str| format!("{CAMERA}{BOX}{}", light(kind, &format!("{shadow}{guard}")));
            let is_served = work.load(&text("")).is_ok();
            let error = work.load(&text("guard = \"fragment\"")).unwrap_err();
            let behind = format!("behind a {name} light lies nothing");
            assert!(!is_served || error.contains(&behind), "{}: {error}", technique.name());
        }
    }
}

/// Open casters are refused wherever the camera looks, and only if their shadow can fall on something.
#[test]
fn open_casters_are_refused_at_load() {
    let work = Work::new();
    let key = "technique = \"second-depth\"";
    for kind in [SPOT, SUN] {
        let text = |objects: &str, shadow: &str| format!("{}{CAMERA}{objects}", light(kind, shadow));
        let error = work.load(&text(&format!("{BOX}{ROOF}"), key)).unwrap_err();
        assert!(error.contains("scene.toml:") && error.ends_with("closed=assume)"), "{error}");
        assert!(error.contains("open: roof. Give them"), "the floor shadows nothing: {error}");
        let away = "[image]\nsize = [64, 48]\n[camera]\neye = [0.0, 50.0, 0.0]\ntarget = [0.0, 60.0, 1.0]\n";
        let error = work.load(&text(&format!("{BOX}{ROOF}"), key).replace(CAMERA, away)).unwrap_err();
        assert!(error.contains("open: roof."), "{error}");
        work.load(&text(BOX, key)).unwrap();
        work.load(&text(&format!("{BOX}{ROOF}"), &format!("{key}\nclosed = \"assume\""))).unwrap();
        work.load(&text(&format!("{BOX}{ROOF}casts_shadow = false\n"), key)).unwrap();
    }
    work.load(&format!("{}{CAMERA}{BOX}{FAR_ROOF}", light(SPOT, key))).unwrap();
}

/// The type says that a light's description has no error.
const DESCRIBE: fn(&LightShadow, &LightView<'_>, &mut PassList, &mut Notes) -> LightTerm = LightShadow::describe;

/// A technique with a few changed keys, which need not go together.
fn some_keys(random: &mut Random, technique: &dyn Technique, kind: &LightKind) -> String {
    let changes = technique.changes(kind);
    let mut keys = format!("technique = \"{}\"", technique.name());
    let mut add = |more: &str| {
        // A key stands once in a table.
        let is_new = |part: &str| !keys.contains(&format!("{} =", part.split(" =").next().unwrap_or_default().trim()));
        if more.split(", ").all(is_new) {
            let _ = write!(keys, ", {more}");
        }
    };
    for _ in 0..random.below(3) {
        if !changes.is_empty() {
            add(changes[random.below(changes.len())].keys);
        }
    }
    for common in [
        "dimming = 0.5",
        "redraw = \"always\"",
        "guard = \"fragment\"",
        "guard = \"clip-plane\"",
        "guard = \"stencil\"",
    ] {
        if random.below(4) == 0 {
            add(common);
        }
    }
    if random.below(2) == 0 {
        add("closed = \"assume\"");
    }
    keys
}

#[test]
fn a_scene_that_loads_can_be_planned() {
    let _ = DESCRIBE;
    let work = Work::new();
    let mut random = Random::new(2001);
    let lit_by = |kind: &str| work.load(&format!("{}{CAMERA}{BOX}", light(kind, ""))).unwrap().lights.remove(0).kind;
    let kinds = [SPOT, POINT, SUN].map(lit_by);
    let (mut refused, mut planned, mut excluded) = (0, 0, 0);
    for _ in 0..600 {
        let mut text = String::from(CAMERA);
        for object in [BOX, ROOF, FAR_ROOF, WAVING].iter().take(1 + random.below(4)) {
            text += object;
        }
        for _ in 0..=random.below(2) {
            let kind = [SPOT, POINT, SUN, BLACK, ASIDE][random.below(5)];
            let (technique, other) = (random.pick(TABLE), random.below(3));
            let keys = some_keys(&mut random, technique, &kinds[other]);
            let _ = write!(text, "[[light]]\n{kind}shadow = {{ {keys} }}\n");
        }
        let Ok(scene) = work.load(&text) else {
            refused += 1;
            continue;
        };
        for keep_all in [false, true] {
            let views = vec![ViewRequest { view: View::Shade, light: 0 }];
            let request = Request { keep_all, views, sampled_warnings: false, ..Request::default() };
            match plan::make(&scene, &request) {
                Ok(_) => planned += 1,
                // Lights that cannot be drawn together; each alone could.
                Err(plan::Error::Composition(_)) => excluded += 1,
                Err(error) => panic!("{error}\n{text}"),
            }
        }
    }
    println!("{refused} refused, {planned} planned, {excluded} of lights that exclude each other");
    assert!(refused > 60 && planned > 600, "{refused} refused, {planned} planned, {excluded} excluded");
}

fn plan_of(technique: &dyn Technique, keys: &str) -> Plan {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/cases/scenes/guards.toml");
    let scene = glumbra::load(path.as_ref(), &[]).unwrap().scene;
    let inside = format!("technique = \"{}\", closed = \"assume\"{keys}", technique.name());
    let scene = techniques::with_keys(&scene, 0, &inside).unwrap();
    let request = Request { sampled_warnings: false, frames: 2, ..Request::default() };
    plan::make(&scene, &request).unwrap_or_else(|error| panic!("{inside}: {error}"))
}

/// A plan's passes with their shaders and uniforms, without meshes.
fn shading(plan: &Plan) -> String {
    let mut text = String::new();
    for pass in &plan.list.passes {
        let _ = writeln!(text, "{}", pass.label);
        if let pass::Work::Draw(draw) = &pass.work {
            for batch in &draw.batches {
                let _ = writeln!(text, "{:?} {:?} {:?}", batch.program, batch.uniforms, batch.clip_planes);
            }
        }
    }
    text
}

/// No technique reads these keys, and none can forget them.
#[test]
fn keys_of_every_light_act_under_every_technique() {
    for technique in TABLE {
        let plain = plan_of(*technique, "");
        assert_eq!(shading(&plan_of(*technique, "")), shading(&plain), "{}: the same twice", technique.name());
        for guard in ["texture-1d", "spot-cutoff", "none"] {
            let guarded = plan_of(*technique, &format!(", guard = \"{guard}\""));
            assert_ne!(shading(&guarded), shading(&plain), "{}: {guard}", technique.name());
        }
        let dimmed = plan_of(*technique, ", dimming = 0.5");
        let is_dimmed = shading(&dimmed) != shading(&plain);
        assert_eq!(is_dimmed, technique.draws_shadows(), "{}: dimming", technique.name());
        // Passes of the light itself; the picture's are drawn every time, or once under a count.
        let kept = |plan: &Plan| plan.list.passes.iter().filter(|pass| pass.redraw == Redraw::WhenChanged).count();
        let redrawn = plan_of(*technique, ", redraw = \"always\"");
        assert_eq!(kept(&redrawn), 0, "{}: redraw", technique.name());
        assert_eq!(kept(&plain) > 0, technique.draws_shadows(), "{}: redraw", technique.name());
    }
}

/// A technique that cannot draw the scene is not taken, and the window's title says why.
#[test]
fn a_window_keeps_its_technique_where_the_next_is_refused() {
    let scene = Work::new().load(&format!("{}{CAMERA}{BOX}{ROOF}", light(SPOT, "technique = \"shadow-map\""))).unwrap();
    let mut state = State::new(scene, Mode::Shadowed).with_techniques(&["shadow-map", "second-depth"]);
    state.apply(Command::NextTechnique);
    assert!(state.status().contains("shadow-map") && state.status().contains("open: roof"), "{}", state.status());
    let technique = LightShadow::of(&state.scene().lights[0].shadow).unwrap().technique;
    assert_eq!(technique.name(), "shadow-map");
    state.apply(Command::NextTweak);
    assert!(!state.status().contains("open: roof"), "{}", state.status());
    // What can be read is taken: its map's texels change with the tweak.
    let before = plan::make(&state.frame().0, &state.frame().1).unwrap();
    state.apply(Command::Step(5.0));
    assert_ne!(plan::make(&state.frame().0, &state.frame().1).unwrap().list, before.list);
}

/// A row that cannot draw the scene's objects fails alone; the report has the others.
#[test]
fn a_row_that_its_objects_refuse_fails_alone() {
    let work = Work::new();
    work.load(&format!("{}{CAMERA}{BOX}{ROOF}", light(SPOT, "technique = \"shadow-map\""))).unwrap();
    let keys = ["technique = \"second-depth\"", "technique = \"second-depth\", closed = \"assume\", size = 64"];
    let grid = Grid::Own(keys.map(|keys| glumbra::scene::shadow_settings(keys).unwrap()).to_vec());
    let context = ContextRequest::default();
    let options = MeasureOptions { light: 0, runs: 1, jobs: 1, shard: (1, 1), band_texels: 2.0, context };
    let sweep = run::prepare(&work.path(), &[], &grid, &options).unwrap();
    assert!(sweep.scene_of(1).is_none() && sweep.scene_of(2).is_some());
    assert_eq!([1, 2].map(|index| sweep.row_of(index).map_size), [Some(1024), Some(64)]);
    let mut rows = Vec::new();
    sweep.run(&[1, 2], &options, &Default::default(), |row| rows.push(row)).unwrap();
    rows.sort_by_key(|row| row.index);
    assert!(matches!(&rows[0].outcome, Outcome::Failed(why) if why.contains("open: roof")), "{:?}", rows[0].outcome);
    assert!(matches!(rows[1].outcome, Outcome::Measured(_)), "{:?}", rows[1].outcome);
}

/// A contender has its own keys, and of the scene's those that it shares with the tuned map: not what would make it another
/// contender, and not what it does not read.
#[test]
fn contenders_share_the_scenes_map() {
    let written = "technique = \"shadow-map\", format = \"depth16\", size = 77, single = \"first\", closed = \"assume\", \
                   method = \"z-pass\", dimming = 0.25";
    let written = glumbra::scene::shadow_settings(written).unwrap();
    let keys = glumbra::scene::shadow_settings("technique = \"midpoint\"").unwrap();
    let names = |table: &glumbra::scene::Settings| {
        let entries = table.entries.iter().map(|(key, entry)| format!("{key} = {}", entry.value.to_toml()));
        entries.collect::<Vec<_>>().join(", ")
    };
    let expected = "technique = \"midpoint\", size = 128, format = \"depth16\", dimming = 0.25";
    assert_eq!(names(&vary::beside_tuned(&written, 128, &keys)), expected);
    let expected = "technique = \"shadow-map\", size = 128, offset = { factor = 1.5, units = 4.0 }, format = \"depth16\", \
                    dimming = 0.25";
    assert_eq!(names(&vary::with_offset(&written, 128, 1.5, 4.0)), expected);
}
