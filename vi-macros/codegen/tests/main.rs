//! The tests of the compiler as one program, so that shared code compiles once.

mod angles;
mod arbitrary;
mod constants;
mod constraints;
mod effort;
mod families;
mod forms;
mod functions;
mod growth;
mod hamiltonian;
mod inspect;
mod large;
mod mass;
mod messages;
mod nesting;
mod operations;
mod reference;
mod requests;
mod rules;
mod scope;
mod vanishing;
mod vectors;
