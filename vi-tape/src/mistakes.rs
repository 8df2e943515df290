//! Why a text is no system.

use core::fmt;
use vi_codegen::inspect::report::{Mistake, mistakes, paragraphs};

/// The mistakes of a text, each with its place and its correction; or what only a compiler makes of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistakes {
    text: String,
    each: Vec<Mistake>,
    needs_compiler: bool,
}

impl Mistakes {
    /// A mistake in these words, of the whole text.
    pub(crate) fn of(words: &str) -> Self {
        Self { text: words.to_owned(), each: Vec::new(), needs_compiler: false }
    }

    /// Mistakes in the text of a file.
    pub(crate) fn at(file: &str, text: &str, each: Vec<Mistake>) -> Self {
        Self { text: paragraphs(file, text, &each), each, needs_compiler: false }
    }

    /// The mistakes that the compiler found in the text of a file.
    pub(crate) fn wrong(file: &str, text: &str, error: &syn::Error) -> Self {
        Self::at(file, text, mistakes(error))
    }

    /// A system that has to be compiled, because it has this.
    pub(crate) fn compiled(name: &str, what: &str) -> Self {
        let text = format!(
            "error: `{name}` has {what}\n = help: compile it, by `lagrangian!` in Rust or `vi.compile(text)` in Python, which need Rust; or write it without"
        );
        Self { text, each: Vec::new(), needs_compiler: true }
    }

    /// Each mistake at its token, for editors; none for those of the whole text.
    #[must_use]
    pub fn each(&self) -> &[Mistake] {
        &self.each
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
