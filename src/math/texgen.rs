//! Eye-linear texture-coordinate generation.
