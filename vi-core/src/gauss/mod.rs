//! Fixed steps of order 2S: Galerkin variational integrators at the S Gauss points.
//!
//! In: a system, a state, the step h (negative: backwards in time), and the number of stages S, 1 to 16. Out: an iterator of states.
//! With the tableau a, b, c of Gauss collocation and the stages `T_i = t0 + c_i h`, a step solves
//!
//! ```text
//! Q_i = q0 + h Σ a_ij V_j        L_v(T_i, Q_i, V_i) = p0 + h Σ a_ij (L_q + f)_j
//! q1  = q0 + h Σ b_i V_i         p1 = p0 + h Σ b_i (L_q + f)_i        E1 = Σ b_i En_i − h Σ b_i c_i (L_t − f·v)_i
//! ```
//!
//! En_i the energy at a stage. It is the variational integrator of the discrete Lagrangian `L_d = h Σ b_i L_i`: symplectic where no force
//! acts, time-symmetric, and momenta of cyclic coordinates are kept bit for bit. S = 1 is the midpoint rule
//! (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, II.1.3 and VI.6.2).
//!
//! | file | part of a step |
//! |---|---|
//! | `tableau` | the coefficients, computed by the compiler in twice the precision (`pair`) |
//! | `stages` | numbers of all stages side by side |
//! | `separable`, `general` | the equations of the stages: forces of the position alone, and any system |
//! | `sweep` | the solution, by sweeps over the stages until they no longer move |
//! | `points` | a system as these equations see it, and as rare code does |
//! | `newton` | else by simplified Newton iterations about the middle of the step |
//! | `modes` | the basis in which these are small systems of equations |
//! | `polynomial` | the motion between the nodes of a step |
//! | `integrator` | what it shares with the other integrators |
//! | `slots` | its discrete Lagrangian, with derivatives, forces and powers, for checks |
//! | `variation` | derivatives of a step |
//! | `rounding` | whether stages that stall are solved, by running error analysis |
//! | [`scaled`] | steps in scaled time, for systems that say how |
//!
//! AFTER A STEP what its stages leave of their equations was measured, and is at the rounding floor. AFTER AN ERROR the integrator
//! holds the last good state and keeps returning that error.

// The index is that of several arrays, of which a vector register holds neighbours.
#![allow(clippy::needless_range_loop)]

mod energies;
pub mod energy;
mod general;
mod integrator;
mod modes;
mod newton;
mod pair;
mod points;
mod polynomial;
mod rounding;
pub mod scaled;
mod separable;
mod slots;
mod stages;
mod sweep;
mod tableau;
mod variation;

use crate::checkpoint;
use crate::collocation::Collocation;
use crate::error::StepError;
use crate::fixed_step::check_step;
use crate::node::Node;
use crate::real::{Lane, Lanes};
use crate::state::State;
use crate::stepping::{Convertible, FixedStepping};
use energies::energies;
use general::General;
pub use integrator::Motion;
use nalgebra::SMatrix;
use newton::{Linearization, Newton};
use points::{Form, Points, Rare};
pub use polynomial::Polynomial;
use separable::Separable;
pub use slots::Slots;
use stages::{AtStages, LOOPED, Stages, constant_mass, extrapolated, mass, stage};
use sweep::{Convergence, Equations, Increment, Pause, Sweeps};
use vi_dispatch::{Instructions, Loop};

/// Fixed steps of order 2 STAGES; see the [module](self).
#[derive(Clone, Debug)]
pub struct Gauss<S, const N: usize, const STAGES: usize> {
    system: S,
    instructions: Instructions,
    run: Run<N, STAGES>,
    /// Made where the first step needs it.
    newton: Option<Box<Newton<N, STAGES>>>,
    failure: Option<StepError>,
}

/// Everything that a run of [`Gauss`] carries, to be stored and resumed bit for bit.
pub type Checkpoint<const N: usize, const STAGES: usize> = checkpoint::Checkpoint<Stored<N, STAGES>>;

/// A run, and where the equations of its stiff steps are linearized.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stored<const N: usize, const S: usize> {
    run: Run<N, S>,
    linearization: Option<Linearization<N>>,
}

/// What a run carries from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Run<const N: usize, const S: usize> {
    node: Node<N>,
    /// The node before the last step.
    before: Node<N>,
    h: f64,
    /// Velocities at the stages of the last step, forces there of a separable system: a column a coordinate. Before the first
    /// step those of the node.
    stages: SMatrix<f64, S, N>,
    convergence: Convergence,
    pause: Pause,
}

