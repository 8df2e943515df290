//! The interval that the next step follows.

use crate::real::Real;
use nalgebra::SVector;

/// A step may be longer or shorter than the last one by this factor at most.
pub(crate) const RATIO: f64 = 3.0;

/// The interval that the next step follows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(super) struct Last<const N: usize, T> {
    pub(super) v: SVector<T, N>,
    pub(super) h: T,
    /// Length of the interval before.
    pub(super) previous: T,
    /// Step density D of the interval.
    pub(super) density: T,
    /// Change of v since the interval before.
    pub(super) change: SVector<T, N>,
    /// Whether it is a step, taken with the parameters that the system has.
    pub(super) is_step: bool,
}

impl<const N: usize, T: Real> Last<N, T> {
    /// Change of v by time, between the middles of the last two intervals.
    pub(super) fn slope(&self) -> SVector<T, N> {
        self.change * (T::real(2.0) / (self.h + self.previous))
    }
}
