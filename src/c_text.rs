//! Text of C: statements, comments, literals.

use glam::DMat4;

/// C text that is appended to.
#[derive(Default)]
pub struct Text(pub String);

impl Text {
    pub fn line(&mut self, text: &str) {
        self.0.push_str(text);
        self.0.push('\n');
    }

    /// A statement in a function.
    pub fn call(&mut self, call: &str) {
        self.line(&format!("    {call};"));
    }

    pub fn enable(&mut self, what: &str, on: bool) {
        self.call(&format!("gl{}({what})", if on { "Enable" } else { "Disable" }));
    }

    /// Loads the top of a matrix stack.
    pub fn load_matrix(&mut self, mode: &str, matrix: &DMat4) {
        self.call(&format!("glMatrixMode({mode})"));
        if *matrix == DMat4::IDENTITY {
            self.call("glLoadIdentity()");
        } else {
            self.call(&format!("glLoadMatrixf({})", columns(&matrix.as_mat4().to_cols_array(), 4)));
        }
    }
}

/// Text within a comment, on one line.
pub fn comment(text: &str) -> String {
    let one_line: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    // Neither ends the comment, nor begins one in it; `?` would begin a trigraph.
    one_line.replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?")
}

/// A float literal.
pub fn float(value: f32) -> String {
    match value {
        _ if value.is_nan() => String::from("(0.0f / 0.0f)"),
        f32::INFINITY => String::from("(1.0f / 0.0f)"),
        f32::NEG_INFINITY => String::from("(-1.0f / 0.0f)"),
        _ => format!("{value:?}f"),
    }
}

pub fn floats(values: &[f32]) -> String {
    values.iter().map(|value| float(*value)).collect::<Vec<_>>().join(", ")
}

/// A pointer to a vector.
pub fn vector(values: &[f32]) -> String {
    format!("(const GLfloat[]){{{}}}", floats(values))
}

/// A pointer to numbers in lines of `width`, as a matrix's columns.
pub fn columns(values: &[f32], width: usize) -> String {
    let lines = values.chunks(width).map(|line| format!("\n        {}", floats(line)));
    format!("(const GLfloat[]){{{}}}", lines.collect::<Vec<_>>().join(","))
}

pub fn boolean(on: bool) -> &'static str {
    if on { "GL_TRUE" } else { "GL_FALSE" }
}

/// Text as string literals of C, a line of it each.
#[cfg(feature = "check")]
pub fn literals(text: &str, indent: &str) -> String {
    let quoted = |line: &str| {
        let mut quoted = String::new();
        for letter in line.chars() {
            match letter {
                '"' | '\\' => quoted.extend(['\\', letter]),
                '\t' => quoted.push_str("\\t"),
                // Two in a row may begin a trigraph.
                '?' => quoted.push_str("\\?"),
                _ => quoted.push(letter),
            }
        }
        quoted
    };
    let lines: Vec<String> = text.lines().map(|line| format!("{indent}\"{}\\n\"", quoted(line))).collect();
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_end_where_they_should() {
        assert_eq!(comment("a */ b\nc /* d ??/"), "a * / b c / * d ? ?/");
    }

    #[test]
    fn floats_are_literals_of_c() {
        assert_eq!(floats(&[1.0, -0.5, 1e-9, 3e20]), "1.0f, -0.5f, 1e-9f, 3e20f");
    }
}
