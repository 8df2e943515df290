//! The length of a step: a number, or the search for one from a tolerance.
//!
//! In: a start and a method. Out: the constant length whose largest error over the first stretch ([`ErrorMonitor`]) is
//! the tolerance. Each trial takes the steps of that stretch; the error of a method of order p grows by `h^(p+1)`. The
//! first trial has the length `τ ε^(1/(p+1))` for the tolerance ε and a time scale τ of the start.

use super::Start;
use super::estimate::ErrorMonitor;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::{Facts, Method};
use crate::real::Scalar;
use core::f64::consts::PI;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// A tolerance instead of a step length: `start.integrate(method, Tolerance(1e-9))`.
///
/// The run then has a constant step. Its largest relative error over the first stretch is at most the tolerance, and a
/// length that is longer by a third would exceed it. If steps stop existing before the tolerance is reached, the run
/// uses half of the longest length that exists. The stretch lasts until the coordinates have turned back twice or more,
/// at most 4096 steps, or 1024/p steps of order p if their lengths follow the forces. A symplectic method keeps its step.
/// A motion that becomes faster later exceeds the tolerance, and [`Run::monitored`] reports it. The global error is
/// larger: about the tolerance times the number of steps, or more.
///
/// [`Run::monitored`]: crate::Run::monitored
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance(pub f64);

/// A step length: a number, or a [`Tolerance`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a step length of a system in `{T}`",
    label = "write a step length such as `0.1`, or `Tolerance(1e-9)`"
)]
pub trait Length<T: Scalar> {
    /// The tolerance of the errors of steps; `None` for a given length.
    fn tolerance(&self) -> Option<f64> {
        None
    }

    /// The step length of a run from a start by a method.
    ///
    /// # Errors
    /// [`StepError::Tolerance`] if no length meets the tolerance, or if nothing moves, with an estimate of zero;
    /// [`StepError::InvalidInput`] for a tolerance below a rounding (2.2e-16 in `f64`) or not below 1; the error of the
    /// shortest steps tried.
    fn length<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize>(
        self,
        start: &Start<S, N, T>,
        method: &M,
    ) -> Result<T, StepError>;
}

impl<T: Scalar> Length<T> for T {
    #[inline]
    fn length<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize>(
        self,
        _start: &Start<S, N, T>,
        _method: &M,
    ) -> Result<T, StepError> {
        Ok(self)
    }
}

/// Most trial lengths.
const TRIALS: u32 = 60;
/// Largest factor between two trial lengths.
const FACTOR: f64 = 8.0;
/// The error target of a trial, relative to the tolerance.
const AIM: f64 = 0.7;
/// A length is accepted if that of the target is at most this factor longer.
const NEARLY: f64 = 1.15;
/// Shortest step that is tried while none exists, and longest step, in units of the time scale of the start.
const SHORTEST: f64 = 1e-10;
const LONGEST: f64 = 1e3;
/// Most steps of a trial whose lengths follow the forces, times half the order. Their errors are alike.
const FOLLOWING: u64 = 512;
/// Consecutive shorter trials without a smaller error, after which rounding dominates.
const STALLED: u32 = 3;

/// Rejects a tolerance that no step keeps.
///
/// # Errors
/// [`StepError::InvalidInput`].
#[doc(hidden)]
pub fn check_tolerance<T: Scalar>(tolerance: f64) -> Result<(), StepError> {
    if tolerance >= T::EPSILON && tolerance < 1.0 {
        return Ok(());
    }
    Err(StepError::InvalidInput { input: "the tolerance", allowed: "between an ulp and 1", value: tolerance })
}

impl<T: Scalar> Length<T> for Tolerance {
    fn tolerance(&self) -> Option<f64> {
        Some(self.0)
    }

