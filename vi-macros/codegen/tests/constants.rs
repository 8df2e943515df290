//! Constants of the language become the nearest `f64` at every position.

use vi_codegen::program::FunctionId;
use vi_codegen::symbol::{Symbol, Variable};
use vi_codegen::{Derived, syntax};

fn derived(clauses: &str) -> Derived {
    let tokens = format!("struct System {{ coord x, y; {clauses} discretize midpoint; }}").parse().expect("tokens");
    let system = syntax::parse::system(tokens);
    system.and_then(|system| vi_codegen::derive(&system)).unwrap_or_else(|error| panic!("{clauses}: {error}")).own
}

/// L of a system with this summand and the kinetic energy, at x = 1 and y = 0 at rest.
fn value(summand: &str) -> f64 {
    let derived = derived(&format!("L = dot(x)^2 + dot(y)^2 + {summand};"));
    let function = derived.program.function(FunctionId::Lagrangian).expect("every function is there");
    let value = function.evaluate(&mut |symbol| match symbol {
        Symbol::Continuous(Variable::Coordinate(0)) => 1.0,
        _ => 0.0,
    });
    value[0]
}

#[test]
fn a_coefficient_is_the_nearest_number() {
    // From mpmath with 30 digits.
    for (summand, wanted) in [
        ("(sin(10^20 * pi / 3)) * x", -0.866_025_403_784_438_6),
        ("(exp(-800) * 1e300) * x", 3.667_874_584_177_687e-48),
        ("exp(-800) * (1e300 * x)", 3.667_874_584_177_687e-48),
        ("(1 - cos(1e-8)) * x", 5e-17),
        ("(acos(1 - 1e-20)) * x", 1.414_213_562_373_095e-10),
        ("(ln(1 + 1e-15)) * x", 9.999_999_999_999_995e-16),
        ("(sqrt(2) - 1)^20 * x", 2.210_478_490_342_221_6e-08),
        ("2 * sqrt(3) * pi * x", 10.882_796_185_405_308),
        ("x * (sqrt(2) - 1)^20 * (y + 1)", 2.210_478_490_342_221_6e-08),
        ("sign(exp(pi) - pi - 20) * x", -1.0),
        ("abs(x * (exp(pi) - pi - 20))", 0.000_900_020_810_524_232_8),
        // High powers are rounded as a whole.
        ("(1 + pi / 100)^365 * x", 80_047.751_297_709_21),
        ("(1 + sqrt(2) / 1000)^1000 * x", 4.109_143_054_374_867),
        ("(1 + pi / 100 + sqrt(2))^50 * x", 2.627_441_887_324_360_3e19),
        // Terms of sums that differ by constants, and constant parts of sums.
        ("(x - cos(1e-8) * x)", 5e-17),
        ("y + cos(1e-8) - 1", -5e-17),
        ("sqrt(2) * sqrt(3) * x - sqrt(6) * x", 0.0),
    ] {
        assert_eq!(value(summand).to_bits(), f64::to_bits(wanted), "{summand} = {:e}, not {wanted:e}", value(summand));
    }
}

/// exp(-800) alone underflows, 1e300 times it does not.
#[test]
fn a_part_out_of_the_range_of_numbers_is_no_mistake() {
    for clauses in [
        "L = dot(x)^2 + dot(y)^2 - exp(-800) * sqrt(x) * 1e300;",
        "L = dot(x)^2 + dot(y)^2 - 1e300 * exp(-800) * abs(x)^(3/2) / y;",
        "L = exp(-800) * 1e300 * dot(x)^2 + dot(y)^2 - sin(exp(-800) * 1e300 * x)^2; force x = -1e300 * exp(-800) * dot(x);",
        "L = dot(x)^2 + dot(y)^2 - x^2; time_scale = 1 + 1e300 * exp(-800) * x^2;",
    ] {
        derived(clauses);
    }
}

#[test]
fn a_matrix_is_as_regular_as_its_constants() {
    // The mass of x is 1 − cos(1e-8), and the mass of y is zero up to the rounding of its terms.
    derived("L = dot(x)^2 - cos(1e-8) * dot(x)^2 + dot(y)^2;");
    let zero = "L = dot(x)^2 + sqrt(2) * sqrt(3) * dot(y)^2 - sqrt(6) * dot(y)^2;";
    let tokens = format!("struct System {{ coord x, y; {zero} discretize midpoint; }}").parse().expect("tokens");
    let message = syntax::parse::system(tokens).and_then(|system| vi_codegen::derive(&system)).err().expect("an error");
    assert!(message.to_string().contains("is singular for every state"), "{message}");
}

#[test]
fn defaults_and_states_of_checks_are_the_nearest_numbers() {
    let derived = derived(
        "const tiny = exp(-800); param a = tiny * 1e300, b[2] = [1 - cos(1e-8), acos(1 - 1e-20)]; \
         L = a * dot(x)^2 + b[0] * dot(y)^2 + b[1] * x; check { x = ln(1 + 1e-15); h = (sqrt(2) - 1)^20; }",
    );
    let defaults: Vec<f64> = derived.model.parameters.iter().map(|parameter| parameter.default).collect();
    assert_eq!(defaults, [3.667_874_584_177_687e-48, 5e-17, 1.414_213_562_373_095e-10]);
    let state = derived.model.check_state.expect("a state");
    assert_eq!((state.q[0], state.h), (9.999_999_999_999_995e-16, 2.210_478_490_342_221_6e-08));
}
