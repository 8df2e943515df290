//! The shift of the step density of energy-preserving steps of order 2s: options and results of their runs.

use super::Method;
use super::bounds::check_forward;
use super::preserving::{check_shift, energy_at, measured};
use crate::error::StepError;
use crate::gauss::history::StepHistory;
use crate::lagrangian::Lagrangian;
use crate::run::{Run, Starts};
use crate::state::State;

/// Most halvings of the step for the measurement of the step density.
const HALVINGS: u32 = 16;
/// Largest energy error of that measurement, relative to the terms of the energy.
const HELD: f64 = 0.01;

/// A method with step lengths that follow from the step density of s stages.
pub trait StepPower {
    /// `C_s h^2s`: `H − E` over the step density, for steps of the length h.
    fn power(h: f64) -> f64;
}

/// A method of order 2s whose steps preserve a discrete energy, which a shift D_* of the step density changes.
pub trait Shiftable<S, const N: usize>: Method<S, N> + StepPower {
    /// Fixed steps of the same order.
    type Fixed: Method<S, N>;
    /// The method of these steps.
    const FIXED: Self::Fixed;

    /// Lengths, energies and densities of the last steps.
    #[doc(hidden)]
    fn history(memory: &Self::Memory) -> &StepHistory;
    /// The same, mutably.
    #[doc(hidden)]
    fn history_mut(memory: &mut Self::Memory) -> &mut StepHistory;
    /// The step density D_s at a state.
    ///
    /// # Errors
    /// The reason why it has no value.
    fn step_density(system: &S, state: &State<N>) -> Result<f64, StepError>;
    /// The discrete energies E0 and E1 of the last step of a run, less `base`.
    #[doc(hidden)]
    fn energies(run: &Run<Self::Fixed, S, N>, base: f64) -> [f64; 2]
    where
        S: Lagrangian<N> + Copy;
}

