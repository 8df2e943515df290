//! Gauss steps of a system: order, momenta of cyclic coordinates, symplectic form.
//!
//! These checks need no rule. Order and momenta are tested on steps with [`STAGES`] stages. The symplectic form is that
//! of the step with one stage, as a function of its start and of the stage velocity. No equation is solved:
//!
//! ```text
//! p0 = L_v − (h/2) (L_q + f)      q1 = q0 + h v      p1 = L_v + (h/2) (L_q + f)      at t0 + h/2, q0 + (h/2) v, v
//! ```
//!
//! Tolerance: as in `order` and `symplecticity`. A Gauss step is reversible for any functions of a system, so that
//! there is no such check.

use super::bounded::Bounded;
use super::comparison::Comparison;
use super::derivatives::First;
use super::order;
use super::report::{CheckFailure, Report};
use super::sample::{Sample, samples};
use super::subject::{MotionChecked, Place};
use super::symmetries::{self, Column};
use crate::called::Called;
use crate::collocation::{Collocation, Point};
use crate::method::Gauss;
use crate::real::Dual;
use crate::run::Starts;
use nalgebra::SVector;

/// Stages of the tested steps.
const STAGES: usize = 2;
/// Their order.
const ORDER: u32 = 4;

/// Tests that the error of Gauss steps with two stages decreases with h⁴ or a higher power.
///
/// # Errors
/// As [`order`](super::order()).
pub fn gauss_order<const N: usize, S: MotionChecked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let check = Comparison::new(S::NAME, "gauss order");
    order::judged(&check, system, place, ORDER, |start, h| {
        Called(*system).at_state(start).integrate(Gauss::<STAGES>, h)
    })
}

/// Tests that momenta of cyclic coordinates are constant bit for bit over Gauss steps, and that no force acts on them
/// at any point.
///
/// # Errors
/// As [`momenta`](super::momenta).
pub fn gauss_momenta<const N: usize, S: MotionChecked<N>>(
    system: &S,
    place: &Place<N>,
) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "gauss momenta");
    symmetries::kept(&mut check, system, place, |start, h| {
        Called(*system).at_state(start).integrate(Gauss::<STAGES>, h)
    })?;
    for sample in samples(system, place, &check)? {
        let force = sample.system.point(sample.t, &sample.q, &sample.v).force;
        for index in (0..N).filter(|index| S::CYCLIC[*index]) {
            check.number(S::COORDINATES[index], Bounded::exact(force[index]), Bounded::exact(0.0))?;
        }
    }
    check.finish(&[])
}

/// Tests that Gauss steps preserve the symplectic form.
///
/// # Errors
/// An entry that differs; [`CheckFailure::NotApplicable`] for a system with a force; [`CheckFailure::Vacuous`] if
/// nothing moves.
pub fn gauss_symplecticity<const N: usize, S: MotionChecked<N>>(
    system: &S,
    place: &Place<N>,
) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "gauss symplecticity");
    if S::FORCED {
        return Err(check.not_applicable("a system with a force does not preserve the symplectic form"));
    }
    for sample in samples(system, place, &check)? {
        symmetries::keeps_area(&mut check, |column| {
            Column::at(column, &sample.q, &sample.v, |q, v| one_stage(&sample, q, v))
        })?;
    }
    check.finish(&[symmetries::AREA])
}

/// The displacement of the step with one stage from q with the stage velocity v, and the momenta at both ends.
fn one_stage<const N: usize, S: MotionChecked<N>>(
    sample: &Sample<S, N>,
    q: &SVector<First, N>,
    v: &SVector<First, N>,
) -> [SVector<First, N>; 3] {
    let half = sample.h / 2.0;
    let [t, part, h] = [sample.t + half, half, sample.h].map(|number| Dual::fixed(Bounded::exact(number)));
    let Point { momentum, force, .. } = sample.system.convert::<First>().point(t, &(q + v * part), v);
    [v * h, momentum - force * part, momentum + force * part]
}
