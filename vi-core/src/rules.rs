//! Markers of discretization rules, and a system by a rule that is not its own.
//!
//! The traits of a discrete system ([`DiscreteLagrangian`](crate::discrete::DiscreteLagrangian),
//! [`FixedStepping`](crate::stepping::FixedStepping), [`EnergyStepping`](crate::stepping::EnergyStepping)) are implemented once for
//! each rule that a system is declared with, told apart by the marker R. The integrators take steps by [`Own`], the first of them.

use core::fmt::Debug;
use core::ops::Deref;

/// A marker of a rule.
pub trait Rule: Copy + Debug + PartialEq + Send + Sync + 'static {}

/// The rule that a system is declared with; of several, the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Own;
/// The midpoint rule, declared after another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Midpoint;
/// The trapezoidal rule, declared after another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trapezoidal;

impl Rule for Own {}
impl Rule for Midpoint {}
impl Rule for Trapezoidal {}

/// A system whose own rule is R, one of the further rules that it is declared with:
/// `FixedStep::new(By::new(&system, Trapezoidal), state, h)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct By<S, R> {
    system: S,
    rule: R,
}

impl<S, R: Rule> By<S, R> {
    /// The system by this rule.
    pub fn new(system: S, rule: R) -> Self {
        Self { system, rule }
    }

    /// The system, by its own rule.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The same, to change its parameters.
    pub(crate) fn system_mut(&mut self) -> &mut S {
        &mut self.system
    }

    /// The rule.
    pub fn rule(&self) -> R {
        self.rule
    }
}

impl<S, R> Deref for By<S, R> {
    type Target = S;

    fn deref(&self) -> &S {
        &self.system
    }
}