impl<S, const N: usize, const STAGES: usize> Gauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N> + FixedStepping<N>,
{
    /// The integrator of `system` from `state` with the step `h`, in units of time.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite, [`StepError::NonFinite`] for such a state,
    /// [`StepError::Singular`] or [`StepError::NotConverged`] where no velocity belongs to its momenta.
    pub fn new(system: S, state: State<N>, h: f64) -> Result<Self, StepError> {
        check_step(h)?;
        let run = Run::new(&system, Node::new(state, 0.0), h)?;
        Ok(Self { system, instructions: Instructions::detected(), run, newton: None, failure: None })
    }

    /// Everything that the run carries, and of which system with which parameters. Allocates.
    pub fn checkpoint(&self) -> Checkpoint<N, STAGES> {
        let linearization = self.newton.as_ref().and_then(|newton| newton.linearization());
        checkpoint::Checkpoint::of(&self.system, Stored { run: self.run, linearization })
    }

    /// The run that was at `checkpoint`, bit for bit, on a processor with the same instructions.
    ///
    /// # Errors
    /// [`StepError::OtherSystem`] for a checkpoint of another system or of other parameters; [`StepError::NonFinite`] and
    /// [`StepError::InvalidInput`] for one that no run can have left.
    pub fn restart(system: S, checkpoint: Checkpoint<N, STAGES>) -> Result<Self, StepError> {
        let Stored { run, linearization } = checkpoint.run_of(&system)?;
        check_step(run.h)?;
        let t = if run.node.t.is_finite() { run.node.t } else { 0.0 };
        run.node.check_finite(t)?;
        run.before.check_finite(t)?;
        if !run.stages.iter().all(|entry| entry.is_finite()) {
            return Err(StepError::NonFinite { t, quantity: "last stages", expression: None });
        }
        let newton = match linearization {
            None => None,
            Some(at) if at.is_finite() => Some(Box::new(Newton::at(&Rare::of(&system), at))),
            Some(_) => return Err(StepError::NonFinite { t, quantity: "point of linearization", expression: None }),
        };
        Ok(Self { system, instructions: Instructions::detected(), run, newton, failure: None })
    }

