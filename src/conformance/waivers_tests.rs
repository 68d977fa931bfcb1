//! Waivers of this driver and of others, needed and not.

use super::*;
use crate::conformance::Finding;
use crate::context::ContextLimits;

fn context(renderer: &str) -> ContextInfo {
    let limits = ContextLimits {
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
        backend: String::new(),
        vendor: String::new(),
        renderer: renderer.to_owned(),
        version: "4.5 Mesa 22.3.6".to_owned(),
        shading_language: String::new(),
        profile: "core".to_owned(),
        khr_debug: false,
        debug_output: false,
        timer_bits: 0,
        limits,
    }
}

/// GL-O1 with one finding.
fn outcome(what: &str, verdict: RuleVerdict, measured: &str) -> RuleOutcome {
    let findings = vec![Finding {
        what: what.to_owned(),
        verdict,
        measured: measured.to_owned(),
        waiver: None,
        first_wrong: None,
    }];
    RuleOutcome {
        id: "GL-O1",
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

fn waiver(finding: &str) -> Vec<Waiver> {
    let [renderer, version, rule, reason] = ["llvmpipe", "Mesa ", "GL-O1", "known"].map(str::to_owned);
    let [from, until] = ["22.3", "25.1"].map(|number| Number::try_from(number.to_owned()).ok());
    vec![Waiver { renderer, version, from, until, rule, finding: Some(finding.to_owned()), on: None, reason }]
}

#[test]
fn a_failure_is_waived_by_what_was_checked_whatever_was_measured() {
    for (finding, measured, verdict, stale) in [
        ("r", "is 4", RuleVerdict::Waived, 0),
        ("r", "is 4.1", RuleVerdict::Waived, 0),
        ("r of lines", "is 4", RuleVerdict::Fail, 1),
    ] {
        let mut outcomes = [outcome("r", RuleVerdict::Fail, measured)];
        assert_eq!(apply(&waiver(finding), &context("llvmpipe (LLVM)"), &mut outcomes).len(), stale, "{finding}");
        assert_eq!(outcomes[0].verdict, verdict, "{finding}");
    }
}

#[test]
fn a_waiver_holds_for_a_range_of_versions() {
    for (version, verdict) in [
        ("4.5 Mesa 22.2.9", RuleVerdict::Fail),
        ("4.5 Mesa 22.3.0", RuleVerdict::Waived),
        ("4.5 (Compatibility Profile) Mesa 25.0.7-2+deb13u1", RuleVerdict::Waived),
        ("4.5 Mesa 25.1.0-devel (git-0123abc)", RuleVerdict::Fail),
        ("4.6 Mesa 100.0", RuleVerdict::Fail),
        ("4.6 Mesa git", RuleVerdict::Fail),
        ("4.6.0 NVIDIA 25.0", RuleVerdict::Fail),
    ] {
        let mut outcomes = [outcome("r", RuleVerdict::Fail, "is 4")];
        let here = ContextInfo { version: version.to_owned(), ..context("llvmpipe") };
        assert!(apply(&waiver("r"), &here, &mut outcomes).is_empty(), "{version}");
        assert_eq!(outcomes[0].verdict, verdict, "{version}");
    }
}

#[test]
fn a_waiver_that_nothing_needs_is_stale() {
    let mut outcomes = [outcome("r", RuleVerdict::Pass, "is 4")];
    let stale = apply(&waiver("r"), &context("llvmpipe"), &mut outcomes);
    assert!(stale[0].contains("a waiver of GL-O1 no longer applies to llvmpipe 4.5 Mesa 22.3.6"), "{stale:?}");
    let mut of_some = waiver("r");
    of_some[0].on = Some(String::from("CPUs with AVX2"));
    assert!(apply(&of_some, &context("llvmpipe"), &mut outcomes).is_empty());
}

#[test]
fn waivers_of_other_drivers_rules_and_what_cannot_be_asked_are_left_alone() {
    let waivers = waiver("r");
    let mut outcomes = [outcome("r", RuleVerdict::Fail, "is 4")];
    for other in ["softpipe", "zink Vulkan 1.4(llvmpipe (LLVM 19.1.7, 256 bits) (MESA_LLVMPIPE))"] {
        assert!(apply(&waivers, &context(other), &mut outcomes).is_empty(), "{other}");
        assert_eq!(outcomes[0].verdict, RuleVerdict::Fail, "{other}");
    }
    assert!(apply(&waivers, &context("llvmpipe"), &mut []).is_empty());
    let mut outcomes = [outcome("r", RuleVerdict::Untestable, "a core context")];
    assert!(apply(&waivers, &context("llvmpipe"), &mut outcomes).is_empty());
}

#[test]
fn files_are_read_with_their_lines() {
    let path = Path::new("w.toml");
    assert!(!parse(path, SHIPPED).unwrap().is_empty());
    assert!(parse(path, "").unwrap().is_empty());
    let text = "[[waiver]]\nrenderer = \"a\"\nversion = \"b\"\nrule = \"GL-O1\"\nfinding = \"c\"\nreason = \"d\"\n";
    assert_eq!(parse(path, text).unwrap().len(), 1);
    for (text, error) in [
        (format!("{text}typo = 1\n"), "w.toml:7: unknown field `typo`"),
        (text.replace("GL-O1", "GL-O9"), "w.toml: there is no rule GL-O9"),
        (text.replace("reason", "raison"), "w.toml:6: unknown field `raison`"),
        (text.replace("rule", "from = \"22.x\"\nrule"), "w.toml:4: \"22.x\" is no version"),
        ("[[waiver]]\nrule = \n".to_owned(), "w.toml:2: "),
    ] {
        let got = parse(path, &text).unwrap_err().to_string();
        assert!(got.starts_with(error), "{got}");
    }
}
