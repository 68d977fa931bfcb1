//! Rules of kind Q: queries.

use crate::conformance::Rule;
use crate::conformance::rules::{conditional, queries};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-Q1",
        title: "samples that pass",
        section: "4.3, 17.3.5",
        says: "SAMPLES_PASSED is the number of samples that pass scissor, stencil and depth tests and are not discarded.",
        tolerance: "none",
        check: queries::samples,
    },
    Rule {
        id: "GL-Q2",
        title: "elapsed time",
        section: "4.2",
        says: "TIME_ELAPSED is there after glFinish, in nanoseconds, grows with the work, and is no more than passes on the clock.",
        tolerance: "a tenth and 0.1 ms over the clock; a hundredth of it for work that is waited for",
        check: queries::time,
    },
    Rule {
        id: "GL-Q3",
        title: "conditional rendering",
        section: "10.9",
        says: "After a query of no samples draws, clears and blits do nothing; after one of some they do all; inverted modes the other way round.",
        tolerance: "a mode that does not wait may draw all; one by region may leave out where no sample passed",
        check: conditional::conditional,
    },
];
