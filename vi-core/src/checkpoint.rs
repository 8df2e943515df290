//! What a run carries, with the system that it is of.
//!
//! In: a system and its run, between two steps. Out: a [`Checkpoint`] that may be stored, with the feature `serde` in any format
//! that keeps numbers exactly (`serde_json` with its feature `float_roundtrip`), and the run again. AFTER A RESTART every number of
//! every further step, and every error, is bit for bit that of the run which was not interrupted. An error is not stored: the
//! restarted run meets it again, for the state before it is unchanged and nothing else enters.

use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::real::Scalar;

/// A run R between two steps, and which system by which rule it is of.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Checkpoint<R, T = f64> {
    system: String,
    /// None for the rule that the system is declared with, and for Gauss steps, which need none.
    #[cfg_attr(feature = "serde", serde(default))]
    rule: Option<String>,
    /// Names and values, in the order in which they are declared.
    parameters: Vec<(String, T)>,
    run: R,
}

impl<R, T: Scalar> Checkpoint<R, T> {
    /// The checkpoint of a run of `system` by a method whose rule has this name.
    pub(crate) fn of<const N: usize, S: Lagrangian<N, T>>(system: &S, rule: Option<&'static str>, run: R) -> Self {
        let named = S::PARAMETERS.iter().enumerate();
        let parameters = named.map(|(index, name)| ((*name).to_owned(), system.parameter(index))).collect();
        Self { system: S::NAME.to_owned(), rule: rule.map(str::to_owned), parameters, run }
    }

    /// The checkpoint of a part of the run, and the rest of it.
    pub(crate) fn split<P, Q>(self, parts: impl FnOnce(R) -> (P, Q)) -> (Checkpoint<P, T>, Q) {
        let Self { system, rule, parameters, run } = self;
        let (run, rest) = parts(run);
        (Checkpoint { system, rule, parameters, run }, rest)
    }

    /// The run, if it is one of this system by this rule with these parameters.
    pub(crate) fn run_of<const N: usize, S: Lagrangian<N, T>>(
        self,
        system: &S,
        rule: Option<&'static str>,
    ) -> Result<R, StepError> {
        let other = |parameter, stored, given| StepError::OtherSystem { system: S::NAME, parameter, stored, given };
        let names = self.parameters.iter().map(|(name, _)| name.as_str());
        if self.system != S::NAME || self.rule.as_deref() != rule || !names.eq(S::PARAMETERS.iter().copied()) {
            return Err(other(None, f64::NAN, f64::NAN));
        }
        for (index, (name, (_, stored))) in S::PARAMETERS.iter().zip(&self.parameters).enumerate() {
            let given = system.parameter(index);
            if *stored != given {
                return Err(other(Some(name), stored.to_f64(), given.to_f64()));
            }
        }
        Ok(self.run)
    }
}
