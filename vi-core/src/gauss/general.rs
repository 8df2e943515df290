//! The stage equations of any system.
//!
//! For `q' = v, p' = F = L_q + f, p = L_v` at the stages, the unknowns are velocities and forces there,
//!
//! ```text
//! Q_i = q0 + Σ_j first_ij h b_j V_j        L_v(Q_i, V_i) = p0 + Σ_j first_ij h b_j F_j
//! q1  = q0 + Σ_j h b_j V_j                 p1 = p0 + Σ_j h b_j F_j
//! ```
//!
//! One iteration evaluates F, L_v and M at (Q, V), corrects V by `M⁻¹ (P − L_v)` with the momenta P from F, and moves Q
//! by the new V. If L is quadratic in v, it solves for V exactly. The change of V is the residual, because Q follows
//! from V. Many coordinates keep the masses of an earlier iteration ([`MANY`]): a fixed point is the same.
//!
//! In curvilinear coordinates ([`follows_momenta`]) F is evaluated at the velocities of the momenta of the last iteration,
//! which at Q are not quite V. If r scales the momentum of φ, V lags behind Q by an iteration, and the centrifugal force
//! with it. A geodesic with eight stages and a fifth of an orbit in a step takes nine iterations instead of fifteen.

use super::fixed_point::{Convergence, Equations, StageIncrement, VELOCITY};
use super::newton::Newton;
use super::points::{EquationForm, ErasedSystem, MANY, Points, follows_momenta};
use super::stages::{
    AtStages, EXACT, Roundings, Stages, add_products, change, constant_mass, gathered, growth, maximum, product,
    relaxed, relaxed_positions, roundings, scaled, scatter, sum, times, weights,
};
use super::tableau::Tableau;
use crate::linear::Matrix;
use crate::node::Node;
use core::marker::PhantomData;
use nalgebra::{SMatrix, SVector};

/// Contraction up to which masses are kept. Slower iterations would need more of them with old masses.
const FAST: f64 = 1.0 / 8.0;
/// Change below which masses are kept: 1/256 of the velocities.
const NEAR: f64 = VELOCITY / (256.0 * f64::EPSILON);

/// The inverse of M at each stage, of the last iteration with new masses.
pub(crate) type Masses<const N: usize, const S: usize> = Option<[Stages<N, S>; N]>;

/// The equations of a step; see the [module](self).
pub(crate) struct General<'a, T, Y, M: Matrix<N, f64>, const N: usize, const S: usize, const FUSED: bool> {
    pub(super) system: &'a Y,
    pub(super) node: &'a Node<N>,
    pub(super) h: f64,
    /// The accuracy of the stages, in ulps.
    pub(super) accuracy: f64,
    /// M, factored, if it is constant.
    inverse: Option<M::Inverse>,
    /// The kept masses of many coordinates. A reference, because moving the equations would copy them.
    kept: Option<&'a mut Masses<N, S>>,
    /// The linearized equations, if fixed-point iteration does not contract.
    pub(super) newton: Option<&'a Newton<N, S>>,
    /// Velocities that determine the positions.
    pub(super) velocity: Stages<N, S>,
    /// Velocities and forces of the last evaluation.
    pub(super) evaluated: Stages<N, S>,
    pub(super) force: Stages<N, S>,
    /// The largest `Σ_l |M⁻¹_kl P_l|` of the stages, for a variable mass matrix. If velocities are smaller, these terms
    /// cancel and determine the rounding error. Zero if M is constant or not finite.
    terms: SVector<f64, N>,
    /// Ulps of the velocities, and of the positions if they are checked.
    of_velocity: Roundings<N>,
    of_position: Roundings<N>,
    numbers: PhantomData<T>,
}

