//! What a fixed step keeps: momenta of cyclic coordinates, the symplectic form, and itself backwards.
//!
//! ```text
//! p1 = p0                                       of a cyclic coordinate: every bit
//! dq1 ∧ dp1 = dq0 ∧ dp0                         with p0 = −D2 L_d − f_d⁻ and q1 = q0 + h v: as functions of (q0, v)
//! r(t1, q1, p1; −h, v) = 0,  p1 → p0            where r(t0, q0, p0; h, v) = 0 and p0 → p1
//! ```
//!
//! p0 is made for (q0, v), so no equation is solved, and the derivatives of the second line are dual numbers, so nothing is
//! differenced. Rounding: none in the first line; in the others that of both sides, carried along as in `derivatives`. h is
//! that of the samples, a part of the system's own time scale.

use super::bounded::{Bounded, exact};
use super::comparison::Comparison;
use super::derivatives::First;
use super::report::{CheckFailure, Report};
use super::sample::{Sample, samples};
use super::subject::{Checked, Place, STEPS};
use crate::method::FixedStep;
use crate::node::Node;
use crate::real::dual::Dual;
use crate::real::dual::{along, lift, slopes, unit};
use crate::run::Starts;
use crate::state::State;
use crate::stepping::FixedStepping;
use nalgebra::SVector;

/// Momenta of cyclic coordinates keep every bit over fixed steps, and gain nothing in any step.
///
/// # Errors
/// A momentum that changes; [`CheckFailure::NotApplicable`] for a system without a cyclic coordinate;
/// [`CheckFailure::Vacuous`] where such a momentum is zero or its coordinate stands still.
pub fn momenta<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "momenta");
    if !S::CYCLIC.contains(&true) {
        return Err(check.not_applicable("no coordinate is cyclic"));
    }
    let cyclic = || (0..N).filter(|index| S::CYCLIC[*index]);
    let start = State::at(system, place.t, place.q, place.v);
    let mut run = system.at_state(start).integrate(FixedStep, place.h).map_err(|error| check.step(error))?;
    for _ in 0..STEPS {
        let state = run.step().map_err(|error| check.step(error))?;
        for index in cyclic() {
            let [found, wanted] = [state.p[index], start.p[index]].map(Bounded::exact);
            check.number(S::COORDINATES[index], found, wanted)?;
        }
    }
    let end = run.state();
    for index in cyclic() {
        let stands_still = place.v[index] == 0.0 && end.q[index] - start.q[index] == 0.0;
        if start.p[index] == 0.0 || stands_still {
            let name = S::COORDINATES[index];
            let why = format!("`{name}` stands still or its momentum is zero; choose a velocity `dot({name})`");
            return Err(check.vacuous(why));
        }
    }
    // What a momentum of moderate size would round away.
    for Sample { system, t, q, v, h } in samples(system, place, &check)? {
        let gain = system.momentum_residual(&Node::new(State::at(&system, t, q, v), 0.0), h, &v).increment;
        for index in cyclic() {
            check.number(S::COORDINATES[index], Bounded::exact(gain[index]), Bounded::exact(0.0))?;
        }
    }
    check.finish(&[])
}

/// The fixed step −h leads back the way that the fixed step h led. For rules that are symmetric in the two ends of the
/// interval; with forces too.
///
/// # Errors
/// A number that differs; [`CheckFailure::Vacuous`] where nothing moves, or no momentum changes.
pub fn reversibility<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "reversibility");
    for sample in samples(system, place, &check)? {
        let system = sample.system.steps::<Bounded>();
        let (h, v) = (Bounded::exact(sample.h), exact(&sample.v));
        let start = bare(&sample).map(Bounded::exact);
        let start = Node { p: system.momentum_equation(&start, h, &v).residual, ..start };
        let gain = system.momentum_residual(&start, h, &v).increment;
        let (t, q) = (start.t + h, start.q + v.map(|v| v * h));
        let end = Node { t, q, p: SVector::zeros(), ..start };
        check.vector("momentum at the end", &system.momentum_equation(&end, -h, &v).residual, &(start.p + gain))?;
        check.vector("momentum lost on the way back", &-system.momentum_residual(&end, -h, &v).increment, &gain)?;
    }
    check.finish(&["momentum at the end"])
}

/// A fixed step keeps the symplectic form, `dq1 ∧ dp1 = dq0 ∧ dp0`.
///
/// # Errors
/// An entry that differs; [`CheckFailure::NotApplicable`] for a system with a force; [`CheckFailure::Vacuous`] where
/// nothing moves.
pub fn symplecticity<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "symplecticity");
    if S::FORCED {
        return Err(check.not_applicable("a force does not keep the symplectic form"));
    }
    for sample in samples(system, place, &check)? {
        let columns: Vec<_> = (0..2 * N).map(|column| Column::of(&sample, column)).collect();
        for (index, one) in columns.iter().enumerate() {
            for other in columns.iter().skip(index + 1) {
                check.number(
                    "area of two columns",
                    area(&one.after, &other.after),
                    area(&one.before, &other.before),
                )?;
            }
        }
    }
    check.finish(&["area of two columns"])
}

/// The place of a sample, without a momentum: its momentum equation says which one it would need.
fn bare<const N: usize, S: Checked<N>>(sample: &Sample<S, N>) -> Node<N> {
    Node::new(State { t: sample.t, q: sample.q, p: SVector::zeros() }, 0.0)
}

/// Changes of coordinates and momenta.
type Change<const N: usize> = (SVector<Bounded, N>, SVector<Bounded, N>);

/// What one entry of (q0, v) changes before the step and after it.
struct Column<const N: usize> {
    before: Change<N>,
    after: Change<N>,
}

impl<const N: usize> Column<N> {
    fn of<S: Checked<N>>(sample: &Sample<S, N>, column: usize) -> Self {
        let system = sample.system.steps::<First>();
        let h = Dual::fixed(Bounded::exact(sample.h));
        let still = bare(sample).map(|number| Dual::fixed(Bounded::exact(number)));
        let (q, v) = (exact(&sample.q), exact(&sample.v));
        let direction = unit(column % N);
        let (q, v) = if column < N { (along(&q, &direction), lift(&v)) } else { (lift(&q), along(&v, &direction)) };
        let place = Node { q, ..still };
        let start = Node { p: system.momentum_equation(&place, h, &v).residual, ..place };
        let gain = system.momentum_residual(&start, h, &v).increment;
        let way = v.map(|v| v * h);
        Self { before: (slopes(&q), slopes(&start.p)), after: (slopes(&(q + way)), slopes(&(start.p + gain))) }
    }
}

/// The symplectic form of two changes.
fn area<const N: usize>(one: &Change<N>, other: &Change<N>) -> Bounded {
    one.0.dot(&other.1) - one.1.dot(&other.0)
}
