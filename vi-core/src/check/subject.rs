//! Inputs of checks: a system over any number type, and a place at which it is well behaved.

use super::bounded::Bounded;

use crate::lagrangian::Parameters;
use crate::real::dual::Dual;
use crate::stepping::{Convertible, Discretized, EnergyStepping};
use nalgebra::SVector;

/// Length of the tested trajectory from a place, in its steps.
pub(super) const STEPS: u32 = 32;

/// Initial state and step length of a check. The system must be well behaved over 32 steps of length `h`: every
/// quantity of moderate size, and the step density of one sign. Units are the system's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place<const N: usize> {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: SVector<f64, N>,
    /// Velocities.
    pub v: SVector<f64, N>,
    /// Step length, positive, in units of time: small enough for the error to decrease with h². If rounding hides the
    /// tested quantity, the check tries larger ones.
    pub h: f64,
}

/// A system with checkable equations of motion. Every generated system is one.
pub trait MotionChecked<const N: usize>: Convertible<N> + Parameters {}

impl<const N: usize, S: Convertible<N> + Parameters> MotionChecked<N> for S {}

/// A system with checkable fixed steps. Every generated system with a rule is one.
pub trait Checked<const N: usize>: MotionChecked<N> + Discretized<N> {}

impl<const N: usize, S: MotionChecked<N> + Discretized<N>> Checked<N> for S {}

/// A system with checkable energy-preserving steps. Rust 1.89 accepts one bound on `Steps` per number type, not two in
/// one.
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
