//! Text that is not valid Rust.
//!
//! In: text that the lexer of Rust rejects, so that the macro never sees it. Out: the first wrong character with its
//! help: an unmatched bracket, or a mathematical sign.

use crate::habits::{DEGREES, Habit};
use proc_macro2::LineColumn;

/// A wrong character.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unreadable {
    /// Its position: line from 1, column from 0.
    pub(super) place: LineColumn,
    /// The error, then `help:` on a second line.
    pub(super) message: String,
}

/// The first wrong character; `None` if only the lexer knows it.
pub(super) fn unreadable(text: &str) -> Option<Unreadable> {
    let mut open: Vec<(char, LineColumn)> = Vec::new();
    let mut scanner = Scanner::new(text);
    let mut before = ' ';
    while let Some((place, letter)) = scanner.next() {
        let follows_name = before.is_alphanumeric() || matches!(before, ')' | ']' | '\'');
        before = letter;
        match letter {
            '\'' if follows_name => {
                let message = format!("{}\nhelp: {}", Habit::Prime.what(), Habit::Prime.help());
                return Some(Unreadable { place, message });
            }
            '(' | '[' | '{' => open.push((letter, place)),
            ')' | ']' | '}' => match open.pop() {
                Some((opening, _)) if closing(opening) == letter => {}
                Some((opening, opened)) => {
                    let LineColumn { line, column } = opened;
                    let wanted = closing(opening);
                    let message = format!(
                        "`{letter}` closes the `{opening}` of {line}:{}\nhelp: write `{wanted}` before it, or remove one",
                        column + 1
                    );
                    return Some(Unreadable { place, message });
                }
                None => {
                    let message = format!(
                        "`{letter}` has no opening bracket\nhelp: remove it, or write the opening bracket before it"
                    );
                    return Some(Unreadable { place, message });
                }
            },
            _ => {
                if let Some(help) = sign(letter) {
                    let message = format!("`{letter}` is not a character of the language\nhelp: {help}");
                    return Some(Unreadable { place, message });
                }
            }
        }
    }
    let (opening, place) = open.pop()?;
    let wanted = closing(opening);
    Some(Unreadable { place, message: format!("`{opening}` is not closed\nhelp: write `{wanted}`") })
}

fn closing(opening: char) -> char {
    match opening {
        '(' => ')',
        '[' => ']',
        _ => '}',
    }
}

/// Help for a mathematical sign.
fn sign(letter: char) -> Option<&'static str> {
    let help = match letter {
        '°' => DEGREES,
        '²' => "write `^2`",
        '³' => "write `^3`",
        '⁰'..='⁹' | '¹' => "write a power with `^`, as in `x^4`",
        '₀'..='₉' => "write an index in its name, `x_1`, or of an array, `q[1]`",
        '½' => "write `1/2`",
        '¼' => "write `1/4`",
        '√' => "write `sqrt(x)`",
        '×' => "write `*`, or `cross(a, b)` of two vectors",
        '∙' | '⋅' | '•' => "write `*`",
        '‖' => "write `norm(v)`",
        '÷' => "write `/`",
        '\u{2212}' | '–' | '—' => "write the hyphen `-`",
        '∂' => "write `dot(x)` for a derivative with respect to time; the macro differentiates `L`",
        '∑' => "write `sum(i in 0..8, …)`",
        '\\' => "write names without a backslash: `theta`, or `θ`",
        '“' | '”' | '’' | '‘' => "remove the quotation marks",
        '\u{a0}' => "write a plain space",
        _ => return None,
    };
    Some(help)
}

/// The characters of a text outside comments and strings.
struct Scanner<'a> {
    letters: core::iter::Peekable<core::str::Chars<'a>>,
    place: LineColumn,
}

impl<'a> Scanner<'a> {
    fn new(text: &'a str) -> Self {
        Self { letters: text.chars().peekable(), place: LineColumn { line: 1, column: 0 } }
    }

    /// The next character of the text.
    fn letter(&mut self) -> Option<(LineColumn, char)> {
        let letter = self.letters.next()?;
        let place = self.place;
        if letter == '\n' {
            self.place = LineColumn { line: place.line + 1, column: 0 };
        } else {
            self.place.column += 1;
        }
        Some((place, letter))
    }

    /// Skips characters up to the one at which `is_end(previous, current)` holds.
    fn skip(&mut self, is_end: impl Fn(char, char) -> bool) {
        let mut before = '\0';
        while let Some((_, letter)) = self.letter() {
            if is_end(before, letter) {
                break;
            }
            // An escaped backslash escapes nothing.
            before = if before == '\\' && letter == '\\' { '\0' } else { letter };
        }
    }

    /// Whether a character literal ends two characters further on.
    fn is_character(&self) -> bool {
        self.letters.clone().nth(1) == Some('\'')
    }

    /// The next character outside comments and strings.
    fn next(&mut self) -> Option<(LineColumn, char)> {
        loop {
            let (place, letter) = self.letter()?;
            match (letter, self.letters.peek().copied()) {
                ('/', Some('/')) => self.skip(|_, letter| letter == '\n'),
                ('/', Some('*')) => self.skip(|before, letter| before == '*' && letter == '/'),
                ('\'', _) if self.is_character() => {
                    self.letter();
                    self.letter();
                }
                ('"', _) => self.skip(|before, letter| letter == '"' && before != '\\'),
                _ => return Some((place, letter)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_message(text: &str, line: usize, column: usize, message: &str) {
        let found = unreadable(text).expect("something is wrong");
        assert_eq!((found.place.line, found.place.column + 1), (line, column), "{text}");
        assert!(found.message.starts_with(message), "{}", found.message);
    }

    #[test]
    fn unmatched_brackets_are_reported_at_their_place() {
        assert_message("a {\n  (b + c;\n}", 3, 1, "`}` closes the `(` of 2:3\nhelp: write `)` before it");
        assert_message("a)", 1, 2, "`)` has no opening bracket");
        assert_message("a {\n  b[1];\n", 1, 3, "`{` is not closed");
        assert_message("// (\n/* ) */ \"}\\\"]\" [", 2, 16, "`[` is not closed");
        assert_eq!(unreadable("a { b(c[1]) } // ²"), None);
        assert_eq!(unreadable("a { '(' }"), None);
        assert_eq!(unreadable("fn f<'a>(a: &'a str) -> &'static str"), None);
    }

    #[test]
    fn primes_are_assert_message() {
        for (text, column) in [("L = q'^2 / 2;", 6), ("L = q'' * q;", 6), ("L = x'(t)^2;", 6), ("L = q[0]' - 1;", 9)] {
            assert_message(
                text,
                1,
                column,
                "a prime does not denote a derivative\nhelp: write `dot(x)` for the velocity of `x`",
            );
        }
    }

    #[test]
    fn signs_of_paper_are_assert_message() {
        assert_message(
            "x * sin(30°)",
            1,
            11,
            "`°` is not a character of the language\nhelp: angles are in radians: write `30 * pi / 180`",
        );
        assert_message("L = m * x²;", 1, 10, "`²` is not a character of the language\nhelp: write `^2`");
        for (text, help) in [("½ * x", "write `1/2`"), ("√(x)", "write `sqrt(x)`"), ("a − b", "write the hyphen `-`")]
        {
            assert!(unreadable(text).is_some_and(|found| found.message.ends_with(help)), "{text}");
        }
    }
}
