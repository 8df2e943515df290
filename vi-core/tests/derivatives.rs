//! Derivatives of runs by every method, over steps, times, events and changes: against differences of the same runs, tangent against adjoint, symplecticity.

use vi_core::derivatives::{Covector, Differentiable, Lyapunov, Objective, Tangent, Variation, gradient};
use vi_core::lagrangian::Parameters;
use vi_core::nalgebra::{DMatrix, SVector};
use vi_core::real::{Dual, Number, Real};
use vi_core::run::Event;
use vi_core::stepping::Convertible;
use vi_core::{
    Composition, EnergyPreserving, EnergyPreservingGauss, Fallback, FixedStep, Gauss, Lagrangian, Run, Starts, State,
    StepError, lagrangian,
};

lagrangian! {
    /// Nothing of it is constant: the mass depends on x, a force damps, the time drives and scales.
    struct Driven {
        param m = 1.3, k = 0.8, c = 0.07, w = 1.7;
        coord x, y;
        L = m / 2 * ((1 + x^2 / 4) * dot(x)^2 + dot(y)^2) - k * (x^2 + 1.5 * y^2) / 2 - k * x^2 * y^2 / 4 - x^4 / 8
            + 0.2 * x * cos(w * t);
        force x = -c * dot(x);
        time_scale = 1 / (1 + k * x^2 + y^2 / 2 + sin(w * t) / 5);
        discretize midpoint;
    }
}

lagrangian! {
    /// The same without force and time.
    struct Free {
        param m = 1.3, k = 0.8;
        coord x, y;
        L = m / 2 * ((1 + x^2 / 4) * dot(x)^2 + dot(y)^2) - k * (x^2 + 1.5 * y^2) / 2 - k * x^2 * y^2 / 4 - x^4 / 8;
        time_scale = 1 / (1 + k * x^2 + y^2 / 2);
        discretize midpoint;
    }
}

/// A part of a run.
#[derive(Clone, Copy, Debug)]
enum Leg {
    Steps(usize),
    StepOf(f64),
    Until(f64),
    /// Until y falls through a curve.
    Event,
    /// k doubles and m is set.
    Parameters,
    /// An impact: the velocity of y is turned around and loses a part.
    Impact,
}

/// Until y falls below a number that depends on x, the velocity and the time.
fn event() -> Event<2> {
    Event::smooth_falling(|at| at.q[1] + Dual::real(0.1) * at.v[0] * at.q[0] - Dual::real(0.02) * at.t)
}

fn impact<T: Real>(State { t, q, p }: State<2, T>) -> State<2, T> {
    State { t, q, p: SVector::from([p[0] + T::real(0.1) * q[0] * p[1], -T::real(0.7) * p[1]]) }
}

fn follow<M: Differentiable<S, 2>, S: Convertible<2> + Parameters>(run: &mut Run<M, S, 2>, legs: &[Leg]) {
    for leg in legs {
        match *leg {
            Leg::Steps(count) => (0..count).try_for_each(|_| run.step().map(drop)),
            Leg::StepOf(h) => run.step_of(h).map(drop),
            Leg::Until(t) => run.until(t).map(drop),
            Leg::Event => run.until_event(event(), 100.0).map(|found| assert!(found.is_some())),
            Leg::Parameters => run.set_parameters(|system| {
                *system.parameter_mut("k").expect("a parameter") *= 2.0;
                *system.parameter_mut("m").expect("a parameter") = 1.1;
            }),
            Leg::Impact => run.set_state(impact(run.state())),
        }
        .unwrap_or_else(|failure| panic!("{leg:?}: {failure}"));
    }
}

fn follow_tangent<M, S>(tangent: &mut Tangent<M, S, 2>, legs: &[Leg])
where
    M: Differentiable<S, 2>,
    S: Convertible<2> + Parameters,
{
    for leg in legs {
        match *leg {
            Leg::Steps(count) => (0..count).try_for_each(|_| tangent.step().map(drop)),
            Leg::StepOf(h) => tangent.step_of(h).map(drop),
            Leg::Until(t) => tangent.until(t).map(drop),
            Leg::Event => tangent.until_event(&event(), 100.0).map(|found| assert!(found.is_some())),
            Leg::Parameters => tangent.set_parameters(|system| {
                *system.parameter_mut("k").expect("a parameter") *= Dual::real(2.0);
                *system.parameter_mut("m").expect("a parameter") = Dual::real(1.1);
            }),
            Leg::Impact => tangent.set_state(|_, state| impact(state)),
        }
        .unwrap_or_else(|failure| panic!("{leg:?}: {failure}"));
    }
}

