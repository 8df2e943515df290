//! Systems from text at run time.
//!
//! In: the text of a system, as `lagrangian!` takes it. Out: a [`System`], which runs by every method in milliseconds:
//! no compiler of Rust is needed. The compiler of the macro runs up to its program, a list of operations of two
//! operands; an interpreter executes them over any type of numbers.
//!
//! | module | product |
//! |---|---|
//! | `mistakes` | the mistakes in the text of a system |
//! | `lines` | a function as instructions over registers, and the interpreter |
//! | `tables` | the tables of a system |
//! | `code` | the facts and functions of a system |
//! | `compile` | the code of a text |
//! | `kinds` | what differs between systems without and with constraints |
//! | `tape` | a code as a system of N coordinates |
//! | [`expressions`] | expressions in the names of a system, and the summands of L, along a motion |
//! | `sizes` | the numbers of coordinates that are built |

#![allow(clippy::inline_always, reason = "a call would lose the vector instructions of its caller")]

mod code;
mod compile;
pub mod expressions;
mod kinds;
mod lines;
mod mistakes;
mod sizes;
mod tables;
mod tape;

pub use code::Start;
pub use mistakes::Mistakes;
pub use vi_codegen::inspect::report::Mistake;

use code::Code;
use core::ops::{Deref, DerefMut};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// A system of a text, with every method. Its functions and runs are those of [`vi_erased::System`].
pub struct System {
    of: Box<dyn vi_erased::System>,
    code: &'static Code,
}

impl System {
    /// Compiles the text of a system: `struct … { … }`, or the same in a `lagrangian!`. The parameters are the defaults.
    /// Equal texts share their code, which stays until the program ends.
    ///
    /// # Errors
    /// The mistakes of the text with their places; what has to be compiled: Rust functions, more coordinates, constraints
    /// or parameters than are built.
    pub fn parse(text: &str) -> Result<Self, Mistakes> {
        Self::of_file("definition", text, &[])
    }

    /// Compiles the text of a file, as [`System::parse`]. The name of the file is in the mistakes. `files` are paths
    /// and texts of files of tables, as the system names them; others are read.
    ///
    /// # Errors
    /// As [`System::parse`].
    pub fn of_file(file: &str, text: &str, files: &[(String, String)]) -> Result<Self, Mistakes> {
        let code = code(file, text, files)?;
        Ok(Self { of: sizes::system(code)?, code })
    }

    /// The type-erased system.
    #[must_use]
    pub fn into_inner(self) -> Box<dyn vi_erased::System> {
        self.of
    }

    /// The state of the clause `check { … }`, if the text has one: a place to start from.
    #[must_use]
    pub fn check(&self) -> Option<&Start> {
        self.code.start.as_ref()
    }

    /// The texts of the files of its tables.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.code.files.values().map(String::as_str)
    }
}

impl Deref for System {
    type Target = dyn vi_erased::System;

    fn deref(&self) -> &Self::Target {
        &*self.of
    }
}

impl DerefMut for System {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut *self.of
    }
}

/// The codes of all texts so far, with the texts of the files of their tables.
static CODES: Mutex<BTreeMap<Key, &'static Code>> = Mutex::new(BTreeMap::new());

type Key = (Box<str>, BTreeMap<PathBuf, String>);

/// The code of a text. Systems are `Copy` and refer to it, so that it stays.
fn code(file: &str, text: &str, files: &[(String, String)]) -> Result<&'static Code, Mistakes> {
    let known = || CODES.lock().unwrap_or_else(PoisonError::into_inner);
    let parsed = compile::parsed(file, text, files)?;
    let key = (text.into(), parsed.system.files.clone());
    if let Some(code) = known().get(&key) {
        return Ok(code);
    }
    let code = compile::code(file, text, parsed)?;
    // Another thread may have compiled it meanwhile.
    Ok(known().entry(key).or_insert_with(|| Box::leak(Box::new(code))))
}
