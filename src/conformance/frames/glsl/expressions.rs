//! Expressions: operators, swizzles, indices, constructors.

use super::compile::{Compiler, Place, Unknown};
use super::functions as f;
use super::ops::{Kind, Op, Shaped, Slot};
use super::tokens::Token;
use crate::conformance::model::number::Num;

/// Binary operators by their rank, the loosest first.
const RANKS: [&[&str]; 7] =
    [&["||"], &["^^"], &["&&"], &["==", "!="], &["<", ">", "<=", ">="], &["+", "-"], &["*", "/"]];

impl<'a> Compiler<'a> {
    /// An expression with its assignments.
    pub fn assignment(&mut self) -> Result<Place, Unknown> {
        let place = self.choice()?;
        let Some(Token::Sign(sign)) = self.peek() else { return Ok(place) };
        if !["=", "+=", "-=", "*=", "/="].contains(&sign) {
            return Ok(place);
        }
        self.at += 1;
        let mut value = self.assignment()?;
        if sign != "=" {
            value = self.binary(&sign[..1], place.clone(), value)?;
        }
        self.assign(&place, value)?;
        Ok(place)
    }

    fn assign(&mut self, place: &Place, value: Place) -> Result<(), Unknown> {
        let value = self.as_wide(value, place.slots.len());
        if let Some((all, index)) = &place.chosen {
            let (to, from) = (all.clone().into(), value.slots.into());
            self.ops.push(Op::Put { to, index: *index, from });
            return Ok(());
        }
        if value.slots.len() != place.slots.len() {
            return Err(format!("{} values for {}", value.slots.len(), place.slots.len()));
        }
        self.set(&place.slots, &value.slots);
        Ok(())
    }

    /// A scalar as often as is needed.
    pub fn as_wide(&self, value: Place, count: usize) -> Place {
        if value.slots.len() == 1 && count > 1 {
            return Place { slots: vec![value.slots[0]; count], is_new: false, ..value };
        }
        value
    }

    fn choice(&mut self) -> Result<Place, Unknown> {
        let condition = self.ranked(0)?;
        if !self.takes("?") {
            return Ok(condition);
        }
        let first = self.assignment()?;
        self.expect(":")?;
        let second = self.assignment()?;
        let to = self.fresh(first.slots.len());
        for (index, slot) in to.iter().enumerate() {
            let [a, b] = [&first, &second].map(|place| place.slots[index]);
            self.ops.push(Op::Choose(*slot, condition.slots[0], a, b));
        }
        Ok(Place::new(first.shaped, to))
    }

    fn ranked(&mut self, rank: usize) -> Result<Place, Unknown> {
        let Some(signs) = RANKS.get(rank) else { return self.prefixed() };
        let mut left = self.ranked(rank + 1)?;
        while let Some(Token::Sign(sign)) = self.peek()
            && signs.contains(&sign)
        {
            self.at += 1;
            let right = self.ranked(rank + 1)?;
            left = self.binary(sign, left, right)?;
        }
        Ok(left)
    }

    fn prefixed(&mut self) -> Result<Place, Unknown> {
        if self.takes("+") {
            return self.prefixed();
        }
        if self.takes("-") {
            let place = self.prefixed()?;
            return Ok(self.each(place.shaped, &[&place], |op, a| Op::One(Num::negative, op, a[0])));
        }
        if self.takes("!") {
            let place = self.prefixed()?;
            return Ok(self.each(Shaped::BOOL, &[&place], |op, a| Op::One(f::not, op, a[0])));
        }
        for (sign, change) in [("++", "+"), ("--", "-")] {
            if self.takes(sign) {
                let place = self.prefixed()?;
                let one = self.constant(1.0);
                let one = Place::variable(place.shaped, vec![one]);
                let value = self.binary(change, place.clone(), one)?;
                self.assign(&place, value)?;
                return Ok(place);
            }
        }
        self.postfixed()
    }

    fn postfixed(&mut self) -> Result<Place, Unknown> {
        let mut place = self.primary()?;
        loop {
            if self.takes(".") {
                let name = self.word()?;
                place = self.part(place, name)?;
            } else if self.takes("[") {
                let index = self.assignment()?;
                self.expect("]")?;
                place = self.element(place, &index);
            } else {
                return Ok(place);
            }
        }
    }

