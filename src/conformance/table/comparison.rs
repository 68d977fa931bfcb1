//! Rules of kind C: comparison with depth textures.

use crate::conformance::{Rule, compare, fixed};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-C1",
        title: "compare function",
        section: "8.23.1",
        says: "A depth texture gives 1 where reference OP texel holds, else 0: eight functions, the reference on the left.",
        tolerance: "none at 0, 1 and floats; 2^-16 around a texel of 0.5, which is no code of fixed formats",
        check: compare::function,
    },
    Rule {
        id: "GL-C2",
        title: "clamp of the reference",
        section: "8.5, 8.23.1",
        says: "Against fixed-point depths the reference is clamped to [0, 1], against floats it is not; uploads always are.",
        tolerance: "none: the values are 0 and 1",
        check: compare::clamp,
    },
    Rule {
        id: "GL-C3",
        title: "filtered comparison",
        section: "8.14, 8.23.1",
        says: "LINEAR may compare several texels: the result lies in [0, 1], in proportion to those that pass.",
        tolerance: "2^-5 at positions good to 2^-7 texel; else a warning from there to the nearest texel's and the mean of four (in proportion, both)",
        check: compare::filtered,
    },
    Rule {
        id: "GL-C4",
        title: "comparison and mipmaps",
        section: "8.14.3, 8.23.1",
        says: "Each level is compared, then levels are blended by the fraction of lambda.",
        tolerance: "2^-6 of a level (as conformance tests ask of good drivers), else a warning to 2^-4; 2^-8 for the result",
        check: compare::levels,
    },
    Rule {
        id: "GL-C5",
        title: "wrap modes and border",
        section: "8.14.2",
        says: "The border's depth is the border colour's first component, and is compared; CLAMP meets it under LINEAR only.",
        tolerance: "none for NEAREST; 2^-6 for LINEAR (a position good to 2^-7 texel), else a warning to 2^-3",
        check: compare::border,
    },
    Rule {
        id: "GL-C6",
        title: "DEPTH_TEXTURE_MODE",
        section: "8.23.1, 16.1 compat.",
        says: "The comparison becomes luminance, intensity, alpha or red, as the mode says.",
        tolerance: "the nearest 8-bit code, else a warning for the other of the two nearest",
        check: fixed::depth_mode,
    },
];
