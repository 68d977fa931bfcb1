//! Resets of the GPU: what the driver says of a context that is no more.

use std::ffi::c_void;

use glow::HasContext;

use crate::context::Context;

/// glGetGraphicsResetStatus, where the driver has it.
pub struct ResetStatus(Option<unsafe extern "system" fn() -> u32>);

impl ResetStatus {
    /// The function of `context`, which is current.
    pub fn of(context: &dyn Context) -> Self {
        let gl = context.gl();
        let (version, extensions) = (gl.version(), gl.supported_extensions());
        let name = match () {
            () if (version.major, version.minor) >= (4, 5) || extensions.contains("GL_KHR_robustness") => {
                c"glGetGraphicsResetStatus"
            }
            () if extensions.contains("GL_ARB_robustness") => c"glGetGraphicsResetStatusARB",
            () => return Self(None),
        };
        let address = context.address_of(name);
        Self((!address.is_null()).then(|| {
            // SAFETY: the driver has the function, of this signature.
            unsafe { std::mem::transmute::<*const c_void, unsafe extern "system" fn() -> u32>(address) }
        }))
    }

    /// The driver's word that the context is no more.
    pub fn why(&self) -> Option<&'static str> {
        // SAFETY: the context is current; the function only asks.
        match unsafe { self.0?() } {
            0x8253 => Some("GL_GUILTY_CONTEXT_RESET: the GPU was reset, by what this rule draws"),
            0x8254 => Some("GL_INNOCENT_CONTEXT_RESET: the GPU was reset, by another program"),
            0x8255 => Some("GL_UNKNOWN_CONTEXT_RESET: the GPU was reset"),
            _ => None,
        }
    }
}
