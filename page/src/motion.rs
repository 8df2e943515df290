//! The rows of a run.
//!
//! In: a planned run. Out: for each step a row of numbers: t, coordinates, velocities, H less its first value, the same of
//! the rival. H is that of the node; for energy-preserving steps that of the midpoint, which they keep: its first value is
//! that of the first midpoint.

use crate::facts::keeps_energy;
use crate::rival::Rival;
use vi_core::StepError;
use vi_erased::plan::PhasePoint;
use vi_erased::system::Quantity;
use vi_erased::{Plan, Simulation, System};

/// A run with its rival.
pub struct Motion {
    system: Box<dyn System>,
    run: Box<dyn Simulation>,
    rival: Rival,
    /// H at the start.
    pub initial_energy: f64,
    /// The first value of the energy of the run; `None` before the first energy-preserving step.
    kept: Option<f64>,
}

impl Motion {
    /// The planned run of a system at its start.
    ///
    /// # Errors
    /// As [`System::begin`].
    pub fn begin(system: Box<dyn System>, plan: &Plan) -> Result<Self, StepError> {
        let run = system.begin(plan)?;
        let start = PhasePoint { t: plan.t, q: plan.q.clone(), v: plan.v.clone() };
        let initial_energy = system.energy(&start)?;
        let is_kept = keeps_energy(plan.method) && system.conserves_energy();
        let kept = (!is_kept).then_some(initial_energy);
        Ok(Self { system, run, rival: Rival::new(start), initial_energy, kept })
    }

    /// The requested length of a step, or the one that a tolerance has found.
    #[must_use]
    pub fn h(&self) -> f64 {
        self.run.h()
    }

    /// The coordinates of the last node.
    #[must_use]
    pub fn q(&self) -> Vec<f64> {
        self.run.q().into_owned()
    }

    /// Takes steps until the time `end`, at most `most`. Appends their rows.
    ///
    /// # Errors
    /// The error of the failed step.
    pub fn advance(&mut self, end: f64, most: u32, rows: &mut Vec<f64>) -> Result<(), StepError> {
        for _ in 0..most {
            if self.run.t() >= end {
                break;
            }
            self.run.advance()?;
            self.push_row(rows)?;
        }
        Ok(())
    }

    /// Takes steps without rows: what a step costs.
    ///
    /// # Errors
    /// The error of the failed step.
    pub fn advance_by(&mut self, steps: u32) -> Result<(), StepError> {
        self.run.advance_by(steps.into())
    }

    /// Appends the row of the last node.
    fn push_row(&mut self, rows: &mut Vec<f64>) -> Result<(), StepError> {
        let (t, q) = (self.run.t(), self.run.q());
        rows.push(t);
        rows.extend_from_slice(&q);
        self.system.evaluate(Quantity::Velocity, [&[t], &q, self.run.p()], rows)?;
        let (_, energy) = self.run.sampled_energy()?;
        rows.push(energy - *self.kept.get_or_insert(energy));
        let of_rival = self.rival.advance(&*self.system, t, self.run.evaluations());
        rows.push(of_rival - self.initial_energy);
        Ok(())
    }
}
