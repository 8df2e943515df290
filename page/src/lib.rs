//! Functions for a page in the browser: from a text to a motion with its energy error.
//!
//! In: a text and numbers, which the page writes into buffers. Out: facts and mistakes as JSON, rows of numbers. The page
//! calls `exports`; the other modules are ordinary Rust, so that tests and programs call them too.
//!
//! | module | product |
//! |---|---|
//! | [`facts`] | the facts of a system, or its mistakes |
//! | [`motion`] | the rows of a run |
//! | [`rival`] | a Runge–Kutta run with as many evaluations |
//! | `exports` | these functions with one buffer for text and one for numbers |
//!
//! No module imports one below it in this table.

mod exports;
pub mod facts;
pub mod motion;
pub mod rival;
