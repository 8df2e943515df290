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
//! so that a step is symplectic in (x, p), and y0 is nothing but a guess. The stage velocities of y are the slopes of the
//! polynomial through y0 and the Y_i; y1 is not its end, but follows from x1 and p1.
//!
//! One iteration evaluates the equations at (X, Y), corrects V by `L_y + f = 0`, moves X by the new V, and corrects Y by
//! `ϑ_y⁻¹ (P − ϑ)` with the momenta P from F. If that does not contract, Newton iteration corrects all velocities, as in
//! [`General`].

use super::fixed_point::{Convergence, Equations, StageIncrement};
use super::general::General;
use super::newton::Newton;
use super::points::{AnyDerivatives, ErasedSystem, Points};
use super::stages::{Roundings, Stages, change, growth, roundings, set, stage, time};
use super::tableau::Tableau;
use crate::first_order::halves;
use crate::linear::{self, Matrix};
use crate::node::Node;
use nalgebra::{SMatrix, SVector};

/// Most iterations for y1.
const ITERATIONS: u32 = 12;
/// The last correction of y1, relative to the coordinates, after which Newton iteration is at rounding.
const SETTLED: f64 = 1e-7;

/// The equations of a step; see the [module](self).
pub(crate) struct FirstOrder<'a, const N: usize, const S: usize> {
    system: &'a ErasedSystem<'a, N>,
    node: &'a Node<N>,
    h: f64,
    general: General<'a, f64, ErasedSystem<'a, N>, SMatrix<f64, N, N>, N, S, false>,
    without_velocity: &'static [bool],
    is_by_newton: bool,
    /// The inverse of the matrix a_ij.
    inverse: SMatrix<f64, S, S>,
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
        Self {
            system,
            node,
            h,
            general: General::new(system, None, (node, h), guess, newton, None),
            without_velocity: system.without_velocity(),
            is_by_newton: newton.is_some(),
            inverse,
            terms: SVector::zeros(),
            roundings: [0.0; N],
        }
    }

    /// The row of slopes of a polynomial through zero at the node and these values at the stages.
    fn slopes(&self, values: &[f64; S]) -> [f64; S] {
        let slopes = self.inverse * SVector::<f64, S>::from(*values) / self.h;
        slopes.into()
    }

    /// The inverse of ϑ_y, and of the matrix of `L_y + f = 0`, at the derivatives of a point; NaN if it is singular.
    fn halves_inverse(&self, of: &AnyDerivatives<N>) -> SMatrix<f64, N, N> {
        let inverse = linear::solve(&halves(of, self.without_velocity), &SMatrix::<f64, N, N>::identity());
        inverse.unwrap_or_else(|| SMatrix::repeat(f64::NAN))
    }

    /// The entries of one half of the coordinates; the others are zero.
    fn half(&self, of: impl Fn(usize) -> f64, without_velocity: bool) -> SVector<f64, N> {
        SVector::from_fn(|k, _| if self.without_velocity.get(k) == Some(&without_velocity) { of(k) } else { 0.0 })
    }

    /// One iteration by `L_y + f = 0` and `ϑ = P`.
    fn iterate_by_halves(&mut self, x: &Stages<N, S>) {
        let mut momentum = [[0.0; S]; N];
        let derivatives: [_; S] = core::array::from_fn(|i| self.evaluate(i, x, &mut momentum));
        let moved = self.general.positions();
        let missing = self.general.missing(&momentum);
        let mut changes = [[0.0; S]; N];
        for (i, (of, inverse)) in derivatives.iter().enumerate() {
            let by_move = of.momentum_dq * self.half(|k| moved[k][i] - x[k][i], false);
            let change = *inverse * self.half(|k| missing[k][i] - by_move[k], false);
            set(&mut changes, i, &change);
            // The momentum that is missing is the difference of these terms.
            let terms = inverse.abs() * self.half(|k| momentum[k][i].abs(), false);
            self.terms = self.terms.sup(&self.half(|k| terms[k], true));
        }
        // Only rows of y have changes.
        for k in 0..N {
            let slopes = self.slopes(&changes[k]);
            for i in 0..S {
                self.general.velocity[k][i] += slopes[i];
            }
        }
    }

    /// Evaluates stage i at the positions x: corrects its velocity of x, and sets its force and its momentum.
    fn evaluate(
        &mut self,
        i: usize,
        x: &Stages<N, S>,
        momentum: &mut Stages<N, S>,
    ) -> (AnyDerivatives<N>, SMatrix<f64, N, N>) {
        let (t, q, v) = (time::<N, S, false, f64>(self.node, self.h, i), stage(x, i), stage(&self.general.velocity, i));
        let sides = self.system.sides_at(t, &q, &v);
        let of = self.system.derivatives(t, &q, &v);
        let inverse = self.halves_inverse(&of);
        let change = inverse * self.half(|k| sides.force[k], true);
        set(&mut self.general.velocity, i, &(v + change));
        let force = sides.force + of.force_dv * change;
        let force = self.half(|k| force[k], false);
        set(&mut self.general.force, i, &force);
        set(momentum, i, &self.half(|k| sides.momentum[k], false));
        (of, inverse)
    }

    /// `y1 − y0` by the momenta at the end of the step; NaN if ϑ_y is singular there.
    fn end(&self, end: &Node<N>, guess: SVector<f64, N>) -> SVector<f64, N> {
        let mut moved = guess;
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let q = end.q + (end.q_low + moved);
            let v = stage(&self.general.velocity, S - 1);
            let sides = self.system.sides_at(end.t, &q, &v);
            let missing = self.half(|k| (end.p[k] - sides.momentum[k]) + end.p_low[k], false);
            let change = self.halves_inverse(&self.system.derivatives(end.t, &q, &v)) * missing;
            let size = change.amax();
            // NaN ends the search, too.
            if !(size < last) {
                break;
            }
            moved += change;
            last = size;
        }
        let is_found = last <= SETTLED * (end.q + moved).amax();
        if is_found { moved } else { SVector::repeat(f64::NAN) }
    }
}

