//! Gauss steps: against references, order, preserved quantities, stiffness, failures.

use crate::gauss_stiff;
use crate::support::assert_order_of;
use crate::support::exact::Trajectory;
use crate::support::reference::{file, number, steps, vector};
use crate::support::scenes::{self, Scene};
use serde_json::Value;
use vi_core::kind::Free;
use vi_core::stepping::{Convertible, FixedStepping};
use vi_core::{FixedStep, Gauss, Lagrangian, Run, Starts, State, StepError, lagrangian, run::Checkpoint};
use vi_systems::{
    DampedOscillator, DoublePendulum, DoubleWell, FpuChain, HarmonicOscillator, Kepler, Pendulum, SphericalPendulum,
};

lagrangian! {
    /// A particle in a nonuniform magnetic field: L is linear in some velocities.
    struct Magnetic {
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - (y + y^3 / 4) * dot(x) - (x^2 + 2 * y^2) / 20;
        discretize midpoint;
    }
}

lagrangian! {
    /// A relativistic particle on a spring: the momentum is not linear in the velocity.
    struct Relativistic {
        param c = 1.7, k = 1.3;
        coord x;
        L = -c^2 * sqrt(1 - dot(x)^2 / c^2) - k * x^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// Force, time dependence, varying mass and damping together.
    pub(crate) struct Everything {
        param a = 1.4, c = 0.15, w = 1.3;
        coord x, y;
        L = (1 + x^2 / 3) * dot(x)^2 / 2 + a * dot(y)^2 / 2 + x * dot(x) * dot(y) / 5 - cos(w * t) * x * y / 4 - x^2 - y^4 / 4;
        force x = -c * dot(x) + sin(t) / 5;
        force y = -c * dot(x) * dot(y);
        discretize midpoint;
    }
}

/// The requirements of a Gauss step on a system.
pub(crate) trait System<const N: usize>: Convertible<N, Kind = Free> + FixedStepping<N> {}
impl<const N: usize, S: Convertible<N, Kind = Free> + FixedStepping<N>> System<N> for S {}

/// Compares a run with a reference: nodes, and the discrete energy of the last interval.
fn follows<const N: usize, const S: usize>(name: &str, system: impl System<N>, case: &Value, limits: [f64; 3]) {
    let state = State::at(&system, 0.0, vector(&case["q0"]), vector(&case["v0"]));
    let mut run = system.at_state(state).integrate(Gauss::<S>, number(&case["h"])).expect("a valid start");
    let entries = steps(&case[&format!("s{S}")]);
    assert_eq!(entries.iter().map(|(step, _)| *step).collect::<Vec<_>>(), [1, 10, 100], "{name}");
    let mut taken = 0;
    for ((step, entry), limit) in entries.into_iter().zip(limits) {
        while taken < step {
            run.step().unwrap_or_else(|error| panic!("{name}: {error}"));
            taken += 1;
        }
        let (q, p) = (vector::<N>(&entry["q"]), vector::<N>(&entry["p"]));
        let state = run.state();
        let relative = |value: f64, exact: f64| (value - exact).abs() / exact.abs();
        let energy = run.discrete_energy().expect("a step was taken");
        let energy = relative(energy, number(&entry["E1_discrete_of_this_step"]));
        let worst = (0..N).map(|i| relative(state.q[i], q[i]).max(relative(state.p[i], p[i]))).fold(0.0, f64::max);
        println!("{name}, {S} stages, step {step}: off by {worst:.1e}, energy by {energy:.1e}");
        assert!(worst <= limit, "{name}, {S} stages, step {step}: off by {worst:e}");
        // The energy of an interval is a sum of cancelling terms. Measured: 2.6e-15.
        assert!(energy <= 1e-14, "{name}, {S} stages, step {step}: energy off by {energy:e}");
    }
}

#[test]
fn steps_are_those_of_the_references() {
    let cases = file("gauss.json");
    let each = |name: &str| cases[name].clone();
    // Relative, after 1, 10 and 100 steps. Measured: 1.0e-15, 1.3e-15, 2.9e-14.
    let limits = [5e-15, 5e-15, 1e-13];
    macro_rules! follow {
        ($($name:literal $system:expr, $n:literal;)*) => {$(
            follows::<$n, 2>($name, $system, &each($name), limits);
            follows::<$n, 4>($name, $system, &each($name), limits);
            follows::<$n, 8>($name, $system, &each($name), limits);
        )*};
    }
    follow! {
        "double_well" DoubleWell::default(), 1;
        "damped_oscillator" DampedOscillator { m: 1.0, k: 4.0, c: 0.04 }, 1;
        "kepler_e0.6" Kepler::default(), 2;
        "double_pendulum" DoublePendulum::default(), 2;
        "charged_particle_magnetic" Magnetic::default(), 2;
    }
}

/// The slope of the error of S stages over a ladder of steps, the longest first.
fn order<const N: usize, const S: usize>(scene: &Scene<impl System<N>, N>, longest: f64, tolerance: f64) {
    let start = Trajectory::new(0.2, scene.q, scene.v);
    let quarter = 2.0 * longest;
    // At four times, since an error that changes sign is small nearby.
    let exact: Vec<Trajectory<N>> =
        (1..=4).map(|k| start.at(&scene.system, start.t + f64::from(k) * quarter)).collect();
    let points: Vec<(f64, f64)> = [2_u32, 3, 4, 5, 6, 7, 8]
        .into_iter()
        .map(|count| {
            let h = quarter / f64::from(count);
            let state = State::at(&scene.system, start.t, scene.q, scene.v);
            let mut run = scene.system.at_state(state).integrate(Gauss::<S>, h).expect("a valid start");
            let mut error = 0.0_f64;
            for exact in &exact {
                let node =
                    run.by_ref().take(count as usize).last().expect("steps").unwrap_or_else(|error| panic!("{error}"));
                let p = scene.system.momentum(exact.t, &exact.q, &exact.v);
                error = error.max((node.q - exact.q).amax()).max((node.p - p).amax());
            }
            (h, error)
        })
        .collect();
    assert_order_of(S, name_of(&scene.system), &points, tolerance);
}

fn name_of<const N: usize, S: Lagrangian<N>>(_: &S) -> &'static str {
    S::NAME
}

