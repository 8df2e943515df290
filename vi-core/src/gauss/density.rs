//! The step density of order 2s.
//!
//! At a state of a system, the density determines the length of an energy-preserving step of s stages:
//!
//! ```text
//! H − E0(h) = C_s h^2s D_s + O(h^(2s+1))        C_s = (s!)⁴/((2s)!)³ = 1/8, 1/864, 1/288000
//! D_s = (d/dτ)^2s H(t + τ, π_q(τ), π_p(τ)) at τ = 0        π = Taylor polynomial of degree s of the forced motion
//! ```
//!
//! with H the energy as a function of (t, q, p). Power series in τ give the motion, and H along π, from the functions
//! of a point that the steps also use. D_s is therefore independent of the step solver. For s = 1 it is `step_density`
//! of the generated rule. `docs/theory.md` derives it.

use crate::error::StepError;
use crate::linear::Matrix;
use crate::motion::Motion;
use crate::real::Series;
use crate::state::State;
use crate::stepping::Convertible;
use nalgebra::SVector;

/// `C_s` of s stages; see the [module](self).
const fn constant(stages: usize) -> f64 {
    match stages {
        1 => 1.0 / 8.0,
        2 => 1.0 / 864.0,
        3 => 1.0 / 288_000.0,
        _ => {
            panic!("an energy-preserving Gauss step has 1 to 3 stages: the length of one with more is lost in rounding")
        }
    }
}

/// `C_s h^2s` of s = S stages.
pub(crate) fn power<const S: usize>(h: f64) -> f64 {
    (1..S).fold(h * h, |power, _| power * (h * h)) * const { constant(S) }
}

/// The step density `D_s` of s = STAGES stages at a state, in units of energy over time to the power 2s. For small h an
/// energy-preserving step exists while it keeps its sign. The power series are for analysis, too slow for the loop of a
/// step.
///
/// # Errors
/// [`StepError::Singular`] or [`StepError::NotConverged`] if no velocity has the momenta, [`StepError::NonFinite`] if
/// D_s has no value.
pub fn step_density<S, const N: usize, const STAGES: usize>(system: &S, state: &State<N>) -> Result<f64, StepError>
where
    S: Convertible<N>,
{
    const { constant(STAGES) };
    density(system, state, STAGES)
}

/// The step density of this many stages. A runtime argument, so that one copy serves all.
fn density<S, const N: usize>(system: &S, state: &State<N>, stages: usize) -> Result<f64, StepError>
where
    S: Convertible<N>,
{
    let series = system.convert::<Series>();
    let t = Series::variable(state.t);
    let start = state.q.map(Series::fixed);
    let momentum = state.p.map(Series::fixed);
    let mut q = start;
    let mut p = momentum;
    let mut v = state.velocity(system)?.map(Series::fixed);
    // Each integration adds one correct term.
    for _ in 0..stages {
        v = velocity(&series, t, [&q, &p], v);
        let force = series.point(t, &q, &v).force;
        q = start + v.map(|v| v.integral());
        p = momentum + force.map(|force| force.integral());
    }
    let q = q.map(|q| q.truncated(stages));
    let p = p.map(|p| p.truncated(stages));
    // The velocities are those of π up to the term s − 1; each iteration doubles the number of correct terms.
    v = velocity(&series, t, [&q, &p], v);
    v = velocity(&series, t, [&q, &p], v);
    let energy = crate::Lagrangian::energy(&series, t, &q, &v);
    let density = energy.derivative(2 * stages);
    if density.is_finite() {
        Ok(density)
    } else {
        Err(StepError::NonFinite { t: state.t, quantity: "step density", expression: None })
    }
}

/// The velocity after one Newton iteration on `L_v(t, q, v) = p`.
fn velocity<S, const N: usize>(
    system: &S,
    t: Series,
    [q, p]: [&SVector<Series, N>; 2],
    v: SVector<Series, N>,
) -> SVector<Series, N>
where
    S: Motion<N, Series>,
{
    let point = system.point(t, q, &v);
    v + point.mass.solve_unchecked(&(p - point.momentum))
}
