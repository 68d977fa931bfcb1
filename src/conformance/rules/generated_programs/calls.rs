//! Random functions of a program, and calls of them.

use super::code::{Argument, Direction, Expr, Form, Own, Place, Statement};
use super::make::{Maker, variable};
use super::run::run;
use super::statements::Inside;
use crate::conformance::model::value::Type;

impl Maker {
    /// A call of a new function, or of one that is there, with arguments that it writes.
    pub fn call(&mut self) -> Statement {
        let writing: Vec<usize> = (0..self.program.functions.len()).filter(|own| !self.pure.contains(own)).collect();
        let own = match writing.is_empty() || self.leaves_early || self.random.chance(0.7) {
            true => None,
            false => Some(self.random.pick(&writing)),
        };
        let known = own.map(|own| self.program.functions[own].parameters.clone());
        let count = known.as_ref().map_or_else(|| 1 + self.random.below(3), Vec::len);
        let mut arguments: Vec<(Argument, Direction, Type)> = Vec::new();
        let mut written: Vec<usize> = Vec::new();
        for index in 0..count {
            let wanted = known.as_ref().map(|known| (known[index].1, self.program.variables[known[index].0].kind));
            let direction = match wanted {
                Some((direction, _)) => direction,
                None if self.leaves_early => Direction::InOut,
                None => self.random.pick(&[Direction::In, Direction::InOut, Direction::Out]),
            };
            let place = (direction != Direction::In).then(|| self.argument(wanted.map(|w| w.1), &written)).flatten();
            match place {
                Some(place) => {
                    written.push(place.variable);
                    let kind = place.kind;
                    arguments.push((Argument::Out(place), direction, kind));
                }
                None if direction != Direction::In && own.is_some() => return self.assignment(),
                None => {
                    let kind = wanted.map_or_else(|| self.kind(), |wanted| wanted.1);
                    arguments.push((Argument::In(self.expr(kind, 2)), Direction::In, kind));
                }
            }
        }
        let own = own.unwrap_or_else(|| self.new_function(&arguments));
        let result = self.program.functions[own].result;
        let result = result.map(|kind| {
            let index = self.new_variable("v", kind);
            self.declare(index);
            index
        });
        Statement::Call(result, own, arguments.into_iter().map(|(argument, ..)| argument).collect())
    }

    /// A call of a new function without a result, which some pixels leave before it has written all.
    pub fn call_left_early(&mut self) -> Statement {
        self.leaves_early = true;
        let statement = self.call();
        self.leaves_early = false;
        statement
    }

    /// A call of a new function without a result, whose one statement is made of its parameter.
    pub fn call_of(&mut self, kind: Type, argument: Expr, make: impl Fn(Expr) -> Statement) -> Statement {
        let index = self.new_variable("p", kind);
        let own = self.program.functions.len();
        self.program.functions.push(Own {
            name: format!("own{own}"),
            parameters: vec![(index, Direction::In)],
            result: None,
            body: vec![make(variable(index, kind))],
        });
        self.pure.push(own);
        Statement::Call(None, own, vec![Argument::In(argument)])
    }

    /// A place for an argument that is written, of a variable that no other argument writes.
    fn argument(&mut self, kind: Option<Type>, written: &[usize]) -> Option<Place> {
        (0..16).find_map(|_| {
            let place = self.place()?;
            let suits = kind.is_none_or(|kind| kind == place.kind) && place.index.is_none() && place.kind.count == 0;
            (suits && !written.contains(&place.variable)).then_some(place)
        })
    }

    /// A function for such arguments: made with their values for its parameters.
    fn new_function(&mut self, arguments: &[(Argument, Direction, Type)]) -> usize {
        let kept = (self.scope.clone(), self.writable.clone(), self.pixels.clone());
        self.scope.retain(|seen| self.globals.contains(seen));
        self.writable.clear();
        let mut parameters = Vec::new();
        let mut head = Vec::new();
        for (argument, direction, kind) in arguments {
            let index = self.new_variable("p", *kind);
            parameters.push((index, *direction));
            let value = match argument {
                Argument::In(expr) => expr.clone(),
                Argument::Out(place) => {
                    let whole = variable(place.variable, self.program.variables[place.variable].kind);
                    match place.swizzle.is_empty() {
                        true => whole,
                        false => Expr { kind: *kind, form: Form::Swizzle(Box::new(whole), place.swizzle.clone()) },
                    }
                }
            };
            for variables in &mut self.pixels {
                run(&self.program, &[Statement::Declare(index, value.clone())], variables);
            }
            if *direction == Direction::Out {
                head.push(index);
            }
        }
        self.scope.extend(parameters.iter().map(|(index, _)| *index));
        self.writable.extend(parameters.iter().map(|(index, _)| *index));
        let written = arguments.iter().any(|(_, direction, _)| *direction != Direction::In);
        let has_result = !written || (self.random.chance(0.5) && !self.leaves_early);
        let result = has_result.then(|| self.kind());
        let mut body: Vec<Statement> = Vec::new();
        for index in head {
            let kind = self.program.variables[index].kind;
            let value = self.expr(kind, 2);
            let place = Place { variable: index, index: None, swizzle: Vec::new(), kind };
            body.push(Statement::Assign(place, None, value));
        }
        let count = 1 + self.random.below(3);
        let inside = Inside { depth: 1, a_loop: false, a_function: true, result };
        if self.leaves_early {
            body.push(self.early(inside));
        }
        body.extend(self.list(count, inside, None));
        if let Some(kind) = result {
            let value = self.expr(kind, 2);
            body.push(Statement::Return(Some(value)));
        }
        (self.scope, self.writable, self.pixels) = kept;
        let own = self.program.functions.len();
        self.program.functions.push(Own { name: format!("own{own}"), parameters, result, body });
        if !written {
            self.pure.push(own);
        }
        own
    }
}
