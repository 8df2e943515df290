//! Simplified Newton iterations on the equations of the stages, for steps where sweeps do not contract.
//!
//! In: the equations linearized in the middle of a step, and what velocities leave of `L_v(Q_i, V_i) = p0 + h Σ a_ij F_j`. Out: the
//! correction of the velocities. With `C = ∂L_v/∂q, M = ∂L_v/∂v, K = ∂F/∂q, B = ∂F/∂v` it solves
//!
//! ```text
//! δQ_i = h Σ_j a_ij δV_j        M δV_i + C δQ_i − h Σ_j a_ij (K δQ_j + B δV_j) = missing_i
//! ```
//!
//! In the basis of Legendre's polynomials A is tridiagonal: 1/2 at its corner, `±ξ_k` beside the diagonal, `ξ_k = 1/(2 √(4k² − 1))`
//! (Hairer and Wanner, *Solving Ordinary Differential Equations II*, IV.5). So S blocks of 2N × 2N follow from each other,
//!
//! ```text
//! E = [I 0; C M]        G = [0 I; K B]        D_0 = E − (h/2) G        D_k = E + h² ξ_k² G D_{k−1}⁻¹ G
//! ```
//!
//! where D_k⁻¹ exists for whatever oscillates or is damped, however stiff. It allocates once, when a run meets its first stiff step.

use super::points::{Points, Rare};
use super::stages::Stages;
use super::sweep::{Equations, Increment};
use super::tableau::Tableau;
use crate::derivatives::{Jacobians, Varied};
use crate::linear::Pivoted;
use nalgebra::{DMatrix, DVector, SVector};

/// The linearized equations of a step, factored.
#[derive(Clone, Debug)]
pub(super) struct Newton<const N: usize, const S: usize> {
    h: f64,
    /// E, and G.
    left: DMatrix<f64>,
    right: DMatrix<f64>,
    /// The factors of D_k.
    factors: Vec<Pivoted>,
    /// Values of the normalized Legendre polynomials k at the nodes i: `basis[k][i]`.
    basis: [[f64; S]; S],
    /// One vector of 2N a polynomial, and room for two matrices.
    modes: Vec<DVector<f64>>,
    room: DMatrix<f64>,
    block: DMatrix<f64>,
}

impl<const N: usize, const S: usize> Newton<N, S> {
    /// Room for the equations of steps of length h.
    pub(super) fn new(h: f64) -> Self {
        let square = DMatrix::zeros(2 * N, 2 * N);
        Self {
            h,
            left: square.clone(),
            right: square.clone(),
            factors: vec![Pivoted::new(2 * N); S],
            basis: basis(),
            modes: vec![DVector::zeros(2 * N); S],
            room: square.clone(),
            block: square,
        }
    }

    /// Takes another length of a step; what is factored is that of the last one until the next linearization.
    pub(super) fn set_step(&mut self, h: f64) {
        self.h = h;
    }

    /// Linearizes the equations of a system at the point (t, q, v).
    pub(super) fn linearize(&mut self, system: &Rare<'_, N>, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) {
        let Jacobians { by_q: [c, k], by_v: [m, b] } = jacobians(system, t, q, v);
        self.left.view_mut((N, 0), (N, N)).copy_from(&c);
        self.left.view_mut((N, N), (N, N)).copy_from(&m);
        self.right.view_mut((N, 0), (N, N)).copy_from(&k);
        self.right.view_mut((N, N), (N, N)).copy_from(&b);
        self.left.view_mut((0, 0), (N, N)).fill_with_identity();
        self.right.view_mut((0, N), (N, N)).fill_with_identity();
        for k in 0..S {
            self.room.copy_from(&self.right);
            match k.checked_sub(1) {
                None => {
                    self.room *= -0.5 * self.h;
                    self.room += &self.left;
                }
                Some(before) => {
                    let scale = (self.h * xi(k)).powi(2);
                    for mut column in self.room.column_iter_mut() {
                        self.factors[before].solve(column.as_mut_slice());
                    }
                    self.block.copy_from(&self.left);
                    self.block.gemm(scale, &self.right, &self.room, 1.0);
                    self.room.copy_from(&self.block);
                }
            }
            self.factors[k].factor(&self.room);
        }
    }

    /// The corrections of the velocities that make up for what is missing in the momenta.
    pub(super) fn correction(&mut self, missing: &Stages<N, S>) -> Stages<N, S> {
        let b = const { &Tableau::<S>::VALUES.b };
        for k in 0..S {
            self.modes[k].fill(0.0);
            for row in 0..N {
                for i in 0..S {
                    self.modes[k][row + N] += b[i] * self.basis[k][i] * missing[row][i];
                }
            }
        }
        self.solve();
        let mut correction = [[0.0; S]; N];
        for k in 0..S {
            for row in 0..N {
                for i in 0..S {
                    correction[row][i] += self.basis[k][i] * self.modes[k][row + N];
                }
            }
        }
        correction
    }

