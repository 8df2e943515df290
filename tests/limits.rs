//! States at which one factor of a product is zero and another infinite: roots that start at a point, and drag at rest.
//!
//! The product tends to zero, or the step returns a typed error.

use vi_core::derivatives::{Covector, Differentiable, Objective, Tangent, Variation, gradient};
use vi_core::motion::Motion;
use vi_core::nalgebra::SMatrix;
use vi_core::node::Node;
use vi_core::stepping::{Batch, Convertible, EnergyStepping, FixedStepping};
use vi_core::{
    Composition, EnergyPreserving, Fallback, FixedStep, Gauss, Lagrangian, Method, Run, SVector, Starts, State,
    StepError, lagrangian,
};
use vi_ensemble::Ensemble;

lagrangian! {
    /// A ball above a floor with a root potential: its curvature is infinite at z = 0 from below.
    struct Ball {
        coord z;
        let d = (abs(z) - z) / 2;
        L = dot(z)^2 / 2 - z - 100 * d^(3/2);
        discretize midpoint;
    }
}

lagrangian! {
    /// The same floor at a height, its exponent a parameter.
    struct Floor {
        param n = 1.5, k = 100.0, height = 0.3;
        coord z;
        let d = (abs(z - height) - (z - height)) / 2;
        L = dot(z)^2 / 2 - z - k * d^n;
        discretize midpoint;
    }
}

lagrangian! {
    /// A floor with a force proportional to the root of the depth.
    struct Cushion {
        param k = 30.0;
        coord z;
        L = dot(z)^2 / 2 - z;
        force z = k * sqrt((abs(z) - z) / 2);
        discretize midpoint;
    }
}

lagrangian! {
    /// A wavy floor: the depth is not a multiple of a coordinate.
    struct Waves {
        param a = 0.1;
        coord x, z;
        let u = z - a * sin(3 * x) - cos(x) / 9;
        let d = (abs(u) - u) / 2;
        L = (dot(x)^2 + dot(z)^2) / 2 - z - 100 * d^(3/2);
        discretize midpoint;
    }
}

lagrangian! {
    /// A fall in the plane with quadratic drag.
    struct Fall {
        param c = 0.3;
        coord x, y;
        let speed = sqrt(dot(x)^2 + dot(y)^2);
        L = (dot(x)^2 + dot(y)^2) / 2 - y;
        force x = -c * speed * dot(x);
        force y = -c * speed * dot(y);
        discretize midpoint;
    }
}

lagrangian! {
    /// Drag with a power of the speed, different along the axes.
    struct Unlike {
        param a = 1.0, b = 4.0, n = 0.5;
        coord x, y;
        let power = (a * dot(x)^2 + b * dot(y)^2)^n;
        L = (dot(x)^2 + dot(y)^2) / 2;
        force x = 1 - power * dot(x);
        force y = -power * dot(y);
        discretize midpoint;
    }
}

lagrangian! {
    /// A force of constant magnitude towards a point, at which it has no limit.
    struct Towards {
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - hypot(x, y);
        discretize midpoint;
    }
}

/// Steps to a time; counts the steps that satisfy `is_there`, and returns the largest energy deviation.
fn followed<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize>(
    mut run: Run<M, S, N>,
    until: f64,
    is_there: impl Fn(&SVector<f64, N>) -> bool,
) -> Result<(usize, f64), StepError> {
    let first = run.state().energy(run.system())?;
    let (mut count, mut worst) = (0, 0.0_f64);
    while run.state().t < until {
        let state = run.step()?;
        count += usize::from(is_there(&state.q));
        worst = worst.max((state.energy(run.system())? - first).abs());
    }
    Ok((count, worst))
}

/// The state after 60 steps.
fn after<M: Method<S, 1>, S: Lagrangian<1> + Copy>(run: Result<Run<M, S, 1>, StepError>) -> State<1> {
    let mut run = run.expect("a valid start");
    for _ in 0..60 {
        run.step().expect("a step");
    }
    run.state()
}

