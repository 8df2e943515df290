//! Invariants of a fixed step: momenta of cyclic coordinates, the symplectic form, reversibility.
//!
//! ```text
//! p1 = p0                                       of a cyclic coordinate: every bit
//! dq1 ∧ dp1 = dq0 ∧ dp0                         with p0 = −D2 L_d − f_d⁻ and q1 = q0 + h v: as functions of (q0, v)
//! r(t1, q1, p1; −h, v) = 0,  p1 → p0            if r(t0, q0, p0; h, v) = 0 and p0 → p1
//! ```
//!
//! p0 is computed for (q0, v), so that no equation is solved. The derivatives of the second line are dual numbers
//! instead of differences. Tolerance: none in the first line; in the others the rounding-error bounds of both sides, as
//! in `derivatives`. h is that of the samples, a fraction of the system's own time scale.

use super::bounded::{Bounded, exact};
use super::comparison::Comparison;
use super::derivatives::First;
use super::report::{CheckFailure, Report};
use super::sample::{Sample, step_samples};
use super::subject::{Checked, MotionChecked, Place, STEPS};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::{FixedStep, Method};
use crate::node::Node;
use crate::real::dual::Dual;
use crate::real::dual::{along, lift, slopes, unit};
use crate::run::{Run, Starts};
use crate::state::State;
use crate::stepping::FixedStepping;
use alloc::vec::Vec;
use nalgebra::SVector;

/// Tests that momenta of cyclic coordinates are constant bit for bit over fixed steps, with a zero increment in every
/// step.
///
/// # Errors
/// A momentum that changes; [`CheckFailure::NotApplicable`] for a system without a cyclic coordinate;
/// [`CheckFailure::Vacuous`] if such a momentum is zero or its coordinate does not change.
pub fn momenta<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "momenta");
    kept(&mut check, system, place, |start, h| system.at_state(start).integrate(FixedStep, h))?;
    // A momentum of moderate size would round away a small increment.
    for Sample { system, t, q, v, h } in step_samples(system, place, &check)? {
        let gain = system.momentum_residual(&Node::new(State::at(&system, t, q, v), 0.0), h, &v).increment;
        for index in (0..N).filter(|index| system.cyclic()[*index]) {
            check.number(system.coordinates()[index], Bounded::exact(gain[index]), Bounded::exact(0.0))?;
        }
    }
    check.finish(&[])
}

/// Tests that momenta of cyclic coordinates are constant bit for bit over the run that `begin` starts from a state with
/// a step.
///
/// # Errors
/// As [`momenta`].
pub(super) fn kept<const N: usize, S: MotionChecked<N>, M: Method<Y, N>, Y: Lagrangian<N> + Copy>(
    check: &mut Comparison,
    system: &S,
    place: &Place<N>,
    begin: impl Fn(State<N>, f64) -> Result<Run<M, Y, N>, StepError>,
) -> Result<(), CheckFailure> {
    if !system.cyclic().contains(&true) {
        return Err(check.not_applicable("no coordinate is cyclic"));
    }
    let cyclic = || (0..N).filter(|index| system.cyclic()[*index]);
    let start = State::at(system, place.t, place.q, place.v);
    let mut run = begin(start, place.h).map_err(|error| check.step(error))?;
    for _ in 0..STEPS {
        let state = run.step().map_err(|error| check.step(error))?;
        for index in cyclic() {
            let [found, wanted] = [state.p[index], start.p[index]].map(Bounded::exact);
            check.number(system.coordinates()[index], found, wanted)?;
        }
    }
    let end = run.state();
    for index in cyclic() {
        let stands_still = place.v[index] == 0.0 && end.q[index] - start.q[index] == 0.0;
        if start.p[index] == 0.0 || stands_still {
            let name = system.coordinates()[index];
            let why = format!("`{name}` does not change or its momentum is zero; choose a velocity `dot({name})`");
            return Err(check.vacuous(why));
        }
    }
    Ok(())
}

