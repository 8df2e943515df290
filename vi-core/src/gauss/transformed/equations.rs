//! The stage equations of a step in transformed time.
//!
//! The equations of motion, `dt = g dτ` and H at the stages determine velocities, times, energies and their rates,
//!
//! ```text
//! T_i = t0 + Σ_j first_ij w_j g_j                 w_j = Δτ b_j
//! Q_i = q0 + Σ_j first_ij w_j g_j V_j
//! E_i = E0 + Σ_j first_ij w_j E'_j                E' = g (f·V − L_t) + (H − E) ∂g/∂t
//! L_v(T_i, Q_i, V_i) = p0 + Σ_j first_ij w_j P'_j         P' = g (L_q + f) − (H − E) ∂g/∂q
//! ```
//!
//! One iteration evaluates everything at (T, Q, V, E), corrects V by `M⁻¹ (P − L_v)` with the momenta P from P', and
//! moves T, Q and E by the new g, V and E'.

use super::super::fixed_point::{Convergence, Equations, StageIncrement, VELOCITY};
use super::super::newton::Newton;
use super::super::stages::{
    Roundings, Stages, add_products, change, constant_mass, growth, product, roundings, scaled, set, stage, weights,
};
use super::super::tableau::Tableau;
use crate::linear::Matrix;
use crate::motion::Motion;
use crate::node::Node;
use crate::real::{Lane, Real};
use nalgebra::SVector;

/// The unknowns of a step: velocities, and the rates of time and energy at its stages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rates<const N: usize, const S: usize> {
    pub(crate) velocity: Stages<N, S>,
    /// `dt/dτ = g`.
    pub(crate) g: [f64; S],
    /// `dE/dτ`.
    pub(crate) energy: [f64; S],
}

/// Times and energies of the stages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clock<const S: usize> {
    pub(crate) time: [f64; S],
    pub(crate) energy: [f64; S],
}

/// The equations of a step; see the [module](self).
pub(crate) struct Scaled<'a, T, Y: Motion<N, T>, const N: usize, const S: usize, const FUSED: bool>
where
    T: Real,
{
    system: &'a Y,
    node: &'a Node<N>,
    dtau: f64,
    /// M, if it is constant.
    mass: Option<Y::Mass>,
    /// The motion with `h = g Δτ`, with g at the middle, linearized, if fixed-point iteration does not contract. The
    /// linearization omits the changes of g, because g is no faster than the motion that it follows.
    newton: Option<&'a Newton<N, S>>,
    /// Rates that determine positions, times and energies.
    rates: Rates<N, S>,
    clock: Clock<S>,
    /// Velocities, times and energies of the last evaluation.
    velocity: Stages<N, S>,
    evaluated: Clock<S>,
    /// `dp/dτ` of the last evaluation.
    force: Stages<N, S>,
    /// The largest H, and v·p, of the last evaluation: the terms of an energy.
    energy_scale: f64,
    /// The largest `|H − E|` of the last evaluation.
    excess: f64,
    roundings: AllRoundings<N>,
}

/// Ulps of all changing quantities.
pub(crate) struct AllRoundings<const N: usize> {
    position: Roundings<N>,
    velocity: Roundings<N>,
    time: Roundings<1>,
    energy: Roundings<1>,
}

