//! The run of Gauss steps as one integrator among others.

use super::points::Rare;
use super::polynomial::Polynomial;
use super::{Checkpoint, Gauss, Run};
use crate::collocation::Collocation;
use crate::error::StepError;
use crate::integrator::{Hermite, Integrator, Path, changed, own};
use crate::node::Node;
use crate::state::State;
use crate::stepping::Convertible;
use nalgebra::SVector;

/// The motion over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion<const N: usize, const S: usize> {
    /// Over a step of the run.
    Collocation(Polynomial<N, S>),
    /// Over a step of another length, the stages of which are not kept.
    Hermite(Hermite<N>),
}

impl<const N: usize, const S: usize> Path<N> for Motion<N, S> {
    fn since_start(self) -> Self {
        match self {
            Self::Collocation(polynomial) => Self::Collocation(polynomial.since_start()),
            Self::Hermite(cubics) => Self::Hermite(cubics.since_start()),
        }
    }

    fn state(&self, t: f64) -> State<N> {
        match self {
            Self::Collocation(polynomial) => polynomial.state(t),
            Self::Hermite(cubics) => cubics.state(t),
        }
    }

    fn velocity(&self, t: f64) -> SVector<f64, N> {
        match self {
            Self::Collocation(polynomial) => polynomial.velocity(t),
            Self::Hermite(cubics) => cubics.velocity(t),
        }
    }
}

impl<S, const N: usize, const STAGES: usize> Integrator<N> for Gauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N>,
{
    type System = S;
    type Path = Motion<N, STAGES>;
    type Checkpoint = Checkpoint<N, STAGES>;

    const LONGEST: f64 = 1.0;

    own!(step, step_of, system, h, discrete_energy, checkpoint);

    fn node(&self) -> &Node<N> {
        &self.run.node
    }

    fn set_parameters(&mut self, change: impl FnOnce(&mut S)) -> Result<(), StepError> {
        let system = changed(&self.system, change)?;
        self.state().velocity(&system)?;
        self.system = system;
        self.run = self.run.with_other_parameters();
        self.forget_linearization();
        self.failure = None;
        Ok(())
    }

    fn set_state(&mut self, state: State<N>) -> Result<(), StepError> {
        self.run = Run::new(&self.system, Node::new(state, 0.0), self.run.h)?;
        self.forget_linearization();
        self.failure = None;
        Ok(())
    }

    fn path(&self, before: &State<N>) -> Result<Motion<N, STAGES>, StepError> {
        if self.run.has_step() {
            Ok(Motion::Collocation(Polynomial::of(&Rare::of(&self.system), &self.run, *before)))
        } else {
            Hermite::between(&self.system, before, &self.state(), self.h()).map(Motion::Hermite)
        }
    }

    fn set_time(&mut self, t: f64) {
        self.run.node.set_time(t);
    }
}
