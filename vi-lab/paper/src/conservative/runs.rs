//! The long runs of the four cases, by both integrators from the same first interval.
//!
//! In: a [`Case`]. Out: a [`Pair`]: samples of the beginning, the growth of the energy error over the whole run.

use vi_core::{EnergyPreserving, FixedStep, Lagrangian, Run, SVector, Starts, StepError};
use vi_erased::start::second_point;
use vi_report::progress::Progress;
use vi_systems::DoubleWell;

/// Time for which samples are kept: several oscillations.
const KEPT: f64 = 40.0;

/// Amplitude and initial step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Case {
    /// Initial coordinate.
    pub(super) q0: f64,
    /// Initial step.
    pub(super) h0: f64,
}

/// The middle of a step, at which the energy equation holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// Time.
    pub(super) t: f64,
    /// Coordinate.
    pub(super) q: f64,
    /// Velocity.
    pub(super) v: f64,
    /// Length of the step.
    pub(super) h: f64,
    /// `E_k − E_1`.
    pub(super) error: f64,
}

/// One integrator's run.
#[derive(Clone, Debug, Default)]
pub(super) struct Track {
    /// The beginning.
    pub(super) samples: Vec<Sample>,
    /// Iteration and largest abs(E_k − E_1) so far, wherever it grew, and at the end.
    pub(super) growth: Vec<(f64, f64)>,
    /// Largest abs(E_k − E_1).
    pub(super) error: f64,
    /// Shortest and longest step.
    pub(super) steps: (f64, f64),
    /// Newton iterations altogether.
    pub(super) iterations: f64,
}

/// Both runs of a case.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    /// Amplitude and initial step.
    pub(super) case: Case,
    /// `E_1 − H_0`: the discretization error of the first interval.
    pub(super) start: f64,
    /// Largest abs(E_k − E_1) if the velocity of a step is recomputed from its stored nodes.
    pub(super) stored: f64,
    /// Largest abs(E_k − E_1) of the same number of fixed steps in the same time, and their length.
    pub(super) as_many: (f64, f64),
    /// The energy-preserving integrator.
    pub(super) energy: Track,
    /// The fixed-step integrator.
    pub(super) fixed: Track,
}

impl Case {
    /// The case in words.
    pub(super) fn label(&self) -> String {
        format!("q₀ = {}, h₀ = {}", self.q0, self.h0)
    }

    /// The energy-preserving integrator at the paper's start.
    pub(super) fn start(&self) -> Result<Run<EnergyPreserving, DoubleWell, 1>, StepError> {
        let system = DoubleWell::default();
        let q0 = SVector::from([self.q0]);
        let second = second_point(&system, 0.0, q0, SVector::zeros(), self.h0)?;
        EnergyPreserving::from_points(system, (0.0, q0), second)
    }
}

impl Pair {
    /// Runs both integrators over `steps` steps.
    pub(super) fn of(case: Case, steps: u32, progress: &mut Progress) -> Result<Self, StepError> {
        let mut integrator = case.start()?;
        let system = *integrator.system();
        let state = integrator.state();
        let energy = integrator.node().energy;
        let mut adaptive = Track::new(case.h0);
        let mut stored = 0.0_f64;
        for index in 1..=steps {
            let before = integrator.state();
            let step = integrator.detailed_step()?;
            let quotient = (step.q - before.q) / (step.t - before.t);
            let recomputed = system.energy(step.midpoint.0, &((step.q + before.q) / 2.0), &quotient) - energy;
            stored = stored.max(recomputed.abs());
            let (t, q, v) = step.midpoint;
            let error = system.energy(t, &q, &v) - energy;
            adaptive.take(index, Sample { t, q: q.x, v: v.x, h: step.h, error }, step.iterations);
            progress.advance();
        }
        adaptive.end(steps);

        let mut integrator = system.at_state(state).integrate(FixedStep, case.h0)?;
        let mut fixed = Track::new(case.h0);
        for index in 1..=steps {
            let before = integrator.state();
            integrator.step()?;
            let v = integrator.v();
            let q = before.q + v * (case.h0 / 2.0);
            let t = before.t + case.h0 / 2.0;
            let error = system.energy(t, &q, &v) - energy;
            fixed.take(index, Sample { t, q: q.x, v: v.x, h: case.h0, error }, integrator.iterations());
            progress.advance();
        }
        fixed.end(steps);
        let start = energy - system.energy(0.0, &SVector::from([case.q0]), &SVector::zeros());
        let as_many = as_many(case.q0, &adaptive.samples)?;
        Ok(Self { case, start, stored, as_many, energy: adaptive, fixed })
    }
}

/// The largest abs(E_k − E_1) and the length of fixed steps that take the time of these samples in as many steps.
fn as_many(q0: f64, samples: &[Sample]) -> Result<(f64, f64), StepError> {
    let until = samples.last().map_or(0.0, |sample| sample.t + sample.h / 2.0);
    let h = samples.iter().map(|sample| sample.h).sum::<f64>() / f64::from(u32::try_from(samples.len()).unwrap_or(1));
    let integrator = Case { q0, h0: h }.start()?;
    let (system, energy) = (*integrator.system(), integrator.node().energy);
    let mut integrator = system.at_state(integrator.state()).integrate(FixedStep, h)?;
    let mut worst = 0.0_f64;
    while integrator.t() < until {
        let before = integrator.state();
        integrator.step()?;
        let v = integrator.v();
        let error = system.energy(before.t + h / 2.0, &(before.q + v * (h / 2.0)), &v) - energy;
        worst = worst.max(error.abs());
    }
    Ok((worst, h))
}

impl Track {
    fn new(h0: f64) -> Self {
        Self { steps: (h0, h0), ..Self::default() }
    }

    fn take(&mut self, index: u32, sample: Sample, iterations: u32) {
        if sample.t < KEPT {
            self.samples.push(sample);
        }
        if sample.error.abs() > self.error {
            self.error = sample.error.abs();
            self.growth.push((f64::from(index), self.error));
        }
        self.steps = (self.steps.0.min(sample.h), self.steps.1.max(sample.h));
        self.iterations += f64::from(iterations);
    }

    /// Newton iterations per step.
    pub(super) fn mean_iterations(&self) -> f64 {
        self.iterations / self.growth.last().map_or(f64::NAN, |(steps, _)| *steps)
    }

    fn end(&mut self, steps: u32) {
        self.growth.push((f64::from(steps), self.error));
    }
}