impl<'a, T, Y, const N: usize, const S: usize, const FUSED: bool> Scaled<'a, T, Y, N, S, FUSED>
where
    T: Real,
    Y: Motion<N, T>,
{
    /// The equations of the step of length Δτ from `node`, with a guess of the rates at its stages.
    #[inline(always)]
    pub(crate) fn new(
        system: &'a Y,
        node: &'a Node<N>,
        dtau: f64,
        rates: Rates<N, S>,
        newton: Option<&'a Newton<N, S>>,
    ) -> Self {
        let mass = constant_mass(system, node);
        let clock = Clock { time: [node.t; S], energy: [node.energy; S] };
        let force = [[0.0; S]; N];
        let velocity = rates.velocity;
        let energy_scale = 0.0;
        let evaluated = clock;
        let roundings = AllRoundings { position: [0.0; N], velocity: [0.0; N], time: [0.0], energy: [0.0] };
        let mut equations = Self {
            system,
            node,
            dtau,
            mass,
            newton,
            rates,
            clock,
            velocity,
            evaluated,
            force,
            energy_scale,
            excess: 0.0,
            roundings,
        };
        equations.advance_clock();
        equations
    }

    /// `low + Σ_j first_ij w_j x_j` at the stages i.
    #[inline(always)]
    fn integral(&self, of: &[f64; S], low: f64) -> [f64; S] {
        let first = const { &Tableau::<S>::VALUES.first };
        let weights = weights(self.dtau);
        product::<S, FUSED>(first, &scaled(&weights, of), &[low; S])
    }

    /// Moves times and energies by the current rates.
    #[inline(always)]
    fn advance_clock(&mut self) {
        let time = self.integral(&self.rates.g, self.node.t_low);
        let energy = self.integral(&self.rates.energy, self.node.energy_low);
        for i in 0..S {
            self.clock.time[i] = self.node.t + time[i];
            self.clock.energy[i] = self.node.energy + energy[i];
        }
    }

    /// The positions by the current rates.
    #[inline(always)]
    fn positions(&self) -> Stages<N, S> {
        let mut x = [[0.0; S]; N];
        for k in 0..N {
            let moved = self.integral(&scaled(&self.rates.g, &self.rates.velocity[k]), self.node.q_low[k]);
            for i in 0..S {
                x[k][i] = self.node.q[k] + moved[i];
            }
        }
        x
    }

    /// Evaluates the equations at the positions x, calls `keep` with each mass matrix, and returns the residuals of the
    /// momenta.
    #[inline(always)]
    fn evaluate(&mut self, x: &Stages<N, S>, mut keep: impl FnMut(usize, &Y::Mass)) -> Stages<N, S> {
        // Local arrays cannot alias, so that the compiler vectorizes their loops.
        let velocity = self.rates.velocity;
        let clock = self.clock;
        let x = *x;
        let mut force = [[0.0; S]; N];
        let mut momentum = [[0.0; S]; N];
        let mut g = [0.0; S];
        let mut gain = [0.0; S];
        let mut size = [0.0; S];
        let mut missed = [0.0; S];
        for i in 0..S {
            let v = stage::<N, S, T>(&velocity, i);
            let at = self.system.scaled_point(T::real(clock.time[i]), &stage(&x, i), &v);
            let excess = at.energy - T::real(clock.energy[i]);
            let mut p_rate = at.point.force;
            let mut action = T::zero();
            for k in 0..N {
                p_rate[k] = at.g * at.point.force[k] - excess * at.g_dq[k];
                action += v[k] * at.point.momentum[k];
            }
            set(&mut force, i, &p_rate);
            set(&mut momentum, i, &at.point.momentum);
            g[i] = at.g.to_f64();
            gain[i] = (at.g * at.power + excess * at.g_dt).to_f64();
            size[i] = at.energy.to_f64().abs() + action.to_f64().abs();
            missed[i] = excess.to_f64().abs();
            keep(i, &at.point.mass);
        }
        self.velocity = velocity;
        self.evaluated = clock;
        self.force = force;
        self.rates.g = g;
        self.rates.energy = gain;
        self.energy_scale = size.into_iter().fold(0.0, f64::max);
        self.excess = missed.into_iter().fold(0.0, f64::max);
        let mut missing = [[0.0; S]; N];
        for k in 0..N {
            let gained = self.integral(&force[k], self.node.p_low[k]);
            for i in 0..S {
                missing[k][i] = gained[i] + (self.node.p[k] - momentum[k][i]);
            }
        }
        missing
    }

    /// Adds corrections to the velocities, and updates times and energies.
    #[inline(always)]
    fn moved(&mut self, correction: &Stages<N, S>) -> Stages<N, S> {
        for k in 0..N {
            for i in 0..S {
                self.rates.velocity[k][i] += correction[k][i];
            }
        }
        self.advance_clock();
        self.positions()
    }

    /// The corrections of the velocities by the constant mass matrix.
    #[inline(always)]
    fn by_constant_mass(&mut self, x: &Stages<N, S>) -> Stages<N, S> {
        let missing = self.evaluate(x, |_, _| {});
        let mut correction = [[0.0; S]; N];
        if let Some(mass) = self.mass {
            for i in 0..S {
                set(&mut correction, i, &mass.solve_unchecked(&stage::<N, S, T>(&missing, i)));
            }
        }
        correction
    }

    /// The corrections of the velocities by the mass matrix of each stage, whose inverse needs the momenta of all
    /// stages.
    #[inline(always)]
    fn by_varying_mass(&mut self, x: &Stages<N, S>) -> Stages<N, S> {
        let mut inverse = [[[0.0; S]; N]; N];
        let missing = self.evaluate(x, |i, mass| {
            let columns = mass.inverse_unchecked();
            for k in 0..N {
                for l in 0..N {
                    inverse[k][l][i] = columns[(k, l)].to_f64();
                }
            }
        });
        let mut correction = [[0.0; S]; N];
        add_products::<N, S, FUSED>(N, &mut correction, &inverse, &missing);
        correction
    }

    /// `dp/dτ` by the current rates.
    pub(crate) fn momentum_rates(&mut self) -> Stages<N, S> {
        let x = self.positions();
        self.evaluate(&x, |_, _| {});
        self.force
    }

    /// `Σ_j w_j x_j`.
    #[inline(always)]
    pub(crate) fn quadrature(&self, of: &[f64; S]) -> f64 {
        let weights = weights::<S>(self.dtau);
        let mut sum = 0.0;
        for i in 0..S {
            sum = Lane::<FUSED>::multiply_add(weights[i], of[i], sum);
        }
        sum
    }

    /// Increments of time and energy over the step, from the last evaluation.
    #[inline(always)]
    pub(crate) fn gains(&self) -> [f64; 2] {
        [self.quadrature(&self.rates.g), self.quadrature(&self.rates.energy)]
    }

    /// The current rates, for the extrapolation of the next step.
    #[inline(always)]
    pub(crate) fn rates(&self) -> Rates<N, S> {
        self.rates
    }

    /// The largest `|H − E|` at the last evaluation, and the size of the terms of H.
    #[inline(always)]
    pub(crate) fn excess(&self) -> [f64; 2] {
        [self.excess, self.energy_scale]
    }

    /// Velocities of the last evaluation.
    #[inline(always)]
    pub(crate) fn velocity(&self) -> Stages<N, S> {
        self.velocity
    }

    /// Times and energies of the last evaluation.
    #[inline(always)]
    pub(crate) fn evaluated(&self) -> Clock<S> {
        self.evaluated
    }
}

