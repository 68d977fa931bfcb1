//! `data/cases/README.md`: its tables are the doc comments of the keys. `GLUMBRA_BLESS=1` writes them, and fails.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use glumbra::cases::KINDS;
use syn::{Attribute, Expr, Fields, Item, Lit, Meta};

const PAGE: &str = "data/cases/README.md";
const BEGIN: &str = "<!-- keys: written from src/cases/file.rs -->\n";
const END: &str = "<!-- end of keys -->\n";

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// The lines of a doc comment, joined.
fn doc(attributes: &[Attribute]) -> String {
    let lines = attributes.iter().filter_map(|attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Str(text) => Some(text.value().trim().to_owned()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    });
    lines.collect::<Vec<_>>().join(" ")
}

/// A type as a user of TOML reads it.
fn type_name(kind: &syn::Type) -> String {
    match kind {
        syn::Type::Array(array) => {
            let Expr::Lit(syn::ExprLit { lit: Lit::Int(count), .. }) = &array.len else { panic!("a length") };
            let kind = type_name(&array.elem);
            format!("{count} {kind}s")
        }
        syn::Type::Path(path) => {
            let last = path.path.segments.last().unwrap();
            if let syn::PathArguments::AngleBracketed(arguments) = &last.arguments {
                let Some(syn::GenericArgument::Type(inner)) = arguments.args.first() else { panic!("a type") };
                let inner = type_name(inner);
                let plural = if inner.ends_with("number") { "s" } else { "" };
                return if last.ident == "Vec" { format!("list of {inner}{plural}") } else { inner };
            }
            match last.ident.to_string().as_str() {
                "String" => "text".to_owned(),
                "PathBuf" => "path".to_owned(),
                "f64" => "number".to_owned(),
                "usize" | "u32" => "whole number".to_owned(),
                "bool" => "true or false".to_owned(),
                "Sets" => "list of lists of text".to_owned(),
                name => format!("[{name}](#{})", name.to_lowercase()),
            }
        }
        _ => panic!("a type that the page has no words for"),
    }
}

/// Arguments of `#[serde(...)]`.
fn serde(attributes: &[Attribute]) -> String {
    let lists = attributes.iter().filter(|own| own.path().is_ident("serde")).filter_map(|own| match &own.meta {
        Meta::List(list) => Some(list.tokens.to_string()),
        _ => None,
    });
    lists.collect()
}

fn needs(field: &syn::Field) -> &'static str {
    let is_option =
        matches!(&field.ty, syn::Type::Path(path) if path.path.segments.iter().any(|part| part.ident == "Option"));
    if is_option || serde(&field.attrs).contains("default") { "" } else { "yes" }
}

/// A section each type: its comment, and a table of its keys or values.
fn tables() -> String {
    let mut page = String::new();
    for item in syn::parse_file(&read("src/cases/file.rs")).unwrap().items {
        match item {
            Item::Struct(item) => {
                let Fields::Named(fields) = &item.fields else { continue };
                write!(
                    page,
                    "\n### {}\n\n{}\n\n| key | type | needed | meaning |\n|---|---|---|---|\n",
                    item.ident,
                    doc(&item.attrs)
                )
                .unwrap();
                for field in &fields.named {
                    let name = field.ident.as_ref().unwrap();
                    let kind = type_name(&field.ty);
                    writeln!(page, "| `{name}` | {kind} | {} | {} |", needs(field), doc(&field.attrs)).unwrap();
                }
            }
            Item::Enum(item) => {
                let is_kebab = serde(&item.attrs).contains("kebab-case");
                write!(page, "\n### {}\n\n{}\n\n| value | meaning |\n|---|---|\n", item.ident, doc(&item.attrs))
                    .unwrap();
                for variant in &item.variants {
                    let mut name = String::new();
                    for letter in variant.ident.to_string().chars() {
                        if letter.is_uppercase() && is_kebab && !name.is_empty() {
                            name.push('-');
                        }
                        name.extend(letter.to_lowercase());
                    }
                    writeln!(page, "| `\"{name}\"` | {} |", doc(&variant.attrs)).unwrap();
                }
            }
            _ => {}
        }
    }
    let command = read("src/cases/placeholders.rs");
    page += "\n### Placeholders of `render`\n\n";
    command.lines().filter_map(|line| line.strip_prefix("//! |")).for_each(|row| page += &format!("|{row}\n"));
    page + "\n"
}

#[test]
fn the_page_has_every_key() {
    let page = read(PAGE);
    let begin = page.find(BEGIN).expect("the page has a place for keys") + BEGIN.len();
    let end = page.find(END).expect("and its end");
    let tables = tables();
    if page[begin..end] != tables {
        if std::env::var_os("GLUMBRA_BLESS").is_some_and(|value| value == "1") {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(PAGE);
            fs::write(path, format!("{}{tables}{}", &page[..begin], &page[end..])).unwrap();
        }
        panic!("{PAGE} differs from the comments of src/cases/file.rs; GLUMBRA_BLESS=1 writes it");
    }
}

#[test]
fn the_page_and_the_help_name_every_check() {
    let help = std::process::Command::new(env!("CARGO_BIN_EXE_glumbra")).args(["test", "--help"]).output().unwrap();
    let help = String::from_utf8(help.stdout).unwrap();
    let page = read(PAGE);
    let page = &page[..page.find(BEGIN).unwrap()];
    for kind in KINDS.into_iter().filter(|kind| *kind != "gl") {
        assert!(help.contains(kind) && page.contains(&format!("`{kind}`")), "{kind}");
    }
}
