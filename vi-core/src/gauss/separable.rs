//! The stage equations of a system with forces of the position alone.
//!
//! For `q'' = M⁻¹ F(t, q)` with constant M, the unknowns are the forces at the stages. With `I_j = h b_j F_j` and the
//! tableau
//!
//! ```text
//! Q_i = q0 + h M⁻¹ (c_i p0 + Σ_j second_ij I_j)           initially with ahead_ij and the forces of the last step
//! q1  = q0 + h M⁻¹ (p0 + Σ_j (1 − c_j) I_j)                p1 = p0 + Σ_j I_j
//! ```
//!
//! This needs half of the products of the general equations, and fixed-point iteration contracts twice as fast. If that does
//! not contract, Newton iteration corrects the positions. Its last corrections are rounding errors of the
//! forces, which enter the next node: they are bounded too.

use super::fixed_point::{Convergence, Equations, StageIncrement};
use super::newton::Newton;
use super::points::Points;
use super::stages::{
    AtStages, EXACT, Roundings, Stages, change, gathered, growth, product, relaxed_positions, roundings, scaled,
    scatter, sum, times, weights,
};
use super::tableau::Tableau;
use crate::linear::{Matrix, row_by_row};
use crate::node::Node;
use crate::real::Lane;
use core::marker::PhantomData;
use nalgebra::SVector;

/// Ulps of q that an ulp of the positions by forces counts as, if Newton iteration corrects them.
const BY_FORCES: f64 = 1.0 / 16.0;

/// The equations of a step; see the [module](self).
pub(crate) struct Separable<
    'a,
    T,
    Y,
    M: Matrix<N, f64>,
    const N: usize,
    const S: usize,
    const FUSED: bool,
    const CORRECTED: bool,
> {
    system: &'a Y,
    node: &'a Node<N>,
    h: f64,
    /// The accuracy of the stages, in ulps.
    pub(super) accuracy: f64,
    /// M, factored.
    inverse: M::Inverse,
    /// `h c_i M⁻¹ p0` at the stages.
    drift: Stages<N, S>,
    force: Stages<N, S>,
    /// Whether the forces are those of the previous step.
    are_last: bool,
    /// The linearized equations, if fixed-point iteration does not contract; unused if not CORRECTED, a constant because
    /// the compiler then keeps the stages in registers.
    newton: Option<&'a Newton<N, S>>,
    /// The change of the last iteration before its correction, in ulps of q that count less.
    uncorrected: f64,
    roundings: Roundings<N>,
    numbers: PhantomData<T>,
}

impl<'a, T, Y, M, const N: usize, const S: usize, const FUSED: bool, const CORRECTED: bool>
    Separable<'a, T, Y, M, N, S, FUSED, CORRECTED>
where
    T: AtStages<S>,
    Y: Points<N, T>,
    M: Matrix<N, f64>,
{
    /// The equations of the step of length h from `node`, with the mass matrix and the stage forces of the last step or
    /// a guess of them.
    #[inline(always)]
    pub(crate) fn new(
        system: &'a Y,
        mass: &M,
        node: &'a Node<N>,
        h: f64,
        (force, are_last): (Stages<N, S>, bool),
        newton: Option<&'a Newton<N, S>>,
    ) -> Self {
        let n = system.moving();
        let c = const { &Tableau::<S>::VALUES.c };
        let inverse = mass.inverse();
        let velocity = M::apply(&inverse, &(node.p + node.p_low));
        let mut drift = [[0.0; S]; N];
        for k in 0..n {
            let moved = h * velocity[k];
            for i in 0..S {
                drift[k][i] = Lane::<FUSED>::multiply_add(c[i], moved, node.q_low[k]);
            }
        }
        let (accuracy, uncorrected, roundings) = (EXACT, 0.0, [0.0; N]);
        Self {
            system,
            node,
            h,
            accuracy,
            inverse,
            drift,
            force,
            are_last,
            newton,
            uncorrected,
            roundings,
            numbers: PhantomData,
        }
    }

    /// Sets x to the positions by the current forces, with the coefficients `second`, or `ahead` for forces of the
    /// previous step.
    #[inline(always)]
    fn set_positions(&self, x: &mut Stages<N, S>, coefficients: &[[f64; S]; S]) {
        let n = self.system.moving();
        let weights = weights(self.h);
        let mut impulses = [[0.0; S]; N];
        for k in 0..n {
            row_by_row();
            impulses[k] = scaled(&weights, &self.force[k]);
        }
        for k in 0..n {
            x[k] = product::<S, FUSED>(coefficients, &impulses[k], &[0.0; S]);
        }
        M::apply_to_rows(&self.inverse, x);
        for k in 0..n {
            x[k] = self.moved(k, &x[k]);
        }
    }

    /// Coordinate k, moved by the velocities that the forces add to its mean from the node to the stages.
    #[inline(always)]
    fn moved(&self, k: usize, velocity: &[f64; S]) -> [f64; S] {
        row_by_row();
        let mut row = [0.0; S];
        for i in 0..S {
            let displacement = Lane::<FUSED>::multiply_add(self.h, velocity[i], self.drift[k][i]);
            row[i] = self.node.q[k] + displacement;
        }
        row
    }
}

