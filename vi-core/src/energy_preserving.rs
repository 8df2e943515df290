//! The integrator that solves for its own step, so that the discrete energy is preserved.
//!
//! In: a system and the first interval. Out: an iterator of [`Step`]s. One step solves, in the unknowns `(v, h)` with
//! q1 = q0 + h v, t1 = t0 + h, h > 0,
//!
//! ```text
//! −D2 L_d − f_d⁻ = p0       p1 =  D4 L_d + f_d⁺
//!  D1 L_d + g_d⁻ = E0       E1 = −D3 L_d − g_d⁺
//! ```
//!
//! where p1 and E1 are carried as p0 and E0 plus their gains, every sum compensated. The pair `(v, −h)` of the last step
//! solves these equations always, and is no step.
//!
//! | file | part of a step |
//! |---|---|
//! | `starts` | the node and the interval that the first step follows |
//! | `predicted` | the root by one or a few Newton steps from v and h extrapolated over the last steps, measured |
//! | `guess` | else: v by extrapolation, h by the step law `h D^(1/3) = constant` |
//! | `newton` | the n + 1 equations to the rounding floor |
//! | `bracket` | where that fails: the smallest h > 0 that solves them, or the proof that there is none |
//! | `fallback` | what is done then: an error, or fixed steps until a step exists again |
//! | `checkpoint` | what a run carries, to be stored and resumed bit for bit |
//!
//! AFTER A STEP both residuals were measured at the (v, h) that was taken, and are at the rounding floor. AFTER AN ERROR the
//! integrator holds the last good state and keeps returning that error.

mod bracket;
mod checkpoint;
mod fallback;
mod guess;
mod newton;
mod predicted;
mod starts;

pub use checkpoint::{Checkpoint, Run};
pub use fallback::{Fallback, Switches};

use crate::called::Called;
use crate::condition::Condition;
use crate::error::StepError;
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::state::Method;
use crate::state::{State, Step};
use crate::stepping::{EnergyStepping, Increment};
use core::hint::black_box;
use nalgebra::SVector;
use newton::{Failure, Root, Trial};
use predicted::{Predicted, Predictors};

/// A step may be longer or shorter than the last one by this factor at most.
const RATIO: f64 = 3.0;

/// The interval that the next step follows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: crate::Real + serde::Serialize",
        deserialize = "T: crate::Real + serde::Deserialize<'de>"
    ))
)]
struct Last<const N: usize, T> {
    v: SVector<T, N>,
    h: T,
    /// Length of the interval before.
    previous: T,
    /// Step density D of the interval.
    density: T,
    /// Change of v since the interval before.
    change: SVector<T, N>,
}

impl<const N: usize, T: Real> Last<N, T> {
    /// Change of v by time, between the middles of the last two intervals.
    fn slope(&self) -> SVector<T, N> {
        self.change * (T::real(2.0) / (self.h + self.previous))
    }
}

