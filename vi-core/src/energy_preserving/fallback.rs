//! What is done where no energy-preserving step exists.
//!
//! In: the typed reason why there is none, and what the user chose. Out: that error; or fixed steps of the momentum
//! equation alone, until an energy-preserving step exists again. Steps exist while the step density D keeps its sign, and
//! follow the law `h |D|^(1/3) = C`. So the fixed steps have
//!
//! ```text
//! length  h_f = h of the last energy-preserving step, or the bound that the next one would have broken
//! end     D has its sign again, and the law asks for h_f in the next interval, or for less: C/|D|^(1/3) ≤ h_f
//! energy  E stays, with the work done since; only where no step has this energy, E is seeded anew with
//!         −D3 L_d − g_d⁺ of the last fixed interval
//! ```
//!
//! Without force, fixed steps keep `E + h² D/12` to order h⁴. They leave at (h_f, D_0) and return at about the same, so
//! that E is back; an interval with D instead of D_0 is off by `h_f² (D_0 − D)/12`, and then
//! `H − E = h_f² (D/24 + D_0/12)` has the sign of D: the step with the energy of before exists.
//! Near D = 0 each step is longer than the last by a growing factor; the fixed steps begin when it exceeds [`GROWTH`],
//! about half a step before the zero, so that h_f is not the length of a last leap.
//! AFTER A SWITCH q, p and t go on without a jump.

use super::{EnergyPreserving, Last, newton::Elimination};
use crate::compensated;
use crate::error::StepError;
use crate::momentum::{self, Solution, continuation};
use crate::node::Node;
use crate::real::Scalar;
use crate::state::Method;
use crate::state::Step;
use crate::stepping::EnergyStepping;

/// With the fallback a step may be longer than the last by this factor at most: where D falls linearly to zero, the step
/// law gives it at the distance of 0.7 h.
const GROWTH: f64 = 1.5;

/// What an [`EnergyPreserving`] run does where no energy-preserving step exists, or none within the bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Fallback {
    /// The step is an error, and the run ends.
    #[default]
    Stop,
    /// Fixed steps until D has its sign back and an energy-preserving step exists.
    FixedSteps,
}

/// How often a run has changed its method, and what that cost.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Switches<T = f64> {
    /// How often fixed steps began.
    pub count: u64,
    /// How often they ended in an energy-preserving step.
    pub returns: u64,
    /// How often the energy was seeded anew for that.
    pub reseeds: u64,
    /// Fixed steps taken.
    pub fixed_steps: u64,
    /// Sum of the jumps of the discrete energy.
    pub energy_change: T,
    /// Sum of their absolute values.
    pub energy_cost: T,
}

impl<T: Scalar> Default for Switches<T> {
    fn default() -> Self {
        Self { count: 0, returns: 0, reseeds: 0, fixed_steps: 0, energy_change: T::zero(), energy_cost: T::zero() }
    }
}

/// The shortest and the longest step allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct StepBounds<T> {
    h_min: T,
    h_max: T,
}

impl<T: Scalar> StepBounds<T> {
    pub(super) fn check(&self) -> Result<(), StepError> {
        let (h_min, h_max) = (self.h_min.to_f64(), self.h_max.to_f64());
        let invalid = |input, allowed, value| Err(StepError::InvalidInput { input, allowed, value });
        if !(h_min >= 0.0 && h_min.is_finite()) {
            return invalid("the bound h_min", "finite and not negative", h_min);
        }
        if !(h_max > 0.0 && h_max >= h_min && h_max.is_finite()) {
            return invalid("the bound h_max", "positive, finite and not below h_min", h_max);
        }
        Ok(())
    }

    #[inline]
    pub(super) fn admit(&self, h: T) -> bool {
        h >= self.h_min && h <= self.h_max
    }

    /// The error for a step of the length `found`.
    #[cold]
    pub(super) fn refusal(&self, t: T, found: T) -> StepError {
        let Self { h_min, h_max } = self;
        StepError::StepBounds { t: t.to_f64(), found: found.to_f64(), h_min: h_min.to_f64(), h_max: h_max.to_f64() }
    }

