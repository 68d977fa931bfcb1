//! Rules of kind O: polygon offset.

use crate::conformance::Rule;
use crate::conformance::rules::{offset, offset_planes};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-O1",
        title: "polygon offset",
        section: "14.6.5",
        says: "o = m factor + r units, clamped; r is the least difference sure to be told, for floats 2^(e-23); m lies between both norms.",
        tolerance: "r 1 step, else a warning to 2; m 0.1 %, else a warning to 10 % (coarse slopes); units to half a step",
        check: offset::offset,
    },
    Rule {
        id: "GL-O2",
        title: "polygon offset of lines and fills",
        section: "14.6.4, 14.6.5",
        says: "POLYGON_OFFSET_FILL and _LINE hold for the sides that are drawn in that mode, by the same r.",
        tolerance: "half a unit of 64, or a code: r is measured by 1024",
        check: offset::modes,
    },
    Rule {
        id: "GL-O3",
        title: "polygon offset of planes and points",
        section: "14.6.5",
        says: "Units are of the buffer, slopes of window depth; for floats r follows the primitive's greatest depth; POLYGON_OFFSET_POINT is for points.",
        tolerance: "as GL-O1",
        check: offset_planes::planes,
    },
];
