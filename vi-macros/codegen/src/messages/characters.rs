//! Characters that Rust itself cannot read, so that the macro never sees them.

use super::words::sign;

catalogue! {
    /// A wrong character of a text.
    Character:

    Closes { closing: char, opening: char, line: usize, column: usize } =
        "`{closing}` closes the `{opening}` of {line}:{column}",
        { format!("write `{}` before it, or remove one", closing_of(*opening)) },
        ["a {\n  (b + c;\n«}»"] { closing: '}', opening: '(', line: 2, column: 3 };
    NotOpened { closing: char } =
        "`{closing}` has no opening bracket", "remove it, or write the opening bracket before it",
        ["a«)»"] { closing: ')' };
    NotClosed { opening: char } =
        "`{opening}` is not closed", { format!("write `{}`", closing_of(*opening)) },
        ["a «{»\n  b[1];\n"] { opening: '{' }, ["// (\n/* ) */ \"}\\\"]\" «[»"] { opening: '[' };
    Sign { letter: char } =
        "`{letter}` is not a character of the language", { sign(*letter).unwrap_or_default().to_owned() },
        ["x * sin(30«°»)"] { letter: '°' }, ["L = m * x«²»;"] { letter: '²' }, ["«½» * x"] { letter: '½' },
        ["«√»(x)"] { letter: '√' }, ["a «−» b"] { letter: '−' };
}

/// The bracket that closes one.
pub(crate) fn closing_of(opening: char) -> char {
    match opening {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}
