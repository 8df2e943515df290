//! The energy-preserving integrator.
//!
//! In: a system and a run. Out: step after step. The common step is predicted and inlined into the caller's loop; every other step is
//! a call that is given a copy of the run.

use super::fallback::{Fallback, StepBounds, Switches, check_step};
use super::interval::Last;
use super::predicted::Predicted;
use super::run::Run;
use crate::called::Called;
use crate::condition::Condition;
use crate::error::StepError;
use crate::node::Node;
use crate::real::Scalar;
use crate::state::{Method, State, Step};
use crate::stepping::EnergyStepping;
use nalgebra::SVector;

/// The integrator that solves for its own step; see the [module](crate::energy_preserving).
#[derive(Clone, Debug)]
pub struct EnergyPreserving<S, const N: usize, T = f64> {
    pub(super) system: S,
    pub(super) run: Run<N, T>,
    pub(super) failure: Option<StepError>,
}

impl<S, const N: usize, T> EnergyPreserving<S, N, T>
where
    S: EnergyStepping<N, T>,
    T: Scalar,
{
    /// Takes one step and returns it.
    ///
    /// # Errors
    /// [`StepError::NoForwardStep`] where no step exists, [`StepError::StepRatio`] where the only one is beyond a factor
    /// of 3 of the last, [`StepError::StepBounds`] where it is outside the bounds, [`StepError::DegenerateStep`] where
    /// every length would do; instead of these a fixed step with [`Fallback::FixedSteps`].
    /// [`StepError::NotConverged`], [`StepError::Singular`], [`StepError::NonFinite`]. The same error again after an error.
    #[inline(always)]
    pub fn step(&mut self) -> Result<Step<N, T>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        if self.run.is_common()
            && let Some(predicted) = self.run.predicted(&self.system, self.run.prediction.guess_highest())
        {
            let Predicted { step, increment, .. } = &predicted;
            let (node, last, step) = self.run.reached::<S>(&self.run.node, step, increment, Method::EnergyPreserving);
            if node.is_finite() {
                self.run.prediction.push_common(&predicted);
                (self.run.node, self.run.last) = (node, last);
                return Ok(step);
            }
        }
        let (run, outcome) = uncommon(self.system, self.run);
        self.run = run;
        outcome.inspect_err(|failure| self.failure = Some(*failure))
    }

    /// Takes one step of the length `h`, in units of time, that solves the momentum equation alone; the energy to preserve stays, with the work
    /// done. The next step follows as if the last one had its own length.
    ///
    /// # Errors
    /// Those of a fixed step: [`StepError::NotConverged`], [`StepError::Singular`], [`StepError::NonFinite`], and [`StepError::InvalidInput`]
    /// for an h that is not positive, or subnormal. The run is then what it was, and may go on.
    pub fn step_of(&mut self, h: T) -> Result<Step<N, T>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        check_step("the step h", h)?;
        let mut run = self.run;
        let step = run.step_of(&Called(self.system), h);
        let Last { h, v, .. } = self.run.last;
        let step = step.map_err(|failure| failure.explained(&self.system, &self.run.node, h, &v))?;
        self.run = run;
        Ok(step)
    }

    /// What to do where no energy-preserving step exists; [`Fallback::Stop`] unless this is called.
    ///
    /// With [`Fallback::FixedSteps`] the errors [`StepError::NoForwardStep`], [`StepError::DegenerateStep`],
    /// [`StepError::StepRatio`], [`StepError::StepBounds`] and [`StepError::NotConverged`] do not end the run: it goes on
    /// with fixed steps while D has lost its sign or the step law asks for longer ones. Then it preserves the energy that
    /// it had before, or, where no step has that energy, the discrete energy of the last fixed interval. A step longer
    /// than the last by more than a factor of 1.5 is not taken either: D is about to vanish. Each [`Step`] says which
    /// method took it, and [`EnergyPreserving::switches`] what it cost.
    #[must_use]
    pub fn with_fallback(mut self, fallback: Fallback) -> Self {
        self.run.fallback = fallback;
        self
    }

    /// Steps shorter than `h_min` or longer than `h_max`, in units of time, are refused with [`StepError::StepBounds`],
    /// or, with the fallback, replaced by fixed steps of the bound. `h_min = 0` bounds from above alone.
    ///
    /// The first step follows an interval of its own length h0 and differs from it by a factor of 3 at most: bounds that
    /// leave no such step end the run at once.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] unless `0 ≤ h_min ≤ h_max`, with `h_max` positive and finite.
    pub fn with_step_bounds(mut self, h_min: T, h_max: T) -> Result<Self, StepError> {
        let bounds = StepBounds { h_min, h_max };
        bounds.check()?;
        self.run.bounds = Some(bounds);
        Ok(self)
    }

    /// What the run does where no step exists.
    pub(crate) fn fallback(&self) -> Fallback {
        self.run.fallback
    }

    /// Whether the last interval is a step, taken with the parameters that the system has.
    pub(crate) fn has_parameters_of_last(&self) -> bool {
        self.run.last.is_step
    }

    /// How often the run has changed its method, and what that cost.
    pub fn switches(&self) -> Switches<T> {
        self.run.switches
    }

    /// The state reached last.
    #[inline]
    pub fn state(&self) -> State<N, T> {
        self.run.node.state()
    }

    /// The node reached last: the state and the discrete energy with the low parts of their sums. During fixed steps its
    /// energy is the one that was preserved before them, with the work done since.
    pub fn node(&self) -> &Node<N, T> {
        &self.run.node
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Discrete energy `E1 = −D3 L_d − g_d⁺` of the node reached last. The energy at the node, H, is that of [`State::energy`].
    pub fn discrete_energy(&self) -> T {
        match &self.run.phase {
            None => self.run.node.energy,
            Some(phase) => phase.energy(&self.run.node),
        }
    }

    /// Length of the last step, in units of time.
    pub fn h(&self) -> T {
        self.run.last.h
    }

    /// Velocity of the last interval, `(q1 − q0)/h` without its cancellation.
    pub fn v(&self) -> SVector<T, N> {
        self.run.last.v
    }

    /// Step density D of the last interval.
    pub fn density(&self) -> T {
        self.run.last.density
    }

    /// Condition numbers of the equations that the last step solved. Allocates.
    pub fn condition(&self) -> Condition {
        let Last { v, h, previous, .. } = &self.run.last;
        let mut start = self.run.node;
        start.shift(-*h, v);
        Condition::of(&self.system.extended_system(&start, *h, v), *h, v, *previous)
    }
}

/// The run after a step that is not the common one, and the step; after an error the run as it was.
#[inline(never)]
fn uncommon<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: S,
    before: Run<N, T>,
) -> (Run<N, T>, Result<Step<N, T>, StepError>) {
    let mut run = before;
    let outcome = run.advance(&Called(system));
    let Last { v, h, .. } = run.last;
    let explained = |failure: StepError| failure.explained(&system, &run.node, h, &v);
    (run, outcome.map_err(explained))
}

impl<S, const N: usize, T> Iterator for EnergyPreserving<S, N, T>
where
    S: EnergyStepping<N, T>,
    T: Scalar,
{
    type Item = Result<Step<N, T>, StepError>;

    /// The next step; never `None`. After an error, the same error.
    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}
