//! Canonical forms, derivatives, substitution and expansion preserve the value.

use std::collections::BTreeMap;

use vi_expr::{Expr, Rational};

use crate::tree::{Random, SYMBOLS};
use crate::{Pool, notation, ratio};

const POINT: [f64; 4] = [0.731, 1.372, -0.618, 2.113];

fn at(pool: &mut Pool, expr: Expr, point: &[Rational]) -> Expr {
    let point: BTreeMap<&str, Expr> =
        SYMBOLS.into_iter().zip(point).map(|(name, value)| (name, pool.number(value.clone()))).collect();
    pool.substitute(expr, &mut |_, symbol| point.get(symbol.as_str()).copied())
}

/// No tolerance: numbers stay exact, so that the value at a rational point is exact.
#[test]
fn rational_functions_are_exact() {
    let points = [
        [ratio(3, 7), ratio(-5, 2), ratio(11, 3), ratio(2, 9)],
        [ratio(-4, 3), ratio(1, 6), ratio(-7, 5), ratio(13, 4)],
    ];
    let (mut compared, mut expanded, mut slopes) = (0, 0, 0);
    for seed in 0..600 {
        let tree = Random::new(seed).rational(5);
        let mut pool = Pool::new();
        let expr = tree.build(&mut pool);
        let derivative = pool.partial_derivative(expr, SYMBOLS[0]);
        let expansion = pool.expand(expr);
        for point in &points {
            let Some((value, slope)) = tree.exact(point) else { continue };
            let found = at(&mut pool, expr, point);
            assert_eq!(pool.as_number(found), Some(&value), "value of {tree:?}");
            let found = at(&mut pool, derivative, point);
            assert_eq!(pool.as_number(found), Some(&slope), "derivative of {tree:?}");
            slopes += i32::from(slope != ratio(0, 1));
            if let Ok(expansion) = expansion {
                let found = at(&mut pool, expansion, point);
                assert_eq!(pool.as_number(found), Some(&value), "expansion of {tree:?}");
                expanded += i32::from(expansion != expr);
            }
            compared += 1;
        }
    }
    println!("{compared} compared, {slopes} slopes other than 0, {expanded} expanded");
    assert!(compared > 900 && slopes > 500 && expanded > 400, "{compared} {slopes} {expanded}");
}

#[test]
fn functions_keep_value_and_derivative() {
    let (mut compared, mut slopes, mut worst) = (0, 0, 0.0_f64);
    for seed in 0..3000 {
        let tree = Random::new(seed).transcendental(5);
        let mut largest = 0.0;
        let (value, slope) = tree.float(&POINT, &mut largest);
        // Beyond this, rounding decides; NaN is skipped too.
        if largest.is_nan() || largest > 1e3 {
            continue;
        }
        let mut pool = Pool::new();
        let expr = tree.build(&mut pool);
        let derivative = pool.partial_derivative(expr, SYMBOLS[0]);
        let Ok(expansion) = pool.expand(expr) else { continue };
        let found = pool.evaluate_all(&[expr, derivative, expansion], &mut |symbol| {
            SYMBOLS.iter().position(|name| name == symbol).map_or(f64::NAN, |place| POINT[place])
        });
        for (found, expected) in found.into_iter().zip([value, slope, value]) {
            let error = (found - expected).abs() / (1.0 + largest);
            // Measured: 7.7e-13.
            assert!(error < 1e-12, "seed {seed}: {found} instead of {expected} in {}", notation::write(&pool, expr));
            worst = worst.max(error);
        }
        slopes += i32::from(slope.abs() > 1e-6);
        compared += 1;
    }
    println!("{compared} compared, {slopes} slopes other than 0, largest error {worst:e}");
    assert!(compared > 500 && slopes > 200, "{compared} {slopes}");
}

/// Rendered text parses to an expression with the same value. (The form may differ: `1/(2*(x + y))` is read as the
/// reciprocal of `2*x + 2*y`.)
#[test]
fn text_reads_back() {
    let (mut same, mut worst) = (0, 0.0_f64);
    for seed in 0..1000 {
        let mut pool = Pool::new();
        notation::read(&mut pool, "0");
        let expr = Random::new(seed).transcendental(4).build(&mut pool);
        let text = notation::write(&pool, expr);
        let back = notation::read(&mut pool, &text);
        same += i32::from(back == expr);
        let found = pool.evaluate_all(&[expr, back], &mut |symbol| {
            SYMBOLS.iter().position(|name| name == symbol).map_or(f64::NAN, |place| POINT[place])
        });
        if found[0].is_finite() {
            let error = (found[1] - found[0]).abs() / (1.0 + found[0].abs());
            // Measured: 3.9e-16.
            assert!(error < 5e-16, "{found:?} of {text}");
            worst = worst.max(error);
        } else {
            assert!(!found[1].is_finite(), "{found:?} of {text}");
        }
    }
    println!("{same} of 1000 the same form, largest error {worst:e}");
    assert!(same > 900, "{same}");
}
