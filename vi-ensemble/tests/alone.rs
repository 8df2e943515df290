//! An ensemble against each of its trajectories alone: with [`FixedStep`], and converged in every step.

use std::collections::BTreeSet;
use vi_core::node::Node;
use vi_core::rules::{By, Trapezoidal};
use vi_core::stepping::Batch;
use vi_core::support::step_alone;
use vi_core::{FixedStep, Gauss, Starts, State, StepError, lagrangian};
use vi_ensemble::{Ended, Ensemble, Runs};
use vi_systems::{
    ChargedParticle, DoublePendulum, DoubleWell, FpuChain, HarmonicOscillator, Kepler, NPendulum, ParametricPendulum,
    Pendulum,
};

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

/// The state after `steps` steps, each solved by Newton iteration from the last velocity without extrapolation.
fn converged<S: Batch<N>, const N: usize>(
    &(system, start): &Start<S, N>,
    h: f64,
    steps: u32,
) -> Result<State<N>, StepError> {
    let mut v = system.at_state(start).integrate(FixedStep, h)?.v();
    let mut node = Node::new(start, 0.0);
    for _ in 0..steps {
        (node, v) = step_alone(&system, &node, h, v)?;
    }
    Ok(node.state())
}

/// Largest difference of coordinates and momenta.
fn distance<const N: usize>(a: &State<N>, b: &State<N>) -> f64 {
    (a.q - b.q).amax().max((a.p - b.p).amax())
}

/// The largest differences after `steps` steps: of all trajectories from the fixed step, and of every fifth from the
/// slower converged one.
fn differences<S: Batch<N>, const N: usize>(starts: &[Start<S, N>], h: f64, steps: u32) -> Result<[f64; 2], StepError> {
    let mut worst = [0.0_f64; 2];
    for (i, (start, outcome)) in starts.iter().zip(outcomes(starts, h, u64::from(steps))?).enumerate() {
        let mut alone = start.0.at_state(start.1).integrate(FixedStep, h)?;
        for _ in 0..steps {
            alone.step()?;
        }
        let (together, alone) = (outcome.map_err(|ended| ended.error)?, alone.state());
        assert!((together.t - alone.t).abs() <= 1e-12 * alone.t.abs().max(1.0));
        worst[0] = worst[0].max(distance(&together, &alone));
        if i % 5 == 0 {
            worst[1] = worst[1].max(distance(&together, &converged(start, h, steps)?));
        }
    }
    assert!(worst.iter().all(|worst| worst.is_finite()));
    Ok(worst)
}

lagrangian! {
    /// Two wells, with two rules.
    struct Wells {
        param m = 1.0;
        coord x;
        L = m * dot(x)^2 / 2 + x^2 / 2 - x^4 / 4;
        discretize midpoint, trapezoidal;
    }
}

/// `count` numbers from `from` to `to`, inclusive.
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
    let driven = ParametricPendulum::default();
    let driven: Vec<_> = spread(5, 0.1, 0.5).map(|q| (driven, State::at(&driven, 0.25, [q], [0.0]))).collect();
    let linear = HarmonicOscillator::default();
    let linear: Vec<_> = spread(5, 0.1, 0.5).map(|q| (linear, State::at(&linear, 0.0, [q], [0.0]))).collect();
    let particle = ChargedParticle::default();
    let particles: Vec<_> =
        spread(65, 0.2, 0.6).map(|x| (particle, State::at(&particle, 0.0, [x, 0.1, -0.2], [0.1, 0.5, 0.3]))).collect();
    let verlet = |m| By::new(Wells { m }, Trapezoidal);
    let verlet: Vec<_> =
        spread(70, 0.5, 2.0).map(|m| (verlet(m), State::at(&verlet(m), 0.0, [0.1 + 0.4 * m], [0.0]))).collect();
    let mut same = true;
    for (name, [alone, converged]) in [
        ("double well", differences(&wells(130), 0.01, 1000)?),
        ("Kepler", differences(&orbits, 0.01, 1000)?),
        ("double pendulum", differences(&pendulums(65), 0.01, 1000)?),
        ("parametric pendulum", differences(&driven, 0.01, 1000)?),
        ("harmonic oscillator", differences(&linear, 0.01, 1000)?),
        ("charged particle", differences(&particles, 0.01, 1000)?),
        ("two wells by the trapezoidal rule", differences(&verlet, 0.01, 1000)?),
    ] {
        // Measured: at most 1.1e-15 from the fixed step, for Kepler, and 7.4e-15 from the converged one, for the double
        // pendulum: the converged one does not carry its residuals.
        assert!(alone < 2e-15 && converged < 1e-14, "{name}: {alone:e}, {converged:e}");
        same &= alone == 0.0 || converged == 0.0;
    }
    assert!(!same, "two ways of the same bits are one way");
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
    // At the sun, and at NaN.
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
    /// A weight on a wall: the force changes by orders of magnitude from step to step, and every step has one root.
    pub struct Wall {
        param k = 50.0;
        coord x;
        L = dot(x)^2 / 2 - x - exp(-k * x);
        discretize midpoint;
    }
}