const START: State<2> = State { t: 0.3, q: SVector::<f64, 2>::new(0.7, 0.5), p: SVector::<f64, 2>::new(0.4, -0.6) };

/// All directions: state, time, and parameters; the length of a step if the run is given one.
fn directions<S: Lagrangian<2>>(with_length: bool) -> Vec<Variation<2>> {
    let mut all = Variation::of_state();
    all.push(Variation { t: 1.0, ..Variation::zero() });
    all.extend(S::PARAMETERS.iter().map(|name| Variation::of_parameter::<S>(name).expect("a parameter")));
    if with_length {
        all.push(Variation { h: 1.0, ..Variation::zero() });
    }
    all
}

/// The run whose start is moved along a direction.
fn moved<M: Differentiable<S, 2>, S>(case: &Case<M, S>, along: &Variation<2>, by: f64) -> Run<M, S, 2>
where
    S: Convertible<2> + Parameters,
{
    let mut system = case.system;
    for (name, slope) in S::PARAMETERS.iter().zip(&along.parameters) {
        *system.parameter_mut(name).expect("a parameter") += by * slope;
    }
    let State { t, q, p } = START;
    let state = State { t: t + by * along.t, q: q + along.q * by, p: p + along.p * by };
    let run = system.at_state(state).integrate(case.method.clone(), case.h + by * along.h).expect("a start");
    (case.option)(run)
}

/// What is differentiated.
#[derive(Clone)]
struct Case<M: Differentiable<S, 2>, S: Convertible<2>> {
    method: M,
    system: S,
    h: f64,
    option: fn(Run<M, S, 2>) -> Run<M, S, 2>,
    /// Whether h is that of every step, and not only a guess.
    is_given_length: bool,
    /// Distance of the nearest states that are compared.
    distance: f64,
}

/// The largest difference of derivatives over some legs from central differences, relative to their size.
fn differs<M, S>(case: &Case<M, S>, legs: &[Leg]) -> f64
where
    M: Differentiable<S, 2>,
    S: Convertible<2> + Parameters,
{
    let directions = directions::<S>(case.is_given_length);
    let start = moved(case, &Variation::zero(), 0.0);
    let mut plain = start.clone();
    let mut tangent = Tangent::from_start(start, directions.clone()).expect("regular");
    follow_tangent(&mut tangent, legs);
    follow(&mut plain, legs);
    assert_eq!(tangent.run().node(), plain.node(), "a tangent takes the steps of the run");
    let mut worst = 0.0_f64;
    for (along, found) in directions.iter().zip(tangent.variations()) {
        let numbers = |by: f64| {
            let mut run = moved(case, along, by);
            follow(&mut run, legs);
            let node = run.node();
            let energy = if case.method.keeps_energy() { node.energy } else { 0.0 };
            SVector::from([node.t, energy, node.q[0], node.q[1], node.p[0], node.p[1]])
        };
        let found = SVector::from([found.t, found.energy, found.q[0], found.q[1], found.p[0], found.p[1]]);
        let s = case.distance;
        // Of order 8: what they miss is s⁸/630 times the ninth derivative, and roundings over s.
        let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
        let differences = (1..)
            .zip(weights)
            .map(|(k, weight)| (numbers(f64::from(k) * s) - numbers(-f64::from(k) * s)) * (weight / s));
        let by_differences: SVector<f64, 6> = differences.sum();
        let size = found.amax();
        assert!(size > 1e-3, "{along:?} changes nothing");
        worst = worst.max((found - by_differences).amax() / size);
    }
    worst
}

/// Every kind of leg, one after the other.
const LEGS: [&[Leg]; 7] = [
    &[Leg::Steps(6)],
    &[Leg::Steps(2), Leg::StepOf(0.11), Leg::Steps(2)],
    &[Leg::Until(1.57), Leg::Steps(1)],
    &[Leg::Event, Leg::Steps(2)],
    &[Leg::Steps(2), Leg::Parameters, Leg::Steps(3)],
    &[Leg::Steps(2), Leg::Impact, Leg::Steps(3)],
    &[Leg::Event, Leg::Impact, Leg::Parameters, Leg::Steps(2), Leg::StepOf(0.07)],
];

