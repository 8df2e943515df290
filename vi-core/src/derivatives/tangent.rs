//! Tangent vectors along a run.
//!
//! Tangent vectors ([`Variation`]) at the node of a run propagate with each step, to a time, to an event, and across
//! changes of the parameters or the state. Directions share their evaluations, so that more of them cost little
//! (`docs/benchmarks.md`). Tangent vectors of a chaotic trajectory grow: rescale them by [`Tangent::variations_mut`].
//!
//! The length ℓ of a step that ends at a time or at an event follows from a condition g = 0 at its end z(ℓ):
//!
//! ```text
//! δz = δz|ℓ + ∂z/∂ℓ δℓ        δℓ = −(∂g·δz|ℓ)/(∂g·∂z/∂ℓ)
//! ```
//!
//! ∂z/∂ℓ is the derivative of the discrete step. It differs from that of the flow by the order of the method.

use super::steps::Differentiable;
use super::variation::along_parameters;
use super::variation::velocity_along;
use super::variation::{Variation, changes_of_energy, not_finite};
use crate::constrained::variation;
use crate::error::StepError;
use crate::lagrangian::{Flow, Lagrangian as _, Parameters};
use crate::method::Method;
use crate::real::Dual;
use crate::run::{Crossing, Event, Moment, Run};
use crate::state::State;
use crate::stepping::Convertible;
use alloc::vec::Vec;
use nalgebra::SVector;

/// A run with tangent vectors at its node.
#[derive(Clone, Debug)]
pub struct Tangent<M: Method<S, N>, S, const N: usize> {
    run: Run<M, S, N>,
    variations: Vec<Variation<N>>,
    failure: Option<StepError>,
    /// Whether the tangent vectors are known to be admissible.
    are_admissible: bool,
}

impl<M: Differentiable<S, N>, S: Convertible<N>, const N: usize> Tangent<M, S, N> {
    /// Combines a run and tangent vectors at its current node.
    #[must_use]
    pub fn new(run: Run<M, S, N>, variations: Vec<Variation<N>>) -> Self {
        Self { run, variations, failure: None, are_admissible: false }
    }

    /// A run before its first step, started by [`Start::integrate`](crate::Start::integrate), with tangent vectors of
    /// its initial state, its parameters and its first length. The preserved energy follows from these: the function sets
    /// `energy` of each vector.
    ///
    /// # Errors
    /// As [`Run::vary`].
    pub fn from_start(run: Run<M, S, N>, mut variations: Vec<Variation<N>>) -> Result<Self, StepError> {
        M::vary_start(&run, &mut variations)?;
        Ok(Self::new(run, variations))
    }

    /// Moves the tangent vectors to admissible ones, which satisfy the derivatives of the constraints and of their rates
    /// at the node: coordinates and momenta by the least changes in the metric of the mass matrix, for the given
    /// changes of time and parameters. Without constraints every tangent vector is admissible. It clears
    /// [`StepError::InconsistentTangent`].
    ///
    /// # Errors
    /// [`StepError::Singular`] if the constraints are redundant at the node, [`StepError::NonFinite`].
    pub fn project(&mut self) -> Result<(), StepError> {
        if let Some(StepError::InconsistentTangent { .. }) = self.failure {
            self.failure = None;
        }
        self.latched(|tangent| {
            let Run { system, node, .. } = &tangent.run;
            variation::project(system, node, &mut tangent.variations)?;
            tangent.are_admissible = true;
            Ok(())
        })
    }

    /// Takes a step, and returns its end state.
    ///
    /// # Errors
    /// The errors of the step; run and tangent vectors then do not change. [`StepError::InconsistentTangent`] for given
    /// vectors that are not admissible. Those of [`Run::vary`]; the tangent vectors are then invalid. Further calls
    /// return the same error.
    pub fn step(&mut self) -> Result<State<N>, StepError> {
        self.latched(|tangent| {
            tangent.check()?;
            let before = *tangent.run.node();
            let state = tangent.run.step()?;
            tangent.run.vary(&before, &mut tangent.variations).map(|()| state)
        })
    }

