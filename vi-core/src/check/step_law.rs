//! How long the energy-preserving integrator makes its steps.
//!
//! ```text
//! h D^(1/3) = constant + O(h²)      D of the step = D(t̄, q̄, v) + O(h²)          midpoint rule, no force
//! ```
//!
//! Left: D by the generated step density at the middle of each step, h as it was solved for. Right: D from the determinant of
//! the equations.

use super::comparison::Comparison;
use super::ladder::{HALVINGS, Slope};
use super::report::{CheckFailure, Report};
use super::{Checked, Place, STEPS};
use crate::EnergyPreserving;

/// Slope of what falls with h².
const SLOPE: f64 = 2.0;
/// What a slope may be less than that by. Measured on the ready systems: 2.6e-3.
const TOLERANCE: f64 = 0.1;
/// Deviations below this are those of rounding: the length of a step is a quantity of second order. Measured on the
/// harmonic oscillator, where there is no other: 6e-11.
const PLATEAU: f64 = 1e-9;

/// The step law, over a ladder of first steps. Where every deviation is one of rounding the law holds exactly, as for the
/// harmonic oscillator.
///
/// # Errors
/// A deviation that does not fall with h²; [`CheckFailure::NotApplicable`] for a system with a force;
/// [`CheckFailure::Vacuous`] for one or two deviations above rounding; a step that does not exist.
pub fn step_law<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let check = Comparison::new(S::NAME, "step law", TOLERANCE);
    if S::FORCED {
        return Err(check.not_applicable("the law is one of systems without a force"));
    }
    let (mut law, mut density) = (Vec::new(), Vec::new());
    for halvings in HALVINGS {
        let h0 = place.h / f64::from(1_u32 << halvings);
        let deviation = deviations(system, place, h0, &check)?;
        law.push((h0, deviation.law));
        density.push((h0, deviation.density));
    }
    let (mut compared, mut what, mut worst) = (law.len(), "h D^(1/3), constant to rounding".to_owned(), 0.0);
    for (name, points) in [("the deviation of h D^(1/3)", &law), ("the deviation of D", &density)] {
        if points.iter().all(|(_, deviation)| *deviation <= PLATEAU) {
            continue;
        }
        let fit = Slope::fit(points, PLATEAU, &check)?;
        let difference = SLOPE - fit.slope;
        // Not a number is no slope either.
        if difference.is_nan() || difference > TOLERANCE {
            return Err(check.differs(fit.describe(name), fit.slope, SLOPE, difference, TOLERANCE));
        }
        if difference >= worst {
            (compared, what, worst) = (fit.points.len(), fit.describe(name), difference);
        }
    }
    Ok(check.fitted(compared, what, worst, TOLERANCE))
}

/// Relative deviations over a run, as the root of their mean square in time: unlike the largest one it does not depend on
/// where in a steep place a step happens to lie.
struct Deviations {
    law: f64,
    density: f64,
}

fn deviations<const N: usize, S: Checked<N>>(
    system: &S,
    place: &Place<N>,
    h0: f64,
    check: &Comparison,
) -> Result<Deviations, CheckFailure> {
    let Place { t, q, v, h } = *place;
    let density = |(t, q, v): (f64, _, _)| system.step_density(t, &q, &v).map_err(|error| check.step(error));
    let constant = |h: f64, density: f64| h * density.abs().cbrt();
    let first = constant(h0, density((t, q, v))?);
    if first == 0.0 {
        return Err(check.vacuous("the step density is zero at this place; choose another"));
    }
    let mut run = EnergyPreserving::from_midpoint(system, t, q, v, h0).map_err(|error| check.step(error))?;
    let mut squares = Deviations { law: 0.0, density: 0.0 };
    let span = h * f64::from(STEPS);
    let mut passed = 0.0;
    while passed < span {
        let step = run.step().map_err(|error| check.step(error))?;
        let here = density(step.midpoint)?;
        // The last step may end beyond the span: it counts as far as it lies inside.
        let part = step.h.min(span - passed);
        squares.law += (constant(step.h, here) / first - 1.0).powi(2) * part;
        squares.density += (step.density / here - 1.0).powi(2) * part;
        passed += part;
    }
    Ok(Deviations { law: (squares.law / span).sqrt(), density: (squares.density / span).sqrt() })
}
