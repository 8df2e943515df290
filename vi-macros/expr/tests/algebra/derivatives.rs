//! Every function against central differences of its own implementation in the standard library.

use std::collections::BTreeSet;

use vi_expr::Function;

use crate::Pool;
use crate::notation::{read, write};

type Formula = fn(f64, f64) -> f64;

type Case = (&'static str, Formula, [(f64, f64); 3]);

/// Text, the same function in floating point, and points (x, y) at which it is smooth.
const CASES: [Case; 24] = [
    ("exp(3*x*y/5)", |x, y| (0.6 * x * y).exp(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("ln(x^2 + 2*y)", |x, y| (x * x + 2.0 * y).ln(), [(0.3, 1.7), (-1.2, 0.4), (2.9, 1.1)]),
    ("sin(x*y + 1/3)", |x, y| (x * y + 1.0 / 3.0).sin(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("cos(x - 2*y)", |x, y| (x - 2.0 * y).cos(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("tan(x*y/2)", |x, y| (0.5 * x * y).tan(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("asin(x*y/3)", |x, y| (x * y / 3.0).asin(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("acos(x*y/3)", |x, y| (x * y / 3.0).acos(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("atan(x*y^2)", |x, y| (x * y * y).atan(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("atan2(x + y, x*y)", |x, y| (x + y).atan2(x * y), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.3)]),
    ("atan2(y, x)", f64_atan2_swapped, [(0.3, 1.7), (-1.2, 0.4), (-0.9, -1.3)]),
    ("sinh(x - y)", |x, y| (x - y).sinh(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("cosh(x - y)", |x, y| (x - y).cosh(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("tanh(x - y)", |x, y| (x - y).tanh(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("abs(x - y)", |x, y| (x - y).abs(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("x*y*sign(x - y)", |x, y| x * y * (x - y).signum(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("hypot(x, 3*y)", |x, y| x.hypot(3.0 * y), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("pow(x, y)", f64::powf, [(0.3, 1.7), (1.2, 0.4), (0.9, -1.1)]),
    ("pow(x*y, x - y)", |x, y| (x * y).powf(x - y), [(0.3, 1.7), (1.2, 0.4), (0.9, 1.1)]),
    ("pow(3/2, x*y)", |x, y| 1.5_f64.powf(x * y), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("sqrt(x^2 + y^2 + 1)", |x, y| (x * x + y * y + 1.0).sqrt(), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("x^3*y^2/(x - y)", |x, y| x.powi(3) * y * y / (x - y), [(0.3, 1.7), (-1.2, 0.4), (0.9, -1.1)]),
    ("(x + 2*y)^(7/3)", |x, y| (x + 2.0 * y).powf(7.0 / 3.0), [(0.3, 1.7), (1.2, 0.4), (-0.9, 1.1)]),
    ("1/sqrt(x^2 + y^2)^3", |x, y| (x * x + y * y).powf(-1.5), [(0.3, 1.7), (1.2, 0.4), (-0.9, 1.1)]),
    (
        "pi*x*exp(-x)*cos(y)",
        |x, y| std::f64::consts::PI * x * (-x).exp() * y.cos(),
        [(0.3, 1.7), (1.2, 0.4), (-0.9, 1.1)],
    ),
];

fn f64_atan2_swapped(x: f64, y: f64) -> f64 {
    y.atan2(x)
}

#[test]
fn every_function_against_central_differences() {
    const STEP: f64 = 1e-4;
    let mut worst: f64 = 0.0;
    let mut tested = BTreeSet::new();
    for (text, formula, points) in CASES {
        let mut pool = Pool::new();
        let expr = read(&mut pool, text);
        tested.extend(Function::ALL.into_iter().filter(|function| text.contains(&format!("{}(", function.name()))));
        let partials = [pool.partial_derivative(expr, "x"), pool.partial_derivative(expr, "y")];
        for (x, y) in points {
            let values = pool.evaluate_all(&partials, &mut |symbol| if symbol == "x" { x } else { y });
            // Five points: error of order STEP^4.
            let difference = |dx: f64, dy: f64| {
                let at = |steps: f64| formula(x + steps * dx, y + steps * dy);
                (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * STEP)
            };
            for (value, expected) in values.into_iter().zip([difference(STEP, 0.0), difference(0.0, STEP)]) {
                assert!(expected.abs() > 1e-3, "nothing to see in {text} at ({x}, {y}): {expected}");
                let error = (value - expected).abs() / (1.0 + expected.abs());
                // Measured: 3.0e-12.
                assert!(error < 4e-12, "{text} at ({x}, {y}): {value} instead of {expected}");
                worst = worst.max(error);
            }
        }
    }
    assert_eq!(tested.len(), Function::ALL.len(), "functions without a case");
    println!("largest error {worst:e}");
}

/// The value of each case in floating point tests `evaluate` separately from derivatives.
#[test]
fn values() {
    let mut worst: f64 = 0.0;
    for (text, formula, points) in CASES {
        let mut pool = Pool::new();
        let expr = read(&mut pool, text);
        for (x, y) in points {
            let value = pool.evaluate(expr, &mut |symbol| if symbol == "x" { x } else { y });
            let expected = formula(x, y);
            let error = (value - expected).abs() / (1.0 + expected.abs());
            // Measured: 8.2e-17.
            assert!(error < 1e-16, "{text} at ({x}, {y}): {value} instead of {expected}");
            worst = worst.max(error);
        }
    }
    println!("largest error {worst:e}");
}

#[test]
fn forms() {
    let table = [
        ("m*v^2/2 - k*x^2/2", "v", "m*v"),
        ("m*v^2/2 - k*x^2/2", "x", "-k*x"),
        ("x^3*y", "x", "3*x^2*y"),
        ("sin(x)*x", "x", "sin(x) + x*cos(x)"),
        ("(x + y)^2", "x", "2*x + 2*y"),
        ("sqrt(x)", "x", "1/(2*sqrt(x))"),
        ("abs(x)", "x", "sign(x)"),
        ("sign(x)", "x", "0"),
        ("hypot(x, y)", "y", "y/hypot(x, y)"),
        ("pow(x, y)", "x", "y*pow(x, y - 1)"),
        ("pow(x, y)", "y", "ln(x)*pow(x, y)"),
        ("x*y", "z", "0"),
        ("1/0", "x", "1/0"),
    ];
    for (input, variable, output) in table {
        let mut pool = Pool::new();
        let expr = read(&mut pool, input);
        let result = pool.partial_derivative(expr, variable);
        let expected = read(&mut pool, output);
        assert_eq!(result, expected, "{input} by {variable}: {} instead of {output}", write(&pool, result));
    }
}

/// A total derivative: each symbol has its rate, and the potential `u` of `x` is opaque with the slope `g`.
#[test]
fn chain_rule_through_the_closure() {
    let mut pool = Pool::new();
    let energy = read(&mut pool, "m*v^2/2 + u");
    let rates = [("v", "a"), ("u", "g*v")].map(|(symbol, rate)| (symbol, read(&mut pool, rate)));
    let power = pool.derivative(energy, &mut |pool, symbol| {
        rates.iter().find(|(name, _)| name == symbol).map_or(pool.zero(), |(_, rate)| *rate)
    });
    assert_eq!(power, read(&mut pool, "m*v*a + g*v"));
}
