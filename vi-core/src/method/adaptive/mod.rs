//! Gauss steps whose length follows the motion.
//!
//! The length h of a step solves
//!
//! ```text
//! h Ω = ε
//! ```
//!
//! with the frequency Ω of the forces along the step (`phase.rs`), which does not change when the step is reversed. The map
//! is time-symmetric: a reversible motion keeps its energy without drift, which steps that follow a measured error lose.
//! Source: E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration*, VIII.3.1.
//!
//! The equation is solved by secants: each length tried is a step from the stages of the one before. The explicit law of
//! Hairer and Söderlind (SIAM J. Sci. Comput. 26, 2005), ρ₊ = ρ₋ + ε ω'/ω with h = ε/ρ, needs one step instead of four.
//! But ρ leaves ω where a step is long for the changes of ω, as with few steps in the period of an oscillator.
//!
//! The map is not symplectic: that needs [`InTransformedTime`](super::InTransformedTime) and a `time_scale`, which
//! [`Adaptive`] takes too. With terms that are linear in the velocities, friction or inputs a motion is not reversible: steps
//! back still return, but no law bounds the energy error.

mod phase;

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
#[cfg(not(feature = "std"))]
use num_traits::Float as _;
use phase::{Phase, Place, phase};

/// A method whose steps follow the motion: `Gauss::<8>.adaptive()`. See the [module](self).
///
/// The step of a run is the first one, or is found from a [`Tolerance`](crate::Tolerance) of all steps of the first
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

/// Ω has at least this part of the reciprocal of the first step: without forces, steps grow no further.
const SLOWEST: f64 = 1e-4;
/// A first step feels no force that could set the lengths of the others, if its phase to the power of its order is smaller.
/// The others then have the phase [`USUAL`] for each stage, and are no longer than the first one.
const FREE: f64 = 1e-12;
const USUAL: f64 = 0.1;
/// The largest deviation of ln h Ω from ln ε of an accepted step. After [`FEW`] lengths it is [`ROUGH`]: then rounding of
/// the positions changes the phase, as near a collision.
const NEAR: f64 = 1e-10;
const ROUGH: f64 = 1e-8;
const FEW: usize = 15;
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
    /// ε, with the sign of the steps; `None` before the first step.
    phase: Option<f64>,
    /// The floor of Ω.
    floor: f64,
    /// The guess of the next length, divided by the last one.
    ahead: f64,
    /// Ratio of the last two lengths.
    ratio: f64,
    /// Logarithmic slope of the phase of the last step in its length.
    slope: f64,
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

/// The step of the length `at.h` from a node.
///
/// # Errors
/// Those of the solver.
fn solved<S: Convertible<N>, const N: usize, const STAGES: usize>(
    at: Of<'_, S, N, STAGES>,
    guess: &Steps<S, N, STAGES>,
    cache: &mut <Solver<S, N, STAGES> as Method<S, N>>::Cache,
) -> Result<(Node<N>, Steps<S, N, STAGES>), StepError> {
    let (solver, Problem { system, node, h, .. }) = (solver::<S, N, STAGES>(), at);
    let step = solver.solve(at, guess, cache)?;
    let (mut end, mut steps) = (*node, guess.clone());
    solver.take(system, h, (&mut end, &mut steps), cache, step);
    Ok((end, steps))
}

/// The first step: its phase is that of all others.
fn first<S: Convertible<N>, const N: usize, const STAGES: usize>(
    at: Of<'_, S, N, STAGES>,
    memory: &Following<Steps<S, N, STAGES>>,
    cache: &mut <Solver<S, N, STAGES> as Method<S, N>>::Cache,
) -> Result<End<S, N, STAGES>, StepError> {
    let Following { steps, h, .. } = memory;
    let at = Problem { h: *h, ..at };
    let (end, steps) = solved(at, steps, cache)?;
    let [here, there] = [at.node, &end].map(|node| Place::of(at.system, node));
    #[allow(clippy::cast_precision_loss)] // 16 stages at most
    let stages = STAGES as f64;
    let is_felt = |found: &Phase| found.value.powf(2.0 * stages) > FREE;
    let found = phase(at.system, [&here?, &there?], [h.abs(), 0.0])?.filter(is_felt);
    let usual = USUAL * stages;
    let Phase { value, slope, .. } = found.unwrap_or(Phase { value: usual, slope: 1.0, ratio: 1.0 });
    let floor = if found.is_some() { SLOWEST } else { usual } / h.abs();
    Ok((end, Following { steps, h: *h, phase: Some(value.copysign(*h)), floor, ahead: 1.0, ratio: 1.0, slope }))
}

/// The search for the length of a step.
struct Search {
    /// A length that is too short, and one that is too long or has no step.
    between: [f64; 2],
    /// The last length tried, and the logarithm of its phase over ε.
    last: Option<[f64; 2]>,
    /// Logarithmic slope of the phase in the length.
    slope: f64,
}

