//! Ends of random expressions: inputs of a function's range, parts of variables, literals.

use super::code::{Expr, Form};
use super::functions::{Gives, Range};
use super::make::{Maker, Ranges, call, constant, variable, whole};
use crate::conformance::model::number::Num;
use crate::conformance::model::value::{GlslValue, NumberBase, Type};

impl Maker {
    pub fn swizzled(&mut self, inner: Expr, kind: Type) -> Expr {
        let components = (0..kind.rows).map(|_| self.random.below(inner.kind.rows)).collect();
        Expr { kind, form: Form::Swizzle(Box::new(inner), components) }
    }

    /// An index below `count`: a literal, or one that is bounded whatever the numbers are.
    pub fn index(&mut self, count: usize, depth: usize) -> Expr {
        if self.random.chance(0.3) {
            let index = self.random.below(count);
            return whole(index as i64, Type::INT);
        }
        let inner = self.expr(Type::INT, depth.saturating_sub(1).min(1));
        let bound = whole(count as i64, Type::INT);
        if count.is_power_of_two() {
            return call("&", Gives::Integers, vec![inner, whole(count as i64 - 1, Type::INT)], Type::INT);
        }
        let positive = call("&", Gives::Integers, vec![inner, whole(0xFFFF, Type::INT)], Type::INT);
        call("%", Gives::Integers, vec![positive, bound], Type::INT)
    }

    fn input(&mut self, index: usize, kind: Type) -> Expr {
        let whole = variable(index, Type::vector(NumberBase::Float, 4));
        self.swizzled(whole, kind)
    }

    /// Numbers of few values, so that two of them are often equal.
    pub fn few(&mut self, kind: Type) -> Expr {
        let Ranges { special, small_integers, .. } = self.ranges;
        match kind.base {
            NumberBase::Float => self.input(special, kind),
            NumberBase::Bool => self.leaf(kind),
            base => {
                let whole_input = variable(small_integers, Type::vector(NumberBase::Int, 4));
                let inner = self.swizzled(whole_input, kind.of(NumberBase::Int));
                let inner = call("&", Gives::Integers, vec![inner, whole(3, Type::INT)], kind.of(NumberBase::Int));
                if base == NumberBase::Int { inner } else { Expr { kind, form: Form::Construct(vec![inner]) } }
            }
        }
    }

    pub fn ranged(&mut self, kind: Type, range: Range, depth: usize) -> Expr {
        let is_float = kind.base == NumberBase::Float;
        let direct = self.random.chance(0.5);
        let Ranges { positive, unit, small, share, .. } = self.ranges;
        let input = match range {
            Range::Positive => Some(positive),
            Range::NotZero => Some(if self.random.chance(0.5) { positive } else { small }),
            Range::Unit => Some(unit),
            Range::Small => Some(small),
            Range::Share => Some(share),
            _ => None,
        };
        if let (true, true, Some(input)) = (is_float, direct, input) {
            return self.input(input, kind);
        }
        if range == Range::Low && direct {
            let least = self.random.pick(&[0.0, 0.0, 0.0, -1.0, -0.5]);
            return constant(GlslValue::filled(Num::exact(least), kind.scalars()), kind);
        }
        let inner = self.expr(kind, depth);
        let integers = |name, by: i64| call(name, Gives::Integers, vec![inner.clone(), whole(by, kind)], kind);
        match range {
            Range::Positive if is_float => {
                let magnitude = call("abs", Gives::Floats, vec![inner], kind);
                let more = constant(GlslValue::filled(Num::exact(0.125), kind.scalars()), kind);
                if direct { magnitude } else { call("+", Gives::Floats, vec![magnitude, more], kind) }
            }
            Range::Low => {
                let magnitude = call("abs", Gives::Floats, vec![inner], kind);
                call("-", Gives::Floats, vec![whole(0, kind), magnitude], kind)
            }
            Range::Positive => {
                let low = integers("&", 255);
                call("+", Gives::Integers, vec![low, whole(1, kind)], kind)
            }
            Range::Unit => {
                let name = self.random.pick(&["sin", "cos", "fract"]);
                call(name, Gives::Floats, vec![inner], kind)
            }
            Range::Small | Range::Share => {
                let end = if range == Range::Small { 20.0 } else { 1.25 };
                let bound = |value: f64| constant(Num::exact(value).into(), Type::FLOAT);
                call("clamp", Gives::Floats, vec![inner, bound(-end), bound(end)], kind)
            }
            Range::NotZero if !is_float => integers("|", 1),
            Range::NotNegative if kind.base == NumberBase::Int => integers("&", 0x7FFF_FFFF),
            Range::Shift => match self.random.chance(0.5) {
                true => {
                    let by = self.random.below(32);
                    whole(by as i64, kind)
                }
                false => integers("&", 31),
            },
            Range::Direction if kind.rows > 1 => call("normalize", Gives::FloatVector, vec![inner], kind),
            _ => inner,
        }
    }

