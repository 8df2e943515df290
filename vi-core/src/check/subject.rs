//! What is checked: a system in any kind of number, and a place where it is well behaved.

use super::bounded::Bounded;
use crate::collocation::Collocation;
use crate::lagrangian::Parameters;
use crate::real::dual::Dual;
use crate::stepping::{Convertible, Discretized, EnergyStepping};
use nalgebra::SVector;

/// Steps of the place's length over which the motion from there is followed.
pub(super) const STEPS: u32 = 32;

/// Where a system is checked: a state from which it is well behaved over 32 steps of length `h`, with every quantity of
/// moderate size and the step density of one sign. Units are the system's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place<const N: usize> {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: SVector<f64, N>,
    /// Velocities.
    pub v: SVector<f64, N>,
    /// Step, positive, in units of time: small enough for the error to fall with h². Where rounding hides what a check is
    /// about, the check tries larger ones.
    pub h: f64,
}

/// A system whose motion can be checked, as that of every generated one can.
pub trait MotionChecked<const N: usize>: Collocation<N> + Convertible<N> + Parameters {}

impl<const N: usize, S: Collocation<N> + Convertible<N> + Parameters> MotionChecked<N> for S {}

/// A system whose fixed steps can be checked, as those of every generated one with a rule can.
pub trait Checked<const N: usize>: MotionChecked<N> + Discretized<N> {}

impl<const N: usize, S: MotionChecked<N> + Discretized<N>> Checked<N> for S {}

/// Such a system with energy-preserving steps. Rust 1.89 takes one bound on `Steps` for each number, not two in one.
pub trait EnergyChecked<const N: usize>:
    EnergyStepping<N>
    + MotionChecked<N>
    + Discretized<N, Steps<Bounded>: EnergyStepping<N, Bounded>>
    + Discretized<N, Steps<Dual<Bounded>>: EnergyStepping<N, Dual<Bounded>>>
{
}

impl<const N: usize, S> EnergyChecked<N> for S where
    S: EnergyStepping<N>
        + MotionChecked<N>
        + Discretized<N, Steps<Bounded>: EnergyStepping<N, Bounded>>
        + Discretized<N, Steps<Dual<Bounded>>: EnergyStepping<N, Dual<Bounded>>>
{
}
