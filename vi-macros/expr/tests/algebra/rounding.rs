//! Error estimates: never below the actual rounding, and not far above it.

use vi_expr::Rounded;

use crate::Pool;
use crate::notation::read;

/// Value and error of an expression at x = 0.7, y = 1.1.
fn rounded(text: &str) -> Rounded {
    let mut pool = Pool::new();
    let expr = read(&mut pool, text);
    let value = |symbol: &String| if symbol == "x" { 0.7 } else { 1.1 };
    pool.evaluate_rounded(&[expr], &mut { value })[0]
}

#[test]
fn a_zero_up_to_rounding_is_within_its_error() {
    for text in [
        "sin(x)^2 + cos(x)^2 - 1",
        "cosh(y)^2 - sinh(y)^2 - 1",
        "exp(x + y) - exp(x)*exp(y)",
        "sin(x + y) - sin(x)*cos(y) - cos(x)*sin(y)",
        "hypot(x, y)^2 - x^2 - y^2",
        "ln(x*y) - ln(x) - ln(y)",
        "sqrt(x*y) - sqrt(x)*sqrt(y)",
        "tan(atan(y)) - y",
        "pow(x, y) - exp(y*ln(x))",
        "atan2(x, y) - atan(x/y)",
        "(x + 1/3)^3 - x^3 - x^2 - x/3 - 1/27",
        "1e20*sin(x)^2 + 1e20*cos(x)^2 - 1e20",
    ] {
        let text = text.replace("1e20", "100000000000000000000");
        let Rounded { value, error } = rounded(&text);
        let size = if text.starts_with('1') { 1e20 } else { 1.0 };
        println!("{text} = {value:e} ± {error:e}");
        assert!(value.abs() <= error && error <= 2e-13 * size, "{text} = {value:e} ± {error:e}");
    }
}

#[test]
fn small_numbers_are_as_accurate_as_large_ones() {
    for (text, wanted) in [
        ("x/1000000000000000000000000000000", 0.7e-30),
        ("exp(-30/x)", (-30.0_f64 / 0.7).exp()),
        ("x^1000", 0.7_f64.powi(1000)),
        ("(x - 7/10)^0", 1.0),
    ] {
        let Rounded { value, error } = rounded(text);
        assert!((value - wanted).abs() <= 1e-12 * wanted, "{text} = {value:e}, not {wanted:e}");
        assert!(error <= 1e-12 * wanted, "{text} = {value:e} ± {error:e}");
    }
    assert_eq!(rounded("x"), Rounded { value: 0.7, error: 0.0 });
}

#[test]
fn values_beyond_the_range_of_numbers_are_lost() {
    for text in ["exp(-1000*y)", "exp(1000*y)", "x^10000", "x^-10000", "ln(x - y)", "sqrt(x - y)", "1/0", "acos(2*y)"] {
        let Rounded { value, error } = rounded(text);
        assert!(value.is_nan() && error.is_nan(), "{text} = {value:e} ± {error:e}");
    }
}
