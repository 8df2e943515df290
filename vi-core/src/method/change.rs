//! Changes of a run between two steps: length, parameters, state.

use super::Method;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::node::Node;
use crate::real::Scalar;
use crate::state::State;

/// A change between two steps. It is passed with the system and the length after the change.
#[derive(Debug)]
pub enum Change<'a, S, const N: usize, T = f64> {
    /// The length of the steps changes.
    NewLength,
    /// Parameters change. Contains the system before the change.
    NewSystem(&'a S),
    /// The state changes, and perhaps parameters. Contains the system before the change and the state after it.
    NewState(&'a S, State<N, T>),
}

impl<'a, S, const N: usize, T: Scalar> Change<'a, S, N, T> {
    /// The same change for another wrapper of the system.
    pub fn of<'b, W>(&self, system: &'b W) -> Change<'b, W, N, T> {
        match self {
            Self::NewLength => Change::NewLength,
            Self::NewSystem(_) => Change::NewSystem(system),
            Self::NewState(_, state) => Change::NewState(system, *state),
        }
    }

    /// The system before; `None` if it stays.
    pub fn before(&self) -> Option<&'a S> {
        match self {
            Self::NewLength => None,
            Self::NewSystem(before) | Self::NewState(before, _) => Some(before),
        }
    }

    /// The node after the change, with the energy of before.
    pub(crate) fn moved(&self, node: &Node<N, T>) -> Node<N, T> {
        match self {
            Self::NewLength | Self::NewSystem(_) => *node,
            Self::NewState(_, state) => node.with_state(*state),
        }
    }

    /// The node after the change: a method that preserves an energy adds the change of H to it.
    ///
    /// # Errors
    /// A state without a velocity, and thus without H.
    pub(crate) fn moved_with_energy(&self, system: &S, node: &Node<N, T>) -> Result<Node<N, T>, StepError>
    where
        S: Lagrangian<N, T>,
    {
        let mut moved = self.moved(node);
        if let Some(before) = self.before() {
            moved.add_energy(moved.state().energy(system)? - node.state().energy(before)?);
        }
        Ok(moved)
    }

    /// The memory of a new run, for a method that carries nothing over a change. Moves the node.
    ///
    /// # Errors
    /// The errors of [`Method::begin`].
    pub(crate) fn begun<M: Method<S, N, T>>(
        &self,
        method: &M,
        system: &S,
        node: &mut Node<N, T>,
        h: T,
    ) -> Result<M::Memory, StepError> {
        if let Self::NewState(_, state) = self {
            *node = Node::new(*state, T::zero());
        }
        method.begin(system, node, h)
    }
}