/// Before the first contact a ball from (1, 0) is on the parabola, by every integrator.
fn falls_freely<S>(system: S)
where
    S: Batch<1> + Motion<1> + Convertible<1> + EnergyStepping<1>,
{
    let start = State::at(&system, 0.0, [1.0], [0.0]);
    let is_on_parabola = |state: &State<1>, name: &str| {
        let off = (state.q[0] - 1.0 + state.t * state.t / 2.0).abs().max((state.p[0] + state.t).abs());
        // Measured: 5.6e-17.
        assert!(off < 1e-16, "{name}: {off:e} at {}", state.t);
    };
    is_on_parabola(&after(system.at_state(start).integrate(FixedStep, 0.01)), "fixed");
    is_on_parabola(&after(system.at_state(start).integrate(Composition::KAHAN_LI_6, 0.01)), "composition");
    is_on_parabola(&after(system.at_state(start).integrate(Gauss::<4>, 0.01)), "Gauss");
    let mut energy = EnergyPreserving::from_midpoint(system, 0.0, [1.0], [0.0], 0.01).expect("a valid start");
    for _ in 0..60 {
        let (t, q, v) = energy.detailed_step().expect("a step").midpoint;
        let off = (q[0] - 1.0 + t * t / 2.0).abs().max((v[0] + t).abs());
        // Measured: 1.2e-16.
        assert!(off < 2e-16, "energy-preserving: {off:e}");
    }
    let mut ensemble = Ensemble::new(vec![system; 9], vec![start; 9], 0.01).expect("valid starts");
    ensemble.run(60);
    for result in ensemble.results() {
        is_on_parabola(&result.unwrap_or_else(|ended| panic!("{}", ended.error)), "ensemble");
    }
}

#[test]
fn a_ball_falls_freely_above_its_floor() {
    falls_freely(Ball::default());
    falls_freely(Floor::default());
    falls_freely(Floor { n: 1.25, height: 0.1, ..Floor::default() });
    falls_freely(Cushion::default());
}

/// The largest energy errors of fixed steps, compositions, Gauss steps and energy-preserving steps over some bounces.
fn bounces<S, const N: usize>(system: S, q: [f64; N], h: f64, is_there: fn(&SVector<f64, N>) -> bool) -> [f64; 4]
where
    S: Batch<N> + Motion<N> + Convertible<N> + EnergyStepping<N>,
{
    let start = State::at(&system, 0.0, q, [0.0; N]);
    let energy = EnergyPreserving::from_midpoint(system, 0.0, q, [0.0; N], h).expect("a valid start");
    let runs = [
        followed(system.at_state(start).integrate(FixedStep, h).expect("a valid start"), 6.0, is_there),
        followed(system.at_state(start).integrate(Composition::KAHAN_LI_6, h).expect("a valid start"), 6.0, is_there),
        followed(system.at_state(start).integrate(Gauss::<4>, h).expect("a valid start"), 6.0, is_there),
        followed(energy.with_fallback(Fallback::FixedSteps), 6.0, is_there),
    ];
    runs.map(|run| {
        let (contacts, worst) = run.unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        assert!(contacts > 10, "{}: {contacts} contacts", S::NAME);
        worst
    })
}

#[test]
fn a_ball_bounces() {
    let ball = bounces(Ball::default(), [1.0], 1e-3, |q| q[0] < 0.0);
    let floor = bounces(Floor::default(), [1.0], 1e-3, |q| q[0] < 0.3);
    let waves =
        bounces(Waves::default(), [0.1, 1.0], 1e-3, |q| q[1] - 0.1 * (3.0 * q[0]).sin() - q[0].cos() / 9.0 < 0.0);
    // Energy-preserving steps end at contacts and fixed steps continue; roundings decide where.
    for (found, most) in [
        // Measured: 1.42e-3, 8.8e-4, 7.1e-4, 8.2e-4.
        (ball, [1.5e-3, 9e-4, 8e-4, 2e-3]),
        // Measured: 6.7e-4, 4.0e-4, 1.6e-4, 9.5e-4.
        (floor, [7e-4, 5e-4, 2e-4, 2e-3]),
        // Measured: 6.5e-4, 1.3e-3, 8.7e-5, 3.2e-4.
        (waves, [7e-4, 1.4e-3, 9e-5, 2e-3]),
    ] {
        assert!(found.iter().zip(most).all(|(found, most)| *found < most), "{found:?}");
    }
}

