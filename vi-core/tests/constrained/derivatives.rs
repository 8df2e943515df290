//! Derivatives of runs with constraints: against differences of runs from states on the constraints, tangent against
//! adjoint, symplecticity, exponents.

use vi_core::derivatives::{Covector, Lyapunov, Objective, Tangent, Variation, gradient};
use vi_core::lagrangian::Parameters;
use vi_core::motion::Motion as _;
use vi_core::nalgebra::SVector;
use vi_core::real::{Dual, Number};
use vi_core::run::Event;
use vi_core::stepping::Convertible;
use vi_core::{Gauss, Run, Starts, State, StepError, lagrangian};

lagrangian! {
    /// Two rods. The pivot moves, and the lower mass is damped.
    struct Driven {
        param m = 1.5, g = 9.81, l = 1.0, a = 0.1, c = 0.2;
        coord x, y, u, w;
        L = m / 2 * (dot(x)^2 + dot(y)^2) + (dot(u)^2 + dot(w)^2) / 2 - g * (m * y + w);
        force u = -c * dot(u);
        constraint upper = x^2 + (y - a * sin(3 * t))^2 - l^2;
        constraint lower = (u - x)^2 + (w - y)^2 - 1;
    }
}

lagrangian! {
    /// Two rods, without force and time. The mass of the upper end depends on its place.
    struct Free {
        param m = 1.5, g = 9.81, l = 1.0;
        coord x, y, u, w;
        L = m / 2 * (1 + x^2 / 4) * (dot(x)^2 + dot(y)^2) + (dot(u)^2 + dot(w)^2) / 2 - g * (m * y + w);
        constraint upper = x^2 + y^2 - l^2;
        constraint lower = (u - x)^2 + (w - y)^2 - 1;
    }
}

lagrangian! {
    /// A point on a sphere with a blade, on ground that moves: both kinds of constraints.
    struct Skate {
        param m = 1.5, g = 2.0, l = 1.0, k = 0.2;
        coord x, y, z, θ;
        L = m / 2 * (dot(x)^2 + dot(y)^2 + dot(z)^2) + dot(θ)^2 / 2 - g * z + sin(θ) * z / 3;
        constraint sphere = x^2 + y^2 + z^2 - l^2;
        constraint blade = (dot(x) + k * sin(t)) * sin(θ) - dot(y) * cos(θ);
    }
}

/// What these tests need of a system.
trait System<const N: usize>: Convertible<N> + Parameters {}
impl<S: Convertible<N> + Parameters, const N: usize> System<N> for S {}

type ARun<S, const N: usize, const STAGES: usize> = Run<Gauss<STAGES>, S, N>;

/// A part of a run.
#[derive(Clone, Copy, Debug)]
enum Leg {
    Steps(usize),
    StepOf(f64),
    Until(f64),
    /// Until the first coordinate crosses a number that depends on the time, the second, and its velocity.
    Event,
    /// The weight doubles.
    Weight,
}

/// No node is near it: there the derivative with respect to the step length jumps.
fn event<const N: usize>() -> Event<N> {
    Event::smooth_crossing(|at| {
        at.q[0] + Dual::real(0.1) * at.v[1] * at.q[1] - Dual::real(0.02) * at.t - Dual::real(0.3)
    })
}

fn follow<S: System<N>, const N: usize, const STAGES: usize>(run: &mut ARun<S, N, STAGES>, legs: &[Leg]) {
    for leg in legs {
        match *leg {
            Leg::Steps(count) => (0..count).try_for_each(|_| run.step().map(drop)),
            Leg::StepOf(h) => run.step_of(h).map(drop),
            Leg::Until(t) => run.until(t).map(drop),
            Leg::Event => run.until_event(event(), 100.0).map(|found| assert!(found.is_some())),
            Leg::Weight => run.set_parameters(|system| *system.parameter_mut("g").expect("a parameter") *= 2.0),
        }
        .unwrap_or_else(|failure| panic!("{leg:?}: {failure}"));
    }
}

fn follow_tangent<S: System<N>, const N: usize, const STAGES: usize>(
    tangent: &mut Tangent<Gauss<STAGES>, S, N>,
    legs: &[Leg],
) {
    for leg in legs {
        match *leg {
            Leg::Steps(count) => (0..count).try_for_each(|_| tangent.step().map(drop)),
            Leg::StepOf(h) => tangent.step_of(h).map(drop),
            Leg::Until(t) => tangent.until(t).map(drop),
            Leg::Event => tangent.until_event(&event(), 100.0).map(|found| assert!(found.is_some())),
            Leg::Weight => {
                tangent.set_parameters(|system| *system.parameter_mut("g").expect("a parameter") *= Dual::real(2.0))
            }
        }
        .unwrap_or_else(|failure| panic!("{leg:?}: {failure}"));
    }
}

