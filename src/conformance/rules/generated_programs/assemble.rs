//! Whole programs: statements that are accepted one by one, results for the targets, and the text of both stages.

use super::code::{Expr, Form, Place, Statement};
use super::functions::Gives;
use super::inputs::{DECLARATIONS, Given, INTEGERS, VECTORS, given};
use super::make::{self, Maker, Use, call, variable, whole};
use super::run::{Ended, Variables, evaluate, run};
use super::statements::Inside;
use crate::conformance::model::number::Num;
use crate::conformance::model::value::{NumberBase, Type};
use crate::conformance::random::Random;

/// Scalars that a program gives: four of each of eight targets.
pub const RESULTS: usize = 32;

/// Attempts at a statement that must be there.
const TRIES: usize = 12;

/// Where a program runs, and where its inputs come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    Vertex,
    Fragment,
    /// A fragment shader that reads its inputs by texelFetch.
    Fetching,
}

impl Stage {
    pub fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex shaders",
            Self::Fragment => "fragment shaders",
            Self::Fetching => "fragment shaders, inputs by texelFetch",
        }
    }
}

pub struct Assembled {
    maker: Maker,
    results: Vec<Expr>,
    version: u32,
    stage: Stage,
}

/// Outcome of a pixel.
pub struct DueNumber {
    pub results: Vec<Num>,
    pub is_discarded: bool,
}

/// How often each function has been used in the programs so far.
#[derive(Default)]
pub struct Uses(Vec<Use>);

/// Makes a program for pixels with these values.
pub fn assemble(random: Random, version: u32, stage: Stage, pixels: Vec<Variables>, uses: &mut Uses) -> Assembled {
    let Given { program, ranges, globals, members } = given();
    let functions = make::functions(version, stage == Stage::Vertex);
    uses.0.resize(functions.len().max(uses.0.len()), Use::default());
    let maker = Maker {
        random,
        program,
        scope: globals.clone(),
        writable: Vec::new(),
        pixels,
        ranges,
        globals,
        block_start: None,
        leaves_early: false,
        pure: Vec::new(),
        uses: std::mem::take(&mut uses.0),
        functions,
    };
    let mut made = Assembled { maker, results: Vec::new(), version, stage };
    made.fill(&members);
    uses.0 = std::mem::take(&mut made.maker.uses);
    made
}

impl Assembled {
    fn fill(&mut self, members: &[usize]) {
        for member in members {
            let kind = self.maker.program.variables[*member].kind;
            let value = self.maker.leaf(kind);
            let place = Place { variable: *member, index: None, swizzle: Vec::new(), kind };
            self.take(Statement::Assign(place, None, value), true);
            self.maker.scope.push(*member);
            self.maker.writable.push(*member);
        }
        let mut written: Vec<usize> = self.constants();
        let discards_at = if self.stage == Stage::Vertex { usize::MAX } else { self.maker.random.below(16) };
        for turn in 0..80 {
            if turn == discards_at {
                let condition = self.maker.expr(Type::BOOL, 2);
                let discard = |condition| Statement::If(condition, vec![Statement::Discard], Vec::new());
                let statement = match self.maker.random.chance(0.5) {
                    true => discard(condition),
                    false => self.maker.call_of(Type::BOOL, condition, discard),
                };
                self.take(statement, false);
            }
            let changed = self.seldom_made(turn);
            written.retain(|variable| !changed.contains(variable));
            written.extend(changed);
            let kept = (self.maker.scope.clone(), self.maker.writable.clone());
            let statement = self.maker.statement(Inside::default());
            match self.take(statement, false) {
                Some(changed) => {
                    written.retain(|variable| !changed.contains(variable));
                    written.extend(changed);
                }
                None => (self.maker.scope, self.maker.writable) = kept,
            }
            let scalars = written.iter().map(|variable| encoded(self.maker.program.variables[*variable].kind));
            if scalars.sum::<usize>() >= RESULTS {
                break;
            }
        }
        let mut results: Vec<Expr> =
            written.iter().flat_map(|index| scalars(*index, self.maker.program.variables[*index].kind)).collect();
        results.resize(RESULTS, whole(0, Type::FLOAT));
        self.results = results;
    }

    /// Constants made of literals, and variables that differ with them.
    fn constants(&mut self) -> Vec<usize> {
        let mut written = Vec::new();
        for kind in [Type::FLOAT, Type::INT, Type::FLOAT] {
            let maker = &mut self.maker;
            let [a, b] = [(); 2].map(|()| whole(maker.random.whole(0, 9).into(), Type::INT));
            let operator = maker.random.pick(&["-", "-", "+", "*"]);
            let folded = call(operator, Gives::Integers, vec![a, b], Type::INT);
            let value = if kind == Type::INT { folded } else { float(folded) };
            let name = maker.new_variable("c", kind);
            self.take(Statement::Constant(name, value), true);
            self.maker.scope.push(name);
            let gives = if kind == Type::INT { Gives::Integers } else { Gives::Floats };
            let more = self.maker.leaf(kind);
            let sum = call("+", gives, vec![variable(name, kind), more], kind);
            let index = self.maker.new_variable("v", kind);
            let kept = (self.maker.scope.clone(), self.maker.writable.clone());
            self.maker.declare(index);
            match self.take(Statement::Declare(index, sum), false) {
                Some(changed) => written.extend(changed),
                None => (self.maker.scope, self.maker.writable) = kept,
            }
        }
        written
    }

