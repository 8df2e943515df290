//! The end of a run in a sweep.

use vi_core::StepError;

/// The end of a run: an index of [`Ending::WORDS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ending(u8);

impl Ending {
    pub(super) const WORDS: [&str; 17] = [
        "reached its end",
        "no forward step",
        "degenerate step",
        "step ratio",
        "step bounds",
        "not converged",
        "stages unsettled",
        "time scale",
        "singular matrix",
        "not finite",
        "wrong input",
        "steps became too short",
        "section not found",
        "another failure",
        "inconsistent start",
        "redundant constraints",
        "step too long",
    ];
    pub(super) const REACHED: Self = Self(0);
    pub(super) const WRONG_INPUT: Self = Self(10);
    /// The steps became too short to reach the end.
    pub(super) const TOO_SHORT: Self = Self(11);
    /// The run reached its end, but some crossings could not be located.
    pub(super) const NO_SECTION: Self = Self(12);

    /// The ending for a failed step.
    pub(super) fn of(error: StepError) -> Self {
        Self(match error {
            StepError::NoForwardStep { .. } | StepError::NoForwardGaussStep { .. } => 1,
            StepError::DegenerateStep { .. } => 2,
            StepError::StepRatio { .. } => 3,
            StepError::StepBounds { .. } => 4,
            StepError::NotConverged { .. } => 5,
            StepError::StagesUnsettled { .. } => 6,
            StepError::TimeScale { .. } => 7,
            StepError::Singular { .. } => 8,
            StepError::NonFinite { .. } | StepError::Undefined { .. } => 9,
            StepError::InvalidInput { .. } => 10,
            StepError::InconsistentStart { .. } => 14,
            StepError::Redundant { .. } => 15,
            StepError::TooLong { .. } => 16,
            _ => 13,
        })
    }

    /// Its index among the words.
    pub(super) fn number(self) -> f64 {
        f64::from(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_places_of_words() {
        let word = |ending: Ending| Ending::WORDS[usize::from(ending.0)];
        let singular = StepError::Singular { t: 0.0, matrix: "mass matrix" };
        let other = StepError::OtherSystem { system: "", parameter: None, stored: 0.0, given: 0.0 };
        let endings = [Ending::REACHED, Ending::WRONG_INPUT, Ending::TOO_SHORT, Ending::NO_SECTION];
        let words = ["reached its end", "wrong input", "steps became too short", "section not found"];
        assert_eq!(endings.map(word), words);
        let long = StepError::TooLong { t: 0.0, h: 2.0, longest: 1.0 };
        let of_errors = [singular, other, long].map(|error| word(Ending::of(error)));
        assert_eq!(of_errors, ["singular matrix", "another failure", "step too long"]);
    }
}
