//! Rust functions, tables and conditions in systems: against the same functions written in the language, against the
//! polynomials of a table, and without a value.

use vi_core::lagrangian::Undefined;
use vi_core::prelude::*;
use vi_core::real::{Dual, Lanes};
use vi_core::stepping::Convertible;
use vi_core::{Lagrangian, SVector};

/// Rust functions for the systems below.
mod laws {
    use vi_core::real::Number;

    pub(super) fn wave<T: Number>(a: T) -> T {
        a.sin()
    }

    pub(super) fn coupling<T: Number>(a: T, b: T) -> T {
        a * a * (b + a).cos()
    }

    pub(super) fn triple<T: Number>(a: T, b: T, c: T) -> T {
        a * b * c + (a - c).exp()
    }

    /// A piecewise law with its own table.
    pub(super) fn piecewise<T: Number>(a: T) -> T {
        let stiff = a - T::real(0.5);
        a * a + stiff.if_positive(stiff * stiff * stiff, T::real(0.0))
    }

    pub(super) fn until_one<T: Number>(a: T) -> T {
        (T::real(1.0) - a).sqrt()
    }
}

lagrangian! {
    /// A system of Rust functions of one, two and three arguments.
    struct WithFunctions {
        param m = 1.3, k = 0.7;
        coord x, y;
        fn wave(a) = laws::wave;
        fn coupling(a, b) = self::laws::coupling;
        fn triple(a, b, c) = crate::functions::laws::triple;
        fn piecewise(a) = laws::piecewise;
        L = m * (dot(x)^2 + dot(y)^2) / 2 - k * wave(2 * x) - coupling(x, y) / 3 - triple(x / 4, y / 5, t / 9) - piecewise(x)
            + dot(wave(y)) / 7 - y^2;
        force x = -wave(dot(x)) / 10;
        discretize midpoint;
        check { x = 0.3, y = 0.2, dot(x) = 0.5, dot(y) = -0.4; h = 0.01; }
    }
}

lagrangian! {
    /// The same system in the language.
    struct Written {
        param m = 1.3, k = 0.7;
        coord x, y;
        fn coupling(a, b) = a * a * cos(b + a);
        fn triple(a, b, c) = a * b * c + exp(a - c);
        fn piecewise(a) = a^2 + if a > 0.5 { (a - 0.5)^3 } else { 0 };
        L = m * (dot(x)^2 + dot(y)^2) / 2 - k * sin(2 * x) - coupling(x, y) / 3 - triple(x / 4, y / 5, t / 9) - piecewise(x)
            + dot(sin(y)) / 7 - y^2;
        force x = -sin(dot(x)) / 10;
        discretize midpoint;
    }
}

/// The largest difference of two runs after the same steps.
macro_rules! difference {
    ($left:expr, $right:expr, $q:expr, $v:expr, $method:expr, $h:expr) => {{
        let mut left = $left.at(0.1, $q, $v).integrate($method, $h).expect("a start");
        let mut right = $right.at(0.1, $q, $v).integrate($method, $h).expect("a start");
        let mut largest: f64 = 0.0;
        for _ in 0..40 {
            let (left, right) = (left.step().expect("a step"), right.step().expect("a step"));
            largest = largest.max((left.q - right.q).amax()).max((left.p - right.p).amax());
        }
        largest
    }};
}

#[test]
fn a_rust_function_steps_as_the_same_expression() {
    let (functions, written) = (WithFunctions::default(), Written::default());
    let (q, v) = ([0.3, 0.2], [0.5, -0.4]);
    let differences = [
        difference!(functions, written, q, v, FixedStep, 0.05),
        difference!(functions, written, q, v, Gauss::<3>, 0.2),
        difference!(functions, written, q, v, Composition::KAHAN_LI_6, 0.1),
        difference!(functions, written, q, v, EnergyPreserving, 0.02),
        difference!(functions, written, q, v, EnergyPreservingGauss::<2>, 0.05),
    ];
    // Measured: 2e-16, 4e-16, 4e-16, 8e-13, 1.4e-9. The energy determines the length of a step of two stages to
    // ε/(h^5 D), and the positions depend on it.
    for (difference, bound) in differences.into_iter().zip([1e-15, 1e-15, 1e-15, 2e-12, 3e-9]) {
        assert!(difference <= bound, "{differences:?}");
    }
}

