//! glumbra: a headless OpenGL reference renderer of shadows and projected light.

pub mod device;
pub mod geometry;
pub mod math;
pub mod pass;
pub mod plan;
pub mod scene;
pub mod techniques;