    fn clamp(&self, h: T) -> T {
        if h < self.h_min {
            self.h_min
        } else if h > self.h_max {
            self.h_max
        } else {
            h
        }
    }
}

/// Fixed steps under way.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Phase<T> {
    /// Their length.
    h: T,
    /// Whether the energy-preserving step would be shorter than they are, rather than longer or absent.
    shorter: bool,
    /// Length of the last energy-preserving step.
    law_h: T,
    /// D of its interval.
    law_density: T,
    /// D in the middle of the next interval, extrapolated.
    density_next: T,
    /// Discrete energy of the last fixed interval less the energy that the node carries.
    gap: T,
}

impl<T: Scalar> Phase<T> {
    pub(super) fn check(&self) -> Result<(), StepError> {
        super::starts::check_step("the fixed step h", self.h)?;
        super::starts::check_step("the last energy-preserving step h", self.law_h)?;
        let numbers = [self.law_density, self.density_next, self.gap];
        match numbers.iter().find(|number| !number.is_finite()) {
            Some(number) => {
                let (input, allowed) = ("a number of the fixed steps under way", "finite");
                Err(StepError::InvalidInput { input, allowed, value: number.to_f64() })
            }
            None => Ok(()),
        }
    }

    /// Discrete energy of the node that the last fixed step reached.
    pub(super) fn energy<const N: usize>(&self, node: &Node<N, T>) -> T {
        node.energy + (node.energy_low + self.gap)
    }

    /// Whether the step law asks for the fixed length in the next interval, or one beyond on the side of the
    /// energy-preserving steps.
    fn is_over(&self) -> bool {
        let ratio = self.law_density.to_f64() / self.density_next.to_f64();
        let h = self.law_h.to_f64() * ratio.cbrt();
        let fixed = self.h.to_f64();
        ratio > 0.0 && if self.shorter { h >= fixed } else { h <= fixed }
    }
}

