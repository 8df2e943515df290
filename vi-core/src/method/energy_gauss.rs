//! Energy-preserving steps of order 2S: Gauss steps whose length preserves the discrete energy.
//!
//! One step solves, for the stages and h > 0,
//!
//! ```text
//! Q_i = q0 + h Σ a_ij V_j        L_v(T_i, Q_i, V_i) = p0 + h Σ a_ij (L_q + f)_j        E0(h) = E
//! E0(h) = Σ b_i En_i − h Σ b_i (1 − c_i) (f·v − L_t)_i        E ← E + h Σ b_i (f·v − L_t)_i
//! ```
//!
//! The discrete energy of every step is then that of the first one, plus the work done since. The length follows from
//! `H − E0(h) = C_s h^2s D_s` with the step density D_s ([`crate::gauss::density`]). Without force `h D_s^(1/(2s+1))`
//! is constant up to O(h²), and a step exists while D_s keeps its sign. A shift D_* adds `C_s D_* h^(2s+1)/(2s+1)` to
//! L_d. Then D_s + D_* must keep its sign, and the run preserves
//!
//! ```text
//! E' = E − C_s h^2s D_*
//! ```
//!
//! The unknown is ln h: `ln[(H − E0(h))/(H − E)]` is nearly a line of slope 2s in it. It also excludes the last step
//! backwards, which solves the same equations. A step is one `Search` over the solutions of Gauss steps of any length.
//!
//! If no step exists, a run with `Fallback::FixedSteps` takes fixed Gauss steps of the last length until an
//! energy-preserving one exists again. E changes by the work only. Fixed steps end when the step law `h |D|^(1/(2s+1))
//! = C` requires their length or a shorter one. With D_0 the density at their start,
//!
//! ```text
//! H − E = C_s h_f^2s (2s D_0 + D)/(2s + 1)        D = D_s + D_*
//! ```
//!
//! to leading order without force, with the sign of D if D has that of D_0. If no step has the previous energy, E
//! becomes the discrete energy of the last fixed step.
//!
//! The stages and the energy of every accepted step are at the rounding floor. Theory and measurements:
//! `docs/theory.md`.

use super::bounds::{Alternating, Control, Controlled, FORWARD, Phase, RATIO, check_forward};
use super::gauss::{Gauss, GaussOutput, LastStages};
use super::length::{Search, Trial};
use super::{Memory, Method, Problem, Report};
use crate::collocation::Collocation;
use crate::energy_preserving::start::check_density;
use crate::error::StepError;
use crate::gauss::density::{power, step_density};
use crate::gauss::energies::{bounded_energies, energies};
use crate::gauss::fixed_point::Convergence;
use crate::gauss::history::StepHistory;
use crate::gauss::newton::Newton;
use crate::gauss::solve::{Start, Step};
use crate::gauss::stages::{Stages, at};
use crate::lagrangian::Lagrangian;
use crate::newton::{FLOOR, roundings};
use crate::node::Node;
use crate::run::{Run, Starts};
use crate::state::State;
use crate::stepping::Convertible;
use core::cell::{Cell, RefCell};
use nalgebra::{ArrayStorage, SMatrix};
use vi_dispatch::Instructions;

/// Energy-preserving steps of order 2 STAGES, with 1 to 3 stages: `EnergyPreservingGauss::<2>`. See the [module](self).
///
/// A run from a state starts with a step of the length h, and preserves the discrete energy of that step. It differs
/// from H at the state by `C_s h^2s D_s`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EnergyPreservingGauss<const STAGES: usize>;

/// The memory of a run: stages, and data for the prediction of lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lengths<const N: usize, const S: usize> {
    pub(crate) stages: LastStages<N, S>,
    pub(crate) course: StepHistory,
}

impl<const N: usize, const S: usize> Memory for Lengths<N, S> {}

impl<const N: usize, const S: usize> Controlled<f64> for Lengths<N, S> {
    fn control(&self) -> &Control {
        &self.course.control
    }

