//! Faults of the depth test, depth range, clamp and offset.

use super::Fault;

pub(super) const FAULTS: &[Fault] = &[Fault::calls(
    "depth-range-ignored",
    &["glDepthRangef", "glDepthRange"],
    "The depth range is [0, 1] whatever is set.",
    &[(&["glDepthRangef", "glDepthRange"], |call| call.skip())],
)
.red(&["GL-D2"])];
