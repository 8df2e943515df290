//! Gauss steps of constant length in transformed time, `dt = g(t, q) dτ`: steps of order 2S that adapt to the motion.
//!
//! A step is Gauss collocation of the Hamiltonian `K = g (H − E)` in extended phase space, where t is a coordinate and
//! −E its momentum. With constant Δτ, h is short if g is small. With `H = V·P − L` at a stage and F = L_q + f,
//!
//! ```text
//! t' = g        q' = g v        p' = g F − (H − E) ∂g/∂q        E' = g (f·v − L_t) + (H − E) ∂g/∂t        L_v = p
//! ```
//!
//! all four collocated. Along the motion H = E. E starts as H of the first state, and is constant if the system is
//! autonomous, has no force and g does not depend on t. Without force the map is symplectic in extended phase space. It
//! is time-symmetric, and preserves the momenta of symmetries of g, such as the angular momentum for g(r) (Hairer,
//! Lubich, Wanner, *Geometric Numerical Integration*, VIII.2.1; Leimkuhler and Reich, *Simulating Hamiltonian
//! Dynamics*, chapter 9).
//!
//! The stages of every accepted step satisfy their equations to rounding, and g is positive and finite at all of them
//! and at the end.

use super::{Change, Facts, Gauss, Method, Problem, Status, check_step};
use crate::error::{Residuals, StepError};
use crate::gauss::fixed_point::Convergence;
use crate::gauss::newton::Buffer;
use crate::gauss::transformed::{
    After, LastRates, Start, TransformedPolynomial, TransformedStages, check_time_scale, time_scale,
};
use crate::motion::TimeScale;
use crate::node::Node;
use crate::run::Run;
use crate::state::State;
use crate::stepping::Convertible;
use vi_dispatch::Instructions;

/// A method whose steps have constant length in transformed time: `Gauss::<8>.in_transformed_time()`. See the [module](self).
///
/// The step of a run is Δτ, in units of time over the unit of g.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InTransformedTime<M>(M);

impl<const STAGES: usize> Gauss<STAGES> {
    /// Takes the same steps at constant length in transformed time, for systems with the clause `time_scale = …;`.
    #[must_use]
    pub fn in_transformed_time(self) -> InTransformedTime<Self> {
        InTransformedTime(self)
    }
}

/// Most trials of Δτ for a step of a given length in time.
const TRIALS: u32 = 60;
/// Largest error of such a length, in its roundings, if they exceed one of the time: the length is a quadrature.
const MISSED: f64 = 16.0;

