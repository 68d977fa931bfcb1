//! Rules of kind T: coordinates and interpolation.

use crate::conformance::Rule;
use crate::conformance::rules::{coordinates, fixed, projective};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-T1",
        title: "texture coordinate generation",
        section: "12.1.3 compat.",
        says: "Eye planes are multiplied by the inverse modelview when given; object planes are not; the texture matrix follows.",
        tolerance: "64 roundings of f32 for the planes; look-ups as GL-C3, but where a texel's edge or a tie is near",
        check: fixed::texgen,
    },
    Rule {
        id: "GL-T2",
        title: "division by q",
        section: "8.14, 16.1 compat.",
        says: "Projective look-ups use s/q, t/q and the reference r/q.",
        tolerance: "as GL-C3; NEAREST either way within 2^-7 texel of a texel's edge",
        check: coordinates::division,
    },
    Rule {
        id: "GL-T3",
        title: "interpolation",
        section: "14.6.1, 15.2.2",
        says: "Varyings are interpolated with perspective, depth is linear in the window, and gl_FragCoord.z is that depth.",
        tolerance: "2^-22 (1 + 2 slope) and a code; else a warning while the plane is met within one sub-pixel of the centre",
        check: coordinates::interpolation,
    },
    Rule {
        id: "GL-T4",
        title: "a surface's shadow on itself",
        section: "8.23.1, 14.6.5",
        says: "Nothing is promised, but maps are used so: offset (1, 1) should clear a floor of its own shadow.",
        tolerance: "none with offset (1, 1), else a warning while (2, 4) is enough",
        check: coordinates::self_shadow,
    },
    Rule {
        id: "GL-T5",
        title: "negative q and q near 0",
        section: "GLSL 8.9.2",
        says: "textureProj divides by q, whatever its sign and size.",
        tolerance: "as GL-T2; colours to a code",
        check: projective::divisors,
    },
    Rule {
        id: "GL-T6",
        title: "texture coordinate generation on every unit",
        section: "12.1.3 compat.",
        says: "Planes, modes and texture matrices are each unit's own.",
        tolerance: "a weight to 2^-7, else a warning to 2^-4",
        check: projective::units,
    },
    Rule {
        id: "GL-T7",
        title: "1D textures by planes",
        section: "8.14, 12.1.3 compat.",
        says: "One coordinate, from a shader or from glTexGen, looks up a 1D texture.",
        tolerance: "a position to 2^-7 texel and a code, else a warning to 2^-4 and 2",
        check: projective::lines,
    },
];
