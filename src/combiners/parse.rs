//! Reads a program from text: the notation of NVIDIA's register combiner files, "!!RC1.0".
//!
//! ```text
//! !!RC1.0
//! const0 = (0.2, 0.2, 0.2, 1);            # constants, here or in a stage; else the renderer's
//! {                                       # a general stage
//!   rgb {
//!     spare0 = expand(tex0) . expand(tex1);   # A . B: a dot product
//!     discard = unsigned(col0) * tex3.a;      # C * D
//!   }
//!   alpha {
//!     discard = unsigned(tex1.b) * unsigned_invert(zero);
//!     discard = unsigned(tex1.b) * unsigned_invert(zero);
//!     spare0 = sum();
//!     scale_by_four();
//!   }
//! }
//! final_product = spare1.a * spare1;          # E * F
//! out.rgb = lerp(A, B, C) + D;                # A B + (1 - A) C + D; or D alone
//! out.a = unsigned_invert(zero);              # G
//! clamp_color_sum();
//! ```
//!
//! An input without a mapping is signed in a stage, unsigned in the final combiner. An input without a component reads RGB,
//! in an alpha portion and as G alpha.

use super::{CombinerProgram, Component, Final, GeneralStage, Mapping, Portion, Register, Scale, Variable, ZERO};

/// A mistake in the text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{line}: {what}")]
pub struct Error {
    /// Counted from 1.
    pub line: usize,
    pub what: String,
}

/// A word, a number or a sign, with its line.
#[derive(Clone, Debug)]
struct Token {
    text: String,
    line: usize,
}

/// Reads a program. What the extension would refuse is not looked for: see `check`.
///
/// # Errors
///
/// The first word that does not belong where it stands.
pub fn parse(text: &str) -> Result<CombinerProgram, Error> {
    let mut lines = text.lines();
    let first = lines.next().unwrap_or_default().trim();
    if first != "!!RC1.0" {
        return Err(Error { line: 1, what: format!("begins with \"{first}\", not with \"!!RC1.0\"") });
    }
    let mut parser = Parser { tokens: tokens(text)?, next: 0 };
    parser.program()
}

fn tokens(text: &str) -> Result<Vec<Token>, Error> {
    let mut tokens = Vec::new();
    for (line, content) in (1..).zip(text.lines()).skip(1) {
        let content = content.split('#').next().unwrap_or_default();
        let content = content.split("//").next().unwrap_or_default();
        let mut rest = content.trim_start();
        while let Some(first) = rest.chars().next() {
            let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
            let length = match first {
                '0'..='9' => rest.find(|c: char| !is_word(c) && c != '.').unwrap_or(rest.len()),
                // A dot and a component belong to the word before it; a dot between spaces is a product.
                c if is_word(c) => word_length(rest),
                '{' | '}' | '(' | ')' | ',' | ';' | '=' | '*' | '.' | '+' | '-' => 1,
                _ => return Err(Error { line, what: format!("'{first}' has no meaning here") }),
            };
            tokens.push(Token { text: rest[..length].to_owned(), line });
            rest = rest[length..].trim_start();
        }
    }
    Ok(tokens)
}

/// Bytes of the word that a text begins with, with its component.
fn word_length(text: &str) -> usize {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let word = text.find(|c: char| !is_word(c)).unwrap_or(text.len());
    match text[word..].strip_prefix('.') {
        Some(rest) if rest.starts_with(is_word) => word + 1 + rest.find(|c: char| !is_word(c)).unwrap_or(rest.len()),
        _ => word,
    }
}

struct Parser {
    tokens: Vec<Token>,
    next: usize,
}

/// Place of an input: decides what is read where nothing is written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Rgb,
    Alpha,
    Final,
    FinalAlpha,
}

impl Parser {
    fn line(&self) -> usize {
        self.tokens.get(self.next).or(self.tokens.last()).map_or(1, |token| token.line)
    }

    fn error<T>(&self, what: impl Into<String>) -> Result<T, Error> {
        Err(Error { line: self.line(), what: what.into() })
    }

    fn peek(&self) -> &str {
        self.tokens.get(self.next).map_or("", |token| &token.text)
    }

    /// Takes the next word if it is `text`.
    fn take(&mut self, text: &str) -> bool {
        let is_it = self.peek() == text;
        self.next += usize::from(is_it);
        is_it
    }

    fn expect(&mut self, text: &str) -> Result<(), Error> {
        if self.take(text) {
            return Ok(());
        }
        match self.peek() {
            "" => self.error(format!("the text ends where '{text}' is needed")),
            found => self.error(format!("'{found}' stands where '{text}' is needed")),
        }
    }

