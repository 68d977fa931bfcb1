//! Pixel tests as data: a folder with a `case.toml` names a scene and what must be seen of it, and [`CaseRunner`] draws it
//! and makes the checks. `glumbra test` runs them.
//!
//! Checks are made in the order of [`KINDS`]. A GL error, or a message of high severity from the driver, fails any picture
//! before it is looked at. What a check needs to know it takes from the resolved scene, by other means than the
//! renderer's: never from matrices, planes or pass lists. A check that could not fail is refused when the file is read.
//!
//! ```
//! use glumbra::cases::{CaseRunner, CaseVerdict, PixelCase, Settings};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = r#"
//! asks = "Is the shadow right?"
//! scene = "sphere.toml"
//! [[pick]]
//! at = [0.5, 0.0, -0.375]
//! class = "shadowed"
//! why = "the middle of the sphere, projected: light + (center - light) * 5/4"
//! [[truth]]
//! false_shadow = 0.1
//! leak = 0.1
//! why = "a map of 256 texels"
//! "#;
//! let case = PixelCase::parse(text, "data/cases/scenes".as_ref(), "sphere")?;
//! # let folder = tempfile::tempdir()?;
//! let settings = Settings { failures: folder.path().into(), ..Settings::default() };
//! let outcome = CaseRunner::new(settings).run(&case);
//! assert_eq!(outcome.verdict, CaseVerdict::Pass, "{:?}", outcome.failure());
//! # Ok(())
//! # }
//! ```
//!
//! # Files
//!
//! `find.rs` finds folders, `read.rs` reads one: `file.rs` has the keys, `refused.rs` what a file may not ask. `runner.rs`
//! runs a case: `check.rs` makes its checks (`picks.rs`, `floors.rs`, `relations.rs`, `truths.rs`, `golden.rs`) on
//! `bench.rs`, whose pictures `draw.rs` or `command.rs` draws (`placeholders.rs`: its words). `outcome.rs` has what comes of it.

mod bench;
mod check;
mod classes;
mod command;
pub mod draw;
mod error;
pub mod file;
mod find;
mod floors;
pub mod formula;
pub mod golden;
mod outcome;
mod picks;
mod placeholders;
mod read;
mod refused;
mod relations;
mod runner;
mod truths;

pub use check::KINDS;
pub use error::Error;
pub use file::{Checks, Pick};
pub use find::{FoundCase, choose, find, shard};
pub use outcome::{CaseOutcome, CaseVerdict, Failure, FailureFiles};
pub use read::{FILE, PixelCase};
pub use runner::{CaseRunner, Settings};
