//! From a shader's text to operations: types, globals and declarations of functions.

use std::collections::HashMap;
use std::ops::Range;

use super::ops::{Compiled, Kind, Op, Shape, Shaped, Shared, Slot, Varies};
use super::tokens::{Token, tokens};

/// Reason why a text has no model.
pub type Unknown = String;

/// Result of an expression, or a variable: the slots themselves, which can be assigned.
#[derive(Clone, Debug)]
pub struct Place {
    pub shaped: Shaped,
    pub slots: Vec<Slot>,
    /// No variable has these slots.
    pub is_new: bool,
    /// Number of the sampler.
    pub sampler: Option<usize>,
    /// Groups of slots of which a slot's number chooses one; `slots` holds its value.
    pub chosen: Option<(Vec<Slot>, Slot)>,
}

impl Place {
    pub fn new(shaped: Shaped, slots: Vec<Slot>) -> Self {
        Self { shaped, slots, is_new: true, sampler: None, chosen: None }
    }

    pub fn variable(shaped: Shaped, slots: Vec<Slot>) -> Self {
        Self { is_new: false, ..Self::new(shaped, slots) }
    }
}

/// Way of a parameter: into the function, out of it.
#[derive(Clone, Copy)]
pub struct Parameter<'a> {
    pub shaped: Shaped,
    pub name: &'a str,
    pub ways: [bool; 2],
}

pub struct Function<'a> {
    pub name: &'a str,
    pub result: Shaped,
    pub parameters: Vec<Parameter<'a>>,
    /// Tokens of the body, with its braces.
    pub body: Range<usize>,
}

pub struct Compiler<'a> {
    pub tokens: Vec<Token<'a>>,
    pub at: usize,
    pub structs: Vec<(&'a str, Vec<(&'a str, Shaped)>)>,
    pub scopes: Vec<HashMap<&'a str, Place>>,
    pub functions: Vec<Function<'a>>,
    pub ops: Vec<Op>,
    pub next: Slot,
    constants: HashMap<u64, Slot>,
    /// Slots of the results of the function that is inlined.
    pub result: Vec<Slot>,
    pub depth: usize,
    pub out: Compiled,
}

/// Compiles a stage.
///
/// # Errors
///
/// What of the text has no model.
pub fn compile(text: &str, is_vertex: bool) -> Result<Compiled, Unknown> {
    let tokens = tokens(text)?;
    let writes_depth = tokens.contains(&Token::Word("gl_FragDepth"));
    let mut compiler = Compiler {
        tokens,
        at: 0,
        structs: Vec::new(),
        scopes: vec![HashMap::new()],
        functions: Vec::new(),
        ops: Vec::new(),
        next: 0,
        constants: HashMap::new(),
        result: Vec::new(),
        depth: 0,
        out: Compiled { writes_depth: writes_depth && !is_vertex, ..Compiled::default() },
    };
    compiler.built_in(is_vertex);
    while compiler.at < compiler.tokens.len() {
        compiler.global(is_vertex)?;
    }
    compiler.call("main", Vec::new())?;
    let Compiler { mut out, ops, next, constants, .. } = compiler;
    (out.ops, out.slots) = (ops, next as usize);
    out.constants = constants.into_iter().map(|(bits, slot)| (slot, f64::from_bits(bits))).collect();
    Ok(out)
}

const QUALIFIERS: [&str; 13] = [
    "in",
    "out",
    "inout",
    "uniform",
    "flat",
    "noperspective",
    "smooth",
    "const",
    "invariant",
    "precise",
    "highp",
    "layout",
    "centroid",
];

impl<'a> Compiler<'a> {
    fn built_in(&mut self, is_vertex: bool) {
        let position = self.fresh(4);
        let depth = self.fresh(1);
        let names = if is_vertex { "gl_Position" } else { "gl_FragCoord" };
        let vector = Shaped::vector(Kind::Float, 4);
        self.scopes[0].insert(names, Place::variable(vector, position.clone()));
        self.scopes[0].insert("gl_FragDepth", Place::variable(Shaped::FLOAT, depth.clone()));
        self.out.position = position;
        self.out.depth = depth[0];
        if is_vertex {
            let distances = self.fresh(8);
            let shaped = Shaped { count: 8, ..Shaped::FLOAT };
            self.scopes[0].insert("gl_ClipDistance", Place::variable(shaped, distances.clone()));
            self.out.clip_distances = distances;
        }
    }

