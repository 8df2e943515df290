//! The built-in rules: named maps from L to L_d.
//!
//! A rule is one line in the language itself with its known properties. Its slot derivatives, discrete forces and
//! equations are derived like those of a user's rule. Messages, generated checks and emitted implementations read this
//! table: a new rule is a new entry.

/// A built-in rule.
#[derive(Debug, PartialEq, Eq)]
pub struct NamedRule {
    /// Its name in the language: `discretize midpoint;`.
    pub name: &'static str,
    /// Its marker in `vi_core::rules`.
    pub marker: &'static str,
    /// Its lines, as a user would write them.
    pub text: &'static str,
    /// The order of its fixed steps in h.
    pub order: u32,
    /// It evaluates L at the ends of the step. Steps are then explicit if `L = v·Mv/2 − V(t, q)` with constant M and f is
    /// free of v.
    pub at_ends: bool,
    /// Self-adjoint: a step back undoes a step.
    pub symmetric: bool,
    /// The step density of the continuous system is that of its steps and determines the length of energy-preserving
    /// steps. The step density of the trapezoidal rule is `|V_q|² − 2 v·V_qq v`, which changes sign in every
    /// oscillation.
    pub step_density: bool,
}

/// All built-in rules; messages recommend the first one.
///
/// ```text
/// midpoint       L_d = h L(t̄, q̄, v)                           with t̄ = (t0+t1)/2, q̄ = (q0+q1)/2, v = (q1−q0)/h
/// trapezoidal    L_d = (h/2) (L(t0, q0, v) + L(t1, q1, v))
/// ```
///
/// The trapezoidal rule is explicit if L = v·Mv/2 − V(t, q) with constant M and f is free of v: Störmer–Verlet.
pub const RULES: [NamedRule; 2] = [
    NamedRule {
        name: "midpoint",
        marker: "Midpoint",
        text: "Ld = h * L((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);",
        order: 2,
        at_ends: false,
        symmetric: true,
        step_density: true,
    },
    NamedRule {
        name: "trapezoidal",
        marker: "Trapezoidal",
        text: "Ld = h/2 * (L(t0, q0, (q1 - q0)/h) + L(t1, q1, (q1 - q0)/h));",
        order: 2,
        at_ends: true,
        symmetric: true,
        step_density: false,
    },
];

/// The list name for Gauss steps, which every system has: it adds no rule.
pub const GAUSS: &str = "gauss";

/// The order assumed for a rule outside the table, which is not assumed symmetric.
pub const LEAST_ORDER: u32 = 1;

/// The rule with this name.
#[must_use]
pub fn named(name: &str) -> Option<&'static NamedRule> {
    RULES.iter().find(|rule| rule.name == name)
}

/// The names that `discretize` takes.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    [GAUSS].into_iter().chain(RULES.iter().map(|rule| rule.name))
}

/// The names that `discretize` takes, separated by commas.
pub(crate) fn list() -> String {
    names().collect::<Vec<_>>().join(", ")
}
