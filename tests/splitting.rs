//! Splittings: against an independent program with 40 digits, their order by slope, their structure over long times, and
//! what they share with other methods.

use crate::support::slope;
use vi_core::derivatives::{Covector, Objective, Tangent, Variation, gradient};
use vi_core::motion::Separable;
use vi_core::stepping::Convertible;
use vi_core::{Gauss, Presumed, Run, SVector, Splitting, Starts, State, StepError, Tolerance, lagrangian};
use vi_systems::{DampedOscillator, DoublePendulum, FpuChain, OuterSolarSystem, Pendulum};

lagrangian! {
    /// Two particles in a potential without symmetry, driven, with a force that has no potential.
    struct Driven {
        param m = 1.5, k = 0.75, w = 1.875, b = 0.25;
        coord x, y;
        L = m / 2 * dot(x)^2 + dot(y)^2 - k * x^4 / 4 - x^2 * y / 4 - y^4 / 2 - x * y;
        force x = sin(w * t) / 2;
        force y = b * sin(x);
    }
}

lagrangian! {
    /// The same without forces.
    struct Free {
        param m = 1.5, k = 0.75;
        coord x, y;
        L = m / 2 * dot(x)^2 + dot(y)^2 + dot(x) * dot(y) / 2 - k * x^4 / 4 - x^2 * y / 4 - y^4 / 2 - x * y;
    }
}

lagrangian! {
    /// A fast particle in a driven trap: its kinetic energy is no quadratic form.
    struct Fast {
        param c = 1.3, k = 0.75, w = 1.875;
        coord x, y;
        momentum p of x, r of y;
        H = c * sqrt(c^2 + p^2 + r^2) + p^2 * r^2 / 9 + k * x^4 / 4 + x^2 * y / 4 + y^4 / 2 + sin(w * t) * x / 2;
        force y = sin(x) / 5;
    }
}

/// The trap of [`Fast`] by L: its momenta are not in the order of their coordinates.
#[allow(dead_code)] // for the compiler
mod not_in_order {
    vi_core::lagrangian! {
        pub(super) struct Crossed {
            coord x, y, r, p;
            L = p * dot(x) + r * dot(y) - (p^2 + r^4 + x^4 + y^2) / 2;
        }
    }
}

const START: [[f64; 2]; 2] = [[0.75, -0.25], [0.5, 0.875]];

fn run<S: Separable<N>, const N: usize>(
    system: S,
    [q, v]: [[f64; N]; 2],
    scheme: Splitting,
    h: f64,
) -> Run<Splitting, S, N> {
    system.at(0.0, q, v).integrate(scheme, h).unwrap_or_else(|error| panic!("{}: {error}", scheme.name))
}

/// The state after some steps.
fn after<S: Separable<N>, const N: usize>(mut run: Run<Splitting, S, N>, steps: u32) -> State<N> {
    for _ in 0..steps {
        run.step().unwrap_or_else(|error| panic!("{error}"));
    }
    run.state()
}

#[test]
fn steps_are_those_of_another_program() {
    // Twenty steps of h = 1/8, with mpmath and 40 digits.
    let known = [
        [0.278_902_311_550_167_37, 0.221_455_859_767_652_4, -1.736_103_096_787_050_8, -0.861_908_147_338_393],
        [0.281_511_681_212_083_5, 0.222_132_447_728_585_5, -1.734_099_849_152_146, -0.863_042_966_136_395_3],
        [0.281_511_648_252_154_9, 0.222_132_432_280_095_9, -1.734_099_870_812_373_2, -0.863_042_968_167_103_7],
        [0.281_511_648_250_543_87, 0.222_132_432_282_158_84, -1.734_099_870_817_005_7, -0.863_042_968_167_614_8],
    ];
    for (scheme, known) in Splitting::ALL.into_iter().zip(known) {
        let State { q, p, .. } = after(run(Driven::default(), START, scheme, 0.125), 20);
        let off =
            q.iter().chain(&p).zip(known).fold(0.0, |worst, (number, known)| f64::max(worst, (number - known).abs()));
        println!("{}: {off:e}", scheme.name);
        // Measured: at most 2.3e-16.
        assert!(off < 1e-15, "{}: {off:e}", scheme.name);
    }
}

