//! Waivers of this driver and of others, needed and not.

use super::*;
use crate::context::Limits;
use crate::oracle::semantics::Finding;

fn context(renderer: &str) -> ContextInfo {
    let limits = Limits {
        texture_size: 0,
        cube_map_size: 0,
        array_layers: 0,
        texture_units: 0,
        renderbuffer_size: 0,
        viewport: [0; 2],
        color_attachments: 0,
        draw_buffers: 0,
        samples: 0,
        subpixel_bits: 8,
        anisotropy: 1.0,
        clip_distances: 0,
        vertex_attributes: 0,
        vertex_uniforms: 0,
        fragment_uniforms: 0,
        uniform_block_bytes: 0,
    };
    ContextInfo {
        road: String::new(),
        vendor: String::new(),
        renderer: renderer.to_owned(),
        version: "4.5 Mesa 22.3.6".to_owned(),
        shading_language: String::new(),
        profile: "core",
        khr_debug: false,
        debug_output: false,
        timer_bits: 0,
        limits,
    }
}

/// O1 with one finding.
fn outcome(what: &str, verdict: Verdict, measured: &str) -> Outcome {
    let findings = vec![Finding { what: what.to_owned(), verdict, measured: measured.to_owned() }];
    Outcome {
        id: "O1",
        title: "",
        section: "",
        says: "",
        tolerance: "",
        verdict,
        findings,
        facts: Vec::new(),
        seconds: 0.0,
    }
}

fn waiver(message: &str) -> Vec<Waiver> {
    let [renderer, version, rule, reason] = ["llvmpipe", "Mesa 22.3.6", "O1", "known"].map(str::to_owned);
    vec![Waiver { renderer, version, rule, message: message.to_owned(), reason }]
}

#[test]
fn a_failure_is_waived_by_its_exact_words_alone() {
    for (message, verdict, stale) in
        [("r: is 4", Verdict::Waived, 0), ("r: is 3", Verdict::Fail, 1), ("r", Verdict::Fail, 1)]
    {
        let mut outcomes = [outcome("r", Verdict::Fail, "is 4")];
        assert_eq!(apply(&waiver(message), &context("llvmpipe (LLVM)"), &mut outcomes).len(), stale, "{message}");
        assert_eq!(outcomes[0].verdict, verdict, "{message}");
    }
}

#[test]
fn a_waiver_that_nothing_needs_is_stale() {
    let mut outcomes = [outcome("r", Verdict::Pass, "is 4")];
    let stale = apply(&waiver("r: is 4"), &context("llvmpipe"), &mut outcomes);
    assert!(stale[0].contains("the waiver of O1 for llvmpipe Mesa 22.3.6 no longer applies"), "{stale:?}");
}

#[test]
fn waivers_of_other_drivers_rules_and_what_cannot_be_asked_are_left_alone() {
    let waivers = waiver("r: is 4");
    let mut outcomes = [outcome("r", Verdict::Fail, "is 4")];
    assert!(apply(&waivers, &context("softpipe"), &mut outcomes).is_empty());
    assert_eq!(outcomes[0].verdict, Verdict::Fail);
    assert!(apply(&waivers, &context("llvmpipe"), &mut []).is_empty());
    let mut outcomes = [outcome("r", Verdict::Untestable, "a core context")];
    assert!(apply(&waivers, &context("llvmpipe"), &mut outcomes).is_empty());
}

#[test]
fn files_are_read_with_their_lines() {
    let path = Path::new("w.toml");
    assert!(!parse(path, SHIPPED).unwrap().is_empty());
    assert!(parse(path, "").unwrap().is_empty());
    let text = "[[waiver]]\nrenderer = \"a\"\nversion = \"b\"\nrule = \"O1\"\nmessage = \"c\"\nreason = \"d\"\n";
    assert_eq!(parse(path, text).unwrap().len(), 1);
    for (text, error) in [
        (format!("{text}typo = 1\n"), "w.toml:7: unknown field `typo`"),
        (text.replace("O1", "O9"), "w.toml: there is no rule O9"),
        (text.replace("reason", "raison"), "w.toml:6: unknown field `raison`"),
        ("[[waiver]]\nrule = \n".to_owned(), "w.toml:2: "),
    ] {
        let got = parse(path, &text).unwrap_err().to_string();
        assert!(got.starts_with(error), "{got}");
    }
}
