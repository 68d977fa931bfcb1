//! The finished GLSL of a program, as the device compiles it and `glumbra plan --shaders` prints it.

use super::{Chunk, Program};

/// A stage of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// GL_VERTEX_SHADER.
    Vertex,
    /// GL_FRAGMENT_SHADER.
    Fragment,
}

impl Stage {
    /// Both, in the order of the pipeline.
    pub const ALL: [Self; 2] = [Self::Vertex, Self::Fragment];

    /// `vertex` or `fragment`, for messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Fragment => "fragment",
        }
    }
}

/// The text of one stage, and which file each of its lines is from.
///
/// `#line` gives every file a number (GLSL's source string number) and counts its lines from 1. File 0 is the part before
/// the first file: `#version` and the defines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// GLSL, whole.
    pub text: String,
    /// Number of lines in `text` that have ended.
    lines: usize,
    /// Name of each file, and its first line in the whole text, from 1.
    files: Vec<(String, usize)>,
}

/// A line of a [`Source`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SourceLine<'a> {
    /// Name of the chunk, or of the part before the first chunk.
    pub file: &'a str,
    /// In the file, from 1.
    pub line: usize,
    /// The line itself, without its end.
    pub text: &'a str,
}

/// `EXACT` marks values that are computed as written, where the driver has a word for it [GLSL 4.60, 4.9.1]. Without it
/// Mesa 24.1 and later move arithmetic across interpolation, from the fragments to the vertices, in one program and not in
/// another.
const HEAD: &str = "#version 330 core
#ifdef GL_ARB_gpu_shader5
#extension GL_ARB_gpu_shader5 : enable
#define EXACT precise
#else
#define EXACT
#endif
";

/// Surfaces without holes have no alpha test, and what draws them calls it all the same.
const AFTER_DEFINES: &str = "#ifndef ALPHA_TEST
#define alpha_test()
#endif
";

impl Program {
    /// The finished GLSL of a stage: `#version`, the defines, then each chunk under a `#line` of its own.
    pub fn source(&self, stage: Stage) -> Source {
        let mut source =
            Source { text: String::new(), lines: 0, files: vec![(String::from("#version and defines"), 1)] };
        source.append(HEAD);
        self.defines.iter().for_each(|define| source.append(&format!("{define}\n")));
        source.append(AFTER_DEFINES);
        self.chunks(stage).iter().for_each(|chunk| source.push(chunk));
        source
    }

    /// The chunks of a stage, in order.
    pub fn chunks(&self, stage: Stage) -> &[Chunk] {
        match stage {
            Stage::Vertex => &self.vertex,
            Stage::Fragment => &self.fragment,
        }
    }
}

impl Source {
    fn push(&mut self, chunk: &Chunk) {
        let number = self.files.len();
        self.append(&format!("// file {number}: {}\n#line 1 {number}\n", chunk.name));
        self.files.push((chunk.name.to_string(), self.lines + 1));
        self.append(&chunk.text);
        if !chunk.text.ends_with('\n') {
            self.append("\n");
        }
    }

    /// Appends text and counts its lines. All before it is left alone, so that many chunks cost as much as their text.
    fn append(&mut self, text: &str) {
        self.lines += ended_lines(text);
        self.text.push_str(text);
    }

    /// Place of line `line` of the whole text, counted from 1.
    pub fn place(&self, line: usize) -> Option<SourceLine<'_>> {
        let (file, first) = self.files.iter().rev().find(|(_, first)| *first <= line)?;
        let text = self.text.lines().nth(line - 1)?;
        Some(SourceLine { file, line: line - first + 1, text })
    }

    /// The text with an empty comment for each `#line`, so that a driver counts the lines of the whole text. Mesa 22.3
    /// reads a file's number and reports 0: line 9 of every file is `0:9`.
    pub fn without_line_marks(&self) -> String {
        let line = |line: &str| String::from(if line.starts_with("#line ") { "//" } else { line }) + "\n";
        self.text.lines().map(line).collect()
    }
}

/// Number of lines that end in `text`.
fn ended_lines(text: &str) -> usize {
    #[cfg(test)]
    tests::COUNTED.with(|counted| counted.set(counted.get() + text.len()));
    text.matches('\n').count()
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;
    use crate::pass::Define;

    thread_local! {
        /// Bytes whose lines [`ended_lines`] has counted.
        pub static COUNTED: Cell<usize> = const { Cell::new(0) };
    }

    #[test]
    fn lines_of_each_chunk_are_counted_once() {
        for chunks in [0, 1, 100, 3000] {
            let chunk = |k: usize| Chunk { name: format!("chunk {k}").into(), text: "a\nb\n".repeat(k % 7 + 1).into() };
            let program = Program { fragment: (0..chunks).map(chunk).collect(), ..program() };
            COUNTED.with(|counted| counted.set(0));
            let source = program.source(Stage::Fragment);
            assert_eq!(COUNTED.with(Cell::get), source.text.len(), "{chunks} chunks");
            assert_eq!(source.lines, source.text.lines().count());
        }
    }

    fn program() -> Program {
        let chunk = |name: &str, text: &str| Chunk { name: name.to_owned().into(), text: text.to_owned().into() };
        Program {
            label: String::from("test"),
            defines: vec![Define::flag("A"), Define::number("B", 2)],
            vertex: vec![],
            fragment: vec![chunk("one", "a\nb\n"), chunk("two", "c\n\nd"), chunk("three", "e\n")],
            attributes: vec![],
        }
    }

    #[test]
    fn every_line_is_found_in_its_file() {
        let source = program().source(Stage::Fragment);
        let expected = "#define B 2\n#ifndef ALPHA_TEST\n#define alpha_test()\n#endif\n// file 1: one\n#line 1 1\na\nb\n// file 2: two\n#line 1 2\nc\n\nd\n// file 3: three\n#line 1 3\ne\n";
        assert!(source.text.ends_with(expected), "{}", source.text);
        let found = |line| source.place(line).map(|place| (place.file, place.line, place.text));
        let head = "#version and defines";
        assert_eq!(found(0), None);
        assert_eq!(found(1), Some((head, 1, "#version 330 core")));
        assert_eq!(found(9), Some((head, 9, "#define B 2")));
        assert_eq!((found(15), found(16)), (Some(("one", 1, "a")), Some(("one", 2, "b"))));
        assert_eq!((found(19), found(21)), (Some(("two", 1, "c")), Some(("two", 3, "d"))));
        assert_eq!((found(24), found(25)), (Some(("three", 1, "e")), None));
        let plain = source.without_line_marks();
        assert_eq!((plain.lines().count(), plain.contains("#line")), (24, false));
        assert!(plain.ends_with("// file 3: three\n//\ne\n"), "{plain}");
    }
}
