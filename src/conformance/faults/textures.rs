//! Faults of textures and samplers.

use super::Fault;

pub(super) const FAULTS: &[Fault] = &[Fault::calls(
    "sampler-lequal-is-gequal",
    &["glSamplerParameteri", "GL_LEQUAL", "GL_TEXTURE_COMPARE_FUNC"],
    "LEQUAL of a sampler object is GEQUAL.",
    &[(&["glSamplerParameteri"], |call| {
        if call.u(1) == glow::TEXTURE_COMPARE_FUNC {
            call.replace(2, glow::LEQUAL, glow::GEQUAL);
        }
    })],
)
.red(&["GL-C1"])];
