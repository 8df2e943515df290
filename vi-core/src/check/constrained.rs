//! Checks of systems with constraints.
//!
//! ```text
//! A = ∂g/∂q, a = ∂g/∂t       (A v + a)_q, (A v + a)_t       ∂(Aᵀλ)/∂q
//! d/dt L_v = L_q + f + AᵀΛ   d/dt (A v + a) = 0              along (1, v, a)
//! p0 = L_v − (h/2) F − A0ᵀλ  q1 = q0 + h v                   p1 = L_v + (h/2) F + A1ᵀμ, at the midpoint
//! ```
//!
//! Left sides: generated code. Right sides: dual numbers, as in `derivatives`. The last line is the step with one stage
//! as a function of (q0, v) for constant λ and μ. It preserves the symplectic form if A is the gradient of a function.
//! The place is moved to the nearest one on the constraints.

use super::bounded::{Bounded, exact, solution, vector_of};
use super::comparison::Comparison;
use super::derivatives::{First, Second, columns, gradient_and_rates, matrix};
use super::order;
use super::report::{CheckFailure, Report};
use super::sample::{Sample, constrained_samples};
use super::subject::{ConstrainedChecked, Place, STEPS};
use super::symmetries::{self, Column};
use crate::collocation::Point;
use crate::constrained::{Constrained, Extended, accelerations, bordered, reaction_of};
use crate::lagrangian::Lagrangian;
use crate::linear::Rectangular;
use crate::method::GaussLobatto;
use crate::real::Real;
use crate::real::dual::{Dual, along, lift, slopes, unit};
use crate::run::Starts;
use crate::state::State;
use alloc::vec::Vec;
use core::array;
use nalgebra::{SMatrix, SVector};

/// Stages of the tested steps.
const STAGES: usize = 2;
/// Their order.
const ORDER: u32 = 4;
/// Largest g and `A v + a` at a node, in ulps of their terms. Measured on the tested systems: at most 2.
const HOLDS: f64 = 16.0;

/// The nearest place on the constraints.
fn placed<const N: usize, S: ConstrainedChecked<N>>(
    system: &S,
    place: &Place<N>,
    check: &Comparison,
) -> Result<Place<N>, CheckFailure> {
    let nearest = State::projected(system, place.t, place.q, place.v).map_err(|error| check.step(error))?;
    Ok(Place { q: place.q + nearest.moved_q, v: place.v + nearest.moved_v, ..*place })
}

