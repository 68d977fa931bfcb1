//! Case files that are refused, because a check in them could not fail or would not be made; and what `for_each` repeats.

use std::fs;

use glumbra::cases::PixelCase;

use crate::comparator::{Folder, fails, tests};

pub const TESTS: &[(&str, fn())] = tests![
    an_empty_case_is_refused,
    an_unknown_key_is_refused,
    a_count_of_anything_is_refused,
    a_check_beside_fails_with_is_refused,
    tolerances_that_let_any_picture_pass_are_refused,
    a_picture_is_not_compared_with_itself,
    for_each_repeats_a_check_and_its_error_names_the_set,
    for_each_repeats_a_case_and_its_error_names_the_set,
    sets_of_for_each_come_before_the_checks_own,
    for_each_without_a_set_is_refused,
    a_golden_of_several_pictures_is_refused,
];

fn refused(title: &str, toml: &str, text: &str) {
    fails(Folder::new().run(title, &[], toml), text);
}

fn an_empty_case_is_refused() {
    refused("empty", "", "the case has no checks");
    refused("empty-pick", "[[pick]]\nat = [0, 0, 0]\nwhy = \"\"\n", "a pick expects nothing");
    let nothing = "[[same]]\nof = [\"shade\"]\nsets = []\nexact = true\nwhy = \"\"\n";
    refused("empty-same", nothing, "compares nothing");
    refused("empty-sum", "[[sum]]\nplus = []\nmax = 1e-7\nwhy = \"\"\n", "adds nothing");
    refused("empty-after", "[[after]]\nof = [\"shade\"]\nfirsts = []\nwhy = \"\"\n", "compares nothing");
}

fn an_unknown_key_is_refused() {
    let folder = Folder::new();
    fs::write(folder.path("case.toml"), "asks = \"\"\npicks = []\n").unwrap();
    assert!(
        PixelCase::read(&folder.path(""), "unknown")
            .unwrap_err()
            .to_string()
            .contains("case.toml:2: unknown field `picks`")
    );
}

const LIT: &str = "[[pick]]\nat = [0.0, 1.0, 0.0]\nclass = \"lit\"\nwhy = \"the box's top\"\n";

fn a_count_of_anything_is_refused() {
    let counts = ["", "least = 0.0\n", "least = 0.0\nmost = 1.0\n"];
    for count in counts.map(|limits| format!("[[count]]\nclass = \"lit\"\n{limits}why = \"any share\"\n")) {
        refused("any-count", &count, "the case has no checks");
        refused(
            "any-count-too",
            &format!("{LIT}{count}"),
            "a count needs `least` above 0 or `most` below 1 (any share)",
        );
    }
}

fn a_check_beside_fails_with_is_refused() {
    let folder = Folder::new();
    let run = |others: &str| {
        let toml = format!("fails_with = \"must be\"\n{others}");
        folder.run("beside", &["light.cone=0"], &toml)
    };
    run("").unwrap();
    let count = "[[count]]\nclass = \"lit\"\nwhy = \"\"\n";
    for others in ["warns = \"x\"\n", "leaves_out = \"x\"\n", LIT, count, "[golden]\nmax = 2\nmean = 1\nwhy = \"\"\n"] {
        fails(run(others), "no check can stand beside `fails_with`");
    }
}

fn tolerances_that_let_any_picture_pass_are_refused() {
    let same = |max: f64, share: f64| {
        let sets = "sets = [[\"light.color=[0, 0, 0]\"]]";
        format!("[[same]]\nof = [\"picture\"]\n{sets}\nmax = {max:?}\nshare = {share:?}\nwhy = \"no light\"\n")
    };
    refused("any-same", &same(1.0, 1.0), "either max is at most 4/255, or share at most 0.05 (no light)");
    refused("most-same", &same(0.5, 0.06), "either max is at most");
    // The widest that are allowed find that there is no light.
    refused("some-same", &same(0.015, 1.0), "pixels");
    refused("few-same", &same(1.0, 0.05), "pixels");
    refused("any-sum", "[[sum]]\nplus = [[]]\nmax = 1.0\nwhy = \"\"\n", "a sum may be 1 off");
    refused("any-golden", "[golden]\nmax = 255\nmean = 1\nwhy = \"\"\n", "a golden may be 255/255 off");
    let pick = "[[pick]]\nat = [0, 0, 0]\ncolor = [0, 0, 0]\nwithin = 255\nwhy = \"\"\n";
    refused("any-pick", pick, "a pick within 255 cannot fail");
}

