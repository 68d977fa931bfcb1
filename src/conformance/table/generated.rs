//! Rules of kind X: generated commands, states, programs and data, held against models.

use crate::conformance::Rule;
use crate::conformance::rules::{generated_commands, generated_lookups, generated_programs};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-X1",
        title: "streams of commands",
        section: "2.2.1, 8, 9, 14, 17, 18",
        says: "Random streams of clears, draws, blits, copies, uploads and settings leave in every image what GL says.",
        tolerance: "0.6 codes of 8 bits, 1.6 after a blend; steps of depths; pixels within 1/64 of an edge are not judged",
        check: generated_commands::generated,
    },
    Rule {
        id: "GL-X2",
        title: "random look-ups",
        section: "8.4, 8.5, 8.6, 8.14, 8.23, GLSL 8.9",
        says: "Look-ups of any function, in textures of any target, format and size, find by any parameters what was put there last.",
        tolerance: "2^-4 of a texel (2^-6 for NEAREST), two codes of 8 bits; 2^-4 of a level beyond the greatest derivative and the sums",
        check: generated_lookups::lookups,
    },
    Rule {
        id: "GL-X4",
        title: "generated shader programs",
        section: "GLSL 4.1, 4.7.1, 5, 6, 8",
        says: "Random programs of all operators, functions, types, loops, branches and calls give what they say, in each stage.",
        tolerance: "GLSL 4.60, 4.7.1, carried through each program; else a warning to 16 times as much",
        check: generated_programs::programs,
    },
];
