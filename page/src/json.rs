//! Text for the page.

use std::fmt::Write as _;

/// A string literal.
pub(crate) fn string(text: &str) -> String {
    let mut literal = String::from('"');
    for letter in text.chars() {
        match letter {
            '"' | '\\' => literal.extend(['\\', letter]),
            // Writing to a string cannot fail.
            _ if letter.is_control() => drop(write!(literal, "\\u{:04x}", u32::from(letter))),
            _ => literal.push(letter),
        }
    }
    literal.push('"');
    literal
}

/// A number; `null` if it is not finite.
pub(crate) fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:?}") } else { "null".to_owned() }
}

/// A list of texts.
pub(crate) fn list(entries: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", entries.into_iter().collect::<Vec<_>>().join(","))
}

/// An object with these texts as values.
pub(crate) fn object<const K: usize>(fields: [(&str, String); K]) -> String {
    format!("{{{}}}", fields.map(|(name, value)| format!("{}:{value}", string(name))).join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_and_numbers_are_json() {
        assert_eq!(string("θ \"a\\b\"\n"), r#""θ \"a\\b\"\u000a""#);
        assert_eq!([1.0, -2.5e-300, f64::NAN].map(number), ["1.0", "-2.5e-300", "null"]);
        let fields = [("a", number(1.0)), ("b", list(["x", "y"].map(string)))];
        assert_eq!(object(fields), r#"{"a":1.0,"b":["x","y"]}"#);
    }
}
