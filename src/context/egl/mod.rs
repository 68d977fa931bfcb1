//! Contexts by EGL without a window: on the surfaceless platform, on a device, or with a pbuffer on the default display.
//!
//! Displays are initialised and never terminated: eglTerminate would destroy the contexts of other threads.

mod api;
mod devices;

use std::ffi::c_void;
use std::ptr::{null, null_mut};
use std::rc::Rc;

use khronos_egl as egl;
use khronos_egl::api::{EGL1_0, EGL1_2, EGL1_4};

use self::api::Egl;
pub use self::devices::{EglDevice, devices};
use super::error::{Reached, Refusal};
use super::load::{self, LoadedContext};
use super::{Backend, Context, ContextRequest, Error, Profile};

/// A context that owns its surface, if it needs one.
///
/// The order of the fields is that of their end: the context first, then `loaded` with the callback it reports to.
struct EglContext {
    handles: Handles,
    loaded: LoadedContext,
}

impl Context for EglContext {
    fn loaded(&self) -> &LoadedContext {
        &self.loaded
    }

    fn make_current(&self) -> Result<(), Error> {
        self.handles.make_current().map_err(|answer| Error::NotCurrent { backend: self.loaded.backend.clone(), answer })
    }

    fn is_current(&self) -> bool {
        self.handles.is_current()
    }
}

/// Handles that are released when the context is dropped.
struct Handles {
    egl: &'static Egl,
    display: egl::EGLDisplay,
    context: egl::EGLContext,
    /// EGL_NO_SURFACE where the display needs none (EGL_KHR_surfaceless_context).
    surface: egl::EGLSurface,
}

/// Opens a context by one of EGL's three platforms. The error is the platform's answer.
pub(super) fn open(backend: Backend, request: &ContextRequest) -> Result<Rc<dyn Context>, Refusal> {
    let egl = api::library().map_err(Refusal::nothing)?;
    match backend {
        Backend::EglDevice => open_device(egl, request),
        Backend::EglPbuffer => {
            // SAFETY: EGL_DEFAULT_DISPLAY is null.
            let display = unsafe { egl.eglGetDisplay(null_mut()) };
            open_on(egl, display, "eglGetDisplay", backend.to_string(), request, true)
        }
        _ => {
            if !api::has_extension(egl, egl::NO_DISPLAY, "EGL_MESA_platform_surfaceless") {
                return Err("EGL has no EGL_MESA_platform_surfaceless".into());
            }
            let display = platform_display(egl, api::PLATFORM_SURFACELESS_MESA, null_mut())?;
            open_on(egl, display, "eglGetPlatformDisplay", backend.to_string(), request, false)
        }
    }
}

/// Opens a context on the requested device, or on the first that works.
fn open_device(egl: &'static Egl, request: &ContextRequest) -> Result<Rc<dyn Context>, Refusal> {
    let devices = devices::enumerate(egl)?;
    if !api::has_extension(egl, egl::NO_DISPLAY, "EGL_EXT_platform_device") {
        return Err("EGL has no EGL_EXT_platform_device".into());
    }
    let chosen = match request.device {
        Some(index) if index < devices.len() => index..index + 1,
        Some(index) => return Err(no_such_device(index, devices.len()).into()),
        None if devices.is_empty() => return Err("EGL finds no device".into()),
        None => 0..devices.len(),
    };
    let mut answers = Vec::new();
    let mut farthest = Reached::Library;
    for index in chosen {
        let display = platform_display(egl, api::PLATFORM_DEVICE_EXT, devices[index]).map_err(Refusal::from);
        let opened = display.and_then(|display| {
            let name = format!("{} {index}", Backend::EglDevice);
            open_on(egl, display, "eglGetPlatformDisplay", name, request, false)
        });
        match opened {
            Ok(context) => return Ok(context),
            Err(Refusal { reached, answer }) => {
                farthest = farthest.max(reached);
                answers.push(format!("device {index}: {answer}"));
            }
        }
    }
    Err(Refusal { reached: farthest, answer: answers.join("; ") })
}

