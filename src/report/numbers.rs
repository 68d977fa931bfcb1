//! Formats numbers for people: plain decimals, no exponents. Knows no unit.

/// Three significant digits, no trailing zeros: 0.0123, 12.3, 1230.
pub fn plain(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { value.to_string() };
    }
    let magnitude = value.abs().log10().floor() as i32;
    let decimals = (2 - magnitude).clamp(0, 12) as usize;
    let text = format!("{value:.decimals$}");
    if decimals == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').to_owned() }
}

/// A fixed number of decimals for a column; a non-zero value that would round to zero is shown as below the least.
pub fn fixed(value: f64, decimals: usize) -> String {
    let least = 0.1_f64.powi(decimals as i32);
    if value > 0.0 && value < 0.5 * least {
        return format!("<{least:.decimals$}");
    }
    format!("{value:.decimals$}")
}

/// Bytes in the largest binary unit that leaves at least one.
pub fn bytes(bytes: u64) -> String {
    let units = [(1_u64 << 30, "GiB"), (1 << 20, "MiB"), (1 << 10, "KiB")];
    match units.iter().find(|(size, _)| bytes >= *size) {
        Some((size, unit)) => format!("{} {unit}", plain(bytes as f64 / *size as f64)),
        None => format!("{bytes} B"),
    }
}

/// Digits in groups of three.
pub fn grouped(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// Text with its first letter in upper case.
pub fn first_upper(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_plain() {
        let cases = [(0.0, "0"), (0.01, "0.01"), (0.012345, "0.0123"), (1.0, "1"), (10.0, "10"), (12.34, "12.3")];
        for (value, text) in cases.into_iter().chain([(1234.5, "1234"), (100_000.0, "100000"), (9.999, "10")]) {
            assert_eq!(plain(value), text, "{value}");
        }
    }

    #[test]
    fn what_is_not_zero_does_not_look_like_zero() {
        assert_eq!(fixed(0.0, 3), "0.000");
        assert_eq!(fixed(0.0002, 3), "<0.001");
        assert_eq!(fixed(1.23456, 3), "1.235");
    }

    #[test]
    fn bytes_have_binary_units() {
        assert_eq!((bytes(12), bytes(1 << 20), bytes(3 << 19)), ("12 B".into(), "1 MiB".into(), "1.5 MiB".into()));
        assert_eq!(grouped(1_234_567), "1\u{202f}234\u{202f}567");
    }
}
