//! An ensemble against each of its trajectories alone.

use std::collections::BTreeSet;
use vi_core::{Batch, FixedStep, State, StepError, lagrangian};
use vi_ensemble::{Ended, Ensemble};
use vi_systems::{DoublePendulum, DoubleWell, FpuChain, HarmonicOscillator, Kepler, ParametricPendulum, Pendulum};

type Start<S, const N: usize> = (S, State<N>);
type Outcome<const N: usize> = Result<State<N>, Ended<N>>;

fn outcomes<S: Batch<N>, const N: usize>(
    starts: &[Start<S, N>],
    h: f64,
    steps: u64,
) -> Result<Vec<Outcome<N>>, StepError> {
    let (systems, states) = starts.iter().copied().unzip();
    let mut ensemble = Ensemble::new(systems, states, h)?;
    ensemble.run(steps);
    Ok(ensemble.results().collect())
}

/// Largest difference of coordinates and momenta after `steps` steps, over all trajectories.
fn difference<S: Batch<N>, const N: usize>(starts: &[Start<S, N>], h: f64, steps: u32) -> Result<f64, StepError> {
    let mut worst = 0.0_f64;
    for (&(system, start), outcome) in starts.iter().zip(outcomes(starts, h, u64::from(steps))?) {
        let mut alone = FixedStep::new(system, start, h)?;
        for _ in 0..steps {
            alone.step()?;
        }
        let (together, alone) = (outcome.map_err(|ended| ended.error)?, alone.state());
        assert!((together.t - alone.t).abs() <= 1e-12 * alone.t.abs().max(1.0));
        worst = worst.max((together.q - alone.q).amax()).max((together.p - alone.p).amax());
    }
    assert!(worst > 0.0 && worst.is_finite(), "two ways of the same bits are one way");
    Ok(worst)
}

/// `count` numbers from `from` to `to`, both included.
fn spread(count: u32, from: f64, to: f64) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| from + (to - from) * f64::from(i) / f64::from(count - 1))
}

fn wells(count: u32) -> Vec<Start<DoubleWell, 1>> {
    let well = |m| DoubleWell { m };
    spread(count, 0.5, 2.0).map(|m| (well(m), State::at(&well(m), 0.0, [0.1 + 0.4 * m], [0.0]))).collect()
}

fn pendulums(count: u32) -> Vec<Start<DoublePendulum, 2>> {
    let system = |l2| DoublePendulum { l2, ..DoublePendulum::default() };
    spread(count, 0.5, 1.5).map(|l| (system(l), State::at(&system(l), 0.0, [0.3, 0.2 * l], [0.0, 0.0]))).collect()
}

#[test]
fn every_trajectory_is_that_of_the_fixed_step() -> Result<(), StepError> {
    let orbits: Vec<_> = spread(70, 0.3, 1.0)
        .map(|x| (Kepler::default(), State::at(&Kepler::default(), 0.0, [x, 0.0], [0.0, (2.0 / x - 1.0).sqrt()])))
        .collect();
    let chains: Vec<_> = spread(3, 0.2, 1.0)
        .map(|x| {
            let chain = FpuChain::default();
            (chain, State::at(&chain, 0.0, core::array::from_fn(|k| if k == 0 { x } else { 0.0 }), [0.0; 16]))
        })
        .collect();
    let driven = ParametricPendulum::default();
    let driven: Vec<_> = spread(5, 0.1, 0.5).map(|q| (driven, State::at(&driven, 0.25, [q], [0.0]))).collect();
    let linear = HarmonicOscillator::default();
    let linear: Vec<_> = spread(5, 0.1, 0.5).map(|q| (linear, State::at(&linear, 0.0, [q], [0.0]))).collect();
    // Measured: at most 3.4e-15, Kepler's.
    for (name, difference) in [
        ("double well", difference(&wells(130), 0.01, 1000)?),
        ("Kepler", difference(&orbits, 0.01, 1000)?),
        ("double pendulum", difference(&pendulums(65), 0.01, 1000)?),
        ("chain", difference(&chains, 0.1, 1000)?),
        ("parametric pendulum", difference(&driven, 0.01, 1000)?),
        ("harmonic oscillator", difference(&linear, 0.01, 1000)?),
    ] {
        assert!(difference < 4e-15, "{name}: {difference:e}");
    }
    Ok(())
}

