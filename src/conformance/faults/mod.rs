//! Drivers that are broken on purpose, for tests: a layer over the GL function table in which one thing is wrong. Bench,
//! device and fixed function draw through it as through a sound driver.
//!
//! A fault is data in the file of its kind, and [`all`] has them. To add one: a line in that file. A file of a new kind
//! needs a line in [`KINDS`].

mod call;
mod depth;
mod functions;
mod shaders;
mod stencil;
mod text;
mod textures;

use std::ffi::{CStr, c_void};
use std::rc::Rc;

pub use call::{Act, Call, Hook, Value};
pub use text::{Source, Stage, after_main, define, words};

use crate::context::{self, Context, LoadedContext};
use call::Layer;

/// One thing that a broken driver does wrong.
#[derive(Clone, Copy)]
pub struct Fault {
    pub name: &'static str,
    /// GL functions, enums (with GL_) and GLSL's words that are no longer what they should be.
    pub breaks: &'static [&'static str],
    /// Summary of what the broken driver does.
    pub says: &'static str,
    wrong: Wrong,
    /// Ids of rules that it turns red, the quickest first.
    pub red: &'static [&'static str],
    /// Reason why no rule sees it.
    pub hole: Option<&'static str>,
}

#[derive(Clone, Copy)]
enum Wrong {
    Calls(&'static [Hook]),
    /// Another text for a shader; `None`: as it is.
    Text(fn(&Source) -> Option<String>),
}

impl Fault {
    /// Calls that are changed on their way.
    const fn calls(
        name: &'static str,
        breaks: &'static [&'static str],
        says: &'static str,
        hooks: &'static [Hook],
    ) -> Self {
        Self { name, breaks, says, wrong: Wrong::Calls(hooks), red: &[], hole: None }
    }

    /// Shaders that are changed before they are compiled.
    const fn text(
        name: &'static str,
        breaks: &'static [&'static str],
        says: &'static str,
        change: fn(&Source) -> Option<String>,
    ) -> Self {
        Self { name, breaks, says, wrong: Wrong::Text(change), red: &[], hole: None }
    }

    /// The same with rules that see it.
    const fn red(mut self, rules: &'static [&'static str]) -> Self {
        self.red = rules;
        self
    }

    /// The same with the reason why no rule sees it.
    #[allow(dead_code, reason = "best where there are none")]
    const fn hole(mut self, reason: &'static str) -> Self {
        self.hole = Some(reason);
        self
    }
}

/// The faults by kind.
const KINDS: &[&[Fault]] = &[depth::FAULTS, shaders::FAULTS, stencil::FAULTS, textures::FAULTS];

/// Every fault.
pub fn all() -> impl Iterator<Item = &'static Fault> {
    KINDS.iter().flat_map(|kind| kind.iter())
}

/// Functions that draw.
const DRAWS: &[&str] = &["glDrawArrays", "glDrawArraysInstanced", "glDrawElements", "glEnd"];

/// A context whose driver has the fault. `inner` is current, and stays so.
pub fn broken(inner: Rc<dyn Context>, fault: &Fault) -> Rc<dyn Context> {
    let own = inner.clone();
    let mut layer = Layer::new(inner.gl().clone(), move |name| own.address_of(name));
    match fault.wrong {
        Wrong::Calls(hooks) => hooks.iter().for_each(|(functions, act)| layer.hook(functions, act)),
        Wrong::Text(change) => {
            layer.hook(&["glCreateShader"], text::note);
            layer.hook(&["glShaderSource"], move |call| text::rewrite(call, change));
        }
    }
    let layer = Rc::new(layer);
    call::make_current(&layer);
    let load = |name: &CStr| address(&layer, inner.as_ref(), name);
    // SAFETY: the context is current; wrappers have the signatures of the functions that they stand for.
    let gl = Rc::new(unsafe { glow::Context::from_loader_function_cstr(load) });
    Rc::new(Broken { inner, layer, gl })
}

/// The wrapper of a function that the fault changes and the driver has, else the driver's.
fn address(layer: &Layer, inner: &dyn Context, name: &CStr) -> *const c_void {
    let driver = inner.address_of(name);
    match name.to_str() {
        Ok(name) if !driver.is_null() && layer.changes(name) => functions::wrapper(name).unwrap_or(driver),
        _ => driver,
    }
}

/// Functions that have a wrapper.
pub fn functions() -> &'static [&'static str] {
    functions::NAMES
}

struct Broken {
    inner: Rc<dyn Context>,
    layer: Rc<Layer>,
    gl: Rc<glow::Context>,
}

impl Context for Broken {
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
