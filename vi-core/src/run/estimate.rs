//! Measurement errors of steps.
//!
//! For each coordinate this module measures the error of q and of h·v in one step. An [`ErrorMonitor`] reports the
//! largest relative error along the run and its time. A step is a pure function, so comparison with two steps of half
//! the length from the same node measures its error. With p the order of the method,
//!
//! ```text
//! error = |one step − two half steps| · 2^p/(2^p − 1)
//! ```
//!
//! The error of a coordinate is relative to a scale of its motion, the shorter one of
//!
//! ```text
//! excursion = largest |q_i − q_i(start)| and |h v_i| so far
//! reach     = range of the force F_i / largest |∂F_i/∂q_i|, at least a quarter of h times the largest change of v_i
//! ```
//!
//! An error as large as the reach changes the force by as much as it changes along the run. The reach does not depend
//! on origin and frame, and that of a rotor is one turn. A step cannot resolve less than the change of v in it, times
//! h. The relative error has no unit, so a large coordinate does not hide the error of a small one. A coordinate counts
//! if it moves by more than [`VISIBLE`] ulps of its own value, and if its `|p_i v_i|` exceeds `(4096 ε)²` of the
//! largest one. Smaller excursions are rounding errors that the other coordinates cause.
//!
//! Three further measurements only add to this. A step that changes a conserved H by more than a thousandth of the
//! energy has at least that error. A half step whose dense output does not begin with the velocity of its node misses
//! the motion. At the end of each window a conserved H is compared with H at the start, relative to the energies
//! between ([`EnergyPath`]): in a near collision or an escape, a small part of the large energies may be all the energy
//! of the orbit.
//!
//! The first stretch ends when every counted coordinate with a turning point has covered four times its excursion, or,
//! if none turns back, its force four times its range, or after [`STRETCH`] steps. Until then the scales grow, so the
//! largest error is relative to the scales at the time of the query. Later measurements are final.
//!
//! A monitor measures the first step, and those after a jump. Then it divides the run into windows of an eighth of the
//! steps so far, at most [`WINDOW`] steps. The indicator of a step is the change of the mean force of a coordinate,
//! relative to the largest change before the window: `h² |Δ(Δp_i/h)|`. A step whose indicator exceeds [`SUSPICIOUS`] is
//! measured at once, and of each window the step with the largest one. So no peak of a force passes unmeasured, and
//! the number of measurements grows by the logarithm of the largest change. On plunging Kepler orbits, walls and rotors
//! this indicator alone found every step that loses the motion, so there is none for the stages of a method. One
//! measurement costs about two steps (eight in transformed time). A run of 5000 steps measures 3 % of them, a long run
//! 1.1 %. The indicator costs about 60 instructions a step for one coordinate, 90 for two. A run without a monitor has
//! no extra cost.

mod energy;
mod local;
mod monitored;

pub use local::LocalError;
pub use monitored::Monitored;

use super::Run;
use crate::angles::{self, Turns};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::node::Node;
use crate::real::Scalar;
use crate::state::State;
use energy::EnergyPath;
use local::{Measurement, duration, measured};
use nalgebra::SVector;

/// A coordinate counts if it moves by more ulps than this.
const VISIBLE: f64 = 64.0;
/// A coordinate counts if the root of its `|p_i v_i|`, relative to the others, exceeds this many `ε`.
const FAINT: f64 = 4096.0;
/// A motion counts as rest if not even relative errors of this size would be visible.
const COARSEST: f64 = 1e-6;
/// The longest window between two measurements, in steps: about 1 % of their time.
const WINDOW: u64 = 200;
/// A step is measured at once if its indicator exceeds the largest one before its window by this factor.
const SUSPICIOUS: f64 = 1.25;
/// Lower bound of the scale of an error, in units of the largest change of `h v`.
const DEFLECTION: f64 = 0.25;
/// Most steps of the first stretch.
const STRETCH: u64 = 4096;
/// Steps after which errors are judged by the excursions so far, even if no coordinate has turned back.
const JUDGED: u64 = 64;
/// A coordinate that covers more than this part of its excursion has turned back.
const TURNED: f64 = 1.001;
/// Path length of a coordinate in the first stretch, in excursions: two full oscillations from a turning point.
const COVERED: f64 = 4.0;

