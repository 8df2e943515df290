//! Mistakes at their places.
//!
//! In: the text of a file and what is wrong in it. Out: per mistake the message, file:line:column, the line with carets
//! under the token, and what to do.

use super::unreadable::{self, Unreadable};
use proc_macro2::LineColumn;
use std::fmt::Write as _;

/// All mistakes of a file, each a paragraph.
#[must_use]
pub fn report(file: &str, text: &str, error: &syn::Error) -> String {
    error.into_iter().map(|error| paragraph(file, text, &error)).collect::<Vec<_>>().join("\n")
}

/// The mistake for which a text is none of Rust, as a paragraph: its place if it is known, else what the lexer says.
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

/// The message for a token from its start to its end.
fn at(file: &str, text: &str, message: &str, [start, end]: [LineColumn; 2]) -> String {
    let (wrong, helps) = message.split_once('\n').unwrap_or((message, ""));
    let line = text.lines().nth(start.line.saturating_sub(1)).unwrap_or_default();
    let margin = " ".repeat(start.line.to_string().len());
    // A token of several lines is marked to the end of its first.
    let stop = if end.line == start.line { end.column } else { line.chars().count() };
    let carets = "^".repeat(stop.saturating_sub(start.column).max(1));
    // Tabs stay tabs, so that the carets stand where the token does.
    let before: String = line.chars().take(start.column).map(|c| if c == '\t' { c } else { ' ' }).collect();
    let mut report = format!("error: {wrong}\n{margin}--> {file}:{}:{}\n", start.line, start.column + 1);
    // Writing to a string does not fail.
    let _ = write!(report, "{margin} |\n{} | {line}\n{margin} | {before}{carets}\n", start.line);
    for help in helps.lines() {
        let _ = writeln!(report, "{margin} = {help}");
    }
    report
}
