//! A system with several rules takes with each of them, bit for bit, the steps of the same system with that rule only.
//! Every user of steps can use any of its rules.

use vi_core::lagrangian::{Lagrangian, Parameters};
use vi_core::rules::{By, Midpoint, Trapezoidal};
use vi_core::stepping::{EnergyStepping, FixedStepping};
use vi_core::{
    Composition, DiscreteLagrangian, EnergyPreserving, FixedStep, Interval, Run, SVector, Starts, State, StepError,
    lagrangian, run::Checkpoint,
};

/// One system with each of these lists of rules.
macro_rules! surface {
    ($($name:ident by $($rule:ident),+;)+) => {$(
        lagrangian! {
            /// A driven and damped particle on a surface: not separable, and not autonomous.
            struct $name {
                param m = 1.2, g = 2.0, c = 0.3;
                coord x, y;
                let height = cos(x) * y^2 / 4 + x^2 / 3;
                let climbing = dot(x) * (2 * x / 3 - sin(x) * y^2 / 4) + dot(y) * cos(x) * y / 2;
                L = m * (dot(x)^2 + dot(y)^2 + climbing^2) / 2 - m * g * height + t * x / 5;
                dissipation = c * (dot(x)^2 + x^2 * dot(y)^2) / 2;
                force y = cos(t) * x;
                discretize $($rule),+;
                check { x = 0.7, y = -0.4, dot(x) = 0.5, dot(y) = 0.9, t = 0.2; h = 0.004; }
            }
        }
    )+};
}
surface! {
    Surface by midpoint, trapezoidal;
    Reversed by trapezoidal, midpoint;
    OfMidpoint by midpoint;
    OfTrapezoidal by trapezoidal;
}

/// One chain, long enough for loops, with each of these lists of rules.
macro_rules! chain {
    ($($name:ident by $($rule:ident),+;)+) => {$(
        lagrangian! {
            /// Masses on stiffening springs, one of them heavier than the others.
            struct $name {
                const N = 24;
                param m = 1.2, k = 0.7;
                coord q[N];
                let springs = sum(i in 1..N, (q[i] - q[i - 1])^2 / 2 + (q[i] - q[i - 1])^4 / 4);
                L = m * sum(i in 0..N, dot(q[i])^2) / 2 + dot(q[3])^2 - k * springs - sum(i in 0..N, cos(q[i]));
                discretize $($rule),+;
            }
        }
    )+};
}
chain! {
    Chain by midpoint, trapezoidal;
    ChainOfMidpoint by midpoint;
    ChainOfTrapezoidal by trapezoidal;
}

/// The initial state on the surface.
const PLACE: ([f64; 2], [f64; 2]) = ([0.7, -0.4], [0.5, 0.9]);

/// The states of steps as bits.
fn bits<const N: usize>(steps: impl Iterator<Item = Result<State<N>, StepError>>) -> Vec<String> {
    steps.map(|state| format!("{:?}", state.expect("a step"))).collect()
}

/// Fixed and composed steps of a system, and its slots.
fn taken<const N: usize, S>(system: S, (q, v): ([f64; N], [f64; N]), h: f64) -> Vec<String>
where
    S: FixedStepping<N> + DiscreteLagrangian<N>,
{
    let start = State::at(&system, 0.3, q, v);
    let mut all = bits(system.at_state(start).integrate(FixedStep, h).expect("a start").take(200));
    all.extend(bits(system.at_state(start).integrate(Composition::SUZUKI_4, h).expect("a start").take(20)));
    let (q0, v0) = (SVector::from(q), SVector::from(v));
    let interval = Interval { t0: 0.3, q0, t1: 0.3 + h, q1: q0 + v0 * h };
    let numbers = [
        system.ld(&interval),
        system.d1_ld(&interval),
        system.d3_ld(&interval),
        system.gd_minus(&interval),
        system.gd_plus(&interval),
    ];
    let vectors =
        [system.d2_ld(&interval), system.d4_ld(&interval), system.fd_minus(&interval), system.fd_plus(&interval)];
    all.push(format!("{numbers:?} {vectors:?}"));
    all
}

/// Energy-preserving steps.
fn energy_steps<S: EnergyStepping<2>>(system: S) -> Vec<String> {
    let (q, v) = PLACE;
    let run = EnergyPreserving::from_midpoint(system, 0.3, q, v, 0.01).expect("a start");
    run.take(100).map(|step| format!("{:?}", step.expect("a step"))).collect()
}