/// Orders 2, 4 and 6, with steps long enough to exceed rounding.
fn low_orders<const N: usize>(scene: &Scene<impl System<N>, N>, h: [f64; 3]) {
    order::<N, 1>(scene, h[0], 0.03);
    order::<N, 2>(scene, h[1], 0.03);
    order::<N, 3>(scene, h[2], 0.03);
}

/// Orders 8, 10 and 12: the range between asymptotic steps and rounding is narrow.
fn high_orders<const N: usize>(scene: &Scene<impl System<N>, N>, h: [f64; 3]) {
    order::<N, 4>(scene, h[0], 0.05);
    order::<N, 5>(scene, h[1], 0.1);
    order::<N, 6>(scene, h[2], 0.1);
}

#[test]
fn the_order_is_twice_the_number_of_stages() {
    let forced = scenes::hard_duffing();
    low_orders(&forced, [0.05, 0.2, 0.4]);
    high_orders(&forced, [0.6, 0.8, 0.9]);
    let timed = scenes::parametric_pendulum();
    low_orders(&timed, [0.05, 0.2, 0.4]);
    high_orders(&timed, [0.6, 0.9, 1.4]);
    low_orders(&scenes::double_pendulum(), [0.01, 0.04, 0.05]);
    order::<2, 4>(&scenes::double_pendulum(), 0.08, 0.05);
    low_orders(&scenes::spherical_pendulum(), [0.02, 0.03, 0.04]);
    let everything = Scene { system: Everything::default(), q: [0.6, 0.9], v: [0.4, -0.3], h: 0.05, span: 1.0 };
    low_orders(&everything, [0.05, 0.2, 0.3]);
    high_orders(&everything, [0.4, 0.6, 1.1]);
    let relativistic = Scene { system: Relativistic::default(), q: [0.9], v: [0.4], h: 0.05, span: 1.0 };
    low_orders(&relativistic, [0.05, 0.2, 0.4]);
}

