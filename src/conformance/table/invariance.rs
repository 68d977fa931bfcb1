//! Rules of kind I: invariance.

use crate::conformance::{Rule, invariance};

pub const RULES: &[Rule] = &[Rule {
    id: "GL-I1",
    title: "invariance",
    section: "A.3, 11.1.3.11",
    says: "invariant gl_Position and ftransform() meet the same depths (EQUAL) whatever else changes; for enables that is a wish.",
    tolerance: "none where required; a warning for enables",
    check: invariance::invariance,
}];
