//! Numbers and ranges as a person would write them, for messages.

use std::fmt;
use std::ops::RangeInclusive;

/// A range as a person would write it; f64's limits are no bounds.
pub(super) fn words(range: &RangeInclusive<f64>) -> String {
    let (low, high) = (*range.start(), *range.end());
    let least = match low {
        low if low <= f64::MIN => None,
        low if low > 0.0 && low <= f64::MIN_POSITIVE => Some(String::from("above 0")),
        low if high < f64::MAX => return format!("in [{}, {}]", Plain(low), Plain(high)),
        low => Some(format!("at least {}", Plain(low))),
    };
    let most = (high < f64::MAX).then(|| format!("at most {}", Plain(high)));
    [least, most].into_iter().flatten().collect::<Vec<_>>().join(" and ")
}

/// A number as a person would write it: 1e18, not eighteen zeros.
pub(super) struct Plain(pub f64);

impl fmt::Display for Plain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size != 0.0 && !(1e-4..1e7).contains(&size) { write!(f, "{:e}", self.0) } else { write!(f, "{}", self.0) }
    }
}
