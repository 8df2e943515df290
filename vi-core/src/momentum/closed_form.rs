//! A step whose equations are linear, as one matrix.
//!
//! In: an autonomous system whose L is quadratic and whose f is linear, and h. Out: the velocity of a step and what it adds to p,
//!
//! ```text
//! v       = Q q + P p + c        the columns of Q, P, R, S are the answers of the equations to unit vectors, c and d those to zero
//! p1 − p0 = R q + S p + d
//! ```
//!
//! two products that wait for nothing, instead of an evaluation, a solution and another evaluation one after the other.

use crate::linear::Matrix;
use crate::{Node, Real, Scalar, Stepping};
use nalgebra::{SMatrix, SVector};

/// The matrix of a linear step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClosedForm<const N: usize, T> {
    velocity: Affine<N, T>,
    increment: Affine<N, T>,
}

/// The velocity of a step, and what it adds to p.
type Answer<const N: usize, T> = [SVector<T, N>; 2];

/// `Q q + P p + c`.
#[derive(Clone, Copy, Debug)]
struct Affine<const N: usize, T> {
    by_q: SMatrix<T, N, N>,
    by_p: SMatrix<T, N, N>,
    constant: SVector<T, N>,
}

impl<const N: usize, T: Real> Affine<N, T> {
    #[inline(always)]
    fn at(&self, node: &Node<N, T>) -> SVector<T, N> {
        (self.by_q * node.q + self.constant) + self.by_p * node.p
    }
}

impl<const N: usize, T: Scalar> ClosedForm<N, T> {
    /// That of a system with a step h, by the inverse of its A.
    pub(crate) fn of<S: Stepping<N, T>>(system: &S, h: T, inverse: &<S::Jacobian as Matrix<N, T>>::Inverse) -> Self {
        let answer = |q: SVector<T, N>, p: SVector<T, N>| {
            let node = Node { q, p, ..Node::zeros() };
            let v = -S::Jacobian::apply(inverse, &system.momentum_residual(&node, h, &SVector::zeros()).residual);
            [v, system.momentum_residual(&node, h, &v).increment]
        };
        let zeros = SVector::zeros();
        let constant = answer(zeros, zeros);
        // So large that the constant is below the rounding of the rest, and a power of two.
        let large = T::real(f64::from(1_u32 << 30)) * T::real(f64::from(1_u32 << 30));
        let unit = |j: usize| SVector::from_fn(|i, _| if i == j { large } else { T::zero() });
        let affine = |part: usize| {
            let column = |answer: Answer<N, T>| (answer[part] - constant[part]) * large.recip();
            let by_q: [SVector<T, N>; N] = core::array::from_fn(|j| column(answer(unit(j), zeros)));
            let by_p: [SVector<T, N>; N] = core::array::from_fn(|j| column(answer(zeros, unit(j))));
            Affine { by_q: SMatrix::from_columns(&by_q), by_p: SMatrix::from_columns(&by_p), constant: constant[part] }
        };
        Self { velocity: affine(0), increment: affine(1) }
    }

    /// The velocity of the step from this node, and what it adds to p.
    #[inline(always)]
    pub(crate) fn step(&self, node: &Node<N, T>) -> (SVector<T, N>, SVector<T, N>) {
        (self.velocity.at(node), self.increment.at(node))
    }
}
