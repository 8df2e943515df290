//! The solution of a step from the memory of the last steps.
//!
//! In: a node and its [`Lengths`]. Out: the node and the memory after the next step: by extrapolation, otherwise by a
//! search, otherwise at a given length if the user allows it (`Fallback`). No state changes.

use super::bracket;
use super::equations::{self, Elimination, EnergyStep, NoStep, RowResiduals};
use super::guess;
use super::interval::Last;
use super::predicted::{Predicted, Prediction};
use crate::error::StepError;
use crate::method::Memory;
use crate::method::bounds::{Alternating, Control, Controlled, FixedPhase, RATIO, check_forward};
use crate::momentum::continuation::{self, BranchPoint};
use crate::momentum::newton;
use crate::node::Node;
use crate::real::Scalar;
use crate::state::StepKind;
use crate::stepping::{EnergyStepping, Increment};
use crate::vector::VelocityStep;
use nalgebra::SVector;

/// Memory of energy-preserving steps, and the options of their run.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: crate::real::Real + serde::Serialize",
        deserialize = "T: crate::real::Real + serde::Deserialize<'de>"
    ))
)]
pub struct Lengths<const N: usize, T = f64> {
    pub(crate) last: Last<N, T>,
    pub(crate) prediction: Prediction<N, T>,
    /// Options and counters. Only the cold path writes them: after a step of another kind no guess has the highest
    /// order.
    pub(crate) control: Control<T>,
}

impl<const N: usize, T: Scalar> Controlled<T> for Lengths<N, T> {
    fn control(&self) -> &Control<T> {
        &self.control
    }

    fn control_mut(&mut self) -> &mut Control<T> {
        &mut self.control
    }
}

impl<const N: usize, T: Scalar> Memory for Lengths<N, T> {
    // Inlined: a call by reference would keep the lengths in memory.
    #[inline(always)]
    fn apart(&self) -> Self {
        *self
    }

    fn stored(&self) -> Self {
        let mut stored = *self;
        // The change of v only extrapolates it; without a finite one the guess skips it.
        if !stored.last.change.iter().all(|entry| entry.is_finite()) {
            stored.last.change = SVector::zeros();
        }
        stored.last.measured = RowResiduals::of(stored.last.measured.roundings());
        stored
    }
}

/// A run after a step.
#[derive(Clone, Copy, Debug)]
pub struct After<const N: usize, T = f64> {
    pub(crate) node: Node<N, T>,
    pub(crate) lengths: Lengths<N, T>,
}

impl<const N: usize, T: Scalar> Lengths<N, T> {
    /// Memory after the interval `last`, without fallback and bounds.
    pub(crate) fn new(last: Last<N, T>) -> Self {
        Self { last, prediction: Prediction::new(last.v, last.h), control: Control::new() }
    }

    /// Whether the next step is common: from guesses of the highest order.
    #[inline(always)]
    pub(crate) fn is_common(&self) -> bool {
        self.control.phase.is_none() && self.prediction.is_highest()
    }

    /// Checks stored data. A file may contain any numbers.
    ///
    /// # Errors
    /// [`StepError::NonFinite`], [`StepError::InvalidInput`].
    pub(crate) fn check(&self, t: T) -> Result<(), StepError> {
        let Self { last, prediction, control } = self;
        let numbers = [last.density, last.density_before, last.previous];
        let mut numbers = numbers.iter().chain(last.v.iter()).chain(last.change.iter());
        if !numbers.all(|number| number.is_finite()) || !prediction.is_finite() {
            return Err(StepError::NonFinite { t: t.to_f64(), quantity: "last interval", expression: None });
        }
        check_forward("the last step h", last.h)?;
        control.check(t.to_f64())
    }

    /// Discrete energy of the last step, which ended at the node.
    pub(crate) fn discrete_energy(&self, node: &Node<N, T>) -> T {
        self.control.phase.as_ref().map_or(node.energy, |phase| node.energy + (node.energy_low + phase.gap))
    }

    /// The next step from a trial, if it needs no search.
    #[inline(always)]
    pub(crate) fn predicted<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        trial: VelocityStep<N, T>,
    ) -> Option<Predicted<N, T>> {
        let predicted = self.prediction.step(system, node, &self.last, trial)?;
        let h = predicted.step.h;
        let Control { bounds, .. } = &self.control;
        let allowed = bounds.as_ref().is_none_or(|bounds| bounds.admit(h)) && !self.control.runs_away(self.last.h, h);
        allowed.then_some(predicted)
    }

    /// Continues after the current velocity as if the last step had the length and the density of `interval`.
    pub(crate) fn resume_after(&mut self, interval: &Last<N, T>) {
        let v = self.last.v;
        self.last = Last { v, previous: interval.h, change: SVector::zeros(), is_step: false, ..*interval };
        self.prediction = Prediction::new(v, interval.h);
    }
}

/// A search for an uncommon next step.
pub(crate) struct Search<'a, S, const N: usize, T> {
    pub(crate) system: &'a S,
    pub(crate) node: &'a Node<N, T>,
    pub(crate) lengths: &'a Lengths<N, T>,
}

