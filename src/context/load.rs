//! Loads the functions of the current context. Checks the context before glow does, which panics on surprises.

use std::ffi::{CStr, c_char, c_void};
use std::rc::Rc;

use glow::HasContext;

use super::debug_log::{self, DebugLog};
use super::{ContextRequest, Profile};

/// The functions of a context, and its properties.
pub struct LoadedContext {
    pub(super) gl: Rc<glow::Context>,
    pub(super) backend: String,
    pub(super) profile: Profile,
    pub(super) debug_log: Option<DebugLog>,
    pub(super) timer_bits: u32,
    pub(super) address_of: Box<AddressOf>,
}

/// Looks up a function of its context; null if there is none.
pub(super) type AddressOf = dyn Fn(&CStr) -> *const c_void;

/// Loads the functions of the context that is current, and refuses one that is older than requested.
///
/// # Safety
/// A context is current on this thread, and `address_of` answers with that context's functions or null.
pub(super) unsafe fn load(
    backend: String,
    request: &ContextRequest,
    address_of: impl Fn(&CStr) -> *const c_void + 'static,
) -> Result<LoadedContext, String> {
    // SAFETY: as the caller promises.
    let version = unsafe { version_string(&address_of) }?;
    let (major, minor) = parse_version(&version).ok_or_else(|| format!("GL_VERSION is `{version}`"))?;
    let least = match request.profile {
        Profile::Core33 => (3, 3),
        Profile::Compatibility => (2, 1),
    };
    if version.starts_with("OpenGL ES") || (major, minor) < least {
        return Err(format!("gave OpenGL {version}, and {}.{} is needed", least.0, least.1));
    }
    // SAFETY: as the caller promises; the version has been seen to parse.
    let mut gl = unsafe { glow::Context::from_loader_function_cstr(&address_of) };
    let has_timer = (major, minor) >= (3, 3) || gl.supported_extensions().contains("GL_ARB_timer_query");
    // SAFETY: as the caller promises.
    let timer_bits = if has_timer { unsafe { timer_bits(&address_of) } } else { 0 };
    let debug_log = request.debug.then(|| debug_log::attach(&mut gl)).flatten();
    let (gl, profile) = (Rc::new(gl), request.profile);
    Ok(LoadedContext { gl, backend, profile, debug_log, timer_bits, address_of: Box::new(address_of) })
}

/// glGetQueryiv, which glow leaves out.
unsafe fn timer_bits(address_of: &impl Fn(&CStr) -> *const c_void) -> u32 {
    type GetQueryiv = unsafe extern "system" fn(u32, u32, *mut i32);
    let address = address_of(c"glGetQueryiv");
    if address.is_null() {
        return 0;
    }
    let mut bits = 0;
    // SAFETY: glGetQueryiv has this signature and writes one integer.
    unsafe {
        let get_query = std::mem::transmute::<*const c_void, GetQueryiv>(address);
        get_query(glow::TIME_ELAPSED, glow::QUERY_COUNTER_BITS, &mut bits);
    }
    bits.max(0) as u32
}

unsafe fn version_string(address_of: &impl Fn(&CStr) -> *const c_void) -> Result<String, String> {
    type GetString = unsafe extern "system" fn(u32) -> *const c_char;
    let address = address_of(c"glGetString");
    if address.is_null() {
        return Err("has no glGetString".to_owned());
    }
    // SAFETY: glGetString has this signature, and answers with a string that lives as long as the context.
    unsafe {
        let get_string = std::mem::transmute::<*const c_void, GetString>(address);
        let version = get_string(glow::VERSION);
        if version.is_null() {
            return Err("glGetString(GL_VERSION) answers null".to_owned());
        }
        Ok(CStr::from_ptr(version).to_string_lossy().into_owned())
    }
}

/// `4.5 (Core Profile) Mesa 22.3.6` is (4, 5).
fn parse_version(text: &str) -> Option<(u32, u32)> {
    let numbers = text.trim_start_matches(|c: char| !c.is_ascii_digit());
    let (major, rest) = numbers.split_once('.')?;
    let minor: String = rest.chars().take_while(char::is_ascii_digit).collect();
    Some((major.parse().ok()?, minor.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::parse_version;

    #[test]
    fn versions_of_drivers_parse() {
        assert_eq!(parse_version("4.5 (Core Profile) Mesa 22.3.6"), Some((4, 5)));
        assert_eq!(parse_version("3.3.0 NVIDIA 535.54"), Some((3, 3)));
        assert_eq!(parse_version("OpenGL ES 3.2 Mesa"), Some((3, 2)));
        assert_eq!(parse_version("Mesa"), None);
    }
}
