//! Tangent vectors of one step, for each method; `gauss/variation.rs` has those of Gauss steps.
//!
//! In: the start node of the last step, with tangent vectors. Out: the tangent vectors at the end node. The unknowns of
//! the step are stored. The system provides the derivatives with respect to them and to the coordinates of
//! the node; dual numbers provide those with respect to the time and the parameters, if a direction needs them.

use super::curvature;
use super::variation::{Covector, TOGETHER, Variation, Varied, more_parameters, singular, slope_along, unsolved};
use crate::angles;
use crate::energy_preserving::interval::Last;
use crate::error::StepError;
use crate::linear::{self, Matrix};
use crate::method::{Change, Composition, Connected, EnergyPreserving, Fallback, FixedStep, Method};
use crate::momentum::steps::Steps;
use crate::node::Node;
use crate::real::Dual;
use crate::run::Run;
use crate::stepping::{
    Convertible, Discretized, EnergyStepping, ExtendedDerivatives, FixedStepping, MomentumDerivatives,
};
use alloc::vec::Vec;
use nalgebra::{DMatrix, SVector};

/// A method whose steps have derivatives.
pub trait Differentiable<S: Convertible<N>, const N: usize>: Method<S, N> {
    /// Whether the preserved energy is a variable beside coordinates and momenta.
    fn keeps_energy(&self) -> bool {
        false
    }
    /// Whether a step depends on its start time.
    fn depends_on_time(&self, system: &S) -> bool {
        !system.is_autonomous()
    }

    /// [`Run::vary`].
    ///
    /// # Errors
    /// As [`Run::vary`].
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError>;

    /// Maps tangent vectors at the node of a run to those after [`Run::step_of`] by `length`. Here `h` of a vector is
    /// the change of this length, in time.
    ///
    /// # Errors
    /// As [`Run::step_of`] and [`Run::vary`].
    fn vary_step_of(run: &Run<Self, S, N>, length: f64, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let Run { method, system, node, memory, .. } = run;
        let mut start = *node;
        let memory = method.restarted(system, &Change::NewLength, &mut start, length, memory)?;
        let mut aside = Run::resumed(method.clone(), *system, (start, length, memory));
        aside.step()?;
        aside.vary(node, variations)
    }

    /// [`Run::curvature`]; `None` by default.
    ///
    /// # Errors
    /// As [`Run::curvature`].
    fn curvature(
        _run: &Run<Self, S, N>,
        _before: &Node<N>,
        _directions: &[Variation<N>],
        _weights: &Covector<N>,
    ) -> Result<Option<DMatrix<f64>>, StepError> {
        Ok(None)
    }

    /// Sets `energy` of tangent vectors at the start of a run by [`Start::integrate`](crate::Start::integrate): the
    /// preserved energy follows from the state, the parameters and the length of the first step.
    ///
    /// # Errors
    /// As [`Run::vary`].
    fn vary_start(_run: &Run<Self, S, N>, _variations: &mut [Variation<N>]) -> Result<(), StepError> {
        Ok(())
    }
}

/// The unknown of an energy-preserving step beside v.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sought {
    /// The length, for given energy.
    Length,
    /// There is none: the length is given, and the energy equation does not apply.
    Neither,
    /// The energy, for a given length of the first step. The node stays.
    Energy,
}

/// Checks that a run takes energy-preserving steps only.
///
/// # Errors
/// [`StepError::NoDerivative`] for the step from the time `t`.
pub(crate) fn check_fallback(fallback: Fallback, t: f64) -> Result<(), StepError> {
    let because = "with a fallback the energy of the run may jump; take steps without one";
    if fallback == Fallback::Stop { Ok(()) } else { Err(StepError::NoDerivative { t, because }) }
}

impl<M: Differentiable<S, N>, S: Convertible<N>, const N: usize> Run<M, S, N> {
    /// Maps tangent vectors at `before`, the start node of the last step, to those at its end node.
    ///
    /// The step is the one that [`Run::step`] took last. With constraints, the vectors have to be admissible:
    /// [`Tangent`](super::Tangent) checks them, and moves others.
    ///
    /// # Errors
    /// [`StepError::Singular`] if the step equations do not determine the derivative of their solution;
    /// [`StepError::NonFinite`] if the derivative is infinite or out of range; [`StepError::NoDerivative`] if `before`
    /// is not the start node of the last step, the parameters have changed since, or a tangent vector has more
    /// parameters than the system.
    pub fn vary(&self, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        // The step began at reduced angles.
        M::vary(self, &angles::reduced_node(self.system(), before), variations)
    }

