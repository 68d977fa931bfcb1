//! The interpreter: one pixel's run of a program. What GLSL leaves open is unknown, and all that depends on it.

use super::code::{Argument, Case, Direction, Expr, Form, Loop, Place, Program, Statement};
use super::functions::{CONSTRUCT, Function, SELECT};
use crate::conformance::model::number::Num;
use crate::conformance::model::value::{GlslValue, Type, unknown};

/// Variables of one pixel.
pub type Variables = Vec<GlslValue>;

/// Statements that one pixel may run before a program counts as too long.
const MOST_STEPS: usize = 6000;

/// How a statement ends.
#[derive(Clone, Debug, PartialEq)]
enum Flow {
    Next,
    Break,
    Continue,
    Return(Option<GlslValue>),
    Discard,
    /// The way taken depends on what is open.
    Lost,
}

/// How a pixel's run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    Whole,
    Discarded,
    /// Nothing that it has written since is known.
    Lost,
}

struct Run<'a> {
    program: &'a Program,
    variables: &'a mut Variables,
    steps: usize,
}

/// Runs statements on a pixel's variables.
pub fn run(program: &Program, list: &[Statement], variables: &mut Variables) -> Ended {
    variables.resize(program.variables.len(), GlslValue::NONE);
    let mut run = Run { program, variables, steps: 0 };
    match run.list(list) {
        Flow::Discard => Ended::Discarded,
        Flow::Lost => Ended::Lost,
        _ => Ended::Whole,
    }
}

/// Finds an expression's value. Functions of the program write their own variables alone.
pub fn evaluate(program: &Program, expr: &Expr, variables: &mut Variables) -> GlslValue {
    variables.resize(program.variables.len(), GlslValue::NONE);
    Run { program, variables, steps: 0 }.value(expr)
}

