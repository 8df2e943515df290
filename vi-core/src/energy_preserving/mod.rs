//! The equations of an energy-preserving step of order 2, and their solution. [`EnergyPreserving`](crate::method::EnergyPreserving) is the method.
//!
//! | file | part of a step |
//! |---|---|
//! | `start` | the node and the interval that the first step follows |
//! | `course` | what is remembered of the steps before, and how a step is found that is not the common one |
//! | `predicted` | the root by one or a few Newton steps from v and h extrapolated over the last steps, measured |
//! | `guess` | else: v by extrapolation, h by the step law `h D^(1/3) = constant` |
//! | `equations` | the n + 1 equations for Newton's iteration |
//! | `bracket` | if that fails: the smallest h > 0 that solves them, or the proof that there is none |
//! | `interval` | the interval that the next step follows |

mod bracket;
pub mod course;
mod equations;
mod guess;
pub(crate) mod interval;
pub mod predicted;
pub(crate) mod start;
