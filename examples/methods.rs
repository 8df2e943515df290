//! The time of a step of each method, divided by that of a fixed step of the same system.
//!
//! In: nothing. Out: a table, of which README.md has the ranges. `cargo run --release --example methods`

use std::hint::black_box;
use std::time::Instant;
use vi_core::motion::Motion;
use vi_core::stepping::{Convertible, EnergyStepping};
use vi_core::{
    EnergyPreserving, EnergyPreservingGauss, FixedStep, Gauss, Lagrangian, Method, Run, Splitting, Starts, State,
    StepError,
};
use vi_systems::{DoublePendulum, DoubleWell, FpuChain, Kepler};

/// Rounds in which all methods take turns; the shortest time counts.
const ROUNDS: usize = 15;

/// Steps of a round.
const STEPS: u32 = 4000;

/// Forces of a step of Blanes and Moan's splitting of order 6.
const FORCES: f64 = 14.0;

/// The seconds of one step, in a local variable, where a run is fastest.
fn seconds<M, S, const N: usize>(run: &Run<M, S, N>) -> Result<f64, StepError>
where
    M: Method<S, N>,
    S: Lagrangian<N> + Copy,
    Run<M, S, N>: Clone,
{
    let mut run = run.clone();
    let clock = Instant::now();
    for _ in 0..STEPS {
        run.step()?;
    }
    black_box(run.state().t);
    Ok(clock.elapsed().as_secs_f64() / f64::from(STEPS))
}

/// The shortest time of each run.
fn shortest<const K: usize>(mut round: impl FnMut() -> Result<[f64; K], StepError>) -> Result<[f64; K], StepError> {
    let mut least = [f64::INFINITY; K];
    for _ in 0..ROUNDS {
        for (least, seconds) in least.iter_mut().zip(round()?) {
            *least = least.min(seconds);
        }
    }
    Ok(least)
}

/// A line of the table: a fixed step in ns, and the others divided by it.
fn print(system: &str, [fixed, others @ ..]: [f64; 6]) {
    print!("{system:16} {:8.1} ns", 1e9 * fixed);
    for other in others {
        print!(" {:8.1}", other / fixed);
    }
    println!();
}

/// Times a system from a start with steps of h, and Gauss steps of `long`.
fn times<S, const N: usize>(system: S, (q, v): ([f64; N], [f64; N]), [h, long]: [f64; 2]) -> Result<(), StepError>
where
    S: EnergyStepping<N> + Motion<N> + Convertible<N>,
{
    let start = black_box(State::at(&system, 0.0, q, v));
    let start = || system.at_state(start);
    let fixed = start().integrate(FixedStep, h)?;
    let gauss = (start().integrate(Gauss::<4>, long)?, start().integrate(Gauss::<8>, long)?);
    let energy = EnergyPreserving::from_midpoint(system, 0.0, q, v, h)?;
    let first = start().integrate(EnergyPreservingGauss::<1>, h)?;
    let second = start().integrate(EnergyPreservingGauss::<2>, 5.0 * h)?;
    let least = shortest(|| {
        Ok([
            seconds(&fixed)?,
            seconds(&gauss.0)?,
            seconds(&gauss.1)?,
            seconds(&energy)?,
            seconds(&first)?,
            seconds(&second)?,
        ])
    })?;
    print(S::NAME, least);
    Ok(())
}

fn main() -> Result<(), StepError> {
    println!(
        "{:16} {:>11} {:>8} {:>8} {:>8} {:>8} {:>8}",
        "system", "fixed step", "Gauss 4", "Gauss 8", "energy", "stages 1", "stages 2"
    );
    times(DoubleWell::default(), ([0.74], [0.0]), [0.01, 0.1])?;
    times(Kepler::default(), ([0.8, 0.0], [0.0, 1.2]), [0.01, 0.1])?;
    times(DoublePendulum::default(), ([0.3, 0.2], [0.0, 0.1]), [0.01, 0.05])?;
    let kepler = Kepler::default();
    let start = kepler.at(0.0, [0.8, 0.0], [0.0, 1.2]);
    let fixed = start.integrate(FixedStep, 0.01)?;
    let four = start.integrate(Gauss::<4>.in_transformed_time(), 0.1)?;
    let eight = start.integrate(Gauss::<8>.in_transformed_time(), 0.3)?;
    let split = start.integrate(Splitting::BLANES_MOAN_6, 0.1)?;
    let [fixed, four, eight, split] =
        shortest(|| Ok([seconds(&fixed)?, seconds(&four)?, seconds(&eight)?, seconds(&split)?]))?;
    println!("Kepler, transformed time: 4 stages {:.1}, 8 stages {:.1}", four / fixed, eight / fixed);
    println!("Kepler, one force of a splitting: {:.2}", split / FORCES / fixed);
    let chain = FpuChain::default();
    let mode = core::array::from_fn(|i| [0.184, 0.361, 0.526, 0.674, 0.798, 0.895, 0.962, 0.996][i.min(15 - i)]);
    let start = chain.at(0.0, mode, [0.0; 16]);
    let (fixed, split) = (start.integrate(FixedStep, 0.1)?, start.integrate(Splitting::BLANES_MOAN_6, 0.1)?);
    let [fixed, split] = shortest(|| Ok([seconds(&fixed)?, seconds(&split)?]))?;
    println!("Chain of 16, one force of a splitting: {:.2}", split / FORCES / fixed);
    Ok(())
}
