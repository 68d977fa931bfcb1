//! Random expressions. Each is run at once, and made again if too few pixels know its value.

use super::code::{Expr, Form, Program};
use super::functions::{BITS, FUNCTIONS, Function, Gives, Range, Takes};
use super::run::{Variables, evaluate};
use crate::conformance::model::number::{Num, SLACK};
use crate::conformance::model::value::{GlslValue, NumberBase, Type};
use crate::conformance::random::Random;

/// Inputs that functions of a narrow range take.
#[derive(Clone, Copy, Debug)]
pub struct Ranges {
    pub positive: usize,
    /// Whole numbers and halves.
    pub special: usize,
    /// Integers from -20 to 20.
    pub small_integers: usize,
    /// In [-1, 1].
    pub unit: usize,
    /// In [-20, 20].
    pub small: usize,
    /// Around [0, 1].
    pub share: usize,
    /// A uniform int that is small.
    pub turns: usize,
}

pub struct Maker {
    pub random: Random,
    pub program: Program,
    /// Variables that may be read.
    pub scope: Vec<usize>,
    /// Those of them that may be written.
    pub writable: Vec<usize>,
    /// Variables of each pixel, so far.
    pub pixels: Vec<Variables>,
    pub ranges: Ranges,
    /// Variables that functions see too.
    pub globals: Vec<usize>,
    /// The first variable of the innermost block, if there is one.
    pub block_start: Option<usize>,
    /// True while a function is made that some pixels leave early.
    pub leaves_early: bool,
    /// Functions of the program that write nothing.
    pub pure: Vec<usize>,
    pub functions: Vec<&'static Function>,
    /// How often each function has been used.
    pub uses: Vec<Use>,
}

/// Uses of a function: all of them, and those as a statement's own by the result's columns and rows.
#[derive(Clone, Copy, Default)]
pub struct Use {
    all: usize,
    own: [[usize; 5]; 5],
}

/// Share of pixels whose value may be unknown, or known badly.
const MOST_UNKNOWN: f64 = 0.1;

/// Types of columns of matrices, and the number of columns.
const MATRICES: [(usize, usize); 6] = [(2, 2), (3, 3), (4, 4), (2, 3), (4, 3), (3, 4)];

pub fn variable(index: usize, kind: Type) -> Expr {
    Expr { kind, form: Form::Variable(index) }
}

pub fn constant(value: GlslValue, kind: Type) -> Expr {
    Expr { kind, form: Form::Literal(value) }
}

pub fn whole(value: i64, kind: Type) -> Expr {
    constant(GlslValue::filled(Num::exact(value as f64), kind.scalars()), kind)
}

/// A function by its name and style.
pub fn function(name: &str, gives: Gives) -> &'static Function {
    let is_meant = |function: &&Function| function.name == name && function.gives == gives;
    FUNCTIONS.iter().find(is_meant).unwrap_or(&FUNCTIONS[0])
}

pub fn call(name: &str, gives: Gives, arguments: Vec<Expr>, kind: Type) -> Expr {
    Expr { kind, form: Form::Call(function(name, gives), arguments) }
}

impl Maker {
    pub fn kind(&mut self) -> Type {
        let rows = 1 + self.random.below(4);
        match self.random.below(20) {
            0..=11 => Type::vector(NumberBase::Float, rows),
            12..=14 => Type::vector(NumberBase::Int, rows.min(3)),
            15..=16 => Type::vector(NumberBase::Uint, rows.min(2)),
            17..=18 => Type::vector(NumberBase::Bool, rows),
            _ => self.matrix(),
        }
    }

    fn matrix(&mut self) -> Type {
        let (columns, rows) = self.random.pick(&MATRICES);
        Type::matrix(columns, rows)
    }

    /// Tests whether most pixels know an expression's value, and not all the same.
    fn is_good(&mut self, expr: &Expr) -> bool {
        let (program, pixels) = (&self.program, &mut self.pixels);
        let values: Vec<GlslValue> = pixels.iter_mut().map(|variables| evaluate(program, expr, variables)).collect();
        let may_be_constant = self.random.unit() < 0.1;
        is_good(values.iter(), may_be_constant)
    }

