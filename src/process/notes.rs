//! Notes that code makes on this thread while somebody listens: for lists that are made from what code does.

use std::any::Any;
use std::cell::RefCell;

thread_local! {
    /// The notes so far; `None`: nobody listens.
    static NOTES: RefCell<Option<Vec<Box<dyn Any>>>> = const { RefCell::new(None) };
}

/// Does `work`, and returns the notes of the type `N` that it makes on this thread, in order.
pub(crate) fn listen<T, N: Any>(work: impl FnOnce() -> T) -> (T, Vec<N>) {
    let before = NOTES.replace(Some(Vec::new()));
    let done = work();
    let notes = NOTES.replace(before).unwrap_or_default();
    (done, notes.into_iter().filter_map(|note| note.downcast().ok()).map(|note| *note).collect())
}

/// Makes a note, if somebody listens.
pub(crate) fn note<N: Any>(make: impl FnOnce() -> N) {
    NOTES.with_borrow_mut(|notes| {
        if let Some(notes) = notes {
            notes.push(Box::new(make()));
        }
    });
}
