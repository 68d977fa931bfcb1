//! GLSL's functions and operators as a table: the name, what it takes and gives, and how it is evaluated.

use crate::conformance::model::number::Num;
use crate::conformance::model::scalars as s;
use crate::conformance::model::value::{GlslValue, NumberBase, Type, unknown};
use crate::conformance::model::vectors::{self as v, Arguments};

/// Place of a function's name in an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    Named,
    Infix,
    Prefix,
}

/// Results that a function may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gives {
    Floats,
    OneFloat,
    FloatVector,
    Vec3,
    /// Signed or unsigned, of any size.
    Integers,
    Signed,
    Unsigned,
    OneBool,
    BoolVector,
    Matrix,
    SquareMatrix,
}

/// An argument's type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// As the result.
    Same,
    /// As the result, or a scalar. All arguments of this kind are alike.
    SameOrOne,
    /// A scalar of the result's base type.
    One,
    /// Booleans, as many as the result has components.
    Choices,
    /// A vector or scalar of floats: all of this kind are alike.
    Floats,
    /// Floats, as many as the result has components.
    FloatsAlike,
    /// Numbers of any base type, as many as the result has components: all of this kind are alike.
    Numbers,
    /// The same, of any number of components; or a matrix.
    Anything,
    Booleans,
    /// A square matrix.
    Square,
    /// The matrix of which the result is the transpose.
    Transposed,
    /// A matrix and what it is multiplied by, in either order, so that the result comes out.
    Factors,
    /// A vector of the result's rows, or of its columns.
    Rows,
    Columns,
}

/// Values for which a function is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    Any,
    Positive,
    /// 0, or below it.
    Low,
    /// From -1 to 1.
    Unit,
    /// Exponents of exp and pow.
    Small,
    NotZero,
    NotNegative,
    /// 0 to 31.
    Shift,
    /// From a little below to a little above [0, 1].
    Share,
    /// Vectors of about unit length.
    Direction,
}

#[derive(Clone, Copy)]
pub enum Evaluate {
    One(fn(Num) -> Num),
    Two(fn(Num, Num) -> Num),
    Three(fn(Num, Num, Num) -> Num),
    /// A function of integers, by the result's base type.
    Integers(fn(i64, i64) -> Option<i64>),
    Whole(fn(Arguments, Type) -> GlslValue),
}

pub struct Function {
    pub name: &'static str,
    pub style: Style,
    pub gives: Gives,
    pub takes: &'static [(Takes, Range)],
    pub evaluate: Evaluate,
    /// A macro's or function's text, which stands before the program.
    pub text: &'static str,
}

impl Function {
    /// The result for arguments with their types.
    pub fn of(&self, a: Arguments, kind: Type) -> GlslValue {
        let part = |which: usize, index: usize| -> Num {
            let value = &a[which].0;
            if value.len() == 1 { value[0] } else { value[index] }
        };
        let each = |function: &dyn Fn(usize) -> Num| (0..kind.scalars()).map(function).collect();
        match self.evaluate {
            Evaluate::One(function) => each(&|i| function(part(0, i))),
            Evaluate::Two(function) => each(&|i| function(part(0, i), part(1, i))),
            Evaluate::Three(function) => each(&|i| function(part(0, i), part(1, i), part(2, i))),
            Evaluate::Integers(operate) if a.len() == 1 => {
                each(&|i| s::integers(part(0, i), Num::exact(0.0), kind.base, operate))
            }
            Evaluate::Integers(operate) => each(&|i| s::integers(part(0, i), part(1, i), kind.base, operate)),
            Evaluate::Whole(function) => function(a, kind),
        }
    }
}

const fn named(name: &'static str, gives: Gives, takes: &'static [(Takes, Range)], evaluate: Evaluate) -> Function {
    Function { name, style: Style::Named, gives, takes, evaluate, text: "" }
}

const fn infix(name: &'static str, gives: Gives, takes: &'static [(Takes, Range)], evaluate: Evaluate) -> Function {
    Function { style: Style::Infix, ..named(name, gives, takes, evaluate) }
}

const fn prefix(name: &'static str, gives: Gives, takes: &'static [(Takes, Range)], evaluate: Evaluate) -> Function {
    Function { style: Style::Prefix, ..named(name, gives, takes, evaluate) }
}

const fn own(
    name: &'static str,
    text: &'static str,
    gives: Gives,
    takes: &'static [(Takes, Range)],
    evaluate: Evaluate,
) -> Function {
    Function { text, ..named(name, gives, takes, evaluate) }
}

use Evaluate::{Integers as Whole32, One, Three, Two, Whole};
use Gives as G;
use Range as R;
use Takes as T;

