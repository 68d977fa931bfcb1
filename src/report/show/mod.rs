//! A report as a page and as plots.

pub mod html;
pub mod plots;