/// A candidate for a measurement.
#[derive(Clone, Debug)]
struct Candidate<M, const N: usize, T> {
    before: Node<N, T>,
    after: Node<N, T>,
    memory: M,
    indicator: T,
}

/// The largest relative error of a step, and the time at which that step began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// Error of q and h·v in one step, relative to the scale of the motion of the coordinate: the largest entry. Infinite
    /// if the half steps of a step have no solution. If H has changed by more than a hundredth since the start although it
    /// is conserved, at least that part.
    pub estimate: f64,
    /// Time at which the step began.
    pub t: f64,
    /// Index of the coordinate.
    pub coordinate: usize,
    /// The errors of all steps so far, added up, in the same unit: the largest entry. Each step counts with the error
    /// of the measured one of its window, so that it is a bound rather than a mean. It is too large if errors cancel,
    /// as those of the energy of a symplectic method, and too small if neighbouring motions diverge.
    pub sum: f64,
}

impl ErrorEstimate {
    /// The estimate before the first measurement: zero, at t.
    fn none(t: f64) -> Self {
        Self { estimate: 0.0, t, coordinate: 0, sum: 0.0 }
    }

    fn or_larger(self, other: Self) -> Self {
        let larger = if other.estimate > self.estimate { other } else { self };
        Self { sum: self.sum.max(other.sum), ..larger }
    }
}

/// Monitors the steps of a run, and keeps the largest relative error. See [`Run::monitored`] and `docs/choosing.md`.
///
/// Errors are relative to the scale of the motion of a coordinate: the distance over which its force changes by its
/// range, or the largest `|q_i − q_i(start)|` and `|h v_i|` so far, if that is shorter. The monitor measures, by half
/// steps, every step whose momentum increments change more than before, and of the others the first sixteen, then ever
/// fewer, down to one of 200.
#[derive(Clone, Debug)]
pub struct ErrorMonitor<M: Method<S, N, T>, S, const N: usize, T: Scalar = f64> {
    start: State<N, T>,
    last: Node<N, T>,
    /// The turns that are subtracted from the angles of `start` and `last`.
    turns: Turns<N>,
    /// Mean force of the last step: the increment of the momenta, divided by its length.
    force: SVector<T, N>,
    /// Mean force of the first step, and the largest difference to it.
    first_force: SVector<T, N>,
    range: SVector<T, N>,
    /// Whether the next step has no predecessor: the first one, and one after a jump.
    is_first: bool,
    excursion: SVector<T, N>,
    /// The largest indicator of each coordinate, and its inverse when the window began.
    peak: SVector<T, N>,
    weights: SVector<T, N>,
    /// The largest `|∂F_i/∂q_i|` of the measured steps.
    stiffness: SVector<f64, N>,
    candidate: Option<Candidate<M::Memory, N, T>>,
    pub(super) steps: u64,
    /// Step number at which the window ends.
    due: u64,
    stretch: Option<Stretch<N, T>>,
    /// Largest `|p_i v_i|` and `|h v_i|` of the measured steps.
    action: SVector<f64, N>,
    displacement: SVector<f64, N>,
    /// `h v` and h of the first measured step, and the largest change of v since, times the length of its step.
    first: Option<(SVector<f64, N>, f64)>,
    deflection: SVector<f64, N>,
    largest: ErrorEstimate,
    /// The errors of all steps of closed windows, added up, and the number of those steps.
    sums: SVector<f64, N>,
    counted: u64,
    /// H along the run, and its largest error.
    energy: Option<EnergyPath>,
    of_energy: ErrorEstimate,
    /// The error of H at the end of the last window. It may pass.
    passing: ErrorEstimate,
    measurements: u64,
}

