//! The step law of the energy-preserving integrator.
//!
//! ```text
//! h D^(1/3) = constant + O(h²)      D of the step = D(t̄, q̄, v) + O(h²)          midpoint rule, no force
//! ```
//!
//! Left sides: D by the generated step density at the midpoint of each step, with the solved h. Right side: D from the
//! determinant of the equations.
//!
//! Tolerance: the rounding errors of the step lengths, `δh/h ≈ 4 ε S_E/(h² D) = 4 ε (τ/h)²`, and of both densities,
//! evaluated at the step (`length`, `rounded`), as the root mean square along the run. A deviation of `C (h/τ)²` is
//! therefore visible if `h > (4 ε/C)^(1/4) τ`, about 2e-4 τ for a C of 1.

use super::bounded::{Bounded, exact, once};
use super::comparison::Comparison;
use super::ladder::{Measured, PowerLaw};
use super::length;
use super::report::{CheckFailure, Report};
use super::sample::SampledMotion;
use super::subject::{EnergyChecked, Place, STEPS};
use crate::error::StepError;
use crate::method::EnergyPreserving;
use crate::node::Node;
use crate::stepping::EnergyStepping;
use alloc::borrow::ToOwned;
use alloc::vec::Vec;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Slope of a quantity that decreases with h².
const SLOPE: f64 = 2.0;
/// Longest step of a sequence, in steps of the trajectory.
const LONGEST: f64 = 4.0;
/// Largest ratio of step densities over the time of a sequence that is longer than the place's.
const EVEN: f64 = 8.0;

/// Tests the step law over a sequence of first steps. If every deviation is a rounding error the law holds exactly, as
/// for the harmonic oscillator.
///
/// # Errors
/// A deviation that does not decrease with h²; [`CheckFailure::NotApplicable`] for a system with a force;
/// [`CheckFailure::StepTooSmall`] for fewer than three deviations above rounding; a step that does not exist.
pub fn step_law<const N: usize, S: EnergyChecked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let check = Comparison::new(system.name(), "step law");
    if system.is_forced() {
        return Err(check.not_applicable("the law requires a system without a force"));
    }
    let motion = SampledMotion::from(system, place, &check)?;
    let density = density(system, &(place.t, place.q, place.v)).map_err(|error| check.step(error))?;
    if !density.is_seen() {
        return Err(check.vacuous(
            "the step density is zero, or below its rounding-error bound, at this place; choose another place",
        ));
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
    let law = PowerLaw { name: "the step law", quantities, slope: SLOPE, every: true };
    law.judge(&check, [place.h, LONGEST * motion.h], prepare, measure)
}

/// Whether the step density keeps its sign and size along the trajectory over the time of a sequence. Near a zero of
/// the density steps grow without bound, and nothing decreases with h².
fn is_even<const N: usize, S: EnergyChecked<N>>(system: &S, place: &Place<N>, h: f64) -> Result<bool, StepError> {
    let states = SampledMotion::over(system, place, h, u32::MAX)?.states;
    let densities = states.iter().map(|state| system.step_density(state.t, &state.q, &state.v));
    let densities = densities.collect::<Result<Vec<f64>, _>>()?;
    let mut ratios = densities.iter().filter_map(|density| densities.first().map(|first| density / first));
    Ok(ratios.all(|ratio| (1.0 / EVEN..EVEN).contains(&ratio)))
}

/// Relative deviations of h D^(1/3) and of D over a run, as the root of their mean square in time. Unlike the maximum,
/// it does not depend on the exact position of a step in a steep region.
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
        let solved = length::solved(system, &node.map(Bounded::nearest), step.h, &step.midpoint.2);
        let solved = solved.ok_or_else(|| check.step(singular(step.t)))?;
        let ratio = solved.density / here;
        let law = Measured {
            quantity: constant(step.h, here.value) / first - 1.0,
            rounding: solved.length + here.error / here.value.abs() / 3.0,
        };
        let density = Measured { quantity: ratio.value - 1.0, rounding: ratio.error };
        // The last step may end beyond the span; only its part inside counts.
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

/// The step density at the midpoint of a step, after one rounding of its arguments.
fn density<const N: usize, S: EnergyChecked<N>>(
    system: &S,
    (t, q, v): &(f64, SVector<f64, N>, SVector<f64, N>),
) -> Result<Bounded, StepError> {
    let bound = system.steps::<Bounded>().step_density(Bounded::nearest(*t), &once(q), &exact(v))?;
    Ok(bound.of(system.step_density(*t, q, v)?))
}
