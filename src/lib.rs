//! glumbra: a headless OpenGL reference renderer of shadows and projected light.
//!
//! A frame's way through the library:
//!
//! 1. [`load`] resolves a file (TOML or OBJ) to a [`scene::Scene`]: plain values, no GL.
//! 2. [`plan::make`] calls each light's technique ([`techniques::TABLE`]), whose keys were read with the scene, to describe its
//!    passes,
//! 3. adds the lit pass, and leaves out what this scene cannot show; a [`plan::Plan`] says what, and why.
//! 4. Its [`pass::PassList`] is data: images, draw state, shader variants, draws. It can be printed and compared.
//! 5. [`context::open`] makes a GL context: EGL, OSMesa or a hidden window.
//! 6. [`device::Device`] turns the pass list into GL with shaders,
//! 7. which [`frame::Renderer`] drives and reads back;
//! 8. [`output`] writes PNG, EXR or NPY, which [`pictures`] reads and compares.
//! 9. [`truth`] finds the same shadows by ray casting in f64 from the scene alone, [`fixed_function`] draws
//!    the same passes by the driver's own fixed-function pipeline.
//! 10. [`judge`] says how wrong a picture's shadow is, by whichever renderer; [`report`] says what that cost over many
//!     settings; [`stress`] judges scenes made to break techniques.
//!
//! Draws a scene and writes the picture:
//!
//! ```
//! use glumbra::{context, frame::Renderer, output};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = glumbra::load("data/cases/scenes/box.toml".as_ref(), &[])?.scene;
//! let context = context::open(&Default::default())?;
//! let mut renderer = Renderer::new(&context);
//! let plan = renderer.plan(&scene, &Default::default())?;
//! renderer.draw(&plan)?;
//! let picture = renderer.read(&plan)?.picture;
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("box.png");
//! output::write_all(&[output::Output { path: &path, pixels: &picture, view: None }])?;
//! # Ok(())
//! # }
//! ```
//!
//! Tests a picture's shadow, pixel by pixel, against exact visibility:
//!
//! ```
//! use glumbra::{context, device::Pixels, frame::Renderer, plan, truth};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let size = ["light.shadow.size=1024".to_owned()];
//! let scene = glumbra::load("data/cases/scenes/box.toml".as_ref(), &size)?.scene;
//! let context = context::open(&Default::default())?;
//! let mut renderer = Renderer::new(&context);
//!
//! // How much of light 0 reaches each pixel: 1 lit, 0 shadowed.
//! let shade = plan::ViewRequest { view: plan::View::Shade, light: 0 };
//! let plan = renderer.plan(&scene, &plan::Request { views: vec![shade], ..Default::default() })?;
//! renderer.draw(&plan)?;
//! let Some(Pixels::RgbaF32 { data, .. }) = renderer.read(&plan)?.views.pop() else { return Err("no view".into()) };
//!
//! let truth = truth::trace(&scene, 0, &Default::default())?;
//! let (mut compared, mut wrong) = (0, 0);
//! for (pixel, texel) in truth.pixels.iter().zip(data.chunks_exact(4)) {
//!     let lit = match pixel.answer {
//!         truth::Answer::Lit => true,
//!         truth::Answer::Shadowed => false,
//!         _ => continue, // nothing there, beside the cone, or at the very edge of something
//!     };
//!     compared += 1;
//!     wrong += i32::from((texel[0] >= 0.5) != lit);
//! }
//! assert!(compared > 10_000);
//! assert!(wrong * 200 < compared, "{wrong} of {compared} pixels are wrong: half a percent at most");
//! # Ok(())
//! # }
//! ```

// These panic if standard output or standard error is closed or full.
#![deny(clippy::print_stdout, clippy::print_stderr)]
// Input never panics.
#![deny(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::todo, clippy::unimplemented)]
// Calls of C: GL's and the system's. Nowhere but in the modules below that allow it.
#![deny(unsafe_code)]

// Documented: what a program that draws or tests needs. Hidden: parts that the command, the samples and the tests share.
mod c_text;
pub mod cases;
#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod combiners;
#[doc(hidden)]
pub mod compositions;
#[doc(hidden)]
#[allow(unsafe_code)]
pub mod conformance;
#[allow(unsafe_code)]
pub mod context;
#[allow(unsafe_code)]
pub mod device;
#[doc(hidden)]
pub mod figures;
#[doc(hidden)]
#[allow(unsafe_code)]
pub mod fixed_function;
pub mod frame;
#[doc(hidden)]
pub mod geometry;
pub mod judge;
#[doc(hidden)]
pub mod lights;
#[doc(hidden)]
pub mod math;
pub mod output;
pub mod pass;
pub mod pictures;
pub mod plan;
#[doc(hidden)]
#[allow(unsafe_code)] // signal handlers, locks on files, the allocator
pub mod process;
pub mod report;
pub mod scene;
pub mod stress;
#[doc(hidden)]
pub mod surfaces;
#[doc(hidden)]
pub mod techniques;
pub mod truth;
#[doc(hidden)]
pub mod viewer;
#[doc(hidden)]
pub mod views;

#[doc(inline)]
pub use techniques::{load, load_embedded};
