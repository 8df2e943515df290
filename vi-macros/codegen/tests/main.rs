//! The tests of the compiler, one program: what they share is compiled once.

mod arbitrary;
mod constants;
mod effort;
mod families;
mod forms;
mod inspect;
mod mass;
mod messages;
mod operations;
mod reference;
mod requests;
mod rules;
mod scope;
mod vanishing;
