//! The oscillator of the study: its exact motion, and its runs.

use super::H0;
use vi_core::{EnergyPreserving, FixedStep, Run, SVector, Starts, StepError};
use vi_systems::DampedOscillator;

/// Natural frequency √(k/m).
pub(super) const OMEGA: f64 = 2.0;

/// A node of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// Time.
    pub(super) t: f64,
    /// Coordinate.
    pub(super) q: f64,
    /// Discrete energy.
    pub(super) energy: f64,
    /// Length of the step that led here.
    pub(super) h: f64,
}

/// A run and its ending.
#[derive(Clone, Debug)]
pub(super) struct Sampled {
    /// The nodes.
    pub(super) samples: Vec<Sample>,
    /// The error that ended it; `None` if it reached its end.
    pub(super) end: Option<StepError>,
}

/// The system with damping ratio ζ: `c = 2 ζ ω m`.
pub(super) fn system(zeta: f64) -> DampedOscillator {
    DampedOscillator { m: 1.0, k: OMEGA * OMEGA, c: 2.0 * zeta * OMEGA }
}

/// Coordinate and velocity of the exact motion from `(1, 0)`.
pub(super) fn exact(zeta: f64, t: f64) -> (f64, f64) {
    let damped = OMEGA * (1.0 - zeta * zeta).sqrt();
    let decay = (-zeta * OMEGA * t).exp();
    let (sin, cos) = (damped * t).sin_cos();
    (decay * (cos + zeta * OMEGA / damped * sin), -decay * OMEGA * OMEGA / damped * sin)
}

/// Energy of the exact motion.
pub(super) fn exact_energy(zeta: f64, t: f64) -> f64 {
    let (q, v) = exact(zeta, t);
    0.5 * (v * v + OMEGA * OMEGA * q * q)
}

/// The paper's start: the first interval ends in the exact motion.
pub(super) fn start(zeta: f64) -> Result<Run<EnergyPreserving, DampedOscillator, 1>, StepError> {
    let second = (H0, SVector::from([exact(zeta, H0).0]));
    EnergyPreserving::from_points(system(zeta), (0.0, SVector::from([1.0])), second)
}

/// The first node of both runs: the end of the first interval.
fn first(run: &Run<EnergyPreserving, DampedOscillator, 1>) -> Sample {
    let state = run.state();
    Sample { t: state.t, q: state.q.x, energy: run.node().energy, h: H0 }
}

/// The energy-preserving run until a time is passed, the steps are used up, or a step fails.
pub(super) fn energy_preserving(zeta: f64, until: f64, most: u32) -> Result<Sampled, StepError> {
    let mut integrator = start(zeta)?;
    let mut samples = vec![first(&integrator)];
    for step in integrator.detailed_steps().take(usize::try_from(most).unwrap_or(usize::MAX)) {
        match step {
            Ok(step) => {
                samples.push(Sample { t: step.t, q: step.q.x, energy: step.energy, h: step.h });
            }
            Err(error) => return Ok(Sampled { samples, end: Some(error) }),
        }
        if samples.last().is_some_and(|sample| sample.t > until) {
            break;
        }
    }
    Ok(Sampled { samples, end: None })
}

/// The fixed-step run from the same first interval.
pub(super) fn fixed(zeta: f64, until: f64) -> Result<Sampled, StepError> {
    let start = start(zeta)?;
    let mut samples = vec![first(&start)];
    let mut integrator = system(zeta).at_state(start.state()).integrate(FixedStep, H0)?;
    while integrator.state().t <= until {
        let state = integrator.step()?;
        let energy = integrator.discrete_energy().unwrap_or(f64::NAN);
        samples.push(Sample { t: state.t, q: state.q.x, energy, h: H0 });
    }
    Ok(Sampled { samples, end: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exact_motion_satisfies_the_equation() {
        for zeta in [0.001, 0.01, -0.01] {
            let h = 1e-3;
            let t = 3.7;
            let [(before, _), (q, v), (after, _)] = [t - h, t, t + h].map(|t| exact(zeta, t));
            let acceleration = (after - 2.0 * q + before) / (h * h);
            let residual = acceleration + 2.0 * zeta * OMEGA * v + OMEGA * OMEGA * q;
            // Measured 6.7e-7 and, for the velocity, 1.3e-6: the errors h²/12 and h²/6 of the differences.
            assert!(residual.abs() < 1e-6, "ζ = {zeta}: {residual}");
            assert!(((after - before) / (2.0 * h) - v).abs() < 2e-6, "ζ = {zeta}");
        }
    }
}
