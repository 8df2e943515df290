//! The order of the rule.
//!
//! Fixed steps h, h/2, … from a place are compared with an accurate reference trajectory, which uses only the
//! acceleration. For each coordinate the check fits the slope of log(error) over log(h). The error is the largest over
//! the run, relative to the size of the coordinate: its largest value, and its largest displacement in the time t,
//! because t is rounded too.
//!
//! Tolerance: the rounding errors of all steps, amplified by the motion, and those of the reference. The error is
//! measured twice, from the place and from a place [`DISTANCE`] ulps away, with references in different parts. The error
//! of the rule is the same in both up to its last digits, so that their difference is rounding error. The reference
//! adds 32 changes and times, which may round equally in both:
//!
//! ```text
//! rounding-error bound = 4 max over the run of |error − error'|, and at least 128 ε (|q| + |t v|)
//! ```

use super::comparison::Comparison;
use super::ladder::{Measured, PowerLaw};
use super::report::{CheckFailure, Report};
use super::sample::SampledMotion;
use super::subject::{Checked, Place, STEPS};
use super::trajectory::Trajectory;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::{FixedStep, Method};
use crate::run::{Run, Starts};
use crate::state::State;
use alloc::vec::Vec;
use nalgebra::SVector;

/// Distance of the two places, in ulps of each coordinate and velocity.
const DISTANCE: f64 = 64.0;
/// Rounding-error bound of one run, in units of the difference of two.
const BOUND: f64 = 4.0;

/// Tests that the error of fixed steps decreases with h to the power `order` or a higher one: 2 for the midpoint and
/// the trapezoidal rule. If every error is a rounding error, the steps are exact, as for a constant force.
///
/// # Errors
/// A smaller slope; [`CheckFailure::StepTooSmall`] for fewer than three errors above rounding;
/// [`CheckFailure::Vacuous`] if nothing accelerates; a failed step.
pub fn order<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>, order: u32) -> Result<Report, CheckFailure> {
    let check = Comparison::new(system.name(), "order");
    judged(&check, system, place, order, |start, h| system.at_state(start).integrate(FixedStep, h))
}

/// Tests the order of the runs that `begin` starts from a state with a step, as [`order`].
pub(super) fn judged<const N: usize, S: Lagrangian<N>, M: Method<Y, N>, Y: Lagrangian<N> + Copy>(
    check: &Comparison,
    system: &S,
    place: &Place<N>,
    order: u32,
    begin: impl Fn(State<N>, f64) -> Result<Run<M, Y, N>, StepError>,
) -> Result<Report, CheckFailure> {
    let motion = SampledMotion::from(system, place, check)?;
    if !motion.accelerates() {
        return Err(check.vacuous("nothing accelerates, so that steps of any rule are exact; choose another place"));
    }
    let start = Trajectory { t: place.t, q: place.q, v: place.v };
    let moved = |vector: &SVector<f64, N>| vector * (1.0 + DISTANCE * f64::EPSILON);
    let other = Trajectory { q: moved(&start.q), v: moved(&start.v), ..start };
    let paths = |h: f64| -> Result<_, CheckFailure> {
        let paths = [Path::from(system, start, h, 1), Path::from(system, other, h, 2)];
        let [path, other] = paths.map(|path| path.map_err(|error| check.step(error)));
        Ok([path?, other?])
    };
    let measure = |[path, other]: &[Path<N>; 2], halvings: u32| {
        let errors = [path.errors(system, halvings, &begin), other.errors(system, halvings, &begin)];
        let [errors, again] = errors.map(|errors| errors.map_err(|error| check.step(error)));
        Ok(measured(&path.size(), &errors?, &again?))
    };
    let quantities = system.coordinates().map(|name| format!("the error of `{name}`")).to_vec();
    let law = PowerLaw { name: "the order", quantities, slope: f64::from(order), every: false };
    law.judge(check, [place.h, motion.h], paths, measure)
}

/// The error of each coordinate, and its rounding error, from the errors along two runs.
fn measured<const N: usize>(
    size: &SVector<f64, N>,
    errors: &[SVector<f64, N>],
    again: &[SVector<f64, N>],
) -> Vec<Measured> {
    let worst = |errors: &mut dyn Iterator<Item = SVector<f64, N>>| {
        errors.fold(SVector::<f64, N>::zeros(), |worst, error| {
            worst.zip_map(&error, |worst, error| larger(worst, error.abs()))
        })
    };
    let error = worst(&mut errors.iter().copied());
    let rounding = worst(&mut errors.iter().zip(again).map(|(one, other)| one - other));
    let part = |number: f64, of: f64| if number == 0.0 { 0.0 } else { number / of };
    let measured = |index: usize| Measured {
        quantity: part(error[index], size[index]),
        rounding: BOUND * part(rounding[index], size[index]).max(f64::from(STEPS) * f64::EPSILON),
    };
    (0..N).map(measured).collect()
}

/// The larger of two numbers; NaN if either is NaN.
fn larger(one: f64, other: f64) -> f64 {
    if one > other || one.is_nan() { one } else { other }
}

/// The reference trajectory at equal time intervals.
struct Path<const N: usize> {
    h: f64,
    states: Vec<Trajectory<N>>,
}

impl<const N: usize> Path<N> {
    /// The reference over [`STEPS`] steps h, each integrated in this many parts.
    fn from<S: Lagrangian<N>>(system: &S, start: Trajectory<N>, h: f64, parts: u32) -> Result<Self, StepError> {
        let mut states = vec![start];
        let mut now = start;
        for index in 1..=STEPS * parts {
            now = now.at(system, start.t + h * f64::from(index) / f64::from(parts))?;
            if index % parts == 0 {
                states.push(now);
            }
        }
        Ok(Self { h, states })
    }

    /// The size of each coordinate.
    fn size(&self) -> SVector<f64, N> {
        let size = |state: &Trajectory<N>| state.q.abs() + state.v.abs() * state.t.abs();
        self.states.iter().fold(SVector::zeros(), |largest, state| largest.sup(&size(state)))
    }

    /// Errors of steps of the length h, after this many halvings, along the reference.
    fn errors<S: Lagrangian<N>, M: Method<Y, N>, Y: Lagrangian<N> + Copy>(
        &self,
        system: &S,
        halvings: u32,
        begin: impl Fn(State<N>, f64) -> Result<Run<M, Y, N>, StepError>,
    ) -> Result<Vec<SVector<f64, N>>, StepError> {
        let parts = 1_u32 << halvings;
        let Some((first, others)) = self.states.split_first() else { return Ok(vec![]) };
        let start = State::at(system, first.t, first.q, first.v);
        let mut run = begin(start, self.h / f64::from(parts))?;
        let error = |state: &Trajectory<N>| {
            let mut reached = run.step()?;
            for _ in 1..parts {
                reached = run.step()?;
            }
            Ok(reached.q - state.q)
        };
        others.iter().map(error).collect()
    }
}
