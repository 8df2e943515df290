//! Where the first step comes from, and which energy is kept.
//!
//! In: a state, and the length h of the first step or the energy to preserve. Out: an integrator at that state. A shift is measured along
//! fixed steps, or given.

use super::EnergyPreservingGauss;
use super::density::{power, step_density};
use super::run::Course;
use super::solver::Solver;
use super::stepper::Stepper;
use crate::collocation::Collocation;
use crate::energy_preserving::fallback::check_step;
use crate::error::StepError;
use crate::gauss::Gauss;
use crate::gauss::energies::energies;
use crate::state::State;
use crate::stepping::Convertible;

/// Times that the step is halved along which the step density is measured.
const HALVINGS: u32 = 16;
/// Part of the terms of the energy that a step may miss it by there.
const HELD: f64 = 0.01;

impl<S, const N: usize, const STAGES: usize> EnergyPreservingGauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N>,
{
    /// The integrator of `system` from `state`, whose first step has the length `h`, in units of time: it preserves the discrete energy of that
    /// step. So the energy differs by `C_s h^2s D_s` from H at the state.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is not positive and finite, or whose `C_s h^2s` is no number; [`StepError::NonFinite`] for such a state,
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
        if !power::<STAGES>(h).is_normal() {
            return Err(StepError::InvalidInput {
                input: "the step h",
                allowed: "so long that C h^2s is a number",
                value: h,
            });
        }
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

    /// The same with twice the largest `|D_s|` that fixed steps meet over `duration` from here, in units of time: a period of the motion, or a
    /// few. The steps are then within a factor of `3^(1/(2s+1))` of each other while the motion goes on as there. The fixed steps have the first
    /// length, halved until their energy holds to a hundredth of its terms.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a duration that is not positive and finite, or over which no fixed steps hold the energy;
    /// [`StepError::ShiftTooLarge`] for a first step that is too long for this shift; those of [`Gauss::step`] and of [`step_density`].
    pub fn with_shift_from(mut self, duration: f64) -> Result<Self, StepError> {
        check_step("the duration over which the step density is measured", duration)?;
        let mut h = self.course.h();
        for _ in 0..HALVINGS {
            if let Some(Met { density, scale, size }) = self.met_along(h, duration)? {
                let shift = 2.0 * density;
                self.stepper().check_shift(shift, scale)?;
                self.course.largest_size = self.course.largest_size.max(size);
                return self.with_shift(shift);
            }
            h *= 0.5;
        }
        let input = "the duration over which the step density is measured";
        Err(StepError::InvalidInput { input, allowed: "one over which fixed steps hold the energy", value: duration })
    }

    /// What fixed steps of the length h meet over `duration` from here; none where their energy does not hold.
    fn met_along(&self, h: f64, duration: f64) -> Result<Option<Met>, StepError> {
        let mut steps = Gauss::<_, N, STAGES>::new(self.gauss.system, self.state(), h)?;
        let end = self.state().t + duration;
        let density = |state: &State<N>| step_density::<S, N, STAGES>(self.system(), state).map(f64::abs);
        let mut before = Solver::energy_at(&steps, &steps.state())?;
        let mut met = Met { density: density(&steps.state())?, scale: 0.0, size: before.size };
        let mut kinetic = 0.0;
        let mut count = 0.0;
        let mut largest_missed = 0.0_f64;
        while steps.run.node.t < end {
            match steps.step() {
                Ok(_) => {}
                Err(StepError::StagesUnsettled { .. }) => return Ok(None),
                Err(failure) => return Err(failure),
            }
            let state = steps.state();
            let after = Solver::energy_at(&steps, &state)?;
            let of_step = energies(&steps.system, &steps.run.before, h, steps.run.stages.data.0, before.total);
            let missed = of_step.start.abs().max((of_step.end + (before.total - after.total)).abs());
            largest_missed = largest_missed.max(missed);
            met.size = met.size.max(after.size);
            met.density = met.density.max(density(&state)?);
            kinetic += after.size - after.total.abs();
            count += 1.0;
            met.scale = (kinetic / count).max(after.total.abs());
            before = after;
        }
        // The energy of a start from rest may be zero: what is missed is judged by the whole motion.
        Ok((largest_missed <= HELD * met.size).then_some(met))
    }
}

/// What a motion meets.
struct Met {
    /// The largest `|D_s|`.
    density: f64,
    /// The larger of the mean of `|v·p|` and of `|H|` at the end: whatever constant V has, one of them tells how large energies are.
    scale: f64,
    /// The largest `|v·p| + |H|`.
    size: f64,
}
