//! Type-erased runs of any system with any integrator.
//!
//! In: a system that `lagrangian!` declares. Out: a [`System`](system::System), and for a [`Plan`](plan::Plan) a
//! [`Simulation`](simulation::Simulation), whose rows a command writes or draws. All code that is generic over systems
//! is here and is compiled once per system, where a program names it: those of the command in `vi-ready`.
//!
//! | module | product |
//! |---|---|
//! | [`entry`] | a system with an initial state |
//! | [`plan`] | the description of a run |
//! | [`system`], [`simulation`] | any system, and one run of it |
//! | [`counting`] | a system that counts its evaluations |
//! | [`rival`] | the motion by DOP853 |
//! | [`start`] | an accurate second node |
//! | [`raw`] | the paper's equations solved as they are written |
//! | [`exponents`] | Lyapunov exponents along a run |

pub mod counting;
pub mod entry;
pub mod exponents;
pub mod kind;
pub mod plan;
pub mod raw;
pub mod rival;
pub mod simulation;
pub mod start;
pub mod system;
