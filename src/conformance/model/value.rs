//! Types and values of GLSL, as the model has them.

use super::number::Num;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberBase {
    Float,
    Int,
    Uint,
    Bool,
}

/// A scalar, a vector, a matrix of floats, or an array of scalars or vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Type {
    pub base: NumberBase,
    /// 0: no matrix.
    pub columns: usize,
    /// Components of a vector or of a column.
    pub rows: usize,
    /// 0: no array.
    pub count: usize,
}

impl Type {
    pub const FLOAT: Self = Self::vector(NumberBase::Float, 1);
    pub const INT: Self = Self::vector(NumberBase::Int, 1);
    pub const BOOL: Self = Self::vector(NumberBase::Bool, 1);

    pub const fn vector(base: NumberBase, rows: usize) -> Self {
        Self { base, columns: 0, rows, count: 0 }
    }

    pub const fn matrix(columns: usize, rows: usize) -> Self {
        Self { base: NumberBase::Float, columns, rows, count: 0 }
    }

    pub fn array(self, count: usize) -> Self {
        Self { count, ..self }
    }

    pub fn of(self, base: NumberBase) -> Self {
        Self { base, ..self }
    }

    pub fn is_matrix(self) -> bool {
        self.columns > 0 && self.count == 0
    }

    pub fn is_vector(self) -> bool {
        self.columns == 0 && self.count == 0
    }

    pub fn is_scalar(self) -> bool {
        self.is_vector() && self.rows == 1
    }

    /// Scalars that it consists of.
    pub fn scalars(self) -> usize {
        self.columns.max(1) * self.rows * self.count.max(1)
    }

    /// The type of an element, a column or a component.
    pub fn element(self) -> Self {
        match self {
            Self { count: 1.., .. } => Self { count: 0, ..self },
            Self { columns: 1.., .. } => Self::vector(self.base, self.rows),
            _ => Self::vector(self.base, 1),
        }
    }

    /// Elements, columns or components.
    pub fn elements(self) -> usize {
        self.scalars() / self.element().scalars()
    }

    /// GLSL's name, of an array that of the element.
    pub fn name(self) -> String {
        let Self { base, columns, rows, .. } = self;
        let [scalar, letter] = match base {
            NumberBase::Float => ["float", ""],
            NumberBase::Int => ["int", "i"],
            NumberBase::Uint => ["uint", "u"],
            NumberBase::Bool => ["bool", "b"],
        };
        match (columns, rows) {
            (0, 1) => scalar.to_owned(),
            (0, _) => format!("{letter}vec{rows}"),
            _ if columns == rows => format!("mat{rows}"),
            _ => format!("mat{columns}x{rows}"),
        }
    }
}

/// Scalars in GLSL's order: matrices by columns. Up to four lie in the value itself.
#[derive(Clone, Debug, PartialEq)]
pub struct GlslValue {
    few: [Num; 4],
    count: usize,
    /// All of them, if there are more.
    many: Vec<Num>,
}

impl GlslValue {
    pub const NONE: Self = Self { few: [Num::UNKNOWN; 4], count: 0, many: Vec::new() };

    pub fn filled(x: Num, count: usize) -> Self {
        std::iter::repeat_n(x, count).collect()
    }

    fn push(&mut self, x: Num) {
        match self.count {
            0..4 => self.few[self.count] = x,
            4 => {
                self.many.extend(self.few);
                self.many.push(x);
            }
            _ => self.many.push(x),
        }
        self.count += 1;
    }
}

impl FromIterator<Num> for GlslValue {
    fn from_iter<T: IntoIterator<Item = Num>>(list: T) -> Self {
        let mut value = Self::NONE;
        list.into_iter().for_each(|x| value.push(x));
        value
    }
}

impl From<Num> for GlslValue {
    fn from(x: Num) -> Self {
        Self { few: [x, Num::UNKNOWN, Num::UNKNOWN, Num::UNKNOWN], count: 1, many: Vec::new() }
    }
}

impl From<&[Num]> for GlslValue {
    fn from(list: &[Num]) -> Self {
        list.iter().copied().collect()
    }
}

impl std::ops::Deref for GlslValue {
    type Target = [Num];

    fn deref(&self) -> &[Num] {
        if self.count > 4 { &self.many } else { &self.few[..self.count] }
    }
}

impl std::ops::DerefMut for GlslValue {
    fn deref_mut(&mut self) -> &mut [Num] {
        if self.count > 4 { &mut self.many } else { &mut self.few[..self.count] }
    }
}

pub fn unknown(kind: Type) -> GlslValue {
    GlslValue::filled(Num::UNKNOWN, kind.scalars())
}

/// A scalar as the text of a literal: floats are dyadic and of few digits.
pub fn literal(value: f64, base: NumberBase) -> String {
    match base {
        NumberBase::Float => format!("{value:?}"),
        NumberBase::Int if value as i64 == i64::from(i32::MIN) => "(-2147483647 - 1)".to_owned(),
        NumberBase::Int => format!("{}", value as i64),
        NumberBase::Uint if value >= 65536.0 => format!("{:#x}u", value as i64),
        NumberBase::Uint => format!("{}u", value as i64),
        NumberBase::Bool => (value != 0.0).to_string(),
    }
}
