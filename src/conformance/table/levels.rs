//! Rules of kind L: levels and filters of textures.

use crate::conformance::Rule;
use crate::conformance::rules::{filters, levels, mipmaps};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-L1",
        title: "stated levels",
        section: "8.14.1, 8.14.3",
        says: "A level is stated by textureLod, kept within TEXTURE_MIN_LOD and _MAX_LOD, then within BASE_LEVEL and MAX_LEVEL.",
        tolerance: "2^-6 of a level, else a warning to 2^-4; the nearest level either way within 2^-6 of the middle",
        check: levels::stated,
    },
    Rule {
        id: "GL-L2",
        title: "levels from derivatives",
        section: "8.14.1, GLSL 8.9",
        says: "lambda is the logarithm of how many texels a pixel is long, plus the biases; gradients stand for derivatives.",
        tolerance: "2^-6 of a level from the longer vector, else a warning between the greatest derivative and the sums, to 2^-4",
        check: levels::derived,
    },
    Rule {
        id: "GL-L3",
        title: "glGenerateMipmap",
        section: "8.14.4",
        says: "Each level is made by a filter of the one above; a box is recommended.",
        tolerance: "a constant and the middle of a slope to half a code a level; at a border half a slope, with a warning",
        check: mipmaps::generated,
    },
    Rule {
        id: "GL-L4",
        title: "sizes and single texels",
        section: "8.11, GLSL 8.9",
        says: "textureSize is a level's size, halved and rounded down; texelFetch gives a level's texel.",
        tolerance: "none",
        check: mipmaps::functions,
    },
    Rule {
        id: "GL-L5",
        title: "wrap modes",
        section: "8.14.2",
        says: "Each coordinate has its own mode: repeated, mirrored, at the edge, at the border, or halfway (CLAMP, LINEAR).",
        tolerance: "a position to 2^-7 texel and a code, else a warning to 2^-4 and 2",
        check: filters::wrapping,
    },
    Rule {
        id: "GL-L6",
        title: "border beyond [0, 1]",
        section: "8.14.2",
        says: "The border is clamped to what a fixed-point format has, in floats it is not.",
        tolerance: "2^-16, else a warning to a code",
        check: filters::borders,
    },
    Rule {
        id: "GL-L7",
        title: "swizzle",
        section: "8.10",
        says: "Each channel that a shader sees is one of the texel's, 0 or 1.",
        tolerance: "2^-16",
        check: filters::swizzles,
    },
];
