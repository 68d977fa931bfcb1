//! Rules of kind S: stencil.

use crate::conformance::Rule;
use crate::conformance::rules::{faces, stencil, volumes, zfail};

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
    Rule {
        id: "GL-S4",
        title: "two faces at once",
        section: "17.3.3",
        says: "Front and back faces have tests, references, masks and three operations of their own in one draw.",
        tolerance: "none: whole numbers",
        check: faces::both,
    },
    Rule {
        id: "GL-S5",
        title: "counts by z-fail",
        section: "13.7, 17.3.3",
        says: "Under depth clamp faces of a closed volume that lie before near, behind the eye or beyond far are counted as they are.",
        tolerance: "none, but for points within 0.03 of a volume's face, some hundred times the depth's and the raster's steps",
        check: zfail::counts,
    },
];
