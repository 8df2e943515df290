//! A step whose equations are linear, as one matrix.
//!
//! In: an autonomous system of up to [`LARGEST`] coordinates whose L is quadratic and whose f is linear, and h. Out: the velocity of a
//! step and what it adds to p,
//!
//! ```text
//! v       = Q q + P p + c        the columns of Q, P, R, S are the answers of the equations to unit vectors, c and d those to zero
//! p1 − p0 = R q + S p + d
//! ```
//!
//! two products that wait for nothing, instead of an evaluation, a solution and another evaluation one after the other.

use crate::linear::Matrix;
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::stepping::FixedStepping;
use nalgebra::SVector;

/// Coordinates that a system with a closed form has at most.
const LARGEST: usize = 3;

/// The matrix of a linear step. Room for the largest one: a matrix of N × N would be large where it is not used.
#[derive(Clone, Copy, Debug)]
pub struct ClosedForm<T> {
    velocity: Affine<T>,
    increment: Affine<T>,
}

/// `Q q + P p + c`, row by row.
#[derive(Clone, Copy, Debug)]
struct Affine<T> {
    by_q: [[T; LARGEST]; LARGEST],
    by_p: [[T; LARGEST]; LARGEST],
    constant: [T; LARGEST],
}

impl<T: Real> Affine<T> {
    fn zeros() -> Self {
        let zeros = [T::zero(); LARGEST];
        Self { by_q: [zeros; LARGEST], by_p: [zeros; LARGEST], constant: zeros }
    }

    #[inline(always)]
    fn at<const N: usize>(&self, node: &Node<N, T>) -> SVector<T, N> {
        let mut sums = node.q;
        for i in 0..N {
            let (mut by_q, mut by_p) = (self.constant[i], T::zero());
            for j in 0..N {
                by_q += self.by_q[i][j] * node.q[j];
                by_p += self.by_p[i][j] * node.p[j];
            }
            sums[i] = by_q + by_p;
        }
        sums
    }
}

impl<T: Scalar> ClosedForm<T> {
    /// That of a system with a step h, by the inverse of its A.
    pub(crate) fn of<const N: usize, S: FixedStepping<N, T>>(
        system: &S,
        h: T,
        inverse: &<S::Jacobian as Matrix<N, T>>::Inverse,
    ) -> Self {
        let answer = |q: SVector<T, N>, p: SVector<T, N>| {
            let node = Node { q, p, ..Node::zeros() };
            let v = -S::Jacobian::apply(inverse, &system.momentum_residual(&node, h, &SVector::zeros()).residual);
            [v, system.momentum_residual(&node, h, &v).increment]
        };
        let zeros = SVector::zeros();
        let constant = answer(zeros, zeros);
        // So large that the constant is below the rounding of the rest, and a power of two.
        let large = T::real(f64::from(1_u32 << 30)) * T::real(f64::from(1_u32 << 30));
        let mut form = [Affine::zeros(); 2];
        for j in 0..N {
            let unit = SVector::from_fn(|i, _| if i == j { large } else { T::zero() });
            let (by_q, by_p) = (answer(unit, zeros), answer(zeros, unit));
            for (part, affine) in form.iter_mut().enumerate() {
                for i in 0..N {
                    affine.constant[i] = constant[part][i];
                    affine.by_q[i][j] = (by_q[part][i] - constant[part][i]) * large.recip();
                    affine.by_p[i][j] = (by_p[part][i] - constant[part][i]) * large.recip();
                }
            }
        }
        let [velocity, increment] = form;
        Self { velocity, increment }
    }

    /// The velocity of the step from this node, and what it adds to p.
    #[inline(always)]
    pub(crate) fn step<const N: usize>(&self, node: &Node<N, T>) -> (SVector<T, N>, SVector<T, N>) {
        (self.velocity.at(node), self.increment.at(node))
    }
}
