//! Changes of a technique's keys that `glumbra stress` draws, one at a time, beside the technique's defaults.

/// A change of a few keys of `[light.shadow]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    /// Keys in TOML, as in an inline table.
    pub keys: &'static str,
    /// True if it acts where light is added and not where shade is found: then the picture itself is judged.
    pub pictured: bool,
}

/// Changes of the shade.
pub(super) const fn of_shade<const N: usize>(keys: [&'static str; N]) -> [Change; N] {
    of(keys, false)
}

/// Changes of the picture.
pub(super) const fn of_picture<const N: usize>(keys: [&'static str; N]) -> [Change; N] {
    of(keys, true)
}

const fn of<const N: usize>(keys: [&'static str; N], pictured: bool) -> [Change; N] {
    let mut changes = [Change { keys: "", pictured }; N];
    let mut index = 0;
    while index < N {
        changes[index].keys = keys[index];
        index += 1;
    }
    changes
}
