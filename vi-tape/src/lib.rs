//! Systems from text at run time.
//!
//! In: the text of a system, as `lagrangian!` takes it. Out: a [`System`], which runs by every method in milliseconds:
//! no compiler of Rust is needed. The compiler of the macro runs up to its program, a list of operations of two
//! operands; an interpreter executes them over any type of numbers, where the macro would print them.
//!
//! | module | product |
//! |---|---|
//! | `lines` | a function as instructions over registers, and the interpreter |
//! | `code` | the facts and functions of a system |
//! | `compile` | the code of a text |
//! | `matrix` | matrices whose form is known at run time |
//! | `tape` | a code as a system of N coordinates |
//! | `sizes` | the numbers of coordinates that are built |

#![allow(clippy::inline_always, reason = "a call would lose the vector instructions of its caller")]

mod code;
mod compile;
mod lines;
mod matrix;
mod mistakes;
mod sizes;
mod tape;

pub use mistakes::Mistakes;

use code::Code;
use core::ops::{Deref, DerefMut};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A system of a text, with its default parameters and every method.
pub struct System(Box<dyn vi_erased::System>);

impl System {
    /// Compiles the text of a system: `struct … { … }`, or the same in a `lagrangian!`. Equal texts share their code,
    /// which stays until the program ends.
    ///
    /// # Errors
    /// The mistakes of the text with their places; what only the macro compiles: Rust functions, tables, constraints;
    /// more coordinates or parameters than are built.
    pub fn parse(text: &str) -> Result<Self, Mistakes> {
        sizes::system(code(text)?).map(Self)
    }

    /// The type-erased system.
    #[must_use]
    pub fn into_inner(self) -> Box<dyn vi_erased::System> {
        self.0
    }
}

impl Deref for System {
    type Target = dyn vi_erased::System;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl DerefMut for System {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut *self.0
    }
}

/// The codes of all texts so far.
static CODES: Mutex<BTreeMap<Box<str>, &'static Code>> = Mutex::new(BTreeMap::new());

/// The code of a text. Systems are `Copy` and refer to it, so that it stays.
fn code(text: &str) -> Result<&'static Code, Mistakes> {
    let known = || CODES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(code) = known().get(text) {
        return Ok(code);
    }
    let code: &'static Code = Box::leak(Box::new(compile::code(text)?));
    known().insert(text.into(), code);
    Ok(code)
}
