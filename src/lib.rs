//! glumbra: a headless OpenGL reference renderer of shadows and projected light.

pub mod geometry;
pub mod math;
pub mod oracle;
pub mod report;
pub mod scene;
