//! From a shader's text to operations: declarations and statements. Calls are inlined; GLSL has no recursion.

use std::collections::HashMap;
use std::ops::Range;

use super::ops::{Compiled, Kind, LoopOp, Op, Shape, Shaped, Shared, Slot, Varies};
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
struct Parameter<'a> {
    shaped: Shaped,
    name: &'a str,
    ways: [bool; 2],
}

struct Function<'a> {
    name: &'a str,
    result: Shaped,
    parameters: Vec<Parameter<'a>>,
    /// Tokens of the body, with its braces.
    body: Range<usize>,
}

pub struct Compiler<'a> {
    tokens: Vec<Token<'a>>,
    pub at: usize,
    pub structs: Vec<(&'a str, Vec<(&'a str, Shaped)>)>,
    scopes: Vec<HashMap<&'a str, Place>>,
    functions: Vec<Function<'a>>,
    pub ops: Vec<Op>,
    pub next: Slot,
    constants: HashMap<u64, Slot>,
    /// Slots of the results of the function that is inlined.
    result: Vec<Slot>,
    depth: usize,
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
    "in", "out", "inout", "uniform", "flat", "noperspective", "smooth", "const", "invariant", "precise", "highp",
    "layout", "centroid",
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
            "mat2" | "mat3" | "mat4" => {
                Shaped { columns: side(name), ..Shaped::vector(Kind::Float, side(name)) }
            }
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
    fn qualifiers(&mut self) -> Result<Vec<&'a str>, Unknown> {
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
    fn array(&mut self, shaped: Shaped) -> Result<Shaped, Unknown> {
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

    /// A variable of the innermost scope, behind its name.
    fn variable(&mut self, shaped: Shaped, name: &'a str) -> Result<(), Unknown> {
        let count = self.size(shaped);
        let place = if self.takes("=") {
            let value = self.assignment()?;
            let value = self.as_wide(value, count);
            if value.is_new && value.slots.len() == count {
                value.slots
            } else {
                let slots = self.fresh(count);
                self.set(&slots, &value.slots);
                slots
            }
        } else {
            let (slots, nothing) = (self.fresh(count), self.constant(f64::NAN));
            slots.iter().for_each(|slot| self.ops.push(Op::Set(*slot, nothing)));
            slots
        };
        let scope = self.scopes.last_mut().ok_or("no scope")?;
        scope.insert(name, Place::variable(shaped, place));
        Ok(())
    }

    /// Sets variables, all at once.
    pub fn set(&mut self, to: &[Slot], from: &[Slot]) {
        let mut from = from.to_vec();
        if (0..from.len()).any(|index| to[..index.min(to.len())].contains(&from[index])) {
            let copies = self.fresh(from.len());
            copies.iter().zip(&from).for_each(|(to, from)| self.ops.push(Op::Set(*to, *from)));
            from = copies;
        }
        to.iter().zip(from).for_each(|(to, from)| self.ops.push(Op::Set(*to, from)));
    }

    pub fn find(&self, name: &str) -> Option<&Place> {
        self.scopes.iter().rev().find_map(|scope| scope.get(name))
    }

    /// Inlines a call.
    pub fn call(&mut self, name: &str, arguments: Vec<Place>) -> Result<Place, Unknown> {
        let fits = |function: &&Function| {
            function.name == name
                && function.parameters.len() == arguments.len()
                && function.parameters.iter().zip(&arguments).all(|(parameter, given)| {
                    parameter.shaped.rows == given.shaped.rows && parameter.shaped.columns == given.shaped.columns
                })
        };
        let function = self.functions.iter().find(fits).ok_or_else(|| format!("function {name}"))?;
        let (parameters, shaped, body) = (function.parameters.clone(), function.result, function.body.clone());
        self.depth += 1;
        if self.depth > 30 {
            return Err(format!("{name} calls itself"));
        }
        let mut scope = HashMap::new();
        let mut back = Vec::new();
        for (parameter, given) in parameters.iter().zip(&arguments) {
            let slots = self.fresh(self.size(parameter.shaped));
            if parameter.ways[0] {
                self.set(&slots, &given.slots);
            }
            if parameter.ways[1] {
                back.push((given.slots.clone(), slots.clone()));
            }
            scope.insert(parameter.name, Place::variable(parameter.shaped, slots));
        }
        let inner = self.scopes.split_off(1);
        self.scopes.push(scope);
        let count = if shaped == Shaped::VOID { 0 } else { self.size(shaped) };
        let slots = self.fresh(count);
        let outer_result = std::mem::replace(&mut self.result, slots.clone());
        let (outer_ops, outer_at) = (std::mem::take(&mut self.ops), self.at);
        self.at = body.start;
        self.statement()?;
        self.at = outer_at;
        let ops = std::mem::replace(&mut self.ops, outer_ops);
        self.ops.push(Op::Call(ops));
        self.result = outer_result;
        self.scopes.truncate(1);
        self.scopes.extend(inner);
        back.iter().for_each(|(to, from)| self.set(to, from));
        self.depth -= 1;
        Ok(Place::new(shaped, slots))
    }

    /// Operations of what `parse` reads.
    fn apart<T>(&mut self, parse: impl FnOnce(&mut Self) -> Result<T, Unknown>) -> Result<(Vec<Op>, T), Unknown> {
        let outer = std::mem::take(&mut self.ops);
        let result = parse(self)?;
        Ok((std::mem::replace(&mut self.ops, outer), result))
    }

    pub fn statement(&mut self) -> Result<(), Unknown> {
        if self.takes(";") {
            return Ok(());
        }
        if self.takes("{") {
            self.scopes.push(HashMap::new());
            while !self.takes("}") {
                self.statement()?;
            }
            self.scopes.pop();
            return Ok(());
        }
        match self.peek() {
            Some(Token::Word("if")) => self.branch(),
            Some(Token::Word("for" | "while")) => self.repeat(),
            Some(Token::Word("return")) => {
                self.at += 1;
                if !self.is_next(";") {
                    let value = self.assignment()?;
                    let to = self.result.clone();
                    let value = self.as_wide(value, to.len());
                    self.set(&to, &value.slots);
                }
                self.ops.push(Op::Return);
                self.expect(";")
            }
            Some(Token::Word("discard")) => {
                self.at += 1;
                self.out.discards = true;
                self.ops.push(Op::Discard);
                self.expect(";")
            }
            _ => {
                self.simple()?;
                self.expect(";")
            }
        }
    }

    /// A declaration or an expression.
    fn simple(&mut self) -> Result<(), Unknown> {
        self.qualifiers()?;
        let name = match (self.peek(), self.tokens.get(self.at + 1)) {
            (Some(Token::Word(word)), Some(Token::Word(_))) => self.named(word),
            _ => None,
        };
        let Some(shaped) = name else { return self.assignment().map(|_| ()) };
        self.at += 1;
        loop {
            let name = self.word()?;
            let shaped = self.array(shaped)?;
            self.variable(shaped, name)?;
            if !self.takes(",") {
                return Ok(());
            }
        }
    }

    fn branch(&mut self) -> Result<(), Unknown> {
        self.at += 1;
        self.expect("(")?;
        let condition = self.assignment()?.slots[0];
        self.expect(")")?;
        let (then, ()) = self.apart(Self::statement)?;
        let mut other = Vec::new();
        if self.peek() == Some(Token::Word("else")) {
            self.at += 1;
            other = self.apart(Self::statement)?.0;
        }
        self.ops.push(Op::If(condition, then, other));
        Ok(())
    }

    fn repeat(&mut self) -> Result<(), Unknown> {
        let is_for = self.word()? == "for";
        self.expect("(")?;
        self.scopes.push(HashMap::new());
        if is_for {
            self.simple()?;
            self.expect(";")?;
        }
        let (test, holds) = self.apart(|compiler| Ok(compiler.assignment()?.slots[0]))?;
        let mut step = Vec::new();
        if is_for {
            self.expect(";")?;
            step = self.apart(|compiler| compiler.assignment().map(|_| ()))?.0;
        }
        self.expect(")")?;
        let (body, ()) = self.apart(Self::statement)?;
        self.scopes.pop();
        self.ops.push(Op::Loop(Box::new(LoopOp { test, holds, body, step })));
        Ok(())
    }
}

/// The digit at the end of a type's name.
fn side(name: &str) -> usize {
    usize::from(name.as_bytes()[name.len() - 1] - b'0')
}