    /// A member of a struct or a swizzle.
    fn part(&mut self, place: Place, name: &str) -> Result<Place, Unknown> {
        if let Kind::Struct(number) = place.shaped.kind {
            let mut first = 0;
            for (known, shaped) in &self.structs[number].1 {
                let count = shaped.scalars();
                if *known == name {
                    let slots = place.slots[first..first + count].to_vec();
                    return Ok(Place { is_new: false, ..Place::new(*shaped, slots) });
                }
                first += count;
            }
            return Err(format!("member {name}"));
        }
        let index = |letter: char| {
            let sets = ["xyzw", "rgba", "stpq"];
            sets.iter().find_map(|set| set.find(letter)).and_then(|index| place.slots.get(index)).copied()
        };
        let slots: Option<Vec<Slot>> = name.chars().map(index).collect();
        let slots = slots.ok_or_else(|| format!("swizzle {name}"))?;
        Ok(Place::variable(Shaped::vector(place.shaped.kind, slots.len()), slots))
    }

    /// An element of an array, a column of a matrix, a component of a vector.
    fn element(&mut self, place: Place, index: &Place) -> Place {
        let shaped = match place.shaped {
            shaped if shaped.count > 0 => Shaped { count: 0, ..shaped },
            shaped if shaped.is_matrix() => Shaped::vector(shaped.kind, shaped.rows),
            shaped => Shaped::vector(shaped.kind, 1),
        };
        let scalars = self.size(shaped);
        let known = self.constant_of(index.slots[0]);
        if let Some(number) = known {
            let first = (number as usize * scalars).min(place.slots.len() - scalars);
            return Place::variable(shaped, place.slots[first..first + scalars].to_vec());
        }
        let to = self.fresh(scalars);
        let from: Box<[Slot]> = place.slots.clone().into();
        self.ops.push(Op::Pick { to: to[0], scalars, from, index: index.slots[0] });
        Place { chosen: Some((place.slots, index.slots[0])), ..Place::variable(shaped, to) }
    }

    fn primary(&mut self) -> Result<Place, Unknown> {
        let token = self.peek().ok_or("the text ends")?;
        self.at += 1;
        match token {
            Token::Number(value, is_float) => {
                let slot = self.constant(value);
                Ok(Place::variable(if is_float { Shaped::FLOAT } else { Shaped::INT }, vec![slot]))
            }
            Token::Sign("(") => {
                let place = self.assignment()?;
                self.expect(")")?;
                Ok(place)
            }
            Token::Word(name @ ("true" | "false")) => {
                let slot = self.constant(f64::from(u8::from(name == "true")));
                Ok(Place::variable(Shaped::BOOL, vec![slot]))
            }
            Token::Word(name) if self.takes("(") => {
                let mut arguments = Vec::new();
                while !self.takes(")") {
                    arguments.push(self.assignment()?);
                    self.takes(",");
                }
                match self.named(name) {
                    Some(shaped) => self.construct(shaped, arguments),
                    None => match self.built_in_call(name, &arguments)? {
                        Some(result) => Ok(result),
                        None => self.call(name, arguments),
                    },
                }
            }
            Token::Word(name) => self.find(name).cloned().ok_or_else(|| format!("name {name}")),
            token => Err(format!("{token:?} in an expression")),
        }
    }

    /// One operation for each component; scalars are as wide as the others.
    pub fn each(&mut self, shaped: Shaped, given: &[&Place], op: impl Fn(Slot, &[Slot]) -> Op) -> Place {
        let count = given.iter().map(|place| place.slots.len()).max().unwrap_or(1);
        let shaped = if shaped.scalars() == count { shaped } else { Shaped::vector(shaped.kind, count) };
        let to = self.fresh(count);
        for (index, slot) in to.iter().enumerate() {
            let of = |place: &&Place| place.slots[if place.slots.len() == 1 { 0 } else { index }];
            let slots: Vec<Slot> = given.iter().map(of).collect();
            self.ops.push(op(*slot, &slots));
        }
        Place::new(shaped, to)
    }

    pub fn two(&mut self, shaped: Shaped, a: &Place, b: &Place, function: fn(Num, Num) -> Num) -> Place {
        self.each(shaped, &[a, b], |to, slots| Op::Two(function, to, slots[0], slots[1]))
    }