impl<T, Y, M, const N: usize, const S: usize, const FUSED: bool, const CORRECTED: bool> Equations<N, S>
    for Separable<'_, T, Y, M, N, S, FUSED, CORRECTED>
where
    T: AtStages<S>,
    Y: Points<N, T>,
    M: Matrix<N, f64>,
{
    #[inline(always)]
    fn has_another_way(&self) -> bool {
        self.newton.is_none()
    }

    #[inline(always)]
    fn accuracy(&self) -> f64 {
        self.accuracy
    }

    #[inline(always)]
    fn start(&self) -> Stages<N, S> {
        let Tableau { second, ahead, .. } = const { &Tableau::<S>::VALUES };
        let mut x = [[0.0; S]; N];
        self.set_positions(&mut x, if self.are_last { ahead } else { second });
        x
    }

    #[inline(always)]
    fn iterate(&mut self, x: &Stages<N, S>, y: &mut Stages<N, S>, _before: &Convergence) {
        let n = self.system.moving();
        let rest = SVector::zeros();
        let times = times::<N, S, FUSED>(self.node, self.h);
        for i in 0..T::EVALUATIONS {
            let force = self.system.force_at(T::of(&times, i), &gathered(n, x, i), &rest);
            scatter(n, &mut self.force, i, &force);
        }
        self.set_positions(y, const { &Tableau::<S>::VALUES.second });
        if CORRECTED && let Some(newton) = self.newton {
            self.uncorrected = change(n, &mut x.clone(), y, &self.roundings) * BY_FORCES;
            newton.correct_positions(x, y);
            // The forces are finite even if the matrix is singular, and NaN is no change. Nor are changes known before the
            // first roundings.
            let is_finite = y.iter().flatten().all(|number| number.is_finite());
            if !is_finite || self.roundings.iter().all(|rounding| *rounding == 0.0) {
                self.uncorrected = f64::INFINITY;
            }
        }
    }

    #[inline(always)]
    fn increment(&self) -> StageIncrement<N> {
        let n = self.system.moving();
        let c = const { &Tableau::<S>::VALUES.c };
        let weights = weights::<S>(self.h);
        let mut momentum = SVector::zeros();
        let mut mean = SVector::zeros();
        for k in 0..n {
            let impulses = scaled(&weights, &self.force[k]);
            let mut ahead = [0.0; S];
            for i in 0..S {
                ahead[i] = (1.0 - c[i]) * impulses[i];
            }
            momentum[k] = sum(&impulses);
            mean[k] = self.node.p[k] + (self.node.p_low[k] + sum(&ahead));
        }
        StageIncrement { velocity: M::apply(&self.inverse, &mean), momentum }
    }

    #[inline(always)]
    fn guess(&self) -> Stages<N, S> {
        self.force
    }

    #[inline(always)]
    fn velocities(&self) -> Option<Stages<N, S>> {
        None
    }

    #[inline(always)]
    fn take_roundings(&mut self, x: &Stages<N, S>) -> f64 {
        let n = self.system.moving();
        let roundings = relaxed_positions(n, roundings(n, x, &self.node.q), x, (self.node, self.accuracy));
        let before = core::mem::replace(&mut self.roundings, roundings);
        growth(n, &before, &self.roundings)
    }

    #[inline(always)]
    fn change(&self, x: &mut Stages<N, S>, y: &Stages<N, S>) -> f64 {
        let n = self.system.moving();
        let change = change(n, x, y, &self.roundings);
        if CORRECTED && self.newton.is_some() { change.max(self.uncorrected) } else { change }
    }

    /// Momenta have an error of h ω relative to the stages, which is not small if an iteration contracts by (h ω)².
    #[inline(always)]
    fn passed_on(&self, _contraction: f64) -> f64 {
        1.0
    }
}
