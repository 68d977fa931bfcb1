//! Rules of kind X: generated commands, states, programs and data, held against models.

use crate::conformance::rules::{
    generated_commands, generated_fixed, generated_lookups, generated_programs, generated_triangles, generated_vertices,
};
use crate::conformance::{Rule, frames};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-X1",
        title: "streams of commands",
        section: "2.2.1, 8, 9, 14, 17, 18",
        says: "Random streams of clears, draws, blits, copies, uploads and settings leave in every image what GL says.",
        tolerance: "0.6 codes of 8 bits, 1.6 after a blend; steps of depths; pixels within 1/64 of an edge are not judged",
        check: generated_commands::generated,
    },
    Rule {
        id: "GL-X2",
        title: "random look-ups",
        section: "8.4, 8.5, 8.6, 8.14, 8.23, GLSL 8.9",
        says: "Look-ups of any function, in textures of any target, format and size, find by any parameters what was put there last.",
        tolerance: "2^-4 of a texel (2^-6 for NEAREST), two codes of 8 bits; 2^-4 of a level beyond the greatest derivative and the sums",
        check: generated_lookups::lookups,
    },
    Rule {
        id: "GL-X3",
        title: "generated triangles",
        section: "13.4 to 13.8, 14.4 to 14.6, GLSL 4.5, 7.1, 8.14.1",
        says: "Triangles of any corners are clipped, culled, offset, covered and interpolated under any state of rasterization, whatever the draws before.",
        tolerance: "pixels: 3/256 pixel along edges; numbers: some roundings of f32 and 1/256 pixel, else a warning to four times that",
        check: generated_triangles::triangles,
    },
    Rule {
        id: "GL-X4",
        title: "generated shader programs",
        section: "GLSL 4.1, 4.7.1, 5, 6, 8",
        says: "Random programs of all operators, functions, types, loops, branches and calls give what they say, in each stage.",
        tolerance: "GLSL 4.60, 4.7.1, carried through each program; else a warning to 16 times as much",
        check: generated_programs::programs,
    },
    Rule {
        id: "GL-X5",
        title: "generated vertex data and uniforms",
        section: "7.6, 10.2 to 10.5, 13.3",
        says: "A vertex shader receives its attributes, uniforms and blocks as they were set last, in every format, from any buffer, whatever was set before.",
        tolerance: "none where values are copied; a rounding of f32 where they are converted",
        check: generated_vertices::vertices,
    },
    Rule {
        id: "GL-X6",
        title: "streams of the fixed-function pipeline",
        section: "12.1, 12.2, 13.7, 16, 17.3.2, 21.6 (compatibility)",
        says: "Texture environments, lights, fog, clip planes, matrices, current values, lists and saved attributes make the colours that GL says, whatever the draws before.",
        tolerance: "a code of 8 bits for each unit, two for lighting, one for fog",
        check: generated_fixed::generated,
    },
    Rule {
        id: "GL-X7",
        title: "frames with shadows",
        section: "8, 9, 13, 14, 17, GLSL 3 to 8",
        says: "The renderer's own shaders, states, copies and look-ups for shadow maps and volumes leave in every image what GL says.",
        tolerance: "errors of f32 carried through each pass; 0.6 codes of 8 bits, 1.6 after a blend; what GL leaves open is not judged",
        check: frames::shadows,
    },
    Rule {
        id: "GL-X8",
        title: "frames with light on surfaces",
        section: "8, 9, 13, 14, 17, GLSL 3 to 8",
        says: "So do those for lit, bump-mapped and textured surfaces, projected light, photographs, dust and views.",
        tolerance: "errors of f32 carried through each pass; 0.6 codes of 8 bits, 1.6 after a blend; what GL leaves open is not judged",
        check: frames::surfaces,
    },
];