    fn control_mut(&mut self) -> &mut Control {
        &mut self.course.control
    }
}

/// A step of some length with solved stages.
#[derive(Clone, Copy, Debug)]
struct Tried<const N: usize, const S: usize> {
    step: Step<N, S>,
    /// `E0(h) − C_s h^2s D_* − E'`.
    residual: f64,
    /// `E1 − E0`.
    work: f64,
    /// Sum of the absolute terms of E0.
    size: f64,
}

impl<const N: usize, const S: usize> Trial for Tried<N, S> {
    fn h(&self) -> f64 {
        self.step.h
    }

    fn residual(&self) -> f64 {
        self.residual
    }

    fn size(&self) -> f64 {
        self.size
    }
}

/// A solved step, with its energies and density.
#[derive(Clone, Copy, Debug)]
pub struct EnergyGaussSolution<const N: usize, const S: usize> {
    step: Step<N, S>,
    /// Increment of the energy of the node.
    gain: f64,
    course: StepHistory,
}

/// Buffers for stiff steps.
type Cache<const N: usize, const S: usize> = Option<Box<Newton<N, S>>>;

/// Largest accepted rounding error of an energy, relative to its terms. With fewer digits the energy is not preserved.
const KNOWN: f64 = 1e-10;
/// Most halvings of the step for the measurement of the step density.
const HALVINGS: u32 = 16;
/// Largest energy error of that measurement, relative to the terms of the energy.
const HELD: f64 = 0.01;

/// A run at a node: the inputs of the search for a step.
struct SearchContext<'a, S, const N: usize, const K: usize> {
    system: &'a S,
    instructions: Instructions,
    node: &'a Node<N>,
    stages: &'a LastStages<N, K>,
    course: &'a StepHistory,
}

impl<S, const N: usize, const K: usize> Clone for SearchContext<'_, S, N, K> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, const N: usize, const K: usize> Copy for SearchContext<'_, S, N, K> {}

impl<const K: usize> EnergyPreservingGauss<K> {
    /// The order: to leading order the slope of `ln (H − E0)` over ln h.
    #[allow(clippy::cast_precision_loss)]
    const ORDER: f64 = 2.0 * K as f64;

    /// The smallest `|H − E|` that determines a length, for energies with this rounding error.
    fn least_excess(rounding: f64) -> f64 {
        // Relative accuracy of the length that the numbers of its step need.
        const PARTS: f64 = 1000.0;
        PARTS * rounding / Self::ORDER
    }
}

