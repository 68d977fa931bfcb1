//! Rules of kind D: depth.

use crate::conformance::Rule;
use crate::conformance::rules::{depth, fragments};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-D1",
        title: "depth conversion",
        section: "2.3.4, 2.3.5",
        says: "A depth becomes one of the two nearest codes, preferably the nearest; 0 and 1 are exact.",
        tolerance: "half a code; else a warning to 1.5, or 1.5 x 2^-24 (arithmetic in f32); a fetch to 2^-24, else a warning to 2^-23",
        check: depth::conversion,
    },
    Rule {
        id: "GL-D2",
        title: "depth range",
        section: "13.8.1",
        says: "Window depth is (f - n)/2 z + (n + f)/2, n and f clamped to [0, 1], in either order.",
        tolerance: "a code (f32 sum and rounding), else a warning to 1.5; 0 and 1 exact",
        check: depth::range,
    },
    Rule {
        id: "GL-D3",
        title: "depth clamp",
        section: "13.7, 17.3.4",
        says: "With DEPTH_CLAMP nothing is clipped by near and far; depth is clamped to the range, after the offset.",
        tolerance: "1.5 codes; 2e-4 where an offset of 0.2 is made of so many r",
        check: depth::clamp,
    },
    Rule {
        id: "GL-D4",
        title: "clamp of a shader's depth",
        section: "15.2.3, 17.3.4",
        says: "gl_FragDepth is clamped to [0, 1], in float formats too.",
        tolerance: "none: the values are 0 and 1",
        check: depth::fragment_clamp,
    },
    Rule {
        id: "GL-D5",
        title: "depth test",
        section: "17.3.4",
        says: "A fragment passes where its depth OP the stored depth holds.",
        tolerance: "none: depths are a quarter apart, or made by the same draw",
        check: depth::test,
    },
    Rule {
        id: "GL-D6",
        title: "discarded fragments",
        section: "15.2, GLSL 6.4",
        says: "A fragment that is discarded, or fails the alpha test, leaves colour, depth and stencil as they are.",
        tolerance: "none: 2^-20 for depths that lie half apart",
        check: fragments::discarded,
    },
    Rule {
        id: "GL-D7",
        title: "a shader's depth",
        section: "15.2.3, 17.3.4",
        says: "The depth that a shader writes is tested and stored in place of the fragment's own.",
        tolerance: "1.5 codes of the stored depth; the test none: depths are equal or 1/64 apart",
        check: fragments::written_depth,
    },
    Rule {
        id: "GL-D8",
        title: "depth writes",
        section: "17.3.4, 17.4.2",
        says: "Depth is written where the depth test and its mask are on and all tests pass; without the test never.",
        tolerance: "none: 2^-20 for depths that lie half apart",
        check: fragments::writes,
    },
];