    /// The second derivatives of `weights·z` with respect to pairs of tangent vectors at `before`: a symmetric matrix,
    /// exact to rounding. z is the end node of the last step, which began at `before`. [`FixedStep`],
    /// [`Composition`] and [`Gauss`](crate::Gauss) have them, for systems without constraints whose L
    /// is not linear in the velocities; otherwise `None`.
    ///
    /// # Errors
    /// As [`Run::vary`].
    pub fn curvature(
        &self,
        before: &Node<N>,
        directions: &[Variation<N>],
        weights: &Covector<N>,
    ) -> Result<Option<DMatrix<f64>>, StepError> {
        if directions.iter().any(|direction| direction.parameters.len() > self.system().parameters().len()) {
            return Err(more_parameters(before.t));
        }
        // The step began at reduced angles.
        M::curvature(self, &angles::reduced_node(self.system(), before), directions, weights)
    }
}

/// Whether a step that ends at the time and the coordinates of `end` is the one that led to the node `reached`.
fn is_last<const N: usize>(end: &Node<N>, reached: &Node<N>) -> bool {
    // The time of the last node may have been set to the requested one.
    let late = (end.t - reached.t) + (end.t_low - reached.t_low);
    let is_in_time = late.abs() <= 2.0 * f64::EPSILON * reached.t.abs();
    is_in_time && end.q == reached.q && end.q_low == reached.q_low
}

/// Checks that the step `(v, h)` from `before` led to the node `reached`, and that its parameters are those of the
/// system.
///
/// # Errors
/// [`StepError::NoDerivative`] otherwise.
fn check_last<const N: usize>(
    before: &Node<N>,
    (h, v): (f64, &SVector<f64, N>),
    reached: &Node<N>,
    has_its_parameters: bool,
) -> Result<(), StepError> {
    let mut end = *before;
    end.shift(h, v);
    if has_its_parameters && is_last(&end, reached) { Ok(()) } else { Err(not_last(before.t)) }
}

/// The given node is not the start of the last step, or that step had other parameters.
pub(crate) fn not_last(t: f64) -> StepError {
    let because = "it is not the last step of the run with its current parameters; pass the start node of the last step, before any change of parameters";
    StepError::NoDerivative { t, because }
}

/// Solves `A x = rhs` by the inverse of A, or by A itself if the inverse lost a pivot.
fn solved<A: Matrix<N, f64>, const N: usize>(
    matrix: &A,
    inverse: &A::Inverse,
    rhs: &SVector<f64, N>,
) -> Option<SVector<f64, N>> {
    let x = A::apply(inverse, rhs);
    if x.iter().all(|entry| entry.is_finite()) { Some(x) } else { linear::solve(matrix, rhs) }
}

/// Maps tangent vectors at a node to those after the momentum step `(v, h)`. Its length is `part` times that of a whole
/// step.
fn vary<S, const N: usize>(
    system: &S,
    node: &Node<N>,
    [h, part]: [f64; 2],
    v: &SVector<f64, N>,
    variations: &mut [Variation<N>],
) -> Result<(), StepError>
where
    S: Discretized<N>,
{
    // Borrowed: the matrices of systems with many coordinates are large.
    let derivatives = system.momentum_derivatives(node, h, v);
    let MomentumDerivatives { residual_dq, residual_dv, increment_dq, increment_dv } = &derivatives;
    let inverse = residual_dv.inverse();
    for variations in variations.chunks_mut(TOGETHER) {
        let explicit = Variation::varying_steps(variations, system, node.t)?.map(|varied| {
            let node = Variation::in_time(variations, node);
            let h = Variation::number(variations, h, |variation| part * variation.h);
            varied.momentum_residual(&node, h, &v.map(Dual::fixed))
        });
        for (direction, variation) in variations.iter_mut().enumerate() {
            let mut residual = residual_dq.multiply(&variation.q) - variation.p;
            let mut increment = increment_dq.multiply(&variation.q);
            if let Some(explicit) = &explicit {
                residual += slope_along(direction, &explicit.residual);
                increment += slope_along(direction, &explicit.increment);
            }
            let of_v =
                -solved(residual_dv, &inverse, &residual).ok_or_else(|| unsolved(residual_dv, &residual, node.t))?;
            let of_h = part * variation.h;
            variation.t += of_h;
            variation.q += of_v * h + v * of_h;
            variation.p += increment + increment_dv.multiply(&of_v);
        }
    }
    Variation::check_finite(variations, node.t)
}

