//! Fixed steps of order 2 by a rule of the system.
//!
//! One step solves
//!
//! ```text
//! −D2 L_d − f_d⁻ = p0       for v, with q1 = q0 + h v and t1 = t0 + h
//!  p1 = D4 L_d + f_d⁺       as p0 plus its increment; for the midpoint rule p1 = p0 + h (L_q + f)
//! ```
//!
//! `momentum::steps` extrapolates v from the last steps, corrects it and evaluates the residual. A linear step of a few
//! coordinates is one matrix product. If this does not reach the rounding floor, Newton iteration continues. If that
//! fails, continuation in h follows v from the velocity of p. Every accepted v satisfies the equation to rounding.
//!
//! Beyond a certain h the equation has several roots. Both methods take the one that is connected with h = 0, or return
//! [`StepError::TooLong`] if its branch turns back before h. [`FixedStep`] checks a root that few corrections of an
//! extrapolated velocity do not reach; [`Connected`] follows the branch in every step. With `L = v·Mv/2 − V(q)`
//! and the midpoint rule the Jacobian is `M + (h²/4) ∇²V`, and the root is unique for `h < 2/√(−V''_min/m)`. Beyond,
//! roots appear and vanish in pairs.

use super::{Change, Facts, Memory, Method, Problem, Status};
use crate::branch::Branch;
use crate::called::Called;
use crate::error::StepError;
use crate::momentum::continuation;
use crate::momentum::steps::{Corrector, MomentumStep, Steps};
use crate::node::Node;
use crate::real::Scalar;
use crate::run::{Hermite, Run};
use crate::state::State;
use crate::stepping::FixedStepping;
use core::hint::black_box;
use nalgebra::SVector;

/// Fixed steps of order 2 by the rule of the system. See the [module](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FixedStep;

/// Fixed steps of order 2 on the branch that is connected with h = 0: [`FixedStep::connected`].
///
/// A step depends on the state alone. It costs 20 to 40 times as much as one of [`FixedStep`], in sixteen parts or
/// more. If the branch turns back before h, the step returns [`StepError::TooLong`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Connected;

impl FixedStep {
    /// Fixed steps on the branch that is connected with h = 0.
    #[must_use]
    pub fn connected(self) -> Connected {
        Connected
    }
}

/// Memory of fixed steps: the last velocities, and the residual of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: crate::real::Real + serde::Serialize",
        deserialize = "T: crate::real::Real + serde::Deserialize<'de>"
    ))
)]
pub struct Velocities<const N: usize, T = f64> {
    pub(crate) steps: Steps<N, T>,
    iterations: u32,
}

impl<const N: usize, T: Scalar> Memory for Velocities<N, T> {
    #[inline(always)]
    fn apart(&self) -> Self {
        Self { steps: self.steps.apart(), iterations: black_box(self.iterations) }
    }
}

/// A solved step.
#[derive(Clone, Copy, Debug)]
pub struct FixedSolution<const N: usize, T = f64> {
    solved: MomentumStep<N, T>,
    /// A constant at inlined call sites, so that the compiler sees that only the newest velocity changes.
    is_common: bool,
}

/// The functions of [`Method`] that only use the memory: they are the same for both methods.
macro_rules! velocities {
    () => {
        type Memory = Velocities<N, T>;
        type Cache = ();
        type Step = FixedSolution<N, T>;
        type Left = ();
        type DenseOutput = Hermite<N, T>;

        fn facts(&self) -> Facts {
            Facts { rule: S::RULE, ..Facts::of_order(2) }
        }

        #[inline(always)]
        fn take(
            &self,
            _system: &S,
            h: T,
            (node, memory): (&mut Node<N, T>, &mut Velocities<N, T>),
            (): &mut (),
            step: FixedSolution<N, T>,
        ) {
            take(h, node, memory, &step);
        }

        fn restarted(
            &self,
            system: &S,
            change: &Change<'_, S, N, T>,
            node: &mut Node<N, T>,
            h: T,
            memory: &Velocities<N, T>,
        ) -> Result<Velocities<N, T>, StepError> {
            if let Change::NewState(..) = change {
                return change.begun(self, system, node, h);
            }
            continuation::check_linear(&Called(*system), node, h)?;
            let steps = match change {
                Change::NewLength => memory.steps.with_length(h),
                _ => {
                    node.state().velocity(system)?;
                    memory.steps.with_other_parameters()
                }
            };
            Ok(Velocities { steps, ..*memory })
        }

        fn dense_output(
            &self,
            system: &S,
            before: &State<N, T>,
            node: &Node<N, T>,
            h: T,
            _memory: &Velocities<N, T>,
        ) -> Result<Hermite<N, T>, StepError> {
            Hermite::between(system, before, &node.state(), h)
        }

        fn status(&self, h: T, memory: &Velocities<N, T>) -> Status<T> {
            let Velocities { steps, iterations } = memory;
            Status { residual: steps.measured().roundings(), iterations: *iterations, ..Status::of_length(h) }
        }

        fn discrete_energy(&self, system: &S, node: &Node<N, T>, h: T, memory: &Velocities<N, T>) -> Option<T> {
            memory.discrete_energy(system, node, h)
        }

        fn check(&self, _system: &S, (node, memory): (&Node<N, T>, &Velocities<N, T>), h: T) -> Result<(), StepError> {
            memory.check(h, node.t)
        }
    };
}

impl<S: FixedStepping<N, T>, const N: usize, T: Scalar> Method<S, N, T> for FixedStep {
    type Prepared = Corrector<S::Jacobian, N, T>;

    velocities!();

    fn prepare(&self, system: &S, h: T) -> Self::Prepared {
        Corrector::of(&Called(*system), h)
    }

