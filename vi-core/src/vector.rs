//! The unknowns of a step as one vector: the velocity v, or (v, h). Newton iteration accesses them entry by entry.

use crate::real::Real;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// A vector of numbers T.
pub(crate) trait Vector<T: Real>: Copy + PartialEq {
    /// Entry by entry.
    fn zip_map(&self, other: &Self, f: impl Fn(T, T) -> T) -> Self;
    /// The largest absolute value of an entry; NaN if an entry is NaN.
    fn longest(&self) -> f64;
    /// Whether every entry is finite.
    fn is_finite(&self) -> bool {
        self.longest().is_finite()
    }

    /// Entry by entry.
    #[inline(always)]
    fn map(&self, f: impl Fn(T) -> T) -> Self {
        self.zip_map(self, |entry, _| f(entry))
    }
}

impl<const N: usize, T: Real> Vector<T> for SVector<T, N> {
    #[inline(always)]
    fn zip_map(&self, other: &Self, f: impl Fn(T, T) -> T) -> Self {
        let mut result = *self;
        for i in 0..N {
            result[i] = f(self[i], other[i]);
        }
        result
    }

    fn longest(&self) -> f64 {
        self.iter().fold(0.0, |longest, entry| worse(entry.to_f64().abs(), longest))
    }
}

/// The larger of two numbers; NaN if either is NaN.
#[inline]
pub(crate) fn worse(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// |u|².
#[inline(always)]
pub(crate) fn length_squared<const N: usize, T: Real>(u: &SVector<T, N>) -> T {
    u.iter().fold(T::zero(), |sum, entry| sum + *entry * *entry)
}

/// A velocity and the length of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VelocityStep<const N: usize, T> {
    pub(crate) v: SVector<T, N>,
    pub(crate) h: T,
}

impl<const N: usize, T: Real> Vector<T> for VelocityStep<N, T> {
    #[inline(always)]
    fn zip_map(&self, other: &Self, f: impl Fn(T, T) -> T) -> Self {
        let h = f(self.h, other.h);
        Self { v: Vector::zip_map(&self.v, &other.v, f), h }
    }

    fn longest(&self) -> f64 {
        worse(self.h.to_f64().abs(), self.v.longest())
    }
}

/// Weights of coordinates in the length of a correction, from the diagonal of the mass matrix: its square roots, and the
/// largest of them for coordinates without mass.
///
/// The length of a correction shows convergence even if residuals of momenta and of constraints, in roundings of their
/// terms, cannot be compared: a rod far from the origin has large terms in its constraint only.
pub(crate) fn weights<const N: usize>(mass: &SVector<f64, N>) -> SVector<f64, N> {
    let largest = mass.max();
    let largest = if largest > 0.0 { largest } else { 1.0 };
    mass.map(|mass| if mass > 0.0 { mass } else { largest }.sqrt())
}
