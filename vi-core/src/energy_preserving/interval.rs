//! The last interval, from which the next step continues.

use super::equations::{EnergyStep, RowResiduals};
use crate::real::Scalar;
use nalgebra::SVector;

/// The last interval, from which the next step continues.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: crate::real::Real + serde::Serialize",
        deserialize = "T: crate::real::Real + serde::Deserialize<'de>"
    ))
)]
pub(crate) struct Last<const N: usize, T> {
    pub(crate) v: SVector<T, N>,
    pub(crate) h: T,
    /// Length of the interval before.
    pub(crate) previous: T,
    /// Step density D of the interval.
    pub(crate) density: T,
    /// D of the interval before.
    pub(crate) density_before: T,
    /// Change of v since the interval before.
    pub(crate) change: SVector<T, N>,
    /// Whether it is a step, taken with the current parameters.
    pub(crate) is_step: bool,
    /// Number of Newton iterations.
    pub(crate) iterations: u32,
    /// Its residuals.
    pub(crate) measured: RowResiduals<N, T>,
}

impl<const N: usize, T: Scalar> Last<N, T> {
    /// The initial interval of a run.
    pub(crate) fn first(v: SVector<T, N>, h: T, density: T, change: SVector<T, N>) -> Self {
        Self {
            v,
            h,
            previous: h,
            density,
            density_before: density,
            change,
            is_step: false,
            iterations: 0,
            measured: RowResiduals::of(0.0),
        }
    }

    /// Whether a run has started with this interval, and has not taken a step.
    pub(crate) fn is_first(&self) -> bool {
        let Self { h, previous, density, density_before, .. } = self;
        !self.is_step && h == previous && density == density_before
    }

    /// The interval after the next step.
    #[inline(always)]
    pub(crate) fn followed(&self, step: &EnergyStep<N, T>) -> Self {
        let EnergyStep { v, h, density, iterations, measured } = *step;
        let (previous, density_before, change) = (self.h, self.density, v - self.v);
        Self { v, h, previous, density, density_before, change, is_step: true, iterations, measured }
    }

    /// Change of v with time, between the middles of the last two intervals.
    pub(crate) fn slope(&self) -> SVector<T, N> {
        self.change * self.frequency()
    }

    /// D at the middle of the next interval, extrapolated linearly from the last two.
    pub(crate) fn density_next(&self) -> T {
        self.density + (self.density - self.density_before) * (self.frequency() * self.h)
    }

    /// The inverse of the time between the middles of the last two intervals.
    fn frequency(&self) -> T {
        T::real(2.0) / (self.h + self.previous)
    }
}
