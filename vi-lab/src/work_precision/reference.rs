//! The reference solution for the errors.
//!
//! In: a system, an initial state, the end time. Out: a [`Reference`]: extrapolation of the modified midpoint rule
//! ([`System::follow`]), a method outside the comparison, stored at equidistant times and continued from there to any
//! other. Its accuracy is estimated from the most accurate runs of two compared methods at the end.
//!
//! ```text
//! error = max_i max( |q_i − q_i^ref| / Q, |p_i − p_i^ref| / P )        Q, P: largest coordinate and momentum along the
//! solution
//! ```

use super::method::{FinalState, Method, Task};
use vi_erased::System;
use vi_erased::plan::PhasePoint;
use vi_erased::studies::rival::Ended;

/// Number of intervals at whose ends the reference is stored.
const PARTS: u32 = 256;
/// Tolerance of the DOP853 run that confirms the reference.
pub(super) const TOLERANCE: f64 = 1e-14;

/// The reference solution.
pub(super) struct Reference<'a> {
    system: &'a dyn System,
    track: Vec<PhasePoint>,
    /// Largest coordinate along the solution.
    largest_q: f64,
    /// Largest momentum along the solution.
    largest_p: f64,
}

/// Errors of other accurate runs relative to the reference at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Agreement {
    /// Kahan and Li's composition of order 8 at a small step.
    pub(super) composed: f64,
    /// Length of that step.
    pub(super) h: f64,
    /// DOP853 at its tightest tolerance.
    pub(super) rival: f64,
}

impl Agreement {
    /// Smaller errors are not resolved.
    pub(super) fn floor(&self) -> f64 {
        self.composed.max(self.rival)
    }
}

impl<'a> Reference<'a> {
    /// Computes the motion from `start` to `end`.
    ///
    /// # Errors
    /// The motion cannot be computed.
    pub(super) fn new(system: &'a dyn System, start: &PhasePoint, end: f64) -> Result<Self, Ended> {
        let mut reference = Self { system, track: vec![start.clone()], largest_q: 0.0, largest_p: 0.0 };
        let mut last = start.clone();
        for part in 0..=PARTS {
            last = system.studies().follow(&last, start.t + (end - start.t) * f64::from(part) / f64::from(PARTS))?;
            reference.largest_q = reference.largest_q.max(largest(&last.q));
            reference.largest_p = reference.largest_p.max(largest(&system.momentum(&last)?));
            reference.track.push(last.clone());
        }
        Ok(reference)
    }

    /// The motion at `t`, which may lie shortly after the end.
    ///
    /// # Errors
    /// The motion cannot be computed.
    fn at(&self, t: f64) -> Result<PhasePoint, Ended> {
        let later = self.track.partition_point(|point| point.t <= t);
        let before = self.track.get(later.saturating_sub(1)).ok_or(Ended::NonFinite)?;
        Ok(self.system.studies().follow(before, t)?)
    }

    /// The error of a state, at its own time.
    ///
    /// # Errors
    /// As [`Reference::at`].
    pub(super) fn error(&self, state: &FinalState) -> Result<f64, Ended> {
        let expected = self.at(state.t)?;
        let p = self.system.momentum(&expected)?;
        let error_q = distance(&state.q, &expected.q) / self.largest_q;
        let error_p = distance(&state.p, &p) / self.largest_p;
        Ok(error_q.max(error_p))
    }

    /// Errors of Kahan and Li's composition with the step `h`, and of DOP853, relative to the reference at its end.
    ///
    /// # Errors
    /// The reason why one of the runs ended.
    pub(super) fn agreement(&self, h: f64) -> Result<Agreement, Ended> {
        let start = self.track.first().ok_or(Ended::NonFinite)?;
        let end = self.track.last().ok_or(Ended::NonFinite)?.t;
        let error = |method, setting| {
            let task = Task { start, end, method, setting };
            self.error(&task.reached(self.system)?.0)
        };
        Ok(Agreement { composed: error(Method::KAHAN_LI_8, h)?, h, rival: error(Method::RIVAL, TOLERANCE)? })
    }
}

/// The largest entry, by absolute value.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| largest.max(value.abs()))
}

/// The largest difference of two vectors.
fn distance(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).fold(0.0, |largest, (a, b)| largest.max((a - b).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ready;

    #[test]
    fn the_reference_is_the_closed_form() {
        let start = PhasePoint { t: 0.0, q: vec![1.0], v: vec![0.0] };
        let system = ready().find("damped-oscillator").expect("the system").system;
        let reference = Reference::new(system.as_ref(), &start, 40.0).expect("a motion");
        let agreement = reference.agreement(0.02).expect("runs");
        let decay = 0.02_f64;
        let omega = (4.0_f64 - 0.02 * 0.02).sqrt();
        let found = reference.at(40.0).expect("the end");
        let exact = (-decay * 40.0).exp() * ((omega * 40.0).cos() + decay / omega * (omega * 40.0).sin());
        // Measured 3.4e-14; the runs estimate 3.7e-14.
        let error = (found.q[0] - exact).abs();
        assert!(error < 4e-14 && error < agreement.floor(), "{error:e}, {agreement:?}");

        let start = PhasePoint { t: 0.0, q: vec![0.4, 0.0], v: vec![0.0, 2.0] };
        let system = ready().find("kepler").expect("the system").system;
        let reference = Reference::new(system.as_ref(), &start, 20.0).expect("a motion");
        let agreement = reference.agreement(0.01).expect("runs");
        // a = 1, e = 0.6: M = E − e sin E, x = cos E − e, y = √(1 − e²) sin E.
        let anomaly = (0..50).fold(20.0_f64, |e, _| e - (e - 0.6 * e.sin() - 20.0) / (1.0 - 0.6 * e.cos()));
        let exact = [anomaly.cos() - 0.6, 0.8 * anomaly.sin()];
        let found = reference.at(20.0).expect("the end");
        let error = (found.q[0] - exact[0]).abs().max((found.q[1] - exact[1]).abs());
        // Measured 1.4e-13; the runs estimate 3.0e-13.
        assert!(error < 2e-13 && error < agreement.floor(), "{error:e}, {agreement:?}");
    }
}
