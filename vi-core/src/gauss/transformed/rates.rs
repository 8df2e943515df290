//! Memory of the last step in transformed time.
//!
//! After a solved step this module updates the run, and extrapolates the rates for the next step from the polynomials
//! of the last one.

use super::equations::Rates;
use super::{TransformedStages, check_time_scale};
use crate::compensated;
use crate::error::StepError;
use crate::gauss::fixed_point::{Convergence, Pause};
use crate::gauss::polynomial::{polynomials, sum};
use crate::gauss::stages::{coefficients, extrapolated, set};
use crate::gauss::tableau::{DEGREE, Tableau};
use crate::method::Memory;
use crate::motion::{ScaledPoint, TimeScale};
use crate::node::Node;
use crate::state::State;
use nalgebra::{ArrayStorage, SMatrix, SVector};

/// The rates at the stages of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LastRates<const N: usize, const S: usize> {
    /// Length of the last step in transformed time, and in time; before the first one Δτ and `g Δτ`.
    pub(crate) taken: f64,
    pub(crate) h: f64,
    /// The largest size of the terms of H, `|v·p| + |H|`, at the stages so far.
    pub(crate) size: f64,
    /// Velocities at the stages of the last step, one column per coordinate. Before the first step, the velocities at
    /// the node.
    pub(crate) velocities: SMatrix<f64, S, N>,
    /// The rates g and dE/dτ, one column each.
    pub(crate) clock: SMatrix<f64, S, 2>,
    pub(crate) convergence: Convergence,
    pub(crate) pause: Pause,
}

impl<const N: usize, const S: usize> Memory for LastRates<N, S> {}

/// A run after a step.
#[derive(Clone, Copy, Debug)]
pub struct After<const N: usize, const S: usize> {
    pub(crate) node: Node<N>,
    pub(crate) rates: LastRates<N, S>,
}

impl<const N: usize, const S: usize> LastRates<N, S> {
    /// Rates equal to those at the node, before the first step.
    ///
    /// # Errors
    /// [`StepError::NonFinite`], [`StepError::TimeScale`]; as [`State::velocity`].
    pub(crate) fn constant<Y: TimeScale<N>>(system: &Y, node: &Node<N>, dtau: f64) -> Result<Self, StepError> {
        node.check_finite(node.t)?;
        let State { t, q, .. } = node.state();
        let v = node.state().velocity(system)?;
        let ScaledPoint { energy, power, g, g_dt, .. } = system.scaled_point(t, &q, &v);
        check_time_scale(t, g)?;
        let gain = g * power + (energy - node.energy) * g_dt;
        let velocities = SMatrix::from_fn(|_, k| v[k]);
        let clock = SMatrix::from_fn(|_, column| if column == 0 { g } else { gain });
        let h = g * dtau;
        let size = energy.abs() + v.dot(&node.p).abs();
        let (convergence, pause) = (Convergence::NONE, Pause::NONE);
        Ok(Self { taken: dtau, h, size, velocities, clock, convergence, pause })
    }

    /// Rates at the stages of the last step.
    #[inline(always)]
    pub(crate) fn rates(&self) -> Rates<N, S> {
        let [g, energy] = self.clock.data.0;
        Rates { velocity: self.velocities.data.0, g, energy }
    }

    /// Rates at the stages of the next step, extrapolated from the last one.
    #[inline(always)]
    pub(crate) fn guess<const FUSED: bool>(&self, dtau: f64) -> Rates<N, S> {
        if !self.convergence.has_begun() {
            return self.rates();
        }
        if self.taken.to_bits() != dtau.to_bits() {
            return self.guess_of_another_length(dtau);
        }
        let Rates { velocity, g, energy } = self.rates();
        let [g, energy] = extrapolated::<2, S, FUSED>(2, &[g, energy]);
        Rates { velocity: extrapolated::<N, S, FUSED>(N, &velocity), g, energy }
    }