    /// Statements that chance makes too seldom, each in every program: a variable that is assigned a function of its own
    /// components, and a function without a result that some pixels leave early. The variables that they change.
    fn seldom_made(&mut self, turn: usize) -> Vec<usize> {
        for _ in 0..TRIES {
            let kept = (self.maker.scope.clone(), self.maker.writable.clone());
            let statement = match turn {
                2 | 5 => self.maker.own_components(),
                4 => Some(self.maker.call_left_early()),
                _ => return Vec::new(),
            };
            if let Some(changed) = statement.and_then(|statement| self.take(statement, false)) {
                return changed;
            }
            (self.maker.scope, self.maker.writable) = kept;
        }
        Vec::new()
    }

    /// Accepts a statement, unless it leaves too much open: the variables that it changes.
    fn take(&mut self, statement: Statement, always: bool) -> Option<Vec<usize>> {
        let maker = &mut self.maker;
        let mut after = maker.pixels.clone();
        let (mut lost, mut discarded) = (0, 0);
        for variables in after.iter_mut().filter(|variables| !variables.is_empty()) {
            match run(&maker.program, std::slice::from_ref(&statement), variables) {
                Ended::Whole => {}
                Ended::Lost => lost += 1,
                Ended::Discarded => discarded += 1,
            }
        }
        let writable = maker.writable.clone();
        let at = |pixels: &[Variables], pixel: usize, index: usize| pixels[pixel].get(index).cloned();
        let count = after.len();
        let is_changed =
            |index: &usize| (0..count).any(|pixel| at(&after, pixel, *index) != at(&maker.pixels, pixel, *index));
        let changed: Vec<usize> = writable.into_iter().filter(is_changed).collect();
        let is_good = |index: &usize| make::is_good((0..count).map(|pixel| &after[pixel][*index]), false);
        let is_jump = |statement: &Statement| matches!(statement, Statement::If(_, then, _) if matches!(then[..], [Statement::Discard]));
        let is_discard = match &statement {
            Statement::Call(None, own, _) => maker.program.functions[*own].body.first().is_some_and(is_jump),
            other => is_jump(other),
        };
        let suits = match is_discard {
            true => (2..count / 2).contains(&discarded),
            false => !changed.is_empty() && changed.iter().all(is_good),
        };
        if !always && (lost > count / 40 || !suits) {
            return None;
        }
        maker.pixels = after;
        maker.program.body.push(statement);
        Some(changed)
    }

    /// Results of pixels with these values.
    pub fn due(&self, pixels: Vec<Variables>) -> Vec<DueNumber> {
        let program = &self.maker.program;
        let of_pixel = |mut variables: Variables| {
            let ended = run(program, &program.body, &mut variables);
            let results = match ended {
                Ended::Whole => {
                    self.results.iter().map(|result| evaluate(program, result, &mut variables)[0]).collect()
                }
                _ => vec![Num::UNKNOWN; RESULTS],
            };
            DueNumber { results, is_discarded: ended == Ended::Discarded }
        };
        pixels.into_iter().map(of_pixel).collect()
    }

    /// A result's number and text.
    pub fn source_of(&self, result: usize) -> String {
        format!("result {result}, {}", self.maker.program.expression(&self.results[result]))
    }

