//! States at given times, with their energies.

use crate::lagrangian::Lagrangian;
use crate::state::State;
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

impl<const N: usize> Solution<N> {
    pub(super) fn of<S: Lagrangian<N>>(states: Vec<State<N>>, energies: Vec<f64>) -> Self {
        let times = states.iter().map(|state| state.t).collect();
        Self { times, states, energies, names: S::COORDINATES }
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
