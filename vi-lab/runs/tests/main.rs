//! The tests of this crate, one program.

mod counting;
mod rival;
mod start;
