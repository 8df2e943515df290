//! The variational integrator with a given step.
//!
//! In: a system, a state and the step h (negative: backwards in time). Out: an iterator of states. One step solves
//!
//! ```text
//! −D2 L_d − f_d⁻ = p0       for v, with q1 = q0 + h v and t1 = t0 + h
//!  p1 = D4 L_d + f_d⁺       as p0 plus its gain; for the midpoint rule p1 = p0 + h (L_q + f)
//! ```
//!
//! v is predicted from the last steps, corrected, and its residual measured (`momentum::steps`); a linear step of a few degrees of
//! freedom is one matrix; sums are compensated. Where that does not do, Newton's iteration goes on to the rounding floor; and where
//! it fails, v is followed from the velocity that belongs to p by continuation in h. Beyond a certain h the equation has several
//! roots: see [`Branch`]. AFTER A STEP its residual was measured at the v that was taken, and is at the rounding floor. AFTER AN
//! ERROR the integrator holds the last good state and keeps returning that error.
//!
//! q and p are carried with what rounding takes from them, so that an increment below an ulp of theirs is not lost, only later seen.

use crate::called::Called;
use crate::checkpoint;
use crate::error::StepError;
use crate::integrator::{Hermite, Integrator, changed, own};
use crate::momentum::steps::{Corrector, Steps};
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::state::State;
use crate::stepping::FixedStepping;
use core::hint::black_box;
use nalgebra::SVector;

/// The variational integrator with a given step; see the [module](self).
#[derive(Clone, Debug)]
pub struct FixedStep<S, const N: usize, T = f64>
where
    S: FixedStepping<N, T>,
    T: Real,
{
    system: S,
    corrector: Corrector<S::Jacobian, N, T>,
    run: Run<N, T>,
    failure: Option<StepError>,
    /// Whether a step is not predicted: by the branch, or after a failure. One question before a step instead of two.
    is_searched: bool,
}

pub use crate::branch::Branch;

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
    node: Node<N, T>,
    steps: Steps<N, T>,
    iterations: u32,
    branch: Branch,
}

/// Everything that a run of [`FixedStep`] carries, to be stored and resumed bit for bit.
pub type Checkpoint<const N: usize, T = f64> = checkpoint::Checkpoint<Run<N, T>, T>;

