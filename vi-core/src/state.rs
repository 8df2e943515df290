//! States, intervals and steps.
//!
//! `q`, `p` and `v` are column vectors of N entries, in the order in which the system declares its coordinates and
//! in the system's own units.

use crate::real::Scalar;
use nalgebra::SVector;

/// Where a system is: time, coordinates, momenta.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const N: usize, T = f64> {
    /// Time.
    pub t: T,
    /// Coordinates.
    pub q: SVector<T, N>,
    /// Momenta, `p = ∂L/∂v`.
    pub p: SVector<T, N>,
}

/// N numbers, one for each coordinate of a system: an array, an [`SVector`], or what else is one.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not one number for each of {N} coordinate(s)",
    label = "the system has {N} coordinate(s)",
    note = "write an array or a vector of so many numbers: `[0.5, 1.0]` for two coordinates"
)]
pub trait Numbers<const N: usize, T = f64> {
    /// The vector of these numbers.
    fn vector(self) -> SVector<T, N>;
}

#[diagnostic::do_not_recommend]
impl<const N: usize, T, V: Into<SVector<T, N>>> Numbers<N, T> for V {
    #[inline]
    fn vector(self) -> SVector<T, N> {
        self.into()
    }
}

/// The pair of nodes between which one discrete Lagrangian lives: `(t0, q0) → (t1, q1)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<const N: usize, T = f64> {
    /// Time at the start.
    pub t0: T,
    /// Coordinates at the start.
    pub q0: SVector<T, N>,
    /// Time at the end.
    pub t1: T,
    /// Coordinates at the end.
    pub q1: SVector<T, N>,
}

/// One step of the energy-preserving integrator: the node reached, and the midpoint it was reached through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<const N: usize, T = f64> {
    /// Time of the node reached.
    pub t: T,
    /// Coordinates of the node reached.
    pub q: SVector<T, N>,
    /// Momenta of the node reached.
    pub p: SVector<T, N>,
    /// Discrete energy `E1 = −D3 L_d − g_d⁺` of the node reached, as the integrator carries it.
    pub energy: T,
    /// Length of the step.
    pub h: T,
    /// Middle of the interval: `(t0 + h/2, q0 + (h/2) v, v)`. The energy equation holds here.
    pub midpoint: (T, SVector<T, N>, SVector<T, N>),
    /// Step density D of the interval, from the determinant that the solution was found with.
    pub density: T,
    /// D in the middle of the next interval, were D to change as it did over the last two: where it does not have the sign
    /// of `density`, the next step is in danger. See [`Step::h_next`].
    pub density_next: T,
    /// Newton iterations on the n + 1 equations that found the step.
    pub iterations: u32,
    /// Largest residual left at the `(v, h)` that was taken, in roundings: one is an ulp of what the row is a sum of, or what
    /// running error analysis finds that its evaluation loses.
    pub residual: T,
    /// How the step was found.
    pub kind: StepKind<T>,
}

impl<const N: usize, T: Scalar> Step<N, T> {
    /// Length of the next step by the step law, `h (D/D_next)^(1/3)`; `None` where D is about to change its sign, and no
    /// step may exist.
    pub fn h_next(&self) -> Option<T> {
        let ratio = self.density.to_f64() / self.density_next.to_f64();
        (ratio > 0.0 && ratio.is_finite()).then(|| self.h * T::real(ratio.cbrt()))
    }
}

/// How a step of the energy-preserving integrator was found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StepKind<T = f64> {
    /// From the momentum and the energy equation.
    EnergyPreserving,
    /// From both equations, the first after fixed steps, where no step had the energy of before: the energy to preserve
    /// was set to the discrete energy of the last fixed interval.
    Reseeded {
        /// By so much the energy to preserve has changed.
        energy_change: T,
    },
    /// From the momentum equation alone, its length given: no energy-preserving step was found, and
    /// [`Fallback::FixedSteps`](crate::Fallback::FixedSteps) was chosen.
    FixedStep,
}