#[test]
fn weights_are_symmetric_and_of_sum_one() {
    for Splitting { name, kicks, drifts, .. } in Splitting::ALL {
        assert_eq!(kicks.len().abs_diff(drifts.len()), 1, "{name}");
        for weights in [kicks, drifts] {
            // Measured: at most 1.2e-16.
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 5e-16, "{name}");
            assert!(weights.iter().eq(weights.iter().rev()), "{name}");
        }
    }
}

#[test]
fn the_orders_are_2_4_and_6() {
    let driven = Driven { m: 1.3, k: 0.9, w: 1.7, b: 0.4 };
    let exact = |steps| {
        let mut exact = driven.at(0.0, START[0], START[1]).integrate(Gauss::<8>, 0.05).expect("a start");
        for _ in 0..steps {
            exact.step().expect("a step");
        }
        exact.state()
    };
    let end = exact(80);
    let chain = FpuChain { m: 0.8, k: 1.2, beta: 0.3, ..FpuChain::default() };
    let mut q = [0.0; 16];
    q[3] = 0.7;
    q[4] = -0.4;
    let mut of_chain = chain.at(0.0, q, [0.0; 16]).integrate(Gauss::<8>, 0.1).expect("a start");
    let end_of_chain = of_chain.until(4.0).expect("the end");
    let counts = [[320, 480, 640], [40, 60, 80], [32, 40, 48], [24, 28, 32], [40, 60, 80], [32, 40, 48]];
    for (scheme, counts) in Splitting::ALL.into_iter().zip(counts) {
        let error = |count: u32| {
            let State { q, p, .. } = after(run(driven, START, scheme, 4.0 / f64::from(count)), count);
            (4.0 / f64::from(count), (q - end.q).norm() + (p - end.p).norm())
        };
        let of_chain = |count: u32| {
            let State { q, p, .. } = after(run(chain, [q, [0.0; 16]], scheme, 4.0 / f64::from(count)), count);
            (4.0 / f64::from(count), (q - end_of_chain.q).norm() + (p - end_of_chain.p).norm())
        };
        let order = f64::from(scheme.order);
        for (name, points) in [("driven", counts.map(error)), ("chain", counts.map(of_chain))] {
            let slope = slope(&format!("{}, {name}", scheme.name), &points, 1e-14);
            // Measured: within 0.08, and 0.3 for fourteen forces.
            assert!((slope - order).abs() < if scheme == Splitting::BLANES_MOAN_6 { 0.5 } else { 0.2 }, "{slope}");
        }
    }
}

