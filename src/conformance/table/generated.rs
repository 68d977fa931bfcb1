//! Rules of kind X: generated programs, states and data, held against models.

use crate::conformance::Rule;
use crate::conformance::rules::generated_commands;

pub const RULES: &[Rule] = &[Rule {
    id: "GL-X1",
    title: "streams of commands",
    section: "2.2.1, 8, 9, 14, 17, 18",
    says: "Random streams of clears, draws, blits, copies, uploads and settings leave in every image what GL says.",
    tolerance: "0.6 codes of 8 bits, 1.6 after a blend; steps of depths; pixels within 1/64 of an edge are not judged",
    check: generated_commands::generated,
}];