impl Run<'_> {
    fn value(&mut self, expr: &Expr) -> GlslValue {
        match &expr.form {
            Form::Literal(value) => value.clone(),
            Form::Variable(variable) => self.read(*variable),
            Form::Call(function, arguments) => self.applied(function, arguments, expr.kind),
            Form::Construct(arguments) => self.applied(&CONSTRUCT, arguments, expr.kind),
            Form::Select(parts) => self.applied(&SELECT, &parts[..], expr.kind),
            Form::Swizzle(inner, components) => {
                let value = self.value(inner);
                components.iter().map(|component| value[*component]).collect()
            }
            Form::Index(parts) => {
                let (value, index) = (self.value(&parts[0]), self.value(&parts[1])[0].whole());
                let size = expr.kind.scalars();
                let at = index.and_then(|index| usize::try_from(index).ok()).map(|index| index * size);
                at.and_then(|at| value.get(at..at + size)).map_or_else(|| unknown(expr.kind), GlslValue::from)
            }
            Form::Own(function, arguments) => {
                let arguments: Vec<GlslValue> = arguments.iter().map(|argument| self.value(argument)).collect();
                let parameters = &self.program.functions[*function].parameters;
                for ((parameter, _), value) in parameters.iter().zip(arguments) {
                    self.variables[*parameter] = value;
                }
                match self.list(&self.program.functions[*function].body) {
                    Flow::Return(Some(value)) => value,
                    _ => unknown(expr.kind),
                }
            }
        }
    }

    fn read(&self, variable: usize) -> GlslValue {
        match &self.variables[variable] {
            value if value.is_empty() => unknown(self.program.variables[variable].kind),
            value => value.clone(),
        }
    }

    fn applied(&mut self, function: &Function, arguments: &[Expr], kind: Type) -> GlslValue {
        let arguments: Vec<(GlslValue, Type)> =
            arguments.iter().map(|argument| (self.value(argument), argument.kind)).collect();
        function.of(&arguments, kind)
    }

    fn list(&mut self, list: &[Statement]) -> Flow {
        for statement in list {
            match self.statement(statement) {
                Flow::Next => {}
                flow => return flow,
            }
        }
        Flow::Next
    }

    fn statement(&mut self, statement: &Statement) -> Flow {
        self.steps += 1;
        if self.steps > MOST_STEPS {
            return Flow::Lost;
        }
        match statement {
            Statement::Declare(variable, expr) | Statement::Constant(variable, expr) => {
                self.variables[*variable] = self.value(expr)
            }
            Statement::Assign(place, operator, expr) => self.assign(place, *operator, expr),
            Statement::If(condition, then, otherwise) => {
                return match self.value(condition)[0].truth() {
                    Some(true) => self.list(then),
                    Some(false) => self.list(otherwise),
                    None => Flow::Lost,
                };
            }
            Statement::For(turns) => return self.turns(turns, false, false),
            Statement::While(turns) => return self.turns(turns, true, false),
            Statement::DoWhile(turns) => return self.turns(turns, true, true),
            Statement::Switch(expr, cases) => return self.switch(expr, cases),
            Statement::Block(list) => return self.list(list),
            Statement::Break => return Flow::Break,
            Statement::Continue => return Flow::Continue,
            Statement::Return(expr) => return Flow::Return(expr.as_ref().map(|expr| self.value(expr))),
            Statement::Discard => return Flow::Discard,
            Statement::Call(result, function, arguments) => return self.call(*result, *function, arguments),
        }
        Flow::Next
    }

    fn assign(&mut self, place: &Place, operator: Option<&Function>, expr: &Expr) {
        let value = self.value(expr);
        let value = match operator {
            Some(operator) => {
                let old = self.part(place);
                operator.of(&[(old, place.kind), (value, expr.kind)], place.kind)
            }
            None => value,
        };
        self.write(place, &value);
    }

    /// First scalar of a place's element, if it is known.
    fn start(&mut self, place: &Place) -> Option<usize> {
        let kind = self.program.variables[place.variable].kind;
        let Some(index) = &place.index else { return Some(0) };
        let index = self.value(index)[0].whole()?;
        usize::try_from(index)
            .ok()
            .filter(|index| *index < kind.elements())
            .map(|index| index * kind.element().scalars())
    }

    /// Where the scalars of a place lie.
    fn scalars(place: &Place, start: usize) -> impl Iterator<Item = usize> {
        let whole = place.swizzle.is_empty();
        (0..place.kind.scalars()).map(move |index| start + if whole { index } else { place.swizzle[index] })
    }

    fn part(&mut self, place: &Place) -> GlslValue {
        let Some(start) = self.start(place) else { return unknown(place.kind) };
        let value = self.read(place.variable);
        Self::scalars(place, start).map(|at| value[at]).collect()
    }

    fn write(&mut self, place: &Place, value: &[Num]) {
        let start = self.start(place);
        let mut whole = self.read(place.variable);
        match start {
            Some(start) => {
                for (at, x) in Self::scalars(place, start).zip(value.iter()) {
                    whole[at] = *x;
                }
            }
            None => whole.fill(Num::UNKNOWN),
        }
        self.variables[place.variable] = whole;
    }

    /// `before`: the counter goes on before the body; `later`: the end is asked after a turn.
    fn turns(&mut self, turns: &Loop, before: bool, later: bool) -> Flow {
        let set = |run: &mut Self, counter: i64| run.variables[turns.counter] = Num::exact(counter as f64).into();
        let (mut counter, mut asks) = (i64::from(turns.first), !later);
        set(self, counter);
        loop {
            if asks {
                match self.value(&turns.end)[0].whole() {
                    Some(end) if counter < end => {}
                    Some(_) => return Flow::Next,
                    None => return Flow::Lost,
                }
            }
            asks = true;
            if before {
                counter += i64::from(turns.step);
                set(self, counter);
            }
            self.steps += 1;
            match self.list(&turns.body) {
                Flow::Next | Flow::Continue => {}
                Flow::Break => return Flow::Next,
                flow => return flow,
            }
            if !before {
                counter += i64::from(turns.step);
                set(self, counter);
            }
        }
    }

    fn switch(&mut self, expr: &Expr, cases: &[Case]) -> Flow {
        let Some(value) = self.value(expr)[0].whole() else { return Flow::Lost };
        let is_meant = |case: &Case| case.labels.iter().any(|label| i64::from(*label) == value);
        let first = cases.iter().position(is_meant).or_else(|| cases.iter().position(|case| case.labels.is_empty()));
        for case in first.map_or(&[][..], |first| &cases[first..]) {
            match self.list(&case.body) {
                Flow::Next => {}
                Flow::Break => return Flow::Next,
                flow => return flow,
            }
            if !case.falls {
                break;
            }
        }
        Flow::Next
    }

    fn call(&mut self, result: Option<usize>, function: usize, arguments: &[Argument]) -> Flow {
        let program = self.program;
        let own = &program.functions[function];
        for ((parameter, direction), argument) in own.parameters.iter().zip(arguments) {
            self.variables[*parameter] = match argument {
                Argument::In(expr) => self.value(expr),
                Argument::Out(place) if *direction == Direction::InOut => self.part(place),
                Argument::Out(place) => unknown(place.kind),
            };
        }
        let returned = match self.list(&own.body) {
            Flow::Return(value) => value,
            Flow::Next => None,
            flow => return flow,
        };
        for ((parameter, _), argument) in own.parameters.iter().zip(arguments) {
            if let Argument::Out(place) = argument {
                let value = self.read(*parameter);
                self.write(place, &value);
            }
        }
        if let Some(result) = result {
            self.variables[result] = returned.unwrap_or_else(|| unknown(program.variables[result].kind));
        }
        Flow::Next
    }
}
