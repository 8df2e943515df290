//! The rules that have a name: how L becomes L_d where the system does not write it out.
//!
//! A rule is one line in the language itself, and what is known of it. Its slot derivatives, its discrete forces and its equations are
//! derived from that line as from one that a user writes. The messages, the generated checks and the emitted implementations read this
//! table and no name: adding a rule is adding an entry.

/// A rule of the table.
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
    /// It is its own adjoint: a step back undoes a step.
    pub symmetric: bool,
    /// The step density of the continuous system is that of its steps, which gives energy-preserving steps their length. That of the
    /// trapezoidal rule is `|V_q|² − 2 v·V_qq v`, which changes its sign in every swing of an oscillator.
    pub step_density: bool,
}

/// All rules; the first is the one that messages recommend.
///
/// ```text
/// midpoint       L_d = h L(t̄, q̄, v)                           with t̄ = (t0+t1)/2, q̄ = (q0+q1)/2, v = (q1−q0)/h
/// trapezoidal    L_d = (h/2) (L(t0, q0, v) + L(t1, q1, v))
/// ```
///
/// The trapezoidal rule is explicit where L = v·Mv/2 − V(t, q) with constant M and f is free of v: Störmer–Verlet.
pub const RULES: [NamedRule; 2] = [
    NamedRule {
        name: "midpoint",
        marker: "Midpoint",
        text: "Ld = h * L((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);",
        order: 2,
        symmetric: true,
        step_density: true,
    },
    NamedRule {
        name: "trapezoidal",
        marker: "Trapezoidal",
        text: "Ld = h/2 * (L(t0, q0, (q1 - q0)/h) + L(t1, q1, (q1 - q0)/h));",
        order: 2,
        symmetric: true,
        step_density: false,
    },
];

/// The name in a list for the functions of Gauss steps, which every system has: it adds no rule.
pub const GAUSS: &str = "gauss";

/// The order that a rule is expected to have which is none of the table, and is not said to be symmetric.
pub const LEAST_ORDER: u32 = 1;

/// The rule of this name.
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
