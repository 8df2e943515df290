//! Compositions: against 50-digit references, of their order by slope, and unstable where damping meets negative substeps.

mod support;

use support::exact::Motion;
use support::reference::{file, number, steps, vector};
use support::slope;
use vi_core::{Composition, Scheme, State, StepError, Stepping};
use vi_systems::{DampedOscillator, DoublePendulum, HardDuffing, Kepler, ParametricPendulum, Pendulum};

/// The entries of `composition_…` of one system.
fn references<const N: usize, S: Stepping<N> + Copy>(name: &str, system: S) {
    let file = file("discrete_multi.json");
    let of = &file[name];
    for (key, scheme) in [("composition_TJ4", Scheme::TRIPLE_JUMP_4), ("composition_KL6", Scheme::KAHAN_LI_6)] {
        let start = State::at(&system, 0.0, vector::<N>(&of["q0"]), vector::<N>(&of["v0"]));
        let list = steps(&of[key]);
        let h = number(&list[0].1["H"]);
        let mut run = Composition::new(system, scheme, start, h).expect("a valid start");
        let (mut taken, mut worst) = (0, 0.0_f64);
        for (step, entry) in list {
            while taken < step {
                run.step().unwrap_or_else(|error| panic!("{name}: {error}"));
                taken += 1;
            }
            let (q, p) = (vector::<N>(&entry["q"]), vector::<N>(&entry["p"]));
            let state = run.state();
            worst = (0..N).fold(worst, |worst, i| worst.max((state.q[i] - q[i]).abs()).max((state.p[i] - p[i]).abs()));
        }
        println!("{name}, {}: {taken} steps, off by {worst:.1e}", scheme.name);
        assert!(taken >= 100 && worst <= 5e-14, "{name}, {}: off by {worst:e}", scheme.name);
    }
}

#[test]
fn the_references_are_followed() {
    references::<1, _>("duffing_hard", HardDuffing::default());
    references::<1, _>("pendulum", Pendulum::default());
    references::<2, _>("kepler", Kepler::default());
    references::<2, _>("double_pendulum", DoublePendulum::default());
}

/// The slope of the error at `span` over a ladder of steps, points at the rounding plateau dropped.
fn order<const N: usize, S: Stepping<N> + Copy>(system: S, scheme: Scheme, q: [f64; N], v: [f64; N], counts: [u32; 4]) {
    let span = 2.0;
    let exact = Motion::new(0.0, q, v).at(&system, span);
    let error = |count: u32| {
        let start = State::at(&system, 0.0, q, v);
        let run = Composition::new(system, scheme, start, span / f64::from(count)).expect("a valid start");
        let last = run.take(count as usize).last().expect("a step").unwrap_or_else(|error| panic!("{error}"));
        (last.q - exact.q).amax()
    };
    let points: Vec<(f64, f64)> = counts.iter().map(|count| (span / f64::from(*count), error(*count))).collect();
    let slope = slope(&format!("{} of {}", scheme.name, S::NAME), &points, 1e-12);
    // Measured: off by 0.066 at most.
    assert!((slope - f64::from(scheme.order)).abs() <= 0.1, "{} of {}: order {slope}", scheme.name, S::NAME);
}

#[test]
fn the_orders_are_reached() {
    let duffing = HardDuffing { alpha: 1.2, beta: 0.7, c: 0.2, amplitude: 0.5, omega: 1.3 };
    let parametric = ParametricPendulum { epsilon: 0.4, omega: 1.7 };
    let double = DoublePendulum { m1: 1.2, m2: 0.7, l1: 1.1, l2: 0.8, g: 2.0 };
    for (scheme, counts) in [
        (Scheme::TRIPLE_JUMP_4, [40, 60, 90, 135]),
        (Scheme::SUZUKI_4, [20, 30, 45, 68]),
        (Scheme::KAHAN_LI_6, [12, 17, 24, 34]),
        (Scheme::KAHAN_LI_8, [6, 8, 10, 13]),
    ] {
        order(duffing, scheme, [1.0], [0.3], counts);
        order(parametric, scheme, [0.9], [0.4], counts);
        // At order 8 its errors come out of the first terms only where rounding begins.
        if scheme.order < 8 {
            order(double, scheme, [0.5, -0.3], [0.2, 0.4], counts);
        }
    }
}

/// The speed that is left after 60 whole steps of `a = −c v`, started with speed 1.
fn speed(scheme: Scheme, ch: f64) -> Result<f64, StepError> {
    let system = DampedOscillator { m: 1.0, k: 0.0, c: ch };
    let start = State::at(&system, 0.0, [0.0], [1.0]);
    let last = Composition::new(system, scheme, start, 1.0)?.take(60).last().unwrap_or(Ok(start))?;
    Ok(last.p[0].abs())
}

#[test]
fn negative_substeps_feed_on_damping() {
    // Each substep multiplies the speed by (1 − γ c h/2)/(1 + γ c h/2): above the bound up to the pole at c h = 2/|γ|, and
    // for some way beyond. Kahan and Li's of order 8 is unstable from 3.2993 on, close to its pole at 3.3030.
    for (scheme, lower, upper) in [
        (Scheme::TRIPLE_JUMP_4, 1.11, 1.15),
        (Scheme::SUZUKI_4, 3.00, 3.04),
        (Scheme::KAHAN_LI_6, 2.71, 2.75),
        (Scheme::KAHAN_LI_8, 3.29, 3.302),
    ] {
        let (below, above) = (speed(scheme, lower).expect("steps"), speed(scheme, upper).expect("steps"));
        println!("{}: {below:.1e} at c h = {lower}, {above:.1e} at {upper}", scheme.name);
        assert!(below < 1.0 && above > 1.0, "{}: {below:e}, {above:e}", scheme.name);
    }
}

#[test]
fn a_failing_substep_leaves_the_state_before_the_whole_step() {
    // Through the centre: Kepler's momentum equation has no solution there.
    let system = Kepler::default();
    let start = State::at(&system, 0.0, [1e-3, 0.0], [0.0, 0.1]);
    let mut run = Composition::new(system, Scheme::SUZUKI_4, start, 0.5).expect("a valid start");
    let error = run.step().expect_err("no solution");
    assert_eq!(run.state(), start);
    assert_eq!(run.step(), Err(error));
}
