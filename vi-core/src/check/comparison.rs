//! Numbers, compared and counted.
//!
//! In: pairs of numbers, each with the bound of its own rounding. Out: a [`Report`]; or at the first pair that differs by
//! more than both bounds, or where a quantity that matters did not stand above rounding anywhere, a [`CheckFailure`].

use super::bounded::Bounded;
use super::report::{CheckFailure, Report};
use crate::error::StepError;
use nalgebra::SVector;
use std::collections::BTreeMap;

/// Pairs of numbers of one check.
pub(super) struct Comparison {
    system: &'static str,
    check: &'static str,
    /// How many numbers above their rounding each quantity had.
    seen: BTreeMap<&'static str, usize>,
    what: String,
    worst: f64,
}

impl Comparison {
    pub(super) fn new(system: &'static str, check: &'static str) -> Self {
        Self { system, check, seen: BTreeMap::new(), what: String::new(), worst: 0.0 }
    }

    /// Two numbers.
    pub(super) fn number(&mut self, what: &'static str, found: Bounded, wanted: Bounded) -> Result<(), CheckFailure> {
        self.entry(what, None, found, wanted)
    }

    /// Two vectors, entry by entry.
    pub(super) fn vector<const N: usize>(
        &mut self,
        what: &'static str,
        found: &SVector<Bounded, N>,
        wanted: &SVector<Bounded, N>,
    ) -> Result<(), CheckFailure> {
        let mut pairs = found.iter().zip(wanted.iter()).enumerate();
        pairs.try_for_each(|(index, (found, wanted))| self.entry(what, Some(index), *found, *wanted))
    }

    fn entry(
        &mut self,
        what: &'static str,
        index: Option<usize>,
        found: Bounded,
        wanted: Bounded,
    ) -> Result<(), CheckFailure> {
        let difference = (found.value - wanted.value).abs();
        let allowed = found.error + wanted.error;
        *self.seen.entry(what).or_default() += usize::from(wanted.value.abs() > allowed);
        let name = || index.map_or_else(|| what.to_owned(), |index| format!("{what}[{index}]"));
        // The check's own derivatives: the system may have a number all the same.
        if wanted.value.is_nan() && !found.value.is_nan() {
            let why = "has no derivative that can be computed here, at the edge of a root, a quotient or a kink";
            return Err(self.vacuous(format!("{} {why}; choose another place", name())));
        }
        // Not a number agrees with nothing; where no bound is known, nothing is said.
        if difference.is_nan() || difference > allowed {
            return Err(self.differs(name(), [found.value, wanted.value], difference, allowed));
        }
        let part = if difference == 0.0 { 0.0 } else { difference / allowed };
        if part > self.worst || self.what.is_empty() {
            (self.worst, self.what) = (part, name());
        }
        Ok(())
    }

    /// The failure of this check by these numbers, the one found and the one wanted.
    pub(super) fn differs(
        &self,
        what: String,
        [found, wanted]: [f64; 2],
        difference: f64,
        tolerance: f64,
    ) -> CheckFailure {
        CheckFailure::Differs { system: self.system, check: self.check, what, found, wanted, difference, tolerance }
    }

    /// The failure of this check for want of numbers.
    pub(super) fn vacuous(&self, why: impl Into<String>) -> CheckFailure {
        CheckFailure::Vacuous { system: self.system, check: self.check, why: why.into() }
    }

    /// The failure of this check by steps that are all rounding.
    pub(super) fn too_small(&self, what: &'static str, needed: Option<f64>, why: String) -> CheckFailure {
        CheckFailure::StepTooSmall { system: self.system, check: self.check, what, needed, why }
    }

    /// The failure of this check by a step.
    pub(super) fn step(&self, error: StepError) -> CheckFailure {
        CheckFailure::Step { system: self.system, check: self.check, error }
    }

    /// The failure of this check for a system that it is not about.
    pub(super) fn not_applicable(&self, why: &'static str) -> CheckFailure {
        CheckFailure::NotApplicable { system: self.system, check: self.check, why }
    }

    /// A slope or another single number, fitted through so many points.
    pub(super) fn fitted(&self, compared: usize, what: String, worst: f64, tolerance: f64) -> Report {
        Report { system: self.system, check: self.check, compared, what, worst, tolerance }
    }

    /// The report, if each of the quantities needed stood above its rounding somewhere.
    pub(super) fn finish(self, needed: &[&'static str]) -> Result<Report, CheckFailure> {
        let count = |what: &str| self.seen.get(what).copied().unwrap_or_default();
        if let Some(zero) = needed.iter().find(|what| count(what) == 0) {
            return Err(self.vacuous(format!("{zero} is zero wherever it was compared; choose another place")));
        }
        let compared = self.seen.values().sum();
        if compared == 0 {
            return Err(self.vacuous("everything that was compared is zero; choose another place"));
        }
        let (what, worst) = (self.what.clone(), self.worst);
        Ok(self.fitted(compared, what, worst, 1.0))
    }
}
