//! glumbra: a headless OpenGL reference renderer of shadows and projected light.

pub mod cli;
pub mod context;
pub mod device;
pub mod frame;
pub mod geometry;
pub mod math;
pub mod oracle;
pub mod output;
pub mod pass;
pub mod plan;
pub mod report;
pub mod scene;
pub mod techniques;
pub mod viewer;