#[test]
fn sudden_motions_are_those_of_the_fixed_step() -> Result<(), StepError> {
    let wall = |k| Wall { k };
    // Steps of 0.03 are so long for the wall that motions diverge by an order of magnitude per bounce.
    for (h, steps) in [(0.01, 5000), (0.0317, 200)] {
        let starts: Vec<_> =
            spread(70, 40.0, 60.0).map(|k| (wall(k), State::at(&wall(k), 0.0, [1.0], [0.0]))).collect();
        let [alone, converged] = differences(&starts, h, steps)?;
        // Measured: 5.8e-14 after 5000 steps.
        assert!(alone < 1e-13 && converged < 1e-13, "{alone:e}, {converged:e}");
    }
    Ok(())
}

lagrangian! {
    /// A moving wall: the time matters to the last digit.
    pub struct MovingWall {
        param a = 0.5, w = 3.0;
        coord x;
        L = dot(x)^2 / 2 - (x - a * sin(w * t))^4;
        discretize midpoint;
    }
}

#[test]
fn late_times_are_those_of_the_fixed_step() -> Result<(), StepError> {
    let wall = |a| MovingWall { a, ..MovingWall::default() };
    for t in [0.0, 10.0, 1e3, 1e5] {
        let start = |a| (wall(a), State::at(&wall(a), t, [0.3], [0.1]));
        let [alone, converged] = differences(&spread(70, 0.4, 0.6).map(start).collect::<Vec<_>>(), 0.01, 200)?;
        // Measured: 6.5e-15 at t = 1e5, whose ulp is 1.5e-11.
        assert!(alone < 1e-14 && converged < 1e-14, "{t}: {alone:e}, {converged:e}");
    }
    Ok(())
}

/// Checks each end, bit for bit.
fn is_that_of_the_fixed_step<S: Batch<N>, const N: usize>(starts: &[Start<S, N>], h: f64) -> Result<usize, StepError> {
    let (systems, states) = starts.iter().copied().unzip();
    let mut ensemble = Ensemble::new(systems, states, h)?;
    ensemble.run_observed(300, 100, |_| ());
    for (&(system, start), outcome) in starts.iter().zip(ensemble.results()) {
        let mut alone = system.at_state(start).integrate(FixedStep, h)?;
        let failure = (0..300_u64).find_map(|steps| alone.step().err().map(|error| (steps, error)));
        let state = alone.state();
        assert_eq!(outcome, failure.map_or(Ok(state), |(steps, error)| Err(Ended { state, steps, error })));
    }
    Ok(ensemble.running())
}

#[test]
fn long_formulas_are_split() -> Result<(), StepError> {
    let chain = FpuChain::default();
    let first = |x| core::array::from_fn(|k| if k == 0 { x } else { 0.0 });
    let chains: Vec<_> = spread(3, 0.2, 1.0).map(|x| (chain, State::at(&chain, 0.0, first(x), [0.0; 16]))).collect();
    assert_eq!(is_that_of_the_fixed_step(&chains, 0.1)?, 3);
    let links = NPendulum::default();
    let links: Vec<_> = spread(70, 0.1, 0.5).map(|q| (links, State::at(&links, 0.0, [q; 4], [0.0; 4]))).collect();
    assert_eq!(is_that_of_the_fixed_step(&links, 0.01)?, 70);
    Ok(())
}

lagrangian! {
    /// Driven to the end of the potential: the force has a kink at x = 0, and beyond x = 1 it is NaN.
    pub struct Cliff {
        param a = 1.0;
        coord x;
        L = dot(x)^2 / 2 + a * x - x * abs(x) / 4 - sqrt(1 - x) / 10;
        discretize midpoint;
    }
}

