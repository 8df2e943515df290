//! The ends of runs: the steps taken, and the error.

use vi_core::stepping::{EnergyStepping, FixedStepping};
use vi_core::{EnergyPreserving, FixedStep, Run, State, Step, StepError};

/// The end of a run of the energy-preserving integrator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ending {
    /// Steps taken before the error.
    pub(crate) steps: usize,
    /// Time of the last good node.
    pub(crate) t: f64,
    /// Length of the last good step.
    pub(crate) h: f64,
    /// The error; `None` if the limit ended the run.
    pub(crate) error: Option<StepError>,
}

/// Runs to the first error, at most `limit` steps, and checks each step: finite, forward, not the reversed last one.
/// After the error the state stays and the error repeats.
pub(crate) fn energy_preserving<const N: usize, S: EnergyStepping<N>>(
    mut run: Run<EnergyPreserving, S, N>,
    limit: usize,
) -> Ending {
    let (mut last, mut steps) = (None, 0);
    while steps < limit {
        let (before, h, v) = (run.state(), run.h(), run.v());
        match run.detailed_step() {
            Ok(step) => {
                assert_step(S::NAME, &step);
                assert!(step.t >= before.t && step.midpoint.0 >= before.t, "{}: {step:?}", S::NAME);
                // The spurious root: the last interval, traversed backwards.
                assert!((step.h, step.midpoint.2) != (-h, v), "{}: {step:?}", S::NAME);
                (last, steps) = (Some(State { t: step.t, q: step.q, p: step.p }), steps + 1);
            }
            Err(error) => {
                assert_typed(error);
                assert_eq!(run.state(), last.unwrap_or(before), "{}: the last good state stays", S::NAME);
                assert_eq!((run.step(), run.next()), (Err(error), Some(Err(error))), "{}: the error repeats", S::NAME);
                assert_eq!(run.state(), before, "{}: the last good state stays", S::NAME);
                return Ending { steps, t: before.t, h, error: Some(error) };
            }
        }
    }
    Ending { steps, t: run.state().t, h: run.h(), error: None }
}

/// Runs to the first error, at most `limit` steps, with the same checks.
pub(crate) fn fixed<const N: usize, S: FixedStepping<N>>(
    mut run: Run<FixedStep, S, N>,
    limit: usize,
) -> Option<StepError> {
    for _ in 0..limit {
        let before = run.state();
        match run.step() {
            Ok(state) => {
                let numbers = state.q.iter().chain(state.p.iter()).chain([&state.t]);
                assert!(numbers.copied().all(f64::is_finite), "{}: {state:?}", S::NAME);
                assert_eq!(state, run.state());
            }
            Err(error) => {
                assert_typed(error);
                assert_eq!((run.step(), run.next()), (Err(error), Some(Err(error))), "{}: the error repeats", S::NAME);
                assert_eq!(run.state(), before, "{}: the last good state stays", S::NAME);
                return Some(error);
            }
        }
    }
    None
}

/// Maximum residual of a solved equation, in roundings of its terms.
const RESIDUAL: f64 = 256.0;

/// Asserts that a step is finite and forward, and solves its equations.
fn assert_step<const N: usize>(name: &str, step: &Step<N>) {
    let (t, q, v) = step.midpoint;
    let scalars = [step.t, step.energy, step.h, step.density, step.residual, t];
    let vectors = [&step.q, &step.p, &q, &v];
    let numbers = scalars.iter().chain(vectors.into_iter().flat_map(|vector| vector.iter()));
    assert!(numbers.copied().all(f64::is_finite), "{name}: {step:?}");
    assert!(step.h > 0.0 && step.residual <= RESIDUAL, "{name}: {step:?}");
}

/// Asserts that an error contains only numbers that are not NaN, except for the caller's own.
pub(crate) fn assert_typed(error: StepError) {
    let numbers = match error {
        StepError::InvalidInput { .. } => vec![],
        StepError::NoForwardStep { t, h, excess, density } => vec![t, h, excess, density],
        StepError::DegenerateStep { t, h, density } => vec![t, h, density],
        StepError::StepRatio { t, previous, found } => vec![t, previous, found],
        StepError::StepBounds { t, found, h_min, h_max } => vec![t, found, h_min, h_max],
        StepError::NotConverged { t, h, residual, residuals, .. } => {
            [t, h, residual].into_iter().chain(residuals.iter()).collect()
        }
        StepError::TooLong { t, h, longest } => vec![t, h, longest],
        StepError::NoForwardGaussStep { t, h, excess, density, shift, largest, .. } => {
            vec![t, h, excess, density, shift, largest]
        }
        StepError::ShiftTooLarge { t, h, shift, part, size, shorter } => vec![t, h, shift, part, size, shorter],
        // Overflowing stages report infinite numbers.
        StepError::StagesNotConverged { t, h, .. } | StepError::TimeScale { t, g: h } => vec![t, h],
        StepError::Singular { t, .. } | StepError::NonFinite { t, .. } | StepError::Ambiguous { t } => vec![t],
        other => panic!("an error that this test does not know: {other:?}"),
    };
    assert!(numbers.into_iter().all(f64::is_finite), "{error:?}");
}
