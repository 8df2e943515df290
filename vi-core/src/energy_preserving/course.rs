//! How a step is found from the steps before it.
//!
//! In: a node, and what is remembered of the steps before ([`Lengths`]). Out: the node and the memory after the next step: predicted; else searched; else of a given
//! length, if the user allows it ([`Fallback`]). Nothing changes on the way.

use super::bracket;
use super::equations::{self, Elimination, EnergyStep, Measured, NoStep};
use super::guess;
use super::interval::Last;
use super::predicted::{Predicted, Prediction};
use crate::error::StepError;
use crate::method::Memory;
use crate::method::bounds::{Fallback, GROWTH, Phase, RATIO, StepBounds, Switches, check_forward};
use crate::momentum::continuation::{self, Reached};
use crate::momentum::newton;
use crate::node::Node;
use crate::real::Scalar;
use crate::state::StepKind;
use crate::stepping::{EnergyStepping, Increment};
use crate::vector::VelocityStep;
use nalgebra::SVector;

/// What energy-preserving steps remember, and the options of their run.
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
    pub(crate) bounds: Option<StepBounds<T>>,
    pub(crate) fallback: Fallback,
    /// The fixed steps under way.
    pub(crate) phase: Option<Phase<T>>,
    pub(crate) switches: Switches<T>,
    /// How the last step was found. Written on the cold path alone: after a step of another kind no guess is of the highest order.
    pub(crate) kind: StepKind<T>,
}

impl<const N: usize, T: Scalar> Memory for Lengths<N, T> {
    fn stored(&self) -> Self {
        let mut stored = *self;
        // The change of v only extrapolates it: if it has overflowed, the guess does without.
        if !stored.last.change.iter().all(|entry| entry.is_finite()) {
            stored.last.change = SVector::zeros();
        }
        stored.last.measured = Measured::of(stored.last.measured.roundings());
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
    /// After the interval `last`, without fallback and bounds.
    pub(crate) fn new(last: Last<N, T>) -> Self {
        let prediction = Prediction::new(last.v, last.h);
        let (bounds, fallback, switches) = (None, Fallback::Stop, Switches::default());
        Self { last, prediction, bounds, fallback, phase: None, switches, kind: StepKind::EnergyPreserving }
    }

    /// Whether the next step is the common one, from guesses of the highest order.
    #[inline(always)]
    pub(crate) fn is_common(&self) -> bool {
        self.phase.is_none() && self.prediction.is_highest()
    }

    /// Whether a step can follow: a file may hold anything.
    ///
    /// # Errors
    /// [`StepError::NonFinite`], [`StepError::InvalidInput`].
    pub(crate) fn check(&self, t: T) -> Result<(), StepError> {
        let Self { last, prediction, bounds, phase, switches, .. } = self;
        let numbers = [last.density, last.density_before, last.previous, switches.energy_change, switches.energy_cost];
        let mut numbers = numbers.iter().chain(last.v.iter()).chain(last.change.iter());
        if !numbers.all(|number| number.is_finite()) || !prediction.is_finite() {
            return Err(StepError::NonFinite { t: t.to_f64(), quantity: "last interval", expression: None });
        }
        check_forward("the last step h", last.h)?;
        if let Some(bounds) = bounds {
            bounds.check()?;
        }
        phase.as_ref().map_or(Ok(()), Phase::check)
    }

    /// The next step from a trial, if it has not to be searched.
    #[inline(always)]
    pub(crate) fn predicted<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        trial: VelocityStep<N, T>,
    ) -> Option<Predicted<N, T>> {
        let predicted = self.prediction.step(system, node, &self.last, trial)?;
        let h = predicted.step.h;
        let allowed = self.bounds.as_ref().is_none_or(|bounds| bounds.admit(h)) && !self.runs_away(h);
        allowed.then_some(predicted)
    }

