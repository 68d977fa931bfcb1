//! The `#define`s of a shader variant.

use std::fmt;

/// One `#define` of a shader variant. `glsl/README.md` lists those that chunks read.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Define {
    name: &'static str,
    light: Option<usize>,
    value: DefineValue,
}

/// Replacement of the name.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum DefineValue {
    /// Nothing: chunks test whether the name is defined.
    Flag,
    Number(u32),
    Word(&'static str),
    /// Statements, with the macro's parameters.
    Calls {
        parameters: &'static str,
        statements: String,
    },
}

impl Define {
    /// A name that chunks test by `#ifdef`.
    pub const fn flag(name: &'static str) -> Self {
        Self { name, light: None, value: DefineValue::Flag }
    }

    /// A whole number.
    pub const fn number(name: &'static str, value: u32) -> Self {
        Self { name, light: None, value: DefineValue::Number(value) }
    }

    /// A word of GLSL.
    pub const fn word(name: &'static str, value: &'static str) -> Self {
        Self { name, light: None, value: DefineValue::Word(value) }
    }

    /// A macro of these parameters that runs `statements`.
    pub const fn calls(name: &'static str, parameters: &'static str, statements: String) -> Self {
        Self { name, light: None, value: DefineValue::Calls { parameters, statements } }
    }

    /// The same for one light: `NAME_index`, which chunks read as `NAME_@`.
    pub const fn of_light(mut self, index: usize) -> Self {
        self.light = Some(index);
        self
    }

    /// The name without a light's index.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Tests whether it is a macro with parameters.
    pub fn has_parameters(&self) -> bool {
        matches!(self.value, DefineValue::Calls { .. })
    }

    /// The name as GLSL has it, with a light's index.
    pub fn full_name(&self) -> String {
        self.light.map_or_else(|| self.name.to_owned(), |index| format!("{}_{index}", self.name))
    }
}

/// The directive, without the end of its line.
impl fmt::Display for Define {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#define {}", self.full_name())?;
        match &self.value {
            DefineValue::Flag => Ok(()),
            DefineValue::Number(value) => write!(f, " {value}"),
            DefineValue::Word(value) => write!(f, " {value}"),
            DefineValue::Calls { parameters, statements } => write!(f, "({parameters}) {statements}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Define;

    #[test]
    fn directives_are_written_as_glsl_has_them() {
        assert_eq!(Define::flag("ALPHA_TEST").to_string(), "#define ALPHA_TEST");
        assert_eq!(Define::number("KERNEL", 3).of_light(12).to_string(), "#define KERNEL_12 3");
        assert_eq!(Define::word("ALPHA_MAP", "r").to_string(), "#define ALPHA_MAP r");
        let calls = Define::calls("TEXGEN", "eye", String::from("texgen_0(eye);"));
        assert_eq!(calls.to_string(), "#define TEXGEN(eye) texgen_0(eye);");
    }
}
