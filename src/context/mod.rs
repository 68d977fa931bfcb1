//! A current GL context behind one trait: EGL, OSMesa or a window's.
//!
//! Opens, keeps and closes contexts, and describes them. Knows nothing of drawing. Loading the driver's libraries happens
//! here and nowhere else; none is linked to.
//!
//! The backends are tried in the order of [`Backend`]. Each that fails says why; the first that works is taken.

mod child;
#[doc(hidden)]
#[cfg(feature = "fixed-function")]
pub mod compatibility;
mod debug_log;
#[doc(hidden)]
pub mod egl;
mod error;
mod gl_names;
mod heap;
mod info;
mod load;
mod osmesa;
#[doc(hidden)]
#[cfg(feature = "window")]
pub mod window;

use std::ffi::{CStr, c_void};
use std::fmt;
use std::rc::Rc;

#[doc(hidden)]
pub use debug_log::{DebugLog, DebugMessage};
pub use error::{Attempt, Error, Reached};
pub(crate) use gl_names::{DEPTH_COMPONENT32, error_name};
pub use info::{ContextInfo, ContextLimits};
#[doc(hidden)]
pub use load::LoadedContext;

use crate::process;
use error::Refusal;

/// Kind of context that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ContextRequest {
    /// Maker of the context; [`Choice::Auto`] tries several.
    pub choice: Choice,
    /// An EGL device by its index in [`egl::devices`]; then only [`Backend::EglDevice`] is tried.
    pub device: Option<usize>,
    /// OpenGL profile of the context.
    pub profile: Profile,
    /// True for a debug context, whose errors are collected with their text (KHR_debug).
    pub debug: bool,
}

/// Maker of the context.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Choice {
    /// EGL, then OSMesa, then a hidden window where there is a display.
    #[default]
    Auto,
    /// EGL only, in any of its ways.
    Egl,
    /// OSMesa only.
    OsMesa,
    /// A hidden window only; it needs a display.
    Window,
}

/// OpenGL profile that is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Profile {
    /// OpenGL 3.3 core or later: for rendering.
    #[default]
    Core33,
    /// With the fixed-function pipeline.
    Compatibility,
}

/// One way to a context.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Backend {
    /// EGL_MESA_platform_surfaceless: no display, no surface.
    EglSurfaceless,
    /// EGL_EXT_platform_device: one of the machine's devices, by index.
    EglDevice,
    /// A pbuffer on EGL's default display.
    EglPbuffer,
    /// Mesa's off-screen library, without EGL; gone since Mesa 25.1.
    OsMesa,
    /// A hidden window on X11 or Wayland.
    Window,
}

impl fmt::Display for Backend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::EglSurfaceless => "EGL surfaceless",
            Self::EglDevice => "EGL device",
            Self::EglPbuffer => "EGL pbuffer",
            Self::OsMesa => "OSMesa",
            Self::Window => "window",
        })
    }
}

impl ContextRequest {
    /// Backends to try, in order.
    fn backends(&self) -> Result<Vec<Backend>, Error> {
        let egl = [Backend::EglSurfaceless, Backend::EglDevice, Backend::EglPbuffer];
        match (self.device, self.choice) {
            (Some(_), Choice::Auto | Choice::Egl) => Ok(vec![Backend::EglDevice]),
            (Some(index), choice) => Err(Error::DeviceWithoutEgl { index, choice }),
            (None, Choice::Egl) => Ok(egl.to_vec()),
            (None, Choice::OsMesa) => Ok(vec![Backend::OsMesa]),
            (None, Choice::Window) => Ok(vec![Backend::Window]),
            (None, Choice::Auto) => {
                let window = display_is_named().then_some(Backend::Window);
                Ok(egl.into_iter().chain([Backend::OsMesa]).chain(window).collect())
            }
        }
    }
}

/// Owns a GL context that is current on this thread from its making until it is dropped or another is made current.
///
/// GL objects made with [`gl`](Self::gl) must be gone before the context is: their names mean nothing without it. A
/// [`Device`](crate::device::Device) shares the context's ownership, and so holds to that by itself.
pub trait Context {
    /// Data that every kind of context has.
    fn loaded(&self) -> &LoadedContext;