/// The state on the constraints that is nearest to a state.
fn nearest<S: System<N>, const N: usize>(system: &S, state: State<N>) -> State<N> {
    let v = state.velocity(system).unwrap_or_else(|failure| panic!("{failure}"));
    State::projected(system, state.t, state.q, v).unwrap_or_else(|failure| panic!("{failure}")).state
}

fn begin<S: System<N>, const N: usize, const STAGES: usize>(system: S, state: State<N>, h: f64) -> ARun<S, N, STAGES> {
    system.at_state(nearest(&system, state)).integrate(Gauss, h).unwrap_or_else(|failure| panic!("{failure}"))
}

/// The run whose start is moved along a direction.
fn moved<S: System<N>, const N: usize, const STAGES: usize>(
    (mut system, State { t, q, p }, h): (S, State<N>, f64),
    along: &Variation<N>,
    by: f64,
) -> ARun<S, N, STAGES> {
    for (name, slope) in S::PARAMETERS.iter().zip(&along.parameters) {
        *system.parameter_mut(name).expect("a parameter") += by * slope;
    }
    let state = State { t: t + by * along.t, q: q + along.q * by, p: p + along.p * by };
    begin(system, state, h + by * along.h)
}

/// Admissible directions of state, time, step length and parameters.
fn directions<S: System<N>, const N: usize, const STAGES: usize>(run: &ARun<S, N, STAGES>) -> Vec<Variation<N>> {
    let mut all = Variation::of_state();
    all.push(Variation { t: 1.0, ..Variation::zero() });
    all.push(Variation { h: 1.0, ..Variation::zero() });
    all.extend(S::PARAMETERS.iter().map(|name| Variation::of_parameter::<S>(name).expect("a parameter")));
    let mut tangent = Tangent::new(run.clone(), all);
    tangent.project().unwrap_or_else(|failure| panic!("{failure}"));
    tangent.variations().to_vec()
}

/// The largest difference of derivatives over some legs from differences of fourth order, relative to their size.
fn differs<S: System<N>, const N: usize, const STAGES: usize>(case: (S, State<N>, f64), legs: &[Leg]) -> f64 {
    let start = moved::<S, N, STAGES>(case, &Variation::zero(), 0.0);
    // Exactly on the constraints.
    let case = (case.0, start.state(), case.2);
    let directions = directions(&start);
    let mut plain = start.clone();
    let mut tangent = Tangent::from_start(start, directions.clone()).expect("regular");
    follow_tangent(&mut tangent, legs);
    follow(&mut plain, legs);
    assert_eq!(tangent.run().node(), plain.node(), "a tangent takes the steps of the run");
    let mut worst = 0.0_f64;
    for (along, found) in directions.iter().zip(tangent.variations()) {
        let end = |by: f64| {
            let mut run = moved::<S, N, STAGES>(case, along, by);
            follow(&mut run, legs);
            run.state()
        };
        let by = 6e-5;
        let ends = [1.0, -1.0, 2.0, -2.0].map(|factor| end(factor * by));
        let difference = |of: &dyn Fn(&State<N>) -> f64| {
            let [one, minus, two, minus_two] = [0, 1, 2, 3].map(|index| of(&ends[index]));
            (8.0 * (one - minus) - (two - minus_two)) / (12.0 * by)
        };
        let q = SVector::<f64, N>::from_fn(|k, _| difference(&|state| state.q[k]));
        let p = SVector::<f64, N>::from_fn(|k, _| difference(&|state| state.p[k]));
        let t = difference(&|state| state.t);
        let size = 1.0 + found.q.amax().max(found.p.amax());
        let off = (found.q - q).amax().max((found.p - p).amax()).max((found.t - t).abs());
        worst = worst.max(off / size);
    }
    worst
}

const LEGS: [&[Leg]; 6] = [
    &[Leg::Steps(1)],
    &[Leg::Steps(20)],
    &[Leg::Steps(3), Leg::StepOf(0.023), Leg::Steps(3)],
    &[Leg::Steps(3), Leg::Until(0.317), Leg::Steps(2)],
    &[Leg::Steps(2), Leg::Event, Leg::Steps(3)],
    &[Leg::Steps(3), Leg::Weight, Leg::Steps(5)],
];

