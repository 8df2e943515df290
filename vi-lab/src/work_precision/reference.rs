//! The motion that errors are measured against.
//!
//! In: a system, a motion to start from, the time to reach. Out: a [`Reference`]: extrapolation of the modified midpoint rule
//! ([`Motion::at`]), a method that is not in the comparison, known at equidistant times and followed from there to any
//! other; and how far the most accurate runs of two methods of the comparison are from it at the end, which says how well
//! it is known.
//!
//! ```text
//! error = max_i max( |q_i − q_i^ref| / Q, |p_i − p_i^ref| / P )        Q, P: largest coordinate and momentum on the way
//! ```

use super::method::{Method, reached};
use super::rival::Ended;
use vi_core::check::Motion;
use vi_core::{Scheme, State, Stepping};

/// Parts of the time at whose ends the reference is stored.
const PARTS: u32 = 256;
/// Tolerance of the run of DOP853 that confirms the reference: its tightest.
pub(super) const TOLERANCE: f64 = 1e-14;

/// The motion that errors are measured against.
#[derive(Clone, Debug)]
pub(super) struct Reference<S, const N: usize> {
    system: S,
    track: Vec<Motion<N>>,
    scale: (f64, f64),
}

/// How far other accurate runs are from the reference at its end, as errors.
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
    /// Errors below this say nothing.
    pub(super) fn floor(&self) -> f64 {
        self.composed.max(self.rival)
    }
}

impl<S: Stepping<N>, const N: usize> Reference<S, N> {
    /// Follows the motion from `start` to `end`.
    ///
    /// # Errors
    /// That of a motion that cannot be followed.
    pub(super) fn new(system: S, start: &Motion<N>, end: f64) -> Result<Self, Ended> {
        let (mut track, mut scale) = (vec![*start], (0.0_f64, 0.0_f64));
        let mut last = *start;
        for part in 0..=PARTS {
            last = last.at(&system, start.t + (end - start.t) * f64::from(part) / f64::from(PARTS))?;
            let p = system.momentum(last.t, &last.q, &last.v);
            scale = (scale.0.max(last.q.amax()), scale.1.max(p.amax()));
            track.push(last);
        }
        Ok(Self { system, track, scale })
    }

    /// The motion at `t`, at the end or a little later too.
    ///
    /// # Errors
    /// That of a motion that cannot be followed.
    pub(super) fn at(&self, t: f64) -> Result<Motion<N>, Ended> {
        let later = self.track.partition_point(|motion| motion.t <= t);
        let before = self.track.get(later.saturating_sub(1)).ok_or(Ended::NonFinite)?;
        Ok(before.at(&self.system, t)?)
    }

    /// The error of a state, at its own time.
    ///
    /// # Errors
    /// As [`Reference::at`].
    pub(super) fn error(&self, state: &State<N>) -> Result<f64, Ended> {
        let Motion { t, q, v } = self.at(state.t)?;
        let p = self.system.momentum(t, &q, &v);
        Ok(((state.q - q).amax() / self.scale.0).max((state.p - p).amax() / self.scale.1))
    }

    /// How far Kahan and Li's composition with the step `h`, and DOP853, are from the reference at its end.
    ///
    /// # Errors
    /// What ended one of the runs.
    pub(super) fn agreement(&self, h: f64) -> Result<Agreement, Ended> {
        let (start, end) = (self.track.first().ok_or(Ended::NonFinite)?, self.track.last().ok_or(Ended::NonFinite)?);
        let distance = |method, setting| self.error(&reached(self.system, start, end.t, method, setting)?);
        let composed = distance(Method::Composed(Scheme::KAHAN_LI_8), h)?;
        Ok(Agreement { composed, h, rival: distance(Method::Rival, TOLERANCE)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vi_systems::{DampedOscillator, Kepler};

    #[test]
    fn the_reference_is_the_closed_form() {
        let start = Motion { t: 0.0, q: [1.0].into(), v: [0.0].into() };
        let system = DampedOscillator::default();
        let reference = Reference::new(&system, &start, 40.0).expect("a motion");
        let agreement = reference.agreement(0.02).expect("runs");
        let (decay, omega) = (0.02_f64, (4.0_f64 - 0.02 * 0.02).sqrt());
        let found = reference.at(40.0).expect("the end");
        let exact = (-decay * 40.0).exp() * ((omega * 40.0).cos() + decay / omega * (omega * 40.0).sin());
        // Measured 3.4e-14; what the runs say 3.7e-14.
        let error = (found.q[0] - exact).abs();
        assert!(error < 4e-14 && error < agreement.floor(), "{error:e}, {agreement:?}");

        let start = Motion { t: 0.0, q: [0.4, 0.0].into(), v: [0.0, 2.0].into() };
        let system = Kepler::default();
        let reference = Reference::new(&system, &start, 20.0).expect("a motion");
        let agreement = reference.agreement(0.01).expect("runs");
        // a = 1, e = 0.6: M = E − e sin E, x = cos E − e, y = √(1 − e²) sin E.
        let anomaly = (0..50).fold(20.0_f64, |e, _| e - (e - 0.6 * e.sin() - 20.0) / (1.0 - 0.6 * e.cos()));
        let exact = [anomaly.cos() - 0.6, 0.8 * anomaly.sin()];
        let found = reference.at(20.0).expect("the end");
        let error = (found.q[0] - exact[0]).abs().max((found.q[1] - exact[1]).abs());
        // Measured 1.4e-13; what the runs say 3.0e-13.
        assert!(error < 2e-13 && error < agreement.floor(), "{error:e}, {agreement:?}");
    }
}
