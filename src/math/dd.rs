//! Double-double 4×4 matrices.
