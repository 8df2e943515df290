//! The gradient of an objective of a run, by one backward pass.
//!
//! For an [`Objective`] `J = Σ_k g_k(z_k)` over the nodes of the next steps of a run, this module computes `∂J/∂z0` and
//! `∂J/∂θ` by
//!
//! ```text
//! λ_K = ∂g_K/∂z        λ_k = (∂z_{k+1}/∂z_k)ᵀ λ_{k+1} + ∂g_k/∂z        ∂J/∂θ_k = (∂z_{k+1}/∂θ)ᵀ λ_{k+1}
//! ```
//!
//! with z the time, coordinates and momenta, and the preserved energy E of an energy-preserving run. Parameters change
//! as by [`Run::set_parameters`]: E increases by `H(z, θ_k) − H(z, θ_{k−1})`, and at fixed v `δH = v·δp − δL`.
//!
//! The run is stored at every √K-th node and repeated between them. The memory is that of `2 √K` runs, and the extra
//! work is one run (Griewank and Walther, *Evaluating Derivatives*, chapter 12). If the caller allows storage for all
//! nodes, no step is repeated. Each step follows 2N directions, those of the energy and of the time if steps depend on
//! them, and one for each requested parameter. With constraints, each direction is the nearest admissible one, so that
//! a covector is that of admissible tangent vectors.

use super::steps::Differentiable;
use super::variation::{Covector, Variation, changes_of_energy};
use crate::constrained::variation;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::run::Run;
use crate::state::State;
use crate::stepping::Convertible;
use alloc::vec::Vec;
use nalgebra::SVector;

/// An objective: a sum of functions of the nodes of a run, with inputs on the way.
pub trait Objective<M: Method<S, N>, S, const N: usize> {
    /// Sets the inputs of the step from the node `step`, before the step. It must have the same effect at every call.
    ///
    /// # Errors
    /// As [`Run::set_parameters`].
    fn prepare(&self, _step: u64, _run: &mut Run<M, S, N>) -> Result<(), StepError> {
        Ok(())
    }
    /// Names of the parameters of the gradient, one column each.
    fn parameters(&self) -> &[&str] {
        &[]
    }
    /// `∂g/∂z` at the node `step`, 0 to K.
    fn slope(&self, step: u64, state: &State<N>) -> Covector<N>;
}

/// The gradient of an objective.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient<const N: usize> {
    /// Derivatives with respect to the start node.
    pub start: Covector<N>,
    /// With respect to the parameters of each step, one row per step, in the order of [`Objective::parameters`]. Their
    /// sum is the gradient with respect to constant parameters, if the preserved energy includes the derivative of H
    /// with respect to them at the start.
    pub parameters: Vec<Vec<f64>>,
}

