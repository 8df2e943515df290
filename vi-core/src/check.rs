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
//! | [`derivatives()`] | momentum, energy, acceleration, the equations at a point and their derivatives are those of dual numbers | all |
//! | [`slots()`] | D1…D4 are the derivatives of L_d; `L_d/h → L`, `(f_d⁻ + f_d⁺)/h → f`, `(g_d⁻ + g_d⁺)/h → −f·v` | with a rule |
//! | [`steps()`] | the equations and gains of a step, and the p1, E1 of steps taken, are those of the slots; their derivatives are those of dual numbers | with a rule |
//! | [`energy_equations()`] | the energy row of a step is that of the slots, its Jacobian that of dual numbers, the step density too | with energy-preserving steps |
//! | [`order()`] | the error falls with h to the order of the rule | with a rule |
//! | [`momenta()`] | momenta of cyclic coordinates keep every bit | with a rule and a cyclic coordinate |
//! | [`symplecticity()`] | `dq1 ∧ dp1 = dq0 ∧ dp0` | with a rule, without force |
//! | [`reversibility()`] | the step −h undoes the step h | symmetric rules |
//! | [`energy()`] | `E` at each midpoint is the mean of the energies carried there; `E1 = −D3 L_d − g_d⁺` | midpoint rule |
//! | [`step_law()`] | `h D^(1/3)` is constant to O(h²) | midpoint rule, without force |
//! | [`gauss_order()`] | the error of Gauss steps falls with h⁴ | all |
//! | [`gauss_momenta()`] | momenta of cyclic coordinates keep every bit over Gauss steps | with a cyclic coordinate |
//! | [`gauss_symplecticity()`] | the derivatives at a point are those of a Lagrangian | without force |
//!
//! The clause `check { … }` of `lagrangian!` writes one test for each that applies: those of Gauss steps for a system without a rule. What no check can see: an L that is
//! not the one that was meant.

mod bounded;
mod comparison;
mod derivatives;
mod energy;
mod energy_equations;
mod gauss;
mod ladder;
mod length;
mod motion;
mod order;
mod report;
mod sample;
mod slots;
mod step_law;
mod steps;
mod subject;
mod symmetries;

pub use derivatives::derivatives;
pub use energy::energy;
pub use energy_equations::energy_equations;
pub use gauss::{gauss_momenta, gauss_order, gauss_symplecticity};
pub use motion::Motion;
pub use order::order;
pub use report::{CheckFailure, Report};
pub use slots::slots;
pub use step_law::step_law;
pub use steps::steps;
pub use subject::{Checked, EnergyChecked, MotionChecked, Place};
pub use symmetries::{momenta, reversibility, symplecticity};
