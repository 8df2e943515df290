//! Checks of a system: what has to hold for every right one, evaluated where the system is well behaved.
//!
//! In: a system and a [`Place`]. Out: a [`Report`] with the worst number met, or a [`CheckFailure`] with the numbers that
//! do not agree. A check that compared nothing, or only zeros, fails as vacuous.
//!
//! Each check knows its own rounding, from the system and the place. Formulas are evaluated in numbers that carry the bound
//! of theirs along, and may differ by that. They are compared at steps of the system's own time scale, not at h: there no
//! term lies below the rounding of another. What falls with a power of h is measured with its rounding; steps at which it
//! does not stand above are dropped, and larger ones tried where fewer than three are left. Where none show it, the check
//! fails with [`CheckFailure::StepTooSmall`], since it has proved nothing, and says which h to try.
//!
//! | check | what has to hold | of which systems |
//! |---|---|---|
//! | [`derivatives()`] | momentum, energy, acceleration, step density, Jacobians are those of dual numbers | all |
//! | [`slots()`] | D1…D4 are the derivatives of L_d; `L_d/h → L`, `(f_d⁻ + f_d⁺)/h → f`, `(g_d⁻ + g_d⁺)/h → −f·v` | all |
//! | [`steps()`] | the equations and gains of a step, and the p1, E1 of steps taken, are those of the slots | all |
//! | [`order()`] | the error falls with h to the order of the rule | all |
//! | [`momenta()`] | momenta of cyclic coordinates keep every bit | with a cyclic coordinate |
//! | [`symplecticity()`] | `dq1 ∧ dp1 = dq0 ∧ dp0` | without force |
//! | [`reversibility()`] | the step −h undoes the step h | symmetric rules |
//! | [`energy()`] | `E` at each midpoint is the mean of the energies carried there; `E1 = −D3 L_d − g_d⁺` | midpoint rule |
//! | [`step_law()`] | `h D^(1/3)` is constant to O(h²) | midpoint rule, without force |
//!
//! The clause `check { … }` of `lagrangian!` writes one test for each that applies. What no check can see: an L that is
//! not the one that was meant.

mod bounded;
mod comparison;
mod derivatives;
pub mod dual;
mod energy;
mod ladder;
mod length;
mod motion;
mod order;
mod report;
mod sample;
mod slots;
mod step_law;
mod steps;
mod symmetries;

pub use derivatives::derivatives;
pub use dual::Dual;
pub use energy::energy;
pub use motion::Motion;
pub use order::order;
pub use report::{CheckFailure, Report};
pub use slots::slots;
pub use step_law::step_law;
pub use steps::steps;
pub use symmetries::{momenta, reversibility, symplecticity};

use crate::{DiscreteLagrangian, Parameters, Real, Stepping};
use nalgebra::SVector;

/// Steps of the place's length over which the motion from there is followed.
const STEPS: u32 = 32;

/// Where a system is checked: a state from which it is well behaved over 32 steps of length `h`, with every quantity of
/// moderate size and the step density of one sign. Units are the system's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place<const N: usize> {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: SVector<f64, N>,
    /// Velocities.
    pub v: SVector<f64, N>,
    /// Step, positive, in units of time: small enough for the error to fall with h². Where rounding hides what a check is
    /// about, the check tries larger ones.
    pub h: f64,
}

/// A system that can be evaluated in other kinds of numbers, as every generated one can.
pub trait Checked<const N: usize>: Stepping<N> + DiscreteLagrangian<N> + Parameters + Clone {
    /// The same system in the numbers T.
    type In<T: Real>: Stepping<N, T> + DiscreteLagrangian<N, T>;

    /// The same system, every parameter converted.
    fn convert<T: Real>(&self) -> Self::In<T>;
}