#[test]
fn functions_are_equal_in_every_number_type() {
    fn energies<T: vi_core::real::Real>(t: T, x: [T; 2], v: [T; 2]) -> [T; 2]
    where
        WithFunctions: Convertible<2, In<T> = WithFunctions<T>>,
        Written: Convertible<2, In<T> = Written<T>>,
    {
        let (functions, written) = (WithFunctions::default().convert::<T>(), Written::default().convert::<T>());
        let (q, v) = (SVector::from(x), SVector::from(v));
        [functions.lagrangian(t, &q, &v), written.lagrangian(t, &q, &v)]
    }
    let [found, wanted] = energies(0.1_f64, [0.8, 0.2], [0.5, -0.4]);
    assert!((found - wanted).abs() < 1e-15 && found.abs() > 0.1, "{found} {wanted}");
    let dual = |value, slope| Dual { value, slope };
    let [found, wanted] =
        energies(dual(0.1, 1.0), [dual(0.8, 0.3), dual(0.2, -0.5)], [dual(0.5, 0.1), dual(-0.4, 2.0)]);
    assert!((found.slope - wanted.slope).abs() < 1e-15 && found.slope.abs() > 0.1, "{found:?} {wanted:?}");
    // Lanes on both sides of the condition of `piecewise`.
    let lanes = |a: f64, b: f64| Lanes::<2, false>([a, b]);
    let [found, wanted] =
        energies(lanes(0.1, 0.1), [lanes(0.8, 0.2), lanes(0.2, 0.1)], [lanes(0.5, 0.0), lanes(1.0, 2.0)]);
    for lane in 0..2 {
        assert!((found.0[lane] - wanted.0[lane]).abs() < 1e-15, "{found:?} {wanted:?}");
    }
    let [alone, _] = energies(0.1_f64, [0.2, 0.1], [0.0, 2.0]);
    assert!((found.0[1] - alone).abs() < 1e-15, "each lane has its own side: {found:?} {alone}");
    let [single, _] = energies(0.1_f32, [0.8, 0.2], [0.5, -0.4]);
    let [double, _] = energies(0.1_f64, [0.8, 0.2], [0.5, -0.4]);
    assert!((f64::from(single) - double).abs() < 1e-6);
}

lagrangian! {
    /// A double well whose potential is a table of a cubic, on either side of the middle.
    struct Tabulated {
        param m = 1.3;
        coord x;
        table V(x) = [(-2, -5.6), (-1.5, -1.475), (-0.6, 0.784), (0, 0.4), (0.7, 0.043), (1.1, 0.631), (2, 6.4)];
        L = m * dot(x)^2 / 2 - V(x) - x^4;
        discretize midpoint;
    }
}

lagrangian! {
    /// The same well by the cubic `x^3 - x + 0.4` of the table.
    struct Polynomial {
        param m = 1.3;
        coord x;
        L = m * dot(x)^2 / 2 - (x^3 - x + 0.4) - x^4;
        discretize midpoint;
    }
}

#[test]
fn a_table_of_a_cubic_is_the_cubic() {
    let (table, polynomial) = (Tabulated::default(), Polynomial::default());
    let differences = [
        difference!(table, polynomial, [0.3], [1.1], FixedStep, 0.05),
        difference!(table, polynomial, [0.3], [1.1], Gauss::<4>, 0.2),
        difference!(table, polynomial, [0.3], [1.1], EnergyPreserving, 0.02),
    ];
    for (difference, bound) in differences.into_iter().zip([1e-14, 1e-14, 1e-11]) {
        assert!(difference <= bound, "{differences:?}");
    }
}

/// The text of the error that ends a run, and the time of its last state.
macro_rules! end {
    ($system:expr, $q:expr, $v:expr, $method:expr, $h:expr) => {{
        let mut run = $system.at(0.0, $q, $v).integrate($method, $h).expect("a start");
        let error = loop {
            if let Err(error) = run.step() {
                break error;
            }
            assert!(run.state().t < 10.0, "the run does not end");
        };
        assert!(run.state().q.iter().chain(run.state().p.iter()).all(|number: &f64| number.is_finite()));
        (error.to_string(), run.state())
    }};
}

