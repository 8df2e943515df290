//! What a run carries from step to step, and how it takes a step.
//!
//! In: a run, a system. Out: the run after the next step, and the step: predicted; else searched; else, where the user allows it, of
//! a given length ([`Fallback`]).
//!
//! A run of 10⁹ steps holds: t, q, p and E are sums of a number and its low part, each addition exact to ε² of the sum,
//! so that 10⁹ of them lose at most 5e-23 of it. Measured: after 10⁷ steps of 0.01, t is k·h with no error in either part.

use super::bracket;
use super::equations::{self, Elimination, EnergyStep, NoStep};
use super::fallback::{Fallback, GROWTH, Phase, StepBounds, Switches, check_step};
use super::guess;
use super::interval::{Last, RATIO};
use super::predicted::{Predicted, Prediction};
use crate::error::StepError;
use crate::momentum::continuation::{self, Reached};
use crate::momentum::newton;
use crate::node::Node;
use crate::real::Scalar;
use crate::state::{Method, Step};
use crate::stepping::{EnergyStepping, Increment};
use crate::vector::VelocityStep;
use nalgebra::SVector;

/// What a run carries from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: crate::real::Real + serde::Serialize",
        deserialize = "T: crate::real::Real + serde::Deserialize<'de>"
    ))
)]
pub struct Run<const N: usize, T = f64> {
    pub(super) node: Node<N, T>,
    pub(super) last: Last<N, T>,
    pub(super) prediction: Prediction<N, T>,
    pub(super) bounds: Option<StepBounds<T>>,
    pub(super) fallback: Fallback,
    /// The fixed steps under way.
    pub(super) phase: Option<Phase<T>>,
    pub(super) switches: Switches<T>,
}

impl<const N: usize, T: Scalar> Run<N, T> {
    /// A run at `node` after the interval `last`, with no fallback and no bounds.
    pub(super) fn new(node: Node<N, T>, last: Last<N, T>) -> Self {
        let prediction = Prediction::new(last.v, last.h);
        let (bounds, fallback, switches) = (None, Fallback::Stop, Switches::default());
        Self { node, last, prediction, bounds, fallback, phase: None, switches }
    }

    /// Whether the next step is the common one, from guesses of the highest order.
    #[inline(always)]
    pub(super) fn is_common(&self) -> bool {
        self.phase.is_none() && self.prediction.is_highest()
    }

    /// Whether a step can follow: what a file says may be anything.
    pub(super) fn check(&self) -> Result<(), StepError> {
        let Self { node, last, prediction, bounds, phase, switches, .. } = self;
        let t = if node.t.to_f64().is_finite() { node.t } else { T::zero() };
        node.check_finite(t)?;
        let numbers = [last.density, last.previous, switches.energy_change, switches.energy_cost];
        let mut numbers = numbers.iter().chain(last.v.iter()).chain(last.change.iter());
        if !numbers.all(|number| number.is_finite()) || !prediction.is_finite() {
            return Err(StepError::NonFinite { t: t.to_f64(), quantity: "last interval", expression: None });
        }
        check_step("the last step h", last.h)?;
        if let Some(bounds) = bounds {
            bounds.check()?;
        }
        phase.as_ref().map_or(Ok(()), Phase::check)
    }

    /// The node and the interval after a step from `start`, and the step.
    #[inline]
    pub(super) fn reached<S: EnergyStepping<N, T>>(
        &self,
        start: &Node<N, T>,
        found: &EnergyStep<N, T>,
        increment: &Increment<N, T>,
        method: Method<T>,
    ) -> (Node<N, T>, Last<N, T>, Step<N, T>) {
        let EnergyStep { v, h, density, iterations, residual } = *found;
        let node = start.advanced::<S>(h, &v, increment);
        let (t_mid, q_mid) = start.midpoint(h, &v);
        let last = &self.last;
        // One over the time between the middles of the two intervals.
        let frequency = T::real(2.0) / (h + last.h);
        let density_next = density + (density - last.density) * (frequency * h);
        let step = Step {
            t: node.t,
            q: node.q,
            p: node.p,
            energy: node.energy,
            h,
            midpoint: (t_mid, q_mid, v),
            density,
            density_next,
            iterations,
            residual: T::real(residual),
            method,
        };
        let last = Last { v, h, previous: last.h, density, change: v - last.v, is_step: true };
        (node, last, step)
    }