impl<S, const N: usize, T> EnergyPreserving<S, N, T>
where
    S: EnergyStepping<N, T>,
    T: Scalar,
{
    /// What to do where no energy-preserving step exists; [`Fallback::Stop`] unless this is called.
    ///
    /// With [`Fallback::FixedSteps`] the errors [`StepError::NoForwardStep`], [`StepError::DegenerateStep`],
    /// [`StepError::StepRatio`], [`StepError::StepBounds`] and [`StepError::NotConverged`] do not end the run: it goes on
    /// with fixed steps while D has lost its sign or the step law asks for longer ones. Then it preserves the energy that
    /// it had before, or, where no step has that energy, the discrete energy of the last fixed interval. A step longer
    /// than the last by more than a factor of 1.5 is not taken either: D is about to vanish. Each [`Step`] says which
    /// method took it, and [`EnergyPreserving::switches`] what it cost.
    #[must_use]
    pub fn with_fallback(mut self, fallback: Fallback) -> Self {
        self.run.fallback = fallback;
        self
    }

    /// Steps shorter than `h_min` or longer than `h_max`, in units of time, are refused with [`StepError::StepBounds`],
    /// or, with the fallback, replaced by fixed steps of the bound. `h_min = 0` bounds from above alone.
    ///
    /// The first step follows an interval of its own length h0 and differs from it by a factor of 3 at most: bounds that
    /// leave no such step end the run at once.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] unless `0 ≤ h_min ≤ h_max`, with `h_max` positive and finite.
    pub fn with_step_bounds(mut self, h_min: T, h_max: T) -> Result<Self, StepError> {
        let bounds = StepBounds { h_min, h_max };
        bounds.check()?;
        self.run.bounds = Some(bounds);
        Ok(self)
    }

    /// How often the run has changed its method, and what that cost.
    pub fn switches(&self) -> Switches<T> {
        self.run.switches
    }

    /// Whether a step is so much longer than the last that D is about to vanish, and the user wants no such step.
    #[inline]
    pub(super) fn runs_away(&self, h: T) -> bool {
        self.run.fallback == Fallback::FixedSteps && h > self.run.last.h * T::real(GROWTH)
    }

    /// A fixed step instead of `root`.
    #[cold]
    pub(super) fn fall_back_from(&mut self, root: super::Root<N, T>) -> Result<Step<N, T>, StepError> {
        let (t, previous, found) = (self.run.node.t.to_f64(), self.run.last.h.to_f64(), root.h.to_f64());
        self.fall_back(StepError::StepRatio { t, previous, found })
    }

    /// The first fixed step, where the user allows it; else the failure.
    #[cold]
    pub(super) fn fall_back(&mut self, failure: StepError) -> Result<Step<N, T>, StepError> {
        let Last { h, density, .. } = self.run.last;
        let bounded = |h: T| self.run.bounds.as_ref().map_or(h, |bounds| bounds.clamp(h));
        let (length, shorter) = match (self.run.fallback, failure) {
            (Fallback::Stop, _) => return Err(failure),
            (_, StepError::StepBounds { found, h_min, .. }) => (bounded(T::real(found)), found < h_min),
            (_, StepError::Singular { .. } | StepError::NonFinite { .. } | StepError::InvalidInput { .. }) => {
                return Err(failure);
            }
            _ => (bounded(h), false),
        };
        let phase = Phase { h: length, shorter, law_h: h, law_density: density, density_next: density, gap: T::zero() };
        let step = self.fixed_step(phase)?;
        self.run.switches.count += 1;
        Ok(step)
    }

    /// A step where the last one was fixed: energy-preserving again where one exists, else fixed.
    #[cold]
    pub(super) fn advance_in_phase(&mut self, phase: Phase<T>) -> Result<Step<N, T>, StepError> {
        if !phase.is_over() {
            return self.fixed_step(phase);
        }
        let kept = self.run.node;
        if let Ok(root) = self.root(&kept) {
            let step = self.take(kept, root, Method::EnergyPreserving)?;
            self.run.switches.returns += 1;
            self.run.phase = None;
            return Ok(step);
        }
        let mut seeded = kept;
        compensated::add(&mut seeded.energy, &mut seeded.energy_low, phase.gap);
        if let Ok(root) = self.root(&seeded) {
            let step = self.take(seeded, root, Method::Reseeded { energy_change: phase.gap })?;
            let switches = &mut self.run.switches;
            switches.returns += 1;
            switches.reseeds += 1;
            switches.energy_change += phase.gap;
            switches.energy_cost += phase.gap.abs();
            self.run.phase = None;
            return Ok(step);
        }
        self.fixed_step(phase)
    }

    /// One fixed step of the phase.
    fn fixed_step(&mut self, phase: Phase<T>) -> Result<Step<N, T>, StepError> {
        let (system, start, last, h) = (&self.system, self.run.node, self.run.last, phase.h);
        let guess = last.v + last.slope() * ((last.h + h) * T::real(0.5));
        let Solution { v, iterations } = continuation::nearest(system, &start, h, guess, last.v)?;
        let equations = system.extended_system(&start, h, &v);
        let t = start.t.to_f64();
        let singular = StepError::Singular { t, matrix: "derivative of the momentum equation" };
        let infinite = StepError::NonFinite { t, quantity: "step density", expression: None };
        let density = Elimination::finite(&equations).ok_or(singular)?.density().ok_or(infinite)?;
        // Of the equation that was solved: next to the smallest numbers the rows of both differ in what underflows.
        let residual = momentum::residual(system, &start, h, &v);
        // The energy row e = c + v·r is what the energy carried lacks of the discrete energy of this interval.
        let gap = equations.energy_residual + v.dot(&equations.momentum.residual);
        // Forces may be finite where L is not: there is no energy to go on with.
        if !gap.is_finite() {
            return Err(StepError::NonFinite { t, quantity: "energy", expression: None });
        }
        let root = super::Root { v, h, density, iterations, residual };
        let step = self.take(start, root, Method::FixedStep)?;
        let phase = Phase { gap, density_next: step.density_next, ..phase };
        self.run.phase = Some(phase);
        self.run.switches.fixed_steps += 1;
        Ok(Step { energy: phase.energy(&self.run.node), ..step })
    }
}