#[test]
fn every_method_names_the_table_that_it_leaves() {
    let table = Tabulated { m: 0.1 };
    let ends = [
        end!(table, [-0.5], [-20.0], FixedStep, 0.01),
        end!(table, [-0.5], [-20.0], Composition::SUZUKI_4, 0.01),
        end!(table, [-0.5], [-20.0], Gauss::<3>, 0.02),
        end!(table, [-0.5], [-20.0], EnergyPreserving, 0.01),
        end!(table, [-0.5], [-20.0], EnergyPreservingGauss::<2>, 0.01),
    ];
    for (text, state) in ends {
        assert!(text.contains("`V(x)` is given for -2 to 2, not at -2."), "{text}");
        assert!(state.q[0] > -2.1 && state.t > 0.02, "{state:?}");
    }
    let mut outside = table.at(0.0, [3.0], [0.0]).integrate(FixedStep, 0.01).expect("a start");
    let error = outside.step().expect_err("outside at the start");
    assert!(error.to_string().contains("`V(x)` is given for -2 to 2, not at 3"), "{error}");
}

lagrangian! {
    /// A force that has a value up to x = 1.
    struct Bounded {
        coord x;
        fn until_one(a) = laws::until_one;
        L = dot(x)^2 / 2;
        force x = 3 * until_one(x);
        discretize midpoint;
    }
}

#[test]
fn a_function_without_a_value_is_named() {
    let (text, state) = end!(Bounded::default(), [0.0], [1.0], FixedStep, 0.01);
    assert!(text.contains("`until_one(x)` is not finite at 1.0"), "{text}");
    assert!(state.q[0] < 1.01 && state.q[0] > 0.9, "{state:?}");
    let (q, v) = (SVector::from([1.5]), SVector::from([0.0]));
    let wanted = Undefined { function: "until_one(x)", argument: 1.5, range: None };
    assert_eq!(Bounded::default().undefined(0.0, &q, &v), Some(wanted));
    assert_eq!(Bounded::default().undefined(0.0, &SVector::from([0.5]), &v), None);
}

lagrangian! {
    /// A potential whose values are parameters.
    struct Fitted {
        param c[5] = [2.0, 0.7, 0.1, 0.6, 2.2];
        coord x;
        table V(x in -2..2) = c;
        L = dot(x)^2 / 2 - V(x);
        discretize midpoint;
        check { x = 0.3, dot(x) = 0.4; h = 0.01; }
    }
}

/// The derivative of a run with respect to a value of its table, against a difference of runs.
#[test]
fn values_of_a_table_are_parameters() {
    use vi_core::derivatives::{Tangent, Variation};
    let start = |system: Fitted| system.at(0.0, [0.4], [0.8]).integrate(Gauss::<3>, 0.1).expect("a start");
    let mut largest: f64 = 0.0;
    for index in 0..5 {
        let variation =
            Variation { parameters: (0..5).map(|k| f64::from(u8::from(k == index))).collect(), ..Variation::zero() };
        let mut tangent = Tangent::from_start(start(Fitted::default()), vec![variation]).expect("a tangent");
        let moved = |by: f64| {
            let mut system = Fitted::default();
            system.c[index] += by;
            let mut run = start(system);
            (0..30).map(|_| run.step().expect("a step")).last().expect("steps").q[0]
        };
        for _ in 0..30 {
            tangent.step().expect("a step");
        }
        let found = tangent.variations()[0].q[0];
        let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
        largest = largest.max((found - difference).abs());
        assert!(found.abs() > 1e-3, "{index}: {found}");
    }
    assert!(largest < 1e-8, "{largest:e}");
}

/// Conditions: each lane and each number has its own side.
#[test]
fn numbers_select_their_own_side() {
    let x = Lanes::<4, false>([-1.0, 0.0, 2.0, f64::NAN]);
    let chosen = x.if_positive(Lanes([1.0; 4]), Lanes([2.0; 4]));
    assert_eq!(chosen.0[..3], [2.0, 2.0, 1.0]);
    assert!(chosen.0[3].is_nan());
}
