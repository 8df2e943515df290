//! Simplified Newton iteration of the stage equations, for steps whose fixed-point iteration does not contract.
//!
//! The equations are linearized at the middle of a step. Residuals of `L_v(Q_i, V_i) = p0 + h Σ a_ij F_j` give
//! corrections of the velocities. With `C = ∂L_v/∂q, M = ∂L_v/∂v, K = ∂F/∂q, B = ∂F/∂v` they solve
//!
//! ```text
//! δQ_i = h Σ_j a_ij δV_j        M δV_i + C δQ_i − h Σ_j a_ij (K δQ_j + B δV_j) = missing_i
//! ```
//!
//! At each eigenvalue λ of A (`modes`) these are N equations, with a matrix that is factored once per linearization,
//!
//! ```text
//! (M + h λ (C − B) − h² λ² K) δV = missing
//! ```
//!
//! The same matrix corrects the positions of a separable system. All eigenvalues are processed side by side. The inverse
//! exists for every oscillating or damped system of any stiffness, because K and B then have no positive eigenvalues,
//! and λ has a positive real part. The first stiff step of a run allocates the buffer.

use super::factors::{Factors, by_width};
use super::linearization::LinearizationPoint;
use super::modes::{Modal, Spectrum};
use super::points::{AnyDerivatives, ErasedSystem};
use super::stages::{Stages, product};
use crate::real::Lane;
use alloc::boxed::Box;
use nalgebra::SMatrix;
use vi_dispatch::Loop;

/// The equations of the last stiff step of a run, with memory from the first one on.
#[derive(Clone, Debug)]
pub struct Buffer<const N: usize, const S: usize>(Option<Box<Newton<N, S>>>);

impl<const N: usize, const S: usize> Default for Buffer<N, S> {
    fn default() -> Self {
        Self(None)
    }
}

impl<const N: usize, const S: usize> Buffer<N, S> {
    /// The equations; allocates them at the first call.
    #[allow(clippy::unnecessary_wraps)] // without the feature `alloc` there are none
    pub(crate) fn newton(&mut self) -> Option<&mut Newton<N, S>> {
        Some(self.0.get_or_insert_with(|| Box::new(Newton::new())))
    }
}

/// The linearized equations of a step, factored.
#[derive(Clone, Debug)]
pub struct Newton<const N: usize, const S: usize> {
    linearization: Option<LinearizationPoint<N>>,
    spectrum: Spectrum<S>,
    derivatives: AnyDerivatives<N>,
    /// Diagonals of its matrices that are not zero, on each side of the main diagonal.
    width: usize,
    factors: Factors<N, S>,
}

impl<const N: usize, const S: usize> Newton<N, S> {
    /// Allocates the buffers.
    fn new() -> Self {
        let zeros = SMatrix::zeros();
        let derivatives = AnyDerivatives { momentum_dq: zeros, mass: zeros, force_dq: zeros, force_dv: zeros };
        Self { linearization: None, spectrum: Spectrum::new(), derivatives, width: 0, factors: Factors::new() }
    }

    /// Linearizes the equations of a system, unless they already are at this point.
    pub(crate) fn linearize(&mut self, system: &ErasedSystem<'_, N>, at: LinearizationPoint<N>) {
        if self.linearization.is_some_and(|last| last.is_at(&at)) {
            return;
        }
        let LinearizationPoint { h, t, q, v, .. } = &at;
        self.derivatives = system.derivatives(*t, q, v);
        let AnyDerivatives { momentum_dq: c, mass: m, force_dq: k, force_dv: b } = &self.derivatives;
        let step = self.spectrum.eigenvalues * *h;
        let square = step * step;
        let is_zero = |at| [c, m, k, b].iter().all(|matrix: &&SMatrix<f64, N, N>| matrix[at] == 0.0);
        let entries = (0..N).flat_map(|row| (0..N).map(move |column| (row, column)));
        let width = entries.filter(|at| !is_zero(*at)).map(|(row, column)| row.abs_diff(column)).max().unwrap_or(0);
        self.width = width;
        self.factors.factor(width, |row, column| {
            let at = (row, column);
            Modal::real(m[at]) + step * (c[at] - b[at]) + square * -k[at]
        });
        self.linearization = Some(at);
    }

    /// The corrections of the velocities for the residuals of the momenta.
    pub(crate) fn correction(&self, missing: &Stages<N, S>) -> Stages<N, S> {
        by_width::<N, _>(self.factors.instructions(), Correct { newton: self, missing })
    }

    /// The solution of the linearized equations for the stage values b.
    #[inline(always)]
    fn solution<const FUSED: bool>(&self, b: &Stages<N, S>) -> Stages<N, S> {
        let Self { spectrum, factors, .. } = self;
        let mut modes = [Modal::ZERO; N];
        for k in 0..N {
            modes[k] = Modal(product::<S, FUSED>(&spectrum.to, &b[k], &[0.0; S]));
        }
        factors.solve::<FUSED>(&mut modes);
        let mut solution = [[0.0; S]; N];
        for k in 0..N {
            solution[k] = product::<S, FUSED>(&spectrum.from, &modes[k].0, &[0.0; S]);
        }
        solution
    }

    /// Corrects the positions y by forces at the positions x, of a separable system.
    pub(crate) fn correct_positions(&self, x: &Stages<N, S>, y: &mut Stages<N, S>) {
        by_width::<N, _>(self.factors.instructions(), CorrectPositions { newton: self, x, y });
    }
}

/// The corrections of the velocities.
struct Correct<'a, const N: usize, const S: usize> {
    newton: &'a Newton<N, S>,
    missing: &'a Stages<N, S>,
}

impl<const N: usize, const S: usize> Loop for Correct<'_, N, S> {
    type Output = Stages<N, S>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Stages<N, S> {
        self.newton.solution::<FUSED>(self.missing)
    }
}

/// The corrections of the positions; see [`Newton::correct_positions`].
struct CorrectPositions<'a, const N: usize, const S: usize> {
    newton: &'a Newton<N, S>,
    x: &'a Stages<N, S>,
    y: &'a mut Stages<N, S>,
}

impl<const N: usize, const S: usize> Loop for CorrectPositions<'_, N, S> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { newton, x, y } = self;
        let Newton { derivatives: AnyDerivatives { mass, .. }, width, .. } = newton;
        let mut missing = [[0.0; S]; N];
        for k in 0..N {
            for l in k.saturating_sub(*width)..N.min(k + width + 1) {
                for i in 0..S {
                    missing[k][i] = Lane::<FUSED>::multiply_add(mass[(k, l)], y[l][i] - x[l][i], missing[k][i]);
                }
            }
        }
        let correction = newton.solution::<FUSED>(&missing);
        for k in 0..N {
            for i in 0..S {
                y[k][i] = x[k][i] + correction[k][i];
            }
        }
    }
}
