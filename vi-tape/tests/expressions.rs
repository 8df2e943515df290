//! Expressions in the names of a system, and the summands of L.

use vi_erased::function::{Function as _, Points};
use vi_erased::system::Quantity;
use vi_tape::System;
use vi_tape::expressions::{Expressions, Moment, Observable, Smooth, Terms, operations};

/// A mass with tables of every kind, and terms that mix velocities, coordinates and the time.
const TEXT: &str = "struct Tabled {
    param m = 1.3;
    param c[5] = [0.1, 0.4, -0.2, 0.3, 0.2];
    coord x, y;
    table well(x) = [(-2, 1.0), (-1, 0.2), (0, 0.0), (0.7, 0.3), (1.5, 0.9), (2, 1.6), (3, 2.0)] quintic extend;
    table valley(x in -2..2, y in -2..2) = [[2, 1, 2, 3], [1, 0.2, 1, 2], [1, 0.3, 0.8, 2], [2, 1, 2, 2.5]] extend;
    table wind(t in 0..2) = c periodic;
    fn square(a) = a^2;
    let r = sqrt(square(x) + square(y));
    L = m * (dot(x)^2 + dot(y)^2) / 2 - well(x) - valley(x, y) + cos(t) * x * dot(y) + dot(x) * dot(y) * sin(x) / 7;
    force y = wind(t);
}";

const PARAMETERS: [f64; 6] = [1.3, 0.1, 0.4, -0.2, 0.3, 0.2];

#[test]
fn the_summands_have_the_force_and_the_energy_of_the_system() {
    let system = System::parse(TEXT).unwrap_or_else(|error| panic!("{error}"));
    let terms = Terms::of(TEXT).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(terms.costs().count(), 5);
    for (t, q, v) in [(0.3, [0.4, -0.7], [0.9, 0.5]), (1.1, [-1.3, 0.2], [-0.4, 1.6])] {
        let of = |quantity| {
            let mut values = Vec::new();
            system.evaluate(quantity, [&[t], &q, &v], &mut values).expect("a value");
            values
        };
        let a = of(Quantity::Acceleration);
        let found = terms.at(&Moment { t, q: &q, v: &v, a: &a, parameters: &PARAMETERS });
        // The equations of motion: the forces of all summands and f balance.
        for (index, applied) in of(Quantity::Force).into_iter().enumerate() {
            let sum = found.iter().map(|(force, _)| force[index]).sum::<f64>() + applied;
            assert!(sum.abs() < 1e-14, "{sum:e}"); // 8.0e-16
        }
        let energy: f64 = found.iter().map(|(_, energy)| energy).sum();
        assert!((energy - of(Quantity::Energy)[0]).abs() < 1e-14, "{energy}"); // 4.4e-16
    }
}

#[test]
fn a_total_time_derivative_has_no_force() {
    let text = "struct Gauge { coord x; L = dot(x)^2 / 2 - x^2 / 2 + 3 * dot(x) * x^2; }";
    let terms = Terms::of(text).unwrap_or_else(|error| panic!("{error}"));
    let (x, v, a) = (0.4, 0.9, -2.0);
    let found = terms.at(&Moment { q: &[x], v: &[v], a: &[a], ..Moment::default() });
    let named: Vec<String> = terms.costs().map(|(text, _)| text).collect();
    let of = |name: &str| {
        let place = named.iter().position(|term| term == name).unwrap_or_else(|| panic!("{name} in {named:?}"));
        (found[place].0[0], found[place].1)
    };
    assert_eq!(of("dot(x)^2/2"), (2.0, v * v / 2.0));
    assert_eq!(of("-x^2/2"), (-x, x * x / 2.0));
    assert_eq!(of("3*dot(x)*x^2"), (0.0, 0.0));
    let without = "struct Gauge { coord x; L = dot(x)^2 / 2 - x^2 / 2; }";
    let costs: Vec<Option<usize>> = terms.costs().map(|(_, costs)| costs).collect();
    let saved = operations(text).expect("a system") - operations(without).expect("a system");
    let place = named.iter().position(|term| term == "3*dot(x)*x^2").expect("the term");
    assert!(saved > 0 && costs[place] == Some(saved), "{costs:?} {saved}");
}

#[test]
fn expressions_use_the_names_of_the_system() {
    let written = [("u", "m * r"), ("w", "wind(t) + c[1]"), ("a", "x^2 * y - t")];
    let of = Expressions::parse(TEXT, &written).unwrap_or_else(|error| panic!("{error}"));
    let (x, y, v) = (0.6, -0.8, [2.0, 0.5]);
    let at = Moment { t: 0.5, q: &[x, y], v: &v, parameters: &PARAMETERS, ..Moment::default() };
    // The table has the points c at distances of 2/5.
    let at_point = Moment { t: 0.4, ..at };
    for (found, wanted) in of.values(&at_point).into_iter().zip([1.3, 0.4 + 0.4, x * x * y - 0.4]) {
        assert!((found - wanted).abs() < 1e-15, "{found} instead of {wanted}"); // 0
    }
    let [u, _, a] = of.rates(&at)[..] else { panic!("three rates") };
    assert!((u - 1.3 * (x * v[0] + y * v[1])).abs() < 1e-15, "{u}"); // 0
    assert!((a - (2.0 * x * v[0] * y + x * x * v[1] - 1.0)).abs() < 1e-15, "{a}"); // 0
}

