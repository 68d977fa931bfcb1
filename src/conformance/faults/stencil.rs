//! Faults of the stencil test.

use super::Fault;

pub(super) const FAULTS: &[Fault] = &[Fault::calls(
    "back-takes-front-depth-fail",
    &["glStencilOpSeparate"],
    "Back faces take the front's operation where the depth test fails.",
    &[(&["glStencilOpSeparate"], |call| match call.u(0) {
        glow::FRONT => {
            let operation = call.f(2);
            call.keep((0, 0), operation);
        }
        glow::BACK if call.kept((0, 0)) != 0.0 => call.set(2, call.kept((0, 0))),
        _ => {}
    })],
)
.red(&["GL-S1"])];
