//! Rules of kind M: what is generated, and held against a model.

use crate::conformance::Rule;
use crate::conformance::rules::generated_programs;

pub const RULES: &[Rule] = &[Rule {
    id: "GL-M4",
    title: "generated shader programs",
    section: "GLSL 4.1, 4.7.1, 5, 6, 8",
    says: "Random programs of all operators, functions, types, loops, branches and calls give what they say, in each stage.",
    tolerance: "GLSL 4.60, 4.7.1, carried through each program; else a warning to 16 times as much",
    check: generated_programs::programs,
}];
