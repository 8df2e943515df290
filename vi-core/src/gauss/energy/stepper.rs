//! One energy-preserving step.
//!
//! In: a run with the energy to preserve. Out: the step that preserves it, within the bounds, and the run after it. The system is erased
//! ([`Solver`]).

use super::density::power;
use super::run::Course;
use super::solver::{NodeEnergy, Solver};
use super::trial::Trial;
use crate::energy_preserving::interval::RATIO;
use crate::error::StepError;
use crate::state::{Method, State};

/// A run on its way to the next node.
pub(super) struct Stepper<'a, const N: usize, const S: usize> {
    pub(super) gauss: &'a mut dyn Solver<N, S>,
    pub(super) course: &'a mut Course,
}

impl<const N: usize, const S: usize> Stepper<'_, N, S> {
    /// The next step, within the bounds.
    pub(super) fn found(&mut self) -> Result<Trial<N, S>, StepError> {
        let t = self.gauss.run().node.t;
        let Course { excess, size, .. } = *self.course;
        let previous = self.course.h();
        if excess.abs() < Self::least_excess(f64::EPSILON * size) {
            return Err(StepError::DegenerateStep { t, h: previous, density: excess / power::<S>(previous) });
        }
        // Past a change of sign lies another root.
        if self.course.density().is_some_and(|last| excess * last < 0.0) {
            return Err(self.no_step());
        }
        let step = match self.root() {
            Some(step) => step,
            None => self.smallest_root()?,
        };
        let found = step.h();
        if found > previous * RATIO || previous > found * RATIO {
            return Err(StepError::StepRatio { t, previous, found });
        }
        match &self.course.bounds {
            Some(bounds) if !bounds.admit(found) => Err(bounds.refusal(t, found)),
            _ => Ok(step),
        }
    }

    /// Takes a step that was found.
    pub(super) fn take(&mut self, step: &Trial<N, S>, method: Method) -> Result<(), StepError> {
        let mut after = step.after;
        if self.gauss.does_work() {
            after.node.add_energy(step.work);
            after.node.check_finite(self.gauss.run().node.t)?;
        }
        let [excess, size] = self.excess_of(after.node.energy, after.node.energy_low, &after.node.state())?;
        // The mean of `H − E0` at the start and of `H − E1` at the end.
        let mean = 0.5 * (self.course.excess + excess) - step.residual;
        let course = &mut *self.course;
        course.push(step.h(), mean / power::<S>(step.h()));
        course.residual = if method == Method::FixedStep { 0.0 } else { step.roundings() };
        if method == Method::FixedStep {
            course.forget_lengths();
        }
        course.excess = excess;
        course.size = size;
        course.method = method;
        *self.gauss.run_mut() = after;
        Ok(())
    }

    /// Measures the energy of the node.
    pub(super) fn measure_excess(&mut self) -> Result<(), StepError> {
        let node = &self.gauss.run().node;
        let [excess, size] = self.excess_of(node.energy, node.energy_low, &node.state())?;
        self.course.excess = excess;
        self.course.size = size;
        Ok(())
    }

    /// `H − E'` at a state, E' with its low part, and the size of the terms of H.
    fn excess_of(&self, energy: f64, low: f64, state: &State<N>) -> Result<[f64; 2], StepError> {
        let NodeEnergy { total, size } = self.gauss.energy_at(state)?;
        let excess = (total - energy) - low;
        if excess.is_finite() && size.is_finite() {
            Ok([excess, size])
        } else {
            Err(StepError::NonFinite { t: state.t, quantity: "energy", expression: None })
        }
    }
}