#[test]
fn a_hamiltonian_of_first_order_splits() {
    let fast = Fast { c: 1.1, k: 0.9, w: 1.7 };
    let q = [0.75, -0.25, 0.5, 0.875];
    let start = || fast.at(0.0, q, [0.0; 4]);
    let end = start().integrate(Gauss::<8>, 0.05).and_then(|mut run| run.until(4.0)).expect("the end");
    let counts = [[320, 480, 640], [60, 80, 100], [48, 56, 64]];
    let schemes = [Splitting::VERLET, Splitting::BLANES_MOAN_S4, Splitting::BLANES_MOAN_S6];
    for (scheme, counts) in schemes.into_iter().zip(counts) {
        let error = |count: u32| {
            let h = 4.0 / f64::from(count);
            let mut run = start().integrate(scheme, h).expect("a start");
            for _ in 0..count {
                run.step().expect("a step");
            }
            let State { q, p, .. } = run.state();
            // The momenta of x and y are coordinates, bit for bit.
            assert_eq!([p[0].to_bits(), p[1].to_bits(), 0], [q[2].to_bits(), q[3].to_bits(), p[2].to_bits()]);
            (h, (q - end.q).norm())
        };
        let slope = slope(&format!("{}, of first order", scheme.name), &counts.map(error), 1e-14);
        // Measured: within 0.1.
        assert!((slope - f64::from(scheme.order)).abs() < 0.3, "{slope}");
        // Back again, by the rounding of 40 steps.
        let mut there = start().integrate(scheme, 0.1).and_then(|mut run| run.until(2.0)).expect("there");
        let back = fast.at_state(there).integrate(scheme, -0.1).and_then(|mut run| run.until(0.0)).expect("back");
        assert!((back.q - SVector::from(q)).amax() < 1e-14, "{}", back.q); // 1.1e-15
        there.q[0] += 1e-3;
        let refused = fast.at_state(there).integrate(scheme, 0.1).and_then(|mut run| run.step());
        assert!(refused.is_ok(), "{refused:?}");
    }
    // Tangent vectors are differences of runs.
    let mut tangent = {
        let run = start().integrate(Splitting::BLANES_MOAN_S6, 0.1).expect("a start");
        let variations = vec![Variation::of_coordinate(1).expect("a coordinate"), Variation::of_index(1)];
        let mut tangent = Tangent::new(run, variations);
        tangent.project().expect("momenta");
        tangent
    };
    let moved = |by: f64, k: f64| {
        let mut q = q;
        q[1] += by;
        let run = Fast { k, ..fast }.at(0.0, q, [0.0; 4]).integrate(Splitting::BLANES_MOAN_S6, 0.1);
        run.and_then(|mut run| run.until(2.0)).expect("the end").q
    };
    let after = tangent.until(2.0).expect("the end");
    assert!((after.q - moved(0.0, fast.k)).amax() < 1e-14);
    for (variation, by, k) in [(0, 1e-5, 0.0), (1, 0.0, 1e-5)] {
        let difference = (moved(by, fast.k + k) - moved(-by, fast.k - k)) / 2e-5;
        let found = tangent.variations()[variation].q;
        assert!((difference - found).amax() < 1e-9, "{difference} {found}"); // 5e-11
    }
    // Other momenta than those of L.
    let other = State { p: [9.0, 0.875, 0.0, 0.0].into(), ..fast.at(0.0, q, [0.0; 4]).state };
    let refused = fast.at_state(other).integrate(Splitting::BLANES_MOAN_S4, 0.1).map(drop);
    assert!(matches!(refused, Err(StepError::InvalidInput { .. })), "{refused:?}");
    // Weights for a mass matrix lose their order here.
    for scheme in [Splitting::BLANES_MOAN_4, Splitting::BLANES_MOAN_6_SHORT, Splitting::BLANES_MOAN_6] {
        let refused = start().integrate(scheme, 0.1).map(drop);
        assert!(matches!(refused, Err(StepError::InvalidInput { .. })), "{refused:?}");
    }
    let crossed = Presumed(not_in_order::Crossed::default()).at(0.0, [0.1; 4], [0.0; 4]);
    let refused = crossed.integrate(Splitting::BLANES_MOAN_S4, 0.1).map(drop);
    assert!(matches!(refused, Err(StepError::NotSeparable { .. })), "{refused:?}");
}

