//! Generated derivatives against dual numbers.
//!
//! ```text
//! p = ∂L/∂v      E = v·p − L      d/dt ∂L/∂v = L_q + f      dE/dt = f·v − L_t
//! ∂L_v/∂q        ∂L_v/∂v = M      ∂(L_q + f)/∂q      ∂(L_q + f)/∂v      ∂g/∂q      ∂g/∂t of a time scale g
//! ```
//!
//! Left sides: generated code. Right sides: automatic differentiation of L, and of the evaluation at a point.
//! Tolerance: the sum of the rounding-error bounds of both sides (`Bounded`). h is that of the samples, a fraction of
//! the system's own time scale; the h of the place is not used.

use super::bounded::{Bounded, exact, solution, vector_of};
use super::comparison::Comparison;
use super::report::{CheckFailure, Report};
use super::sample::{Sample, placed, samples};
use super::subject::{MotionChecked, Place};
use crate::kind::Kind;
use crate::lagrangian::Lagrangian;
use crate::linear::Matrix;
use crate::motion::Motion;
use crate::real::dual::Dual;
use crate::real::dual::{along, lift, slopes, unit};
use core::array;
use nalgebra::{SMatrix, SVector};

/// Dual numbers for first derivatives, and for second ones.
pub(super) type First = Dual<Bounded>;
pub(super) type Second = Dual<First>;

/// Tests momentum, energy, the equations at a point and their derivatives against dual numbers, without constraints also
/// the acceleration, and with a time scale the evaluation of steps in transformed time. If L is linear in the velocities,
/// its acceleration has to keep `L_q + f = d/dt ∂L/∂v`, which holds at the velocities of the coordinates only.
///
/// # Errors
/// The first number that differs; [`CheckFailure::Vacuous`] if momentum, energy or the mass matrix is zero throughout, or
/// ∂L_v/∂q if L is linear in the velocities.
pub fn derivatives<const N: usize, S: MotionChecked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "derivatives");
    let place = &placed(system, place, &check)?;
    for sample in samples(system, place, &check)? {
        continuous(&sample, &mut check)?;
        point(&sample, &mut check)?;
        scaled_point(&sample, &mut check)?;
    }
    check.finish(&["momentum", "energy", if system.is_first_order() { "momentum_dq" } else { "mass" }])
}

/// `∂L/∂q`, and its rate and that of `∂L/∂t` along the trajectory (1, v, a), by second-order dual numbers.
pub(super) fn gradient_and_rates<const N: usize>(
    system: &impl Lagrangian<N, Second>,
    t: f64,
    [q, v, a]: [&SVector<Bounded, N>; 3],
) -> (SVector<Bounded, N>, SVector<Bounded, N>, Bounded) {
    let number = |value: Bounded, rate: Bounded, seed: Bounded| Second {
        value: Dual { value, slope: rate },
        slope: Dual::fixed(seed),
    };
    let [zero, one] = [0.0, 1.0].map(Bounded::exact);
    let derivative = |seed_t: Bounded, seed_q: &SVector<Bounded, N>| {
        let q = SVector::from_fn(|i, _| number(q[i], v[i], seed_q[i]));
        let v = SVector::from_fn(|i, _| number(v[i], a[i], zero));
        system.lagrangian(number(Bounded::exact(t), one, seed_t), &q, &v).slope
    };
    let each: SVector<First, N> = SVector::from_fn(|index, _| derivative(zero, &unit(index)));
    (each.map(|entry| entry.value), slopes(&each), derivative(one, &SVector::zeros()).slope)
}