/// Tests momentum, energy, the equations at a point and their derivatives against dual numbers.
///
/// # Errors
/// The first number that differs; [`CheckFailure::Vacuous`] if momentum, energy or the mass matrix is zero throughout.
pub fn constrained_derivatives<const N: usize, S: ConstrainedChecked<N>>(
    system: &S,
    place: &Place<N>,
) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "constrained derivatives");
    let place = &placed(system, place, &check)?;
    for Sample { system, t, q, v, .. } in constrained_samples(system, place, &check)? {
        let (bounded, dual) = (system.convert::<Bounded>(), system.convert::<First>());
        let (time, place, velocity) = (Bounded::exact(t), exact(&q), exact(&v));
        let by_lagrangian = |i: usize| dual.lagrangian(Dual::fixed(time), &lift(&place), &along(&velocity, &unit(i)));
        let momentum = SVector::from_fn(|i, _| by_lagrangian(i).slope);
        let found = vector_of(&system.momentum(t, &q, &v), &bounded.momentum(time, &place, &velocity));
        check.vector("momentum", &found, &momentum)?;
        let energy = velocity.dot(&momentum) - bounded.lagrangian(time, &place, &velocity);
        check.number("energy", bounded.energy(time, &place, &velocity).of(system.energy(t, &q, &v)), energy)?;
        let (point, bounds) = (system.point(t, &q, &v), bounded.point(time, &place, &velocity));
        check.vector("momentum at a point", &vector_of(&point.momentum, &bounds.momentum), &momentum)?;
        let force = bounded.force(time, &place, &velocity);
        let gradient = SVector::from_fn(|i, _| {
            dual.lagrangian(Dual::fixed(time), &along(&place, &unit(i)), &lift(&velocity)).slope
        });
        check.vector("force at a point", &vector_of(&point.force, &bounds.force), &(gradient + force))?;
        let of_time = dual.lagrangian(Dual::variable(time), &lift(&place), &lift(&velocity)).slope;
        let power = bounded.power(time, &place, &velocity).of(system.power(t, &q, &v));
        check.number("power", power, force.dot(&velocity) - of_time)?;

        let (found, again) = (system.point_derivatives(t, &q, &v), bounded.point_derivatives(time, &place, &velocity));
        let at = |q: &SVector<First, N>, v: &SVector<First, N>| dual.point(Dual::fixed(time), q, v);
        let by_q = array::from_fn(|j| at(&along(&place, &unit(j)), &lift(&velocity)));
        let by_v = array::from_fn(|j| at(&lift(&place), &along(&velocity, &unit(j))));
        let [momentum_dq, mass] = [&by_q, &by_v].map(|by| columns(by, |point| point.momentum));
        let [force_dq, force_dv] = [&by_q, &by_v].map(|by| columns(by, |point| point.force));
        matrix(&mut check, "mass at a point", (&point.mass, &bounds.mass), &mass)?;
        matrix(&mut check, "momentum_dq", (&found.momentum_dq, &again.momentum_dq), &momentum_dq)?;
        matrix(&mut check, "mass", (&found.mass, &again.mass), &mass)?;
        matrix(&mut check, "force_dq", (&found.force_dq, &again.force_dq), &force_dq)?;
        matrix(&mut check, "force_dv", (&found.force_dv, &again.force_dv), &force_dv)?;
    }
    check.finish(&["momentum", "energy", "mass"])
}