    fn dots(&mut self, shaped: Shaped, pairs: Vec<Vec<[Slot; 2]>>) -> Place {
        let to = self.fresh(pairs.len());
        to.iter().zip(pairs).for_each(|(to, pairs)| self.ops.push(Op::Dot(*to, pairs.into())));
        Place::new(shaped, to)
    }

    pub fn binary(&mut self, sign: &str, a: Place, b: Place) -> Result<Place, Unknown> {
        if sign == "*"
            && (a.shaped.is_matrix() || b.shaped.is_matrix())
            && !a.shaped.is_scalar()
            && !b.shaped.is_scalar()
        {
            return Ok(self.product(&a, &b));
        }
        let wider = if a.slots.len() >= b.slots.len() { a.shaped } else { b.shaped };
        let is_float = a.shaped.kind == Kind::Float || b.shaped.kind == Kind::Float;
        let shaped = if is_float { Shaped { kind: Kind::Float, ..wider } } else { wider };
        let function: fn(Num, Num) -> Num = match sign {
            "+" => Num::plus,
            "-" => Num::minus,
            "*" => Num::times,
            "/" if is_float => Num::over,
            "/" => f::quotient,
            "<" => f::below,
            ">" => f::above,
            "<=" => f::at_most,
            ">=" => f::at_least,
            "&&" => f::both,
            "||" => f::either,
            "^^" => f::differ,
            "==" | "!=" => {
                let parts = self.two(Shaped::BOOL, &a, &b, f::same);
                let mut all = parts.slots[0];
                for part in &parts.slots[1..] {
                    let to = self.fresh(1)[0];
                    self.ops.push(Op::Two(f::both, to, all, *part));
                    all = to;
                }
                let all = Place::new(Shaped::BOOL, vec![all]);
                return Ok(match sign {
                    "==" => all,
                    _ => self.each(Shaped::BOOL, &[&all], |op, a| Op::One(f::not, op, a[0])),
                });
            }
            _ => return Err(format!("operator {sign}")),
        };
        let shaped = if RANKS[..5].iter().any(|signs| signs.contains(&sign)) { Shaped::BOOL } else { shaped };
        Ok(self.two(shaped, &a, &b, function))
    }

    /// A product with a matrix on either side or on both.
    fn product(&mut self, a: &Place, b: &Place) -> Place {
        let vector = |rows| Shaped::vector(Kind::Float, rows);
        if !a.shaped.is_matrix() {
            let rows = b.shaped.rows;
            let column = |column: usize| (0..rows).map(|row| [a.slots[row], b.slots[column * rows + row]]).collect();
            return self.dots(vector(b.shaped.columns), (0..b.shaped.columns).map(column).collect());
        }
        let rows = a.shaped.rows;
        let columns = b.shaped.columns.max(1);
        let inner = a.shaped.columns;
        let mut pairs: Vec<Vec<[Slot; 2]>> = Vec::new();
        for column in 0..columns {
            for row in 0..rows {
                let pair = |k: usize| [a.slots[k * rows + row], b.slots[column * inner + k]];
                pairs.push((0..inner).map(pair).collect());
            }
        }
        let shaped = if b.shaped.is_matrix() { Shaped { columns, ..vector(rows) } } else { vector(rows) };
        self.dots(shaped, pairs)
    }

    /// A constructor.
    fn construct(&mut self, shaped: Shaped, arguments: Vec<Place>) -> Result<Place, Unknown> {
        let count = self.size(shaped);
        let mut slots = Vec::new();
        for argument in &arguments {
            let cuts = shaped.kind == Kind::Int && argument.shaped.kind == Kind::Float;
            let to_bool = shaped.kind == Kind::Bool && argument.shaped.kind != Kind::Bool;
            let converted = match () {
                () if cuts => self.each(argument.shaped, &[argument], |op, a| Op::One(f::whole, op, a[0])),
                () if to_bool => return Err("a conversion to bool".into()),
                () => argument.clone(),
            };
            slots.extend(converted.slots);
        }
        if shaped.is_matrix() && arguments.len() == 1 {
            return Err("a matrix of one argument".into());
        }
        if slots.len() == 1 {
            slots = vec![slots[0]; count];
        }
        slots.truncate(count);
        if slots.len() != count {
            return Err("a constructor with too few arguments".into());
        }
        Ok(Place::variable(shaped, slots))
    }
}