fn continuous<const N: usize, S: MotionChecked<N>>(
    sample: &Sample<S, N>,
    check: &mut Comparison,
) -> Result<(), CheckFailure> {
    let Sample { system, t, q, v, .. } = sample;
    let (bounded, dual, second) = (system.convert::<Bounded>(), system.convert::<First>(), system.convert::<Second>());
    let (time, place, velocity) = (Bounded::exact(*t), exact(q), exact(v));
    let momentum =
        SVector::from_fn(|i, _| dual.lagrangian(Dual::fixed(time), &lift(&place), &along(&velocity, &unit(i))).slope);
    let found = vector_of(&system.momentum(*t, q, v), &bounded.momentum(time, &place, &velocity));
    check.vector("momentum", &found, &momentum)?;
    let energy = velocity.dot(&momentum) - bounded.lagrangian(time, &place, &velocity);
    check.number("energy", bounded.energy(time, &place, &velocity).of(system.energy(*t, q, v)), energy)?;

    // With constraints the acceleration needs their reaction: `reaction` tests both.
    let is_free = const { S::Kind::COUNT == 0 };
    let a = if is_free { acceleration(sample, check)? } else { SVector::repeat(Bounded::exact(0.0)) };
    let (gradient, _, _) = gradient_and_rates(&second, *t, [&place, &velocity, &a]);
    let applied = gradient + bounded.force(time, &place, &velocity);
    let moving = |a: &SVector<Bounded, N>| (Dual::variable(time), along(&place, &velocity), along(&velocity, a));
    if system.is_first_order() {
        let (time, q, v) = moving(&SVector::repeat(Bounded::exact(0.0)));
        let missing = applied - slopes(&dual.momentum(time, &q, &v));
        let bounds = bounded.applied(time.value, &place, &velocity);
        let found = vector_of(&system.convert::<f64>().applied(sample.t, &sample.q, &sample.v), &bounds);
        check.vector("force without inertia", &found, &missing)?;
        let (time, q, v) = moving(&a);
        let rate = slopes(&dual.applied(time, &q, &v));
        check.vector("rate of the force without inertia", &rate, &SVector::repeat(Bounded::exact(0.0)))?;
    } else if is_free {
        let (time, q, v) = moving(&a);
        check.vector("rate of the momentum", &slopes(&dual.momentum(time, &q, &v)), &applied)?;
    }
    // The point evaluation of Gauss steps must agree too.
    let (point, bounds) = (system.point(*t, q, v), bounded.point(time, &place, &velocity));
    check.vector("momentum at a point", &vector_of(&point.momentum, &bounds.momentum), &momentum)?;
    check.vector("force at a point", &vector_of(&point.force, &bounds.force), &applied)?;
    let by_v = array::from_fn(|j| dual.momentum(Dual::fixed(time), &lift(&place), &along(&velocity, &unit(j))));
    matrix(check, "mass at a point", (&point.mass, &bounds.mass), &columns(&by_v, |momentum| *momentum))?;
    let power = bounded.force(time, &place, &velocity).dot(&velocity)
        - dual.lagrangian(Dual::variable(time), &lift(&place), &lift(&velocity)).slope;
    check.number("power", bounded.power(time, &place, &velocity).of(system.power(*t, q, v)), power)
}

/// The acceleration, with bounds for the residual of its equations.
fn acceleration<const N: usize, S: MotionChecked<N>>(
    Sample { system, t, q, v, .. }: &Sample<S, N>,
    check: &Comparison,
) -> Result<SVector<Bounded, N>, CheckFailure> {
    let a = system.acceleration(*t, q, v).map_err(|error| check.step(error))?;
    let bounds = system.convert::<Bounded>().acceleration(Bounded::exact(*t), &exact(q), &exact(v));
    let bounds = bounds.map_err(|error| check.step(error))?;
    Ok(SVector::from_vec(solution(a.as_slice(), bounds.as_slice(), N)))
}

/// The step density D, from L and the acceleration.
pub(super) fn density<const N: usize, S: MotionChecked<N>>(
    sample: &Sample<S, N>,
    check: &Comparison,
) -> Result<Bounded, CheckFailure> {
    let Sample { system, t, q, v, .. } = sample;
    let (bounded, second) = (system.convert::<Bounded>(), system.convert::<Second>());
    let (time, place, velocity) = (Bounded::exact(*t), exact(q), exact(v));
    let a = acceleration(sample, check)?;
    let (gradient, gradient_rate, time_rate) = gradient_and_rates(&second, *t, [&place, &velocity, &a]);
    let applied = gradient + bounded.force(time, &place, &velocity);
    Ok(a.dot(&applied) - velocity.dot(&gradient_rate) - time_rate)
}

/// Derivatives of a vector in each direction, one column per direction.
pub(super) fn columns<R, const N: usize>(
    directions: &[R; N],
    vector: impl Fn(&R) -> SVector<First, N>,
) -> SMatrix<Bounded, N, N> {
    SMatrix::from_columns(&directions.each_ref().map(|direction| slopes(&vector(direction))))
}

