//! A record of the keys that readers ask for, with the values that each may have: `glumbra keys` lists it.

use std::cell::RefCell;
use std::ops::RangeInclusive;

use super::settings::{Plain, Settings, words};

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

thread_local! {
    /// Keys that were read on this thread, while they are recorded.
    static RECORD: RefCell<Option<Vec<(String, ValueForm)>>> = const { RefCell::new(None) };
}

/// Does `work`, and returns the dotted names of the keys that it reads on this thread, in order, each with the forms that it
/// may have.
pub fn record<T>(work: impl FnOnce() -> T) -> (T, Vec<(String, Vec<ValueForm>)>) {
    RECORD.set(Some(Vec::new()));
    let done = work();
    let mut keys: Vec<(String, Vec<ValueForm>)> = Vec::new();
    for (key, form) in RECORD.take().unwrap_or_default() {
        match keys.iter_mut().find(|(name, _)| *name == key) {
            None => keys.push((key, vec![form])),
            Some((_, forms)) => add(forms, form),
        }
    }
    (done, keys)
}

/// Adds a form, unless another says as much or more.
pub fn add(forms: &mut Vec<ValueForm>, form: ValueForm) {
    forms.retain(|known| !known.is_less_than(&form));
    if !forms.iter().any(|known| *known == form || form.is_less_than(known)) {
        forms.push(form);
    }
}

/// Notes that a key is read, if that is recorded.
pub(super) fn note(table: &Settings, key: &str, form: impl FnOnce() -> ValueForm) {
    RECORD.with_borrow_mut(|record| {
        if let Some(record) = record {
            record.push((table.key(key), form()));
        }
    });
}
