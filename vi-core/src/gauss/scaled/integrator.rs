//! The run in scaled time as one integrator among others.
//!
//! In: a run. Out: what [`Integrator`] asks. A step of a given length in time is one whose Δτ is solved for. A change of the parameters or of
//! the state brings the energy `ΔH` to the node, and the run goes on with `E + ΔH`: so `H − E` is what it was.

use super::path::Polynomial;
use super::run::time_scale;
use super::{Checkpoint, Run, ScaledGauss, check_time_scale};
use crate::collocation::TimeScale;
use crate::error::{Residuals, StepError};
use crate::fixed_step::check_step;
use crate::integrator::{Integrator, changed, own};
use crate::node::Node;
use crate::state::State;
use crate::stepping::Convertible;

/// Trials of Δτ for a step of a given length in time.
const TRIALS: u32 = 60;
/// Roundings of the length by which such a step may miss it, where they are more than one of the time: the quadrature that the length is.
const MISSED: f64 = 16.0;

impl<S, const N: usize, const STAGES: usize> ScaledGauss<S, N, STAGES>
where
    S: TimeScale<N> + Convertible<N>,
{
    /// Takes one step of the length `h` in time instead of the next one; Δτ of the run stays. It is found by a few trials, each of which solves
    /// a step.
    ///
    /// # Errors
    /// As [`ScaledGauss::step`], [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite, and [`StepError::NotConverged`] where no
    /// Δτ is found; the run is then what it was, and may go on.
    pub fn step_of(&mut self, h: f64) -> Result<State<N>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        check_step(h)?;
        let run = self.run_of(h)?;
        self.run = Run { h: self.run.h, dtau: self.run.dtau, ..run };
        Ok(self.state())
    }

    /// The run after a step of the length h: Newton's iteration on `t(Δτ) = t0 + h`, whose derivative is g at the end, halved where it leaves
    /// what is known to hold Δτ.
    fn run_of(&self, h: f64) -> Result<Run<N, STAGES>, StepError> {
        let State { t, q, .. } = self.state();
        let g = time_scale(&self.system, t, &q);
        check_time_scale(t, g)?;
        let missed = f64::EPSILON * (MISSED * h.abs()).max(t.abs());
        // None is tried that is longer than twice what is known to be too short.
        let [mut low, mut high] = [0.0, f64::INFINITY];
        let mut length = (h / g).abs().min(self.run.dtau.abs());
        let mut residuals = Residuals::new();
        let mut residual = 0.0;
        for _ in 0..TRIALS {
            let dtau = length.copysign(h);
            let mut aside = Self { system: self.system, run: Run { dtau, ..self.run }, newton: None, ..*self };
            let run = aside.solve()?;
            let left = (h - run.h) * h.signum();
            if left.abs() <= missed {
                return Ok(run);
            }
            residual = left.abs() / (f64::EPSILON * h.abs());
            residuals.push(residual);
            if left > 0.0 {
                low = length;
            } else {
                high = length;
            }
            let end = run.node.state();
            let g = time_scale(&self.system, end.t, &end.q);
            let next = length + left / g;
            let bound = if high.is_finite() { high } else { 2.0 * low };
            let halfway = if high.is_finite() { 0.5 * (low + high) } else { bound };
            length = if next > low && next < bound { next } else { halfway };
        }
        Err(StepError::NotConverged { t, h, iterations: TRIALS, residual, residuals })
    }
}

impl<S, const N: usize, const STAGES: usize> Integrator<N> for ScaledGauss<S, N, STAGES>
where
    S: TimeScale<N> + Convertible<N>,
{
    type System = S;
    type Path = Polynomial<N, STAGES>;
    type Checkpoint = Checkpoint<N, STAGES>;

    // Nothing bounds how g changes from one step to the next.
    const LONGEST: f64 = f64::INFINITY;

    own!(step, step_of, system, h, checkpoint);

    fn node(&self) -> &Node<N> {
        &self.run.node
    }

    fn discrete_energy(&self) -> Option<f64> {
        self.run.convergence.has_begun().then(|| self.discrete_energy())
    }

    fn set_parameters(&mut self, change: impl FnOnce(&mut S)) -> Result<(), StepError> {
        let system = changed(&self.system, change)?;
        let state = self.state();
        let brought = state.energy(&system)? - state.energy(&self.system)?;
        self.run = self.run.resumed(&system, self.run.node, brought)?;
        self.system = system;
        self.failure = None;
        Ok(())
    }

    fn set_state(&mut self, state: State<N>) -> Result<(), StepError> {
        let brought = state.energy(&self.system)? - self.state().energy(&self.system)?;
        self.run = self.run.resumed(&self.system, self.run.node.with_state(state), brought)?;
        self.failure = None;
        Ok(())
    }

    fn path(&self, before: &State<N>) -> Result<Polynomial<N, STAGES>, StepError> {
        Ok(Polynomial::of(&self.system, &self.run, *before))
    }

    fn set_time(&mut self, t: f64) {
        self.run.node.set_time(t);
    }
}

impl<const N: usize, const S: usize> Run<N, S> {
    /// The run that goes on from another node, or with another system, to which a change brought energy.
    fn resumed<Y: TimeScale<N>>(&self, system: &Y, mut node: Node<N>, brought: f64) -> Result<Self, StepError> {
        node.add_energy(brought);
        Run::new(system, node, self.dtau)
    }
}
