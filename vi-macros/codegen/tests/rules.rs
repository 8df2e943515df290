//! The rules: the parts derived from `Ld` equal what a user would write, and the table of rules is correct.

use std::collections::BTreeSet;
use vi_codegen::rules::{self, NamedRule, RULES};
use vi_codegen::syntax::parse;
use vi_codegen::{Derived, derive};

/// Two coordinates and a force with all arguments.
const SYSTEM: &str = "param a = 2; coord x, y; L = dot(x)^2 + (2 + cos(x)) * dot(y)^2 - a * x * y * sin(t);
    force x = -dot(x) * y^2 + t; force y = x * dot(y)^3;";

fn derived(rule: &str) -> Derived {
    let text = format!("struct System {{ {SYSTEM} discretize {{ {rule} }} }}");
    let system = parse::system(text.parse().expect("tokens"));
    system.and_then(|system| derive(&system)).unwrap_or_else(|error| panic!("{rule}: {error}")).own
}

/// A number for each symbol, determined by its name.
fn drawn(name: &str) -> f64 {
    let seed = name.bytes().fold(7_u32, |seed, byte| seed.wrapping_mul(31).wrapping_add(u32::from(byte)));
    0.3 + (f64::from(seed % 10_000) * 0.618_033_988_749_894_9).fract()
}

/// The discrete forces and powers of a rule, f_d⁻, f_d⁺, g_d⁻, g_d⁺, at the numbers of `drawn`.
fn forces(rule: &str) -> Vec<f64> {
    let Derived { pool, model, system, .. } = derived(rule);
    let of = &system.by_rule.as_ref().expect("a rule").slots.forces;
    let powers = [of.gd_minus, of.gd_plus];
    let all = of.fd_minus.iter().chain(&of.fd_plus).chain(&powers);
    all.map(|expr| pool.evaluate(*expr, &mut |symbol| drawn(&system.spell(&model, symbol)))).collect()
}

/// `Ld`, and the four lines derived from it.
const WRITTEN: [(&str, &str); 4] = [
    (
        "Ld = h * L((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);",
        "fd_minus = h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);
         fd_plus = h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);
         gd_minus = -h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h) * (q1 - q0)/h;
         gd_plus = -h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h) * (q1 - q0)/h;",
    ),
    (
        "Ld = h/2 * (L(t0, q0, (q1 - q0)/h) + L(t1, q1, (q1 - q0)/h));",
        "fd_minus = h/2 * f(t0, q0, (q1 - q0)/h);
         fd_plus = h/2 * f(t1, q1, (q1 - q0)/h);
         gd_minus = -h/2 * f(t0, q0, (q1 - q0)/h) * (q1 - q0)/h;
         gd_plus = -h/2 * f(t1, q1, (q1 - q0)/h) * (q1 - q0)/h;",
    ),
    // Simpson's rule.
    (
        "Ld = h/6 * (L(t0, q0, (q1 - q0)/h) + 4 * L((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h) + L(t1, q1, (q1 - q0)/h));",
        "fd_minus = h/6 * (f(t0, q0, (q1 - q0)/h) + 2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h));
         fd_plus = h/6 * (f(t1, q1, (q1 - q0)/h) + 2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h));
         gd_minus = -h/6 * (f(t0, q0, (q1 - q0)/h) + 2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h)) * (q1 - q0)/h;
         gd_plus = -h/6 * (f(t1, q1, (q1 - q0)/h) + 2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h)) * (q1 - q0)/h;",
    ),
    // A point whose velocity differs from that of the interval, and whose coordinates change with h.
    (
        "Ld = h * L(t0 + h/3, q0, q1);",
        "fd_minus = h * f(t0 + h/3, q0, q1); fd_plus = 0 * q0;
         gd_minus = -2/3 * h * f(t0 + h/3, q0, q1) * q1; gd_plus = -1/3 * h * f(t0 + h/3, q0, q1) * q1;",
    ),
];

#[test]
fn the_work_of_the_force_is_derived_as_it_would_be_written() {
    for (ld, written) in WRITTEN {
        let (derived, wanted) = (forces(ld), forces(&format!("{ld} {written}")));
        assert_eq!(derived.len(), 6);
        for (derived, wanted) in derived.into_iter().zip(wanted) {
            // Equal up to the order of the terms.
            assert!((derived - wanted).abs() <= 1e-13 * wanted.abs(), "{ld}: {derived}, not {wanted}");
        }
        assert!(forces(ld)[4].abs() > 1e-3, "{ld}: no power");
    }
}

/// The built-in rule that equals this one.
fn known(rule: &str) -> Option<&'static NamedRule> {
    derived(rule).system.by_rule.expect("a rule").rule
}

#[test]
fn a_rule_of_the_table_is_known_however_it_is_written() {
    let [midpoint, trapezoidal, others @ ..] = WRITTEN;
    for ((ld, forces), rule) in [midpoint, trapezoidal].into_iter().zip(&RULES) {
        assert_eq!(known(ld), Some(rule), "{ld}");
        assert_eq!(known(&format!("{ld} {forces}")), Some(rule), "{ld}");
        // Other forces make it a different rule.
        let other = forces.replace("fd_plus = h/2", "fd_plus = h/3");
        assert_eq!(known(&format!("{ld} {other}")), None, "{ld}");
    }
    for (ld, _) in others {
        assert_eq!(known(ld), None, "{ld}");
    }
    let sum = "Ld = h/2 * sum(i in 0..2, L(t0 + i * h, q0 + i * (q1 - q0), (q1 - q0)/h));";
    assert_eq!(derived(sum).system.points(), 2);
}

#[test]
fn names_and_markers_of_the_table_are_distinct() {
    let distinct = |of: fn(&NamedRule) -> &'static str| RULES.iter().map(of).collect::<BTreeSet<_>>().len();
    assert_eq!(distinct(|rule| rule.name), RULES.len());
    assert_eq!(distinct(|rule| rule.marker), RULES.len());
    for rule in &RULES {
        assert_eq!(rules::named(rule.name), Some(rule));
    }
    assert_eq!(rules::named("some"), None);
}

/// The language reference names every built-in rule with its line.
#[test]
fn the_reference_lists_the_table() {
    let reference = include_str!("../../../docs/reference.md");
    for rule in &RULES {
        assert!(reference.contains(&format!("| `{}` |", rule.name)), "{}", rule.name);
    }
}
