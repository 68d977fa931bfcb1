//! Rules of kind R: raster and clipping.

use crate::conformance::Rule;
use crate::conformance::rules::{clip_distances, large_viewports, not_numbers, raster, switches, windows};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-R1",
        title: "coverage",
        section: "14.6.1",
        says: "A pixel is drawn where its centre lies inside; a shared edge draws it once.",
        tolerance: "none on shared edges; else 3/256 pixel along an edge, where vertices are snapped",
        check: raster::coverage,
    },
    Rule {
        id: "GL-R2",
        title: "clipping",
        section: "13.7, GLSL 7.1.1",
        says: "-w <= x, y, z <= w before the division: w = 0 is a direction; a clip plane and its opposite make the whole, one that is not enabled does nothing.",
        tolerance: "none; 1/32 pixel along edges of triangles with corners behind the eye",
        check: raster::clipping,
    },
    Rule {
        id: "GL-R3",
        title: "viewport and scissor",
        section: "13.8.1, 17.3.1",
        says: "A viewport maps [-1, 1] to its pixels, and a depth range to its depths; a scissor lets its own pixels through.",
        tolerance: "none for pixels; places 1e-5 of the viewport, else a warning to 1/16 pixel",
        check: windows::windows,
    },
    Rule {
        id: "GL-R4",
        title: "clip distances",
        section: "13.7",
        says: "Each of eight distances that is on cuts where it is below 0; what is left keeps its varyings.",
        tolerance: "none, but for 1/16 pixel along the cut; varyings 1e-5, else a warning to 1/8 pixel",
        check: clip_distances::distances,
    },
    Rule {
        id: "GL-R5",
        title: "states that are switched off",
        section: "13.7, 14.6, 17.3",
        says: "What is disabled does nothing, whatever its function, factors or rectangle: scissor, blending, depth and stencil tests, culling, offset, depth clamp.",
        tolerance: "none; 1e-6 for depths",
        check: switches::switched_off,
    },
    Rule {
        id: "GL-R6",
        title: "positions that are no numbers",
        section: "2.3.4.1",
        says: "A position that is infinite or no number may draw anything, but ends nothing and leaves the draws after it alone.",
        tolerance: "none for the next draw; neighbours in the same draw no more than a warning: unspecified",
        check: not_numbers::positions,
    },
    Rule {
        id: "GL-R7",
        title: "edges in large viewports",
        section: "14.6.1, 23 (SUBPIXEL_BITS)",
        says: "In viewports up to 4096 pixels an edge lies where its corners are, as finely as GL_SUBPIXEL_BITS says.",
        tolerance: "half a step of a subpixel, else a warning to a whole one; a column of pixels, 2^-22 of the side",
        check: large_viewports::edges,
    },
];
