//! Citations in comments resolve: each tag is in the bibliography, `data/documents.md` names only scenes, cases, figures
//! and tests that exist, and no comment cites a planning number or a document that nobody has.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders and files whose text is checked.
const CHECKED: [&str; 6] = ["src", "glsl", "tests", "data", "ci", "README.md"];

/// Names of this file, which has all forbidden words in it.
const OWN: &str = "documents.rs";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Text files below `path`, without the inputs of fuzzing and of bad files.
fn files(path: &Path, found: &mut Vec<PathBuf>) {
    if !path.is_dir() {
        let known = ["rs", "frag", "vert", "glsl", "toml", "md"];
        let is_script = path.extension().is_none() && path.starts_with(root().join("ci"));
        let is_text = path.extension().is_some_and(|end| known.contains(&&*end.to_string_lossy())) || is_script;
        if is_text && !path.ends_with(OWN) {
            found.push(path.to_owned());
        }
        return;
    }
    if path.ends_with("target") || path.ends_with("tests/bad") || path.ends_with("tests/fuzz/seeds") {
        return;
    }
    for entry in fs::read_dir(path).unwrap() {
        files(&entry.unwrap().path(), found);
    }
}

/// All checked texts with their paths.
fn texts() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    CHECKED.iter().for_each(|name| files(&root().join(name), &mut found));
    assert!(found.len() > 300, "{} files", found.len());
    let read = |path: PathBuf| fs::read_to_string(&path).ok().map(|text| (path, text));
    found.into_iter().filter_map(read).collect()
}

fn bibliography() -> String {
    fs::read_to_string(root().join("data/documents.md")).unwrap()
}

/// The text of consecutive comment lines as one, so that a citation across lines is whole; of a TOML file, all of it.
fn comments(path: &Path, text: &str) -> Vec<String> {
    if path.extension().is_some_and(|end| end == "toml") {
        return vec![text.to_owned()];
    }
    let mut blocks = vec![String::new()];
    for line in text.lines() {
        let line = line.trim_start();
        let comment = ["///", "//!", "//", "#"].into_iter().find_map(|mark| line.strip_prefix(mark));
        match comment {
            Some(comment) => {
                let block = blocks.last_mut().unwrap();
                block.push_str(comment.trim());
                block.push(' ');
            }
            None if !blocks.last().unwrap().is_empty() => blocks.push(String::new()),
            None => {}
        }
    }
    blocks
}

/// Tags that `[…]` in a comment cites: `HSM`, `GL 4.6`, `Woop 2013`.
fn tags(comment: &str) -> Vec<String> {
    let mut found = Vec::new();
    for part in comment.split('[').skip(1) {
        let inside = part.split(']').next().unwrap_or_default();
        for citation in inside.split("; ") {
            let tag = citation.split(',').next().unwrap_or_default().trim();
            let is_document = ["HSM", "LEC", "GDC"].contains(&tag);
            let is_specification = tag.starts_with("GL ") || tag.starts_with("GLSL ");
            let year = tag.rsplit(' ').next().unwrap_or_default();
            let is_paper = tag.contains(' ') && year.len() == 4 && year.parse().is_ok_and(|year: u32| year > 1900);
            if is_document || is_specification || is_paper {
                found.push(tag.split(':').next().unwrap_or_default().to_owned());
            }
        }
    }
    found
}

#[test]
fn every_tag_is_in_the_bibliography() {
    let page = bibliography();
    let (mut wrong, mut used) = (Vec::new(), BTreeSet::new());
    for (path, text) in texts() {
        if path.extension().is_none_or(|end| end == "md") {
            continue;
        }
        for tag in comments(&path, &text).iter().flat_map(|comment| tags(comment)) {
            if !page.contains(&format!("**[{tag}]**")) {
                wrong.push(format!("{}: [{tag}]", path.display()));
            }
            used.insert(tag);
        }
    }
    assert!(wrong.is_empty(), "not in data/documents.md:\n{}", wrong.join("\n"));
    for tag in ["HSM", "LEC", "GDC", "GL 4.6", "Woop 2013"] {
        assert!(used.contains(tag), "no comment cites [{tag}]: are comments still read?");
    }
}