#[test]
fn derivatives_of_every_method_are_those_of_differences() {
    fn all<M, S>(case: &Case<M, S>, bound: f64)
    where
        M: Differentiable<S, 2>,
        S: Convertible<2> + Parameters,
    {
        let errors = LEGS.map(|legs| differs(case, legs));
        println!("{:?} {}: {}", case.method, S::NAME, errors.map(|error| format!("{error:.1e}")).join(" "));
        assert!(errors.iter().all(|error| *error <= bound), "{:?}: {errors:?}", case.method);
    }
    fn case<M: Differentiable<S, 2>, S: Convertible<2>>(method: M, system: S, h: f64) -> Case<M, S> {
        Case { method, system, h, option: |run| run, is_given_length: true, distance: 5e-4 }
    }
    /// The distance is larger if the length of a step is known to fewer digits.
    fn kept<M: Differentiable<S, 2>, S: Convertible<2>>(method: M, system: S, h: f64, distance: f64) -> Case<M, S> {
        Case { is_given_length: false, distance, ..case(method, system, h) }
    }
    let (driven, free) = (Driven::default(), Free::default());
    // At most 6.7e-12: roundings over the distance.
    all(&case(FixedStep, driven, 0.1), 2e-11);
    all(&case(FixedStep.connected(), driven, 0.1), 2e-11);
    all(&case(Composition::SUZUKI_4, driven, 0.2), 2e-11);
    all(&case(Gauss::<3>, driven, 0.25), 2e-11);
    all(&case(Gauss::<4>.in_transformed_time(), driven, 0.4), 2e-11);
    all(&case(Gauss::<4>.in_transformed_time(), free, 0.4), 2e-11);
    // A length is known to the rounding of the energy over its derivative, which is of order h^(2s−1). At most 9.0e-10.
    all(&kept(EnergyPreserving, driven, 0.1, 5e-4), 2e-9);
    all(&kept(EnergyPreservingGauss::<1>, driven, 0.1, 5e-4), 2e-9);
    all(&kept(EnergyPreservingGauss::<2>, driven, 0.4, 4e-3), 2e-9);
    all(&kept(EnergyPreservingGauss::<2>, free, 0.35, 4e-3), 2e-9);
    let option = |run: Run<_, _, 2>| run.with_shift(300.0).expect("finite");
    all(&Case { option, ..kept(EnergyPreservingGauss::<3>, free, 0.7, 4e-3) }, 2e-9);
}

/// How far a map is from a symplectic one by the form of pairs (i, i + n), relative to its square.
fn defect(map: &DMatrix<f64>) -> f64 {
    let n = map.nrows() / 2;
    let form = DMatrix::from_fn(2 * n, 2 * n, |i, j| f64::from(i8::from(j == i + n) - i8::from(i == j + n)));
    (map.transpose() * &form * map - form).amax() / map.norm_squared().max(1.0)
}

#[test]
fn maps_of_steps_that_find_their_length_are_symplectic() {
    // In extended phase space (t, q; −E, p), also where the time drives and scales.
    lagrangian! {
        struct Shaken {
            param m = 1.3, k = 0.8, w = 1.7;
            coord x, y;
            L = m / 2 * ((1 + x^2 / 4) * dot(x)^2 + dot(y)^2) - k * (x^2 + 1.5 * y^2) / 2 - x^4 / 8 + 0.2 * x * cos(w * t);
            time_scale = 1 / (1 + k * x^2 + y^2 / 2 + sin(w * t) / 5);
        }
    }
    /// The map of some steps in extended phase space.
    fn map<M: Differentiable<S, 2>, S: Convertible<2>>(run: Run<M, S, 2>, steps: usize) -> DMatrix<f64> {
        let mut all = Variation::of_state();
        all.insert(0, Variation { t: 1.0, ..Variation::zero() });
        all.insert(3, Variation { energy: -1.0, ..Variation::zero() });
        let mut tangent = Tangent::new(run, all);
        (0..steps).for_each(|_| _ = tangent.step().expect("solvable"));
        let column = |of: &Variation<2>| [of.t, of.q[0], of.q[1], -of.energy, of.p[0], of.p[1]];
        DMatrix::from_iterator(6, 6, tangent.variations().iter().flat_map(column))
    }
    let shaken = Shaken::default().at_state(START);
    let transformed = map(shaken.integrate(Gauss::<3>.in_transformed_time(), 0.5).expect("a start"), 20);
    let kept = map(shaken.integrate(EnergyPreservingGauss::<2>, 0.4).expect("a start"), 6);
    assert!(transformed.amax() > 2.0 && kept.amax() > 2.0);
    let [transformed, kept] = [transformed, kept].map(|map| defect(&map));
    println!("{transformed:.1e} {kept:.1e}");
    // 3.4e-17 and 2.1e-17.
    assert!(transformed <= 2e-16 && kept <= 2e-16, "{transformed:e} {kept:e}");
}

