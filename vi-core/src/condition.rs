//! Condition numbers of the equations of an energy-preserving step.
//!
//! For an [`ExtendedSystem`] at the solution `(v, h)`, this module computes the ratio of the largest to the smallest
//! singular value of its Jacobian in three forms. With the momentum row r and the energy row e, uncombined,
//!
//! ```text
//! ∂e/∂v = h energy_dv + vᵀA        ∂e/∂h = h energy_dh + v·∂r/∂h
//! ```
//!
//! grow as `1/h` in the unknowns `(v, h)`, and as `1/h²` in `(q1, t1)` with `v = (q1 − q0)/h`. Combined and scaled rows
//! do not grow.

use crate::linear::Matrix;
use crate::real::Scalar;
use crate::stepping::ExtendedSystem;
use nalgebra::{DMatrix, SVector};

/// Condition numbers in the 2-norm; infinite if the Jacobian is singular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Rows `(r, e)`, unknowns `(q1, t1)`, as in the paper.
    pub position_time: f64,
    /// Rows `(r, e)`, unknowns `(v, h)`.
    pub velocity_step: f64,
    /// Rows `(r/h, (e − v·r)/h²)`, unknowns `(v/h, h/h_previous)`, as in the stepper.
    pub scaled: f64,
}

impl Condition {
    /// The condition numbers at `(v, h)` after a step of length `h_previous`. Allocates.
    #[must_use]
    pub fn of<const N: usize, T: Scalar>(
        equations: &ExtendedSystem<N, T, impl Matrix<N, T>>,
        h: T,
        v: &SVector<T, N>,
        h_previous: T,
    ) -> Self {
        let number = |value: T| value.to_f64();
        let (h, h_previous, v) = (number(h), number(h_previous), v.map(number));
        let a = equations.momentum.jacobian.dense().map(number);
        let residual_dh = equations.residual_dh.map(number);
        let energy_dv = equations.energy_dv.map(number);
        let energy_dh = number(equations.energy_dh);

        let raw_dv = energy_dv * h + a.tr_mul(&v);
        let raw_dh = energy_dh * h + v.dot(&residual_dh);
        let raw = bordered::<N>(|i, j| a[(i, j)], |i| residual_dh[i], |j| raw_dv[j], raw_dh);
        let chain = bordered::<N>(|i, j| if i == j { h.recip() } else { 0.0 }, |i| -v[i] / h, |_| 0.0, 1.0);
        let stretch = h_previous / h;
        let scaled =
            bordered::<N>(|i, j| a[(i, j)], |i| residual_dh[i] * stretch, |j| energy_dv[j], energy_dh * stretch);
        Self {
            position_time: condition_number(&(&raw * chain)),
            velocity_step: condition_number(&raw),
            scaled: condition_number(&scaled),
        }
    }
}

/// The matrix `[block, column; row, corner]` of N + 1 rows.
fn bordered<const N: usize>(
    block: impl Fn(usize, usize) -> f64,
    column: impl Fn(usize) -> f64,
    row: impl Fn(usize) -> f64,
    corner: f64,
) -> DMatrix<f64> {
    DMatrix::from_fn(N + 1, N + 1, |i, j| match (i == N, j == N) {
        (false, false) => block(i, j),
        (false, true) => column(i),
        (true, false) => row(j),
        (true, true) => corner,
    })
}

/// Largest over smallest singular value.
fn condition_number(matrix: &DMatrix<f64>) -> f64 {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return f64::INFINITY;
    }
    let values = matrix.singular_values();
    let smallest = values.min();
    if smallest > 0.0 { values.max() / smallest } else { f64::INFINITY }
}
