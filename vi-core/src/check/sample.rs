//! Samples for the comparison of formulas: states near the trajectory from a place, with parameters near the given
//! ones.
//!
//! [`SampledMotion`] has the trajectory from a [`Place`] of a system, on the time scale of the system, not of the
//! place's h. No coordinate, velocity or parameter of a sample has a value that could hide a term, such as zero and
//! one. A formula holds for every h. At a fraction of the time scale its terms are of similar size; with a small h of
//! the place, a term of order h² would lie below the rounding error of the others.

use super::comparison::Comparison;
use super::report::CheckFailure;
use super::subject::{Checked, MotionChecked, Place, STEPS};
use super::trajectory::Trajectory;
use crate::constrained::Extended;
use crate::error::StepError;
use crate::kind::Kind;
use crate::lagrangian::{Lagrangian, Parameters};
use crate::linear::Matrix;
use crate::node::Node;
use crate::state::{Interval, State};
use alloc::vec::Vec;
use nalgebra::{SMatrix, SVector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Samples per place.
const SAMPLES: u32 = 8;
/// Distance of the samples from the trajectory, relative to its extent.
const DISTANCE: f64 = 0.5;
/// Relative variation of a parameter.
const VARIATION: f64 = 0.1;
/// Smallest extent of a coordinate, relative to the largest one in the measure of kinetic energy.
const LEAST: f64 = 1e-2;
/// Phase, in radians, of the fastest coordinate after which the trajectory has turned.
const TURN: f64 = 2.0;
/// Doublings of the time span for a trajectory that does not turn.
const DOUBLINGS: u32 = 40;
/// Most trial steps between two states beyond the place's own steps.
const TRIALS: u32 = 256;
/// Smallest step, in ulps of the time.
const LOST: f64 = 16.0;
/// Most moves of a sample without a value half way toward the trajectory.
const RETREATS: u32 = 6;

/// A system with varied parameters at a state.
pub(super) struct Sample<S, const N: usize> {
    pub(super) system: S,
    pub(super) t: f64,
    pub(super) q: SVector<f64, N>,
    pub(super) v: SVector<f64, N>,
    pub(super) h: f64,
}

/// The trajectory from a place, until it has turned: at least over [`STEPS`] steps of the place's length, and beyond as
/// far as the integration succeeds.
pub(super) struct SampledMotion<const N: usize> {
    /// States at equal time intervals.
    pub(super) states: Vec<Trajectory<N>>,
    /// The step length: the span divided by [`STEPS`].
    pub(super) h: f64,
}

impl<const N: usize> SampledMotion<N> {
    /// The trajectory from a place.
    ///
    /// # Errors
    /// A failed integration over the place's own steps; [`CheckFailure::Vacuous`] if nothing moves.
    pub(super) fn from<S: Lagrangian<N>>(
        system: &S,
        place: &Place<N>,
        check: &Comparison,
    ) -> Result<Self, CheckFailure> {
        let resolution = f64::EPSILON * place.t.abs();
        if place.h < LOST * resolution {
            let why = format!("t = {:.0e} is rounded by {resolution:.0e}", place.t);
            return Err(check.too_small("steps", Some(LOST * LOST * resolution), why));
        }
        let mut motion = Self::over(system, place, place.h, u32::MAX).map_err(|error| check.step(error))?;
        for _ in 0..DOUBLINGS {
            if motion.has_turned(system).map_err(|error| check.step(error))? {
                break;
            }
            // The place guarantees only its own steps.
            match Self::over(system, place, 2.0 * motion.h, TRIALS) {
                Ok(longer) => motion = longer,
                Err(_) => break,
            }
        }
        if motion.range(|state| state.q).amax() == 0.0 {
            return Err(check.vacuous("nothing moves from this place; choose another place"));
        }
        Ok(motion)
    }

    /// The trajectory over [`STEPS`] steps h, with a limit of trial steps from one state to the next.
    pub(super) fn over<S: Lagrangian<N>>(system: &S, place: &Place<N>, h: f64, trials: u32) -> Result<Self, StepError> {
        let mut now = Trajectory { t: place.t, q: place.q, v: place.v };
        let mut states = vec![now];
        for index in 1..SAMPLES {
            let end = place.t + h * f64::from(STEPS) * f64::from(index) / f64::from(SAMPLES - 1);
            now = now.within(system, end, trials)?;
            states.push(now);
        }
        Ok(Self { states, h })
    }

    /// Whether a coordinate has passed a substantial phase, if its acceleration is `−ω² q` plus a constant.
    fn has_turned<S: Lagrangian<N>>(&self, system: &S) -> Result<bool, StepError> {
        let accelerations = self.states.iter().map(|state| system.acceleration(state.t, &state.q, &state.v));
        let accelerations: Vec<_> = accelerations.collect::<Result<_, _>>()?;
        let (acceleration, distance) = (range(accelerations.into_iter()), self.range(|state| state.q));
        let squares = acceleration.zip_map(&distance, |a, q| if q > 0.0 { a / q } else { 0.0 });
        Ok(squares.amax().sqrt() * self.h * f64::from(STEPS) >= TURN)
    }

    /// Whether a velocity changes.
    pub(super) fn accelerates(&self) -> bool {
        self.range(|state| state.v).amax() > 0.0
    }

    /// The largest distances from the value at the first state.
    fn range(&self, of: impl Fn(&Trajectory<N>) -> SVector<f64, N>) -> SVector<f64, N> {
        range(self.states.iter().map(of))
    }

    /// Nonzero distances for each coordinate and velocity: their extents or, if these are tiny, the extents of a fixed
    /// part of the same kinetic energy.
    fn extent(&self, mass: impl Fn(&Trajectory<N>) -> SMatrix<f64, N, N>) -> [SVector<f64, N>; 2] {
        let Some(first) = self.states.first() else { return [SVector::zeros(); 2] };
        let mass = mass(first);
        let weights = SVector::<f64, N>::from_fn(|row, _| match mass[(row, row)].abs().sqrt() {
            weight if weight > 0.0 => weight,
            _ => mass.row(row).amax().sqrt(),
        });
        let positive = |range: SVector<f64, N>, otherwise: SVector<f64, N>| {
            let largest = |entries: &SVector<f64, N>| entries.component_mul(&weights).amax();
            let largest = if range.amax() > 0.0 { largest(&range) } else { largest(&otherwise) };
            range.zip_map(&weights, |entry, weight| entry.max(LEAST * largest / weight))
        };
        let speeds = |_: &Trajectory<N>| first.v.abs();
        let [q, v] = [self.range(|state| state.q), self.range(|state| state.v)];
        [positive(q, q), positive(v, speeds(first))]
    }

    /// The samples near this trajectory, each with values of the system.
    fn samples<S: Lagrangian<N> + Parameters + Copy>(
        &self,
        system: &S,
        mass: impl Fn(&Trajectory<N>) -> SMatrix<f64, N, N>,
        is_defined: fn(&Sample<S, N>) -> bool,
    ) -> Vec<Sample<S, N>> {
        let extent = self.extent(mass);
        let mut draw = Sequence(7);
        let sample = |state: &Trajectory<N>| {
            let drawn = draw;
            let mut part = 1.0;
            for _ in 0..RETREATS {
                draw = drawn;
                let sample = near(system, state, self.h, &extent, part, &mut draw);
                if is_defined(&sample) {
                    return sample;
                }
                part /= 2.0;
            }
            near(system, state, self.h, &extent, 0.0, &mut draw)
        };
        self.states.iter().map(sample).collect()
    }
}

/// The nearest place on the constraints; without constraints the place itself. If L is linear in the velocities, they
/// are replaced by the velocities of the coordinates.
///
/// # Errors
/// As [`State::projected`].
pub(super) fn placed<const N: usize, S: MotionChecked<N>>(
    system: &S,
    place: &Place<N>,
    check: &Comparison,
) -> Result<Place<N>, CheckFailure> {
    if const { S::Kind::COUNT == 0 } && !system.is_first_order() {
        return Ok(*place);
    }
    let nearest = State::projected(system, place.t, place.q, place.v).map_err(|error| check.step(error))?;
    Ok(Place { q: place.q + nearest.moved_q, v: place.v + nearest.moved_v, ..*place })
}

/// The samples near the trajectory from a place, with constraints most of them off the constraints.
///
/// # Errors
/// As [`SampledMotion::from`].
pub(super) fn samples<const N: usize, S: MotionChecked<N>>(
    system: &S,
    place: &Place<N>,
    check: &Comparison,
) -> Result<Vec<Sample<S, N>>, CheckFailure> {
    let is_first_order = system.is_first_order();
    let mass = |at: &Trajectory<N>| {
        // Without masses, lengths of the coordinates are compared.
        if is_first_order { SMatrix::identity() } else { system.point(at.t, &at.q, &at.v).mass.dense() }
    };
    let has_values = |Sample { system, t, q, v, h }: &Sample<S, N>| {
        Sample { system: Extended(*system), t: *t, q: *q, v: *v, h: *h }.has_values()
    };
    Ok(SampledMotion::from(&Extended(*system), place, check)?.samples(system, mass, has_values))
}

/// The same samples, restricted to those from which a step also has values.
///
/// # Errors
/// As [`SampledMotion::from`].
pub(super) fn step_samples<const N: usize, S: Checked<N>>(
    system: &S,
    place: &Place<N>,
    check: &Comparison,
) -> Result<Vec<Sample<S, N>>, CheckFailure> {
    let mass = |at: &Trajectory<N>| system.point(at.t, &at.q, &at.v).mass.dense();
    Ok(SampledMotion::from(system, place, check)?.samples(system, mass, Sample::has_step))
}

/// The largest distances from the first vector, entry by entry.
fn range<const N: usize>(mut vectors: impl Iterator<Item = SVector<f64, N>>) -> SVector<f64, N> {
    let Some(first) = vectors.next() else { return SVector::zeros() };
    vectors.fold(SVector::zeros(), |range, vector| range.sup(&(vector - first).abs()))
}

/// The sample near a state: part 1 is the largest distance, part 0 the state itself.
fn near<const N: usize, S: Lagrangian<N> + Parameters + Copy>(
    system: &S,
    state: &Trajectory<N>,
    h: f64,
    [extent_q, extent_v]: &[SVector<f64, N>; 2],
    part: f64,
    draw: &mut Sequence,
) -> Sample<S, N> {
    let mut moved = |entry: f64, extent: f64| entry + DISTANCE * part * extent * draw.next();
    let (q, v) = (state.q.zip_map(extent_q, &mut moved), state.v.zip_map(extent_v, &mut moved));
    let mut varied = *system;
    for name in system.parameters() {
        if let Some(parameter) = varied.parameter_mut(name) {
            *parameter *= 1.0 + VARIATION * part * draw.next();
        }
    }
    Sample { system: varied, t: state.t, q, v, h }
}

impl<S: Lagrangian<N>, const N: usize> Sample<S, N> {
    /// The interval that starts here, with the velocity of the sample.
    pub(super) fn interval(&self) -> Interval<N> {
        Interval { t0: self.t, q0: self.q, t1: self.t + self.h, q1: self.q + self.v * self.h }
    }

    /// The interval with this midpoint, over a fraction of the step.
    pub(super) fn about(&self, part: f64) -> Interval<N> {
        let half = self.h * part / 2.0;
        Interval { t0: self.t - half, q0: self.q - self.v * half, t1: self.t + half, q1: self.q + self.v * half }
    }

    /// A node from which `(v, h)` is not a solution, so that the residuals are nonzero.
    pub(super) fn node(&self) -> Node<N> {
        let Self { system, t, q, v, .. } = self;
        let p = system.momentum(*t, q, &(v * 0.75));
        Node::new(State { t: *t, q: *q, p }, system.energy(*t, q, &(v * 0.5)))
    }

    /// Whether the equations of motion have values here; an exponent, for example, may exclude others.
    fn has_values(&self) -> bool {
        let Self { system, t, q, v, .. } = self;
        let Ok(acceleration) = system.acceleration(*t, q, v) else { return false };
        let sums = [acceleration, system.force(*t, q, v)].map(|vector| vector.sum());
        let numbers = [system.lagrangian(*t, q, v)];
        sums.iter().chain(&numbers).all(|number| number.is_finite())
    }
}

impl<S: Checked<N>, const N: usize> Sample<S, N> {
    /// Whether the equations of motion and the step have values here.
    fn has_step(&self) -> bool {
        let Self { system, v, h, .. } = self;
        let (node, interval) = (self.node(), self.interval());
        let residual = system.momentum_equation(&node, *h, v).residual.sum();
        let numbers = [residual, system.ld(&interval), system.discrete_energy(&node, *h, v)];
        self.has_values() && numbers.iter().all(|number| number.is_finite())
    }
}

/// A fixed pseudorandom sequence in (−1, 1): a linear congruential generator (Knuth and Lewis, Numerical Recipes,
/// section 7.1).
#[derive(Clone, Copy)]
struct Sequence(u32);

impl Sequence {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0) / f64::from(1_u32 << 31) - 1.0
    }
}
