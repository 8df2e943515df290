//! Formulas as `MathML`, put together from small elements.

/// A formula on a line of its own.
pub fn display(elements: &str) -> String {
    format!("<math display=\"block\"><mrow>{elements}</mrow></math>")
}

/// An identifier.
pub fn id(name: &str) -> String {
    format!("<mi>{name}</mi>")
}

/// A number.
pub fn num(digits: &str) -> String {
    format!("<mn>{digits}</mn>")
}

/// An operator.
pub fn op(symbol: &str) -> String {
    format!("<mo>{symbol}</mo>")
}

/// `base` with a subscript.
pub fn sub(base: &str, index: &str) -> String {
    format!("<msub>{base}{index}</msub>")
}

/// `base` with a superscript.
pub fn sup(base: &str, exponent: &str) -> String {
    format!("<msup>{base}{exponent}</msup>")
}

/// `base` with both.
pub fn sub_sup(base: &str, index: &str, exponent: &str) -> String {
    format!("<msubsup>{base}{index}{exponent}</msubsup>")
}

/// A fraction.
pub fn frac(above: &str, below: &str) -> String {
    format!("<mfrac>{above}{below}</mfrac>")
}

/// A square root.
pub fn sqrt(inside: &str) -> String {
    format!("<msqrt>{inside}</msqrt>")
}

/// Elements as one.
pub fn row(elements: &[String]) -> String {
    format!("<mrow>{}</mrow>", elements.concat())
}
