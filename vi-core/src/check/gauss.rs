//! Gauss steps of a system: order, momenta of cyclic coordinates, symplectic form.
//!
//! These checks need no rule. Order and momenta are tested on steps with [`STAGES`] stages. The symplectic form is that
//! of the step with one stage, as a function of its start and of the stage velocity. No equation is solved:
//!
//! ```text
//! p0 = L_v − (h/2) (L_q + f) − A0ᵀλ      q1 = q0 + h v      p1 = L_v + (h/2) (L_q + f) + A1ᵀμ
//!                                                             at t0 + h/2, q0 + (h/2) v, v
//! ```
//!
//! With constraints, λ and μ are constant numbers: the step preserves the symplectic form if A is the gradient of a
//! function. The place is moved to the nearest one on the constraints.
//!
//! Tolerance: as in `order` and `symplecticity`. A Gauss step is reversible for any functions of a system, so that
//! there is no such check.

use super::bounded::Bounded;
use super::comparison::Comparison;
use super::derivatives::First;
use super::order;
use super::report::{CheckFailure, Report};
use super::sample::{Sample, placed, samples};
use super::subject::{MotionChecked, Place};
use super::symmetries::{self, Column};
use crate::called::Called;
use crate::constrained::{Extended, accelerations, bordered, reaction_of};
use crate::error::StepError;
use crate::kind::Kind;
use crate::method::Gauss;
use crate::motion::{Motion, Point};
use crate::real::Dual;
use crate::run::Starts;
use crate::state::State;
use alloc::vec::Vec;
use nalgebra::SVector;

/// Stages of the tested steps.
const STAGES: usize = 2;
/// Order of the tested steps.
const ORDER: u32 = 4;

/// Tests that the error of Gauss steps with two stages decreases with h⁴ or a higher power.
///
/// # Errors
/// As [`order`](super::order()).
pub fn gauss_order<const N: usize, S: MotionChecked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let check = Comparison::new(system.name(), "gauss order");
    let place = placed(system, place, &check)?;
    order::judged(&check, &Extended(*system), &place, ORDER, |start, h| {
        let start = if const { S::Kind::COUNT == 0 } {
            start
        } else {
            // The integration of the reference leaves the constraints.
            State::projected(system, start.t, start.q, start.velocity(system)?)?.state
        };
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
    let mut check = Comparison::new(system.name(), "gauss momenta");
    let place = &placed(system, place, &check)?;
    symmetries::kept(&mut check, system, place, |start, h| {
        Called(*system).at_state(start).integrate(Gauss::<STAGES>, h)
    })?;
    for sample in samples(system, place, &check)? {
        let force = sample.system.point(sample.t, &sample.q, &sample.v).force;
        for index in (0..N).filter(|index| system.cyclic()[*index]) {
            check.number(system.coordinates()[index], Bounded::exact(force[index]), Bounded::exact(0.0))?;
        }
    }
    check.finish(&[])
}

/// Tests that Gauss steps preserve the symplectic form.
///
/// # Errors
/// An entry that differs; [`CheckFailure::NotApplicable`] for a system with a force or a nonholonomic constraint;
/// [`CheckFailure::Vacuous`] if nothing moves.
pub fn gauss_symplecticity<const N: usize, S: MotionChecked<N>>(
    system: &S,
    place: &Place<N>,
) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "gauss symplecticity");
    if system.is_forced() {
        return Err(check.not_applicable("a system with a force does not preserve the symplectic form"));
    }
    if system.holonomic() < system.constraint_names().len() {
        return Err(check.not_applicable("a constraint on velocities does not preserve the symplectic form"));
    }
    let place = &placed(system, place, &check)?;
    for sample in samples(system, place, &check)? {
        let impulses = impulses(&sample).map_err(|error| check.step(error))?;
        symmetries::keeps_area(&mut check, |column| {
            Column::at(column, &sample.q, &sample.v, |q, v| one_stage(&sample, &impulses, q, v))
        })?;
    }
    check.finish(&[symmetries::AREA])
}

/// An impulse of each constraint, of the size that it has in half a step.
///
/// # Errors
/// [`StepError::Singular`] and [`StepError::NonFinite`].
fn impulses<const N: usize, S: MotionChecked<N>>(
    Sample { system, t, q, v, h }: &Sample<S, N>,
) -> Result<Vec<f64>, StepError> {
    if const { S::Kind::COUNT == 0 } {
        return Ok(Vec::new());
    }
    let (_, multipliers) = accelerations(system, (*t, q, v), &mut bordered(system))?;
    Ok(multipliers.as_ref().iter().map(|multiplier| multiplier * h / 2.0).collect())
}

/// The displacement of the step with one stage from q with the stage velocity v and these impulses at both ends, and
/// the momenta there.
fn one_stage<const N: usize, S: MotionChecked<N>>(
    sample: &Sample<S, N>,
    impulses: &[f64],
    q: &SVector<First, N>,
    v: &SVector<First, N>,
) -> [SVector<First, N>; 3] {
    let number = |number: f64| Dual::fixed(Bounded::exact(number));
    let [start, middle, end] = [0.0, 0.5, 1.0].map(|part| number(sample.t + part * sample.h));
    let (half, h) = (number(sample.h / 2.0), number(sample.h));
    let system = sample.system.convert::<First>();
    let Point { momentum, force, .. } = system.point(middle, &(q + v * half), v);
    let (mut before, mut after) = (momentum - force * half, momentum + force * half);
    if !impulses.is_empty() {
        let impulses: Vec<First> = impulses.iter().map(|impulse| number(*impulse)).collect();
        let reaction = |t: First, q: &SVector<First, N>| reaction_of(&system.constraint_gradients(t, q).0, &impulses);
        before -= reaction(start, q);
        after += reaction(end, &(q + v * h));
    }
    [v * h, before, after]
}