    /// Takes one step of the length `h` instead of the next one; the step of the run stays.
    ///
    /// # Errors
    /// As [`Gauss::step`], and [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite; the run is then what it was, and
    /// may go on.
    pub fn step_of(&mut self, h: f64) -> Result<State<N>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        check_step(h)?;
        let start = Run::new(&self.system, self.run.node, h)?;
        let mut aside = Self { system: self.system, run: start, newton: None, ..*self };
        let state = aside.step()?;
        self.run = Run::new(&self.system, aside.run.node, self.run.h)?;
        self.forget_linearization();
        Ok(state)
    }

    /// Takes one step and returns the state reached.
    ///
    /// # Errors
    /// [`StepError::StagesUnsettled`] where the stages do not come to rest: h is too long for the fastest motion of the system;
    /// [`StepError::NonFinite`]. The same error again after an error.
    pub fn step(&mut self) -> Result<State<N>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        if let Err(failure) = self.advance() {
            self.failure = Some(failure);
            return Err(failure);
        }
        Ok(self.run.node.state())
    }

    /// Moves the run to the next node, or leaves it.
    #[inline(always)]
    fn advance(&mut self) -> Result<(), StepError> {
        if !self.run.pause.is_over() {
            return self.advance_with_care(None);
        }
        let Self { system, instructions, run, .. } = self;
        let unsettled = if !S::SIDE_BY_SIDE {
            run.swept(run.solved_plainly(&Rare::of(system), None))
        } else if const { N > LOOPED } {
            long_step(*instructions, Solve { system, run, newton: None })
        } else {
            instructions.run(Solve { system, run, newton: None })
        };
        if unsettled.is_none() { Ok(()) } else { self.advance_with_care(unsettled.as_ref()) }
    }

    /// The same where sweeps do not bring a step to the rounding of its positions, or are not tried.
    #[cold]
    fn advance_with_care(&mut self, swept: Option<&Solved<N, STAGES>>) -> Result<(), StepError> {
        if let Some(run) = swept.and_then(|swept| self.run.accepted(&Rare::of(&self.system), swept, None)) {
            self.run = run;
            return Ok(());
        }
        let mut newton = self.newton.take().unwrap_or_else(|| Box::new(Newton::new()));
        let outcome = self.solved_by_newton(&mut newton).map(|run| {
            newton.keep(run.convergence.sweeps);
            self.run = run;
        });
        if outcome.is_err() {
            // A run that is restarted here begins with a new one too.
            newton.forget();
        }
        self.newton = Some(newton);
        outcome
    }

    /// Takes a new linearization for the next stiff step.
    fn forget_linearization(&mut self) {
        if let Some(newton) = &mut self.newton {
            newton.forget();
        }
    }

    /// The run after the next step by Newton's iteration: about the last linearization, else a new one, else from stages that are all like the node,
    /// for the polynomials of the last step may lead far away.
    fn solved_by_newton(&self, newton: &mut Newton<N, STAGES>) -> Result<Run<N, STAGES>, StepError> {
        let Self { system, run, .. } = self;
        if newton.linearization().is_some()
            && let Ok(next) = self.solved_from(run, newton)
        {
            return Ok(next);
        }
        run.linearize(&Rare::of(system), newton);
        let extrapolated = self.solved_from(run, newton);
        if extrapolated.is_ok() || !run.convergence.has_begun() {
            return extrapolated;
        }
        let Ok(constant) = Run::new(system, run.node, run.h) else { return extrapolated };
        constant.linearize(&Rare::of(system), newton);
        self.solved_from(&Run { pause: run.pause, ..constant }, newton).or(extrapolated)
    }

    /// The run after the next step of a run by Newton's iteration from its guess.
    fn solved_from(&self, run: &Run<N, STAGES>, newton: &Newton<N, STAGES>) -> Result<Run<N, STAGES>, StepError> {
        let Self { system, instructions, .. } = self;
        // Where sweeps have equations of their own, or short ones, a copy of Newton's iteration is not worth its build: one serves all systems of N
        // coordinates.
        let side_by_side = if S::SIDE_BY_SIDE && const { N > LOOPED && !S::SEPARABLE } {
            long_step(*instructions, Solve { system, run: &mut run.clone(), newton: Some(newton) })
        } else {
            None
        };
        let solved = side_by_side.unwrap_or_else(|| run.solved_plainly(&Rare::of(system), Some(newton)));
        let unsettled = || solved.sweeps.convergence.unsettled(run.node.t, run.h, newton.stiffness());
        let accepted = run.accepted(&Rare::of(&self.system), &solved, Some(newton));
        accepted.ok_or_else(|| lost_force(&self.system, &run.node, run.h).unwrap_or_else(unsettled))
    }

    /// The state reached last.
    pub fn state(&self) -> State<N> {
        self.run.node.state()
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The step, in units of time.
    pub fn h(&self) -> f64 {
        self.run.h
    }

    /// What the stages of the last step leave of their equations: in roundings of the coordinates where forces depend on them alone, else in sixteens of
    /// roundings of the velocities. Zero before the first step.
    pub fn residual(&self) -> f64 {
        self.run.convergence.change
    }

    /// Discrete energy of the last interval, `E1 = Σ b_i En_i + h Σ b_i c_i (f·v − L_t)_i = −D3 L_d − g_d⁺`, in the units of L; `None`
    /// before the first step, after a change of parameters, and where it is not finite: forces may be finite where L is not.
    pub fn discrete_energy(&self) -> Option<f64> {
        let Self { system, run, .. } = self;
        let energy = energies(system, &run.before, run.h, run.stages.data.0, 0.0).end;
        (run.has_step() && energy.is_finite()).then_some(energy)
    }

    /// The discrete Lagrangian of the last step with its derivatives, discrete forces and powers, for checks: `−D2 L_d − f_d⁻ = p0`,
    /// `D4 L_d + f_d⁺ = p1`. `None` before the first step, after a change of parameters or a step of another length ([`Gauss::step_of`]), and where one of them is not finite.
    pub fn slots(&self) -> Option<Slots<N>> {
        let slots = self.run.has_step().then(|| Slots::of(&self.system, &self.run));
        slots.filter(Slots::is_finite)
    }

    /// Sweeps over the stages that the last step took.
    pub fn iterations(&self) -> u32 {
        self.run.convergence.sweeps
    }
}

impl<const N: usize, const S: usize> Run<N, S> {
    /// A run that begins at a node, the stages of its first step guessed constant.
    fn new<Y: Collocation<N>>(system: &Y, node: Node<N>, h: f64) -> Result<Self, StepError> {
        let flow = node.state().flow(system)?;
        let start = if Y::SEPARABLE { flow.force } else { flow.v };
        let stages = SMatrix::from_fn(|_, k| start[k]);
        Ok(Self { node, before: node, h, stages, convergence: Convergence::NONE, pause: Pause::NONE })
    }

