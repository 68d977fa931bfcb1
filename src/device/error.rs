//! Errors between a pass list and its pictures.

/// A failure of the driver, or of a pass list against GL's rules.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message of a variant names its fields")]
#[non_exhaustive]
pub enum Error {
    /// A GL call failed.
    #[error(transparent)]
    Gl(#[from] super::debug::GlError),
    /// A shader does not compile; the log names chunk and line.
    #[error("the {stage} shader of {program} does not compile:\n{log}")]
    Compile { program: String, stage: &'static str, log: String },
    /// The stages of a program do not fit each other.
    #[error("{program} does not link: {log}")]
    Link { program: String, log: String },
    /// A batch sets a uniform that its program does not use.
    #[error("{pass}: {program} has no uniform or sampler `{name}`")]
    UnknownUniform { pass: String, program: String, name: String },
    /// A program uses a uniform that neither the batch nor the draw sets.
    #[error("{pass}: {program} needs `{name}`, and nothing sets it for {draw}")]
    MissingUniform { pass: String, program: String, name: String, draw: String },
    /// A batch and one of its draws both set a uniform.
    #[error(
        "{pass}: `{name}` of {program} is set for all draws of a batch and again for {draw}: draws after that would have its value"
    )]
    UniformSetTwice { pass: String, program: String, name: String, draw: String },
    /// A program reads an attribute that the draw's mesh does not have.
    #[error("{pass}: {program} reads the attribute `{name}`, which {mesh} does not have")]
    MissingAttribute { pass: String, program: String, name: &'static str, mesh: String },
    /// The attachments of a pass make no complete framebuffer.
    #[error("{pass}: the driver cannot draw into {target}: {status}")]
    Incomplete { pass: String, target: String, status: String },
    /// A pass samples an image that it draws into.
    #[error("{pass}: {image} is both read and drawn into (GL 4.6, 9.3.1: the values would be undefined)")]
    Feedback { pass: String, image: String },
    /// The driver refuses the storage of an image.
    #[error("{image}: the driver has no memory for it, or refuses its size or format ({codes})")]
    Allocation { image: String, codes: String },
    /// The context cannot be made current.
    #[error(transparent)]
    Context(#[from] crate::context::Error),
    /// The driver makes no object of a kind, such as a texture or a query.
    #[error("GL cannot make {0}")]
    Create(String),
}