impl<S, const N: usize> Differentiable<S, N> for FixedStep
where
    S: Discretized<N>,
{
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        vary_fixed(run, run.memory.steps.v(), run.memory.steps.has_parameters_of_last(), before, variations)
    }

    fn curvature(
        run: &Run<Self, S, N>,
        before: &Node<N>,
        directions: &[Variation<N>],
        weights: &Covector<N>,
    ) -> Result<Option<DMatrix<f64>>, StepError> {
        let Run { system, node, memory, h, .. } = run;
        let v = memory.steps.v();
        check_last(before, (*h, &v), node, memory.steps.has_parameters_of_last())?;
        let (_, matrix) = curvature::of_momentum_step(system, before, [*h, 1.0], &v, directions, weights)?;
        Ok(Some(matrix))
    }
}

impl<S, const N: usize> Differentiable<S, N> for Connected
where
    S: Discretized<N>,
{
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        vary_fixed(run, run.memory.steps.v(), run.memory.steps.has_parameters_of_last(), before, variations)
    }
}

/// Tangent vectors of the step that led a run to its node with the velocity v.
fn vary_fixed<M: Method<S, N>, S: Discretized<N>, const N: usize>(
    run: &Run<M, S, N>,
    v: SVector<f64, N>,
    has_its_parameters: bool,
    before: &Node<N>,
    variations: &mut [Variation<N>],
) -> Result<(), StepError> {
    check_last(before, (run.h, &v), &run.node, has_its_parameters)?;
    vary(&run.system, before, [run.h, 1.0], &v, variations)
}

impl<S, const N: usize> Differentiable<S, N> for Composition
where
    S: Discretized<N>,
{
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let Run { system, memory, .. } = run;
        if !memory.all.iter().all(Steps::has_parameters_of_last) {
            return Err(not_last(before.t));
        }
        let mut node = *before;
        for substep in &memory.all {
            let (h, v) = (substep.h, substep.v());
            vary(system, &node, [h, h / run.h], &v, variations)?;
            let increment = system.momentum_residual(&node, h, &v).increment;
            node.advance(h, &v, &increment);
        }
        if is_last(&node, &run.node) { Ok(()) } else { Err(not_last(before.t)) }
    }

    /// Goes backwards over the substeps, with the weights at the end of each.
    fn curvature(
        run: &Run<Self, S, N>,
        before: &Node<N>,
        directions: &[Variation<N>],
        weights: &Covector<N>,
    ) -> Result<Option<DMatrix<f64>>, StepError> {
        let Run { system, memory, .. } = run;
        let mut starts = Vec::with_capacity(memory.all.len());
        let (mut node, mut variations) = (*before, directions.to_vec());
        for substep in &memory.all {
            let (lengths, v) = ([substep.h, substep.h / run.h], substep.v());
            starts.push((node, lengths, v, variations.clone()));
            vary(system, &node, lengths, &v, &mut variations)?;
            let increment = system.momentum_residual(&node, substep.h, &v).increment;
            node.advance(substep.h, &v, &increment);
        }
        if !(memory.all.iter().all(Steps::has_parameters_of_last) && is_last(&node, &run.node)) {
            return Err(not_last(before.t));
        }
        let (mut weights, mut sum) = (*weights, DMatrix::zeros(directions.len(), directions.len()));
        for (node, lengths, v, variations) in starts.iter().rev() {
            let (at_start, matrix) = curvature::of_momentum_step(system, node, *lengths, v, variations, &weights)?;
            weights = at_start;
            sum += matrix;
        }
        Ok(Some(sum))
    }
}