/// A Gauss step of one stage equals a step of the midpoint rule.
fn one_stage<const N: usize>(Scene { system, q, v, h, .. }: Scene<impl System<N>, N>) {
    let state = State::at(&system, 0.2, q, v);
    let mut midpoint = system.at_state(state).integrate(FixedStep, h).expect("a valid start");
    let mut gauss = system.at_state(state).integrate(Gauss::<1>, h).expect("a valid start");
    let mut worst = 0.0_f64;
    for _ in 0..50 {
        let (one, other) = (midpoint.step().expect("a step"), gauss.step().expect("a step"));
        worst = worst.max((one.q - other.q).amax()).max((one.p - other.p).amax());
    }
    let (name, moved) = (name_of(&system), (gauss.state().q - state.q).amax());
    println!("{name}: one stage is off by {worst:.1e} from the midpoint rule after moving by {moved:.1e}");
    // Measured: 4.3e-15.
    assert!(worst < 1e-14 && moved > 1e-2, "{name}: {worst:e}");
}

mod one_stage_is_the_midpoint_rule {
    use crate::support::scenes::each_system;

    each_system!(super::one_stage);
}

/// Backward steps return to the start.
fn there_and_back<const N: usize>(Scene { system, q, v, h, .. }: Scene<impl System<N>, N>) {
    let state = State::at(&system, 0.2, q, v);
    let there = system.at_state(state).integrate(Gauss::<3>, h).expect("a valid start").take(40).last();
    let there = there.expect("steps").expect("a step");
    let back = system.at_state(there).integrate(Gauss::<3>, -h).expect("a valid start").take(40).last();
    let back = back.expect("steps").expect("a step");
    let worst = (back.q - state.q).amax().max((back.p - state.p).amax()).max((back.t - state.t).abs());
    // Measured: 1.1e-14.
    assert!(worst < 4e-14, "{}: {worst:e}", name_of(&system));
    assert!((there.q - state.q).amax() > 1e-2, "{} did not move", name_of(&system));
}

mod backwards {
    use crate::support::scenes::each_system;

    each_system!(super::there_and_back);
}

#[test]
fn momenta_of_cyclic_coordinates_are_kept_bit_for_bit() {
    let Scene { system, q, v, h, .. } = scenes::spherical_pendulum();
    let state = State::at(&system, 0.0, q, v);
    let cyclic = <SphericalPendulum as Lagrangian<2>>::CYCLIC.iter().position(|cyclic| *cyclic).expect("the azimuth");
    let end = system.at_state(state).integrate(Gauss::<4>, 4.0 * h).expect("a valid start").take(10_000).last();
    let end = end.expect("steps").expect("a step");
    assert_eq!(end.p[cyclic].to_bits(), state.p[cyclic].to_bits());
    assert!((end.p[1 - cyclic] - state.p[1 - cyclic]).abs() > 1e-3);
}

/// The largest relative change of the angular momentum of an orbit.
fn change_of_angular_momentum(steps: u32) -> f64 {
    let system = Kepler { mu: 1.6 };
    let mut run = system.at(0.0, [0.6, 0.1], [-0.2, 1.9]).integrate(Gauss::<4>, 0.1).expect("a start");
    let of = |state: &State<2>| state.q[0] * state.p[1] - state.q[1] * state.p[0];
    let start = of(&run.state());
    let mut worst = 0.0_f64;
    for _ in 0..steps {
        worst = worst.max((of(&run.step().expect("a step")) - start).abs());
    }
    println!("angular momentum off by {:.1e}", worst / start);
    worst / start
}

#[test]
fn angular_momentum_of_ten_thousand_steps() {
    let change = change_of_angular_momentum(10_000);
    assert!(change < 1e-14, "{change:e}");
}

/// Measured: 1.6e-14.
#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn angular_momentum_of_a_million_steps() {
    let change = change_of_angular_momentum(1_000_000);
    assert!(change < 1e-13, "{change:e}");
}

/// The largest relative energy error over a number of periods, and its mean over the last tenth.
fn energy_error<const N: usize>(system: impl System<N>, state: State<N>, h: f64, count: u32) -> (f64, f64) {
    let mut run = system.at_state(state).integrate(Gauss::<8>, h).expect("a valid start");
    let exact = state.energy(&system).expect("an energy");
    let (mut worst, mut mean, mut counted) = (0.0_f64, 0.0, 0.0);
    for step in 0..count {
        let state = run.step().expect("a step");
        // Every tenth node: the energy costs as much as the step.
        if step % 10 == 0 {
            let error = state.energy(&system).expect("an energy") / exact - 1.0;
            worst = worst.max(error.abs());
            if step >= count / 10 * 9 {
                mean += error;
                counted += 1.0;
            }
        }
    }
    (worst, mean / counted)
}

