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
//! | `run`, `solve` | what is carried from step to step, and its step by the instructions of the processor |
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
mod run;
pub mod scaled;
mod separable;
mod slots;
mod solve;
mod stages;
mod sweep;
mod tableau;
mod variation;

use crate::checkpoint;
use crate::collocation::Collocation;
use crate::error::StepError;
use crate::fixed_step::check_step;
use crate::node::Node;
use crate::state::State;
use crate::stepping::Convertible;
use energies::energies;
pub use integrator::Motion;
use newton::Newton;
use points::Rare;
pub use polynomial::Polynomial;
pub use run::{Checkpoint, Run, Stored};
pub use slots::Slots;
use solve::{Solve, Solved, long_step, lost_force};
use stages::LOOPED;
use vi_dispatch::Instructions;

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

impl<S, const N: usize, const STAGES: usize> Gauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N>,
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
        checkpoint::Checkpoint::of(&self.system, None, Stored { run: self.run, linearization })
    }

    /// The run that was at `checkpoint`, bit for bit, on a processor with the same instructions.
    ///
    /// # Errors
    /// [`StepError::OtherSystem`] for a checkpoint of another system or of other parameters; [`StepError::NonFinite`] and
    /// [`StepError::InvalidInput`] for one that no run can have left.
    pub fn restart(system: S, checkpoint: Checkpoint<N, STAGES>) -> Result<Self, StepError> {
        let Stored { run, linearization } = checkpoint.run_of(&system, None)?;
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
        let Solved { increment, sweeps, .. } = &solved;
        let unsettled = || sweeps.convergence.unsettled(increment, [run.node.t, run.h], newton.stiffness());
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

    /// The number by which the last step was accepted, 4 at most: by how much its stages still change, in roundings of the coordinates where forces depend
    /// on them alone, else in sixteens of roundings of the velocities, or of the terms of `M⁻¹ p` where M varies; where that stalls, what the stages
    /// leave of their equations over its rounding-error bound. Zero before the first step.
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

impl<S, const N: usize, const STAGES: usize> Iterator for Gauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N>,
{
    type Item = Result<State<N>, StepError>;

    /// The next step; never `None`. After an error, the same error.
    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}
