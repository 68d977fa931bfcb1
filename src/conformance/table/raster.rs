//! Rules of kind R: raster and clipping.

use crate::conformance::{Rule, raster};

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
];
