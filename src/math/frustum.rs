//! Frustum tests of boxes.
