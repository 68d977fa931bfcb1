//! Doc comments: how they begin, and those that the compiler's `missing_docs` does not ask for.

use std::fs;
use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};

/// Words that no doc comment begins with: a noun or a verb says at once what the item is or does.
const OPENINGS: [&str; 4] = ["Of", "Who", "What", "Whether"];

/// Rust files below `folder` with their texts.
fn read_all(folder: &Path, found: &mut Vec<(PathBuf, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("target") {
            read_all(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            found.push((path, text));
        }
    }
}

fn texts(folder: &str) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    read_all(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut found);
    found
}

/// Numbers of the lines, from 1, with a doc comment that begins with one of [`OPENINGS`].
fn wrong_openings(text: &str) -> Vec<usize> {
    let doc = |line: &str| {
        let line = line.trim_start();
        line.strip_prefix("///").or_else(|| line.strip_prefix("//!")).map(str::to_owned)
    };
    let lines: Vec<Option<String>> = text.lines().map(doc).collect();
    let begins = |index: &usize| *index == 0 || lines[*index - 1].is_none();
    let is_wrong = |index: &usize| {
        let first = lines[*index].as_deref().and_then(|line| line.split_whitespace().next());
        first.is_some_and(|word| OPENINGS.contains(&word))
    };
    (0..lines.len()).filter(begins).filter(is_wrong).map(|index| index + 1).collect()
}

#[test]
fn no_doc_comment_begins_with_a_question() {
    let texts = [texts("src"), texts("tests")].concat();
    assert!(texts.len() > 300, "{} files", texts.len());
    let in_file = |(path, text): &(PathBuf, String)| {
        wrong_openings(text).into_iter().map(|line| format!("{}:{line}", path.display())).collect::<Vec<_>>()
    };
    let wrong: Vec<String> = texts.iter().flat_map(in_file).collect();
    assert!(wrong.is_empty(), "doc comments that begin with one of {OPENINGS:?}:\n{}", wrong.join("\n"));
    assert_eq!(wrong_openings("/// A\n/// What follows.\nfn f();\n\n/// Whether it is.\n"), [5]);
}

/// Variants without a doc comment, of enums that allow `missing_docs`.
#[derive(Default)]
struct Variants {
    enums: usize,
    bare: Vec<String>,
}

impl<'a> Visit<'a> for Variants {
    fn visit_item_enum(&mut self, item: &'a syn::ItemEnum) {
        let allows = |attribute: &syn::Attribute| match &attribute.meta {
            syn::Meta::List(list) => list.path.is_ident("allow") && list.tokens.to_string().contains("missing_docs"),
            _ => false,
        };
        if item.attrs.iter().any(allows) {
            self.enums += 1;
            let is_bare = |variant: &&syn::Variant| !variant.attrs.iter().any(|own| own.path().is_ident("doc"));
            let bare = item.variants.iter().filter(is_bare);
            self.bare.extend(bare.map(|variant| format!("{}::{}", item.ident, variant.ident)));
        }
        visit::visit_item_enum(self, item);
    }
}

/// The fields of an error's variants stand in its message, and need no comment; what makes the error does.
#[test]
fn every_variant_of_an_error_says_when_it_happens() {
    let mut variants = Variants::default();
    for (path, text) in texts("src") {
        let before = variants.bare.len();
        variants.visit_file(&syn::parse_file(&text).unwrap());
        variants.bare[before..].iter_mut().for_each(|name| *name = format!("{}: {name}", path.display()));
    }
    assert!(variants.enums > 10, "{} enums: are attributes still read?", variants.enums);
    assert!(variants.bare.is_empty(), "variants without a doc comment:\n{}", variants.bare.join("\n"));
}