    /// The next step from a trial, where it has not to be searched.
    #[inline(always)]
    pub(super) fn predicted<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        trial: VelocityStep<N, T>,
    ) -> Option<Predicted<N, T>> {
        let predicted = self.prediction.step(system, &self.node, &self.last, trial)?;
        let h = predicted.step.h;
        let allowed = self.bounds.as_ref().is_none_or(|bounds| bounds.admit(h)) && !self.runs_away(h);
        allowed.then_some(predicted)
    }

    /// Takes one step that is not the common one.
    pub(super) fn advance<S: EnergyStepping<N, T>>(&mut self, system: &S) -> Result<Step<N, T>, StepError> {
        if let Some(phase) = self.phase {
            return self.advance_in_phase(system, phase);
        }
        if !self.is_common()
            && let Some(predicted) = self.predicted(system, self.prediction.guess())
        {
            let (node, last, step) =
                self.reached::<S>(&self.node, &predicted.step, &predicted.increment, Method::EnergyPreserving);
            node.check_finite(self.node.t)?;
            self.prediction.push(&predicted);
            (self.node, self.last) = (node, last);
            return Ok(step);
        }
        match self.next_step(system, &self.node) {
            Ok(step) if self.runs_away(step.h) => self.fall_back_from(system, step),
            Ok(step) => self.take(system, self.node, step, Method::EnergyPreserving),
            Err(failure) => self.fall_back(system, failure),
        }
    }

    /// Takes a step from `start`.
    pub(super) fn take<S: EnergyStepping<N, T>>(
        &mut self,
        system: &S,
        start: Node<N, T>,
        found: EnergyStep<N, T>,
        method: Method<T>,
    ) -> Result<Step<N, T>, StepError> {
        let increment = system.extended_residual(&start, found.h, &found.v).increment;
        let (node, last, step) = self.reached::<S>(&start, &found, &increment, method);
        node.check_finite(start.t)?;
        match method {
            // A length that was given predicts none.
            Method::FixedStep => self.prediction = Prediction::new(found.v, found.h),
            _ => self.prediction.restart(&found),
        }
        (self.node, self.last) = (node, last);
        Ok(step)
    }

    /// The forward step from `node`, within the bounds.
    pub(super) fn next_step<S: EnergyStepping<N, T>>(
        &self,
        system: &S,
        node: &Node<N, T>,
    ) -> Result<EnergyStep<N, T>, StepError> {
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

    /// A fixed step instead of one that was found.
    #[cold]
    fn fall_back_from<S: EnergyStepping<N, T>>(
        &mut self,
        system: &S,
        step: EnergyStep<N, T>,
    ) -> Result<Step<N, T>, StepError> {
        let (t, previous, found) = (self.node.t.to_f64(), self.last.h.to_f64(), step.h.to_f64());
        self.fall_back(system, StepError::StepRatio { t, previous, found })
    }

    /// The first fixed step, where the user allows it; else the failure.
    #[cold]
    fn fall_back<S: EnergyStepping<N, T>>(&mut self, system: &S, failure: StepError) -> Result<Step<N, T>, StepError> {
        let Last { h, density, .. } = self.last;
        let phase = Phase::instead_of(failure, self.fallback, self.bounds.as_ref(), h, density)?;
        let step = self.fixed_step(system, phase)?;
        self.switches.count += 1;
        Ok(step)
    }

    /// One fixed step of the length h, after which the run goes on as it was: with its energy, its length of a step, its fallback.
    pub(super) fn step_of<S: EnergyStepping<N, T>>(&mut self, system: &S, h: T) -> Result<Step<N, T>, StepError> {
        let before = *self;
        let Last { h: last, density, .. } = before.last;
        let mut phase =
            Phase { h, shorter: false, law_h: last, law_density: density, density_next: density, gap: T::zero() };
        let step = self.fixed_step(system, phase)?;
        if let Some(fixed) = before.phase {
            phase = self.phase.unwrap_or(phase);
            self.phase = Some(Phase { gap: phase.gap, density_next: phase.density_next, ..fixed });
        } else {
            self.phase = None;
        }
        self.switches = before.switches;
        self.resume_after(&before.last);
        Ok(step)
    }

    /// Lets the next step follow the velocity at hand as if the last one had the length and the density of `interval`.
    pub(super) fn resume_after(&mut self, interval: &Last<N, T>) {
        let v = self.last.v;
        self.last = Last { v, previous: interval.h, change: SVector::zeros(), is_step: false, ..*interval };
        self.prediction = Prediction::new(v, interval.h);
    }

    /// A step where the last one was fixed: energy-preserving again where one exists, else fixed.
    #[cold]
    fn advance_in_phase<S: EnergyStepping<N, T>>(
        &mut self,
        system: &S,
        phase: Phase<T>,
    ) -> Result<Step<N, T>, StepError> {
        if !phase.is_over(3.0) {
            return self.fixed_step(system, phase);
        }
        let kept = self.node;
        if let Ok(found) = self.next_step(system, &kept) {
            let step = self.take(system, kept, found, Method::EnergyPreserving)?;
            self.switches.returns += 1;
            self.phase = None;
            return Ok(step);
        }
        let mut seeded = kept;
        seeded.add_energy(phase.gap);
        if let Ok(found) = self.next_step(system, &seeded) {
            let step = self.take(system, seeded, found, Method::Reseeded { energy_change: phase.gap })?;
            self.switches.returns += 1;
            self.switches.reseed(phase.gap);
            self.phase = None;
            return Ok(step);
        }
        self.fixed_step(system, phase)
    }

    /// One fixed step of the phase.
    fn fixed_step<S: EnergyStepping<N, T>>(&mut self, system: &S, phase: Phase<T>) -> Result<Step<N, T>, StepError> {
        let (start, last, h) = (self.node, self.last, phase.h);
        let guess = last.v + last.slope() * ((last.h + h) * T::real(0.5));
        let Reached { v, iterations } = continuation::nearest(system, &start, h, guess, last.v)?;
        let equations = system.extended_system(&start, h, &v);
        let t = start.t.to_f64();
        let singular = StepError::Singular { t, matrix: "derivative of the momentum equation" };
        let infinite = StepError::NonFinite { t, quantity: "step density", expression: None };
        let density = Elimination::finite(&equations).ok_or(singular)?.density().ok_or(infinite)?;
        // Of the equation that was solved: next to the smallest numbers the rows of both differ in what underflows.
        let residual = newton::residual(system, &start, h, &v);
        // The energy row e = c + v·r is what the energy carried lacks of the discrete energy of this interval.
        let gap = equations.energy_residual + v.dot(&equations.momentum.residual);
        // Forces may be finite where L is not: there is no energy to go on with.
        if !gap.is_finite() {
            return Err(StepError::NonFinite { t, quantity: "energy", expression: None });
        }
        let found = EnergyStep { v, h, density, iterations, residual };
        let step = self.take(system, start, found, Method::FixedStep)?;
        let phase = Phase { gap, density_next: step.density_next, ..phase };
        self.phase = Some(phase);
        self.switches.fixed_steps += 1;
        Ok(Step { energy: phase.energy(&self.node), ..step })
    }
}
