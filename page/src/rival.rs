//! A Runge–Kutta run with as many evaluations.
//!
//! In: a system and an initial state. Out: H along the classical method of order 4, whose steps are so long that it
//! evaluates the equations of motion as often as the method beside it.

use vi_core::StepError;
use vi_erased::System;
use vi_erased::plan::PhasePoint;
use vi_erased::system::Quantity;

/// Evaluations of a step.
const STAGES: u64 = 4;

/// A state of the rival, which has diverged if there is no state.
pub struct Rival {
    at: Option<PhasePoint>,
    evaluations: u64,
}

impl Rival {
    /// A run from a state.
    #[must_use]
    pub fn new(at: PhasePoint) -> Self {
        Self { at: Some(at), evaluations: 0 }
    }

    /// Moves to the time `end` with about as many evaluations in all as `evaluations`, and returns H there; NaN once the
    /// run has diverged.
    pub fn advance(&mut self, system: &dyn System, end: f64, evaluations: u64) -> f64 {
        let steps = (evaluations.saturating_sub(self.evaluations) / STAGES).max(1);
        self.evaluations += STAGES * steps;
        let Some(mut at) = self.at.take() else { return f64::NAN };
        #[allow(clippy::cast_precision_loss)] // a few steps
        let h = (end - at.t) / steps as f64;
        for _ in 0..steps {
            let Ok(next) = step(system, &at, h) else { return f64::NAN };
            at = next;
        }
        at.t = end;
        let energy = system.energy(&at).ok().filter(|energy| energy.is_finite());
        self.at = energy.is_some().then_some(at);
        energy.unwrap_or(f64::NAN)
    }
}

/// One step of the classical method.
fn step(system: &dyn System, at: &PhasePoint, h: f64) -> Result<PhasePoint, StepError> {
    let mut slopes: Vec<(f64, PhasePoint)> = Vec::new();
    for (part, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
        let stage = slopes.last().map_or_else(|| at.clone(), |(_, slope)| moved(at, part * h, slope));
        slopes.push((weight, slope(system, stage)?));
    }
    Ok(slopes.iter().fold(at.clone(), |sum, (weight, slope)| moved(&sum, weight * h / 6.0, slope)))
}

/// The derivative of a state with respect to time.
fn slope(system: &dyn System, at: PhasePoint) -> Result<PhasePoint, StepError> {
    let mut acceleration = Vec::new();
    system.evaluate(Quantity::Acceleration, [&[at.t], &at.q, &at.v], &mut acceleration)?;
    Ok(PhasePoint { t: 1.0, q: at.v, v: acceleration })
}

/// `at + h slope`.
fn moved(at: &PhasePoint, h: f64, slope: &PhasePoint) -> PhasePoint {
    let sum = |of: &[f64], slope: &[f64]| of.iter().zip(slope).map(|(of, slope)| of + h * slope).collect();
    PhasePoint { t: at.t + h * slope.t, q: sum(&at.q, &slope.q), v: sum(&at.v, &slope.v) }
}
