//! The tests of this crate, one program.

mod counting;
mod ready;
mod rival;
mod start;