#[test]
fn the_curvature_of_the_floor_is_that_of_the_formula() {
    let system = Floor::default();
    let at = |z: f64| Motion::point_derivatives(&system, 0.0, &[z].into(), &[0.0].into()).force_dq[(0, 0)];
    assert_eq!(SVector::<f64, 3>::from([at(0.3 + 1e-15), at(0.4), at(1e9)]), SVector::<f64, 3>::zeros());
    // −k n (n − 1) d^(n − 2)
    let wanted = -100.0 * 0.75 / 0.2_f64.sqrt();
    // Measured: 0.
    assert!((at(0.1) / wanted - 1.0).abs() < 1e-15, "{:e}", at(0.1));
    // At the floor itself it is infinite on one side: no step starts there.
    assert!(!at(0.3).is_finite(), "{:e}", at(0.3));
    let floor = State { t: 0.0, q: [0.3].into(), p: [0.0].into() };
    let step = system.at_state(floor).integrate(FixedStep, 0.01).expect("a velocity").step();
    assert!(matches!(step, Err(StepError::NonFinite { .. })), "{step:?}");
}

/// The derivative of the momentum equation of a fall.
fn jacobian(c: f64, v: [f64; 2]) -> SMatrix<f64, 2, 2> {
    let node = Node::new(State { t: 0.0, q: [0.0; 2].into(), p: [0.0; 2].into() }, 0.0);
    Fall { c }.momentum_equation(&node, 0.1, &v.into()).jacobian
}

#[test]
fn a_drag_at_rest_has_no_slope() {
    assert_eq!(jacobian(0.3, [0.0, 0.0]), SMatrix::<f64, 2, 2>::identity());
    for [x, y] in [[3.0, 4.0], [-5e-9, 12e-9], [0.0, 1e-80], [8e-150, 6e-150]] {
        // δ_ij + (h c/2)(|v| δ_ij + v_i v_j/|v|)
        let (speed, half) = (f64::hypot(x, y), 0.05 * 0.3);
        let found = jacobian(0.3, [x, y]);
        let across = half * x * y / speed;
        let wanted = [1.0 + half * (speed + x * x / speed), across, across, 1.0 + half * (speed + y * y / speed)];
        for (found, wanted) in found.iter().zip(wanted) {
            // Measured: relative error 2.3e-16.
            assert!((found - wanted).abs() <= 3e-16 * wanted.abs(), "{found:e}, {wanted:e} at {x:e}, {y:e}");
        }
    }
    // If the squares underflow, the product is below 1e-160.
    assert_eq!(jacobian(0.3, [1e-170, 1e-170]), SMatrix::<f64, 2, 2>::identity());
}

/// The errors of x, y and both momenta after a fall from rest of 2 seconds, against `v = √(g/c) tanh(√(g c) t)`.
fn off<M: Method<S, 2>, S: Lagrangian<2> + Copy>(mut run: Run<M, S, 2>) -> f64 {
    run.until(2.0).expect("a fall");
    let (state, root) = (run.state(), 0.3_f64.sqrt());
    let y = -(2.0 * root).cosh().ln() / 0.3;
    let v = -(2.0 * root).tanh() / root;
    [state.q[0], state.q[1] - y, state.p[0], state.p[1] - v].into_iter().fold(0.0, |most, off| off.abs().max(most))
}

