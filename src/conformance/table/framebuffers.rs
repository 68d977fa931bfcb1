//! Rules of kind F: framebuffers and colour.

use crate::conformance::{Rule, blending, copies};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-F1",
        title: "copies of depth",
        section: "8.6, 18.2",
        says: "glCopyTexSubImage2D copies depth, converted to the texture's format; without depth to copy it is an error.",
        tolerance: "none in one format; half a code to another, else a warning to 1.5 (or 2^-23: arithmetic in f32)",
        check: copies::copy,
    },
    Rule {
        id: "GL-F2",
        title: "framebuffers of depth alone",
        section: "8.5.1, 9.4",
        says: "A depth attachment alone is complete; 16, 24, 32F, 24+8 and 32F+8 bits are required.",
        tolerance: "DEPTH_COMPONENT32 need not be there: a warning",
        check: copies::completeness,
    },
    Rule {
        id: "GL-F3",
        title: "reading what is attached",
        section: "9.3.1",
        says: "Values are undefined where a texture is written and read; read alone, they should be what is stored.",
        tolerance: "2^-22 (a fetch); no more than a warning",
        check: copies::feedback,
    },
    Rule {
        id: "GL-F4",
        title: "8-bit colour",
        section: "2.3.5, 17.3.6, 17.3.7",
        says: "A float becomes the nearest code, or the next; sums are exact, products and sRGB near.",
        tolerance: "half a code (sRGB 0.6), else a warning to 1 (products and sRGB 1.5); sums exact",
        check: copies::eight_bits,
    },
    Rule {
        id: "GL-F5",
        title: "stored alpha",
        section: "17.3.6",
        says: "The stored alpha is a factor, and alpha has factors of its own: RGB can be multiplied and alpha replaced.",
        tolerance: "half a code a product, else a warning to 1.5; what is copied is exact",
        check: blending::stored_alpha,
    },
];
