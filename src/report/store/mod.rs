//! A report as data and as files.

pub mod claim_sweep;
pub mod claimed;
pub mod csv;
pub mod fingerprint;
pub mod journal;
pub mod light_pictures;
pub mod merge;
pub mod picture_files;
pub mod pictures;
pub mod results;
pub mod spread;
pub mod swept;
pub mod write;
