//! Deep, wide and huge expressions end in bounded time and without recursion.

use vi_expr::{Expr, Function, MAX_CHARACTERS, Node, TooLarge};

use crate::notation::{read, write};
use crate::{Pool, ratio};

/// Levels of nesting; two nodes each.
const DEPTH: u32 = 50_000;

fn deep(pool: &mut Pool) -> Expr {
    let x = pool.symbol("x".to_owned());
    let mut expr = x;
    for _ in 0..DEPTH {
        let sum = pool.add(x, expr);
        let half = pool.scale(sum, &ratio(1, 2));
        expr = pool.call(Function::Sin, &[half]);
    }
    expr
}

#[test]
fn a_hundred_thousand_nodes_deep() {
    let mut pool = Pool::new();
    let expr = deep(&mut pool);
    assert!(pool.reachable(&[expr]).len() >= 100_000);
    assert_eq!(pool.symbols(expr).len(), 1);
    assert!(pool.depends_on(expr, &|symbol| symbol == "x"));

    let derivative = pool.derivative(expr, &mut |pool, _| pool.one());
    let expansion = pool.expand(expr).map(|expansion| pool.is_zero(expansion));
    assert_eq!(expansion, Err(TooLarge::Terms { limit: 50_000 }), "a sum of two terms at each level");
    let y = pool.symbol("y".to_owned());
    let moved = pool.substitute(expr, &mut |_, _| Some(y));

    let (mut value, mut slope) = (0.7, 1.0);
    for _ in 0..DEPTH {
        let angle = 0.5_f64 * (0.7 + value);
        (value, slope) = (angle.sin(), 0.5 * (1.0 + slope) * angle.cos());
    }
    let found = pool.evaluate_all(&[expr, derivative, moved], &mut |_| 0.7);
    assert!(slope > 0.1);
    for (found, expected) in found.into_iter().zip([value, slope, value]) {
        // Measured: 0, since the roundings agree.
        assert!((found - expected).abs() <= f64::EPSILON, "{found} instead of {expected}");
    }
    let text = write(&pool, expr);
    assert_eq!(text.chars().count(), MAX_CHARACTERS + 1);
    assert!(text.starts_with("sin(x/2 + sin(x/2 + ") && text.ends_with('…'));
}

#[test]
fn deep_calls_expand() {
    let mut pool = Pool::new();
    let mut nested = [read(&mut pool, "(x + 1)*(x - 1)"), read(&mut pool, "x^2 - 1")];
    for _ in 0..DEPTH {
        nested = nested.map(|expr| pool.call(Function::Atan, &[expr]));
    }
    assert_ne!(nested[0], nested[1]);
    assert_eq!(pool.expand(nested[0]), Ok(nested[1]));
}

/// A shared expression of 3 nodes a level has a text of 2^60 characters.
#[test]
fn text_of_a_shared_expression_is_cut() {
    let mut pool = Pool::new();
    let mut expr = read(&mut pool, "x");
    for _ in 0..60 {
        let sine = pool.call(Function::Sin, &[expr]);
        let cosine = pool.call(Function::Cos, &[expr]);
        expr = pool.call(Function::Atan2, &[sine, cosine]);
    }
    assert!(pool.len() < 250);
    assert_eq!(write(&pool, expr).chars().count(), MAX_CHARACTERS + 1);
}

#[test]
fn huge_powers_stay_powers() {
    for text in ["2^1000000000", "2^1000000000000000000000", "(1/3)^1000000000", "7^(1000000001/2)", "(2/3)^-123456789"]
    {
        let mut pool = Pool::new();
        let expr = read(&mut pool, text);
        assert!(matches!(pool.node(expr), Node::Product(_)), "{text}: {}", write(&pool, expr));
        let same = write(&pool, expr);
        assert_eq!(read(&mut pool, &same), expr, "{text}");
        let inverse = pool.div(expr, expr);
        assert_eq!(inverse, pool.one(), "{text}");
        let with_symbol = read(&mut pool, &format!("({text})*x/({text})"));
        assert_eq!(with_symbol, read(&mut pool, "x"), "{text}");
    }
    let mut pool = Pool::new();
    let expr = read(&mut pool, "(2*x)^1000000000");
    assert_eq!(write(&pool, expr), "x^1000000000*2^1000000000");
    let expr = read(&mut pool, "(2*x)^1000000000/(2*x)^999999998");
    assert_eq!(write(&pool, expr), "4*x^2");
    let expr = read(&mut pool, "1^1000000000000*x");
    assert_eq!(write(&pool, expr), "x");
}

