//! The stage equations of a system whose L is linear in the velocities.
//!
//! `L = ϑ(t, x, y)·x' − H(t, x, y)` contains the velocities of one half of the coordinates, x. With the momenta `p = ϑ` of x
//! the stages are those of Gauss collocation in the canonical variables (x, p),
//!
//! ```text
//! X_i = x0 + h Σ_j a_ij V_j        ϑ(X_i, Y_i) = p0 + h Σ_j a_ij F_j        F = L_x + f        0 = L_y + f = ϑ_yᵀ V − H_y + f
//! x1  = x0 + h Σ_j b_j V_j         ϑ(x1, y1)   = p0 + h Σ_j b_j F_j
//! ```
//!
//! so that a step is symplectic in (x, p), and y0 is only a guess. The stage velocities of y are the slopes of the
//! polynomial through y0 and the Y_i. y1 follows from x1 and p1, not from this polynomial.
//!
//! One iteration evaluates the equations at (X, Y), corrects V by `L_y + f = 0`, moves X by the new V, and corrects Y by
//! `ϑ_y⁻¹ (P − ϑ)` with the momenta P from F. Its matrices are evaluated in the middle of the guess, or at each stage
//! if that contracts slowly. If neither contracts, Newton iteration corrects all velocities, as in [`General`].

use super::fixed_point::{Convergence, Equations, StageIncrement};
use super::general::General;
use super::newton::Newton;
use super::points::{ErasedSystem, Points};
use super::stages::{Roundings, Stages, change, growth, roundings, set, stage, time};
use super::tableau::Tableau;
use crate::first_order::halves;
use crate::linear::{self, Matrix};
use crate::node::Node;
use nalgebra::{SMatrix, SVector};

/// Most iterations for y1.
const ITERATIONS: u32 = 60;
/// The last correction of y1, relative to the coordinates and to the terms of y: a few roundings.
const CONVERGED: f64 = 64.0 * f64::EPSILON;

/// Contraction up to which the matrices in the middle of the guess serve all stages.
const FAST: f64 = 1.0 / 8.0;

/// The matrices of an iteration, at a point.
struct Matrices<const N: usize> {
    /// The inverse of ϑ_y and of `−∂(L_y + f)/∂x'`; NaN if it is singular.
    halves: SMatrix<f64, N, N>,
    momentum_dq: SMatrix<f64, N, N>,
    force_dv: SMatrix<f64, N, N>,
}

impl<const N: usize> Matrices<N> {
    fn at(system: &ErasedSystem<'_, N>, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Self {
        let of = system.derivatives(t, q, v);
        let halves = halves(&of, system.without_velocity());
        let inverse = linear::solve(&halves, &SMatrix::<f64, N, N>::identity());
        let halves = inverse.unwrap_or_else(|| SMatrix::repeat(f64::NAN));
        Self { halves, momentum_dq: of.momentum_dq, force_dv: of.force_dv }
    }
}

/// The equations of a step; see the [module](self).
pub(crate) struct FirstOrder<'a, const N: usize, const S: usize> {
    general: General<'a, f64, ErasedSystem<'a, N>, SMatrix<f64, N, N>, N, S, false>,
    without_velocity: &'static [bool],
    /// The inverse of the matrix a_ij.
    inverse: SMatrix<f64, S, S>,
    /// The matrices in the middle of the guess.
    kept: Matrices<N>,
    /// The largest `Σ_l |ϑ_y⁻¹_kl P_l|` of the stages, for each y. If y is smaller, these terms cancel and determine its
    /// rounding error.
    terms: SVector<f64, N>,
    roundings: Roundings<N>,
}

