//! Nodes with compensated sums, and their update.
//!
//! The next node follows from the solved `(v, h)` of a step and its increments of momentum and energy: `q1 = q0 + h v`,
//! with compensated sums. Each low part stays below half an ulp of its number.

use crate::compensated;
use crate::error::StepError;
use crate::real::{Real, Scalar};
use crate::state::State;
use crate::vector::Vector;
use core::hint::black_box;
use nalgebra::SVector;

/// A node of a run. Each quantity is the unevaluated sum of a number and its low part, so that ten million additions
/// lose no digit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub struct Node<const N: usize, T = f64> {
    /// Time.
    pub t: T,
    /// Low part of `t`.
    pub t_low: T,
    /// Coordinates.
    pub q: SVector<T, N>,
    /// Low part of `q`.
    pub q_low: SVector<T, N>,
    /// Momenta.
    pub p: SVector<T, N>,
    /// Low part of `p`.
    pub p_low: SVector<T, N>,
    /// Discrete energy.
    pub energy: T,
    /// Low part of `energy`.
    pub energy_low: T,
}

impl<const N: usize, T: Real> Node<N, T> {
    /// The node at a state with its discrete energy, which fixed steps ignore. Low parts are zero.
    pub fn new(state: State<N, T>, energy: T) -> Self {
        let (zero, zeros) = (T::zero(), SVector::zeros());
        let State { t, q, p } = state;
        Self { t, t_low: zero, q, q_low: zeros, p, p_low: zeros, energy, energy_low: zero }
    }

    /// Whether both nodes have the same numbers, except for the energy.
    pub(crate) fn is_at(&self, other: &Self) -> bool {
        Self { energy: other.energy, energy_low: other.energy_low, ..*self } == *other
    }

    /// The node at the origin, at rest.
    pub(crate) fn zeros() -> Self {
        Self::new(State { t: T::zero(), q: SVector::zeros(), p: SVector::zeros() }, T::zero())
    }

    /// Converts the node to other numbers.
    pub(crate) fn map<U: Real>(&self, convert: impl Fn(T) -> U + Copy) -> Node<N, U> {
        Node {
            t: convert(self.t),
            t_low: convert(self.t_low),
            q: self.q.map(convert),
            q_low: self.q_low.map(convert),
            p: self.p.map(convert),
            p_low: self.p_low.map(convert),
            energy: convert(self.energy),
            energy_low: convert(self.energy_low),
        }
    }

    /// A copy number by number, in which the compiler sees no copy: a loop over steps then keeps its own numbers in
    /// registers, although a cold path gets all of them.
    #[inline(always)]
    pub(crate) fn apart(&self) -> Self {
        Self {
            t: black_box(self.t),
            t_low: black_box(self.t_low),
            q: Vector::map(&self.q, black_box),
            q_low: Vector::map(&self.q_low, black_box),
            p: Vector::map(&self.p, black_box),
            p_low: Vector::map(&self.p_low, black_box),
            energy: black_box(self.energy),
            energy_low: black_box(self.energy_low),
        }
    }

    /// Time, coordinates and momenta, without low parts.
    #[inline]
    pub fn state(&self) -> State<N, T> {
        State { t: self.t, q: self.q, p: self.p }
    }

    /// Middle of the step `(v, h)` from this node: `(t + h/2, q + (h/2) v)`.
    #[inline]
    pub fn midpoint(&self, h: T, v: &SVector<T, N>) -> (T, SVector<T, N>) {
        self.within(0.5, h, v)
    }

    /// The point of the step `(v, h)` at the part c of its length: `(t + c h, q + c h v)`.
    #[inline]
    pub(crate) fn within(&self, c: f64, h: T, v: &SVector<T, N>) -> (T, SVector<T, N>) {
        let part = h * T::real(c);
        (self.t + (self.t_low + part), self.moved(part, v))
    }

    /// `q + h v`.
    #[inline]
    fn moved(&self, h: T, v: &SVector<T, N>) -> SVector<T, N> {
        self.q + (self.q_low + v * h)
    }

    /// Advances time and coordinates by the step `(v, h)`, `q1 = q0 + h v`; momenta and energy stay.
    #[inline(always)]
    pub(crate) fn shift(&mut self, h: T, v: &SVector<T, N>) {
        self.shift_by(h, &(v * h));
    }

