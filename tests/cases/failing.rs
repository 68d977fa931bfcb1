//! Every kind of check fails where it must: a case that holds, and the same case with one thing wrong. A kind without such
//! a test is a failure.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use glow::HasContext;
use glumbra::cases::{CaseOutcome, CaseVerdict, KINDS, PixelCase};
use glumbra::frame::Renderer;

use crate::comparator::{Folder, draw, scene, tests};
use crate::with_runner;

pub const TESTS: &[(&str, fn())] = tests![
    every_kind_of_check_has_a_case_that_fails,
    each_check_fails_where_it_must,
    a_picks_color_fails_by_one_code,
    a_renderer_that_keeps_what_it_must_not_fails,
    a_gl_error_fails_a_case_before_its_checks,
    a_message_of_high_severity_fails_a_case,
    commands_that_fail_say_how,
    a_commands_picture_is_checked,
    checks_of_glumbras_own_plan_are_refused_beside_a_command,
];

/// A check that holds, the same that does not, and the words of its failure. The kind: the check's key, for a pick or a
/// check against truth with the key of what it expects.
const PAIRS: &[(&str, &str, &str, &str)] = &[
    ("fails_with", "set = [\"light.cone=0\"]\nfails_with = \"cone\"\n", "fails_with = \"cone\"\n", "the scene draws"),
    (
        "warns",
        "set = [\"light.shadow.format=depth32\"]\nwarns = \"DEPTH_COMPONENT32\"\n",
        "set = [\"light.shadow.format=depth32\"]\nwarns = \"a herring\"\n",
        "nothing says \"a herring\"",
    ),
    (
        "leaves_out",
        "set = [\"light.position=[0, 5, 30]\", \"light.target=[0, 0, 60]\"]\nleaves_out = \"light 0: its cone\"\n",
        "leaves_out = \"light 0: its cone\"\n",
        "nothing says \"light 0: its cone\"",
    ),
    (
        "pick.class",
        "[[pick]]\nat = [0.8, 0, -0.4]\nclass = \"shadowed\"\n",
        "[[pick]]\nat = [0.8, 0, -0.4]\nclass = \"lit\"\n",
        "is Shadowed",
    ),
    (
        "pick.shade",
        "[[pick]]\nat = [0.8, 0, -0.4]\nshade = 0.0\n",
        "[[pick]]\nat = [0.8, 0, -0.4]\nshade = 0.01\n",
        "not a shade of 0.01",
    ),
    (
        "pick.formula",
        "[[pick]]\nat = [0.8, 0, -0.4]\nformula = { normal = [0, 1, 0], object = 0, shade = [0] }\n",
        "[[pick]]\nat = [0.8, 0, -0.4]\nformula = { normal = [0, 1, 0], object = 0, shade = [1] }\n",
        "within 1",
    ),
    (
        "edge",
        "[[edge]]\ncaster = [0.5, 1, 0]\noutward = [1, 0, 0]\n",
        "[[edge]]\ncaster = [0.6, 1, 0]\noutward = [1, 0, 0]\n",
        "not Shadowed",
    ),
    ("cone", "[[cone]]\ntowards = [0, 0, 1]\n", "[[cone]]\ntowards = [0, 0, 1]\nfloor = 0.3\n", " at pixel "),
    (
        "count",
        "[[count]]\nclass = \"shadowed\"\nleast = 0.01\n",
        "[[count]]\nclass = \"shadowed\"\nleast = 0.9\n",
        "not in [0.9, 1]",
    ),
    (
        "same",
        "[[same]]\nof = [\"shade\"]\nsets = [[\"light.shadow.redraw=always\"]]\nexact = true\n",
        "[[same]]\nof = [\"shade\"]\nsets = [[\"light.shadow.size=128\"]]\nexact = true\n",
        "none may",
    ),
    (
        "sum",
        "[[sum]]\nplus = [[\"light.color=[0.5, 0.5, 0.5]\"], [\"light.color=[0.5, 0.5, 0.5]\"]]\nminus = [[\"light.color=[0, 0, 0]\"]]\nmax = 1e-5\n",
        "[[sum]]\nplus = [[\"light.color=[0.5, 0.5, 0.5]\"]]\nmax = 1e-5\n",
        "the sum: ",
    ),
    (
        "truth.false_shadow",
        "[[truth]]\nfalse_shadow = 1.0\nleak = 1.0\n",
        "[[truth]]\nfalse_shadow = 0.0\nleak = 1.0\n",
        "; false_shadow may be 0 %",
    ),
    (
        "truth.leak",
        "[[truth]]\nfalse_shadow = 1.0\nleak = 1.0\n",
        "[[truth]]\nfalse_shadow = 1.0\nleak = 0.0\n",
        "; leak may be 0 %",
    ),
    (
        "truth.outside_band",
        "[[truth]]\nfalse_shadow = 1.0\nleak = 1.0\n",
        "[[truth]]\nfalse_shadow = 1.0\nleak = 1.0\nbound = \"exact\"\n",
        "; outside_band may be 0 %",
    ),
    (
        "truth.edge",
        "[[truth]]\nfalse_shadow = 1.0\nleak = 1.0\nedge = 1.0\n",
        "[[truth]]\nfalse_shadow = 1.0\nleak = 1.0\nedge = 0.0\n",
        "; edge may be 0 pixels",
    ),
    (
        "golden",
        "[golden]\nmax = 2\nmean = 0.05\n",
        "set = [\"light.shadow.technique=none\"]\n[golden]\nmax = 2\nmean = 0.05\n",
        "differ, by",
    ),
];

