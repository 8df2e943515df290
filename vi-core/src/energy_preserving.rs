//! The integrator that solves for its own step, so that the discrete energy is preserved.
//!
//! In: a system and the first interval. Out: an iterator of [`Step`](crate::state::Step)s. One step solves, in the unknowns `(v, h)` with
//! q1 = q0 + h v, t1 = t0 + h, h > 0,
//!
//! ```text
//! −D2 L_d − f_d⁻ = p0       p1 =  D4 L_d + f_d⁺
//!  D1 L_d + g_d⁻ = E0       E1 = −D3 L_d − g_d⁺
//! ```
//!
//! where p1 and E1 are carried as p0 and E0 plus their increments, every sum compensated. The pair `(v, −h)` of the last step
//! solves these equations always, and is no step.
//!
//! | file | part of a step |
//! |---|---|
//! | `stepper` | the integrator: the common step, and everything else |
//! | `starts` | the node and the interval that the first step follows |
//! | `run` | what a run carries from step to step, and how it takes a step that is not the common one |
//! | `predicted` | the root by one or a few Newton steps from v and h extrapolated over the last steps, measured |
//! | `guess` | else: v by extrapolation, h by the step law `h D^(1/3) = constant` |
//! | `equations` | the n + 1 equations for Newton's iteration |
//! | `bracket` | where that fails: the smallest h > 0 that solves them, or the proof that there is none |
//! | `fallback` | what is done then: an error, or fixed steps until a step exists again |
//! | `interval` | the interval that the next step follows |
//! | `integrator` | what it shares with the other integrators |
//! | `checkpoint` | what a run carries, to be stored and resumed bit for bit |
//!
//! AFTER A STEP both residuals were measured at the (v, h) that was taken, and are at the rounding floor. AFTER AN ERROR the
//! integrator holds the last good state and keeps returning that error.

mod bracket;
mod checkpoint;
mod equations;
pub(crate) mod fallback;
mod guess;
mod integrator;
pub(crate) mod interval;
mod predicted;
mod run;
mod starts;
mod stepper;

pub use checkpoint::Checkpoint;
pub use fallback::{Fallback, Switches};
pub use run::Run;
pub use stepper::EnergyPreserving;
