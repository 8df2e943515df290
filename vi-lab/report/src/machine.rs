//! The origin of a file: versions, command line, machine.

use std::borrow::Cow;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Version of the project.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Version of the compiler.
const RUSTC: &str = env!("VI_RUSTC");

/// The versions, the command line, the time since its start, and the machine, for a footer.
pub(crate) fn origin(started: Instant) -> String {
    let build = if cfg!(debug_assertions) { "debug" } else { "release" };
    format!(
        "Made by vi-lab {VERSION} ({build} build, {RUSTC}) with “{command}” in {seconds:.1} s on {processor}, \
         {threads} threads, {os} {architecture}. Charts drawn by kuva {kuva}.",
        command = command_line(),
        seconds = started.elapsed().as_secs_f64(),
        processor = processor().unwrap_or_else(|| "unknown processor".to_owned()),
        threads = std::thread::available_parallelism().map_or(1, usize::from),
        os = env::consts::OS,
        architecture = env::consts::ARCH,
        kuva = kuva::VERSION,
    )
}

/// The name of the running program: `vi-lab`, or the user's own.
pub fn program() -> String {
    let path = env::args_os().next().map(PathBuf::from);
    let name = path.as_deref().and_then(Path::file_stem).map(|name| name.to_string_lossy().into_owned());
    name.unwrap_or_else(|| "vi-lab".to_owned())
}

/// The command line on one line with the name of the program only; an argument with blanks is quoted.
#[must_use]
pub fn command_line() -> String {
    let arguments = env::args_os().skip(1).map(|argument| quoted(&argument.to_string_lossy()));
    core::iter::once(quoted(&program())).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// A text for a terminal: keeps line ends and tabs, escapes other control characters, with which names and files could
/// change the display.
#[must_use]
pub fn visible(text: &str) -> Cow<'_, str> {
    escaped(text, |letter| letter.is_control() && !matches!(letter, '\n' | '\t'))
}

/// A text with the selected characters escaped.
fn escaped(text: &str, is_escaped: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_escaped) {
        return Cow::Borrowed(text);
    }
    let one = |letter: char| if is_escaped(letter) { letter.escape_default().collect() } else { letter.to_string() };
    text.chars().map(one).collect()
}

/// An argument as one word on one line.
fn quoted(argument: &str) -> String {
    let needs_quotes = argument.is_empty() || argument.contains(|letter: char| letter.is_whitespace());
    let argument = escaped(argument, char::is_control);
    if needs_quotes { format!("'{argument}'") } else { argument.into_owned() }
}

/// The name of the processor, if the system provides it.
fn processor() -> Option<String> {
    let description = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = description.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_argument_is_one_word_of_one_line() {
        let shown = ["kepler", "a b.csv", "", "x\ny"].map(quoted);
        assert_eq!(shown, ["kepler", "'a b.csv'", "''", "'x\\ny'"]);
    }

    #[test]
    fn a_text_cannot_steer_the_terminal() {
        let raw = "line\n\ttab \u{1b}[31mred\u{1b}[0m \r\u{7}\u{9b}2J\u{7f} π";
        assert_eq!(visible(raw), "line\n\ttab \\u{1b}[31mred\\u{1b}[0m \\r\\u{7}\\u{9b}2J\\u{7f} π");
        assert!(matches!(visible("plain\n"), Cow::Borrowed(_)));
    }
}