    pub fn fresh(&mut self, count: usize) -> Vec<Slot> {
        let first = self.next;
        self.next += count as Slot;
        (first..self.next).collect()
    }

    pub fn constant(&mut self, value: f64) -> Slot {
        if let Some(slot) = self.constants.get(&value.to_bits()) {
            return *slot;
        }
        let slot = self.fresh(1)[0];
        self.constants.insert(value.to_bits(), slot);
        slot
    }

    /// The value of a constant's slot.
    pub fn constant_of(&self, slot: Slot) -> Option<f64> {
        self.constants.iter().find(|(_, known)| **known == slot).map(|(bits, _)| f64::from_bits(*bits))
    }

    pub fn peek(&self) -> Option<Token<'a>> {
        self.tokens.get(self.at).copied()
    }

    pub fn is_next(&self, sign: &str) -> bool {
        matches!(self.peek(), Some(Token::Sign(next)) if next == sign)
    }

    /// Takes the sign if it is next.
    pub fn takes(&mut self, sign: &str) -> bool {
        let is_next = self.is_next(sign);
        self.at += usize::from(is_next);
        is_next
    }

    pub fn expect(&mut self, sign: &str) -> Result<(), Unknown> {
        if self.takes(sign) { Ok(()) } else { Err(format!("{:?} where {sign} is expected", self.peek())) }
    }

    pub fn word(&mut self) -> Result<&'a str, Unknown> {
        match self.peek() {
            Some(Token::Word(word)) => {
                self.at += 1;
                Ok(word)
            }
            other => Err(format!("{other:?} where a name is expected")),
        }
    }

    pub fn size(&self, shaped: Shaped) -> usize {
        match shaped.kind {
            Kind::Struct(number) => {
                self.structs[number].1.iter().map(|(_, part)| part.scalars()).sum::<usize>() * shaped.count.max(1)
            }
            _ => shaped.scalars(),
        }
    }

    /// The type of this name.
    pub fn named(&self, name: &str) -> Option<Shaped> {
        let sampler = |coordinates, compares| Shaped::vector(Kind::Sampler(Shape { coordinates, compares }), 1);
        Some(match name {
            "void" => Shaped::VOID,
            "float" => Shaped::FLOAT,
            "int" => Shaped::INT,
            "bool" => Shaped::BOOL,
            "vec2" | "vec3" | "vec4" => Shaped::vector(Kind::Float, side(name)),
            "ivec2" | "ivec3" | "ivec4" => Shaped::vector(Kind::Int, side(name)),
            "bvec2" | "bvec3" | "bvec4" => Shaped::vector(Kind::Bool, side(name)),
            "mat2" | "mat3" | "mat4" => Shaped { columns: side(name), ..Shaped::vector(Kind::Float, side(name)) },
            "sampler1D" => sampler(1, false),
            "sampler2D" => sampler(2, false),
            "sampler2DShadow" => sampler(2, true),
            "samplerCube" => sampler(3, false),
            "samplerCubeShadow" => sampler(3, true),
            _ => {
                let number = self.structs.iter().position(|(known, _)| *known == name)?;
                Shaped::vector(Kind::Struct(number), 1)
            }
        })
    }

    /// Qualifiers, as words.
    pub fn qualifiers(&mut self) -> Result<Vec<&'a str>, Unknown> {
        let mut found = Vec::new();
        while let Some(Token::Word(word)) = self.peek()
            && QUALIFIERS.contains(&word)
        {
            self.at += 1;
            found.push(word);
            if word == "layout" {
                while !self.takes(")") {
                    self.at += 1;
                }
            }
        }
        Ok(found)
    }

    fn global(&mut self, is_vertex: bool) -> Result<(), Unknown> {
        let qualifiers = self.qualifiers()?;
        let word = self.word()?;
        if word == "struct" {
            return self.structure();
        }
        if self.scopes[0].contains_key(word) && self.takes(";") {
            return Ok(());
        }
        let shaped = self.named(word).ok_or_else(|| format!("type {word}"))?;
        loop {
            let name = self.word()?;
            if self.is_next("(") {
                return self.function(shaped, name);
            }
            let shaped = self.array(shaped)?;
            if name == "gl_ClipDistance" {
                // It is there already.
            } else if qualifiers.contains(&"uniform") || qualifiers.contains(&"in") || qualifiers.contains(&"out") {
                self.shared(shaped, name, &qualifiers, is_vertex);
            } else {
                self.variable(shaped, name)?;
            }
            if !self.takes(",") {
                return self.expect(";");
            }
        }
    }

    fn shared(&mut self, shaped: Shaped, name: &'a str, qualifiers: &[&str], is_vertex: bool) {
        if let Kind::Sampler(_) = shaped.kind {
            let sampler = Some(self.out.samplers.len());
            self.out.samplers.push(name.to_owned());
            self.scopes[0].insert(name, Place { sampler, ..Place::variable(shaped, Vec::new()) });
            return;
        }
        let slots = self.fresh(self.size(shaped));
        self.scopes[0].insert(name, Place::variable(shaped, slots.clone()));
        let varies = match () {
            () if qualifiers.contains(&"flat") => Varies::Flat,
            () if qualifiers.contains(&"noperspective") => Varies::NoPerspective,
            () => Varies::Smooth,
        };
        let mut slots = slots;
        if is_vertex && qualifiers.contains(&"in") && slots.len() < 4 {
            // Missing components of an attribute are those of (0, 0, 0, 1).
            slots.extend(self.fresh(4 - slots.len()));
        }
        let shared = Shared { name: name.to_owned(), slots, varies };
        match () {
            () if qualifiers.contains(&"uniform") => {
                self.out.uniforms.insert(shared.name, shared.slots);
            }
            () if qualifiers.contains(&"in") => self.out.inputs.push(shared),
            () => self.out.outputs.push(shared),
        }
    }

    fn structure(&mut self) -> Result<(), Unknown> {
        let name = self.word()?;
        self.expect("{")?;
        let mut parts = Vec::new();
        while !self.takes("}") {
            let word = self.word()?;
            let shaped = self.named(word).ok_or_else(|| format!("type {word}"))?;
            parts.push((self.word()?, shaped));
            self.expect(";")?;
        }
        self.structs.push((name, parts));
        self.expect(";")
    }

    /// `[N]` behind a name.
    pub fn array(&mut self, shaped: Shaped) -> Result<Shaped, Unknown> {
        if !self.takes("[") {
            return Ok(shaped);
        }
        let Some(Token::Number(count, _)) = self.peek() else { return Err("the size of an array".into()) };
        self.at += 1;
        self.expect("]")?;
        Ok(Shaped { count: count as usize, ..shaped })
    }

    fn function(&mut self, result: Shaped, name: &'a str) -> Result<(), Unknown> {
        self.expect("(")?;
        let mut parameters = Vec::new();
        while !self.takes(")") {
            let qualifiers = self.qualifiers()?;
            let word = self.word()?;
            if word == "void" {
                continue;
            }
            let shaped = self.named(word).ok_or_else(|| format!("type {word}"))?;
            let name = self.word()?;
            let both = qualifiers.contains(&"inout");
            let ways = [both || !qualifiers.contains(&"out"), both || qualifiers.contains(&"out")];
            parameters.push(Parameter { shaped: self.array(shaped)?, name, ways });
            self.takes(",");
        }
        if self.takes(";") {
            return Ok(());
        }
        let start = self.at;
        let mut depth = 0;
        loop {
            match self.peek().ok_or("a body without }")? {
                Token::Sign("{") => depth += 1,
                Token::Sign("}") => depth -= 1,
                _ => {}
            }
            self.at += 1;
            if depth == 0 {
                break;
            }
        }
        self.functions.push(Function { name, result, parameters, body: start..self.at });
        Ok(())
    }
}

/// The digit at the end of a type's name.
fn side(name: &str) -> usize {
    usize::from(name.as_bytes()[name.len() - 1] - b'0')
}