    /// Both stages' text.
    pub fn sources(&self) -> [String; 2] {
        let version = format!("#version {}\n", self.version);
        let program = &self.maker.program;
        let functions = make::functions(self.version, self.stage == Stage::Vertex);
        let own: String = functions
            .iter()
            .map(|function| function.text)
            .filter(|text| !text.is_empty())
            .collect::<Vec<_>>()
            .join("\n");
        let head = format!("{DECLARATIONS}{own}\n{}", program.functions());
        let inputs = ["a", "m", "s", "p", "w", "n", "t", "h"];
        let copies = |prefix: &str| -> String {
            inputs.iter().enumerate().map(|(index, name)| format!("{name} = {prefix}{index}; ")).collect()
        };
        let body = program.statements(&program.body, 1);
        let results: String = (0..8)
            .map(|target| {
                let part = |index: usize| program.expression(&self.results[4 * target + index]);
                format!("    r{target} = vec4({}, {}, {}, {});\n", part(0), part(1), part(2), part(3))
            })
            .collect();
        let main = format!("    {INTEGERS}\n{body}{results}");
        let attributes = listed(VECTORS, |index| format!("in vec4 x{index};"));
        let fetches = listed(VECTORS, |index| {
            format!("vec4 x{index} = texelFetch(inputs, ivec2(int(gl_FragCoord.x), {index}), 0);")
        });
        let place = "gl_Position = position;";
        match self.stage {
            Stage::Vertex => [
                format!(
                    "{version}in vec4 position; {attributes}\n{}\n{head}void main() {{\n    {place} {}\n{main}}}\n",
                    listed(8, |index| format!("flat out vec4 r{index};")),
                    copies("x"),
                ),
                format!(
                    "{version}{}\n{}\nvoid main() {{ {} }}\n",
                    listed(8, |index| format!("flat in vec4 r{index};")),
                    listed(8, |index| format!("out vec4 {};", OUTPUTS[index])),
                    listed(8, |index| format!("{} = r{index};", OUTPUTS[index])),
                ),
            ],
            Stage::Fragment => [
                format!(
                    "{version}in vec4 position; {attributes}\n{}\nvoid main() {{ {place} {} }}\n",
                    listed(VECTORS, |index| format!("flat out vec4 y{index};")),
                    listed(VECTORS, |index| format!("y{index} = x{index};")),
                ),
                format!(
                    "{version}{}\n{}\n{head}void main() {{\n    {}\n    {}\n{main}}}\n",
                    listed(VECTORS, |index| format!("flat in vec4 y{index};")),
                    outputs(),
                    listed(VECTORS, |index| format!("vec4 x{index} = y{index};")),
                    copies("x"),
                ),
            ],
            Stage::Fetching => [
                format!("{version}in vec4 position;\nvoid main() {{ {place} }}\n"),
                format!(
                    "{version}uniform sampler2D inputs;\n{}\n{head}void main() {{\n    {fetches}\n    {}\n{main}}}\n",
                    outputs(),
                    copies("x"),
                ),
            ],
        }
    }
}

/// Names of fragment outputs, as the bench binds them.
const OUTPUTS: [&str; 8] = ["result", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth"];

fn outputs() -> String {
    listed(8, |index| format!("out vec4 {0};\n#define r{index} {0}\n", OUTPUTS[index]))
}

fn listed(count: usize, text: impl Fn(usize) -> String) -> String {
    (0..count).map(|index| text(index) + " ").collect()
}

/// Scalars that stand for a variable: one for booleans, two for integers.
fn encoded(kind: Type) -> usize {
    match kind.base {
        _ if kind.count > 0 => 0,
        NumberBase::Int | NumberBase::Uint => 2,
        NumberBase::Bool => 1,
        NumberBase::Float => kind.rows,
    }
}

fn at(inner: &Expr, place: usize) -> Expr {
    let index = whole(place as i64, Type::INT);
    Expr { kind: inner.kind.element(), form: Form::Index(Box::new([inner.clone(), index])) }
}

fn float(inner: Expr) -> Expr {
    Expr { kind: Type::FLOAT, form: Form::Construct(vec![inner]) }
}

/// Floats that change if any part of a variable does: sums of columns, a number of integers' bits in two halves.
fn scalars(index: usize, kind: Type) -> Vec<Expr> {
    let all = variable(index, kind);
    let one = Type::vector(kind.base, 1);
    let parts: Vec<Expr> = match kind.is_scalar() {
        true => vec![all.clone()],
        false => (0..kind.elements()).map(|place| at(&all, place)).collect(),
    };
    let integers = |name, a: Expr, b: Expr| call(name, Gives::Integers, vec![a, b], one);
    match kind.base {
        _ if kind.count > 0 => Vec::new(),
        NumberBase::Float if kind.is_matrix() => {
            let weighed = parts.into_iter().zip([1.0, 2.0, -3.0, 0.5]).map(|(column, weight)| {
                let weight = make::constant(Num::exact(weight).into(), Type::FLOAT);
                let kind = column.kind;
                call("*", Gives::Floats, vec![column, weight], kind)
            });
            let sum = weighed.reduce(|a, b| {
                let kind = a.kind;
                call("+", Gives::Floats, vec![a, b], kind)
            });
            sum.map_or_else(Vec::new, |sum| (0..kind.rows).map(|row| at(&sum, row)).collect())
        }
        NumberBase::Float => parts,
        NumberBase::Bool => {
            let bit = |(place, part): (usize, Expr)| {
                let weight = make::constant(Num::exact(f64::from(1 << place)).into(), Type::FLOAT);
                call("*", Gives::Floats, vec![float(part), weight], Type::FLOAT)
            };
            let sum =
                parts.into_iter().enumerate().map(bit).reduce(|a, b| call("+", Gives::Floats, vec![a, b], Type::FLOAT));
            sum.into_iter().collect()
        }
        NumberBase::Int | NumberBase::Uint => {
            let mixed = parts.into_iter().reduce(|a, b| integers("^", integers("*", a, whole(31, one)), b));
            let halves = |mixed: Expr| {
                vec![
                    float(integers(">>", mixed.clone(), whole(16, one))),
                    float(integers("&", mixed, whole(0xFFFF, one))),
                ]
            };
            mixed.map_or_else(Vec::new, halves)
        }
    }
}
