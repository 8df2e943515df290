//! Derivatives of motions where numbers are extreme: slopes without a bound, and coordinates in units that are far apart.

use nalgebra::{DMatrix, SMatrix};
use vi_core::derivatives::{Covector, Lyapunov, Objective, Tangent, Variation, gradient};
use vi_core::{FixedStep, Gauss, SVector, State, StepError, lagrangian, nalgebra};

lagrangian! {
    /// A force that is zero at x = 0, where its slope has no bound.
    struct Kink {
        param k = 1.0;
        coord x;
        L = dot(x)^2 / 2 - k * abs(x)^(3/2);
        discretize trapezoidal;
    }
}

/// The last coordinate.
struct Last;

impl<I> Objective<I, 1> for Last {
    fn slope(&self, step: u64, _state: &State<1>) -> Covector<1> {
        let weight = if step == 1 { 1.0 } else { 0.0 };
        Covector { q: SVector::repeat(weight), p: SVector::repeat(weight), ..Covector::zero() }
    }
}

#[test]
fn a_slope_without_a_bound_is_told() {
    // One step ends exactly at x = 0.
    let start = State { t: 0.0, q: SVector::from([-1.0]), p: SVector::from([0.25]) };
    let run = FixedStep::new(Kink::default(), start, 1.0).expect("valid");
    let mut tangent = Tangent::new(run.clone(), Variation::of_state());
    let is_told = |outcome: Result<(), StepError>| matches!(outcome, Err(StepError::NonFinite { t: 0.0, quantity, .. }) if quantity.contains("variation"));
    let failure = tangent.step().map(drop);
    assert_eq!(tangent.run().state().q, SVector::from([0.0]));
    assert!(is_told(failure), "{failure:?}");
    assert_eq!(tangent.step().map(drop), failure);
    assert!(is_told(gradient(&run, 1, 1, &Last).map(drop)));
    assert!(is_told(Lyapunov::new(run, 1).advance(1)));
}

lagrangian! {
    /// A mass on a hilltop, whose variations grow without end, and a brake.
    struct Hill {
        param k = 1.0, c = 0.0;
        coord x;
        L = dot(x)^2 / 2 + k * x^2 / 2;
        force x = -c * dot(x);
        discretize midpoint;
    }
}

/// Whether an error tells that a number of this name is not finite.
fn is_not_finite<T>(outcome: &Result<T, StepError>, name: &str) -> bool {
    matches!(outcome, Err(StepError::NonFinite { quantity, .. }) if quantity.contains(name))
}

/// The last coordinate after so many steps, by this weight.
struct Weighted(u64, f64);

impl<I> Objective<I, 1> for Weighted {
    fn slope(&self, step: u64, _state: &State<1>) -> Covector<1> {
        let weight = if step == self.0 { self.1 } else { 0.0 };
        Covector { q: SVector::repeat(weight), ..Covector::zero() }
    }
}

#[test]
fn what_grows_beyond_the_range_of_numbers_is_told() {
    // cosh(t) of 700 and more is beyond them.
    let top = State { t: 0.0, q: SVector::from([0.0]), p: SVector::from([0.0]) };
    let fixed = FixedStep::new(Hill::default(), top, 0.5).expect("valid");
    let gauss = Gauss::<_, 1, 4>::new(Hill::default(), top, 0.5).expect("valid");
    assert!(is_not_finite(&gradient(&fixed, 2000, 0, &Weighted(2000, 1.0)), "gradient"));
    assert!(is_not_finite(&gradient(&gauss, 2000, 0, &Weighted(2000, 1.0)), "gradient"));
    for weight in [f64::NAN, f64::INFINITY] {
        assert!(is_not_finite(&gradient(&fixed, 5, 0, &Weighted(5, weight)), "gradient"));
        assert!(is_not_finite(&gradient(&fixed, 5, 0, &Weighted(2, weight)), "gradient"));
    }
    let mut run = fixed.clone();
    let before = *run.node();
    run.step().expect("solvable");
    let huge = Variation { q: SVector::from([1e155]), parameters: vec![1e155], ..Variation::zero() };
    assert!(run.second_variation(&before, &Variation::of_coordinate(0), &Variation::of_coordinate(0)).is_ok());
    assert!(run.second_variation(&before, &huge, &huge).is_err());
    let large = Variation { q: SVector::from([1e154]), parameters: vec![1e154], ..Variation::zero() };
    assert!(is_not_finite(&run.second_variation(&before, &large, &large), "variation"));
    // What goes in is no number.
    let none = Variation { q: SVector::from([f64::NAN]), ..Variation::zero() };
    assert!(is_not_finite(&Tangent::new(fixed, vec![none.clone()]).step(), "variation"));
    assert!(is_not_finite(&Tangent::new(gauss, vec![none]).step(), "variation"));
}

