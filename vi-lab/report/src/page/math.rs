//! Formulas as `MathML`, built from small elements.

/// A displayed formula.
#[must_use]
pub fn display(elements: &str) -> String {
    format!("<math display=\"block\"><mrow>{elements}</mrow></math>")
}

/// An identifier.
#[must_use]
pub fn id(name: &str) -> String {
    format!("<mi>{name}</mi>")
}

/// A number.
#[must_use]
pub fn num(digits: &str) -> String {
    format!("<mn>{digits}</mn>")
}

/// An operator.
#[must_use]
pub fn op(symbol: &str) -> String {
    format!("<mo>{symbol}</mo>")
}

/// `base` with a subscript.
#[must_use]
pub fn sub(base: &str, index: &str) -> String {
    format!("<msub>{base}{index}</msub>")
}

/// `base` with a superscript.
#[must_use]
pub fn sup(base: &str, exponent: &str) -> String {
    format!("<msup>{base}{exponent}</msup>")
}

/// `base` with both.
#[must_use]
pub fn sub_sup(base: &str, index: &str, exponent: &str) -> String {
    format!("<msubsup>{base}{index}{exponent}</msubsup>")
}

/// A fraction.
#[must_use]
pub fn frac(above: &str, below: &str) -> String {
    format!("<mfrac>{above}{below}</mfrac>")
}

/// A square root.
#[must_use]
pub fn sqrt(inside: &str) -> String {
    format!("<msqrt>{inside}</msqrt>")
}

/// Combines elements.
#[must_use]
pub fn row(elements: &[String]) -> String {
    format!("<mrow>{}</mrow>", elements.concat())
}
