//! The kind of a system: free, or bound by K constraints.
//!
//! [`Motion::Kind`] is [`Free`] or [`Bound<K>`](Bound). A free system is one with zero
//! constraints: the arrays of its multipliers and gradients are empty. So one trait describes the motion of both kinds,
//! and a method takes its solver from the kind.

use crate::linear::{AtMost, Rectangular, Rows, Sparse};
#[cfg(feature = "alloc")]
use crate::method::energy_gauss::BoundLengths;
use crate::method::energy_gauss::{FreeLengths, LengthSolver};
#[cfg(feature = "alloc")]
use crate::method::gauss::BoundGauss;
use crate::method::gauss::{FreeGauss, StageSolver};
use crate::motion::Motion;
use crate::real::Real;
use crate::stepping::Convertible;
use core::fmt::Debug;
use core::marker::PhantomData;
use nalgebra::SVector;

/// The number of constraints of a system, and the types of their values and derivatives over the numbers T.
pub trait Kind: Copy + Debug + Send + Sync + 'static {
    /// The number of constraints; the largest one if the system is known at run time only.
    const COUNT: usize;
    /// One number for each constraint.
    type Multipliers<T: Real>: Copy + Debug + PartialEq + Send + Sync + AsRef<[T]> + AsMut<[T]>;
    /// The rows of A and of `(A v + a)_q`, one for each constraint.
    type Gradients<const N: usize, T: Real>: Rectangular<N, T> + Copy + Debug + PartialEq + Send + Sync;
    /// The rows of `∂(Aᵀλ)/∂q`, one for each coordinate.
    type ReactionMatrix<const N: usize, T: Real>: Rectangular<N, T> + Copy + Debug + PartialEq + Send + Sync;

    /// The solver of Gauss steps.
    #[doc(hidden)]
    type Stages<S: Convertible<N, Kind = Self>, const N: usize, const STAGES: usize>: StageSolver<S, N, STAGES>;
    /// The solver of Gauss steps of any length.
    #[doc(hidden)]
    type Lengths<S: Convertible<N, Kind = Self>, const N: usize, const STAGES: usize>: LengthSolver<S, N, STAGES>;

    /// One zero for each constraint.
    #[doc(hidden)]
    fn no_multipliers<T: Real>() -> Self::Multipliers<T>;
    /// Zero gradients.
    #[doc(hidden)]
    fn no_gradients<const N: usize, T: Real>() -> Self::Gradients<N, T>;
    /// The zero matrix.
    #[doc(hidden)]
    fn no_reaction<const N: usize, T: Real>() -> Self::ReactionMatrix<N, T>;
}

/// The kind of a system without constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Free {}

/// The kind of a system with K constraints; its solvers need the feature `alloc`. F is the form of the derivatives of
/// the constraints: [`Dense`], [`Nonzeros`] in generated systems, or [`Counted`] in those that are known at run time only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bound<const K: usize, F = Dense>(PhantomData<F>);

/// The form of the derivatives of constraints.
pub trait Form: Copy + Debug + Send + Sync + 'static {
    /// One number for each constraint.
    type Multipliers<const K: usize, T: Real>: Copy + Debug + PartialEq + Send + Sync + AsRef<[T]> + AsMut<[T]>;
    /// K rows of N entries.
    type Gradients<const K: usize, const N: usize, T: Real>: Rectangular<N, T> + Copy + Debug + PartialEq + Send + Sync;
    /// N rows of N entries.
    type ReactionMatrix<const N: usize, T: Real>: Rectangular<N, T> + Copy + Debug + PartialEq + Send + Sync;

    /// K zeros.
    #[doc(hidden)]
    fn no_multipliers<const K: usize, T: Real>() -> Self::Multipliers<K, T>;
    /// K zero rows.
    #[doc(hidden)]
    fn no_gradients<const K: usize, const N: usize, T: Real>() -> Self::Gradients<K, N, T>;
    /// N zero rows.
    #[doc(hidden)]
    fn no_reaction<const N: usize, T: Real>() -> Self::ReactionMatrix<N, T>;
}

/// Dense rows: the form to write by hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dense {}

impl Form for Dense {
    type Multipliers<const K: usize, T: Real> = [T; K];
    type Gradients<const K: usize, const N: usize, T: Real> = [SVector<T, N>; K];
    type ReactionMatrix<const N: usize, T: Real> = [SVector<T, N>; N];

    fn no_multipliers<const K: usize, T: Real>() -> [T; K] {
        [T::zero(); K]
    }

    fn no_gradients<const K: usize, const N: usize, T: Real>() -> [SVector<T, N>; K] {
        [SVector::zeros(); K]
    }

