//! Rules of kind E: texture environments.

use crate::conformance::Rule;
use crate::conformance::rules::{environment, lighting};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-E1",
        title: "texture environment",
        section: "16.1 compat.",
        says: "COMBINE has six functions, four operands and the scales 1, 2 and 4; each unit clamps to [0, 1].",
        tolerance: "the nearest code of f32 sums; else a warning while each unit is off by half a code before its scale",
        check: environment::functions,
    },
    Rule {
        id: "GL-E2",
        title: "dot product",
        section: "16.1 compat.",
        says: "DOT3_RGB is 4 ((a0 - 1/2)(b0 - 1/2) + ... + (a2 - 1/2)(b2 - 1/2)), scaled and clamped; DOT3_RGBA writes alpha too.",
        tolerance: "as GL-E1, four times as much before the scale: the factor 4; both scales are the same where alpha is written",
        check: environment::dot_product,
    },
    Rule {
        id: "GL-E3",
        title: "textures of other units",
        section: "16.1 compat.",
        says: "TEXTUREn is a source in every unit's environment.",
        tolerance: "as GL-E1",
        check: environment::crossbar,
    },
    Rule {
        id: "GL-E4",
        title: "lighting",
        section: "12.2.1 compat.",
        says: "A vertex's colour is emission, ambient, diffuse and specular light of each light that is on, which fades with distance; then clamped and interpolated.",
        tolerance: "a code, else a warning to 2: a power and an interpolation of f32",
        check: lighting::lighting_of_vertices,
    },
];