    /// A random expression of a type, at most so deep.
    pub fn expr(&mut self, kind: Type, depth: usize) -> Expr {
        if depth > 0 {
            for _ in 0..12 {
                if let Some(made) = self.candidate(kind, depth)
                    && self.is_good(&made)
                {
                    return made;
                }
            }
        }
        self.leaf(kind)
    }

    fn candidate(&mut self, kind: Type, depth: usize) -> Option<Expr> {
        let expr = match self.random.below(100) {
            0..=6 => {
                let parts = [Type::BOOL, kind, kind].map(|kind| self.expr(kind, depth - 1));
                Expr { kind, form: Form::Select(Box::new(parts)) }
            }
            7..=14 => self.constructor(kind, depth)?,
            15..=20 => self.part(kind, depth)?,
            21..=26 => self.own(kind, depth)?,
            _ => self.function(kind, depth)?,
        };
        Some(expr)
    }

    /// A constructor of scalars and vectors of any base type, or of columns.
    fn constructor(&mut self, kind: Type, depth: usize) -> Option<Expr> {
        let other = |maker: &mut Self| {
            let bases = [NumberBase::Float, NumberBase::Float, NumberBase::Int, NumberBase::Uint, NumberBase::Bool];
            if maker.random.chance(0.6) { kind.base } else { maker.random.pick(&bases) }
        };
        let arguments = match () {
            () if kind.is_matrix() => match self.random.below(4) {
                0 => vec![self.expr(Type::FLOAT, depth - 1)],
                1 => {
                    let from = self.matrix();
                    vec![self.leaf(from)]
                }
                _ => (0..kind.columns).map(|_| self.expr(kind.element(), depth - 1)).collect(),
            },
            () if kind.rows == 1 => {
                let base = self.random.pick(&[NumberBase::Float, NumberBase::Int, NumberBase::Uint, NumberBase::Bool]);
                (base != kind.base).then_some(())?;
                vec![self.expr(kind.of(base), depth - 1)]
            }
            () => {
                let (mut left, mut list) = (kind.rows, Vec::new());
                while left > 0 {
                    let rows = 1 + self.random.below(left.min(3));
                    let base = other(self);
                    list.push(self.expr(Type::vector(base, rows), depth - 1));
                    left -= rows;
                }
                list
            }
        };
        Some(Expr { kind, form: Form::Construct(arguments) })
    }

    /// A swizzle of a vector, or an element by an index that differs from pixel to pixel.
    fn part(&mut self, kind: Type, depth: usize) -> Option<Expr> {
        if !kind.is_vector() {
            return None;
        }
        if self.random.chance(0.5) {
            let from = Type::vector(kind.base, 2 + self.random.below(3));
            let inner = self.expr(from, depth - 1);
            return Some(self.swizzled(inner, kind));
        }
        let from = match () {
            () if kind.rows == 1 => Type::vector(kind.base, 2 + self.random.below(3)),
            () if kind.base == NumberBase::Float => Type::matrix(2 + self.random.below(3), kind.rows),
            () => return None,
        };
        let whole = self.leaf(from);
        let index = self.index(from.elements(), depth);
        // Not of a constructor: an index needs a variable for some old compilers.
        matches!(whole.form, Form::Variable(_)).then(|| Expr { kind, form: Form::Index(Box::new([whole, index])) })
    }

    fn own(&mut self, kind: Type, depth: usize) -> Option<Expr> {
        let has = |own: &&usize| self.program.functions[**own].result == Some(kind);
        let known: Vec<usize> = self.pure.iter().filter(has).copied().collect();
        let own = if known.is_empty() { return None } else { self.random.pick(&known) };
        let parameters = self.program.functions[own].parameters.clone();
        let kinds: Vec<Type> = parameters.iter().map(|(index, _)| self.program.variables[*index].kind).collect();
        let arguments = kinds.into_iter().map(|kind| self.expr(kind, depth - 1)).collect();
        Some(Expr { kind, form: Form::Own(own, arguments) })
    }