fn rods<S: System<4>>(system: S) -> (S, State<4>, f64) {
    let (q, v) = ([0.6, -0.8, 1.1, -1.7], [0.8, 0.6, 0.3, 0.2]);
    (system, State::projected(&system, 0.1, q, v).unwrap_or_else(|failure| panic!("{failure}")).state, 0.02)
}

fn skate() -> (Skate, State<4>, f64) {
    let system = Skate::default();
    let (q, v) = ([0.1, 0.6, -0.8, 0.4], [1.5, 0.3, 0.2, 0.7]);
    (system, State::projected(&system, 0.1, q, v).unwrap_or_else(|failure| panic!("{failure}")).state, 0.03)
}

#[test]
fn tangent_vectors_are_differences_of_projected_runs() {
    for legs in LEGS {
        let worst = [
            differs::<_, 4, 1>(rods(Driven::default()), legs),
            differs::<_, 4, 2>(rods(Driven::default()), legs),
            differs::<_, 4, 3>(rods(Free::default()), legs),
            differs::<_, 4, 1>(skate(), legs),
            differs::<_, 4, 2>(skate(), legs),
        ];
        println!("{legs:?}: {worst:?}");
        // Measured: at most 5.5e-9, by differences over 6e-5.
        assert!(worst.iter().all(|worst| *worst < 1e-8), "{legs:?}: {worst:?}");
    }
}

#[test]
fn tangent_vectors_have_velocities() {
    let (system, state, h) = rods(Driven::default());
    let v = state.velocity(&system).expect("regular");
    let end = |change: SVector<f64, 4>| {
        let start = State::projected(&system, state.t, state.q, v + change).expect("a start").state;
        let mut run = system.at_state(start).integrate(Gauss::<2>, h).expect("a start");
        follow(&mut run, &[Leg::Steps(20)]);
        run.velocity().expect("regular")
    };
    let axes: Vec<SVector<f64, 4>> = (0..4).map(|k| SVector::from_fn(|i, _| f64::from(u8::from(i == k)))).collect();
    let run = system.at_state(state).integrate(Gauss::<2>, h).expect("a start");
    let mut tangent = Tangent::new(run, vec![Variation::zero(); 4]);
    tangent.set_velocities(&axes).expect("regular");
    tangent.project().expect("regular");
    follow_tangent(&mut tangent, &[Leg::Steps(20)]);
    let by = 6e-5;
    let off = |(axis, found): (&SVector<f64, 4>, SVector<f64, 4>)| {
        let [one, minus, two, minus_two] = [1.0, -1.0, 2.0, -2.0].map(|factor| end(axis * (factor * by)));
        (found - (8.0 * (one - minus) - (two - minus_two)) / (12.0 * by)).amax()
    };
    let worst = axes.iter().zip(tangent.velocities().expect("regular")).map(off).fold(0.0, f64::max);
    println!("{worst:e}");
    // Measured: 6.7e-12, by differences over 6e-5.
    assert!(worst < 3e-11, "{worst:e}");
}

#[test]
fn inconsistent_tangent_vectors_are_refused() {
    let (system, state, h) = rods(Driven::default());
    let run = begin::<_, 4, 2>(system, state, h);
    let refused = |variation: Variation<4>| {
        let failure = Tangent::new(run.clone(), vec![variation]).step().expect_err("inconsistent");
        let StepError::InconsistentTangent { constraint, residual, impulse, .. } = failure else { panic!("{failure}") };
        assert!(failure.to_string().contains("Tangent::project"), "{failure}");
        (constraint, residual, impulse)
    };
    // 2 (u − x) δu of the lower rod.
    let (constraint, residual, _) = refused(Variation::of_coordinate(2).expect("an index"));
    assert_eq!(constraint, "lower");
    assert!((residual - 2.0 * (state.q[2] - state.q[0])).abs() < 1e-14, "{residual}");
    // A momentum along the upper rod: its gradient times 1.
    let (gradients, _) = system.constraint_gradients(state.t, &state.q);
    let (constraint, residual, impulse) = refused(Variation { p: gradients.row(0).dense(), ..Variation::zero() });
    assert_eq!((constraint, residual), ("upper", 0.0));
    assert!((impulse + 1.0).abs() < 1e-14, "{impulse}");
    // A longer rod, with an end that stays.
    let (constraint, residual, _) = refused(Variation::of_parameter::<Driven>("l").expect("a parameter"));
    assert_eq!((constraint, residual), ("upper", -2.0));
    // The weight moves nothing.
    let mut tangent = Tangent::new(run.clone(), vec![Variation::of_parameter::<Driven>("g").expect("a parameter")]);
    tangent.step().unwrap_or_else(|failure| panic!("{failure}"));
    let mut many = Tangent::new(run, vec![Variation { parameters: vec![0.0; 9], ..Variation::zero() }]);
    assert!(matches!(many.step(), Err(StepError::NoDerivative { .. })));
}