#[test]
fn wrong_expressions_are_named() {
    for (expression, said) in [
        ("sin(z)", "error: unknown name `z`\n --> x:1:5"),
        ("sin(y", "--> x:1:"),
        ("dot(y) * x", "error: the expression of `x` has velocities"),
        ("x; let b = y", "expected one expression"),
    ] {
        let found = Expressions::parse(TEXT, &[("x", expression)]).err().expect("a mistake").to_string();
        assert!(found.contains(said), "{expression}: {found}");
    }
}

#[test]
fn an_observable_has_a_shape_and_velocities() {
    let of = |expression| Observable::parse(TEXT, &[], expression).unwrap_or_else(|error| panic!("{error}"));
    let at = Moment { t: 0.4, q: &[0.6, -0.8], v: &[2.0, 0.5], parameters: &PARAMETERS, ..Moment::default() };
    let rate = of("m * dot(r)");
    assert!(rate.shape().is_empty());
    assert!((rate.values(&at)[0] - 1.3 * (0.6 * 2.0 - 0.8 * 0.5)).abs() < 1e-15); // 0
    let rows = of("[[x, dot(y), 1], [t, c[1], wind(t)]]");
    assert_eq!(rows.shape(), [2, 3]);
    for (found, wanted) in rows.values(&at).into_iter().zip([0.6, 0.5, 1.0, 0.4, 0.4, 0.4]) {
        assert!((found - wanted).abs() < 1e-15, "{found} instead of {wanted}"); // 0
    }
    let wrong = Observable::parse(TEXT, &[], "x + [1, 2]").err().map(|error| error.to_string()).unwrap_or_default();
    assert!(wrong.contains("--> expression:1:"), "{wrong}");
}

#[test]
fn derivatives_of_an_expression_are_those_of_differences() {
    let text = "x^2 * dot(y) + m * sin(t) * well(x) - valley(x, y) * c[1]";
    let parsed = || Observable::parse(TEXT, &[], text).unwrap_or_else(|error| panic!("{error}"));
    let (value, slopes) = (parsed(), parsed().derivatives(&[0, 2]));
    assert_eq!(slopes.shape(), [7]);
    // x, y and the velocity of y, but not that of x.
    assert_eq!(slopes.zeros(), [false, false, false, true, false, false, false]);
    // t, q, v, and the two parameters.
    let point = [0.5, 0.6, -0.8, 2.0, 0.5, 1.3, 0.4];
    let at = |[t, x, y, vx, vy, m, c]: [f64; 7]| {
        let mut parameters = PARAMETERS;
        (parameters[0], parameters[2]) = (m, c);
        let (q, v) = ([x, y], [vx, vy]);
        let moment = Moment { t, q: &q, v: &v, parameters: &parameters, ..Moment::default() };
        (value.values(&moment)[0], slopes.values(&moment))
    };
    for (column, slope) in at(point).1.into_iter().enumerate() {
        let moved = |by: f64| at(core::array::from_fn(|of| point[of] + if of == column { by } else { 0.0 })).0;
        let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
        assert!((difference - slope).abs() < 1e-9, "{column}: {difference} {slope}");
    }
    let of_inputs = Observable::parse(TEXT, &[], "m^2").unwrap_or_else(|error| panic!("{error}")).derivatives(&[0]);
    assert_eq!(of_inputs.zeros(), [true, true, true, true, true, false]);
}

#[test]
fn a_cost_has_first_and_second_derivatives() {
    let text =
        "struct Mass { param k = 2.0; input u = 0.0; coord x, y; L = (dot(x)^2 + dot(y)^2) / 2 - k * x; force x = u; }";
    let cost = Smooth::parse(text, &[], "k*u^2*x + sin(t)*dot(y)^2", &[1]).unwrap_or_else(|error| panic!("{error}"));
    assert!(!cost.is_of_inputs());
    // Two points; the second has other parameters.
    let (t, q, v) = ([0.3, 0.7], [0.4, -0.2, 1.5, 0.1], [0.9, 0.5, -0.3, 1.1]);
    let points = Points { t: &t, q: &q, v: &v, parameters: &[2.0, 0.6, 3.0, -1.2] };
    let mut expected = [const { Vec::new() }; 3];
    for (k, (par, t)) in [[2.0, 0.6], [3.0, -1.2]].into_iter().zip(t).enumerate() {
        let ([k_x, u], (x, w), (sine, cosine)) = (par, (q[2 * k], v[2 * k + 1]), t.sin_cos());
        expected[0].push(k_x * u * u * x + sine * w * w);
        // t, x, y, dot(x), dot(y), u
        expected[1].extend([cosine * w * w, k_x * u * u, 0.0, 0.0, 2.0 * sine * w, 2.0 * k_x * u * x]);
        let mut second = [[0.0; 6]; 6];
        (second[0][0], second[4][4], second[5][5]) = (-sine * w * w, 2.0 * sine, 2.0 * k_x * x);
        for (row, column, value) in [(0, 4, 2.0 * cosine * w), (1, 5, 2.0 * k_x * u)] {
            (second[row][column], second[column][row]) = (value, value);
        }
        expected[2].extend(second.concat());
    }
    for (order, expected) in (0..3).zip(expected) {
        let found = cost.at(&points, order);
        assert_eq!(found.len(), expected.len());
        let close = |(found, expected): (&f64, &f64)| (found - expected).abs() < 1e-14; // 1.8e-15
        assert!(found.iter().zip(&expected).all(close), "{order}: {found:?} {expected:?}");
    }
    assert!(Smooth::parse(text, &[], "k*u^2 + 1", &[1]).is_ok_and(|cost| cost.is_of_inputs()));
    let refused = Smooth::parse(text, &[], "[x, y]", &[1]).err().map(|mistakes| mistakes.to_string());
    assert!(refused.is_some_and(|words| words.contains("has the shape [2]")));
}
