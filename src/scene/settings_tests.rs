//! Words of an error for a range.

use super::*;

#[test]
fn ranges_are_told_without_the_ends_of_f64() {
    for (range, expected) in [
        (-1e18..=1e18, "in [-1e18, 1e18]"),
        (0.0..=1.0, "in [0, 1]"),
        (f64::MIN..=1e18, "at most 1e18"),
        (f64::NEG_INFINITY..=2.0, "at most 2"),
        (1.0..=f64::MAX, "at least 1"),
        (f64::MIN_POSITIVE..=1e18, "above 0 and at most 1e18"),
        (f64::MIN_POSITIVE..=f64::INFINITY, "above 0"),
    ] {
        assert_eq!(words(&range), expected);
    }
}
