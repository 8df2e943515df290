//! What a check found.

use crate::error::StepError;
use core::fmt;

/// A check that passed, with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The system.
    pub system: &'static str,
    /// The check.
    pub check: &'static str,
    /// Numbers above their rounding that were compared; of a slope, the points that it was fitted through.
    pub compared: usize,
    /// Where the difference was worst.
    pub what: String,
    /// The worst difference, as a part of what rounding may do there; of a slope, what it falls short by.
    pub worst: f64,
    /// What would have been allowed: 1, or for a slope how much it may fall short by.
    pub tolerance: f64,
}

/// Why a check did not pass.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CheckFailure {
    /// Two numbers that should agree do not.
    Differs {
        /// The system.
        system: &'static str,
        /// The check.
        check: &'static str,
        /// Which number.
        what: String,
        /// As the system has it.
        found: f64,
        /// As the check has it.
        wanted: f64,
        /// Their difference; of a slope, what it falls short by.
        difference: f64,
        /// What would have been allowed: the bound of the rounding of both.
        tolerance: f64,
    },
    /// Nothing was compared, or only zeros: this proves nothing.
    Vacuous {
        /// The system.
        system: &'static str,
        /// The check.
        check: &'static str,
        /// What was missing, and what to do.
        why: String,
    },
    /// The step is so small that what the check is about is all rounding, and larger ones, which the check tried, did not
    /// help. This proves nothing, so it is a failure.
    StepTooSmall {
        /// The system.
        system: &'static str,
        /// The check.
        check: &'static str,
        /// What is to be seen.
        what: &'static str,
        /// The step with which it would be, by extrapolation from the largest one tried, in units of time; `None` where that is
        /// far beyond the time in which the system moves, and only another place will do.
        needed: Option<f64>,
        /// Which steps were tried, and what stood against larger ones.
        why: String,
    },
    /// The system has not the property that the check is about.
    NotApplicable {
        /// The system.
        system: &'static str,
        /// The check.
        check: &'static str,
        /// What stands against it.
        why: &'static str,
    },
    /// A step of the check was not taken.
    Step {
        /// The system.
        system: &'static str,
        /// The check.
        check: &'static str,
        /// Why.
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
                "{system}, {check}: {what} is {found:e} instead of {wanted:e}, off by {difference:.1e} where {tolerance:.1e} is allowed"
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
                "{system}, {check}: {}; a check needs steps: try another place, where D keeps its sign, or a shorter h",
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
