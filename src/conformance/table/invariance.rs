//! Rules of kind I: invariance.

use crate::conformance::Rule;
use crate::conformance::rules::{invariance, programs};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-I1",
        title: "invariance",
        section: "A.3, 11.1.3.11",
        says: "invariant gl_Position and ftransform() meet the same depths (EQUAL) whatever else changes; for enables that is a wish.",
        tolerance: "none where required; a warning for enables",
        check: invariance::invariance,
    },
    Rule {
        id: "GL-I2",
        title: "several programs",
        section: "A.3, 11.1.3.11",
        says: "Programs with the same invariant position meet the same depths, whatever else they compute: sums under EQUAL miss nothing.",
        tolerance: "none; under an offset a warning to 1 % of the pixels (its slope is no position)",
        check: programs::add_up,
    },
];
