//! Sensitivities for extreme numbers: unbounded slopes, and coordinates in very different units.

use nalgebra::{DMatrix, SMatrix};
use vi_core::derivatives::{Covector, Differentiable, Lyapunov, Objective, Tangent, Variation, gradient};
use vi_core::{
    Composition, EnergyPreserving, Fallback, FixedStep, Gauss, Method, Run, SVector, Starts, State, StepError,
    lagrangian, nalgebra,
};

lagrangian! {
    /// A force that is zero at x = 0 with an unbounded slope.
    struct Kink {
        param k = 1.0;
        coord x;
        L = dot(x)^2 / 2 - k * abs(x)^(3/2);
        discretize trapezoidal;
    }
}

/// The last coordinate.
struct Last;

impl<M: Method<S, 1>, S> Objective<M, S, 1> for Last {
    fn slope(&self, step: u64, _state: &State<1>) -> Covector<1> {
        let weight = if step == 1 { 1.0 } else { 0.0 };
        Covector { q: SVector::repeat(weight), p: SVector::repeat(weight), ..Covector::zero() }
    }
}

#[test]
fn a_slope_without_a_bound_is_told() {
    // One step ends exactly at x = 0.
    let start = State { t: 0.0, q: SVector::from([-1.0]), p: SVector::from([0.25]) };
    let run = Kink::default().at_state(start).integrate(FixedStep, 1.0).expect("valid");
    let mut tangent = Tangent::new(run.clone(), Variation::of_state());
    let is_told = |outcome: Result<(), StepError>| matches!(outcome, Err(StepError::NonFinite { t: 0.0, quantity, .. }) if quantity.contains("tangent vector"));
    let failure = tangent.step().map(drop);
    assert_eq!(tangent.run().state().q, SVector::from([0.0]));
    assert!(is_told(failure), "{failure:?}");
    assert_eq!(tangent.step().map(drop), failure);
    assert!(is_told(gradient(&run, 1, 1, &Last).map(drop)));
    assert!(is_told(Lyapunov::new(run, 1).expect("one").advance(1)));
}

lagrangian! {
    /// A mass on a hilltop, whose tangent vectors grow without bound, and a brake.
    struct Hill {
        param k = 1.0, c = 0.0;
        coord x;
        L = dot(x)^2 / 2 + k * x^2 / 2;
        force x = -c * dot(x);
        discretize midpoint;
    }
}

/// Whether an error reports a non-finite number with this name.
fn is_not_finite<T>(outcome: &Result<T, StepError>, name: &str) -> bool {
    matches!(outcome, Err(StepError::NonFinite { quantity, .. }) if quantity.contains(name))
}

/// Whether an error reports, with this word, why a step from the time `t` has no derivative.
fn has_none(outcome: &Result<(), StepError>, t: f64, word: &str) -> bool {
    matches!(outcome, Err(StepError::NoDerivative { t: at, because }) if at.total_cmp(&t).is_eq() && because.contains(word))
}

/// Only the last step of a run is differentiated, and only with respect to existing parameters.
fn differentiates_its_last_step<M: Differentiable<Hill, 1>>(mut run: Run<M, Hill, 1>) {
    let start = *run.node();
    let states = Variation::of_state;
    assert!(has_none(&run.vary(&start, &mut states()), start.t, "last"), "before any step");
    run.step().expect("solvable");
    run.vary(&start, &mut states()).expect("the last step");
    let after = *run.node();
    assert!(has_none(&run.vary(&after, &mut states()), after.t, "last"), "the node reached");
    run.step().expect("solvable");
    assert!(has_none(&run.vary(&start, &mut states()), start.t, "last"), "a node before the last step");
    let many = Variation { parameters: vec![0.0; 3], ..Variation::zero() };
    assert!(has_none(&run.vary(&after, &mut [many]), after.t, "more parameters"));
    run.vary(&after, &mut states()).expect("the last step");
    // The last step had other parameters: its derivative with respect to the new ones would be wrong.
    run.set_parameters(|hill| hill.k *= 2.0).expect("regular");
    assert!(has_none(&run.vary(&after, &mut states()), after.t, "before any change of parameters"), "other parameters");
    let changed = *run.node();
    run.step().expect("solvable");
    run.vary(&changed, &mut states()).expect("the last step, with the new parameters");
    // The last step ends at a given time, up to rounding.
    let before = *run.node();
    run.until(before.t + 1.25 * run.h()).expect("solvable");
    assert!(has_none(&run.vary(&before, &mut states()), before.t, "last"), "two steps");
}