#[test]
fn the_map_is_symplectic_and_its_own_inverse() {
    let free = Free { m: 1.3, k: 0.9 };
    for scheme in Splitting::ALL {
        let start = run(free, START, scheme, 0.3);
        let mut tangent = Tangent::new(start.clone(), Variation::of_state());
        for _ in 0..100 {
            tangent.step().expect("a step");
        }
        let columns = tangent.variations();
        let product = |a: &Variation<2>, b: &Variation<2>| a.q.dot(&b.p) - a.p.dot(&b.q);
        let mut worst = 0.0_f64;
        for (i, a) in columns.iter().enumerate() {
            for (j, b) in columns.iter().enumerate() {
                let wanted = f64::from(u8::from(i + 2 == j)) - f64::from(u8::from(j + 2 == i));
                worst = worst.max((product(a, b) - wanted).abs());
            }
        }
        let largest = columns.iter().map(|column| column.q.norm() + column.p.norm()).fold(0.0, f64::max);
        let there = after(start, 100);
        let mut back = free.at_state(there).integrate(scheme, -0.3).expect("a start");
        let back = (0..100).map(|_| back.step().expect("a step")).last().expect("a state");
        let off = (back.q - SVector::from(START[0])).amax();
        println!("{}: {worst:e} of {largest}, back again {off:e}", scheme.name);
        // Measured: at most 3.4e-12, of columns up to 250, and 1.4e-13.
        assert!(worst < 1e-11 && largest > 10.0, "{}: {worst:e} {largest}", scheme.name);
        assert!(off < 5e-13 && (there.q - SVector::from(START[0])).amax() > 0.1, "{}: {off:e}", scheme.name);
    }
}

/// The sum of the squares of the coordinates at the end, by the stiffness.
struct AtEnd {
    steps: u64,
}

impl<S: Separable<2>> Objective<Splitting, S, 2> for AtEnd {
    fn parameters(&self) -> &[&str] {
        &["k"]
    }

    fn slope(&self, step: u64, state: &State<2>) -> Covector<2> {
        let part = if step == self.steps { 2.0 } else { 0.0 };
        Covector { q: state.q * part, ..Covector::zero() }
    }
}

#[test]
fn tangents_and_gradients_agree_with_differences() {
    const STEPS: u32 = 12;
    const D: f64 = 1e-6;
    let at = |k: f64, x: f64, h: f64| {
        let system = Driven { k, ..Driven::default() };
        after(run(system, [[x, START[0][1]], START[1]], Splitting::BLANES_MOAN_6, h), STEPS).q.norm_squared()
    };
    for scheme in Splitting::ALL {
        let begun = run(Driven::default(), START, scheme, 0.2);
        let by_length = Variation { h: 1.0, ..Variation::zero() };
        let directions = vec![
            Variation::of_coordinate(0).expect("x"),
            Variation::of_parameter::<Driven>("k").expect("k"),
            by_length,
        ];
        let mut tangent = Tangent::new(begun.clone(), directions);
        for _ in 0..STEPS {
            tangent.step().expect("a step");
        }
        let q = tangent.run().state().q;
        let slopes: Vec<f64> = tangent.variations().iter().map(|variation| 2.0 * q.dot(&variation.q)).collect();
        let backward = gradient(&begun, u64::from(STEPS), 4, &AtEnd { steps: u64::from(STEPS) }).expect("a gradient");
        let of_k: f64 = backward.parameters.iter().map(|row| row[0]).sum();
        println!("{}: {slopes:?} {} {of_k}", scheme.name, backward.start.q[0]);
        // Measured: 1e-14.
        assert!((backward.start.q[0] - slopes[0]).abs() < 1e-13 && (of_k - slopes[1]).abs() < 1e-13, "{}", scheme.name);
        if scheme != Splitting::BLANES_MOAN_6 {
            continue;
        }
        let differences = [
            at(0.75, START[0][0] + D, 0.2) - at(0.75, START[0][0] - D, 0.2),
            at(0.75 + D, START[0][0], 0.2) - at(0.75 - D, START[0][0], 0.2),
            at(0.75, START[0][0], 0.2 + D) - at(0.75, START[0][0], 0.2 - D),
        ];
        for (slope, difference) in slopes.iter().zip(differences) {
            println!("{:e}", slope - difference / (2.0 * D));
            // Measured: 1.5e-9, for the length.
            assert!((slope - difference / (2.0 * D)).abs() < 5e-9, "{slope} {}", difference / (2.0 * D));
        }
    }
}

