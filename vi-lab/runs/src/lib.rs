//! Runs of any system by any integrator, their types erased.
//!
//! In: a system that `lagrangian!` declares. Out: a [`System`](system::System), and of a [`Plan`](plan::Plan) a
//! [`Simulation`](simulation::Simulation), whose rows a command writes or charts. All that is generic over systems stands here; it is
//! compiled where a system is named, once for each of them: those of the command in `vi-ready`.
//!
//! | module | what it makes |
//! |---|---|
//! | [`entry`] | a system with a place to start from |
//! | [`plan`] | what is to be run |
//! | [`system`], [`simulation`] | any system, and one run of it |
//! | [`counting`] | a system that counts its evaluations |
//! | [`rival`] | its motion by DOP853 |
//! | [`start`] | an accurate start |
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
