//! A current GL context behind one trait: EGL, OSMesa or a window's.
//!
//! Owns how a context is found, kept and given up, and what it says of itself. Knows nothing of what is drawn with it.
//! Loading the driver's libraries happens here and nowhere else; none is linked to.
//!
//! The roads are tried in the order of [`Road`]; each that fails says why, and the first that answers is taken.

mod child;
pub mod compatibility;
mod debug_log;
pub mod egl;
mod error;
mod gl_names;
mod heap;
mod info;
mod load;
mod osmesa;
pub mod window;

use std::ffi::{CStr, c_void};
use std::fmt;
use std::rc::Rc;

pub use debug_log::{DebugLog, DebugMessage};
pub use error::{Attempt, Error, Reached};
pub(crate) use gl_names::{DEPTH_COMPONENT32, error_name};
pub use info::{ContextInfo, Limits};
pub use load::Loaded;

use crate::process;
use error::Refusal;

/// What kind of context is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ContextRequest {
    pub choice: Choice,
    /// An EGL device by its index in [`egl::devices`]; then only [`Road::EglDevice`] is tried.
    pub device: Option<usize>,
    pub profile: Profile,
    /// Asks for a debug context, whose errors are collected with their text (KHR_debug).
    pub debug: bool,
}

/// Who makes the context.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Choice {
    /// EGL, then OSMesa, then a hidden window where there is a display.
    #[default]
    Auto,
    Egl,
    OsMesa,
    Window,
}

/// Which half of OpenGL is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Profile {
    /// OpenGL 3.3 core or later: for rendering.
    #[default]
    Core33,
    /// With the fixed-function pipeline: for the oracle.
    Compatibility,
}

/// One way to a context.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Road {
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

impl fmt::Display for Road {
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
    /// The roads to try, in order.
    fn roads(&self) -> Result<Vec<Road>, Error> {
        let egl = [Road::EglSurfaceless, Road::EglDevice, Road::EglPbuffer];
        match (self.device, self.choice) {
            (Some(_), Choice::Auto | Choice::Egl) => Ok(vec![Road::EglDevice]),
            (Some(index), choice) => Err(Error::DeviceWithoutEgl { index, choice }),
            (None, Choice::Egl) => Ok(egl.to_vec()),
            (None, Choice::OsMesa) => Ok(vec![Road::OsMesa]),
            (None, Choice::Window) => Ok(vec![Road::Window]),
            (None, Choice::Auto) => {
                let window = window::display_is_named().then_some(Road::Window);
                Ok(egl.into_iter().chain([Road::OsMesa]).chain(window).collect())
            }
        }
    }
}

/// Owns a GL context that is current on this thread from its making until it is dropped or another is made current.
///
/// GL objects made with [`gl`](Self::gl) must be gone before the context is: their names mean nothing without it.
pub trait Context {
    /// What every kind of context holds.
    fn loaded(&self) -> &Loaded;

    /// Makes it current on this thread again, after another was.
    fn make_current(&self) -> Result<(), Error>;

    /// The functions of this context. They act on whatever context is current on the calling thread.
    fn gl(&self) -> &Rc<glow::Context> {
        &self.loaded().gl
    }

    /// The way it was made, as a person reads it: `EGL surfaceless`, `EGL device 1`.
    fn road(&self) -> &str {
        &self.loaded().road
    }

    /// Which profile was asked for.
    fn profile(&self) -> Profile {
        self.loaded().profile
    }

    /// What the driver reports, where it was asked to and can.
    fn debug_log(&self) -> Option<&DebugLog> {
        self.loaded().debug_log.as_ref()
    }

    /// A GL function by its name, for bindings beside [`gl`](Self::gl); null where the driver has none. Some drivers answer
    /// with a stub for any name: what the context's version and profile promise is to be asked for, and no more.
    fn address_of(&self, name: &CStr) -> *const c_void {
        (self.loaded().address_of)(name)
    }

    /// Bits of the counter of GL_TIME_ELAPSED queries; 0: there is none.
    fn timer_bits(&self) -> u32 {
        self.loaded().timer_bits
    }

    /// What the driver says of itself. Costs some GL queries; the context must be current.
    fn describe(&self) -> ContextInfo {
        info::describe(self.loaded())
    }
}

/// Opens a context by the first road that can be had, and makes it current.
pub fn open(request: &ContextRequest) -> Result<Box<dyn Context>, Error> {
    let mut attempts = Vec::new();
    for road in request.roads()? {
        match try_road(road, request, &attempts) {
            Ok(context) => return Ok(context),
            Err(Refusal { reached, answer }) => attempts.push(Attempt { road, reached, answer }),
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

/// Opens a context by this road and no other; `request.choice` is not looked at.
pub fn open_road(road: Road, request: &ContextRequest) -> Result<Box<dyn Context>, Error> {
    let refused = |Refusal { reached, answer }| Error::NoContext(vec![Attempt { road, reached, answer }]);
    try_road(road, request, &[]).map_err(refused)
}

/// The road's answer is one line, for a person to read beside the road's name. `before`: what was tried already.
fn try_road(road: Road, request: &ContextRequest, before: &[Attempt]) -> Result<Box<dyn Context>, Refusal> {
    heap::keep();
    let _doing = process::doing(error::tried_before(road, before));
    match road {
        Road::EglSurfaceless | Road::EglDevice | Road::EglPbuffer => egl::open(road, request),
        Road::OsMesa => osmesa::open(request),
        Road::Window => window::open_hidden(request),
    }
}
