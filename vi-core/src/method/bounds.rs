//! Step bounds, and the fallback if no energy-preserving step exists.
//!
//! [`Fallback::Stop`] returns the typed error. [`Fallback::FixedSteps`] takes fixed steps of the momentum equation
//! alone, until an energy-preserving step exists again. Steps exist while the step density D keeps its sign, and follow
//! the law `h |D|^(1/3) = C`. Therefore the fixed steps use
//!
//! ```text
//! length  h_f = h of the last energy-preserving step, or the bound that the next one would have broken
//! end     D has its sign again, and the law requires h_f in the next interval, or less: C/|D|^(1/3) ≤ h_f
//! energy  E changes by the work only; if no step has this energy, E is seeded anew with
//!         −D3 L_d − g_d⁺ of the last fixed interval
//! ```
//!
//! Without force, fixed steps preserve `E + h² D/12` to order h⁴. They begin at (h_f, D_0) and end at about the same,
//! so that E returns. An interval with D instead of D_0 is off by `h_f² (D_0 − D)/12`. Then `H − E = h_f² (D/24 +
//! D_0/12)` has the sign of D, so that the step with the previous energy exists. Near D = 0 each step is longer than
//! the last by a growing factor. Fixed steps begin when it exceeds `GROWTH`, about half a step before the zero, which
//! keeps h_f below the length of that last step. Across a switch q, p and t are continuous.

use super::{Memory, Method};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::real::Scalar;
use crate::run::Run;
use crate::state::StepKind;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Largest factor between the lengths of two consecutive steps.
pub(crate) const RATIO: f64 = 3.0;
/// Largest growth factor of a step with the fallback: for D falling linearly to zero, the step law reaches it at the
/// distance of 0.7 h.
pub(crate) const GROWTH: f64 = 1.5;

/// The reaction of an energy-preserving run if no energy-preserving step exists, or none within its bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Fallback {
    /// Returns the error and ends the run.
    #[default]
    Stop,
    /// Takes fixed steps until D has its sign back and an energy-preserving step exists.
    FixedSteps,
}

/// Counters and energy changes of the switches between energy-preserving and fixed steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Switches<T = f64> {
    /// Number of switches to fixed steps.
    pub count: u64,
    /// Number of returns to energy-preserving steps.
    pub returns: u64,
    /// Number of returns with a reseeded energy.
    pub reseeds: u64,
    /// Number of fixed steps.
    pub fixed_steps: u64,
    /// Sum of the jumps of the discrete energy.
    pub energy_change: T,
    /// Sum of their absolute values.
    pub energy_cost: T,
}

impl<T: Scalar> Switches<T> {
    /// Counts a reseeded energy and its change.
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

/// Options and counters of a run whose steps find their length.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Control<T = f64> {
    pub(crate) bounds: Option<StepBounds<T>>,
    pub(crate) fallback: Fallback,
    /// The current fixed steps.
    pub(crate) phase: Option<FixedPhase<T>>,
    pub(crate) switches: Switches<T>,
    /// The kind of the last step.
    pub(crate) kind: StepKind<T>,
}

impl<T: Scalar> Control<T> {
    /// No bounds, no fallback.
    pub(crate) fn new() -> Self {
        let (fallback, kind) = (Fallback::Stop, StepKind::EnergyPreserving);
        Self { bounds: None, fallback, phase: None, switches: Switches::default(), kind }
    }

    /// The error if a step of the length `found` violates the bounds.
    #[inline]
    pub(crate) fn check_bounds(&self, t: T, found: T) -> Result<(), StepError> {
        match &self.bounds {
            Some(bounds) if !bounds.admit(found) => Err(bounds.refusal(t, found)),
            _ => Ok(()),
        }
    }

    /// Whether the user excludes this step because its growth shows that D is about to vanish.
    #[inline]
    pub(crate) fn runs_away(&self, last: T, found: T) -> bool {
        self.fallback == Fallback::FixedSteps && found > last * T::real(GROWTH)
    }

    /// Upper bound of the step after one of the length `last`, by the allowed factor or as a fixed step of the bound.
    pub(crate) fn longest(&self, last: T) -> T {
        let shortest = self.bounds.as_ref().map_or(T::zero(), |bounds| bounds.h_min);
        shortest.max(last * T::real(RATIO))
    }