impl<'a, S, const N: usize, const K: usize> SearchContext<'a, S, N, K>
where
    S: Collocation<N> + Convertible<N>,
{
    fn of(at: Problem<'a, S, Instructions, N>, memory: &'a Lengths<N, K>) -> Self {
        let Problem { system, prepared, node, .. } = at;
        Self { system, instructions: *prepared, node, stages: &memory.stages, course: &memory.course }
    }

    /// The stages of the step of length h, extrapolated from the last one.
    fn guess(&self, h: f64) -> Stages<N, K> {
        let LastStages { stages, convergence, h: last, .. } = self.stages;
        if convergence.has_begun() { at(&stages.data.0, |c| 1.0 + c * (h / last)) } else { stages.data.0 }
    }

    /// Solves the step of length h, guessed from another step from the same node if there is one, otherwise from the
    /// last step.
    ///
    /// # Errors
    /// Those of a Gauss step; [`StepError::NonFinite`] if its energy is not finite.
    fn tried(&self, h: f64, beside: Option<&Tried<N, K>>, cache: &mut Cache<N, K>) -> Result<Tried<N, K>, StepError> {
        let Self { system, instructions, node, stages: last, course } = *self;
        let stages = beside.map_or_else(
            || self.guess(h),
            |other| {
                let ratio = h / other.h();
                at(&other.step.stages, |c| ratio * c)
            },
        );
        let before = &Convergence { iterations: 0, ..last.convergence };
        let start = Start { node, h, stages: &stages, are_last: false, before, pause: last.pause };
        let by_fixed_point =
            if last.pause.is_over() { start.by_fixed_point(system, instructions).map_err(Some) } else { Err(None) };
        // Lengths differ from step to step, so each has its own linearization.
        let step = by_fixed_point.or_else(|left| start.recover(system, instructions, (left.as_ref(), None), cache))?;
        let energies = energies(system, node, h, step.stages, node.energy);
        let residual = energies.start - node.energy_low - power::<K>(h) * course.shift;
        if !residual.is_finite() {
            return Err(StepError::NonFinite { t: node.t, quantity: "energy", expression: None });
        }
        Ok(Tried { step: Step { linearization: None, ..step }, residual, work: energies.work, size: energies.size })
    }

    /// Rounding-error bound of the energy of a trial by running error analysis, in units of `ε`.
    #[cold]
    fn rounding_of(&self, trial: &Tried<N, K>) -> f64 {
        bounded_energies(self.system, self.node, trial.h(), trial.step.stages, self.node.energy).start.ulps()
    }

    /// Whether the energy of a trial equals the preserved one within its rounding error.
    ///
    /// # Errors
    /// [`StepError::DegenerateStep`] if it does, but `H − E` is too small to determine the length.
    #[cold]
    fn is_kept(&self, trial: &Tried<N, K>) -> Result<bool, StepError> {
        let rounding = f64::EPSILON * self.rounding_of(trial);
        // At a turning point H may be zero although the energies of the trajectory are not.
        let size = trial.size.max(self.course.largest_size);
        if !(trial.residual.abs() <= FLOOR * rounding && rounding <= KNOWN * size) {
            return Ok(false);
        }
        let least = EnergyPreservingGauss::<K>::least_excess(rounding);
        if self.course.excess.abs() < least { Err(self.degenerate()) } else { Ok(true) }
    }

    /// The error if `H − E` does not determine a length.
    fn degenerate(&self) -> StepError {
        let h = self.course.h();
        StepError::DegenerateStep { t: self.node.t, h, density: self.course.excess / power::<K>(h) }
    }

    /// The error if no forward step exists.
    #[cold]
    fn no_step(&self) -> StepError {
        let Self { system, node, course, .. } = *self;
        let told = || course.initial_density::<K>() - course.shift;
        let density = step_density::<S, N, K>(system, &node.state()).unwrap_or_else(|_| told());
        let StepHistory { excess, shift, largest, .. } = *course;
        let largest = largest.max(density.abs());
        StepError::NoForwardGaussStep { t: node.t, h: course.h(), stages: K, excess, density, shift, largest }
    }

    /// The energy-preserving step within the bounds, the slope of its energy over its length, and the iterations of all
    /// trials.
    fn found(&self, cache: &mut Cache<N, K>) -> Result<(Tried<N, K>, f64, u32), StepError> {
        let Self { node, course, .. } = *self;
        let (t, last) = (node.t, course.h());
        let StepHistory { excess, size, largest_size, shift, .. } = *course;
        if excess.abs() < EnergyPreservingGauss::<K>::least_excess(f64::EPSILON * size) {
            return Err(self.degenerate());
        }
        // A trajectory that has only gained speed so far does not show the size of its energies.
        if size < largest_size {
            check_shift::<K>(t, last, shift, largest_size)?;
        }
        // Beyond a sign change of D lies another root.
        if course.density().is_some_and(|density| excess * density < 0.0) {
            return Err(self.no_step());
        }
        let cache = RefCell::new(cache);
        let iterations = Cell::new(0);
        let search = Search {
            solve: &|h, beside| {
                let tried = self.tried(h, beside, &mut cache.borrow_mut())?;
                iterations.set(iterations.get() + tried.step.convergence.iterations);
                Ok(tried)
            },
            is_rounding: &|trial| self.is_kept(trial),
            t,
            predicted: course.predicted_length(),
            last,
            ratio: RATIO,
            excess,
            noise: 0.0,
            slope: course.slope,
            order: EnergyPreservingGauss::<K>::ORDER,
        };
        let (step, slope) = match search.root() {
            Some(found) => found,
            None => (search.smallest()?.ok_or_else(|| self.no_step())?, course.slope),
        };
        let h = step.h();
        if h > last * RATIO || last > h * RATIO {
            return Err(StepError::StepRatio { t, previous: last, found: h });
        }
        course.control.check_bounds(t, h)?;
        Ok((step, slope, iterations.get()))
    }

    /// Computes the energies at the end of a step.
    fn after(&self, trial: &Tried<N, K>) -> Result<EnergyGaussSolution<N, K>, StepError> {
        let Self { system, node, .. } = *self;
        let mut course = *self.course;
        let step = trial.step;
        let mut after = *node;
        after.advance(step.h, &step.increment.velocity, &step.increment.momentum);
        let gain = if !S::AUTONOMOUS || S::FORCED { trial.work } else { 0.0 };
        after.add_energy(gain);
        after.check_finite(node.t)?;
        let measured = measured(system, &after)?;
        // The mean of `H − E0` at the start and of `H − E1` at the end.
        let mean = 0.5 * (course.excess + measured[0]) - trial.residual;
        course.push(step.h, mean / power::<K>(step.h));
        course.set_excess(measured);
        Ok(EnergyGaussSolution { step, gain, course })
    }
}

