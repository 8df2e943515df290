//! Systems of a text against compiled ones.

mod allocations;
mod bits;
mod bound;
mod expressions;
mod first_order;
mod hamiltonian;
mod padded;
mod tables;
mod texts;