fn no_such_device(index: usize, count: usize) -> String {
    match count {
        0 => format!("there is no device {index}: EGL finds none"),
        1 => format!("there is no device {index}: EGL finds one, number 0"),
        _ => format!("there is no device {index}: EGL finds {count}, numbered 0 to {}", count - 1),
    }
}

/// eglGetPlatformDisplay of EGL 1.5, or its extension: with no attributes, both take the same arguments.
fn platform_display(egl: &Egl, platform: egl::Enum, native: *mut c_void) -> Result<egl::EGLDisplay, String> {
    type GetPlatformDisplay = unsafe extern "system" fn(egl::Enum, *mut c_void, *const c_void) -> egl::EGLDisplay;
    let names = [c"eglGetPlatformDisplayEXT", c"eglGetPlatformDisplay"];
    let address = names.iter().map(|name| api::address_of(egl, name)).find(|address| !address.is_null());
    let address = address.ok_or("EGL has no eglGetPlatformDisplay")?;
    // SAFETY: the function has this signature; `native` is what the platform asks for.
    let display = unsafe {
        let get_display = std::mem::transmute::<*const c_void, GetPlatformDisplay>(address);
        get_display(platform, native, null())
    };
    if display == egl::NO_DISPLAY { Err(api::failure(egl, "eglGetPlatformDisplay")) } else { Ok(display) }
}

/// Initialises the display, makes a context on it and makes that current. `origin`: the call that gave the display.
fn open_on(
    egl: &'static Egl,
    display: egl::EGLDisplay,
    origin: &str,
    backend: String,
    request: &ContextRequest,
    want_surface: bool,
) -> Result<Rc<dyn Context>, Refusal> {
    if display == egl::NO_DISPLAY {
        return Err(format!("{origin} answers EGL_NO_DISPLAY").into());
    }
    // SAFETY: the display is one that EGL gave; eglInitialize may be called again on it.
    unsafe {
        if egl.eglInitialize(display, null_mut(), null_mut()) != egl::TRUE {
            return Err(api::failure(egl, "eglInitialize").into());
        }
        if egl.eglBindAPI(egl::OPENGL_API) != egl::TRUE {
            return Err(api::failure(egl, "eglBindAPI(EGL_OPENGL_API)").into());
        }
    }
    let extensions = api::query_string(egl, display, egl::EXTENSIONS);
    let has = |name: &str| extensions.split_ascii_whitespace().any(|word| word == name);
    let needs_surface = want_surface || !has("EGL_KHR_surfaceless_context");
    let configless = has("EGL_KHR_no_config_context") || has("EGL_MESA_configless_context");
    let needs_config = needs_surface || !configless;
    let config = if needs_config { choose_config(egl, display).map_err(Refusal::driver)? } else { null_mut() };

    let debug = request.debug && has("EGL_KHR_create_context");
    let mut handles = Handles { egl, display, context: egl::NO_CONTEXT, surface: egl::NO_SURFACE };
    handles.context = create_context(egl, display, config, request.profile, debug).map_err(Refusal::driver)?;
    if needs_surface {
        handles.surface = create_pbuffer(egl, display, config).map_err(Refusal::driver)?;
    }
    handles.make_current().map_err(Refusal::driver)?;
    // SAFETY: the context is current; eglGetProcAddress answers with its functions.
    let loaded = unsafe { load::load(backend, request, move |name| api::address_of(egl, name)) };
    let loaded = loaded.map_err(Refusal::driver)?;
    Ok(Rc::new(EglContext { handles, loaded }))
}