/// Kinds with a test of their own in this file or in `comparator.rs`.
const APART: [&str; 4] = ["gl", "pick.color", "after", "render"];

/// Keys of a file, a pick and a check against truth that are no checks.
const NO_CHECKS: [&str; 4] = ["asks", "scene", "set", "for_each"];
const NO_PICKS: [&str; 7] = ["at", "pixel", "light", "set", "for_each", "within", "why"];
const NO_TRUTHS: [&str; 6] = ["light", "bound", "band", "set", "for_each", "why"];

fn every_kind_of_check_has_a_case_that_fails() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/cases/file.rs");
    let file = syn::parse_file(&fs::read_to_string(path).unwrap()).unwrap();
    let keys = |name: &str, without: &[&str]| -> Vec<String> {
        let found = file.items.iter().find_map(|item| match item {
            syn::Item::Struct(item) if item.ident == name => Some(item),
            _ => None,
        });
        let fields = found.unwrap_or_else(|| panic!("no {name}")).fields.iter();
        let names = fields.map(|field| field.ident.as_ref().unwrap().to_string());
        names.filter(|name| !without.contains(&name.as_str())).collect()
    };
    let top = keys("Checks", &NO_CHECKS);
    let made: BTreeSet<&str> = top.iter().map(String::as_str).filter(|key| *key != "render").chain(["gl"]).collect();
    assert_eq!(made, KINDS.into_iter().collect(), "keys of Checks, and the kinds that check.rs makes");
    let mut kinds: BTreeSet<String> = top.into_iter().chain(["gl".to_owned()]).collect();
    for (key, name, without) in [("pick", "Pick", &NO_PICKS[..]), ("truth", "TruthCheck", &NO_TRUTHS)] {
        kinds.remove(key);
        kinds.extend(keys(name, without).iter().map(|field| format!("{key}.{field}")));
    }
    let tested = PAIRS.iter().map(|(kind, ..)| *kind).chain(APART).map(str::to_owned).collect();
    let missing: Vec<_> = kinds.difference(&tested).collect();
    assert!(missing.is_empty(), "kinds of checks without a case that fails: {missing:?}");
    assert_eq!(kinds, tested, "and no test of a kind that is not there");
}

/// Runs the box scene with the keys of `toml`; checks that need one get a `why`.
fn outcome(folder: &Folder, title: &str, toml: &str) -> CaseOutcome {
    let why = if toml.contains("[[") || toml.contains("[golden]") { "why = \"\"\n" } else { "" };
    let text = format!("asks = \"{title}\"\nscene = {:?}\n{toml}{why}", scene());
    fs::write(folder.path("case.toml"), text).unwrap();
    let case = PixelCase::read(&folder.path(""), &format!("failing/{title}"))
        .unwrap_or_else(|error| panic!("{title}: {error}"));
    with_runner(|runner| runner.run(&case))
}

fn each_check_fails_where_it_must() {
    for (kind, right, wrong, text) in PAIRS {
        let folder = Folder::with_golden(&[]);
        let passes = outcome(&folder, kind, right);
        assert_eq!(passes.failure(), None, "{kind}");
        let fails = outcome(&folder, kind, wrong);
        let message = fails.message.unwrap_or_else(|| panic!("{kind} passes with {wrong}"));
        assert!(message.contains(text), "{kind}: {message}");
        assert_eq!(fails.verdict, CaseVerdict::Fail);
        assert_eq!(fails.check.as_deref(), kind.split('.').next(), "{message}");
        let line = 3 + wrong
            .lines()
            .position(|line| line.trim_matches(['[', ']']).split(' ').next() == fails.check.as_deref())
            .unwrap();
        assert!(fails.at.as_ref().unwrap().ends_with(&format!("case.toml:{line}")), "{kind}: {:?}", fails.at);
    }
}