#[test]
fn every_rule_of_a_list_takes_the_steps_that_it_takes_alone() {
    let (by_midpoint, by_trapezoidal) =
        (taken(OfMidpoint::default(), PLACE, 0.02), taken(OfTrapezoidal::default(), PLACE, 0.02));
    assert_ne!(by_midpoint, by_trapezoidal);
    assert_eq!(taken(Surface::default(), PLACE, 0.02), by_midpoint);
    assert_eq!(taken(By::new(Surface::default(), Trapezoidal), PLACE, 0.02), by_trapezoidal);
    assert_eq!(taken(By::new(&Surface::default(), Trapezoidal), PLACE, 0.02), by_trapezoidal);
    assert_eq!(taken(Reversed::default(), PLACE, 0.02), by_trapezoidal);
    assert_eq!(taken(By::new(Reversed::default(), Midpoint), PLACE, 0.02), by_midpoint);
}

#[test]
fn a_further_rule_with_a_step_density_preserves_energy() {
    let alone = energy_steps(OfMidpoint::default());
    assert_eq!(energy_steps(Surface::default()), alone);
    assert_eq!(energy_steps(By::new(Reversed::default(), Midpoint)), alone);
}

#[test]
fn functions_in_loops_are_those_of_one_rule_too() {
    let place = (core::array::from_fn(|i| [0.3, -0.2, 0.5][i % 3]), core::array::from_fn(|i| [0.1, 0.4][i % 2]));
    let (by_midpoint, by_trapezoidal) =
        (taken(ChainOfMidpoint::default(), place, 0.05), taken(ChainOfTrapezoidal::default(), place, 0.05));
    assert_eq!(taken(Chain::default(), place, 0.05), by_midpoint);
    assert_eq!(taken(By::new(&Chain::default(), Trapezoidal), place, 0.05), by_trapezoidal);
}

#[test]
fn a_checkpoint_is_of_one_rule() {
    let surface = Surface::default();
    let system = By::new(&surface, Trapezoidal);
    let (q, v) = PLACE;
    let mut whole = system.at_state(State::at(&surface, 0.3, q, v)).integrate(FixedStep, 0.02).expect("a start");
    for _ in 0..20 {
        let text = serde_json::to_string(&whole.checkpoint()).expect("numbers");
        let stored: Checkpoint<_, 2> = serde_json::from_str(&text).expect("the same numbers");
        let by_other = Run::restart(surface, FixedStep, stored.clone()).expect_err("another rule");
        assert!(matches!(by_other, StepError::OtherSystem { parameter: None, .. }), "{by_other:?}");
        let mut resumed = Run::restart(system, FixedStep, stored).expect("a checkpoint of this system by this rule");
        assert_eq!(format!("{:?}", whole.step()), format!("{:?}", resumed.step()));
    }
    let own = surface.at(0.3, q, v).integrate(FixedStep, 0.02).expect("a start").checkpoint();
    assert!(Run::restart(system, FixedStep, own.clone()).is_err());
    // A checkpoint from before rules had names belongs to the default rule.
    let text = serde_json::to_string(&own).expect("numbers").replace("\"rule\":null,", "");
    assert!(!text.contains("rule"), "{text}");
    let stored: Checkpoint<_, 2> = serde_json::from_str(&text).expect("the same numbers");
    assert!(Run::restart(surface, FixedStep, stored).is_ok());
}

#[test]
fn a_system_by_a_rule_is_the_system_in_all_else() {
    let mut by = By::new(Surface::default(), Trapezoidal);
    *by.parameter_mut("c").expect("a parameter") = 0.7;
    let surface = Surface { c: 0.7, ..Surface::default() };
    assert_eq!((*by.system(), by.rule(), by.c), (surface, Trapezoidal, 0.7));
    let (q, v) = (SVector::from(PLACE.0), SVector::from(PLACE.1));
    assert_eq!(by.acceleration(0.1, &q, &v), surface.acceleration(0.1, &q, &v));
    assert_eq!(taken(by, PLACE, 0.02), taken(OfTrapezoidal { c: 0.7, ..OfTrapezoidal::default() }, PLACE, 0.02));
}

#[test]
fn single_precision_has_every_rule() {
    /// Fixed steps in single precision.
    fn single<S: FixedStepping<2, f32>>(system: S) -> Vec<String> {
        let start = State::at(&system, 0.3, [0.7, -0.4], [0.5, 0.9]);
        let run = system.at_state(start).integrate(FixedStep, 0.02).expect("a start");
        run.take(100).map(|state| format!("{:?}", state.expect("a step"))).collect()
    }
    let alone = single(OfTrapezoidal::default().convert::<f32>());
    assert_eq!(single(By::new(Surface::default().convert::<f32>(), Trapezoidal)), alone);
}
