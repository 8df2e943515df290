//! Substitution, expansion, and queries of an expression.

use std::collections::BTreeSet;

use vi_expr::{Function, Node};

use crate::Pool;
use crate::notation::{read, write};

/// The midpoint rule, for which no other simplifier is needed.
#[test]
fn a_step_becomes_its_velocity() {
    let table = [
        ("(a + b)/2", "a + h*v/2"),
        ("(b - a)/h", "v"),
        ("h*(m*((b - a)/h)^2/2 - k*((a + b)/2)^2/2)", "h*(m*v^2/2 - k*(a + h*v/2)^2/2)"),
        ("sin(b - a)", "sin(h*v)"),
    ];
    for (input, output) in table {
        let mut pool = Pool::new();
        let end = read(&mut pool, "a + h*v");
        let expr = read(&mut pool, input);
        let result = pool.substitute(expr, &mut |_, symbol| (symbol == "b").then_some(end));
        let expected = read(&mut pool, output);
        assert_eq!(result, expected, "{input}: {}", write(&pool, result));
    }
}

#[test]
fn substitution_is_simultaneous() {
    let mut pool = Pool::new();
    let expr = read(&mut pool, "x - 2*y + sin(x/y)");
    let [x, y] = ["x", "y"].map(|name| pool.symbol(name.to_owned()));
    let swapped = pool.substitute(expr, &mut |_, symbol| Some(if symbol == "x" { y } else { x }));
    assert_eq!(swapped, read(&mut pool, "y - 2*x + sin(y/x)"));
    let nodes = pool.len();
    assert_eq!(pool.substitute(expr, &mut |_, _| None), expr);
    assert_eq!(pool.len(), nodes, "nothing is built where nothing changes");
}

#[test]
fn substitution_meets_a_pole() {
    let mut pool = Pool::new();
    let expr = read(&mut pool, "0*x + y + sin(1/(x - 1))");
    let one = pool.one();
    let result = pool.substitute(expr, &mut |_, symbol| (symbol == "x").then_some(one));
    assert!(pool.is_undefined(result));
}

#[test]
fn expansion() {
    let table = [
        ("(x + y)^2", "x^2 + 2*x*y + y^2"),
        ("(x + 1)*(x - 1)", "x^2 - 1"),
        ("(x + y)^2 - (x - y)^2", "4*x*y"),
        ("x*(y + z) - x*y - x*z", "0"),
        ("(a - b)^3 + (b - a)^3", "0"),
        ("sin((x + 1)*(x - 1)) - sin(x^2 - 1)", "0"),
        ("(x + y)*(x - y)/(x^2 - y^2)", "x^2/(x^2 - y^2) - y^2/(x^2 - y^2)"),
        ("(sqrt(x) + 1)*(sqrt(x) - 1)", "x - 1"),
        ("(sqrt(2) + 1)^2", "2*sqrt(2) + 3"),
        ("(1 + c*sqrt(a + b))*(1 - c*sqrt(a + b))", "1 - a*c^2 - b*c^2"),
        ("m*((a + h*v - a)/h)^2/2", "m*v^2/2"),
        ("(sin(x) + cos(x))^2 - 2*sin(x)*cos(x)", "sin(x)^2 + cos(x)^2"),
        ("1/((x + 1)^2 - x^2)", "1/(2*x + 1)"),
    ];
    for (input, output) in table {
        let mut pool = Pool::new();
        let expr = read(&mut pool, input);
        let result = pool.expand(expr).expect("a small expansion");
        let expected = read(&mut pool, output);
        assert_eq!(result, expected, "{input}: {}", write(&pool, result));
        assert_eq!(pool.expand(result), Ok(result), "{input} expanded twice");
    }
}

/// `Σ_k (n choose k) x^k y^(n-k)`: coefficients by Pascal's triangle.
#[test]
fn expansion_of_a_power_is_the_binomial_theorem() {
    let mut pool = Pool::new();
    let expr = read(&mut pool, "(x + y)^20");
    let result = pool.expand(expr).expect("21 terms");
    let mut row = vec![1_i64];
    for _ in 0..20 {
        let inner = row.windows(2).map(|pair| pair[0] + pair[1]);
        row = [1].into_iter().chain(inner).chain([1]).collect();
    }
    let text: Vec<String> = row.iter().enumerate().map(|(k, c)| format!("{c}*x^{k}*y^{}", 20 - k)).collect();
    assert_eq!(result, read(&mut pool, &text.join(" + ")));
}

#[test]
fn questions() {
    let mut pool = Pool::new();
    let expr = read(&mut pool, "x*sin(y)/2 + pi*z - z*pi + 3");
    let names = ["x", "y"].map(str::to_owned);
    assert_eq!(pool.symbols(expr), BTreeSet::from(names));
    assert!(pool.depends_on(expr, &|symbol| symbol == "y"));
    assert!(!pool.depends_on(expr, &|symbol| symbol == "z"));
    assert_eq!(pool.as_symbol(expr), None);

    let below = pool.reachable(&[expr]);
    assert!(below.is_sorted() && below.last() == Some(&expr));
    assert_eq!(below.len(), 5, "x, y, sin(y), x*sin(y) and the sum");
    for node in below.iter().copied() {
        pool.node(node).each_child(|child| assert!(child < node && below.contains(&child)));
    }
    assert_eq!(pool.reachable(&[]), []);
}

#[test]
fn equal_forms_are_one_node() {
    let mut pool = Pool::new();
    let first = read(&mut pool, "(x + y)*z/2 + sin(x*y)");
    let nodes = pool.len();
    assert_eq!(read(&mut pool, "sin(y*x) - (y + x)*z/-2"), first);
    // New are -2, the multiple by -1/2, and the sum with it subtracted.
    assert!(pool.len() <= nodes + 3, "{} new nodes", pool.len() - nodes);
}

#[test]
fn names_of_functions() {
    for function in Function::ALL {
        assert_eq!(Function::from_name(function.name()), Some(function));
        assert!(matches!(function.arity(), 1 | 2));
    }
    assert_eq!(Function::from_name("sqrt"), None);
    assert_eq!(Function::from_name("Sin"), None);
}

#[test]
fn numbers_are_read_off() {
    let mut pool = Pool::new();
    let expr = read(&mut pool, "1/2 + 1/3 - x/x");
    assert_eq!(pool.as_number(expr), Some(&crate::ratio(-1, 6)));
    assert!(matches!(pool.node(expr), Node::Number(_)));
    let pi = pool.pi();
    assert_eq!(pool.as_number(pi), None);
    let integer = pool.integer(-7);
    assert_eq!(pool.as_number(integer), Some(&crate::ratio(-7, 1)));
}
