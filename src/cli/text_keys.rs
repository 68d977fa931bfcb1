//! Keywords of the texts in a PNG that `glumbra render` writes.

pub const SCENE: &str = "Scene";
pub const OVERRIDES: &str = "Overrides";
pub const TECHNIQUE: &str = "Technique";
pub const DRIVER: &str = "Driver";