#[test]
fn a_fall_from_rest_is_the_closed_form() {
    let system = Fall::default();
    let start = State::at(&system, 0.0, [0.0, 0.0], [0.0, 0.0]);
    let errors = [
        off(system.at_state(start).integrate(FixedStep, 0.02).expect("a velocity")),
        off(system.at_state(start).integrate(FixedStep, 0.01).expect("a velocity")),
        off(system.at_state(start).integrate(Composition::KAHAN_LI_6, 0.02).expect("a velocity")),
        off(system.at_state(start).integrate(Gauss::<4>, 0.02).expect("a velocity")),
    ];
    // Measured: 1.31e-5, 3.28e-6 (a quarter), 1.1e-15, 0.
    assert!(errors.iter().zip([1.4e-5, 3.4e-6, 2e-15, 1e-15]).all(|(found, most)| *found < most), "{errors:?}");
    // In single precision.
    let single = Fall::<f32> { c: 0.3 };
    let start = State::at(&single, 0.0, [0.0, 0.0], [0.0, 0.0]);
    let mut run = single.at_state(start).integrate(FixedStep, 0.01_f32).expect("a velocity");
    for _ in 0..200 {
        run.step().expect("a step");
    }
    let off = (run.state().p[1] + (2.0 * 0.3_f32.sqrt()).tanh() / 0.3_f32.sqrt()).abs();
    // Measured: 3.3e-6, the error of the step.
    assert!(off < 4e-6, "{off:e}");
    // Energy-preserving steps fall too.
    let mut run = EnergyPreserving::from_midpoint(system, 0.0, [0.0, 0.0], [0.0, 0.0], 0.01).expect("a velocity");
    for _ in 0..100 {
        run.step().expect("a step");
    }
    let (state, root) = (run.state(), 0.3_f64.sqrt());
    let off = (state.p[1] + (state.t * root).tanh() / root).abs();
    // Measured: 3.7e-6.
    assert!(off < 4e-6, "{off:e}");
    // As in vector lanes.
    let mut alone = system.at(0.0, [0.0, 0.0], [0.0, 0.0]).integrate(FixedStep, 0.01).expect("a velocity");
    let mut ensemble = Ensemble::new(vec![system; 9], vec![alone.state(); 9], 0.01).expect("valid starts");
    ensemble.run(200);
    for _ in 0..200 {
        alone.step().expect("a step");
    }
    for result in ensemble.results() {
        let state = result.unwrap_or_else(|ended| panic!("{}", ended.error));
        let error = (state.q - alone.state().q).amax().max((state.p - alone.state().p).amax());
        // Measured: 0; with fused multiply-add the rounding is smaller.
        assert!(error < 1e-13, "{error:e}");
    }
}

#[test]
fn exponents_and_coefficients_that_are_parameters_are_tested_at_run_time() {
    let start = |system: Unlike| system.at(0.0, [0.0; 2], [0.0; 2]).integrate(FixedStep, 0.01);
    for system in [Unlike::default(), Unlike { n: 0.2, ..Unlike::default() }] {
        let mut run = start(system).expect("a velocity");
        for _ in 0..1000 {
            run.step().expect("a step");
        }
        // The terminal speed: 1 = a^n v^(2n + 1).
        // Measured: 1.1e-6, for the slower convergence.
        assert!((run.v()[0] - 1.0).abs() < 2e-6, "{:e}", run.v()[0]);
    }
    for system in [
        Unlike { n: -0.5, ..Unlike::default() },
        Unlike { n: -0.7, ..Unlike::default() },
        Unlike { a: -1.0, ..Unlike::default() },
        Unlike { b: 0.0, n: -0.1, ..Unlike::default() },
    ] {
        let step = start(system).and_then(|mut run| run.step().map(drop));
        assert!(matches!(step, Err(StepError::NonFinite { .. })), "{system:?}: {step:?}");
    }
}

#[test]
fn products_without_a_limit_are_typed_errors() {
    let system = Towards::default();
    let start = State { t: 0.0, q: [0.0; 2].into(), p: [0.0; 2].into() };
    let fixed = system.at_state(start).integrate(FixedStep, 0.01).expect("a velocity").step();
    assert!(matches!(fixed, Err(StepError::NonFinite { .. })), "{fixed:?}");
    assert!(!system.momentum_equation(&Node::new(start, 0.0), 0.01, &[0.0; 2].into()).residual[0].is_finite());
    let gauss = system.at_state(start).integrate(Gauss::<4>, 0.01).expect("a velocity").step();
    assert!(gauss.is_err(), "{gauss:?}");
    // At a state nearby a step exists.
    let nearby = State { q: [1e-9, 0.0].into(), ..start };
    assert!(system.at_state(nearby).integrate(FixedStep, 1e-6).expect("a velocity").step().is_ok());
}

/// The last coordinate after 60 steps.
struct Height;

impl<M: Method<S, 1>, S> Objective<M, S, 1> for Height {
    fn parameters(&self) -> &[&str] {
        &["n", "k", "height"]
    }
    fn slope(&self, step: u64, _state: &State<1>) -> Covector<1> {
        Covector { q: SVector::repeat(f64::from(u8::from(step == 60))), ..Covector::zero() }
    }
}

