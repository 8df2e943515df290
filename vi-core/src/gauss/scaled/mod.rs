//! Gauss steps in scaled time, `dt = g(t, q) dτ`: steps of order 2S that follow the motion.
//!
//! In: a system with the clause `time_scale = g;`, a state, the step Δτ in scaled time (negative: backwards), and the number of stages S,
//! 1 to 16. Out: an iterator of states, at times whose distance is about g Δτ. A step is Gauss collocation of the Hamiltonian
//! `K = g (H − E)` in extended phase space, where t is a coordinate and −E its momentum: with Δτ constant, h is short where g is small.
//! With `H = V·P − L` at a stage and F = L_q + f,
//!
//! ```text
//! t' = g        q' = g v        p' = g F − (H − E) ∂g/∂q        E' = g (f·v − L_t) + (H − E) ∂g/∂t        L_v = p
//! ```
//!
//! all four collocated. Along the motion H = E: E starts as H of the first state, and is constant where the system is autonomous, has
//! no force and g no time in it. The map is symplectic in extended phase space where no force acts, time-symmetric, and keeps the momenta of
//! symmetries that g shares, as the angular momentum for g(r) (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, VIII.2.1;
//! Leimkuhler and Reich, *Simulating Hamiltonian Dynamics*, chapter 9).
//!
//! | file | part of a step |
//! |---|---|
//! | `equations` | the equations of the stages, solved by sweeps, else by simplified Newton iterations |
//! | `run` | what a run carries from step to step |
//! | `path` | the motion between the nodes of a step |
//! | `integrator` | what it shares with the other integrators; steps of a given length in time |
//! | `rounding` | whether stages that stall are solved, by running error analysis |
//!
//! AFTER A STEP what its stages leave of their equations was measured, and is at the rounding floor; g is positive and finite at all of
//! them, and at the state reached. AFTER AN ERROR the integrator holds the last good state and keeps returning that error.

mod equations;
mod integrator;
mod path;
mod rounding;
mod run;

use super::lost_force;
use super::newton::{Linearization, Newton};
use super::points::Rare;
use super::stages::{Stages, stage};
use super::sweep::{self, Equations, Increment, Sweeps};
use crate::checkpoint;
use crate::collocation::{Collocation, TimeScale};
use crate::error::StepError;
use crate::node::Node;
use crate::real::{Lane, Real, Rounded};
use crate::state::State;
use crate::stepping::Convertible;
use equations::{Clock, Rates, Scaled};
pub use path::Polynomial;
pub use run::Run;
use run::time_scale;
use vi_dispatch::{Instructions, Loop};

/// Steps of order 2 STAGES in scaled time; see the [module](self).
#[derive(Clone, Debug)]
pub struct ScaledGauss<S, const N: usize, const STAGES: usize> {
    system: S,
    instructions: Instructions,
    run: Run<N, STAGES>,
    /// Made where the first step needs it.
    newton: Option<Box<Newton<N, STAGES>>>,
    failure: Option<StepError>,
}

/// Everything that a run of [`ScaledGauss`] carries, to be stored and resumed bit for bit.
pub type Checkpoint<const N: usize, const STAGES: usize> = checkpoint::Checkpoint<Run<N, STAGES>>;

