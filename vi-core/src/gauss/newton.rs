//! Simplified Newton iteration of the stage equations, for steps whose fixed-point iteration does not contract.
//!
//! The equations are linearized at the middle of a step. From the residuals of `L_v(Q_i, V_i) = p0 + h Σ a_ij F_j`
//! follow corrections of the velocities. With `C = ∂L_v/∂q, M = ∂L_v/∂v, K = ∂F/∂q, B = ∂F/∂v` they solve
//!
//! ```text
//! δQ_i = h Σ_j a_ij δV_j        M δV_i + C δQ_i − h Σ_j a_ij (K δQ_j + B δV_j) = missing_i
//! ```
//!
//! At each eigenvalue λ of A (`modes`) these are N equations, with a matrix that is inverted once per linearization,
//!
//! ```text
//! (M + h λ (C − B) − h² λ² K) δV = missing
//! ```
//!
//! All eigenvalues are processed side by side. The inverse exists for every oscillating or damped system, however
//! stiff: then K and B have no positive eigenvalues, and λ has a positive real part. The first stiff step of a run
//! allocates the buffer.

use super::modes::{Modal, Spectrum};
use super::points::{AnyDerivatives, ErasedSystem};
use super::stages::{LOOPED, Stages, product};
use crate::linear::Pivoted;
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use vi_dispatch::{Instructions, Loop, by_baseline};

/// The linearization point of a step of length h.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Linearization<const N: usize> {
    pub(crate) h: f64,
    pub(crate) t: f64,
    pub(crate) q: SVector<f64, N>,
    pub(crate) v: SVector<f64, N>,
    /// Iterations of the first step with this linearization; `None` before.
    pub(crate) iterations: Option<u32>,
}

impl<const N: usize> Linearization<N> {
    /// The linearization for the next step, after one of this many iterations; `None` if a new one pays off.
    pub(crate) fn after(self, iterations: u32) -> Option<Self> {
        let first = self.iterations.unwrap_or(iterations);
        (2 * iterations <= 3 * first).then_some(Self { iterations: Some(first), ..self })
    }

    /// Whether the equations are linearized at the same point, for the same length.
    fn is_at(&self, other: &Self) -> bool {
        self.h.to_bits() == other.h.to_bits()
            && self.t.to_bits() == other.t.to_bits()
            && self.q == other.q
            && self.v == other.v
    }

    /// Whether all numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        [self.h, self.t].iter().chain(&self.q).chain(&self.v).all(|number| number.is_finite())
    }
}

/// The linearized equations of a step, factored.
#[derive(Clone, Debug)]
pub struct Newton<const N: usize, const S: usize> {
    linearization: Option<Linearization<N>>,
    instructions: Instructions,
    spectrum: Spectrum<S>,
    derivatives: AnyDerivatives<N>,
    /// The inverse of the matrix, by rows.
    inverse: Vec<[Modal<S>; N]>,
}

impl<const N: usize, const S: usize> Newton<N, S> {
    /// Allocates the buffers.
    pub(crate) fn new() -> Self {
        let zeros = SMatrix::zeros();
        let derivatives = AnyDerivatives { momentum_dq: zeros, mass: zeros, force_dq: zeros, force_dv: zeros };
        let inverse = vec![[Modal::ZERO; N]; N];
        let instructions = Instructions::detected();
        Self { linearization: None, instructions, spectrum: Spectrum::new(), derivatives, inverse }
    }

    /// Linearizes the equations of a system, unless they already are at this point.
    pub(crate) fn linearize(&mut self, system: &ErasedSystem<'_, N>, at: Linearization<N>) {
        if self.linearization.is_some_and(|last| last.is_at(&at)) {
            return;
        }
        let Linearization { h, t, q, v, .. } = &at;
        self.derivatives = system.derivatives(*t, q, v);
        let AnyDerivatives { momentum_dq: c, mass: m, force_dq: k, force_dv: b } = &self.derivatives;
        let step = self.spectrum.eigenvalues * *h;
        let square = step * step;
        for row in 0..N {
            for column in 0..N {
                let at = (row, column);
                self.inverse[row][column] = Modal::real(m[at]) + step * (c[at] - b[at]) + square * -k[at];
            }
        }
        by_width::<N, _>(self.instructions, Invert { matrix: &mut self.inverse });
        self.linearization = Some(at);
    }

