//! The outer solar system over a million days, as `rebound_runs.py` runs it in REBOUND: microseconds and error.
//!
//! The reference is Gauss's method of 12 stages with h = 200.

use std::time::Instant;
use vi_core::run::Start;
use vi_core::{Gauss, Method, SVector, Splitting, Starts, State, StepError};
use vi_systems::OuterSolarSystem;

const END: f64 = 1e6;
const REPETITIONS: u32 = 7;

fn start() -> Start<OuterSolarSystem, 18> {
    OuterSolarSystem::default().at(0.0, OuterSolarSystem::POSITIONS, OuterSolarSystem::VELOCITIES)
}

/// The state at the end, and the largest coordinate and momentum on the way.
fn end<M: Method<OuterSolarSystem, 18>>(method: M, h: f64) -> Result<(State<18>, [f64; 2]), StepError> {
    let mut run = start().integrate(method, h)?;
    let mut largest = [0.0_f64; 2];
    while run.t() < END - 0.5 * h {
        let State { q, p, .. } = run.step()?;
        largest = [largest[0].max(q.amax()), largest[1].max(p.amax())];
    }
    Ok((run.state(), largest))
}

fn show<M: Method<OuterSolarSystem, 18>>(
    name: &str,
    method: M,
    h: f64,
    (exact, largest): &(State<18>, [f64; 2]),
) -> Result<(), StepError> {
    let mut seconds = f64::INFINITY;
    let mut state = exact.to_owned();
    for _ in 0..REPETITIONS {
        let mut run = start().integrate(method.clone(), h)?;
        let begin = Instant::now();
        state = run.until(END)?;
        seconds = seconds.min(begin.elapsed().as_secs_f64());
    }
    let off = |one: SVector<f64, 18>, other: SVector<f64, 18>| (one - other).amax();
    let error = (off(state.q, exact.q) / largest[0]).max(off(state.p, exact.p) / largest[1]);
    println!("{name:24} h = {h:5} {:8.0} µs  {error:.1e}", seconds * 1e6);
    Ok(())
}

fn main() -> Result<(), StepError> {
    let exact = end(Gauss::<12>, 200.0)?;
    for h in [1250.0, 1000.0, 800.0, 625.0, 500.0] {
        show("Gauss, 8 stages", Gauss::<8>, h, &exact)?;
    }
    for h in [625.0, 500.0, 400.0, 250.0] {
        show("Gauss, 4 stages", Gauss::<4>, h, &exact)?;
    }
    for h in [800.0, 500.0, 400.0, 250.0, 125.0] {
        show("splitting, order 6", Splitting::BLANES_MOAN_6, h, &exact)?;
    }
    Ok(())
}