/// Tangent vectors after 60 steps.
fn varied<M, S>(run: Run<M, S, 1>, variations: Vec<Variation<1>>) -> Vec<[f64; 2]>
where
    M: Differentiable<S, 1>,
    S: Convertible<1>,
{
    let mut tangent = Tangent::new(run, variations);
    for _ in 0..60 {
        tangent.step().expect("a derivative");
    }
    tangent.variations().iter().map(|variation| [variation.q[0], variation.p[0]]).collect()
}

#[test]
fn derivatives_of_a_free_fall_are_those_of_the_parabola() {
    let system = Floor::default();
    let start = State::at(&system, 0.0, [1.0], [0.0]);
    let variations = || {
        let names = ["n", "k", "height"].map(|name| Variation::of_parameter::<Floor>(name).expect("a parameter"));
        Variation::of_state().into_iter().chain(names).collect::<Vec<_>>()
    };
    let run = system.at_state(start).integrate(FixedStep, 0.01).expect("a velocity");
    for found in [
        varied(run.clone(), variations()),
        varied(system.at_state(start).integrate(Composition::KAHAN_LI_6, 0.01).expect("a velocity"), variations()),
        varied(system.at_state(start).integrate(Gauss::<4>, 0.01).expect("a velocity"), variations()),
    ] {
        let wanted = [[1.0, 0.0], [0.6, 1.0], [0.0; 2], [0.0; 2], [0.0; 2]];
        for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
            // Measured: 7.8e-16.
            assert!((found - wanted).abs() < 1e-15, "{found:e}, {wanted:e}");
        }
    }
    let gradient = gradient(&run, 60, 8, &Height).expect("a derivative");
    // Measured: 3.4e-16.
    assert!((gradient.start.q[0] - 1.0).abs() < 1e-15 && (gradient.start.p[0] - 0.6).abs() < 1e-15, "{gradient:?}");
    assert_eq!(gradient.parameters, vec![vec![0.0; 3]; 60]);
    // Second derivatives of a parabola do not exist.
    let mut run = run;
    let before = *run.node();
    run.step().expect("a step");
    let [one, other] = ["n", "height"].map(|name| Variation::of_parameter::<Floor>(name).expect("a parameter"));
    let end = Covector { q: [1.0].into(), p: [-1.0].into(), ..Covector::zero() };
    let second = run.curvature(&before, &[one, other], &end).expect("a derivative");
    assert!(second.is_some_and(|of| of.iter().all(|entry| *entry == 0.0)));
}

#[test]
fn derivatives_of_a_fall_from_rest_are_differences_of_falls() {
    let system = Fall::default();
    let after = |system: Fall, v: [f64; 2]| {
        let mut run = system.at(0.0, [0.0; 2], v).integrate(FixedStep, 0.01).expect("a velocity");
        for _ in 0..100 {
            run.step().expect("a step");
        }
        run.state().q
    };
    let run = system.at(0.0, [0.0; 2], [0.0; 2]).integrate(FixedStep, 0.01).expect("a velocity");
    let by_c = Variation::of_parameter::<Fall>("c").expect("a parameter");
    let momentum = |index| Variation::of_momentum(index).expect("a coordinate");
    let mut tangent = Tangent::new(run, vec![momentum(0), momentum(1), by_c]);
    for _ in 0..100 {
        tangent.step().expect("a derivative");
    }
    let d = 1e-5;
    let differences = [
        (after(system, [d, 0.0]) - after(system, [-d, 0.0])) / (2.0 * d),
        (after(system, [0.0, d]) - after(system, [0.0, -d])) / (2.0 * d),
        (after(Fall { c: 0.3 + d }, [0.0; 2]) - after(Fall { c: 0.3 - d }, [0.0; 2])) / (2.0 * d),
    ];
    for (variation, difference) in tangent.variations().iter().zip(differences) {
        let off = (variation.q - difference).amax();
        // Measured: 7.8e-11, 2.4e-12, 1.0e-12.
        assert!(off < 1e-10, "{off:e}");
    }
}
