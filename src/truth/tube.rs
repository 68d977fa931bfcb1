//! Neighbourhood of a segment of a ray.

/// Neighbourhood of a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tube {
    /// Radius where the segment's parameter is 1.
    pub radius: f64,
    /// True if the radius grows from 0 with the segment's parameter.
    pub tapers: bool,
}

impl Tube {
    /// The segment alone.
    pub const LINE: Self = Self { radius: 0.0, tapers: false };
}