impl<const N: usize, const S: usize> Equations<N, S> for FirstOrder<'_, N, S> {
    fn has_another_way(&self) -> bool {
        !self.is_by_newton
    }

    fn start(&self) -> Stages<N, S> {
        self.general.positions()
    }

    fn iterate(&mut self, x: &Stages<N, S>, y: &mut Stages<N, S>, before: &Convergence) {
        if self.is_by_newton {
            self.general.iterate(x, y, before);
        } else {
            self.general.evaluated = self.general.velocity;
            self.iterate_by_halves(x);
            *y = self.general.positions();
        }
    }

    fn increment(&self) -> StageIncrement<N> {
        let StageIncrement { velocity, momentum } = self.general.increment();
        let momentum = self.half(|k| momentum[k], false);
        let mut end = *self.node;
        end.advance(self.h, &self.half(|k| velocity[k], false), &momentum);
        let moved = self.end(&end, self.half(|k| self.h * velocity[k], true));
        StageIncrement {
            velocity: self.half(|k| velocity[k], false) + self.half(|k| moved[k] / self.h, true),
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
        let before = core::mem::replace(&mut self.roundings, roundings(n, x, &self.node.q.abs().sup(&self.terms)));
        growth(n, &before, &self.roundings)
    }

    fn change(&self, x: &mut Stages<N, S>, y: &Stages<N, S>) -> f64 {
        change(self.without_velocity.len(), x, y, &self.roundings)
    }

    /// After an iteration by halves, velocities and momenta follow from its positions and share their error.
    fn passed_on(&self, contraction: f64) -> f64 {
        if self.is_by_newton { 1.0 } else { contraction }
    }
}