fn a_picks_color_fails_by_one_code() {
    let picture = draw(&[]);
    let [red, green, blue] = [0, 1, 2].map(|channel| 255.0 * picture.pixel([40, 100])[channel]);
    let pick =
        |red: f32| format!("[[pick]]\npixel = [40, 100]\ncolor = [{red:?}, {green:?}, {blue:?}]\nwithin = 0.5\n");
    assert_eq!(outcome(&Folder::new(), "color", &pick(red)).failure(), None);
    let fails = outcome(&Folder::new(), "color", &pick(red + 1.0));
    assert!(fails.message.unwrap().contains("within 0.5"));
}

/// Between the two frames another program asks for outlines.
fn a_renderer_that_keeps_what_it_must_not_fails() {
    let after = "[[after]]\nof = [\"picture\"]\nfirsts = [[\"light.far=11\"]]\n";
    assert_eq!(outcome(&Folder::new(), "after", after).failure(), None);
    let wire = |is_on: bool| {
        move |renderer: &mut Renderer| {
            let gl = renderer.device().raw_gl();
            // SAFETY: state that the device does not know; it is taken back below.
            unsafe { gl.polygon_mode(glow::FRONT_AND_BACK, if is_on { glow::LINE } else { glow::FILL }) };
        }
    };
    with_runner(|runner| runner.drawer().between_frames(Some(Box::new(wire(true)))));
    let fails = outcome(&Folder::new(), "after", after);
    with_runner(|runner| {
        runner.drawer().between_frames(None);
        wire(false)(runner.drawer().renderer().unwrap());
    });
    assert_eq!(fails.check.as_deref(), Some("after"), "{fails:?}");
    assert!(fails.message.as_ref().unwrap().contains("Picture after [\"light.far=11\"]: "), "{fails:?}");
    assert_eq!(outcome(&Folder::new(), "after", after).failure(), None);
}

const LIT: &str = "[[pick]]\nat = [0, 1, 0]\nclass = \"lit\"\n";

fn a_gl_error_fails_a_case_before_its_checks() {
    // SAFETY: no such capability; the context is the runner's.
    with_runner(|runner| unsafe { runner.drawer().renderer().unwrap().device().raw_gl().enable(0xFFFF) });
    let fails = outcome(&Folder::new(), "gl-error", LIT);
    assert_eq!((fails.verdict, fails.check.as_deref()), (CaseVerdict::Fail, Some("gl")));
    assert!(fails.message.as_ref().unwrap().starts_with("GL error in "), "{fails:?}");
    assert_eq!(outcome(&Folder::new(), "gl-error", LIT).failure(), None, "an error is reported once");
}

fn a_message_of_high_severity_fails_a_case() {
    with_runner(|runner| {
        let gl = runner.drawer().renderer().unwrap().device().raw_gl().clone();
        // SAFETY: a message of the application's own.
        unsafe {
            gl.debug_message_insert(
                glow::DEBUG_SOURCE_APPLICATION,
                glow::DEBUG_TYPE_PERFORMANCE,
                7,
                glow::DEBUG_SEVERITY_HIGH,
                "everything is slow",
            );
        }
    });
    let fails = outcome(&Folder::new(), "gl-message", LIT);
    assert_eq!(fails.check.as_deref(), Some("gl"), "{fails:?}");
    assert!(fails.message.as_ref().unwrap().contains("with high severity: everything is slow"), "{fails:?}");
    assert_eq!(outcome(&Folder::new(), "gl-message", LIT).failure(), None);
}

/// Runs a case whose pictures a shell draws.
fn shell(script: &str, toml: &str) -> CaseOutcome {
    outcome(
        &Folder::with_golden(&[]),
        "command",
        &format!("render = [\"sh\", \"-c\", {script:?}, \"{{out}}\"]\n{toml}"),
    )
}

#[cfg(unix)]
fn commands_that_fail_say_how() {
    let begin = std::time::Instant::now();
    for (script, verdict, text) in [
        ("echo no such light >&2; exit 3 # {out} {kind}", CaseVerdict::Fail, "(exit status: 3)\n    | no such light"),
        ("kill -9 $$", CaseVerdict::Crash, "crashed (SIGKILL)"),
        ("kill -SEGV $$", CaseVerdict::Crash, "crashed (SIGSEGV)"),
        ("true", CaseVerdict::Fail, "ended well and wrote no picture"),
        ("sleep 100 & wait", CaseVerdict::Hang, "did not end in 5.0 s, and was killed"),
    ] {
        let fails = shell(script, LIT);
        assert_eq!(fails.verdict, verdict, "{script}: {fails:?}");
        assert!(fails.message.as_ref().unwrap().contains(text), "{script}: {fails:?}");
        assert_eq!(fails.check.as_deref(), Some("pick"));
    }
    assert!(begin.elapsed().as_secs() < 60);
    let absent = outcome(&Folder::new(), "command", &format!("render = [\"no-such-engine\", \"{{out}}\"]\n{LIT}"));
    assert!(absent.message.as_ref().unwrap().contains("no-such-engine: cannot be started"), "{absent:?}");
}

