//! Numbers on the command line.
//!
//! In: text. Out: the number, or one line with the allowed values.

/// A number of steps or rows: `1000`, or `1e6` if it is a whole number.
///
/// # Errors
/// The allowed values, if the text is not such a number.
pub fn count(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let digits = text.parse().ok();
    digits.or_else(|| text.parse().ok().and_then(whole)).ok_or_else(|| format!("write {COUNT}"))
}

/// The allowed values.
pub const COUNT: &str = "a whole number from 0 to 1.8e19, such as 1000 or 1e6";

/// A number with a decimal point or an exponent as a count; `None` if it is not a whole number.
#[must_use]
pub fn whole(value: f64) -> Option<u64> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // whole, and below 2^64
    (value.fract() == 0.0 && (1.0..18_446_744_073_709_551_616.0).contains(&value)).then_some(value as u64)
}

/// A number; the caller decides whether it must be finite.
///
/// # Errors
/// As [`count`].
pub fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| {
        let hint = if text.contains('\u{2212}') { "; write the minus sign as a hyphen `-`" } else { "" };
        format!("write a number such as 0.5 or 1e-3{hint}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_may_have_an_exponent() {
        for (text, expected) in [
            ("0", Some(0)),
            (" 12 ", Some(12)),
            ("1e6", Some(1_000_000)),
            ("1.5e3", Some(1500)),
            ("18446744073709551615", Some(u64::MAX)),
            ("1.5e0", None),
            ("-3", None),
            ("1e400", None),
            ("1e-400", None),
            ("18446744073709551616", None),
            ("nan", None),
            ("", None),
        ] {
            assert_eq!(count(text).ok(), expected, "{text}");
        }
    }

    #[test]
    fn a_printed_minus_is_explained() {
        assert_eq!(number(" -1.5e-3 "), Ok(-1.5e-3));
        assert_eq!(number("one"), Err("write a number such as 0.5 or 1e-3".to_owned()));
        assert!(number("−1").is_err_and(|message| message.ends_with("; write the minus sign as a hyphen `-`")));
    }
}