impl<S, const N: usize, T> FixedStep<S, N, T>
where
    S: FixedStepping<N, T>,
    T: Scalar,
{
    /// The integrator of `system` from `state` with the step `h`, in units of time.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite, [`StepError::NonFinite`] for such a state,
    /// [`StepError::Singular`] or [`StepError::NotConverged`] where no velocity belongs to its momenta.
    pub fn new(system: S, state: State<N, T>, h: T) -> Result<Self, StepError> {
        check_step(h)?;
        let steps = Steps::new(h, state.velocity(&system)?);
        let node = Node::new(state, T::zero());
        Ok(Self::prepared(system, Run { node, steps, iterations: 0, branch: Branch::Nearest }))
    }

    /// Which root to take where there are several; [`Branch::Nearest`] unless this is called.
    #[must_use]
    pub fn with_branch(mut self, branch: Branch) -> Self {
        self.run.branch = branch;
        Self::prepared(self.system, self.run)
    }

    /// Everything that the run carries: the node with its low parts, the step, what the next guess is made of; and of which
    /// system with which parameters. Allocates.
    pub fn checkpoint(&self) -> Checkpoint<N, T> {
        checkpoint::Checkpoint::of(&self.system, S::RULE, self.run)
    }

    /// The run that was at `checkpoint`, bit for bit.
    ///
    /// # Errors
    /// [`StepError::OtherSystem`] for a checkpoint of another system or of other parameters; [`StepError::NonFinite`] and
    /// [`StepError::InvalidInput`] for one that no run can have left.
    pub fn restart(system: S, checkpoint: Checkpoint<N, T>) -> Result<Self, StepError> {
        let run = checkpoint.run_of(&system, S::RULE)?;
        let Run { node, steps, .. } = &run;
        check_step(steps.h)?;
        let t = if node.t.to_f64().is_finite() { node.t } else { T::zero() };
        node.check_finite(t)?;
        if !steps.is_finite() {
            return Err(StepError::NonFinite { t: t.to_f64(), quantity: "last velocity", expression: None });
        }
        Ok(Self::prepared(system, run))
    }

    /// With what is the same in every step.
    fn prepared(system: S, run: Run<N, T>) -> Self {
        let corrector = Corrector::of(&Called(system), run.steps.h);
        let is_searched = run.branch != Branch::Nearest;
        Self { system, corrector, run, failure: None, is_searched }
    }

    /// Takes one step and returns the state reached.
    ///
    /// # Errors
    /// [`StepError::NotConverged`] where the momentum equation has no solution that can be reached, with the iterations
    /// spent; [`StepError::NonFinite`], [`StepError::Singular`]. The same error again after an error.
    #[inline(always)]
    pub fn step(&mut self) -> Result<State<N, T>, StepError> {
        let Self { system, corrector, run, is_searched, .. } = self;
        if run.steps.is_common::<S>()
            && !*is_searched
            && let Some(solved) = run.steps.common(system, &run.node, corrector)
        {
            let h = run.steps.h;
            if run.node.stays_finite(h, &solved.v, &solved.increment) {
                run.steps.push_common(&solved);
                run.node.advance(h, &solved.v, &solved.increment);
                run.iterations = solved.iterations;
                return Ok(run.node.state());
            }
        }
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        let (run, outcome) = uncommon(self.system, self.corrector, self.run.apart());
        let run = run.apart();
        match outcome {
            Ok(()) => self.run = run,
            Err(failure) => (self.failure, self.is_searched) = (Some(failure), true),
        }
        outcome.map(|()| self.run.node.state())
    }

    /// Takes one step of the length `h` instead of the next one; the step of the run stays.
    ///
    /// # Errors
    /// As [`FixedStep::step`], and [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite; the run is then what it was, and
    /// may go on.
    pub fn step_of(&mut self, h: T) -> Result<State<N, T>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        check_step(h)?;
        let steps = self.run.steps.with_length(h);
        let mut aside = Self::prepared(self.system, Run { steps, ..self.run });
        let state = aside.step()?;
        self.run = Run { steps: aside.run.steps.with_length(self.h()), ..aside.run };
        Ok(state)
    }

    /// The state reached last.
    #[inline]
    pub fn state(&self) -> State<N, T> {
        self.run.node.state()
    }

    /// The node reached last: the state with the low parts of its sums. Its energy has no meaning here; see
    /// [`FixedStep::discrete_energy`].
    pub fn node(&self) -> &Node<N, T> {
        &self.run.node
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The step, in units of time.
    pub fn h(&self) -> T {
        self.run.steps.h
    }

    /// Whether the last step was taken with the parameters that the system has.
    pub(crate) fn has_parameters_of_last(&self) -> bool {
        self.run.steps.has_parameters_of_last()
    }

    /// Velocity of the last interval, `(q1 − q0)/h` without its cancellation; before the first step the velocity that
    /// belongs to the momenta.
    pub fn v(&self) -> SVector<T, N> {
        self.run.steps.v()
    }

    /// Largest residual of the last step, measured at the v that was taken, in roundings: one is an ulp of what the row is a sum
    /// of. Zero before the first step.
    pub fn residual(&self) -> f64 {
        self.run.steps.measured().roundings()
    }

    /// Newton iterations of the last step.
    pub fn iterations(&self) -> u32 {
        self.run.iterations
    }

    /// Discrete energy of the last interval, `E1 = −D3 L_d − g_d⁺`; `None` before the first step, and where it is not finite: forces
    /// may be finite where L is not.
    ///
    /// Evaluated from v inside the interval: from the stored nodes it would carry the cancellation of `(q1 − q0)/h`.
    pub fn discrete_energy(&self) -> Option<T> {
        let v = self.v();
        let energy = (!self.run.steps.is_new()).then(|| {
            let mut start = self.run.node;
            start.shift(-self.run.steps.h, &v);
            self.system.discrete_energy(&start, self.run.steps.h, &v)
        });
        energy.filter(|energy| energy.is_finite())
    }
}