    /// The corrections of the velocities for the residuals of the momenta.
    pub(crate) fn correction(&self, missing: &Stages<N, S>) -> Stages<N, S> {
        by_width::<N, _>(self.instructions, Correct { newton: self, missing })
    }

    /// An estimate of the largest h ω: the growth of a vector by `h E⁻¹ G`, with `E = [I 0; C M]` and `G = [0 I; K B]`.
    pub(crate) fn stiffness(&self) -> f64 {
        let h = self.linearization.map_or(f64::NAN, |at| at.h);
        let AnyDerivatives { momentum_dq: c, mass: m, force_dq: k, force_dv: b } = &self.derivatives;
        let mut left = DMatrix::identity(2 * N, 2 * N);
        left.view_mut((N, 0), (N, N)).copy_from(c);
        left.view_mut((N, N), (N, N)).copy_from(m);
        let mut right = DMatrix::zeros(2 * N, 2 * N);
        right.view_mut((0, N), (N, N)).fill_with_identity();
        right.view_mut((N, 0), (N, N)).copy_from(k);
        right.view_mut((N, N), (N, N)).copy_from(b);
        let mut factors = Pivoted::new(2 * N);
        factors.factor(&left);
        let mut vector = DVector::from_element(2 * N, 1.0);
        let mut length = 0.0;
        for _ in 0..POWERS {
            let norm = vector.norm();
            vector /= norm;
            vector = &right * &vector;
            factors.solve(vector.as_mut_slice());
            length += vector.norm().ln();
        }
        let stiffness = h.abs() * (length / f64::from(POWERS)).exp();
        if stiffness.is_nan() { f64::INFINITY } else { stiffness }
    }
}

/// Runs a loop over the rows of N coordinates, with SIMD dispatch if there are many.
fn by_width<const N: usize, L: Loop>(instructions: Instructions, of: L) -> L::Output {
    if const { N > LOOPED } { instructions.run(of) } else { by_baseline(of) }
}

/// Inverts a matrix in place, by Gauss–Jordan elimination with partial pivoting; not finite if it is singular.
struct Invert<'a, const N: usize, const S: usize> {
    matrix: &'a mut [[Modal<S>; N]],
}

impl<const N: usize, const S: usize> Loop for Invert<'_, N, S> {
    type Output = ();

    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { matrix } = self;
        let mut exchanged = [0; N];
        for k in 0..N {
            let mut pivot = k;
            for row in k + 1..N {
                if matrix[row][k].is_larger(&matrix[pivot][k]) {
                    pivot = row;
                }
            }
            exchanged[k] = pivot;
            matrix.swap(k, pivot);
            let scale = matrix[k][k].recip();
            matrix[k][k] = Modal::ONE;
            let mut pivotal = [Modal::ZERO; N];
            for column in 0..N {
                pivotal[column].add_product::<FUSED>(&matrix[k][column], &scale);
            }
            matrix[k] = pivotal;
            for row in (0..N).filter(|row| *row != k) {
                let factor = matrix[row][k] * -1.0;
                matrix[row][k] = Modal::ZERO;
                for column in 0..N {
                    matrix[row][column].add_product::<FUSED>(&factor, &pivotal[column]);
                }
            }
        }
        for k in (0..N).rev() {
            for row in &mut *matrix {
                row.swap(k, exchanged[k]);
            }
        }
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
        let Newton { spectrum, inverse, .. } = self.newton;
        let mut modes = [Modal::ZERO; N];
        let mut exchanged = modes;
        for k in 0..N {
            modes[k] = Modal(product::<S, FUSED>(&spectrum.to, &self.missing[k], &[0.0; S]));
            exchanged[k] = modes[k].exchanged();
        }
        let mut correction = [[0.0; S]; N];
        for k in 0..N {
            let solution = Modal::dot::<N, FUSED>(&inverse[k], &modes, &exchanged);
            correction[k] = product::<S, FUSED>(&spectrum.from, &solution.0, &[0.0; S]);
        }
        correction
    }
}

/// Power iterations of the stiffness estimate.
const POWERS: u32 = 16;
