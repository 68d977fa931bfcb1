//! A layer over a context's GL function table: every call may be looked at, changed, kept back or noted before it reaches
//! the driver. Drivers that are broken on purpose and the recorder of calls are made of it.

mod asked;
pub mod call;
pub mod functions;
pub mod groups;
pub mod value;

use std::ffi::{CStr, c_void};
use std::rc::Rc;

use self::call::Layer;
use crate::context::{self, Context, LoadedContext};

/// A context whose calls go through the acts that `hook` sets. `inner` is current, and stays so.
pub fn over(inner: Rc<dyn Context>, hook: impl FnOnce(&mut Layer)) -> Rc<dyn Context> {
    let own = inner.clone();
    let mut layer = Layer::new(inner.gl().clone(), move |name| own.address_of(name), functions::invoke_of);
    hook(&mut layer);
    let layer = Rc::new(layer);
    call::make_current(&layer);
    let load = |name: &CStr| address(&layer, inner.as_ref(), name);
    // SAFETY: the context is current; wrappers have the signatures of the functions that they stand for.
    let gl = Rc::new(unsafe { glow::Context::from_loader_function_cstr(load) });
    Rc::new(Layered { inner, layer, gl })
}

/// The wrapper of a function that the layer changes and the driver has, else the driver's.
fn address(layer: &Layer, inner: &dyn Context, name: &CStr) -> *const c_void {
    let driver = inner.address_of(name);
    match name.to_str() {
        Ok(name) if !driver.is_null() && layer.changes(name) => functions::wrapper(name).unwrap_or(driver),
        _ => driver,
    }
}

struct Layered {
    inner: Rc<dyn Context>,
    layer: Rc<Layer>,
    gl: Rc<glow::Context>,
}

impl Context for Layered {
    fn loaded(&self) -> &LoadedContext {
        self.inner.loaded()
    }

    fn make_current(&self) -> Result<(), context::Error> {
        self.inner.make_current()?;
        call::make_current(&self.layer);
        Ok(())
    }

    fn is_current(&self) -> bool {
        self.inner.is_current() && call::is_current(&self.layer)
    }

    fn gl(&self) -> &Rc<glow::Context> {
        &self.gl
    }

    fn address_of(&self, name: &CStr) -> *const c_void {
        address(&self.layer, self.inner.as_ref(), name)
    }
}
