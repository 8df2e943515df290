//! One energy-preserving step.
//!
//! In: a run with the energy to preserve. Out: the step of some length from its node; the step that preserves the energy, within the bounds, and the
//! run after it. The system is erased ([`Solver`]).

use super::density::power;
use super::run::Course;
use super::solver::{NodeEnergy, Solver};
use super::trial::{Trial, at};
use crate::energy_preserving::interval::RATIO;
use crate::error::StepError;
use crate::gauss::stages::Stages;
use crate::gauss::sweep::Convergence;
use crate::newton::{FLOOR, roundings};
use crate::state::{Method, State};
use nalgebra::SMatrix;

/// Part of the terms of an energy that its rounding may be: one that is known to fewer digits is not kept.
const KNOWN: f64 = 1e-10;

/// A run on its way to the next node.
pub(super) struct Stepper<'a, const N: usize, const S: usize> {
    pub(super) gauss: &'a mut dyn Solver<N, S>,
    pub(super) course: &'a mut Course,
}

impl<const N: usize, const S: usize> Stepper<'_, N, S> {
    /// The stages of the next step of length h, by those of the last one.
    fn stages_for(&self, h: f64) -> Stages<N, S> {
        let run = self.gauss.run();
        let stages = &run.stages.data.0;
        if run.convergence.has_begun() { at(stages, |c| 1.0 + c * (h / run.h)) } else { *stages }
    }

    /// The step of length h from the node, by the stages of the last one.
    ///
    /// # Errors
    /// As [`Stepper::trial`].
    pub(super) fn trial_of(&mut self, h: f64) -> Result<Trial<N, S>, StepError> {
        self.trial(h, self.stages_for(h))
    }

    /// The step of length h from the node, by a guess of its stages.
    ///
    /// # Errors
    /// Those of [`Gauss::step`](crate::Gauss::step).
    pub(super) fn trial(&mut self, h: f64, stages: Stages<N, S>) -> Result<Trial<N, S>, StepError> {
        let run = self.gauss.run_mut();
        let kept = (run.h, run.stages, run.convergence);
        run.h = h;
        run.stages = SMatrix::from_array_storage(nalgebra::ArrayStorage(stages));
        // Where no sweep was before, stages are taken as they are, not carried further.
        run.convergence = Convergence { sweeps: 0, ..run.convergence };
        let solved = self.gauss.solved();
        let run = self.gauss.run_mut();
        (run.h, run.stages, run.convergence) = kept;
        let after = solved?;
        let node = &self.gauss.run().node;
        let energies = self.gauss.energies(h, after.stages.data.0, node.energy);
        let residual = energies.start - node.energy_low - power::<S>(h) * self.course.shift;
        if !residual.is_finite() {
            return Err(StepError::NonFinite { t: node.t, quantity: "energy", expression: None });
        }
        Ok(Trial { after, residual, work: energies.work, size: energies.size })
    }

    /// What rounding moves the energy of a trial by at most, by running error analysis, in ulps of 1.
    #[cold]
    fn rounding_of(&self, trial: &Trial<N, S>) -> f64 {
        let base = self.gauss.run().node.energy;
        self.gauss.bounded_energies(trial.h(), trial.after.stages.data.0, base).start.ulps()
    }

    /// Whether the energy of a trial is the one to preserve as far as its arithmetic can tell.
    ///
    /// # Errors
    /// [`StepError::DegenerateStep`] where it is, and `H − E` is too small to tell the length.
    #[cold]
    pub(super) fn is_preserved(&self, trial: &Trial<N, S>) -> Result<bool, StepError> {
        let rounding = f64::EPSILON * self.rounding_of(trial);
        // At a turning point H may be zero, while the energies of the motion are not.
        let size = trial.size.max(self.course.largest_size);
        if !(trial.residual.abs() <= FLOOR * rounding && rounding <= KNOWN * size) {
            return Ok(false);
        }
        if self.course.excess.abs() < Self::least_excess(rounding) { Err(self.degenerate()) } else { Ok(true) }
    }

    /// The error where `H − E` tells no length.
    fn degenerate(&self) -> StepError {
        let (t, h) = (self.gauss.run().node.t, self.course.h());
        StepError::DegenerateStep { t, h, density: self.course.excess / power::<S>(h) }
    }

    /// Refuses a shift that adds more to the energy than `size`, the size of its terms along the motion.
    ///
    /// # Errors
    /// [`StepError::ShiftTooLarge`].
    pub(super) fn check_shift(&self, shift: f64, size: f64) -> Result<(), StepError> {
        let (t, h) = (self.gauss.run().node.t, self.course.h());
        let part = power::<S>(h) * shift.abs();
        if part <= size {
            return Ok(());
        }
        let shorter = h * (0.1 * size / part).powf(Self::SLOPE.recip());
        Err(StepError::ShiftTooLarge { t, h, shift, part, size, shorter })
    }

    /// The least `|H − E|` that tells a length, where energies are rounded by so much.
    pub(super) fn least_excess(rounding: f64) -> f64 {
        // The length is known to this part of itself, so that the numbers of its step are.
        const PARTS: f64 = 1000.0;
        PARTS * rounding / Self::SLOPE
    }

    /// The next step, within the bounds.
    pub(super) fn found(&mut self) -> Result<Trial<N, S>, StepError> {
        let t = self.gauss.run().node.t;
        let Course { excess, size, largest_size, shift, .. } = *self.course;
        let previous = self.course.h();
        if excess.abs() < Self::least_excess(f64::EPSILON * size) {
            return Err(self.degenerate());
        }
        // A motion that has only gained speed so far has not shown how large its energies are.
        if size < largest_size {
            self.check_shift(shift, largest_size)?;
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
        let measured = self.excess_of(after.node.energy, after.node.energy_low, &after.node.state())?;
        let residual = match method {
            Method::FixedStep => 0.0,
            _ if step.roundings() <= FLOOR => step.roundings(),
            _ => roundings(step.residual, self.rounding_of(step)),
        };
        let excess = measured[0];
        // The mean of `H − E0` at the start and of `H − E1` at the end.
        let mean = 0.5 * (self.course.excess + excess) - step.residual;
        let course = &mut *self.course;
        course.push(step.h(), mean / power::<S>(step.h()));
        course.residual = residual;
        if method == Method::FixedStep {
            course.forget_lengths();
        }
        course.set_excess(measured);
        course.method = method;
        *self.gauss.run_mut() = after;
        Ok(())
    }

    /// Measures the energy of the node.
    pub(super) fn measure_excess(&mut self) -> Result<(), StepError> {
        let node = &self.gauss.run().node;
        let measured = self.excess_of(node.energy, node.energy_low, &node.state())?;
        self.course.set_excess(measured);
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