/// The search for the next step, with the buffers for stiff steps.
struct Searching<'a, S, const N: usize, const K: usize> {
    here: SearchContext<'a, S, N, K>,
    cache: RefCell<&'a mut Cache<N, K>>,
}

impl<S, const N: usize, const K: usize> Alternating<f64> for Searching<'_, S, N, K>
where
    S: Collocation<N> + Convertible<N>,
{
    const POWER: f64 = EnergyPreservingGauss::<K>::ORDER + 1.0;
    type StepSolution = EnergyGaussSolution<N, K>;

    fn control(&self) -> &Control {
        &self.here.course.control
    }

    fn t(&self) -> f64 {
        self.here.node.t
    }

    fn last(&self) -> [f64; 2] {
        [self.here.course.h(), self.here.course.initial_density::<K>()]
    }

    fn preserving(&self, gap: f64) -> Result<(EnergyGaussSolution<N, K>, f64), StepError> {
        let (mut node, mut course) = (*self.here.node, *self.here.course);
        if gap != 0.0 {
            node.add_energy(gap);
            course.set_excess(measured(self.here.system, &node)?);
        }
        let here = SearchContext { node: &node, course: &course, ..self.here };
        let (trial, slope, iterations) = here.found(&mut self.cache.borrow_mut())?;
        let mut found = here.after(&trial)?;
        found.gain += gap;
        found.course.residual = match trial.roundings() {
            few if few <= FLOOR => few,
            _ => roundings(trial.residual, here.rounding_of(&trial)),
        };
        (found.course.slope, found.course.iterations) = (slope, iterations);
        Ok((found, trial.h()))
    }

    fn fixed(&self, h: f64) -> Result<(EnergyGaussSolution<N, K>, [f64; 2]), StepError> {
        let trial = self.here.tried(h, None, &mut self.cache.borrow_mut())?;
        let last = self.here.course.initial_density::<K>();
        let mut found = self.here.after(&trial)?;
        found.course.residual = 0.0;
        found.course.forget_lengths();
        found.course.iterations = trial.step.convergence.iterations;
        let density = found.course.initial_density::<K>();
        // The next interval has the same length.
        Ok((found, [trial.residual, density + (density - last)]))
    }

    fn control_of(found: &mut EnergyGaussSolution<N, K>) -> &mut Control {
        &mut found.course.control
    }
}

