//! Text that is not valid Rust.
//!
//! In: text that the lexer of Rust rejects, so that the macro never sees it. Out: the first wrong character with its
//! help: an unmatched bracket, or a mathematical sign.

use crate::messages::characters::{Character, closing_of};
use crate::messages::words::sign;
use crate::messages::{Habit, Message};
use proc_macro2::LineColumn;

/// The first wrong character with its message and its position, line from 1, column from 0; `None` if only the lexer
/// knows it.
pub(crate) fn unreadable(text: &str) -> Option<(LineColumn, Message)> {
    let mut open: Vec<(char, LineColumn)> = Vec::new();
    let mut scanner = Scanner::new(text);
    let mut before = ' ';
    while let Some((place, letter)) = scanner.next() {
        let follows_name = before.is_alphanumeric() || matches!(before, ')' | ']' | '\'');
        before = letter;
        let mistake = match letter {
            '\'' if follows_name => return Some((place, Message::Habit(Habit::Prime))),
            '(' | '[' | '{' => {
                open.push((letter, place));
                continue;
            }
            ')' | ']' | '}' => match open.pop() {
                Some((opening, _)) if closing_of(opening) == letter => continue,
                Some((opening, LineColumn { line, column })) => {
                    Character::Closes { closing: letter, opening, line, column: column + 1 }
                }
                None => Character::NotOpened { closing: letter },
            },
            _ if sign(letter).is_some() => Character::Sign { letter },
            _ => continue,
        };
        return Some((place, Message::Character(mistake)));
    }
    let (opening, place) = open.pop()?;
    Some((place, Message::Character(Character::NotClosed { opening })))
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
