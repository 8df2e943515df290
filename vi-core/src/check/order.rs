//! The order of the rule.
//!
//! In: a place. The motion from there is taken by fixed steps h, h/2, … and, independently, followed accurately from
//! nothing but the acceleration. Out: the slope of log(error) over log(h).

use super::comparison::Comparison;
use super::ladder::{HALVINGS, Slope};
use super::report::{CheckFailure, Report};
use super::{Checked, Motion, Place, STEPS};
use crate::{FixedStep, State};

/// What a slope may differ from the order by: the next power of h has its part in it. Measured on the
/// ready systems: 2.6e-3.
const TOLERANCE: f64 = 0.1;
/// Errors below this, relative to the state, are those of rounding. Measured: 1e-14.
const PLATEAU: f64 = 1e-12;

/// The error of fixed steps falls with h to the power `order` or a higher one: 2 for the midpoint and the trapezoidal rule.
///
/// # Errors
/// A smaller slope; [`CheckFailure::Vacuous`] for less than three errors above rounding; a step that is not taken.
pub fn order<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>, order: u32) -> Result<Report, CheckFailure> {
    let check = Comparison::new(S::NAME, "order", TOLERANCE);
    let mut exact = vec![Motion { t: place.t, q: place.q, v: place.v }];
    for index in 1..=STEPS {
        let last = exact.last().copied().unwrap_or(Motion { t: place.t, q: place.q, v: place.v });
        let end = place.t + place.h * f64::from(index);
        exact.push(last.at(system, end).map_err(|error| check.step(error))?);
    }
    let size = exact.iter().map(|state| state.q.amax()).fold(0.0, f64::max);
    let mut points = Vec::new();
    for halvings in HALVINGS {
        let parts = 1_u32 << halvings;
        let h = place.h / f64::from(parts);
        let start = State::at(system, place.t, place.q, place.v);
        let mut run = FixedStep::new(system, start, h).map_err(|error| check.step(error))?;
        let mut worst = 0.0_f64;
        for state in exact.iter().skip(1) {
            for _ in 0..parts {
                run.step().map_err(|error| check.step(error))?;
            }
            worst = worst.max((run.state().q - state.q).amax());
        }
        points.push((h, worst));
    }
    let fit = Slope::fit(&points, PLATEAU * size, &check)?;
    let (wanted, what) = (f64::from(order), fit.describe("the error"));
    let difference = wanted - fit.slope;
    // Not a number is no slope either.
    if difference.is_nan() || difference > TOLERANCE {
        return Err(check.differs(what, fit.slope, wanted, difference, TOLERANCE));
    }
    Ok(check.fitted(fit.points.len(), what, difference.max(0.0), TOLERANCE))
}