#[test]
fn only_the_last_step_has_a_derivative() {
    let (system, state, h) = rods(Free::default());
    let mut run = begin::<_, 4, 2>(system, state, h);
    let first = *run.node();
    run.step().unwrap_or_else(|failure| panic!("{failure}"));
    run.step().unwrap_or_else(|failure| panic!("{failure}"));
    let refused = |run: &ARun<Free, 4, 2>, before| {
        assert!(matches!(run.vary(&before, &mut []), Err(StepError::NoDerivative { .. })));
    };
    refused(&run, first);
    let last = *run.node();
    run.step().unwrap_or_else(|failure| panic!("{failure}"));
    run.vary(&last, &mut []).unwrap_or_else(|failure| panic!("{failure}"));
    run.set_parameters(|system| *system.parameter_mut("g").expect("a parameter") = 1.0)
        .unwrap_or_else(|failure| panic!("{failure}"));
    refused(&run, last);
}

/// The change of the two-form over steps, on admissible tangent vectors.
fn form_changes<S: System<4>, const STAGES: usize>((system, state, h): (S, State<4>, f64)) -> f64 {
    let mut seeds = Tangent::new(begin::<S, 4, STAGES>(system, state, h), Variation::of_state());
    seeds.project().unwrap_or_else(|failure| panic!("{failure}"));
    let before = seeds.variations().to_vec();
    let mut tangent = seeds;
    follow_tangent(&mut tangent, &[Leg::Steps(100)]);
    let form = |a: &Variation<4>, b: &Variation<4>| a.q.dot(&b.p) - a.p.dot(&b.q);
    let (mut worst, mut size) = (0.0_f64, 0.0_f64);
    for i in 0..before.len() {
        for j in 0..i {
            let after = form(&tangent.variations()[i], &tangent.variations()[j]);
            worst = worst.max((after - form(&before[i], &before[j])).abs());
            size = size.max(after.abs());
        }
    }
    assert!(size > 0.1, "{size}");
    worst
}

#[test]
fn tangent_maps_are_symplectic_with_holonomic_constraints_and_no_force() {
    let free = [form_changes::<_, 1>(rods(Free::default())), form_changes::<_, 2>(rods(Free::default()))];
    println!("{free:?}");
    // Measured: at most 1.4e-15.
    assert!(free.iter().all(|change| *change < 4e-15), "{free:?}");
    let damped = form_changes::<_, 2>(rods(Driven::default()));
    let skate = form_changes::<_, 2>(skate());
    println!("{damped:.1e} {skate:.1e}");
    assert!(damped > 1e-3 && skate > 1e-3, "{damped} {skate}");
}

/// Squares of places and of speeds.
struct Squares {
    steps: u64,
    names: &'static [&'static str],
}

impl<S: System<N>, const N: usize, const STAGES: usize> Objective<Gauss<STAGES>, S, N> for Squares {
    fn parameters(&self) -> &[&str] {
        self.names
    }
    fn slope(&self, step: u64, state: &State<N>) -> Covector<N> {
        let weight = if step == self.steps { 3.0 } else { 0.1 };
        Covector { q: state.q * weight, p: state.p * weight * 0.5, t: 0.3, ..Covector::zero() }
    }
}