    /// Discrete energy of the last step minus the energy of the node.
    pub(crate) fn gap(&self) -> T {
        self.phase.as_ref().map_or(T::zero(), |phase| phase.gap)
    }

    /// Checks stored data. A file may contain any numbers.
    ///
    /// # Errors
    /// [`StepError::NonFinite`], [`StepError::InvalidInput`].
    pub(crate) fn check(&self, t: f64) -> Result<(), StepError> {
        let Switches { energy_change, energy_cost, .. } = self.switches;
        if !(energy_change.is_finite() && energy_cost.is_finite()) {
            return Err(StepError::NonFinite { t, quantity: "energy of the switches", expression: None });
        }
        self.bounds.as_ref().map_or(Ok(()), StepBounds::check)?;
        self.phase.as_ref().map_or(Ok(()), FixedPhase::check)
    }
}

/// The memory of a method that finds the length of its steps.
pub trait Controlled<T>: Memory {
    /// Its options and counters.
    fn control(&self) -> &Control<T>;
    /// Its options and counters, mutably.
    fn control_mut(&mut self) -> &mut Control<T>;
}

/// A run at a node, by a method that finds the length of its steps.
pub(crate) trait Alternating<T: Scalar> {
    /// The step law is `h |D|^(1/POWER) = constant`.
    const POWER: f64;
    /// A step.
    type StepSolution;

    fn control(&self) -> &Control<T>;
    /// Time of the node.
    fn t(&self) -> T;
    /// Length of the last step, and D there.
    fn last(&self) -> [T; 2];
    /// The energy-preserving step within the bounds for the energy of the node plus `gap`, and its length.
    fn preserving(&self, gap: T) -> Result<(Self::StepSolution, T), StepError>;
    /// The step of a given length; its discrete energy minus that of the node; and the extrapolated D at the middle of
    /// the step after it.
    fn fixed(&self, h: T) -> Result<(Self::StepSolution, [T; 2]), StepError>;
    fn control_of(found: &mut Self::StepSolution) -> &mut Control<T>;

    /// The next step: energy-preserving, or fixed if there is none and the user allows it.
    ///
    /// # Errors
    /// The reason why both fail.
    fn next(&self) -> Result<Self::StepSolution, StepError> {
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
        let phase = FixedPhase::instead_of(failure, *fallback, bounds.as_ref(), previous, density)?;
        let mut found = self.fixed_in(phase)?;
        Self::control_of(&mut found).switches.count += 1;
        Ok(found)
    }

    /// The step after a fixed one: energy-preserving by the previous energy, otherwise by that of the last step,
    /// otherwise fixed.
    #[cold]
    fn next_in(&self, phase: FixedPhase<T>) -> Result<Self::StepSolution, StepError> {
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
    fn fixed_in(&self, phase: FixedPhase<T>) -> Result<Self::StepSolution, StepError> {
        let (mut found, [gap, density_next]) = self.fixed(phase.h)?;
        let control = Self::control_of(&mut found);
        control.kind = StepKind::FixedStep;
        control.phase = Some(FixedPhase { density_next, gap, ..phase });
        control.switches.fixed_steps += 1;
        Ok(found)
    }
}

impl<M, S, const N: usize, T: Scalar> Run<M, S, N, T>
where
    M: Method<S, N, T, Memory: Controlled<T>>,
    S: Lagrangian<N, T> + Copy,
{
    /// Sets the reaction if no energy-preserving step exists; [`Fallback::Stop`] is the default. The run clears an
    /// error of the last step.
    ///
    /// With [`Fallback::FixedSteps`] the errors [`StepError::NoForwardStep`], [`StepError::NoForwardGaussStep`],
    /// [`StepError::DegenerateStep`], [`StepError::StepRatio`], [`StepError::StepBounds`], [`StepError::NotConverged`],
    /// [`StepError::StagesNotConverged`] and [`StepError::TooLong`] do not end the run. It continues with fixed steps while D has the wrong sign
    /// or the step law requires longer ones. Then it preserves the previous energy or, if no step has that energy, the
    /// discrete energy of the last fixed step. It also replaces a step that exceeds the last one by more than a factor
    /// of 1.5, because D is about to vanish. [`Run::step_kind`] returns the kind of the last step, and
    /// [`Run::switches`] the counters.
    #[must_use]
    pub fn with_fallback(mut self, fallback: Fallback) -> Self {
        self.memory.control_mut().fallback = fallback;
        self.failure = None;
        self
    }

    /// Sets bounds of the step length, in units of time. A step shorter than `h_min` or longer than `h_max` is
    /// [`StepError::StepBounds`], or, with the fallback, a fixed step of the bound.
    ///
    /// `h_min = 0` bounds from above only. The run clears an error of the last step. The first step differs from the
    /// given length by a factor of at most 3; bounds that exclude all of these end the run at once.
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

    /// The kind of the last step.
    pub fn step_kind(&self) -> StepKind<T> {
        self.memory.control().kind
    }

    /// Counters of the switches to fixed steps and back, with their energy changes.
    pub fn switches(&self) -> Switches<T> {
        self.memory.control().switches
    }
}

/// A phase of fixed steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct FixedPhase<T> {
    /// Length of these steps.
    pub(crate) h: T,
    /// Whether the energy-preserving step would be shorter than these, rather than longer or absent.
    pub(crate) shorter: bool,
    /// Length of the last energy-preserving step.
    pub(crate) law_h: T,
    /// D of its interval.
    pub(crate) law_density: T,
    /// D at the middle of the next interval, extrapolated.
    pub(crate) density_next: T,
    /// Discrete energy of the last fixed interval minus the energy of the node.
    pub(crate) gap: T,
}

