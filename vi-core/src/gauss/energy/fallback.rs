//! What a run does where no energy-preserving step exists.
//!
//! In: the typed reason why there is none, and what the user chose. Out: that error; or fixed Gauss steps of the last length, until an
//! energy-preserving step exists again. As with one stage ([`crate::energy_preserving::Fallback`]) E stays, with the work done since, and
//! fixed steps end where the step law `h |D|^(1/(2s+1)) = C` asks for their length or a shorter one: with D_0 the density where they began,
//!
//! ```text
//! H − E = C_s h_f^2s (2s D_0 + D)/(2s + 1)        D = D_s + D_*
//! ```
//!
//! to leading order without force, which has the sign of D where D has that of D_0. Only where no step has the energy of before, E is the
//! discrete energy of the last fixed step from there on.

use super::run::Course;
use super::stepper::Stepper;
use crate::energy_preserving::fallback::{Fallback, GROWTH, Phase};
use crate::error::StepError;
use crate::state::Method;

impl<const N: usize, const S: usize> Stepper<'_, N, S> {
    /// Whether a step is so much longer than the last that D is about to vanish, and the user wants no such step.
    fn runs_away(&self, h: f64) -> bool {
        self.course.fallback == Fallback::FixedSteps && h > self.course.h() * GROWTH
    }

    /// Takes the next step.
    pub(super) fn advance(&mut self) -> Result<(), StepError> {
        if let Some(phase) = self.course.phase {
            return self.advance_in_phase(phase);
        }
        match self.found() {
            Ok(step) if self.runs_away(step.h()) => {
                let t = self.gauss.run().node.t;
                let failure = StepError::StepRatio { t, previous: self.course.h(), found: step.h() };
                self.fall_back(failure)
            }
            Ok(step) => self.take(&step, Method::EnergyPreserving),
            Err(failure) => self.fall_back(failure),
        }
    }

    /// The first fixed step, where the user allows it; else the failure.
    #[cold]
    fn fall_back(&mut self, failure: StepError) -> Result<(), StepError> {
        let Course { fallback, bounds, .. } = *self.course;
        let phase =
            Phase::instead_of(failure, fallback, bounds.as_ref(), self.course.h(), self.course.told_density::<S>())?;
        self.fixed_step(phase)?;
        self.course.switches.count += 1;
        Ok(())
    }

    /// A step where the last one was fixed: energy-preserving again where one exists, else fixed.
    #[cold]
    fn advance_in_phase(&mut self, phase: Phase<f64>) -> Result<(), StepError> {
        if !phase.is_over(Self::SLOPE + 1.0) {
            return self.fixed_step(phase);
        }
        let node = self.gauss.run().node;
        let course = *self.course;
        if let Ok(step) = self.found() {
            self.take(&step, Method::EnergyPreserving)?;
            self.course.switches.returns += 1;
            self.course.phase = None;
            return Ok(());
        }
        self.gauss.run_mut().node.add_energy(phase.gap);
        if self.measure_excess().is_ok()
            && let Ok(step) = self.found()
        {
            self.take(&step, Method::Reseeded { energy_change: phase.gap })?;
            self.course.switches.returns += 1;
            self.course.switches.reseed(phase.gap);
            self.course.phase = None;
            return Ok(());
        }
        self.gauss.run_mut().node = node;
        *self.course = course;
        self.fixed_step(phase)
    }

    /// One fixed step of the phase.
    fn fixed_step(&mut self, phase: Phase<f64>) -> Result<(), StepError> {
        let step = self.trial_of(phase.h)?;
        let last = self.course.told_density::<S>();
        self.take(&step, Method::FixedStep)?;
        let density = self.course.told_density::<S>();
        // The next interval has the same length.
        self.course.phase = Some(Phase { gap: step.residual, density_next: density + (density - last), ..phase });
        self.course.switches.fixed_steps += 1;
        Ok(())
    }
}
