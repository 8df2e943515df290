//! Checks of constraints and their reaction.
//!
//! ```text
//! A = ∂g/∂q, a = ∂g/∂t       (A v + a)_q, (A v + a)_t       ∂(Aᵀλ)/∂q
//! d/dt L_v = L_q + f + AᵀΛ   d/dt (A v + a) = 0              along (1, v, a)
//! ```
//!
//! Left sides: generated code. Right sides: dual numbers, as in `derivatives`. The place is moved to the nearest one on
//! the constraints.

use super::bounded::{Bounded, exact, solution, vector_of};
use super::comparison::Comparison;
use super::derivatives::{First, Second, columns, gradient_and_rates, matrix};
use super::report::{CheckFailure, Report};
use super::sample::{Sample, placed, samples};
use super::subject::{MotionChecked, Place, STEPS};
use crate::constrained::{accelerations, bordered, reaction_of};
use crate::lagrangian::Lagrangian;
use crate::linear::Rectangular;
use crate::method::Gauss;
use crate::motion::Motion;
use crate::real::Real;
use crate::real::dual::{Dual, along, lift, slopes, unit};
use crate::run::Starts;
use crate::state::State;
use alloc::vec::Vec;
use core::array;
use nalgebra::{SMatrix, SVector};

/// Stages of the tested steps.
const STAGES: usize = 2;
/// Largest g and `A v + a` at a node, in ulps of their terms. Measured on the tested systems: at most 2.
const HOLDS: f64 = 16.0;

/// Tests gradients and rates of constraints and derivatives of their reactions against dual numbers, and that the
/// constraints hold at the nodes of a run.
///
/// # Errors
/// The first number that differs; a constraint that does not hold; [`CheckFailure::Vacuous`] if all gradients are zero;
/// a failed step.
pub fn constraints<const N: usize, S: MotionChecked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "constraints");
    let place = &placed(system, place, &check)?;
    for sample in samples(system, place, &check)? {
        gradients(&sample, &mut check)?;
    }
    let start = State::projected(system, place.t, place.q, place.v).map_err(|error| check.step(error))?.state;
    let begun = system.at_state(start).integrate(Gauss::<STAGES>, place.h);
    let mut run = begun.map_err(|error| check.step(error))?;
    for _ in 0..STEPS {
        let state = run.step().map_err(|error| check.step(error))?;
        let v = state.velocity(system).map_err(|error| check.step(error))?;
        let values = system.constraints(state.t, &state.q);
        let (rows, rates) = system.constraint_gradients(state.t, &state.q);
        for (r, name) in system.constraint_names().iter().enumerate() {
            let (row, rate) = (rows.row(r), rates.as_ref()[r]);
            let of_velocity = (row.dot(&v) + rate, row.terms(&v) + rate.abs());
            let of_place = (values.as_ref()[r], row.terms(&state.q) + (rate * state.t).abs());
            for (value, scale) in [of_place, of_velocity] {
                let allowed = HOLDS * f64::EPSILON * scale;
                // False for NaN.
                let holds = value.abs() <= allowed;
                if !holds {
                    return Err(check.differs(format!("{name} at a node"), [value, 0.0], value.abs(), allowed));
                }
            }
        }
    }
    check.finish(&["gradient"])
}