impl<'a, const N: usize, const S: usize> FirstOrder<'a, N, S> {
    /// The equations of the step of length h from `node`, with a guess of the stage velocities.
    pub(crate) fn new(
        system: &'a ErasedSystem<'a, N>,
        (node, h): (&'a Node<N>, f64),
        guess: Stages<N, S>,
        newton: Option<&'a Newton<N, S>>,
    ) -> Self {
        let Tableau { first, b, .. } = const { &Tableau::<S>::VALUES };
        let inverse = SMatrix::<f64, S, S>::from_fn(|i, j| first[j][i] * b[j]).inverse_unchecked();
        let general = General::new(system, None, (node, h), guess, newton, None);
        let middle = S / 2;
        let t = time::<N, S, false, f64>(node, h, middle);
        let kept = Matrices::at(system, t, &stage(&general.positions(), middle), &stage(&guess, middle));
        Self {
            general,
            without_velocity: system.without_velocity(),
            inverse,
            kept,
            terms: SVector::zeros(),
            roundings: [0.0; N],
        }
    }

    /// The row of slopes of a polynomial through zero at the node and these values at the stages.
    fn slopes(&self, values: &[f64; S]) -> [f64; S] {
        let slopes = self.inverse * SVector::<f64, S>::from(*values) / self.general.h;
        slopes.into()
    }

    /// The entries of one half of the coordinates; the others are zero.
    fn half(&self, of: impl Fn(usize) -> f64, without_velocity: bool) -> SVector<f64, N> {
        SVector::from_fn(|k, _| if self.without_velocity.get(k) == Some(&without_velocity) { of(k) } else { 0.0 })
    }

    /// One iteration by `L_y + f = 0` and `ϑ = P`.
    fn iterate_by_halves(&mut self, x: &Stages<N, S>, before: &Convergence) {
        let velocity = self.general.velocity;
        let time = |i| time::<N, S, false, f64>(self.general.node, self.general.h, i);
        let at_stage = |i| Matrices::at(self.general.system, time(i), &stage(x, i), &stage(&velocity, i));
        let own: Option<[_; S]> = (before.contraction > FAST).then(|| core::array::from_fn(at_stage));
        let of = |i: usize| own.as_ref().map_or(&self.kept, |own| &own[i]);
        let mut momentum = [[0.0; S]; N];
        for i in 0..S {
            let v = stage(&velocity, i);
            let sides = self.general.system.sides_at(time(i), &stage(x, i), &v);
            let change = of(i).halves * self.half(|k| sides.force[k], true);
            set(&mut self.general.velocity, i, &(v + change));
            set(&mut self.general.force, i, &(sides.force + of(i).force_dv * change));
            set(&mut momentum, i, &sides.momentum);
        }
        let moved = self.general.positions();
        let missing = self.general.missing(&momentum);
        let (mut changes, mut terms) = ([[0.0; S]; N], self.terms);
        for i in 0..S {
            let by_move = of(i).momentum_dq * self.half(|k| moved[k][i] - x[k][i], false);
            set(&mut changes, i, &(of(i).halves * self.half(|k| missing[k][i] - by_move[k], false)));
            // The residual of the momentum is the difference of these terms.
            terms = terms.sup(&(of(i).halves.abs() * self.half(|k| momentum[k][i].abs(), false)));
        }
        self.terms = self.half(|k| terms[k], true);
        // Only rows of y have changes.
        for k in 0..N {
            let slopes = self.slopes(&changes[k]);
            for i in 0..S {
                self.general.velocity[k][i] += slopes[i];
            }
        }
    }

    /// `y1 − y0` by the momenta at the end of the step; NaN if the iteration does not converge.
    fn end(&self, end: &Node<N>, guess: SVector<f64, N>) -> SVector<f64, N> {
        let mut moved = guess;
        let mut last = f64::INFINITY;
        let v = stage(&self.general.velocity, S - 1);
        for _ in 0..ITERATIONS {
            let sides = self.general.system.sides_at(end.t, &(end.q + (end.q_low + moved)), &v);
            let change = self.kept.halves * self.half(|k| (end.p[k] - sides.momentum[k]) + end.p_low[k], false);
            let size = change.amax();
            if size >= last || size.is_nan() {
                break;
            }
            moved += change;
            last = size;
        }
        let is_found = last <= CONVERGED * (end.q + moved).amax().max(self.terms.amax());
        if is_found { moved } else { SVector::repeat(f64::NAN) }
    }
}

impl<const N: usize, const S: usize> Equations<N, S> for FirstOrder<'_, N, S> {
    fn has_another_way(&self) -> bool {
        self.general.has_another_way()
    }

    fn start(&self) -> Stages<N, S> {
        self.general.positions()
    }

    fn iterate(&mut self, x: &Stages<N, S>, y: &mut Stages<N, S>, before: &Convergence) {
        if self.general.newton.is_some() {
            self.general.iterate(x, y, before);
        } else {
            self.general.evaluated = self.general.velocity;
            self.iterate_by_halves(x, before);
            *y = self.general.positions();
        }
    }

    fn increment(&self) -> StageIncrement<N> {
        let StageIncrement { velocity, momentum } = self.general.increment();
        let momentum = self.half(|k| momentum[k], false);
        let mut end = *self.general.node;
        end.advance(self.general.h, &self.half(|k| velocity[k], false), &momentum);
        let moved = self.end(&end, self.half(|k| self.general.h * velocity[k], true));
        StageIncrement {
            velocity: self.half(|k| velocity[k], false) + self.half(|k| moved[k] / self.general.h, true),
            momentum,
        }
    }

    fn guess(&self) -> Stages<N, S> {
        self.general.guess()
    }

    fn velocities(&self) -> Option<Stages<N, S>> {
        self.general.velocities()
    }

    fn take_roundings(&mut self, x: &Stages<N, S>) -> f64 {
        let n = self.without_velocity.len();
        let before =
            core::mem::replace(&mut self.roundings, roundings(n, x, &self.general.node.q.abs().sup(&self.terms)));
        growth(n, &before, &self.roundings)
    }

    fn change(&self, x: &mut Stages<N, S>, y: &Stages<N, S>) -> f64 {
        change(self.without_velocity.len(), x, y, &self.roundings)
    }

    /// After an iteration by halves, velocities and momenta follow from its positions and share their error.
    fn passed_on(&self, contraction: f64) -> f64 {
        if self.general.newton.is_some() { 1.0 } else { contraction }
    }
}
