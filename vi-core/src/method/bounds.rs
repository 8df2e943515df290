//! What a run does where no energy-preserving step exists.
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
//! Near D = 0 each step is longer than the last by a growing factor; the fixed steps begin when it exceeds `GROWTH`,
//! about half a step before the zero, so that h_f is not the length of a last leap.
//! AFTER A SWITCH q, p and t go on without a jump.

use super::{Memory, Method};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::real::Scalar;
use crate::run::Run;
use crate::state::StepKind;

/// A step may be longer or shorter than the last one by this factor at most.
pub(crate) const RATIO: f64 = 3.0;
/// With the fallback a step may be longer than the last by this factor at most: where D falls linearly to zero, the step
/// law gives it at the distance of 0.7 h.
pub(crate) const GROWTH: f64 = 1.5;

/// What an energy-preserving run does if no energy-preserving step exists, or none within its bounds.
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

impl<T: Scalar> Switches<T> {
    /// Counts the energy that was seeded anew, by so much more.
    pub(crate) fn reseed(&mut self, gap: T) {
        self.reseeds += 1;
        self.energy_change += gap;
        self.energy_cost += gap.abs();
    }
}

impl<T: Scalar> Default for Switches<T> {
    fn default() -> Self {
        Self { count: 0, returns: 0, reseeds: 0, fixed_steps: 0, energy_change: T::zero(), energy_cost: T::zero() }
    }
}

/// The shortest and the longest step allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct StepBounds<T> {
    pub(crate) h_min: T,
    pub(crate) h_max: T,
}

impl<T: Scalar> StepBounds<T> {
    pub(crate) fn check(&self) -> Result<(), StepError> {
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
    pub(crate) fn admit(&self, h: T) -> bool {
        h >= self.h_min && h <= self.h_max
    }

    /// The error for a step of the length `found`.
    #[cold]
    pub(crate) fn refusal(&self, t: T, found: T) -> StepError {
        let Self { h_min, h_max } = self;
        StepError::StepBounds { t: t.to_f64(), found: found.to_f64(), h_min: h_min.to_f64(), h_max: h_max.to_f64() }
    }

    pub(crate) fn clamp(&self, h: T) -> T {
        if h < self.h_min {
            self.h_min
        } else if h > self.h_max {
            self.h_max
        } else {
            h
        }
    }
}

/// What a run whose steps find their length does if no such step exists, and how often it did.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Control<T = f64> {
    pub(crate) bounds: Option<StepBounds<T>>,
    pub(crate) fallback: Fallback,
    /// The fixed steps under way.
    pub(crate) phase: Option<Phase<T>>,
    pub(crate) switches: Switches<T>,
    /// How the last step was found.
    pub(crate) kind: StepKind<T>,
}

impl<T: Scalar> Control<T> {
    /// No bounds, no fallback.
    pub(crate) fn new() -> Self {
        let (fallback, kind) = (Fallback::Stop, StepKind::EnergyPreserving);
        Self { bounds: None, fallback, phase: None, switches: Switches::default(), kind }
    }

    /// The error if a step of the length `found` is beyond the bounds.
    #[inline]
    pub(crate) fn check_bounds(&self, t: T, found: T) -> Result<(), StepError> {
        match &self.bounds {
            Some(bounds) if !bounds.admit(found) => Err(bounds.refusal(t, found)),
            _ => Ok(()),
        }
    }

    /// Whether a step is so much longer than the last one that D is about to vanish, and the user wants no such step.
    #[inline]
    pub(crate) fn runs_away(&self, last: T, found: T) -> bool {
        self.fallback == Fallback::FixedSteps && found > last * T::real(GROWTH)
    }

    /// The longest that the step after one of the length `last` can be, by the factor that is allowed or as a fixed step of the bound.
    pub(crate) fn longest(&self, last: T) -> T {
        let shortest = self.bounds.as_ref().map_or(T::zero(), |bounds| bounds.h_min);
        shortest.max(last * T::real(RATIO))
    }

    /// Discrete energy of the last step, less the energy that the node carries.
    pub(crate) fn gap(&self) -> T {
        self.phase.as_ref().map_or(T::zero(), |phase| phase.gap)
    }

    /// Whether a step can follow: a file may hold anything.
    ///
    /// # Errors
    /// [`StepError::NonFinite`], [`StepError::InvalidInput`].
    pub(crate) fn check(&self, t: f64) -> Result<(), StepError> {
        let Switches { energy_change, energy_cost, .. } = self.switches;
        if !(energy_change.is_finite() && energy_cost.is_finite()) {
            return Err(StepError::NonFinite { t, quantity: "energy of the switches", expression: None });
        }
        self.bounds.as_ref().map_or(Ok(()), StepBounds::check)?;
        self.phase.as_ref().map_or(Ok(()), Phase::check)
    }
}

