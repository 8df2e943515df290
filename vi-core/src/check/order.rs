//! The order of the rule.
//!
//! In: a place. The motion from there is taken by fixed steps h, h/2, … and, independently, followed accurately from
//! nothing but the acceleration. Out: for each coordinate the slope of log(error) over log(h), the error being the largest
//! over the run, relative to the size of the coordinate: its largest value, and how far it goes in the time t, which is
//! rounded too.
//!
//! Rounding: that of each step, grown as the motion makes it grow, and that of the accurate motion. So the error is
//! measured twice, from the place and from a place [`BESIDE`] roundings away, from which the accurate motion is followed in
//! other parts. The error of the rule is the same in both but for its last digits, so what they differ by is rounding. The
//! accurate motion adds 32 changes and times, which may round the same way in both:
//!
//! ```text
//! bound of rounding = 4 max over the run of |error − error'|, and 128 ε (|q| + |t v|) at least
//! ```

use super::comparison::Comparison;
use super::ladder::{Law, Measured};
use super::motion::Motion;
use super::report::{CheckFailure, Report};
use super::sample::Course;
use super::subject::{Checked, MotionChecked, Place, STEPS};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::{FixedStep, Method};
use crate::run::{Run, Starts};
use crate::state::State;
use nalgebra::SVector;

/// Roundings of each coordinate and velocity between the two places.
const BESIDE: f64 = 64.0;
/// The bound of the rounding of one run, in what two differ by.
const BOUND: f64 = 4.0;

/// The error of fixed steps falls with h to the power `order` or a higher one: 2 for the midpoint and the trapezoidal rule.
/// Where every error is one of rounding the steps are exact, as for a constant force.
///
/// # Errors
/// A smaller slope; [`CheckFailure::StepTooSmall`] for less than three errors above rounding; [`CheckFailure::Vacuous`]
/// where nothing accelerates; a step that is not taken.
pub fn order<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>, order: u32) -> Result<Report, CheckFailure> {
    let check = Comparison::new(S::NAME, "order");
    judged(&check, system, place, order, |start, h| system.at_state(start).integrate(FixedStep, h))
}

/// The same for the runs that `begin` makes from a state with a step.
pub(super) fn judged<const N: usize, S: MotionChecked<N>, M: Method<Y, N>, Y: Lagrangian<N> + Copy>(
    check: &Comparison,
    system: &S,
    place: &Place<N>,
    order: u32,
    begin: impl Fn(State<N>, f64) -> Result<Run<M, Y, N>, StepError>,
) -> Result<Report, CheckFailure> {
    let course = Course::from(system, place, check)?;
    if !course.accelerates() {
        return Err(check.vacuous("nothing accelerates, and steps of any rule are exact; choose another place"));
    }
    let start = Motion { t: place.t, q: place.q, v: place.v };
    let beside = |vector: &SVector<f64, N>| vector * (1.0 + BESIDE * f64::EPSILON);
    let other = Motion { q: beside(&start.q), v: beside(&start.v), ..start };
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
    let quantities = S::COORDINATES.map(|name| format!("the error of `{name}`")).to_vec();
    let law = Law { name: "the order", quantities, slope: f64::from(order), every: false };
    law.judge(check, [place.h, course.h], paths, measure)
}

/// The error of each coordinate, and its rounding, from the errors along two runs.
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

/// The larger of two numbers; not a number where either is not.
fn larger(one: f64, other: f64) -> f64 {
    if one > other || one.is_nan() { one } else { other }
}

/// The accurate motion at equal times.
struct Path<const N: usize> {
    h: f64,
    states: Vec<Motion<N>>,
}

impl<const N: usize> Path<N> {
    /// The motion over [`STEPS`] steps h, each followed in so many parts.
    fn from<S: MotionChecked<N>>(system: &S, start: Motion<N>, h: f64, parts: u32) -> Result<Self, StepError> {
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
        let size = |state: &Motion<N>| state.q.abs() + state.v.abs() * state.t.abs();
        self.states.iter().fold(SVector::zeros(), |largest, state| largest.sup(&size(state)))
    }

    /// What steps of the length h, so many times halved, are off by along the motion.
    fn errors<S: MotionChecked<N>, M: Method<Y, N>, Y: Lagrangian<N> + Copy>(
        &self,
        system: &S,
        halvings: u32,
        begin: impl Fn(State<N>, f64) -> Result<Run<M, Y, N>, StepError>,
    ) -> Result<Vec<SVector<f64, N>>, StepError> {
        let parts = 1_u32 << halvings;
        let Some((first, others)) = self.states.split_first() else { return Ok(vec![]) };
        let start = State::at(system, first.t, first.q, first.v);
        let mut run = begin(start, self.h / f64::from(parts))?;
        let error = |state: &Motion<N>| {
            let mut reached = run.step()?;
            for _ in 1..parts {
                reached = run.step()?;
            }
            Ok(reached.q - state.q)
        };
        others.iter().map(error).collect()
    }
}
