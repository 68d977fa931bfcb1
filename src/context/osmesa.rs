//! Contexts by OSMesa, Mesa's off-screen library (GL/osmesa.h), loaded at run time. Mesa 25.1 dropped it, so it is only one
//! backend of several.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::null_mut;
use std::rc::Rc;
use std::sync::OnceLock;

use libloading::Library;

use super::error::Refusal;
use super::load::{self, LoadedContext};
use super::{Backend, Context, ContextRequest, Error, Profile, child};

/// By the version that Mesa has had since 2013, the one before, and the name of the development package.
const NAMES: [&str; 3] = ["libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"];

// GL/osmesa.h
const FORMAT: c_int = 0x22;
const DEPTH_BITS: c_int = 0x30;
const STENCIL_BITS: c_int = 0x31;
const ACCUM_BITS: c_int = 0x32;
const PROFILE: c_int = 0x33;
const CORE_PROFILE: c_int = 0x34;
const COMPAT_PROFILE: c_int = 0x35;
const CONTEXT_MAJOR_VERSION: c_int = 0x36;
const CONTEXT_MINOR_VERSION: c_int = 0x37;

type RawContext = *mut c_void;

/// The entry points that are used.
struct Api {
    create: unsafe extern "C" fn(*const c_int, RawContext) -> RawContext,
    destroy: unsafe extern "C" fn(RawContext),
    make_current: unsafe extern "C" fn(RawContext, *mut c_void, u32, c_int, c_int) -> u8,
    get_current: unsafe extern "C" fn() -> RawContext,
    get_proc_address: unsafe extern "C" fn(*const c_char) -> *const c_void,
    /// Keeps the code in memory.
    _library: Library,
}

/// The default framebuffer, which OSMesa insists on: glumbra draws into framebuffer objects of its own.
const SIDE: c_int = 4;
type Pixels = Box<[u8; (SIDE * SIDE * 4) as usize]>;

/// Declared in the order of their end, as in EGL's context; OSMesa draws into `pixels` until then.
struct OsMesaContext {
    handle: Handle,
    loaded: LoadedContext,
}

struct Handle {
    api: &'static Api,
    context: RawContext,
    pixels: *mut u8,
}

/// Opens an OSMesa context. The error is this backend's answer.
///
/// OSMesa crashes where EGL refuses: with a driver that is not there, or without GLSL 1.30. So it is tried in a child process
/// first, once for each profile.
pub(super) fn open(request: &ContextRequest) -> Result<Rc<dyn Context>, Refusal> {
    static TRIED: [OnceLock<Result<(), String>>; 2] = [OnceLock::new(), OnceLock::new()];
    let tried = TRIED[usize::from(request.profile == Profile::Compatibility)].get_or_init(|| {
        let request = ContextRequest { debug: false, ..*request };
        child::survives(move || drop(open_here(&request)))
    });
    tried.clone().map_err(Refusal::driver)?;
    open_here(request)
}

fn open_here(request: &ContextRequest) -> Result<Rc<dyn Context>, Refusal> {
    let api = library().map_err(Refusal::nothing)?;
    let (profile, name) = match request.profile {
        Profile::Core33 => (CORE_PROFILE, "core"),
        Profile::Compatibility => (COMPAT_PROFILE, "compatibility"),
    };
    let attributes = [
        [FORMAT, glow::RGBA as c_int],
        [DEPTH_BITS, 0],
        [STENCIL_BITS, 0],
        [ACCUM_BITS, 0],
        [PROFILE, profile],
        [CONTEXT_MAJOR_VERSION, 3],
        [CONTEXT_MINOR_VERSION, 3],
        [0, 0],
    ];
    // SAFETY: pairs of name and value that end with 0.
    let context = unsafe { (api.create)(attributes.as_flattened().as_ptr(), null_mut()) };
    if context.is_null() {
        return Err(Refusal::driver(format!("OSMesaCreateContextAttribs refuses OpenGL 3.3 {name}")));
    }
    let pixels: Pixels = Box::new([0; (SIDE * SIDE * 4) as usize]);
    let handle = Handle { api, context, pixels: Box::into_raw(pixels).cast() };
    handle.make_current().map_err(Refusal::driver)?;
    // SAFETY: the context is current; OSMesaGetProcAddress answers with its functions or null.
    let address_of = move |name: &CStr| unsafe { (api.get_proc_address)(name.as_ptr()) };
    let loaded = unsafe { load::load(Backend::OsMesa.to_string(), request, address_of) }.map_err(Refusal::driver)?;
    Ok(Rc::new(OsMesaContext { handle, loaded }))
}

/// libOSMesa, loaded once and kept.
fn library() -> Result<&'static Api, String> {
    static API: OnceLock<Result<Api, String>> = OnceLock::new();
    API.get_or_init(load_library).as_ref().map_err(Clone::clone)
}

fn load_library() -> Result<Api, String> {
    let mut answers = Vec::new();
    for name in NAMES {
        // SAFETY: loading libOSMesa runs its constructors, which is what is asked for.
        let loaded = unsafe { Library::new(name) }.map_err(|error| error.to_string());
        match loaded.and_then(|library| find_functions(library).map_err(|error| format!("{name}: {error}"))) {
            Ok(api) => return Ok(api),
            Err(answer) => answers.push(answer),
        }
    }
    Err(answers.join("; "))
}

fn find_functions(library: Library) -> Result<Api, libloading::Error> {
    // SAFETY: the signatures are those of GL/osmesa.h; the addresses are used only as long as the library, in `Api`.
    unsafe {
        Ok(Api {
            create: *library.get(b"OSMesaCreateContextAttribs\0")?,
            destroy: *library.get(b"OSMesaDestroyContext\0")?,
            make_current: *library.get(b"OSMesaMakeCurrent\0")?,
            get_current: *library.get(b"OSMesaGetCurrentContext\0")?,
            get_proc_address: *library.get(b"OSMesaGetProcAddress\0")?,
            _library: library,
        })
    }
}

impl Context for OsMesaContext {
    fn loaded(&self) -> &LoadedContext {
        &self.loaded
    }

    fn make_current(&self) -> Result<(), Error> {
        self.handle.make_current().map_err(|answer| Error::NotCurrent { backend: self.loaded.backend.clone(), answer })
    }

    fn is_current(&self) -> bool {
        self.handle.is_current()
    }
}

impl Handle {
    fn is_current(&self) -> bool {
        // SAFETY: a query of the calling thread's state.
        unsafe { (self.api.get_current)() == self.context }
    }

    fn make_current(&self) -> Result<(), String> {
        // SAFETY: context and buffer live until the drop, and the buffer holds SIDE rows of SIDE RGBA pixels.
        let answered =
            unsafe { (self.api.make_current)(self.context, self.pixels.cast(), glow::UNSIGNED_BYTE, SIDE, SIDE) };
        if answered != 0 { Ok(()) } else { Err("OSMesaMakeCurrent fails".to_owned()) }
    }
}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: the handles are this context's own and are not used again. It is let go before it is destroyed, and
        // destroyed before its buffer is freed.
        unsafe {
            if self.is_current() {
                (self.api.make_current)(null_mut(), null_mut(), 0, 0, 0);
            }
            (self.api.destroy)(self.context);
            drop(Pixels::from_raw(self.pixels.cast()));
        }
    }
}
