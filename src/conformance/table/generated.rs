//! Rules of kind X: generated cases against a model of GL.

use crate::conformance::Rule;
use crate::conformance::rules::{generated_triangles, generated_vertices};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-X3",
        title: "generated triangles",
        section: "13.4 to 13.8, 14.4 to 14.6, GLSL 4.5, 7.1, 8.14.1",
        says: "Triangles of any corners are clipped, culled, offset, covered and interpolated under any state of rasterization, whatever the draws before.",
        tolerance: "pixels: 3/256 pixel along edges; numbers: some roundings of f32 and 1/256 pixel, else a warning to four times that",
        check: generated_triangles::triangles,
    },
    Rule {
        id: "GL-X5",
        title: "generated vertex data and uniforms",
        section: "7.6, 10.2 to 10.5, 13.3",
        says: "A vertex shader receives its attributes, uniforms and blocks as they were set last, in every format, from any buffer, whatever was set before.",
        tolerance: "none where values are copied; a rounding of f32 where they are converted",
        check: generated_vertices::vertices,
    },
];