/// Squares of times, coordinates and momenta at the nodes, c an input of each step.
struct Squares;

impl<M: Differentiable<Driven, 2>> Objective<M, Driven, 2> for Squares {
    fn prepare(&self, step: u64, run: &mut Run<M, Driven, 2>) -> Result<(), StepError> {
        let input = if step.is_multiple_of(2) { 0.07 } else { 0.12 };
        run.set_parameters(|system| system.c = input)
    }
    fn parameters(&self) -> &[&str] {
        &["m", "k", "w"]
    }
    fn slope(&self, step: u64, state: &State<2>) -> Covector<2> {
        let weight = if step.is_multiple_of(3) { 1.0 } else { 0.5 };
        Covector { t: weight * state.t, q: state.q * (2.0 * weight), p: state.p * weight, ..Covector::zero() }
    }
}

#[test]
fn the_adjoint_agrees_with_tangents() {
    fn worst<M: Differentiable<Driven, 2>>(method: M, h: f64, steps: u64) -> f64 {
        let run = Driven::default().at_state(START).integrate(method, h).expect("a start");
        let found = gradient(&run, steps, 2, &Squares).expect("regular");
        let mut varied = directions::<Driven>(false);
        varied.push(Variation { energy: 1.0, ..Variation::zero() });
        // c is set before every step.
        varied.retain(|of| of.parameters.get(2) != Some(&1.0));
        let parameters = found.parameters.iter().fold([0.0; 3], |sum, row| [0, 1, 2].map(|k| sum[k] + row[k]));
        let start = &found.start;
        let by_adjoint = [
            start.q[0],
            start.q[1],
            start.p[0],
            start.p[1],
            start.t,
            parameters[0],
            parameters[1],
            parameters[2],
            start.energy,
        ];
        assert_eq!(by_adjoint.len(), varied.len());
        let mut forward = vec![0.0; varied.len()];
        let mut run = run.clone();
        // The gradient by a parameter counts the energy that it brings at the start.
        for of in varied.iter_mut().filter(|of| !of.parameters.is_empty()) {
            of.energy = energy_slope(&run, of);
        }
        for step in 0..=steps {
            let slope = Objective::<M, Driven, 2>::slope(&Squares, step, &run.state());
            forward.iter_mut().zip(&varied).for_each(|(sum, of)| *sum += slope.of(of));
            if step < steps {
                let mut tangent = Tangent::new(run.clone(), varied);
                let input = if step.is_multiple_of(2) { 0.07 } else { 0.12 };
                tangent.set_parameters(|system| system.c = Dual::real(input)).expect("regular");
                tangent.step().expect("solvable");
                (run, varied) = (tangent.run().clone(), tangent.variations().to_vec());
            }
        }
        let size = forward.iter().fold(1.0_f64, |size, entry| size.max(entry.abs()));
        forward.iter().zip(by_adjoint).map(|(one, other)| (one - other).abs() / size).fold(0.0, f64::max)
    }
    let errors = [
        worst(FixedStep, 0.1, 11),
        worst(Gauss::<3>, 0.3, 11),
        worst(Gauss::<4>.in_transformed_time(), 0.4, 11),
        worst(EnergyPreserving, 0.1, 5),
        worst(EnergyPreservingGauss::<2>, 0.4, 5),
    ];
    println!("{}", errors.map(|error| format!("{error:.1e}")).join(" "));
    // The energies that a length follows from are differences: 4.9e-16, 1.6e-16, 4.6e-16, 1.4e-14, 5.6e-11.
    let bounds = [2e-15, 2e-15, 2e-15, 4e-14, 2e-10];
    assert!(errors.iter().zip(bounds).all(|(error, bound)| *error <= bound), "{errors:?}");
}

/// What H at the node of a run changes by along a variation: by the energy that a run started there in transformed time keeps.
fn energy_slope<M: Differentiable<Driven, 2>>(run: &Run<M, Driven, 2>, along: &Variation<2>) -> f64 {
    let beside = run.system().at_state(run.state()).integrate(Gauss::<1>.in_transformed_time(), 0.1).expect("a start");
    Tangent::from_start(beside, vec![along.clone()]).expect("regular").variations()[0].energy
}