const SAME: (Takes, Range) = (T::Same, R::Any);
const EITHER: (Takes, Range) = (T::SameOrOne, R::Any);
const LOW: (Takes, Range) = (T::SameOrOne, R::Low);
const HIGH: (Takes, Range) = (T::SameOrOne, R::Positive);
const FREE: (Takes, Range) = (T::Floats, R::Any);
const DIRECTION: (Takes, Range) = (T::Same, R::Direction);
const ALIKE: (Takes, Range) = (T::FloatsAlike, R::Any);
const NUMBERS: (Takes, Range) = (T::Numbers, R::Any);

fn truth(value: Option<bool>) -> Num {
    Num::boolean(value)
}

/// Functions that each version has.
pub const FUNCTIONS: &[Function] = &[
    infix("+", G::Floats, &[SAME, EITHER], Two(Num::plus)),
    infix("-", G::Floats, &[SAME, EITHER], Two(Num::minus)),
    infix("-", G::Floats, &[EITHER, SAME], Two(Num::minus)),
    infix("*", G::Floats, &[SAME, EITHER], Two(Num::times)),
    infix("*", G::Floats, &[EITHER, SAME], Two(Num::times)),
    infix("/", G::Floats, &[SAME, (T::SameOrOne, R::NotZero)], Two(Num::over)),
    infix("/", G::Floats, &[(T::One, R::Any), (T::Same, R::NotZero)], Two(Num::over)),
    prefix("-", G::Floats, &[SAME], One(Num::negative)),
    named("abs", G::Floats, &[SAME], One(Num::magnitude)),
    named("sign", G::Floats, &[SAME], One(s::sign)),
    named("floor", G::Floats, &[SAME], One(|x| x.step(f64::floor))),
    named("ceil", G::Floats, &[SAME], One(|x| x.step(f64::ceil))),
    named("trunc", G::Floats, &[SAME], One(|x| x.step(f64::trunc))),
    named("round", G::Floats, &[SAME], One(s::round)),
    named("roundEven", G::Floats, &[SAME], One(|x| x.step(f64::round_ties_even))),
    named("fract", G::Floats, &[SAME], One(s::fract)),
    named("mod", G::Floats, &[SAME, (T::SameOrOne, R::NotZero)], Two(s::modulus)),
    named("min", G::Floats, &[SAME, EITHER], Two(Num::least)),
    named("max", G::Floats, &[SAME, EITHER], Two(Num::most)),
    named("clamp", G::Floats, &[SAME, LOW, HIGH], Three(s::clamp)),
    named("mix", G::Floats, &[SAME, SAME, (T::SameOrOne, R::Share)], Three(s::mix)),
    named("mix", G::Floats, &[SAME, SAME, (T::Choices, R::Any)], Whole(mix_by_bool)),
    named("step", G::Floats, &[EITHER, SAME], Two(s::step)),
    named("smoothstep", G::Floats, &[LOW, HIGH, SAME], Three(s::smoothstep)),
    named("sqrt", G::Floats, &[(T::Same, R::Positive)], One(s::sqrt)),
    named("inversesqrt", G::Floats, &[(T::Same, R::Positive)], One(s::inversesqrt)),
    named("pow", G::Floats, &[(T::Same, R::Positive), (T::Same, R::Small)], Two(s::pow)),
    named("exp", G::Floats, &[(T::Same, R::Small)], One(s::exp)),
    named("exp2", G::Floats, &[(T::Same, R::Small)], One(s::exp2)),
    named("log", G::Floats, &[(T::Same, R::Positive)], One(s::log)),
    named("log2", G::Floats, &[(T::Same, R::Positive)], One(s::log2)),
    named("sin", G::Floats, &[(T::Same, R::Small)], One(s::sin)),
    named("cos", G::Floats, &[(T::Same, R::Small)], One(s::cos)),
    named("tan", G::Floats, &[(T::Same, R::Small)], One(s::tan)),
    named("asin", G::Floats, &[(T::Same, R::Unit)], One(s::asin)),
    named("acos", G::Floats, &[(T::Same, R::Unit)], One(s::acos)),
    named("atan", G::Floats, &[SAME], One(s::atan)),
    named("atan", G::Floats, &[SAME, SAME], Two(s::atan2)),
    named("radians", G::Floats, &[SAME], One(|x| x.times(Num::off(std::f64::consts::PI / 180.0, 2e-9)))),
    named("degrees", G::Floats, &[SAME], One(|x| x.times(Num::off(180.0 / std::f64::consts::PI, 7e-6)))),
    named("dot", G::OneFloat, &[FREE, FREE], Whole(v::dot_of)),
    named("length", G::OneFloat, &[FREE], Whole(v::length_of)),
    named("distance", G::OneFloat, &[FREE, FREE], Whole(v::distance)),
    named("determinant", G::OneFloat, &[(T::Square, R::Any)], Whole(v::determinant_of)),
    named("cross", G::Vec3, &[SAME, SAME], Whole(v::cross)),
    named("normalize", G::FloatVector, &[SAME], Whole(v::normalize)),
    named("reflect", G::FloatVector, &[SAME, DIRECTION], Whole(v::reflect)),
    named("refract", G::FloatVector, &[DIRECTION, DIRECTION, (T::One, R::Share)], Whole(v::refract)),
    named("faceforward", G::FloatVector, &[SAME, SAME, SAME], Whole(v::faceforward)),
    infix("*", G::FloatVector, &[(T::Factors, R::Any), (T::Factors, R::Any)], Whole(v::product)),
    infix("*", G::Matrix, &[(T::Factors, R::Any), (T::Factors, R::Any)], Whole(v::product)),
    infix("+", G::Matrix, &[SAME, SAME], Two(Num::plus)),
    infix("-", G::Matrix, &[SAME, SAME], Two(Num::minus)),
    infix("*", G::Matrix, &[SAME, (T::One, R::Any)], Two(Num::times)),
    infix("/", G::Matrix, &[SAME, (T::One, R::NotZero)], Two(Num::over)),
    prefix("-", G::Matrix, &[SAME], One(Num::negative)),
    named("matrixCompMult", G::Matrix, &[SAME, SAME], Two(Num::times)),
    named("transpose", G::Matrix, &[(T::Transposed, R::Any)], Whole(v::transpose)),
    named("outerProduct", G::Matrix, &[(T::Rows, R::Any), (T::Columns, R::Any)], Whole(v::outer_product)),
    named("inverse", G::SquareMatrix, &[(T::Square, R::Any)], Whole(v::inverse)),
    infix("+", G::Integers, &[SAME, EITHER], Whole32(|a, b| Some(a + b))),
    infix("-", G::Integers, &[SAME, EITHER], Whole32(|a, b| Some(a - b))),
    infix("*", G::Integers, &[SAME, EITHER], Whole32(|a, b| Some(a.wrapping_mul(b)))),
    infix("/", G::Integers, &[SAME, (T::SameOrOne, R::NotZero)], Whole32(s::quotient)),
    infix("%", G::Integers, &[(T::Same, R::NotNegative), (T::SameOrOne, R::Positive)], Whole32(s::remainder)),
    infix("&", G::Integers, &[SAME, EITHER], Whole32(|a, b| Some(a & b))),
    infix("|", G::Integers, &[SAME, EITHER], Whole32(|a, b| Some(a | b))),
    infix("^", G::Integers, &[SAME, EITHER], Whole32(|a, b| Some(a ^ b))),
    infix("<<", G::Integers, &[SAME, (T::SameOrOne, R::Shift)], Whole32(s::left)),
    infix(">>", G::Integers, &[SAME, (T::SameOrOne, R::Shift)], Whole32(s::right)),
    prefix("~", G::Integers, &[SAME], Whole32(|a, _| Some(!a))),
    prefix("-", G::Integers, &[SAME], Whole32(|a, _| Some(-a))),
    named("abs", G::Signed, &[SAME], Whole32(|a, _| Some(a.abs()))),
    named("sign", G::Signed, &[SAME], Whole32(|a, _| Some(a.signum()))),
    named("min", G::Integers, &[SAME, EITHER], Whole32(|a, b| Some(a.min(b)))),
    named("max", G::Integers, &[SAME, EITHER], Whole32(|a, b| Some(a.max(b)))),
    named("clamp", G::Integers, &[SAME, EITHER, EITHER], Three(s::clamp)),
    infix("<", G::OneBool, &[NUMBERS, NUMBERS], Two(|a, b| truth(a.below(b)))),
    infix(">", G::OneBool, &[NUMBERS, NUMBERS], Two(|a, b| truth(b.below(a)))),
    infix("<=", G::OneBool, &[NUMBERS, NUMBERS], Two(|a, b| truth(b.below(a).map(|above| !above)))),
    infix(">=", G::OneBool, &[NUMBERS, NUMBERS], Two(|a, b| truth(a.below(b).map(|below| !below)))),
    infix("==", G::OneBool, &[(T::Anything, R::Any), (T::Anything, R::Any)], Whole(v::equal)),
    infix("!=", G::OneBool, &[(T::Anything, R::Any), (T::Anything, R::Any)], Whole(v::unequal)),
    infix("&&", G::OneBool, &[SAME, SAME], Two(v::both)),
    infix("||", G::OneBool, &[SAME, SAME], Two(v::either)),
    infix("^^", G::OneBool, &[SAME, SAME], Two(|a, b| truth(a.equals(b).map(|equal| !equal)))),
    prefix("!", G::OneBool, &[SAME], One(|a| truth(a.truth().map(|a| !a)))),
    named("any", G::OneBool, &[(T::Booleans, R::Any)], Whole(v::any)),
    named("all", G::OneBool, &[(T::Booleans, R::Any)], Whole(v::all)),
    named("not", G::BoolVector, &[SAME], One(|a| truth(a.truth().map(|a| !a)))),
    named("lessThan", G::BoolVector, &[NUMBERS, NUMBERS], Two(|a, b| truth(a.below(b)))),
    named("greaterThan", G::BoolVector, &[NUMBERS, NUMBERS], Two(|a, b| truth(b.below(a)))),
    named("lessThanEqual", G::BoolVector, &[NUMBERS, NUMBERS], Two(|a, b| truth(b.below(a).map(|is| !is)))),
    named("greaterThanEqual", G::BoolVector, &[NUMBERS, NUMBERS], Two(|a, b| truth(a.below(b).map(|is| !is)))),
    named("equal", G::BoolVector, &[NUMBERS, NUMBERS], Two(|a, b| truth(a.equals(b)))),
    named("notEqual", G::BoolVector, &[NUMBERS, NUMBERS], Two(|a, b| truth(a.equals(b).map(|is| !is)))),
    named("isnan", G::BoolVector, &[ALIKE], One(|a| truth(a.is_known().then_some(false)))),
    named("isinf", G::BoolVector, &[ALIKE], One(|a| truth(a.is_known().then_some(false)))),
    named("isnan", G::OneBool, &[ALIKE], One(|a| truth(a.is_known().then_some(false)))),
    named("isinf", G::OneBool, &[ALIKE], One(|a| truth(a.is_known().then_some(false)))),
    own("SQUARE", "#define SQUARE(x) ((x) * (x))", G::Floats, &[SAME], One(|x| x.times(x))),
    own(
        "BETWEEN",
        "#define BETWEEN(a, b, t) \\\n    ((a) + ((b) - (a)) * (t))",
        G::OneFloat,
        &[SAME, SAME, SAME],
        Three(|a, b, t| a.plus(b.minus(a).times(t))),
    ),
    own(
        "larger",
        "float larger(float a, float b) { if (a > b) return a; return b; }\n\
         int larger(int a, int b) { return a > b ? a : b; }",
        G::OneFloat,
        &[SAME, SAME],
        Two(Num::most),
    ),
];

