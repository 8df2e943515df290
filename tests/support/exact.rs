//! Accurate motion, as the checks compute it, with panics as failures.

use core::ops::Deref;
use vi_core::check;
use vi_core::{Lagrangian, SVector};

/// A state of a motion: time, coordinates, velocities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trajectory<const N: usize>(check::Trajectory<N>);

impl<const N: usize> Trajectory<N> {
    pub(crate) fn new(t: f64, q: impl Into<SVector<f64, N>>, v: impl Into<SVector<f64, N>>) -> Self {
        Self(check::Trajectory { t, q: q.into(), v: v.into() })
    }

    /// The same motion at the time `end`, later or earlier.
    pub(crate) fn at(self, system: &impl Lagrangian<N>, end: f64) -> Self {
        Self(self.0.at(system, end).unwrap_or_else(|error| panic!("no accurate motion: {error}")))
    }
}

impl<const N: usize> Deref for Trajectory<N> {
    type Target = check::Trajectory<N>;

    fn deref(&self) -> &check::Trajectory<N> {
        &self.0
    }
}
