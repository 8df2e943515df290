//! What a fixed step keeps: momenta of cyclic coordinates, the symplectic form, and itself backwards.

use super::comparison::Comparison;
use super::report::{CheckFailure, Report};
use super::sample::{Extent, extent};
use super::{Checked, Place, STEPS};
use crate::{FixedStep, State};
use nalgebra::SVector;

/// What a run forth and back again may be off by, relative to how far it went. Measured on the ready systems: 2.3e-16.
const RETURN: f64 = 1e-9;
/// What `MᵀJM − J` may be by differences, in the units of the motion. Measured on the ready systems: 4.6e-13.
const SYMPLECTIC: f64 = 1e-8;
/// Part of the extent of the motion by which a state is moved for a difference.
const DISTANCE: f64 = 1e-3;

/// The state after `steps` steps of length `h`.
fn after<const N: usize, S: Checked<N>>(
    system: &S,
    start: State<N>,
    h: f64,
    steps: u32,
    check: &Comparison,
) -> Result<State<N>, CheckFailure> {
    let mut run = FixedStep::new(system, start, h).map_err(|error| check.step(error))?;
    for _ in 0..steps {
        run.step().map_err(|error| check.step(error))?;
    }
    Ok(run.state())
}

/// Momenta of cyclic coordinates keep every bit over fixed steps.
///
/// # Errors
/// A momentum that changes; [`CheckFailure::NotApplicable`] for a system without a cyclic coordinate;
/// [`CheckFailure::Vacuous`] where such a momentum is zero or its coordinate stands still.
pub fn momenta<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "momenta", 0.0);
    if !S::CYCLIC.contains(&true) {
        return Err(check.not_applicable("no coordinate is cyclic"));
    }
    let start = State::at(system, place.t, place.q, place.v);
    let mut run = FixedStep::new(system, start, place.h).map_err(|error| check.step(error))?;
    for _ in 0..STEPS {
        let state = run.step().map_err(|error| check.step(error))?;
        for index in (0..N).filter(|index| S::CYCLIC[*index]) {
            check.number(S::COORDINATES[index], state.p[index], start.p[index], 0.0)?;
        }
    }
    let end = run.state();
    for index in (0..N).filter(|index| S::CYCLIC[*index]) {
        if start.p[index] == 0.0 || end.q[index] - start.q[index] == 0.0 {
            let name = S::COORDINATES[index];
            let why = format!("`{name}` stands still or its momentum is zero; choose a velocity `dot({name})`");
            return Err(check.vacuous(why));
        }
    }
    check.finish(&[])
}

/// Fixed steps −h lead back the way that fixed steps h led. For rules that are symmetric in the two ends of the interval;
/// with forces too.
///
/// # Errors
/// A coordinate or momentum that does not return; [`CheckFailure::Vacuous`] where nothing moves; a step that is not taken.
pub fn reversibility<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "reversibility", RETURN);
    let Extent { q, p, .. } = extent(system, place, &check)?;
    let start = State::at(system, place.t, place.q, place.v);
    let there = after(system, start, place.h, STEPS, &check)?;
    let back = after(system, there, -place.h, STEPS, &check)?;
    if there.q == start.q && there.p == start.p {
        return Err(check.vacuous("nothing moves from this place; choose another"));
    }
    // Counted from the far end, so that zero stands for not having moved.
    check.vector("way of the coordinates", &(back.q - there.q), &(start.q - there.q), q.amax())?;
    check.vector("way of the momenta", &(back.p - there.p), &(start.p - there.p), p.amax())?;
    check.finish(&[])
}

/// The derivative M of one fixed step by the state before it keeps the symplectic form: `MᵀJM = J`. M is by central
/// differences of fourth order.
///
/// # Errors
/// An entry that differs; [`CheckFailure::NotApplicable`] for a system with a force; [`CheckFailure::Vacuous`] where the
/// step moves nothing; a step that is not taken.
pub fn symplecticity<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "symplecticity", SYMPLECTIC);
    if S::FORCED {
        return Err(check.not_applicable("a force does not keep the symplectic form"));
    }
    let extent = extent(system, place, &check)?;
    let columns = derivative(system, place, &extent, &check)?;
    // Areas in the units of the motion.
    let unit = extent.q.component_mul(&extent.p).amax();
    let mut moved = 0.0_f64;
    for (i, (q, p)) in columns.iter().enumerate() {
        for (j, (other_q, other_p)) in columns.iter().enumerate().skip(i + 1) {
            let wanted = if i + N == j { extent.q[i] * extent.p[i] } else { 0.0 };
            check.number("area of two columns", q.dot(other_p) - p.dot(other_q), wanted, unit)?;
        }
        let kept = |index: usize, own: usize, distance: f64| if index == own { distance } else { 0.0 };
        let own_q = SVector::<f64, N>::from_fn(|row, _| kept(i, row, extent.q[row]));
        let own_p = SVector::<f64, N>::from_fn(|row, _| kept(i, row + N, extent.p[row]));
        moved = moved.max((q - own_q).component_div(&extent.q).amax()).max((p - own_p).component_div(&extent.p).amax());
    }
    if moved < SYMPLECTIC {
        return Err(check.vacuous("the step moves nothing; choose a larger h or another place"));
    }
    check.finish(&[])
}

/// Changes of coordinates and momenta.
type Change<const N: usize> = (SVector<f64, N>, SVector<f64, N>);

/// Columns of M, each times the extent of the coordinate or momentum that it is the derivative by: q first, then p.
fn derivative<const N: usize, S: Checked<N>>(
    system: &S,
    place: &Place<N>,
    extent: &Extent<N>,
    check: &Comparison,
) -> Result<Vec<Change<N>>, CheckFailure> {
    let start = State::at(system, place.t, place.q, place.v);
    let moved = |column: usize, times: f64| {
        let mut state = start;
        if column < N {
            state.q[column] += times * DISTANCE * extent.q[column];
        } else {
            state.p[column - N] += times * DISTANCE * extent.p[column - N];
        }
        after(system, state, place.h, 1, check)
    };
    let difference = |column: usize, times: f64| -> Result<Change<N>, CheckFailure> {
        let (more, less) = (moved(column, times)?, moved(column, -times)?);
        Ok((more.q - less.q, more.p - less.p))
    };
    let column = |column: usize| {
        let (near, far) = (difference(column, 1.0)?, difference(column, 2.0)?);
        let divisor = 12.0 * DISTANCE;
        Ok(((near.0 * 8.0 - far.0) / divisor, (near.1 * 8.0 - far.1) / divisor))
    };
    (0..2 * N).map(column).collect()
}
