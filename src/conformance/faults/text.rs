//! Shaders that a broken driver compiles: another text for glShaderSource.

use std::ffi::{CStr, c_char};

use glow::HasContext;

use super::{Call, Value};

/// Stage of a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    Vertex,
    Fragment,
    Other,
}

/// The text of a shader.
pub struct Source {
    pub stage: Stage,
    /// As `#version` says; 110 without it.
    pub version: u32,
    /// Shaders that this context was given before.
    pub number: u32,
    pub text: String,
}

impl Source {
    /// The same with lines before all that is not `#version` or `#extension`. Line numbers stay.
    pub fn with(&self, lines: &str) -> String {
        let is_head =
            |line: &&str| line.trim_start().starts_with("#version") || line.trim_start().starts_with("#extension");
        let last = self.text.lines().enumerate().filter(|(_, line)| is_head(line)).map(|(number, _)| number + 1).last();
        let head = last.unwrap_or(0);
        let mut text = String::new();
        for line in self.text.lines().take(head) {
            text += line;
            text.push('\n');
        }
        text += lines;
        text += &format!("\n#line {}\n", head + 1);
        for line in self.text.lines().skip(head) {
            text += line;
            text.push('\n');
        }
        text
    }

    /// Tests whether a word stands in it.
    pub fn has(&self, word: &str) -> bool {
        words(&self.text).any(|found| found == word)
    }
}

/// GLSL's words in a text.
pub fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').filter(|word| !word.is_empty())
}

/// Lines before a shader of this stage that has `word`, from version 130.
pub fn define(source: &Source, stage: Stage, word: &str, lines: &str) -> Option<String> {
    (source.stage == stage && source.version >= 130 && source.has(word)).then(|| source.with(lines))
}

/// Statements after the whole of main(), in shaders of this stage.
pub fn after_main(source: &Source, stage: Stage, statements: &str) -> Option<String> {
    if source.stage != stage {
        return None;
    }
    let at = source.text.rfind("void main(")?;
    let (before, rest) = source.text.split_at(at);
    let rest = rest.replacen("void main(", "void whole_main(", 1);
    Some(format!("{before}{rest}\nvoid main() {{\n    whole_main();\n    {statements}\n}}\n"))
}

/// Notes the stage of a new shader.
pub fn note(call: &mut Call) {
    call.now();
    if let Value::Unsigned(shader) = call.result {
        let kind = call.u(0);
        call.keep((1, shader), kind);
    }
}

/// Hands the driver another text.
pub fn rewrite(call: &mut Call, change: fn(&Source) -> Option<String>) {
    let number = call.kept((0, 0));
    call.keep((0, 0), number + 1.0);
    let Some(shader) = std::num::NonZeroU32::new(call.u(0)).map(glow::NativeShader) else { return };
    let stage = match call.kept((1, call.u(0))) as u32 {
        glow::VERTEX_SHADER => Stage::Vertex,
        glow::FRAGMENT_SHADER => Stage::Fragment,
        _ => Stage::Other,
    };
    let text = joined(call);
    let version = text.lines().find_map(|line| line.trim_start().strip_prefix("#version"));
    let version = version.and_then(|rest| rest.split_whitespace().next()?.parse().ok()).unwrap_or(110);
    let source = Source { stage, version, number: number as u32, text };
    if let Some(other) = change(&source) {
        // SAFETY: as above.
        unsafe { call.gl().shader_source(shader, &other) };
        call.skip();
    }
}

/// The text of glShaderSource's parts.
pub(super) fn joined(call: &Call) -> String {
    let (texts, lengths) = (call.pointer(2).cast::<*const c_char>(), call.pointer(3).cast::<i32>());
    let part = |index: usize| {
        // SAFETY: GL reads the same: `count` pointers, and as many lengths unless that is null or one is negative.
        unsafe {
            let text = texts.add(index).read();
            let length = if lengths.is_null() { -1 } else { lengths.add(index).read() };
            let bytes = match usize::try_from(length) {
                Ok(length) => std::slice::from_raw_parts(text.cast::<u8>(), length),
                Err(_) => CStr::from_ptr(text).to_bytes(),
            };
            String::from_utf8_lossy(bytes).into_owned()
        }
    };
    if texts.is_null() { String::new() } else { (0..call.i(1).max(0) as usize).map(part).collect() }
}

/// A shader of this stage whose loops by `for` are gone through at most once, from version 130.
pub fn loops_once(source: &Source, stage: Stage) -> Option<String> {
    if source.stage != stage || source.version < 130 {
        return None;
    }
    let is_letter = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let (mut text, mut rest, mut found) = (String::new(), source.text.as_str(), false);
    while let Some(at) = rest.find("for") {
        let (before, after) = (&rest[..at], &rest[at + 3..]);
        let head = after.trim_start().strip_prefix('(').filter(|_| !before.ends_with(is_letter)).and_then(head_of_loop);
        text += before;
        text += "for";
        rest = after;
        if let Some([first, holds, step, behind]) = head {
            // The loop around it counts the turns from 0 each time.
            text += &format!(" (int turns = 0; turns < 1; turns = 9) for ({first}; ({holds}) && turns++ < 1; {step})");
            (rest, found) = (behind, true);
        }
    }
    found.then(|| text + rest)
}

/// The three parts of a loop's head after its parenthesis, and what is behind it.
fn head_of_loop(text: &str) -> Option<[&str; 4]> {
    let (mut depth, mut ends) = (1, Vec::new());
    for (index, letter) in text.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            ';' if depth == 1 => ends.push(index),
            _ => {}
        }
        if depth == 0 {
            let [first, second] = ends[..] else { return None };
            return Some([&text[..first], &text[first + 1..second], &text[second + 1..index], &text[index + 1..]]);
        }
    }
    None
}

/// Lines before a shader of any stage that has `word`, from version 130.
pub fn anywhere(source: &Source, word: &str, lines: &str) -> Option<String> {
    define(source, source.stage, word, lines)
}
