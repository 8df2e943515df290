//! Systems of a text against compiled ones.

mod allocations;
mod bits;
mod padded;
mod texts;
