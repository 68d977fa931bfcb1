//! Random statements: declarations, assignments to parts, branches, loops, switches, and calls.

use super::code::{Case, Expr, Form, Loop, Place, Statement, Variable};
use super::functions::{FUNCTIONS, Function, Gives};
use super::make::{Maker, call, function, variable, whole};
use super::run::run;
use crate::conformance::model::number::Num;
use crate::conformance::model::value::{GlslValue, NumberBase, Type};

/// Where a statement stands.
#[derive(Clone, Copy, Default)]
pub struct Inside {
    /// Loops and branches around it.
    pub depth: usize,
    pub a_loop: bool,
    /// True in a function that is no main, with its result.
    pub a_function: bool,
    pub result: Option<Type>,
}

impl Inside {
    fn deeper(self) -> Self {
        Self { depth: self.depth + 1, ..self }
    }
}

impl Maker {
    pub fn new_variable(&mut self, letter: &str, kind: Type) -> usize {
        let index = self.program.variables.len();
        self.program.variables.push(Variable { name: format!("{letter}{index}"), kind });
        index
    }

    /// Makes a variable known from here on.
    pub fn declare(&mut self, index: usize) {
        self.scope.push(index);
        self.writable.push(index);
    }

    pub fn statement(&mut self, inside: Inside) -> Statement {
        let is_short = inside.depth >= 3;
        match self.random.below(100) {
            0..=39 if inside.depth == 0 => self.declaration(),
            0..=11 => self.declaration(),
            12..=53 => self.assignment(),
            54..=57 if inside.a_loop => {
                let jump = if self.random.chance(0.5) { Statement::Break } else { Statement::Continue };
                Statement::If(self.expr(Type::BOOL, 1), vec![jump], Vec::new())
            }
            58..=60 if inside.a_function => self.early(inside),
            61..=68 if inside.a_function && inside.depth == 1 => self.early(inside),
            _ if is_short => self.assignment(),
            54..=66 => self.branch(inside),
            67..=80 => self.turns(inside),
            81..=87 => self.switch(inside),
            88..=90 => Statement::Block(self.body(2, inside.deeper())),
            _ if inside.depth == 0 && !inside.a_function => self.call(),
            _ => self.assignment(),
        }
    }

    /// An assignment of a function of a variable's components to these components.
    pub fn own_components(&mut self) -> Option<Statement> {
        let place = self.place().filter(|place| !place.swizzle.is_empty())?;
        let value = self.of_itself(&place)?;
        Some(Statement::Assign(place, None, value))
    }

    /// A return that some pixels take.
    pub fn early(&mut self, inside: Inside) -> Statement {
        let result = inside.result.map(|kind| self.expr(kind, 1));
        Statement::If(self.expr(Type::BOOL, 1), vec![Statement::Return(result)], Vec::new())
    }

    fn declaration(&mut self) -> Statement {
        if let Some(value) = self.random.chance(0.6).then(|| self.seldom()).flatten() {
            let index = self.new_variable("v", value.kind);
            self.declare(index);
            return Statement::Declare(index, value);
        }
        let mut kind = self.kind();
        let depth = 1 + self.random.below(3);
        let value = match kind.is_vector() && self.random.chance(0.08) {
            true => {
                let parts: Vec<Expr> = (0..2 + self.random.below(8)).map(|_| self.expr(kind, depth - 1)).collect();
                kind = kind.array(parts.len());
                Expr { kind, form: Form::Construct(parts) }
            }
            false => self.expr(kind, depth),
        };
        let index = self.new_variable("v", kind);
        self.hide(index);
        self.declare(index);
        Statement::Declare(index, value)
    }

    /// In a block, a new variable may take the name of one outside, which cannot be seen then.
    fn hide(&mut self, index: usize) {
        let Some(start) = self.block_start else { return };
        if !self.random.chance(0.3) || self.writable.is_empty() {
            return;
        }
        let at = self.random.below(self.writable.len());
        let other = self.writable[at];
        let name = self.program.name(other).to_owned();
        if other < start && !name.contains(['.', '[']) && self.scope.contains(&other) {
            self.program.variables[index].name = name;
            self.scope.retain(|seen| *seen != other);
            self.writable.retain(|seen| *seen != other);
        }
    }