#[test]
fn a_run_ends_where_the_fixed_step_does() -> Result<(), StepError> {
    let cliff = |a| Cliff { a };
    let starts: Vec<_> = spread(80, -0.2, 2.0).map(|a| (cliff(a), State::at(&cliff(a), 0.0, [-0.1], [0.0]))).collect();
    let all = outcomes(&starts, 0.01, 200)?;
    let mut worst = [0.0_f64; 2];
    for (start, outcome) in starts.iter().zip(&all) {
        let mut alone = start.0.at_state(start.1).integrate(FixedStep, 0.01)?;
        let failure = (0..200_u64).find_map(|step| alone.step().err().map(|error| (step, error)));
        let (state, steps) = match outcome {
            Ok(state) => {
                assert_eq!(failure, None);
                (state, 200)
            }
            Err(ended) => {
                assert_eq!(failure.map(|(step, _)| step), Some(ended.steps));
                let is_typed = matches!(
                    ended.error,
                    StepError::NonFinite { .. } | StepError::NotConverged { .. } | StepError::TooLong { .. }
                );
                assert!(is_typed, "{ended}");
                (&ended.state, u32::try_from(ended.steps).unwrap_or(u32::MAX))
            }
        };
        let converged = converged(start, 0.01, steps)?;
        worst[0] = worst[0].max((state.q - alone.state().q).amax());
        worst[1] = worst[1].max((state.q - converged.q).amax());
    }
    // Measured: an ulp, even in the last step, whose midpoint is 4e-4 before the edge.
    assert!(worst.iter().all(|worst| *worst < 5e-16), "{worst:?}");
    let steps: BTreeSet<u64> = all.iter().filter_map(|outcome| outcome.err()).map(|ended| ended.steps).collect();
    assert!(steps.len() > 20 && all.iter().any(Result::is_ok), "{steps:?}");
    Ok(())
}

lagrangian! {
    /// The same, with the force at the end of a step instead of the midpoint.
    pub struct Ledge {
        param a = 1.0;
        coord x;
        L = dot(x)^2 / 2 + a * x - sqrt(1 - x) / 10;
        discretize trapezoidal;
    }
}

#[test]
fn the_last_state_is_a_good_one() -> Result<(), StepError> {
    let ledge = |a| Ledge { a };
    let starts: Vec<_> = spread(80, 0.2, 2.0).map(|a| (ledge(a), State::at(&ledge(a), 0.0, [0.0], [0.0]))).collect();
    for (&(system, start), outcome) in starts.iter().zip(outcomes(&starts, 0.01, 400)?) {
        let mut alone = system.at_state(start).integrate(FixedStep, 0.01)?;
        let taken = (0..400_u64).find(|_| alone.step().is_err());
        let Err(Ended { state, steps, error }) = outcome else { panic!("{} goes on", system.a) };
        assert_eq!(Some(steps), taken);
        assert!(matches!(error, StepError::NonFinite { .. }), "{error}");
        assert!(distance(&state, &alone.state()) < 1e-14);
    }
    Ok(())
}

#[test]
fn angles_of_many_turns_are_taken_alone() -> Result<(), StepError> {
    let pendulum = Pendulum::default();
    let starts: Vec<_> = spread(3, 2e5, 3e5).map(|q| (pendulum, State::at(&pendulum, 0.0, [q], [1.0]))).collect();
    let [alone, converged] = differences(&starts, 0.01, 100)?;
    // Measured: 3.8e-13, for angles with an ulp of 3e-11.
    assert!(alone < 4e-13 && converged < 4e-13, "{alone:e}, {converged:e}");
    Ok(())
}

lagrangian! {
    /// A linear chain: its matrix is inverted once.
    pub struct Springs {
        param m = 1.2, k = 1.7;
        coord q[6];
        L = sum(i in 0..6, m * dot(q[i])^2 / 2 - k * q[i]^2 / 8) - k * sum(i in 0..5, (q[i + 1] - q[i])^2) / 2;
        discretize midpoint;
    }
}

