//! Rules of kind B: masks, clears, blending.

use crate::conformance::Rule;
use crate::conformance::rules::{factors, masks, srgb_blending};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-B1",
        title: "colour masks",
        section: "17.4.2",
        says: "Each channel is written where its mask is on, blended or not, in floats too.",
        tolerance: "none: codes are given and sums exact",
        check: masks::draws,
    },
    Rule {
        id: "GL-B2",
        title: "clears",
        section: "17.4.2, 17.4.3",
        says: "Clears go through the scissor and the masks of colour, depth and front stencil, and leave other buffers alone.",
        tolerance: "none: codes are given; 2^-20 for depths that lie half apart",
        check: masks::clears,
    },
    Rule {
        id: "GL-B3",
        title: "blend factors and equations",
        section: "17.3.6",
        says: "Ten factors for RGB and for alpha, five equations; floats are not clamped.",
        tolerance: "a code for two products that round, else a warning to 2; floats 4e-7 of the terms, else a warning to 2^-10",
        check: factors::factors,
    },
    Rule {
        id: "GL-B4",
        title: "blending in sRGB",
        section: "17.3.6, 17.3.7",
        says: "With FRAMEBUFFER_SRGB stored red, green and blue are decoded, blended and encoded, alpha is not; without it codes are blended.",
        tolerance: "0.6 of a code, else a warning to 2 with what is stored decoded to half a code: two products round",
        check: srgb_blending::blended,
    },
];