    /// Takes a step of the length h in time, as [`Run::step_of`] does, and returns its end state. This length does not
    /// vary.
    ///
    /// # Errors
    /// As [`Run::step_of`] and [`Run::vary`]. Further calls return the same error.
    pub fn step_of(&mut self, h: f64) -> Result<State<N>, StepError> {
        self.latched(|tangent| {
            tangent.check()?;
            let mut after = tangent.run.clone();
            after.step_of(h)?;
            tangent.end_at(h, after, |_, _| Ok(0.0))
        })
    }

    /// Takes steps up to the time t, as [`Run::until`] does, and returns the state there. The tangent vectors are at
    /// this fixed time: their `t` is zero.
    ///
    /// # Errors
    /// As [`Run::until`] and [`Run::vary`]. Further calls return the same error.
    pub fn until(&mut self, t: f64) -> Result<State<N>, StepError> {
        self.latched(|tangent| {
            tangent.check()?;
            tangent.end_at_time(t)
        })
    }

    /// The run.
    pub fn run(&self) -> &Run<M, S, N> {
        &self.run
    }

    /// The tangent vectors at the current node, in the given order.
    #[must_use]
    pub fn variations(&self) -> &[Variation<N>] {
        &self.variations
    }

    /// The tangent vectors, mutably, for example to rescale or orthogonalize them.
    pub fn variations_mut(&mut self) -> &mut [Variation<N>] {
        self.are_admissible = false;
        &mut self.variations
    }

    /// The derivative of the velocity along each tangent vector at the current node.
    ///
    /// # Errors
    /// [`StepError::Singular`] if the mass matrix, bordered by the constraints, is singular; those of
    /// [`State::velocity`].
    pub fn velocities(&self) -> Result<Vec<SVector<f64, N>>, StepError> {
        let (system, state) = (&self.run.system, self.run.node.state());
        let v = state.velocity(system)?;
        self.variations.iter().map(|variation| velocity_along(system, &state, &v, variation)).collect()
    }

    /// Sets the momenta of each tangent vector so that the velocity changes by this vector, for its changes of time,
    /// coordinates and parameters.
    ///
    /// # Errors
    /// The errors of [`State::velocity`].
    pub fn set_velocities(&mut self, changes: &[SVector<f64, N>]) -> Result<(), StepError> {
        let State { t, q, .. } = self.run.node.state();
        let v = self.run.node.state().velocity(&self.run.system)?;
        for (variation, change) in self.variations.iter_mut().zip(changes) {
            let along = |value: f64, slope: f64| Dual { value, slope };
            let (q, v) = (q.zip_map(&variation.q, along), v.zip_map(change, along));
            let momentum = along_parameters(&self.run.system, variation).momentum(along(t, variation.t), &q, &v);
            variation.p = momentum.map(|entry| entry.slope);
        }
        self.are_admissible = false;
        Ok(())
    }

    /// The tangent vectors, for linear combinations of them.
    pub(super) fn combined(&mut self) -> &mut [Variation<N>] {
        &mut self.variations
    }

    /// Checks vectors that the caller gave or changed.
    fn check(&mut self) -> Result<(), StepError> {
        if !self.are_admissible {
            variation::check_admissible(&self.run.system, (&self.run.node, self.run.h), &self.variations)?;
            self.are_admissible = true;
        }
        Ok(())
    }

    /// Runs a function unless an earlier one failed, and stores its failure.
    fn latched<R>(&mut self, take: impl FnOnce(&mut Self) -> Result<R, StepError>) -> Result<R, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        take(self).inspect_err(|failure| self.failure = Some(*failure))
    }

    /// [`Tangent::until`].
    fn end_at_time(&mut self, t: f64) -> Result<State<N>, StepError> {
        self.run.check_ahead(t)?;
        loop {
            let mut after = self.run.clone();
            if after.approach(t)? {
                let left = self.run.time_to(t);
                let state = self.end_at(left, after, |varied, _| Ok(-varied.t))?;
                self.variations.iter_mut().for_each(|variation| variation.t = 0.0);
                return Ok(state);
            }
            let before = core::mem::replace(&mut self.run, after);
            self.run.vary(before.node(), &mut self.variations)?;
        }
    }

    /// Advances to the run `after` by a step of this length. `of_length` returns the change of the length, from the
    /// tangent vector at fixed length and the derivative with respect to the length.
    fn end_at(
        &mut self,
        length: f64,
        after: Run<M, S, N>,
        of_length: impl Fn(&Variation<N>, &Variation<N>) -> Result<f64, StepError>,
    ) -> Result<State<N>, StepError> {
        let run = &self.run;
        let mut all: Vec<_> = self.variations.iter().map(|of| Variation { h: 0.0, ..of.clone() }).collect();
        let along = if length.is_normal() {
            all.push(Variation::of_length());
            M::vary_step_of(run, length, &mut all)?;
            all.pop().unwrap_or_else(Variation::zero)
        } else {
            // No time remains: the state moves along the flow.
            let State { t, q, p } = run.node().state();
            let Flow { v, force, power } = run.system().flow(t, &q, &p)?;
            Variation { t: 1.0, q: v, p: force, energy: power, ..Variation::zero() }
        };
        for (own, varied) in self.variations.iter_mut().zip(&mut all) {
            let change = of_length(varied, &along)?;
            if change != 0.0 {
                varied.add(&along, change);
            }
            varied.h = own.h;
        }
        Variation::check_finite(&all, run.t())?;
        self.variations = all;
        self.run = after;
        Ok(self.run.state())
    }
}