impl<S, const N: usize, const STAGES: usize> ScaledGauss<S, N, STAGES>
where
    S: TimeScale<N> + Convertible<N>,
{
    /// The integrator of `system` from `state` with the step `dtau`, in units of scaled time: the time over the unit of g.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a Δτ that is zero, subnormal or not finite, [`StepError::NonFinite`] for such a state or energy,
    /// [`StepError::TimeScale`] where g is not positive and finite, [`StepError::Singular`] or [`StepError::NotConverged`] where no velocity
    /// belongs to its momenta, [`StepError::NoTimeScale`] for a [`Called`](crate::Called) system without one.
    pub fn new(system: S, state: State<N>, dtau: f64) -> Result<Self, StepError> {
        if !S::SCALES_TIME {
            return Err(StepError::NoTimeScale { system: S::NAME });
        }
        check_dtau(dtau)?;
        let energy = state.energy(&system)?;
        let run = Run::new(&system, Node::new(state, energy), dtau)?;
        Ok(Self { system, instructions: Instructions::detected(), run, newton: None, failure: None })
    }

    /// Everything that the run carries, and of which system with which parameters. Allocates.
    pub fn checkpoint(&self) -> Checkpoint<N, STAGES> {
        checkpoint::Checkpoint::of(&self.system, None, self.run)
    }

    /// The run that was at `checkpoint`, bit for bit, on a processor with the same instructions.
    ///
    /// # Errors
    /// [`StepError::OtherSystem`] for a checkpoint of another system or of other parameters; [`StepError::NonFinite`] and
    /// [`StepError::InvalidInput`] for one that no run can have left.
    pub fn restart(system: S, checkpoint: Checkpoint<N, STAGES>) -> Result<Self, StepError> {
        let run = checkpoint.run_of(&system, None)?;
        check_dtau(run.dtau)?;
        let t = if run.node.t.is_finite() { run.node.t } else { 0.0 };
        run.node.check_finite(t)?;
        if !run.velocities.iter().chain(run.clock.iter()).chain([&run.taken, &run.h]).all(|entry| entry.is_finite()) {
            return Err(StepError::NonFinite { t, quantity: "last stages", expression: None });
        }
        Ok(Self { system, instructions: Instructions::detected(), run, newton: None, failure: None })
    }

    /// Takes one step and returns the state reached.
    ///
    /// # Errors
    /// [`StepError::StagesUnsettled`] where the stages do not come to rest: Δτ is too long for the fastest motion of the system;
    /// [`StepError::TimeScale`] where g is not positive and finite at a stage, or at the state reached, or too small for the time to go on or the energy to stay;
    /// [`StepError::NonFinite`]. The same error again after an error.
    pub fn step(&mut self) -> Result<State<N>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        // No `?`: with it a step copies the run once more.
        match self.solve() {
            Ok(run) => self.run = run,
            Err(failure) => {
                self.failure = Some(failure);
                return Err(failure);
            }
        }
        Ok(self.run.node.state())
    }

    /// The run after the next step.
    fn solve(&mut self) -> Result<Run<N, STAGES>, StepError> {
        if !self.run.pause.is_over() {
            return self.solve_with_care(None);
        }
        let swept = if S::SIDE_BY_SIDE {
            self.instructions.run(Solve { system: &self.system, run: &self.run })
        } else {
            solved_plainly(&self.system, &self.run, None)
        };
        let run = self.run.after(&swept);
        let is_solved = swept.is_at_floor() && run.is_sound(&self.system) && run.goes_on(&self.run, &swept);
        if is_solved { Ok(run) } else { self.solve_with_care(Some(&swept)) }
    }

    /// The run after a step that sweeps do not bring to the rounding of its positions, or that they are not tried on, or whose g is not
    /// positive.
    #[cold]
    fn solve_with_care(&mut self, swept: Option<&Solved<N, STAGES>>) -> Result<Run<N, STAGES>, StepError> {
        if let Some(swept) = swept {
            // Plain numbers have sines and cosines of every angle; lanes lose what is not near.
            let plain;
            let solved = if swept.increment.is_finite() {
                swept
            } else {
                plain = solved_plainly(&self.system, &self.run, None);
                &plain
            };
            if let Some(run) = self.accepted(solved, self.run.after(solved)) {
                return Ok(run);
            }
        }
        let solved = self.solve_stiff();
        let run = self.run.after_newton(&solved);
        self.accepted(&solved, run).ok_or_else(|| self.failure_of(&solved, &run))
    }

    /// The run after a solved step, with the number by which the step is judged: the last change of its stages, or, where that stalls, what
    /// they leave of their equations by running error analysis. None where that is not rounding, or the run cannot go on.
    fn accepted(&self, solved: &Solved<N, STAGES>, mut after: Run<N, STAGES>) -> Option<Run<N, STAGES>> {
        if !solved.is_at_floor() && !solved.sweeps.are_given_up {
            let Run { node, dtau, .. } = &self.run;
            after.convergence.change = rounding::residual(&self.system.convert::<Rounded>(), node, *dtau, solved);
        }
        (after.convergence.is_at_floor() && after.is_sound(&self.system) && after.goes_on(&self.run, solved))
            .then_some(after)
    }

    /// Why a step was not solved.
    fn failure_of(&self, solved: &Solved<N, STAGES>, after: &Run<N, STAGES>) -> StepError {
        let Run { node, dtau, h, .. } = &self.run;
        let stages = (0..STAGES).map(|i| (solved.clock.time[i], stage(&solved.sweeps.positions, i)));
        for (t, q) in stages.chain([(after.node.t, after.node.q)]) {
            let is_known = t.is_finite() && q.iter().all(|q: &f64| q.is_finite());
            if is_known && let Err(failure) = check_time_scale(t, time_scale(&self.system, t, &q)) {
                return failure;
            }
        }
        if let Some(failure) = lost_force(&self.system, node, *h) {
            return failure;
        }
        if after.convergence.is_at_floor() && !after.goes_on(&self.run, solved) {
            return StepError::TimeScale { t: node.t, g: solved.rates.g[0] };
        }
        let stiffness = self.newton.as_ref().map_or(f64::INFINITY, |newton| newton.stiffness());
        let h = time_scale(&self.system, node.t, &node.q) * dtau;
        solved.sweeps.convergence.unsettled(&solved.increment, [node.t, h], stiffness)
    }

    /// The step by simplified Newton iterations about its middle.
    fn solve_stiff(&mut self) -> Solved<N, STAGES> {
        let Self { system, run, newton, .. } = self;
        let rates = run.guess::<false>();
        let equations = Scaled::<f64, S, N, STAGES, false>::new(system, &run.node, run.dtau, rates, None);
        let middle = STAGES / 2;
        let h = run.dtau * rates.g[middle];
        let q = stage(&equations.start(), middle);
        let v = stage(&rates.velocity, middle);
        let newton = newton.get_or_insert_with(|| Box::new(Newton::new()));
        let t = run.node.t + 0.5 * h;
        newton.linearize(&Rare::of(system), Linearization { h, t, q, v, iterations: None });
        solved_plainly(system, run, Some(newton))
    }

    /// The state reached last.
    pub fn state(&self) -> State<N> {
        self.run.node.state()
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The step, in units of scaled time.
    pub fn dtau(&self) -> f64 {
        self.run.dtau
    }

    /// Length of the last step in time, `Δτ Σ b_i g_i`; before the first step what it is about to be, `g Δτ` at the first state. It
    /// differs from step to step.
    pub fn h(&self) -> f64 {
        self.run.h
    }

    /// The discrete energy E that is carried, −E the momentum of the time, in the units of L: H of the first state, and from there what the power
    /// `f·v − L_t` adds. Constant where the system is autonomous, has no force and g no time in it.
    pub fn discrete_energy(&self) -> f64 {
        self.run.node.energy
    }

    /// `H − E` at the state reached last, in the units of L: by so much the step misses the energy of the motion. It stays small and does
    /// not drift, while `K = g (H − E)` is zero along the motion.
    ///
    /// # Errors
    /// [`StepError::Singular`] or [`StepError::NotConverged`] where no velocity belongs to the momenta.
    pub fn excess(&self) -> Result<f64, StepError> {
        let energy = self.run.node.state().energy(&self.system)?;
        Ok(energy - self.run.node.energy)
    }

    /// The number by which the last step was accepted, 4 at most: by how much its stages still change, in roundings of the coordinates, or, where
    /// that stalls above their rounding, what they leave of their equations over its rounding-error bound. Zero before the first step.
    pub fn residual(&self) -> f64 {
        self.run.convergence.change
    }

    /// Sweeps over the stages that the last step took.
    pub fn iterations(&self) -> u32 {
        self.run.convergence.sweeps
    }
}

