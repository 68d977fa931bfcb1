//! Faults of GLSL: built-in functions, variables and qualifiers.

use super::{Fault, Stage, define};

pub(super) const FAULTS: &[Fault] =
    &[Fault::text("discard-ignored", &["discard"], "A fragment that is discarded is drawn.", |source| {
        define(source, Stage::Fragment, "discard", "#define discard 0")
    })
    .red(&["GL-I1"])];
