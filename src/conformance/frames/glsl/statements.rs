//! Statements, variables and calls, which are inlined.

use std::collections::HashMap;

use super::compile::{Compiler, Function, Place, Unknown};
use super::ops::{LoopOp, Op, Shaped, Slot};
use super::tokens::Token;

impl<'a> Compiler<'a> {
    /// A variable of the innermost scope, behind its name.
    pub fn variable(&mut self, shaped: Shaped, name: &'a str) -> Result<(), Unknown> {
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