#[test]
fn energies_and_momenta_stay() {
    // Total momentum and angular momentum of the planets over 1e4 steps of 100 days.
    let system = OuterSolarSystem::default();
    let (q, v) = (OuterSolarSystem::POSITIONS, OuterSolarSystem::VELOCITIES);
    let mut orbit = run(system, [q, v], Splitting::BLANES_MOAN_6, 100.0);
    let total =
        |state: &State<18>| -> [f64; 3] { core::array::from_fn(|i| (0..6).map(|body| state.p[6 * i + body]).sum()) };
    let (momentum, energy) = (total(&orbit.state()), orbit.energy().expect("an energy"));
    let (mut first, mut second, mut moved) = (0.0_f64, 0.0_f64, 0.0_f64);
    for step in 0..10_000 {
        let state = orbit.step().expect("a step");
        let error = (orbit.energy().expect("an energy") / energy - 1.0).abs();
        if step < 5000 {
            first = first.max(error);
        } else {
            second = second.max(error);
        }
        moved = total(&state).iter().zip(momentum).fold(moved, |worst, (now, before)| worst.max((now - before).abs()));
    }
    println!("{first:e} {second:e} {moved:e}");
    // Measured: 2.4e-12 in both halves, and 1.6e-20 of momenta up to 7e-6.
    assert!(first < 1e-11 && second < 1.2 * first, "{first:e} {second:e}");
    assert!(moved < 1e-19, "{moved:e}");
}

#[test]
fn runs_restart_change_and_end_as_others() {
    for scheme in Splitting::ALL {
        let mut begun = run(Driven::default(), START, scheme, 0.2);
        for _ in 0..30 {
            begun.step().expect("a step");
        }
        let text = serde_json::to_string(&begun.checkpoint()).expect("plain numbers");
        let stored = || serde_json::from_str(&text).expect("what was written");
        let mut again = Run::restart(Driven::default(), scheme, stored()).expect("the same system");
        for _ in 0..30 {
            assert_eq!(begun.step(), again.step());
            assert_eq!(begun.node(), again.node());
        }
        let other = if scheme == Splitting::VERLET { Splitting::BLANES_MOAN_4 } else { Splitting::VERLET };
        let refused = Run::restart(Driven::default(), other, stored());
        assert!(matches!(refused, Err(StepError::OtherSystem { .. })), "{refused:?}");
        let own = Splitting { kicks: &[0.25, 0.5, 0.25], drifts: &[0.5, 0.5], ..scheme };
        let refused = Run::restart(Driven::default(), own, stored());
        assert!(matches!(refused, Err(StepError::InvalidInput { .. })), "{refused:?}");
        // Other parameters from here on are those of a new run.
        begun.set_parameters(|system| system.k = 2.0).expect("finite");
        let fresh = Driven { k: 2.0, ..Driven::default() }.at_state(begun.state()).integrate(scheme, 0.2);
        let (of_run, of_fresh) = (begun.step().expect("a step"), fresh.and_then(|mut run| run.step()).expect("a step"));
        // The low parts of the node: measured 1.1e-16.
        assert!((of_run.q - of_fresh.q).amax() < 1e-15 && (of_run.p - of_fresh.p).amax() < 1e-15);
        // A time between nodes, a partial step, and an estimate.
        begun.until(begun.t() + 0.33).expect("a time");
        let held = Driven::default().at(0.0, START[0], START[1]).integrate(scheme, Tolerance(1e-6)).expect("a step");
        assert!(held.h() > 1e-4 && held.h() < 2.0, "{}: {}", scheme.name, held.h());
        // A force that overflows ends the run, which keeps its state.
        let mut far = run(Driven::default(), [[1e110, 0.0], [0.0, 0.0]], Splitting::BLANES_MOAN_6, 0.2);
        let before = far.state();
        let failure = far.step().expect_err("an overflow");
        assert!(matches!(failure, StepError::NonFinite { .. }), "{failure}");
        assert_eq!((far.state(), far.step()), (before, Err(failure)));
    }
    let start = Driven::default().at(0.0, [1e300, 0.0], [0.0, 0.0]).integrate(Splitting::VERLET, 0.1);
    assert!(matches!(start, Err(StepError::NonFinite { .. })), "{start:?}");
    let wrong = |kicks, drifts| {
        let scheme = Splitting { name: "wrong", order: 2, kicks, drifts, is_nystrom: false };
        Driven::default().at(0.0, START[0], START[1]).integrate(scheme, 0.1).map(drop).expect_err("wrong weights")
    };
    let endless = Splitting { order: u32::MAX, ..Splitting::VERLET };
    let endless = Driven::default().at(0.0, START[0], START[1]).integrate(endless, Tolerance(1e-6)).map(drop);
    assert!(matches!(endless, Err(StepError::InvalidInput { .. })), "{endless:?}");
    for (kicks, drifts, word) in [
        (&[][..], &[][..], "take turns"),
        (&[0.5, 0.5], &[0.5, 0.5], "take turns"),
        (&[1.0], &[0.5, 0.6], "sum of the drifts"),
        (&[f64::NAN, 1.0], &[1.0], "sum of the kicks"),
    ] {
        let text = wrong(kicks, drifts).to_string();
        assert!(text.contains(word), "{text}");
    }
    let short = Driven::default().at(0.0, START[0], START[1]).integrate(Splitting::VERLET, 0.0);
    assert!(matches!(short, Err(StepError::InvalidInput { .. })), "{short:?}");
}