/// `H − E'` at a node, and the size of the terms of H.
///
/// # Errors
/// As [`State::velocity`]; [`StepError::NonFinite`] if H is not finite.
fn measured<S: Lagrangian<N>, const N: usize>(system: &S, node: &Node<N>) -> Result<[f64; 2], StepError> {
    let State { t, .. } = node.state();
    let NodeEnergy { total, size } = energy_at(system, &node.state())?;
    let excess = (total - node.energy) - node.energy_low;
    if excess.is_finite() && size.is_finite() {
        Ok([excess, size])
    } else {
        Err(StepError::NonFinite { t, quantity: "energy", expression: None })
    }
}

/// The energy at a state.
struct NodeEnergy {
    /// H.
    total: f64,
    /// The size of its terms, `|v·p| + |H|`.
    size: f64,
}

fn energy_at<S: Lagrangian<N>, const N: usize>(
    system: &S,
    State { t, q, p }: &State<N>,
) -> Result<NodeEnergy, StepError> {
    let v = system.flow(*t, q, p)?.v;
    let total = system.energy(*t, q, &v);
    Ok(NodeEnergy { total, size: v.dot(p).abs() + total.abs() })
}

/// Rejects a shift that adds more to the energy of a step of the length h than `size`, the size of the energy terms
/// along the trajectory.
///
/// # Errors
/// [`StepError::ShiftTooLarge`].
fn check_shift<const K: usize>(t: f64, h: f64, shift: f64, size: f64) -> Result<(), StepError> {
    let part = power::<K>(h) * shift.abs();
    if part <= size {
        return Ok(());
    }
    let shorter = h * (0.1 * size / part).powf(EnergyPreservingGauss::<K>::ORDER.recip());
    Err(StepError::ShiftTooLarge { t, h, shift, part, size, shorter })
}

/// The memory before the first step, which preserves the energy of the node.
fn begun<S, const N: usize, const K: usize>(system: &S, node: &Node<N>, h: f64) -> Result<Lengths<N, K>, StepError>
where
    S: Collocation<N>,
{
    let mut course = StepHistory::new(h, EnergyPreservingGauss::<K>::ORDER);
    let stages = LastStages::constant(system, node, h)?;
    course.set_excess(measured(system, node)?);
    Ok(Lengths { stages, course })
}

