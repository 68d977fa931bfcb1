//! `glumbra check`: on a sound driver no rule fails, each mistake that a test makes the bench commit turns the rules red
//! that are about it, and the command's files, waivers and exit codes are what they say.

#[cfg(unix)]
mod broken_drivers;
#[cfg(unix)]
mod reduce;
mod runs;

use std::path::Path;
use std::process::{Command, Output};

use assert_cmd::cargo::CommandCargoExt;
use glumbra::conformance::bench::{GlFormat, Mutation};
use glumbra::conformance::verify::cube;
use glumbra::conformance::{self, DriverUnderTest, RuleOutcome, RuleVerdict, probe, waivers};
use glumbra::context::{self, ContextRequest, Profile};
use glumbra::geometry::normal_cube;

/// These rules, or all if none is named, on the default context of a profile, with one mistake or none; known deviations
/// waived.
fn outcomes(profile: Profile, mutation: Option<Mutation>, rules: &[&str]) -> Vec<RuleOutcome> {
    let context = context::open(&ContextRequest { profile, ..ContextRequest::default() }).unwrap();
    let subject = DriverUnderTest::new(&context, mutation).unwrap();
    let patterns: Vec<_> = rules.iter().map(|id| (*id).to_owned()).collect();
    let mut outcomes = conformance::run(&subject, &conformance::choose(&patterns).unwrap(), |_| {});
    waivers::apply(&waivers::load(None).unwrap(), &subject.info, &mut outcomes);
    outcomes
}

fn with(outcomes: &[RuleOutcome], verdict: RuleVerdict) -> Vec<&'static str> {
    outcomes.iter().filter(|outcome| outcome.verdict == verdict).map(|outcome| outcome.id).collect()
}

/// The end of a C library that is loaded before libEGL: its `driver` becomes EGL's own eglGetProcAddress, and its `lookup` is found in
/// that one's place.
const FOUND_BY_DLSYM: &str = r#"
void *dlsym(void *handle, const char *name) {
    static void *(*real)(void *, const char *);
    if (!real) {
        const char *versions[] = {"GLIBC_2.34", "GLIBC_2.17", "GLIBC_2.2.5"};
        for (int i = 0; i < 3 && !real; i++) *(void **)&real = dlvsym(RTLD_NEXT, "dlsym", versions[i]);
    }
    void *found = real(handle, name);
    if (strcmp(name, "eglGetProcAddress") || !found) return found;
    driver = (Lookup)found;
    return (void *)lookup;
}
"#;

/// README and CHANGELOG say how many rules and faults there are.
#[test]
fn pages_count_what_there_is() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = |path: &str| std::fs::read_to_string(root.join(path)).unwrap();
    let rules = format!("{} rules", conformance::TABLE.len());
    let (readme, changelog) = (page("README.md"), page(".github/CHANGELOG.md"));
    assert_eq!(readme.matches(&rules).count(), 2, "README.md: {rules}, in the sentence and in what is printed");
    assert!(changelog.contains(&format!("`check`: {rules}")), "CHANGELOG.md: {rules}");
    let faults = format!("- {} drivers that are broken on purpose", conformance::faults::all().count());
    assert!(changelog.contains(&faults), "CHANGELOG.md: {faults}");
}

#[test]
fn without_a_mistake_no_rule_fails() {
    for (profile, untestable) in [
        (Profile::Compatibility, vec![]),
        (
            Profile::Core33,
            vec![
                "GL-C6", "GL-C12", "GL-T1", "GL-T6", "GL-F12", "GL-E1", "GL-E2", "GL-E3", "GL-E4", "GL-V2", "GL-K8",
                "GL-K13", "GL-X6",
            ],
        ),
    ] {
        let outcomes = outcomes(profile, None, &[]);
        let failing: Vec<_> = outcomes
            .iter()
            .flat_map(|outcome| &outcome.findings)
            .filter(|finding| finding.verdict == RuleVerdict::Fail)
            .map(|finding| finding.message())
            .collect();
        assert!(failing.is_empty(), "{profile:?}: {failing:#?}");
        assert_eq!(with(&outcomes, RuleVerdict::Untestable), untestable, "{profile:?}");
        assert!(outcomes.iter().all(|outcome| !outcome.findings.is_empty()));
    }
}

