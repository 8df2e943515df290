//! The slots of the discrete system against L_d, L and f.
//!
//! ```text
//! D1 = ∂L_d/∂t0    D2 = ∂L_d/∂q0    D3 = ∂L_d/∂t1    D4 = ∂L_d/∂q1                by dual numbers
//! L_d/h → L        (f_d⁻ + f_d⁺)/h → f        (g_d⁻ + g_d⁺)/h → −f·v              as h → 0
//! ```

use super::comparison::{Comparison, ROUNDING, Scale};
use super::derivatives::magnitude;
use super::dual::{along, lift, unit};
use super::report::{CheckFailure, Report};
use super::sample::{Sample, samples};
use super::{Checked, Dual, Place};
use crate::{DiscreteLagrangian, Interval};
use nalgebra::SVector;

/// Part of the step with which a limit is approached.
const PART: f64 = 0.25;
/// By so much the distance from a limit has to fall: a rule of order one falls by [`PART`].
const FALL: f64 = 0.4;

/// Slot derivatives against dual numbers; L_d, discrete forces and powers against what they stand for.
///
/// # Errors
/// The first number that differs; [`CheckFailure::Vacuous`] where L_d, D2 or D4, or f_d of a forced system, is zero
/// throughout.
pub fn slots<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    let mut check = Comparison::new(S::NAME, "slots", ROUNDING);
    for sample in samples(system, place, &check)? {
        by_slot(&sample, &mut check)?;
        limits(&sample, &mut check)?;
    }
    check.finish(if S::FORCED { &["L_d", "D2", "D4", "f_d"] } else { &["L_d", "D2", "D4"] })
}

fn by_slot<const N: usize, S: Checked<N>>(sample: &Sample<S, N>, check: &mut Comparison) -> Result<(), CheckFailure> {
    let (system, dual, interval) = (&sample.system, sample.system.convert::<Dual<f64>>(), sample.interval(1.0));
    let Interval { t0, q0, t1, q1 } = interval;
    let still = Interval { t0: Dual::fixed(t0), q0: lift(&q0), t1: Dual::fixed(t1), q1: lift(&q1) };
    let value = dual.ld(&still).value;
    let Scale { size, slack } = sample.scale();
    check.number("L_d", system.ld(&interval), value, Scale { size: sample.h * size, slack: sample.h * slack })?;
    let d1 = dual.ld(&Interval { t0: Dual::variable(t0), ..still }).slope;
    check.number("D1", system.d1_ld(&interval), d1, sample.scale())?;
    let d3 = dual.ld(&Interval { t1: Dual::variable(t1), ..still }).slope;
    check.number("D3", system.d3_ld(&interval), d3, sample.scale())?;
    let d2 = SVector::from_fn(|i, _| dual.ld(&Interval { q0: along(&q0, &unit(i)), ..still }).slope);
    check.vector("D2", &system.d2_ld(&interval), &d2, 0.0)?;
    let d4 = SVector::from_fn(|i, _| dual.ld(&Interval { q1: along(&q1, &unit(i)), ..still }).slope);
    check.vector("D4", &system.d4_ld(&interval), &d4, 0.0)
}

/// What L_d, f_d and g_d are to a whole step and to a part of it: nearer to L and f by [`FALL`], or equal to rounding.
fn limits<const N: usize, S: Checked<N>>(sample: &Sample<S, N>, check: &mut Comparison) -> Result<(), CheckFailure> {
    let system = &sample.system;
    let averages = |part: f64| {
        let interval = sample.interval(part);
        let h = interval.t1 - interval.t0;
        let force = (system.fd_minus(&interval) + system.fd_plus(&interval)) / h;
        (system.ld(&interval) / h, force, (system.gd_minus(&interval) + system.gd_plus(&interval)) / h)
    };
    let wanted = |part: f64| {
        let (t, q, v) = sample.middle(part);
        let force = system.force(t, &q, &v);
        (system.lagrangian(t, &q, &v), force, -force.dot(&v))
    };
    let ((ld, force, power), (ld_wanted, force_wanted, power_wanted)) = (averages(PART), wanted(PART));
    let ((ld_far, force_far, power_far), (ld_goal, force_goal, power_goal)) = (averages(1.0), wanted(1.0));
    // The distance from the whole step is allowed for, beside rounding.
    let scale = |of: Scale, far: f64| Scale { slack: of.slack + far.abs() * FALL, ..of };
    check.number("L_d/h", ld, ld_wanted, scale(sample.scale(), ld_far - ld_goal))?;
    for index in 0..N {
        let size = scale(force_wanted.amax().into(), force_far[index] - force_goal[index]);
        check.number("f_d", force[index], force_wanted[index], size)?;
    }
    check.number("g_d", power, power_wanted, scale(magnitude(&force_wanted, &sample.v).into(), power_far - power_goal))
}

impl<const N: usize, S: Checked<N>> Sample<S, N> {
    /// The interval that begins here, over a part of the step, with the velocity of the sample.
    fn interval(&self, part: f64) -> Interval<N> {
        let h = self.h * part;
        Interval { t0: self.t, q0: self.q, t1: self.t + h, q1: self.q + self.v * h }
    }

    /// The middle of that interval, with the velocity that its ends say: what rounding takes from it is the same here and
    /// in the slots.
    fn middle(&self, part: f64) -> (f64, SVector<f64, N>, SVector<f64, N>) {
        let Interval { t0, q0, t1, q1 } = self.interval(part);
        let h = t1 - t0;
        (t0 + h / 2.0, (q0 + q1) / 2.0, (q1 - q0) / h)
    }

    /// The terms of an energy, and what it loses where v is made of the ends of an interval.
    pub(super) fn scale(&self) -> Scale {
        let Self { system, t, q, v, h } = self;
        let momentum = system.momentum(*t, q, v);
        let size = magnitude(&momentum, v) + system.lagrangian(*t, q, v).abs();
        Scale { size, slack: lost_velocity(q, v, *t, *h) * momentum.abs().sum() }
    }
}

/// What rounding takes from v where it is made of the ends of an interval.
pub(super) fn lost_velocity<const N: usize>(q: &SVector<f64, N>, v: &SVector<f64, N>, t: f64, h: f64) -> f64 {
    4.0 * f64::EPSILON * (q.amax() + v.amax() * t.abs()) / h.abs()
}
