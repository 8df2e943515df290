//! Number of stages: error against time of Gauss steps, Kepler's problem, e = 0.6, three periods.
//!
//! In: nothing. Out: for each number of stages the shortest time of a run within each error, and its steps. `cargo run --release --example gauss`

use std::f64::consts::TAU;
use std::time::Instant;
use vi_core::{Gauss, Starts, State, StepError};
use vi_systems::Kepler;

/// Runs of each kind, of which the fastest counts.
const RUNS: u32 = 9;

/// Numbers of steps that are tried.
const STEPS: [u32; 24] =
    [24, 28, 32, 36, 42, 48, 56, 64, 72, 84, 96, 110, 128, 148, 170, 196, 226, 260, 300, 340, 450, 600, 800, 1060];

/// Errors for which times are shown.
const ERRORS: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

/// One run: seconds, relative error of the position, steps.
struct Timing {
    seconds: f64,
    error: f64,
    steps: u32,
}

/// Runs of S stages, from few steps to many.
fn runs<const S: usize>() -> Result<Vec<Timing>, StepError> {
    let planet = Kepler::default();
    let start = State::at(&planet, 0.0, [0.4, 0.0], [0.0, 2.0]);
    let mut runs = Vec::new();
    for steps in STEPS {
        let mut seconds = f64::INFINITY;
        let mut end = Ok(start);
        for _ in 0..RUNS {
            let clock = Instant::now();
            let mut run = planet.at_state(start).integrate(Gauss::<S>, 3.0 * TAU / f64::from(steps))?;
            end = (0..steps).try_fold(start, |_, _| run.step());
            seconds = seconds.min(clock.elapsed().as_secs_f64());
        }
        // Steps that are too long have no solution.
        let Ok(end) = end else { continue };
        // After whole periods the planet is where it began.
        runs.push(Timing { seconds, error: (end.q - start.q).norm() / start.q.norm(), steps });
    }
    Ok(runs)
}

/// A line of the fastest runs of S stages within each error.
fn print_fastest<const S: usize>() -> Result<(), StepError> {
    let runs = runs::<S>()?;
    print!("{S:2} stages");
    for error in ERRORS {
        let good = runs.iter().filter(|run| run.error <= error);
        match good.min_by(|a, b| a.seconds.total_cmp(&b.seconds)) {
            Some(Timing { seconds, steps, .. }) => print!("  {error:.0e}: {:5.1} µs, {steps:3} steps", 1e6 * seconds),
            None => print!("  {error:.0e}: none{:15}", ""),
        }
    }
    println!();
    Ok(())
}

fn main() -> Result<(), StepError> {
    print_fastest::<4>()?;
    print_fastest::<5>()?;
    print_fastest::<6>()?;
    print_fastest::<8>()?;
    print_fastest::<12>()
}