/// Compares a matrix with the expected one, column by column.
pub(super) fn matrix<const N: usize>(
    check: &mut Comparison,
    what: &'static str,
    (found, bounds): (&impl Matrix<N, f64>, &impl Matrix<N, Bounded>),
    wanted: &SMatrix<Bounded, N, N>,
) -> Result<(), CheckFailure> {
    let found = bounds.dense().zip_map(&found.dense(), Bounded::of);
    found.column_iter().zip(wanted.column_iter()).try_for_each(|(found, wanted)| {
        let [found, wanted] = [found, wanted].map(nalgebra::Matrix::into_owned);
        check.vector(what, &found, &wanted)
    })
}

fn point<const N: usize, S: MotionChecked<N>>(
    sample: &Sample<S, N>,
    check: &mut Comparison,
) -> Result<(), CheckFailure> {
    let Sample { system, t, q, v, .. } = sample;
    let (bounded, dual) = (system.convert::<Bounded>(), system.convert::<First>());
    let (time, place, velocity) = (Bounded::exact(*t), exact(q), exact(v));
    let found = system.convert::<f64>().point_derivatives(*t, q, v);
    let again = bounded.point_derivatives(time, &place, &velocity);
    let at = |q: &SVector<First, N>, v: &SVector<First, N>| dual.point(Dual::fixed(time), q, v);
    let by_q = array::from_fn(|j| at(&along(&place, &unit(j)), &lift(&velocity)));
    let by_v = array::from_fn(|j| at(&lift(&place), &along(&velocity, &unit(j))));
    let [momentum_dq, mass] = [&by_q, &by_v].map(|by| columns(by, |point| point.momentum));
    let [force_dq, force_dv] = [&by_q, &by_v].map(|by| columns(by, |point| point.force));
    matrix(check, "momentum_dq", (&found.momentum_dq, &again.momentum_dq), &momentum_dq)?;
    matrix(check, "mass", (&found.mass, &again.mass), &mass)?;
    matrix(check, "force_dq", (&found.force_dq, &again.force_dq), &force_dq)?;
    matrix(check, "force_dv", (&found.force_dv, &again.force_dv), &force_dv)
}

/// The evaluation of steps in transformed time against the functions that it joins, and the derivatives of g.
fn scaled_point<const N: usize, S: MotionChecked<N>>(
    sample: &Sample<S, N>,
    check: &mut Comparison,
) -> Result<(), CheckFailure> {
    let Sample { system, t, q, v, .. } = sample;
    if !system.scales_time() {
        return Ok(());
    }
    let (bounded, dual) = (system.convert::<Bounded>(), system.convert::<First>());
    let (time, place, velocity) = (Bounded::exact(*t), exact(q), exact(v));
    let (found, bounds) = (system.scaled_point(*t, q, v), bounded.scaled_point(time, &place, &velocity));
    let point = bounded.point(time, &place, &velocity);
    let momentum = vector_of(&found.point.momentum, &bounds.point.momentum);
    check.vector("momentum in transformed time", &momentum, &point.momentum)?;
    let force = vector_of(&found.point.force, &bounds.point.force);
    check.vector("force in transformed time", &force, &point.force)?;
    let mass = (&found.point.mass, &bounds.point.mass);
    matrix(check, "mass in transformed time", mass, &point.mass.dense())?;
    let energy = bounded.energy(time, &place, &velocity);
    check.number("energy in transformed time", bounds.energy.of(found.energy), energy)?;
    let power = bounded.power(time, &place, &velocity);
    check.number("power in transformed time", bounds.power.of(found.power), power)?;
    let slope = |time, place: &SVector<First, N>| dual.scaled_point(time, place, &lift(&velocity)).g.slope;
    let g_dq = SVector::from_fn(|j, _| slope(Dual::fixed(time), &along(&place, &unit(j))));
    check.vector("g_dq", &vector_of(&found.g_dq, &bounds.g_dq), &g_dq)?;
    check.number("g_dt", bounds.g_dt.of(found.g_dt), slope(Dual::variable(time), &lift(&place)))
}

/// A row is a sum with a rounding error of at least half an ulp of itself.
pub(super) fn enough(residual: f64, rounding: f64, check: &mut Comparison) -> Result<(), CheckFailure> {
    let least = 0.5 * residual.abs();
    check.number("rounding", Bounded::exact(rounding.max(least)), Bounded::nearest(least).of(rounding))
}