/// Compares gradients, rates and reactions at a sample.
fn gradients<const N: usize, S: MotionChecked<N>>(
    Sample { system, t, q, v, .. }: &Sample<S, N>,
    check: &mut Comparison,
) -> Result<(), CheckFailure> {
    let (bounded, dual) = (system.convert::<Bounded>(), system.convert::<First>());
    let (time, place, velocity) = (Bounded::exact(*t), exact(q), exact(v));
    let (found, found_rates) = system.constraint_gradients(*t, q);
    let (again, again_rates) = bounded.constraint_gradients(time, &place);
    let by_q: [_; N] = array::from_fn(|j| along(&place, &unit(j)));
    let values = by_q.map(|q| dual.constraints(Dual::fixed(time), &q));
    let of_time = dual.constraints(Dual::variable(time), &lift(&place));
    for r in 0..system.holonomic() {
        let wanted = SVector::from_fn(|j, _| values[j].as_ref()[r].slope);
        check.vector("gradient", &vector_of::<N>(&found.row(r).dense(), &again.row(r).dense()), &wanted)?;
        check.number("rate", again_rates.as_ref()[r].of(found_rates.as_ref()[r]), of_time.as_ref()[r].slope)?;
    }
    let rates = |t: First, q: &SVector<First, N>| {
        let (rows, mut rates) = dual.constraint_gradients(t, q);
        for (rate, row) in rates.as_mut().iter_mut().zip(rows.rows()) {
            *rate += row.dot(&lift(&velocity));
        }
        rates
    };
    let (found, found_rates) = system.constraint_rate_derivatives(*t, q, v);
    let (again, again_rates) = bounded.constraint_rate_derivatives(time, &place, &velocity);
    let of_place = by_q.map(|q| rates(Dual::fixed(time), &q));
    let of_time = rates(Dual::variable(time), &lift(&place));
    // Nonholonomic gradients are given by their rates: those of velocities.
    for r in 0..system.constraint_names().len() {
        let wanted = SVector::from_fn(|j, _| of_place[j].as_ref()[r].slope);
        let found = vector_of::<N>(&found.row(r).dense(), &again.row(r).dense());
        check.vector(if r < system.holonomic() { "derivative of a rate" } else { "gradient" }, &found, &wanted)?;
        let found = again_rates.as_ref()[r].of(found_rates.as_ref()[r]);
        check.number("change of a rate with time", found, of_time.as_ref()[r].slope)?;
    }
    let mut multipliers = system.constraints(*t, q);
    let mut part = 1.0;
    for multiplier in multipliers.as_mut() {
        *multiplier = part;
        part *= -0.9;
    }
    let mut exactly = bounded.constraints(time, &place);
    for (exactly, multiplier) in exactly.as_mut().iter_mut().zip(multipliers.as_ref()) {
        *exactly = Bounded::exact(*multiplier);
    }
    let fixed: Vec<First> = exactly.as_ref().iter().map(|entry| Dual::fixed(*entry)).collect();
    let reactions = by_q.map(|q| reaction_of(&dual.constraint_gradients(Dual::fixed(time), &q).0, &fixed));
    let found = dense(&system.reaction_derivatives(*t, q, &multipliers));
    let again = dense(&bounded.reaction_derivatives(time, &place, &exactly));
    matrix(check, "derivative of a reaction", (&found, &again), &columns(&reactions, |reaction| *reaction))
}

/// The matrix of these rows.
fn dense<const N: usize, T: Real>(rows: &impl Rectangular<N, T>) -> SMatrix<T, N, N> {
    let mut matrix = SMatrix::zeros();
    for (i, row) in rows.rows().enumerate() {
        row.iter().for_each(|(j, value)| matrix[(i, j)] = value);
    }
    matrix
}

/// Tests that acceleration and multipliers satisfy the equations of motion, and that the rates of the constraints stay.
///
/// # Errors
/// The first number that differs; [`CheckFailure::Vacuous`] if no reaction acts; [`CheckFailure::Step`] without an
/// acceleration.
pub fn reaction<const N: usize, S: MotionChecked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "reaction");
    let place = &placed(system, place, &check)?;
    for Sample { system, t, q, v, .. } in samples(system, place, &check)? {
        let (bounded, dual, second) =
            (system.convert::<Bounded>(), system.convert::<First>(), system.convert::<Second>());
        let (time, place, velocity) = (Bounded::exact(t), exact(&q), exact(&v));
        let found = accelerations(&system, (t, &q, &v), &mut bordered(&system));
        let (a, multipliers) = found.map_err(|error| check.step(error))?;
        let again = accelerations(&bounded, (time, &place, &velocity), &mut bordered(&bounded));
        let (bounds, again) = again.map_err(|error| check.step(error))?;
        let unknowns = N + system.constraint_names().len();
        let a = SVector::from_vec(solution(a.as_slice(), bounds.as_slice(), unknowns));
        let multipliers = solution(multipliers.as_ref(), again.as_ref(), unknowns);
        let (moving, changing) = (along(&place, &velocity), along(&velocity, &a));
        let rate = slopes(&dual.momentum(Dual::variable(time), &moving, &changing));
        let (gradient, _, _) = gradient_and_rates(&second, t, [&place, &velocity, &a]);
        let applied = gradient + bounded.force(time, &place, &velocity);
        let reaction = reaction_of(&bounded.constraint_gradients(time, &place).0, &multipliers);
        check.vector("reaction", &reaction, &(rate - applied))?;
        let (rows, rates) = dual.constraint_gradients(Dual::variable(time), &moving);
        for (row, rate) in rows.rows().zip(rates.as_ref()) {
            check.number("change of a rate", (row.dot(&changing) + *rate).slope, Bounded::exact(0.0))?;
        }
    }
    check.finish(&["reaction"])
}
