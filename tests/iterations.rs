//! The iterations of a step, and that it is the forward solution, in runs of every system.

use crate::support::scenes::{Scene, each_system};
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, FixedStep, Starts, State};

const STEPS: u32 = if cfg!(feature = "long") { 100_000 } else { 10_000 };

/// Maximum mean Newton iterations per step.
const LIMIT: f64 = 2.8;

/// Over the time in which steps exist. Measured: 1.01 (harmonic oscillator) to 2.55 (hard Duffing oscillator).
fn energy_preserving<const N: usize, S: EnergyStepping<N> + Copy>(scene: Scene<S, N>) {
    let mut run = EnergyPreserving::from_midpoint(scene.system, 0.0, scene.q, scene.v, scene.h).expect("a valid start");
    let (sign, mut middle) = (run.density().signum(), 0.0);
    let (mut steps, mut iterations) = (0, 0);
    while steps < STEPS && run.state().t < scene.span {
        let before = run.state();
        let step = run.detailed_step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        (steps, iterations) = (steps + 1, iterations + step.iterations);
        // The spurious root returns to the midpoint of the last interval; beyond a sign change of D there is another
        // one.
        assert!(step.h > 0.0 && step.t > before.t && step.midpoint.0 > middle, "{}: {step:?}", S::NAME);
        assert!(step.density * sign > 0.0, "{}: {step:?}", S::NAME);
        middle = step.midpoint.0;
    }
    let mean = f64::from(iterations) / f64::from(steps);
    println!("{}: {mean:.2} iterations over {steps} steps to t = {:.0}", S::NAME, run.state().t);
    assert!(mean <= LIMIT && mean > 0.5, "{}: {mean}", S::NAME);
}

/// Measured: none (linear systems), 1.00 (Hénon–Heiles) to 2.34 (spherical pendulum).
fn fixed<const N: usize, S: EnergyStepping<N> + Copy>(scene: Scene<S, N>) {
    let start = State::at(&scene.system, 0.0, scene.q, scene.v);
    let mut run = scene.system.at_state(start).integrate(FixedStep, scene.h).expect("a valid start");
    let mut iterations = 0;
    for _ in 0..STEPS {
        run.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        iterations += run.iterations();
    }
    let mean = f64::from(iterations) / f64::from(STEPS);
    println!("{}: {mean:.2} iterations over {STEPS} fixed steps", S::NAME);
    // Nearly none if the step is one matrix; one if A is constant.
    assert!(mean <= LIMIT && (mean > 0.5 || S::CLOSED_FORM && mean < 1e-3), "{}: {mean}", S::NAME);
    assert!(!S::CONSTANT_JACOBIAN || mean < 1.001, "{}: {mean}", S::NAME);
}

mod of_fixed_steps {
    super::each_system!(super::fixed);
}

mod of_energy_preserving_steps {
    super::each_system!(super::energy_preserving);
}