impl<T, Y, const N: usize, const S: usize, const FUSED: bool> Equations<N, S> for Scaled<'_, T, Y, N, S, FUSED>
where
    T: Real,
    Y: Motion<N, T>,
{
    #[inline(always)]
    fn has_another_way(&self) -> bool {
        self.newton.is_none()
    }

    #[inline(always)]
    fn start(&self) -> Stages<N, S> {
        self.positions()
    }

    #[inline(always)]
    fn iterate(&mut self, x: &Stages<N, S>, y: &mut Stages<N, S>, _before: &Convergence) {
        let correction = match self.newton {
            Some(newton) => newton.correction(&self.evaluate(x, |_, _| {})),
            None if self.system.has_constant_mass() => self.by_constant_mass(x),
            None => self.by_varying_mass(x),
        };
        *y = self.moved(&correction);
    }

    #[inline(always)]
    fn increment(&self) -> StageIncrement<N> {
        let mut increment = StageIncrement { velocity: SVector::zeros(), momentum: SVector::zeros() };
        for k in 0..N {
            increment.velocity[k] = self.quadrature(&scaled(&self.rates.g, &self.velocity[k])) / self.dtau;
            increment.momentum[k] = self.quadrature(&self.force[k]);
        }
        increment
    }

    #[inline(always)]
    fn guess(&self) -> Stages<N, S> {
        self.rates.velocity
    }

    #[inline(always)]
    fn velocities(&self) -> Option<Stages<N, S>> {
        Some(self.velocity)
    }

    /// Changes of velocities, of times (with the ulps of positions) and of energies.
    #[inline(always)]
    fn take_roundings(&mut self, x: &Stages<N, S>) -> f64 {
        let after = AllRoundings {
            position: roundings(N, x, &self.node.q),
            velocity: roundings(N, &self.rates.velocity, &SVector::zeros()),
            time: roundings(1, &[self.clock.time], &SVector::from([self.node.t])),
            energy: roundings(1, &[self.clock.energy], &SVector::from([self.energy_scale])),
        };
        let before = core::mem::replace(&mut self.roundings, after);
        let now = &self.roundings;
        let of_motion = growth(N, &before.position, &now.position).max(growth(N, &before.velocity, &now.velocity));
        of_motion.max(growth(1, &before.time, &now.time)).max(growth(1, &before.energy, &now.energy))
    }

    #[inline(always)]
    fn change(&self, x: &mut Stages<N, S>, y: &Stages<N, S>) -> f64 {
        let roundings = &self.roundings;
        let mut evaluated = self.velocity;
        let Clock { time, energy } = self.evaluated;
        let velocity = change(N, &mut evaluated, &self.rates.velocity, &roundings.velocity);
        let time = change(1, &mut [time], &[self.clock.time], &roundings.time);
        let energy = change(1, &mut [energy], &[self.clock.energy], &roundings.energy);
        change(N, x, y, &roundings.position).max(time).max(velocity.max(energy) * VELOCITY)
    }

    #[inline(always)]
    fn passed_on(&self, _contraction: f64) -> f64 {
        1.0
    }
}