/// The results of 300 steps, in one call or in several.
fn in_parts<S: Batch<N>, const N: usize>(
    starts: &[Start<S, N>],
    h: f64,
    part: u64,
) -> Result<Vec<Outcome<N>>, StepError> {
    let (systems, states) = starts.iter().copied().unzip();
    let mut ensemble = Ensemble::new(systems, states, h)?;
    ensemble.run_observed(300, part, |_| ());
    assert_eq!(ensemble.steps(), 300);
    Ok(ensemble.results().collect())
}

#[test]
fn how_a_run_is_split_changes_no_bit() -> Result<(), StepError> {
    let springs = Springs::default();
    let chains: Vec<_> = spread(5, 0.2, 1.0).map(|x| (springs, State::at(&springs, 0.0, [x; 6], [-x; 6]))).collect();
    let linear = HarmonicOscillator::default();
    let linear: Vec<_> = spread(70, 0.2, 1.0).map(|x| (linear, State::at(&linear, 0.0, [x], [0.3]))).collect();
    for h in [0.1, 10.0] {
        for part in [1, 7] {
            assert_eq!(in_parts(&chains, h, part)?, in_parts(&chains, h, 300)?);
            assert_eq!(in_parts(&linear, h, part)?, in_parts(&linear, h, 300)?);
        }
    }
    Ok(())
}

#[test]
fn more_steps_than_can_be_counted_are_counted_as_the_most() -> Result<(), StepError> {
    let kepler = Kepler::default();
    // At the sun: every trajectory has ended.
    let starts = vec![State { t: 0.0, q: [0.0, 0.0].into(), p: [0.0, 0.0].into() }; 130];
    let mut ensemble = Ensemble::new(vec![kepler; 130], starts, 0.01)?;
    for steps in [1 << 58, u64::MAX, 1] {
        ensemble.run(steps);
    }
    assert_eq!((ensemble.running(), ensemble.steps()), (0, u64::MAX));
    Ok(())
}

#[test]
fn invalid_runs_are_rejected() {
    let well = DoubleWell::default();
    let start = State::at(&well, 0.0, [0.7], [0.0]);
    for (systems, states, h) in [(1, 1, 0.0), (1, 1, 1e-310), (1, 1, f64::NAN), (1, 2, 0.1), (2, 1, 0.1)] {
        let refused = Ensemble::new(vec![well; systems], vec![start; states], h);
        assert!(matches!(refused, Err(StepError::InvalidInput { .. })));
    }
    let empty = Ensemble::<DoubleWell, 1>::new(Vec::new(), Vec::new(), 0.1);
    assert!(empty.is_ok_and(|mut empty| {
        empty.run(3);
        empty.results().next().is_none() && empty.running() == 0
    }));
}

/// Runs of any integrator on threads equal single runs, bit for bit; a failed one ends with its error, and the others
/// continue.
#[test]
fn runs_of_any_integrator_equal_single_runs() {
    let planet = Kepler::default();
    // The last one falls into the sun.
    let speeds = [1.0, 1.1, 0.9, 1.3, 0.0];
    let start = |speed: f64| State::at(&planet, 0.0, [1.0, 0.0], [0.0, speed]);
    let gauss = |speed: f64| planet.at_state(start(speed)).integrate(Gauss::<6>, 0.1);
    let all: Result<Vec<_>, _> = speeds.into_iter().map(gauss).collect();
    let mut runs = Runs::new(all.expect("valid"));
    runs.run(37);
    runs.until(11.17);
    runs.run(5);
    let results: Vec<_> = runs.results().collect();
    for (speed, result) in speeds.into_iter().zip(&results) {
        let mut alone = gauss(speed).expect("valid");
        let outcome: Result<State<2>, StepError> = (|| {
            for _ in 0..37 {
                alone.step()?;
            }
            alone.until(11.17)?;
            for _ in 0..4 {
                alone.step()?;
            }
            alone.step()
        })();
        match (outcome, result) {
            (Ok(state), Ok(reached)) => assert_eq!(state, *reached),
            (Err(error), Err(ended)) => {
                assert_eq!((error, alone.state()), (ended.error, ended.state));
                assert!(ended.steps < 37, "{ended}");
            }
            other => panic!("{speed}: {other:?}"),
        }
    }
    assert_eq!(runs.running(), 4);
    assert_eq!(runs.runs().filter(|run| run.is_ok_and(|run| (run.h() - 0.1).abs() < 1e-15)).count(), 4);
}