/// Each square doubles the bits: 2^(2^60) of them without a bound.
#[test]
fn repeated_squares_are_bounded() {
    let mut pool = Pool::new();
    for start in ["3/2", "3*x/2"] {
        let mut expr = read(&mut pool, start);
        for _ in 0..60 {
            expr = pool.mul(expr, expr);
        }
        assert!(write(&pool, expr).len() < 10_000, "{}", write(&pool, expr).len());
        let back = pool.power(expr, &ratio(0, 1));
        assert_eq!(back, pool.one());
    }
}

/// Numbers beyond the bound are not folded, and keep their value.
#[test]
fn large_numbers_keep_their_value() {
    let mut pool = Pool::new();
    // Close to 2, with 3172 bits.
    let two = read(&mut pool, "2 + 1/3^1000");
    assert!(pool.as_number(two).is_some());
    let x = read(&mut pool, "x");
    let double = pool.mul(two, x);
    let square = pool.mul(double, double);
    let back = pool.div(square, double);
    let cube = pool.product(&[square, two, x]);
    let found = pool.evaluate_all(&[double, square, back, cube], &mut |_| 1.5);
    assert_eq!(found, [3.0, 9.0, 3.0, 27.0]);
    let ratio = pool.div(square, square);
    assert_eq!(ratio, pool.one());
}

#[test]
fn expansion_is_bounded() {
    let mut texts =
        ["(x + y)^1000000000", "(x + y)^99999999999999999999", "(x + y + z + w)^60"].map(str::to_owned).to_vec();
    texts.push((0..40).map(|power| format!("(x^{power} + y)")).collect::<Vec<_>>().join("*"));
    for text in texts {
        let mut pool = Pool::new();
        let expr = read(&mut pool, &text);
        assert_eq!(pool.expand(expr), Err(TooLarge::Terms { limit: 50_000 }), "{text}");
    }
    // A high power of a constant stays unexpanded.
    let mut pool = Pool::new();
    let power = read(&mut pool, "(1 + sqrt(2))^1000000000");
    assert_eq!(pool.expand(power), Ok(power));
    let message = "multiplying the expression out takes more than 50000 terms";
    assert_eq!(TooLarge::Terms { limit: 50_000 }.to_string(), message);
}

#[test]
fn wide_sums_and_products() {
    let mut pool = Pool::new();
    let symbols: Vec<Expr> = (0..20_000).map(|place| pool.symbol(format!("q{place}"))).collect();
    let squares: Vec<Expr> = symbols.iter().map(|symbol| pool.mul(*symbol, *symbol)).collect();
    let sum = pool.sum(&squares);
    let derivative = pool.partial_derivative(sum, "q7");
    assert_eq!(write(&pool, derivative), "2*q7");
    let product = pool.product(&symbols);
    let derivative = pool.partial_derivative(product, "q7");
    let back = pool.mul(derivative, symbols[7]);
    assert_eq!(back, product);
}

#[test]
fn undefined_expressions_are_nan() {
    let mut pool = Pool::new();
    let undefined = pool.undefined();
    assert!(pool.is_undefined(undefined) && !pool.is_zero(undefined) && pool.as_number(undefined).is_none());
    assert!(pool.evaluate(undefined, &mut |_: &String| 0.0).is_nan());
    let [zero, one] = [pool.zero(), pool.one()];
    assert_eq!(pool.scale(undefined, &ratio(0, 1)), undefined);
    assert_eq!(pool.product(&[zero, undefined]), undefined);
    assert_eq!(pool.sum(&[one, undefined]), undefined);
    assert_eq!(pool.div(one, undefined), undefined);
    assert_eq!(pool.expand(undefined), Ok(undefined));
    assert_eq!(pool.derivative(undefined, &mut |pool, _| pool.zero()), undefined);
    // A symbol that later becomes 0 is then found.
    let x = pool.symbol("x".to_owned());
    let inverse = pool.div(one, x);
    assert!(pool.evaluate(inverse, &mut |_| 0.0).is_infinite());
    assert_eq!(pool.substitute(inverse, &mut |_, _| Some(zero)), undefined);
}