    /// A variable, a part of one, or a literal.
    pub fn leaf(&mut self, kind: Type) -> Expr {
        for _ in 0..24 {
            if kind.is_vector() && self.random.chance(0.02) {
                break;
            }
            let at = self.random.below(self.scope.len());
            let index = self.scope[at];
            let from = self.program.variables[index].kind;
            let whole = variable(index, from);
            if from == kind {
                return whole;
            }
            if from.is_vector() && kind.is_vector() && from.base == kind.base && from.rows > 1 {
                return self.swizzled(whole, kind);
            }
            if from.element() == kind && !from.is_scalar() {
                let index = self.index(from.elements(), 1);
                return Expr { kind, form: Form::Index(Box::new([whole, index])) };
            }
        }
        match () {
            () if kind.is_matrix() => {
                let columns = (0..kind.columns).map(|_| self.leaf(kind.element())).collect();
                Expr { kind, form: Form::Construct(columns) }
            }
            () if kind.base == NumberBase::Bool && kind.rows == 1 => {
                let base = self.random.pick(&[NumberBase::Float, NumberBase::Int]);
                let sides = vec![self.leaf(kind.of(base)), self.leaf(kind.of(base))];
                let name = self.random.pick(&["<", ">", "<=", ">="]);
                call(name, Gives::OneBool, sides, kind)
            }
            () if kind.base == NumberBase::Bool => {
                let sides = vec![self.leaf(kind.of(NumberBase::Float)), self.leaf(kind.of(NumberBase::Float))];
                call("lessThan", Gives::BoolVector, sides, kind)
            }
            () => self.literal(kind),
        }
    }

    /// Neutral numbers of operators and functions, in all components.
    pub fn simple(&mut self, kind: Type) -> Expr {
        let number = match kind.base {
            NumberBase::Float => self.random.pick(&[0.0, 0.0, 1.0, 1.0, -1.0, 0.5, 2.0]),
            NumberBase::Int => self.random.pick(&[0.0, 1.0, 2.0, -1.0, 8.0]),
            NumberBase::Uint => self.random.pick(&[0.0, 1.0, 2.0, 8.0]),
            NumberBase::Bool => self.random.pick(&[0.0, 1.0]),
        };
        constant(GlslValue::filled(Num::exact(number), kind.scalars()), kind)
    }

    pub fn literal(&mut self, kind: Type) -> Expr {
        const FLOATS: [f64; 14] =
            [0.0, 1.0, -1.0, 0.5, 2.0, -0.25, 3.0, 0.125, 10.0, 1.5, -7.0, 100.0, 0.0078125, 65536.0];
        const INTEGERS: [i64; 12] = [0, 1, 2, 3, 5, 7, 16, 31, 255, 4096, 65535, 0x0F0F_1234];
        let one = |maker: &mut Self| match kind.base {
            NumberBase::Float if maker.random.chance(0.5) => maker.random.pick(&FLOATS),
            NumberBase::Float => (maker.random.below(257) as f64 - 128.0) / 16.0,
            NumberBase::Int if maker.random.chance(0.4) => -(maker.random.below(40) as f64),
            NumberBase::Bool => maker.random.below(2) as f64,
            _ if maker.random.chance(0.5) => maker.random.pick(&INTEGERS) as f64,
            _ => maker.random.below(12) as f64,
        };
        let value = (0..kind.scalars()).map(|_| Num::exact(one(self))).collect();
        constant(value, kind)
    }
}