    #[inline(always)]
    fn shift_by(&mut self, h: T, displacement: &SVector<T, N>) {
        compensated::add_rounded(&mut self.t, &mut self.t_low, h);
        compensated::add_vector(&mut self.q, &mut self.q_low, displacement);
    }

    /// Adds h to the time, `displacement` to q and `increment` to p; the energy stays.
    #[inline(always)]
    pub(crate) fn advance_by(&mut self, h: T, displacement: &SVector<T, N>, increment: &SVector<T, N>) {
        self.shift_by(h, displacement);
        compensated::add_vector_apart(&mut self.p, &mut self.p_low, increment);
    }

    /// Advances by the step `(v, h)`, which adds `increment` to p; the energy stays.
    #[inline(always)]
    pub fn advance(&mut self, h: T, v: &SVector<T, N>, increment: &SVector<T, N>) {
        self.advance_by(h, &(v * h), increment);
    }

    /// Adds to the momenta.
    pub(crate) fn add_momentum(&mut self, increment: &SVector<T, N>) {
        compensated::add_vector(&mut self.p, &mut self.p_low, increment);
    }

    /// This node moved to another state, with the same energy.
    pub(crate) fn with_state(&self, state: State<N, T>) -> Self {
        Self { energy_low: self.energy_low, ..Self::new(state, self.energy) }
    }

    /// Sets the time, without a low part.
    pub(crate) fn set_time(&mut self, t: T) {
        self.t = t;
        self.t_low = T::zero();
    }

    /// Adds to the energy.
    #[inline]
    pub(crate) fn add_energy(&mut self, increment: T) {
        compensated::add(&mut self.energy, &mut self.energy_low, increment);
    }
}

impl<const N: usize, T: Scalar> Node<N, T> {
    /// Whether [`Node::advance`] leads to a finite node. Checked before advancing, so that a failed step needs no
    /// rollback and no copy of a large node.
    #[inline(always)]
    pub(crate) fn stays_finite(&self, h: T, v: &SVector<T, N>, increment: &SVector<T, N>) -> bool {
        let displacement = v * h;
        let t = compensated::sum(self.t, self.t_low, h);
        let q = |i| compensated::sum(self.q[i], self.q_low[i], displacement[i]);
        let p = |i| compensated::sum(self.p[i], self.p_low[i], increment[i]);
        are_finite::<N, T>(t, self.energy, q, p)
    }

    /// Whether time, coordinates, momenta and energy are finite.
    #[inline(always)]
    pub(crate) fn is_finite(&self) -> bool {
        are_finite::<N, T>(self.t, self.energy, |i| self.q[i], |i| self.p[i])
    }

    /// Checks that every quantity is finite. `t` is the time of the last good node.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] names the first that is not finite.
    pub fn check_finite(&self, t: T) -> Result<(), StepError> {
        let entries = |vector: &SVector<T, N>| vector.iter().all(|entry| entry.is_finite());
        let quantities = [
            (self.t.is_finite() && self.t_low.is_finite(), "time"),
            (entries(&self.q) && entries(&self.q_low), "position"),
            (entries(&self.p) && entries(&self.p_low), "momentum"),
            (self.energy.is_finite() && self.energy_low.is_finite(), "energy"),
        ];
        match quantities.into_iter().find(|(finite, _)| !finite) {
            Some((_, quantity)) => Err(StepError::NonFinite { t: t.to_f64(), quantity, expression: None }),
            None => Ok(()),
        }
    }
}

/// Whether time, energy, and N coordinates and momenta are finite. Tests their sum, which is exact unless they are
/// huge.
#[inline(always)]
fn are_finite<const N: usize, T: Scalar>(t: T, energy: T, q: impl Fn(usize) -> T, p: impl Fn(usize) -> T) -> bool {
    let ([a, b], [c, d]) = (halves::<N, T>(t, q), halves::<N, T>(energy, p));
    ((a + c) + (b + d)).is_finite()
}

/// Sums the entries with even and with odd indices, so that neighbours add in SIMD registers.
#[inline(always)]
fn halves<const N: usize, T: Scalar>(start: T, entry: impl Fn(usize) -> T) -> [T; 2] {
    let [mut even, mut odd] = [start, T::zero()];
    for i in (1..N).step_by(2) {
        (even, odd) = (even + entry(i - 1), odd + entry(i));
    }
    if N % 2 == 1 { [even + entry(N - 1), odd] } else { [even, odd] }
}
