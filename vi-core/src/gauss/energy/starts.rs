//! Where the first step comes from, and which energy is kept.
//!
//! In: a state, and the length h of the first step or the energy to preserve. Out: an integrator at that state. A shift is measured along
//! fixed steps, or given.

use super::EnergyPreservingGauss;
use super::density::{power, step_density};
use super::run::Course;
use super::stepper::Stepper;
use crate::collocation::Collocation;
use crate::energy_preserving::fallback::check_step;
use crate::error::StepError;
use crate::gauss::Gauss;
use crate::state::State;
use crate::stepping::{Convertible, FixedStepping};

impl<S, const N: usize, const STAGES: usize> EnergyPreservingGauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N> + FixedStepping<N>,
{
    /// The integrator of `system` from `state`, whose first step has the length `h`, in units of time: it preserves the discrete energy of that
    /// step. So the energy differs by `C_s h^2s D_s` from H at the state.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is not positive and finite, [`StepError::NonFinite`] for such a state,
    /// [`StepError::Singular`] or [`StepError::NotConverged`] where no velocity belongs to its momenta, [`StepError::StagesUnsettled`] where h is
    /// too long for the motion.
    pub fn new(system: S, state: State<N>, h: f64) -> Result<Self, StepError> {
        let mut integrator = Self::from_energy(system, state, 0.0, h)?;
        let first = integrator.stepper().trial_of(h)?;
        let run = &mut integrator.gauss.run;
        run.node.energy = first.residual;
        // The stages of the first step are known.
        run.stages = first.after.stages;
        integrator.stepper().measure_excess()?;
        Ok(integrator)
    }

    /// The integrator of `system` from `state` that preserves `energy`, in units of L, with a first step of about the length `h`: up to a factor
    /// of 3 from it. H at the state differs from that energy by `C_s h^2s D_s`; a step that belongs to `E = H` itself has no length.
    ///
    /// # Errors
    /// As [`EnergyPreservingGauss::new`]; [`StepError::NonFinite`] for an energy that is not finite.
    pub fn from_energy(system: S, state: State<N>, energy: f64, h: f64) -> Result<Self, StepError> {
        check_step("the step h", h)?;
        let mut gauss = Gauss::new(system, state, h)?;
        gauss.run.node.energy = energy;
        let mut integrator = Self { gauss, course: Course::new(h, Stepper::<N, STAGES>::SLOPE), failure: None };
        integrator.stepper().measure_excess()?;
        Ok(integrator)
    }

    /// Adds `shift`, in the units of the step density, to the step density of every step: a step exists while `D_s + shift` keeps its sign.
    /// What is kept to rounding is E' = E − C_s h^2s D_*, [`EnergyPreservingGauss::shifted_energy`]; momenta and the order stay. With zero it
    /// is the integrator without a shift, and the larger it is the closer it is to fixed steps.
    ///
    /// The length of the last step, or the first one, stays what it is.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a shift that is not finite.
    pub fn with_shift(mut self, shift: f64) -> Result<Self, StepError> {
        if !shift.is_finite() {
            return Err(StepError::InvalidInput {
                input: "the shift of the step density",
                allowed: "finite",
                value: shift,
            });
        }
        let change = shift - self.course.shift;
        self.gauss.run.node.add_energy(-power::<STAGES>(self.course.h()) * change);
        self.course.shift = shift;
        self.course.densities = self.course.densities.map(|densities| densities.map(|density| density + change));
        self.stepper().measure_excess()?;
        Ok(self)
    }

    /// The same with twice the largest `|D_s|` that fixed steps of the first length meet over `duration` from here, in units of time: a
    /// period of the motion, or a few. The steps are then within a factor of `3^(1/(2s+1))` of each other while the motion goes on as there.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a duration that is not positive and finite; those of [`Gauss::step`] and of [`step_density`].
    pub fn with_shift_from(self, duration: f64) -> Result<Self, StepError> {
        check_step("the duration over which the step density is measured", duration)?;
        let mut steps = self.gauss.clone();
        steps.run.h = self.course.h();
        let end = steps.run.node.t + duration;
        let of = |state: &State<N>| step_density::<S, N, STAGES>(self.system(), state);
        let mut largest = of(&steps.state())?.abs();
        while steps.run.node.t < end {
            largest = largest.max(of(&steps.step()?)?.abs());
        }
        self.with_shift(2.0 * largest)
    }
}