    fn begin(&self, system: &S, node: &mut Node<N, T>, h: T) -> Result<Velocities<N, T>, StepError> {
        let v = node.state().velocity(system)?;
        continuation::check_linear(&Called(*system), node, h)?;
        Ok(Velocities { steps: Steps::new(h, v), iterations: 0 })
    }

    #[inline(always)]
    fn attempt(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        memory: &Velocities<N, T>,
        (): &mut (),
    ) -> Result<FixedSolution<N, T>, ()> {
        let Problem { system, prepared, node, h } = at;
        if memory.steps.is_common(system)
            && let Some(solved) = memory.steps.common(system, node, prepared)
            && node.stays_finite(h, &solved.v, &solved.increment)
        {
            return Ok(FixedSolution { solved, is_common: true });
        }
        Err(())
    }

    fn recover(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        memory: &Velocities<N, T>,
        (): &mut (),
        (): (),
    ) -> Result<FixedSolution<N, T>, StepError> {
        let Problem { system, prepared, node, .. } = at;
        let steps = &memory.steps;
        // A common step above the floor has already had all corrections that pay off.
        let is_corrected = steps.is_common(system) && !system.has_closed_form();
        let corrected =
            if is_corrected { None } else { steps.corrected(&Called(*system), node, prepared, steps.guess()) };
        found(at, memory, corrected, Branch::Nearest)
    }
}

/// Only the differences to [`FixedStep`]: steps are not extrapolated.
impl<S: FixedStepping<N, T>, const N: usize, T: Scalar> Method<S, N, T> for Connected {
    type Prepared = ();

    velocities!();

    fn prepare(&self, _system: &S, _h: T) {}

    fn begin(&self, system: &S, node: &mut Node<N, T>, h: T) -> Result<Velocities<N, T>, StepError> {
        FixedStep.begin(system, node, h)
    }

    fn attempt(
        &self,
        _at: Problem<'_, S, (), N, T>,
        _memory: &Velocities<N, T>,
        (): &mut (),
    ) -> Result<FixedSolution<N, T>, ()> {
        Err(())
    }

    fn recover(
        &self,
        at: Problem<'_, S, (), N, T>,
        memory: &Velocities<N, T>,
        (): &mut (),
        (): (),
    ) -> Result<FixedSolution<N, T>, StepError> {
        found(at, memory, None, Branch::Connected)
    }
}

impl<const N: usize, T: Scalar> Velocities<N, T> {
    /// Discrete energy of the last interval; `None` if it is not finite, since forces may be finite although L is not.
    /// Evaluated from v, because the stored nodes would add the cancellation of `(q1 − q0)/h`.
    fn discrete_energy<S: FixedStepping<N, T>>(&self, system: &S, node: &Node<N, T>, h: T) -> Option<T> {
        let v = self.steps.v();
        let energy = (!self.steps.is_new()).then(|| {
            let mut start = *node;
            start.shift(-h, &v);
            system.discrete_energy(&start, h, &v)
        });
        energy.filter(|energy| energy.is_finite())
    }

    fn check(&self, h: T, t: T) -> Result<(), StepError> {
        check_steps(&self.steps, h, t)
    }
}

/// Checks that stored steps have the length h and are finite.
///
/// # Errors
/// [`StepError::InvalidInput`], [`StepError::NonFinite`].
pub(super) fn check_steps<const N: usize, T: Scalar>(steps: &Steps<N, T>, h: T, t: T) -> Result<(), StepError> {
    if steps.h != h {
        let (input, allowed) = ("the step of a checkpoint", "that of its run");
        return Err(StepError::InvalidInput { input, allowed, value: steps.h.to_f64() });
    }
    let lost = StepError::NonFinite { t: t.to_f64(), quantity: "last velocity", expression: None };
    if steps.is_finite() { Ok(()) } else { Err(lost) }
}

#[inline(always)]
fn take<const N: usize, T: Scalar>(
    h: T,
    node: &mut Node<N, T>,
    memory: &mut Velocities<N, T>,
    step: &FixedSolution<N, T>,
) {
    let FixedSolution { solved, is_common } = step;
    if *is_common {
        memory.steps.push_common(solved);
    } else {
        memory.steps.push(solved);
    }
    node.advance(h, &solved.v, &solved.increment);
    memory.iterations = solved.iterations;
}

/// The corrected step, or a step by the full solver.
fn found<S: FixedStepping<N, T>, P, const N: usize, T: Scalar>(
    at: Problem<'_, S, P, N, T>,
    memory: &Velocities<N, T>,
    corrected: Option<MomentumStep<N, T>>,
    branch: Branch,
) -> Result<FixedSolution<N, T>, StepError> {
    let Problem { system, node, h, .. } = at;
    let solved = match corrected {
        Some(solved) => memory.steps.connected(&Called(*system), node, solved),
        None => memory.steps.searched(&Called(*system), node, branch),
    };
    let found = solved.and_then(|solved| {
        let mut after = *node;
        after.advance(h, &solved.v, &solved.increment);
        after.check_finite(node.t).map(|()| FixedSolution { solved, is_common: false })
    });
    found.map_err(|failure| failure.explained(system, node, h, &memory.steps.v()))
}

impl<S: FixedStepping<N, T>, const N: usize, T: Scalar> Run<FixedStep, S, N, T> {
    /// Velocity `(q1 − q0)/h` of the last interval, without its cancellation. Before the first step, the velocity of
    /// the momenta.
    pub fn v(&self) -> SVector<T, N> {
        self.memory.steps.v()
    }
}

impl<S: FixedStepping<N, T>, const N: usize, T: Scalar> Run<Connected, S, N, T> {
    /// Velocity `(q1 − q0)/h` of the last interval, as of [`FixedStep`].
    pub fn v(&self) -> SVector<T, N> {
        self.memory.steps.v()
    }
}
