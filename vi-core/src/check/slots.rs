//! The slots of the discrete system against L_d, L and f.
//!
//! ```text
//! D1 = ∂L_d/∂t0    D2 = ∂L_d/∂q0    D3 = ∂L_d/∂t1    D4 = ∂L_d/∂q1                by dual numbers
//! L_d/h → L        (f_d⁻ + f_d⁺)/h → f        (g_d⁻ + g_d⁺)/h → −f·v              as h → 0
//! ```
//!
//! Tolerance: as in `derivatives`, the rounding-error bounds of both sides. The limits are approached from 1/64 of the
//! samples' step, which is a fraction of the system's own time scale, about one midpoint.

use super::bounded::{Bounded, vector_of};
use super::comparison::Comparison;
use super::derivatives::First;
use super::report::{CheckFailure, Report};
use super::sample::{Sample, step_samples};
use super::subject::{Checked, Place};
use crate::discrete::DiscreteLagrangian;
use crate::lagrangian::Lagrangian;
use crate::real::Real;
use crate::real::dual::Dual;
use crate::real::dual::{along, unit};
use crate::state::Interval;
use alloc::vec::Vec;
use nalgebra::SVector;

/// Initial fractions of the step for a limit: two, since the distance may be zero at one by chance.
const FAR: [f64; 2] = [1.0 / 64.0, 1.0 / 128.0];
/// Final fraction of the step.
const NEAR: f64 = 1.0 / 1024.0;
/// Required reduction of the distance: that of a rule of order one falls to 1/16, and from the nearer fraction to 1/8.
const FALL: f64 = 0.3;

/// Tests slot derivatives against dual numbers, and L_d, discrete forces and powers against their limits.
///
/// # Errors
/// The first number that differs; [`CheckFailure::Vacuous`] if L_d, D2 or D4, or f_d of a forced system, is zero
/// throughout.
pub fn slots<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(system.name(), "slots");
    for sample in step_samples(system, place, &check)? {
        by_slot(&sample, &mut check)?;
        limits(&sample, &mut check)?;
    }
    check.finish(if system.is_forced() { &["L_d", "D2", "D4", "f_d"] } else { &["L_d", "D2", "D4"] })
}

/// Converts an interval to other numbers.
pub(super) fn between<const N: usize, T: Real>(interval: &Interval<N>, number: impl Fn(f64) -> T) -> Interval<N, T> {
    let Interval { t0, q0, t1, q1 } = interval;
    Interval { t0: number(*t0), q0: q0.map(&number), t1: number(*t1), q1: q1.map(&number) }
}

fn by_slot<const N: usize, S: Checked<N>>(sample: &Sample<S, N>, check: &mut Comparison) -> Result<(), CheckFailure> {
    let (system, interval) = (&sample.system, sample.interval());
    let (bounded, dual) = (system.steps::<Bounded>(), system.steps::<First>());
    let known = between(&interval, Bounded::exact);
    let still = between(&interval, |number| Dual::fixed(Bounded::exact(number)));
    let Interval { t0, q0, t1, q1 } = known;
    check.number("L_d", bounded.ld(&known).of(system.ld(&interval)), dual.ld(&still).value)?;
    let d1 = dual.ld(&Interval { t0: Dual::variable(t0), ..still }).slope;
    check.number("D1", bounded.d1_ld(&known).of(system.d1_ld(&interval)), d1)?;
    let d3 = dual.ld(&Interval { t1: Dual::variable(t1), ..still }).slope;
    check.number("D3", bounded.d3_ld(&known).of(system.d3_ld(&interval)), d3)?;
    let d2 = SVector::from_fn(|i, _| dual.ld(&Interval { q0: along(&q0, &unit(i)), ..still }).slope);
    check.vector("D2", &vector_of(&system.d2_ld(&interval), &bounded.d2_ld(&known)), &d2)?;
    let d4 = SVector::from_fn(|i, _| dual.ld(&Interval { q1: along(&q1, &unit(i)), ..still }).slope);
    check.vector("D4", &vector_of(&system.d4_ld(&interval), &bounded.d4_ld(&known)), &d4)
}

/// Tests that L_d, f_d and g_d over a smaller fraction of the step are nearer to L, f and −f·v by [`FALL`], or equal to
/// rounding.
fn limits<const N: usize, S: Checked<N>>(sample: &Sample<S, N>, check: &mut Comparison) -> Result<(), CheckFailure> {
    let system = sample.system.steps::<Bounded>();
    let pairs = |part: f64| {
        let interval = between(&sample.about(part), Bounded::exact);
        let Interval { t0, q0, t1, q1 } = &interval;
        let (h, half) = (*t1 - *t0, Bounded::exact(0.5));
        let (t, q, v) = (*t0 + h * half, (q0 + q1) * half, (q1 - q0).map(|way| way / h));
        let force = system.force(t, &q, &v);
        let average = (system.fd_minus(&interval) + system.fd_plus(&interval)).map(|force| force / h);
        let power = (system.gd_minus(&interval) + system.gd_plus(&interval)) / h;
        let numbers =
            [("L_d/h", system.ld(&interval) / h, system.lagrangian(t, &q, &v)), ("g_d", power, -force.dot(&v))];
        let forces = average.iter().zip(force.iter()).map(|(average, force)| ("f_d", *average, *force));
        numbers.into_iter().chain(forces).collect::<Vec<_>>()
    };
    let far = FAR.map(pairs);
    for (index, (what, found, wanted)) in pairs(NEAR).into_iter().enumerate() {
        let distances = far.iter().filter_map(|pairs| pairs.get(index)).map(|(_, far, goal)| (*far - *goal).most());
        let allowed = distances.fold(0.0, f64::max) * FALL;
        check.number(what, found, Bounded { error: wanted.error + allowed, ..wanted })?;
    }
    Ok(())
}
