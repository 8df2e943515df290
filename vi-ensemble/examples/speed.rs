//! Nanoseconds per trajectory and step on one core, next to [`FixedStep`]: the minimum of interleaved rounds.

use std::hint::black_box;
use std::time::Instant;
use vi_core::stepping::Batch;
use vi_core::{FixedStep, Starts, State, StepError};
use vi_ensemble::Ensemble;
use vi_systems::{DoublePendulum, DoubleWell, Kepler};

const ROUNDS: usize = 9;
const STEPS: u32 = 20_000;
const TRAJECTORIES: u32 = 64;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    pool.install(|| -> Result<(), StepError> {
        compare("double well", DoubleWell::default(), [0.74], [0.0])?;
        compare("Kepler, e = 0.6", Kepler::default(), [0.4, 0.0], [0.0, 2.0])?;
        compare("double pendulum", DoublePendulum::default(), [1.0, 1.0], [0.0, 0.0])
    })?;
    Ok(())
}

fn compare<S: Batch<N>, const N: usize>(name: &str, system: S, q: [f64; N], v: [f64; N]) -> Result<(), StepError> {
    let count = TRAJECTORIES as usize;
    // Spreads the initial states, so that the trajectories differ.
    let start =
        |i: u32| State::at(&system, 0.0, q.map(|q| q * (1.0 - 0.2 * f64::from(i) / f64::from(TRAJECTORIES))), v);
    let mut ensemble = Ensemble::new(vec![system; count], (0..TRAJECTORIES).map(start).collect(), 0.01)?;
    let mut alone = system.at_state(start(0)).integrate(FixedStep, 0.01)?;
    let (mut together, mut single) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        let begun = Instant::now();
        ensemble.run(u64::from(STEPS));
        together = together.min(begun.elapsed().as_secs_f64() * 1e9 / f64::from(STEPS) / f64::from(TRAJECTORIES));
        let begun = Instant::now();
        for _ in 0..STEPS {
            black_box(alone.step()?);
        }
        single = single.min(begun.elapsed().as_secs_f64() * 1e9 / f64::from(STEPS));
    }
    black_box(ensemble.running());
    println!("{name}: {together:.2} ns, alone {single:.1} ns, ratio {:.1}", single / together);
    Ok(())
}
