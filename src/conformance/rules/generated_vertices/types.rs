//! Types of uniforms.

use crate::conformance::random::Random;

/// DataType of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    Float,
    Signed,
    Unsigned,
    Bool,
}

/// A scalar, vector or matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DataType {
    pub base: Base,
    /// More than one: a matrix.
    pub columns: usize,
    /// Components of a column.
    pub rows: usize,
}

impl DataType {
    pub fn any(dice: &mut Random) -> Self {
        if dice.chance(0.4) {
            return Self { base: Base::Float, columns: dice.whole(2, 4) as usize, rows: dice.whole(2, 4) as usize };
        }
        let base = dice.pick(&[Base::Float, Base::Float, Base::Float, Base::Signed, Base::Unsigned, Base::Bool]);
        Self { base, columns: 1, rows: dice.whole(1, 4) as usize }
    }

    pub fn name(self) -> String {
        let Self { base, columns, rows } = self;
        if columns > 1 {
            return format!("mat{columns}x{rows}");
        }
        let [one, many] = match base {
            Base::Float => ["float", "vec"],
            Base::Signed => ["int", "ivec"],
            Base::Unsigned => ["uint", "uvec"],
            Base::Bool => ["bool", "bvec"],
        };
        if rows == 1 { one.to_owned() } else { format!("{many}{rows}") }
    }

    pub fn numbers(self) -> usize {
        self.columns * self.rows
    }

    /// Expressions of all components' bits as uint, by columns, of the value that `path` names.
    pub fn words(self, path: &str) -> Vec<String> {
        let mut words = Vec::new();
        for column in 0..self.columns {
            for row in 0..self.rows {
                let mut place = path.to_owned();
                if self.columns > 1 {
                    place += &format!("[{column}]");
                }
                if self.rows > 1 {
                    place += &format!("[{row}]");
                }
                words.push(match self.base {
                    Base::Float => format!("floatBitsToUint({place})"),
                    Base::Unsigned => place,
                    Base::Signed | Base::Bool => format!("uint({place})"),
                });
            }
        }
        words
    }
}

/// Bits of an ordinary float; as an integer it may be any.
pub fn word(dice: &mut Random) -> u32 {
    let sign = if dice.chance(0.5) { -1.0 } else { 1.0 };
    match dice.below(8) {
        0 => 0,
        1 => (sign * dice.whole(0, 9) as f32).to_bits(),
        _ => (sign * dice.power(-60.0, 60.0)).to_bits(),
    }
}
