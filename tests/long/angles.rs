//! A rotor over many turns: an angle loses nothing, a coordinate loses the digits of its turns.

use std::f64::consts::TAU;
use vi_core::{FixedStep, Gauss, Lagrangian, Method, Run, Starts, State, lagrangian};

lagrangian! {
    struct Rotor {
        param g = 9.81;
        angle θ;
        L = dot(θ)^2 / 2 + g * cos(θ);
        discretize midpoint;
    }
}

lagrangian! {
    struct Unreduced {
        param g = 9.81;
        coord θ;
        L = dot(θ)^2 / 2 + g * cos(θ);
        discretize midpoint;
    }
}

/// Velocity at the start, and a step of about two turns.
const SPEED: f64 = 100.0;
const H: f64 = 0.125;
/// Steps after all turns in which motions are compared.
const AFTER: usize = 300;

/// A run after this number of turns.
fn turned<M: Method<S, 1>, S: Lagrangian<1> + Copy>(system: S, method: M, turns: u32) -> Run<M, S, 1> {
    let mut run = system.at(0.0, [0.3], [SPEED]).integrate(method, H).expect("a start");
    while run.state().q[0] < TAU * f64::from(turns) {
        run.step().expect("a step");
    }
    run
}

/// The largest differences of the momenta, and of the energies, between two runs over the next steps.
fn differences<M, S, Y>(mut one: Run<M, S, 1>, mut other: Run<M, Y, 1>) -> [f64; 2]
where
    M: Method<S, 1> + Method<Y, 1>,
    S: Lagrangian<1> + Copy,
    Y: Lagrangian<1> + Copy,
{
    let (mut momentum, mut energy) = (0.0_f64, 0.0_f64);
    for _ in 0..AFTER {
        let (a, b) = (one.step().expect("a step"), other.step().expect("a step"));
        momentum = momentum.max((a.p - b.p).amax());
        energy = energy.max((one.energy().expect("an energy") - other.energy().expect("an energy")).abs());
    }
    [momentum, energy]
}

/// Every increment after all turns has the bits of a run without them.
fn has_the_bits_of_a_run_without_turns<M: Method<Rotor, 1>>(mut far: Run<M, Rotor, 1>, turns: u32) {
    let mut near = far.clone();
    near.set_turns([0]).expect("turns");
    for _ in 0..AFTER {
        far.step().expect("a step");
        near.step().expect("a step");
        assert_eq!((far.node(), far.reduced(), far.energy()), (near.node(), near.reduced(), near.energy()));
    }
    assert!(far.turns()[0] > i64::from(turns) - 10 && near.turns()[0] > 90);
}

/// An angle after these turns, continued from the reduced state: the same motion. A coordinate does not continue so.
fn compared<M: Method<Rotor, 1> + Method<Unreduced, 1>>(method: M, turns: u32) -> [[f64; 2]; 2] {
    let run = turned(Rotor::default(), method.clone(), turns);
    let made = run.turns()[0];
    assert!(made.abs_diff(i64::from(turns)) <= 10, "{made}");
    has_the_bits_of_a_run_without_turns(run.clone(), turns);
    // From the same reduced state.
    let State { t, p, .. } = run.state();
    let near = Rotor::default().at_state(State { t, q: run.reduced(), p });
    let of_angle = differences(run.clone(), near.integrate(method.clone(), H).expect("a start"));
    let far = Unreduced::default().at_state(run.state());
    let of_coordinate = differences(run, far.integrate(method, H).expect("a start"));
    [of_angle, of_coordinate]
}

/// The differences after these turns, and how many times a coordinate is worse than an angle.
fn lose_nothing(turns: u32, ratio: f64) {
    let each = [("FixedStep", compared(FixedStep, turns)), ("Gauss", compared(Gauss::<2>, turns))];
    for (name, [of_angle, of_coordinate]) in each {
        println!("{name}: momentum and energy, angle {of_angle:?}, coordinate {of_coordinate:?}");
        assert!(of_angle[0] < 2e-11 && of_angle[1] < 2e-9, "{name}: {of_angle:?}");
        assert!(of_coordinate[0] > ratio * of_angle[0], "{name}: {of_coordinate:?} {of_angle:?}");
    }
}

/// Measured: momentum 5.7e-14 and 4.7e-12, energy 6.4e-12 and 4.9e-10; a coordinate 3.1e4 and 1.0e4 times worse.
#[test]
fn a_hundred_thousand_turns_lose_nothing() {
    lose_nothing(100_000, 5e3);
}

/// Measured: momentum 2.8e-14 and 1.4e-11, energy of 5000 3.6e-12 and 1.4e-9; a coordinate 9.8e5 and 7.8e5 times worse.
/// A state has no low parts, and two stages a step of two turns multiply what is lost by 500.
#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn ten_million_turns_lose_nothing() {
    lose_nothing(10_000_000, 1e5);
}

/// Without gravity θ = θ0 + n h v for every method: the product in exact arithmetic, modulo 2π.
///
/// h v = 0.625, so that θ is a number. Its turns, and its remainder from 120 digits of 2π, are given.
fn ends_where_its_velocity_leads(steps: u32, turns: i64, rest: f64, tolerance: f64) {
    let (h, v) = (0.0625_f64, 10.0_f64);
    let mut run = Rotor { g: 0.0 }.at(0.0, [0.0], [v]).integrate(FixedStep, h).expect("a start");
    for _ in 0..steps {
        run.step().expect("a step");
    }
    assert_eq!(run.turns(), [turns]);
    let error = (run.reduced()[0] - rest).abs();
    println!("off by {error:.1e}");
    assert!(error < tolerance, "{error:e}");
    assert_eq!(run.state().q[0].to_bits(), (0.625 * f64::from(steps)).to_bits());
}

/// Measured: 6.7e-13. An ulp of θ is 2.9e-11.
#[test]
fn a_free_rotor_ends_where_its_velocity_leads() {
    ends_where_its_velocity_leads(9 << 15, 29_335, 2.759_013_886_830_699, 1e-12);
}

/// A sum loses less than half an ulp of its increment a step, 5.6e-17. Measured: 1.5e-10, 2.3e-18 a step. An ulp of θ is
/// 7.5e-9.
#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn a_free_rotor_ends_where_its_velocity_leads_after_six_million_turns() {
    ends_where_its_velocity_leads(1 << 26, 6_675_442, 0.906_670_486_889_301, 2e-10);
}
