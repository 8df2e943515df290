//! The variational integrator with a given step.
//!
//! In: a system, a state and the step h (negative: backwards in time). Out: an iterator of states. One step solves
//!
//! ```text
//! −D2 L_d − f_d⁻ = p0       for v, with q1 = q0 + h v and t1 = t0 + h
//!  p1 = D4 L_d + f_d⁺       as p0 plus its gain; for the midpoint rule p1 = p0 + h (L_q + f)
//! ```
//!
//! A linear step of a few degrees of freedom is one matrix (`closed_form`); where A does not change, v comes by one product with
//! its inverse. Else v is foretold from the last steps and one Newton step follows, trusted by what earlier steps taught
//! of its convergence (`stride`, `forecast`); sums are compensated. Where that does not do, Newton's iteration goes on to the rounding floor, every residual measured; and where it fails, v is followed
//! from the velocity that belongs to p by continuation in h. Beyond a certain h the equation has several roots: see
//! [`Branch`]. AFTER AN ERROR the integrator holds the last good state and keeps returning that error.

use crate::closed_form::ClosedForm;
use crate::continuation;
use crate::stride::{Inverse, Stride};
use crate::{Node, Real, Scalar, State, StepError, Stepping};
use core::hint::black_box;
use nalgebra::SVector;

/// The variational integrator with a given step; see the [module](self).
#[derive(Clone, Debug)]
pub struct FixedStep<S, const N: usize, T = f64>
where
    S: Stepping<N, T>,
    T: Real,
{
    system: S,
    /// The inverse of A, where it is the same in every step.
    inverse: Option<Inverse<S, N, T>>,
    /// The step as one matrix, where it is that.
    closed_form: Option<ClosedForm<N, T>>,
    run: Checkpoint<N, T>,
    failure: Option<StepError>,
    /// Whether no step is foretold: by the branch, or after a failure. One question before a step instead of two.
    is_sought: bool,
}

/// Which root of the momentum equation is a step, where it has several.
///
/// With `L = v·Mv/2 − V(q)` and the midpoint rule the derivative of the equation is `M + (h²/4) ∇²V`: the root is the only
/// one for `h < 2/√(−V''_min/m)`, and then this makes no difference. Beyond, roots appear and vanish in pairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Branch {
    /// The root that Newton's iteration reaches from the velocity of the last step, or extrapolated over the last ones. It
    /// depends on the steps before, and on nothing else.
    #[default]
    Nearest,
    /// The root that is connected with h = 0, where it is the velocity that belongs to p: it depends on the state alone.
    /// The step is followed in sixteen parts or more, at 20 to 40 times the effort. Where the branch ends before h,
    /// [`StepError::NotConverged`].
    Connected,
}

/// Everything that [`FixedStep`] carries but the system, to be stored and resumed bit for bit; see
/// [`energy_preserving::Checkpoint`](crate::energy_preserving::Checkpoint), which is the same for the other integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: crate::Real + serde::Serialize",
        deserialize = "T: crate::Real + serde::Deserialize<'de>"
    ))
)]
pub struct Checkpoint<const N: usize, T = f64> {
    node: Node<N, T>,
    stride: Stride<N, T>,
    /// Where the next stride evaluates L.
    place: SVector<T, N>,
    iterations: u32,
    branch: Branch,
}

