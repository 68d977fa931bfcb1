//! Rules of kind G: GLSL's functions, uniforms and varyings.

use crate::conformance::Rule;
use crate::conformance::rules::{centroid, derivatives, functions, provoking, uniforms, varyings};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-G1",
        title: "derivatives",
        section: "GLSL 8.14.1",
        says: "dFdx and dFdy are differences to a neighbour, to the right and upwards; fwidth is the sum of their magnitudes.",
        tolerance: "1e-6 of the values (a difference of f32), else a warning to 1e-4; a curve's to either neighbour",
        check: derivatives::derivatives,
    },
    Rule {
        id: "GL-G2",
        title: "functions",
        section: "GLSL 4.7.1, 8",
        says: "Functions on numbers, vectors and matrices give what mathematics says; loops and arrays run as written.",
        tolerance: "GLSL 4.60, 4.7.1; else a warning to 2^-11 (sines 2^-8: GL states no bound), and none where nothing rounds",
        check: functions::functions,
    },
    Rule {
        id: "GL-G3",
        title: "uniforms",
        section: "7.6, GLSL 5.10",
        says: "Uniforms arrive as they were given, arrays whole, matrices by columns or by rows; each program has its own.",
        tolerance: "none: values are exact; 1e-3 for a sum in the vertex stage",
        check: uniforms::uniforms,
    },
    Rule {
        id: "GL-G4",
        title: "varyings and variables",
        section: "GLSL 4.5, 7.1",
        says: "smooth has perspective, noperspective none, flat is the last vertex's; gl_FragCoord has centres, depth and 1/w.",
        tolerance: "none where copied; 4e-6 of the values, else a warning to a sub-pixel of 2^-4",
        check: varyings::varyings,
    },
    Rule {
        id: "GL-G5",
        title: "provoking vertex",
        section: "13.6",
        says: "A flat varying is the last vertex's of its primitive, or the first one's by glProvokingVertex.",
        tolerance: "none: values are copied; pixels within 1/20 of an edge are left out",
        check: provoking::provoking,
    },
    Rule {
        id: "GL-G6",
        title: "centroid varyings",
        section: "14.3.1, GLSL 4.5",
        says: "A centroid varying has a value of a place inside of the pixel and of the primitive.",
        tolerance: "1/16 pixel beyond an edge, where vertices are snapped",
        check: centroid::centroid,
    },
];