#[test]
fn only_the_last_step_is_differentiated() {
    let start = State { t: 0.7, q: SVector::from([1.3]), p: SVector::from([0.4]) };
    let hill = Hill { k: -2.0, c: 0.1 };
    let fixed = hill.at_state(start).integrate(FixedStep, 0.1).expect("valid");
    differentiates_its_last_step(fixed.clone());
    differentiates_its_last_step(hill.at_state(start).integrate(Gauss::<3>, 0.1).expect("valid"));
    differentiates_its_last_step(hill.at_state(start).integrate(Composition::KAHAN_LI_6, 0.1).expect("valid"));
    let energy = EnergyPreserving::from_midpoint(hill, 0.7, [1.3], [0.4], 0.1).expect("valid");
    differentiates_its_last_step(energy.clone());
    let leaping = energy.with_fallback(Fallback::FixedSteps);
    let failure = Tangent::new(leaping, Variation::of_state()).step().map(drop);
    assert!(failure.as_ref().is_err_and(|error| error.to_string().ends_with("take steps without one")), "{failure:?}");
    // Second derivatives too.
    let mut run = fixed;
    let first = *run.node();
    let one = Variation::of_coordinate(0).expect("a coordinate");
    let end = Covector { q: [1.0].into(), p: [-1.0].into(), ..Covector::zero() };
    let second = |run: &Run<FixedStep, Hill, 1>, other: &Variation<1>| {
        run.curvature(&first, &[one.clone(), other.clone()], &end).map(drop)
    };
    assert!(has_none(&second(&run, &one), 0.7, "last"));
    run.step().expect("solvable");
    second(&run, &one).expect("the last step");
    assert!(has_none(&second(&run, &Variation { parameters: vec![0.0; 3], ..one.clone() }), 0.7, "more parameters"));
    let mut changed = run.clone();
    changed.set_parameters(|hill| hill.k *= 2.0).expect("regular");
    assert!(has_none(&second(&changed, &one), 0.7, "before any change of parameters"));
    // A stored run also knows this.
    let changed = Run::restart(*changed.system(), FixedStep, changed.checkpoint()).expect("its own system");
    assert!(has_none(&second(&changed, &one), 0.7, "before any change of parameters"));
    run.step().expect("solvable");
    assert!(has_none(&second(&run, &one), 0.7, "last"));
}

#[test]
fn names_and_indices_that_do_not_exist_are_told() {
    let unknown = Err(StepError::UnknownParameter { system: "Hill", parameters: &["k", "c"] });
    assert_eq!(Variation::<1>::of_parameter::<Hill>("kk"), unknown);
    let text = unknown.map_err(|error| error.to_string());
    assert_eq!(text, Err("`Hill` has no parameter of the given name; its parameters are `k`, `c`".to_owned()));
    let input = |outcome: Result<Variation<1>, StepError>| match outcome {
        Err(StepError::InvalidInput { input, value, .. }) => (input, value),
        other => panic!("{other:?}"),
    };
    assert_eq!(input(Variation::of_coordinate(99)), ("the index of a coordinate", 99.0));
    assert_eq!(input(Variation::of_momentum(1)), ("the index of a momentum", 1.0));
    assert_eq!(
        Variation::<1>::of_coordinate(0).map(|of| vec![of, Variation::of_momentum(0).expect("one")]),
        Ok(Variation::of_state())
    );
    let run = Hill::default()
        .at_state(State { t: 0.0, q: [0.3].into(), p: [0.1].into() })
        .integrate(FixedStep, 0.1)
        .expect("valid");
    for count in [0, 3] {
        let refused = Lyapunov::new(run.clone(), count).map(drop);
        assert!(matches!(refused, Err(StepError::InvalidInput { .. })), "{count}: {refused:?}");
    }
    // A gradient with respect to a name that does not exist would shift the columns after it.
    let misspelt = gradient(&run, 1, 1, &Misspelt).map(drop);
    assert!(matches!(misspelt, Err(StepError::UnknownParameter { system: "Hill", .. })), "{misspelt:?}");
}

/// Requests the gradient with respect to one missing and one existing parameter.
struct Misspelt;

impl<M: Method<S, 1>, S> Objective<M, S, 1> for Misspelt {
    fn parameters(&self) -> &[&str] {
        &["kk", "c"]
    }

    fn slope(&self, _step: u64, _state: &State<1>) -> Covector<1> {
        Covector { q: SVector::repeat(1.0), ..Covector::zero() }
    }
}

lagrangian! {
    /// A force with an unbounded slope at x = 0, at which it is not zero.
    struct Root {
        coord x;
        L = dot(x)^2 / 2;
        force x = 1.5 + sqrt(abs(x));
        discretize midpoint;
    }
}

#[test]
fn a_start_where_the_slope_of_a_force_has_no_bound_is_told() {
    let start = State { t: 0.7, q: SVector::from([0.0]), p: SVector::from([0.0]) };
    let mut run = Root::default().at_state(start).integrate(FixedStep, 0.1).expect("the velocity is known");
    let failure = run.step();
    assert!(is_not_finite(&failure, "derivative of the momentum equation"), "{failure:?}");
    // Away from x = 0 it is an ordinary step.
    let start = State { p: SVector::from([0.1]), ..start };
    Root::default().at_state(start).integrate(FixedStep, 0.1).expect("valid").step().expect("solvable");
}

/// The last coordinate after this number of steps, times this weight.
struct Weighted(u64, f64);

