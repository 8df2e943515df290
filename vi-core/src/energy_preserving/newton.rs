//! Newton's iteration on the n + 1 equations.
//!
//! In: a trial `(v, h)` and the range that h must keep to. Out: the root with momentum and energy equation at the rounding
//! floor. With `a = A⁻¹ r`, `b = A⁻¹ ∂r/∂h` the combined and scaled rows of [`ExtendedSystem`] leave one equation for
//! δh,
//!
//! ```text
//! S δh = −((c + ½ a·r)/h − energy_dv·a)        S = energy_dh − energy_dv·b = −D/4
//! δv = −a − b δh
//! ```
//!
//! and S is the step density besides. The term `½ a·r` is not Newton's: it is `½ δv·A δv`, by which the energy is curved along v
//! (to leading order in h, and all of it where the mass is constant). Without it that is what δh is off by after a step.

use crate::linear::{self, Matrix};
use crate::momentum;
use crate::node::Node;
use crate::predictor::length_squared;
use crate::real::Scalar;
use crate::stepping::{EnergyStepping, ExtendedSystem};
use core::cmp::Ordering;
use nalgebra::{SMatrix, SVector};

const ITERATIONS: u32 = 20;
/// Roundings of its terms below which S counts as zero.
const VANISHING: f64 = 64.0;
/// Part of v and h that a short Newton step is at most.
const SHORT: f64 = 1e-6;

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

/// The momentum rows eliminated from the energy row; everything times the determinant of A where that is solved by one
/// quotient, so that the quotients of a step do not wait for each other, else times 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elimination<const N: usize, T> {
    /// `a = A⁻¹ r`.
    pub(super) residual: SVector<T, N>,
    /// `b = A⁻¹ ∂r/∂h`.
    pub(super) residual_dh: SVector<T, N>,
    /// `S = energy_dh − energy_dv·b`.
    pub(super) schur: T,
    /// Sum of the absolute values of the terms of S.
    schur_magnitude: T,
    determinant: T,
    /// 1/determinant.
    reciprocal: T,
}

impl<const N: usize, T: Scalar> Elimination<N, T> {
    /// Not finite where A is singular.
    #[inline]
    pub(super) fn of(equations: &ExtendedSystem<N, T, impl Matrix<N, T>>) -> Self {
        let momentum = &equations.momentum;
        let both = SMatrix::<T, N, 2>::from_columns(&[momentum.residual, equations.residual_dh]);
        Self::from_solved(equations, momentum.jacobian.quotient(&both))
    }

    /// `None` where A is singular.
    #[inline]
    pub(super) fn finite(equations: &ExtendedSystem<N, T, impl Matrix<N, T>>) -> Option<Self> {
        let momentum = &equations.momentum;
        let both = SMatrix::<T, N, 2>::from_columns(&[momentum.residual, equations.residual_dh]);
        let solved = linear::solve(&momentum.jacobian, &both)?;
        Some(Self::from_solved(equations, (solved, T::one())))
    }

    #[inline]
    fn from_solved(
        equations: &ExtendedSystem<N, T, impl Matrix<N, T>>,
        (solved, determinant): (SMatrix<T, N, 2>, T),
    ) -> Self {
        let (residual, residual_dh) = (solved.column(0).into_owned(), solved.column(1).into_owned());
        let mut schur = equations.energy_dh * determinant;
        let mut schur_magnitude = schur.abs();
        for (energy_dv, b) in equations.energy_dv.iter().zip(residual_dh.iter()) {
            let term = *energy_dv * *b;
            schur -= term;
            schur_magnitude += term.abs();
        }
        Self { residual, residual_dh, schur, schur_magnitude, determinant, reciprocal: determinant.recip() }
    }