/// Words that no comment, message or page may have: numbers of planning files, and names of documents that nobody has.
fn unresolvable(text: &str) -> Option<String> {
    const WORDS: [&str; 7] =
        ["[techniques", "; techniques ", "techniques E", "shared/", "issue \"", "[lecture", "the documents' "];
    if let Some(word) = WORDS.iter().find(|word| text.contains(**word)) {
        return Some((*word).to_owned());
    }
    // `(C8)`, `[C7]`, `A13:` and so on; the driver's rules are `GL-C1`, formats are `D24`.
    let is_number = |word: &str| {
        let word = word.trim_matches(|c: char| "()[]:;,.".contains(c));
        let (letter, digits) = (word.chars().next()?, word.get(1..)?);
        let is_planned = match letter {
            'A' => 1..=25,
            'B' => 1..=8,
            'C' => 1..=12,
            'E' => 1..=5,
            _ => return None,
        };
        is_planned.contains(&digits.parse::<u32>().ok()?).then(|| word.to_owned())
    };
    text.split_whitespace().find_map(is_number)
}

#[test]
fn nothing_cites_what_nobody_has() {
    let mut wrong = Vec::new();
    for (path, text) in texts() {
        // Tables of the check's results hold ids of rules by themselves, and B1 is an appendix of a manual.
        let is_page = path.extension().is_some_and(|end| end == "md");
        let found = if is_page {
            ["[techniques", "shared/", "[lecture"]
                .iter()
                .find(|word| text.contains(**word))
                .map(|word| (*word).to_owned())
        } else {
            let allowed = |text: &str| text.replace("appendix B1", "").replace("`C1`", "");
            comments(&path, &text).iter().find_map(|comment| unresolvable(&allowed(comment)))
        };
        if let Some(found) = found {
            wrong.push(format!("{}: {found}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(unresolvable("volumes as (C8) has them").as_deref(), Some("C8"));
    assert_eq!(unresolvable("rule GL-C1, appendix D24"), None);
}

/// Cells of the tables under "Where each section is found", without their header lines.
fn rows(page: &str) -> Vec<Vec<&str>> {
    let (_, tables) = page.split_once("## Where each section is found").unwrap();
    let is_row = |line: &&str| line.starts_with('|') && !line.starts_with("|---");
    let rows = tables.lines().filter(is_row).map(|line| line.trim_matches('|').split('|').map(str::trim).collect());
    rows.filter(|row: &Vec<&str>| !row[0].starts_with("section") && !["slide", "what"].contains(&row[0])).collect()
}

fn names(cell: &str) -> impl Iterator<Item = &str> {
    cell.split(", ").filter(|name| !name.starts_with("not yet") && *name != "—")
}

#[test]
fn what_the_bibliography_names_exists() {
    let page = bibliography();
    let table = ["table.rs", "projected.rs", "explained.rs", "bumps.rs", "bump_errors.rs"]
        .map(|file| fs::read_to_string(root().join("src/figures").join(file)).unwrap());
    let table = table.concat();
    let figures: Vec<&str> =
        table.lines().filter_map(|line| line.trim().strip_prefix("name: \"")?.strip_suffix("\",")).collect();
    let mut wrong = Vec::new();
    let mut count = [0; 3];
    for row in rows(&page) {
        let [figure, cases, tests] = match row[..] {
            [_, _, figure, cases, tests] => [figure, cases, tests],
            [_, _, cases, tests] => ["—", cases, tests],
            _ => panic!("a row of {} cells: {row:?}", row.len()),
        };
        for name in names(figure) {
            count[0] += 1;
            if !figures.contains(&name) {
                wrong.push(format!("figure {name}"));
            }
        }
        for name in names(cases) {
            count[1] += 1;
            if !root().join("data/cases").join(name).join("case.toml").is_file() {
                wrong.push(format!("case {name}"));
            }
        }
        for name in names(tests) {
            count[2] += 1;
            let place = root().join("tests/it").join(name);
            if !place.is_dir() && !place.with_extension("rs").is_file() {
                wrong.push(format!("test {name}"));
            }
        }
        for word in row.iter().flat_map(|cell| cell.split('`')).filter(|word| word.starts_with("data/")) {
            if !root().join(word).exists() {
                wrong.push(word.to_owned());
            }
        }
    }
    assert!(wrong.is_empty(), "data/documents.md names what is not there: {wrong:?}");
    assert!(count.iter().all(|count| *count > 10), "{count:?}");
    // Figures that show a document's result are all in the tables.
    let missing: Vec<&&str> = figures.iter().filter(|name| !page.contains(**name)).collect();
    assert!(missing.is_empty(), "figures without a row: {missing:?}");
}
