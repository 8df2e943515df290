//! The systems whose products have limits, and the number of derivatives that vanish too.

use std::collections::BTreeSet;
use vi_codegen::program::{FunctionId, Operation};
use vi_codegen::syntax;

/// The limits in a function of a system: the number of vanishing derivatives of each.
fn limits(function: FunctionId, body: &str) -> Vec<u8> {
    let text = format!("struct S {{ {body} discretize midpoint; }}");
    let system = syntax::parse::system(text.parse().expect("tokens")).expect("a system");
    let program = vi_codegen::derive(&system).unwrap_or_else(|error| panic!("{body}: {error}")).own.program;
    let function = program.function(function).expect("every function is there");
    let needed = function.needed().into_iter();
    let found: BTreeSet<u8> = needed
        .filter_map(|id| match function.operations.get(id) {
            Operation::ZeroWhere(_, _, derivatives) => Some(*derivatives),
            _ => None,
        })
        .collect();
    found.into_iter().collect()
}

#[test]
fn a_force_has_the_limits_of_its_products() {
    let kinetic = "coord x, y; L = (dot(x)^2 + dot(y)^2) / 2;";
    for (force, wanted) in [
        // Orders 1, 1/2, 2 and 3 of the distance.
        ("x * y / sqrt(x^2 + y^2)", vec![0]),
        ("x / sqrt(abs(x))", vec![0]),
        ("x * y^2 / hypot(x, y)", vec![1]),
        ("x^3 * sin(y)^2 / (3 * x^2 + y^2)", vec![2]),
        ("(x - y)^3 / ((x - y)^2 + dot(x)^2)", vec![0]),
        ("(2*x - 2*y) / abs(x - y)^(1/2) * cos(x)", vec![0]),
        // A parameter is tested at run time.
        ("x * y / sqrt(a * (x^2 + a * y^2))", vec![0]),
        ("x * pow(x^2 + y^2, a)", vec![0]),
        // Zero on one side, whatever is infinite there.
        ("(1 - sign(x)) / y", vec![u8::MAX]),
        ("(1 - sign(x) + sign(y)) * ln(y)", vec![]),
        ("(a - sign(x)) * ln(y)", vec![u8::MAX]),
        // No limit.
        ("x / hypot(x, y)", vec![]),
        ("x * y / (x^2 + y^2)", vec![]),
        ("x * y / sqrt(x^2 - y^2)", vec![]),
        ("x * y / sqrt(x^2 + 1)", vec![]),
        ("x * y / hypot(x, 2)", vec![]),
        ("x * y / sqrt(hypot(x, a))", vec![0]),
        ("x * y / sqrt(x^2 * y^2 + x)", vec![]),
        ("x * y / sqrt(x^2 + sign(y)^2)", vec![]),
        // The sign is zero at its jump only.
        ("sign(x) / sqrt(abs(x))", vec![]),
        ("sign(x) * ln(y)", vec![]),
    ] {
        let found = limits(FunctionId::Force, &format!("param a = 1.0; {kinetic} force x = {force} + a * 0.5;"));
        assert_eq!(found, wanted, "{force}");
    }
}

#[test]
fn a_limit_stays_whole_in_sums() {
    let force = "force x = y * x^2 / hypot(x, y) + y * x^2 * cos(x) + y * x^2;";
    let body = format!("coord x, y; L = (dot(x)^2 + dot(y)^2) / 2; {force}");
    for function in [FunctionId::Force, FunctionId::MomentumEquation, FunctionId::MomentumResidual] {
        assert!(!limits(function, &body).is_empty(), "{function:?}");
    }
}

#[test]
fn no_limit_is_taken_where_the_system_has_no_value() {
    let force = "force x = x * y / hypot(x, y);";
    let body = |potential: &str| format!("coord x, y; L = (dot(x)^2 + dot(y)^2) / 2 {potential}; {force}");
    assert_eq!(limits(FunctionId::MomentumEquation, &body("")), [0]);
    assert_eq!(limits(FunctionId::MomentumEquation, &body("+ 1 / sqrt(x^2 + y^2)")), [] as [u8; 0]);
    // These have a value there, or may have one.
    for potential in ["+ 1 / sqrt(x^2 + y^2 + a^2)", "- (x^2 + y^2)^a", "+ 1 / hypot(x, a)"] {
        let body = format!("param a = 1.0; {}", body(potential));
        assert!(limits(FunctionId::Force, &body).contains(&0), "{potential}");
    }
}

#[test]
fn a_root_without_a_value_is_zero_where_its_sign_is() {
    let body = "coord x; L = dot(x)^2 / 2 - (1 + sign(x)) / 2 * sqrt(x);";
    for function in [FunctionId::Lagrangian, FunctionId::MomentumEquation] {
        assert!(!limits(function, body).is_empty(), "{function:?}");
    }
}