    /// The trial that follows, `(δv, δh)` taken.
    #[inline]
    pub(super) fn step(&self, equations: &ExtendedSystem<N, T, impl Matrix<N, T>>, trial: &Trial<N, T>) -> Step<N, T> {
        let mut known = T::zero();
        for i in 0..N {
            known +=
                (equations.energy_dv[i] * trial.h - equations.momentum.residual[i] * T::real(0.5)) * self.residual[i];
        }
        // The bent row over h, and S, both times h: one quotient, where two would wait for each other.
        let energy = equations.energy_residual * self.determinant - known;
        let dh = -(energy / (self.schur * trial.h));
        Step { v: -(self.residual + self.residual_dh * dh) * self.reciprocal, h: dh }
    }

    /// −4 S, the step density D of the interval.
    #[inline]
    pub(super) fn density_or_infinite(&self) -> T {
        self.schur * self.reciprocal * T::real(-4.0)
    }

    /// Step density D of the interval; `None` where a term of it is not finite.
    #[inline]
    pub(super) fn density(&self) -> Option<T> {
        (self.schur_magnitude * T::real(4.0)).is_finite().then(|| self.density_or_infinite())
    }

    /// Whether S is zero but for its rounding.
    #[inline]
    pub(super) fn is_degenerate(&self) -> bool {
        // Where it is not a number, too.
        let rounding = self.schur_magnitude * T::real(VANISHING * T::EPSILON);
        self.schur.abs().partial_cmp(&rounding) != Some(Ordering::Greater)
    }
}

/// A Newton step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step<const N: usize, T> {
    /// δv.
    pub(super) v: SVector<T, N>,
    /// δh.
    pub(super) h: T,
}

impl<const N: usize, T: Scalar> Step<N, T> {
    /// Whether it changes the trial that it leads to by less than a millionth.
    #[inline(always)]
    pub(super) fn is_short(&self, trial: &Trial<N, T>) -> bool {
        let part = T::real(SHORT);
        let (step, whole) = (length_squared(&self.v), length_squared(&trial.v));
        self.h.abs() <= trial.h.abs() * part && step <= whole * (part * part)
    }
}

/// The root that Newton's iteration reaches from `trial` with h inside `range`; `observe` is told the larger residual of
/// the rows before each iteration, in roundings.
pub(super) fn solve<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
    system: &S,
    node: &Node<N, T>,
    mut trial: Trial<N, T>,
    (shortest, longest): (T, T),
    observe: &mut dyn FnMut(f64),
) -> Result<Root<N, T>, Failure<T>> {
    let mut before = Rows { momentum: f64::INFINITY, energy: f64::INFINITY };
    for iterations in 0..=ITERATIONS {
        let equations = system.extended_system(node, trial.h, &trial.v);
        let elimination = Elimination::finite(&equations).ok_or(Failure::NoRoot)?;
        let rows = Rows::of(system, node, &trial);
        observe(momentum::worse(rows.momentum, rows.energy));
        let density = elimination.density().ok_or(Failure::NoRoot)?;
        if rows.are_at_floor(&before) {
            let (Trial { v, h }, residual) = (trial, momentum::worse(rows.momentum, rows.energy));
            let root = Root { v, h, density, iterations, residual };
            return if elimination.is_degenerate() { Err(Failure::Degenerate { h, density }) } else { Ok(root) };
        }
        let step = elimination.step(&equations, &trial);
        trial = Trial { v: trial.v + step.v, h: trial.h + step.h };
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
    fn of<const N: usize, T: Scalar, S: EnergyStepping<N, T>>(
        system: &S,
        node: &Node<N, T>,
        trial: &Trial<N, T>,
    ) -> Self {
        let (at, rounding) =
            (system.extended_residual(node, trial.h, &trial.v), system.extended_rounding(node, trial.h, &trial.v));
        Self {
            momentum: momentum::worst(&at.residual, &rounding.residual),
            energy: momentum::roundings(at.energy_residual, rounding.energy_residual),
        }
    }

    /// Each row for itself: the rounding of one must not hide that the other still gains.
    #[inline]
    fn are_at_floor(&self, before: &Self) -> bool {
        momentum::is_at_floor(self.momentum, before.momentum) && momentum::is_at_floor(self.energy, before.energy)
    }
}
