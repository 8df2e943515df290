//! The endings of runs, with the same colours in every map.
//!
//! In: an integrator and a [`Limit`]. Out: a [`RunSummary`]. A map distinguishes a solver that fails from a motion that
//! grows without bound: each typed error has its own colour.

use vi_core::stepping::{EnergyStepping, FixedStepping};
use vi_core::{EnergyPreserving, FixedStep, SVector, Starts, State, StepError};
use vi_erased::System;
use vi_erased::plan::Plan;
use vi_report::chart::Class;

/// The limits of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    /// Largest number of steps.
    pub(super) steps: u32,
    /// End time.
    pub(super) until: f64,
    /// Coordinate above which a run counts as unstable.
    pub(super) bound: f64,
}

/// The ending of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ending {
    /// The run reached its limit.
    Lasting,
    /// A coordinate exceeded the bound.
    Unbounded,
    /// A step failed.
    Failing(StepError),
}

/// The ending of a run, with the number of its steps and its largest coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunSummary {
    /// The ending.
    pub(super) ending: Ending,
    /// Steps taken.
    pub(super) steps: u32,
    /// Largest coordinate, by absolute value.
    pub(super) largest: f64,
}

/// A run to its limit.
pub(super) const LASTING: Class = Class { number: 0, label: "runs to the end", colour: "#E3ECF4" };
/// A run with a coordinate that exceeds the bound.
pub(super) const UNBOUNDED: Class = Class { number: 1, label: "unstable: grows on", colour: "#E69F00" };
const NO_FORWARD_STEP: Class = Class { number: 2, label: "no forward step", colour: "#CC79A7" };
const DEGENERATE_STEP: Class = Class { number: 3, label: "degenerate step", colour: "#56B4E9" };
const STEP_RATIO: Class = Class { number: 4, label: "step ratio above 3", colour: "#0072B2" };
/// No solution of the momentum equation was found.
pub(super) const NOT_CONVERGED: Class = Class { number: 5, label: "solver: no solution", colour: "#3A3A3A" };
const SINGULAR: Class = Class { number: 6, label: "singular matrix", colour: "#F0E442" };
const NON_FINITE: Class = Class { number: 7, label: "not finite", colour: "#999999" };
const OTHER: Class = Class { number: 8, label: "no such start", colour: "#009E73" };
/// First number for the classes of a single chart.
pub(super) const OWN: u8 = 10;

impl Ending {
    /// The colour of this end.
    pub(super) fn class(self) -> Class {
        match self {
            Self::Lasting => LASTING,
            Self::Unbounded => UNBOUNDED,
            Self::Failing(error) => match error {
                StepError::NoForwardStep { .. } | StepError::NoForwardGaussStep { .. } => NO_FORWARD_STEP,
                StepError::DegenerateStep { .. } => DEGENERATE_STEP,
                StepError::StepRatio { .. } => STEP_RATIO,
                StepError::NotConverged { .. } | StepError::StagesNotConverged { .. } | StepError::TooLong { .. } => {
                    NOT_CONVERGED
                }
                StepError::Singular { .. } => SINGULAR,
                StepError::NonFinite { .. } | StepError::Undefined { .. } => NON_FINITE,
                _ => OTHER,
            },
        }
    }
}

impl RunSummary {
    /// Takes the steps of a run, if it could start, as [`RunSummary::of`].
    fn begun<R>(
        run: Result<R, StepError>,
        limit: Limit,
        mut step: impl FnMut(&mut R) -> Result<(f64, f64), StepError>,
    ) -> Self {
        match run {
            Ok(mut run) => Self::of(limit, || step(&mut run)),
            Err(error) => Self { ending: Ending::Failing(error), steps: 0, largest: 0.0 },
        }
    }

    /// Takes steps, each of which returns the time and the largest coordinate, to the limit.
    fn of(limit: Limit, mut step: impl FnMut() -> Result<(f64, f64), StepError>) -> Self {
        let mut summary = Self { ending: Ending::Lasting, steps: 0, largest: 0.0 };
        while summary.steps < limit.steps {
            match step() {
                Ok((t, size)) => {
                    summary.steps += 1;
                    summary.largest = summary.largest.max(size);
                    if size > limit.bound {
                        summary.ending = Ending::Unbounded;
                        break;
                    }
                    if t >= limit.until {
                        break;
                    }
                }
                Err(error) => {
                    summary.ending = Ending::Failing(error);
                    break;
                }
            }
        }
        summary
    }

    /// Runs the integrator with fixed step from the node `(q, p)`, p belonging to `v`.
    pub(super) fn fixed<S: FixedStepping<N>, const N: usize>(
        system: S,
        q: impl Into<SVector<f64, N>>,
        v: impl Into<SVector<f64, N>>,
        h: f64,
        limit: Limit,
    ) -> Self {
        let state = State::at(&system, 0.0, q, v);
        Self::begun(system.at_state(state).integrate(FixedStep, h), limit, |run| {
            run.step().map(|state| (state.t, state.q.amax()))
        })
    }

    /// Runs the energy-preserving integrator from the midpoint `(q, v)` of the first interval.
    pub(super) fn energy<S: EnergyStepping<N>, const N: usize>(
        system: S,
        q: impl Into<SVector<f64, N>>,
        v: impl Into<SVector<f64, N>>,
        h: f64,
        limit: Limit,
    ) -> Self {
        let run = EnergyPreserving::from_midpoint(system, 0.0, q, v, h);
        Self::begun(run, limit, |run| run.step().map(|step| (step.t, step.q.amax())))
    }

    /// Runs a plan of a type-erased system.
    pub(super) fn planned(system: &dyn System, plan: &Plan, limit: Limit) -> Self {
        Self::begun(system.begin(plan), limit, |run| {
            run.advance()?;
            Ok((run.t(), size(&run.q())))
        })
    }
}

/// The ending of fixed steps of an oscillator from (1, 0), whose exact motion grows at this rate. Counts displacement
/// and momentum: at an extreme one of them vanishes.
pub(super) fn oscillation<S: FixedStepping<1>>(system: S, h: f64, limit: Limit, rate: f64) -> Ending {
    /// Amplitude of a motion that has come to rest: far above the subnormal numbers, whose rounding is not relative.
    const REST: f64 = 1e-200;
    let summary = RunSummary::begun(system.at(0.0, [1.0], [0.0]).integrate(FixedStep, h), limit, |run| {
        let state = run.step()?;
        let size = state.q.x.hypot(state.p.x);
        Ok((if size < REST { f64::INFINITY } else { state.t }, size * (-rate * state.t).exp()))
    });
    summary.ending
}

/// The largest of some numbers, by absolute value.
pub(super) fn size(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()))
}
