//! Numbers on the command line, and the files that it names.
//!
//! In: text. Out: the number, or one line with the allowed values.

use crate::failure::Failure;
use std::fs;
use std::path::Path;

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

/// Whether a file has systems, by its name: Rust, or a bare `struct` in a file that ends in `.vi`.
#[must_use]
pub fn has_systems(path: &Path) -> bool {
    path.extension().is_some_and(|kind| kind == "rs" || kind == "vi")
}

/// The text of a file. Only regular files are read: a pipe may never end.
///
/// # Errors
/// [`Failure::Input`] if it cannot be read, or is not a regular file.
pub fn text(path: &Path) -> Result<String, Failure> {
    check_regular(path)?;
    fs::read_to_string(path).map_err(|error| Failure::Input(format!("{}: {error}", path.display())))
}

/// Checks that a path is a regular file.
///
/// # Errors
/// [`Failure::Input`] if it is not.
pub fn check_regular(path: &Path) -> Result<(), Failure> {
    let shown = path.display();
    match fs::metadata(path) {
        Err(error) => Err(Failure::Input(format!("{shown}: {error}"))),
        Ok(found) if !found.is_file() => {
            Err(Failure::Input(format!("{shown} is not a regular file; name a regular file")))
        }
        Ok(_) => Ok(()),
    }
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
}