/// Each mistake, and the rules that are about it. Where a unit of polygon offset is one code, GL-O2 cannot tell one unit less
/// from a rounded code.
const MUTATIONS: [(Mutation, &[&str]); 25] = [
    (Mutation::CompareSwapped, &["GL-C1", "GL-C2", "GL-C8", "GL-C11"]),
    (Mutation::IncrementForIncrementWrap, &["GL-S1", "GL-S3"]),
    (Mutation::OneOffsetUnitLess, &["GL-O1", "GL-O2"]),
    (Mutation::OffsetClampIgnored, &["GL-O1"]),
    (Mutation::PlanesTransposed, &["GL-T1", "GL-T6", "GL-T7"]),
    (Mutation::PlanesUnderWrongModelview, &["GL-T1", "GL-T6", "GL-T7"]),
    (
        Mutation::FilterThenCompare,
        &[
            "GL-C2", "GL-C3", "GL-C4", "GL-C5", "GL-C6", "GL-C7", "GL-C8", "GL-C9", "GL-C10", "GL-C11", "GL-C13",
            "GL-T1", "GL-T2", "GL-T5",
        ],
    ),
    (Mutation::FrontAndBackSwapped, &["GL-O2", "GL-S2"]),
    (
        Mutation::DepthRangeReversed,
        &["GL-T3", "GL-T4", "GL-D2", "GL-D3", "GL-D5", "GL-O1", "GL-S3", "GL-F6", "GL-F10", "GL-F11"],
    ),
    (Mutation::DepthClampIgnored, &["GL-D3"]),
    (Mutation::StencilMaskIgnored, &["GL-S1"]),
    (Mutation::CopyShifted, &["GL-F1", "GL-F7"]),
    (Mutation::ClipPlanesIgnored, &["GL-R2"]),
    (Mutation::BlendIgnored, &["GL-F4", "GL-F5", "GL-F13"]),
    (Mutation::StoredAlphaAsOne, &["GL-F5"]),
    (Mutation::AlphaBlendedAsRgb, &["GL-F5"]),
    (Mutation::CubeFacesSwapped, &["GL-M1", "GL-M2", "GL-M3"]),
    (Mutation::CubeFaceTransposed, &["GL-M1", "GL-M2", "GL-M3"]),
    (Mutation::SeamlessIgnored, &["GL-C9", "GL-M2", "GL-M3"]),
    (Mutation::Dot3WithoutFour, &["GL-E2", "GL-M3"]),
    (Mutation::Dot3AsModulate, &["GL-E2", "GL-M3"]),
    (Mutation::AddSignedAsAdd, &["GL-E1"]),
    (Mutation::CrossbarIgnored, &["GL-E3"]),
    (Mutation::CombineScaleIgnored, &["GL-E1", "GL-E2"]),
    (Mutation::ComplementIgnored, &["GL-E1", "GL-E2", "GL-E3"]),
];

