//! Rules of kind N: random programs, states and data, held against a model of GL.

use crate::conformance::Rule;
use crate::conformance::rules::generated_lookups;

pub const RULES: &[Rule] = &[Rule {
    id: "GL-N2",
    title: "random look-ups",
    section: "8.4, 8.5, 8.6, 8.14, 8.23, GLSL 8.9",
    says: "Look-ups of any function, in textures of any target, format and size, find by any parameters what was put there last.",
    tolerance: "2^-4 of a texel (2^-6 for NEAREST), two codes of 8 bits; 2^-4 of a level beyond the greatest derivative and the sums",
    check: generated_lookups::lookups,
}];