/// A solved step.
struct Solved<const N: usize, const S: usize> {
    increment: Increment<N>,
    /// What time and energy gain.
    gains: [f64; 2],
    /// The largest `|H − E|` at its stages, and the size of the terms of H there.
    excess: [f64; 2],
    /// What the next step is extrapolated from.
    rates: Rates<N, S>,
    /// Velocities, times and energies at which the last sweep evaluated.
    velocity: Stages<N, S>,
    clock: Clock<S>,
    sweeps: Sweeps<N, S>,
}

impl<const N: usize, const S: usize> Solved<N, S> {
    /// Whether the stages are at the rounding of their positions.
    fn is_at_floor(&self) -> bool {
        self.sweeps.convergence.is_at_floor()
    }
}

/// The solution of the next step of a run, by the instructions of the processor.
struct Solve<'a, Y, const N: usize, const S: usize> {
    system: &'a Y,
    run: &'a Run<N, S>,
}

impl<Y: Convertible<N>, const N: usize, const S: usize> Loop for Solve<'_, Y, N, S> {
    type Output = Solved<N, S>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Solved<N, S> {
        let system = self.system.convert::<Lane<FUSED>>();
        solved::<Lane<FUSED>, _, N, S, FUSED>(&system, self.run, None)
    }
}

/// The next step of a run in plain numbers. Not inlined: where vectors do not solve it, speed is no matter.
#[inline(never)]
fn solved_plainly<Y: Collocation<N>, const N: usize, const S: usize>(
    system: &Y,
    run: &Run<N, S>,
    newton: Option<&Newton<N, S>>,
) -> Solved<N, S> {
    solved::<f64, Y, N, S, false>(system, run, newton)
}