/// Options and results that only such a run has.
impl<M, S, const N: usize> Run<M, S, N>
where
    M: Shiftable<S, N> + StepPower,
    S: Lagrangian<N> + Copy,
{
    /// Adds `shift`, in the units of the step density, to the step density of every step: a step exists while `D_s +
    /// shift` keeps its sign.
    ///
    /// The run preserves E' = E − C_s h^2s D_*, [`Run::shifted_energy`], to rounding. Momenta and the order stay. Zero
    /// means no shift. A larger shift makes the steps more uniform. The run clears an error of the last step. The
    /// length of the last or the first step stays.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a shift that is not finite.
    pub fn with_shift(mut self, shift: f64) -> Result<Self, StepError> {
        if !shift.is_finite() {
            let (input, allowed) = ("the shift of the step density", "finite");
            return Err(StepError::InvalidInput { input, allowed, value: shift });
        }
        let history = M::history_mut(&mut self.memory);
        let change = shift - history.shift;
        self.node.add_energy(-M::power(history.h()) * change);
        history.shift = shift;
        history.densities = history.densities.map(|densities| densities.map(|density| density + change));
        history.set_excess(measured(&self.system, &self.node)?);
        self.failure = None;
        Ok(self)
    }

    /// [`Run::with_shift`] with twice the largest `|D_s|` of fixed steps over `duration` from here, in units of time:
    /// one or a few periods.
    ///
    /// Step lengths then stay within a factor of `3^(1/(2s+1))` of each other as long as the motion does not change.
    /// The fixed steps have the first length, halved until their energy error is below a hundredth of the energy terms.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a duration that is not positive and finite, or over which no fixed steps
    /// preserve the energy; [`StepError::ShiftTooLarge`] if the first step is too long for this shift; those of fixed
    /// steps of the same order and of [`step_density`](crate::gauss::step_density).
    pub fn with_shift_from(self, duration: f64) -> Result<Self, StepError> {
        self.with_shift_from_while(duration, &mut || true)
    }

    /// [`Run::with_shift_from`], which asks `goes_on` before each step that it measures. Short steps over a long duration
    /// take hours: once `goes_on` is false, the measurement ends with the error of a duration without fixed steps that
    /// preserve the energy.
    ///
    /// # Errors
    /// The errors of [`Run::with_shift_from`].
    #[doc(hidden)]
    pub fn with_shift_from_while(
        mut self,
        duration: f64,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Self, StepError> {
        check_forward("the duration over which the step density is measured", duration)?;
        let mut h = M::history(&self.memory).h();
        for _ in 0..HALVINGS {
            if let Some(Maxima { density, scale, size }) = self.met_along(h, duration, goes_on)? {
                let shift = 2.0 * density;
                let history = M::history_mut(&mut self.memory);
                let first = history.h();
                check_shift(self.node.t, [first, M::power(first)], shift, scale, f64::from(self.method.facts().order))?;
                history.largest_size = history.largest_size.max(size);
                return self.with_shift(shift);
            }
            h *= 0.5;
        }
        let input = "the duration over which the step density is measured";
        Err(StepError::InvalidInput {
            input,
            allowed: "one over which fixed steps preserve the energy",
            value: duration,
        })
    }

    /// Maxima along fixed steps of the length h over `duration` from here; `None` if their energy error is too large, or
    /// if `goes_on` is false before one of them.
    fn met_along(&self, h: f64, duration: f64, goes_on: &mut dyn FnMut() -> bool) -> Result<Option<Maxima>, StepError> {
        let system = &self.system;
        let mut steps = Starts::at_state(*system, self.node.state()).integrate(M::FIXED, h)?;
        let end = self.node.t + duration;
        let density = |state: &State<N>| M::step_density(system, state).map(f64::abs);
        let mut before = energy_at(system, &steps.state())?;
        let mut met = Maxima { density: density(&steps.state())?, scale: 0.0, size: before.size };
        let mut kinetic = 0.0;
        let mut count = 0.0;
        let mut largest_missed = 0.0_f64;
        while steps.node.t < end {
            if !goes_on() {
                return Ok(None);
            }
            match steps.step() {
                Ok(_) => {}
                Err(StepError::StagesNotConverged { .. } | StepError::TooLong { .. }) => return Ok(None),
                // A constraint turns too far.
                Err(StepError::NotConverged { turn, .. }) if turn > 0.0 => return Ok(None),
                Err(failure) => return Err(failure),
            }
            let state = steps.state();
            let after = energy_at(system, &state)?;
            let [start, end] = M::energies(&steps, before.total);
            let missed = start.abs().max((end + (before.total - after.total)).abs());
            largest_missed = largest_missed.max(missed);
            met.size = met.size.max(after.size);
            met.density = met.density.max(density(&state)?);
            kinetic += after.size - after.total.abs();
            count += 1.0;
            met.scale = (kinetic / count).max(after.total.abs());
            before = after;
        }
        // The energy of a start from rest may be zero, so the whole trajectory sets the scale of the energy error.
        Ok((largest_missed <= HELD * met.size).then_some(met))
    }

    /// The preserved quantity, E' = E − C_s h^2s D_*; without a shift the discrete energy E. It changes only by the
    /// work of forces and moving constraints, and by an explicit time. During fixed steps it is the previous value plus
    /// the work done since.
    pub fn shifted_energy(&self) -> f64 {
        self.node.energy
    }

    /// The shift D_* of the step density.
    pub fn shift(&self) -> f64 {
        M::history(&self.memory).shift
    }

    /// Step density D_s of the last step, without the shift, from its energy: the mean of `H − E` at both ends over
    /// `C_s h^2s`. Before the first step, at its start.
    pub fn density(&self) -> f64 {
        let history = M::history(&self.memory);
        history.density().unwrap_or_else(|| history.excess / M::power(history.h())) - history.shift
    }
}

/// Maxima along a trajectory.
struct Maxima {
    /// The largest `|D_s|`.
    density: f64,
    /// The larger of the mean of `|v·p|` and of `|H|` at the end: one of them shows the size of the energies for any
    /// constant in V.
    scale: f64,
    /// The largest `|v·p| + |H|`.
    size: f64,
}
