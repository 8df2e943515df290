//! Tests of a system at states of moderate size.
//!
//! Each check takes a system and a [`Place`], and returns a [`Report`] with the worst difference, or a [`CheckFailure`]
//! with the numbers that do not agree. A check that compared nothing, or only zeros, fails as vacuous.
//!
//! Each check derives its tolerance from the system and the place. It evaluates formulas in numbers that carry a
//! rounding-error bound, and allows differences up to the bounds. It compares them at steps of the system's own time
//! scale instead of h, because there no term lies below the rounding error of another. Quantities that decrease with a
//! power of h have rounding errors too: the check drops steps that do not exceed them, and tries larger ones if fewer
//! than three remain. If no step is large enough, the check fails with [`CheckFailure::StepTooSmall`], because it has
//! proved nothing, and suggests an h.
//!
//! | check | condition | systems |
//! |---|---|---|
//! | [`derivatives()`] | momentum, energy, the equations at a point and their derivatives equal those of dual numbers; without constraints the acceleration too | all |
//! | [`slots()`] | D1…D4 are the derivatives of L_d; `L_d/h → L`, `(f_d⁻ + f_d⁺)/h → f`, `(g_d⁻ + g_d⁺)/h → −f·v` | with a rule |
//! | [`steps()`] | the equations and increments of a step, and p1, E1 of actual steps, follow from the slots; their derivatives equal those of dual numbers | with a rule |
//! | [`energy_equations()`] | the energy row of a step follows from the slots; its Jacobian and the step density equal those of dual numbers | with energy-preserving steps |
//! | [`order()`] | the error decreases with h to the order of the rule | with a rule |
//! | [`momenta()`] | momenta of cyclic coordinates are constant bit for bit | with a rule and a cyclic coordinate |
//! | [`symplecticity()`] | `dq1 ∧ dp1 = dq0 ∧ dp0` | with a rule, without force |
//! | [`reversibility()`] | the step −h reverses the step h | symmetric rules |
//! | [`energy()`] | `E` at each midpoint is the mean of the carried energies; `E1 = −D3 L_d − g_d⁺` | midpoint rule |
//! | [`step_law()`] | `h D^(1/3)` is constant to O(h²) | midpoint rule, without force |
//! | [`gauss_order()`] | the error of Gauss steps decreases with h⁴ | all |
//! | [`gauss_momenta()`] | momenta of cyclic coordinates are constant bit for bit over Gauss steps | with a cyclic coordinate |
//! | [`gauss_symplecticity()`] | the derivatives at a point are those of a Lagrangian, and gradients of constraints those of functions | without force, constraints on positions only |
//! | [`constraints()`] | gradients, rates and reactions equal those of dual numbers; the constraints hold at the nodes of `Gauss` | with constraints |
//! | [`reaction()`] | acceleration and multipliers satisfy the equations of motion and keep the rates of the constraints | with constraints |
//!
//! The clause `check { … }` of `lagrangian!` writes one test for each applicable check; for a system without a rule,
//! the checks of Gauss steps, and those of its constraints. No check can detect that L is not the intended Lagrangian.

mod bounded;
mod comparison;
mod constraints;
mod derivatives;
mod energy;
mod energy_equations;
mod gauss;
mod ladder;
mod length;
mod order;
mod report;
mod sample;
mod slots;
mod step_law;
mod steps;
mod subject;
mod symmetries;
mod trajectory;

pub use constraints::{constraints, reaction};
pub use derivatives::derivatives;
pub use energy::energy;
pub use energy_equations::energy_equations;
pub use gauss::{gauss_momenta, gauss_order, gauss_symplecticity};
pub use order::order;
pub use report::{CheckFailure, Report};
pub use slots::slots;
pub use step_law::step_law;
pub use steps::steps;
pub use subject::{Checked, EnergyChecked, MotionChecked, Place};
pub use symmetries::{momenta, reversibility, symplecticity};
pub use trajectory::Trajectory;