fn a_picture_is_not_compared_with_itself() {
    let same = |with: &str| {
        let sets = "sets = [[\"light.shadow.size=64\"], [\"light.far=30\"]]";
        format!("[[same]]\nof = [\"shade\"]\n{with}\n{sets}\nframes = 5\nexact = true\nwhy = \"kept\"\n")
    };
    refused("itself", &same("with = [\"light.far=30\"]"), "`same` compares [\"light.far=30\"] with itself (kept)");
}

const NONE: &str = "light.shadow.technique=none";

fn for_each_repeats_a_check_and_its_error_names_the_set() {
    let shadowed = |sets: &str| {
        format!("[[pick]]\nat = [0.8, 0, -0.4]\nfor_each = {sets}\nclass = \"shadowed\"\nwhy = \"behind the box\"\n")
    };
    Folder::new().run("each", &[], &shadowed("[[], [\"light.shadow.size=128\"]]")).unwrap();
    let error = fails(
        Folder::new().run("each-wrong", &[], &shadowed(&format!("[[], [\"light.shadow.size=128\"], [\"{NONE}\"]]"))),
        &format!("for_each [\"{NONE}\"]: pixel"),
    );
    assert!(error.contains("behind the box"), "{error}");
    for check in [
        "[[edge]]\ncaster = [0.5, 1, 0]\noutward = [1, 0, 0]\n",
        "[[count]]\nclass = \"shadowed\"\nleast = 0.01\n",
        "[[cone]]\ntowards = [0, 0, 1]\n",
        "[[same]]\nof = [\"shade\"]\nsets = [[\"light.shadow.redraw=always\"]]\nexact = true\n",
    ] {
        let toml = format!("{check}for_each = [[], [\"light.cone=0\"]]\nwhy = \"\"\n");
        fails(Folder::new().run("each-kind", &[], &toml), "for_each [\"light.cone=0\"]: ");
    }
}

fn for_each_repeats_a_case_and_its_error_names_the_set() {
    let toml = format!("for_each = [[\"light.shadow.size=128\"], [\"{NONE}\"]]\n[[pick]]\nat = [0.8, 0, -0.4]\n");
    let shadowed = format!("{toml}class = \"shadowed\"\nwhy = \"\"\n");
    fails(Folder::new().run("case-each", &[], &shadowed), &format!("for_each [\"{NONE}\"]: pixel"));
    let refused = "fails_with = \"must\"\nfor_each = [[\"light.cone=0\"], []]\n";
    fails(Folder::new().run("case-each-refused", &[], refused), "for_each []: the scene draws");
}

/// With a technique of the check's own, that of `for_each` is not drawn.
fn sets_of_for_each_come_before_the_checks_own() {
    let toml = format!(
        "for_each = [[\"{NONE}\"]]\n[[pick]]\nat = [0.8, 0, -0.4]\nclass = \"shadowed\"\nwhy = \"\"\n\
         set = [\"light.shadow.technique=shadow-map\"]\nfor_each = [[\"{NONE}\"]]\n"
    );
    Folder::new().run("order", &[], &toml).unwrap();
}

fn for_each_without_a_set_is_refused() {
    let text = "`for_each` has no sets: nothing would be checked";
    refused("no-set", &format!("for_each = []\n{LIT}"), text);
    refused("no-set-of-pick", &format!("{LIT}for_each = []\n"), text);
    let same =
        "[[same]]\nof = [\"shade\"]\nsets = [[\"light.shadow.size=64\"]]\nfor_each = []\nexact = true\nwhy = \"\"\n";
    refused("no-set-of-same", same, text);
}

fn a_golden_of_several_pictures_is_refused() {
    let golden = "for_each = [[]]\n[golden]\nmax = 2\nmean = 0.05\nwhy = \"\"\n";
    fails(Folder::with_golden(&[]).run("goldens", &[], golden), "a golden cannot be the picture of each set");
}