    fn function(&mut self, kind: Type, depth: usize) -> Option<Expr> {
        let suits: Vec<usize> =
            (0..self.functions.len()).filter(|index| gives(self.functions[*index].gives, kind)).collect();
        if suits.is_empty() {
            return None;
        }
        // Seldom used ones first.
        let choice =
            [(); 4].map(|()| self.random.pick(&suits)).into_iter().min_by_key(|index| self.uses[*index].all)?;
        self.uses[choice].all += 1;
        let function = self.functions[choice];
        let arguments = self.arguments(function, kind, depth - 1)?;
        Some(Expr { kind, form: Form::Call(function, arguments) })
    }

    /// A function of an expression, of the same type.
    pub fn function_of(&mut self, first: &Expr) -> Option<Expr> {
        let kind = first.kind;
        let suits: Vec<&'static Function> = (self.functions.iter().copied())
            .filter(|function| gives(function.gives, kind) && matches!(function.takes, [(Takes::Same, _), ..]))
            .collect();
        if suits.is_empty() {
            return None;
        }
        let function = self.random.pick(&suits);
        let mut arguments = self.arguments(function, kind, 1)?;
        arguments[0] = first.clone();
        let made = Expr { kind, form: Form::Call(function, arguments) };
        self.is_good(&made).then_some(made)
    }

    /// A call of a function that has been a statement's own with a result of this size least often.
    pub fn seldom(&mut self) -> Option<Expr> {
        for _ in 0..8 {
            let mut some: Vec<(usize, Type)> = Vec::new();
            for _ in 0..40 {
                let choice = self.random.below(self.functions.len());
                some.push((choice, self.kind_of(self.functions[choice].gives)));
            }
            let used = |(choice, kind): &(usize, Type)| self.uses[*choice].own[kind.columns][kind.rows];
            let (choice, kind) = some.into_iter().min_by_key(used)?;
            let function = self.functions[choice];
            // One that is hard to make waits until the others have had as many attempts.
            self.uses[choice].own[kind.columns][kind.rows] += 1;
            for _ in 0..12 {
                let arguments = self.arguments(function, kind, 1);
                let made = arguments.map(|arguments| Expr { kind, form: Form::Call(function, arguments) });
                if let Some(made) = made
                    && self.is_good(&made)
                {
                    return Some(made);
                }
            }
        }
        None
    }

    fn kind_of(&mut self, wanted: Gives) -> Type {
        loop {
            let base = self.random.pick(&[
                NumberBase::Float,
                NumberBase::Float,
                NumberBase::Int,
                NumberBase::Uint,
                NumberBase::Bool,
            ]);
            let vector = Type::vector(base, 1 + self.random.below(4));
            let kind = if matches!(wanted, Gives::Matrix | Gives::SquareMatrix) { self.matrix() } else { vector };
            if gives(wanted, kind) {
                return kind;
            }
        }
    }

    fn arguments(&mut self, function: &'static Function, kind: Type, depth: usize) -> Option<Vec<Expr>> {
        let free = Type::vector(NumberBase::Float, 2 + self.random.below(3));
        let number = self.random.pick(&[
            NumberBase::Float,
            NumberBase::Float,
            NumberBase::Float,
            NumberBase::Int,
            NumberBase::Uint,
        ]);
        let side = 2 + self.random.below(3);
        let (one, few) = (self.random.chance(0.4), self.random.chance(0.5));
        let (count, matrix, booleans) =
            (1 + self.random.below(4), self.matrix(), Type::vector(NumberBase::Bool, 2 + self.random.below(3)));
        let anything = if self.random.chance(0.15) { matrix } else { Type::vector(number, count) };
        let factors = self.factors(kind)?;
        let mut list = Vec::new();
        for (place, (takes, range)) in function.takes.iter().enumerate() {
            let kind = match takes {
                Takes::Same => kind,
                Takes::SameOrOne if one => Type::vector(kind.base, 1),
                Takes::SameOrOne => kind,
                Takes::One => Type::vector(kind.base, 1),
                Takes::Choices => kind.of(NumberBase::Bool),
                Takes::Floats => free,
                Takes::FloatsAlike => kind.of(NumberBase::Float),
                Takes::Numbers => kind.of(number),
                Takes::Anything => anything,
                Takes::Booleans => booleans,
                Takes::Square if kind.is_matrix() => kind,
                Takes::Square => Type::matrix(side, side),
                Takes::Transposed => Type::matrix(kind.rows, kind.columns),
                Takes::Factors => factors[place],
                Takes::Rows => Type::vector(NumberBase::Float, kind.rows),
                Takes::Columns => Type::vector(NumberBase::Float, kind.columns),
            };
            let is_compared = matches!(takes, Takes::Numbers | Takes::Anything) && kind.is_vector();
            list.push(match () {
                () if is_compared && few => self.few(kind),
                // Compilers have rules of their own for these.
                () if kind.is_vector() && *range == Range::Any && self.random.chance(0.1) => self.simple(kind),
                () => self.ranged(kind, *range, depth),
            });
        }
        Some(list)
    }