impl<S, const N: usize, const STAGES: usize> Method<S, N> for EnergyPreservingGauss<STAGES>
where
    S: Collocation<N> + Convertible<N>,
{
    type Prepared = Instructions;
    type Memory = Lengths<N, STAGES>;
    type Cache = Cache<N, STAGES>;
    type Step = EnergyGaussSolution<N, STAGES>;
    type Left = StepError;
    type DenseOutput = GaussOutput<N, STAGES>;

    const FINDS_LENGTH: bool = true;

    #[allow(clippy::cast_possible_truncation)] // 16 stages at most
    fn order(&self) -> u32 {
        2 * STAGES as u32
    }

    fn check_length(&self, h: f64) -> Result<(), StepError> {
        check_forward(FORWARD, h)?;
        if power::<STAGES>(h).is_normal() {
            return Ok(());
        }
        let (input, allowed) = ("the step h", "so long that C h^2s is a number");
        Err(StepError::InvalidInput { input, allowed, value: h })
    }

    fn prepare(&self, _system: &S, _h: f64) -> Instructions {
        Instructions::detected()
    }

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        check_density::<N, f64, S>()?;
        node.energy = 0.0;
        let mut memory = begun(system, node, h)?;
        let at = Problem { system, prepared: &Instructions::detected(), node, h };
        let first = SearchContext::of(at, &memory).tried(h, None, &mut None)?;
        node.energy = first.residual;
        // The start has already solved the stages of the first step.
        memory.stages.stages = SMatrix::from_array_storage(ArrayStorage(first.step.stages));
        memory.course.set_excess(measured(system, node)?);
        Ok(memory)
    }

    /// The search of a step, compiled once.
    #[inline(never)]
    fn attempt(
        &self,
        at: Problem<'_, S, Instructions, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, StepError> {
        Searching { here: SearchContext::of(at, memory), cache: RefCell::new(cache) }.next()
    }

    fn recover(
        &self,
        _at: Problem<'_, S, Instructions, N>,
        _memory: &Self::Memory,
        _cache: &mut Self::Cache,
        left: StepError,
    ) -> Result<Self::Step, StepError> {
        Err(left)
    }

    fn take(
        &self,
        _h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        _cache: &mut Self::Cache,
        step: Self::Step,
    ) {
        memory.stages.take(node, &step.step);
        node.add_energy(step.gain);
        memory.course = step.course;
    }

    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N>, &Self::Memory),
        [h, _]: [f64; 2],
    ) -> Result<(Node<N>, Self::Memory), StepError> {
        check_forward("the step h", h)?;
        let at = Problem { system, prepared: &Instructions::detected(), node, h };
        let Tried { step, residual, work, .. } = SearchContext::of(at, memory).tried(h, None, &mut None)?;
        let mut after = *node;
        after.advance(h, &step.increment.velocity, &step.increment.momentum);
        after.add_energy(work);
        after.check_finite(node.t)?;
        let mut course = memory.course;
        course.set_excess(measured(system, &after)?);
        course.control.phase = course.control.phase.map(|phase| Phase { gap: residual, ..phase });
        let stages = LastStages::constant(system, &after, course.h())?;
        Ok((after, Lengths { stages, course }))
    }

    fn with_length(
        &self,
        _system: &S,
        memory: &Self::Memory,
        _node: &Node<N>,
        _h: f64,
    ) -> Result<Self::Memory, StepError> {
        Ok(*memory)
    }

    fn with_system(
        &self,
        [before, after]: [&S; 2],
        node: &mut Node<N>,
        _h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        let state = node.state();
        let mut changed = *node;
        changed.add_energy(state.energy(after)? - state.energy(before)?);
        let mut memory = *memory;
        memory.course.set_excess(measured(after, &changed)?);
        memory.stages.before = changed;
        *node = changed;
        Ok(memory)
    }

    fn with_state(
        &self,
        system: &S,
        node: &mut Node<N>,
        _h: f64,
        memory: &Self::Memory,
        state: State<N>,
    ) -> Result<Self::Memory, StepError> {
        let brought = state.energy(system)? - node.state().energy(system)?;
        *node = node.with_state(state);
        node.add_energy(brought);
        let mut course = memory.course;
        course.set_excess(measured(system, node)?);
        Ok(Lengths { stages: LastStages::constant(system, node, course.h())?, course })
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<GaussOutput<N, STAGES>, StepError> {
        memory.stages.dense_output(system, before, node, h)
    }

    fn length(&self, _h: f64, memory: &Self::Memory) -> f64 {
        memory.course.h()
    }

    fn longest(&self, _h: f64, memory: &Self::Memory) -> f64 {
        memory.course.control.longest(memory.course.h())
    }

    fn report(&self, memory: &Self::Memory) -> Report {
        let Lengths { stages, course } = memory;
        Report { residual: stages.convergence.change.max(course.residual), iterations: course.iterations }
    }

    fn discrete_energy(&self, _system: &S, node: &Node<N>, _h: f64, memory: &Self::Memory) -> Option<f64> {
        let course = &memory.course;
        Some(node.energy + course.control.gap() + power::<STAGES>(course.h()) * course.shift)
    }

    fn check(&self, memory: &Self::Memory, _h: f64, t: f64) -> Result<(), StepError> {
        memory.stages.check(t)?;
        memory.course.check(t)
    }
}

impl<const STAGES: usize> EnergyPreservingGauss<STAGES> {
    /// A run of `system` from `state` that preserves `energy`, in units of L. The first step has about the length `h`,
    /// up to a factor of 3. H at the state differs from that energy by `C_s h^2s D_s`; for `E = H` itself no step
    /// length exists.
    ///
    /// # Errors
    /// As [`integrate`](crate::run::Start::integrate); [`StepError::NonFinite`] for an energy that is not finite.
    pub fn from_energy<S, const N: usize>(
        system: S,
        state: State<N>,
        energy: f64,
        h: f64,
    ) -> Result<Run<Self, S, N>, StepError>
    where
        S: Collocation<N> + Convertible<N>,
    {
        Method::<S, N>::check_length(&Self, h)?;
        let node = Node::new(state, energy);
        let memory = begun(&system, &node, h)?;
        Ok(Run::resumed(Self, system, (node, h, memory)))
    }
}