impl<S, const N: usize, const STAGES: usize> Method<S, N> for InTransformedTime<Gauss<STAGES>>
where
    S: TimeScale<N> + Convertible<N>,
{
    type Prepared = Instructions;
    type Memory = LastRates<N, STAGES>;
    type Cache = Buffer<N, STAGES>;
    type Step = After<N, STAGES>;
    type Left = Option<TransformedStages<N, STAGES>>;
    type DenseOutput = TransformedPolynomial<N, STAGES>;

    // The change of g from step to step has no known bound.
    fn facts(&self) -> Facts {
        Facts { finds_length: true, ..Facts::of_order(2 * STAGES) }
    }

    fn check_length(&self, system: &S, dtau: f64) -> Result<(), StepError> {
        if !system.scales_time() {
            return Err(StepError::NoTimeScale { system: system.name() });
        }
        if dtau.is_normal() {
            return Ok(());
        }
        let allowed = "finite, not zero and not subnormal";
        Err(StepError::InvalidInput { input: "the step Δτ in transformed time", allowed, value: dtau })
    }

    fn prepare(&self, _system: &S, _dtau: f64) -> Instructions {
        Instructions::detected()
    }

    fn begin(&self, system: &S, node: &mut Node<N>, dtau: f64) -> Result<Self::Memory, StepError> {
        node.energy = node.state().energy(system)?;
        LastRates::constant(system, node, dtau)
    }

    #[inline(always)]
    fn attempt(
        &self,
        at: Problem<'_, S, Instructions, N>,
        memory: &Self::Memory,
        _cache: &mut Self::Cache,
    ) -> Result<Self::Step, Self::Left> {
        let Problem { system, prepared, node, h } = at;
        if !memory.pause.is_over() {
            return Err(None);
        }
        Start { system, node, dtau: h, last: memory }.by_fixed_point(*prepared).map_err(Some)
    }

    fn recover(
        &self,
        at: Problem<'_, S, Instructions, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
        left: Self::Left,
    ) -> Result<Self::Step, StepError> {
        let Problem { system, node, h, .. } = at;
        Start { system, node, dtau: h, last: memory }.recover(left.as_ref(), cache)
    }

    #[inline(always)]
    fn take(
        &self,
        _system: &S,
        _dtau: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        _cache: &mut Self::Cache,
        step: Self::Step,
    ) {
        (*node, *memory) = (step.node, step.rates);
    }

    /// Newton iteration on `t(Δτ) = t0 + h`, whose derivative is g at the end, with bisection if it leaves the bracket
    /// of Δτ. Each trial solves a step.
    fn step_of(
        &self,
        system: &S,
        (node, memory): (&Node<N>, &Self::Memory),
        [h, next]: [f64; 2],
    ) -> Result<(Node<N>, Self::Memory), StepError> {
        check_step(h)?;
        let State { t, q, .. } = node.state();
        let g = time_scale(system, t, &q);
        check_time_scale(t, g)?;
        let prepared = Instructions::detected();
        let mut cache = Buffer::default();
        let missed = f64::EPSILON * (MISSED * h.abs()).max(t.abs());
        // No trial exceeds twice the longest Δτ known to be too short.
        let [mut low, mut high] = [0.0, f64::INFINITY];
        let mut length = (h / g).abs().min(next.abs());
        let mut residuals = Residuals::new();
        let mut residual = 0.0;
        for _ in 0..TRIALS {
            let dtau = length.copysign(h);
            let at = Problem { system, prepared: &prepared, node, h: dtau };
            let After { node: end, rates } = self.solve(at, memory, &mut cache)?;
            let left = (h - rates.h) * h.signum();
            if left.abs() <= missed {
                return Ok((end, LastRates { h: memory.h, ..rates }));
            }
            residual = left.abs() / (f64::EPSILON * h.abs());
            residuals.push(residual);
            if left > 0.0 {
                low = length;
            } else {
                high = length;
            }
            let g = time_scale(system, end.t, &end.q);
            let next = length + left / g;
            let bound = if high.is_finite() { high } else { 2.0 * low };
            let halfway = if high.is_finite() { 0.5 * (low + high) } else { bound };
            length = if next > low && next < bound { next } else { halfway };
        }
        Err(StepError::NotConverged { t, h, iterations: TRIALS, residual, residuals, turn: 0.0 })
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N>,
        node: &mut Node<N>,
        dtau: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        if matches!(change, Change::NewLength) {
            return Ok(*memory);
        }
        let changed = change.moved_with_energy(system, node)?;
        let rates = LastRates::constant(system, &changed, dtau)?;
        *node = changed;
        Ok(rates)
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        _h: f64,
        memory: &Self::Memory,
    ) -> Result<TransformedPolynomial<N, STAGES>, StepError> {
        Ok(TransformedPolynomial::of(system, node.energy, memory, *before))
    }

    fn status(&self, dtau: f64, memory: &Self::Memory) -> Status {
        let Convergence { change: residual, iterations, .. } = memory.convergence;
        Status { length: memory.h, longest: f64::INFINITY.copysign(dtau), residual, iterations }
    }

    fn discrete_energy(&self, _system: &S, node: &Node<N>, _dtau: f64, memory: &Self::Memory) -> Option<f64> {
        memory.convergence.has_begun().then_some(node.energy)
    }

    fn check(&self, _system: &S, (node, memory): (&Node<N>, &Self::Memory), _dtau: f64) -> Result<(), StepError> {
        memory.check(node.t)
    }
}

impl<S, const N: usize, const STAGES: usize> Run<InTransformedTime<Gauss<STAGES>>, S, N>
where
    S: TimeScale<N> + Convertible<N>,
{
    /// The step in transformed time.
    pub fn dtau(&self) -> f64 {
        self.h
    }

    /// `H − E` at the last state, in the units of L: the energy error of the steps. It stays small and does not drift,
    /// while `K = g (H − E)` is zero along the motion.
    ///
    /// # Errors
    /// [`StepError::Singular`] or [`StepError::NotConverged`] if no velocity has the momenta.
    pub fn excess(&self) -> Result<f64, StepError> {
        Ok(self.energy()? - self.node.energy)
    }
}
