//! The functions of the constraints of a large system.
//!
//! A constraint on positions, `g(t, q) = 0`, and one on velocities, `A v + a = 0`, are one function c(t, q, v):
//!
//! ```text
//!                     on positions, c = g      on velocities, c = A v + a
//! A                   c_q                      c_v
//! a                   c_t                      c at v = 0
//! ∂(A v + a)/∂q       d/dt(c_q)                c_q
//! ∂(A v + a)/∂t       ∂/∂t(dc/dt)              c_t
//! ∂(Aᵀλ)/∂q           Σ λ_r c_r,qq             Σ λ_r c_r,vq
//! ```
//!
//! with `d/dt` along `(1, v, 0)`.

use crate::lagrangian::Lagrangian;
use crate::real::dual::{along, slopes};
use crate::real::{Dual, Real};
use nalgebra::{SMatrix, SVector};

/// The K constraints of a large system, computed by loops. Those on positions come first.
pub trait IndexedConstraints<const N: usize, const K: usize, T: Real = f64>: Lagrangian<N, T> + Copy {
    /// The same system over dual numbers.
    type Dual: IndexedConstraints<N, K, Dual<T>>;

    /// The names of the constraints, for [`Motion::CONSTRAINTS`](crate::motion::Motion::CONSTRAINTS).
    const CONSTRAINTS: &'static [&'static str];
    /// The number of constraints on positions, for [`Motion::HOLONOMIC`](crate::motion::Motion::HOLONOMIC).
    const HOLONOMIC: usize;

    /// Converts the system to dual numbers; the parameters are constants.
    fn dual(&self) -> Self::Dual;
    /// The constraints: g, or `A v + a`.
    fn constraint_values(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> [T; K];
    /// Derivatives of the constraints. For `columns = [c_q, c_v]`, row r, column j is `(c_v ∂/∂v_j + c_q ∂/∂q_j)` of
    /// constraint r.
    fn constraint_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>, columns: [T; 2])
    -> [SVector<T, N>; K];
    /// Second derivatives of the sum of all constraints, each times its weight, as those of L in
    /// [`Indexed::second_derivatives`](super::Indexed::second_derivatives).
    #[allow(clippy::too_many_arguments)] // a point, and weights
    fn constraint_second_derivatives(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
        weights: &[T; K],
        rows: [T; 2],
        columns: [T; 2],
    ) -> SMatrix<T, N, N>;
}

/// Weights of the derivatives with respect to q, and to v.
fn weights<T: Real>() -> [[T; 2]; 2] {
    [[T::one(), T::zero()], [T::zero(), T::one()]]
}

/// A vector that does not change.
fn constant<T: Real, const N: usize>(vector: &SVector<T, N>) -> SVector<Dual<T>, N> {
    along(vector, &SVector::zeros())
}

/// A time that passes.
fn passing<T: Real>(t: T) -> Dual<T> {
    Dual { value: t, slope: T::one() }
}

/// g of the constraints on positions, zero for the others, for [`Motion::constraints`](crate::motion::Motion::constraints).
#[inline]
pub fn constraints<const N: usize, const K: usize, T: Real, S>(system: &S, t: T, q: &SVector<T, N>) -> [T; K]
where
    S: IndexedConstraints<N, K, T>,
{
    let mut values = system.constraint_values(t, q, &SVector::zeros());
    values[S::HOLONOMIC..].fill(T::zero());
    values
}

/// A and a, for [`Motion::constraint_gradients`](crate::motion::Motion::constraint_gradients).
#[inline]
pub fn constraint_gradients<const N: usize, const K: usize, T: Real, S>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
) -> ([SVector<T, N>; K], [T; K])
where
    S: IndexedConstraints<N, K, T>,
{
    let (rest, [by_q, by_v]) = (SVector::zeros(), weights());
    let gradients = of_kinds::<K, S, N, T, _>(
        || system.constraint_derivatives(t, q, &rest, by_q),
        || system.constraint_derivatives(t, q, &rest, by_v),
    );
    let rates = of_kinds::<K, S, N, T, _>(
        || {
            // Not by a derivative, which may be a product of zero and infinity.
            if S::AUTONOMOUS {
                return [T::zero(); K];
            }
            let found = system.dual().constraint_values(passing(t), &constant(q), &constant(&rest));
            found.map(|value| value.slope)
        },
        || system.constraint_values(t, q, &rest),
    );
    (gradients, rates)
}

/// `∂(A v + a)/∂q` and `∂(A v + a)/∂t`, for [`Motion::constraint_rate_derivatives`](crate::motion::Motion::constraint_rate_derivatives).
#[inline]
pub fn constraint_rate_derivatives<const N: usize, const K: usize, T: Real, S>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    v: &SVector<T, N>,
) -> ([SVector<T, N>; K], [T; K])
where
    S: IndexedConstraints<N, K, T>,
{
    let ([by_q, _], dual) = (weights(), system.dual());
    let rates_dq = of_kinds::<K, S, N, T, _>(
        || {
            let [by_q, _] = weights();
            let found = dual.constraint_derivatives(passing(t), &along(q, v), &SVector::zeros(), by_q);
            found.map(|row| slopes(&row))
        },
        || system.constraint_derivatives(t, q, v, by_q),
    );
    if S::AUTONOMOUS {
        return (rates_dq, [T::zero(); K]);
    }
    let rates_dt = of_kinds::<K, S, N, T, _>(
        || {
            let time = Dual { value: passing(t), slope: Dual { value: T::one(), slope: T::zero() } };
            let place = along(&constant(q), &constant(v));
            dual.dual().constraint_values(time, &place, &SVector::zeros()).map(|value| value.slope.slope)
        },
        || dual.constraint_values(passing(t), &constant(q), &constant(v)).map(|value| value.slope),
    );
    (rates_dq, rates_dt)
}

/// `∂(Aᵀλ)/∂q` by rows, for [`Motion::reaction_derivatives`](crate::motion::Motion::reaction_derivatives).
#[inline]
pub fn reaction_derivatives<const N: usize, const K: usize, T: Real, S>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
    multipliers: &[T; K],
) -> [SVector<T, N>; N]
where
    S: IndexedConstraints<N, K, T>,
{
    let (rest, [by_q, by_v]) = (SVector::zeros(), weights());
    let second = |is_of_kind: &dyn Fn(usize) -> bool, rows| {
        let weights = core::array::from_fn(|r| if is_of_kind(r) { multipliers[r] } else { T::zero() });
        system.constraint_second_derivatives(t, q, &rest, &weights, rows, by_q)
    };
    let mut reaction = SMatrix::<T, N, N>::zeros();
    if S::HOLONOMIC > 0 {
        reaction += second(&|r| r < S::HOLONOMIC, by_q);
    }
    if S::HOLONOMIC < K {
        reaction += second(&|r| r >= S::HOLONOMIC, by_v);
    }
    core::array::from_fn(|i| reaction.row(i).transpose())
}

/// A quantity of each constraint, in their order: of constraints on positions by the first function, of those on
/// velocities by the second. A function without constraints is not called.
#[inline]
fn of_kinds<const K: usize, S: IndexedConstraints<N, K, T>, const N: usize, T: Real, R: Copy>(
    on_positions: impl FnOnce() -> [R; K],
    on_velocities: impl FnOnce() -> [R; K],
) -> [R; K] {
    if S::HOLONOMIC == K {
        return on_positions();
    }
    let mut all = on_velocities();
    if S::HOLONOMIC > 0 {
        all[..S::HOLONOMIC].copy_from_slice(&on_positions()[..S::HOLONOMIC]);
    }
    all
}
