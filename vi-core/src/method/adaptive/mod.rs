//! Gauss steps whose length follows the motion.
//!
//! The step density ρ, the reciprocal of a step up to a constant ε, changes at the nodes between two steps,
//!
//! ```text
//! ρ₊ = ρ₋ + ε G        h = ε/ρ        G = ω'/ω at the node
//! ```
//!
//! with a frequency ω of the forces (`frequency.rs`): along the motion ρ/ω is constant. No error enters ρ,
//! so that the map (q, p, ρ) is time-symmetric if ω is even in the velocities. A reversible motion then keeps its energy
//! without drift, which steps that follow a measured error lose. Source: E. Hairer and G. Söderlind, Explicit, time
//! reversible, adaptive step size control, SIAM J. Sci. Comput. 26 (2005).
//!
//! The map is not symplectic: that needs [`InTransformedTime`](super::InTransformedTime) and a `time_scale`, which
//! [`Adaptive`] takes too. Terms that are linear in the velocities, friction and inputs break the symmetry; the steps
//! still follow the motion.
//!
//! A step to a given time, a change of parameters or of the state begins a new ρ there, with the same ε.
//!
//! The law holds while a step resolves the changes of ω. Where it does not, as at a wall in the way of a free flight or
//! with a few steps in a period, ρ would wander from ω: such a step is refused, [`StepError::LengthsLost`].

mod frequency;

use super::gauss::{Solver, StageSolver, solver};
use super::{Gauss, Memory, Method, Problem, Report, check_step, step_from};
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
use frequency::{Frequency, frequency};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// A method whose steps follow the motion: `Gauss::<8>.adaptive()`. See the [module](self).
///
/// The step of a run is about the first one, or is found from a [`Tolerance`](crate::Tolerance) of all steps of the first
/// stretch. Its sign is the direction of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Adaptive<M>(M);

impl<const STAGES: usize> Gauss<STAGES> {
    /// Takes steps whose length follows the forces along the motion.
    #[must_use]
    pub fn adaptive(self) -> Adaptive<Self> {
        Adaptive(self)
    }
}

/// The frequency has at least this part of the reciprocal of the first step: without forces, steps grow no further.
const SLOWEST: f64 = 1e-4;
/// Largest ratio of the mean of ρ₋ and ρ₊ to ω, and its reciprocal. It is 1 + O(ε²) along the motion; with steps too long for
/// the changes of ω, ρ loses it.
const STRAY: f64 = 1.25;

/// Memory of steps that follow the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Following<Y> {
    /// That of the last step; before the first one, of a step of the length `h`.
    steps: Y,
    /// Length of the last step, or of the next one before the first.
    h: f64,
    /// ε, with the sign of the steps.
    scale: f64,
    /// ρ of the last step; before the first one, that half a step earlier.
    density: f64,
    /// The floor of the frequency.
    floor: f64,
}

impl<Y: Memory> Memory for Following<Y> {
    fn stored(&self) -> Self {
        Self { steps: self.steps.stored(), ..self.clone() }
    }
}

/// The next step: the memory from which it is solved, its length and its density.
#[derive(Clone, Debug)]
pub struct Next<Y> {
    steps: Y,
    h: f64,
    density: f64,
}

/// The memory of the solver of a system.
type Steps<S, const N: usize, const STAGES: usize> = <Solver<S, N, STAGES> as Method<S, N>>::Memory;

/// The density half a step earlier, by the rate of ln ω.
fn half_a_step_before(found: &Frequency, scale: f64) -> f64 {
    found.value * (-0.5 * scale / found.value * found.rate).exp()
}

/// The memory with a new density at a node.
///
/// # Errors
/// As [`frequency`].
fn anew<S: Convertible<N>, Y, const N: usize>(
    system: &S,
    node: &Node<N>,
    memory: Following<Y>,
) -> Result<Following<Y>, StepError> {
    let Some(found) = frequency(system, node, [memory.floor, memory.h])? else { return Ok(memory) };
    Ok(Following { density: half_a_step_before(&found, memory.scale), ..memory })
}

/// The next step from a node.
///
/// # Errors
/// [`StepError::LengthsLost`] if ρ has left ω. As [`frequency`], and those of a start.
fn next<S: Convertible<N>, const N: usize, const STAGES: usize>(
    system: &S,
    node: &Node<N>,
    memory: &Following<Steps<S, N, STAGES>>,
) -> Result<Next<Steps<S, N, STAGES>>, StepError> {
    let Following { steps, h: last, scale, density: before, floor, .. } = memory;
    // Where the stiffness has no value, the steps keep their length.
    let found = frequency(system, node, [*floor, *last])?;
    let density = before + scale * found.map_or(0.0, |found| found.rate);
    let ratio = found.map_or(1.0, |found| 0.5 * (before + density) / found.value);
    // False for NaN.
    if !(density > 0.0 && ratio < STRAY && ratio > 1.0 / STRAY) {
        return Err(StepError::LengthsLost { t: node.t, h: *last });
    }
    let h = scale / density;
    check_step(h)?;
    let steps = Solver::<S, N, STAGES>::resized(system, steps, node, h)?;
    Ok(Next { steps, h, density })
}

