//! Type-erased runs of any system with any integrator.
//!
//! In: a system declared by `lagrangian!`. Out: a [`System`](system::System), and for a [`Plan`](plan::Plan) a
//! [`Simulation`](simulation::Simulation), whose rows a command writes or draws. All code that is generic over systems
//! is here and is compiled once per system; the command `vi-lab` names none of their types.
//!
//! | module | product |
//! |---|---|
//! | [`ready`] | the predefined systems, each with an initial state |
//! | [`plan`] | the description of a run |
//! | [`system`], [`simulation`] | any system, and one run of it |
//! | [`counting`] | a system that counts its evaluations |
//! | [`rival`] | the motion by DOP853 |
//! | [`start`] | an accurate second node |
//! | [`exponents`] | Lyapunov exponents along a run |

pub mod counting;
pub mod exponents;
pub mod kind;
pub mod plan;
pub mod ready;
pub mod rival;
pub mod simulation;
pub mod start;
pub mod system;
