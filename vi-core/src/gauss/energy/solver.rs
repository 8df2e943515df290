//! What the search for a step asks of a system.
//!
//! In: a node, and a length of the step from it. Out: the stages, and energies. The system is erased here, so that the search for a length is
//! compiled once for each number of coordinates and of stages, and not for each system; what solves the stages is the system's own.

use super::density::step_density;
use crate::collocation::Collocation;
use crate::error::StepError;
use crate::gauss::energies::{Energies, bounded_energies, energies};
use crate::gauss::stages::Stages;
use crate::gauss::{Gauss, Run};
use crate::lagrangian::Lagrangian;
use crate::real::Rounded;
use crate::state::State;
use crate::stepping::Convertible;

/// The energy at a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeEnergy {
    /// H.
    pub(super) total: f64,
    /// The size of its terms.
    pub(super) size: f64,
}

/// A run of Gauss steps, its system erased; see the [module](self).
pub(super) trait Solver<const N: usize, const S: usize> {
    /// The run.
    fn run(&self) -> &Run<N, S>;
    /// The run, to be changed.
    fn run_mut(&mut self) -> &mut Run<N, S>;
    /// The run after the next step.
    fn solved(&mut self) -> Result<Run<N, S>, StepError>;
    /// The energies, less `base`, of the step of length h from the node with these stages.
    fn energies(&self, h: f64, stages: Stages<N, S>, base: f64) -> Energies;
    /// The same in numbers that carry a bound of their rounding.
    fn bounded_energies(&self, h: f64, stages: Stages<N, S>, base: f64) -> Energies<Rounded>;
    /// The energy at a state.
    fn energy_at(&self, state: &State<N>) -> Result<NodeEnergy, StepError>;
    /// D_s at a state.
    fn step_density(&self, state: &State<N>) -> Result<f64, StepError>;
    /// Whether the energy of the system changes: by a force, or by the time.
    fn does_work(&self) -> bool;
}

impl<Y, const N: usize, const S: usize> Solver<N, S> for Gauss<Y, N, S>
where
    Y: Collocation<N> + Convertible<N>,
{
    fn run(&self) -> &Run<N, S> {
        &self.run
    }

    fn run_mut(&mut self) -> &mut Run<N, S> {
        &mut self.run
    }

    fn solved(&mut self) -> Result<Run<N, S>, StepError> {
        // Lengths differ: a checkpoint stores no linearization.
        self.forget_linearization();
        let before = self.run;
        let outcome = self.advance();
        let after = core::mem::replace(&mut self.run, before);
        outcome.map(|()| after)
    }

    fn energies(&self, h: f64, stages: Stages<N, S>, base: f64) -> Energies {
        energies(&self.system, &self.run.node, h, stages, base)
    }

    fn bounded_energies(&self, h: f64, stages: Stages<N, S>, base: f64) -> Energies<Rounded> {
        bounded_energies(&self.system, &self.run.node, h, stages, base)
    }

    fn energy_at(&self, state: &State<N>) -> Result<NodeEnergy, StepError> {
        let State { t, q, p } = state;
        let v = Lagrangian::flow(&self.system, *t, q, p)?.v;
        let total = self.system.energy(*t, q, &v);
        Ok(NodeEnergy { total, size: v.dot(p).abs() + total.abs() })
    }

    fn step_density(&self, state: &State<N>) -> Result<f64, StepError> {
        step_density::<Y, N, S>(&self.system, state)
    }

    fn does_work(&self) -> bool {
        !Y::AUTONOMOUS || Y::FORCED
    }
}