impl Search {
    /// The length to try after one without a step.
    fn shorter(&mut self, h: f64) -> f64 {
        self.between[1] = h;
        0.5 * (self.between[0] + h)
    }

    /// The slope by the last two lengths.
    fn learn(&mut self, h: f64, off: f64) {
        if let Some([before, off_before]) = self.last.replace([h, off]) {
            self.slope = ((off - off_before) / (h / before).ln()).max(0.25);
        }
    }

    /// The length to try after this one, by the slope, or halfway between those that are too short and too long.
    fn beside(&mut self, h: f64, off: f64) -> f64 {
        self.between[usize::from(off > 0.0)] = h;
        let next = h * (-off / self.slope).clamp(-1.0, 1.0).exp();
        let [short, long] = self.between;
        // False for NaN.
        if (next - short) / (long - short) > 0.0 && (long - next) / (long - short) > 0.0 {
            next
        } else {
            0.5 * (short + long)
        }
    }
}

/// The step whose phase is that of the first one.
///
/// # Errors
/// Those of the solver for the shortest length tried; [`StepError::LengthsLost`] if no length has this phase.
fn next<S: Convertible<N>, const N: usize, const STAGES: usize>(
    at: Of<'_, S, N, STAGES>,
    memory: &Following<Steps<S, N, STAGES>>,
    wanted: f64,
    cache: &mut <Solver<S, N, STAGES> as Method<S, N>>::Cache,
) -> Result<End<S, N, STAGES>, StepError> {
    let Problem { system, node, .. } = at;
    let Following { steps, h: last, floor, ahead, ratio: before, slope, .. } = memory;
    let start = Place::of(system, node)?;
    let mut search = Search { between: [0.0, wanted / floor], last: None, slope: *slope };
    let mut h = last * ahead;
    let mut guess = Solver::<S, N, STAGES>::resized(system, steps, node, h)?;
    let mut failure = StepError::LengthsLost { t: node.t, h: *last };
    for trial in 0..TRIALS {
        check_step(h)?;
        // Below the rounding of the time, as in a fall into a centre, time stands still.
        if h.abs() < f64::EPSILON * node.t.abs() {
            break;
        }
        let tried = solved(Problem { h, ..at }, &guess, cache)
            .and_then(|(end, steps)| Ok((Place::of(system, &end)?, end, steps)));
        let (there, end, steps) = match tried {
            Ok(found) => found,
            Err(error) => {
                failure = error;
                h = search.shorter(h);
                guess = Solver::<S, N, STAGES>::resized(system, &memory.steps, node, h)?;
                continue;
            }
        };
        // Where the stiffness has no value, the length is taken.
        let found = phase(system, [&start, &there], [h.abs(), *floor])?;
        let found = found.unwrap_or(Phase { value: wanted.abs(), slope: 1.0, ratio: 1.0 });
        let off = (found.value / wanted.abs()).ln();
        search.learn(h, off);
        if off.abs() < if trial < FEW { NEAR } else { ROUGH } {
            let ratio = h / last;
            // Ratios change by nearly equal factors, until the forces turn.
            let ahead = found.ratio.min(ratio * (ratio / before).clamp(0.7, 1.4));
            return Ok((end, Following { steps, h, ahead, ratio, slope: search.slope, ..memory.clone() }));
        }
        h = search.beside(h, off);
        guess = Solver::<S, N, STAGES>::again(system, &steps, node, h)?;
    }
    Err(failure)
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
        Ok(Following { steps, h, phase: None, floor: SLOWEST / h.abs(), ahead: 1.0, ratio: 1.0, slope: 1.0 })
    }

    fn attempt(
        &self,
        at: Problem<'_, S, Self::Prepared, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, Self::Left> {
        match memory.phase {
            None => first(at, memory, cache),
            Some(wanted) => next(at, memory, wanted, cache),
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
        let solver = &solver::<S, N, STAGES>();
        let (node, steps) = step_from(solver, system, (node, before), [h, memory.h])?;
        Ok((node, Following { steps, ..*memory }))
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
        Ok(Following { steps, ahead: 1.0, ratio: 1.0, ..*memory })
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
        Ok(Following { steps, ahead: 1.0, ratio: 1.0, ..*memory })
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

    // The next length is known after its step.
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
        let Following { steps, h: last, phase, floor, ahead, ratio, slope } = memory;
        let are_positive =
            [last * h.signum(), phase.map_or(1.0, |phase| phase * h.signum()), *floor, *ahead, *ratio, *slope]
                .map(|number| number > 0.0 && number.is_normal());
        if are_positive != [true; 6] {
            return Err(StepError::NonFinite { t: node.t, quantity: "length of the last step", expression: None });
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