#[test]
fn an_exponent_without_a_bound_is_told() {
    // The step ends at rest from everywhere, c h = 2: nothing is left of one direction.
    let start = State { t: 0.0, q: SVector::from([0.0]), p: SVector::from([1.0]) };
    let run = FixedStep::new(Hill { k: 0.0, c: 20.0 }, start, 0.1).expect("valid");
    let mut exponents = Lyapunov::new(run, 2);
    let failure = exponents.advance(3);
    assert!(is_not_finite(&failure, "Lyapunov exponent"), "{failure:?}");
    assert!(exponents.exponents().iter().all(|exponent| exponent.is_nan()), "{:?}", exponents.exponents());
    // One direction alone loses length once, and keeps it then.
    let run = FixedStep::new(Hill { k: 0.0, c: 20.0 }, start, 0.1).expect("valid");
    let mut largest = Lyapunov::new(run, 1);
    largest.advance(1000).expect("a length is left");
    assert!(largest.exponents()[0].abs() < 0.01, "{:?}", largest.exponents());
}

lagrangian! {
    /// Two coupled oscillators, the second in the unit 1/u.
    struct Units {
        param u = 1.0, c = 0.3, b = 0.2;
        coord x, y;
        L = dot(x)^2 / 2 + u^2 * dot(y)^2 / 2 + c * u * dot(x) * dot(y) - x^2 / 2 - u^2 * y^2 / 2 - b * (x + u * y)^4;
        discretize midpoint;
    }
}

/// The tangent map over some steps, in units in which both oscillators are alike.
fn map<const STAGES: usize>(u: f64, c: f64) -> SMatrix<f64, 4, 4> {
    let system = Units { u, c, ..Units::default() };
    let start = State::at(&system, 0.0, [0.5, -0.3 / u], [0.2, 0.4 / u]);
    let run = Gauss::<_, 2, STAGES>::new(system, start, 0.2).expect("valid");
    let mut tangent = Tangent::new(run, Variation::of_state());
    for _ in 0..10 {
        tangent.step().expect("solvable");
    }
    let units = [1.0, 1.0 / u, 1.0, u];
    let entry = |row: usize, column: usize| {
        let variation = &tangent.variations()[column];
        let entry = if row < 2 { variation.q[row] } else { variation.p[row - 2] };
        entry * units[column] / units[row]
    };
    SMatrix::from_fn(entry)
}

#[test]
fn derivatives_do_not_depend_on_units() {
    for c in [0.3, 1e-8] {
        for u in [1e-10, 1e-3, 1e6, 1e10] {
            let errors = [
                (map::<1>(u, c) - map::<1>(1.0, c)).amax(),
                (map::<4>(u, c) - map::<4>(1.0, c)).amax(),
                (map::<8>(u, c) - map::<8>(1.0, c)).amax(),
            ];
            let worst = errors.into_iter().fold(0.0, f64::max);
            assert!(worst < 1e-14, "u = {u:e}, c = {c:e}: {errors:?}");
        }
    }
    // They are derivatives of something that moves.
    let moved = DMatrix::from_iterator(4, 4, map::<4>(1.0, 0.3).iter().copied()) - DMatrix::identity(4, 4);
    assert!(moved.amax() > 0.1);
}