/// Numbers become floating point with one rounding, for any size of numerator and denominator.
#[test]
fn exact_numbers_round_correctly() {
    let table: [(&str, f64); 7] = [
        ("1/3", 1.0 / 3.0),
        ("1/10", 0.1),
        ("123456789012345678901234567890/7", 123_456_789_012_345_678_901_234_567_890.0 / 7.0),
        ("10^400", f64::INFINITY),
        ("10^300", 1e300),
        ("10^-310", 1e-310),
        ("10^-400", 0.0),
    ];
    for (text, expected) in table {
        let mut pool = Pool::new();
        let expr = read(&mut pool, text);
        let found = pool.evaluate(expr, &mut |_| f64::NAN);
        assert_eq!(found.to_bits(), expected.to_bits(), "{text}: {found:e} instead of {expected:e}");
    }
}

/// The work of a pool is counted, and ends reproducibly.
#[test]
fn work_is_bounded() {
    const LIMIT: usize = 100_000;
    let grow = |pool: &mut Pool| {
        let mut expr = pool.symbol("x".to_owned());
        for place in 0..10_000 {
            let one = pool.integer(place);
            let sum = pool.add(expr, one);
            let sine = pool.call(Function::Sin, &[sum]);
            expr = pool.mul(expr, sine);
        }
        expr
    };
    let sizes = [0, 1].map(|_| {
        let mut pool = Pool::bounded(LIMIT);
        let expr = grow(&mut pool);
        assert!(pool.is_exhausted() && pool.is_undefined(expr));
        assert_eq!((pool.work(), pool.within_work()), (LIMIT, Err(TooLarge::Work { limit: LIMIT })));
        pool.len()
    });
    assert!(sizes[0] == sizes[1] && (100..LIMIT / 12).contains(&sizes[0]), "{sizes:?}");
    let message = "the expressions take more than 100000 steps of algebra";
    assert_eq!(TooLarge::Work { limit: LIMIT }.to_string(), message);

    // Every later request ends at once without a result.
    let mut pool = Pool::bounded(LIMIT);
    let x = pool.symbol("x".to_owned());
    let sum = pool.add(x, pool.one());
    grow(&mut pool);
    assert!(pool.reachable(&[sum]).is_empty() && pool.evaluate(sum, &mut |_| 1.0).is_nan());
    assert_eq!(pool.derivative(sum, &mut |pool, _| pool.one()), pool.undefined());
    assert_eq!(pool.substitute(sum, &mut |_, _| None), pool.undefined());
    assert_eq!(pool.expand(sum), Err(TooLarge::Work { limit: LIMIT }));
    assert_eq!(pool.uncounted(|pool| pool.evaluate(sum, &mut |_| 1.0)).to_bits(), 2.0_f64.to_bits());

    let mut pool = Pool::bounded(LIMIT);
    let expr = read(&mut pool, "sin(x)*(x + 1)^2/3");
    let before = pool.work();
    assert!(before > 0 && pool.reachable(&[expr]).len() == 5 && pool.work() > before);
    assert_eq!(pool.within_work(), Ok(()));
}

/// A number costs the square of its digits.
#[test]
fn long_numbers_are_work() {
    let work = |count: i64| {
        let mut pool = Pool::bounded(usize::MAX);
        let parts: Vec<Expr> = (1..count).map(|place| pool.number(ratio(1, place))).collect();
        let before = pool.work();
        pool.sum(&parts);
        pool.work() - before
    };
    let (short, long) = (work(100), work(1600));
    // 1/1 + … + 1/1600 has 4600 bits: 16 times as many terms are about 16³ times as much work.
    assert!(long > 1000 * short, "{short} and {long}");
}

/// Numbers that differ in their last digits only are found as fast as short ones.
#[test]
fn many_long_numbers_are_distinguished() {
    let mut pool = Pool::new();
    let x = pool.symbol("x".to_owned());
    let long = ratio(2, 1).pow(100);
    let multiples: Vec<Expr> = (0..20_000).map(|place| pool.scale(x, &(&long + ratio(place, 1)))).collect();
    let again = pool.scale(x, &(&long + ratio(777, 1)));
    assert_eq!(multiples[777], again);
    assert_eq!(multiples.iter().collect::<std::collections::BTreeSet<_>>().len(), 20_000);
}