#[cfg(not(unix))]
fn commands_that_fail_say_how() {}

/// The golden is the right picture, and no shade: its colours are seen.
#[cfg(unix)]
fn a_commands_picture_is_checked() {
    const GOLDEN: &str = "[golden]\nmax = 2\nmean = 0.05\n";
    let copy = "cp golden.png $0; : {kind}";
    assert_eq!(shell(copy, GOLDEN).failure(), None);
    assert!(shell(copy, LIT).message.unwrap().contains("a shade must be gray"));
    assert!(shell(copy, LIT).files.actual.unwrap().is_file(), "the wrong picture can be seen");
    let folder = Folder::with_golden(&["image.size=[192, 191]"]);
    let small = outcome(&folder, "size", &format!("render = [\"cp\", \"golden.png\", \"{{out}}\"]\n{GOLDEN}"));
    assert!(small.message.as_ref().unwrap().contains("it is 192x191, and the scene's 192x192"), "{small:?}");
    let folder = Folder::new();
    let mut white = draw(&[]);
    white.data.fill(1.0);
    white.write_png(&folder.path("white.png")).unwrap();
    let render = "render = [\"cp\", \"white.png\", \"{out}\"]\n";
    assert_eq!(outcome(&folder, "white", &format!("{render}{LIT}")).failure(), None);
    let shadowed = "[[pick]]\nat = [0.8, 0, -0.4]\nclass = \"shadowed\"\n";
    assert!(outcome(&folder, "white", &format!("{render}{shadowed}")).message.unwrap().contains("is Lit"));
    for check in ["[[cone]]\ntowards = [0, 0, 1]\n", "[[count]]\nclass = \"lit\"\nmost = 0.9\n"] {
        let fails = outcome(&folder, "opaque", &format!("{render}{check}"));
        assert!(fails.message.as_ref().unwrap().contains("the command's shade is opaque"), "{fails:?}");
    }
}

#[cfg(not(unix))]
fn a_commands_picture_is_checked() {}

fn checks_of_glumbras_own_plan_are_refused_beside_a_command() {
    let refused = |toml: &str, text: &str| {
        let folder = Folder::new();
        fs::write(folder.path("case.toml"), format!("asks = \"\"\n{toml}")).unwrap();
        let error = PixelCase::read(&folder.path(""), "refused").unwrap_err().to_string();
        assert!(error.contains(text), "{toml}: {error}");
    };
    let with = |checks: &str| format!("render = [\"engine\", \"{{scene}}\", \"{{out}}\"]\n{checks}");
    let relation = "[[same]]\nof = [\"shade\"]\nsets = [[\"light.shadow.size=128\"]]\nexact = true\nwhy = \"\"\n";
    for (key, checks) in [
        ("warns", "warns = \"x\"\n".to_owned()),
        ("leaves_out", "leaves_out = \"x\"\n".to_owned()),
        ("fails_with", "fails_with = \"x\"\n".to_owned()),
        ("set", format!("set = [\"light.far=3\"]\n{LIT}why = \"\"\n")),
        ("for_each", format!("for_each = [[\"light.far=3\"]]\n{LIT}why = \"\"\n")),
        ("same", relation.to_owned()),
        ("after", "[[after]]\nof = [\"shade\"]\nfirsts = [[]]\nwhy = \"\"\n".to_owned()),
        ("sum", "[[sum]]\nplus = [[]]\nmax = 1e-7\nwhy = \"\"\n".to_owned()),
    ] {
        refused(&with(&checks), &format!("`{key}` cannot stand beside `render`"));
    }
    refused(
        &with(&format!("{LIT}set = [\"light.far=3\"]\nwhy = \"\"\n")),
        "case.toml:3: `set` and `for_each` cannot stand",
    );
    let technique = "[[truth]]\nbound = \"technique\"\nwhy = \"\"\n";
    refused(&with(technique), "case.toml:3: `bound = \"technique\"` is glumbra's own technique");
    refused(&format!("render = []\n{LIT}why = \"\"\n"), "case.toml:2: `render` names no program");
    refused(&format!("render = [\"e\"]\n{LIT}why = \"\"\n"), "`render` has no {out}");
    refused(
        &format!("render = [\"e\", \"{{out}}\", \"{{size}}\"]\n{LIT}why = \"\"\n"),
        "{size}, which stands for nothing",
    );
    let both = format!("{LIT}why = \"\"\n[[pick]]\nat = [0, 1, 0]\ncolor = [0, 0, 0]\nwhy = \"\"\n");
    refused(&with(&both), "`render` has no {kind}");
}
