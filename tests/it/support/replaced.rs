//! A context some of whose GL functions are a test's own.

use std::ffi::{CStr, c_void};
use std::rc::Rc;

use glumbra::context::{self, Context, LoadedContext};

/// The context, with its own table of functions.
pub struct Replaced {
    inner: Rc<dyn Context>,
    gl: Rc<glow::Context>,
}

impl Replaced {
    /// `replace`: a function's name and the driver's address to the test's address; `None`: the driver's.
    #[expect(clippy::new_ret_no_self, reason = "a context is shared as a trait object")]
    pub fn new(
        inner: Rc<dyn Context>,
        replace: impl Fn(&CStr, *const c_void) -> Option<*const c_void>,
    ) -> Rc<dyn Context> {
        let load = |name: &CStr| {
            let driver = inner.address_of(name);
            replace(name, driver).unwrap_or(driver)
        };
        // SAFETY: the context is current.
        let gl = Rc::new(unsafe { glow::Context::from_loader_function_cstr(load) });
        Rc::new(Self { inner, gl })
    }
}

impl Context for Replaced {
    fn loaded(&self) -> &LoadedContext {
        self.inner.loaded()
    }

    fn make_current(&self) -> Result<(), context::Error> {
        self.inner.make_current()
    }

    fn is_current(&self) -> bool {
        self.inner.is_current()
    }

    fn gl(&self) -> &Rc<glow::Context> {
        &self.gl
    }
}