    /// The next step, if it is not the common one.
    ///
    /// # Errors
    /// Why there is no step.
    pub(crate) fn next<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
    ) -> Result<After<N, T>, StepError> {
        if let Some(phase) = self.phase {
            return self.next_in_phase(system, node, phase);
        }
        if !self.is_common()
            && let Some(predicted) = self.predicted(system, node, self.prediction.guess())
        {
            let mut after = After { node: *node, lengths: *self };
            after.node = node.advanced::<S>(predicted.step.h, &predicted.step.v, &predicted.increment);
            after.node.check_finite(node.t)?;
            after.lengths.last = self.last.followed(&predicted.step);
            after.lengths.kind = StepKind::EnergyPreserving;
            after.lengths.prediction.push(&predicted);
            return Ok(after);
        }
        match self.next_step(system, node) {
            Ok(step) if self.runs_away(step.h) => {
                let (t, previous, found) = (node.t.to_f64(), self.last.h.to_f64(), step.h.to_f64());
                self.fall_back(system, node, StepError::StepRatio { t, previous, found })
            }
            Ok(step) => self.after(system, node, step, StepKind::EnergyPreserving),
            Err(failure) => self.fall_back(system, node, failure),
        }
    }

    /// The run after a step from `start`.
    fn after<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        start: &Node<N, T>,
        step: EnergyStep<N, T>,
        kind: StepKind<T>,
    ) -> Result<After<N, T>, StepError> {
        let increment: Increment<N, T> = system.extended_residual(start, step.h, &step.v).increment;
        let node = start.advanced::<S>(step.h, &step.v, &increment);
        node.check_finite(start.t)?;
        let mut lengths = Self { last: self.last.followed(&step), kind, ..*self };
        match kind {
            // A given length predicts none.
            StepKind::FixedStep => lengths.prediction = Prediction::new(step.v, step.h),
            _ => lengths.prediction.restart(&step),
        }
        Ok(After { node, lengths })
    }

    /// The forward step from `node`, within the bounds.
    fn next_step<S: EnergyStepping<N, T>>(&self, system: &S, node: &Node<N, T>) -> Result<EnergyStep<N, T>, StepError> {
        let last = &self.last;
        let ratio = T::real(RATIO);
        let range = (last.h / ratio, last.h * ratio);
        // At the smallest root D has the sign that it had: past a change of sign lies another root.
        let forward = |step: &EnergyStep<N, T>| step.density.to_f64() * last.density.to_f64() > 0.0;
        let step = match equations::solve(system, node, guess::predict(system, node, last), range) {
            Ok(step) if forward(&step) => step,
            Err(NoStep::Degenerate { h, density }) => {
                let (t, h, density) = (node.t.to_f64(), h.to_f64(), density.to_f64());
                return Err(StepError::DegenerateStep { t, h, density });
            }
            _ => bracket::smallest_root(system, node, last)?,
        };
        match &self.bounds {
            Some(bounds) if !bounds.admit(step.h) => Err(bounds.refusal(node.t, step.h)),
            _ => Ok(step),
        }
    }

    /// Whether a step is so much longer than the last that D is about to vanish, and the user wants no such step.
    #[inline]
    fn runs_away(&self, h: T) -> bool {
        self.fallback == Fallback::FixedSteps && h > self.last.h * T::real(GROWTH)
    }

    /// The first fixed step, if the user allows it; else the failure.
    #[cold]
    fn fall_back<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        failure: StepError,
    ) -> Result<After<N, T>, StepError> {
        let Last { h, density, .. } = self.last;
        let phase = Phase::instead_of(failure, self.fallback, self.bounds.as_ref(), h, density)?;
        let mut after = self.fixed_step(system, node, phase)?;
        after.lengths.switches.count += 1;
        Ok(after)
    }

    /// One fixed step of the length h, after which the run continues as it was: with its energy, its length, its fallback.
    ///
    /// # Errors
    /// Those of a fixed step.
    pub(crate) fn step_of<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        h: T,
    ) -> Result<After<N, T>, StepError> {
        let Last { h: last, density, .. } = self.last;
        let phase =
            Phase { h, shorter: false, law_h: last, law_density: density, density_next: density, gap: T::zero() };
        let After { node, mut lengths } = self.fixed_step(system, node, phase)?;
        let taken = lengths.phase.unwrap_or(phase);
        lengths.phase = self.phase.map(|fixed| Phase { gap: taken.gap, density_next: taken.density_next, ..fixed });
        lengths.switches = self.switches;
        lengths.resume_after(&self.last);
        Ok(After { node, lengths })
    }

    /// Lets the next step follow the velocity at hand as if the last one had the length and the density of `interval`.
    pub(crate) fn resume_after(&mut self, interval: &Last<N, T>) {
        let v = self.last.v;
        self.last = Last { v, previous: interval.h, change: SVector::zeros(), is_step: false, ..*interval };
        self.prediction = Prediction::new(v, interval.h);
    }

    /// A step after a fixed one: energy-preserving again if one exists, else fixed.
    #[cold]
    fn next_in_phase<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
        phase: Phase<T>,
    ) -> Result<After<N, T>, StepError> {
        if !phase.is_over(3.0) {
            return self.fixed_step(system, node, phase);
        }
        let mut seeded = *node;
        seeded.add_energy(phase.gap);
        let reseeded = StepKind::Reseeded { energy_change: phase.gap };
        for (start, kind) in [(node, StepKind::EnergyPreserving), (&seeded, reseeded)] {
            if let Ok(found) = self.next_step(system, start) {
                let mut after = self.after(system, start, found, kind)?;
                after.lengths.switches.returns += 1;
                after.lengths.phase = None;
                if kind != StepKind::EnergyPreserving {
                    after.lengths.switches.reseed(phase.gap);
                }
                return Ok(after);
            }
        }
        self.fixed_step(system, node, phase)
    }

    /// One fixed step of the phase.
    fn fixed_step<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        start: &Node<N, T>,
        phase: Phase<T>,
    ) -> Result<After<N, T>, StepError> {
        let (last, h) = (&self.last, phase.h);
        let guess = last.v + last.slope() * ((last.h + h) * T::real(0.5));
        let Reached { v, iterations } = continuation::nearest(system, start, h, guess, last.v)?;
        let equations = system.extended_system(start, h, &v);
        let t = start.t.to_f64();
        let singular = StepError::Singular { t, matrix: "derivative of the momentum equation" };
        let infinite = StepError::NonFinite { t, quantity: "step density", expression: None };
        let density = Elimination::finite(&equations).ok_or(singular)?.density().ok_or(infinite)?;
        // Of the equation that was solved: next to the smallest numbers the rows of both differ in what underflows.
        let residual = newton::residual(system, start, h, &v);
        // The energy row e = c + v·r is what the kept energy lacks of the discrete energy of this interval.
        let gap = equations.energy_residual + v.dot(&equations.momentum.residual);
        // Forces may be finite where L is not: there is no energy to continue with.
        if !gap.is_finite() {
            return Err(StepError::NonFinite { t, quantity: "energy", expression: None });
        }
        let found = EnergyStep { v, h, density, iterations, measured: Measured::of(residual) };
        let mut after = self.after(system, start, found, StepKind::FixedStep)?;
        let density_next = after.lengths.last.density_next();
        after.lengths.phase = Some(Phase { density_next, gap, ..phase });
        after.lengths.switches.fixed_steps += 1;
        Ok(after)
    }
}
