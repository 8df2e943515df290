//! The tests of this crate as one program.

mod counting;
mod ready;
mod rival;
mod start;
