//! Every generated derivative against dual numbers.
//!
//! ```text
//! p = ∂L/∂v      E = v·p − L      d/dt ∂L/∂v = L_q + f      D = a·(L_q + f) − v·d/dt(L_q) − d/dt(L_t)
//! A = ∂r/∂v
//! ```
//!
//! Left: what the system says. Right: L, and the residual r of a step, differentiated operation by operation.
//! Rounding: both sides are evaluated in numbers that carry the bound of theirs (`bounded`), and may differ by the sum of
//! the two bounds. h is that of the samples, a part of the system's own time scale: the place's h does not enter.

use super::bounded::{Bounded, exact, vector_of};
use super::comparison::Comparison;
use super::report::{CheckFailure, Report};
use super::sample::{Sample, samples};
use super::subject::{Checked, Place};
use crate::lagrangian::Lagrangian;
use crate::linear::Matrix;
use crate::real::dual::Dual;
use crate::real::dual::{along, lift, slopes, unit};
use crate::stepping::FixedStepping;
use nalgebra::SVector;

/// Dual numbers for first derivatives, and for second ones.
pub(super) type First = Dual<Bounded>;
type Second = Dual<First>;

/// Momentum, energy, acceleration, step density, and the Jacobian of a fixed step, against dual numbers.
///
/// # Errors
/// The first number that differs; [`CheckFailure::Vacuous`] where momentum, energy or the Jacobian is zero throughout.
pub fn derivatives<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "derivatives");
    for sample in samples(system, place, &check)? {
        continuous(&sample, &mut check)?;
        jacobian(&sample, &mut check)?;
    }
    check.finish(&["momentum", "energy", "residual_dv"])
}

/// `∂L/∂q`, its rate and that of `∂L/∂t` along the motion (1, v, a), by second-order dual numbers.
fn gradient_and_rates<const N: usize>(
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

fn continuous<const N: usize, S: Checked<N>>(
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

    let a = system.acceleration(*t, q, v).map_err(|error| check.step(error))?;
    let bound = bounded.acceleration(time, &place, &velocity).map_err(|error| check.step(error))?;
    let a = vector_of(&a, &bound);
    let rate = slopes(&dual.momentum(Dual::variable(time), &along(&place, &velocity), &along(&velocity, &a)));
    let (gradient, gradient_rate, time_rate) = gradient_and_rates(&second, *t, [&place, &velocity, &a]);
    let applied = gradient + bounded.force(time, &place, &velocity);
    check.vector("rate of the momentum", &rate, &applied)?;
    let density = a.dot(&applied) - velocity.dot(&gradient_rate) - time_rate;
    let found = system.step_density(*t, q, v).map_err(|error| check.step(error))?;
    let bound = bounded.step_density(time, &place, &velocity).map_err(|error| check.step(error))?;
    check.number("step density", bound.of(found), density)
}

fn jacobian<const N: usize, S: Checked<N>>(sample: &Sample<S, N>, check: &mut Comparison) -> Result<(), CheckFailure> {
    let Sample { system, v, h, .. } = sample;
    let (node, bounded, dual) = (sample.node(), system.convert::<Bounded>(), system.convert::<First>());
    let found = system.momentum_equation(&node, *h, v);
    let known = node.map(Bounded::exact);
    let lifted = node.map(|number| Dual::fixed(Bounded::exact(number)));
    let (step, velocity) = (Bounded::exact(*h), exact(v));
    let bounds = bounded.momentum_equation(&known, step, &velocity).jacobian.dense();
    let matrix = found.jacobian.dense();
    for j in 0..N {
        let column = dual.momentum_equation(&lifted, Dual::fixed(step), &along(&velocity, &unit(j)));
        let (entries, bound) = (matrix.column(j).into_owned(), bounds.column(j).into_owned());
        check.vector("residual_dv", &vector_of(&entries, &bound), &slopes(&column.residual))?;
    }
    let rounding = system.momentum_rounding(&node, *h, v);
    found.residual.iter().zip(rounding.iter()).try_for_each(|(residual, rounding)| enough(*residual, *rounding, check))
}

/// A row is a sum that loses at least half an ulp of itself.
pub(super) fn enough(residual: f64, rounding: f64, check: &mut Comparison) -> Result<(), CheckFailure> {
    let least = 0.5 * residual.abs();
    check.number("rounding", Bounded::exact(rounding.max(least)), Bounded::once(least).of(rounding))
}
