//! Mistakes with their lines of source.
//!
//! In: the text of a file and its mistakes. Out: per mistake the message, file:line:column, the line with carets under
//! the token, and the help.

use super::unreadable::{self, Unreadable};
use proc_macro2::LineColumn;
use std::fmt::Write as _;

/// Characters of a line that are shown.
const WIDTH: usize = 120;

/// Marks an omitted part of a line.
const CUT: &str = "…";

/// All mistakes of a file, each a paragraph.
#[must_use]
pub fn report(file: &str, text: &str, error: &syn::Error) -> String {
    error.into_iter().map(|error| paragraph(file, text, &error)).collect::<Vec<_>>().join("\n")
}

/// The first mistake in text that is not valid Rust: at its place if known, otherwise the message of the lexer.
#[must_use]
pub fn unreadable(file: &str, text: &str, error: &syn::Error) -> String {
    match unreadable::unreadable(text) {
        Some(Unreadable { place, message }) => at(file, text, &message, [place, place]),
        None => paragraph(file, text, error),
    }
}

fn paragraph(file: &str, text: &str, error: &syn::Error) -> String {
    at(file, text, &error.to_string(), [error.span().start(), error.span().end()])
}

/// The message for a token from `start` to `end`.
fn at(file: &str, text: &str, message: &str, [start, end]: [LineColumn; 2]) -> String {
    let (wrong, helps) = message.split_once('\n').unwrap_or((message, ""));
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