/// The memory of a method that finds the length of its steps.
pub trait Controlled<T>: Memory {
    /// Its options and counters.
    fn control(&self) -> &Control<T>;
    /// The same, to be changed.
    fn control_mut(&mut self) -> &mut Control<T>;
}

/// A run at a node, by a method that finds the length of its steps.
pub(crate) trait Alternating<T: Scalar> {
    /// The step law is `h |D|^(1/POWER) = constant`.
    const POWER: f64;
    /// A step.
    type Found;

    fn control(&self) -> &Control<T>;
    /// Time of the node.
    fn t(&self) -> T;
    /// Length of the last step, and D there.
    fn last(&self) -> [T; 2];
    /// The energy-preserving step within the bounds, of the energy that the node carries and `gap`, and its length.
    fn preserving(&self, gap: T) -> Result<(Self::Found, T), StepError>;
    /// The step of a given length; the discrete energy there less that of the node; and D in the middle of the step after it, extrapolated.
    fn fixed(&self, h: T) -> Result<(Self::Found, [T; 2]), StepError>;
    fn control_of(found: &mut Self::Found) -> &mut Control<T>;

    /// The next step: energy-preserving, or fixed if there is none and the user allows it.
    ///
    /// # Errors
    /// Why there is neither.
    fn next(&self) -> Result<Self::Found, StepError> {
        if let Some(phase) = self.control().phase {
            return self.next_in(phase);
        }
        let [previous, density] = self.last();
        let preserving = self.preserving(T::zero()).and_then(|(found, h)| {
            if !self.control().runs_away(previous, h) {
                return Ok(found);
            }
            let (t, previous, found) = (self.t().to_f64(), previous.to_f64(), h.to_f64());
            Err(StepError::StepRatio { t, previous, found })
        });
        let failure = match preserving {
            Ok(mut found) => {
                Self::control_of(&mut found).kind = StepKind::EnergyPreserving;
                return Ok(found);
            }
            Err(failure) => failure,
        };
        let Control { fallback, bounds, .. } = self.control();
        let phase = Phase::instead_of(failure, *fallback, bounds.as_ref(), previous, density)?;
        let mut found = self.fixed_in(phase)?;
        Self::control_of(&mut found).switches.count += 1;
        Ok(found)
    }

    /// The step after a fixed one: energy-preserving if one exists, by the energy of before or, else, by that of the last step; else fixed.
    #[cold]
    fn next_in(&self, phase: Phase<T>) -> Result<Self::Found, StepError> {
        if !phase.is_over(Self::POWER) {
            return self.fixed_in(phase);
        }
        let reseeded = StepKind::Reseeded { energy_change: phase.gap };
        for (gap, kind) in [(T::zero(), StepKind::EnergyPreserving), (phase.gap, reseeded)] {
            if let Ok((mut found, _)) = self.preserving(gap) {
                let control = Self::control_of(&mut found);
                control.kind = kind;
                control.phase = None;
                control.switches.returns += 1;
                if kind == reseeded {
                    control.switches.reseed(gap);
                }
                return Ok(found);
            }
        }
        self.fixed_in(phase)
    }

    /// A fixed step of a phase.
    fn fixed_in(&self, phase: Phase<T>) -> Result<Self::Found, StepError> {
        let (mut found, [gap, density_next]) = self.fixed(phase.h)?;
        let control = Self::control_of(&mut found);
        control.kind = StepKind::FixedStep;
        control.phase = Some(Phase { density_next, gap, ..phase });
        control.switches.fixed_steps += 1;
        Ok(found)
    }
}