    /// The block tridiagonal system, in place: forwards, then backwards.
    fn solve(&mut self) {
        for k in 0..S {
            let (solved, rest) = self.modes.split_at_mut(k);
            if let Some(before) = solved.last() {
                rest[0].gemv(self.h * xi(k), &self.right, before, 1.0);
            }
            self.factors[k].solve(rest[0].as_mut_slice());
        }
        for k in (1..S).rev() {
            // The row above waits for `h ξ_k D⁻¹ G` times this one.
            let (above, below) = self.modes.split_at_mut(k);
            let mut column = self.room.column_mut(0);
            column.gemv(self.h * xi(k), &self.right, &below[0], 0.0);
            self.factors[k - 1].solve(column.as_mut_slice());
            above[k - 1] -= &column;
        }
    }

    /// An estimate of the largest h ω: how much `h E⁻¹ G` stretches a vector.
    pub(super) fn stiffness(&self) -> f64 {
        let mut left = Pivoted::new(2 * N);
        left.factor(&self.left);
        let mut vector = DVector::from_element(2 * N, 1.0);
        let mut length = 0.0;
        for _ in 0..POWERS {
            let norm = vector.norm();
            vector /= norm;
            vector = &self.right * &vector;
            left.solve(vector.as_mut_slice());
            length += vector.norm().ln();
        }
        let stiffness = self.h.abs() * (length / f64::from(POWERS)).exp();
        if stiffness.is_nan() { f64::INFINITY } else { stiffness }
    }
}

/// How `L_v` and `L_q + f` change at the point (t, q, v).
pub(super) fn jacobians<const N: usize>(
    system: &Rare<'_, N>,
    t: f64,
    q: &SVector<f64, N>,
    v: &SVector<f64, N>,
) -> Jacobians<N> {
    let sides = |q: &SVector<Varied, N>, v: &SVector<Varied, N>| {
        let point = system.at(Varied::fixed(t), q, v);
        [point.momentum, point.force]
    };
    Jacobians::of(sides, q, v)
}

/// Multiplications that estimate the stiffness.
const POWERS: u32 = 16;

/// `ξ_k = 1/(2 √(4k² − 1))`.
#[allow(clippy::cast_precision_loss)]
fn xi(k: usize) -> f64 {
    0.5 / ((4 * k * k) as f64 - 1.0).sqrt()
}

/// The polynomials `√(2k + 1) P_k(2 c − 1)` at the nodes: orthonormal under the weights.
#[allow(clippy::cast_precision_loss)]
fn basis<const S: usize>() -> [[f64; S]; S] {
    let mut basis = const { Tableau::<S>::VALUES.legendre };
    for (k, row) in basis.iter_mut().enumerate() {
        let norm = ((2 * k + 1) as f64).sqrt();
        for value in row {
            *value *= norm;
        }
    }
    basis
}

/// Equations of the stages whose velocities can be corrected.
pub(super) trait Correctable<const N: usize, const S: usize>: Equations<N, S> {
    /// Evaluates the equations at the positions x, and returns what is missing in the momenta.
    fn missing(&mut self, x: &Stages<N, S>) -> Stages<N, S>;
    /// Adds corrections to the velocities, and returns the positions that follow.
    fn follow(&mut self, correction: &Stages<N, S>) -> Stages<N, S>;
    /// What is extrapolated to the next step, where the velocities were corrected.
    fn corrected(&self) -> Stages<N, S> {
        self.guess()
    }
}

/// The equations of the stages, corrected by simplified Newton iterations.
pub(super) struct Stiff<'a, E, const N: usize, const S: usize> {
    pub(super) equations: E,
    newton: &'a mut Newton<N, S>,
}

impl<'a, E, const N: usize, const S: usize> Stiff<'a, E, N, S> {
    /// Equations with their linearization.
    pub(super) fn new(equations: E, newton: &'a mut Newton<N, S>) -> Self {
        Self { equations, newton }
    }
}

impl<E: Correctable<N, S>, const N: usize, const S: usize> Equations<N, S> for Stiff<'_, E, N, S> {
    // There is no other way left.
    const PATIENCE: u32 = u32::MAX;

    fn start(&self) -> Stages<N, S> {
        self.equations.start()
    }

    fn sweep(&mut self, x: &Stages<N, S>) -> Stages<N, S> {
        let missing = self.equations.missing(x);
        let correction = self.newton.correction(&missing);
        self.equations.follow(&correction)
    }

    fn increment(&self) -> Increment<N> {
        self.equations.increment()
    }

    fn guess(&self) -> Stages<N, S> {
        self.equations.corrected()
    }

    fn velocities(&self) -> Option<Stages<N, S>> {
        self.equations.velocities()
    }

    fn change_of_velocities(&self) -> f64 {
        self.equations.change_of_velocities()
    }
}
