//! Constants: correct rounding, against 50 digits of mpmath (`constants.py`).

use std::cmp::Ordering;

use vi_expr::{NoConstant, Rational};

use crate::Pool;
use crate::notation::{read, write};

const REFERENCE: &str = include_str!("constants.txt");

/// The value of a constant expression.
fn constant(text: &str) -> Result<f64, NoConstant> {
    let mut pool = Pool::new();
    let expr = read(&mut pool, text);
    pool.constant(expr)
}

#[test]
fn constants_are_rounded_once() {
    let cases: Vec<(&str, &str)> = REFERENCE.lines().filter_map(|line| line.split_once(" = ")).collect();
    let mut wrong = Vec::new();
    for (text, digits) in &cases {
        // The parser of the standard library rounds correctly.
        let wanted: f64 = digits.parse().expect("digits");
        let found = constant(text);
        if found != Ok(wanted) {
            wrong.push(format!("{text} = {found:?}, not {wanted:e}"));
        }
    }
    assert!(wrong.is_empty() && cases.len() > 600, "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

#[test]
fn the_sign_of_a_constant_is_known() {
    for (text, wanted) in [
        ("sqrt(2)*sqrt(3) - sqrt(6)", Ordering::Equal),
        ("ln(2) + ln(3) - ln(6)", Ordering::Equal),
        ("atan(1) - pi/4", Ordering::Equal),
        ("sin(sqrt(8)*sqrt(3)*pi/sqrt(24)*1000)", Ordering::Equal),
        ("acos(sqrt(2)*sqrt(3)/sqrt(6))", Ordering::Equal),
        ("ln(sqrt(2)*sqrt(3)/sqrt(6))", Ordering::Equal),
        ("exp(1e-300) - 1 - 1e-300", Ordering::Greater),
        ("1 - exp(exp(-600))", Ordering::Less),
        ("abs(1 - sqrt(2))", Ordering::Greater),
        ("exp(-10000)", Ordering::Greater),
        ("-exp(10000)", Ordering::Less),
    ] {
        let mut pool = Pool::new();
        let expr = read(&mut pool, text);
        assert_eq!(pool.constant_sign(expr), Ok(wanted), "{text}");
    }
}

#[test]
fn a_number_between_two_is_rounded_to_the_even_one() {
    assert_eq!(constant("sqrt(2)*sqrt(3)/sqrt(6)*(1 + 1/2^53)"), Ok(1.0));
    assert_eq!(constant("sqrt(2)*sqrt(3)/sqrt(6)*(1 + 3/2^53)"), Ok(1.0 + 2.0 * f64::EPSILON));
    assert_eq!(constant("1 + 1/2^53 + exp(-1000)"), Ok(1.0 + f64::EPSILON));
    assert_eq!(constant("1 + 3/2^53 - exp(-1000)"), Ok(1.0 + f64::EPSILON));
}

#[test]
fn constants_without_a_number_report_why() {
    for (text, why) in [
        ("ln(1 - sqrt(2))", NoConstant::Undefined),
        ("ln(sqrt(2)*sqrt(3) - sqrt(6))", NoConstant::Undefined),
        ("acos(sqrt(2))", NoConstant::Undefined),
        ("asin(-sqrt(2))", NoConstant::Undefined),
        ("(1 - sqrt(2))^(1/3)", NoConstant::Undefined),
        ("pow(1 - sqrt(2), sqrt(2))", NoConstant::Undefined),
        ("tan(sqrt(2)*sqrt(3)/sqrt(6)*pi/2)", NoConstant::Undefined),
        ("atan2(0, 0)", NoConstant::Undefined),
        ("exp(1000)", NoConstant::TooLarge),
        ("exp(-1000)", NoConstant::TooSmall),
        ("10^100000", NoConstant::TooLarge),
        ("exp(exp(exp(10)))", NoConstant::TooLarge),
        ("exp(-exp(exp(10)))", NoConstant::TooSmall),
        ("3^(10^(10^6))", NoConstant::TooLarge),
        ("sin(10^(10^6))", NoConstant::Undecided),
        ("sin(10^2000)", NoConstant::Undecided),
        ("cos(exp(exp(10)))", NoConstant::Undecided),
    ] {
        assert_eq!(constant(text), Err(why), "{text}");
    }
    assert_eq!(constant("pow(1 - sqrt(2), sqrt(2)*sqrt(3)/sqrt(6))"), constant("1 - sqrt(2)"));
    assert_eq!(constant("2^(1/1000000)"), Ok(1.000_000_693_147_420_8));
}

#[test]
fn absolute_values_and_signs_of_constants_are_decided() {
    for (text, wanted) in [
        ("sign(ln(1 + 1e-30))", "1"),
        ("sign(x*(1 - sqrt(2)))", "-sign(x)"),
        ("abs(x*(1 - sqrt(2)))", "(sqrt(2) - 1)*abs(x)"),
        ("abs(x*(sqrt(6) - sqrt(2)*sqrt(3)))", "0"),
        ("abs(pi*x)", "pi*abs(x)"),
        ("sign(sqrt(6) - sqrt(2)*sqrt(3))", "0"),
    ] {
        let mut pool = Pool::new();
        let (found, wanted) = (read(&mut pool, text), read(&mut pool, wanted));
        assert_eq!(found, wanted, "{text} = {}", write(&pool, found));
    }
}

#[test]
fn terms_that_differ_by_constants_become_one() {
    for (text, wanted) in [
        ("x - cos(1e-8)*x + y", "(1 - cos(1e-8))*x + y"),
        ("sqrt(2)*x^2 + pi*x^2 + pi*y", "(sqrt(2) + pi)*x^2 + pi*y"),
        ("sqrt(2)*sqrt(3)*x - sqrt(6)*x + y", "y"),
        ("sin(x - cos(1e-8)*x)", "sin((1 - cos(1e-8))*x)"),
        ("x + sqrt(4) - 1", "x + 1"),
        ("sqrt(2)*(x + y) - sqrt(3)*(x + y)", "(sqrt(2) - sqrt(3))*(x + y)"),
        ("pi*x + sqrt(2)*y + 3", "pi*x + sqrt(2)*y + 3"),
        ("x + exp(1000) - 1", "1/0"),
    ] {
        let mut pool = Pool::new();
        let (found, wanted) = (read(&mut pool, text), read(&mut pool, wanted));
        let collected = pool.collect_constants(&[found])[0];
        assert_eq!(collected, wanted, "{text} = {}", write(&pool, collected));
    }
    // The constant part of a sum is rounded.
    let mut pool = Pool::new();
    let text = read(&mut pool, "x + cos(1e-8) - 1");
    let collected = pool.collect_constants(&[text])[0];
    let difference = read(&mut pool, "cos(1e-8) - 1");
    let wanted = Rational::from_float(pool.constant(difference).expect("a number")).expect("a finite number");
    let (x, wanted) = (pool.symbol("x".to_owned()), pool.number(wanted));
    assert_eq!(collected, pool.add(x, wanted));
}
