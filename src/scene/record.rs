//! A record of the keys that readers ask for, with the values that each may have: `glumbra keys` lists it.

use std::ops::RangeInclusive;

use super::plain::{Plain, words};
use crate::process;

/// Values that a key may have.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueForm {
    /// Values of several kinds, which the reader tells apart itself.
    Any,
    /// A string.
    Text,
    /// A file's name.
    File,
    /// `true` or `false`.
    Boolean,
    /// An integer in a range.
    Integer(RangeInclusive<i64>),
    /// A finite number in a range; f64's limits are no bounds.
    Number(RangeInclusive<f64>),
    /// A length above zero.
    Length,
    /// Degrees, strictly between two.
    Angle([f64; 2]),
    /// So many numbers, each in a range.
    Numbers(usize, RangeInclusive<f64>),
    /// One of these strings.
    Choice(Vec<String>),
    /// A table.
    Table,
    /// An array of tables.
    Tables,
}

impl ValueForm {
    /// The values in words.
    pub fn words(&self) -> String {
        let bounds = |range: &RangeInclusive<f64>| match words(range) {
            bounds if bounds.is_empty() => String::new(),
            bounds => format!(" {bounds}"),
        };
        match self {
            Self::Any => String::from("a value"),
            Self::Text => String::from("a string"),
            Self::File => String::from("a file"),
            Self::Boolean => String::from("true, false"),
            Self::Integer(range) => format!("an integer from {} to {}", range.start(), range.end()),
            Self::Number(range) => format!("a number{}", bounds(range)),
            Self::Length => String::from("a length above 0"),
            Self::Angle([low, high]) => format!("degrees above {} and below {}", Plain(*low), Plain(*high)),
            Self::Numbers(count, range) => format!("{count} numbers{}", bounds(range)),
            Self::Choice(names) => {
                let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
                quoted.join(", ")
            }
            Self::Table => String::from("a table"),
            Self::Tables => String::from("an array of tables"),
        }
    }

    /// Tests whether `other`, of the same key, says more.
    fn is_less_than(&self, other: &Self) -> bool {
        match self {
            Self::Any => *other != Self::Any,
            Self::Text => matches!(other, Self::File | Self::Choice(_)),
            Self::Number(range) if words(range).is_empty() => matches!(other, Self::Length | Self::Angle(_)),
            _ => false,
        }
    }
}

/// Does `work`, and returns the dotted names of the keys that it reads on this thread, in order, each with the forms that it
/// may have.
pub fn record<T>(work: impl FnOnce() -> T) -> (T, Vec<(String, Vec<ValueForm>)>) {
    let (done, notes) = process::listen::<T, KeyNote>(work);
    let mut keys: Vec<(String, Vec<ValueForm>)> = Vec::new();
    for KeyNote { key, form } in notes {
        match keys.iter_mut().find(|(name, _)| *name == key) {
            None => keys.push((key, vec![form])),
            Some((_, forms)) => add(forms, form),
        }
    }
    (done, keys)
}

/// A key that is read.
struct KeyNote {
    key: String,
    form: ValueForm,
}

/// Adds a form, unless another says as much or more.
fn add(forms: &mut Vec<ValueForm>, form: ValueForm) {
    forms.retain(|known| !known.is_less_than(&form));
    if !forms.iter().any(|known| *known == form || form.is_less_than(known)) {
        forms.push(form);
    }
}

/// Notes that a key is read, if that is recorded.
pub(super) fn note(make: impl FnOnce() -> (String, ValueForm)) {
    process::note(|| {
        let (key, form) = make();
        KeyNote { key, form }
    });
}
