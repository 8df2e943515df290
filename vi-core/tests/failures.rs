//! If there is no step: a typed error, the last good state, the same error again; never NaN, never an endless loop.

use crate::systems::{DoubleWell, FreeParticle, Kepler, UnitMass, point_after};
use vi_core::{EnergyPreserving, FixedStep, Run, SVector, Starts, State, Step, StepError};

type DoubleWellRun<'a> = Run<EnergyPreserving, &'a UnitMass<DoubleWell>, 1>;

fn above_the_barrier(system: &UnitMass<DoubleWell>, q0: f64) -> DoubleWellRun<'_> {
    let q1 = point_after(&system.0, q0, 0.01);
    EnergyPreserving::from_points(system, (0.0, [q0]), (0.01, [q1])).unwrap_or_else(|error| panic!("{error}"))
}

/// The steps taken, at most `limit`, and the error that ended the run.
fn until_error<const N: usize>(
    run: &mut impl Iterator<Item = Result<Step<N>, StepError>>,
    limit: usize,
) -> (usize, Option<StepError>) {
    let mut steps = 0;
    for result in run.take(limit) {
        match result {
            Ok(step) => {
                let numbers = [step.t, step.energy, step.h, step.density, step.residual];
                assert!(numbers.into_iter().chain(step.q.iter().chain(step.p.iter()).copied()).all(f64::is_finite));
                steps += 1;
            }
            Err(error) => {
                assert_typed(error);
                return (steps, Some(error));
            }
        }
    }
    (steps, None)
}

#[test]
fn above_the_barrier_the_step_ends_where_the_density_vanishes() {
    for (q0, last) in [(1.0001, 151), (1.001, 145), (1.05, 114), (1.2, 88), (1.5, 66)] {
        let system = UnitMass(DoubleWell);
        let mut run = above_the_barrier(&system, q0);
        let (steps, error) = until_error(&mut run.detailed_steps(), 1000);
        // The step that fails, counted from 1. Measured: exactly these.
        assert_eq!(steps + 1, last, "{q0}");
        assert!(matches!(error, Some(StepError::NoForwardStep { excess, .. }) if excess > 0.0), "{q0}: {error:?}");
    }
}

#[test]
fn kepler_ends_beyond_the_eccentricity_that_the_method_can_follow() {
    let system = UnitMass(Kepler { mu: 1.0 });
    let run = EnergyPreserving::from_midpoint(&system, 0.0, [0.2, 0.0], [0.0, 3.0], 0.0035);
    let (steps, error) = until_error(&mut run.unwrap_or_else(|error| panic!("{error}")).detailed_steps(), 1000);
    assert_eq!(steps + 1, 37);
    assert!(matches!(error, Some(StepError::NoForwardStep { .. })), "{error:?}");
}

#[test]
fn after_an_error_the_last_state_stays_and_the_error_repeats() {
    let system = UnitMass(DoubleWell);
    let mut run = above_the_barrier(&system, 1.5);
    let mut last = None;
    let error = loop {
        match run.step() {
            Ok(step) => last = Some(State { t: step.t, q: step.q, p: step.p }),
            Err(error) => break error,
        }
    };
    assert_eq!(last, Some(run.state()));
    assert_eq!((run.step(), run.next()), (Err(error), Some(Err(error))));
    assert_eq!(last, Some(run.state()));

    let falling = State { t: 0.0, q: SVector::from([0.1, 0.0]), p: SVector::from([0.0, 0.0]) };
    let mut fixed = UnitMass(Kepler { mu: 1.0 })
        .at_state(falling)
        .integrate(FixedStep, 1.0)
        .unwrap_or_else(|error| panic!("{error}"));
    let error = fixed.step();
    assert!(error.is_err());
    assert_eq!((fixed.step(), fixed.next(), fixed.state()), (error, Some(error), falling));
}

