//! Counts of what planning does on this thread. Tests hold how they grow with a scene, so that a step that visits all objects
//! for each object is seen without a clock.
//!
//! Work is counted where it is done: a box where its corners are found, triangles in each loop over a mesh. Other threads have
//! counts of their own.

use std::cell::Cell;

/// Numbers of steps since the thread began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WorkDone {
    /// Boxes whose corners were found.
    pub boxes: u64,
    /// Triangles that a loop visited.
    pub triangles: u64,
    /// Comparisons of two images' texels, or of a point with a surface that may hide it.
    pub comparisons: u64,
}

thread_local! {
    static BOXES: Cell<u64> = const { Cell::new(0) };
    static TRIANGLES: Cell<u64> = const { Cell::new(0) };
    static COMPARISONS: Cell<u64> = const { Cell::new(0) };
}

/// The steps of this thread so far.
pub fn done() -> WorkDone {
    WorkDone { boxes: BOXES.get(), triangles: TRIANGLES.get(), comparisons: COMPARISONS.get() }
}

/// Counts a box.
pub(crate) fn count_box() {
    BOXES.set(BOXES.get() + 1);
}

/// Counts the triangles that `indices` are, three each.
pub(crate) fn count_triangles(indices: usize) {
    TRIANGLES.set(TRIANGLES.get() + indices as u64 / 3);
}

/// Counts a comparison: of two images' texels, or of a point with a surface that may hide it.
pub(crate) fn count_comparison() {
    COMPARISONS.set(COMPARISONS.get() + 1);
}