    /// Whether the step is known that led to the node: its stages mean nothing by other parameters.
    fn has_step(&self) -> bool {
        self.convergence.has_begun() && self.before != self.node
    }

    /// The run of a system with other parameters, for which the stages are a guess and no more.
    fn with_other_parameters(self) -> Self {
        Self { before: self.node, ..self }
    }

    /// Velocities at the stages of the next step, or forces there: the polynomials of the last one, further on.
    #[inline(always)]
    fn guess<const FUSED: bool>(&self) -> Stages<N, S> {
        if self.convergence.has_begun() { extrapolated::<N, S, FUSED>(&self.stages.data.0) } else { self.stages.data.0 }
    }

    /// Moves to the end of a step, after which sweeps are tried or not.
    #[inline(always)]
    fn take(&mut self, solved: &Solved<N, S>, pause: Pause) {
        self.before = self.node;
        self.node.advance(self.h, &solved.increment.velocity, &solved.increment.momentum);
        self.stages = SMatrix::from_array_storage(nalgebra::ArrayStorage(solved.stages));
        self.convergence = solved.sweeps.convergence;
        self.pause = pause;
    }

    /// Moves to the end of a step that sweeps solved to the rounding of its positions; else what they led to.
    #[inline(always)]
    fn swept(&mut self, solved: Solved<N, S>) -> Option<Solved<N, S>> {
        let Increment { velocity, momentum } = &solved.increment;
        if solved.is_at_floor() && self.node.stays_finite(self.h, velocity, momentum) {
            self.take(&solved, Pause::NONE);
            return None;
        }
        Some(solved)
    }

    /// The run after a step that sweeps, or Newton's iteration, solved to rounding; none where they did not.
    fn accepted(&self, system: &Rare<'_, N>, solved: &Solved<N, S>, newton: Option<&Newton<N, S>>) -> Option<Self> {
        // Plain numbers have sines and cosines of every angle; lanes lose what is not near.
        let plain;
        let solved = if solved.increment.is_finite() {
            solved
        } else {
            plain = self.solved_plainly(system, newton);
            &plain
        };
        let pause = if newton.is_some() { self.pause.after_newton() } else { Pause::NONE };
        let mut run = *self;
        run.take(solved, pause);
        (run.node.is_finite() && self.is_solved(system, solved)).then_some(run)
    }

    /// The next step in plain numbers. Not inlined: one copy serves all systems of N coordinates.
    #[inline(never)]
    fn solved_plainly(&self, system: &Rare<'_, N>, newton: Option<&Newton<N, S>>) -> Solved<N, S> {
        solved::<f64, _, _, N, S, false>(system, system, self, newton)
    }

    /// Linearizes the equations about the middle of the next step.
    fn linearize(&self, system: &Rare<'_, N>, newton: &mut Newton<N, S>) {
        let equations = general(system, &self.node, self.h, self.guess::<false>());
        let middle = S / 2;
        let q = stage(&equations.start(), middle);
        let v = stage(&equations.velocity(), middle);
        let t = self.node.t + 0.5 * self.h;
        newton.linearize(system, Linearization { h: self.h, t, q, v, iterations: None });
    }

    /// Whether what the stages leave of their equations is rounding.
    fn is_solved(&self, system: &Rare<'_, N>, solved: &Solved<N, S>) -> bool {
        let Solved { sweeps, velocities, .. } = solved;
        let are_rounding = || rounding::are_solved(system, &self.node, self.h, &sweeps.positions, velocities.as_ref());
        solved.is_at_floor() || !sweeps.are_given_up && are_rounding()
    }
}

/// Whether every processor of this architecture has vectors that are worth a copy of long equations. Those of x86-64 without AVX2 hold two
/// numbers, and are of before 2013 or of the simplest machines: they evaluate one stage after another.
const WIDE: bool = !cfg!(target_arch = "x86_64");

/// The equations of a step from `node`, with velocities at its stages, or forces there of a separable system.
fn general<'a, const N: usize, const S: usize>(
    system: &'a Rare<'a, N>,
    node: &'a Node<N>,
    h: f64,
    stages: Stages<N, S>,
) -> General<'a, f64, Rare<'a, N>, SMatrix<f64, N, N>, N, S, false> {
    let mass = constant_mass::<N, f64, _>(system, node);
    General::new(system, mass.as_ref(), node, h, stages, None)
}