impl<S, const N: usize, T> FixedStep<S, N, T>
where
    S: Stepping<N, T>,
    T: Scalar,
{
    /// The integrator of `system` from `state` with the step `h`, in units of time.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is zero or not finite, [`StepError::NonFinite`] for such a state,
    /// [`StepError::Singular`] or [`StepError::NotConverged`] where no velocity belongs to its momenta.
    pub fn new(system: S, state: State<N, T>, h: T) -> Result<Self, StepError> {
        check_step(h)?;
        let node = Node::new(state, T::zero());
        let v = state.velocity(&system)?;
        let stride = Stride::new(h, v);
        let run = Checkpoint { node, stride, place: node.q, iterations: 0, branch: Branch::Nearest };
        Ok(Self::prepared(system, run))
    }

    /// Which root to take where there are several; [`Branch::Nearest`] unless this is called.
    #[must_use]
    pub fn with_branch(mut self, branch: Branch) -> Self {
        self.run.branch = branch;
        Self::prepared(self.system, self.run)
    }

    /// Everything that the run carries: the node with its low parts, the step, and what the next guess is made of.
    pub fn checkpoint(&self) -> Checkpoint<N, T> {
        self.run
    }

    /// The run that was at `checkpoint`, bit for bit. The system must be the one that it was taken of, with the same
    /// parameters.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] and [`StepError::InvalidInput`] for a checkpoint that no run can have left.
    pub fn restart(system: S, checkpoint: Checkpoint<N, T>) -> Result<Self, StepError> {
        let Checkpoint { node, stride, .. } = &checkpoint;
        check_step(stride.h)?;
        let t = if node.t.to_f64().is_finite() { node.t } else { T::zero() };
        node.check_finite(t)?;
        if !(stride.forecast.is_finite() && checkpoint.place.iter().all(|entry| entry.is_finite())) {
            return Err(StepError::NonFinite { t: t.to_f64(), quantity: "last velocity", expression: None });
        }
        Ok(Self::prepared(system, checkpoint))
    }

    /// With what is the same in every step.
    fn prepared(system: S, run: Checkpoint<N, T>) -> Self {
        let Checkpoint { node, stride, branch, .. } = &run;
        let is_sought = *branch != Branch::Nearest;
        let inverse = stride.inverse(&system, node).filter(|_| *branch == Branch::Nearest);
        let closed_form = ClosedForm::of(&system, node, stride.h, inverse.as_ref());
        Self { system, inverse, closed_form, run, failure: None, is_sought }
    }

    /// Takes one step and returns the state reached.
    ///
    /// # Errors
    /// [`StepError::NotConverged`] where the momentum equation has no solution that can be reached, with the iterations
    /// spent; [`StepError::NonFinite`], [`StepError::Singular`]. The same error again after an error.
    #[inline]
    pub fn step(&mut self) -> Result<State<N, T>, StepError> {
        let Self { system, inverse, closed_form, run, is_sought, .. } = self;
        if *is_sought {
            if let Some(failure) = self.failure {
                return Err(failure);
            }
        } else if let Some(closed_form) = closed_form.as_ref().filter(|_| S::CLOSED_FORM) {
            let (h, (way, gain)) = (run.stride.h, closed_form.step(&run.node));
            if run.node.stays_finite(h, &way, &gain) {
                run.stride.forecast.replace(way * h.recip());
                run.node.advance(h, &way, &gain);
                return Ok(run.node.state());
            }
        } else if let Some(found) = run.stride.foretold(system, &run.node, run.place, inverse.as_ref()) {
            let (h, way) = (run.stride.h, found.v() * run.stride.h);
            if run.node.stays_finite(h, &way, &found.gain) {
                if let Some(place) = run.stride.place_after::<S>(&run.node, &found) {
                    run.place = place;
                }
                run.stride.take::<S>(&found);
                run.node.advance(h, &way, &found.gain);
                run.iterations = found.iterations;
                return Ok(run.node.state());
            }
        }
        // The rare path gets copies, so that a loop over steps may keep the run in registers; and each number for itself, since
        // the compiler joins those that it stores side by side, and then one waits for the other.
        let (run, outcome) = sought(self.system, self.run.apart());
        let run = run.apart();
        match outcome {
            // The rest is as it was, and known to be.
            Ok(()) => {
                let Checkpoint { node, stride, place, iterations, .. } = run;
                (self.run.node, self.run.place, self.run.iterations) = (node, place, iterations);
                self.run.stride.resume(stride);
            }
            Err(failure) => (self.failure, self.is_sought) = (Some(failure), true),
        }
        outcome.map(|()| self.run.node.state())
    }

    /// The state reached last.
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
        self.run.stride.h
    }

    /// Velocity of the last interval, `(q1 − q0)/h` without its cancellation; before the first step the velocity that
    /// belongs to the momenta.
    pub fn v(&self) -> SVector<T, N> {
        self.run.stride.forecast.newest()
    }

    /// Newton iterations of the last step.
    pub fn iterations(&self) -> u32 {
        self.run.iterations
    }

    /// Discrete energy of the last interval, `E1 = −D3 L_d − g_d⁺`; `None` before the first step.
    ///
    /// Evaluated from v inside the interval: from the stored nodes it would carry the cancellation of `(q1 − q0)/h`.
    pub fn discrete_energy(&self) -> Option<T> {
        let v = self.v();
        (!self.run.stride.forecast.is_new()).then(|| {
            let mut start = self.run.node;
            start.shift(-self.run.stride.h, &(v * -self.run.stride.h));
            let start = start.leaving(&self.system, self.run.stride.h, &v);
            start.energy + self.system.increment(&start, self.run.stride.h, &v).energy
        })
    }
}