/// The gradient of an objective over the next `steps` steps of a run.
///
/// Stores max(`kept`, √steps) checkpoints, plus the states between two of them during the backward pass. Steps between
/// checkpoints are taken twice; with `kept = steps` none is.
///
/// # Errors
/// The error of a failed step, of its derivative, or of an input; [`StepError::UnknownParameter`] for a name that no
/// parameter has; [`StepError::NonFinite`] if the gradient is out of range, or a derivative of the objective is NaN.
pub fn gradient<M, S, const N: usize>(
    run: &Run<M, S, N>,
    steps: u64,
    kept: usize,
    objective: &impl Objective<M, S, N>,
) -> Result<Gradient<N>, StepError>
where
    M: Differentiable<S, N>,
    S: Convertible<N>,
{
    let named = objective.parameters().iter().map(|name| Variation::of_parameter_of(run.system(), name));
    let of_parameters: Vec<_> = named.collect::<Result<_, _>>()?;
    let stride = stride(steps, kept);
    let mut stations = vec![run.clone()];
    let mut ahead = run.clone();
    for step in 0..steps {
        objective.prepare(step, &mut ahead)?;
        ahead.step()?;
        if (step + 1) % stride == 0 && step + 1 < steps {
            stations.push(ahead.clone());
        }
    }
    let mut slope = finite(objective.slope(steps, &ahead.state()), ahead.t())?;
    let mut directions = Variation::of_state();
    let keeps_energy = run.method().keeps_energy();
    if keeps_energy {
        directions.push(Variation { energy: 1.0, ..Variation::zero() });
    }
    let is_autonomous = !run.method().depends_on_time(run.system());
    if !is_autonomous {
        directions.push(Variation { t: 1.0, ..Variation::zero() });
    }
    let of_state = directions.len();
    directions.extend(of_parameters);
    let are_varied = directions.len() > of_state;
    let mut variations = directions.clone();
    let mut parameters = Vec::new();
    let mut inherited = vec![0.0; directions.len()];
    let mut last = steps;
    let mut end = ahead;
    let mut changes = Vec::with_capacity(directions.len());
    while let Some(station) = stations.pop() {
        let first = last.saturating_sub(1) / stride * stride;
        let inner = between(&station, first, last, objective)?;
        for step in (first..last).rev() {
            // The run before and after the step, with its inputs.
            let place = usize::try_from(step - first).unwrap_or(usize::MAX);
            let before = place.checked_sub(1).map_or(&station, |place| &inner[place]);
            let after = inner.get(place).unwrap_or(&end);
            variations.clone_from_slice(&directions);
            variation::project(after.system(), before.node(), &mut variations)?;
            after.vary(before.node(), &mut variations)?;
            changes.clear();
            changes.extend(variations.iter().map(|variation| slope.of(variation)));
            if keeps_energy && (are_varied || !have_equal_parameters(before.system(), after.system())) {
                let state = before.node().state();
                let gained = changes_of_energy(after.system(), &state, &directions)?;
                let lost = changes_of_energy(before.system(), &state, &directions)?;
                // The run still has the parameters of the previous step.
                let of_energy = changes[2 * N];
                for (index, change) in changes.iter_mut().enumerate() {
                    let is_of_state = index < of_state;
                    let own = of_energy * lost[index];
                    let lost = if is_of_state { own } else { core::mem::replace(&mut inherited[index], own) };
                    *change += of_energy * gained[index] - lost;
                }
            }
            let (mut back, of_parameters) = sorted(&changes, keeps_energy, !is_autonomous);
            if is_autonomous {
                // A later start does not change an autonomous trajectory.
                back.t = slope.t;
            }
            let own = objective.slope(step, &before.state());
            let t = before.t();
            let sum =
                Covector { t: back.t + own.t, q: back.q + own.q, p: back.p + own.p, energy: back.energy + own.energy };
            slope = finite(sum, t)?;
            if of_parameters.iter().any(|entry| !entry.is_finite()) {
                return Err(not_finite(t));
            }
            parameters.push(of_parameters);
        }
        last = first;
        end = station;
    }
    parameters.reverse();
    Ok(Gradient { start: slope, parameters })
}

/// Returns a finite covector. The derivative of the objective may overflow, also during the backward pass.
fn finite<const N: usize>(covector: Covector<N>, t: f64) -> Result<Covector<N>, StepError> {
    let numbers = [covector.t, covector.energy];
    let are_finite = numbers.iter().chain(&covector.q).chain(&covector.p).all(|entry| entry.is_finite());
    if are_finite { Ok(covector) } else { Err(not_finite(t)) }
}

/// The derivative of the objective is out of range.
fn not_finite(t: f64) -> StepError {
    StepError::NonFinite { t, quantity: "gradient", expression: None }
}

/// Number of steps between two checkpoints.
fn stride(steps: u64, kept: usize) -> u64 {
    let kept = u64::try_from(kept).unwrap_or(u64::MAX).max(steps.isqrt()).max(1);
    steps.div_ceil(kept).max(1)
}

/// The runs at the nodes from `first`, if given, to `last`.
fn between<M: Differentiable<S, N>, S: Convertible<N>, const N: usize>(
    start: &Run<M, S, N>,
    first: u64,
    last: u64,
    objective: &impl Objective<M, S, N>,
) -> Result<Vec<Run<M, S, N>>, StepError> {
    let inner = first..last.saturating_sub(1);
    if inner.is_empty() {
        return Ok(Vec::new());
    }
    let mut run = start.clone();
    let mut runs = Vec::with_capacity(usize::try_from(last - first).unwrap_or(0));
    for step in inner {
        objective.prepare(step, &mut run)?;
        run.step()?;
        runs.push(run.clone());
    }
    Ok(runs)
}

/// Whether two systems have the same parameters. A change between them then keeps the energy of a run.
fn have_equal_parameters<S: Lagrangian<N>, const N: usize>(one: &S, other: &S) -> bool {
    (0..one.parameters().len()).all(|index| one.parameter(index).to_bits() == other.parameter(index).to_bits())
}

/// Splits the derivatives in all directions: the covector at the start of a step, and the derivatives with respect to
/// the parameters of the step.
fn sorted<const N: usize>(changes: &[f64], keeps_energy: bool, depends_on_time: bool) -> (Covector<N>, Vec<f64>) {
    let mut changes = changes.iter().copied();
    let mut next = || changes.next().unwrap_or(0.0);
    let q = SVector::from_fn(|_, _| next());
    let p = SVector::from_fn(|_, _| next());
    let energy = if keeps_energy { next() } else { 0.0 };
    let t = if depends_on_time { next() } else { 0.0 };
    (Covector { t, q, p, energy }, changes.collect())
}