/// The next step of a run, the equations evaluated in the numbers T; by sweeps, else by Newton's iteration.
#[inline(always)]
fn solved<T, Y, const N: usize, const S: usize, const FUSED: bool>(
    system: &Y,
    run: &Run<N, S>,
    newton: Option<&Newton<N, S>>,
) -> Solved<N, S>
where
    T: Real,
    Y: Collocation<N, T>,
{
    let rates = run.guess::<FUSED>();
    let mut equations = Scaled::<T, Y, N, S, FUSED>::new(system, &run.node, run.dtau, rates, newton);
    let sweeps = sweep::solve(&mut equations, &run.convergence);
    Solved {
        increment: equations.increment(),
        gains: equations.gains(),
        excess: equations.excess(),
        rates: equations.rates(),
        velocity: equations.velocity(),
        clock: equations.evaluated(),
        sweeps,
    }
}

/// A step in scaled time must lead somewhere.
fn check_dtau(dtau: f64) -> Result<(), StepError> {
    if dtau.is_normal() {
        return Ok(());
    }
    let allowed = "finite, not zero and not subnormal";
    Err(StepError::InvalidInput { input: "the step Δτ in scaled time", allowed, value: dtau })
}

/// Time must go on.
fn check_time_scale(t: f64, g: f64) -> Result<(), StepError> {
    if g > 0.0 && g.is_finite() { Ok(()) } else { Err(StepError::TimeScale { t, g }) }
}

impl<S, const N: usize, const STAGES: usize> Iterator for ScaledGauss<S, N, STAGES>
where
    S: TimeScale<N> + Convertible<N>,
{
    type Item = Result<State<N>, StepError>;

    /// The next step; never `None`. After an error, the same error.
    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}