    /// Makes it current on this thread again, after another was.
    fn make_current(&self) -> Result<(), Error>;

    /// True if it is current on the calling thread.
    fn is_current(&self) -> bool;

    /// The functions of this context. They act on whatever context is current on the calling thread.
    fn gl(&self) -> &Rc<glow::Context> {
        &self.loaded().gl
    }

    /// The way it was made, as a person reads it: `EGL surfaceless`, `EGL device 1`.
    fn backend(&self) -> &str {
        &self.loaded().backend
    }

    /// Profile that was requested.
    fn profile(&self) -> Profile {
        self.loaded().profile
    }

    /// Messages of the driver, in a debug context.
    fn debug_log(&self) -> Option<&DebugLog> {
        self.loaded().debug_log.as_ref()
    }

    /// A GL function by its name, for bindings beside [`gl`](Self::gl); null where the driver has none. Some drivers return
    /// a stub for any name, so look up only functions that the context's version and profile have.
    fn address_of(&self, name: &CStr) -> *const c_void {
        (self.loaded().address_of)(name)
    }

    /// Bits of the counter of GL_TIME_ELAPSED queries; 0: there is none.
    fn timer_bits(&self) -> u32 {
        self.loaded().timer_bits
    }

    /// Driver, version and limits. Makes some GL queries; the context must be current.
    fn describe(&self) -> ContextInfo {
        info::describe(self.loaded())
    }
}

/// Answer of the window backend where it is not compiled in.
#[cfg(not(feature = "window"))]
const WITHOUT_WINDOWS: &str = "glumbra was built without the cargo feature `window`";

/// Tests whether the environment names a display to open windows on.
#[doc(hidden)]
pub fn display_is_named() -> bool {
    let named = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(not(target_os = "linux")) || named("DISPLAY") || named("WAYLAND_DISPLAY") || named("WAYLAND_SOCKET")
}

/// Opens a context by the first backend that works, and makes it current.
pub fn open(request: &ContextRequest) -> Result<Rc<dyn Context>, Error> {
    let mut attempts = Vec::new();
    for backend in request.backends()? {
        match try_backend(backend, request, &attempts) {
            Ok(context) => return Ok(context),
            Err(Refusal { reached, answer }) => attempts.push(Attempt { backend, reached, answer }),
        }
    }
    match (request.device, attempts.pop()) {
        // With EGL and devices at hand there is nothing to install: another number is wanted.
        (Some(index), Some(attempt)) if egl::devices().is_ok_and(|devices| !devices.is_empty()) => {
            Err(Error::Device { index, answer: attempt.answer })
        }
        (_, last) => {
            attempts.extend(last);
            Err(Error::NoContext(attempts))
        }
    }
}

/// Opens a context by this backend only; `request.choice` is ignored.
#[doc(hidden)]
pub fn open_backend(backend: Backend, request: &ContextRequest) -> Result<Rc<dyn Context>, Error> {
    let refused = |Refusal { reached, answer }| Error::NoContext(vec![Attempt { backend, reached, answer }]);
    try_backend(backend, request, &[]).map_err(refused)
}

/// Tries one backend. The error is one line, to be read beside the backend's name. `before`: earlier attempts.
fn try_backend(backend: Backend, request: &ContextRequest, before: &[Attempt]) -> Result<Rc<dyn Context>, Refusal> {
    heap::keep();
    let _doing = process::doing(error::tried_before(backend, before));
    match backend {
        Backend::EglSurfaceless | Backend::EglDevice | Backend::EglPbuffer => egl::open(backend, request),
        Backend::OsMesa => osmesa::open(request),
        #[cfg(feature = "window")]
        Backend::Window => window::open_hidden(request),
        #[cfg(not(feature = "window"))]
        Backend::Window => Err(Refusal::nothing(WITHOUT_WINDOWS.to_owned())),
    }
}