#[test]
fn the_fixed_step_of_kepler_exists_up_to_its_bound() {
    // On a radial line |q + h p/2|³ ≥ (27/16) μ h² decides.
    let (mu, h) = (1.0, 0.5_f64);
    let bound = (27.0 / 16.0 * mu * h * h).cbrt();
    for (distance, exists) in [(0.999, false), (0.9, false), (0.5, false), (1.001, true), (1.1, true), (3.0, true)] {
        let start = State { t: 0.0, q: SVector::from([distance * bound, 0.0]), p: SVector::zeros() };
        let mut run =
            UnitMass(Kepler { mu }).at_state(start).integrate(FixedStep, h).unwrap_or_else(|error| panic!("{error}"));
        let result = run.step();
        match result {
            Ok(state) => assert!(exists && state.q[0] > 0.0, "{distance}: {state:?}"),
            Err(error) => assert!(!exists && matches!(error, StepError::NotConverged { .. }), "{distance}: {error:?}"),
        }
    }
}

#[test]
fn a_length_that_nothing_determines_is_an_error() {
    let mut run = EnergyPreserving::from_midpoint(UnitMass(FreeParticle), 0.0_f64, [0.0], [1.0], 0.1)
        .unwrap_or_else(|error| panic!("{error}"));
    assert!(matches!(run.step(), Err(StepError::DegenerateStep { .. })));
    // At rest at the bottom of the well.
    let mut run = EnergyPreserving::from_midpoint(UnitMass(DoubleWell), 0.0_f64, [0.0], [0.0], 0.1)
        .unwrap_or_else(|error| panic!("{error}"));
    assert!(matches!(run.step(), Err(StepError::DegenerateStep { .. })));
}

#[test]
fn a_state_too_close_to_a_sign_change_has_no_step() {
    // H = E: the last node has the energy of the interval, and the step would have zero length.
    let system = UnitMass(DoubleWell);
    let state = State::at(&system, 0.0_f64, [0.74], [0.1]);
    let energy = vi_core::Lagrangian::energy(&system, 0.0, &state.q, &SVector::from([0.1]));
    let run = EnergyPreserving::from_state(&system, state, energy, 0.01, [0.1]);
    let (steps, error) = until_error(&mut run.unwrap_or_else(|error| panic!("{error}")).detailed_steps(), 10);
    assert!(steps == 0 && matches!(error, Some(StepError::NoForwardStep { .. })), "{error:?}");
}

#[test]
fn a_step_beyond_the_factor_is_named_with_its_length() {
    // As if the last step had been ten times longer than the energy allows.
    let system = UnitMass(DoubleWell);
    let mut short = EnergyPreserving::from_midpoint(&system, 0.0_f64, [0.74], [0.0], 0.01)
        .unwrap_or_else(|error| panic!("{error}"));
    let h = short.detailed_step().map_or(f64::NAN, |step| step.h);
    let (state, energy, v) = (short.state(), short.last_step().energy, short.v());
    let run = EnergyPreserving::from_state(&system, state, energy, 0.05, v);
    let (_, error) = until_error(&mut run.unwrap_or_else(|error| panic!("{error}")).detailed_steps(), 1);
    let Some(StepError::StepRatio { previous, found, .. }) = error else { panic!("{error:?}") };
    assert!(previous.to_bits() == 0.05_f64.to_bits() && (found / h - 1.0).abs() < 1e-8, "{found} {h}");
}

/// Unreasonable numbers.
const STRANGE: [f64; 12] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.01,
    f64::MIN_POSITIVE,
    5e-324,
    1e-150,
    1e-20,
    1e6,
    1e150,
    f64::MAX,
];

#[test]
fn strange_numbers_give_typed_errors_and_never_not_a_number() {
    let system = UnitMass(DoubleWell);
    for x in STRANGE {
        for (t0, q0, v0, h0) in [(0.0, 0.74, 0.1, x), (x, 0.74, 0.1, 0.01), (0.0, x, 0.1, 0.01), (0.0, 0.74, x, 0.01)] {
            let runs = [
                EnergyPreserving::from_midpoint(&system, t0, [q0], [v0], h0),
                EnergyPreserving::from_points(&system, (t0, [q0]), (t0 + h0, [q0 + h0 * v0])),
                EnergyPreserving::from_state(&system, State::at(&system, t0, [q0], [v0]), x, h0, [v0]),
            ];
            for run in runs {
                match run {
                    Ok(mut run) => _ = until_error(&mut run.detailed_steps(), 20),
                    Err(error) => assert_typed(error),
                }
            }
            match system.at(t0, [q0], [v0]).integrate(FixedStep, h0) {
                Ok(run) => {
                    for result in run.take(20) {
                        match result {
                            Ok(state) => assert!([state.t, state.q[0], state.p[0]].iter().all(|x| x.is_finite())),
                            Err(error) => assert_typed(error),
                        }
                    }
                }
                Err(error) => assert_typed(error),
            }
        }
    }
}

