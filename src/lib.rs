//! glumbra: a headless OpenGL reference renderer of shadows and projected light.
//!
//! A frame's way through the library:
//!
//! 1. [`load`] resolves a file (TOML or OBJ) to a [`scene::Scene`]: plain values, no GL.
//! 2. [`plan::make`] calls each light's technique, whose keys were read with the scene, to describe its
//!    passes,
//! 3. adds the lit pass, and leaves out what this scene cannot show; a [`plan::Plan`] says what, and why.
//! 4. Its pass list ([`plan::Plan::list`]) is data: images, draw state, shader variants, draws. It can be printed and compared.
//! 5. [`context::open`] makes a GL context: EGL, OSMesa or a hidden window.
//! 6. [`device::Device`] turns the pass list into GL with shaders,
//! 7. which [`frame::Renderer`] drives and reads back;
//! 8. [`output`] writes PNG, EXR or NPY, which [`pictures`] reads and compares.
//! 9. [`truth`] finds the same shadows by ray casting in f64 from the scene alone.
//! 10. [`judge`] says how wrong a picture's shadow is, by whichever renderer. `cases` runs pixel tests.
//!
//! Draws a scene that is made in code, and writes the picture:
//!
//! ```
//! use glumbra::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::builder()
//!     .size([320, 240])
//!     .camera([2.5, 4.5, 5.0], [0.2, 0.2, 0.0], 40.0)
//!     .light(LightBuilder::spot([-2.0, 5.0, 1.5], [0.0; 3], 50.0).shadow("shadow-map").set("shadow.size", 1024))
//!     .object(ObjectBuilder::mesh("quad").name("floor").scale([8.0, 1.0, 8.0]))
//!     .object(ObjectBuilder::mesh("box").at([0.0, 0.5, 0.0]).scale([0.5; 3]).color([0.8, 0.5, 0.3]))
//!     .build()?
//!     .scene;
//! let context = context::open(&ContextRequest::default())?;
//! let frame = Renderer::new(&context).render(&scene, &Request::default())?;
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("box.png");
//! output::write_all(&[Output { path: &path, pixels: &frame.picture, view: None }])?;
//! # Ok(())
//! # }
//! ```
//!
//! Tests a picture's shadow: at one point by a formula, then pixel by pixel against exact visibility:
//!
//! ```
//! use glumbra::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = load("data/cases/scenes/box.toml".as_ref(), &["light.shadow.size=1024".to_owned()])?.scene;
//! let context = context::open(&ContextRequest::default())?;
//! let mut renderer = Renderer::new(&context);
//!
//! // How much of light 0 reaches each pixel: 1 lit, 0 shadowed.
//! let shade = ViewRequest { view: View::Shade, light: 0 };
//! let shade = renderer.render(&scene, &Request { views: vec![shade], ..Request::default() })?.views.remove(0);
//! let at = |point: glam::DVec3| scene.pixel(point).and_then(|pixel| shade.at(pixel)).map(|texel| texel[0]);
//!
//! // The box's top corner at (0.5, 1, -0.5) throws its shadow to light + (corner - light) * 5 / 4. A tenth before that
//! // there is shadow, a tenth behind it light.
//! let light = glam::DVec3::new(-2.0, 5.0, 1.5);
//! let corner = light + (glam::DVec3::new(0.5, 1.0, -0.5) - light) * 1.25;
//! let outwards = 0.1 * (corner - light).with_y(0.0).normalize();
//! assert_eq!([at(corner - outwards), at(corner + outwards)], [Some(0.0), Some(1.0)]);
//!
//! let (mut compared, mut wrong) = (0, 0);
//! for (index, pixel) in (0..).zip(&truth::trace(&scene, 0, &Default::default())?.pixels) {
//!     let lit = match pixel.answer {
//!         Answer::Lit => true,
//!         Answer::Shadowed => false,
//!         _ => continue, // nothing there, beside the cone, or at the very edge of something
//!     };
//!     let drawn = shade.at([index % 192, index / 192]).ok_or("the picture has another size")?[0];
//!     compared += 1;
//!     wrong += i32::from((drawn >= 0.5) != lit);
//! }
//! assert!(compared > 10_000);
//! assert!(wrong * 200 < compared, "{wrong} of {compared} pixels are wrong: half a percent at most");
//! # Ok(())
//! # }
//! ```
//!
//! # Cargo features
//!
//! `default-features = false` leaves what a test of pixels needs: scenes, plans, a context without a window, pictures as
//! PNG, the ray tracer; no C++ is compiled. Each feature adds to that, and works alone. A value that needs a missing feature
//! is an error that names it.
//!
//! | feature | adds |
//! |---|---|
//! | `default` | all of these: what the command has |
//! | `pure-rust` | all that need no C++ compiler: the default ones but `flip` and `meshopt` |
//! | `check` | rules for the driver; `glumbra check` |
//! | `cli` | the command with all its subcommands |
//! | `exr` | pictures as OpenEXR files |
//! | `fixed-function` | the same passes by the driver's fixed-function pipeline; `--pipeline fixed-function`, `plan --gl` |
//! | `flip` | FLIP, how different two pictures look to a viewer; compiles C++ |
//! | `meshopt` | vertex-cache order, and `casters = "texel"`, which else draws all triangles and warns; compiles C++ |
//! | `repack` | skins packed again |
//! | `report` | reports, stress tests, figures and the gallery, and their commands |
//! | `window` | contexts of windows, hidden ones too; the viewer and the samples |

// These panic if standard output or standard error is closed or full.
#![deny(clippy::print_stdout, clippy::print_stderr)]
// Input never panics.
#![deny(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::todo, clippy::unimplemented)]
// Calls of C: GL's and the system's. Nowhere but in the modules below that allow it.
#![deny(unsafe_code)]

// Documented: what a program that draws or tests needs. Hidden: parts that the command, the samples and the tests share.
#[cfg(feature = "fixed-function")]
mod c_text;
#[doc(hidden)]
pub mod cases;
#[cfg(feature = "cli")]
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
#[cfg(feature = "report")]
#[doc(hidden)]
pub mod figures;
#[cfg(feature = "fixed-function")]
#[doc(hidden)]
#[allow(unsafe_code)]
pub mod fixed_function;
pub mod frame;
#[cfg(feature = "report")]
#[doc(hidden)]
pub mod gallery;
#[doc(hidden)]
pub mod geometry;
pub mod judge;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod keys;
#[doc(hidden)]
pub mod lights;
#[doc(hidden)]
pub mod math;
pub mod output;
#[doc(hidden)]
pub mod pass;
pub mod pictures;
pub mod plan;
#[doc(hidden)]
pub mod png_file;
pub mod prelude;
#[doc(hidden)]
#[allow(unsafe_code)] // signal handlers, locks on files, the allocator
pub mod process;
#[cfg(feature = "report")]
#[doc(hidden)]
pub mod report;
pub mod scene;
#[cfg(feature = "report")]
#[doc(hidden)]
pub mod stress;
#[doc(hidden)]
pub mod surfaces;
#[doc(hidden)]
pub mod techniques;
pub mod truth;
#[cfg(feature = "window")]
#[doc(hidden)]
pub mod viewer;
#[doc(hidden)]
pub mod views;

pub use glam;
#[doc(inline)]
pub use techniques::{load, load_embedded, load_str};