/// The integrator that solves for its own step; see the [module](self).
#[derive(Clone, Debug)]
pub struct EnergyPreserving<S, const N: usize, T = f64> {
    system: S,
    run: Run<N, T>,
    failure: Option<StepError>,
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
            && let Some(predicted) = self.predicted(self.run.predictors.guess_highest())
        {
            let (node, last, step) = self.reached(&predicted);
            if node.is_finite() {
                self.run.predictors.push_common(&predicted);
                (self.run.node, self.run.last) = (node, last);
                return Ok(step);
            }
        }
        let (run, outcome) = uncommon(black_box(self.system), black_box(self.run));
        self.run = run;
        outcome.inspect_err(|failure| self.failure = Some(*failure))
    }

    /// The next step from a trial, where it has not to be searched.
    #[inline(always)]
    fn predicted(&self, trial: Trial<N, T>) -> Option<Predicted<N, T>> {
        let Self { system, run, .. } = self;
        let predicted = run.predictors.step(system, &run.node, &run.last, trial)?;
        let h = predicted.root.h;
        let allowed = run.bounds.as_ref().is_none_or(|bounds| bounds.admit(h)) && !self.runs_away(h);
        allowed.then_some(predicted)
    }

    /// Where a step leads that was predicted.
    #[inline(always)]
    fn reached(&self, predicted: &Predicted<N, T>) -> (Node<N, T>, Last<N, T>, Step<N, T>) {
        let Predicted { root, increment, .. } = predicted;
        self.run.reached::<S>(&self.run.node, root, increment, Method::EnergyPreserving)
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

    /// Discrete energy `E1 = −D3 L_d − g_d⁺` of the node reached last.
    pub fn energy(&self) -> T {
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

    /// Takes one step that is not the common one.
    fn advance(&mut self) -> Result<Step<N, T>, StepError> {
        if let Some(phase) = self.run.phase {
            return self.advance_in_phase(phase);
        }
        if !self.run.is_common()
            && let Some(predicted) = self.predicted(self.run.predictors.guess())
        {
            let (node, last, step) = self.reached(&predicted);
            node.check_finite(self.run.node.t)?;
            self.run.predictors.push(&predicted);
            (self.run.node, self.run.last) = (node, last);
            return Ok(step);
        }
        match self.root(&self.run.node) {
            Ok(root) if self.runs_away(root.h) => self.fall_back_from(root),
            Ok(root) => self.take(self.run.node, root, Method::EnergyPreserving),
            Err(failure) => self.fall_back(failure),
        }
    }

    /// Takes the step `root` from `start`.
    fn take(&mut self, start: Node<N, T>, root: Root<N, T>, method: Method<T>) -> Result<Step<N, T>, StepError> {
        let increment = self.system.extended_residual(&start, root.h, &root.v).increment;
        let (node, last, step) = self.run.reached::<S>(&start, &root, &increment, method);
        node.check_finite(start.t)?;
        match method {
            // A length that was given predicts none.
            Method::FixedStep => self.run.predictors = Predictors::new(root.v, root.h),
            _ => self.run.predictors.restart(&root),
        }
        (self.run.node, self.run.last) = (node, last);
        Ok(step)
    }

    /// The forward step from `node`, within the bounds.
    fn root(&self, node: &Node<N, T>) -> Result<Root<N, T>, StepError> {
        let Self { system, run: Run { last, .. }, .. } = self;
        let ratio = T::real(RATIO);
        let range = (last.h / ratio, last.h * ratio);
        // At the smallest root D has the sign that it had: past a change of sign lies another root.
        let forward = |root: &Root<N, T>| root.density.to_f64() * last.density.to_f64() > 0.0;
        let root = match newton::solve(system, node, guess::predict(system, node, last), range, &mut |_| ()) {
            Ok(root) if forward(&root) => root,
            Err(Failure::Degenerate { h, density }) => {
                let (t, h, density) = (node.t.to_f64(), h.to_f64(), density.to_f64());
                return Err(StepError::DegenerateStep { t, h, density });
            }
            _ => bracket::smallest_root(system, node, last)?,
        };
        match &self.run.bounds {
            Some(bounds) if !bounds.admit(root.h) => Err(bounds.refusal(node.t, root.h)),
            _ => Ok(root),
        }
    }
}

/// The run after a step that is not the common one, and the step; after an error the run as it was.
#[inline(never)]
fn uncommon<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: S,
    run: Run<N, T>,
) -> (Run<N, T>, Result<Step<N, T>, StepError>) {
    let mut integrator = EnergyPreserving { system: Called(system), run, failure: None };
    let outcome = integrator.advance();
    let Last { v, h, .. } = integrator.run.last;
    let explained = |failure: StepError| failure.explained(&system, &integrator.run.node, h, &v);
    (integrator.run, outcome.map_err(explained))
}

impl<const N: usize, T: Real> Run<N, T> {
    /// The node and the interval after the step `root` from `start`, and the step.
    #[inline]
    fn reached<S: EnergyStepping<N, T>>(
        &self,
        start: &Node<N, T>,
        root: &Root<N, T>,
        increment: &Increment<N, T>,
        method: Method<T>,
    ) -> (Node<N, T>, Last<N, T>, Step<N, T>) {
        let Root { v, h, density, iterations, residual, .. } = *root;
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
        let last = Last { v, h, previous: last.h, density, change: v - last.v };
        (node, last, step)
    }
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
