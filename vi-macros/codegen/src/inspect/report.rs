//! Mistakes with their lines of source.
//!
//! In: the text of a file and its mistakes. Out: per mistake the message, file:line:column, the line with carets under
//! the token, and the help.

use super::unreadable;
use proc_macro2::LineColumn;
use std::fmt::Write as _;

/// Characters of a line that are shown.
const WIDTH: usize = 120;

/// Marks an omitted part of a line.
const CUT: &str = "…";

/// A mistake at its token.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// The mistake in words.
    pub wrong: String,
    /// The lines of help, each with the kind of help at its begin.
    pub helps: String,
    /// The first character of the token, and the one behind it: lines from 1, columns in characters from 0.
    pub token: [LineColumn; 2],
}

/// All mistakes of a text, in order.
#[must_use]
pub fn mistakes(error: &syn::Error) -> Vec<Mistake> {
    error.into_iter().map(|error| Mistake::of(&error)).collect()
}

/// The first mistake in text that is not valid Rust: at its place if known, otherwise the message of the lexer.
#[must_use]
pub fn first_unreadable(text: &str, error: &syn::Error) -> Mistake {
    match unreadable::unreadable(text) {
        Some((place, message)) => Mistake::new(&message.text(), [place, place]),
        None => Mistake::of(error),
    }
}

/// All mistakes of a file, each a paragraph.
#[must_use]
pub fn report(file: &str, text: &str, error: &syn::Error) -> String {
    paragraphs(file, text, &mistakes(error))
}

/// [`first_unreadable`] as a paragraph.
#[must_use]
pub fn unreadable(file: &str, text: &str, error: &syn::Error) -> String {
    first_unreadable(text, error).paragraph(file, text)
}

/// Each mistake of a file as a paragraph.
#[must_use]
pub fn paragraphs(file: &str, text: &str, mistakes: &[Mistake]) -> String {
    mistakes.iter().map(|mistake| mistake.paragraph(file, text)).collect::<Vec<_>>().join("\n")
}

impl Mistake {
    fn of(error: &syn::Error) -> Self {
        Self::new(&error.to_string(), [error.span().start(), error.span().end()])
    }

    fn new(message: &str, token: [LineColumn; 2]) -> Self {
        let (wrong, helps) = message.split_once('\n').unwrap_or((message, ""));
        Self { wrong: wrong.to_owned(), helps: helps.to_owned(), token }
    }

    /// The mistake with the line of its token, and carets under it.
    fn paragraph(&self, file: &str, text: &str) -> String {
        let Self { wrong, helps, token: [start, end] } = self;
        let line: Vec<char> = text.lines().nth(start.line.saturating_sub(1)).unwrap_or_default().chars().collect();
        let margin = " ".repeat(start.line.to_string().len());
        // A token of several lines is marked to the end of its first line.
        let stop = if end.line == start.line { end.column } else { line.len() };
        let Excerpt { shown, before, carets } = excerpt(&line, start.column, stop);
        let mut report = format!("error: {wrong}\n{margin}--> {file}:{}:{}\n", start.line, start.column + 1);
        // Writing to a string cannot fail.
        let _ = write!(report, "{margin} |\n{} | {shown}\n{margin} | {before}{carets}\n", start.line);
        for help in helps.lines() {
            let _ = writeln!(report, "{margin} = {help}");
        }
        report
    }
}

/// A line with carets under a token.
struct Excerpt {
    /// The line, or a part of it around the token.
    shown: String,
    /// The characters before the carets.
    before: String,
    carets: String,
}

/// The excerpt of a line whose token has these columns.
fn excerpt(line: &[char], start: usize, stop: usize) -> Excerpt {
    let start = start.min(line.len());
    let from = if line.len() > WIDTH { start.saturating_sub(WIDTH / 2).min(line.len() - WIDTH) } else { 0 };
    let to = line.len().min(from + WIDTH);
    let [left, right] = [from > 0, to < line.len()].map(|is_cut| if is_cut { CUT } else { "" });
    let shown: String = line[from..to].iter().collect();
    // Keeps tabs, so that the carets align with the token.
    let before = left.chars().chain(line[from..start].iter().copied()).map(|c| if c == '\t' { c } else { ' ' });
    Excerpt {
        before: before.collect(),
        carets: "^".repeat(stop.min(to).saturating_sub(start).max(1)),
        shown: format!("{left}{shown}{right}"),
    }
}