/// Options and results that only such a run has.
impl<S, const N: usize, const STAGES: usize> Run<EnergyPreservingGauss<STAGES>, S, N>
where
    S: Collocation<N> + Convertible<N>,
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
        let course = &mut self.memory.course;
        let change = shift - course.shift;
        self.node.add_energy(-power::<STAGES>(course.h()) * change);
        course.shift = shift;
        course.densities = course.densities.map(|densities| densities.map(|density| density + change));
        course.set_excess(measured(&self.system, &self.node)?);
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
    /// preserve the energy; [`StepError::ShiftTooLarge`] if the first step is too long for this shift; those of Gauss
    /// steps and of [`step_density`].
    pub fn with_shift_from(mut self, duration: f64) -> Result<Self, StepError> {
        check_forward("the duration over which the step density is measured", duration)?;
        let mut h = self.memory.course.h();
        for _ in 0..HALVINGS {
            if let Some(Maxima { density, scale, size }) = self.met_along(h, duration)? {
                let shift = 2.0 * density;
                check_shift::<STAGES>(self.node.t, self.memory.course.h(), shift, scale)?;
                let course = &mut self.memory.course;
                course.largest_size = course.largest_size.max(size);
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

    /// The stages of a step of the length h from here, regardless of its energy.
    ///
    /// # Errors
    /// Those of a Gauss step; [`StepError::NonFinite`] if its energy is not finite.
    pub(crate) fn stages_of(&self, h: f64) -> Result<Stages<N, STAGES>, StepError> {
        let Self { system, prepared, node, memory, .. } = self;
        let at = Problem { system, prepared, node, h };
        Ok(SearchContext::of(at, memory).tried(h, None, &mut None)?.step.stages)
    }

    /// Maxima along fixed steps of the length h over `duration` from here; `None` if their energy error is too large.
    fn met_along(&self, h: f64, duration: f64) -> Result<Option<Maxima>, StepError> {
        let system = &self.system;
        let mut steps = Starts::at_state(*system, self.node.state()).integrate(Gauss::<STAGES>, h)?;
        let end = self.node.t + duration;
        let density = |state: &State<N>| step_density::<S, N, STAGES>(system, state).map(f64::abs);
        let mut before = energy_at(system, &steps.state())?;
        let mut met = Maxima { density: density(&steps.state())?, scale: 0.0, size: before.size };
        let mut kinetic = 0.0;
        let mut count = 0.0;
        let mut largest_missed = 0.0_f64;
        while steps.node.t < end {
            match steps.step() {
                Ok(_) => {}
                Err(StepError::StagesUnsettled { .. }) => return Ok(None),
                Err(failure) => return Err(failure),
            }
            let state = steps.state();
            let after = energy_at(system, &state)?;
            let LastStages { before: start, stages, .. } = &steps.memory;
            let of_step = energies(system, start, h, stages.data.0, before.total);
            let missed = of_step.start.abs().max((of_step.end + (before.total - after.total)).abs());
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
    /// work of forces and by an explicit time. During fixed steps it is the previous value plus the work done since.
    pub fn shifted_energy(&self) -> f64 {
        self.node.energy
    }

    /// The shift D_* of the step density.
    pub fn shift(&self) -> f64 {
        self.memory.course.shift
    }

    /// Step density D_s of the last step, without the shift, from its energy: the mean of `H − E` at both ends over
    /// `C_s h^2s`. Before the first step, at its start.
    pub fn density(&self) -> f64 {
        self.memory.course.initial_density::<STAGES>() - self.memory.course.shift
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