impl<S, const N: usize, const STAGES: usize> Method<S, N> for Adaptive<Gauss<STAGES>>
where
    S: Convertible<N>,
{
    type Prepared = <Solver<S, N, STAGES> as Method<S, N>>::Prepared;
    type Memory = Following<Steps<S, N, STAGES>>;
    type Cache = <Solver<S, N, STAGES> as Method<S, N>>::Cache;
    type Step = (Next<Steps<S, N, STAGES>>, <Solver<S, N, STAGES> as Method<S, N>>::Step);
    type Left = Result<(Next<Steps<S, N, STAGES>>, <Solver<S, N, STAGES> as Method<S, N>>::Left), StepError>;
    type DenseOutput = <Solver<S, N, STAGES> as Method<S, N>>::DenseOutput;

    fn finds_length(&self) -> bool {
        true
    }

    fn has_reactions(&self) -> bool {
        Method::<S, N>::has_reactions(&self.0)
    }

    fn order(&self) -> u32 {
        Method::<S, N>::order(&self.0)
    }

    fn prepare(&self, system: &S, h: f64) -> Self::Prepared {
        solver::<S, N, STAGES>().prepare(system, h)
    }

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        let steps = solver::<S, N, STAGES>().begin(system, node, h)?;
        let floor = SLOWEST / h.abs();
        let found = frequency(system, node, [floor, h])?.unwrap_or(Frequency { value: floor, rate: 0.0 });
        let scale = h * found.value;
        Ok(Following { steps, h, scale, density: half_a_step_before(&found, scale), floor })
    }

    fn attempt(
        &self,
        at: Problem<'_, S, Self::Prepared, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, Self::Left> {
        let next = next::<S, N, STAGES>(at.system, at.node, memory).map_err(Err)?;
        match solver::<S, N, STAGES>().attempt(Problem { h: next.h, ..at }, &next.steps, cache) {
            Ok(step) => Ok((next, step)),
            Err(left) => Err(Ok((next, left))),
        }
    }

    fn recover(
        &self,
        at: Problem<'_, S, Self::Prepared, N>,
        _memory: &Self::Memory,
        cache: &mut Self::Cache,
        left: Self::Left,
    ) -> Result<Self::Step, StepError> {
        let (next, left) = left?;
        let step = solver::<S, N, STAGES>().recover(Problem { h: next.h, ..at }, &next.steps, cache, left)?;
        Ok((next, step))
    }

    fn take(
        &self,
        system: &S,
        _h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        cache: &mut Self::Cache,
        (Next { steps, h, density }, step): Self::Step,
    ) {
        *memory = Following { steps, h, density, ..*memory };
        solver::<S, N, STAGES>().take(system, h, (node, &mut memory.steps), cache, step);
    }

    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N>, &Self::Memory),
        [h, _]: [f64; 2],
    ) -> Result<(Node<N>, Self::Memory), StepError> {
        check_step(h)?;
        let before = Solver::<S, N, STAGES>::resized(system, &memory.steps, node, h)?;
        let solver = &solver::<S, N, STAGES>();
        let (node, steps) = step_from(solver, system, (node, before), [h, memory.h])?;
        let memory = anew(system, &node, Following { steps, ..*memory })?;
        Ok((node, memory))
    }

    fn with_length(
        &self,
        _system: &S,
        memory: &Self::Memory,
        _node: &Node<N>,
        _h: f64,
    ) -> Result<Self::Memory, StepError> {
        Ok(memory.clone())
    }

    fn with_system(
        &self,
        systems: [&S; 2],
        node: &mut Node<N>,
        _h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        let steps = solver::<S, N, STAGES>().with_system(systems, node, memory.h, &memory.steps)?;
        anew(systems[1], node, Following { steps, ..*memory })
    }

    fn with_state(
        &self,
        systems: [&S; 2],
        node: &mut Node<N>,
        _h: f64,
        memory: &Self::Memory,
        state: State<N>,
    ) -> Result<Self::Memory, StepError> {
        let steps = solver::<S, N, STAGES>().with_state(systems, node, memory.h, &memory.steps, state)?;
        anew(systems[1], node, Following { steps, ..*memory })
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

    fn length(&self, _h: f64, memory: &Self::Memory) -> f64 {
        memory.h
    }

    // The next density needs the frequency at the node.
    fn longest(&self, h: f64, _memory: &Self::Memory) -> f64 {
        f64::INFINITY.copysign(h)
    }

    fn report(&self, memory: &Self::Memory) -> Report {
        Method::<S, N>::report(&solver::<S, N, STAGES>(), &memory.steps)
    }

    fn discrete_energy(&self, system: &S, node: &Node<N>, _h: f64, memory: &Self::Memory) -> Option<f64> {
        solver::<S, N, STAGES>().discrete_energy(system, node, memory.h, &memory.steps)
    }

    fn check(&self, system: &S, (node, memory): (&Node<N>, &Self::Memory), h: f64) -> Result<(), StepError> {
        let Following { steps, h: last, scale, density, floor } = memory;
        let are_positive =
            [last * h.signum(), scale * h.signum(), *density, *floor].map(|number| number > 0.0 && number.is_normal());
        if are_positive != [true; 4] {
            return Err(StepError::NonFinite { t: node.t, quantity: "step density", expression: None });
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
        let Run { method: Self(method), system, node, memory, .. } = run;
        let memory = Solver::<S, N, STAGES>::resized(system, &memory.steps, node, length)?;
        let mut aside = Run::resumed(*method, *system, (*node, length, memory));
        aside.step()?;
        aside.vary(node, variations)
    }
}