    fn program(&mut self) -> Result<CombinerProgram, Error> {
        let constants = self.constants()?;
        let mut stages = Vec::new();
        while self.take("{") {
            stages.push(self.stage()?);
        }
        let last = self.last()?;
        Ok(CombinerProgram { constants, stages, last })
    }

    /// `const0 = (r, g, b, a);`, none or several.
    fn constants(&mut self) -> Result<[Option<[f32; 4]>; 2], Error> {
        let mut constants = [None; 2];
        while let Some(index) = ["const0", "const1"].iter().position(|name| self.take(name)) {
            self.expect("=")?;
            self.expect("(")?;
            let mut value = [0.0; 4];
            for (channel, slot) in value.iter_mut().enumerate() {
                if channel > 0 {
                    self.expect(",")?;
                }
                *slot = self.number()?;
            }
            self.expect(")")?;
            self.expect(";")?;
            constants[index] = Some(value);
        }
        Ok(constants)
    }

    /// A number in [0, 1]: GL clamps constants to that.
    fn number(&mut self) -> Result<f32, Error> {
        let text = self.peek();
        match text.parse::<f32>() {
            Ok(number) if (0.0..=1.0).contains(&number) => {
                self.next += 1;
                Ok(number)
            }
            Ok(number) => self.error(format!("{number} is not in [0, 1]")),
            Err(_) => self.error(format!("'{text}' is no number")),
        }
    }

    fn stage(&mut self) -> Result<GeneralStage, Error> {
        let mut stage = GeneralStage { constants: self.constants()?, ..GeneralStage::default() };
        loop {
            if self.take("}") {
                return Ok(stage);
            }
            let (slot, place) = match self.peek() {
                "rgb" => (&mut stage.rgb, Place::Rgb),
                "alpha" => (&mut stage.alpha, Place::Alpha),
                "" => return self.error("the text ends within a stage"),
                found => return self.error(format!("'{found}' is no portion: rgb, alpha")),
            };
            if slot.is_some() {
                return self.error(format!("a stage has one {} portion", self.peek()));
            }
            self.next += 1;
            *slot = Some(self.portion(place)?);
        }
    }

    fn portion(&mut self, place: Place) -> Result<Portion, Error> {
        let zero = Variable { component: if place == Place::Rgb { Component::Rgb } else { Component::Alpha }, ..ZERO };
        let mut portion =
            Portion { inputs: [zero; 4], outputs: [None; 3], dots: [false; 2], biased: false, scale: Scale::One };
        self.expect("{")?;
        let (mut products, mut has_sum) = (0, false);
        while !self.take("}") {
            if let Some((biased, scale)) = self.scaling() {
                (portion.biased, portion.scale) = (biased, scale);
                self.call()?;
                continue;
            }
            let output = self.output()?;
            self.expect("=")?;
            if self.take("mux") {
                return self.error("mux() is not to be had");
            }
            if self.take("sum") {
                if has_sum {
                    return self.error("a portion has one sum");
                }
                (portion.outputs[2], has_sum) = (output, true);
                self.call()?;
                continue;
            }
            if products == 2 {
                return self.error("a portion has two products");
            }
            portion.inputs[2 * products] = self.input(place)?;
            portion.dots[products] = self.take(".");
            if !portion.dots[products] {
                self.expect("*")?;
            }
            portion.inputs[2 * products + 1] = self.input(place)?;
            self.expect(";")?;
            portion.outputs[products] = output;
            products += 1;
        }
        Ok(portion)
    }

    /// Bias and scale, if the next word sets them.
    fn scaling(&mut self) -> Option<(bool, Scale)> {
        let found = match self.peek() {
            "scale_by_one_half" => (false, Scale::Half),
            "scale_by_two" => (false, Scale::Two),
            "scale_by_four" => (false, Scale::Four),
            "bias_by_negative_one_half" => (true, Scale::One),
            "bias_by_negative_one_half_scale_by_two" => (true, Scale::Two),
            _ => return None,
        };
        self.next += 1;
        Some(found)
    }

    /// `();`
    fn call(&mut self) -> Result<(), Error> {
        ["(", ")", ";"].iter().try_for_each(|text| self.expect(text))
    }