impl<S: EnergyStepping<N, T>, const N: usize, T: Scalar> Alternating<T> for Search<'_, S, N, T> {
    const POWER: f64 = 3.0;
    type StepSolution = After<N, T>;

    fn control(&self) -> &Control<T> {
        &self.lengths.control
    }

    fn t(&self) -> T {
        self.node.t
    }

    fn last(&self) -> [T; 2] {
        let Last { h, density, .. } = self.lengths.last;
        [h, density]
    }

    fn preserving(&self, gap: T) -> Result<(After<N, T>, T), StepError> {
        let Self { system, lengths, .. } = *self;
        let mut node = *self.node;
        node.add_energy(gap);
        let has_guess = lengths.control.phase.is_none() && !lengths.is_common();
        if has_guess && let Some(predicted) = lengths.predicted(system, &node, lengths.prediction.guess()) {
            let mut after = After { node, lengths: *lengths };
            after.node = node.advanced(system, predicted.step.h, &predicted.step.v, &predicted.increment);
            after.node.check_finite(node.t)?;
            after.lengths.last = lengths.last.followed(&predicted.step);
            after.lengths.prediction.push(&predicted);
            return Ok((after, predicted.step.h));
        }
        let step = self.solved(&node)?;
        let mut after = self.after(&node, &step)?;
        after.lengths.prediction.restart(&step);
        Ok((after, step.h))
    }

    fn fixed(&self, h: T) -> Result<(After<N, T>, [T; 2]), StepError> {
        let Self { system, node, lengths: Lengths { last, .. } } = *self;
        let guess = last.v + last.slope() * ((last.h + h) * T::real(0.5));
        let nearest = continuation::nearest(system, node, h, guess, last.v)?;
        let BranchPoint { v, iterations } = continuation::connected(system, node, h, &nearest.v)?.unwrap_or(nearest);
        let equations = system.extended_system(node, h, &v);
        let t = node.t.to_f64();
        let singular = StepError::Singular { t, matrix: "derivative of the momentum equation" };
        let infinite = StepError::NonFinite { t, quantity: "step density", expression: None };
        let density = Elimination::finite(&equations).ok_or(singular)?.density().ok_or(infinite)?;
        // Residual of the solved equation: near the smallest numbers the rows of both differ by underflow.
        let residual = newton::residual(system, node, h, &v);
        // The energy row e = c + v·r is the discrete energy of this interval minus the preserved energy.
        let gap = equations.energy_residual + v.dot(&equations.momentum.residual);
        // Forces may be finite although L is not: then there is no energy to continue with.
        if !gap.is_finite() {
            return Err(StepError::NonFinite { t, quantity: "energy", expression: None });
        }
        let step = EnergyStep { v, h, density, iterations, measured: RowResiduals::of(residual) };
        let mut after = self.after(node, &step)?;
        // A given length predicts no other length.
        after.lengths.prediction = Prediction::new(v, h);
        let density_next = after.lengths.last.density_next();
        Ok((after, [gap, density_next]))
    }

    fn control_of(found: &mut After<N, T>) -> &mut Control<T> {
        &mut found.lengths.control
    }
}

impl<S: EnergyStepping<N, T>, const N: usize, T: Scalar> Search<'_, S, N, T> {
    /// One fixed step of the length h, after which energy, length and fallback of the run are as before.
    ///
    /// # Errors
    /// The errors of a fixed step.
    pub(crate) fn step_of(&self, h: T) -> Result<After<N, T>, StepError> {
        let (mut after, [gap, density_next]) = self.fixed(h)?;
        let control = &mut after.lengths.control;
        control.kind = StepKind::FixedStep;
        control.phase = control.phase.map(|phase| FixedPhase { density_next, gap, ..phase });
        after.lengths.resume_after(&self.lengths.last);
        Ok(after)
    }

    /// The run after a step from `start`.
    fn after(&self, start: &Node<N, T>, step: &EnergyStep<N, T>) -> Result<After<N, T>, StepError> {
        let increment: Increment<N, T> = self.system.extended_residual(start, step.h, &step.v).increment;
        let node = start.advanced(self.system, step.h, &step.v, &increment);
        node.check_finite(start.t)?;
        Ok(After { node, lengths: Lengths { last: self.lengths.last.followed(step), ..*self.lengths } })
    }

    /// The forward step from `node`, within the bounds.
    fn solved(&self, node: &Node<N, T>) -> Result<EnergyStep<N, T>, StepError> {
        let Self { system, lengths: Lengths { last, control, .. }, .. } = *self;
        let ratio = T::real(RATIO);
        let range = (last.h / ratio, last.h * ratio);
        // At the smallest root D has the same sign as before.
        let forward = |step: &EnergyStep<N, T>| step.density.to_f64() * last.density.to_f64() > 0.0;
        let step = match equations::solve(system, node, guess::predict(system, node, last), range) {
            Ok(step) if forward(&step) => step,
            Err(NoStep::Degenerate { h, density }) => {
                let (t, h, density) = (node.t.to_f64(), h.to_f64(), density.to_f64());
                return Err(StepError::DegenerateStep { t, h, density });
            }
            _ => bracket::smallest_root(system, node, last)?,
        };
        control.check_bounds(node.t, step.h).map(|()| step)
    }
}