#[test]
fn neighbours_and_threads_change_no_bit() -> Result<(), Box<dyn std::error::Error>> {
    let starts = pendulums(200);
    let all = outcomes(&starts, 0.02, 500)?;
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    assert_eq!(one_thread.install(|| outcomes(&starts, 0.02, 500))?, all);
    for (start, outcome) in starts.iter().zip(&all).step_by(17) {
        assert_eq!(outcomes(&[*start], 0.02, 500)?, [*outcome]);
    }
    let (systems, states) = starts.iter().copied().unzip();
    let mut parts = Ensemble::new(systems, states, 0.02)?;
    let mut seen = Vec::new();
    parts.run_observed(500, 200, |ensemble| seen.push(ensemble.steps()));
    assert_eq!(seen, [200, 400, 500]);
    assert_eq!(parts.results().collect::<Vec<_>>(), all);
    Ok(())
}

#[test]
fn a_trajectory_that_ends_ends_alone() -> Result<(), StepError> {
    let kepler = Kepler::default();
    let circle = State::at(&kepler, 0.0, [1.0, 0.0], [0.0, 1.0]);
    // At the sun, and where there is no number.
    let bad = [State::at(&kepler, 0.0, [0.0, 0.0], [0.0, 0.0]), State { q: [f64::NAN, 0.0].into(), ..circle }];
    let starts: Vec<_> = (0..100).map(|i| (kepler, if i % 10 == 3 { bad[i / 10 % 2] } else { circle })).collect();
    let good = outcomes(&[(kepler, circle)], 0.01, 300)?;
    let all = outcomes(&starts, 0.01, 300)?;
    assert_eq!(all.len(), 100);
    for (i, outcome) in all.iter().enumerate() {
        match outcome {
            Ok(_) => assert!(i % 10 != 3 && good.contains(outcome)),
            Err(ended) => {
                assert!(i % 10 == 3 && ended.steps == 0, "{ended}");
                assert!(matches!(ended.error, StepError::NonFinite { .. }), "{ended}");
            }
        }
    }
    Ok(())
}

lagrangian! {
    /// Pushed to where the potential ends: beyond x = 1 there is no number.
    pub struct Cliff {
        param a = 1.0;
        coord x;
        L = dot(x)^2 / 2 + a * x - sqrt(1 - x) / 10;
        discretize midpoint;
    }
}

#[test]
fn a_run_ends_where_the_fixed_step_does() -> Result<(), StepError> {
    let cliff = |a| Cliff { a };
    let starts: Vec<_> = spread(80, -0.2, 2.0).map(|a| (cliff(a), State::at(&cliff(a), 0.0, [0.0], [0.0]))).collect();
    let all = outcomes(&starts, 0.01, 200)?;
    let mut worst = 0.0_f64;
    for (&(system, start), outcome) in starts.iter().zip(&all) {
        let mut alone = FixedStep::new(system, start, 0.01)?;
        let failure = (0..200_u64).find_map(|step| alone.step().err().map(|error| (step, error)));
        let apart = match outcome {
            Ok(state) => {
                assert_eq!(failure, None);
                state.q - alone.state().q
            }
            Err(ended) => {
                assert_eq!(failure.map(|(step, _)| step), Some(ended.steps));
                assert!(matches!(ended.error, StepError::NonFinite { .. } | StepError::NotConverged { .. }), "{ended}");
                ended.state.q - alone.state().q
            }
        };
        worst = worst.max(apart.amax());
    }
    // Measured: 5.6e-12, in the last steps before the edge, where the slope of the root grows without bound.
    assert!(worst < 6e-12, "{worst:e}");
    let steps: BTreeSet<u64> = all.iter().filter_map(|outcome| outcome.err()).map(|ended| ended.steps).collect();
    assert!(steps.len() > 20 && all.iter().any(Result::is_ok), "{steps:?}");
    Ok(())
}

#[test]
fn angles_of_many_turns_are_taken_alone() -> Result<(), StepError> {
    let pendulum = Pendulum::default();
    let starts: Vec<_> = spread(3, 2e5, 3e5).map(|q| (pendulum, State::at(&pendulum, 0.0, [q], [1.0]))).collect();
    let difference = difference(&starts, 0.01, 100)?;
    // Measured: 3.8e-13, of angles with an ulp of 3e-11.
    assert!(difference < 4e-13, "{difference:e}");
    Ok(())
}

#[test]
fn what_cannot_be_run_is_refused() {
    let well = DoubleWell::default();
    let start = State::at(&well, 0.0, [0.7], [0.0]);
    for (systems, states, h) in [(1, 1, 0.0), (1, 1, f64::NAN), (1, 2, 0.1), (2, 1, 0.1)] {
        let refused = Ensemble::new(vec![well; systems], vec![start; states], h);
        assert!(matches!(refused, Err(StepError::InvalidInput { .. })));
    }
    let empty = Ensemble::<DoubleWell, 1>::new(Vec::new(), Vec::new(), 0.1);
    assert!(empty.is_ok_and(|mut empty| {
        empty.run(3);
        empty.results().next().is_none() && empty.running() == 0
    }));
}