/// The largest relative error of the energy of a pendulum and of an orbit over these periods.
fn energy_of_periods(count: u32, tolerance: f64) {
    let pendulum = Pendulum { m: 1.0, l: 1.0, g: 1.0 };
    // The period at 1 rad is 6.6997.
    let swing = energy_error(pendulum, State::at(&pendulum, 0.0, [1.0], [0.0]), 0.5, count / 10 * 134);
    let kepler = Kepler::default();
    let start = State::at(&kepler, 0.0, [0.4, 0.0], [0.0, 2.0]);
    let orbit = energy_error(kepler, start, core::f64::consts::TAU / 40.0, 40 * count);
    for (name, (worst, mean)) in [("pendulum", swing), ("Kepler", orbit)] {
        println!("{name}: energy off by {worst:.1e}, by {mean:.1e} in the last tenth");
        assert!(worst <= tolerance, "{name}: {worst:e}");
    }
}

#[test]
fn energy_of_a_thousand_periods() {
    // Measured: 3.1e-15 and 8.3e-14.
    energy_of_periods(1000, 2e-13);
}

/// Roundings of the forces walk randomly. Measured: 7.3e-14 and 1.1e-13.
#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn energy_of_a_hundred_thousand_periods() {
    energy_of_periods(100_000, 3e-13);
}

#[test]
fn the_discrete_energy_oscillates_as_it_should() {
    // 2s γ_s h^2s (Dmax − Dmin): q0, s, at h = 0.1.
    fn spread<const S: usize>(q0: f64) -> f64 {
        let system = DoubleWell::default();
        let mut run = system.at(0.0, [q0], [0.0]).integrate(Gauss::<S>, 0.1).expect("a start");
        let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
        for _ in 0..2000 {
            run.step().expect("a step");
            let energy = run.discrete_energy().expect("an energy");
            (least, largest) = (least.min(energy), largest.max(energy));
        }
        largest - least
    }
    let cases = [
        ("0.74, 2 stages", spread::<2>(0.74), 1.194e-9),
        ("0.74, 3 stages", spread::<3>(0.74), 4.569e-13),
        ("0.995, 2 stages", spread::<2>(0.995), 1.296e-6),
        ("0.995, 3 stages", spread::<3>(0.995), 8.065e-10),
    ];
    for (name, found, expected) in cases {
        println!("{name}: {found:.3e}, {expected:.3e} expected");
        assert!((found / expected - 1.0).abs() < 0.02, "{name}: {found:e}");
    }
}

#[test]
fn angles_beyond_the_fast_sine_are_solved_too() {
    let system = DoublePendulum::default();
    let turns = 40_000.0 * core::f64::consts::TAU;
    let run = |turned: f64| {
        let state = State::at(&system, 0.0, [2.0 + turned, 2.0], [0.0, 0.0]);
        system
            .at_state(state)
            .integrate(Gauss::<8>, 0.05)
            .expect("a start")
            .take(40)
            .last()
            .expect("steps")
            .expect("a step")
    };
    let (near, far) = (run(0.0), run(turns));
    let off = (far.q[0] - turns - near.q[0]).abs().max((far.p - near.p).amax());
    println!("off by {off:.1e}");
    // A quarter of a million radians rounds to 3e-11. Measured: 1.1e-9.
    assert!(off < 5e-9, "{off:e}");
}

lagrangian! {
    /// Two masses with a nearly rigid coupling: velocities are small differences of contributions of the momenta.
    struct Coupled {
        coord x, y;
        L = (dot(x)^2 + dot(y)^2)/2 + 0.99*cos(x*y/10)*dot(x)*dot(y) - x^2/2 - y^2;
        discretize midpoint;
    }
}