impl<M: Method<S, 1>, S> Objective<M, S, 1> for Weighted {
    fn slope(&self, step: u64, _state: &State<1>) -> Covector<1> {
        let weight = if step == self.0 { self.1 } else { 0.0 };
        Covector { q: SVector::repeat(weight), ..Covector::zero() }
    }
}

#[test]
fn what_grows_beyond_the_range_of_numbers_is_told() {
    // cosh(t) overflows for 700 and more.
    let top = State { t: 0.0, q: SVector::from([0.0]), p: SVector::from([0.0]) };
    let fixed = Hill::default().at_state(top).integrate(FixedStep, 0.5).expect("valid");
    let gauss = Hill::default().at_state(top).integrate(Gauss::<4>, 0.5).expect("valid");
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
    let one = Variation::of_coordinate(0).expect("a coordinate");
    let end = Covector { q: [1.0].into(), p: [-1.0].into(), ..Covector::zero() };
    assert!(run.curvature(&before, &[one], &end).is_ok());
    assert!(is_not_finite(&run.curvature(&before, std::slice::from_ref(&huge), &end), "tangent vector"));
    let mut collocated = gauss.clone();
    let first = *collocated.node();
    collocated.step().expect("solvable");
    assert!(is_not_finite(&collocated.curvature(&first, &[huge], &end), "tangent vector"));
    let large = Variation { q: SVector::from([1e154]), parameters: vec![1e154], ..Variation::zero() };
    assert!(is_not_finite(&run.curvature(&before, &[large], &end), "tangent vector"));
    // The input is not a number.
    let none = Variation { q: SVector::from([f64::NAN]), ..Variation::zero() };
    assert!(is_not_finite(&Tangent::new(fixed, vec![none.clone()]).step(), "tangent vector"));
    assert!(is_not_finite(&Tangent::new(gauss, vec![none]).step(), "tangent vector"));
}

#[test]
fn an_exponent_without_a_bound_is_told() {
    // With c h = 2 every step ends at rest: one direction collapses.
    let start = State { t: 0.0, q: SVector::from([0.0]), p: SVector::from([1.0]) };
    let run = Hill { k: 0.0, c: 20.0 }.at_state(start).integrate(FixedStep, 0.1).expect("valid");
    let mut exponents = Lyapunov::new(run, 2).expect("two");
    let failure = exponents.advance(3);
    assert!(is_not_finite(&failure, "Lyapunov exponent"), "{failure:?}");
    assert!(exponents.exponents().iter().all(|exponent| exponent.is_nan()), "{:?}", exponents.exponents());
    // Backward in time they are the exponents of the reversed motion, largest first: λ² − c λ − k = 0.
    let start = State { t: 0.0, q: SVector::from([1e-9]), p: SVector::from([0.0]) };
    let run = Hill { k: 1.0, c: 0.5 }.at_state(start).integrate(Gauss::<4>, -0.1).expect("valid");
    let mut backwards = Lyapunov::new(run, 2).expect("two");
    backwards.advance(200).expect("no step fails");
    let [largest, smallest] = backwards.exponents()[..] else { panic!("two exponents") };
    let root = (0.25_f64 * 0.25 + 1.0).sqrt();
    // Measured 1.3e-2, a term of order 1/t; their sum is accurate to rounding.
    assert!((largest - 0.25 - root).abs() < 0.02 && (smallest - 0.25 + root).abs() < 0.02, "{largest} {smallest}");
    assert!((largest + smallest - 0.5).abs() < 1e-12, "{largest} {smallest}");
    // A single direction shrinks once, and then keeps its length.
    let run = Hill { k: 0.0, c: 20.0 }.at_state(start).integrate(FixedStep, 0.1).expect("valid");
    let mut largest = Lyapunov::new(run, 1).expect("one");
    largest.advance(1000).expect("a length is left");
    assert!(largest.exponents()[0].abs() < 0.01, "{:?}", largest.exponents());
}

lagrangian! {
    /// Two coupled oscillators, the second in units of 1/u.
    struct Units {
        param u = 1.0, c = 0.3, b = 0.2;
        coord x, y;
        L = dot(x)^2 / 2 + u^2 * dot(y)^2 / 2 + c * u * dot(x) * dot(y) - x^2 / 2 - u^2 * y^2 / 2 - b * (x + u * y)^4;
        discretize midpoint;
    }
}

/// The tangent map over some steps, in units with equal oscillators.
fn map<const STAGES: usize>(u: f64, c: f64) -> SMatrix<f64, 4, 4> {
    let system = Units { u, c, ..Units::default() };
    let start = State::at(&system, 0.0, [0.5, -0.3 / u], [0.2, 0.4 / u]);
    let run = system.at_state(start).integrate(Gauss::<STAGES>, 0.2).expect("valid");
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
    // They are derivatives of a moving system.
    let moved = DMatrix::from_iterator(4, 4, map::<4>(1.0, 0.3).iter().copied()) - DMatrix::identity(4, 4);
    assert!(moved.amax() > 0.1);
}