    /// Types of a product's factors.
    fn factors(&mut self, kind: Type) -> Option<[Type; 2]> {
        let inner = 2 + self.random.below(3);
        Some(match () {
            () if kind.is_matrix() => [Type::matrix(inner, kind.rows), Type::matrix(kind.columns, inner)],
            () if kind.rows > 1 && self.random.chance(0.6) => {
                [Type::matrix(inner, kind.rows), Type::vector(NumberBase::Float, inner)]
            }
            () => [Type::vector(NumberBase::Float, inner), Type::matrix(kind.rows.max(2), inner)],
        })
    }
}

fn gives(gives: Gives, kind: Type) -> bool {
    let Type { base, columns, rows, .. } = kind;
    match gives {
        Gives::Matrix => columns > 0,
        Gives::SquareMatrix => columns == rows,
        _ if columns > 0 => false,
        Gives::Floats => base == NumberBase::Float,
        Gives::OneFloat => base == NumberBase::Float && rows == 1,
        Gives::FloatVector => base == NumberBase::Float && rows > 1,
        Gives::Vec3 => base == NumberBase::Float && rows == 3,
        Gives::Integers => matches!(base, NumberBase::Int | NumberBase::Uint),
        Gives::Signed => base == NumberBase::Int,
        Gives::Unsigned => base == NumberBase::Uint,
        Gives::OneBool => base == NumberBase::Bool && rows == 1,
        Gives::BoolVector => base == NumberBase::Bool && rows > 1,
    }
}

/// Functions of a version of GLSL. In vertex shaders atan of two arguments stands in the place of atan of one, which a
/// driver has wrong under a condition: GL-G2 says so, and would not be heard beside this rule.
pub fn functions(version: u32, is_vertex: bool) -> Vec<&'static Function> {
    let bits = if version >= 330 { BITS } else { &[] };
    let of = |count: usize| move |function: &&Function| function.name == "atan" && function.takes.len() == count;
    let other = FUNCTIONS.iter().find(of(2)).filter(|_| is_vertex);
    let stands = |function: &'static Function| other.filter(|_| of(1)(&function)).unwrap_or(function);
    FUNCTIONS.iter().chain(bits).map(stands).collect()
}

/// Tests whether most values are known to a fiftieth, and not all the same.
pub fn is_good<'a>(values: impl Iterator<Item = &'a GlslValue>, may_be_constant: bool) -> bool {
    let (mut bad, mut count, mut differs) = (0, 0, may_be_constant);
    let mut first: Option<&GlslValue> = None;
    for value in values {
        count += 1;
        let is_bad = |x: &Num| !x.is_known() || SLACK * x.error > 0.02 * (x.value.abs() + 1.0);
        if value.is_empty() || value.iter().any(is_bad) {
            bad += 1;
            continue;
        }
        differs |= first.is_some_and(|first| first != value);
        first = first.or(Some(value));
    }
    differs && f64::from(bad) <= MOST_UNKNOWN * f64::from(count)
}
