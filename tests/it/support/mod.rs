//! Shared by several tests.

pub mod contexts;
pub mod gl_headers;
pub mod lit_box;
#[cfg(unix)]
pub mod processes;
pub mod random;
pub mod replaced;
pub mod rims;
#[cfg(unix)]
pub mod shell;
pub mod window;
pub mod xvfb;

use std::path::Path;

use glumbra::scene::{Error, Loaded};

/// Loads a file with the texts of `--set`.
pub fn load_file(path: &Path, overrides: &[&str]) -> Result<Loaded, Error> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    glumbra::load(path, &overrides)
}
