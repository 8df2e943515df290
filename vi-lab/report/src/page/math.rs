//! Formulas as `MathML`, from text in a notation like that of TeX.
//!
//! Letters, digits and signs stand for themselves. `_` and `^` take the next part, `{…}` is one part. `\frac{…}{…}` and
//! `\sqrt{…}` are as in TeX, another `\word` is one identifier, `~` is a gap.

use crate::html::escape;
use core::iter::Peekable;
use core::str::Chars;

/// A displayed formula.
#[must_use]
pub(super) fn display(formula: &str) -> String {
    format!("<math display=\"block\"><mrow>{}</mrow></math>", row(&mut formula.chars().peekable()))
}

/// The parts up to a closing brace or the end, with their indices and exponents.
fn row(text: &mut Peekable<Chars>) -> String {
    let parts = core::iter::from_fn(|| {
        let base = part(text)?;
        let index = text.next_if_eq(&'_').and_then(|_| part(text));
        let exponent = text.next_if_eq(&'^').and_then(|_| part(text));
        Some(match (index, exponent) {
            (None, None) => base,
            (Some(index), None) => format!("<msub>{base}{index}</msub>"),
            (None, Some(exponent)) => format!("<msup>{base}{exponent}</msup>"),
            (Some(index), Some(exponent)) => format!("<msubsup>{base}{index}{exponent}</msubsup>"),
        })
    });
    parts.collect()
}

/// The next part; `None` at a closing brace or the end.
fn part(text: &mut Peekable<Chars>) -> Option<String> {
    let first = text.find(|letter| !letter.is_whitespace())?;
    let mut rest = |is_part: fn(&char) -> bool| -> String { core::iter::from_fn(|| text.next_if(is_part)).collect() };
    Some(match first {
        '}' => return None,
        '{' => format!("<mrow>{}</mrow>", row(text)),
        '~' => "<mo>&emsp;</mo>".to_owned(),
        '\\' => match rest(|letter| letter.is_alphabetic()).as_str() {
            "frac" => format!("<mfrac>{}{}</mfrac>", part(text)?, part(text)?),
            "sqrt" => format!("<msqrt>{}</msqrt>", part(text)?),
            word => format!("<mi>{word}</mi>"),
        },
        '0'..='9' => format!("<mn>{first}{}</mn>", rest(char::is_ascii_digit)),
        letter if letter.is_alphabetic() => format!("<mi>{letter}</mi>"),
        sign => format!("<mo>{}</mo>", escape(&sign.to_string())),
    })
}

#[cfg(test)]
mod tests {
    use super::display;

    #[test]
    fn a_formula_has_its_elements() {
        let of = |formula: &str| {
            display(formula).replace("<math display=\"block\"><mrow>", "").replace("</mrow></math>", "")
        };
        let power = "<msubsup><mi>h</mi><mi>k</mi><mrow><mn>10</mn><mi>s</mi></mrow></msubsup>";
        assert_eq!(of("h_k^{10s} ≤ \\const"), format!("{power}<mo>≤</mo><mi>const</mi>"));
        assert_eq!(
            of("\\frac{1}{2} \\sqrt{x}"),
            "<mfrac><mrow><mn>1</mn></mrow><mrow><mn>2</mn></mrow></mfrac><msqrt><mrow><mi>x</mi></mrow></msqrt>"
        );
        assert_eq!(of("D^′ < 0"), "<msup><mi>D</mi><mo>′</mo></msup><mo>&lt;</mo><mn>0</mn>");
    }
}