impl<T: Scalar> FixedPhase<T> {
    /// The phase of fixed steps that replaces a failed step, if the user allows it. `h` is the length and `density` the
    /// density of the last interval.
    ///
    /// # Errors
    /// The failure, if fixed steps are not allowed or would fail too.
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
                | StepError::Undefined { .. }
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
                let (input, allowed) = ("a number of the current fallback", "finite");
                Err(StepError::InvalidInput { input, allowed, value: number.to_f64() })
            }
            None => Ok(()),
        }
    }

    /// Whether the step law `h |D|^(1/power) = constant` requires the fixed length in the next interval, or one beyond
    /// it on the side of the energy-preserving steps.
    pub(crate) fn is_over(&self, power: f64) -> bool {
        let ratio = self.law_density.to_f64() / self.density_next.to_f64();
        let h = self.law_h.to_f64() * ratio.powf(power.recip());
        let fixed = self.h.to_f64();
        ratio > 0.0 && if self.shorter { h >= fixed } else { h <= fixed }
    }
}

/// Largest difference, in `H − E`, of the energies of a run and of another one that starts in the same state by the same
/// length.
const ALIKE: f64 = 0.5;
/// Halvings of a length after which no step follows.
const HALVINGS: i32 = 16;

/// A run that starts from the node with some length: its energy, and whether it takes a step.
pub(super) struct FirstStep {
    pub(super) energy: f64,
    pub(super) exists: bool,
}

/// The error if the first step after one of the length h fails: [`StepError::TooLong`] if a run that `starts` from the
/// node with a shorter length takes a step. A run that continues with an energy of its own cannot begin anew: its
/// `energies`, E and H − E, are not those of a start.
#[cold]
pub(super) fn too_long(
    failure: StepError,
    ([t, h], energies): ([f64; 2], [f64; 2]),
    mut starts: impl FnMut(f64) -> Option<FirstStep>,
) -> StepError {
    let may_be_too_long = matches!(
        failure,
        StepError::NoForwardStep { .. }
            | StepError::NoForwardGaussStep { .. }
            | StepError::NotConverged { .. }
            | StepError::StagesNotConverged { .. }
    );
    let [energy, excess] = energies;
    let is_alike = |start: FirstStep| (start.energy - energy).abs() <= ALIKE * excess.abs();
    if !may_be_too_long || !starts(h).is_some_and(is_alike) {
        return failure;
    }
    let mut shorter = (1..=HALVINGS).map(|halved| h * 0.5_f64.powi(halved));
    match shorter.find(|shorter| starts(*shorter).is_some_and(|start| start.exists)) {
        Some(longest) => StepError::TooLong { t, h, longest },
        None => failure,
    }
}

/// The step of a method that finds its length.
pub(super) const FORWARD: &str = "the step h of a method that only goes forward in time";

/// Checks that a step leads forward.
pub(crate) fn check_forward<T: Scalar>(input: &'static str, h: T) -> Result<(), StepError> {
    let value = h.to_f64();
    if value.is_normal() && value > 0.0 {
        Ok(())
    } else {
        Err(StepError::InvalidInput { input, allowed: "positive, finite and not subnormal", value })
    }
}
