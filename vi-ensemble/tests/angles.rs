//! Angles of trajectories in vector lanes, against runs.

use vi_core::{FixedStep, Gauss, Starts, State, StepError, lagrangian};
use vi_ensemble::{Ensemble, Runs};

lagrangian! {
    struct Rotor {
        param g = 2.0;
        angle θ;
        L = dot(θ)^2 / 2 + g * cos(θ);
        discretize midpoint;
    }
}

const H: f64 = 0.05;
const STEPS: u32 = 20_000;

/// Rotors of several speeds, one of them from an angle far away, and one that swings about the upper point.
fn starts() -> Vec<(Rotor, State<1>)> {
    let rotor = Rotor::default();
    let at = |(q, v): (f64, f64)| (rotor, rotor.at(0.0, [q], [v]).state);
    let mut all: Vec<_> = (0..70).map(|index| at((0.1, 5.0 + 0.3 * f64::from(index)))).collect();
    all.push(at((1e9, -20.0)));
    let inverted = Rotor { g: -2.0 };
    all.push((inverted, inverted.at(0.0, [3.2], [0.1]).state));
    all
}

#[test]
fn lanes_have_the_angles_of_runs() -> Result<(), StepError> {
    let starts = starts();
    let (systems, states) = starts.iter().copied().unzip();
    let mut ensemble = Ensemble::new(systems, states, H)?;
    ensemble.run(u64::from(STEPS));
    let mut turned = 0;
    for ((system, start), together) in starts.iter().zip(ensemble.results()) {
        let mut alone = system.at_state(*start).integrate(FixedStep, H)?;
        for _ in 0..STEPS {
            alone.step()?;
        }
        let (together, alone) = (together.map_err(|ended| ended.error)?, alone.state());
        turned += usize::from((alone.q[0] - start.q[0]).abs() > 1000.0);
        // An ensemble agrees with runs to a few roundings, which the motion amplifies in proportion to the time.
        // Measured: 7e-11 of the angle, where it moved by 2e4.
        let difference = (together.q - alone.q).amax();
        assert!(difference < 1e-9 + 2.0 * f64::EPSILON * alone.q[0].abs(), "{difference:e}: {together:?} {alone:?}");
        assert!((together.p - alone.p).amax() < 1e-10, "{together:?} {alone:?}");
    }
    assert!(turned >= 70, "{turned}");
    Ok(())
}

#[test]
fn an_angle_without_digits_ends_its_trajectory_at_the_start() -> Result<(), StepError> {
    let (rotor, far) = (Rotor::default(), State { t: 0.0, q: [1e20].into(), p: [1.0].into() });
    let near = rotor.at(0.0, [1.0], [9.0]).state;
    let mut ensemble = Ensemble::new(vec![rotor; 2], vec![far, near], H)?;
    ensemble.run(100);
    let results: Vec<_> = ensemble.results().collect();
    let ended = results[0].expect_err("no angle");
    assert!(matches!(ended.error, StepError::InvalidInput { input: "an angle", .. }), "{ended:?}");
    assert_eq!((ended.state.q[0].to_bits(), ended.steps), (1e20_f64.to_bits(), 0));
    assert!(results[1].is_ok_and(|state| state.q[0] > 30.0));
    Ok(())
}

#[test]
fn runs_of_any_method_have_their_bits() -> Result<(), StepError> {
    let begun = || starts().into_iter().map(|(system, state)| system.at_state(state).integrate(Gauss::<3>, H));
    let mut runs = Runs::new(begun().collect::<Result<Vec<_>, _>>()?);
    runs.run(500);
    for (alone, together) in begun().zip(runs.runs()) {
        let mut alone = alone?;
        for _ in 0..500 {
            alone.step()?;
        }
        let together = together.map_err(|ended| ended.error)?;
        assert_eq!((together.state(), together.turns()), (alone.state(), alone.turns()));
    }
    Ok(())
}