impl<const N: usize, T: Scalar> Checkpoint<N, T> {
    /// The same, each number stored for itself: see the rare path of [`FixedStep::step`](crate::FixedStep::step).
    fn apart(self) -> Self {
        let Self { node, stride, place, iterations, branch } = self;
        Self { node: node.apart(), stride: stride.apart(), place: black_box(place), iterations, branch }
    }

    /// Takes a step that has to be sought.
    fn seek<S: Stepping<N, T>>(&mut self, system: &S) -> Result<(), StepError> {
        let t = self.node.t;
        let found = self.stride.seek(system, &self.node, self.branch)?;
        self.node.advance(self.stride.h, &(found.v() * self.stride.h), &found.gain);
        self.iterations = found.iterations;
        self.place = self.stride.place::<S>(&self.node);
        self.node.check_finite(t)
    }
}

/// The run after a step that has to be sought; or the error, with the expression that is not finite.
#[cold]
#[inline(never)]
fn sought<const N: usize, T: Scalar, S: Stepping<N, T>>(
    system: S,
    before: Checkpoint<N, T>,
) -> (Checkpoint<N, T>, Result<(), StepError>) {
    let mut run = before;
    let outcome = run.seek(&system);
    let v = before.stride.forecast.newest();
    (run, outcome.map_err(|failure| failure.explained(&system, &before.node, before.stride.h, &v)))
}

impl<S, const N: usize, T> Iterator for FixedStep<S, N, T>
where
    S: Stepping<N, T>,
    T: Scalar,
{
    type Item = Result<State<N, T>, StepError>;

    /// The next step; never `None`. After an error, the same error.
    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}

/// The velocity of one step of length h from a node, as [`FixedStep`] finds it by [`Branch::Nearest`]: from `guess`, or,
/// where Newton's iteration fails from there, by the continuation from `last`, the velocity of the step before.
///
/// # Errors
/// Those of [`FixedStep::step`].
#[cold]
pub fn velocity<const N: usize, T: Scalar, S: Stepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    h: T,
    guess: SVector<T, N>,
    last: SVector<T, N>,
) -> Result<SVector<T, N>, StepError> {
    continuation::nearest(system, node, h, guess, last)
        .map(|solution| solution.v)
        .map_err(|failure| failure.explained(system, node, h, &last))
}

/// A step must lead somewhere.
pub(crate) fn check_step<T: Scalar>(h: T) -> Result<(), StepError> {
    let value = h.to_f64();
    if value.is_finite() && value != 0.0 {
        Ok(())
    } else {
        Err(StepError::InvalidInput { input: "the step h", allowed: "finite and not zero", value })
    }
}
