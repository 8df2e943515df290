//! A linear step as one matrix product.
//!
//! The system is autonomous with up to [`LARGEST`] coordinates, quadratic L and linear f. For a given h, the velocity
//! of a step and its momentum increment are
//!
//! ```text
//! v       = Q q + P p + c        the columns of Q, P, R, S solve the equations for unit vectors, c and d for zero
//! p1 − p0 = R q + S p + d
//! ```
//!
//! These two products are independent. They replace an evaluation, a solution and another evaluation in sequence.

use crate::linear::Matrix;
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::stepping::FixedStepping;
use nalgebra::SVector;

/// Largest number of coordinates with a closed form.
const LARGEST: usize = 3;

/// The number of coordinates that move; the others are at rest.
const fn moving(coordinates: usize) -> usize {
    if coordinates < LARGEST { coordinates } else { LARGEST }
}

/// The matrix of a linear step. Its size is that of the largest closed form: N × N numbers would be large if not used.
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
        let mut sums = SVector::zeros();
        for i in 0..const { moving(N) } {
            let (mut by_q, mut by_p) = (self.constant[i], T::zero());
            for j in 0..const { moving(N) } {
                by_q += self.by_q[i][j] * node.q[j];
                by_p += self.by_p[i][j] * node.p[j];
            }
            sums[i] = by_q + by_p;
        }
        sums
    }
}

impl<T: Scalar> ClosedForm<T> {
    /// The closed form of a system with a step h, by the inverse of its A.
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
        // A power of two, so large that the constant rounds away.
        let large = T::real(f64::from(1_u32 << 30)) * T::real(f64::from(1_u32 << 30));
        let mut form = [Affine::zeros(); 2];
        for j in 0..moving(N) {
            let unit = SVector::from_fn(|i, _| if i == j { large } else { T::zero() });
            let (by_q, by_p) = (answer(unit, zeros), answer(zeros, unit));
            for (part, affine) in form.iter_mut().enumerate() {
                for i in 0..moving(N) {
                    affine.constant[i] = constant[part][i];
                    affine.by_q[i][j] = (by_q[part][i] - constant[part][i]) * large.recip();
                    affine.by_p[i][j] = (by_p[part][i] - constant[part][i]) * large.recip();
                }
            }
        }
        let [velocity, increment] = form;
        Self { velocity, increment }
    }

    /// The velocity of the step from this node, and the momentum increment.
    #[inline(always)]
    pub(crate) fn step<const N: usize>(&self, node: &Node<N, T>) -> (SVector<T, N>, SVector<T, N>) {
        (self.velocity.at(node), self.increment.at(node))
    }
}