/// Any configuration that takes OpenGL and pbuffers: glumbra draws into framebuffer objects of its own.
fn choose_config(egl: &Egl, display: egl::EGLDisplay) -> Result<egl::EGLConfig, String> {
    let wanted = [egl::SURFACE_TYPE, egl::PBUFFER_BIT, egl::RENDERABLE_TYPE, egl::OPENGL_BIT, egl::NONE];
    let mut config = null_mut();
    let mut count = 0;
    // SAFETY: the list ends with EGL_NONE; at most one configuration is written.
    let answered = unsafe { egl.eglChooseConfig(display, wanted.as_ptr(), &mut config, 1, &mut count) };
    if answered != egl::TRUE {
        return Err(api::failure(egl, "eglChooseConfig"));
    }
    if count == 0 { Err("has no configuration for OpenGL with pbuffers".to_owned()) } else { Ok(config) }
}

fn create_context(
    egl: &Egl,
    display: egl::EGLDisplay,
    config: egl::EGLConfig,
    profile: Profile,
    debug: bool,
) -> Result<egl::EGLContext, String> {
    let (bit, name) = match profile {
        Profile::Core33 => (egl::CONTEXT_OPENGL_CORE_PROFILE_BIT, "core"),
        Profile::Compatibility => (egl::CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT, "compatibility"),
    };
    let mut attributes = vec![egl::CONTEXT_MAJOR_VERSION, 3, egl::CONTEXT_MINOR_VERSION, 3];
    attributes.extend([egl::CONTEXT_OPENGL_PROFILE_MASK, bit]);
    if debug {
        attributes.extend([api::CONTEXT_FLAGS_KHR, api::CONTEXT_OPENGL_DEBUG_BIT_KHR]);
    }
    attributes.push(egl::NONE);
    // SAFETY: the display is initialised, the configuration is its own or none, the list ends with EGL_NONE.
    let context = unsafe { egl.eglCreateContext(display, config, egl::NO_CONTEXT, attributes.as_ptr()) };
    let call = format!("eglCreateContext (OpenGL 3.3 {name})");
    if context == egl::NO_CONTEXT { Err(api::failure(egl, &call)) } else { Ok(context) }
}

fn create_pbuffer(egl: &Egl, display: egl::EGLDisplay, config: egl::EGLConfig) -> Result<egl::EGLSurface, String> {
    let size = [egl::WIDTH, 1, egl::HEIGHT, 1, egl::NONE];
    // SAFETY: display and configuration belong together, the list ends with EGL_NONE.
    let surface = unsafe { egl.eglCreatePbufferSurface(display, config, size.as_ptr()) };
    if surface == egl::NO_SURFACE { Err(api::failure(egl, "eglCreatePbufferSurface")) } else { Ok(surface) }
}

impl Handles {
    fn is_current(&self) -> bool {
        // SAFETY: a query of the calling thread's state, which is the bound API's.
        unsafe {
            self.egl.eglBindAPI(egl::OPENGL_API);
            self.egl.eglGetCurrentContext() == self.context
        }
    }

    fn make_current(&self) -> Result<(), String> {
        // SAFETY: the handles are this context's own.
        let answered = unsafe {
            // The bound API is the thread's, and a context may be made current on another thread than its maker.
            self.egl.eglBindAPI(egl::OPENGL_API);
            self.egl.eglMakeCurrent(self.display, self.surface, self.surface, self.context)
        };
        if answered == egl::TRUE { Ok(()) } else { Err(api::failure(self.egl, "eglMakeCurrent")) }
    }
}

impl Drop for Handles {
    fn drop(&mut self) {
        // SAFETY: the handles are this context's own and are not used again. A context that is current is let go first:
        // EGL would otherwise keep it until the thread's next.
        unsafe {
            if self.context != egl::NO_CONTEXT {
                if self.is_current() {
                    self.egl.eglMakeCurrent(self.display, egl::NO_SURFACE, egl::NO_SURFACE, egl::NO_CONTEXT);
                }
                self.egl.eglDestroyContext(self.display, self.context);
            }
            if self.surface != egl::NO_SURFACE {
                self.egl.eglDestroySurface(self.display, self.surface);
            }
        }
    }
}