#[test]
fn a_monitor_measures_steps_that_begin_with_a_kick() {
    // The force at the end of a step is that of the next one: steps that are past have another one.
    for scheme in Splitting::ALL {
        let mut watched = run(Driven::default(), START, scheme, 0.1).monitored();
        let mut largest = 0.0_f64;
        for _ in 0..40 {
            let error = watched.run().local_error().expect("a step");
            largest = largest.max(error.q.amax()).max(error.hv.amax());
            watched.step().expect("a step");
        }
        // Relative to excursions of about 1. Measured: 1.28 to 1.36.
        let ratio = watched.largest().estimate / largest;
        assert!((1.0..2.0).contains(&ratio), "{}: {ratio}", scheme.name);
    }
}

/// The refusal of a system whose motion does not split.
fn refused<S: Convertible<N, In<f64> = S, Kind = vi_core::kind::Free>, const N: usize>(system: S) {
    let begun = Presumed(system).at(0.0, [0.5; N], [0.1; N]).integrate(Splitting::VERLET, 0.01);
    let failure = begun.map(drop).expect_err("no splitting");
    assert_eq!(failure, StepError::NotSeparable { system: S::NAME });
    let text = failure.to_string();
    assert!(text.contains(S::NAME) && text.contains("velocities") && text.contains("`Gauss`"), "{text}");
}

#[test]
fn other_motions_are_refused() {
    refused(DoublePendulum::default());
    refused(DampedOscillator::default());
    // The same wrapper takes one that splits, with the same numbers to rounding.
    let pendulum = Pendulum::default();
    let presumed = after(run(Presumed(pendulum), [[1.0], [0.3]], Splitting::BLANES_MOAN_6, 0.05), 100);
    let inlined = after(run(pendulum, [[1.0], [0.3]], Splitting::BLANES_MOAN_6, 0.05), 100);
    // Measured: equal.
    assert!((presumed.q - inlined.q).amax() < 1e-14 && (presumed.p - inlined.p).amax() < 1e-14);
}

lagrangian! {
    /// A rotor that turns fast.
    struct Rotor {
        param g = 1e4;
        angle θ;
        L = dot(θ)^2 / 2 + g * cos(θ);
    }
}

#[test]
fn tangents_follow_angles_over_whole_turns() {
    for scheme in Splitting::ALL {
        let begun = run(Rotor::default(), [[0.3], [1300.0]], scheme, 3e-4);
        let mut tangent = Tangent::new(begun, Variation::of_state());
        for _ in 0..5000 {
            tangent.step().unwrap_or_else(|error| panic!("{}: {error}", scheme.name));
        }
        assert!(tangent.run().turns()[0] > 100, "{}", scheme.name);
    }
}
