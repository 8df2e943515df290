//! Gauss steps whose length follows the motion.
//!
//! | law | motions | |
//! |---|---|---|
//! | `reversible` | conservative motions, and systems with a `time_scale` | the length depends on the step alone, and not on its direction: no drift |
//! | `decaying` | motions with friction, inputs or a dependence on time | the length keeps the error: fast modes that have died out do not count |
//!
//! `phase` measures the frequency of the forces along a step, for `reversible`.
//!
//! Neither map is symplectic: that needs [`InTransformedTime`](super::InTransformedTime) and a `time_scale`, which
//! [`Adaptive`] takes too.

mod decaying;
mod phase;
mod reversible;

use super::gauss::{Solver, StageSolver, solver};
use super::{Change, Facts, Gauss, Memory, Method, Problem, Status, check_step, step_from};
#[cfg(feature = "alloc")]
use crate::derivatives::{Differentiable, Variation};
use crate::error::StepError;
use crate::node::Node;
#[cfg(feature = "alloc")]
use crate::run::Run;
use crate::state::State;
use crate::stepping::Convertible;
#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use decaying::Decaying;
use reversible::Reversible;

/// A method whose steps follow the motion: `Gauss::<8>.adaptive()`. See the [module](self).
///
/// The step of a run is the first one, or is found from a [`Tolerance`](crate::Tolerance) of all steps of the first
/// stretch. Its sign is the direction of time. With a tolerance the stages of irreversible motions without constraints are
/// solved to a part of it, from three stages on; all others to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Adaptive<M> {
    method: M,
    /// The tolerance of the steps, relative to their motion; zero without one.
    tolerance: f64,
}

impl<const STAGES: usize> Gauss<STAGES> {
    /// Takes steps whose length follows the forces along the motion.
    #[must_use]
    pub fn adaptive(self) -> Adaptive<Self> {
        Adaptive { method: self, tolerance: 0.0 }
    }
}

/// The longest step, in units of the first one: without forces, steps grow no further.
const LONGEST: f64 = 1e4;
/// Lengths tried for a step at most.
const TRIALS: usize = 60;

/// Memory of steps that follow the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Following<Y> {
    /// Memory of the solver after the last step; before the first one, for a step of the length `h`.
    steps: Y,
    /// Length of the last step, or of the next one before the first.
    h: f64,
    /// The law of the lengths, with what the first step has set; `None` before it.
    law: Option<Law>,
    /// The tolerance of the steps; zero without one.
    #[cfg_attr(feature = "serde", serde(default))]
    tolerance: f64,
}

/// A law of the lengths of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[doc(hidden)]
pub enum Law {
    /// The law of motions that may be reversed.
    Reversible(Reversible),
    /// The law of all other motions.
    Decaying(Decaying),
}

impl Law {
    /// The law after a change of the system or of the state: the next length is the last one.
    fn resumed(self) -> Self {
        match self {
            Self::Reversible(law) => Self::Reversible(law.resumed()),
            Self::Decaying(law) => Self::Decaying(law.resumed()),
        }
    }
}

impl<Y> Following<Y> {
    /// The solver of the next step. Reversible steps are solved to rounding, else they would drift.
    fn solver<S, const N: usize, const STAGES: usize>(&self) -> Solver<S, N, STAGES>
    where
        S: Convertible<N>,
    {
        let is_decaying = matches!(self.law, Some(Law::Decaying(_)));
        Solver::<S, N, STAGES>::within(if is_decaying { self.tolerance } else { 0.0 })
    }
}

impl<Y: Memory> Memory for Following<Y> {
    fn stored(&self) -> Self {
        Self { steps: self.steps.stored(), ..self.clone() }
    }
}

/// The memory of the solver of a system.
type Steps<S, const N: usize, const STAGES: usize> = <Solver<S, N, STAGES> as Method<S, N>>::Memory;

/// The end of a step, and the memory there.
type End<S, const N: usize, const STAGES: usize> = (Node<N>, Following<Steps<S, N, STAGES>>);

/// The problem of the solver of a system.
type Of<'a, S, const N: usize, const STAGES: usize> =
    Problem<'a, S, <Solver<S, N, STAGES> as Method<S, N>>::Prepared, N>;

/// Whether a step of the length h from t changes the time: in a fall into a centre, h may be less than a rounding of t.
///
/// # Errors
/// As [`check_step`].
fn moves_time(h: f64, t: f64) -> Result<bool, StepError> {
    check_step(h)?;
    Ok(h.abs() >= f64::EPSILON * t.abs())
}

