//! Comparison of numbers with rounding-error bounds.
//!
//! It collects pairs of numbers and returns a [`Report`], or a [`CheckFailure`] at the first pair that differs by more
//! than both bounds. It also fails if a required quantity never exceeded its rounding error.

use super::bounded::Bounded;
use super::report::{CheckFailure, Report};
use crate::error::StepError;
use alloc::borrow::ToOwned;
use alloc::collections::BTreeMap;
use alloc::string::String;
use nalgebra::SVector;

/// The compared pairs of one check.
pub(super) struct Comparison {
    system: &'static str,
    check: &'static str,
    /// For each quantity, how many numbers exceeded their rounding error.
    seen: BTreeMap<&'static str, usize>,
    what: String,
    worst: f64,
}

impl Comparison {
    pub(super) fn new(system: &'static str, check: &'static str) -> Self {
        Self { system, check, seen: BTreeMap::new(), what: String::new(), worst: 0.0 }
    }

    /// Compares two numbers.
    pub(super) fn number(&mut self, what: &'static str, found: Bounded, wanted: Bounded) -> Result<(), CheckFailure> {
        self.entry(what, None, found, wanted)
    }

    /// Compares two vectors, entry by entry.
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
        // The check's own derivative does not exist, although the system may have one.
        if wanted.value.is_nan() && !found.value.is_nan() {
            let why = "has no derivative here, at the edge of a root, a quotient or a kink";
            return Err(self.vacuous(format!("{} {why}; choose another place", name())));
        }
        // NaN agrees with nothing; an infinite bound allows everything.
        if difference.is_nan() || difference > allowed {
            return Err(self.differs(name(), [found.value, wanted.value], difference, allowed));
        }
        let part = if difference == 0.0 { 0.0 } else { difference / allowed };
        if part > self.worst || self.what.is_empty() {
            (self.worst, self.what) = (part, name());
        }
        Ok(())
    }

    /// Fails because two numbers differ.
    pub(super) fn differs(
        &self,
        what: String,
        [found, wanted]: [f64; 2],
        difference: f64,
        tolerance: f64,
    ) -> CheckFailure {
        CheckFailure::Differs { system: self.system, check: self.check, what, found, wanted, difference, tolerance }
    }

    /// Fails because nothing was compared.
    pub(super) fn vacuous(&self, why: impl Into<String>) -> CheckFailure {
        CheckFailure::Vacuous { system: self.system, check: self.check, why: why.into() }
    }

    /// Fails because all steps are dominated by rounding.
    pub(super) fn too_small(&self, what: &'static str, needed: Option<f64>, why: String) -> CheckFailure {
        CheckFailure::StepTooSmall { system: self.system, check: self.check, what, needed, why }
    }

    /// Fails because of a step.
    pub(super) fn step(&self, error: StepError) -> CheckFailure {
        CheckFailure::Step { system: self.system, check: self.check, error }
    }

    /// Fails because the check does not apply to the system.
    pub(super) fn not_applicable(&self, why: &'static str) -> CheckFailure {
        CheckFailure::NotApplicable { system: self.system, check: self.check, why }
    }

    /// Reports a slope or another single number, fitted through this many points.
    pub(super) fn fitted(&self, compared: usize, what: String, worst: f64, tolerance: f64) -> Report {
        Report { system: self.system, check: self.check, compared, what, worst, tolerance }
    }

    /// The report, if each required quantity exceeded its rounding error somewhere.
    pub(super) fn finish(self, needed: &[&'static str]) -> Result<Report, CheckFailure> {
        let count = |what: &str| self.seen.get(what).copied().unwrap_or_default();
        if let Some(zero) = needed.iter().find(|what| count(what) == 0) {
            return Err(self.vacuous(format!(
                "{zero} is zero, or below its rounding-error bound, in every comparison; choose another place"
            )));
        }
        let compared = self.seen.values().sum();
        if compared == 0 {
            return Err(self.vacuous("all compared numbers are zero; choose another place"));
        }
        let (what, worst) = (self.what.clone(), self.worst);
        Ok(self.fitted(compared, what, worst, 1.0))
    }
}
