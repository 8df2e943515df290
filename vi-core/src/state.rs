//! States, intervals and steps.
//!
//! `q`, `p` and `v` are column vectors of N entries, in the order in which the system declares its coordinates and in
//! the units of the system.

use crate::real::Scalar;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// A state of a system: time, coordinates, momenta.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const N: usize, T = f64> {
    /// Time.
    pub t: T,
    /// Coordinates.
    pub q: SVector<T, N>,
    /// Momenta, `p = ∂L/∂v`.
    pub p: SVector<T, N>,
}

/// N numbers, one for each coordinate of a system: an array, an [`SVector`], or any type that converts to one.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not one number for each of {N} coordinate(s)",
    label = "the system has {N} coordinate(s)",
    note = "write an array or a vector of that length: `[0.5, 1.0]` for two coordinates"
)]
pub trait Numbers<const N: usize, T = f64> {
    /// Converts to a vector.
    fn vector(self) -> SVector<T, N>;
}

#[diagnostic::do_not_recommend]
impl<const N: usize, T, V: Into<SVector<T, N>>> Numbers<N, T> for V {
    #[inline]
    fn vector(self) -> SVector<T, N> {
        self.into()
    }
}

/// The two nodes of one discrete Lagrangian: `(t0, q0) → (t1, q1)`.
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

/// One step of the energy-preserving integrator: its end node and its midpoint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<const N: usize, T = f64> {
    /// Time of the end node.
    pub t: T,
    /// Coordinates of the end node.
    pub q: SVector<T, N>,
    /// Momenta of the end node.
    pub p: SVector<T, N>,
    /// Discrete energy `E1 = −D3 L_d − g_d⁺` of the end node, as the integrator carries it.
    pub energy: T,
    /// Length of the step.
    pub h: T,
    /// Middle of the interval: `(t0 + h/2, q0 + (h/2) v, v)`. The energy equation holds here.
    pub midpoint: (T, SVector<T, N>, SVector<T, N>),
    /// Step density D of the interval, from the determinant of the solved equations.
    pub density: T,
    /// D at the middle of the next interval, extrapolated linearly from the last two. A sign other than that of
    /// `density` warns that the next step may not exist. See [`Step::h_next`].
    pub density_next: T,
    /// Newton iterations on the n + 1 equations of the step.
    pub iterations: u32,
    /// Largest residual at the accepted `(v, h)`, in units of its rounding-error bound: an ulp of the sum of absolute
    /// terms of the row, or the bound of running error analysis.
    pub residual: T,
    /// The equations by which the step was found.
    pub kind: StepKind<T>,
}

impl<const N: usize, T: Scalar> Step<N, T> {
    /// Length of the next step by the step law, `h (D/D_next)^(1/3)`. `None` if D is about to change sign, so that no
    /// step may exist.
    pub fn h_next(&self) -> Option<T> {
        let ratio = self.density.to_f64() / self.density_next.to_f64();
        (ratio > 0.0 && ratio.is_finite()).then(|| self.h * T::real(ratio.cbrt()))
    }
}

/// The equations by which a step of the energy-preserving integrator was found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StepKind<T = f64> {
    /// The momentum and the energy equation.
    EnergyPreserving,
    /// Both equations, for the first step after fixed steps. No step had the previous energy, so the discrete energy of
    /// the last fixed interval is now preserved.
    Reseeded {
        /// Change of the preserved energy.
        energy_change: T,
    },
    /// The momentum equation alone, with given length: no energy-preserving step was found, and
    /// [`Fallback::FixedSteps`](crate::Fallback::FixedSteps) was chosen.
    FixedStep,
}