impl<M, S, const N: usize> Tangent<M, S, N>
where
    M: Differentiable<S, N>,
    S: Convertible<N>,
{
    /// A run at any node with tangent vectors of its present state and parameters. They vary as by
    /// [`Run::set_state`] and [`Run::set_parameters`]: the function sets `energy` of each vector to the derivative of H.
    ///
    /// # Errors
    /// As [`State::velocity`].
    pub fn from_change(run: Run<M, S, N>, mut variations: Vec<Variation<N>>) -> Result<Self, StepError> {
        if run.method().keeps_energy() {
            let changes = changes_of_energy(run.system(), &run.node().state(), &variations)?;
            variations.iter_mut().zip(changes).for_each(|(variation, change)| variation.energy = change);
        }
        Ok(Self::new(run, variations))
    }

    /// Takes steps up to the event, as [`Run::until_event`] does, or to the time `end` if there is none before. The
    /// tangent vectors are at the event: their `t` is the derivative of its time. The event needs a derivative:
    /// [`Event::smooth_rising`], [`Event::smooth_falling`], [`Event::smooth_crossing`].
    ///
    /// # Errors
    /// As [`Run::until_event`] and [`Run::vary`]; [`StepError::NoDerivative`] for an event without a derivative, or
    /// with a derivative along the trajectory that is zero or not finite. Further calls return the same error.
    pub fn until_event(&mut self, event: &Event<N>, end: f64) -> Result<Option<Crossing<N>>, StepError> {
        self.latched(|tangent| {
            tangent.check()?;
            tangent.end_at_event(event, end)
        })
    }

    /// Changes parameters, as [`Run::set_parameters`] does. The function of dual numbers also changes their
    /// derivatives: a parameter set to `Dual::fixed(2.0)` no longer varies.
    ///
    /// The preserved energy increases by `H_new − H_old`, and its derivative by the derivative of that.
    ///
    /// # Errors
    /// As [`Run::set_parameters`]; [`StepError::NonFinite`] if a derivative is not finite. Further calls return the
    /// same error.
    pub fn set_parameters(&mut self, change: impl Fn(&mut S::In<Dual<f64>>)) -> Result<(), StepError>
    where
        S: Parameters,
    {
        self.latched(|tangent| {
            let state = tangent.run.node().state();
            let before = changes_of_energy(tangent.run.system(), &state, &tangent.variations)?;
            let plain = Variation::zero();
            let numbers = |variation: &Variation<N>, run: &Run<M, S, N>| {
                let mut system = along_parameters(run.system(), variation);
                change(&mut system);
                let named = run.system().parameters().iter().map(|name| system.parameter_mut(name).copied());
                named.map(|number| number.unwrap_or(Dual::fixed(0.0))).collect::<Vec<_>>()
            };
            let values = numbers(&plain, &tangent.run);
            let slopes: Vec<Vec<_>> =
                tangent.variations.iter().map(|variation| numbers(variation, &tangent.run)).collect();
            tangent.run.set_parameters(|system| {
                for (name, value) in system.parameters().iter().zip(&values) {
                    if let Some(parameter) = system.parameter_mut(name) {
                        *parameter = value.value;
                    }
                }
            })?;
            for (variation, slopes) in tangent.variations.iter_mut().zip(slopes) {
                variation.parameters = slopes.into_iter().map(|number| number.slope).collect();
            }
            let after = changes_of_energy(tangent.run.system(), &state, &tangent.variations)?;
            tangent.gain_energy(&before, &after)
        })
    }

    /// Maps the state, as [`Run::set_state`] does, for example at an impact or into another frame. The map takes the
    /// system and the state in dual numbers.
    ///
    /// The preserved energy increases by `H(after) − H(before)`, and its derivative by the derivative of that.
    ///
    /// # Errors
    /// As [`Run::set_state`]; [`StepError::NonFinite`] if a derivative is not finite. Further calls return the same
    /// error.
    pub fn set_state(
        &mut self,
        map: impl Fn(&S::In<Dual<f64>>, State<N, Dual<f64>>) -> State<N, Dual<f64>>,
    ) -> Result<(), StepError> {
        self.latched(|tangent| {
            let State { t, q, p } = tangent.run.state();
            let node = tangent.run.node().state();
            let before = changes_of_energy(tangent.run.system(), &node, &tangent.variations)?;
            let mapped = |variation: &Variation<N>, run: &Run<M, S, N>| {
                let along = |value: f64, slope: f64| Dual { value, slope };
                let (q, p) = (q.zip_map(&variation.q, along), p.zip_map(&variation.p, along));
                map(&along_parameters(run.system(), variation), State { t: along(t, variation.t), q, p })
            };
            let State { t, q, p } = mapped(&Variation::zero(), &tangent.run);
            let varied: Vec<_> = tangent.variations.iter().map(|variation| mapped(variation, &tangent.run)).collect();
            let value = |number: Dual<f64>| number.value;
            tangent.run.set_state(State { t: t.value, q: q.map(value), p: p.map(value) })?;
            for (variation, State { t, q, p }) in tangent.variations.iter_mut().zip(varied) {
                let slope = |number: Dual<f64>| number.slope;
                (variation.t, variation.q, variation.p) = (t.slope, q.map(slope), p.map(slope));
            }
            let after = changes_of_energy(tangent.run.system(), &tangent.run.state(), &tangent.variations)?;
            tangent.gain_energy(&before, &after)
        })
    }

    /// Adds the change of the derivatives of H to those of the preserved energy, after a change of the vectors.
    fn gain_energy(&mut self, before: &[f64], after: &[f64]) -> Result<(), StepError> {
        self.are_admissible = false;
        if self.run.method().keeps_energy() {
            for (variation, (before, after)) in self.variations.iter_mut().zip(before.iter().zip(after)) {
                variation.energy += after - before;
            }
        }
        Variation::check_finite(&self.variations, self.run.t())
    }

    /// [`Tangent::until_event`].
    fn end_at_event(&mut self, event: &Event<N>, end: f64) -> Result<Option<Crossing<N>>, StepError> {
        if !event.has_derivative() {
            let because =
                "the event has no derivative; make it by `Event::smooth_rising` from a function of dual numbers";
            return Err(StepError::NoDerivative { t: self.run.t(), because });
        }
        let mut after = self.run.clone();
        let Some(crossing) = after.next_event(event, end)? else {
            return self.end_at_time(end).map(|_| None);
        };
        let Crossing { state: State { t, q, p }, v, length, .. } = crossing;
        // The search takes the same steps up to the node before the event.
        let missed = 4.0 * f64::EPSILON * t.abs();
        while self.run.time_to(t).abs() > length.abs() + missed {
            let before = *self.run.node();
            self.run.step()?;
            self.run.vary(&before, &mut self.variations)?;
        }
        let system = *self.run.system();
        let reduced = State { t, q: after.node().q, p };
        let slope = |variation: &Variation<N>| {
            let along = |value: f64, slope: f64| Dual { value, slope };
            let of_v = velocity_along(&system, &reduced, &v, variation)?;
            let (q, v) = (q.zip_map(&variation.q, along), v.zip_map(&of_v, along));
            event.slope(&Moment { t: along(t, variation.t), q, v }).ok_or(not_finite(t))
        };
        self.end_at(length, after, |varied, along| {
            let change = -slope(varied)? / slope(along)?;
            let because = "the event function has a derivative along the trajectory that is zero or not finite";
            if change.is_finite() { Ok(change) } else { Err(StepError::NoDerivative { t, because }) }
        })?;
        Ok(Some(crossing))
    }
}
