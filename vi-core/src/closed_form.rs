//! A step whose equations are linear, as one matrix.
//!
//! In: an autonomous system whose A and whose gain's derivatives depend on parameters and h only, so that L and f are
//! quadratic and linear. Out: what a step adds to q and p, by
//!
//! ```text
//! h v     = Q q + P p + c        the columns of Q, P, R, S are the answers of the equations to unit vectors, c that to zero
//! p1 − p0 = R q + S p + d
//! ```
//!
//! two products that wait for nothing, instead of an evaluation, a solution and another evaluation one after the other.

use crate::stride::{Inverse, linear_velocity};
use crate::{Node, Scalar, State, Stepping};
use nalgebra::{SMatrix, SVector};

/// Roundings by which both ways may differ.
const AGREEMENT: f64 = 32.0;

/// The matrix of a linear step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClosedForm<const N: usize, T> {
    way: Affine<N, T>,
    gain: Affine<N, T>,
}

/// What a step adds to q and to p.
type Answer<const N: usize, T> = (SVector<T, N>, SVector<T, N>);

/// `Q q + P p + c`.
#[derive(Clone, Copy, Debug)]
struct Affine<const N: usize, T> {
    by_q: SMatrix<T, N, N>,
    by_p: SMatrix<T, N, N>,
    constant: SVector<T, N>,
}

impl<const N: usize, T: Scalar> Affine<N, T> {
    #[inline]
    fn at(&self, node: &Node<N, T>) -> SVector<T, N> {
        (self.by_q * node.q + self.constant) + self.by_p * node.p
    }
}

impl<const N: usize, T: Scalar> ClosedForm<N, T> {
    /// That of a system with a step h; `None` where it has none, or where it does not agree with the equations at `node`.
    pub(crate) fn of<S: Stepping<N, T>>(
        system: &S,
        node: &Node<N, T>,
        h: T,
        inverse: Option<&Inverse<S, N, T>>,
    ) -> Option<Self> {
        let inverse = inverse.filter(|_| S::CLOSED_FORM)?;
        let answer = |node: &Node<N, T>| {
            let v = linear_velocity(system, node, h, inverse);
            (v * h, system.increment(node, h, &v).momentum)
        };
        let at = |q: SVector<T, N>, p: SVector<T, N>| answer(&Node::new(State { t: node.t, q, p }, T::zero()));
        let (zeros, unit) =
            (SVector::zeros(), |j: usize| SVector::from_fn(|i, _| T::real(f64::from(u8::from(i == j)))));
        let constant = at(zeros, zeros);
        // So large that the constant is below the rounding of the rest, and a power of two.
        let large = T::real(f64::from(1_u32 << 30)) * T::real(f64::from(1_u32 << 30));
        let affine = |part: fn(&Answer<N, T>) -> SVector<T, N>| {
            let column = |(q, p)| (part(&at(q, p)) - part(&constant)) * large.recip();
            let by_q: [SVector<T, N>; N] = core::array::from_fn(|j| column((unit(j) * large, zeros)));
            let by_p: [SVector<T, N>; N] = core::array::from_fn(|j| column((zeros, unit(j) * large)));
            Affine { by_q: SMatrix::from_columns(&by_q), by_p: SMatrix::from_columns(&by_p), constant: part(&constant) }
        };
        let form = Self { way: affine(|answer| answer.0), gain: affine(|answer| answer.1) };
        let (wanted, found) = (answer(node), form.step(node));
        let agrees = |affine: &Affine<N, T>, wanted: &SVector<T, N>, found: &SVector<T, N>| {
            let bound = T::real(AGREEMENT * T::EPSILON);
            (0..N).all(|i| {
                let terms = |j| (affine.by_q[(i, j)] * node.q[j]).abs() + (affine.by_p[(i, j)] * node.p[j]).abs();
                let magnitude = (0..N).fold(affine.constant[i].abs(), |sum, j| sum + terms(j));
                (wanted[i] - found[i]).abs() <= magnitude * bound
            })
        };
        (agrees(&form.way, &wanted.0, &found.0) && agrees(&form.gain, &wanted.1, &found.1)).then_some(form)
    }

    /// What the step from this node adds to q and p.
    #[inline]
    pub(crate) fn step(&self, node: &Node<N, T>) -> Answer<N, T> {
        (self.way.at(node), self.gain.at(node))
    }
}