/// The largest difference of a gradient from tangent vectors, relative to its size.
fn adjoint_differs<S: System<N>, const N: usize, const STAGES: usize>(case: (S, State<N>, f64), kept: usize) -> f64 {
    let steps = 23;
    let run = begin::<S, N, STAGES>(case.0, case.1, case.2);
    let objective = Squares { steps, names: S::PARAMETERS };
    let found = gradient(&run, steps, kept, &objective).unwrap_or_else(|failure| panic!("{failure}"));
    let directions = directions(&run);
    let mut tangent = Tangent::new(run.clone(), directions.clone());
    let slope = |tangent: &Tangent<Gauss<STAGES>, S, N>, step: u64| {
        let covector = Objective::<Gauss<STAGES>, S, N>::slope(&objective, step, &tangent.run().state());
        tangent.variations().iter().map(|variation| covector.of(variation)).collect::<Vec<_>>()
    };
    let mut sums = slope(&tangent, 0);
    for step in 1..=steps {
        tangent.step().unwrap_or_else(|failure| panic!("{failure}"));
        for (sum, slope) in sums.iter_mut().zip(slope(&tangent, step)) {
            *sum += slope;
        }
    }
    let mut worst = 0.0_f64;
    for (along, sum) in directions.iter().zip(sums) {
        if along.h != 0.0 {
            continue;
        }
        let of_parameters = found.parameters.iter().flat_map(|row| row.iter().zip(&along.parameters));
        let of_parameters: f64 = of_parameters.map(|(slope, parameter)| slope * parameter).sum();
        let off = found.start.of(along) + of_parameters - sum;
        worst = worst.max(off.abs() / (1.0 + sum.abs()));
    }
    worst
}

#[test]
fn the_adjoint_is_that_of_tangent_vectors() {
    let worst = [
        adjoint_differs::<_, 4, 1>(rods(Driven::default()), 0),
        adjoint_differs::<_, 4, 2>(rods(Driven::default()), 23),
        adjoint_differs::<_, 4, 3>(rods(Free::default()), 0),
        adjoint_differs::<_, 4, 2>(skate(), 0),
    ];
    println!("{worst:?}");
    // Measured: at most 5.5e-15.
    assert!(worst.iter().all(|worst| *worst < 2e-14), "{worst:?}");
}

#[test]
fn exponents_of_holonomic_systems_come_in_pairs() {
    let system = Free::default();
    let start = State::projected(&system, 0.0, [0.6, 0.8, 1.3, 1.5], [0.8, -0.6, 0.3, -0.2]);
    let state = start.unwrap_or_else(|failure| panic!("{failure}")).state;
    let mut lyapunov =
        Lyapunov::new(begin::<_, 4, 2>(system, state, 0.02), 4).unwrap_or_else(|failure| panic!("{failure}"));
    // Largest first, also before they have converged.
    for _ in 0..50 {
        lyapunov.advance(1).unwrap_or_else(|failure| panic!("{failure}"));
        let exponents = lyapunov.exponents();
        assert!(exponents.is_sorted_by(|one, next| one >= next), "{exponents:?}");
    }
    lyapunov.advance(1950).unwrap_or_else(|failure| panic!("{failure}"));
    let exponents = lyapunov.exponents();
    println!("{exponents:?}");
    // The motion is chaotic: 0.94, and pairs of opposite numbers up to O(1/t): 0.08 after t = 40.
    let pairs = [exponents[0] + exponents[3], exponents[1] + exponents[2]];
    assert!(exponents[0] > 0.3 && pairs.iter().all(|sum| sum.abs() < 0.2), "{exponents:?}");
    let many = Lyapunov::new(begin::<_, 4, 2>(system, state, 0.02), 5);
    assert!(matches!(many, Err(StepError::InvalidInput { .. })));
    // Of a nonholonomic and a holonomic constraint: 8 − 2 − 1.
    let (system, state, h) = skate();
    let mut lyapunov =
        Lyapunov::new(begin::<_, 4, 2>(system, state, h), 5).unwrap_or_else(|failure| panic!("{failure}"));
    lyapunov.advance(200).unwrap_or_else(|failure| panic!("{failure}"));
    assert!(lyapunov.exponents().iter().all(|exponent| exponent.is_finite()), "{:?}", lyapunov.exponents());
    assert!(Lyapunov::new(begin::<_, 4, 2>(system, state, h), 6).is_err());
}

#[test]
fn a_step_is_linearized_on_the_constraints() {
    let (system, state, h) = rods(Free::default());
    let run = begin::<_, 4, 2>(system, state, h);
    let linearization = run.linearization().unwrap_or_else(|failure| panic!("{failure}"));
    let sizes: Vec<f64> = linearization.eigenvalues().expect("converged").iter().map(|value| value.norm()).collect();
    println!("{sizes:?}");
    // Two for each rod vanish; at most 9.8e-17 was measured.
    assert_eq!(sizes.iter().filter(|size| **size < 1e-15).count(), 4, "{sizes:?}");
    assert!(sizes.iter().filter(|size| **size > 0.9).count() == 4, "{sizes:?}");
}