    /// A variable that may be written, or a part of it: swizzles with each component once, elements by an index.
    pub fn place(&mut self) -> Option<Place> {
        if self.writable.is_empty() {
            return None;
        }
        let at = self.random.below(self.writable.len());
        let variable = self.writable[at];
        let mut kind = self.program.variables[variable].kind;
        let mut index = None;
        let may_be_part = !kind.is_vector() || (!kind.is_scalar() && self.random.chance(0.2));
        if may_be_part && (kind.count > 0 || self.random.chance(0.7)) {
            index = Some(self.index(kind.elements(), 1));
            kind = kind.element();
        }
        let mut swizzle = Vec::new();
        if kind.is_vector() && kind.rows > 1 && self.random.chance(0.4) {
            let mut left: Vec<usize> = (0..kind.rows).collect();
            for _ in 0..1 + self.random.below(kind.rows) {
                let at = self.random.below(left.len());
                swizzle.push(left.remove(at));
            }
            kind = Type::vector(kind.base, swizzle.len());
        }
        Some(Place { variable, index, swizzle, kind })
    }

    pub fn assignment(&mut self) -> Statement {
        let Some(place) = self.place() else { return self.declaration() };
        let kind = place.kind;
        let suits = |name: &str| -> Option<&'static Function> {
            let is_meant = |function: &&Function| function.name == name && function.takes.len() == 2;
            let gives = if kind.base == NumberBase::Float { Gives::Floats } else { Gives::Integers };
            FUNCTIONS.iter().filter(is_meant).find(|function| function.gives == gives)
        };
        let operator = match kind.base {
            _ if kind.is_matrix() || self.random.chance(0.4) => None,
            NumberBase::Float => suits(self.random.pick(&["+", "-", "*"])),
            NumberBase::Bool => None,
            _ => suits(self.random.pick(&["+", "-", "*", "&", "|", "^"])),
        };
        if self.random.chance(0.15)
            && let Some(value) = self.of_itself(&place)
        {
            return Statement::Assign(place, None, value);
        }
        let depth = 1 + self.random.below(2);
        let value = self.expr(kind, depth);
        Statement::Assign(place, operator, value)
    }

    /// A function of a place's own value, as in `v.x = max(v.x, y)`.
    fn of_itself(&mut self, place: &Place) -> Option<Expr> {
        let kind = place.kind;
        if place.index.is_some() || !kind.is_vector() || kind.count > 0 {
            return None;
        }
        let whole = variable(place.variable, self.program.variables[place.variable].kind);
        let own = match place.swizzle.is_empty() {
            true => whole,
            false => Expr { kind, form: Form::Swizzle(Box::new(whole), place.swizzle.clone()) },
        };
        (0..8).find_map(|_| self.function_of(&own))
    }

    /// Statements of a block, made with the variables as they are at its start.
    pub fn body(&mut self, count: usize, inside: Inside) -> Vec<Statement> {
        self.list(count, inside, Some(self.program.variables.len()))
    }

    /// Statements of a block, or of a function, whose parameters no variable may hide.
    pub fn list(&mut self, count: usize, inside: Inside, block_start: Option<usize>) -> Vec<Statement> {
        let kept = (self.scope.clone(), self.writable.clone(), self.pixels.clone(), self.block_start);
        self.block_start = block_start;
        let mut list = Vec::new();
        for _ in 0..count {
            let statement = self.statement(inside);
            for variables in &mut self.pixels {
                run(&self.program, std::slice::from_ref(&statement), variables);
            }
            list.push(statement);
        }
        (self.scope, self.writable, self.pixels, self.block_start) = kept;
        list
    }

    fn branch(&mut self, inside: Inside) -> Statement {
        let condition = self.expr(Type::BOOL, 2);
        let count = 1 + self.random.below(2);
        let then = self.body(count, inside.deeper());
        let otherwise = match self.random.below(3) {
            0 => Vec::new(),
            1 if inside.depth < 2 => vec![self.branch(inside.deeper())],
            _ => self.body(1, inside.deeper()),
        };
        Statement::If(condition, then, otherwise)
    }

    fn turns(&mut self, inside: Inside) -> Statement {
        let counter = self.new_variable("k", Type::INT);
        let is_long = inside.depth == 0 && self.random.chance(0.25);
        let end = match self.random.below(10) {
            _ if is_long => {
                let most = self.random.pick(&[20, 33, 65, 70, 100, 130, 200]);
                whole(most, Type::INT)
            }
            0..=4 => {
                let most = self.random.below(9);
                whole(most as i64, Type::INT)
            }
            5..=7 => self.index(12, 1),
            _ => variable(self.ranges.turns, Type::INT),
        };
        for (index, variables) in self.pixels.iter_mut().enumerate() {
            variables.resize(self.program.variables.len(), GlslValue::NONE);
            variables[counter] = Num::exact((index % 5) as f64).into();
        }
        self.scope.push(counter);
        let count = 1 + self.random.below(if is_long { 2 } else { 3 });
        let inner = Inside { a_loop: true, ..inside.deeper() };
        let mut body = Vec::new();
        // A loop alone in a loop is written without braces.
        let nests = !is_long && inside.depth < 2 && self.random.chance(0.25);
        if nests {
            body.push(self.turns(inner));
        }
        if self.random.chance(0.4) && !nests {
            let jump = if self.random.chance(0.7) { Statement::Continue } else { Statement::Break };
            body.push(Statement::If(self.of_counter(counter), vec![jump], Vec::new()));
        }
        if !nests {
            body.extend(self.counted(counter));
            body.extend(self.body(count - 1, inner));
        }
        self.scope.retain(|seen| *seen != counter);
        let first = if self.random.chance(0.8) { 0 } else { self.random.below(5) as i32 - 2 };
        let step = if self.random.chance(0.8) { 1 } else { 2 };
        let turns = Loop { counter, first, end, step, body };
        match self.random.below(10) {
            0..=5 => Statement::For(turns),
            6..=7 => Statement::While(turns),
            _ => Statement::DoWhile(turns),
        }
    }

    /// A condition that holds in some turns.
    fn of_counter(&mut self, counter: usize) -> Expr {
        let turn = variable(counter, Type::INT);
        let (at, step) = (self.random.below(6) as i64, self.random.below(3) as i64 + 1);
        let (name, inner) = match self.random.chance(0.5) {
            true => (">", turn),
            false => ("==", call("&", Gives::Integers, vec![turn, whole(step, Type::INT)], Type::INT)),
        };
        let end = if name == ">" { whole(at + 1, Type::INT) } else { whole(at & step, Type::INT) };
        call(name, Gives::OneBool, vec![inner, end], Type::BOOL)
    }

    /// A sum to which each turn adds something else.
    fn counted(&mut self, counter: usize) -> Option<Statement> {
        for _ in 0..16 {
            let place = self.place()?;
            let kind = place.kind;
            if !kind.is_vector() || kind.base == NumberBase::Bool {
                continue;
            }
            let more = self.expr(Type::INT, 1);
            let turn = variable(counter, Type::INT);
            let by = whole(1 + self.random.below(30) as i64, Type::INT);
            let (share, gives) = match kind.base {
                NumberBase::Float => {
                    (call("+", Gives::Integers, vec![turn, whole(1, Type::INT)], Type::INT), Gives::Floats)
                }
                _ => {
                    let product = call("*", Gives::Integers, vec![turn, by], Type::INT);
                    (call("^", Gives::Integers, vec![product, more], Type::INT), Gives::Integers)
                }
            };
            let share = Expr { kind, form: Form::Construct(vec![share]) };
            return Some(Statement::Assign(place, Some(function("+", gives)), share));
        }
        None
    }

    fn switch(&mut self, inside: Inside) -> Statement {
        let count = 3 + self.random.below(3);
        let value = self.index(count + 1, 2);
        let cases = 2 + self.random.below(count - 1);
        let mut labels: Vec<i32> = (0..count as i32).collect();
        let mut list: Vec<Case> = Vec::new();
        let has_default = self.random.chance(0.7);
        for index in 0..cases {
            let is_default = has_default && index + 1 == cases;
            let mut own = Vec::new();
            for _ in 0..if is_default { 0 } else { 1 + usize::from(self.random.chance(0.3)) } {
                if !labels.is_empty() {
                    let at = self.random.below(labels.len());
                    own.push(labels.remove(at));
                }
            }
            if own.is_empty() && !is_default {
                continue;
            }
            // A jump out of a loop from inside of a switch is `continue` alone.
            let body = self.body(1, Inside { a_loop: false, ..inside.deeper() });
            let falls = self.random.chance(0.25) && index + 1 < cases;
            list.push(Case { labels: own, body, falls });
        }
        if let Some(last) = list.last_mut() {
            last.falls = false;
        }
        Statement::Switch(value, list)
    }
}
