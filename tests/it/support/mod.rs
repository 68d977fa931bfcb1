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

use glumbra::scene::{Error, Loaded, Scene};

/// Loads a file with the texts of `--set`.
pub fn load_file(path: &Path, overrides: &[&str]) -> Result<Loaded, Error> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    glumbra::load(path, &overrides)
}

/// The scene of a text that names no files.
pub fn scene_of(text: &str) -> Scene {
    glumbra::load_str(text, Path::new(""), &[]).unwrap_or_else(|error| panic!("{error}\n{text}")).scene
}
