//! Energy-preserving steps of order 2S: the stages of a Gauss step and its length, from the momenta and the energy at its start.
//!
//! In: a system, a state with a first length h, and the number of stages S = 1, 2 or 3. Out: an iterator of states. One step solves, in the
//! stages and h > 0,
//!
//! ```text
//! Q_i = q0 + h Σ a_ij V_j        L_v(T_i, Q_i, V_i) = p0 + h Σ a_ij (L_q + f)_j        E0(h) = E
//! E0(h) = Σ b_i En_i − h Σ b_i (1 − c_i) (f·v − L_t)_i        E ← E + h Σ b_i (f·v − L_t)_i
//! ```
//!
//! so that the discrete energy of every step is that of the first one, and the work done since. Its length follows from
//! `H − E0(h) = C_s h^2s D_s`, D_s the step density (`density`): `h D_s^(1/(2s+1))` is constant up to O(h²) without force, and a step exists
//! while D_s keeps its sign. A shift D_* adds `C_s D_* h^(2s+1)/(2s+1)` to L_d: then D_s + D_* has to keep its sign, and what is kept is
//!
//! ```text
//! E' = E − C_s h^2s D_*
//! ```
//!
//! The unknown is ln h, in which `ln[(H − E0(h))/(H − E)]` is nearly a line of slope 2s, and the last step backwards, which solves the
//! equations too, does not exist. Stages are solved by what solves those of [`Gauss`].
//!
//! | file | part of a step |
//! |---|---|
//! | `stepper` | the step to the next node, of some length and of the right one |
//! | `solver` | what it asks of a system |
//! | `trial` | a step of some length: its energy, and what its stages tell of others |
//! | `root` | the length: by secants from the lengths before |
//! | `search` | else the smallest length, by its bracket; or why there is none |
//! | `fallback` | what is done then: an error, or fixed steps until a step exists again |
//! | `starts` | the first energy, and the shift |
//! | `run` | what a run carries, to be stored and resumed bit for bit |
//! | `integrator` | what it shares with the other integrators |
//! | `density` | the step density of order 2s |
//!
//! AFTER A STEP its stages and its energy were measured at the numbers that were taken, and are at the rounding floor. AFTER AN ERROR the
//! integrator holds the last good state and keeps returning that error. Theory and measurements: `docs/theory.md`.

mod density;
mod fallback;
mod integrator;
mod root;
mod run;
mod search;
mod solver;
mod starts;
mod stepper;
mod trial;

pub use density::step_density;
pub use run::{Checkpoint, Run};

use super::Gauss;
use crate::collocation::Collocation;
use crate::energy_preserving::fallback::{Phase, StepBounds};
use crate::energy_preserving::{Fallback, Switches};
use crate::error::StepError;
use crate::state::{Method, State};
use crate::stepping::Convertible;
use density::power;
use run::Course;
use stepper::Stepper;

/// Energy-preserving steps of order 2 STAGES; see the [module](self).
#[derive(Clone, Debug)]
pub struct EnergyPreservingGauss<S, const N: usize, const STAGES: usize> {
    /// Solves the stages; its node carries the energy to preserve.
    gauss: Gauss<S, N, STAGES>,
    course: Course,
    failure: Option<StepError>,
}

