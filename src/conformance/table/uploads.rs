//! Rules of kind U: uploads and read-backs.

use crate::conformance::Rule;
use crate::conformance::rules::uploads;

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-U1",
        title: "uploads",
        section: "8.4, 8.5",
        says: "Texels come by rows from t = 0, rows by UNPACK_ALIGNMENT and UNPACK_ROW_LENGTH; rectangles leave the rest as it is.",
        tolerance: "2^-22 for c / 255, else a warning to 2^-20; floats of a format are exact",
        check: uploads::uploads,
    },
    Rule {
        id: "GL-U2",
        title: "read-backs",
        section: "18.2",
        says: "glReadPixels gives rows from below, padded by PACK_ALIGNMENT; channels that a format lacks are 0, alpha 1.",
        tolerance: "as GL-U1",
        check: uploads::read_backs,
    },
    Rule {
        id: "GL-U3",
        title: "sRGB",
        section: "8.24, 17.3.7",
        says: "A look-up decodes red, green and blue; writing encodes them with FRAMEBUFFER_SRGB alone.",
        tolerance: "2^-10, else a warning to half a code; the same code again, else a warning to the next",
        check: uploads::srgb,
    },
];