impl<S, const N: usize> Integrator<N> for FixedStep<S, N>
where
    S: FixedStepping<N>,
{
    type System = S;
    type Path = Hermite<N>;
    type Checkpoint = Checkpoint<N>;

    const LONGEST: f64 = 1.0;

    own!(step, step_of, node, system, h, discrete_energy, checkpoint);

    fn set_parameters(&mut self, change: impl FnOnce(&mut S)) -> Result<(), StepError> {
        let system = changed(&self.system, change)?;
        self.state().velocity(&system)?;
        let steps = self.run.steps.with_other_parameters();
        *self = Self::prepared(system, Run { steps, ..self.run });
        Ok(())
    }

    fn set_state(&mut self, state: State<N>) -> Result<(), StepError> {
        *self = Self::new(self.system, state, self.h())?.with_branch(self.run.branch);
        Ok(())
    }

    fn path(&self, before: &State<N>) -> Result<Hermite<N>, StepError> {
        Hermite::between(&self.system, before, &self.state(), self.h())
    }

    fn set_time(&mut self, t: f64) {
        self.run.node.set_time(t);
    }
}

impl<const N: usize, T: Scalar> Run<N, T> {
    /// The same run, in memory of its own.
    ///
    /// The rare path is lent copies of a run and gives one back, so that a loop over steps may keep its own in registers. But copies
    /// of many numbers at once tie a run to memory, where it is loaded two numbers at a time that were stored one by one, and each step waits for
    /// that. So each number is copied for itself. Measured: the double well takes 33 ns without this and 23 with it, the oscillator 22 and 9.
    fn apart(self) -> Self {
        let Self { node, steps, iterations, branch } = self;
        Self { node: node.map(black_box), steps: steps.map(black_box), iterations, branch }
    }

    /// Takes a step that is not the common one.
    fn take<S: FixedStepping<N, T>>(
        &mut self,
        system: &S,
        corrector: &Corrector<S::Jacobian, N, T>,
    ) -> Result<(), StepError> {
        let (t, h) = (self.node.t, self.steps.h);
        // A common step that was not at the floor has been corrected as often as it is worth.
        let is_corrected = self.steps.is_common::<S>() && !S::CLOSED_FORM;
        let is_searched = is_corrected || self.branch != Branch::Nearest;
        let corrected =
            if is_searched { None } else { self.steps.corrected(system, &self.node, corrector, self.steps.guess()) };
        let solved = match corrected {
            Some(solved) => solved,
            None => self.steps.searched(system, &self.node, self.branch)?,
        };
        self.node.advance(h, &solved.v, &solved.increment);
        self.node.check_finite(t)?;
        self.steps.push(&solved);
        self.iterations = solved.iterations;
        Ok(())
    }
}

/// The run after a step that is not the common one; or the error, with the expression that is not finite.
#[inline(never)]
fn uncommon<const N: usize, T: Scalar, S: FixedStepping<N, T>>(
    system: S,
    corrector: Corrector<S::Jacobian, N, T>,
    before: Run<N, T>,
) -> (Run<N, T>, Result<(), StepError>) {
    let mut run = before;
    let outcome = run.take(&Called(system), &corrector);
    let v = before.steps.v();
    (run, outcome.map_err(|failure| failure.explained(&system, &before.node, before.steps.h, &v)))
}

impl<S, const N: usize, T> Iterator for FixedStep<S, N, T>
where
    S: FixedStepping<N, T>,
    T: Scalar,
{
    type Item = Result<State<N, T>, StepError>;

    /// The next step; never `None`. After an error, the same error.
    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}

/// A step must lead somewhere: a subnormal h has no quotients.
///
/// # Errors
/// [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite.
#[doc(hidden)]
pub fn check_step<T: Scalar>(h: T) -> Result<(), StepError> {
    let value = h.to_f64();
    if value.is_normal() {
        Ok(())
    } else {
        Err(StepError::InvalidInput { input: "the step h", allowed: "finite, not zero and not subnormal", value })
    }
}