impl<S, const N: usize, const STAGES: usize> EnergyPreservingGauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N>,
{
    /// Takes one step and returns the state reached.
    ///
    /// # Errors
    /// [`StepError::NoForwardGaussStep`] where no step exists, [`StepError::StepRatio`] where the only one is beyond a factor of 3 of the last,
    /// [`StepError::StepBounds`] where it is outside the bounds, [`StepError::DegenerateStep`] where `H − E` is too small to tell a length;
    /// instead of these a fixed step with [`Fallback::FixedSteps`]. [`StepError::StagesUnsettled`], [`StepError::NotConverged`],
    /// [`StepError::Singular`], [`StepError::NonFinite`]. The same error again after an error.
    pub fn step(&mut self) -> Result<State<N>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        match self.stepper().advance() {
            Ok(()) => Ok(self.state()),
            Err(failure) => {
                self.failure = Some(failure);
                Err(failure)
            }
        }
    }

    /// What to do where no energy-preserving step exists; [`Fallback::Stop`] unless this is called.
    ///
    /// With [`Fallback::FixedSteps`] the errors [`StepError::NoForwardGaussStep`], [`StepError::DegenerateStep`],
    /// [`StepError::StepRatio`], [`StepError::StepBounds`], [`StepError::NotConverged`] and [`StepError::StagesUnsettled`] do not end the run: it
    /// goes on with fixed steps while D_s has lost its sign or the step law asks for longer ones. A step longer than the last by more than a
    /// factor of 1.5 is not taken either: D_s is about to vanish. [`EnergyPreservingGauss::method`] says how the last step was taken, and
    /// [`EnergyPreservingGauss::switches`] what it cost.
    #[must_use]
    pub fn with_fallback(mut self, fallback: Fallback) -> Self {
        self.course.fallback = fallback;
        self
    }

    /// Steps shorter than `h_min` or longer than `h_max`, in units of time, are refused with [`StepError::StepBounds`], or, with the
    /// fallback, replaced by fixed steps of the bound. `h_min = 0` bounds from above alone.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] unless `0 ≤ h_min ≤ h_max`, with `h_max` positive and finite.
    pub fn with_step_bounds(mut self, h_min: f64, h_max: f64) -> Result<Self, StepError> {
        let bounds = StepBounds { h_min, h_max };
        bounds.check()?;
        self.course.bounds = Some(bounds);
        Ok(self)
    }

    /// The state reached last.
    pub fn state(&self) -> State<N> {
        self.gauss.run.node.state()
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.gauss.system
    }

    /// Length of the last step, in units of time; before the first step the length it was given.
    pub fn h(&self) -> f64 {
        self.course.h()
    }

    /// What is kept, E' = E − C_s h^2s D_*: without a shift the discrete energy E. It changes by the work of forces and by an explicit time
    /// alone. During fixed steps it is what was kept before them, with the work done since.
    pub fn shifted_energy(&self) -> f64 {
        self.gauss.run.node.energy
    }

    /// Discrete energy `E = −D3 L_d − g_d⁺` of the last step without the shift, in the units of L. H at the node is
    /// [`State::energy`].
    pub fn discrete_energy(&self) -> f64 {
        let gap = self.course.phase.map_or(0.0, |phase| phase.gap);
        self.shifted_energy() + gap + power::<STAGES>(self.course.h()) * self.course.shift
    }

    /// The shift D_* of the step density.
    pub fn shift(&self) -> f64 {
        self.course.shift
    }

    /// Step density D_s of the last step, without the shift, as its energy tells it: the mean of `H − E` at both ends, by `C_s h^2s`. Before
    /// the first step, of its start.
    pub fn density(&self) -> f64 {
        self.course.told_density::<STAGES>() - self.course.shift
    }

    /// What the last step leaves of its equations, in roundings: of the coordinates at its stages, and of the terms of its energy. Zero
    /// before the first step.
    pub fn residual(&self) -> f64 {
        self.gauss.residual().max(self.course.residual)
    }

    /// Sweeps over the stages that the last step took, over all lengths that were tried.
    pub fn iterations(&self) -> u32 {
        self.gauss.iterations()
    }

    /// How the last step was taken.
    pub fn method(&self) -> Method {
        self.course.method
    }

    /// How often the run has changed its method, and what that cost.
    pub fn switches(&self) -> Switches {
        self.course.switches
    }

    /// The run on its way to the next node.
    fn stepper(&mut self) -> Stepper<'_, N, STAGES> {
        Stepper { gauss: &mut self.gauss, course: &mut self.course }
    }
}

impl<S, const N: usize, const STAGES: usize> Iterator for EnergyPreservingGauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N>,
{
    type Item = Result<State<N>, StepError>;

    /// The next step; never `None`. After an error, the same error.
    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}
