//! The tests of this crate as one program.

mod counting;
mod rival;
mod start;