    fn length<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize>(
        self,
        start: &Start<S, N, T>,
        method: &M,
    ) -> Result<T, StepError> {
        let Self(tolerance) = self;
        check_tolerance::<T>(tolerance)?;
        let method = &method.with_tolerance(tolerance);
        let exponent = 1.0 / f64::from(method.facts().order + 1);
        let scale = time_scale(start)?;
        let mut h = scale * tolerance.powf(exponent);
        // The longest accepted length, and the shortest rejected one.
        let (mut low, mut high) = (0.0_f64, f64::INFINITY);
        let mut least = f64::INFINITY;
        let mut stalled = 0;
        let mut failure = None;
        // Whether steps of the length `high` do not exist, so that no length has an error near the tolerance.
        let mut is_edge = false;
        for _ in 0..TRIALS {
            let outcome = over_stretch(start, method, T::real(h), tolerance);
            let estimate = match outcome {
                Ok(Some(estimate)) => estimate,
                Ok(None) => {
                    return Err(StepError::Tolerance { t: start.state.t.to_f64(), estimate: 0.0, tolerance });
                }
                Err(error) => {
                    // The error of the longest steps: the user does not know the shorter lengths of the search.
                    failure.get_or_insert(error);
                    f64::INFINITY
                }
            };
            let factor = (AIM * tolerance / estimate).powf(exponent).clamp(1.0 / FACTOR, FACTOR);
            if estimate <= tolerance {
                low = low.max(h);
                if factor <= NEARLY || estimate == 0.0 || h >= LONGEST * scale {
                    return Ok(T::real(h));
                }
            } else {
                if h < high {
                    (high, is_edge) = (h, estimate.is_infinite());
                }
                // Below this, rounding dominates the error of every method.
                let is_rounding = estimate < T::EPSILON.sqrt() && estimate > 0.7 * least;
                stalled = if is_rounding { stalled + 1 } else { 0 };
                if stalled >= STALLED && low == 0.0 {
                    break;
                }
            }
            least = least.min(estimate);
            if least.is_infinite() && h < SHORTEST * scale {
                break;
            }
            if low > 0.0 && high < NEARLY * low {
                break;
            }
            let next = h * factor;
            h = if next > low && next < high { next } else { bisected(low, high) };
        }
        if low > 0.0 {
            return Ok(T::real(if is_edge { 0.5 * low } else { low }));
        }
        match failure {
            Some(error) if least.is_infinite() => Err(error),
            _ => Err(StepError::Tolerance { t: start.state.t.to_f64(), estimate: least, tolerance }),
        }
    }
}

/// A length between two lengths.
fn bisected(low: f64, high: f64) -> f64 {
    if low == 0.0 {
        high / FACTOR
    } else if high.is_infinite() {
        low * FACTOR
    } else {
        (low * high).sqrt()
    }
}

/// The largest relative error over the first stretch with steps of the length h; `None` if nothing moves.
///
/// # Errors
/// The reason why a step fails.
fn over_stretch<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    start: &Start<S, N, T>,
    method: &M,
    h: T,
    tolerance: f64,
) -> Result<Option<f64>, StepError> {
    let mut run = start.integrate(method.clone(), h)?;
    let mut monitor = ErrorMonitor::of_steps(&run);
    let Facts { order, follows_forces, .. } = method.facts();
    let most = if follows_forces { FOLLOWING / u64::from(order / 2).max(1) } else { u64::MAX };
    while !monitor.is_over() && monitor.steps < most {
        match run.single_step() {
            Ok(_) => monitor.watch(&run),
            // No step of any length leads past this place: the steps up to it count.
            Err(failure) if ends_motion(&failure) && monitor.steps > 0 => break,
            Err(failure) => return Err(failure),
        }
    }
    let found = monitor.largest(&run);
    Ok(monitor.has_motion(tolerance).then_some(found.estimate))
}

/// Whether a method has no step past some place, of any length.
fn ends_motion(failure: &StepError) -> bool {
    matches!(
        failure,
        StepError::NoForwardStep { .. }
            | StepError::NoForwardGaussStep { .. }
            | StepError::DegenerateStep { .. }
            | StepError::StepRatio { .. }
    )
}

/// The shortest time scale of a coordinate: the longest of `|q|/|v|`, `|v|/|a|` and `√(|q|/|a|)`.
///
/// # Errors
/// The errors of a velocity without a solution.
fn time_scale<S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(start: &Start<S, N, T>) -> Result<f64, StepError> {
    let Start { system, state } = start;
    let v = state.velocity(system)?;
    let a = system.acceleration(state.t, &state.q, &v)?;
    let mut shortest = f64::INFINITY;
    for i in 0..N {
        let [q, v, a] = [state.q[i], v[i], a[i]].map(|entry| entry.to_f64().abs());
        // Whole turns of an angle do not count as its size.
        let q = if system.spaces()[i].is_angle() { q.min(PI) } else { q };
        let scales = [q / v, v / a, (q / a).sqrt()];
        let scale = scales.into_iter().filter(|scale| scale.is_normal()).fold(0.0, f64::max);
        if scale > 0.0 {
            shortest = shortest.min(scale);
        }
    }
    Ok(if shortest.is_finite() { shortest } else { 1.0 })
}
