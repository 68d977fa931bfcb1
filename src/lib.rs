//! glumbra: a headless OpenGL reference renderer of shadows and projected light.
//!
//! A frame's way through the library:
//!
//! 1. [`scene::load`] resolves a file (TOML or OBJ) to a [`scene::Scene`]: plain values, no GL.
//! 2. [`plan::make`] calls each light's technique ([`techniques::TABLE`]) to describe its passes,
//! 3. adds the lit pass, and leaves out what this scene cannot show; a [`plan::Plan`] says what, and why.
//! 4. Its [`pass::PassList`] is data: images, draw state, shader variants, draws. It can be printed and compared.
//! 5. [`context::open`] makes a GL context: EGL, OSMesa or a hidden window.
//! 6. [`device::Device`] turns the pass list into GL, the only module that does,
//! 7. which [`frame::Renderer`] drives and reads back;
//! 8. [`output`] writes PNG, EXR or NPY.
//! 9. [`truth`] finds the same shadows by ray casting in f64 from the scene alone, [`fixed_function`] draws
//!    the same passes by the driver's own fixed-function pipeline, and
//! 10. [`report`] says how far apart they are, and what that cost; [`stress`] does so for scenes made to break them.
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = glumbra::scene::load("data/scenes/main.toml".as_ref(), &[])?.scene;
//! let context = glumbra::context::open(&Default::default())?;
//! let mut renderer = glumbra::frame::Renderer::new(context.as_ref());
//! let plan = renderer.plan(&scene, &Default::default())?;
//! renderer.draw(&plan)?;
//! let pixels = renderer.read(&plan)?.picture;
//! # Ok(())
//! # }
//! ```

// These panic if standard output or standard error is closed or full.
#![deny(clippy::print_stdout, clippy::print_stderr)]
// Input never panics.
#![deny(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::todo, clippy::unimplemented)]
// Calls of C: GL's and the system's. Nowhere but in the modules below that allow it.
#![deny(unsafe_code)]

pub mod cli;
pub mod compositions;
#[allow(unsafe_code)]
pub mod conformance;
#[allow(unsafe_code)]
pub mod context;
#[allow(unsafe_code)]
pub mod device;
pub mod figures;
#[allow(unsafe_code)]
pub mod fixed_function;
pub mod frame;
pub mod geometry;
pub mod lights;
pub mod math;
pub mod output;
pub mod pass;
pub mod plan;
#[allow(unsafe_code)] // signal handlers, locks on files, the allocator
pub mod process;
pub mod report;
pub mod scene;
pub mod stress;
pub mod surfaces;
pub mod techniques;
pub mod truth;
pub mod viewer;
pub mod views;
