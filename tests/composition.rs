//! Compositions: against 50-digit references, their order by slope, and their instability for damping with negative
//! substeps.

use crate::support::exact::Trajectory;
use crate::support::reference::{file, number, steps, vector};
use crate::support::slope;
use vi_core::stepping::FixedStepping;
use vi_core::{Composition, Starts, State, StepError};
use vi_systems::{DampedOscillator, DoublePendulum, HardDuffing, Kepler, ParametricPendulum, Pendulum};

/// The entries of `composition_…` of one system.
fn references<const N: usize, S: FixedStepping<N> + Copy>(name: &str, system: S) {
    let file = file("discrete_multi.json");
    let of = &file[name];
    for (key, scheme) in [("composition_TJ4", Composition::TRIPLE_JUMP_4), ("composition_KL6", Composition::KAHAN_LI_6)]
    {
        let start = State::at(&system, 0.0, vector::<N>(&of["q0"]), vector::<N>(&of["v0"]));
        let list = steps(&of[key]);
        let h = number(&list[0].1["H"]);
        let mut run = system.at_state(start).integrate(scheme, h).expect("a valid start");
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

/// The slope of the error over a ladder of steps, `count` of them between each two of four equally spaced times. The
/// maximum over the four times is used, since at a single time the leading term may be about to change sign.
fn order<const N: usize, S: FixedStepping<N> + Copy>(
    system: S,
    scheme: Composition,
    motion: &[Trajectory<N>],
    counts: [u32; 4],
) {
    let (start, ends) = motion.split_first().expect("a start");
    let error = |h: f64, count: u32| {
        let state = State::at(&system, start.t, start.q, start.v);
        let mut run = system.at_state(state).integrate(scheme, h).expect("a valid start");
        let squares = ends.iter().map(|exact| {
            for _ in 0..count {
                run.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
            }
            (run.state().q - exact.q).norm_squared()
        });
        squares.sum::<f64>().sqrt()
    };
    let points = counts.map(|count| {
        let h = (ends[0].t - start.t) / f64::from(count);
        (h, error(h, count))
    });
    // Measured with shorter steps: 1.1e-14 remains as rounding, including that of the accurate motion.
    let slope = slope(&format!("{} of {}", scheme.name, S::NAME), &points, 5e-13);
    assert!((slope - f64::from(scheme.order)).abs() <= 0.05, "{} of {}: order {slope}", scheme.name, S::NAME);
}

/// An accurate motion at five equally spaced times.
fn motion<const N: usize, S: FixedStepping<N>>(system: &S, q: [f64; N], v: [f64; N], apart: f64) -> [Trajectory<N>; 5] {
    let start = Trajectory::new(0.0, q, v);
    [0.0, 1.0, 2.0, 3.0, 4.0].map(|part| start.at(system, part * apart))
}

#[test]
fn the_orders_are_reached() {
    // Forced, time-dependent, not separable. The steps are short enough for the leading term and long enough to exceed
    // rounding. The links of the pendulum start parallel: for bent links the errors of order 8 begin at rounding.
    let duffing = HardDuffing { alpha: 1.2, beta: 0.7, c: 0.2, amplitude: 0.5, omega: 1.3 };
    let parametric = ParametricPendulum { epsilon: 0.4, omega: 1.7 };
    let double = DoublePendulum { m1: 1.2, m2: 0.7, l1: 1.1, l2: 0.8, g: 2.0 };
    let (forced, driven) = (motion(&duffing, [1.0], [0.3], 2.0), motion(&parametric, [0.9], [0.4], 2.0));
    let coupled = motion(&double, [0.5, 0.6], [0.2, 0.4], 1.0);
    // Measured:            forced    driven    coupled
    //     triple jump 4    3.9990    4.0002    3.9986
    //     Suzuki 4         3.9995    4.0007    3.9993
    //     Kahan–Li 6       5.9927    5.9997    5.9915
    //     Kahan–Li 8       7.9637    7.9963    7.9786
    for (scheme, of_forced, of_driven, of_coupled) in [
        (Composition::TRIPLE_JUMP_4, [80, 160, 320, 640], [80, 160, 320, 640], [40, 80, 160, 320]),
        (Composition::SUZUKI_4, [40, 80, 160, 320], [40, 80, 160, 320], [20, 40, 80, 160]),
        (Composition::KAHAN_LI_6, [24, 34, 48, 68], [20, 28, 40, 56], [12, 17, 24, 34]),
        (Composition::KAHAN_LI_8, [12, 15, 18, 22], [7, 8, 10, 12], [7, 9, 11, 13]),
    ] {
        order(duffing, scheme, &forced, of_forced);
        order(parametric, scheme, &driven, of_driven);
        order(double, scheme, &coupled, of_coupled);
    }
}

/// The speed after 60 steps of `a = −c v`, from speed 1.
fn speed(scheme: Composition, ch: f64) -> Result<f64, StepError> {
    let system = DampedOscillator { m: 1.0, k: 0.0, c: ch };
    let start = State::at(&system, 0.0, [0.0], [1.0]);
    let last = system.at_state(start).integrate(scheme, 1.0)?.take(60).last().unwrap_or(Ok(start))?;
    Ok(last.p[0].abs())
}

#[test]
fn negative_substeps_feed_on_damping() {
    // Each substep multiplies the speed by (1 − γ c h/2)/(1 + γ c h/2): above the bound up to the pole at c h = 2/|γ|
    // and somewhat beyond. Kahan and Li's composition of order 8 is unstable from 3.2993 on, close to its pole at
    // 3.3030.
    for (scheme, lower, upper) in [
        (Composition::TRIPLE_JUMP_4, 1.11, 1.15),
        (Composition::SUZUKI_4, 3.00, 3.04),
        (Composition::KAHAN_LI_6, 2.71, 2.75),
        (Composition::KAHAN_LI_8, 3.29, 3.302),
    ] {
        let (below, above) = (speed(scheme, lower).expect("steps"), speed(scheme, upper).expect("steps"));
        println!("{}: {below:.1e} at c h = {lower}, {above:.1e} at {upper}", scheme.name);
        assert!(below < 1.0 && above > 1.0, "{}: {below:e}, {above:e}", scheme.name);
    }
}

#[test]
fn a_failing_substep_leaves_the_state_before_the_whole_step() {
    // Through the centre the momentum equation of Kepler's problem has no solution.
    let system = Kepler::default();
    let start = State::at(&system, 0.0, [1e-3, 0.0], [0.0, 0.1]);
    let mut run = system.at_state(start).integrate(Composition::SUZUKI_4, 0.5).expect("a valid start");
    let error = run.step().expect_err("no solution");
    assert_eq!(run.state(), start);
    assert_eq!(run.step(), Err(error));
}
