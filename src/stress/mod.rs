//! Scenes against truth: named extreme cases, random scenes and files that are given, each drawn by every technique and each of its settings
//! that matters, each picture judged by the ray caster.
//!
//! Every error must be reported: a row ends as right, warned, refused, or *silently wrong* ([`Verdict`]).
//! [`crate::judge`] has the bound between right and wrong.

mod bumps;
mod case;
mod colors;
pub mod files;
mod judge;
pub mod named;
mod page;
mod photos;
mod pictures;
mod plot;
pub mod projected;
pub mod random;
mod reduce;
mod results;
mod rows;
mod run;
mod table;
mod write;

pub use case::{Case, CaseSource};
pub use colors::{rows as color_rows, rows_of as color_rows_of};
pub use judge::{Judged, RowJudge};
pub use reduce::reduce;
pub use results::{CaseResult, CaseRow, Verdict, tally};
pub use rows::{RowSettings, rows};
pub use run::{StressOptions, draw_case, run};
pub use table::to_text;
pub use write::{Error, to_json, write};