/// The step of the length `at.h` from a node by a solver.
///
/// # Errors
/// The errors of the solver.
fn solved<S: Convertible<N>, const N: usize, const STAGES: usize>(
    solver: &Solver<S, N, STAGES>,
    at: Of<'_, S, N, STAGES>,
    guess: &Steps<S, N, STAGES>,
    cache: &mut <Solver<S, N, STAGES> as Method<S, N>>::Cache,
) -> Result<(Node<N>, Steps<S, N, STAGES>), StepError> {
    let step = solver.solve(at, guess, cache)?;
    Ok(taken::<S, N, STAGES>(at, guess, cache, step))
}

/// The end of a step.
fn taken<S: Convertible<N>, const N: usize, const STAGES: usize>(
    at: Of<'_, S, N, STAGES>,
    guess: &Steps<S, N, STAGES>,
    cache: &mut <Solver<S, N, STAGES> as Method<S, N>>::Cache,
    step: <Solver<S, N, STAGES> as Method<S, N>>::Step,
) -> (Node<N>, Steps<S, N, STAGES>) {
    let Problem { system, node, h, .. } = at;
    let (mut end, mut steps) = (*node, guess.clone());
    solver::<S, N, STAGES>().take(system, h, (&mut end, &mut steps), cache, step);
    (end, steps)
}

/// The first step, which sets the law of all others.
fn first<S: Convertible<N>, const N: usize, const STAGES: usize>(
    at: Of<'_, S, N, STAGES>,
    memory: &Following<Steps<S, N, STAGES>>,
    cache: &mut <Solver<S, N, STAGES> as Method<S, N>>::Cache,
) -> Result<End<S, N, STAGES>, StepError> {
    let Following { steps, h, tolerance, .. } = memory;
    let (system, at) = (at.system, Problem { h: *h, ..at });
    let (end, steps) = solved(&solver::<S, N, STAGES>(), at, steps, cache)?;
    let is_reversible = system.conserves_energy() || system.scales_time() || STAGES < decaying::FEWEST;
    let law = if is_reversible {
        Law::Reversible(Reversible::of_first::<S, N, STAGES>(system, [at.node, &end], *h)?)
    } else {
        Law::Decaying(Decaying::of_first::<S, N, STAGES>(system, (&end, &steps), *h)?)
    };
    Ok((end, Following { steps, h: *h, law: Some(law), tolerance: *tolerance }))
}

/// The law of a run that leaves a node by a change or a part of a step. The first length is right for the system and the
/// node before: if the run has taken no step, they set the law.
fn law_at<S: Convertible<N>, const N: usize, const STAGES: usize>(
    system: &S,
    node: &Node<N>,
    memory: &Following<Steps<S, N, STAGES>>,
) -> Option<Law> {
    memory.law.or_else(|| {
        let prepared = &solver::<S, N, STAGES>().prepare(system, memory.h);
        let at = Problem { system, prepared, node, h: memory.h };
        let (_, after) = first::<S, N, STAGES>(at, memory, &mut Default::default()).ok()?;
        after.law.map(Law::resumed)
    })
}

