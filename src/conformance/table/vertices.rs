//! Rules of kind V: vertices.

use crate::conformance::Rule;
use crate::conformance::rules::fetch;

pub const RULES: &[Rule] = &[Rule {
    id: "GL-V1",
    title: "vertices by index",
    section: "10.3, 10.4",
    says: "Attributes come from their buffers by index, offset and stride, completed by 0, 0, 1; primitives take theirs in turn.",
    tolerance: "none: values are copied",
    check: fetch::fetch,
}];