#[test]
fn what_has_no_derivative_says_so() {
    // Not the last step, or not any more.
    fn refused<M: Differentiable<Free, 2>>(mut run: Run<M, Free, 2>) -> [Result<(), StepError>; 4] {
        let before = *run.node();
        let none = run.vary(&before, &mut Variation::of_state());
        run.step().expect("solvable");
        let between = *run.node();
        run.step().expect("solvable");
        let earlier = run.vary(&before, &mut Variation::of_state());
        run.vary(&between, &mut Variation::of_state()).expect("regular");
        let mut changed = run.clone();
        changed.set_parameters(|system| system.k = 0.9).expect("regular");
        let changed = changed.vary(&between, &mut Variation::of_state());
        let mut last = *run.node();
        run.step_of(0.03).expect("solvable");
        last.energy = run.node().energy;
        [none, earlier, changed, run.vary(&last, &mut Variation::of_state())]
    }
    let has_none = |outcome: Result<(), StepError>, word: &str| match outcome {
        Err(StepError::NoDerivative { because, .. }) => assert!(because.contains(word), "{because}"),
        other => panic!("{other:?}"),
    };
    let start = Free::default().at_state(START);
    let all = Variation::of_state;
    let fallen = start.integrate(EnergyPreservingGauss::<2>, 0.2).expect("a start").with_fallback(Fallback::FixedSteps);
    let mut fallen = Tangent::new(fallen, all());
    has_none(fallen.step().map(drop), "fallback");
    has_none(fallen.step().map(drop), "fallback");
    let transformed = refused(start.integrate(Gauss::<4>.in_transformed_time(), 0.4).expect("a start"));
    let kept = refused(start.integrate(EnergyPreservingGauss::<2>, 0.2).expect("a start"));
    transformed.into_iter().chain(kept).for_each(|outcome| has_none(outcome, "last"));
    let mut plain = Tangent::new(start.integrate(Gauss::<2>, 0.1).expect("a start"), all());
    has_none(plain.until_event(&Event::falling(|at| at.q[1]), 9.0).map(drop), "smooth");
    let many = Variation { parameters: vec![1.0; 3], ..Variation::zero() };
    let mut many = Tangent::new(start.integrate(Gauss::<4>.in_transformed_time(), 0.4).expect("a start"), vec![many]);
    has_none(many.step().map(drop), "more parameters");
    let jump = Event::smooth_falling(|at| at.q[1].sign());
    let mut jumped = Tangent::new(start.integrate(Gauss::<6>, 0.1).expect("a start"), all());
    has_none(jumped.until_event(&jump, 9.0).map(drop), "along the trajectory");
    // Before an event variations are those at the time.
    let mut before = Tangent::new(start.integrate(EnergyPreserving, 0.1).expect("a start"), all());
    assert!(before.until_event(&event(), 0.5).expect("no event").is_none());
    assert!(before.variations().iter().all(|of| of.t == 0.0 && of.q.amax().is_normal()));
}

#[test]
fn exponents_in_transformed_time_are_those_in_time() {
    // An inverted oscillator: the growth of the first direction does not depend on how time is divided.
    lagrangian! {
        struct Saddle {
            param k = 2.25;
            coord x, y;
            L = (dot(x)^2 + dot(y)^2) / 2 + k * (x^2 - y^2) / 2;
            time_scale = 1 / (1 + y^2);
        }
    }
    let start = Saddle::default().at(0.0, [0.0, 0.4], [0.0, 0.3]);
    let run = start.integrate(Gauss::<6>.in_transformed_time(), 0.3).expect("a start");
    let mut lyapunov = Lyapunov::new(run, 1).expect("one");
    let mut growth = [[0.0; 2]; 2];
    for part in &mut growth {
        lyapunov.advance(100).expect("solvable");
        *part = [lyapunov.exponents()[0] * lyapunov.run().t(), lyapunov.run().t()];
    }
    let rate = (growth[1][0] - growth[0][0]) / (growth[1][1] - growth[0][1]);
    println!("{:.1e}", rate - 1.5);
    // √k, of the direction (x, p) that leaves: to 2.2e-16.
    assert!((rate - 1.5).abs() <= 1e-15, "{rate}");
}