impl<S, const N: usize> Differentiable<S, N> for EnergyPreserving
where
    S: EnergyStepping<N> + Discretized<N>,
    S::Steps<Varied>: EnergyStepping<N, Varied>,
{
    fn keeps_energy(&self) -> bool {
        true
    }

    /// The preserved energy is a variable beside q and p, and the step length varies. With [`Fallback::FixedSteps`] the
    /// energy may jump, so that the run has no derivative: [`StepError::NoDerivative`].
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        check_fallback(run.memory.control.fallback, before.t)?;
        let Last { h, v, is_step, .. } = run.memory.last;
        check_last(before, (h, &v), &run.node, is_step)?;
        vary_extended(&run.system, before, (h, &v), Sought::Length, variations)
    }

    fn vary_step_of(run: &Run<Self, S, N>, length: f64, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let (_, after) = run.method.step_of(&run.system, (&run.node, &run.memory), [length, run.h])?;
        vary_extended(&run.system, &run.node, (length, &after.last.v), Sought::Neither, variations)
    }

    fn vary_start(run: &Run<Self, S, N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let Last { h, v, .. } = run.memory.last;
        vary_extended(&run.system, &run.node, (h, &v), Sought::Energy, variations)
    }
}

/// Maps tangent vectors at a node to those after the energy-preserving step `(v, h)`.
fn vary_extended<S, const N: usize>(
    system: &S,
    before: &Node<N>,
    (h, v): (f64, &SVector<f64, N>),
    sought: Sought,
    variations: &mut [Variation<N>],
) -> Result<(), StepError>
where
    S: EnergyStepping<N> + Discretized<N>,
    S::Steps<Varied>: EnergyStepping<N, Varied>,
{
    let derivatives = system.extended_derivatives(before, h, v);
    let ExtendedDerivatives { momentum, residual_dh, increment_dh, energy_dq, energy_dv, energy_dh, .. } = &derivatives;
    let MomentumDerivatives { residual_dq, residual_dv, increment_dq, increment_dv } = momentum;
    let inverse = residual_dv.inverse();
    let along_h =
        solved(residual_dv, &inverse, residual_dh).ok_or_else(|| unsolved(residual_dv, residual_dh, before.t))?;
    let schur = energy_dh - energy_dv.dot(&along_h);
    for variations in variations.chunks_mut(TOGETHER) {
        let explicit = Variation::varying_steps(variations, system, before.t)?.map(|varied| {
            let node = Variation::in_time(variations, before);
            varied.extended_residual(&node, Dual::fixed(h), &v.map(Dual::fixed))
        });
        for (direction, variation) in variations.iter_mut().enumerate() {
            let mut residual = residual_dq.multiply(&variation.q) - variation.p;
            let mut energy = energy_dq.dot(&variation.q) + v.dot(&variation.p);
            let mut momentum_gain = increment_dq.multiply(&variation.q);
            let mut energy_gain = derivatives.energy_increment_dq.dot(&variation.q);
            if let Some(explicit) = &explicit {
                residual += slope_along(direction, &explicit.residual);
                energy += explicit.energy_residual.slope.0[direction];
                momentum_gain += slope_along(direction, &explicit.increment.momentum);
                energy_gain += explicit.increment.energy.slope.0[direction];
            }
            let of_residual =
                solved(residual_dv, &inverse, &residual).ok_or_else(|| unsolved(residual_dv, &residual, before.t))?;
            let of_h = match sought {
                Sought::Length => (energy_dv.dot(&of_residual) - (energy - variation.energy) / h) / schur,
                Sought::Neither => variation.h,
                Sought::Energy => {
                    variation.energy = energy + (schur * variation.h - energy_dv.dot(&of_residual)) * h;
                    continue;
                }
            };
            if !of_h.is_finite() {
                return Err(singular(before.t));
            }
            let of_v = -of_residual - along_h * of_h;
            variation.t += of_h;
            variation.q += of_v * h + v * of_h;
            variation.p += momentum_gain + increment_dv.multiply(&of_v) + increment_dh * of_h;
            if !system.conserves_energy() {
                variation.energy +=
                    energy_gain + derivatives.energy_increment_dv.dot(&of_v) + derivatives.energy_increment_dh * of_h;
            }
        }
    }
    Variation::check_finite(variations, before.t)
}