#[test]
fn every_mistake_turns_its_rules_red() {
    assert_eq!(MUTATIONS.map(|(mutation, _)| mutation), Mutation::ALL);
    let context = context::open(&ContextRequest { profile: Profile::Compatibility, ..Default::default() }).unwrap();
    let facts = probe::depth_format(context.gl(), GlFormat::Depth24).unwrap();
    let unit_is_a_code = facts.measured.is_some_and(|measured| measured.units[0].codes < 1.5);
    drop(context);
    let wrong: Vec<String> = MUTATIONS
        .iter()
        .map(|(mutation, due)| (mutation, due.to_vec(), outcomes(Profile::Compatibility, Some(*mutation), due)))
        .map(|(mutation, due, outcomes)| (mutation, due, with(&outcomes, RuleVerdict::Fail)))
        .map(|(mutation, mut due, mut red)| {
            let untold = unit_is_a_code && *mutation == Mutation::OneOffsetUnitLess;
            for rules in [&mut due, &mut red] {
                rules.retain(|id| !(untold && *id == "GL-O2"));
            }
            (mutation, due, red)
        })
        .filter(|(_, due, red)| !due.iter().all(|id| red.contains(id)))
        .map(|(mutation, due, red)| format!("{mutation:?} turns {red:?} red, and {due:?} is due"))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The checker's own cube map and the renderer's: the same vector through the middle of each texel.
#[test]
fn cube_maps_of_checker_and_renderer_agree() {
    for index in 0..6 {
        for (texel, vector) in normal_cube::face(index, 4).enumerate() {
            let place = [texel % 4, texel / 4].map(|at| (at as f64 + 0.5) / 4.0);
            assert_eq!(cube::faces(vector.to_array()).collect::<Vec<_>>(), [index]);
            let found = cube::on_face(index, vector.to_array());
            assert!((0..2).all(|axis| (found[axis] - place[axis]).abs() < 1e-12), "{index} {place:?} {found:?}");
        }
    }
}

fn check(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("glumbra").unwrap().current_dir(folder).arg("check").args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Text whose lines are joined: the screen wraps them.
fn words(bytes: &[u8]) -> String {
    text(bytes).split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_run_is_printed_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let output = check(
        folder.path(),
        &["--verbose", "--filter", "GL-C1", "--filter", "o1", "--json", "c.json", "--junit", "c.xml"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    for part in ["GL-C1 compare", "8 functions", "tolerance", "r, one unit of polygon offset", "2 rules, "] {
        assert!(table.contains(part), "no `{part}` in {table}");
    }
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let json: serde_json::Value = serde_json::from_str(&read("c.json")).unwrap();
    let ids: Vec<_> = json["outcomes"].as_array().unwrap().iter().map(|outcome| outcome["id"].clone()).collect();
    assert_eq!(ids, ["GL-C1", "GL-O1"]);
    assert!(json["context"]["renderer"].is_string());
    let xml = read("c.xml");
    let findings = |outcome: &serde_json::Value| outcome["findings"].as_array().unwrap().len();
    let cases: usize = json["outcomes"].as_array().unwrap().iter().map(findings).sum();
    assert_eq!(xml.matches("<testcase ").count(), cases);
    for part in ["<testsuite ", "failures=\"0\"", "name=\"GL-C1 compare function\"", "<property name=\"GL_RENDERER\""] {
        assert!(xml.contains(part), "no `{part}` in {xml}");
    }
}

#[test]
fn a_run_that_tests_nothing_ends_with_2() {
    let folder = tempfile::tempdir().unwrap();
    let output = check(folder.path(), &["--core", "--filter", "GL-C6"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(words(&output.stdout).contains("core profile"), "{}", text(&output.stdout));
    let cases: [(&[&str], &str); 5] = [
        (&["--filter", "C99"], "no rule is called `C99`: did you mean GL-C9"),
        (&["--filter", ""], "no rule is called ``"),
        (&["--waivers", "none.toml"], "none.toml: "),
        (&["--filter", "GL-C1", "--json", "/dev/null/c.json"], "/dev/null/c.json: cannot be written: "),
        (&["--context", "window"], "no OpenGL context can be had"),
    ];
    for (arguments, error) in cases {
        let mut command = Command::cargo_bin("glumbra").unwrap();
        let output = command
            .current_dir(folder.path())
            .arg("check")
            .args(arguments)
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let said = text(&output.stderr);
        assert!(said.contains(&format!("error: {error}")), "{arguments:?}: {said}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// A waiver of this driver that nothing needs, and on llvmpipe a known deviation without its waiver.
#[test]
fn waivers_decide_the_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let stale =
        "[[waiver]]\nrenderer = \"\"\nversion = \"\"\nrule = \"GL-C1\"\nfinding = \"no such\"\nreason = \"none\"\n";
    std::fs::write(folder.path().join("stale.toml"), stale).unwrap();
    std::fs::write(folder.path().join("empty.toml"), "").unwrap();
    let output = check(folder.path(), &["--filter", "GL-C1", "--waivers", "stale.toml", "--junit", "c.xml"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(words(&output.stdout).contains("no longer applies"), "{}", text(&output.stdout));
    assert!(std::fs::read_to_string(folder.path().join("c.xml")).unwrap().contains("failures=\"1\""));
    // The rule that it names is not run: nothing can be said of it.
    let output = check(folder.path(), &["--filter", "GL-S2", "--waivers", "stale.toml"]);
    assert_eq!(output.status.code(), Some(0));
    let output = check(folder.path(), &["--filter", "GL-O1", "--waivers", "empty.toml"]);
    let said = words(&output.stdout);
    if said.contains("llvmpipe") {
        assert_eq!(output.status.code(), Some(1));
        assert!(said.contains("FAIL: DEPTH_COMPONENT32: one"), "{said}");
    }
}
