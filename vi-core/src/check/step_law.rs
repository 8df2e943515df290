//! How long the energy-preserving integrator makes its steps.
//!
//! ```text
//! h D^(1/3) = constant + O(h²)      D of the step = D(t̄, q̄, v) + O(h²)          midpoint rule, no force
//! ```
//!
//! Left: D by the generated step density at the middle of each step, h as it was solved for. Right: D from the determinant of
//! the equations.
//!
//! Rounding: of the length of each step `δh/h ≈ 4 ε S_E/(h² D) = 4 ε (τ/h)²`, and of the two densities what their terms carry,
//! both evaluated at the step (`length`, `rounded`), as the root of the mean square along the run. So a deviation of `C (h/τ)²` is
//! seen where `h > (4 ε/C)^(1/4) τ`, about 2e-4 τ for a C of 1.

use super::bounded::{Bounded, exact, once};
use super::comparison::Comparison;
use super::ladder::{Law, Measured};
use super::length;
use super::report::{CheckFailure, Report};
use super::sample::Course;
use super::subject::{EnergyChecked, Place, STEPS};
use crate::error::StepError;
use crate::method::EnergyPreserving;
use crate::node::Node;
use crate::stepping::EnergyStepping;
use nalgebra::SVector;

/// Slope of what falls with h².
const SLOPE: f64 = 2.0;
/// Up to so many steps of the course a ladder is climbed.
const LONGEST: f64 = 4.0;
/// Factor by which the step density may change over the time of a ladder that is longer than the place's.
const EVEN: f64 = 8.0;

/// The step law, over a ladder of first steps. Where every deviation is one of rounding the law holds exactly, as for the
/// harmonic oscillator.
///
/// # Errors
/// A deviation that does not fall with h²; [`CheckFailure::NotApplicable`] for a system with a force;
/// [`CheckFailure::StepTooSmall`] for less than three deviations above rounding; a step that does not exist.
pub fn step_law<const N: usize, S: EnergyChecked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let check = Comparison::new(S::NAME, "step law");
    if S::FORCED {
        return Err(check.not_applicable("the law is one of systems without a force"));
    }
    let course = Course::from(system, place, &check)?;
    let density = density(system, &(place.t, place.q, place.v)).map_err(|error| check.step(error))?;
    if !density.is_seen() {
        return Err(check.vacuous("the step density is zero at this place; choose another"));
    }
    let prepare = |h: f64| {
        if h > place.h && !is_even(system, place, h).map_err(|error| check.step(error))? {
            return Err(check.vacuous("the step density changes too much"));
        }
        Ok(h)
    };
    let measure = |h: &f64, halvings: u32| {
        let (h0, span) = (h / f64::from(1_u32 << halvings), h * f64::from(STEPS));
        let rounding = length::at_start(system, place, h0);
        let hidden = || vec![Measured { quantity: 0.0, rounding: f64::INFINITY }; 2];
        if rounding > length::COARSE {
            return Ok(hidden());
        }
        match deviations(system, place, [h0, span], &check) {
            Err(CheckFailure::Step { .. }) if rounding > length::FINE => Ok(hidden()),
            result => result,
        }
    };
    let quantities = ["the deviation of h D^(1/3)", "the deviation of D"].map(str::to_owned).to_vec();
    let law = Law { name: "the step law", quantities, slope: SLOPE, every: true };
    law.judge(&check, [place.h, LONGEST * course.h], prepare, measure)
}

/// Whether the step density keeps its sign and size along the motion over the time of a ladder: where it comes near zero
/// steps grow without bound, and nothing falls with h².
fn is_even<const N: usize, S: EnergyChecked<N>>(system: &S, place: &Place<N>, h: f64) -> Result<bool, StepError> {
    let states = Course::over(system, place, h, u32::MAX)?.states;
    let densities = states.iter().map(|state| system.step_density(state.t, &state.q, &state.v));
    let densities = densities.collect::<Result<Vec<f64>, _>>()?;
    let mut ratios = densities.iter().filter_map(|density| densities.first().map(|first| density / first));
    Ok(ratios.all(|ratio| (1.0 / EVEN..EVEN).contains(&ratio)))
}

/// Relative deviations of h D^(1/3) and of D over a run, as the root of their mean square in time: unlike the largest one
/// it does not depend on where in a steep place a step happens to lie.
fn deviations<const N: usize, S: EnergyChecked<N>>(
    system: &S,
    place: &Place<N>,
    [h0, span]: [f64; 2],
    check: &Comparison,
) -> Result<Vec<Measured>, CheckFailure> {
    let Place { t, q, v, .. } = *place;
    let constant = |h: f64, density: f64| h * density.abs().cbrt();
    let first = constant(h0, system.step_density(t, &q, &v).map_err(|error| check.step(error))?);
    let mut run = EnergyPreserving::from_midpoint(system, t, q, v, h0).map_err(|error| check.step(error))?;
    let mut squares = [Measured { quantity: 0.0, rounding: 0.0 }; 2];
    let mut passed = 0.0;
    while passed < span {
        let node = Node::new(run.state(), run.node().energy);
        run.step().map_err(|error| check.step(error))?;
        let step = run.last_step();
        let here = density(system, &step.midpoint).map_err(|error| check.step(error))?;
        let solved = length::solved(system, &node.map(Bounded::once), step.h, &step.midpoint.2);
        let solved = solved.ok_or_else(|| check.step(singular(step.t)))?;
        let ratio = solved.density / here;
        let law = Measured {
            quantity: constant(step.h, here.value) / first - 1.0,
            rounding: solved.length + here.error / here.value.abs() / 3.0,
        };
        let density = Measured { quantity: ratio.value - 1.0, rounding: ratio.error };
        // The last step may end beyond the span: it counts as far as it lies inside.
        let part = step.h.min(span - passed) / span;
        for (square, measured) in squares.iter_mut().zip([law, density]) {
            square.quantity += measured.quantity.powi(2) * part;
            square.rounding += measured.rounding.powi(2) * part;
        }
        passed += step.h;
    }
    let root = |square: Measured| Measured { quantity: square.quantity.sqrt(), rounding: square.rounding.sqrt() };
    Ok(squares.map(root).to_vec())
}

fn singular(t: f64) -> StepError {
    StepError::Singular { t, matrix: "derivative of the momentum equation" }
}

/// The step density in the middle of a step, which is known to one rounding.
fn density<const N: usize, S: EnergyChecked<N>>(
    system: &S,
    (t, q, v): &(f64, SVector<f64, N>, SVector<f64, N>),
) -> Result<Bounded, StepError> {
    let bound = system.steps::<Bounded>().step_density(Bounded::once(*t), &once(q), &exact(v))?;
    Ok(bound.of(system.step_density(*t, q, v)?))
}
