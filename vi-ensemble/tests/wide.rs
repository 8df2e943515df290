//! Gauss steps by the widest vectors of the processor, against the same steps in plain numbers.
//!
//! A type-erased system ([`Called`]) is solved in plain numbers, the system itself by the copy of the loop for the vectors that the processor has.
//! Builds with debug assertions have no copy for AVX-512: `.ci/run vectors` runs these tests in release.

use vi_core::motion::Motion;
use vi_core::stepping::Convertible;
use vi_core::{Called, Gauss, Starts as _, State, StepError};
use vi_dispatch::Instructions;
use vi_systems::{DoublePendulum, FpuChain, NPendulum};

/// The states of a run after each step.
fn states<S, const N: usize, const STAGES: usize>(
    system: S,
    (q, v): ([f64; N], [f64; N]),
    h: f64,
    steps: usize,
) -> Result<Vec<State<N>>, StepError>
where
    S: Motion<N> + Convertible<N> + Copy,
{
    let mut run = system.at(0.0, q, v).integrate(Gauss::<STAGES>, h)?;
    (0..steps).map(|_| run.step()).collect()
}

/// The largest difference of a coordinate or a momentum, over the largest of either kind.
fn difference<S, const N: usize, const STAGES: usize>(
    start: ([f64; N], [f64; N]),
    h: f64,
    steps: usize,
) -> Result<f64, StepError>
where
    S: Motion<N> + Convertible<N> + Copy + Default,
{
    let wide = states::<_, N, STAGES>(S::default(), start, h, steps)?;
    let plain = states::<_, N, STAGES>(Called(S::default()), start, h, steps)?;
    let size = |of: fn(&State<N>) -> f64| plain.iter().map(of).fold(0.0, f64::max);
    let (q, p) = (size(|state| state.q.amax()), size(|state| state.p.amax()));
    let apart = |(a, b): (&State<N>, &State<N>)| ((a.q - b.q).amax() / q).max((a.p - b.p).amax() / p);
    let worst = wide.iter().zip(&plain).map(apart).fold(0.0, f64::max);
    println!("{}, {:?}: {worst:.1e}", S::NAME, Instructions::detected());
    Ok(worst)
}

/// The lowest mode of the chain.
fn mode(amplitude: f64) -> ([f64; 16], [f64; 16]) {
    let part = |i: u32| f64::from(i + 1) * core::f64::consts::PI / 17.0;
    (core::array::from_fn(|i| amplitude * part(u32::try_from(i).expect("16 masses")).sin()), [0.0; 16])
}

#[test]
fn long_equations_are_solved_alike() -> Result<(), StepError> {
    let hanging = ([0.6, 0.4, 0.2, 0.1], [0.0; 4]);
    assert!(difference::<NPendulum, 4, 8>(hanging, 0.05, 40)? < 1e-13);
    assert!(difference::<NPendulum, 4, 3>(hanging, 0.02, 40)? < 1e-13);
    assert!(difference::<FpuChain, 16, 8>(mode(1.0), 0.8, 40)? < 1e-13);
    Ok(())
}

#[test]
fn short_equations_are_solved_alike() -> Result<(), StepError> {
    assert!(difference::<DoublePendulum, 2, 8>(([1.0, 1.0], [0.0; 2]), 0.05, 40)? < 1e-13);
    Ok(())
}

#[test]
fn stiff_steps_are_solved_alike() -> Result<(), StepError> {
    assert!(difference::<NPendulum, 4, 8>(([0.06, 0.04, 0.02, 0.01], [0.0; 4]), 0.8, 20)? < 1e-12);
    Ok(())
}