/// Mean iterations, and the number of zeros of the second velocity.
fn iterations(system: impl System<2>, q: [f64; 2], h: f64) -> (f64, u32) {
    let mut run = system.at(0.0, q, [0.0, 0.0]).integrate(Gauss::<8>, h).expect("a start");
    let mut sweeps = 0;
    let mut turns = 0;
    let mut last = run.velocity().expect("regular").y;
    for _ in 0..10_000 {
        run.step().expect("a step");
        sweeps += run.iterations();
        let v = run.velocity().expect("regular").y;
        turns += u32::from(v * last < 0.0);
        last = v;
    }
    let mean = f64::from(sweeps) / 10_000.0;
    println!("{mean} sweeps, {turns} turns");
    (mean, turns)
}

/// A velocity is a sum of larger terms, whose rounding no iteration reduces. A criterion relative to the velocity
/// itself took 4.25 and 8.6 iterations.
#[test]
fn velocities_whose_terms_cancel_take_no_further_iterations() {
    let (mean, turns) = iterations(DoublePendulum { g: 1.0, ..DoublePendulum::default() }, [1.2, 0.5], 0.05);
    // Measured: 4.02.
    assert!(turns > 100 && mean < 4.1, "{mean} sweeps, {turns} turns");
    let (mean, turns) = iterations(Coupled::default(), [0.5, 0.3], 0.02);
    // Measured: 2.98.
    assert!(turns > 10 && mean < 3.1, "{mean} sweeps, {turns} turns");
}

#[test]
fn stages_that_do_not_converge_are_a_typed_error_and_nothing_is_lost() {
    let system = DoubleWell::default();
    let state = State::at(&system, 0.3, [3.0], [0.0]);
    let mut run = system.at_state(state).integrate(Gauss::<3>, 2.0).expect("a valid start");
    let error = run.step().expect_err("a step far too long");
    let StepError::StagesNotConverged { t, h, iterations, stiffness, .. } = error else { panic!("{error}") };
    assert_eq!((t, h), (0.3, 2.0));
    assert!(iterations > 1 && stiffness > 10.0, "{error}");
    assert_eq!(run.state(), state);
    assert_eq!(run.step().expect_err("the same error"), error);
    let message = error.to_string();
    assert!(message.contains("did not converge") && message.contains("take steps shorter than 2"), "{message}");
}

#[test]
fn what_is_not_finite_is_named() {
    let system = Kepler::default();
    let state = State::at(&system, 0.0, [0.0, 0.0], [1.0, 0.0]);
    let error = system
        .at_state(state)
        .integrate(Gauss::<4>, 0.1)
        .and_then(|mut run| run.step())
        .expect_err("no force at the centre");
    assert!(matches!(error, StepError::NonFinite { expression: Some(_), .. }), "{error}");
    for h in [0.0, f64::NAN, f64::INFINITY] {
        let start = State::at(&system, 0.0, [1.0, 0.0], [0.0, 1.0]);
        let error = system.at_state(start).integrate(Gauss::<4>, h).expect_err("no step");
        assert!(matches!(error, StepError::InvalidInput { .. }), "{error}");
    }
}

/// Restarts after each step: the next steps must equal those of the uninterrupted run.
fn resumes<const N: usize, const S: usize>(system: impl System<N>, (q, v): ([f64; N], [f64; N]), h: f64, count: u32) {
    let mut whole = system.at(0.3, q, v).integrate(Gauss::<S>, h).expect("a start");
    let mut resumed = whole.clone();
    for step in 0..count {
        let text = serde_json::to_string(&resumed.checkpoint()).expect("numbers");
        let stored: Checkpoint<_, N> = serde_json::from_str(&text).expect("the same numbers");
        resumed = Run::restart(system, Gauss, stored).expect("a checkpoint of this system");
        let (next, again) = (whole.step(), resumed.step());
        assert_eq!(format!("{next:?}"), format!("{again:?}"), "{} stages, h = {h}, step {step}", S);
        assert!(next.is_ok(), "{next:?}");
        assert_eq!(format!("{:?}", whole.checkpoint()), format!("{:?}", resumed.checkpoint()));
    }
}