impl<S, const N: usize, const STAGES: usize> Method<S, N> for Adaptive<Gauss<STAGES>>
where
    S: Convertible<N>,
{
    type Prepared = <Solver<S, N, STAGES> as Method<S, N>>::Prepared;
    type Memory = Following<Steps<S, N, STAGES>>;
    type Cache = <Solver<S, N, STAGES> as Method<S, N>>::Cache;
    type Step = End<S, N, STAGES>;
    type Left = StepError;
    type DenseOutput = <Solver<S, N, STAGES> as Method<S, N>>::DenseOutput;

    fn facts(&self) -> Facts {
        Facts { finds_length: true, follows_forces: true, ..Method::<S, N>::facts(&self.method) }
    }

    fn with_tolerance(&self, tolerance: f64) -> Self {
        Self { tolerance, ..*self }
    }

    fn prepare(&self, system: &S, h: f64) -> Self::Prepared {
        solver::<S, N, STAGES>().prepare(system, h)
    }

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        if system.is_first_order() {
            return Err(StepError::FirstOrder { system: system.name() });
        }
        let steps = solver::<S, N, STAGES>().begin(system, node, h)?;
        Ok(Following { steps, h, law: None, tolerance: self.tolerance })
    }

    fn attempt(
        &self,
        at: Problem<'_, S, Self::Prepared, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, Self::Left> {
        match &memory.law {
            None => first(at, memory, cache),
            Some(Law::Reversible(law)) => law.next(at, memory, cache),
            Some(Law::Decaying(law)) => law.next(at, memory, cache),
        }
    }

    fn recover(
        &self,
        _at: Problem<'_, S, Self::Prepared, N>,
        _memory: &Self::Memory,
        _cache: &mut Self::Cache,
        left: Self::Left,
    ) -> Result<Self::Step, StepError> {
        Err(left)
    }

    fn take(
        &self,
        _system: &S,
        _h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        _cache: &mut Self::Cache,
        (end, after): Self::Step,
    ) {
        (*node, *memory) = (end, after);
    }

    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N>, &Self::Memory),
        [h, _]: [f64; 2],
    ) -> Result<(Node<N>, Self::Memory), StepError> {
        check_step(h)?;
        let before = Solver::<S, N, STAGES>::resized(system, &memory.steps, node, h)?;
        let solver = &memory.solver::<S, N, STAGES>();
        let law = law_at::<S, N, STAGES>(system, node, memory);
        let (node, steps) = step_from(solver, system, (node, before), [h, memory.h])?;
        Ok((node, Following { steps, law, ..*memory }))
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N>,
        node: &mut Node<N>,
        _h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        if matches!(change, Change::NewLength) {
            return Ok(memory.clone());
        }
        let law = match change.before() {
            Some(before) => law_at::<S, N, STAGES>(before, node, memory),
            None => memory.law,
        };
        let steps = solver::<S, N, STAGES>().restarted(system, change, node, memory.h, &memory.steps)?;
        Ok(Following { steps, law: law.map(Law::resumed), ..*memory })
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::DenseOutput, StepError> {
        solver::<S, N, STAGES>().dense_output(system, before, node, h, &memory.steps)
    }

    fn status(&self, h: f64, memory: &Self::Memory) -> Status {
        let solved = Method::<S, N>::status(&solver::<S, N, STAGES>(), memory.h, &memory.steps);
        // The next length is known after its step.
        Status { longest: f64::INFINITY.copysign(h), ..solved }
    }

    fn discrete_energy(&self, system: &S, node: &Node<N>, _h: f64, memory: &Self::Memory) -> Option<f64> {
        solver::<S, N, STAGES>().discrete_energy(system, node, memory.h, &memory.steps)
    }

    fn check(&self, system: &S, (node, memory): (&Node<N>, &Self::Memory), h: f64) -> Result<(), StepError> {
        let Following { steps, h: last, law, tolerance } = memory;
        let is_length = last * h.signum() > 0.0 && last.is_normal();
        let is_law = match law {
            None => true,
            Some(Law::Reversible(law)) => law.is_valid(h),
            Some(Law::Decaying(law)) => law.is_valid(),
        };
        let wrong = |quantity| Err(StepError::NonFinite { t: node.t, quantity, expression: None });
        if !(is_length && is_law) {
            return wrong("length of the last step");
        }
        if !(0.0..1.0).contains(tolerance) {
            return wrong("tolerance of the steps");
        }
        solver::<S, N, STAGES>().check(system, (node, steps), *last)
    }
}

/// The lengths of the steps are held fixed: `h` of a tangent vector has no effect.
#[cfg(feature = "alloc")]
impl<S, const N: usize, const STAGES: usize> Differentiable<S, N> for Adaptive<Gauss<STAGES>>
where
    S: Convertible<N>,
{
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let lengths: Vec<f64> = variations.iter_mut().map(|of| core::mem::take(&mut of.h)).collect();
        let outcome = Solver::<S, N, STAGES>::vary(&run.system, (&run.node, &run.memory.steps), before, variations);
        variations.iter_mut().zip(lengths).for_each(|(of, h)| of.h = h);
        outcome
    }

    fn vary_step_of(run: &Run<Self, S, N>, length: f64, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let Run { method: Self { method, .. }, system, node, memory, .. } = run;
        let memory = Solver::<S, N, STAGES>::resized(system, &memory.steps, node, length)?;
        let mut aside = Run::resumed(*method, *system, (*node, length, memory));
        aside.step()?;
        aside.vary(node, variations)
    }
}
