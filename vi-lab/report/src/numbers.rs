//! Number formats of pages and messages, and some statistics.

/// A number with three digits, and a power of ten if that is shorter: `7.19·10⁻⁹`.
#[must_use]
pub fn scientific(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let text = format!("{value:.2e}");
    match text.split_once('e') {
        Some((digits, exponent)) => match exponent.parse() {
            Ok(exponent @ (-2..=3)) => format!("{value:.*}", usize::try_from(2 - exponent).unwrap_or(0)),
            Ok(exponent) => format!("{digits}·10{}", superscript(exponent)),
            Err(_) => text,
        },
        None => text,
    }
}

/// An integer in superscript digits.
#[must_use]
pub fn superscript(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    exponent
        .to_string()
        .chars()
        .map(|c| c.to_digit(10).and_then(|digit| DIGITS.get(usize::try_from(digit).ok()?).copied()).unwrap_or('⁻'))
        .collect()
}

/// A number with all its digits, and an exponent if it would have many zeros: `0.01`, `1e-300`.
#[must_use]
pub fn short(value: f64) -> String {
    let is_plain = value == 0.0 || !value.is_finite() || (1e-5..1e15).contains(&value.abs());
    if is_plain { value.to_string() } else { format!("{value:e}") }
}

/// Names with their values, with all digits: `m = 1, k = 4`.
#[must_use]
pub fn assigned(values: &[(&str, f64)]) -> String {
    let each: Vec<String> = values.iter().map(|(name, value)| format!("{name} = {}", short(*value))).collect();
    each.join(", ")
}

/// A number with at most three digits: `1.5e-154`, `84`.
pub fn about(value: f64) -> String {
    format!("{value:.2e}").parse().map_or_else(|_| value.to_string(), short)
}

/// The median; `None` without numbers.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}

/// The larger number; NaN if one of them is.
#[must_use]
pub fn larger(one: f64, other: f64) -> f64 {
    if one.is_nan() || other <= one { one } else { other }
}

/// Smallest and largest number.
pub fn extremes(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    values.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Least-squares slope of `(log x, log y)`: the exponent of a power law.
#[must_use]
pub fn order(points: &[(f64, f64)]) -> f64 {
    let sum = |of: fn(f64, f64) -> f64| points.iter().map(|(x, y)| of(x.ln(), y.ln())).sum::<f64>();
    let [n, x, y, xx, xy] = [|_, _| 1.0, |x, _| x, |_, y| y, |x, _| x * x, |x, y| x * y].map(sum);
    (n * xy - x * y) / (n * xx - x * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, expected) in [
            (7.189e-9, "7.19·10⁻⁹"),
            (0.0, "0"),
            (4.6260, "4.63"),
            (886.2, "886"),
            (8.6e4, "8.60·10⁴"),
            (0.0123, "0.0123"),
            (-1e-14, "-1.00·10⁻¹⁴"),
            (9999.0, "1.00·10⁴"),
        ] {
            assert_eq!(scientific(value), expected);
        }
    }

    #[test]
    fn messages_have_no_rows_of_zeros() {
        let numbers = [0.0, 0.01, 1.0, -2.5, 1e-300, 1e300, 123_456_789.0, f64::INFINITY];
        assert_eq!(numbers.map(short), ["0", "0.01", "1", "-2.5", "1e-300", "1e300", "123456789", "inf"]);
        assert_eq!([84.04, 0.0, 1.234_5e-154, 99_999.0].map(about), ["84", "0", "1.23e-154", "100000"]);
    }

    #[test]
    fn statistics_by_hand() {
        assert_eq!(median([3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median([]), None);
        assert_eq!(extremes([2.0, -1.0, 5.0]), (-1.0, 5.0));
        let points: Vec<(f64, f64)> = [1.0, 2.0, 4.0].map(|x: f64| (x, 3.0 * x.powi(-2))).to_vec();
        // Measured 4e-16.
        assert!((order(&points) + 2.0).abs() < 1e-15, "{}", order(&points));
    }
}