/// Tests that the fixed step −h reverses the fixed step h. For rules that are symmetric in both ends of the interval;
/// with forces too.
///
/// # Errors
/// A number that differs; [`CheckFailure::Vacuous`] if nothing moves, or no momentum changes.
pub fn reversibility<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "reversibility");
    for sample in step_samples(system, place, &check)? {
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

/// Tests that a fixed step preserves the symplectic form, `dq1 ∧ dp1 = dq0 ∧ dp0`.
///
/// # Errors
/// An entry that differs; [`CheckFailure::NotApplicable`] for a system with a force; [`CheckFailure::Vacuous`] if
/// nothing moves.
pub fn symplecticity<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "symplecticity");
    if system.is_forced() {
        return Err(check.not_applicable("a system with a force does not preserve the symplectic form"));
    }
    for sample in step_samples(system, place, &check)? {
        keeps_area(&mut check, |column| Column::at(column, &sample.q, &sample.v, |q, v| ends(&sample, q, v)))?;
    }
    check.finish(&[AREA])
}

/// Name of the quantity that [`keeps_area`] compares.
pub(super) const AREA: &str = "area of two columns";

/// Compares the symplectic form of every two columns before and after a step.
pub(super) fn keeps_area<const N: usize>(
    check: &mut Comparison,
    column: impl Fn(usize) -> Column<N>,
) -> Result<(), CheckFailure> {
    let columns: Vec<_> = (0..2 * N).map(column).collect();
    for (index, one) in columns.iter().enumerate() {
        for other in columns.iter().skip(index + 1) {
            check.number(AREA, area(&one.after, &other.after), area(&one.before, &other.before))?;
        }
    }
    Ok(())
}

/// The node of a sample with zero momentum, so that the residual of its momentum equation is the required momentum.
fn bare<const N: usize, S: Checked<N>>(sample: &Sample<S, N>) -> Node<N> {
    Node::new(State { t: sample.t, q: sample.q, p: SVector::zeros() }, 0.0)
}

/// A change of coordinates and momenta.
type Displacement<const N: usize> = (SVector<Bounded, N>, SVector<Bounded, N>);

/// Derivatives with respect to one entry of (q0, v), before and after a step.
pub(super) struct Column<const N: usize> {
    before: Displacement<N>,
    after: Displacement<N>,
}

impl<const N: usize> Column<N> {
    /// The column of this index, for a step from the coordinates q with the velocity v; `step` returns its displacement
    /// and the momenta at both ends.
    pub(super) fn at(
        column: usize,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
        step: impl Fn(&SVector<First, N>, &SVector<First, N>) -> [SVector<First, N>; 3],
    ) -> Self {
        let (q, v) = (exact(q), exact(v));
        let direction = unit(column % N);
        let (q, v) = if column < N { (along(&q, &direction), lift(&v)) } else { (lift(&q), along(&v, &direction)) };
        let [way, start, end] = step(&q, &v);
        Self { before: (slopes(&q), slopes(&start)), after: (slopes(&(q + way)), slopes(&end)) }
    }
}

/// The displacement of a fixed step of the sample from q with the velocity v, and the momenta at both ends.
fn ends<const N: usize, S: Checked<N>>(
    sample: &Sample<S, N>,
    q: &SVector<First, N>,
    v: &SVector<First, N>,
) -> [SVector<First, N>; 3] {
    let system = sample.system.steps::<First>();
    let h = Dual::fixed(Bounded::exact(sample.h));
    let still = bare(sample).map(|number| Dual::fixed(Bounded::exact(number)));
    let place = Node { q: *q, ..still };
    let start = Node { p: system.momentum_equation(&place, h, v).residual, ..place };
    let gain = system.momentum_residual(&start, h, v).increment;
    [v.map(|v| v * h), start.p, start.p + gain]
}

/// The symplectic form of two changes.
fn area<const N: usize>(one: &Displacement<N>, other: &Displacement<N>) -> Bounded {
    one.0.dot(&other.1) - one.1.dot(&other.0)
}