#[test]
fn a_run_that_is_stored_goes_on_bit_for_bit() {
    resumes::<1, 4>(DoubleWell { m: 1.3 }, ([0.9], [0.1]), 0.3, 200);
    resumes::<2, 8>(Kepler { mu: 1.2 }, ([1.1, 0.0], [0.1, 0.9]), -0.2, 200);
    resumes::<2, 3>(scenes::double_pendulum().system, ([0.5, -0.3], [0.2, 0.1]), 0.05, 200);
    // Stiff steps.
    resumes::<1, 4>(DampedOscillator::default(), ([0.7], [0.3]), 5.0, 30);
    resumes::<16, 8>(FpuChain::default(), gauss_stiff::lowest_mode(), 2.3, 60);
    resumes::<1, 5>(HarmonicOscillator { m: 1.3, k: 0.7 }, ([0.7], [0.3]), 40.0, 200);
}

#[test]
fn a_checkpoint_is_resumed_by_its_own_system_only() {
    let system = Kepler { mu: 1.2 };
    let start = State::at(&system, 0.0, [1.0, 0.0], [0.0, 1.1]);
    let run = system.at_state(start).integrate(Gauss::<4>, 0.1).expect("a start");
    let error = Run::restart(Kepler { mu: 1.3 }, Gauss, run.checkpoint()).expect_err("another parameter");
    assert!(matches!(error, StepError::OtherSystem { parameter: Some("mu"), .. }), "{error}");
}

lagrangian! {
    /// A relativistic particle in a field: velocities beyond 1 have no momentum.
    struct Accelerated {
        coord x;
        L = -sqrt(1 - dot(x)^2) + 3 * x;
        discretize midpoint;
    }
}

lagrangian! {
    /// Damped and driven at every position.
    struct Anywhere {
        coord x;
        L = dot(x)^2 / 2;
        force x = -dot(x) / 2 + cos(t);
        discretize midpoint;
    }
}

lagrangian! {
    /// A wall too steep for long steps.
    struct Wall {
        coord x;
        L = dot(x)^2 / 2 - exp(-50 * x) - x;
        discretize midpoint;
    }
}

lagrangian! {
    /// A mass that vanishes at the origin.
    struct Vanishing {
        coord x;
        L = x^2 * dot(x)^2 / 2 + x;
        discretize midpoint;
    }
}

#[test]
fn stages_that_leave_the_domain_are_an_error_or_right() {
    for h in [0.1, 0.5, 5.0] {
        let system = Accelerated::default();
        let mut run = system.at(0.0, [0.0], [0.0]).integrate(Gauss::<3>, h).expect("a valid start");
        // p = 3 t, and x = (√(1 + p²) − 1)/3.
        for step in 1..=10 {
            let Ok(state) = run.step() else { break };
            let p = 3.0 * h * f64::from(step);
            assert!((state.p[0] - p).abs() < 1e-12 * p, "h = {h}: {state:?}");
            assert!(state.q[0].abs() < h * f64::from(step), "h = {h}, faster than light: {state:?}");
            assert!(run.residual().is_finite() && run.discrete_energy().is_some(), "h = {h}");
        }
    }
    let system = Vanishing::default();
    let mut run = system.at(0.0, [1.0], [-2.0]).integrate(Gauss::<3>, 1.0).expect("a valid start");
    let error = run.step().expect_err("the mass vanishes on the way");
    assert!(matches!(error, StepError::StagesNotConverged { .. } | StepError::NonFinite { .. }), "{error}");
}

#[test]
fn velocities_are_solved_wherever_the_positions_are() {
    let system = Anywhere::default();
    let step = |x: f64| {
        let state = State::at(&system, 0.0, [x], [1.0]);
        system.at_state(state).integrate(Gauss::<8>, 0.1).expect("a start").step().expect("a step").p[0]
    };
    for x in [1e6, 1e12, 1e17] {
        // Measured: 4.4e-16.
        assert!((step(x) - step(0.0)).abs() < 2e-15, "x = {x:e}: {} and {}", step(x), step(0.0));
    }
}

#[test]
fn a_step_that_newton_does_not_solve_is_an_error() {
    let system = Wall::default();
    let mut run = system.at(0.0, [1.0], [-1.0]).integrate(Gauss::<1>, 1.0).expect("a valid start");
    for _ in 0..5 {
        match run.step() {
            // p1 − p0 = h F at the midpoint, and L_v there is the mean of both.
            Ok(state) => assert!(state.p[0].abs() < 100.0, "{state:?}"),
            Err(error) => return assert!(matches!(error, StepError::StagesNotConverged { .. }), "{error}"),
        }
    }
}
