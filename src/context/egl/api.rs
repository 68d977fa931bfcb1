//! libEGL as it is found at run time: its entry points by khronos-egl, its extensions, and the names of its errors.
//!
//! The raw entry points are used, not khronos-egl's `Instance`: that one panics where a call fails without an error
//! code, as libglvnd's may when no driver is installed.

use std::ffi::{CStr, c_char, c_void};
use std::ops::Deref;
use std::sync::OnceLock;

use khronos_egl as egl;
use khronos_egl::api::EGL1_0;

type Dynamic = egl::Dynamic<libloading::Library, egl::EGL1_4>;
type GetProcAddress = unsafe extern "system" fn(*const c_char) -> *const c_void;

/// libEGL, of version 1.4 or later.
pub struct Egl {
    entry_points: Dynamic,
    /// By a signature that may answer null, as khronos-egl's own may not.
    get_proc_address: GetProcAddress,
}

impl Deref for Egl {
    type Target = Dynamic;

    fn deref(&self) -> &Dynamic {
        &self.entry_points
    }
}

/// Names of the library in distributions.
const NAMES: [&str; 2] = ["libEGL.so.1", "libEGL.so"];

pub const PLATFORM_SURFACELESS_MESA: egl::Enum = 0x31DD;
pub const PLATFORM_DEVICE_EXT: egl::Enum = 0x313F;
pub const CONTEXT_FLAGS_KHR: egl::Int = 0x30FC;
pub const CONTEXT_OPENGL_DEBUG_BIT_KHR: egl::Int = 1;

/// libEGL, loaded once and kept: drivers leave threads and exit handlers behind that must not lose their code.
pub fn library() -> Result<&'static Egl, String> {
    static EGL: OnceLock<Result<Egl, String>> = OnceLock::new();
    EGL.get_or_init(load).as_ref().map_err(Clone::clone)
}

fn load() -> Result<Egl, String> {
    let mut answers = Vec::new();
    for name in NAMES {
        // SAFETY: loading libEGL runs its constructors, which is what is asked for; its symbols have the signatures
        // of the EGL specification.
        let loaded = unsafe {
            libloading::Library::new(name)
                .map_err(|error| error.to_string())
                .and_then(|library| find_functions(library).map_err(|error| format!("{name}: {error}")))
        };
        match loaded {
            Ok(egl) => return Ok(egl),
            Err(answer) => answers.push(answer),
        }
    }
    Err(answers.join("; "))
}

/// # Safety
/// The library is libEGL.
unsafe fn find_functions(library: libloading::Library) -> Result<Egl, String> {
    // SAFETY: the signature is that of the EGL specification; the address is used only as long as the library.
    unsafe {
        let get_proc_address: GetProcAddress =
            *library.get(b"eglGetProcAddress\0").map_err(|error| error.to_string())?;
        let entry_points = Dynamic::load_required(library).map_err(|error| error.to_string())?;
        Ok(Egl { entry_points, get_proc_address })
    }
}

/// A GL function, or an EGL function outside EGL 1.4, or null.
pub fn address_of(egl: &Egl, name: &CStr) -> *const c_void {
    // SAFETY: the name ends with a null byte; the answer is an address or null.
    unsafe { (egl.get_proc_address)(name.as_ptr()) }
}

/// Tests whether the display, or EGL itself if `display` is null, has an extension.
pub fn has_extension(egl: &Egl, display: egl::EGLDisplay, name: &str) -> bool {
    query_string(egl, display, egl::EXTENSIONS).split_ascii_whitespace().any(|word| word == name)
}

/// Empty where EGL has no answer.
pub fn query_string(egl: &Egl, display: egl::EGLDisplay, name: egl::Int) -> String {
    // SAFETY: null, or a display that EGL gave; the answer is null or a string that EGL keeps.
    unsafe {
        let text = egl.eglQueryString(display, name);
        if text.is_null() { String::new() } else { CStr::from_ptr(text).to_string_lossy().into_owned() }
    }
}

/// `eglInitialize: EGL_NOT_INITIALIZED`, of the call that has just failed on this thread.
pub fn failure(egl: &Egl, call: &str) -> String {
    // SAFETY: reads and clears this thread's error code.
    let code = unsafe { egl.eglGetError() };
    format!("{call}: {}", error_name(code))
}

fn error_name(code: egl::Int) -> String {
    const FIRST: egl::Int = egl::SUCCESS;
    const NAMES: [&str; 15] = [
        "no error code (EGL_SUCCESS)",
        "EGL_NOT_INITIALIZED",
        "EGL_BAD_ACCESS",
        "EGL_BAD_ALLOC",
        "EGL_BAD_ATTRIBUTE",
        "EGL_BAD_CONFIG",
        "EGL_BAD_CONTEXT",
        "EGL_BAD_CURRENT_SURFACE",
        "EGL_BAD_DISPLAY",
        "EGL_BAD_MATCH",
        "EGL_BAD_NATIVE_PIXMAP",
        "EGL_BAD_NATIVE_WINDOW",
        "EGL_BAD_PARAMETER",
        "EGL_BAD_SURFACE",
        "EGL_CONTEXT_LOST",
    ];
    let name = usize::try_from(code - FIRST).ok().and_then(|index| NAMES.get(index));
    name.map_or_else(|| format!("EGL error {code:#06x}"), |name| (*name).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_codes_have_their_names() {
        assert_eq!(error_name(egl::BAD_CONFIG), "EGL_BAD_CONFIG");
        assert_eq!(error_name(egl::BAD_MATCH), "EGL_BAD_MATCH");
        assert_eq!(error_name(egl::CONTEXT_LOST), "EGL_CONTEXT_LOST");
        assert_eq!(error_name(0x31), "EGL error 0x0031");
    }
}