    /// A register to be written, or none for `discard`.
    fn output(&mut self) -> Result<Option<Register>, Error> {
        if self.take("discard") {
            return Ok(None);
        }
        match register(self.peek()) {
            Some(found) => {
                self.next += 1;
                Ok(Some(found))
            }
            None => self.error(format!("'{}' is no register", self.peek())),
        }
    }

    /// `expand(tex0.b)`, `-spare0`, `unsigned_invert(zero)` and so on.
    fn input(&mut self, place: Place) -> Result<Variable, Error> {
        let is_final = matches!(place, Place::Final | Place::FinalAlpha);
        let is_negated = self.take("-");
        let named = match self.peek() {
            "unsigned" => Some(Mapping::Unsigned),
            "unsigned_invert" => Some(Mapping::UnsignedInvert),
            "expand" => Some(Mapping::Expand),
            "half_bias" => Some(Mapping::HalfBias),
            _ => None,
        };
        let mapping = match (named, is_negated) {
            (Some(Mapping::Expand), true) => Mapping::ExpandNegate,
            (Some(Mapping::HalfBias), true) => Mapping::HalfBiasNegate,
            (Some(other), true) => return self.error(format!("{other:?} cannot be negated")),
            (Some(mapping), false) => mapping,
            (None, true) => Mapping::SignedNegate,
            (None, false) if is_final => Mapping::Unsigned,
            (None, false) => Mapping::Signed,
        };
        if named.is_some() {
            self.next += 1;
            self.expect("(")?;
        }
        let text = self.peek().to_owned();
        let (name, part) = text.split_once('.').unwrap_or((&text, ""));
        let component = match part {
            "rgb" => Component::Rgb,
            "a" => Component::Alpha,
            "b" => Component::Blue,
            "" if matches!(place, Place::Alpha | Place::FinalAlpha) => Component::Alpha,
            "" => Component::Rgb,
            other => return self.error(format!("'.{other}' is no component: .rgb, .a, .b")),
        };
        let Some(register) = register(name) else {
            return self.error(format!("'{text}' is no register"));
        };
        self.next += 1;
        if named.is_some() {
            self.expect(")")?;
        }
        Ok(Variable { register, mapping, component })
    }

    fn last(&mut self) -> Result<Final, Error> {
        let alpha = Variable { component: Component::Alpha, ..ZERO };
        let mut last = Final { inputs: [ZERO, ZERO, ZERO, ZERO, ZERO, ZERO, alpha], clamps_sum: false };
        let mut has_color = false;
        while self.next < self.tokens.len() {
            if self.take("clamp_color_sum") {
                self.call()?;
                last.clamps_sum = true;
            } else if self.take("final_product") {
                self.expect("=")?;
                last.inputs[4] = self.input(Place::Final)?;
                self.expect("*")?;
                last.inputs[5] = self.input(Place::Final)?;
                self.expect(";")?;
            } else if self.take("out.rgb") {
                self.expect("=")?;
                self.color(&mut last)?;
                has_color = true;
            } else if self.take("out.a") {
                self.expect("=")?;
                last.inputs[6] = self.input(Place::FinalAlpha)?;
                self.expect(";")?;
            } else {
                let known = "final_product, out.rgb, out.a, clamp_color_sum";
                return self.error(format!("'{}' does not belong to the final combiner: {known}", self.peek()));
            }
        }
        if has_color { Ok(last) } else { self.error("has no final combiner: `out.rgb = …;` is missing") }
    }

    /// `lerp(A, B, C) + D;` or `D;`
    fn color(&mut self, last: &mut Final) -> Result<(), Error> {
        let mut has_more = true;
        if self.take("lerp") {
            self.expect("(")?;
            for index in 0..3 {
                if index > 0 {
                    self.expect(",")?;
                }
                last.inputs[index] = self.input(Place::Final)?;
            }
            self.expect(")")?;
            has_more = self.take("+");
        }
        if has_more {
            last.inputs[3] = self.input(Place::Final)?;
        }
        self.expect(";")
    }
}

fn register(name: &str) -> Option<Register> {
    Some(match name {
        "zero" => Register::Zero,
        "const0" => Register::Constant0,
        "const1" => Register::Constant1,
        "fog" => Register::Fog,
        "col0" => Register::Color0,
        "col1" => Register::Color1,
        "tex0" => Register::Texture(0),
        "tex1" => Register::Texture(1),
        "tex2" => Register::Texture(2),
        "tex3" => Register::Texture(3),
        "spare0" => Register::Spare0,
        "spare1" => Register::Spare1,
        "final_product" => Register::Product,
        "color_sum" => Register::ColorSum,
        _ => return None,
    })
}