impl<M, S, const N: usize, T: Scalar> Run<M, S, N, T>
where
    M: Method<S, N, T, Memory: Controlled<T>>,
    S: Lagrangian<N, T> + Copy,
{
    /// What to do if no energy-preserving step exists; [`Fallback::Stop`] is the default. An error of the last step is forgotten.
    ///
    /// With [`Fallback::FixedSteps`] the errors [`StepError::NoForwardStep`], [`StepError::NoForwardGaussStep`], [`StepError::DegenerateStep`],
    /// [`StepError::StepRatio`], [`StepError::StepBounds`], [`StepError::NotConverged`] and [`StepError::StagesUnsettled`] do not end the run. It continues with fixed
    /// steps while D has lost its sign or the step law asks for longer ones. Then it keeps the energy that it had before, or, if no step has that energy, the discrete
    /// energy of the last fixed step. A step longer than the last by more than a factor of 1.5 is not taken either: D is about to vanish. [`Run::step_kind`] says how
    /// the last step was found, and [`Run::switches`] what the switches cost.
    #[must_use]
    pub fn with_fallback(mut self, fallback: Fallback) -> Self {
        self.memory.control_mut().fallback = fallback;
        self.failure = None;
        self
    }

    /// Refuses steps shorter than `h_min` or longer than `h_max`, in units of time, with [`StepError::StepBounds`], or, with the fallback, replaces them by fixed steps
    /// of the bound. `h_min = 0` bounds from above alone. An error of the last step is forgotten.
    ///
    /// The first step differs from the given one by a factor of 3 at most: bounds that leave no such step end the run at once.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] unless `0 ≤ h_min ≤ h_max`, with `h_max` positive and finite.
    pub fn with_step_bounds(mut self, h_min: T, h_max: T) -> Result<Self, StepError> {
        let bounds = StepBounds { h_min, h_max };
        bounds.check()?;
        self.memory.control_mut().bounds = Some(bounds);
        self.failure = None;
        Ok(self)
    }

    /// How the last step was found.
    pub fn step_kind(&self) -> StepKind<T> {
        self.memory.control().kind
    }

    /// How often the run has switched to fixed steps and back, and what that cost.
    pub fn switches(&self) -> Switches<T> {
        self.memory.control().switches
    }
}

/// Fixed steps under way.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Phase<T> {
    /// Their length.
    pub(crate) h: T,
    /// Whether the energy-preserving step would be shorter than they are, rather than longer or absent.
    pub(crate) shorter: bool,
    /// Length of the last energy-preserving step.
    pub(crate) law_h: T,
    /// D of its interval.
    pub(crate) law_density: T,
    /// D in the middle of the next interval, extrapolated.
    pub(crate) density_next: T,
    /// Discrete energy of the last fixed interval less the energy that the node carries.
    pub(crate) gap: T,
}

impl<T: Scalar> Phase<T> {
    /// The fixed steps that begin instead of a step that failed, where the user allows them: after one of the length `h`, in an interval of the density
    /// `density`.
    ///
    /// # Errors
    /// The failure, where they are not allowed, or would fail too.
    pub(crate) fn instead_of(
        failure: StepError,
        fallback: Fallback,
        bounds: Option<&StepBounds<T>>,
        h: T,
        density: T,
    ) -> Result<Self, StepError> {
        let bounded = |h: T| bounds.map_or(h, |bounds| bounds.clamp(h));
        let (length, shorter) = match (fallback, failure) {
            (Fallback::Stop, _)
            | (
                _,
                StepError::Singular { .. }
                | StepError::NonFinite { .. }
                | StepError::InvalidInput { .. }
                | StepError::ShiftTooLarge { .. },
            ) => return Err(failure),
            (_, StepError::StepBounds { found, h_min, .. }) => (bounded(T::real(found)), found < h_min),
            _ => (bounded(h), false),
        };
        Ok(Self { h: length, shorter, law_h: h, law_density: density, density_next: density, gap: T::zero() })
    }

    pub(crate) fn check(&self) -> Result<(), StepError> {
        check_forward("the fixed step h", self.h)?;
        check_forward("the last energy-preserving step h", self.law_h)?;
        let numbers = [self.law_density, self.density_next, self.gap];
        match numbers.iter().find(|number| !number.is_finite()) {
            Some(number) => {
                let (input, allowed) = ("a number of the fixed steps under way", "finite");
                Err(StepError::InvalidInput { input, allowed, value: number.to_f64() })
            }
            None => Ok(()),
        }
    }

    /// Whether the step law asks for the fixed length in the next interval, or one beyond on the side of the
    /// energy-preserving steps. The law is `h |D|^(1/power) = constant`.
    pub(crate) fn is_over(&self, power: f64) -> bool {
        let ratio = self.law_density.to_f64() / self.density_next.to_f64();
        let h = self.law_h.to_f64() * ratio.powf(power.recip());
        let fixed = self.h.to_f64();
        ratio > 0.0 && if self.shorter { h >= fixed } else { h <= fixed }
    }
}

/// The step of a method that finds its length.
pub(super) const FORWARD: &str = "the step h of a method that only goes forward in time";

/// A step must lead forward.
pub(crate) fn check_forward<T: Scalar>(input: &'static str, h: T) -> Result<(), StepError> {
    let value = h.to_f64();
    if value.is_normal() && value > 0.0 {
        Ok(())
    } else {
        Err(StepError::InvalidInput { input, allowed: "positive, finite and not subnormal", value })
    }
}