/// Why stages cannot be evaluated about the step of length h from `node`: no velocity belongs to its momenta, or a part of L or f is not
/// finite, which the system names. None where they can.
#[cold]
fn lost_force<S: Collocation<N>, const N: usize>(system: &S, node: &Node<N>, h: f64) -> Option<StepError> {
    let v = match node.state().velocity(system) {
        Ok(v) => v,
        Err(failure) => return Some(failure),
    };
    let lost = StepError::NonFinite { t: node.t, quantity: "force at a stage", expression: None };
    let explained = lost.explained(system, node, h, &v);
    matches!(explained, StepError::NonFinite { expression: Some(_), .. }).then_some(explained)
}

/// A solved step.
struct Solved<const N: usize, const S: usize> {
    increment: Increment<N>,
    stages: Stages<N, S>,
    velocities: Option<Stages<N, S>>,
    sweeps: Sweeps<N, S>,
}

impl<const N: usize, const S: usize> Solved<N, S> {
    /// Whether the stages are at the rounding of their positions.
    fn is_at_floor(&self) -> bool {
        self.sweeps.convergence.is_at_floor()
    }
}

/// The next step of a run, by the instructions of the processor: taken where sweeps solve it, else what they, or Newton's iteration, lead to. None, and
/// nothing taken, where Newton's iteration is that of all systems.
struct Solve<'a, Y, const N: usize, const S: usize> {
    system: &'a Y,
    run: &'a mut Run<N, S>,
    newton: Option<&'a Newton<N, S>>,
}

impl<Y: Collocation<N> + Convertible<N>, const N: usize, const S: usize> Loop for Solve<'_, Y, N, S> {
    type Output = Option<Solved<N, S>>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Option<Solved<N, S>> {
        let Self { system, run, newton } = self;
        if const { N > LOOPED && (FUSED || WIDE) } {
            let lanes = system.convert::<Lanes<S, FUSED>>();
            // Separable systems are not asked for Newton's iteration here: the compiler need not build it.
            let newton = if const { Y::SEPARABLE } { None } else { newton };
            let solved = solved::<Lanes<S, FUSED>, _, _, N, S, FUSED>(&lanes, system, run, newton);
            return if newton.is_some() { Some(solved) } else { run.swept(solved) };
        }
        if newton.is_some() {
            return None;
        }
        let lane = system.convert::<Lane<FUSED>>();
        run.swept(solved::<Lane<FUSED>, _, _, N, S, FUSED>(&lane, system, run, None))
    }
}

/// The next step of a run, its equations long. Not inlined: sweeps and Newton's iteration take one copy for each set of instructions.
#[inline(never)]
fn long_step<Y, const N: usize, const S: usize>(
    instructions: Instructions,
    step: Solve<'_, Y, N, S>,
) -> Option<Solved<N, S>>
where
    Y: Collocation<N> + Convertible<N>,
{
    instructions.run(step)
}

/// The next step of a run, the equations evaluated in the numbers T; `plain` is the same system in plain ones. By sweeps, else by Newton's iteration.
#[inline(always)]
fn solved<T, Y, P, const N: usize, const S: usize, const FUSED: bool>(
    system: &Y,
    plain: &P,
    run: &Run<N, S>,
    newton: Option<&Newton<N, S>>,
) -> Solved<N, S>
where
    T: AtStages<S>,
    Y: Points<N, T>,
    P: Points<N, f64>,
{
    let Run { node, h, .. } = run;
    // Of a known type the compiler sees one of the two. Newton's iteration corrects velocities: of stiff steps they are known better than forces.
    let is_separable =
        const { Form::Separable.is_known(Y::FORM) } || const { Y::FORM.is_none() } && system.form() == Form::Separable;
    if is_separable && newton.is_none() {
        let mass = mass(plain, node);
        let last = run.stages.data.0;
        let are_last = run.convergence.has_begun();
        finished(Separable::<T, Y, P::Mass, N, S, FUSED>::new(system, &mass, node, *h, last, are_last), run)
    } else {
        let mass = constant_mass(plain, node);
        let guess = run.guess::<FUSED>();
        finished(General::<T, Y, P::Mass, N, S, FUSED>::new(system, mass.as_ref(), node, *h, guess, newton), run)
    }
}

#[inline(always)]
fn finished<const N: usize, const S: usize>(mut equations: impl Equations<N, S>, run: &Run<N, S>) -> Solved<N, S> {
    let sweeps = sweep::solve(&mut equations, &run.convergence);
    Solved { increment: equations.increment(), stages: equations.guess(), velocities: equations.velocities(), sweeps }
}

impl<S, const N: usize, const STAGES: usize> Iterator for Gauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N> + FixedStepping<N>,
{
    type Item = Result<State<N>, StepError>;

    /// The next step; never `None`. After an error, the same error.
    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}
