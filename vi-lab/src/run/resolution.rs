//! Checks that a step is neither too small nor too large for double precision.
//!
//! In: a [`Request`]. Out: nothing, or [`Failure::Input`] with the numbers. If both checks pass, h² is a normal number.
//! A step changes t at the start, and for fixed steps at the end too. The first step changes the state, or the system
//! is at rest.

use super::request::{Length, Request};
use vi_erased::plan::Plan;
use vi_report::failure::Failure;
use vi_report::numbers::{about, short};

/// Checks the step by itself and with respect to the times of the run.
pub(super) fn check_times(plan: &Plan, length: Length) -> Result<(), Failure> {
    square(plan.h)?;
    time(plan.t, plan.h)?;
    if plan.finds_length() { Ok(()) } else { time(length.end(plan), plan.h) }
}

/// The equations of a step contain h².
fn square(h: f64) -> Result<(), Failure> {
    if (h * h).is_normal() {
        return Ok(());
    }
    let smallest = f64::MIN_POSITIVE.sqrt();
    let largest = f64::MAX.sqrt();
    Err(Failure::Input(format!(
        "the step (--h) {} is out of range: its square is not a normal number in double precision; use a step from {} to {}",
        short(h),
        about(smallest),
        about(largest)
    )))
}

/// A step below the spacing of numbers near t would change t by too much, or not at all.
fn time(t: f64, h: f64) -> Result<(), Failure> {
    let spacing = t.abs().next_up() - t.abs();
    if h.abs() >= spacing {
        return Ok(());
    }
    Err(Failure::Input(format!(
        "a step of h = {} is below rounding at t = {}, where double-precision numbers are {} apart; use a larger --h, or times \
         closer to zero",
        short(h),
        short(t),
        about(spacing)
    )))
}

/// Checks the step with a trial: it must change q or p by more than their rounding, unless the system is at rest.
pub(super) fn check_state(Request { system, plan, .. }: &Request) -> Result<(), Failure> {
    // The run itself reports a failed start or a failed first step.
    let Ok(mut trial) = system.begin(plan) else { return Ok(()) };
    let before = trial.row();
    let is_at_rest = plan.v.iter().all(|v| *v == 0.0);
    if is_at_rest || trial.advance().is_err() {
        return Ok(());
    }
    let after = trial.row();
    if !(is_same(&before.q, &after.q) && is_same(&before.p, &after.p)) {
        return Ok(());
    }
    let Plan { h, v, .. } = plan;
    Err(Failure::Input(format!(
        "the first step of h = {} changes neither q = {:?} nor p = {:?} in double precision, although v = {v:?}; use a \
         larger --h, or a start and parameters with a regular mass matrix",
        short(*h),
        before.q,
        before.p
    )))
}

/// Whether two vectors differ by less than a rounding of the largest entry.
fn is_same(before: &[f64], after: &[f64]) -> bool {
    let largest = before.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    before.iter().zip(after).all(|(one, other)| (one - other).abs() <= f64::EPSILON / 2.0 * largest)
}