fn mix_by_bool(a: Arguments, kind: Type) -> GlslValue {
    (0..kind.scalars()).map(|i| a[2].0[i].truth().map_or(Num::UNKNOWN, |second| a[usize::from(second)].0[i])).collect()
}

/// The constructor of any type.
pub static CONSTRUCT: Function = named("", G::Floats, &[], Whole(v::construct));

/// The choice by ?:.
pub static SELECT: Function = named("?", G::Floats, &[], Whole(select));

fn select(a: Arguments, kind: Type) -> GlslValue {
    a[0].0[0].truth().map_or_else(|| unknown(kind), |first| a[if first { 1 } else { 2 }].0.clone())
}

/// Bits of floats as integers and back, from GLSL 3.30.
pub const BITS: &[Function] = &[
    named("floatBitsToInt", G::Signed, &[ALIKE], One(|x| bits(x, NumberBase::Int))),
    named("floatBitsToUint", G::Unsigned, &[ALIKE], One(|x| bits(x, NumberBase::Uint))),
    own(
        "THERE_AND_BACK",
        "#define THERE_AND_BACK(x) intBitsToFloat(floatBitsToInt(x))",
        G::Floats,
        &[SAME],
        One(|x| x),
    ),
    own(
        "OTHER_SIGN",
        "#define OTHER_SIGN(x) uintBitsToFloat(floatBitsToUint(x) ^ 0x80000000u)",
        G::Floats,
        &[SAME],
        One(Num::negative),
    ),
];

/// Bits of exact floats but 0, which has two signs.
fn bits(x: Num, base: NumberBase) -> Num {
    let is_sure = x.error == 0.0 && x.value != 0.0;
    Num::integer(is_sure.then(|| s::wrapped(i64::from((x.value as f32).to_bits()), base)))
}
