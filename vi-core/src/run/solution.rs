//! States at given times, with their energies.

use super::Run;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::state::State;
use alloc::vec::Vec;
use core::fmt;

/// States of a run with their times and energies. `Display` prints a CSV table: `t`, coordinates, momenta, `H`.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution<const N: usize> {
    /// The times.
    pub times: Vec<f64>,
    /// The states.
    pub states: Vec<State<N>>,
    /// Energy `H = v·∂L/∂v − L` at each state, in the units of L.
    pub energies: Vec<f64>,
    names: [&'static str; N],
}

impl<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize> Run<M, S, N> {
    /// Returns states at the given times with their energies. The run ends at its last node that is not beyond the last
    /// time.
    ///
    /// [`Run::states_at`] returns the same states one by one, including those before an error.
    ///
    /// # Errors
    /// The error of the failed step; [`StepError::InvalidInput`] for a time that is not finite, or that precedes the
    /// one before.
    pub fn at_times(&mut self, times: impl IntoIterator<Item = f64>) -> Result<Solution<N>, StepError> {
        let system = self.system;
        let mut states = Vec::new();
        let mut energies = Vec::new();
        let mut grid = self.states_at(times);
        while let Some(t) = grid.times.next() {
            let (state, node) = grid.at(t)?;
            states.push(state);
            energies.push(node.state().energy(&system)?);
        }
        Ok(Solution::of(&system, states, energies))
    }
}

impl<const N: usize> Solution<N> {
    pub(super) fn of<S: Lagrangian<N>>(system: &S, states: Vec<State<N>>, energies: Vec<f64>) -> Self {
        let times = states.iter().map(|state| state.t).collect();
        Self { times, states, energies, names: system.coordinates() }
    }
}

impl<const N: usize> fmt::Display for Solution<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "t")?;
        self.names.iter().try_for_each(|name| write!(f, ",{name}"))?;
        self.names.iter().try_for_each(|name| write!(f, ",p_{name}"))?;
        writeln!(f, ",H")?;
        for (State { t, q, p }, energy) in self.states.iter().zip(&self.energies) {
            write!(f, "{t}")?;
            q.iter().chain(p).try_for_each(|number| write!(f, ",{number}"))?;
            writeln!(f, ",{energy}")?;
        }
        Ok(())
    }
}
