//! Rules of kind M: cube maps.

use crate::conformance::Rule;
use crate::conformance::rules::cube_maps;

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-M1",
        title: "cube map faces",
        section: "8.13, table 8.19",
        says: "The coordinate of the greatest magnitude selects the face; the others, divided by it, are s and t.",
        tolerance: "either neighbour within 2^-7 texel of a texel's edge; either face where two coordinates are equal",
        check: cube_maps::faces,
    },
    Rule {
        id: "GL-M2",
        title: "cube map seams",
        section: "8.13.1, 8.14.2",
        says: "A face is filtered alone, its edge texels repeated; TEXTURE_CUBE_MAP_SEAMLESS takes its neighbours' texels.",
        tolerance: "a code at positions good to 2^-7 texel, else a warning to 2 at 2^-4, and for any texel as a corner's fourth",
        check: cube_maps::seams,
    },
    Rule {
        id: "GL-M3",
        title: "normalisation by a cube map",
        section: "8.13, 8.14",
        says: "A cube map of n x n packed unit vectors gives the unit vector, whatever the length of the one that looks it up.",
        tolerance: "1/n^2 between texels, 1/(2n) more where a texel has no neighbour, and a code, else a warning to 2",
        check: cube_maps::normalization,
    },
];
