//! Numbers as the panel writes and reads them.

/// Digits that count: finer changes can't be seen in a cloth.
const DIGITS: usize = 5;
/// Digits of what changes all the time.
const BRIEF_DIGITS: usize = 3;

/// A number with a few digits that count and without trailing zeros: 0.0125, 20000, 1.5e-7.
pub(super) fn text(value: f64) -> String {
    with_digits(value, DIGITS)
}

/// The same with fewer digits, for what changes all the time.
pub(super) fn brief(value: f64) -> String {
    with_digits(value, BRIEF_DIGITS)
}

fn with_digits(value: f64, digits: usize) -> String {
    let size = value.abs();
    if !size.is_finite() {
        return value.to_string();
    }
    if size != 0.0 && !(1e-4..1e7).contains(&size) {
        let text = format!("{value:.*e}", digits - 1);
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", trimmed(digits));
    }
    let before = size.max(1.0).log10() as usize + 1;
    // A zero before the point and those right behind it don't count.
    let after = if size > 0.0 && size < 1.0 { 1 + (-size.log10()) as usize } else { 0 };
    trimmed(&format!("{value:.*}", digits.saturating_sub(before) + after)).to_owned()
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// Reads what was typed, with or without a unit behind it. None where that isn't a finite number.
pub(super) fn parse(text: &str) -> Option<f64> {
    // Grouped digits, and the minus sign that egui writes.
    let text: String = text.chars().filter(|c| !c.is_whitespace()).map(|c| if c == '−' { '-' } else { c }).collect();
    let value = |text: &str| text.parse::<f64>().ok().filter(|value| value.is_finite());
    // An exponent has a letter too, so the longest beginning that is a number counts.
    let end = text.rfind(|c: char| c.is_ascii_digit() || c == '.').map_or(0, |last| last + 1);
    let (number, unit) = text.split_at(end);
    value(number).filter(|_| unit.is_empty() || unit.starts_with(|c: char| c.is_alphabetic() || c == '°' || c == '%'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_count() {
        for (value, expected) in [
            (0.0, "0"),
            (f64::from(0.15_f32), "0.15"),
            (0.0125, "0.0125"),
            (-0.5, "-0.5"),
            (9.81, "9.81"),
            (5000.0, "5000"),
            (20_000.0, "20000"),
            (1234.5678, "1234.6"),
            (0.001, "0.001"),
            (0.000_123_456_7, "0.00012346"),
            (1.5e-7, "1.5e-7"),
            (2e9, "2e9"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(text(value), expected);
        }
    }

    #[test]
    fn brief_numbers_have_three_digits() {
        for (value, expected) in
            [(0.0, "0"), (1.0 / 3.0, "0.333"), (-12.345, "-12.3"), (12345.6, "12346"), (1.234e-6, "1.23e-6")]
        {
            assert_eq!(brief(value), expected);
        }
    }

    #[test]
    fn what_is_written_is_read() {
        for value in [0.0, 1e-6, 0.005, 0.1, 1.0, 12.5, 999.99, 1e4, 1e6, 2.5e8, -3.0] {
            assert_eq!(parse(&text(value)), Some(value));
        }
    }

    #[test]
    fn units_are_read_over_and_other_things_are_no_number() {
        assert_eq!(parse(" 20 000 N/m"), Some(20_000.0));
        assert_eq!(parse("1e3 kg"), Some(1000.0));
        assert_eq!(parse("−45°"), Some(-45.0));
        for text in ["", "abc", "NaN", "-nan", "inf", "1e999", "1-2", "5 +", "--5"] {
            assert_eq!(parse(text), None, "{text:?}");
        }
    }
}
