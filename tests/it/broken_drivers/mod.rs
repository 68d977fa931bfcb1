//! Drivers that are broken on purpose: each fault turns a rule of `glumbra check` red, and everything of GL that the
//! renderer uses has a fault, or a reason why none could be seen.

mod reading;
mod uses;

#[path = "../../faults/judge.rs"]
mod judge;
#[path = "../../faults/shown.rs"]
mod shown;

use std::collections::BTreeSet;

use glumbra::conformance::faults::{self, Fault};
use judge::Row;

/// Functions, enums and words that have no fault, each group with its reason.
#[rustfmt::skip]
const CANNOT_BE_CAUGHT: &[(&str, &[&str])] = &[
    ("makes or deletes names, which are the driver's to choose", &[
        "glcreatebuffer", "glcreateframebuffer", "glcreateprogram", "glcreatequery", "glcreaterenderbuffer", "glcreatesampler",
        "glcreateshader", "glcreatetexture", "glcreatevertexarray", "gldeletebuffer", "gldeleteframebuffer", "gldeleteprogram",
        "gldeletequery", "gldeleterenderbuffer", "gldeletesampler", "gldeleteshader", "gldeletetexture", "gldeletevertexarray",
    ]),
    ("tells an error or a log: without it nothing is drawn otherwise", &[
        "glgeterror", "glgetprograminfolog", "glgetprogramlinkstatus", "glgetshaderinfolog", "glgetshadercompilestatus",
        "GL_NO_ERROR", "GL_FRAMEBUFFER_COMPLETE", "GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT", "GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER",
    ]),
    ("compiles: where it does nothing, nothing can be drawn, and a fault of what it makes is one of GLSL's", &[
        "glattachshader", "glcompileshader", "gldetachshader", "gllinkprogram", "glshadersource", "GL_FRAGMENT_SHADER", "GL_VERTEX_SHADER",
    ]),
    ("tells names and places of uniforms: a wrong one is an error of the device's, or a uniform of another's value", &[
        "glgetactiveuniform", "glgetactiveuniforms", "glgetuniformlocation",
    ]),
    ("tells a limit: a smaller one refuses a plan, and draws none otherwise", &[
        "glgetintegerv", "GL_MAX_LIGHTS", "GL_MAX_RENDERBUFFER_SIZE", "GL_MAX_TEXTURE_IMAGE_UNITS", "GL_MAX_TEXTURE_SIZE",
        "GL_MAX_TEXTURE_UNITS", "GL_MAX_VIEWPORT_DIMS",
    ]),
    ("reads the product of two matrices back, for a test of the arithmetic alone", &["glgetfloatv"]),
    ("dithers: no driver at hand does, with eight bits a channel", &["GL_DITHER"]),
    ("says when to compute as written: a driver may not take it wrongly where its optimiser does nothing", &["precise"]),
];

#[test]
fn everything_that_is_used_has_a_fault_or_a_reason() {
    let broken: BTreeSet<&str> = faults::all().flat_map(|fault| fault.breaks.iter().copied()).collect();
    let functions: BTreeSet<String> = broken.iter().map(|name| name.to_ascii_lowercase()).collect();
    let excused: BTreeSet<&str> = CANNOT_BE_CAUGHT.iter().flat_map(|(_, names)| names.iter().copied()).collect();
    let (used, enums) = uses::of_gl();
    let words = uses::of_glsl();
    assert!(
        used.len() > 80 && enums.len() > 120 && words.len() >= 40,
        "{} {} {}",
        used.len(),
        enums.len(),
        words.len()
    );
    let without: Vec<_> = used
        .iter()
        .filter(|name| !functions.contains(*name))
        .chain(enums.iter().chain(&words).filter(|name| !broken.contains(name.as_str())))
        .filter(|name| !excused.contains(name.as_str()))
        .collect();
    assert!(without.is_empty(), "used, and no fault breaks it: {without:#?}");
    let both: Vec<_> = excused
        .iter()
        .filter(|name| {
            broken.contains(**name) || !(used.contains(**name) || enums.contains(**name) || words.contains(**name))
        })
        .filter(|name| **name != "precise")
        .collect();
    assert!(both.is_empty(), "excused, and broken all the same or not used: {both:#?}");
}

