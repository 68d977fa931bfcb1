//! Errors between a pass list and its pictures.

/// A failure of the driver, or of a pass list against GL's rules.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error(transparent)]
    Gl(#[from] super::debug::GlError),
    #[error("the {stage} shader of {program} does not compile:\n{log}")]
    Compile { program: String, stage: &'static str, log: String },
    #[error("{program} does not link: {log}")]
    Link { program: String, log: String },
    #[error("{pass}: {program} has no uniform or sampler `{name}`")]
    UnknownUniform { pass: String, program: String, name: String },
    #[error("{pass}: {program} needs `{name}`, and nothing sets it for {draw}")]
    MissingUniform { pass: String, program: String, name: String, draw: String },
    #[error(
        "{pass}: `{name}` of {program} is set for all draws of a batch and again for {draw}: draws after that would have its value"
    )]
    UniformSetTwice { pass: String, program: String, name: String, draw: String },
    #[error("{pass}: {program} reads the attribute `{name}`, which {mesh} does not have")]
    MissingAttribute { pass: String, program: String, name: &'static str, mesh: String },
    #[error("{pass}: the driver cannot draw into {target}: {status}")]
    Incomplete { pass: String, target: String, status: String },
    #[error("{pass}: {image} is both read and drawn into (GL 4.6, 9.3.1: the values would be undefined)")]
    Feedback { pass: String, image: String },
    #[error("{image}: the driver has no memory for it, or refuses its size or format ({codes})")]
    Allocation { image: String, codes: String },
    #[error(transparent)]
    Context(#[from] crate::context::Error),
    #[error("GL cannot make {0}")]
    Create(String),
}