/// The first stretch of a run.
#[derive(Clone, Debug)]
struct Stretch<const N: usize, T> {
    /// Path lengths of each coordinate and of its mean force.
    way: SVector<T, N>,
    force_way: SVector<T, N>,
    /// The largest error of each coordinate, in its unit, and the time of that step.
    errors: SVector<f64, N>,
    times: SVector<f64, N>,
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> ErrorMonitor<M, S, N, T> {
    /// A monitor that starts at the current node of a run.
    pub fn new(run: &Run<M, S, N, T>) -> Self {
        Self { energy: EnergyPath::from(run), ..Self::of_steps(run) }
    }

    /// A monitor of the errors of single steps only, which starts at the current node of a run.
    pub(super) fn of_steps(run: &Run<M, S, N, T>) -> Self {
        let nothing = ErrorEstimate::none(run.node.t.to_f64());
        let (node, zeros, none) = (run.node, SVector::zeros(), SVector::zeros());
        Self {
            start: node.state(),
            last: node,
            turns: run.turns,
            force: zeros,
            first_force: zeros,
            range: zeros,
            is_first: true,
            excursion: zeros,
            peak: zeros,
            weights: zeros,
            stiffness: none,
            candidate: None,
            steps: 0,
            due: 1,
            stretch: Some(Stretch { way: zeros, force_way: zeros, errors: none, times: none }),
            action: none,
            displacement: none,
            first: None,
            deflection: none,
            largest: nothing,
            sums: none,
            counted: 0,
            energy: None,
            of_energy: nothing,
            passing: nothing,
            measurements: 0,
        }
    }

    /// Records the step that the run has just taken.
    #[inline]
    pub fn watch(&mut self, run: &Run<M, S, N, T>) {
        let node = &run.node;
        let h = duration(&self.last, node);
        if h == T::zero() {
            return;
        }
        let rate = T::one() / h;
        self.turn(run);
        if self.is_first {
            self.take_first((node.p - self.last.p) * rate);
        }
        // The change of the mean force, as a displacement. The steps of a damped motion grow: their errors increase
        // while its momenta decay.
        let unit = if run.method.facts().finds_length { h * h * h * h } else { h * h };
        let mut indicator = T::zero();
        for i in 0..N {
            let excursion = (node.q[i] - self.start.q[i]).abs();
            self.excursion[i] = larger(self.excursion[i], excursion);
            let force = (node.p[i] - self.last.p[i]) * rate;
            self.range[i] = larger(self.range[i], (force - self.first_force[i]).abs());
            let change = (force - self.force[i]).abs();
            let size = force.abs();
            self.force[i] = force;
            // An impulse changes the force in its own step and in the next one equally: a quarter more decides for its
            // own step.
            let peak = (change + T::real(0.25) * if size < change { size } else { change }) * unit;
            self.peak[i] = larger(self.peak[i], peak);
            indicator = larger(indicator, peak * self.weights[i]);
            // In free flight, sums of roundings would look like the path of a force.
            if let Some(stretch) = &mut self.stretch
                && change > T::real(4.0 * T::EPSILON) * (node.p[i] * rate).abs()
            {
                stretch.force_way[i] += change;
            }
        }
        if let Some(stretch) = &mut self.stretch {
            stretch.way += (node.q - self.last.q).map(T::abs);
        }
        self.steps += 1;
        if self.candidate.as_ref().is_none_or(|candidate| indicator >= candidate.indicator) {
            self.nominate(run, indicator);
        }
        self.last = *node;
        if self.steps >= self.due || indicator > T::real(SUSPICIOUS) {
            self.close(run);
        }
    }

    /// Takes the mean force of a step without a predecessor, and measures that step.
    #[cold]
    #[inline(never)]
    fn take_first(&mut self, force: SVector<T, N>) {
        if self.steps == 0 {
            self.first_force = force;
        }
        (self.force, self.is_first, self.due) = (force, false, self.steps);
    }

    /// Takes the turns of a run for the start of its step, and for the start of the run.
    #[inline]
    fn turn(&mut self, run: &Run<M, S, N, T>) {
        if const { angles::has_angles::<S, N, T>() } && self.turns != run.turns {
            self.last = angles::reduced_node(&run.system, &self.last);
            self.start = angles::without_turns(&self.start, &(run.turns - self.turns));
            self.turns = run.turns;
        }
    }

    /// Skips a jump of the state: the next step begins at the current node of the run.
    pub fn resume(&mut self, run: &Run<M, S, N, T>) {
        self.close(run);
        // A jump is no excursion.
        self.start.q += run.node.q - self.last.q;
        self.start.p += run.node.p - self.last.p;
        (self.last, self.turns) = (run.node, run.turns);
        self.is_first = true;
        self.energy = EnergyPath::from(run);
    }

    /// The largest relative error of a step so far, and its time. Also measures the candidate of the open window, so
    /// that short runs have a result.
    pub fn largest(&self, run: &Run<M, S, N, T>) -> ErrorEstimate {
        if self.candidate.is_none() {
            return self.found();
        }
        let mut closed = self.clone();
        closed.close(run);
        closed.found()
    }

    /// Number of measured steps.
    pub fn measurements(&self) -> u64 {
        self.measurements
    }

    /// The error of the next step of the run, relative to the scales so far.
    ///
    /// # Errors
    /// The errors of the step.
    pub fn error_estimate(&self, run: &Run<M, S, N, T>) -> Result<f64, StepError> {
        let mut ahead = run.clone();
        ahead.single_step()?;
        let mut monitor = self.clone();
        // The excursions include this step.
        monitor.watch(&ahead);
        let before = angles::reduced_node(&run.system, &run.node);
        let found = measured(run, &run.memory, [&before, &ahead.node]);
        monitor.add(&found);
        Ok(monitor.relative(&found.error, &SVector::zeros()).estimate.max(found.energy))
    }

    /// Whether some coordinate moves so far that errors of the size of a tolerance exceed rounding.
    pub(super) fn has_motion(&self, tolerance: f64) -> bool {
        (0..N).any(|i| {
            let size = larger(self.start.q[i].abs(), self.last.q[i].abs()).to_f64();
            self.counts(i) && self.excursion(i) * tolerance.max(COARSEST) > VISIBLE * T::EPSILON * size
        })
    }

    /// Whether the first stretch is over.
    pub(super) fn is_over(&self) -> bool {
        self.stretch.is_none()
    }

    /// Whether excursions are large enough to judge errors: a coordinate or its force has turned back, or the run has taken [`JUDGED`] steps.
    fn judges(&self) -> bool {
        let Some(stretch) = &self.stretch else { return true };
        let has_turned = |way: T, largest: T| way.to_f64() > TURNED * largest.to_f64();
        self.steps >= JUDGED
            || (0..N).filter(|i| self.counts(*i)).any(|i| {
                has_turned(stretch.way[i], self.excursion[i])
                    || self.has_force(i) && has_turned(stretch.force_way[i], self.range[i])
            })
    }

    /// # Errors
    /// [`StepError::Tolerance`] if the largest error exceeds the limit.
    #[inline]
    fn check(&self, limit: f64) -> Result<(), StepError> {
        // Errors of the first steps are relative to excursions that still grow.
        if self.largest.estimate <= limit || !self.judges() {
            return Ok(());
        }
        let ErrorEstimate { estimate, t, .. } = self.largest;
        Err(StepError::Tolerance { t, estimate, tolerance: limit })
    }

    #[inline(never)]
    fn nominate(&mut self, run: &Run<M, S, N, T>, indicator: T) {
        let (before, after, memory) = (self.last, run.node, run.memory.clone());
        self.candidate = Some(Candidate { before, after, memory, indicator });
    }

    /// Measures the step with the largest indicator, and begins the next window.
    #[cold]
    #[inline(never)]
    fn close(&mut self, run: &Run<M, S, N, T>) {
        self.due = self.steps + (self.steps / 8).clamp(1, WINDOW);
        let Some(Candidate { before, after, memory, .. }) = self.candidate.take() else { return };
        if !duration(&before, &after).to_f64().is_normal() {
            return;
        }
        let found = measured(run, &memory, [&before, &after]);
        self.measurements += 1;
        self.add(&found);
        // Without a step the product of an infinite error has no value.
        if self.steps > self.counted {
            #[allow(clippy::cast_precision_loss)] // an estimate
            let steps = (self.steps - self.counted) as f64;
            self.sums += found.error * steps;
            self.counted = self.steps;
        }
        let t = before.t.to_f64();
        let coordinate = found.action.imax();
        let [lasting, passing] = self.energy.as_mut().map_or([0.0; 2], |energy| energy.drift(run));
        let of_energy = |estimate: f64| ErrorEstimate { estimate, t, coordinate, sum: 0.0 };
        self.of_energy = self.of_energy.or_larger(of_energy(found.energy.max(lasting)));
        self.passing = of_energy(passing);
        if let Some(stretch) = &mut self.stretch {
            for i in 0..N {
                if found.error[i] > stretch.errors[i] {
                    (stretch.errors[i], stretch.times[i]) = (found.error[i], t);
                }
            }
            self.largest = self.lasting();
            if self.steps >= STRETCH || self.has_turned() {
                self.stretch = None;
            }
        } else {
            let of_step = self.relative(&found.error, &SVector::repeat(t));
            self.largest = self.largest.or_larger(of_step).or_larger(self.of_energy);
        }
        self.weights = self.peak.map(|peak| T::one() / peak);
    }

    fn add(&mut self, found: &Measurement<N>) {
        self.action = self.action.zip_map(&found.action, f64::max);
        self.displacement = self.displacement.zip_map(&found.hv, |largest, hv| largest.max(hv.abs()));
        if found.h != 0.0 {
            let (first, h) = *self.first.get_or_insert((found.hv, found.h));
            let change = found.hv - first * (found.h / h);
            self.deflection = self.deflection.zip_map(&change, |largest, hv| largest.max(hv.abs()));
        }
        self.stiffness = self.stiffness.zip_map(&found.stiffness, f64::max);
    }

    /// Whether every counted coordinate has turned back and covered its excursion several times, or has never turned. If
    /// none has turned, the same of the mean forces: a rotor never turns back, but its force does.
    fn has_turned(&self) -> bool {
        let Some(stretch) = &self.stretch else { return true };
        let path = |i: usize| stretch.way[i].to_f64() / self.excursion[i].to_f64();
        let of_force = |i: usize| stretch.force_way[i].to_f64() / self.range[i].to_f64();
        let counted = || (0..N).filter(|i| self.counts(*i));
        if counted().any(|i| path(i) > TURNED) {
            counted().any(|i| path(i) >= COVERED) && counted().all(|i| path(i) >= COVERED || path(i) <= TURNED)
        } else {
            let forced = || counted().filter(|i| self.has_force(*i));
            forced().any(|i| of_force(i) >= COVERED)
                && forced().all(|i| of_force(i) >= COVERED || of_force(i) <= TURNED)
        }
    }

    /// Whether a coordinate moves visibly.
    fn counts(&self, i: usize) -> bool {
        let size = larger(self.start.q[i].abs(), self.last.q[i].abs()).to_f64();
        let faint = FAINT * T::EPSILON;
        self.excursion(i) > VISIBLE * T::EPSILON * size && self.action[i] >= faint * faint * self.action.max()
    }

    /// The scale of the errors of a coordinate: its excursion, or the distance over which its force changes by the
    /// range of the force, if that is shorter.
    fn scale(&self, i: usize) -> f64 {
        let excursion = self.excursion(i);
        let reach = (self.range[i].to_f64() / self.stiffness[i]).max(DEFLECTION * self.deflection[i]);
        if self.has_force(i) && reach < excursion { reach } else { excursion }
    }

    /// Whether the mean force of a coordinate changes visibly.
    fn has_force(&self, i: usize) -> bool {
        let change = self.range[i].to_f64() * self.displacement[i];
        change > VISIBLE * T::EPSILON * self.action[i]
    }

    fn excursion(&self, i: usize) -> f64 {
        self.excursion[i].to_f64().max(self.displacement[i])
    }

    /// The largest relative error so far.
    fn found(&self) -> ErrorEstimate {
        self.lasting().or_larger(self.passing)
    }

    /// The largest relative error so far, without an error of H that may pass.
    fn lasting(&self) -> ErrorEstimate {
        let found = match &self.stretch {
            Some(stretch) => self.relative(&stretch.errors, &stretch.times),
            None => self.largest,
        };
        let sum = self.relative(&self.sums, &SVector::zeros()).estimate;
        ErrorEstimate { sum, ..found.or_larger(self.of_energy) }
    }

    /// The largest error over all coordinates, relative to their excursions.
    fn relative(&self, errors: &SVector<f64, N>, times: &SVector<f64, N>) -> ErrorEstimate {
        let mut largest = ErrorEstimate::none(self.last.t.to_f64());
        for i in 0..N {
            let error = errors[i];
            let estimate = match error {
                0.0 => 0.0,
                _ if error.is_infinite() => f64::INFINITY,
                _ if self.counts(i) => error / self.scale(i),
                _ => 0.0,
            };
            largest = largest.or_larger(ErrorEstimate { estimate, t: times[i], coordinate: i, sum: 0.0 });
        }
        largest
    }
}

/// The larger number, by one comparison.
#[inline(always)]
fn larger<T: Scalar>(a: T, b: T) -> T {
    if b > a { b } else { a }
}
