//! What is near to a segment of a ray.

/// What is near to a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tube {
    /// Where the segment's parameter is 1.
    pub radius: f64,
    /// Whether the radius grows from 0 with the segment's parameter.
    pub tapers: bool,
}

impl Tube {
    /// The segment alone.
    pub const LINE: Self = Self { radius: 0.0, tapers: false };
}
