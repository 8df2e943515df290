//! Accurate reference trajectories, by extrapolation of the modified midpoint rule (Gragg, Bulirsch, Stoer): Hairer,
//! Nørsett, Wanner, Solving Ordinary Differential Equations I, section II.9.
//!
//! They use only the acceleration of the system.

use crate::error::Residuals;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use alloc::vec::Vec;
use nalgebra::SVector;

/// Rows of the extrapolation tableau.
const ROWS: u32 = 7;
/// Substeps of the rows; the last entry of the tableau is of order 14.
const SUBSTEPS: [u32; ROWS as usize] = [2, 4, 6, 8, 10, 12, 14];
/// Accepted difference of the last two columns, relative to the state; the last column is far more accurate.
const TOLERANCE: f64 = 1e-14;
/// A smaller difference that half a step does not reduce by [`FALL`] is rounding error, and the step is accepted.
const ROUNDING: f64 = 1e-8;
/// Expected reduction for half a step; without rounding it is some thousands.
const FALL: f64 = 16.0;
/// Shortest step before failure, as a fraction of the time span.
const SHORTEST: f64 = 1e-7;

/// A point of a trajectory: time, coordinates, velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trajectory<const N: usize> {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: SVector<f64, N>,
    /// Velocities.
    pub v: SVector<f64, N>,
}

/// Change of coordinates and velocities.
type Change<const N: usize> = (SVector<f64, N>, SVector<f64, N>);

impl<const N: usize> Trajectory<N> {
    /// The trajectory at the time `end`, later or earlier. With constraints it takes the system as
    /// [`Extended`](crate::constrained::Extended).
    ///
    /// # Errors
    /// The errors of the acceleration; [`StepError::NotConverged`] if the integration fails.
    pub fn at(self, system: &impl Lagrangian<N>, end: f64) -> Result<Self, StepError> {
        self.within(system, end, u32::MAX)
    }

    /// The same, with a limit of trial steps.
    pub(super) fn within(mut self, system: &impl Lagrangian<N>, end: f64, mut trials: u32) -> Result<Self, StepError> {
        let way = end - self.t;
        let mut h = way;
        let mut arrived = way == 0.0;
        // The difference of the previous trial step from the same state, of twice the length.
        let mut before = f64::INFINITY;
        while !arrived {
            let last = (end - self.t).abs() <= h.abs();
            let step = if last { end - self.t } else { h };
            // A trial step that is too long may end anywhere, even at a state without acceleration.
            let trial = self.extrapolated(system, step);
            if let Err(failure @ StepError::InconsistentStart { .. }) = trial {
                return Err(failure);
            }
            let error = trial.as_ref().map_or(f64::NAN, |(_, error)| *error);
            let is_accurate = error <= TOLERANCE || error <= ROUNDING && error * FALL >= before;
            let goes_on = trials > 0 && (is_accurate || h.abs() > SHORTEST * way.abs());
            trials = trials.saturating_sub(1);
            match trial {
                Ok((change, _)) if goes_on && is_accurate => {
                    self =
                        Self { t: if last { end } else { self.t + step }, q: self.q + change.0, v: self.v + change.1 };
                    (arrived, before) = (last, f64::INFINITY);
                    h *= 1.25;
                }
                _ if goes_on => (h, before) = (step / 2.0, error),
                Ok((_, error)) => {
                    let (residual, residuals) = (error / f64::EPSILON, Residuals::new());
                    return Err(StepError::NotConverged {
                        t: self.t,
                        h,
                        iterations: ROWS,
                        residual,
                        residuals,
                        turn: 0.0,
                    });
                }
                Err(error) => return Err(error),
            }
        }
        Ok(self)
    }

    /// A vector's `error` relative to the vector and its change.
    fn relative(error: &SVector<f64, N>, vector: &SVector<f64, N>, change: &SVector<f64, N>) -> f64 {
        let size = vector.amax().max(change.amax());
        if error.amax() == 0.0 { 0.0 } else { error.amax() / size }
    }

    /// The change over one step, and the difference of the last two columns, relative to coordinates and velocities.
    fn extrapolated(&self, system: &impl Lagrangian<N>, h: f64) -> Result<(Change<N>, f64), StepError> {
        let mut row: Vec<Change<N>> = Vec::new();
        let mut error = f64::NAN;
        for (j, n) in SUBSTEPS.into_iter().enumerate() {
            let mut entry = self.modified_midpoint(system, h, n)?;
            for (above, before) in row.iter_mut().zip(SUBSTEPS[..j].iter().rev()) {
                // Aitken and Neville, in h²: two neighbouring entries cancel one more power.
                let ratio = f64::from(n) / f64::from(*before);
                let gain = 1.0 / (ratio * ratio - 1.0);
                let better = (entry.0 + (entry.0 - above.0) * gain, entry.1 + (entry.1 - above.1) * gain);
                let error_q = Self::relative(&(better.0 - entry.0), &self.q, &better.0);
                error = error_q.max(Self::relative(&(better.1 - entry.1), &self.v, &better.1));
                *above = entry;
                entry = better;
            }
            row.push(entry);
        }
        let best = row.pop().unwrap_or((self.q * f64::NAN, self.v * f64::NAN));
        let finite = best.0.iter().chain(best.1.iter()).all(|entry| entry.is_finite());
        Ok((best, if finite { error } else { f64::NAN }))
    }

    /// Change over `h` by the modified midpoint rule with `n` substeps, without the rounding error of the starting
    /// value.
    fn modified_midpoint(&self, system: &impl Lagrangian<N>, h: f64, n: u32) -> Result<Change<N>, StepError> {
        let part = h / f64::from(n);
        let rate = |index: u32, (y, w): &Change<N>| {
            let (q, v) = (self.q + y, self.v + w);
            system.acceleration(self.t + part * f64::from(index), &q, &v).map(|a| (v, a))
        };
        let mut before = (SVector::zeros(), SVector::zeros());
        let (v, a) = rate(0, &before)?;
        let mut now = (v * part, a * part);
        for index in 1..n {
            let (v, a) = rate(index, &now)?;
            (before, now) = (now, (before.0 + v * (2.0 * part), before.1 + a * (2.0 * part)));
        }
        Ok(now)
    }
}