    fn no_reaction<const N: usize, T: Real>() -> [SVector<T, N>; N] {
        [SVector::zeros(); N]
    }
}

/// Rows by their nonzeros: at most W in a gradient, at most R in a row of `∂(Aᵀλ)/∂q`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nonzeros<const W: usize, const R: usize> {}

impl<const W: usize, const R: usize> Form for Nonzeros<W, R> {
    type Multipliers<const K: usize, T: Real> = [T; K];
    type Gradients<const K: usize, const N: usize, T: Real> = Sparse<K, W, T>;
    type ReactionMatrix<const N: usize, T: Real> = Sparse<N, R, T>;

    fn no_multipliers<const K: usize, T: Real>() -> [T; K] {
        [T::zero(); K]
    }

    fn no_gradients<const K: usize, const N: usize, T: Real>() -> Sparse<K, W, T> {
        Sparse { columns: const { &[&[]; K] }, rows: [[T::zero(); W]; K] }
    }

    fn no_reaction<const N: usize, T: Real>() -> Sparse<N, R, T> {
        Sparse { columns: const { &[&[]; N] }, rows: [[T::zero(); R]; N] }
    }
}

/// Rows by their nonzeros, as [`Nonzeros`], of at most K constraints: for a system that is known at run time only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counted {}

impl Form for Counted {
    type Multipliers<const K: usize, T: Real> = AtMost<K, T>;
    type Gradients<const K: usize, const N: usize, T: Real> = Rows<K, N, T>;
    type ReactionMatrix<const N: usize, T: Real> = Rows<N, N, T>;

    fn no_multipliers<const K: usize, T: Real>() -> AtMost<K, T> {
        AtMost::zeros(K)
    }

    fn no_gradients<const K: usize, const N: usize, T: Real>() -> Rows<K, N, T> {
        Rows::zeros(&[])
    }

    fn no_reaction<const N: usize, T: Real>() -> Rows<N, N, T> {
        Rows::zeros(&[])
    }
}

/// The multipliers of a system: `[T; K]`, or [`AtMost`] K.
pub type Multipliers<S, const N: usize, T = f64> = <<S as Motion<N, T>>::Kind as Kind>::Multipliers<T>;
/// The gradients of the constraints of a system.
pub type Gradients<S, const N: usize, T = f64> = <<S as Motion<N, T>>::Kind as Kind>::Gradients<N, T>;
/// The derivatives of the reaction of a system.
pub type ReactionMatrix<S, const N: usize, T = f64> = <<S as Motion<N, T>>::Kind as Kind>::ReactionMatrix<N, T>;

impl Kind for Free {
    const COUNT: usize = 0;
    type Multipliers<T: Real> = [T; 0];
    type Gradients<const N: usize, T: Real> = [SVector<T, N>; 0];
    type ReactionMatrix<const N: usize, T: Real> = [SVector<T, N>; N];
    type Stages<S: Convertible<N, Kind = Self>, const N: usize, const STAGES: usize> = FreeGauss<STAGES>;
    type Lengths<S: Convertible<N, Kind = Self>, const N: usize, const STAGES: usize> = FreeLengths<STAGES>;

    fn no_multipliers<T: Real>() -> [T; 0] {
        []
    }

    fn no_gradients<const N: usize, T: Real>() -> [SVector<T, N>; 0] {
        []
    }

    fn no_reaction<const N: usize, T: Real>() -> [SVector<T, N>; N] {
        [SVector::zeros(); N]
    }
}

#[cfg(feature = "alloc")]
impl<const K: usize, F: Form> Kind for Bound<K, F> {
    const COUNT: usize = K;
    type Multipliers<T: Real> = F::Multipliers<K, T>;
    type Gradients<const N: usize, T: Real> = F::Gradients<K, N, T>;
    type ReactionMatrix<const N: usize, T: Real> = F::ReactionMatrix<N, T>;
    type Stages<S: Convertible<N, Kind = Self>, const N: usize, const STAGES: usize> = BoundGauss<STAGES>;
    type Lengths<S: Convertible<N, Kind = Self>, const N: usize, const STAGES: usize> = BoundLengths<STAGES>;

    fn no_multipliers<T: Real>() -> Self::Multipliers<T> {
        F::no_multipliers()
    }

    fn no_gradients<const N: usize, T: Real>() -> Self::Gradients<N, T> {
        F::no_gradients()
    }

    fn no_reaction<const N: usize, T: Real>() -> Self::ReactionMatrix<N, T> {
        F::no_reaction()
    }
}