/// The equations of a step from `node`, with velocities at its stages, or forces there of a separable system.
pub(crate) fn equations<'a, const N: usize, const S: usize>(
    system: &'a ErasedSystem<'a, N>,
    node: &'a Node<N>,
    h: f64,
    stages: Stages<N, S>,
) -> General<'a, f64, ErasedSystem<'a, N>, SMatrix<f64, N, N>, N, S, false> {
    let mass = constant_mass::<N, f64, _>(system, node);
    General::new(system, mass.as_ref(), (node, h), stages, None, None)
}

impl<'a, T, Y, M, const N: usize, const S: usize, const FUSED: bool> General<'a, T, Y, M, N, S, FUSED>
where
    T: AtStages<S>,
    Y: Points<N, T>,
    M: Matrix<N, f64>,
{
    /// The equations of the step of length h from `node`, with the mass matrix if it is constant. The guess has stage
    /// velocities, or the stage forces of a separable system.
    #[inline(always)]
    pub(crate) fn new(
        system: &'a Y,
        mass: Option<&M>,
        (node, h): (&'a Node<N>, f64),
        guess: Stages<N, S>,
        newton: Option<&'a Newton<N, S>>,
        kept: Option<&'a mut Masses<N, S>>,
    ) -> Self {
        let inverse = mass.map(Matrix::inverse);
        let [velocity, force] = [guess; 2];
        let terms = SVector::zeros();
        let mut equations = Self {
            system,
            node,
            h,
            accuracy: EXACT,
            inverse,
            kept,
            newton,
            velocity,
            evaluated: velocity,
            force,
            terms,
            of_velocity: [0.0; N],
            of_position: [0.0; N],
            numbers: PhantomData,
        };
        if equations.system.form() == EquationForm::Separable {
            let mut velocity = equations.missing(&[[0.0; S]; N]);
            equations.solve(&mut velocity);
            equations.velocity = velocity;
        }
        equations
    }

    /// The current velocities.
    pub(crate) fn velocity(&self) -> Stages<N, S> {
        self.velocity
    }

    /// `low + Σ_j first_ij h b_j X_j` at the stages i.
    #[inline(always)]
    fn integrals(&self, of: &Stages<N, S>, low: &SVector<f64, N>) -> Stages<N, S> {
        let n = self.system.moving();
        let first = const { &Tableau::<S>::VALUES.first };
        let weights = weights(self.h);
        let mut integrals = [[0.0; S]; N];
        for k in 0..n {
            integrals[k] = product::<S, FUSED>(first, &scaled(&weights, &of[k]), &[low[k]; S]);
        }
        integrals
    }

    /// The positions by the current velocities.
    #[inline(always)]
    pub(super) fn positions(&self) -> Stages<N, S> {
        let n = self.system.moving();
        let mut x = self.integrals(&self.velocity, &self.node.q_low);
        for k in 0..n {
            for i in 0..S {
                x[k][i] += self.node.q[k];
            }
        }
        x
    }

    /// The momenta by the current forces minus `momentum`, the L_v of the velocities.
    #[inline(always)]
    pub(super) fn missing(&self, momentum: &Stages<N, S>) -> Stages<N, S> {
        let n = self.system.moving();
        let mut missing = self.integrals(&self.force, &self.node.p_low);
        for k in 0..n {
            for i in 0..S {
                missing[k][i] += self.node.p[k] - momentum[k][i];
            }
        }
        missing
    }

    /// Velocities of momenta, by the constant mass matrix.
    #[inline(always)]
    fn solve(&self, momenta: &mut Stages<N, S>) {
        if let Some(inverse) = &self.inverse {
            M::apply_to_rows(inverse, momenta);
        }
    }

    /// Time, coordinates and velocities of a stage.
    #[inline(always)]
    fn place(&self, i: usize, x: &Stages<N, S>, velocity: &Stages<N, S>) -> (T, SVector<T, N>, SVector<T, N>) {
        let n = self.system.moving();
        (T::of(&times::<N, S, FUSED>(self.node, self.h), i), gathered(n, x, i), gathered(n, velocity, i))
    }

    /// Evaluates the equations at the positions x, and returns the residuals of the momenta.
    #[inline(always)]
    fn evaluate(&mut self, x: &Stages<N, S>) -> Stages<N, S> {
        let n = self.system.moving();
        // Local arrays cannot alias, so that the compiler vectorizes their loops.
        let velocity = self.velocity;
        let x = *x;
        let mut force = [[0.0; S]; N];
        let mut momentum = [[0.0; S]; N];
        for i in 0..T::EVALUATIONS {
            let (t, q, v) = self.place(i, &x, &velocity);
            let sides = self.system.sides_at(t, &q, &v);
            scatter(n, &mut force, i, &sides.force);
            scatter(n, &mut momentum, i, &sides.momentum);
        }
        self.evaluated = velocity;
        self.force = force;
        self.missing(&momentum)
    }

    /// The same, and the inverse of the mass matrix of each stage. With momenta, the forces are those at their velocities.
    #[inline(always)]
    fn evaluate_with_masses(
        &mut self,
        x: &Stages<N, S>,
        inverse: &mut [Stages<N, S>; N],
        momenta: Option<&Stages<N, S>>,
    ) -> Stages<N, S> {
        let n = self.system.moving();
        let velocity = self.velocity;
        let x = *x;
        let mut force = [[0.0; S]; N];
        let mut momentum = [[0.0; S]; N];
        let mut terms = [[0.0; S]; N];
        let mut columns = SMatrix::<T, N, N>::zeros();
        for i in 0..T::EVALUATIONS {
            let (t, q, v) = self.place(i, &x, &velocity);
            let sides = self.system.sides_and_inverse_at(t, &q, &v, &mut columns);
            let mut at = sides.force;
            if let Some(momenta) = momenta {
                let mut v = v;
                for l in 0..n {
                    let missing = T::of(&momenta[l], i) - sides.momentum[l];
                    for k in 0..n {
                        v[k] += columns[(k, l)] * missing;
                    }
                }
                at = self.system.force_at(t, &q, &v);
            }
            scatter(n, &mut force, i, &at);
            scatter(n, &mut momentum, i, &sides.momentum);
            for k in 0..n {
                let mut sum = T::zero();
                for l in 0..n {
                    columns[(k, l)].put(&mut inverse[k][l], i);
                    sum += (columns[(k, l)] * sides.momentum[l]).abs();
                }
                sum.put(&mut terms[k], i);
            }
        }
        self.evaluated = velocity;
        self.force = force;
        for k in 0..n {
            let largest = maximum(&terms[k]);
            self.terms[k] = if largest < f64::INFINITY { largest } else { 0.0 };
        }
        self.missing(&momentum)
    }

    /// Adds corrections to the velocities.
    #[inline(always)]
    fn correct(&mut self, correction: &Stages<N, S>) {
        let n = self.system.moving();
        for k in 0..n {
            for i in 0..S {
                self.velocity[k][i] += correction[k][i];
            }
        }
    }

    /// An iteration with the constant mass matrix.
    #[inline(always)]
    fn iterate_constant(&mut self, x: &Stages<N, S>) {
        let mut correction = self.evaluate(x);
        self.solve(&mut correction);
        self.correct(&correction);
    }

    /// An iteration with the mass matrix of each stage, whose inverse waits for the momenta of all stages.
    #[inline(always)]
    fn iterate_varying(&mut self, x: &Stages<N, S>, before: &Convergence) {
        let n = self.system.moving();
        let zeros = [[[0.0; S]; N]; N];
        let kept = if const { N < MANY } { None } else { self.kept.take() };
        let Some(kept) = kept else {
            let mut inverse = zeros;
            // Before the first evaluation there are no forces.
            let has_forces = before.change.is_finite();
            let momenta = if has_forces && follows_momenta::<Y, T, N, S>(self.system) {
                Some(self.missing(&[[0.0; S]; N]))
            } else {
                None
            };
            let missing = self.evaluate_with_masses(x, &mut inverse, momenta.as_ref());
            return add_products::<N, S, FUSED>(n, &mut self.velocity, &inverse, &missing);
        };
        let are_near = before.change * self.accuracy < NEAR && before.contraction <= FAST;
        let missing = match kept {
            Some(_) if are_near => self.evaluate(x),
            _ => self.evaluate_with_masses(x, kept.insert(zeros), None),
        };
        if let Some(inverse) = kept {
            add_products::<N, S, FUSED>(n, &mut self.velocity, inverse, &missing);
        }
        self.kept = Some(kept);
    }
}

impl<T, Y, M, const N: usize, const S: usize, const FUSED: bool> Equations<N, S> for General<'_, T, Y, M, N, S, FUSED>
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
        self.positions()
    }

    #[inline(always)]
    fn iterate(&mut self, x: &Stages<N, S>, y: &mut Stages<N, S>, before: &Convergence) {
        // For a known form the compiler sees one branch.
        if let Some(newton) = self.newton {
            let missing = self.evaluate(x);
            self.correct(&newton.correction(&missing));
        } else if const { matches!(Y::FORM, Some(form) if form.varies_mass()) }
            || const { Y::FORM.is_none() } && self.system.form().varies_mass()
        {
            self.iterate_varying(x, before);
        } else {
            self.iterate_constant(x);
        }
        *y = self.positions();
    }

    #[inline(always)]
    fn increment(&self) -> StageIncrement<N> {
        let n = self.system.moving();
        let b = const { &Tableau::<S>::VALUES.b };
        let weights = weights::<S>(self.h);
        let mut increment = StageIncrement { velocity: SVector::zeros(), momentum: SVector::zeros() };
        for k in 0..n {
            increment.velocity[k] = sum(&scaled(b, &self.velocity[k]));
            increment.momentum[k] = sum(&scaled(&weights, &self.force[k]));
        }
        increment
    }

    #[inline(always)]
    fn guess(&self) -> Stages<N, S> {
        if self.system.form() == EquationForm::Separable { self.force } else { self.velocity }
    }

    #[inline(always)]
    fn velocities(&self) -> Option<Stages<N, S>> {
        Some(self.evaluated)
    }

    #[inline(always)]
    fn take_roundings(&mut self, x: &Stages<N, S>) -> f64 {
        let n = self.system.moving();
        let of_velocity = relaxed(n, roundings(n, &self.velocity, &self.terms), &self.velocity, self.accuracy);
        let before = core::mem::replace(&mut self.of_velocity, of_velocity);
        let of_velocities = growth(n, &before, &self.of_velocity);
        if self.newton.is_some() {
            let of_position = relaxed_positions(n, roundings(n, x, &self.node.q), x, (self.node, self.accuracy));
            let before = core::mem::replace(&mut self.of_position, of_position);
            return growth(n, &before, &self.of_position).max(of_velocities);
        }
        of_velocities
    }

    /// Changes of velocities, in ulps of the terms of these sums; in stiff steps also of positions, because the forces
    /// depend on them strongly.
    #[inline(always)]
    fn change(&self, x: &mut Stages<N, S>, y: &Stages<N, S>) -> f64 {
        let n = self.system.moving();
        let mut evaluated = self.evaluated;
        let of_velocities = change(n, &mut evaluated, &self.velocity, &self.of_velocity) * VELOCITY;
        if self.newton.is_some() {
            return change(n, x, y, &self.of_position).max(of_velocities);
        }
        *x = *y;
        of_velocities
    }

    /// After an iteration the velocities follow from its forces and share their error. A Newton correction does not
    /// update the forces of stiff steps. The energy error is then that of the velocities in ulps, not in sixteenths of
    /// them, and has a sign. Measured for a double pendulum with small oscillations: half of that tolerance costs 6 %
    /// more iterations and reduces the drift from 2.4e-17 a step to 3e-18; rounding alone has 1e-18.
    #[inline(always)]
    fn passed_on(&self, contraction: f64) -> f64 {
        if self.newton.is_some() { 1.0 } else { 0.5 * contraction / VELOCITY }
    }
}
