//! Opaque functions and conditions: their forms, derivatives and values.

use super::{Pool, ratio};
use vi_expr::{Expr, Opaque};

fn text(pool: &Pool, expr: Expr) -> String {
    pool.render(expr, &String::clone)
}

#[test]
fn a_derivative_raises_one_order() {
    let mut pool = Pool::new();
    let [x, y] = ["x", "y"].map(|name| pool.symbol(name.to_owned()));
    let square = pool.mul(x, x);
    let one = pool.opaque(Opaque::new("cl", 1, 0.7), vec![square]);
    let slope = pool.partial_derivative(one, "x");
    assert_eq!(text(&pool, slope), "2*x*cl'(x^2)");
    let two = pool.opaque(Opaque::new("cp", 2, 0.7), vec![x, y]);
    let by_x = pool.partial_derivative(two, "x");
    let mixed = pool.partial_derivative(by_x, "y");
    let by_y = pool.partial_derivative(two, "y");
    assert_eq!(mixed, pool.partial_derivative(by_y, "x"), "mixed derivatives are equal");
    assert_eq!(text(&pool, mixed), "cp^(1,1)(x, y)");
    // A further argument is a constant of the run: it has no derivative.
    let of_parameter = pool.opaque(Opaque::new("lift", 1, 0.7), vec![x, y]);
    assert_eq!(text(&pool, of_parameter), "lift(x)");
    let by_parameter = pool.partial_derivative(of_parameter, "y");
    assert!(pool.is_undefined(by_parameter));
}

/// The stand-in is one analytic function: its derivatives agree with differences.
#[test]
fn derivatives_of_the_stand_in_are_consistent() {
    let mut pool = Pool::new();
    let [x, y] = ["x", "y"].map(|name| pool.symbol(name.to_owned()));
    let function = pool.opaque(Opaque::new("cp", 2, 0.7), vec![x, y]);
    let at = |pool: &Pool, expr: Expr, x: f64, y: f64| pool.evaluate(expr, &mut |name| if name == "x" { x } else { y });
    let step = 1e-5;
    let mut expr = function;
    for by in ["x", "y", "x", "x"] {
        let slope = pool.partial_derivative(expr, by);
        let (dx, dy) = if by == "x" { (step, 0.0) } else { (0.0, step) };
        let difference = (at(&pool, expr, 0.4 + dx, 1.3 + dy) - at(&pool, expr, 0.4 - dx, 1.3 - dy)) / (2.0 * step);
        let found = at(&pool, slope, 0.4, 1.3);
        // Measured: 6e-12.
        println!("{:e}", found - difference);
        assert!((found - difference).abs() < 1e-9 && found.abs() > 1e-3, "{found} {difference}");
        expr = slope;
    }
    let constant = pool.integer(2);
    let of_constant = pool.opaque(Opaque::new("cl", 1, 0.7), vec![constant]);
    assert!(!pool.is_constant(of_constant));
    let rounded = pool.evaluate_rounded(&[function], &mut |_| 1e9)[0];
    assert!(rounded.error > 1e-8, "{rounded:?}");
}

#[test]
fn a_period_is_that_of_the_stand_in() {
    let cogging = Opaque::new("cogging", 1, 3.0);
    let period = core::f64::consts::TAU / 3.0;
    // Measured: 7e-16.
    println!("{:e}", cogging.value(&[0.4]) - cogging.value(&[0.4 + period]));
    assert!((cogging.value(&[0.4]) - cogging.value(&[0.4 + period])).abs() < 2e-15);
}

#[test]
fn conditions_have_one_form() {
    let mut pool = Pool::new();
    let [x, y] = ["x", "y"].map(|name| pool.symbol(name.to_owned()));
    let difference = pool.sub(x, y);
    let larger = pool.select(difference, x, y);
    assert_eq!(text(&pool, larger), "if x - y > 0 { x } else { y }");
    let tripled = pool.scale(difference, &ratio(3, 2));
    assert_eq!(pool.select(tripled, x, y), larger, "a positive factor of the condition");
    let opposite = pool.neg(difference);
    assert_ne!(pool.select(opposite, x, y), larger);
    assert_eq!(pool.select(difference, x, x), x);
    let [positive, negative, zero] = [1, -1, 0].map(|number| pool.integer(number));
    assert_eq!([positive, negative, zero].map(|number| pool.select(number, x, y)), [x, y, y]);
    let undefined = pool.undefined();
    assert!([pool.select(undefined, x, y), pool.select(x, undefined, y)].iter().all(|found| pool.is_undefined(*found)));
}

#[test]
fn the_derivative_of_a_condition_is_that_of_the_selected_expression() {
    let mut pool = Pool::new();
    let x = pool.symbol("x".to_owned());
    let root = pool.power(x, &ratio(1, 2));
    let zero = pool.zero();
    let half_root = pool.select(x, root, zero);
    let slope = pool.partial_derivative(half_root, "x");
    assert_eq!(text(&pool, slope), "if x > 0 { 1/(2*sqrt(x)) } else { 0 }");
    let at = |x: f64| pool.evaluate_all(&[half_root, slope], &mut |_| x);
    assert_eq!(at(4.0), [2.0, 0.25]);
    // The other expression has no value here, and leaves no trace.
    assert_eq!(at(-4.0), [0.0, 0.0]);
    assert!(at(f64::NAN).iter().all(|value| value.is_nan()));
    let rounded = pool.evaluate_rounded(&[half_root], &mut |_| -4.0)[0];
    assert_eq!(rounded.value.to_bits(), 0);
    let replaced = pool.replace(half_root, root, x);
    assert_eq!(text(&pool, replaced), "if x > 0 { x } else { 0 }");
}