/// Tests gradients and rates of constraints and derivatives of their reactions against dual numbers, and that the
/// constraints hold at the nodes of a run.
///
/// # Errors
/// The first number that differs; a constraint that does not hold; [`CheckFailure::Vacuous`] if all gradients are zero;
/// a failed step.
pub fn constraints<const N: usize, S: ConstrainedChecked<N>>(
    system: &S,
    place: &Place<N>,
) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "constraints");
    let place = &placed(system, place, &check)?;
    for sample in constrained_samples(system, place, &check)? {
        gradients(&sample, &mut check)?;
    }
    let start = State::projected(system, place.t, place.q, place.v).map_err(|error| check.step(error))?.state;
    let begun = system.at_state(start).integrate(GaussLobatto::<STAGES>, place.h);
    let mut run = begun.map_err(|error| check.step(error))?;
    for _ in 0..STEPS {
        let state = run.step().map_err(|error| check.step(error))?;
        let v = state.velocity(system).map_err(|error| check.step(error))?;
        let values = system.constraints(state.t, &state.q);
        let (rows, rates) = system.constraint_gradients(state.t, &state.q);
        for (r, name) in S::CONSTRAINTS.iter().enumerate() {
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
fn gradients<const N: usize, S: ConstrainedChecked<N>>(
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
    for r in 0..S::HOLONOMIC {
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
    for r in 0..S::CONSTRAINTS.len() {
        let wanted = SVector::from_fn(|j, _| of_place[j].as_ref()[r].slope);
        let found = vector_of::<N>(&found.row(r).dense(), &again.row(r).dense());
        check.vector(if r < S::HOLONOMIC { "derivative of a rate" } else { "gradient" }, &found, &wanted)?;
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
pub fn reaction<const N: usize, S: ConstrainedChecked<N>>(
    system: &S,
    place: &Place<N>,
) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "reaction");
    let place = &placed(system, place, &check)?;
    for Sample { system, t, q, v, .. } in constrained_samples(system, place, &check)? {
        let (bounded, dual, second) =
            (system.convert::<Bounded>(), system.convert::<First>(), system.convert::<Second>());
        let (time, place, velocity) = (Bounded::exact(t), exact(&q), exact(&v));
        let found = accelerations(&system, (t, &q, &v), &mut bordered::<S, N, f64>());
        let (a, multipliers) = found.map_err(|error| check.step(error))?;
        let again = accelerations(&bounded, (time, &place, &velocity), &mut bordered::<S::In<Bounded>, N, Bounded>());
        let (bounds, again) = again.map_err(|error| check.step(error))?;
        let unknowns = N + S::CONSTRAINTS.len();
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

/// Tests that the error of Gauss–Lobatto steps with two stages decreases with h⁴ or a higher power.
///
/// # Errors
/// As [`order`](super::order()).
pub fn lobatto_order<const N: usize, S: ConstrainedChecked<N>>(
    system: &S,
    place: &Place<N>,
) -> Result<Report, CheckFailure> {
    let check = Comparison::new(S::NAME, "lobatto order");
    let place = placed(system, place, &check)?;
    // The integration of the reference leaves the constraints.
    order::judged(&check, &Extended(*system), &place, ORDER, |start, h| {
        let v = start.velocity(system)?;
        let start = State::projected(system, start.t, start.q, v)?.state;
        system.at_state(start).integrate(GaussLobatto::<STAGES>, h)
    })
}

/// Tests that Gauss–Lobatto steps preserve the symplectic form.
///
/// # Errors
/// An entry that differs; [`CheckFailure::NotApplicable`] for a system with a force or a nonholonomic constraint;
/// [`CheckFailure::Vacuous`] if nothing moves.
pub fn lobatto_symplecticity<const N: usize, S: ConstrainedChecked<N>>(
    system: &S,
    place: &Place<N>,
) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "lobatto symplecticity");
    if S::FORCED {
        return Err(check.not_applicable("a system with a force does not preserve the symplectic form"));
    }
    if S::HOLONOMIC < S::CONSTRAINTS.len() {
        return Err(check.not_applicable("a constraint on velocities does not preserve the symplectic form"));
    }
    let place = &placed(system, place, &check)?;
    for sample in constrained_samples(system, place, &check)? {
        let Sample { system, t, q, v, h } = &sample;
        let found = accelerations(system, (*t, q, v), &mut bordered::<S, N, f64>());
        let (_, multipliers) = found.map_err(|error| check.step(error))?;
        let impulses: Vec<f64> = multipliers.as_ref().iter().map(|multiplier| multiplier * h / 2.0).collect();
        symmetries::keeps_area(&mut check, |column| {
            Column::at(column, q, v, |q, v| one_stage(&sample, &impulses, q, v))
        })?;
    }
    check.finish(&[symmetries::AREA])
}

/// The displacement of the step with one stage from q with the stage velocity v and these impulses at both ends, and
/// the momenta there.
fn one_stage<const N: usize, S: ConstrainedChecked<N>>(
    sample: &Sample<S, N>,
    impulses: &[f64],
    q: &SVector<First, N>,
    v: &SVector<First, N>,
) -> [SVector<First, N>; 3] {
    let number = |number: f64| Dual::fixed(Bounded::exact(number));
    let [start, middle, end] = [0.0, 0.5, 1.0].map(|part| number(sample.t + part * sample.h));
    let (half, h) = (number(sample.h / 2.0), number(sample.h));
    let impulses: Vec<First> = impulses.iter().map(|impulse| number(*impulse)).collect();
    let system = sample.system.convert::<First>();
    let Point { momentum, force, .. } = system.point(middle, &(q + v * half), v);
    let reaction = |t: First, q: &SVector<First, N>| reaction_of(&system.constraint_gradients(t, q).0, &impulses);
    let before = momentum - force * half - reaction(start, q);
    let after = momentum + force * half + reaction(end, &(q + v * h));
    [v * h, before, after]
}
