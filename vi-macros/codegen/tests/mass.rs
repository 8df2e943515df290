//! Detection of mass matrices that are singular in every state, without false positives, for any sizes.

use proc_macro2::TokenStream;
use vi_codegen::{model, syntax};
use vi_expr::Pool;

/// The message of the name check for a system with these clauses.
fn message(clauses: &str) -> Option<String> {
    let text = format!("struct System {{ {clauses} discretize midpoint; }}");
    let tokens: TokenStream = text.parse().expect("the case is made of Rust tokens");
    let check = |system| model::check::model(&mut Pool::new(), &system, 0);
    syntax::parse::system(tokens).and_then(check).err().map(|error| error.to_string())
}

#[test]
fn a_regular_matrix_of_any_sizes_is_regular() {
    for clauses in [
        "coord x, y; L = dot(x)^2 + 1e-12 * dot(y)^2;",
        "coord x, y; L = 1e30 * dot(x)^2 + 1e-30 * dot(y)^2;",
        "coord x, y; L = 1e-200 * dot(x)^2 + 1e-250 * dot(y)^2;",
        "coord x, y, z; L = 1e30 * dot(x)^2 + 1e-30 * dot(y)^2 + dot(z)^2 + dot(x) * dot(y) / 2 + 1e14 * dot(x) * dot(z);",
        "coord x; L = exp(-30/x) * dot(x)^2 / 2;",
        "coord x, y; L = exp(-30/x) * dot(x)^2 / 2 + dot(y)^2 / 2;",
        // Out of the range of numbers at every tested point: nothing is known.
        "coord x, y; L = exp(-1e5/x^2) * dot(x)^2 / 2 + dot(y)^2 / 2;",
        "coord x, y; L = x^100000 * dot(x)^2 + dot(y)^2;",
        "coord x; L = ln(x - 5) * dot(x)^2;",
        // Nearly singular.
        "coord x, y; L = (dot(x) + dot(y))^2 + 1e-12 * dot(y)^2;",
        "coord q[8]; L = sum(i in 0..8, sum(j in 0..8, dot(q[i]) * dot(q[j]) / (i + j + 1)));",
        "coord q[64]; L = sum(i in 0..64, dot(q[i]))^2 + 1e-9 * sum(i in 0..64, dot(q[i])^2);",
        // Singular on one half-line only.
        "coord x; L = (abs(x) - x) * dot(x)^2;",
        "coord x; L = (abs(x) + x) * dot(x)^2;",
        // Indefinite, and not quadratic.
        "coord x, y; L = 1e-20 * dot(x) * dot(y);",
        "coord x, y; L = sqrt(1 - dot(x)^2 - dot(y)^2);",
        "param c = 3e8; coord x; L = -1e-18 * sqrt(1 - dot(x)^2 / c^2);",
        // Nearly homogeneous.
        "param m = 1, c = 3e8; coord T, x; L = -m * c * sqrt(c^2 * dot(T)^2 - dot(x)^2) + m * dot(T)^2;",
        "coord x, y; L = (dot(x)^2 + dot(y)^2)^0.51;",
        "coord x, y; L = dot(x)^2.001 / dot(y);",
        // Without mass by default.
        "param m = 0; coord x; L = m * dot(x)^2;",
        "param m = 0, c = 2; coord T, x; L = m * (sqrt(c^2 * dot(T)^2 - dot(x)^2) + dot(x)^2);",
    ] {
        assert_eq!(message(clauses), None, "{clauses}");
    }
}

#[test]
fn a_matrix_that_is_singular_everywhere_is_found() {
    for clauses in [
        "coord x, y; L = (dot(x) + dot(y))^2;",
        "coord x, y; L = (1e20 * dot(x) + 1e-20 * dot(y))^2;",
        "coord x, y, z; L = (dot(x) - dot(y))^2 + (dot(y) - dot(z))^2 + (dot(z) - dot(x))^2;",
        "coord x, y, z; L = dot(x)^2 + 1e-15 * (dot(y) - 3 * dot(z))^2;",
        // By identities of functions.
        "coord x, y; L = (cos(x) * dot(x) + sin(x) * dot(y))^2;",
        "coord x, y; L = dot(x)^2 + 2 * cos(x) * dot(x) * dot(y) + (1 - sin(x)^2) * dot(y)^2;",
        "coord x, y; L = (cosh(x)^2 - sinh(x)^2 - 1) * dot(x)^2 + dot(y)^2;",
        "coord q[3]; L = sum(i in 0..3, sum(j in 0..3, dot(q[i]) * dot(q[j]) * cos(q[i] - q[j])));",
        "coord x, y; L = hypot(dot(x), dot(y));",
        // Half of the tested points have no value.
        "coord x, y; L = sqrt(x) * (dot(x) + dot(y))^2;",
        "coord x, y; L = sqrt(-x) * (dot(x) + dot(y))^2;",
        // Homogeneous of degree 1, with a root that is defined at few points.
        "param m = 1, c = 3e8; coord T, x; L = -m * c * sqrt(c^2 * dot(T)^2 - dot(x)^2);",
        "param m = 1; coord T, x, y, z; L = -m * sqrt(dot(T)^2 - dot(x)^2 - dot(y)^2 - dot(z)^2);",
        "param M = 1; coord T, r; L = -sqrt((1 - 2 * M / r) * dot(T)^2 - dot(r)^2 / (1 - 2 * M / r));",
        "coord x, y; L = dot(x)^2 / dot(y);",
    ] {
        let text = message(clauses).unwrap_or_else(|| panic!("{clauses} is accepted"));
        assert!(text.starts_with("the mass matrix ∂²L/∂v² is singular for every state\nhelp: "), "{clauses}: {text}");
    }
    let nothing = message("coord x; L = (cos(x)^2 + sin(x)^2 - 1) * dot(x)^2;");
    assert!(nothing.is_some_and(|text| text.starts_with("`L` does not depend on any velocity")));
}
