//! Rules of kind V: vertices.

use crate::conformance::Rule;
use crate::conformance::rules::{coordinate_arrays, fetch, instances};

pub const RULES: &[Rule] = &[
    Rule {
        id: "GL-V1",
        title: "vertices by index",
        section: "10.3, 10.4",
        says: "Attributes come from their buffers by index, offset and stride, completed by 0, 0, 1; primitives take theirs in turn.",
        tolerance: "none: values are copied",
        check: fetch::fetch,
    },
    Rule {
        id: "GL-V2",
        title: "arrays of texture coordinates",
        section: "10.2, 10.3 compat.",
        says: "Each unit reads the array that glClientActiveTexture chose, of 2 to 4 numbers a vertex; one without an array has its current coordinate.",
        tolerance: "a weight to 2^-7, else a warning to 2^-4",
        check: coordinate_arrays::arrays,
    },
    Rule {
        id: "GL-V3",
        title: "instances",
        section: "10.3.4, 10.4, GLSL 7.1",
        says: "gl_InstanceID counts the instances of a draw from 0; an attribute with a divisor goes on after so many of them.",
        tolerance: "none: values are copied",
        check: instances::instances,
    },
];