    /// Rates at the stages of the next step if it has another length: extrapolated up to a limited distance; beyond it,
    /// the rates of the last stage.
    #[cold]
    fn guess_of_another_length(&self, dtau: f64) -> Rates<N, S> {
        let c = const { &Tableau::<S>::VALUES.c };
        let ratio = dtau / self.taken;
        if !(ratio > 0.0 && ratio <= FARTHEST) {
            let last = |row: [f64; S]| [row[S - 1]; S];
            let Rates { velocity, g, energy } = self.rates();
            return Rates { velocity: velocity.map(last), g: last(g), energy: last(energy) };
        }
        let velocity = coefficients(&self.velocities.data.0);
        let clock = coefficients(&self.clock.data.0);
        let mut rates = self.rates();
        for i in 0..S {
            let mut basis = polynomials::<S>(1.0 + ratio * c[i]);
            basis.iter_mut().skip(DEGREE + 1).for_each(|value| *value = 0.0);
            set(&mut rates.velocity, i, &sum(&velocity, &basis));
            [rates.g[i], rates.energy[i]] = sum(&clock, &basis).into();
        }
        rates
    }

    /// The run after a step of the length Δτ from a node.
    #[inline(always)]
    pub(crate) fn after(&self, node: &Node<N>, dtau: f64, solved: &TransformedStages<N, S>) -> After<N, S> {
        let TransformedStages { increment, gains: [h, energy], rates, iteration, .. } = solved;
        let mut node = *node;
        compensated::add_rounded(&mut node.t, &mut node.t_low, *h);
        compensated::add_vector(&mut node.q, &mut node.q_low, &(increment.velocity * dtau));
        compensated::add_vector(&mut node.p, &mut node.p_low, &increment.momentum);
        node.add_energy(*energy);
        let velocities = SMatrix::from_array_storage(ArrayStorage(rates.velocity));
        let clock = SMatrix::from_array_storage(ArrayStorage([rates.g, rates.energy]));
        let size = self.size.max(solved.excess[1]);
        let convergence = iteration.convergence;
        After { node, rates: Self { taken: dtau, h: *h, size, velocities, clock, convergence, pause: Pause::NONE } }
    }

    /// Checks whether a run can continue from stored rates.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub(crate) fn check(&self, t: f64) -> Result<(), StepError> {
        let Self { velocities, clock, taken, h, size, .. } = self;
        let mut numbers = velocities.iter().chain(clock.iter()).chain([taken, h, size]);
        let lost = StepError::NonFinite { t, quantity: "last stages", expression: None };
        if numbers.all(|entry| entry.is_finite()) { Ok(()) } else { Err(lost) }
    }
}

impl<const N: usize, const S: usize> After<N, S> {
    /// Whether the step changes the time, whose two parts hold twice the digits of a number, and preserves the energy.
    /// K = g (H − E) is nearly constant: if g almost vanishes, H − E grows, and the trajectory would be reflected.
    #[inline(always)]
    pub(crate) fn can_continue(&self, before: (&Node<N>, &LastRates<N, S>), solved: &TransformedStages<N, S>) -> bool {
        let (node, rates) = before;
        let [excess, size] = solved.excess;
        let is_lost = excess > size && excess > LOST * rates.size;
        !is_lost && self.rates.h.abs() > 0.25 * f64::EPSILON * f64::EPSILON * node.t.abs()
    }

    /// Whether everything is finite, and g positive at all stages and at the node.
    #[inline(always)]
    pub(crate) fn is_sound<Y: TimeScale<N>>(&self, system: &Y) -> bool {
        let is_positive = |g: f64| g > 0.0 && g.is_finite();
        self.node.is_finite()
            && self.rates.clock.column(0).iter().all(|g| is_positive(*g))
            && is_positive(time_scale(system, self.node.t, &self.node.q))
    }
}

/// g at a state.
#[inline(always)]
pub(crate) fn time_scale<Y: TimeScale<N>, const N: usize>(system: &Y, t: f64, q: &SVector<f64, N>) -> f64 {
    system.scaled_point(t, q, &SVector::zeros()).g
}

/// Excess `|H − E|`, relative to the largest terms of H, that invalidates a step.
const LOST: f64 = 0.1;
/// Longest extrapolation, in lengths of the last step.
const FARTHEST: f64 = 2.0;