#[test]
fn names_are_single_and_functions_have_wrappers() {
    let names: Vec<_> = faults::all().map(|fault| fault.name).collect();
    let single: BTreeSet<_> = names.iter().collect();
    assert_eq!(single.len(), names.len());
    for fault in faults::all() {
        assert!(fault.says.ends_with('.') && !fault.breaks.is_empty(), "{}", fault.name);
        let unknown: Vec<_> = fault.changes().filter(|name| !faults::functions().contains(name)).collect();
        assert!(unknown.is_empty(), "{}: no wrapper for {unknown:?}", fault.name);
    }
}

/// The page's table has every fault and no other; where no rule sees one, the reason stands with the fault.
#[test]
fn the_table_has_every_fault() {
    let rows = table();
    let rows: BTreeSet<_> = rows.iter().map(|row| row.fault.as_str()).collect();
    let names: BTreeSet<_> = faults::all().map(|fault| fault.name).collect();
    let differ: Vec<_> = rows.symmetric_difference(&names).collect();
    assert!(differ.is_empty(), "only in {} or only in src/conformance/faults: {differ:#?}\n{HOW}", judge::PAGE);
}

const HOW: &str = "cargo run --release --example faults -- --pictures --write NAME... writes the table";

fn table() -> Vec<Row> {
    let page = std::fs::read_to_string(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(judge::PAGE)).unwrap();
    judge::rows(&page)
}

/// At least one rule fails of those that the table has for each fault, the quickest tried first; a fault with a reason why none does has
/// none there.
#[test]
fn every_fault_turns_a_rule_red() {
    let quickest = judge::quickest();
    let rows = table();
    let faults: Vec<&'static Fault> = faults::all().collect();
    let wrong = judge::each(&faults, |fault| {
        let due = rows.iter().find(|row| row.fault == fault.name).map(|row| row.red.clone()).unwrap_or_default();
        let rules: Vec<_> = quickest.iter().copied().filter(|rule| due.iter().any(|id| id == rule.id)).collect();
        match (fault.hole, rules.is_empty()) {
            (_, true) => None,
            (Some(reason), false) => Some(format!("{}: {due:?} see it, and {reason:?} is said", fault.name)),
            (None, false) if judge::red(Some(fault), &rules, true).is_empty() => {
                Some(format!("{}: none of {due:?} fails", fault.name))
            }
            (None, false) => None,
        }
    });
    let wrong: Vec<_> = wrong.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{wrong:#?}\n{HOW}");
}

/// Each fault of the tenth measure changes a picture of the product, by the share of its pixels that stands with it.
#[test]
fn faults_that_are_shown_change_pictures() {
    let scenes = judge::sound_of(&shown::scenes());
    let names: BTreeSet<_> = shown::SHOWN.iter().map(|(name, _, _)| *name).collect();
    let faults: Vec<&'static Fault> = faults::all().filter(|fault| names.contains(fault.name)).collect();
    assert!(faults.len() == names.len() && names.len() >= 34, "{} of {} names", faults.len(), names.len());
    let wrong: Vec<_> = judge::each(&faults, |fault| shown::wrong(fault, &scenes)).into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A fault that no rule sees has a reason.
#[test]
fn no_hole_is_open() {
    let rows = table();
    let is_seen = |fault: &&Fault| rows.iter().any(|row| row.fault == fault.name && !row.red.is_empty());
    let open: Vec<_> =
        faults::all().filter(|fault| fault.hole.is_none() && !is_seen(fault)).map(|fault| fault.name).collect();
    assert!(open.is_empty(), "{} faults that no rule sees: {open:#?}\n{HOW}", open.len());
}
