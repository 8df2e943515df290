//! What the command asks of a system beside its runs.
//!
//! In: a system that `lagrangian!` declares. Out: a [`System`], with the runs of `vi_erased` and what studies and maps
//! need, and an [`Entry`](entry::Entry) with a place to start from. All code that is generic over systems is compiled
//! once per system, where a program names it: those of the command in `vi-ready`.
//!
//! | module | product |
//! |---|---|
//! | [`entry`] | a system with an initial state |
//! | [`system`] | a type-erased system |
//! | [`rival`] | the motion by DOP853 |
//! | [`raw`] | the paper's equations solved as they are written |
//! | [`exponents`] | Lyapunov exponents along a run |

pub mod entry;
pub mod exponents;
pub mod raw;
pub mod rival;
pub mod system;

pub use system::System;
