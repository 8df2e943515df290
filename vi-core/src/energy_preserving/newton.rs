//! Newton's iteration on the n + 1 equations.
//!
//! In: a trial `(v, h)` and the range that h must keep to. Out: the root with momentum and energy equation at the rounding
//! floor. With `a = A⁻¹ r`, `b = A⁻¹ ∂r/∂h` the combined and scaled rows of [`ExtendedSystem`] leave one equation for
//! `y = δh/h`,
//!
//! ```text
//! S y = −(c/h² − energy_dv·a/h)        S = energy_dh − energy_dv·b = −D/4
//! δh = h y                              δv = −a − b δh
//! ```
//!
//! and S is the step density besides.

use crate::momentum;
use crate::{ExtendedSystem, Node, Scalar, Stepping, linear};
use nalgebra::{SMatrix, SVector};

const ITERATIONS: u32 = 20;
/// Roundings of its terms below which S counts as zero.
const VANISHING: f64 = 64.0;

/// A velocity and a step length to try.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial<const N: usize, T> {
    pub(super) v: SVector<T, N>,
    pub(super) h: T,
}

/// A step that solves the equations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root<const N: usize, T> {
    pub(super) v: SVector<T, N>,
    pub(super) h: T,
    pub(super) density: T,
    pub(super) iterations: u32,
    pub(super) residual: f64,
}

/// Why there is no root here.
#[derive(Clone, Copy, Debug)]
pub(super) enum Failure<T> {
    /// The equations hold, and would for other lengths too.
    Degenerate { h: T, density: T },
    /// The iteration left the range, met a singular matrix or an overflow, or did not reach the floor.
    NoRoot,
}

/// The momentum rows eliminated from the energy row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elimination<const N: usize, T> {
    /// `a = A⁻¹ r`.
    pub(super) residual: SVector<T, N>,
    /// `b = A⁻¹ ∂r/∂h`.
    pub(super) residual_dh: SVector<T, N>,
    /// `S = energy_dh − energy_dv·b`.
    schur: T,
    /// Sum of the absolute values of the terms of S.
    schur_magnitude: T,
}

impl<const N: usize, T: Scalar> Elimination<N, T> {
    /// `None` where A is singular.
    #[inline]
    pub(super) fn of(equations: &ExtendedSystem<N, T>) -> Option<Self> {
        let momentum = &equations.momentum;
        let both = SMatrix::<T, N, 2>::from_columns(&[momentum.residual, equations.residual_dh]);
        let solved = linear::solve(&momentum.jacobian, &both)?;
        let (residual, residual_dh) = (solved.column(0).into_owned(), solved.column(1).into_owned());
        let (mut schur, mut schur_magnitude) = (equations.energy_dh, equations.energy_dh.abs());
        for (energy_dv, b) in equations.energy_dv.iter().zip(residual_dh.iter()) {
            let term = *energy_dv * *b;
            schur -= term;
            schur_magnitude += term.abs();
        }
        Some(Self { residual, residual_dh, schur, schur_magnitude })
    }

    /// Step density D of the interval; `None` where a term of it is not finite.
    #[inline]
    pub(super) fn density(&self) -> Option<T> {
        (self.schur_magnitude * T::real(4.0)).is_finite().then(|| self.schur * T::real(-4.0))
    }

    /// Whether S is zero but for its rounding.
    #[inline]
    fn is_degenerate(&self) -> bool {
        self.schur.to_f64().abs() <= VANISHING * T::EPSILON * self.schur_magnitude.to_f64()
    }
}

/// The root that Newton's iteration reaches from `trial` with h inside `range`; `observe` is told the larger residual of
/// the rows before each iteration, in roundings.
#[inline]
pub(super) fn solve<const N: usize, T: Scalar, S: Stepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    mut trial: Trial<N, T>,
    (shortest, longest): (T, T),
    mut observe: impl FnMut(f64),
) -> Result<Root<N, T>, Failure<T>> {
    let mut before = Rows { momentum: f64::INFINITY, energy: f64::INFINITY };
    for iterations in 0..=ITERATIONS {
        let equations = system.extended_system(node, trial.h, &trial.v);
        let elimination = Elimination::of(&equations).ok_or(Failure::NoRoot)?;
        let rows = Rows::of(&equations);
        observe(momentum::worse(rows.momentum, rows.energy));
        let density = elimination.density().ok_or(Failure::NoRoot)?;
        let (v, h) = (trial.v, trial.h);
        if rows.are_at_floor(&before) {
            let root = Root { v, h, density, iterations, residual: momentum::worse(rows.momentum, rows.energy) };
            return if elimination.is_degenerate() { Err(Failure::Degenerate { h, density }) } else { Ok(root) };
        }
        let energy = equations.energy_residual / h / h - equations.energy_dv.dot(&elimination.residual) / h;
        let dh = -(energy / elimination.schur) * h;
        trial = Trial { v: v - elimination.residual - elimination.residual_dh * dh, h: h + dh };
        if !(trial.h >= shortest && trial.h <= longest) {
            return Err(Failure::NoRoot);
        }
        before = rows;
    }
    Err(Failure::NoRoot)
}

/// The residuals of the rows, in roundings.
#[derive(Clone, Copy, Debug)]
struct Rows {
    momentum: f64,
    energy: f64,
}

impl Rows {
    #[inline]
    fn of<const N: usize, T: Scalar>(equations: &ExtendedSystem<N, T>) -> Self {
        Self {
            momentum: momentum::worst(&equations.momentum.residual, &equations.momentum.magnitude),
            energy: momentum::roundings(equations.energy_residual, equations.energy_magnitude),
        }
    }

    /// Each row for itself: the rounding of one must not hide that the other still gains.
    #[inline]
    fn are_at_floor(&self, before: &Self) -> bool {
        momentum::is_at_floor(self.momentum, before.momentum) && momentum::is_at_floor(self.energy, before.energy)
    }
}