/// Asserts that the error names the cause, and that every number in it is valid.
fn assert_typed(error: StepError) {
    let numbers = match error {
        // The caller's value may be anything.
        StepError::InvalidInput { .. } => vec![],
        StepError::NoForwardStep { t, h, excess, density } => vec![t, h, excess, density],
        StepError::DegenerateStep { t, h, density } => vec![t, h, density],
        StepError::StepRatio { t, previous, found } => vec![t, previous, found],
        StepError::NotConverged { t, h, residual, .. } => vec![t, h, residual],
        StepError::TooLong { t, h, longest } => vec![t, h, longest],
        StepError::Singular { t, .. } | StepError::NonFinite { t, .. } => vec![t],
        other => panic!("{other:?}"),
    };
    assert!(numbers.into_iter().all(f64::is_finite), "{error:?}");
}

#[test]
fn a_step_whose_branch_ends_before_is_too_long() {
    let system = UnitMass(DoubleWell);
    let start = system.at(0.0, [-0.501_788_718_293_452_4], [0.482_599_976_848_844_04]);
    let step = |h: f64| -> Result<f64, StepError> {
        let mut run = start.integrate(FixedStep, h)?;
        run.step().map(|_| run.v()[0])
    };
    // By continuation with 30 digits the branch turns back at h = 2.1340050. Newton iteration finds v = 0.0729 beyond.
    let error = step(3.018_217_936_830_678_7).map_or_else(|error| error, |v| panic!("{v}"));
    let StepError::TooLong { t: 0.0, h, longest } = error else { panic!("{error}") };
    assert!(h > 3.0 && (longest - 1.707_204_0_f64).abs() < 1e-5, "{error}");
    assert!(step(longest).is_ok() && step(2.13).is_ok() && step(2.14).is_err(), "{error}");
    assert_eq!(
        error.to_string(),
        "the step from t = 0.000000000 is too long: with h = 3.018e0 no solution continues those of short steps; try h = 1.707e0"
    );
}

#[test]
fn a_long_step_takes_the_connected_root() {
    let start = UnitMass(DoubleWell).at(0.0, [-0.995_271_648_905_431_6], [0.682_351_423_365_381_3]);
    let mut run = start.integrate(FixedStep, 3.0).unwrap_or_else(|error| panic!("{error}"));
    assert!(run.step().is_ok());
    // By continuation with 30 digits.
    let off: f64 = run.state().q[0] + 0.035_444_653_096_64;
    assert!(off.abs() < 1e-10, "{off:e}");
}

#[test]
fn a_step_must_be_a_step() {
    let system = UnitMass(DoubleWell);
    let state = State::at(&system, 0.0_f64, [0.74], [0.0]);
    for h in [0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(matches!(system.at_state(state).integrate(FixedStep, h), Err(StepError::InvalidInput { .. })), "{h}");
    }
    for h in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let start = EnergyPreserving::from_midpoint(&system, 0.0, [0.74], [0.0], h);
        assert!(matches!(start, Err(StepError::InvalidInput { .. })), "{h}");
    }
}

#[test]
fn a_negative_step_reverses_a_run() {
    let system = UnitMass(DoubleWell);
    let start = State::at(&system, 0.0_f64, [0.74], [0.1]);
    let there = system.at_state(start).integrate(FixedStep, 0.1).ok().and_then(|run| run.take(1000).last());
    let there = there.and_then(Result::ok).unwrap_or(start);
    let back = system.at_state(there).integrate(FixedStep, -0.1).ok().and_then(|run| run.take(1000).last());
    let back = back.and_then(Result::ok).unwrap_or(there);
    // Measured: 5.6e-15.
    assert!(back.t.abs().max((back.q - start.q).amax()).max((back.p - start.p).amax()) < 2e-14, "{back:?}");
}
