//! The step density of order 2s with constraints.
//!
//! `H − E0(h) = C_s h^2s D_s + O(h^(2s+1))`, as without constraints ([`crate::gauss::density`]). With the Taylor
//! polynomials π of degree s of the constrained motion, and its multipliers Λ,
//!
//! ```text
//! D_s = (d/dτ)^2s H(t + τ, π_q, π_p) + (s + 1)/s (d/dτ)^2s [Λ·g(t + τ, π_q)]      holonomic
//!                                    + 2 (d/dτ)^(2s−1) [Λ·(A π_q' + a)(t + τ, π_q)]      nonholonomic
//!
//! (d/dτ)^2s H = ½ C(2s, s) q^(s+1)·M q^(s+1) − (d/dτ)^2s L(t + τ, π_q, π_q')
//! ```
//!
//! at τ = 0. The second line needs no inverse of M, which may be singular across the constraints. π leaves the
//! constraint, so D_s depends on L beside it.

use super::{accelerations, bordered};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::linear::{Matrix, Rectangular};
use crate::motion::Motion;
use crate::real::Series;
use crate::state::State;
use crate::stepping::Convertible;

/// The step density `D_s` of s = STAGES stages of a system with constraints at a state, in units of energy over time to
/// the power 2s. For small h an energy-preserving step exists while it keeps its sign.
///
/// # Errors
/// As [`State::velocity`]; [`StepError::NonFinite`] if D_s has no value.
pub fn step_density<S, const N: usize, const STAGES: usize>(system: &S, state: &State<N>) -> Result<f64, StepError>
where
    S: Convertible<N>,
{
    const { assert!(STAGES >= 1 && STAGES <= 3, "an energy-preserving step has 1 to 3 stages") };
    density(system, state, STAGES)
}

/// The step density of this many stages. A runtime argument, so that one copy serves all.
fn density<S, const N: usize>(system: &S, state: &State<N>, stages: usize) -> Result<f64, StepError>
where
    S: Convertible<N>,
{
    let series = system.convert::<Series>();
    let t = Series::variable(state.t);
    let q_start = state.q.map(Series::fixed);
    let v_start = state.velocity(system)?.map(Series::fixed);
    let bordered = &mut bordered(&series);
    let (mut q, mut v) = (q_start, v_start);
    let (mut a, mut multipliers) = accelerations(&series, (t, &q, &v), bordered)?;
    // Each integration adds one correct term; v is then known to the term s, Λ to the term s − 1.
    for _ in 0..stages {
        q = q_start + v.map(|v| v.integral());
        v = v_start + a.map(|a| a.integral());
        (a, multipliers) = accelerations(&series, (t, &q, &v), bordered)?;
    }
    let highest = v.map(|v| v.derivative(stages));
    let q = (q_start + v.map(|v| v.integral())).map(|q| q.truncated(stages));
    let v = q.map(|q| q.slope());
    let mass = system.point(state.t, &state.q, &state.velocity(system)?).mass.dense();
    let chosen = (1..=stages).fold(1.0, |product, k| product * real(stages + k) / real(k));
    let energy = 0.5 * chosen * highest.dot(&(mass * highest)) - series.lagrangian(t, &q, &v).derivative(2 * stages);

    let values = series.constraints(t, &q);
    let (gradients, rates) = series.constraint_gradients(t, &q);
    let of_constraints = (0..system.constraint_names().len()).fold(0.0, |sum, r| {
        let multiplier = multipliers.as_ref()[r];
        sum + if r < system.holonomic() {
            real(stages + 1) / real(stages) * (multiplier * values.as_ref()[r]).derivative(2 * stages)
        } else {
            let rate = gradients.row(r).dot(&v) + rates.as_ref()[r];
            2.0 * (multiplier * rate).derivative(2 * stages - 1)
        }
    });
    let density = energy + of_constraints;
    if density.is_finite() {
        Ok(density)
    } else {
        Err(StepError::NonFinite { t: state.t, quantity: "step density", expression: None })
    }
}

/// A small integer as a number.
#[allow(clippy::cast_precision_loss)]
fn real(integer: usize) -> f64 {
    integer as f64
}
