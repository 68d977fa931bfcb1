//! Rules of kind S: stencil.

use crate::conformance::{Rule, stencil, volumes};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-S1",
        title: "stencil operations",
        section: "17.3.3",
        says: "INCR and DECR saturate, _WRAP wraps, before the write mask; (ref & mask) OP (stored & mask), ref clamped.",
        tolerance: "none: whole numbers",
        check: stencil::operations,
    },
    Rule {
        id: "GL-S2",
        title: "front and back",
        section: "14.6.1",
        says: "The sign of the area in the window decides, with glFrontFace; a mirror turns it.",
        tolerance: "none",
        check: stencil::facing,
    },
    Rule {
        id: "GL-S3",
        title: "closed shadow volumes",
        section: "13.7, 14.6.1",
        says: "What enters a closed volume leaves it, at infinity too: net counts are 0; directions lie at depth 1.",
        tolerance: "none; the far cap's depth a code, with a warning (z/w of equal numbers may round)",
        check: volumes::closure,
    },
];
