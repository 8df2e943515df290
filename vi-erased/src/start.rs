//! Accurate motion over a short time: the start of the paper needs the second node of the exact solution.
//!
//! In: a system and an initial state. Out: coordinates at a later time, by the classical Runge–Kutta method of order 4
//! for the deviation from the start, which keeps digits that a sum with q0 would lose.

use vi_core::{Lagrangian, SVector, StepError};

/// Substeps for the second node: with h0 = 0.1 the error for a motion of unit scale is below 1e-16.
const SUBSTEPS: u32 = 1024;

/// The point that the motion reaches at `t0 + h0`.
///
/// # Errors
/// [`StepError::Singular`] if the mass matrix cannot be inverted.
pub fn second_point<S: Lagrangian<N>, const N: usize>(
    system: &S,
    t0: f64,
    q0: SVector<f64, N>,
    v0: SVector<f64, N>,
    h0: f64,
) -> Result<(f64, SVector<f64, N>), StepError> {
    let (deviation, _) = motion(system, t0, q0, v0, h0, SUBSTEPS)?;
    Ok((t0 + h0, q0 + deviation))
}

/// Deviation from `q0`, and velocity, after the time `duration`.
///
/// # Errors
/// [`StepError::Singular`] if the mass matrix cannot be inverted.
pub fn motion<S: Lagrangian<N>, const N: usize>(
    system: &S,
    t0: f64,
    q0: SVector<f64, N>,
    v0: SVector<f64, N>,
    duration: f64,
    substeps: u32,
) -> Result<(SVector<f64, N>, SVector<f64, N>), StepError> {
    let h = duration / f64::from(substeps);
    let slope = |t: f64, y: &SVector<f64, N>, v: &SVector<f64, N>| system.acceleration(t, &(q0 + y), v);
    let mut y = SVector::zeros();
    let mut v = v0;
    for index in 0..substeps {
        let t = t0 + h * f64::from(index);
        let a1 = slope(t, &y, &v)?;
        let y2 = y + v * (h / 2.0);
        let v2 = v + a1 * (h / 2.0);
        let a2 = slope(t + h / 2.0, &y2, &v2)?;
        let y3 = y + v2 * (h / 2.0);
        let v3 = v + a2 * (h / 2.0);
        let a3 = slope(t + h / 2.0, &y3, &v3)?;
        let y4 = y + v3 * h;
        let v4 = v + a3 * h;
        let a4 = slope(t + h, &y4, &v4)?;
        y += (v + (v2 + v3) * 2.0 + v4) * (h / 6.0);
        v += (a1 + (a2 + a3) * 2.0 + a4) * (h / 6.0);
    }
    Ok((y, v))
}
