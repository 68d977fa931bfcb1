//! Drivers that are broken on purpose, for tests: a layer over the GL function table in which one thing is wrong. Bench,
//! device and fixed function draw through it as through a sound driver.
//!
//! A fault is data in the file of its kind, and [`all`] has them. To add one: a line in that file. A file of a new kind
//! needs a line in `KINDS`.

/// Faults as a table of the file: `"name" [what it breaks] "summary" (hole: "reason") functions => |call| act; ...`, the hole
/// only where no rule sees it, or `"name" [...] "summary" text |source| another text;`.
macro_rules! faults {
    ($($name:literal [$($broken:ident)*] $says:literal $((hole: $hole:literal))? { $($wrong:tt)* })*) => {
        pub(super) const FAULTS: &[$crate::conformance::faults::Fault] = &[$(
            $crate::conformance::faults::Fault {
                name: $name,
                breaks: &[$(stringify!($broken)),*],
                says: $says,
                wrong: faults!(@wrong { $($wrong)* }),
                hole: faults!(@hole $($hole)?),
            }
        ),*];
    };
    (@hole) => { None };
    (@hole $reason:literal) => { Some($reason) };
    (@wrong { text $change:expr }) => { $crate::conformance::faults::Wrong::Text($change) };
    (@wrong { $($($function:ident)+ => $act:expr);+ $(;)? }) => {
        $crate::conformance::faults::Wrong::Calls(&[$((&[$(stringify!($function)),+], $act)),+])
    };
}

mod apart;
mod apart_again;
mod apart_eight;
mod apart_eight_inputs;
mod apart_eight_raster;
mod apart_eight_shaders;
mod apart_inputs;
mod apart_nine;
mod apart_nine_inputs;
mod apart_nine_raster;
mod apart_nine_shaders;
mod apart_seven;
mod apart_seven_inputs;
mod apart_seven_raster;
mod apart_seven_shaders;
mod apart_shaders;
mod apart_six;
mod apart_six_inputs;
mod apart_ten;
mod apart_ten_pixels;
mod apart_ten_raster;
mod apart_ten_shaders;
mod beyond;
mod blending;
mod depth;
mod fifth;
mod fifth_shaders;
mod fixed;
mod fourth;
mod fourth_shaders;
mod framebuffers;
mod functions_of_glsl;
mod generated_fixed;
mod generated_inputs;
mod levels;
mod lights;
mod lookups;
mod of_programs;
mod partial;
mod programs;
mod raster;
mod samplers;
mod shaders;
mod stencil;
mod text;
mod textures;
mod third;
mod third_more;

use std::rc::Rc;

pub use super::layer::call::{Act, Call, Hook};
pub use super::layer::value::Value;
pub use text::{Source, Stage, words};

use text::{after_main, anywhere, define, loops_once};

use super::layer::{self, functions, groups};
use crate::context::Context;

/// One thing that a broken driver does wrong.
#[derive(Clone, Copy)]
pub struct Fault {
    pub name: &'static str,
    /// GL functions, enums (with GL_) and GLSL's words that are no longer what they should be.
    pub breaks: &'static [&'static str],
    /// Summary of what the broken driver does.
    pub says: &'static str,
    wrong: Wrong,
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
    /// GL functions that it changes, or groups of them.
    pub fn changes(&self) -> impl Iterator<Item = &'static str> {
        match self.wrong {
            Wrong::Calls(hooks) => hooks,
            Wrong::Text(_) => &[],
        }
        .iter()
        .flat_map(|(functions, _)| groups::whole(functions))
    }
}

/// The faults by kind.
const KINDS: &[&[Fault]] = &[
    stencil::FAULTS,
    depth::FAULTS,
    raster::FAULTS,
    blending::FAULTS,
    samplers::FAULTS,
    textures::FAULTS,
    framebuffers::FAULTS,
    programs::FAULTS,
    shaders::FAULTS,
    functions_of_glsl::FAULTS,
    lookups::FAULTS,
    fixed::FAULTS,
    levels::FAULTS,
    lights::FAULTS,
    beyond::FAULTS,
    partial::FAULTS,
    of_programs::FAULTS,
    apart::FAULTS,
    apart_again::FAULTS,
    apart_inputs::FAULTS,
    apart_shaders::FAULTS,
    third::FAULTS,
    third_more::FAULTS,
    fourth::FAULTS,
    fourth_shaders::FAULTS,
    fifth::FAULTS,
    fifth_shaders::FAULTS,
    generated_fixed::FAULTS,
    generated_inputs::FAULTS,
    apart_six::FAULTS,
    apart_six_inputs::FAULTS,
    apart_seven::FAULTS,
    apart_seven_raster::FAULTS,
    apart_seven_shaders::FAULTS,
    apart_seven_inputs::FAULTS,
    apart_eight::FAULTS,
    apart_eight_raster::FAULTS,
    apart_eight_shaders::FAULTS,
    apart_eight_inputs::FAULTS,
    apart_nine::FAULTS,
    apart_nine_raster::FAULTS,
    apart_nine_shaders::FAULTS,
    apart_nine_inputs::FAULTS,
    apart_ten::FAULTS,
    apart_ten_raster::FAULTS,
    apart_ten_pixels::FAULTS,
    apart_ten_shaders::FAULTS,
];

/// Every fault.
pub fn all() -> impl Iterator<Item = &'static Fault> {
    KINDS.iter().flat_map(|kind| kind.iter())
}

/// Leaves a parameter as it is.
fn ignore(call: &mut Call, name: u32) {
    if call.u(1) == name {
        call.skip();
    }
}

/// Leaves something off.
fn never_on(call: &mut Call, what: u32) {
    if call.u(0) == what {
        call.skip();
    }
}

/// Holds a call back until the next draw is over.
fn hold(call: &mut Call) {
    call.hold();
}

/// Draws, then makes the calls that were held back.
fn release(call: &mut Call) {
    call.release();
}

/// A context whose driver has the fault. `inner` is current, and stays so.
pub fn broken(inner: Rc<dyn Context>, fault: &Fault) -> Rc<dyn Context> {
    layer::over(inner, |layer| match fault.wrong {
        Wrong::Calls(hooks) => hooks.iter().for_each(|(functions, act)| layer.hook(functions, act)),
        Wrong::Text(change) => {
            layer.hook(&["glCreateShader"], text::note);
            layer.hook(&["glShaderSource"], move |call| text::rewrite(call, change));
        }
    })
}

/// Functions that have a wrapper.
pub fn functions() -> &'static [&'static str] {
    functions::NAMES
}
