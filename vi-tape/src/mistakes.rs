//! Why a text is no system.

use core::fmt;

/// The mistakes of a text, each with its place and its correction; or what only a compiler makes of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistakes {
    text: String,
    needs_compiler: bool,
}

impl Mistakes {
    /// Mistakes in these words.
    pub(crate) fn of(text: String) -> Self {
        Self { text, needs_compiler: false }
    }

    /// A system that has to be compiled, because it has this.
    pub(crate) fn compiled(name: &str, what: &str) -> Self {
        let text = format!(
            "error: `{name}` has {what}\n = help: compile it, by `lagrangian!` in Rust or `vi.compile(text)` in Python, which need Rust; or write it without"
        );
        Self { text, needs_compiler: true }
    }

    /// Whether the text is right, and `lagrangian!` compiles it.
    #[must_use]
    pub fn needs_compiler(&self) -> bool {
        self.needs_compiler
    }
}

impl fmt::Display for Mistakes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text.trim_end())
    }
}

impl core::error::Error for Mistakes {}
