//! Rules of kind N: random programs, states and data, held against a model of GL.

use crate::conformance::Rule;
use crate::conformance::rules::generated_lookups;

pub const RULES: &[Rule] = &[Rule {
    id: "GL-N2",
    title: "random look-ups",
    section: "8.4, 8.5, 8.6, 8.14, 8.23, GLSL 8.9",
    says: "Look-ups of any function, in textures of any target, format and size, find by any parameters what was put there last.",
    tolerance: "2^-7 of a texel and a code of 8 bits, else a warning to 2^-4 and two; 2^-6 of a level from the longer vector, else a warning to 2^-4 beyond the sums",
    check: generated_lookups::lookups,
}];
