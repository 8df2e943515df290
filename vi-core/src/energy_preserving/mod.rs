//! The equations of an energy-preserving step of order 2, and their solvers.
//! [`EnergyPreserving`](crate::method::EnergyPreserving) is the method.
//!
//! | file | part of a step |
//! |---|---|
//! | `start` | the node and the interval before the first step |
//! | `lengths` | the memory of a run, and the choice of the solver |
//! | `predicted` | first: up to three Newton steps from extrapolated v and h |
//! | `guess` | second: v by extrapolation, h by the step law `h D^(1/3) = constant` |
//! | `equations` | the n + 1 equations for Newton iteration |
//! | `bracket` | third: the smallest h > 0 that solves the equations, or the reason why there is none |
//! | `interval` | the last interval |

mod bracket;
mod equations;
mod guess;
pub(crate) mod interval;
pub mod lengths;
pub mod predicted;
pub(crate) mod start;
