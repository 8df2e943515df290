//! Results of checks.

use crate::error::StepError;
use alloc::string::String;
use core::fmt;

/// A check that passed, with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The system.
    pub system: &'static str,
    /// The check.
    pub check: &'static str,
    /// Number of compared values above their rounding errors; for a slope, the number of fitted points.
    pub compared: usize,
    /// Quantity with the worst difference.
    pub what: String,
    /// The worst difference, relative to its tolerance; for a slope, its shortfall.
    pub worst: f64,
    /// The tolerance: 1, or for a slope the allowed shortfall.
    pub tolerance: f64,
}

/// The reason why a check failed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CheckFailure {
    /// Two numbers differ that should agree.
    Differs {
        /// The system.
        system: &'static str,
        /// The check.
        check: &'static str,
        /// Name of the number.
        what: String,
        /// Value of the system.
        found: f64,
        /// Value of the check.
        wanted: f64,
        /// The difference of both values; for a slope, its shortfall.
        difference: f64,
        /// The tolerance: the sum of both rounding-error bounds.
        tolerance: f64,
    },
    /// Nothing was compared, or only zeros, which proves nothing.
    Vacuous {
        /// The system.
        system: &'static str,
        /// The check.
        check: &'static str,
        /// The missing quantity, with advice.
        why: String,
    },
    /// The step is so small that rounding dominates the tested quantity, and larger steps, which the check tried, did
    /// not help. This proves nothing, so it is a failure.
    StepTooSmall {
        /// The system.
        system: &'static str,
        /// The check.
        check: &'static str,
        /// The tested quantity.
        what: &'static str,
        /// A sufficient step, extrapolated from the largest one tried, in units of time; `None` if it is far beyond the
        /// time scale of the system, so that only another place can help.
        needed: Option<f64>,
        /// The steps tried, and the obstacle to larger ones.
        why: String,
    },
    /// The system lacks the tested property.
    NotApplicable {
        /// The system.
        system: &'static str,
        /// The check.
        check: &'static str,
        /// The reason.
        why: &'static str,
    },
    /// A step of the check failed.
    Step {
        /// The system.
        system: &'static str,
        /// The check.
        check: &'static str,
        /// The error of the step.
        error: StepError,
    },
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { system, check, compared, what, worst, tolerance } = self;
        write!(
            f,
            "{system}, {check}: {compared} numbers compared, worst difference {worst:.1e} in {what}, allowed {tolerance:.1e}"
        )
    }
}

impl fmt::Display for CheckFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Differs { system, check, what, found, wanted, difference, tolerance } => write!(
                f,
                "{system}, {check}: {what} is {found:e} instead of {wanted:e}, off by {difference:.1e} (allowed {tolerance:.1e})"
            ),
            Self::Vacuous { system, check, why } => write!(f, "{system}, {check}: proves nothing, {why}"),
            Self::StepTooSmall { system, check, what, needed, why } => {
                write!(f, "{system}, {check}: h is too small to see {what} above rounding, {why}; ")?;
                match needed {
                    Some(h) => write!(f, "try h = {h:.0e}, or another place"),
                    None => write!(f, "try another place"),
                }
            }
            Self::NotApplicable { system, check, why } => write!(f, "{system}, {check}: does not apply, {why}"),
            Self::Step { system, check, error } => write!(
                f,
                "{system}, {check}: {}; try a place at which D keeps its sign, or a shorter h",
                error.reason()
            ),
        }
    }
}

impl core::error::Error for CheckFailure {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Step { error, .. } => Some(error),
            _ => None,
        }
    }
}
