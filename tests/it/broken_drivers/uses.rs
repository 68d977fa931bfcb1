//! GL functions, enums and words of GLSL that the renderer uses, read from its code.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Files below a folder with one of the endings, without comments.
fn texts(folder: &str, endings: &[&str]) -> Vec<String> {
    fn walk(folder: &Path, endings: &[&str], found: &mut Vec<String>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, endings, found);
            } else if path.extension().is_some_and(|end| endings.iter().any(|ending| end == *ending)) {
                let text = fs::read_to_string(&path).unwrap();
                let lines = text.lines().map(|line| line.split("//").next().unwrap_or(""));
                found.push(lines.collect::<Vec<_>>().join("\n"));
            }
        }
    }
    let mut found = Vec::new();
    walk(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), endings, &mut found);
    found
}

fn is_letter(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_'
}

/// Words that follow `before` at once, each with the character behind it. `before` begins no word's middle.
fn after(text: &str, before: &str) -> Vec<(String, Option<char>)> {
    let whole = |at: usize| !is_letter(before.chars().next().unwrap_or(' ')) || !text[..at].ends_with(is_letter);
    text.match_indices(before)
        .filter(|(at, _)| whole(*at))
        .map(|(at, _)| {
            let rest = &text[at + before.len()..];
            let end = rest.find(|letter| !is_letter(letter)).unwrap_or(rest.len());
            (rest[..end].to_owned(), rest[end..].chars().next())
        })
        .collect()
}

/// Methods of glow whose GL function has a name that does not follow from theirs.
const METHODS: &[(&str, &str)] = &[
    ("get_query_parameter_u32", "glgetqueryobjectuiv"),
    ("get_query_parameter_u64", "glgetqueryobjectui64v"),
    ("vertex_attrib_pointer_f32", "glvertexattribpointer"),
    ("get_parameter_i32", "glgetintegerv"),
    ("get_parameter_i32_slice", "glgetintegerv"),
    ("get_parameter_f32_slice", "glgetfloatv"),
];

/// GL's name in small letters of a method of glow.
fn function(method: &str) -> String {
    if let Some((_, function)) = METHODS.iter().find(|(known, _)| *known == method) {
        return (*function).to_owned();
    }
    let mut name = method.replace('_', "");
    for (ending, of_gl) in [("f32slice", "fv"), ("i32slice", "iv"), ("u8slice", ""), ("f32", "f"), ("i32", "i")] {
        name = name.replace(ending, of_gl);
    }
    format!("gl{name}")
}

/// Functions in small letters, and enums with GL_.
pub fn of_gl() -> (BTreeSet<String>, BTreeSet<String>) {
    let texts = [texts("src/device", &["rs"]), texts("src/fixed_function", &["rs"])].concat();
    let (mut functions, mut enums) = (BTreeSet::new(), BTreeSet::new());
    for text in texts {
        // A chain of calls may be broken before a dot.
        let flat = text.split_whitespace().collect::<Vec<_>>().join(" ").replace(" .", ".");
        for before in ["gl.", "gl().", "glow::Context::"] {
            let called = after(&flat, before).into_iter().filter(|(name, next)| {
                name.starts_with(|letter: char| letter.is_ascii_lowercase()) && (*next == Some('(') || before.len() > 5)
            });
            functions.extend(called.map(|(name, _)| function(&name)));
        }
        let methods = after(&flat, ".")
            .into_iter()
            .filter(|(name, next)| name.starts_with(|letter: char| letter.is_ascii_uppercase()) && *next == Some('('));
        functions.extend(methods.map(|(name, _)| format!("gl{}", name.to_ascii_lowercase())));
        for before in ["glow::", "raw::"] {
            let names = after(&flat, before).into_iter().map(|(name, _)| name);
            let is_enum = |name: &String| {
                !name.is_empty()
                    && name
                        .chars()
                        .all(|letter| letter == '_' || letter.is_ascii_digit() || letter.is_ascii_uppercase())
            };
            enums.extend(names.filter(is_enum).map(|name| format!("GL_{name}")));
        }
    }
    functions.remove("glclone");
    (functions, enums)
}

/// Words before a parenthesis that are no function of GLSL: types, statements, the preprocessor's, what is made from a
/// program of register combiners, and a main function under another name.
const NO_FUNCTIONS: &[&str] = &[
    "combine",
    "main_before_far",
    "if",
    "for",
    "while",
    "main",
    "defined",
    "float",
    "int",
    "bool",
    "vec2",
    "vec3",
    "vec4",
    "ivec2",
    "ivec3",
    "mat3",
    "mat4",
];

/// Qualifiers and statements that a driver may take wrongly.
const WORDS: &[&str] =
    &["discard", "invariant", "flat", "noperspective", "centroid", "precise", "layout", "for", "while"];

/// Built-in functions and variables of GLSL, and qualifiers, that a shader of `glsl/` uses.
pub fn of_glsl() -> BTreeSet<String> {
    let all = texts("glsl", &["vert", "frag", "glsl"]).join("\n");
    let mut tokens: Vec<&str> = Vec::new();
    let mut rest = all.as_str();
    while let Some(letter) = rest.chars().next() {
        let end = if is_letter(letter) || letter == '@' {
            rest.find(|letter| !is_letter(letter) && letter != '@').unwrap_or(rest.len())
        } else {
            letter.len_utf8()
        };
        if !letter.is_whitespace() {
            tokens.push(&rest[..end]);
        }
        rest = &rest[end..];
    }
    let is_word = |token: &str| token.starts_with(|letter: char| letter.is_ascii_alphabetic());
    // A word, a name and a parenthesis declare a function; `return name(` and `else name(` do not.
    let declared: BTreeSet<&str> = tokens
        .windows(3)
        .filter(|three| {
            is_word(three[0]) && !["return", "else"].contains(&three[0]) && is_word(three[1]) && three[2] == "("
        })
        .map(|three| three[1])
        .collect();
    let called =
        tokens.windows(2).filter(|two| two[1] == "(" && two[0].starts_with(|letter: char| letter.is_ascii_lowercase()));
    let called = called.map(|two| two[0]).filter(|name| {
        !name.contains('@') && !name.ends_with('_') && !NO_FUNCTIONS.contains(name) && !declared.contains(name)
    });
    let others = tokens.iter().copied().filter(|token| token.starts_with("gl_") || WORDS.contains(token));
    called.chain(others).map(str::to_owned).collect()
}
